//! The transform tool on a shape, written as the lines of a replay: paint that slides over it, and
//! paint that moves with it.

use super::*;

/// A stroke over a ball.
fn ball() -> Session {
    replay(&format!(
        r#"{PAPER}{}{STROKE}"#,
        "\n{\"in\":\"part\",\"do\":\"add\",\"kind\":\"sphere\"}"
    ))
}

fn story(session: &mut Session, lines: &str) {
    session.replay(Path::new("story"), lines).unwrap_or_else(|e| panic!("{e}"));
}

fn carry(session: &mut Session, what: &str, from: [i32; 2], to: [i32; 2]) {
    let lines = format!(
        r#"{{"in":"hand","do":"carried","carried":"{what}"}}
        {{"in":"pointer","do":"press","tool":"transform","pen":{from:?},"px_per_pt":0.5}}
        {{"in":"pointer","do":"drag","pens":[{to:?}]}}
        {{"in":"pointer","do":"release"}}"#
    );
    story(session, &lines);
}

fn picture(session: &Session) -> Vec<u8> {
    let document = session.active().unwrap().drawn_document();
    flatten(&document, &Progress::default()).unwrap().to_straight_rgba(document.size.rect())
}

fn surface(session: &Session) -> Arc<crate::surface::Surface> {
    session.active().unwrap().document().surface.clone().unwrap()
}

#[test]
fn paint_slides_over_a_shape_that_stays() {
    let mut session = ball();
    let before = surface(&session);
    carry(&mut session, "paint", [60, 71], [65, 81]);
    assert!(Arc::ptr_eq(&before, &surface(&session)));
    assert!(session.layer().unwrap().transform.is_some());
}

#[test]
fn the_shape_is_moved_with_its_paint_and_comes_back_by_undo() {
    let mut session = ball();
    let (old, before) = (surface(&session), picture(&session));
    let at = |pixels: &[u8], x: usize, y: usize| pixels[(y * 200 + x) * 4..][..4].to_vec();
    carry(&mut session, "shape", [90, 60], [112, 69]);
    let new = surface(&session);
    assert_eq!(session.active().unwrap().history.undo_label(), Some("Move shape"));
    let after = picture(&session);
    for (x, y) in [(90, 60), (100, 70), (110, 90)] {
        assert_eq!(old.normal(x, y), new.normal(x + 22, y + 9));
        assert_eq!(at(&before, x, y), at(&after, x + 22, y + 9));
    }
    assert_ne!(after, before);
    story(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert_eq!(picture(&session), before);
    story(&mut session, r#"{"in":"edit","do":"redo"}"#);
    assert_eq!(picture(&session), after);
}

#[test]
fn the_shape_is_turned_scaled_and_mirrored_by_numbers_and_a_perspective_is_refused() {
    let mut session = ball();
    let before = picture(&session);
    let by = |by: &str| format!(r#"{{"in":"part","do":"take along","by":{by},"done":true}}"#);
    story(&mut session, &by("[0,1,-1,0,175,-25]"));
    let quarter = picture(&session);
    assert_ne!(quarter, before);
    story(&mut session, &by("[0,-1,1,0,25,175]"));
    assert_eq!(picture(&session), before, "a quarter and back");
    story(&mut session, &by("[0.5,0,0,0.5,50,37.5]"));
    let half = surface(&session);
    assert_eq!(
        (half.coverage(100, 75), half.coverage(100, 40)),
        (255, 0),
        "half as large about the middle"
    );
    let steps = session.active().unwrap().history.past_names().count();
    let frame =
        session.active().unwrap().gizmo(crate::tools::gizmo::TransformTarget::Shape).unwrap();
    let corner = frame.corners[2];
    let keys = r#"{"shift":false,"ctrl":true,"alt":false}"#;
    let pen = format!("[{},{},1,0,0,0,{keys}]", corner.x, corner.y);
    let line = format!(
        r#"{{"in":"hand","do":"carried","carried":"shape"}}
        {{"in":"pointer","do":"press","tool":"transform","pen":{pen},"px_per_pt":0.5}}"#
    );
    story(&mut session, &line);
    assert!(
        session.notes.last().is_some_and(|why| why.contains("perspective")),
        "{:?}",
        session.notes
    );
    assert_eq!(session.active().unwrap().history.past_names().count(), steps);
    story(&mut session, &by("[1,0,0,1,9000,0]"));
    assert!(
        session.notes.last().is_some_and(|why| why.contains("No part of the shape")),
        "{:?}",
        session.notes
    );
}
