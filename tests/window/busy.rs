//! Keys pressed while the window is busy, undo, and what the window says of strokes that it does
//! not keep.

use super::{Story, act_until, command, key, layers, session, steps, stroke, until, window};
use eframe::egui::{Event, Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use rilievo_program::tools::ToolKind;

/// A letter as a keyboard sends it.
fn letter(harness: &mut Story, key: Key, text: &str) {
    harness.key_press(key);
    harness.event(Event::Text(text.into()));
}

fn row(harness: &mut Story, name: &str) {
    harness.get_by_label(&format!("Layer {name}")).click();
    steps(harness);
}

/// Several layers, whose merging takes longer than a frame.
fn layered() -> Story {
    let mut harness = window();
    (0..4).for_each(|_| command(&mut harness, "New gradient layer"));
    // Its properties leave room for three layers only.
    command(&mut harness, "Brushes");
    harness
}

#[test]
fn what_is_typed_before_a_dialog_is_there_goes_into_it() {
    let mut harness = window();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::O);
    harness.step();
    letter(&mut harness, Key::E, "e");
    harness.step();
    letter(&mut harness, Key::G, "g");
    until(&mut harness, |harness| harness.query_by_label("File name").is_some());
    assert_eq!(harness.get_by_label("File name").value().as_deref(), Some("eg"));
    assert_eq!(session(&harness).tool, ToolKind::Brush);
}

#[test]
fn keys_over_the_canvas_during_an_edit_are_done_after_it_in_their_order() {
    let mut harness = layered();
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::E);
    harness.step();
    harness.key_press(Key::E);
    harness.step();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.step();
    until(&mut harness, |harness| {
        session(harness).active().unwrap().history.redo_name() == Some("Flatten picture")
    });
    assert_eq!((layers(&harness).len(), session(&harness).tool), (5, ToolKind::Eraser));
}

#[test]
fn a_name_typed_during_an_edit_stays_in_its_field_and_switches_no_tool() {
    let mut harness = layered();
    for _ in 0..2 {
        harness.get_by_label_contains("Layer Background").click();
        harness.step();
    }
    until(&mut harness, |harness| harness.query_by_label("Layer name").is_some());
    // A command that the pointer gave; the field keeps the keyboard.
    command_under(&mut harness, "Flatten picture");
    // Also after the row, and the field in it, are gone.
    let type_g = |harness: &mut Story| {
        letter(harness, Key::G, "g");
        harness.step();
    };
    let mut frames_after = 0;
    act_until(&mut harness, type_g, |harness| {
        frames_after += i32::from(layers(harness).len() == 1);
        frames_after == 5
    });
    assert_eq!(layers(&harness), ["Picture"]);
    assert_eq!(session(&harness).tool, ToolKind::Brush);
}

/// By its name, without a palette.
fn command_under(harness: &mut Story, name: &str) {
    let ctx = harness.ctx.clone();
    harness.state_mut().as_mut().unwrap().command(&ctx, name);
}

#[test]
fn after_undo_the_layer_is_selected_that_was_selected_before() {
    let mut harness = window();
    command(&mut harness, "New paint layer");
    command(&mut harness, "New paint layer");
    row(&mut harness, "Paint");
    let selected = |harness: &Story| session(harness).layer().unwrap().name.clone();
    assert_eq!(selected(&harness), "Paint");
    command(&mut harness, "New gradient layer");
    assert_eq!(selected(&harness), "Gradient");
    key(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(selected(&harness), "Paint");
    let before = layers(&harness);
    stroke(&mut harness, vec2(40.0, 10.0));
    assert_eq!(layers(&harness), before, "the stroke goes to that layer");
}

#[test]
fn a_stroke_on_a_locked_layer_names_it_once() {
    let mut harness = window();
    command(&mut harness, "New paint layer");
    command(&mut harness, "Lock layer");
    stroke(&mut harness, vec2(40.0, 10.0));
    stroke(&mut harness, vec2(10.0, 40.0));
    steps(&mut harness);
    assert_eq!(harness.query_all_by_label_contains("“Paint” is locked. Unlock it").count(), 1);
}
