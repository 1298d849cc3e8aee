//! What the hand does on the canvas.

use super::{Story, click, command, drag, key, layers, session, steps, window};
use eframe::egui::{Event, Key, Modifiers, Pos2, TouchDeviceId, TouchId, TouchPhase, Vec2, vec2};
use egui_kittest::kittest::Queryable;
use rilievo::Content;

#[test]
fn a_new_document_is_painted_on_and_the_stroke_undone() {
    let mut harness = window();
    assert_eq!(layers(&harness), ["Background"]);
    let canvas = harness.get_by_label("Canvas").rect();
    harness.drag_at(canvas.center());
    steps(&mut harness);
    harness.hover_at(canvas.center() + vec2(90.0, 30.0));
    steps(&mut harness);
    harness.drop_at(canvas.center() + vec2(90.0, 30.0));
    steps(&mut harness);
    assert_eq!(layers(&harness), ["Background", "Strokes"]);
    let Content::Strokes(live) = &session(&harness).layer().unwrap().content else {
        panic!("a stroke layer")
    };
    assert!(live.params().strokes[0].samples().len() >= 2);
    click(&mut harness, "Edit");
    click(&mut harness, "Undo");
    assert_eq!(layers(&harness), ["Background"]);
}

#[test]
fn a_stroke_is_selected_in_the_list_ordered_duplicated_and_deleted() {
    let mut harness = window();
    let canvas = harness.get_by_label("Canvas").rect();
    for dy in [-40.0, 40.0] {
        let from = canvas.center() + vec2(-60.0, dy);
        harness.drag_at(from);
        steps(&mut harness);
        harness.drop_at(from + vec2(120.0, 0.0));
        steps(&mut harness);
    }
    let heights = |harness: &Story| -> Vec<f32> {
        let open = session(harness).active().unwrap();
        open.document()
            .strokes(open.active_layer.unwrap())
            .iter()
            .map(|stroke| stroke.samples()[0].at.y)
            .collect()
    };
    let [upper, lower] = heights(&harness)[..] else { panic!("two strokes") };
    harness.get_by_label("Properties").click();
    steps(&mut harness);
    click(&mut harness, "Stroke 1 ·");
    assert_eq!(session(&harness).tool, rilievo_program::tools::ToolKind::Strokes);
    assert_eq!(session(&harness).active().unwrap().selected_strokes(), [0]);
    harness.get_by_label("Stroke up").click();
    steps(&mut harness);
    assert_eq!(heights(&harness), [lower, upper]);
    harness.get_by_label("Duplicate strokes").click();
    steps(&mut harness);
    assert_eq!(heights(&harness).len(), 3);
    harness.get_by_label("Delete strokes").click();
    steps(&mut harness);
    assert_eq!(heights(&harness), [lower, upper]);
    // On the canvas: the lower one, dragged up.
    harness.drag_at(canvas.center() + vec2(0.0, 40.0));
    steps(&mut harness);
    harness.hover_at(canvas.center() + vec2(0.0, 10.0));
    steps(&mut harness);
    harness.drop_at(canvas.center() + vec2(0.0, 10.0));
    steps(&mut harness);
    assert_eq!(session(&harness).active().unwrap().selected_strokes(), [0]);
    assert!(heights(&harness)[0] < lower && heights(&harness)[1] == upper);
}

#[test]
fn the_fill_tool_shows_its_options_and_fills() {
    let mut harness = window();
    click(&mut harness, "Fill");
    assert_ne!(harness.query_all_by_label("Close gaps").count(), 0);
    harness.get_by_label("This layer only").click();
    steps(&mut harness);
    assert!(session(&harness).tools.fill.layer_alone);
    let canvas = harness.get_by_label("Canvas").rect();
    harness.drag_at(canvas.center());
    steps(&mut harness);
    harness.drop_at(canvas.center());
    steps(&mut harness);
    assert_eq!(layers(&harness), ["Background", "Paint"]);
    let Content::Pixels(pixels) = &session(&harness).layer().unwrap().content else {
        panic!("a paint layer")
    };
    assert_ne!(pixels.tiles.pixel(3, 3), [0; 4]);
}

#[test]
fn the_brush_is_made_to_smudge_and_says_what_it_needs() {
    let mut harness = window();
    harness.get_by_label("Mark").click();
    steps(&mut harness);
    harness.get_by_label("Smudge").click();
    steps(&mut harness);
    assert!(session(&harness).tools.brush.mode.is_retouching());
    assert_ne!(harness.query_all_by_label("Length").count(), 0);
    let canvas = harness.get_by_label("Canvas").rect();
    harness.drag_at(canvas.center());
    steps(&mut harness);
    harness.drop_at(canvas.center());
    steps(&mut harness);
    assert_eq!(layers(&harness), ["Background"]);
    harness.get_by_label_contains("work on paint layers");
}

#[test]
fn two_fingers_that_tap_take_a_step_back() {
    let mut harness = window();
    click(&mut harness, "+ Add");
    click(&mut harness, "Fill layer");
    let middle = harness.get_by_label("Canvas").rect().center();
    for phase in [TouchPhase::Start, TouchPhase::End] {
        for finger in [1, 2] {
            let pos = middle + vec2(40.0 * finger as f32, 0.0);
            harness.event(touch(finger, phase, pos));
        }
        harness.step();
    }
    steps(&mut harness);
    assert_eq!(layers(&harness), ["Background"]);
}

fn touch(finger: u64, phase: TouchPhase, pos: Pos2) -> Event {
    Event::Touch { device_id: TouchDeviceId(0), id: TouchId(finger), phase, pos, force: None }
}

#[test]
fn keys_that_other_painting_programs_taught_do_the_same_here() {
    let mut harness = window();
    let (size, view) = (
        |harness: &Story| session(harness).tools.brush.size,
        |harness: &Story| session(harness).active().unwrap().view.unwrap(),
    );
    let before = size(&harness);
    key(&mut harness, Modifiers::NONE, Key::CloseBracket);
    assert!(size(&harness) > before);
    key(&mut harness, Modifiers::NONE, Key::OpenBracket);
    key(&mut harness, Modifiers::NONE, Key::OpenBracket);
    assert!(size(&harness) < before);
    key(&mut harness, Modifiers::NONE, Key::M);
    key(&mut harness, Modifiers::NONE, Key::Num6);
    assert!(view(&harness).mirrored && view(&harness).turn_rad != 0.0);
    key(&mut harness, Modifiers::NONE, Key::Num5);
    key(&mut harness, Modifiers::NONE, Key::M);
    let upright = view(&harness);
    assert!(!upright.mirrored && upright.turn_rad == 0.0);
    // With the space bar held the canvas is moved, and nothing is painted.
    harness.key_down(Key::Space);
    harness.hover_at(harness.get_by_label("Canvas").rect().center());
    steps(&mut harness);
    drag(&mut harness, Vec2::ZERO, vec2(60.0, 20.0));
    harness.key_up(Key::Space);
    steps(&mut harness);
    assert_eq!(layers(&harness), ["Background"]);
    assert!((view(&harness).center.x - upright.center.x).abs() > 10.0);
    drag(&mut harness, Vec2::ZERO, vec2(60.0, 20.0));
    assert_eq!(layers(&harness), ["Background", "Strokes"]);
    key(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(layers(&harness), ["Background"]);
    key(&mut harness, Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    assert_eq!(layers(&harness), ["Background", "Strokes"]);
    command(&mut harness, "Transform");
    assert_eq!(session(&harness).tool, rilievo_program::tools::ToolKind::Transform);
}
