//! Guides, snapping and assistants, written as the lines of a replay.

use super::*;
use crate::math::{Rect, vec2};
use crate::raster::CoverageGrid;

/// A guide at x = 80 and one at y = 60.
const GUIDES: &str = r#"
{"in":"guide","do":"set","guides":{"vertical":[80],"horizontal":[60]}}"#;

fn story(session: &mut Session, lines: &str) {
    session.replay(Path::new("story"), lines).unwrap_or_else(|e| panic!("{e}"));
}

/// A drag with a tool and one key or none.
fn drag(tool: &str, from: [f32; 2], to: [f32; 2], key: &str) -> String {
    let keys = |name: &str| name == key;
    let keys =
        format!(r#"{{"shift":{},"ctrl":{},"alt":{}}}"#, keys("shift"), keys("ctrl"), keys("alt"));
    let pen = |[x, y]: [f32; 2]| format!("[{x},{y},1,0,0,0,{keys}]");
    format!(
        "{{\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"{tool}\",\"pen\":{},\"px_per_pt\":1}}
{{\"in\":\"pointer\",\"do\":\"drag\",\"pens\":[{}]}}
{{\"in\":\"pointer\",\"do\":\"release\"}}",
        pen(from),
        pen(to)
    )
}

fn covered_rect(session: &Session) -> Rect {
    session.active().unwrap().document().active_coverage().map(CoverageGrid::covered_rect).unwrap()
}

fn document(session: &Session) -> &Document {
    session.active().unwrap().document()
}

#[test]
fn selections_gradients_and_layers_go_to_guides_that_they_come_near() {
    let mut session = replay(&format!("{PAPER}{GUIDES}"));
    story(&mut session, &drag("select rectangle", [77.0, 20.0], [150.0, 66.0], ""));
    assert_eq!(covered_rect(&session), Rect::new(80, 20, 150, 60));
    story(&mut session, &drag("select rectangle", [120.0, 40.0], [118.0, 61.0], ""));
    assert_eq!(
        covered_rect(&session),
        Rect::new(80, 40, 150, 80),
        "moved: its middle stands at 60, its side at 80"
    );
    story(&mut session, "{\"in\":\"selection\",\"do\":\"none\"}");
    story(&mut session, &drag("gradient", [20.0, 57.0], [86.0, 140.0], ""));
    let Content::Gradient(live) = &session.layer().unwrap().content else { panic!("a gradient") };
    assert_eq!((live.params().from, live.params().to), (vec2(20.0, 60.0), vec2(80.0, 140.0)));
    story(&mut session, r#"{"in":"layer","do":"add","kind":"paint"}"#);
    story(&mut session, &drag("select rectangle", [10.0, 10.0], [30.0, 30.0], ""));
    let fill = r##"
{"in":"hand","do":"color","color":"#c02010"}
{"in":"pointer","do":"press","tool":"fill","pen":[20,20],"px_per_pt":1}
{"in":"pointer","do":"release"}
{"in":"selection","do":"none"}"##;
    story(&mut session, fill);
    story(&mut session, &drag("move", [20.0, 20.0], [75.0, 20.0], ""));
    let frame =
        |session: &Session| document(session).frame_box(session.layer().unwrap().id).unwrap();
    assert_eq!((frame(&session).low.x, frame(&session).high.x), (60.0, 80.0), "its right side");
    story(&mut session, &drag("transform", [80.0, 30.0], [100.0, 66.0], ""));
    let map = document(&session).map_of(session.layer().unwrap().id).unwrap();
    let corner = map.plane.to_canvas(frame(&session).high).unwrap();
    assert!(
        corner.distance(vec2(100.0, 60.0)) < 0.01,
        "the corner goes to the middle and the guide: {corner}"
    );
}

#[test]
fn nothing_snaps_once_it_is_put_off_and_lines_with_shift_do_else() {
    let mut session = replay(&format!("{PAPER}{GUIDES}{STROKE}"));
    story(&mut session, &drag("brush", [84.0, 100.0], [84.0, 100.0], "shift"));
    let ends = |session: &Session| {
        let layer = session.layer().unwrap().id;
        let strokes = document(session).strokes(layer);
        strokes.last().unwrap().samples().last().unwrap().at
    };
    // The line itself ends there; the pen went on beyond it.
    let layer = session.layer().unwrap().id;
    let strokes = document(&session).strokes(layer).to_vec();
    assert!(
        strokes.last().unwrap().samples().iter().any(|sample| sample.at == vec2(80.0, 100.0)),
        "{}",
        ends(&session)
    );
    let mut aids = session.tools.aids;
    aids.snaps = false;
    Action::Guide(super::super::actions::GuideAction::Aids { aids }).apply(&mut session).unwrap();
    story(&mut session, &drag("select rectangle", [77.0, 20.0], [150.0, 66.0], ""));
    assert_eq!(covered_rect(&session), Rect::new(77, 20, 150, 66));
}

#[test]
fn guides_are_pulled_moved_undone_and_cleared() {
    let mut session = replay(PAPER);
    let pull = "{\"in\":\"guide\",\"do\":\"pull\",\"vertical\":true,\"pen\":[0,9],\"px_per_pt\":1}
{\"in\":\"pointer\",\"do\":\"drag\",\"pens\":[[33.3,20]]}
{\"in\":\"pointer\",\"do\":\"release\"}";
    story(&mut session, pull);
    story(&mut session, &drag("move", [34.0, 70.0], [50.0, 40.0], ""));
    assert_eq!(document(&session).guides.vertical, [50.0]);
    assert!(session.active().unwrap().is_dirty(), "guides are saved");
    story(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert_eq!(document(&session).guides.vertical, [33.0]);
    story(&mut session, &drag("move", [34.0, 70.0], [-30.0, 40.0], ""));
    assert!(document(&session).guides.is_empty(), "off the canvas it is gone");
    story(&mut session, r#"{"in":"guide","do":"clear"}"#);
    assert_eq!(session.said.pop().as_deref(), Some("There are no guides."));
    story(&mut session, r#"{"in":"guide","do":"assistants","assistants":[]}"#);
    assert_eq!(session.said.pop().as_deref(), Some("There are no assistants."));
}

#[test]
fn a_stroke_goes_along_an_assistant_and_the_next_line_begins_at_its_end() {
    let ruler = r#"
{"in":"guide","do":"assistants","assistants":[{"kind":"line","points":[[10,100],[190,100]]}]}"#;
    let mut session = replay(&format!("{PAPER}{STROKE}{ruler}"));
    story(&mut session, &drag("brush", [30.0, 110.0], [150.0, 93.0], ""));
    let layer = session.layer().unwrap().id;
    let samples = document(&session).strokes(layer)[1].samples().to_vec();
    assert!(samples.iter().all(|sample| (sample.at.y - 100.0).abs() < 1e-3), "{samples:?}");
    assert_eq!(session.active().unwrap().last_end.map(|at| at.round()), Some(vec2(150.0, 100.0)));
    let written: Vec<_> = document(&session).assistants.iter().map(ReplayValue::to_value).collect();
    assert_eq!(
        written,
        [serde_json::json!({ "kind": "line", "points": [[10.0, 100.0], [190.0, 100.0]] })]
    );
}
