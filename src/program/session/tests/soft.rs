//! Soft paint through a session: painted, retouched, merged, copied, saved and opened.

use super::*;
use crate::document::PixelLayer;
use crate::io::Overwrite;

const AIR: &str = r##"
{"in":"file","do":"new","width":200,"height":150,"background":"#ffffff"}
{"in":"layer","do":"add","kind":"paint"}
{"in":"hand","do":"color","color":"#102030"}
{"in":"hand","do":"brush","brush":{"size":120,"hardness":0,"flow":0.004,"spacing":0.1,"dynamics":{}}}"##;

/// A stroke of the current brush or eraser.
fn drawn(tool: &str, x: u32) -> String {
    format!(
        r#"
        {{"in":"pointer","do":"press","tool":"{tool}","pen":[{x},10],"px_per_pt":1}}
        {{"in":"pointer","do":"drag","pens":[[{x},140]]}}
        {{"in":"pointer","do":"release"}}"#
    )
}
fn tell(session: &mut Session, lines: &str) {
    session.replay(Path::new("story"), lines).unwrap_or_else(|e| panic!("{e}"));
}
fn airbrushed() -> Session {
    let mut session = told(AIR);
    (0..60).for_each(|i| tell(&mut session, &drawn("brush", 60 + i)));
    session
}
fn paint(session: &Session) -> PixelLayer {
    let layer = session.active().unwrap().document().layers.last().unwrap().clone();
    let Content::Pixels(pixels) = &layer.content else { panic!("paint") };
    pixels.clone()
}
/// How many values alpha has.
fn levels(paint: &PixelLayer) -> usize {
    let all =
        paint.tiles.iter().flat_map(|(_, tile)| tile.deep_rows().iter().flat_map(|row| row[3]).collect::<Vec<_>>());
    all.collect::<std::collections::BTreeSet<u16>>().len()
}

#[test]
fn an_airbrush_over_many_strokes_is_kept_finely_through_undo_cut_paste_and_merging() {
    let mut session = airbrushed();
    let fine = levels(&paint(&session));
    assert!(fine > 2000, "{fine} levels");
    tell(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert!(levels(&paint(&session)) > 2000);
    tell(&mut session, r#"{"in":"edit","do":"redo"}"#);
    let all = session.active().unwrap().document().clone();
    for copied in
        [r#"{"in":"clipboard","do":"copy","merged":false}"#, r#"{"in":"clipboard","do":"copy","merged":true}"#]
    {
        tell(&mut session, &format!("{copied}\n{}", r#"{"in":"clipboard","do":"paste new"}"#));
        assert!(levels(&paint(&session)) > 2000 || copied.contains("true"), "{copied}: {}", levels(&paint(&session)));
        let red = paint(&session).tiles.deep_pixel(90, 75);
        assert!(red.iter().any(|v| v % 257 != 0), "{copied}: {red:?}");
    }
    let mut session = airbrushed();
    assert!(session.active().unwrap().document().difference(&all).is_none(), "the same strokes, the same paint");
    tell(&mut session, r#"{"in":"layer","do":"merge down","layer":"1"}"#);
    assert!(paint(&session).tiles.deep_pixel(90, 75).iter().any(|v| v % 257 != 0));
}
#[test]
fn a_faint_eraser_takes_airbrushed_paint_away_and_what_is_left_is_saved() {
    let mut session = airbrushed();
    let before = paint(&session).tiles.deep_pixel(90, 75)[3];
    tell(&mut session, r#"{"in":"hand","do":"brush","brush":{"size":120,"hardness":0,"flow":0.001,"erases":true}}"#);
    tell(&mut session, &drawn("eraser", 90));
    let after = paint(&session).tiles.deep_pixel(90, 75)[3];
    assert!(after < before && before - after < 900, "{before} to {after}");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.ora");
    let document = session.active().unwrap().document();
    crate::session::storage::save(&file, document, Overwrite::Nothing, &Progress::default()).unwrap().unwrap();
    let back = crate::session::storage::open(&file).unwrap();
    assert!(document.difference(back.tab.document()).is_none());
}
#[test]
fn baked_soft_strokes_are_as_fine_as_they_were_alive() {
    let mut session = told(&AIR.replace(r#"{"in":"layer","do":"add","kind":"paint"}"#, ""));
    (0..6).for_each(|i| tell(&mut session, &drawn("brush", 60 + i)));
    assert!(matches!(session.active().unwrap().document().layers[1].content, Content::Strokes(_)));
    let bake = Action::Layer(LayerAction::Bake { layer: session.layer_paths() });
    bake.apply(&mut session).unwrap();
    assert!(levels(&paint(&session)) > 1000, "{} levels", levels(&paint(&session)));
}
