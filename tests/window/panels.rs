//! Every panel next to the canvas, in a window of its own, and hidden.

use super::{
    Story, choose, click, command, key, press, session, steps, stroke, until, window, window_at,
};
use eframe::egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, TouchPhase, pos2, vec2,
};
use egui_kittest::kittest::Queryable;
use rilievo::{Progress, flatten_layer};
use std::path::Path;

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
fn a_second_view_is_painted_in_and_moved_apart_from_the_first() {
    let mut harness = window();
    command(&mut harness, "Second view");
    let view = harness.get_by_label("Second view").rect();
    assert!(view.width() > 200.0 && view.height() > 200.0, "{view:?}");
    let before = session(&harness).active().unwrap().view;
    let past = |harness: &Story| session(harness).active().unwrap().history.past_names().len();
    let drag = |harness: &mut Story| {
        harness.drag_at(view.center());
        steps(harness);
        harness.drop_at(view.center() + vec2(30.0, 20.0));
        steps(harness);
    };
    // The middle of the view is the middle of the canvas: a stroke begins there.
    drag(&mut harness);
    let open = session(&harness).active().unwrap();
    assert_eq!((open.view, past(&harness)), (before, 1), "a stroke, and no other view");
    let document = open.document();
    let middle = document.size.center();
    let painted = flatten_layer(
        document,
        document.layers[document.layers.len() - 1].id,
        &Progress::default(),
    )
    .unwrap();
    let [x, y] = [middle.x as i32, middle.y as i32];
    assert!(painted.bounds().contains(x, y), "{:?}, not {middle}", painted.bounds());
    // The hand moves this view alone.
    command(&mut harness, "Hand");
    drag(&mut harness);
    assert_eq!((session(&harness).active().unwrap().view, past(&harness)), (before, 1));
    command(&mut harness, "Brush");
    drag(&mut harness);
    let document = session(&harness).active().unwrap().document();
    let painted = flatten_layer(
        document,
        document.layers[document.layers.len() - 1].id,
        &Progress::default(),
    )
    .unwrap();
    let left = middle.x - painted.bounds().x0 as f32;
    assert!(left > 25.0, "the second stroke lies where the view was moved to, {left} px left");
    command(&mut harness, "Second view");
    assert!(harness.query_by_label("Second view").is_none());
}

#[test]
fn a_reference_is_pinned_over_the_canvas_gives_its_colors_and_is_there_again() {
    let home = tempfile::tempdir().unwrap();
    let (settings, file) = (home.path().join("settings.json"), home.path().join("parrot.png"));
    let red = image::RgbImage::from_pixel(64, 32, image::Rgb([200, 30, 40]));
    red.save(&file).unwrap();
    let mut harness = window_at(1.0, Some(settings.clone()));
    command(&mut harness, "Pin a reference");
    choose(&mut harness, &file);
    let is_seen = |harness: &Story| harness.query_by_label("Reference parrot.png").is_some();
    until(&mut harness, is_seen);
    let place = |harness: &Story| harness.get_by_label("Reference parrot.png").rect();
    // It has the shape of the picture once that is read.
    until(&mut harness, |harness| (place(harness).aspect_ratio() - 2.0).abs() < 0.02);
    let first = place(&harness);
    let drag = |harness: &mut Story, from, to| {
        harness.drag_at(from);
        steps(harness);
        harness.hover_at(to);
        steps(harness);
        harness.drop_at(to);
        steps(harness);
    };
    drag(&mut harness, first.center(), first.center() + vec2(50.0, 40.0));
    assert!((place(&harness).center() - first.center() - vec2(50.0, 40.0)).length() < 1.0);
    let moved = place(&harness);
    drag(&mut harness, moved.max - vec2(4.0, 4.0), moved.max + vec2(60.0, 0.0));
    assert!((place(&harness).width() - moved.width() - 64.0).abs() < 1.0, "{:?}", place(&harness));
    // Nothing was painted, and a click with the eyedropper takes its color.
    let open = session(&harness).active().unwrap();
    assert_eq!(open.history.past_names().len(), 0);
    command(&mut harness, "Eyedropper");
    let at = place(&harness).center();
    drag(&mut harness, at, at);
    assert_eq!(session(&harness).tools.color.to_string(), "#c81e28");
    let kept = place(&harness).size();
    command(&mut harness, "Show references");
    assert!(!is_seen(&harness));
    command(&mut harness, "Show references");
    // The settings are written a moment after each change: this waits for the last one.
    let stored = |settings: &Path| -> Option<f64> {
        let text = std::fs::read_to_string(settings).ok()?;
        let value: serde_json::Value = serde_json::from_str(&text).ok()?;
        value["references"][0]["width"].as_f64()
    };
    until(&mut harness, |_| {
        stored(&settings).is_some_and(|width| (width - f64::from(kept.x)).abs() < 0.1)
    });
    drop(harness);
    let mut harness = window_at(1.0, Some(settings));
    until(&mut harness, |harness| is_seen(harness) && place(harness).size() == kept);
    command(&mut harness, "Remove references");
    assert!(!is_seen(&harness));
}

#[test]
fn the_picture_is_shown_as_saved_until_anything_is_done() {
    let mut harness = window();
    stroke(&mut harness, vec2(80.0, 40.0));
    command(&mut harness, "Show as saved");
    assert!(session(&harness).shows_saved);
    command(&mut harness, "Zoom in");
    assert!(session(&harness).shows_saved, "a view of it is moved");
    stroke(&mut harness, vec2(-80.0, 40.0));
    let now = session(&harness);
    assert!(!now.shows_saved);
    assert_eq!(now.active().unwrap().history.past_names().len(), 2, "and the stroke is painted");
}

#[test]
fn a_proof_is_shown_with_the_profile_of_a_file_and_kept_for_the_next_time() {
    let home = tempfile::tempdir().unwrap();
    let (settings, letter) = (home.path().join("settings.json"), home.path().join("a.icc"));
    std::fs::write(&letter, "Dear reader").unwrap();
    let mut harness = window_at(1.0, Some(settings.clone()));
    command(&mut harness, "Show proof");
    choose(&mut harness, &letter);
    until(&mut harness, |harness| {
        harness.query_by_label_contains("it is not an ICC profile").is_some()
    });
    assert!(!session(&harness).shows_proof);
    let profile = home.path().join("press.icc");
    std::fs::write(&profile, rilievo_io::icc_profiles::icc_of(Default::default())).unwrap();
    command(&mut harness, "Show proof");
    choose(&mut harness, &profile);
    until(&mut harness, |harness| session(harness).shows_proof);
    command(&mut harness, "Mark colors out of gamut");
    stroke(&mut harness, vec2(60.0, 30.0));
    assert!(session(&harness).marks_gamut && session(&harness).shows_proof);
    command(&mut harness, "Show proof");
    assert!(!session(&harness).shows_proof);
    until(&mut harness, |_| {
        std::fs::read_to_string(&settings).is_ok_and(|text| text.contains("press.icc"))
    });
    drop(harness);
    let mut harness = window_at(1.0, Some(settings));
    command(&mut harness, "Show proof");
    until(&mut harness, |harness| session(harness).shows_proof);
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
