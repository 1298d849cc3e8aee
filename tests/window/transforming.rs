//! The transform tool by the window's own controls.

use super::{Story, command, drag, key, press, session, steps, window};
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use rilievo_program::tools::transform::GizmoNumbers;

/// A paint layer with a stroke on it, and the transform tool in hand.
fn painted() -> Story {
    let mut harness = window();
    command(&mut harness, "Sphere");
    command(&mut harness, "New paint layer");
    press(&mut harness, "Brush");
    drag(&mut harness, vec2(-60.0, -30.0), vec2(60.0, 30.0));
    command(&mut harness, "Transform");
    harness
}

fn numbers(harness: &Story) -> GizmoNumbers {
    GizmoNumbers::of(
        &session(harness).active().unwrap().gizmo(session(harness).tools.transform.target).unwrap(),
    )
    .unwrap()
}

#[test]
fn the_options_of_the_transform_tool_fit_a_small_window_in_one_row() {
    let mut harness = painted();
    drag(&mut harness, vec2(-30.0, -14.0), vec2(0.0, 10.0));
    harness.set_size(vec2(1024.0, 700.0));
    steps(&mut harness);
    let row = [
        "What is transformed",
        "X",
        "Y",
        "Width",
        "Width in %",
        "Height",
        "Height in %",
        "Angle",
        "Skew",
        "Apply transform",
        "Mesh",
        "More options",
    ];
    let controls = row.iter().flat_map(|name| harness.query_all_by_label(name).collect::<Vec<_>>());
    let controls: Vec<_> = controls.filter(|node| node.rect().top() < 110.0).collect();
    assert!(controls.len() >= row.len(), "some of {row:?} are missing");
    let middle = controls[0].rect().center().y;
    for node in controls {
        let (name, rect) = (node.accesskit_node().label(), node.rect());
        assert!(rect.right() < 1018.0, "{name:?} is cut off: {rect}");
        assert!((rect.center().y - middle).abs() < 3.0, "{name:?} stands in another row: {rect}");
    }
    press(&mut harness, "More options");
    for command in ["Remove transform", "Mirror left and right", "Pivot"] {
        assert!(harness.query_all_by_label(command).count() > 0, "{command}");
    }
}

#[test]
fn several_layers_are_turned_by_a_number_and_their_frame_turns_along() {
    let mut harness = painted();
    command(&mut harness, "Duplicate layer");
    key(&mut harness, Modifiers::SHIFT, Key::PageDown);
    assert_eq!(session(&harness).active().unwrap().selected_layers().len(), 2);
    let before = numbers(&harness);
    for (degrees, is_back) in [("30", false), ("0", true)] {
        let field = harness.query_all_by_label("Angle").last().unwrap();
        field.focus();
        steps(&mut harness);
        harness.query_all_by_label("Angle").last().unwrap().type_text(degrees);
        key(&mut harness, Modifiers::NONE, Key::Enter);
        let now = numbers(&harness);
        let wanted: f64 = degrees.parse().unwrap();
        assert!(
            (now.angle - wanted).abs() < 0.01 && (now.width - before.width).abs() < 0.01,
            "{now:?}"
        );
        let open = session(&harness).active().unwrap();
        let stay = open
            .selected_layers()
            .iter()
            .all(|id| open.document().layer(*id).unwrap().transform.is_none());
        assert_eq!(stay, is_back);
    }
}

#[test]
fn a_press_on_the_canvas_beside_an_open_menu_closes_it_and_nothing_else() {
    let mut harness = painted();
    let before = numbers(&harness);
    press(&mut harness, "Mesh");
    assert!(harness.query_by_label("4 × 4 points").is_some());
    drag(&mut harness, vec2(-10.0, 60.0), vec2(30.0, 90.0));
    assert!(harness.query_by_label("4 × 4 points").is_none(), "the menu is still open");
    assert_eq!(numbers(&harness), before, "the drag that closed it moved the layer as well");
    drag(&mut harness, vec2(-10.0, 60.0), vec2(30.0, 90.0));
    assert_ne!(numbers(&harness), before);
}
