//! Texts, by the tool, keys and the panel of properties.

use super::{Story, command, drag, key, layers, press, session, steps, window};
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use rilievo::Content;
use rilievo::paint::Text;
use rilievo_program::tools::ToolKind;

fn text(harness: &Story) -> Text {
    let layer = session(harness).layer().expect("no layer is selected");
    match &layer.content {
        Content::Image(live) => {
            live.params().source.text().expect("it is no text").as_ref().clone()
        }
        _ => panic!("it is no image layer"),
    }
}

fn type_text(harness: &mut Story, words: &str) {
    harness.get_by_label("Words on the canvas").type_text(words);
    steps(harness);
}

#[test]
fn a_click_writes_typing_replaces_and_undo_takes_it_back() {
    let mut harness = window();
    key(&mut harness, Modifiers::SHIFT, Key::T);
    assert_eq!(session(&harness).tool, ToolKind::Text);
    drag(&mut harness, vec2(-100.0, 0.0), vec2(-100.0, 0.0));
    steps(&mut harness);
    assert_eq!(text(&harness).string(), "Text");
    // All of it is selected, so what is typed takes its place.
    type_text(&mut harness, "Big ");
    type_text(&mut harness, "fish");
    assert_eq!(text(&harness).string(), "Big fish");
    press(&mut harness, "Bold");
    assert_eq!(text(&harness).runs[0].style.weight, 700);
    assert!(layers(&harness).contains(&"Big fish".to_owned()), "{:?}", layers(&harness));
    // Beside it another one begins.
    drag(&mut harness, vec2(-100.0, 200.0), vec2(-100.0, 200.0));
    steps(&mut harness);
    assert_eq!((text(&harness).string().as_str(), layers(&harness).len()), ("Text", 3));
    key(&mut harness, Modifiers::NONE, Key::Escape);
    command(&mut harness, "Undo");
    assert_eq!(layers(&harness).len(), 2);
}
