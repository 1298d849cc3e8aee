//! A comic's page: panels made by the dialog, cut and drawn by the tool, painted in; and the shape of a
//! vector drawing by its paths.

use super::{
    Story, choose, command, drag, key, layers, press, session, steps, until, window, window_of,
};
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use rilievo::Content;
use rilievo_program::tools::ToolKind;
use rilievo_window::MainWindow;
use tempfile::TempDir;

fn panels(harness: &Story) -> Vec<String> {
    let open = session(harness).active().expect("no document");
    let all = open.document().layers.iter().rev().map(|layer| layer.name.clone());
    all.filter(|name| name.starts_with("Panel")).collect()
}

fn selected(harness: &Story) -> String {
    session(harness).layer().map_or(String::new(), |layer| layer.name.clone())
}

#[test]
fn a_page_is_divided_cut_painted_in_and_its_frame_is_moved() {
    let mut harness = window();
    command(&mut harness, "Panels…");
    press(&mut harness, "Create");
    assert_eq!(panels(&harness), (1..=6).map(|n| format!("Panel {n}")).collect::<Vec<_>>());
    assert_eq!(selected(&harness), "Drawing");
    // A level cut through the middle row, which goes over both of its panels.
    key(&mut harness, Modifiers::SHIFT, Key::C);
    assert_eq!(session(&harness).tool, ToolKind::Panels);
    let far = 0.5 * harness.get_by_label("Canvas").rect().width() - 10.0;
    drag(&mut harness, vec2(-far, 0.0), vec2(far, 0.0));
    assert_eq!(panels(&harness).len(), 8);
    key(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(panels(&harness).len(), 6);
    // A click selects the frame, and the figure tool drags its corner.
    drag(&mut harness, vec2(-60.0, 0.0), vec2(-60.0, 0.0));
    assert_eq!(selected(&harness), "Frame");
    let frame = |harness: &Story| {
        let layer = session(harness).layer().expect("no layer is selected");
        let Content::Image(live) = &layer.content else { panic!("it is no path") };
        *live.params().source.path().and_then(|path| path.figure()).expect("it is no figure")
    };
    let was = frame(&harness);
    let view = session(&harness).active().unwrap().view.unwrap();
    let at = view.screen_from_canvas().transform_point2(was.to);
    key(&mut harness, Modifiers::SHIFT, Key::U);
    drag(&mut harness, vec2(at.x, at.y), vec2(at.x - 30.0, at.y - 20.0));
    assert!(frame(&harness).to.x < was.to.x && frame(&harness).from == was.from);
    // Drawn ones lie above all others.
    key(&mut harness, Modifiers::SHIFT, Key::C);
    press(&mut harness, "What a drag does");
    harness.get_all_by_label("Draws panels").last().expect("the choice").click();
    steps(&mut harness);
    drag(&mut harness, vec2(-40.0, -30.0), vec2(50.0, 40.0));
    assert_eq!(panels(&harness).len(), 7);
    assert_eq!(selected(&harness), "Drawing");
    let name = layers(&harness);
    assert!(name.iter().any(|name| name == "Panel 7"), "{name:?}");
}

#[test]
fn the_box_of_a_frame_lets_what_lies_beneath_be_seen_outside() {
    let mut harness = window();
    command(&mut harness, "Panels…");
    press(&mut harness, "Create");
    key(&mut harness, Modifiers::SHIFT, Key::C);
    drag(&mut harness, vec2(-60.0, 0.0), vec2(-60.0, 0.0));
    press(&mut harness, "Properties");
    // It may lie beneath the panel's lower edge.
    harness.get_by_label("Frame of its group").click_accesskit();
    steps(&mut harness);
    let layer = session(&harness).layer().expect("no layer is selected");
    assert!(!layer.is_frame());
}

#[test]
fn an_svg_is_offered_a_part_for_each_of_its_paths() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("emblem.svg");
    let text = r##"<svg xmlns="http://www.w3.org/2000/svg" width="320" height="240">
        <circle id="disc" cx="150" cy="120" r="90" fill="#c06030"/>
        <path id="leaf" d="M80 120 Q150 20 220 120 Z" fill="#308050"/></svg>"##;
    std::fs::write(&file, text).unwrap();
    let mut harness = window_of(1.0, MainWindow::new);
    key(&mut harness, Modifiers::COMMAND, Key::O);
    choose(&mut harness, &file);
    until(&mut harness, |harness| harness.query_by_label("Only paint").is_some());
    harness.get_by_label("A part for each path of the file");
    press(&mut harness, "Give it a shape");
    let parts = |harness: &Story| {
        let open = session(harness).active().unwrap();
        open.document().parts.list.iter().map(|part| part.name.clone()).collect::<Vec<_>>()
    };
    until(&mut harness, |harness| !parts(harness).is_empty());
    assert_eq!(parts(&harness), ["disc", "leaf"]);
    let document = session(&harness).active().unwrap().document().clone();
    let group = document.layers[0].content.group().expect("the paths are no group");
    let names: Vec<&str> = group.layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["disc", "leaf"]);
    assert!(document.surface.is_some());
}
