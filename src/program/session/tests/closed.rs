//! Strokes on layers that cannot be painted on.

use super::targets::{act, stroke_with, two_layers};
use super::*;

#[test]
fn a_stroke_that_would_not_be_kept_or_seen_names_the_layer_and_what_to_do() {
    let mut session = two_layers();
    act(&mut session, r#"{"in":"layer","do":"group","layer":"2"}"#);
    act(&mut session, r#"{"in":"layer","do":"select","layer":"2.0"}"#);
    let set = |layer: &str, to: &str| {
        format!(r#"{{"in":"layer","do":"set","layer":"{layer}","to":{to},"done":true}}"#)
    };
    let refused = |session: &mut Session, tool: &str| {
        let before = session.active().unwrap().document().clone();
        act(session, &stroke_with(tool));
        assert!(is_same(&before, session.active().unwrap().document()), "{tool} changed something");
        std::mem::take(&mut session.notes).join("|")
    };
    act(&mut session, &set("2", r#"{"do":"visible","on":false}"#));
    for tool in ["brush", "eraser", "fill", "liquify"] {
        let why = refused(&mut session, tool);
        assert!(why.contains("“Paint 2” is in the hidden group “Group”"), "{tool}: {why}");
    }
    act(&mut session, &set("2", r#"{"do":"visible","on":true}"#));
    act(&mut session, &set("2.0", r#"{"do":"visible","on":false}"#));
    act(&mut session, r#"{"in":"layer","do":"paint mask","layer":"2.0","hides":false}"#);
    assert!(refused(&mut session, "brush").contains("“Paint 2” is hidden. Show it"), "on its mask");
    act(&mut session, r#"{"in":"layer","do":"select","layer":"2.0"}"#);
    assert!(refused(&mut session, "brush").contains("“Paint 2” is hidden. Show it"));
    act(&mut session, &set("2.0", r#"{"do":"visible","on":true}"#));
    act(&mut session, &set("2.0", r#"{"do":"lock","lock":"all"}"#));
    for tool in ["brush", "eraser", "fill", "liquify", "move", "transform"] {
        let why = refused(&mut session, tool);
        assert!(why.contains("“Paint 2” is locked. Unlock it"), "{tool}: {why}");
    }
    act(&mut session, &set("2.0", r#"{"do":"lock","lock":"none"}"#));
    act(&mut session, r#"{"in":"layer","do":"solo","layer":"1"}"#);
    assert!(
        refused(&mut session, "brush")
            .contains("“Paint 2” is hidden, since “Paint” is shown alone")
    );
    act(&mut session, r#"{"in":"layer","do":"solo","layer":"2"}"#);
    act(&mut session, &stroke_with("brush"));
    assert!(
        session.notes.is_empty()
            && session.active().unwrap().history.undo_label() == Some("Brush stroke")
    );
}
