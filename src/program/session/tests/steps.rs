//! Any sequence of edits, undone to the start and redone to the end: every document is the same as
//! before.

use super::*;
use proptest::prelude::*;

/// One thing a user does, as a line of a replay. Layers are named by positions that need not exist.
fn edit() -> impl Strategy<Value = String> {
    let layer = || {
        let nested = (0..3usize, 0..2usize).prop_map(|(i, j)| format!("{i}.{j}"));
        prop_oneof![3 => (0..4usize).prop_map(|i| i.to_string()), 1 => nested]
    };
    let kinds = prop::sample::select(vec!["paint", "strokes", "fill", "gradient", "group"]);
    let plain = prop::sample::select(vec![
        "delete",
        "duplicate",
        "group",
        "ungroup",
        "merge down",
        "bake",
        "clear",
        "select",
    ]);
    let blend = prop::sample::select(BlendMode::ALL.map(|row| row.1).to_vec());
    prop_oneof![
        3 => kinds.prop_map(|kind| format!(r#"{{"in":"layer","do":"add","kind":"{kind}"}}"#)),
        4 => (plain, layer()).prop_map(|(what, layer)| format!(r#"{{"in":"layer","do":"{what}","layer":"{layer}"}}"#)),
        1 => (layer(), -2..3i32).prop_map(|(layer, by)| {
            format!(r#"{{"in":"layer","do":"nudge","layer":"{layer}","by":{by}}}"#)
        }),
        2 => (layer(), 0..=10u8).prop_map(|(layer, n)| {
            let to = f32::from(n) / 10.0;
            format!(r#"{{"in":"layer","do":"set","layer":"{layer}","to":{{"do":"opacity","to":{to}}},"done":true}}"#)
        }),
        1 => (layer(), blend).prop_map(|(layer, mode)| {
            let to = format!(r#"{{"do":"blend","mode":"{mode}"}}"#);
            format!(r#"{{"in":"layer","do":"set","layer":"{layer}","to":{to},"done":true}}"#)
        }),
        3 => [0..60i32, 0..40, 0..60, 0..40].prop_map(|[x, y, u, v]| format!(
            "{{\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"brush\",\"pen\":[{x},{y}],\"px_per_pt\":1}}\n\
             {{\"in\":\"pointer\",\"do\":\"drag\",\"pens\":[[{u},{v}]]}}\n{{\"in\":\"pointer\",\"do\":\"release\"}}"
        )),
        1 => (layer(), 2..5usize).prop_map(|(layer, side)| {
            format!(r#"{{"in":"layer","do":"mesh","layer":"{layer}","columns":{side},"rows":3}}"#)
        }),
        1 => layer().prop_map(|layer| format!(r#"{{"in":"layer","do":"apply transform","layer":"{layer}"}}"#)),
        2 => (prop::sample::select(vec!["liquify", "transform"]), [0..60i32, 0..40, 0..60, 0..40]).prop_map(
            |(tool, [x, y, u, v])| format!(
                "{{\"in\":\"pointer\",\"do\":\"press\",\"tool\":\"{tool}\",\"pen\":[{x},{y}],\"px_per_pt\":1}}\n\
                 {{\"in\":\"pointer\",\"do\":\"drag\",\"pens\":[[{u},{v}]]}}\n{{\"in\":\"pointer\",\"do\":\"release\"}}"
            )
        ),
        4 => (-4..4i32).prop_map(|steps| format!(r#"{{"in":"edit","do":"walk","steps":{steps}}}"#)),
    ]
}

/// What a document is: its parameters and its picture.
fn fingerprint(document: &Document) -> (String, u32) {
    let picture =
        flatten(document, &Progress::default()).unwrap().to_straight_rgba(document.size.rect());
    (crate::io::recipe::write(document).to_string(), crc32fast::hash(&picture))
}

fn document(session: &Session) -> Document {
    session.active().unwrap().document().clone()
}

fn walk(session: &mut Session, steps: i32) -> (String, u32) {
    session
        .replay(Path::new("story"), &format!(r#"{{"in":"edit","do":"walk","steps":{steps}}}"#))
        .unwrap();
    fingerprint(&document(session))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]
    #[test]
    fn undone_to_the_start_and_made_again_every_document_is_the_one_that_was(
        edits in prop::collection::vec(edit(), 1..20)
    ) {
        let mut session = replay(r##"{"in":"file","do":"new","width":60,"height":40,"background":"#ffffff"}"##);
        // The entries of the history, and the document's position in it.
        let (mut known, mut at) = (vec![fingerprint(&document(&session))], 0usize);
        for line in &edits {
            let before = document(&session);
            session.replay(Path::new("story"), line).unwrap();
            let now = document(&session);
            if let Some(steps) = line.strip_prefix(r#"{"in":"edit","do":"walk","steps":"#) {
                let steps: isize = steps.trim_end_matches('}').parse().unwrap();
                at = at.saturating_add_signed(steps).min(known.len() - 1);
                prop_assert_eq!(&fingerprint(&now), &known[at]);
            } else if !is_same(&before, &now) {
                known.truncate(at + 1);
                known.push(fingerprint(&now));
                at += 1;
            }
        }
        walk(&mut session, (known.len() - 1 - at) as i32);
        for step in known.iter().rev().skip(1) {
            prop_assert_eq!(&walk(&mut session, -1), step);
        }
        for step in &known[1..] {
            prop_assert_eq!(&walk(&mut session, 1), step);
        }
    }
}

#[test]
fn a_layer_that_comes_back_is_selected() {
    let mut session = replay(&format!("{PAPER}{STROKE}"));
    let selected = |session: &Session| session.layer().map(|layer| layer.name.clone());
    let step = |session: &mut Session, what: &str| {
        session.replay(Path::new("story"), &format!(r#"{{"in":"edit","do":"{what}"}}"#)).unwrap();
    };
    step(&mut session, "undo");
    assert_eq!(selected(&session).as_deref(), Some("Background"));
    step(&mut session, "redo");
    assert_eq!(selected(&session).as_deref(), Some("Strokes"));
}
