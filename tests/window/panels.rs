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
        "Radiance scaling",
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
        harness.get_by_label(panel).click_secondary();
        steps(&mut harness);
        press(&mut harness, "In a window of its own");
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
fn what_a_small_window_cuts_off_the_options_comes_by_the_wheel() {
    let mut harness = window();
    press(&mut harness, "Brush");
    harness.set_size(vec2(1024.0, 700.0));
    steps(&mut harness);
    let ends = |harness: &Story| harness.get_by_label("Pressure from speed").rect().right();
    assert!(ends(&harness) > 1016.0, "{}", ends(&harness));
    harness.hover_at(pos2(600.0, 68.0));
    steps(&mut harness);
    let (unit, delta) = (MouseWheelUnit::Point, vec2(0.0, -400.0));
    let (phase, source) = (TouchPhase::Move, MouseWheelSource::Wheel);
    let wheel = Event::MouseWheel { unit, delta, phase, source, modifiers: Modifiers::NONE };
    harness.input_mut().events.push(wheel);
    // The wheel is followed smoothly.
    until(&mut harness, |harness| ends(harness) < 1020.0);
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
