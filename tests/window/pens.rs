//! Pens in the window: what a platform says about one is painted, shown in the preferences, and its
//! buttons do what is chosen.

use super::{Story, key, press, session, steps, window};
use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::kittest::Queryable;
use rilievo::Color;
use rilievo_window::{PenState, SharedTablet};

/// A window, and the tablet that its pointer belongs to.
fn window_with_pen() -> (Story, SharedTablet) {
    let (mut harness, tablet) = (window(), SharedTablet::default());
    harness.state_mut().as_mut().expect("a window").draw_on(tablet.clone());
    press(&mut harness, "Brush");
    (harness, tablet)
}

fn held(pressure: f32) -> PenState {
    let (pressure, tilt) = (Some(pressure), (20.0, -35.0));
    PenState { device: 3, pressure, tilt, twist: Some(45.0), is_eraser: false }
}

/// The pen moves to a place of the window.
fn move_pen(harness: &mut Story, tablet: &SharedTablet, at: Pos2, state: PenState) {
    tablet.borrow_mut().note([at.x.into(), at.y.into()], state);
    harness.event(Event::PointerMoved(at));
    steps(harness);
}

fn button(harness: &mut Story, pos: Pos2, button: PointerButton, pressed: bool) {
    harness.event(Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE });
    steps(harness);
}

/// A stroke with the tip, from the middle of the canvas.
fn pen_stroke(harness: &mut Story, tablet: &SharedTablet, state: PenState) {
    let from = harness.get_by_label("Canvas").rect().center();
    move_pen(harness, tablet, from, state);
    button(harness, from, PointerButton::Primary, true);
    for step in 1..=4 {
        move_pen(harness, tablet, from + vec2(12.0 * step as f32, 0.0), state);
    }
    button(harness, from + vec2(48.0, 0.0), PointerButton::Primary, false);
}

/// Chooses what the button does that is taken for the mouse's right one.
fn choose_right_button(harness: &mut Story, action: &str) {
    key(harness, Modifiers::COMMAND, Key::Comma);
    press(harness, "Pen");
    harness.get_by_role_and_label(Role::ComboBox, "Right click").click();
    steps(harness);
    press(harness, action);
    key(harness, Modifiers::NONE, Key::Escape);
}

/// Holds the button above the middle of the canvas.
fn hold_right_button(harness: &mut Story, tablet: &SharedTablet) -> Pos2 {
    let middle = harness.get_by_label("Canvas").rect().center();
    move_pen(harness, tablet, middle, held(0.0));
    button(harness, middle, PointerButton::Secondary, true);
    middle
}

fn done(harness: &Story) -> Vec<String> {
    let history = &session(harness).active().unwrap().history;
    history.past_names().map(str::to_owned).collect()
}

#[test]
fn the_page_of_the_pen_shows_what_it_reports() {
    let (mut harness, tablet) = window_with_pen();
    key(&mut harness, Modifiers::COMMAND, Key::Comma);
    press(&mut harness, "Pen");
    assert!(harness.query_all_by_label_contains("No pen yet").next().is_some());
    let place = harness.get_by_label("Place to try the pen").rect();
    move_pen(&mut harness, &tablet, place.center(), held(0.0));
    button(&mut harness, place.center(), PointerButton::Primary, true);
    move_pen(&mut harness, &tablet, place.center() + vec2(20.0, 4.0), held(0.25));
    assert!(harness.query_all_by_label_contains("No pen yet").next().is_none());
    for shown in ["0.250, painted with as 0.250", "20° right, -35° down", "45°", "tip"] {
        assert!(harness.query_by_label(shown).is_some(), "no {shown}");
    }
    button(&mut harness, place.center(), PointerButton::Secondary, true);
    let eraser = PenState { is_eraser: true, twist: None, ..held(0.5) };
    move_pen(&mut harness, &tablet, place.center() + vec2(30.0, 4.0), eraser);
    assert!(harness.query_by_label("the other end, tip, right click").is_some());
    assert!(harness.query_by_label("45°").is_none(), "it has no twist");
    button(&mut harness, place.center(), PointerButton::Secondary, false);
    button(&mut harness, place.center(), PointerButton::Primary, false);
    move_pen(&mut harness, &tablet, pos2(9.0, 9.0), held(0.0));
    assert!(harness.query_by_label("nothing").is_some());
    press(&mut harness, "Clear");
    assert!(done(&harness).is_empty(), "nothing was painted beneath the dialog");
}

#[test]
fn a_pens_pressure_is_painted_with_and_its_other_end_erases() {
    let (mut harness, tablet) = window_with_pen();
    pen_stroke(&mut harness, &tablet, held(0.75));
    let eraser = PenState { is_eraser: true, ..held(0.75) };
    pen_stroke(&mut harness, &tablet, eraser);
    let done = done(&harness);
    assert_eq!(done.len(), 2, "{done:?}");
    assert_eq!(done[1], "Erase");
    assert_ne!(done[0], "Erase");
}

#[test]
fn the_barrel_erases_takes_a_color_and_undoes_by_choice() {
    let (mut harness, tablet) = window_with_pen();
    choose_right_button(&mut harness, "Take a color");
    let middle = hold_right_button(&mut harness, &tablet);
    pen_stroke(&mut harness, &tablet, held(0.5));
    button(&mut harness, middle, PointerButton::Secondary, false);
    assert!(done(&harness).is_empty());
    assert_eq!(session(&harness).tools.color, Color::WHITE, "it was taken from the paper");
    pen_stroke(&mut harness, &tablet, held(0.5));
    choose_right_button(&mut harness, "Erase");
    let middle = hold_right_button(&mut harness, &tablet);
    assert_eq!(done(&harness).len(), 1, "a held button alone does nothing");
    pen_stroke(&mut harness, &tablet, held(0.5));
    button(&mut harness, middle, PointerButton::Secondary, false);
    assert_eq!(done(&harness).last().map(String::as_str), Some("Erase"));
    choose_right_button(&mut harness, "Undo");
    let middle = hold_right_button(&mut harness, &tablet);
    button(&mut harness, middle, PointerButton::Secondary, false);
    assert_eq!(done(&harness).len(), 1);
}

#[test]
fn the_barrel_moves_the_view_until_it_is_released_and_a_mouse_keeps_its_buttons() {
    let (mut harness, tablet) = window_with_pen();
    choose_right_button(&mut harness, "Move the view");
    let view = |harness: &Story| session(harness).active().unwrap().view.unwrap();
    let (before, size) = (view(&harness), session(&harness).tools.brush.size);
    let middle = hold_right_button(&mut harness, &tablet);
    move_pen(&mut harness, &tablet, middle + vec2(30.0, 10.0), held(0.0));
    let moved = view(&harness);
    assert_ne!(moved, before);
    // The tip that comes down meanwhile neither paints nor ends it.
    button(&mut harness, middle, PointerButton::Primary, true);
    button(&mut harness, middle, PointerButton::Primary, false);
    move_pen(&mut harness, &tablet, middle + vec2(60.0, 10.0), held(0.0));
    assert_ne!(view(&harness), moved);
    button(&mut harness, middle, PointerButton::Secondary, false);
    assert!(done(&harness).is_empty());
    let (moved, mouse) = (view(&harness), PenState::default());
    move_pen(&mut harness, &tablet, middle, mouse);
    button(&mut harness, middle, PointerButton::Secondary, true);
    let to = middle + vec2(40.0, 0.0);
    move_pen(&mut harness, &tablet, to, mouse);
    button(&mut harness, to, PointerButton::Secondary, false);
    assert_eq!(view(&harness), moved);
    assert_ne!(session(&harness).tools.brush.size, size, "a mouse's right button sizes the brush");
}
