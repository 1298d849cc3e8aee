//! Several layers, guides, the grid and assistants, by the window's own controls.

use super::{Story, click, command, drag, key, layers, press, session, steps, window};
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;

/// Three fill layers above the background.
fn four() -> Story {
    let mut harness = window();
    (0..3).for_each(|_| command(&mut harness, "New fill layer"));
    harness
}

fn row(harness: &mut Story, name: &str, modifiers: Modifiers) {
    harness.get_by_label_contains(&format!("Layer {name}")).click_modifiers(modifiers);
    steps(harness);
}

fn selected(harness: &Story) -> Vec<String> {
    let open = session(harness).active().unwrap();
    open.selected_layers()
        .iter()
        .map(|id| open.document().layer(*id).unwrap().name.clone())
        .collect()
}

#[test]
fn layers_are_selected_with_keys_held_and_grouped_as_one_step() {
    let mut harness = four();
    assert_eq!(layers(&harness), ["Background", "Fill", "Fill 2", "Fill 3"]);
    row(&mut harness, "Background", Modifiers::NONE);
    row(&mut harness, "Fill 3", Modifiers::COMMAND);
    assert_eq!(selected(&harness), ["Background", "Fill 3"]);
    row(&mut harness, "Fill 2", Modifiers::NONE);
    row(&mut harness, "Background", Modifiers::SHIFT);
    assert_eq!(selected(&harness), ["Background", "Fill", "Fill 2"]);
    assert!(harness.query_by_label("Layer Fill 2, selected").is_some(), "a screen reader is told");
    key(&mut harness, Modifiers::COMMAND, Key::G);
    assert_eq!(layers(&harness), ["Group", "Fill 3"]);
    key(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::G);
    assert_eq!(layers(&harness), ["Background", "Fill", "Fill 2", "Fill 3"]);
    key(&mut harness, Modifiers::SHIFT, Key::Delete);
    assert_eq!(layers(&harness), ["Fill 3"]);
    command(&mut harness, "Undo");
    assert_eq!(layers(&harness).len(), 4);
}

#[test]
fn the_keys_of_pages_go_through_the_layers_and_extend_with_shift() {
    let mut harness = four();
    key(&mut harness, Modifiers::NONE, Key::PageDown);
    assert_eq!(selected(&harness), ["Fill 2"]);
    key(&mut harness, Modifiers::SHIFT, Key::PageDown);
    assert_eq!(selected(&harness), ["Fill", "Fill 2"]);
    key(&mut harness, Modifiers::SHIFT, Key::PageUp);
    key(&mut harness, Modifiers::SHIFT, Key::PageUp);
    assert_eq!(selected(&harness), ["Fill 2", "Fill 3"], "the beginning stays");
    command(&mut harness, "Show or hide layer");
    let document = session(&harness).active().unwrap().document();
    assert_eq!(
        document.layers.iter().map(|layer| layer.visible).collect::<Vec<_>>(),
        [true, true, false, false]
    );
}

#[test]
fn the_list_is_filtered_by_name_and_an_eye_with_alt_shows_one_layer_alone() {
    let mut harness = four();
    harness.get_by_label("Filter layers").focus();
    steps(&mut harness);
    harness.get_by_label("Filter layers").type_text("fill 2");
    steps(&mut harness);
    assert!(harness.query_by_label_contains("Layer Fill 2").is_some());
    assert!(harness.query_by_label_contains("Layer Background").is_none());
    key(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(
        harness.query_by_label_contains("Layer Background").is_some(),
        "Escape shows all again"
    );
    for is_alone in [true, false] {
        harness.get_by_label("Show Fill").click_modifiers(Modifiers::ALT);
        steps(&mut harness);
        assert_eq!(session(&harness).active().unwrap().solo.is_some(), is_alone);
    }
}

#[test]
fn guides_are_pulled_out_of_a_ruler_and_dragged_back() {
    let mut harness = window();
    command(&mut harness, "Rulers");
    let guides =
        |harness: &Story| session(harness).active().unwrap().document().guides.vertical.clone();
    let canvas = harness.get_by_label("Canvas").rect();
    let ruler = vec2(-0.5 * canvas.width() - 6.0, 0.0);
    drag(&mut harness, ruler, vec2(40.0, 30.0));
    assert_eq!(guides(&harness).len(), 1);
    press(&mut harness, "Move");
    drag(&mut harness, vec2(40.0, 60.0), vec2(-37.0, 0.0));
    let moved = guides(&harness);
    assert_eq!(moved.len(), 1);
    let done: Vec<String> =
        session(&harness).active().unwrap().history.past_names().map(str::to_owned).collect();
    assert_eq!(done, ["Add guide", "Move guide"]);
    drag(&mut harness, vec2(-37.0, 0.0), ruler);
    assert!(guides(&harness).is_empty());
    command(&mut harness, "Undo");
    assert_eq!(guides(&harness), moved);
    command(&mut harness, "Clear guides");
    assert!(guides(&harness).is_empty());
    command(&mut harness, "Grid and snapping…");
    click(&mut harness, "To layers");
    assert!(session(&harness).tools.aids.to_layers);
    press(&mut harness, "Close");
}

#[test]
fn an_assistant_is_laid_and_a_stroke_beside_it_is_straight() {
    let mut harness = window();
    press(&mut harness, "Assistants");
    drag(&mut harness, vec2(-150.0, 0.0), vec2(150.0, 0.0));
    let assistants = session(&harness).active().unwrap().document().assistants.clone();
    assert_eq!(assistants.len(), 1);
    press(&mut harness, "Brush");
    drag(&mut harness, vec2(-100.0, 9.0), vec2(80.0, -14.0));
    let open = session(&harness).active().unwrap();
    let strokes = open.document().strokes(open.active_layer.unwrap());
    let on = assistants[0].points[0].y;
    assert!(
        strokes[0].samples().iter().all(|sample| (sample.at.y - on).abs() < 0.05),
        "it lies on the line"
    );
}
