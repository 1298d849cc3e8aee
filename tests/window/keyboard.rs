//! The keyboard alone: menus, the own file dialog, dialogs that Enter accepts.

use super::{
    Story, choose, click, command, drag, key, layers, press, session, steps, until, window,
};
use eframe::egui::{Event, Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use rilievo_program::tools::ToolKind;

fn is_shown(harness: &Story, label: &str) -> bool {
    harness.query_all_by_label_contains(label).next().is_some()
}

#[test]
fn menus_open_by_f10_and_arrows_go_through_them() {
    let mut harness = window();
    key(&mut harness, Modifiers::NONE, Key::F10);
    assert!(is_shown(&harness, "Open maps…"), "File is open");
    key(&mut harness, Modifiers::NONE, Key::ArrowRight);
    assert!(!is_shown(&harness, "Open maps…") && is_shown(&harness, "Free transform"), "Edit is");
    key(&mut harness, Modifiers::NONE, Key::ArrowDown);
    key(&mut harness, Modifiers::NONE, Key::ArrowRight);
    assert!(is_shown(&harness, "Trim canvas"), "from an entry of Edit to Image");
    key(&mut harness, Modifiers::NONE, Key::ArrowLeft);
    key(&mut harness, Modifiers::NONE, Key::ArrowLeft);
    key(&mut harness, Modifiers::NONE, Key::ArrowLeft);
    assert!(is_shown(&harness, "About Rilievo…"), "around the end to Help");
    key(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(!is_shown(&harness, "About Rilievo…"));
    key(&mut harness, Modifiers::NONE, Key::E);
    assert_eq!(session(&harness).tool, ToolKind::Eraser, "keys are the canvas's again");
}

#[test]
fn keys_within_one_frame_are_all_heard_in_their_order() {
    let mut harness = window();
    let before = layers(&harness);
    for _ in 0..3 {
        command(&mut harness, "New paint layer");
    }
    assert_eq!(layers(&harness).len(), before.len() + 3);
    let key = |key, modifiers, pressed| Event::Key {
        key,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers,
    };
    let tap = |k, modifiers| [key(k, modifiers, true), key(k, modifiers, false)];
    let undo = || tap(Key::Z, Modifiers::COMMAND);
    let redo = tap(Key::Z, Modifiers::COMMAND | Modifiers::SHIFT);
    let keys = [undo(), undo(), undo(), redo, undo(), tap(Key::E, Modifiers::NONE)];
    harness.input_mut().events.extend(keys.into_iter().flatten());
    steps(&mut harness);
    until(&mut harness, |harness| session(harness).tool == ToolKind::Eraser);
    assert_eq!(layers(&harness), before);
    assert_eq!(session(&harness).tool, ToolKind::Eraser);
}

#[test]
fn an_entry_is_chosen_by_enter() {
    let mut harness = window();
    key(&mut harness, Modifiers::ALT, Key::L);
    assert!(is_shown(&harness, "New paint layer"), "Alt and a letter open a menu");
    key(&mut harness, Modifiers::NONE, Key::ArrowDown);
    key(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(layers(&harness).len(), 2);
    assert!(!is_shown(&harness, "New fill layer"), "the menu is closed");
    key(&mut harness, Modifiers::NONE, Key::E);
    assert_eq!(session(&harness).tool, ToolKind::Eraser);
}

#[test]
fn alt_alone_opens_the_menus_and_a_held_one_does_not() {
    let mut harness = window();
    let tap = |harness: &mut Story, moved: bool| {
        harness.event(Event::ModifiersChanged(Modifiers::ALT));
        harness.step();
        if moved {
            harness.hover_at(eframe::egui::pos2(500.0, 500.0));
            harness.step();
        }
        harness.event(Event::ModifiersChanged(Modifiers::NONE));
        steps(harness);
    };
    tap(&mut harness, true);
    assert!(!is_shown(&harness, "Open maps…"), "it was held for the canvas");
    tap(&mut harness, false);
    assert!(is_shown(&harness, "Open maps…"));
    key(&mut harness, Modifiers::NONE, Key::Escape);
    command(&mut harness, "Preferences…");
    press(&mut harness, "Interface");
    press(&mut harness, "Alt opens the menus");
    key(&mut harness, Modifiers::NONE, Key::Escape);
    tap(&mut harness, false);
    assert!(!is_shown(&harness, "Open maps…"), "by choice it does not");
}

#[test]
fn a_typed_folder_is_listed_and_marked_and_the_arrows_choose_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let deep = folder.path().join("deep");
    std::fs::create_dir(&deep).unwrap();
    let fill = r##"{"format":"rilievo","version":1,"canvas":{"width":40,"height":20},
        "layers":[{"kind":"fill","name":"only","color":"#336699"}]}"##;
    for name in ["one.json", "two.json"] {
        std::fs::write(deep.join(name), fill).unwrap();
    }
    let mut harness = window();
    command(&mut harness, "Open…");
    until(&mut harness, |harness| harness.query_by_label("File name").is_some());
    harness.get_by_label("File name").type_text(&format!("{}/", deep.display()));
    steps(&mut harness);
    assert!(is_shown(&harness, "one.json") && is_shown(&harness, "two.json"), "it is listed");
    press(&mut harness, "Bookmark");
    press(&mut harness, "Up");
    press(&mut harness, "deep");
    steps(&mut harness);
    key(&mut harness, Modifiers::NONE, Key::ArrowDown);
    key(&mut harness, Modifiers::NONE, Key::ArrowDown);
    assert_eq!(harness.get_by_label("File name").value().as_deref(), Some("two.json"));
    key(&mut harness, Modifiers::NONE, Key::Enter);
    until(&mut harness, |harness| layers(harness) == ["only"]);
    // A recipe is among the recent files, too.
    click(&mut harness, "File");
    press(&mut harness, "Open recent");
    assert!(is_shown(&harness, "two.json"));
}

#[test]
fn a_folder_without_its_last_separator_is_entered_by_enter() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("deep")).unwrap();
    std::fs::write(folder.path().join("deep").join("three.png"), b"no picture").unwrap();
    let mut harness = window();
    command(&mut harness, "Open…");
    choose(&mut harness, &folder.path().join("deep"));
    assert!(is_shown(&harness, "three.png"), "the dialog stays, in that folder");
    key(&mut harness, Modifiers::NONE, Key::Escape);
}

#[test]
fn a_gradient_is_painted_or_live_by_choice() {
    let mut harness = window();
    command(&mut harness, "New paint layer");
    press(&mut harness, "Gradient");
    drag(&mut harness, vec2(-100.0, 0.0), vec2(100.0, 0.0));
    assert_eq!(layers(&harness), ["Background", "Paint"]);
    assert_eq!(session(&harness).active().unwrap().history.undo_label(), Some("Gradient"));
    press(&mut harness, "Live");
    drag(&mut harness, vec2(-100.0, 60.0), vec2(100.0, 60.0));
    assert_eq!(layers(&harness), ["Background", "Paint", "Gradient"]);
}
