//! The brush in hand: chosen, changed in all its parts, kept and removed.

use super::{Story, press, session, steps, window};
use eframe::egui::accesskit::Role;
use eframe::egui::vec2;
use egui_kittest::kittest::Queryable;
use rilievo::paint::{DualMode, Input, Property, Stabilizer, Tip};

fn editor() -> Story {
    let mut harness = window();
    press(&mut harness, "Brushes");
    press(&mut harness, "Current brush");
    harness
}

/// Whatever the scroll position of the panel.
fn tap(harness: &mut Story, label: &str) {
    harness.get_by_label(label).click_accesskit();
    steps(harness);
}

fn pick(harness: &mut Story, label: &str, choice: &str) {
    harness.get_by_role_and_label(Role::ComboBox, label).click_accesskit();
    steps(harness);
    tap(harness, choice);
}

#[test]
fn a_preset_goes_to_hand_and_its_parts_can_be_changed() {
    let mut harness = window();
    press(&mut harness, "Brushes");
    tap(&mut harness, "Brush Gouache");
    assert_eq!(session(&harness).preset, "gouache");
    press(&mut harness, "Current brush");
    tap(&mut harness, "Tip");
    pick(&mut harness, "Shape", "Bristles");
    assert!(matches!(session(&harness).tools.brush.tip, Tip::Bristles(_)));
    assert!(session(&harness).tools.brush.grain.is_some(), "the rest of the gouache stays");
    tap(&mut harness, "Stroke");
    pick(&mut harness, "Stabilizer", "Pulled string");
    assert!(matches!(session(&harness).tools.brush.stabilizer, Stabilizer::String { .. }));
    tap(&mut harness, "Erases");
    assert!(session(&harness).tools.brush.erases);
    tap(&mut harness, "Grain");
    pick(&mut harness, "Pattern", "None");
    assert!(session(&harness).tools.brush.grain.is_none());
}

#[test]
fn a_second_tip_is_chosen_and_taken_away() {
    let mut harness = editor();
    tap(&mut harness, "Dual brush");
    pick(&mut harness, "Second tip", "Specks");
    let dual = |harness: &Story| session(harness).tools.brush.dual.clone();
    assert!(matches!(dual(&harness).unwrap().tip, Tip::Noise(_)));
    pick(&mut harness, "Meets by", "Linear burn");
    tap(&mut harness, "Tip of a brush…");
    tap(&mut harness, "Calligraphy");
    let taken = dual(&harness).unwrap();
    assert_eq!(taken.settings.mode, DualMode::LinearBurn, "the rest stays");
    assert!(!matches!(taken.tip, Tip::Noise(_)));
    pick(&mut harness, "Second tip", "None");
    assert!(dual(&harness).is_none());
}

#[test]
fn a_property_follows_what_it_is_told_to_by_a_curve_that_a_hand_bends() {
    let mut harness = editor();
    // The other parts stay closed, so that the curves are seen.
    tap(&mut harness, "Dynamics");
    for label in ["Remove Size by pressure", "Remove Opacity by pressure"] {
        tap(&mut harness, label);
    }
    let brush = &session(&harness).tools.brush;
    assert!(brush.dynamics.curve(Property::Opacity, Input::Pressure).is_none());
    assert!(brush.dynamics.curve(Property::Flow, Input::Pressure).is_some());
    harness.get_by_label("Curve of flow by pressure").scroll_to_me();
    steps(&mut harness);
    let square = harness.get_by_label("Curve of flow by pressure").rect();
    let middle = square.center();
    harness.drag_at(middle + vec2(0.0, 10.0));
    steps(&mut harness);
    harness.hover_at(middle + vec2(0.0, -20.0));
    steps(&mut harness);
    harness.drop_at(middle + vec2(0.0, -20.0));
    steps(&mut harness);
    let curve = session(&harness)
        .tools
        .brush
        .dynamics
        .curve(Property::Flow, Input::Pressure)
        .unwrap()
        .clone();
    assert!(curve.at(0.5) > 0.6, "a point was added and drawn up: {}", curve.at(0.5));
}

#[test]
fn a_brush_is_kept_under_a_name_and_stands_with_ones_own() {
    let mut harness = editor();
    harness.get_by_label("Name of the brush to keep").focus();
    steps(&mut harness);
    harness.get_by_label("Name of the brush to keep").type_text("My wash");
    steps(&mut harness);
    tap(&mut harness, "Keep brush");
    assert_eq!(session(&harness).preset, "my-wash");
    press(&mut harness, "Presets");
    harness.get_by_label("Brush My wash");
}

#[test]
fn favorites_and_the_last_used_come_before_all_others() {
    let mut harness = window();
    press(&mut harness, "Brushes");
    tap(&mut harness, "Brush Airbrush");
    assert!(harness.query_by_label("Brush Airbrush, last used").is_some());
    harness.get_by_label("Brush Soft round, last used").click_secondary();
    steps(&mut harness);
    press(&mut harness, "Add to favorites");
    let top = |harness: &Story, label: &str| harness.get_by_label(label).rect().top();
    let favorite = top(&harness, "Brush Soft round, favorite");
    assert!(favorite < top(&harness, "Brush Airbrush, last used"));
    assert!(top(&harness, "Brush Airbrush, last used") < top(&harness, "Brush Soft round"));
    harness.get_by_label("Brush Soft round, favorite").click_secondary();
    steps(&mut harness);
    press(&mut harness, "Remove from favorites");
    assert!(harness.query_by_label("Brush Soft round, favorite").is_none());
}
