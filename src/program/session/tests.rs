//! Stories: what a user does, written as the lines of a replay.

mod canvas;
mod closed;
mod dialect;
mod exporting;
mod held;
mod kept;
mod palettes;
mod panels;
mod pasting;
mod paths;
mod profiles;
mod selecting;
mod several;
mod shaped;
mod smooth;
mod snapping;
mod steps;
pub(in crate::session) mod stories;
mod svg;
mod targets;
mod texts;
mod transforming;
mod unwrapped;
mod warping;

use super::actions::{Action, LayerAction};
use super::replay::ReplayValue;
use super::*;
use crate::document::{Content, Progress, flatten};
use crate::raster::BlendMode;
use crate::shading::Mood;

fn replay(lines: &str) -> Session {
    let mut session = Session::default();
    session.replay(Path::new("story"), lines).unwrap_or_else(|e| panic!("{e}"));
    session
}

fn names(session: &Session) -> Vec<String> {
    session
        .active()
        .unwrap()
        .document()
        .walk()
        .iter()
        .map(|(_, layer)| layer.name.clone())
        .collect()
}

fn pixel(session: &Session, x: i32, y: i32) -> [u8; 4] {
    flatten(&session.active().unwrap().drawn_document(), &Progress::default()).unwrap().pixel(x, y)
}

const PAPER: &str = r##"{"in":"file","do":"new","width":200,"height":150,"background":"#ffffff"}"##;
const STROKE: &str = r##"
{"in":"hand","do":"preset","name":"hard-round"}
{"in":"hand","do":"color","color":"#c02010"}
{"in":"pointer","do":"press","tool":"brush","pen":[20,70],"px_per_pt":1}
{"in":"pointer","do":"drag","pens":[[60,74],[120,70]]}
{"in":"pointer","do":"drag","pens":[[180,72]]}
{"in":"pointer","do":"release"}"##;

#[test]
fn a_stroke_on_paper_is_one_named_step_that_can_be_undone() {
    let mut session = replay(&format!("{PAPER}{STROKE}"));
    assert_eq!(names(&session), ["Background", "Strokes"]);
    assert_eq!(session.active().unwrap().history.undo_label(), Some("Brush stroke"));
    assert_eq!(pixel(&session, 100, 70), [0xc0, 0x20, 0x10, 255]);
    assert!(session.active().unwrap().is_dirty());
    session.replay(Path::new("story"), r#"{"in":"edit","do":"undo"}"#).unwrap();
    assert_eq!(pixel(&session, 100, 70), [255; 4]);
    assert!(
        !session.active().unwrap().is_dirty(),
        "back to what was opened, there is nothing to save"
    );
    assert_eq!(session.recent_colors, [session.tools.color]);
}

#[test]
fn a_slider_shows_as_it_moves_and_is_one_step_when_it_is_let_go() {
    let mut session = replay(&format!("{PAPER}{STROKE}"));
    let set = |to: f32, done: bool| {
        format!(
            r#"{{"in":"layer","do":"set","layer":"1","to":{{"do":"opacity","to":{to}}},"done":{done}}}"#
        )
    };
    session.replay(Path::new("story"), &set(0.2, false)).unwrap();
    assert_eq!(session.layer().unwrap().opacity, 0.2);
    assert_eq!(session.active().unwrap().document().layers[1].opacity, 1.0);
    session
        .replay(Path::new("story"), &format!("{}\n{}", set(0.4, false), set(0.5, true)))
        .unwrap();
    assert_eq!(
        session.active().unwrap().history.past_names().collect::<Vec<_>>(),
        ["Brush stroke", "Opacity"]
    );
    assert_eq!(session.active().unwrap().document().layers[1].opacity, 0.5);
}

#[test]
fn new_light_suits_what_is_painted() {
    let session = replay(&format!(
        r#"{PAPER}{STROKE}
        {{"in":"layer","do":"add shading","model":"toon"}}
        {{"in":"layer","do":"add shading","model":"painter"}}
        {{"in":"layer","do":"set","layer":"3","to":{{"do":"mood","mood":"moon"}},"done":true}}"#
    ));
    let layers = &session.active().unwrap().document().layers;
    assert_eq!(layers[2].blend, BlendMode::Multiply, "toon darkens what it is laid on");
    let Content::Shading(light) = &layers[3].content else { panic!("no light") };
    assert_eq!(layers[3].name, "Painter's light");
    assert!(light.params().is_lighting_beneath(), "there is paint beneath");
    let is_in = |mood: Mood| mood.is_of(light.params());
    assert!(is_in(Mood::Moon) && !is_in(Mood::Studio));
}

#[test]
fn layers_are_made_grouped_moved_and_merged() {
    let session = replay(&format!(
        r#"{PAPER}{STROKE}
        {{"in":"layer","do":"duplicate","layer":"1"}}
        {{"in":"layer","do":"group","layer":"2"}}
        {{"in":"layer","do":"add","kind":"gradient"}}
        {{"in":"layer","do":"move","layer":"1","group":"2","index":0}}
        {{"in":"layer","do":"set","layer":"1","to":{{"do":"blend","mode":"multiply"}},"done":true}}"#
    ));
    assert_eq!(names(&session), ["Background", "Strokes", "Strokes copy", "Gradient", "Group"]);
    assert_eq!(session.active().unwrap().document().layers[1].blend, BlendMode::Multiply);
    let mut session = session;
    session
        .replay(
            Path::new("story"),
            "{\"in\":\"layer\",\"do\":\"ungroup\",\"layer\":\"1\"}\n{\"in\":\"layer\",\"do\":\"flatten\"}",
        )
        .unwrap();
    assert_eq!(names(&session), ["Picture"]);
}

#[test]
fn baking_changes_what_a_layer_is_and_no_pixel() {
    let mut session = replay(&format!("{PAPER}{STROKE}"));
    let before = flatten(session.active().unwrap().document(), &Progress::default()).unwrap();
    let bake = Action::Layer(LayerAction::Bake { layer: session.layer_paths() });
    bake.apply(&mut session).unwrap();
    let after = session.active().unwrap().document();
    assert!(matches!(after.layers[1].content, Content::Pixels(_)));
    let after = flatten(after, &Progress::default()).unwrap();
    let rect = crate::math::Rect::new(0, 0, 200, 150);
    assert_eq!(before.to_straight_rgba(rect), after.to_straight_rgba(rect));
}

#[test]
fn adjusted_paint_is_shown_then_kept_as_one_step_or_forgotten() {
    let mut session = replay(&format!(
        r#"{PAPER}{STROKE}
        {{"in":"layer","do":"bake","layer":"1"}}
        {{"in":"layer","do":"adjust","layer":"1","adjustment":{{"kind":"invert"}},"done":false}}"#
    ));
    let (red, inverted) = ([0xc0, 0x20, 0x10, 255], [0x3f, 0xdf, 0xef, 255]);
    let kept = |session: &Session| {
        let document = session.active().unwrap().document();
        flatten(document, &Progress::default()).unwrap().pixel(100, 70)
    };
    assert_eq!((pixel(&session, 100, 70), kept(&session)), (inverted, red));
    let forget = r#"{"in":"layer","do":"unadjust"}"#;
    session.replay(Path::new("story"), forget).unwrap();
    assert_eq!(pixel(&session, 100, 70), red);
    let keep =
        r#"{"in":"layer","do":"adjust","layer":"1","adjustment":{"kind":"invert"},"done":true}"#;
    session.replay(Path::new("story"), keep).unwrap();
    assert_eq!(kept(&session), inverted);
    session.replay(Path::new("story"), r#"{"in":"edit","do":"undo"}"#).unwrap();
    assert_eq!(pixel(&session, 100, 70), red);
}

#[test]
fn an_adjustment_layer_changes_what_is_beneath_it_and_the_selection_masks_it() {
    let mut session = replay(&format!(
        r#"{PAPER}{STROKE}
        {{"in":"layer","do":"add adjustment","adjustment":{{"kind":"threshold","level":100}}}}"#
    ));
    assert_eq!((pixel(&session, 100, 70), pixel(&session, 5, 5)), ([0, 0, 0, 255], [255; 4]));
    let set = r#"{"in":"layer","do":"set","layer":"2","to":{"do":"adjustment","to":{"kind":"invert"}},"done":true}"#;
    session.replay(Path::new("story"), set).unwrap();
    assert_eq!(pixel(&session, 5, 5), [0, 0, 0, 255]);
}

#[test]
fn paint_is_filtered_for_good_or_by_a_layer_above_it() {
    let pixelate = r#"{"kind":"pixelate","size":200}"#;
    let mut session = replay(&format!(
        r#"{PAPER}{STROKE}
        {{"in":"layer","do":"bake","layer":"1"}}
        {{"in":"layer","do":"filter","layer":"1","filter":{pixelate},"done":false}}"#
    ));
    let shown = pixel(&session, 190, 140);
    assert_ne!(shown, [255; 4], "the mean of all of it");
    session.replay(Path::new("story"), r#"{"in":"layer","do":"unadjust"}"#).unwrap();
    assert_eq!(pixel(&session, 190, 140), [255; 4]);
    let keep =
        format!(r#"{{"in":"layer","do":"filter","layer":"1","filter":{pixelate},"done":true}}"#);
    session.replay(Path::new("story"), &keep).unwrap();
    assert_eq!(pixel(&session, 190, 140), shown);
    session.replay(Path::new("story"), r#"{"in":"edit","do":"undo"}"#).unwrap();
    let add = format!(r#"{{"in":"layer","do":"add filter","filter":{pixelate}}}"#);
    session.replay(Path::new("story"), &add).unwrap();
    let both = pixel(&session, 190, 140);
    let off = shown.iter().zip(both).map(|(a, b)| a.abs_diff(b)).max();
    assert!(off <= Some(1), "paper and paint, mixed: {both:?}, not {shown:?}");
    let set = r#"{"in":"layer","do":"set","layer":"2","to":{"do":"filter layer","to":{"kind":"sharpen"}},"done":true}"#;
    session.replay(Path::new("story"), set).unwrap();
    assert_eq!(pixel(&session, 190, 140), [255; 4]);
}

#[test]
fn a_layer_alone_hides_the_others_until_it_is_no_longer() {
    let mut session = replay(&format!("{PAPER}{STROKE}"));
    let solo = r#"{"in":"layer","do":"solo","layer":"1"}"#;
    session.replay(Path::new("story"), solo).unwrap();
    assert_eq!(
        (pixel(&session, 5, 5), pixel(&session, 100, 70)),
        ([0; 4], [0xc0, 0x20, 0x10, 255])
    );
    session.replay(Path::new("story"), solo).unwrap();
    assert_eq!(pixel(&session, 5, 5), [255; 4]);
}

#[test]
fn what_cannot_be_done_changes_nothing() {
    let mut session = replay(PAPER);
    let before = session.active().unwrap().document().clone();
    let hopeless = r#"
        {"in":"layer","do":"delete","layer":"7"}
        {"in":"layer","do":"move","layer":"0","group":"0","index":0}
        {"in":"layer","do":"merge down","layer":"0"}
        {"in":"edit","do":"redo"}
        {"in":"pointer","do":"release"}
        {"in":"file","do":"tab","index":9}"#;
    session.replay(Path::new("story"), hopeless).unwrap();
    assert!(is_same(&before, session.active().unwrap().document()));
    assert_eq!(session.active().unwrap().history.past_names().len(), 0);
    let wrong = session
        .replay(Path::new("story"), "{\"in\":\"layer\",\"do\":\"paint it black\"}")
        .unwrap_err();
    assert_eq!(
        wrong.to_string(),
        "story: line 1: “do” is “paint it black”, which is not known here"
    );
}

#[test]
fn actions_read_back_as_they_were_written() {
    let story = format!("{PAPER}{STROKE}");
    let actions = replay::lines::<Action>(Path::new("story"), &story).unwrap();
    for action in actions {
        let written = action.to_value();
        assert_eq!(Action::read(&written).unwrap().to_value(), written);
    }
}

#[test]
fn strokes_are_selected_restyled_ordered_copied_and_baked_by_replay() {
    let mut session = replay(&format!(
        r##"{PAPER}{STROKE}
        {{"in":"stroke","do":"duplicate","layer":"1","strokes":[0]}}
        {{"in":"stroke","do":"restyle","layer":"1","strokes":[1],"to":{{"do":"color","color":"#0000ff"}},"done":true}}
        {{"in":"stroke","do":"move","layer":"1","strokes":[1],"by":[0,40]}}"##
    ));
    assert_eq!(session.active().unwrap().selected_strokes(), [1]);
    assert_eq!(
        (pixel(&session, 100, 70), pixel(&session, 112, 123)),
        ([0xc0, 0x20, 0x10, 255], [0, 0, 255, 255])
    );
    let past: Vec<&str> = session.active().unwrap().history.past_names().collect();
    assert_eq!(past[1..], ["Duplicate stroke", "Restyle stroke", "Move stroke"]);
    let rest = r#"
        {"in":"stroke","do":"take","layer":"1","stroke":1}
        {"in":"stroke","do":"order","layer":"1","stroke":1,"to":0}
        {"in":"stroke","do":"bake","layer":"1","strokes":[0]}
        {"in":"stroke","do":"delete","layer":"2","strokes":[0]}
        {"in":"stroke","do":"delete","layer":"2","strokes":[7]}"#;
    session.replay(Path::new("story"), rest).unwrap();
    assert_eq!(session.tools.color.to_string(), "#0000ff");
    assert_eq!(names(&session), ["Background", "Strokes baked", "Strokes"]);
    assert_eq!((pixel(&session, 100, 70), pixel(&session, 112, 123)), ([255; 4], [0, 0, 255, 255]));
}

#[test]
fn a_fill_stops_at_a_stroke_and_is_one_step() {
    let fill = r#"{"tolerance":0.2,"gap_px":0,"grow_px":1,"antialias":true,"layer_alone":false,"bounded":"free"}"#;
    let session = replay(&format!(
        r##"{PAPER}{STROKE}
        {{"in":"hand","do":"fill","fill":{fill}}}
        {{"in":"hand","do":"color","color":"#00ff00"}}
        {{"in":"pointer","do":"press","tool":"fill","pen":[100,20],"px_per_pt":1}}
        {{"in":"pointer","do":"release"}}"##
    ));
    assert_eq!(names(&session), ["Background", "Strokes", "Paint"]);
    assert_eq!(session.active().unwrap().history.undo_label(), Some("Fill"));
    assert_eq!(
        (pixel(&session, 100, 20), pixel(&session, 100, 70)),
        ([0, 255, 0, 255], [0xc0, 0x20, 0x10, 255])
    );
    assert_eq!(pixel(&session, 5, 140), [0, 255, 0, 255], "around the stroke's ends");
}

#[test]
fn a_line_begins_where_the_last_stroke_ended_whatever_other_tool_was_used_since() {
    let line = r#"
        {"in":"pointer","do":"press","tool":"brush","pen":[20,20],"px_per_pt":1}
        {"in":"pointer","do":"release"}
        {"in":"pointer","do":"press","tool":"select rectangle","pen":[60,50],"px_per_pt":1}
        {"in":"pointer","do":"drag","pens":[[150,120]]}
        {"in":"pointer","do":"release"}
        {"in":"pointer","do":"press","tool":"brush","pen":PEN,"px_per_pt":1}
        {"in":"pointer","do":"release"}"#;
    let shifted = r#"[40,20,1,0,0,0,{"shift":true,"ctrl":false,"alt":false}]"#;
    let session = replay(&format!("{PAPER}{}", line.replace("PEN", shifted)));
    let document = session.active().unwrap().document();
    let strokes = document.strokes(session.active().unwrap().active_layer.unwrap());
    assert_eq!(strokes[1].samples()[0].at, crate::math::vec2(20.0, 20.0));
}
