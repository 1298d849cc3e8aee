//! Menus, keys, the palette of commands, and what the window remembers.

use super::{
    Story, act_until, command, key, layers, press, session, steps, until, window, window_at,
};
use eframe::egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use rilievo_program::tools::ToolKind;
use rilievo_window::MainWindow;

#[test]
fn a_key_that_is_taken_is_asked_for_and_then_given() {
    let mut harness = window();
    command(&mut harness, "Keyboard shortcuts");
    press(&mut harness, "Find a shortcut");
    harness.get_by_label("Find a shortcut").type_text("bring out");
    steps(&mut harness);
    press(&mut harness, "Add a key to Bring out form");
    key(&mut harness, Modifiers::COMMAND, Key::J);
    harness.get_by_label_contains("belongs to “Layer via copy”");
    press(&mut harness, "Give it to “Bring out form”");
    press(&mut harness, "Close");
    key(&mut harness, Modifiers::COMMAND, Key::J);
    assert_eq!(layers(&harness), ["Background", "Bring out form"]);
}

#[test]
fn what_was_chosen_is_there_the_next_time() {
    let folder = tempfile::tempdir().unwrap();
    let settings = folder.path().join("settings.json");
    let mut harness = window_at(1.0, Some(settings.clone()));
    command(&mut harness, "Dark, gray or light");
    command(&mut harness, "Dark, gray or light");
    command(&mut harness, "Panels on the other side");
    command(&mut harness, "Layers in a window");
    press(&mut harness, "History");
    let is_kept = move |_: &Story| {
        std::fs::read_to_string(&settings).is_ok_and(|text| text.contains("History"))
    };
    until(&mut harness, is_kept);
    drop(harness);
    let harness = window_at(1.0, Some(folder.path().join("settings.json")));
    let panels = harness.get_by_label("History").rect();
    assert!(panels.left() < harness.get_by_label("Canvas").rect().left(), "they stand at the left");
    assert!(!harness.ctx.global_style().visuals.dark_mode);
}

#[test]
fn a_pixel_of_the_canvas_is_one_of_the_screen_at_any_density() {
    for pixels_per_point in [1.0, 1.5, 2.0] {
        let mut harness = window_at(pixels_per_point, None);
        command(&mut harness, "Actual pixels");
        let zoom = session(&harness).active().unwrap().view.unwrap().zoom;
        assert!((zoom * pixels_per_point - 1.0).abs() < 1e-4, "{zoom}");
        harness.get_by_label("100 %");
    }
}

#[test]
fn every_command_stands_in_its_menu() {
    let mut harness = window();
    for (title, commands) in MainWindow::menus() {
        // A tool may have the name of a menu; the menus come first.
        harness.get_all_by_label(title).next().unwrap().click();
        steps(&mut harness);
        for name in commands {
            let found = harness.query_all_by_label_contains(name).map(|node| node.rect());
            // Each menu fits a window of 800 points.
            let lowest = found.map(|rect| rect.bottom()).fold(f32::INFINITY, f32::min);
            assert!(lowest < 800.0, "{name} in {title}: {lowest}");
        }
        key(&mut harness, Modifiers::NONE, Key::Escape);
    }
}

#[test]
fn every_command_is_done_by_its_name() {
    let mut harness = window();
    command(&mut harness, "New gradient layer");
    // They leave the document; and what menus within the menus make is made one by one elsewhere.
    const OTHER: [&str; 2] = ["Close", "Take the tour"];
    let all: Vec<&str> = MainWindow::commands().collect();
    let rows = MainWindow::menus().flat_map(|(_, rows)| rows);
    let names: Vec<&str> = rows.filter(|row| all.contains(row) && !OTHER.contains(row)).collect();
    assert!(names.len() > 60, "{}", names.len());
    for name in names {
        command(&mut harness, name);
        if name == "Give it a shape…" {
            // The layers are looked at before the dialog opens.
            until(&mut harness, |harness| harness.query_by_label("Close").is_some());
        }
        // Closes whatever dialog it opened.
        (0..2).for_each(|_| key(&mut harness, Modifiers::NONE, Key::Escape));
        assert!(session(&harness).active().is_some(), "{name}");
    }
    // The sample may come in front only now; it is closed without a question.
    let close = |harness: &mut Story| command(harness, "Close");
    act_until(&mut harness, close, |harness| harness.query_by_label("Do not save").is_some());
    press(&mut harness, "Do not save");
}

#[test]
fn the_keys_of_krita_do_what_they_do_there_and_say_so_where_they_cannot() {
    let mut harness = window();
    let (ctrl, shift) = (Modifiers::COMMAND, Modifiers::SHIFT);
    let is_selected =
        |harness: &Story| session(harness).active().unwrap().document().active_coverage().is_some();
    for (modifiers, letter, selects) in [
        (ctrl, Key::A, true),
        (ctrl, Key::D, false),
        (ctrl | shift, Key::D, true),
        (ctrl | shift, Key::I, false),
    ] {
        key(&mut harness, modifiers, letter);
        assert_eq!(is_selected(&harness), selects, "{letter:?}");
    }
    for (modifiers, letter, tool) in
        [(ctrl, Key::T, ToolKind::Transform), (Modifiers::NONE, Key::C, ToolKind::Crop)]
    {
        key(&mut harness, modifiers, letter);
        assert_eq!(session(&harness).tool, tool);
    }
    key(&mut harness, ctrl, Key::J);
    assert_eq!(layers(&harness).len(), 2);
    (0..3).for_each(|_| key(&mut harness, shift, Key::Delete));
    assert_eq!(layers(&harness).len(), 0);
    key(&mut harness, ctrl, Key::J);
    harness.get_by_label("Layer via copy: no layer is selected.");
}

#[test]
fn the_interface_is_made_larger_and_the_picture_stays_as_it_is() {
    let mut harness = window();
    let zoom = |harness: &Story| {
        session(harness).active().unwrap().view.unwrap().zoom * harness.ctx.pixels_per_point()
    };
    let before = zoom(&harness);
    command(&mut harness, "Larger interface");
    assert!(harness.ctx.zoom_factor() > 1.05 && (zoom(&harness) / before - 1.0).abs() < 1e-3);
    command(&mut harness, "Smaller interface");
    assert!((harness.ctx.zoom_factor() - 1.0).abs() < 1e-3);
}

#[test]
fn the_palette_puts_what_begins_with_the_words_first() {
    let mut harness = window();
    command(&mut harness, "bend: gloss");
    assert!(matches!(session(&harness).tools.operator, rilievo::Operator::Normal { .. }));
    command(&mut harness, "lock");
    assert_eq!(
        session(&harness).layer().unwrap().lock,
        rilievo::document::LayerLock::Alpha,
        "not “Clip” or “Block”"
    );
    assert_eq!(layers(&harness), ["Background"]);
}

#[test]
fn a_dialog_begins_in_its_first_number_and_enter_accepts() {
    let mut harness = window();
    let typed = |harness: &mut Story, text: &str| {
        harness.event(Event::Text(text.into()));
        steps(harness);
        key(harness, Modifiers::NONE, Key::Enter);
    };
    key(&mut harness, Modifiers::COMMAND, Key::N);
    typed(&mut harness, "300");
    assert_eq!(session(&harness).shown_document().unwrap().size.width, 300);
}

#[test]
fn ctrl_shift_tab_goes_to_the_document_before() {
    let mut harness = window();
    for _ in 0..2 {
        key(&mut harness, Modifiers::COMMAND, Key::N);
        key(&mut harness, Modifiers::NONE, Key::Enter);
    }
    let back = Modifiers::COMMAND | Modifiers::SHIFT;
    for expected in [1, 0, 2] {
        key(&mut harness, back, Key::Tab);
        assert_eq!(session(&harness).current, expected);
    }
    key(&mut harness, Modifiers::COMMAND, Key::Tab);
    assert_eq!(session(&harness).current, 0);
}

#[test]
fn in_full_screen_tab_leaves_nothing_but_the_picture() {
    let mut harness = window();
    key(&mut harness, Modifiers::NONE, Key::Tab);
    assert!(harness.query_by_label("File").is_some(), "in a window the menus stay");
    let root = eframe::egui::ViewportId::ROOT;
    harness.input_mut().viewports.entry(root).or_default().fullscreen = Some(true);
    steps(&mut harness);
    assert!(harness.query_by_label("File").is_none());
    key(&mut harness, Modifiers::NONE, Key::Tab);
    assert!(harness.query_by_label("File").is_some());
}
