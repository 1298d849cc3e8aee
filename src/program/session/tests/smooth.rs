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
fn stroke_line(tool: &str, x: u32) -> String {
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

fn airbrush() -> Session {
    let mut session = replay(AIR);
    (0..60).for_each(|i| tell(&mut session, &stroke_line("brush", 60 + i)));
    session
}

fn paint(session: &Session) -> PixelLayer {
    let layer = session.active().unwrap().document().layers.last().unwrap().clone();
    let Content::Pixels(pixels) = &layer.content else { panic!("paint") };
    pixels.clone()
}

/// How many values alpha has.
fn levels(paint: &PixelLayer) -> usize {
    let all = paint
        .tiles
        .iter()
        .flat_map(|(_, tile)| tile.to_rows16().iter().flat_map(|row| row[3]).collect::<Vec<_>>());
    all.collect::<std::collections::BTreeSet<u16>>().len()
}

#[test]
fn an_airbrush_over_many_strokes_is_kept_finely_through_undo_cut_paste_and_merging() {
    let mut session = airbrush();
    let fine = levels(&paint(&session));
    assert!(fine > 2000, "{fine} levels");
    tell(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert!(levels(&paint(&session)) > 2000);
    tell(&mut session, r#"{"in":"edit","do":"redo"}"#);
    let all = session.active().unwrap().document().clone();
    for copied in [
        r#"{"in":"clipboard","do":"copy","merged":false}"#,
        r#"{"in":"clipboard","do":"copy","merged":true}"#,
    ] {
        tell(&mut session, &format!("{copied}\n{}", r#"{"in":"clipboard","do":"paste new"}"#));
        assert!(
            levels(&paint(&session)) > 2000 || copied.contains("true"),
            "{copied}: {}",
            levels(&paint(&session))
        );
        let red = paint(&session).tiles.pixel16(90, 75);
        assert!(red.iter().any(|v| v % 257 != 0), "{copied}: {red:?}");
    }
    let mut session = airbrush();
    assert!(
        session.active().unwrap().document().difference(&all).is_none(),
        "the same strokes, the same paint"
    );
    tell(&mut session, r#"{"in":"layer","do":"merge down","layer":"1"}"#);
    assert!(paint(&session).tiles.pixel16(90, 75).iter().any(|v| v % 257 != 0));
}

#[test]
fn a_faint_eraser_takes_airbrushed_paint_away_and_what_is_left_is_saved() {
    let mut session = airbrush();
    let before = paint(&session).tiles.pixel16(90, 75)[3];
    tell(
        &mut session,
        r#"{"in":"hand","do":"brush","brush":{"size":120,"hardness":0,"flow":0.001,"erases":true}}"#,
    );
    tell(&mut session, &stroke_line("eraser", 90));
    let after = paint(&session).tiles.pixel16(90, 75)[3];
    assert!(after < before && before - after < 900, "{before} to {after}");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.ora");
    let document = session.active().unwrap().document();
    crate::session::storage::save(&file, document, Overwrite::Nothing, &Progress::default())
        .unwrap()
        .unwrap();
    let back = crate::session::storage::open(&file).unwrap();
    assert!(document.difference(back.open.document()).is_none());
}

#[test]
fn baked_smooth_strokes_are_as_fine_as_they_were_alive() {
    let mut session = replay(&AIR.replace(r#"{"in":"layer","do":"add","kind":"paint"}"#, ""));
    (0..6).for_each(|i| tell(&mut session, &stroke_line("brush", 60 + i)));
    assert!(matches!(session.active().unwrap().document().layers[1].content, Content::Strokes(_)));
    let bake = Action::Layer(LayerAction::Bake { layer: session.layer_paths() });
    bake.apply(&mut session).unwrap();
    assert!(levels(&paint(&session)) > 1000, "{} levels", levels(&paint(&session)));
}

#[test]
fn a_picture_of_16_bits_keeps_them_when_it_is_opened_or_placed_and_baked() {
    let folder = tempfile::tempdir().unwrap();
    let noise = |x: u32, y: u32| image::Luma([(crate::math::hash::unit(x, y, 0) * 65536.0) as u16]);
    let picture = image::ImageBuffer::from_fn(200, 150, noise);
    let file = folder.path().join("noise.png");
    image::DynamicImage::ImageLuma16(picture.clone()).save(&file).unwrap();
    let named = file.to_string_lossy().replace('\\', "/");
    let opened = replay(&format!(r#"{{"in":"file","do":"open","file":"{named}"}}"#));
    let mut placed =
        replay(r#"{"in":"file","do":"new","width":200,"height":150,"background":null}"#);
    tell(&mut placed, &format!(r#"{{"in":"file","do":"place","file":"{named}","at":[100,75]}}"#));
    tell(&mut placed, r#"{"in":"layer","do":"bake","layer":"0"}"#);
    for session in [opened, placed] {
        let tiles = paint(&session).tiles;
        let apart = |(x, y, pixel): (u32, u32, &image::Luma<u16>)| {
            tiles.pixel16(x as i32, y as i32)[0].abs_diff(pixel.0[0])
        };
        assert!(picture.enumerate_pixels().map(apart).max() <= Some(1));
    }
}

#[test]
fn a_photoshop_file_of_16_bits_is_not_saved_over_with_8() {
    let folder = tempfile::tempdir().unwrap();
    // One pixel without layers: its header, no table, resources or layers, and three plain
    // channels.
    let file = |bits: u8, plane: &[u8]| {
        let head =
            [&b"8BPS\0\x01\0\0\0\0\0\0\0\x03\0\0\0\x01\0\0\0\x01\0"[..], &[bits, 0, 3]].concat();
        let bytes = [&head, &[0; 14][..], &plane.repeat(3)].concat();
        let file = folder.path().join(format!("{bits}.psd"));
        std::fs::write(&file, bytes).unwrap();
        file
    };
    let opened =
        |file: &Path| crate::session::storage::open(file).unwrap_or_else(|e| panic!("{e}"));
    let wide = opened(&file(16, &[0x12, 0x34]));
    let Content::Pixels(pixels) = &wide.open.document().layers[0].content else { panic!("paint") };
    assert_eq!(pixels.tiles.pixel16(0, 0), [0x1234, 0x1234, 0x1234, 65535]);
    assert!(wide.notes[0].contains("8 for other programs"), "{:?}", wide.notes);
    assert_eq!(wide.open.file, None);
    let narrow = opened(&file(8, &[0x12]));
    assert!(narrow.notes.is_empty() && narrow.open.file.is_some());
}
