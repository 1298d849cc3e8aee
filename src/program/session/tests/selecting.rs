//! Selections, written as the lines of a replay: what can be done with them, and what is said if it
//! cannot.

use super::*;
use crate::raster::CoverageGrid;

/// A square of columns 60 to 120 and rows 50 to 100.
const SQUARE: &str = r#"
{"in":"pointer","do":"press","tool":"select rectangle","pen":[60,50],"px_per_pt":1}
{"in":"pointer","do":"drag","pens":[[90,70],[120,100]]}
{"in":"pointer","do":"release"}"#;

fn story(session: &mut Session, lines: &str) {
    session.replay(Path::new("story"), lines).unwrap_or_else(|e| panic!("{e}"));
}

fn area(session: &Session) -> f64 {
    session.active().unwrap().document().active_coverage().map_or(0.0, CoverageGrid::area_px)
}

fn red(session: &Session, x: i32, y: i32) -> bool {
    pixel(session, x, y) == [0xc0, 0x20, 0x10, 255]
}

#[test]
fn a_stroke_keeps_to_the_selection_and_undo_gives_both_back() {
    let mut session = replay(&format!("{PAPER}{SQUARE}{STROKE}"));
    assert_eq!([50, 62, 118, 125].map(|x| red(&session, x, 70)), [false, true, true, false]);
    let steps: Vec<_> = session.active().unwrap().history.past_names().collect();
    assert_eq!(steps, ["Select", "Brush stroke"]);
    story(&mut session, r#"{"in":"selection","do":"none"}"#);
    assert!(!red(&session, 50, 70), "the stroke keeps its own selection");
    story(&mut session, "{\"in\":\"edit\",\"do\":\"undo\"}\n{\"in\":\"edit\",\"do\":\"undo\"}");
    assert_eq!((area(&session), red(&session, 90, 70)), (3000.0, false));
    story(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert_eq!(area(&session), 0.0);
}

#[test]
fn fills_gradients_erasers_and_retouching_keep_to_the_selection() {
    let fill = r#"
{"in":"layer","do":"add","kind":"paint"}
{"in":"pointer","do":"press","tool":"fill","pen":[90,70],"px_per_pt":1}
{"in":"pointer","do":"release"}"#;
    let mut session = replay(&format!(
        "{PAPER}{SQUARE}\n{{\"in\":\"hand\",\"do\":\"color\",\"color\":\"#c02010\"}}{fill}"
    ));
    assert_eq!([59, 60, 119, 120].map(|x| red(&session, x, 70)), [false, true, true, false]);
    let erase = "{\"in\":\"selection\",\"do\":\"change\",\"change\":\"shrink\",\"px\":10}
{\"in\":\"hand\",\"do\":\"preset\",\"name\":\"hard-round\"}
{\"in\":\"hand\",\"do\":\"size\",\"to\":200}
{\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"eraser\",\"pen\":[90,75],\"px_per_pt\":1}
{\"in\":\"pointer\",\"do\":\"release\"}";
    story(&mut session, erase);
    assert_eq!([65, 75, 105, 115].map(|x| red(&session, x, 75)), [true, false, false, true]);
    let gradient = "{\"in\":\"hand\",\"do\":\"live gradients\",\"on\":true}
{\"in\":\"hand\",\"do\":\"second color\",\"color\":\"#c02010\"}
{\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"gradient\",\"pen\":[0,75],\"px_per_pt\":1}
{\"in\":\"pointer\",\"do\":\"drag\",\"pens\":[[40,75]]}
{\"in\":\"pointer\",\"do\":\"release\"}";
    story(&mut session, gradient);
    assert_eq!([20, 75, 105, 150].map(|x| red(&session, x, 75)), [false, true, true, false]);
    assert!(session.layer().unwrap().mask.is_some(), "a gradient layer gets a mask");
    let blur = "{\"in\":\"layer\",\"do\":\"select\",\"layer\":\"1\"}
{\"in\":\"hand\",\"do\":\"mark\",\"mark\":{\"kind\":\"blur\",\"width\":0.5}}
{\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"brush\",\"pen\":[70,75],\"px_per_pt\":1}
{\"in\":\"pointer\",\"do\":\"drag\",\"pens\":[[70,90]]}
{\"in\":\"pointer\",\"do\":\"release\"}";
    let before = session.active().unwrap().document().clone();
    story(&mut session, blur);
    let paint = |document: &Document, x: i32| match &document.layers[1].content {
        Content::Pixels(pixels) => pixels.tiles.pixel(x, 80),
        _ => panic!("paint"),
    };
    let after = session.active().unwrap().document();
    assert_eq!(paint(after, 66), paint(&before, 66), "beside the selection nothing is blurred");
    assert_ne!(paint(after, 71), paint(&before, 71));
}

#[test]
fn cutting_and_pasting_moves_paint_and_keeps_strokes_strokes() {
    let mut session = replay(&format!("{PAPER}{STROKE}{SQUARE}"));
    story(&mut session, r#"{"in":"clipboard","do":"cut"}"#);
    assert_eq!([40, 90].map(|x| red(&session, x, 70)), [true, false]);
    story(&mut session, r#"{"in":"clipboard","do":"paste"}"#);
    assert_eq!([40, 62, 90, 150].map(|x| red(&session, x, 70)), [true; 4]);
    let Content::Strokes(live) = &session.layer().unwrap().content else {
        panic!("a stroke layer")
    };
    assert_eq!(live.params().strokes.len(), 1);
    story(&mut session, r#"{"in":"clipboard","do":"layer via","cut":false}"#);
    assert_eq!(names(&session), ["Background", "Strokes", "Strokes 2", "Strokes 2 copy"]);
    story(
        &mut session,
        "{\"in\":\"clipboard\",\"do\":\"copy\",\"merged\":true}\n{\"in\":\"clipboard\",\"do\":\"paste new\"}",
    );
    assert_eq!(session.shown_document().unwrap().size, crate::math::Size::new(60, 50));
    assert_eq!(session.open_documents.len(), 2);
}

#[test]
fn what_cannot_be_done_says_why() {
    let mut session = replay(PAPER);
    let mut said = |line: &str| {
        story(&mut session, line);
        session.said.pop().unwrap_or_default()
    };
    for line in ["none", "invert", "again"] {
        let told = said(&format!(r#"{{"in":"selection","do":"{line}"}}"#));
        assert!(told.contains("othing"), "{line}: {told}");
    }
    assert_eq!(
        said(r#"{"in":"selection","do":"change","change":"grow","px":3}"#),
        "Nothing is selected."
    );
    assert_eq!(said(r#"{"in":"clipboard","do":"paste"}"#), "Nothing has been copied yet.");
    let region = r#"{"kind":"direction","at":[9,9],"tolerance":15,"softness":0,"contiguous":true}"#;
    let line = format!(r#"{{"in":"selection","do":"region","region":{region},"how":"replace"}}"#);
    assert_eq!(said(&line), "There is no surface to select by.");
    story(&mut session, &format!("{}{SQUARE}", r#"{"in":"layer","do":"add","kind":"paint"}"#));
    let mut said = |line: &str| {
        story(&mut session, line);
        session.said.pop().unwrap_or_default()
    };
    assert_eq!(
        said(r#"{"in":"clipboard","do":"copy","merged":false}"#),
        "The layer has nothing where you selected."
    );
    assert!(
        said(r#"{"in":"selection","do":"layer","layer":"1","how":"replace"}"#).contains("empty")
    );
    assert!(
        said(r#"{"in":"selection","do":"mask","layer":"1","how":"replace"}"#).contains("no mask")
    );
    assert!(
        said(r#"{"in":"selection","do":"change","change":"shrink","px":90}"#).contains("anymore")
    );
}

#[test]
fn selections_are_kept_taken_inverted_and_let_go_of() {
    let mut session = replay(&format!("{PAPER}{SQUARE}"));
    story(
        &mut session,
        "{\"in\":\"selection\",\"do\":\"keep\",\"name\":\"Eye\"}\n{\"in\":\"selection\",\"do\":\"invert\"}",
    );
    assert_eq!(area(&session), 200.0 * 150.0 - 3000.0);
    story(
        &mut session,
        "{\"in\":\"selection\",\"do\":\"none\"}\n{\"in\":\"selection\",\"do\":\"again\"}",
    );
    assert_eq!(area(&session), 27_000.0);
    story(&mut session, r#"{"in":"selection","do":"take","name":"Eye","how":"intersect"}"#);
    assert_eq!((area(&session), session.said.pop().is_some()), (0.0, true));
    story(&mut session, r#"{"in":"selection","do":"take","name":"Eye","how":"replace"}"#);
    assert_eq!(area(&session), 3000.0);
    story(&mut session, r#"{"in":"selection","do":"to mask","layer":"0"}"#);
    assert_eq!((pixel(&session, 90, 70), pixel(&session, 10, 10)[3]), ([255; 4], 0));
    story(&mut session, r#"{"in":"selection","do":"none"}"#);
    story(&mut session, r#"{"in":"selection","do":"mask","layer":"0","how":"replace"}"#);
    assert_eq!(area(&session), 3000.0);
}

#[test]
fn the_brush_paints_on_the_selection_under_a_quick_mask() {
    let mut session = replay(&format!("{PAPER}{SQUARE}"));
    let paint = "{\"in\":\"selection\",\"do\":\"quick mask\",\"on\":true}
{\"in\":\"hand\",\"do\":\"preset\",\"name\":\"hard-round\"}
{\"in\":\"hand\",\"do\":\"size\",\"to\":20}
{\"in\":\"hand\",\"do\":\"color\",\"color\":\"#ffffff\"}
{\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"brush\",\"pen\":[20,20],\"px_per_pt\":1}
{\"in\":\"pointer\",\"do\":\"release\"}";
    story(&mut session, paint);
    assert_eq!(names(&session), ["Background"], "nothing was painted on the picture");
    let grown = area(&session) - 3000.0;
    assert!((grown - 314.0).abs() < 15.0, "{grown}");
    let shown = |x, y| {
        flatten(&session.active().unwrap().drawn_document(), &Progress::default())
            .unwrap()
            .pixel(x, y)
    };
    assert_eq!(shown(20, 20), [255; 4]);
    assert!(shown(150, 20)[1] < 200, "what is not selected is seen under red");
}
