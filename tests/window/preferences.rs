//! The dialog of preferences: its pages, keys and their presets, and taking colors.

use super::{Story, command, key, press, session, steps, window, window_at};
use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use rilievo::Color;
use rilievo_program::tools::ToolKind;

/// Opens the preferences by their key, at a page.
fn open(harness: &mut Story, page: &str) {
    key(harness, Modifiers::COMMAND, Key::Comma);
    press(harness, page);
}

#[test]
fn every_page_is_shown_and_escape_closes_them() {
    let mut harness = window();
    for (page, holds) in [
        ("Interface", "Large targets"),
        ("Keys", "Preset of keys"),
        ("Pen", "Place to try the pen"),
        ("Colors", "Remember recent colors"),
        ("Files", "Clear recent files"),
        ("Memory", "Undo steps"),
    ] {
        open(&mut harness, page);
        assert!(harness.query_all_by_label_contains(holds).next().is_some(), "{page}: no {holds}");
        key(&mut harness, Modifiers::NONE, Key::Escape);
        assert!(harness.query_by_label("Preferences").is_none(), "{page}");
    }
}

#[test]
fn a_preset_of_keys_counts_at_once_and_in_the_next_run() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("settings.json");
    let mut harness = window_at(1.0, Some(file.clone()));
    open(&mut harness, "Keys");
    press(&mut harness, "Preset of keys");
    press(&mut harness, "Krita");
    key(&mut harness, Modifiers::NONE, Key::Escape);
    key(&mut harness, Modifiers::NONE, Key::P);
    assert_eq!(session(&harness).tool, ToolKind::Eyedropper);
    // Settings are written after a pause.
    let written = || std::fs::read_to_string(&file).is_ok_and(|text| text.contains("\"krita\""));
    super::until(&mut harness, |_| written());
    let mut next = window_at(1.0, Some(file.clone()));
    key(&mut next, Modifiers::NONE, Key::P);
    assert_eq!(session(&next).tool, ToolKind::Eyedropper);
}

#[test]
fn a_preset_asks_before_it_replaces_keys_of_the_user() {
    let mut harness = window();
    open(&mut harness, "Keys");
    press(&mut harness, "Find a shortcut");
    harness.get_by_label("Find a shortcut").type_text("rulers");
    steps(&mut harness);
    press(&mut harness, "Add a key to Rulers");
    key(&mut harness, Modifiers::COMMAND | Modifiers::ALT, Key::F7);
    press(&mut harness, "Preset of keys");
    press(&mut harness, "Photoshop");
    press(&mut harness, "Keep mine");
    assert!(harness.query_by_label_contains("F7 of").is_some(), "it is kept");
    press(&mut harness, "Preset of keys");
    press(&mut harness, "Photoshop");
    press(&mut harness, "Replace them");
    assert!(harness.query_by_label_contains("F7 of").is_none(), "it is replaced");
}

#[test]
fn undo_steps_limit_the_documents_that_are_open() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("settings.json");
    std::fs::write(&file, r#"{ "preferences": { "undo steps": 12 } }"#).unwrap();
    let mut harness = window_at(1.0, Some(file));
    for _ in 0..14 {
        command(&mut harness, "New fill layer");
    }
    assert_eq!(session(&harness).active().unwrap().history.past_names().len(), 12);
}

/// Whether a press takes the color under the pen while this is held.
fn takes_color(harness: &mut Story, held: Modifiers) -> bool {
    let before = session(harness).tools.color;
    let middle = harness.get_by_label("Canvas").rect().center();
    harness.event(Event::ModifiersChanged(held));
    harness.hover_at(middle);
    steps(harness);
    harness.drag_at(middle);
    steps(harness);
    assert_eq!(session(harness).tools.color, before, "not before the pen lifts");
    harness.drop_at(middle);
    steps(harness);
    harness.event(Event::ModifiersChanged(Modifiers::NONE));
    steps(harness);
    session(harness).tools.color == Color::WHITE
}

#[test]
fn a_color_is_taken_with_ctrl_or_alt_by_choice() {
    let mut harness = window();
    press(&mut harness, "Brush");
    for held in [Modifiers::COMMAND, Modifiers::ALT] {
        key(&mut harness, Modifiers::NONE, Key::D);
        assert!(takes_color(&mut harness, held), "{held:?}");
    }
    open(&mut harness, "Colors");
    harness.get_by_role_and_label(Role::ComboBox, "Hold").click();
    steps(&mut harness);
    press(&mut harness, "Ctrl");
    key(&mut harness, Modifiers::NONE, Key::Escape);
    for (held, takes) in [(Modifiers::COMMAND, true), (Modifiers::ALT, false)] {
        key(&mut harness, Modifiers::NONE, Key::D);
        assert_eq!(takes_color(&mut harness, held), takes, "{held:?}");
    }
    let drawn = session(&harness).active().unwrap().history.past_names().len();
    assert_eq!(drawn, 1, "Alt draws now");
}
