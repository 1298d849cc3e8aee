//! Undo and redo put the user back where the step was made: the layers that were selected, and mask
//! or paint.

use super::*;

/// A paper with two paint layers; the lower one, of the name `Paint`, is selected.
pub(super) fn two_layers() -> Session {
    replay(&format!(
        r#"{PAPER}
        {{"in":"layer","do":"add","kind":"paint"}}
        {{"in":"layer","do":"add","kind":"paint"}}
        {{"in":"layer","do":"select","layer":"1"}}"#
    ))
}

pub(super) fn act(session: &mut Session, lines: &str) {
    session.replay(Path::new("story"), lines).unwrap();
}

fn undo(session: &mut Session) {
    act(session, r#"{"in":"edit","do":"undo"}"#);
}

fn redo(session: &mut Session) {
    act(session, r#"{"in":"edit","do":"redo"}"#);
}

pub(super) fn stroke_with(tool: &str) -> String {
    format!(
        r#"{{"in":"pointer","do":"press","tool":"{tool}","pen":[20,30],"px_per_pt":1}}
        {{"in":"pointer","do":"drag","pens":[[60,44],[90,60]]}}
        {{"in":"pointer","do":"release"}}"#
    )
}

/// The names of the selected layers, the active one last.
fn selected_names(session: &Session) -> Vec<String> {
    let open = session.active().unwrap();
    let mut ids = open.selected_layers();
    ids.sort_by_key(|id| open.active_layer == Some(*id));
    ids.iter().map(|id| open.document().layer(*id).unwrap().name.clone()).collect()
}

#[test]
fn after_an_undone_gradient_the_next_stroke_goes_where_the_last_one_would_have() {
    let mut session = two_layers();
    act(&mut session, r#"{"in":"hand","do":"live gradients","on":true}"#);
    for step in [&stroke_with("gradient"), r#"{"in":"layer","do":"add","kind":"group"}"#] {
        act(&mut session, step);
        let made = selected_names(&session);
        assert_ne!(made, ["Paint"], "the new layer is selected");
        undo(&mut session);
        assert_eq!(selected_names(&session), ["Paint"]);
        redo(&mut session);
        assert_eq!(selected_names(&session), made);
        undo(&mut session);
    }
    let before = names(&session);
    act(&mut session, &stroke_with("brush"));
    assert_eq!(
        names(&session),
        before,
        "the stroke is on the layer that was selected, not on a new one"
    );
}

#[test]
fn redo_selects_what_was_selected_right_after_the_step_and_not_what_was_selected_later() {
    let mut session = two_layers();
    act(&mut session, &stroke_with("brush"));
    act(&mut session, r#"{"in":"layer","do":"select","layer":"2"}"#);
    undo(&mut session);
    assert_eq!(selected_names(&session), ["Paint"]);
    act(&mut session, r#"{"in":"layer","do":"select","layer":"0"}"#);
    redo(&mut session);
    assert_eq!(selected_names(&session), ["Paint"]);
}

#[test]
fn several_deleted_layers_come_back_selected_and_a_click_in_the_history_selects_too() {
    let mut session = two_layers();
    act(
        &mut session,
        r#"{"in":"layer","do":"choose","layer":["1","2"],"active_layer":"1","anchor":"2"}"#,
    );
    act(&mut session, r#"{"in":"layer","do":"delete","layer":["1","2"]}"#);
    act(&mut session, &stroke_with("brush"));
    assert_eq!(selected_names(&session), ["Strokes"]);
    act(&mut session, r#"{"in":"edit","do":"walk","steps":-2}"#);
    assert_eq!(selected_names(&session), ["Paint 2", "Paint"]);
    act(&mut session, r#"{"in":"edit","do":"walk","steps":1}"#);
    assert_eq!(selected_names(&session), ["Background"]);
}

#[test]
fn a_stroke_on_a_mask_is_undone_on_the_mask_and_the_tool_stays_in_hand() {
    let mut session = two_layers();
    let on_mask = |session: &Session| session.active().unwrap().on_mask;
    act(&mut session, r#"{"in":"layer","do":"paint mask","layer":"1","hides":false}"#);
    act(&mut session, &stroke_with("brush"));
    act(&mut session, r#"{"in":"layer","do":"on mask","layer":"1","on":false}"#);
    act(&mut session, &stroke_with("brush"));
    act(&mut session, r#"{"in":"hand","do":"tool","tool":"eraser"}"#);
    undo(&mut session);
    assert!(!on_mask(&session));
    undo(&mut session);
    assert!(on_mask(&session), "the stroke was painted on the mask");
    redo(&mut session);
    redo(&mut session);
    assert!(!on_mask(&session));
    act(&mut session, r#"{"in":"edit","do":"walk","steps":-3}"#);
    assert!(!on_mask(&session), "there is no mask");
    assert_eq!(session.tool, ToolKind::Eraser);
}

#[test]
fn selected_strokes_are_those_that_were_selected_before_they_were_ordered() {
    let mut session = replay(&format!(
        r#"{PAPER}{STROKE}
        {{"in":"stroke","do":"duplicate","layer":"1","strokes":[0]}}
        {{"in":"stroke","do":"order","layer":"1","stroke":1,"to":0}}"#
    ));
    let strokes = |session: &Session| session.active().unwrap().selected_strokes();
    assert_eq!(strokes(&session), [0]);
    undo(&mut session);
    assert_eq!(strokes(&session), [1], "the same stroke, where it lies now");
    redo(&mut session);
    assert_eq!(strokes(&session), [0]);
}

#[test]
fn the_history_says_which_layer_a_step_was_done_to() {
    let mut session = two_layers();
    act(&mut session, &stroke_with("brush"));
    act(
        &mut session,
        r#"{"in":"layer","do":"set","layer":"1","to":{"do":"opacity","to":0.5},"done":true}"#,
    );
    act(&mut session, r#"{"in":"layer","do":"group","layer":["1","2"]}"#);
    act(&mut session, r#"{"in":"layer","do":"select","layer":"1.0"}"#);
    act(&mut session, &stroke_with("brush"));
    act(&mut session, r#"{"in":"layer","do":"delete","layer":"1.1"}"#);
    act(&mut session, r#"{"in":"selection","do":"all"}"#);
    let said: Vec<String> =
        session.active().unwrap().history.past_labels().map(labels::sentence).collect();
    let expected = [
        "Add layer “Paint”",
        "Add layer “Paint 2”",
        "Brush stroke on “Paint”",
        "Opacity on “Paint”",
        "Group layers “Group”",
        "Brush stroke on “Paint”",
        "Delete layer “Paint 2”",
        "Select all",
    ];
    assert_eq!(said, expected);
}
