//! Several layers at once, written as the lines of a replay: each edit is one step.

use super::*;

/// Four fills above the paper, the topmost one alone in a group.
fn five() -> Session {
    replay(&format!(
        r#"{PAPER}
        {{"in":"layer","do":"add","kind":"fill"}}
        {{"in":"layer","do":"add","kind":"gradient"}}
        {{"in":"layer","do":"add","kind":"paint"}}
        {{"in":"layer","do":"add","kind":"strokes"}}
        {{"in":"layer","do":"group","layer":"4"}}
        {{"in":"layer","do":"choose","layer":["1","3"],"active_layer":"3","anchor":null}}"#
    ))
}

fn story(session: &mut Session, lines: &str) {
    session.replay(Path::new("story"), lines).unwrap_or_else(|e| panic!("{e}"));
}

fn selected_names(session: &Session) -> Vec<String> {
    let open = session.active().unwrap();
    open.selected_layers()
        .iter()
        .map(|id| open.document().layer(*id).unwrap().name.clone())
        .collect()
}

#[test]
fn scripts_name_the_active_layer_as_before_too() {
    let mut session = five();
    let line = r#"{"in":"layer","do":"choose","layer":["1","2"],"primary":"1"}"#;
    story(&mut session, line);
    let open = session.active().unwrap();
    assert_eq!(open.active_layer, Some(open.document().layers[1].id));
}

fn last_edit(session: &Session) -> &str {
    session.active().unwrap().history.undo_label().unwrap_or_default()
}

fn steps(session: &Session) -> usize {
    session.active().unwrap().history.past_names().count()
}

#[test]
fn layers_are_selected_together_and_one_of_them_is_painted_on() {
    let mut session = five();
    assert_eq!(
        (selected_names(&session), session.layer().unwrap().name.as_str()),
        (vec!["Fill".into(), "Paint".into()], "Paint")
    );
    assert_eq!(session.layer_paths().to_value(), serde_json::json!(["1", "3"]));
    story(&mut session, r#"{"in":"layer","do":"select","layer":"1"}"#);
    assert_eq!(selected_names(&session), ["Fill"]);
}

#[test]
fn what_is_done_to_several_layers_is_one_step() {
    let mut session = five();
    let before = steps(&session);
    let set = |to: &str| {
        format!(r#"{{"in":"layer","do":"set","layer":["1","3"],"to":{to},"done":true}}"#)
    };
    for to in [
        r#"{"do":"opacity","to":0.25}"#,
        r#"{"do":"blend","mode":"multiply"}"#,
        r#"{"do":"visible","on":false}"#,
        r#"{"do":"label","label":"purple"}"#,
    ] {
        story(&mut session, &set(to));
    }
    assert_eq!(steps(&session), before + 4);
    let document = session.active().unwrap().document();
    for layer in [&document.layers[1], &document.layers[3]] {
        assert_eq!((layer.opacity, layer.blend, layer.visible), (0.25, BlendMode::Multiply, false));
        assert_eq!(layer.label, crate::document::LayerLabel::Purple);
    }
    assert_eq!(document.layers[2].opacity, 1.0);
    story(&mut session, r#"{"in":"edit","do":"walk","steps":-4}"#);
    assert_eq!(session.active().unwrap().document().layers[3].opacity, 1.0);
}

#[test]
fn several_layers_are_grouped_copied_moved_dissolved_and_deleted() {
    let mut session = five();
    story(&mut session, r#"{"in":"layer","do":"duplicate","layer":["1","3"]}"#);
    assert_eq!(names(&session)[3..6], ["Paint", "Fill copy", "Paint copy"]);
    assert_eq!(
        (selected_names(&session), last_edit(&session)),
        (vec!["Fill copy".into(), "Paint copy".into()], "Duplicate layers")
    );
    story(&mut session, r#"{"in":"layer","do":"group","layer":["1","4","5"]}"#);
    assert_eq!(
        names(&session)[1..7],
        ["Gradient", "Paint", "Fill", "Fill copy", "Paint copy", "Group 2"]
    );
    story(&mut session, r#"{"in":"layer","do":"move","layer":["1","2"],"group":"3","index":0}"#);
    assert_eq!(names(&session)[1..4], ["Gradient", "Paint", "Fill"]);
    assert_eq!(
        (selected_names(&session), last_edit(&session)),
        (vec!["Gradient".into(), "Paint".into()], "Move layers")
    );
    story(&mut session, r#"{"in":"layer","do":"ungroup","layer":["1","2"]}"#);
    assert_eq!(
        names(&session),
        ["Background", "Gradient", "Paint", "Fill", "Fill copy", "Paint copy", "Strokes"]
    );
    story(&mut session, r#"{"in":"layer","do":"delete","layer":["1","3","6"]}"#);
    assert_eq!(
        (names(&session).join(" "), last_edit(&session)),
        ("Background Paint Fill copy Paint copy".into(), "Delete layers")
    );
    story(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert_eq!(names(&session).len(), 7);
}

#[test]
fn several_layers_merge_into_one_that_looks_the_same() {
    let mut session = five();
    story(&mut session, STROKE);
    let look =
        |session: &Session| [(100, 70), (10, 10), (180, 140)].map(|(x, y)| pixel(session, x, y));
    let (before, count) = (look(&session), steps(&session));
    story(&mut session, r#"{"in":"layer","do":"merge down","layer":["1","2","3"]}"#);
    assert_eq!(
        (names(&session)[1].as_str(), last_edit(&session), steps(&session)),
        ("Fill", "Merge layers", count + 1)
    );
    assert!(matches!(session.layer().unwrap().content, Content::Pixels(_)));
    for (a, b) in look(&session).into_iter().zip(before) {
        assert!(a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 1), "{a:?}, not {b:?}");
    }
}

#[test]
fn several_layers_are_moved_by_the_tool_and_cut_and_pasted_together() {
    let mut session = replay(&format!(
        r#"{PAPER}
        {{"in":"layer","do":"add","kind":"paint"}}{STROKE}
        {{"in":"layer","do":"add","kind":"strokes"}}{STROKE}
        {{"in":"layer","do":"choose","layer":["1","2"],"active_layer":"2","anchor":null}}"#
    ));
    let red = |session: &Session, y: i32| pixel(session, 100, y) == [0xc0, 0x20, 0x10, 255];
    let drag =
        "{\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"move\",\"pen\":[100,70],\"px_per_pt\":1}
{\"in\":\"pointer\",\"do\":\"drag\",\"pens\":[[100,110]]}
{\"in\":\"pointer\",\"do\":\"release\"}";
    story(&mut session, drag);
    assert_eq!(
        (last_edit(&session), red(&session, 70), red(&session, 110)),
        ("Move layers", false, true)
    );
    assert_eq!(selected_names(&session), ["Paint", "Strokes"], "both stay selected");
    story(&mut session, r#"{"in":"clipboard","do":"cut"}"#);
    assert!(!red(&session, 110));
    story(&mut session, r#"{"in":"clipboard","do":"paste"}"#);
    assert_eq!(
        (red(&session, 110), selected_names(&session)),
        (true, vec!["Paint 2".into(), "Strokes 2".into()])
    );
    let open = session.active().unwrap();
    let kinds = open
        .selected_layers()
        .into_iter()
        .map(|id| open.document().layer(id).unwrap().content.kind_name());
    assert_eq!(kinds.collect::<Vec<_>>(), ["pixels", "strokes"]);
    let turn = r#"{"in":"layer","do":"turn","layer":["3","4"],"degrees":90}"#;
    story(&mut session, turn);
    assert!(
        (0..150).filter(|y| red(&session, *y)).count() > 60,
        "a line that stood level stands upright"
    );
}

#[test]
fn where_there_is_nothing_to_act_on_that_is_said() {
    let mut session = five();
    let mut said = |line: &str| {
        let before = steps(&session);
        story(&mut session, line);
        assert_eq!(steps(&session), before, "{line}");
        session.said.pop().unwrap_or_default()
    };
    assert_eq!(
        said(r#"{"in":"layer","do":"ungroup","layer":["1","2"]}"#),
        "There is no group among the selected layers."
    );
    assert_eq!(
        said(r#"{"in":"layer","do":"merge down","layer":"0"}"#),
        "There is no layer beneath to merge with."
    );
    assert_eq!(said(r#"{"in":"layer","do":"delete","layer":[]}"#), "Select a layer first.");
    assert_eq!(said(r#"{"in":"layer","do":"group","layer":["9"]}"#), "Select a layer first.");
}
