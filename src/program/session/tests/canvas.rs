//! The canvas cropped, resized, turned and mirrored, written as the lines of a replay.

use super::*;
use crate::math::Size;

/// A square of columns 60 to 120 and rows 50 to 100.
const SQUARE: &str = r#"
{"in":"pointer","do":"press","tool":"select rectangle","pen":[60,50],"px_per_pt":1}
{"in":"pointer","do":"drag","pens":[[90,70],[120,100]]}
{"in":"pointer","do":"release"}"#;

fn story(session: &mut Session, lines: &str) {
    session.replay(Path::new("story"), lines).unwrap_or_else(|e| panic!("{e}"));
}

fn size(session: &Session) -> Size {
    session.active().unwrap().document().size
}

fn is_red(session: &Session, x: i32, y: i32) -> bool {
    pixel(session, x, y) == [0xc0, 0x20, 0x10, 255]
}

#[test]
fn a_crop_to_the_selection_is_one_step_that_undo_takes_back_whole() {
    let mut session = replay(&format!("{PAPER}{STROKE}{SQUARE}"));
    story(&mut session, r#"{"in":"canvas","do":"crop to selection"}"#);
    assert_eq!(size(&session), Size::new(60, 50));
    assert!(is_red(&session, 30, 21), "the stroke is where it was on the picture");
    let strokes = session.active().unwrap().document().layer_named("Strokes").unwrap().clone();
    assert!(
        matches!(&strokes.content, Content::Strokes(_)) && strokes.transform.is_none(),
        "it stays live"
    );
    assert_eq!(session.active().unwrap().history.undo_label(), Some("Crop to selection"));
    story(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert_eq!(size(&session), Size::new(200, 150));
    assert!(
        is_red(&session, 100, 70)
            && session.active().unwrap().document().active_coverage().is_some()
    );
    story(&mut session, r#"{"in":"edit","do":"redo"}"#);
    story(
        &mut session,
        r#"{"in":"canvas","do":"size","width":200,"height":150,"anchor":"top-left"}"#,
    );
    assert!(is_red(&session, 110, 22), "what lay beyond the border was kept");
}

#[test]
fn the_crop_tool_s_frame_is_dragged_beyond_the_canvas_and_applied_or_given_up() {
    let drag = "
{\"in\":\"hand\",\"do\":\"tool\",\"tool\":\"crop\"}
{\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"crop\",\"pen\":[40,30],\"px_per_pt\":1}
{\"in\":\"pointer\",\"do\":\"drag\",\"pens\":[[260,200]]}
{\"in\":\"pointer\",\"do\":\"release\"}";
    let mut session = replay(&format!("{PAPER}{STROKE}{drag}"));
    let frame = session.tools.crop.area.unwrap();
    assert_eq!((frame.x0, frame.y0, frame.x1, frame.y1), (40, 30, 260, 200));
    assert_eq!(
        session.active().unwrap().history.undo_label(),
        Some("Brush stroke"),
        "a frame is no step"
    );
    let click = "
{\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"crop\",\"pen\":[10,10],\"px_per_pt\":1}
{\"in\":\"pointer\",\"do\":\"release\"}";
    story(&mut session, click);
    assert_eq!(session.tools.crop.area, Some(frame), "a click beside it does nothing");
    story(&mut session, r#"{"in":"canvas","do":"aspect","aspect":"1:1"}"#);
    assert_eq!(session.tools.crop.area.map(|area| (area.width(), area.height())), Some((220, 220)));
    story(&mut session, r#"{"in":"canvas","do":"frame","frame":null}"#);
    assert_eq!((session.tools.crop.area, size(&session)), (None, Size::new(200, 150)));
    story(&mut session, r#"{"in":"canvas","do":"crop","to":{"x0":40,"y0":30,"x1":260,"y1":200}}"#);
    assert_eq!(size(&session), Size::new(220, 170));
    assert!(is_red(&session, 60, 40) && pixel(&session, 215, 165) == [255; 4], "the fill goes on");
}

#[test]
fn turns_and_mirrors_take_the_picture_along() {
    let mut session = replay(&format!("{PAPER}{STROKE}"));
    story(&mut session, r#"{"in":"canvas","do":"turn","degrees":90}"#);
    assert_eq!(size(&session), Size::new(150, 200));
    assert!(is_red(&session, 72, 140), "what was on the left is at the bottom");
    story(&mut session, r#"{"in":"canvas","do":"mirror","mirror":"up-down"}"#);
    assert!(is_red(&session, 72, 60));
    story(&mut session, r#"{"in":"canvas","do":"turn","degrees":30}"#);
    assert_eq!(size(&session), Size::new(230, 250));
    story(
        &mut session,
        r#"{"in":"canvas","do":"scale","width":115,"height":125,"filter":"sharp"}"#,
    );
    assert_eq!(size(&session), Size::new(115, 125));
    (0..4).for_each(|_| story(&mut session, r#"{"in":"edit","do":"undo"}"#));
    assert!(size(&session) == Size::new(200, 150) && is_red(&session, 100, 71));
}

#[test]
fn what_cannot_be_done_says_why() {
    let mut session = replay(PAPER);
    for (line, why) in [
        (r#"{"in":"canvas","do":"crop to selection"}"#, "Nothing is selected"),
        (r#"{"in":"canvas","do":"trim"}"#, "nothing to trim"),
        (r#"{"in":"canvas","do":"turn","degrees":360}"#, "stay the same"),
        (r#"{"in":"canvas","do":"size","width":0,"height":5,"anchor":"center"}"#, "0"),
        (
            r#"{"in":"canvas","do":"scale","width":200,"height":150,"filter":"smooth"}"#,
            "already has that size",
        ),
        (
            r#"{"in":"canvas","do":"size","width":4000000000,"height":4000000000,"anchor":"top"}"#,
            "4000000000",
        ),
        (
            r#"{"in":"canvas","do":"crop","to":{"x0":-2147483648,"y0":-2147483648,"x1":2147483647,"y1":2147483647}}"#,
            "2000000",
        ),
        (r#"{"in":"canvas","do":"crop","to":{"x0":9,"y0":9,"x1":9,"y1":20}}"#, "no pixel"),
    ] {
        session.said.clear();
        story(&mut session, line);
        let said = session.said.join(" ");
        assert!(said.contains(why), "{line}: {said}");
        assert_eq!(session.active().unwrap().history.undo_label(), None, "{line}");
    }
}
