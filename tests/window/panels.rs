//! Every panel next to the canvas, in a window of its own, and hidden.

use super::{Story, click, command, key, press, session, steps, until, window};
use eframe::egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, TouchPhase, pos2, vec2,
};
use egui_kittest::kittest::Queryable;

const PANELS: [&str; 6] = ["Color", "Brushes", "Properties", "Surface", "History", "Navigator"];

#[test]
fn every_panel_shows_every_kind_of_layer() {
    let mut harness = window();
    for kind in [
        "Paint layer",
        "Stroke layer",
        "Fill layer",
        "Gradient layer",
        "Shading layer",
        "Bring out form",
        "Group",
    ] {
        click(&mut harness, "+ Add");
        harness.get_by_label(kind).click();
        steps(&mut harness);
        for panel in PANELS {
            harness.get_by_label(panel).click();
            steps(&mut harness);
        }
    }
}

#[test]
fn every_panel_stands_in_a_window_of_its_own_and_goes_back() {
    let mut harness = window();
    for panel in PANELS {
        if panel == "Color" {
            press(&mut harness, "Color");
            press(&mut harness, "In a window of its own, or back");
        } else {
            // A group of brushes may have the name of a panel; the tabs come first.
            harness.get_all_by_label(panel).next().unwrap().click_secondary();
            steps(&mut harness);
            press(&mut harness, "In a window of its own");
        }
        let beside = harness.get_by_label("Canvas").rect().right();
        let stands = |harness: &Story, is: fn(f32, f32) -> bool| {
            harness.get_all_by_label(panel).any(|node| is(node.rect().left(), beside))
        };
        assert!(stands(&harness, |at, beside| at < beside), "{panel} stands over the canvas");
        press(&mut harness, "Close window");
        assert!(!stands(&harness, |at, beside| at < beside), "{panel} is beside it again");
    }
}

#[test]
fn the_panels_hide_go_to_the_other_side_and_into_a_window_together() {
    let mut harness = window();
    let canvas = |harness: &Story| harness.get_by_label("Canvas").rect();
    let usual = canvas(&harness);
    key(&mut harness, Modifiers::NONE, Key::Tab);
    assert!(
        harness.query_by_label("History").is_none() && canvas(&harness).width() > usual.width()
    );
    key(&mut harness, Modifiers::NONE, Key::Tab);
    assert_eq!(canvas(&harness), usual);
    command(&mut harness, "Panels on the other side");
    assert!(harness.get_by_label("History").rect().right() < canvas(&harness).left());
    command(&mut harness, "Panels in a window");
    assert!(canvas(&harness).width() > usual.width());
    harness.get_by_label("History");
}

#[test]
fn a_click_in_the_history_goes_there_and_one_in_the_navigator_looks_there() {
    let mut harness = window();
    for kind in ["Fill layer", "Paint layer"] {
        click(&mut harness, "+ Add");
        click(&mut harness, kind);
    }
    press(&mut harness, "History");
    press(&mut harness, "Opened");
    assert_eq!(super::layers(&harness), ["Background"]);
    command(&mut harness, "Actual pixels");
    press(&mut harness, "Navigator");
    let corner = harness.get_all_by_label("Navigator").last().unwrap().rect().left_top()
        + eframe::egui::vec2(9.0, 9.0);
    harness.drag_at(corner);
    steps(&mut harness);
    harness.drop_at(corner);
    steps(&mut harness);
    let center = session(&harness).active().unwrap().view.unwrap().center;
    assert!(center.x < 200.0 && center.y < 200.0, "{center}");
}

#[test]
fn colors_are_typed_in_hex_and_numbers_and_remembered_once_painted_with() {
    let mut harness = window();
    press(&mut harness, "Color");
    press(&mut harness, "Numbers and palette");
    key(&mut harness, Modifiers::NONE, Key::Escape);
    press(&mut harness, "Hex color");
    key(&mut harness, Modifiers::COMMAND, Key::A);
    harness.get_by_label("Hex color").type_text("#3366cc");
    steps(&mut harness);
    key(&mut harness, Modifiers::NONE, Key::Enter);
    let color = session(&harness).tools.color;
    assert_eq!([color.r, color.g, color.b], [0x33, 0x66, 0xcc]);
    assert!(harness.query_by_label("Recent color 1").is_none());
    super::stroke(&mut harness, eframe::egui::vec2(30.0, 0.0));
    key(&mut harness, Modifiers::NONE, Key::D);
    press(&mut harness, "Recent color 1");
    assert_eq!(session(&harness).tools.color, color);
}

#[test]
fn a_small_window_has_room_for_the_options_the_tools_and_six_layers() {
    let mut harness = window();
    (0..6).for_each(|_| command(&mut harness, "New fill layer"));
    for bend in ["Flat", "Wrap", "Gloss"] {
        harness.set_size(vec2(1024.0, 700.0));
        press(&mut harness, "Brush");
        press(&mut harness, bend);
        let ends = harness.get_by_label("More options").rect().right();
        assert!(ends < 1018.0, "{bend}: {ends}");
    }
    let tools = ["Brush", "Zoom"].map(|tool| harness.get_by_label(tool).rect());
    assert_eq!(tools[0].center().x, tools[1].center().x, "one column");
    let beneath = harness.get_by_label("+ Add").rect().top();
    let rows = harness.get_all_by_label_contains("Layer Fill");
    let seen = rows.filter(|row| row.rect().bottom() <= beneath).count();
    assert!(seen >= 6, "{seen} layers");
    for always in ["Current color", "Brush Gouache", "Other color"] {
        assert!(harness.query_by_label(always).is_some(), "{always}");
    }
}

#[test]
fn what_a_small_window_cuts_off_the_options_comes_by_the_wheel() {
    let mut harness = window();
    press(&mut harness, "Assistants");
    harness.set_size(vec2(640.0, 700.0));
    steps(&mut harness);
    let ends = |harness: &Story| harness.get_by_label("Magnetism").rect().right();
    assert!(ends(&harness) > 636.0, "{}", ends(&harness));
    harness.hover_at(pos2(300.0, 42.0));
    steps(&mut harness);
    let (unit, delta) = (MouseWheelUnit::Point, vec2(0.0, -900.0));
    let (phase, source) = (TouchPhase::Move, MouseWheelSource::Wheel);
    let wheel = Event::MouseWheel { unit, delta, phase, source, modifiers: Modifiers::NONE };
    harness.input_mut().events.push(wheel);
    // The wheel is followed smoothly.
    until(&mut harness, |harness| ends(harness) < 640.0);
}

#[test]
fn the_status_bar_says_what_is_measured_if_that_is_asked_for() {
    let mut harness = window();
    let has_memory = |harness: &Story| harness.query_by_label("Memory of this document").is_some();
    assert!(!has_memory(&harness));
    command(&mut harness, "Details in the status bar");
    assert!(has_memory(&harness));
}

#[test]
fn a_number_is_set_by_a_drag_along_its_bar_or_typed_after_a_double_click() {
    let mut harness = window();
    let size = |harness: &Story| session(harness).tools.brush.size;
    let bar = harness.get_by_label("Size").rect();
    harness.drag_at(bar.left_center() + vec2(2.0, 0.0));
    steps(&mut harness);
    let small = size(&harness);
    harness.hover_at(bar.center());
    steps(&mut harness);
    harness.drop_at(bar.center());
    steps(&mut harness);
    assert!(small < 3.0 && size(&harness) > 10.0, "{small} {}", size(&harness));
    harness.get_by_label("Size").click_secondary();
    steps(&mut harness);
    harness.event(Event::Text("77".into()));
    steps(&mut harness);
    key(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(size(&harness), 77.0);
}

#[test]
fn a_canvas_that_was_seen_whole_is_so_in_a_window_that_grew_behind_another() {
    let mut harness = window();
    let zoom = |harness: &Story| session(harness).active().unwrap().view.unwrap().zoom;
    let key_of = |harness: &Story| session(harness).active().unwrap().key;
    let (first, before) = (key_of(&harness), zoom(&harness));
    click(&mut harness, "File");
    click(&mut harness, "New…");
    click(&mut harness, "Create");
    harness.set_size(vec2(1280.0, 1020.0));
    steps(&mut harness);
    let grown = zoom(&harness);
    command(&mut harness, "Next document");
    steps(&mut harness);
    assert!(key_of(&harness) == first && grown > before + 0.1, "{before} {grown}");
    assert_eq!(zoom(&harness), grown);
}

#[test]
fn a_second_view_shows_the_document_until_it_is_asked_to_go() {
    let mut harness = window();
    command(&mut harness, "Second view");
    let view = harness.get_by_label("Second view").rect();
    assert!(view.width() > 200.0 && view.height() > 200.0, "{view:?}");
    let before = session(&harness).active().unwrap().view;
    harness.drag_at(view.center());
    steps(&mut harness);
    harness.drop_at(view.center() + vec2(30.0, 20.0));
    steps(&mut harness);
    let open = session(&harness).active().unwrap();
    assert_eq!(
        (open.view, open.history.past_names().len()),
        (before, 0),
        "nothing is painted or moved"
    );
    command(&mut harness, "Second view");
    assert!(harness.query_by_label("Second view").is_none());
}

#[test]
fn in_a_narrow_window_the_panels_slide_in_and_a_touch_on_the_picture_puts_them_away() {
    let mut harness = window();
    harness.set_size(vec2(390.0, 800.0));
    steps(&mut harness);
    assert!(harness.query_by_label("Layers").is_none());
    press(&mut harness, "Panels");
    until(&mut harness, |harness| harness.query_by_label("Layers").is_some());
    (0..5).for_each(|_| steps(&mut harness));
    let past = session(&harness).active().unwrap().history.past_names().len();
    harness.hover_at(pos2(62.0, 300.0));
    harness.drag_at(pos2(62.0, 300.0));
    steps(&mut harness);
    harness.drop_at(pos2(62.0, 300.0));
    until(&mut harness, |harness| harness.query_by_label("Layers").is_none());
    assert_eq!(session(&harness).active().unwrap().history.past_names().len(), past);
    assert!(harness.query_by_label("Panels").is_some());
}
