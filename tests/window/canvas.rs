//! The Image menu and the crop tool.

use super::{Story, command, drag, key, press, session, steps, until, window};
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use rilievo::Size;
use rilievo_program::tools::ToolKind;

fn size(harness: &Story) -> Size {
    session(harness).active().unwrap().document().size
}

#[test]
fn a_frame_is_dragged_given_up_by_escape_and_applied_by_enter() {
    let mut harness = window();
    key(&mut harness, Modifiers::NONE, Key::C);
    assert_eq!(session(&harness).tool, ToolKind::Crop);
    drag(&mut harness, vec2(-80.0, -60.0), vec2(80.0, 60.0));
    let frame = session(&harness).tools.crop.area.expect("a frame");
    drag(&mut harness, vec2(120.0, 100.0), vec2(120.0, 100.0));
    assert_eq!(session(&harness).tools.crop.area, Some(frame), "a click beside it does nothing");
    key(&mut harness, Modifiers::NONE, Key::Escape);
    assert_eq!((session(&harness).tools.crop.area, size(&harness)), (None, Size::new(1024, 1024)));
    drag(&mut harness, vec2(-80.0, -60.0), vec2(80.0, 60.0));
    key(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(size(&harness), Size::new(frame.width() as u32, frame.height() as u32));
    key(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(size(&harness), Size::new(1024, 1024));
}

#[test]
fn the_canvas_grows_from_its_anchor_the_picture_shrinks_and_turns() {
    let mut harness = window();
    key(&mut harness, Modifiers::COMMAND | Modifiers::ALT, Key::C);
    harness.get_by_label("The upper left corner stays");
    press(&mut harness, "The lower right corner stays");
    press(&mut harness, "Cancel");
    assert_eq!(size(&harness), Size::new(1024, 1024));
    command(&mut harness, "Image size…");
    harness.get_by_label("Keep the aspect");
    harness.get_by_label_contains("megapixels");
    press(&mut harness, "Cancel");
    command(&mut harness, "Turn canvas…");
    harness.get_by_label("Angle");
    press(&mut harness, "Turn");
    assert_eq!(size(&harness), Size::new(1256, 1256));
    key(&mut harness, Modifiers::COMMAND, Key::Z);
    command(&mut harness, "Crop to selection");
    steps(&mut harness);
    harness.get_by_label_contains("Nothing is selected.");
    command(&mut harness, "Turn canvas left");
    command(&mut harness, "Mirror canvas left and right");
    assert_eq!(session(&harness).active().unwrap().history.undo_label(), Some("Mirror canvas"));
}

#[test]
fn the_canvas_is_trimmed_to_what_is_painted_beside_the_window() {
    let mut harness = window();
    command(&mut harness, "Trim canvas");
    until(&mut harness, |harness| {
        harness.query_by_label_contains("the picture reaches every border").is_some()
    });
    command(&mut harness, "Delete layer");
    command(&mut harness, "New paint layer");
    press(&mut harness, "Brush");
    drag(&mut harness, vec2(-60.0, -20.0), vec2(60.0, 30.0));
    command(&mut harness, "Trim canvas");
    until(&mut harness, |harness| size(harness).width < 1024);
    assert!(size(&harness).height < 1024 && size(&harness).width > 100);
    assert_eq!(session(&harness).active().unwrap().history.undo_label(), Some("Trim"));
    key(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(size(&harness), Size::new(1024, 1024));
}
