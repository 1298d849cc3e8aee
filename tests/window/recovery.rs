//! What an accident left is offered at the next start.

use super::{Story, click, key, layers, session, until, window_of};
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use rilievo_engine::document::{Document, Progress, flatten};
use rilievo_program::session::{Autosave, Session};
use rilievo_window::MainWindow;
use std::path::Path;

/// A window that keeps its recovery logs in a folder.
fn window_recovering(folder: &Path) -> Story {
    let folder = folder.to_owned();
    window_of(1.0, move |ctx| {
        let mut window = MainWindow::new(ctx);
        window.keep_recovery_in(folder.clone());
        window
    })
}

#[test]
fn after_a_crash_the_window_offers_what_was_unsaved() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window_recovering(folder.path());
    click(&mut harness, "File");
    click(&mut harness, "New…");
    click(&mut harness, "Create");
    click(&mut harness, "+ Add");
    click(&mut harness, "Gradient layer");
    // Dropped without its leave, as a crash would.
    drop(harness);
    std::fs::write(folder.path().join("0-broken.log"), "garbage").unwrap();
    let mut harness = window_recovering(folder.path());
    until(&mut harness, |harness| harness.query_by_label("Recover unsaved drawings?").is_some());
    harness.get_by_label("Recover Unnamed").click();
    until(&mut harness, |harness| harness.query_by_label_contains("no complete version").is_some());
    harness.get_by_label("Recover all").click();
    until(&mut harness, |harness| session(harness).active().is_some());
    assert!(harness.query_by_label("Recover unsaved drawings?").is_none());
    assert_eq!(layers(&harness), ["Background", "Gradient"]);
    let open = session(&harness).active().unwrap();
    assert!(open.is_dirty() && open.file.is_none());
    assert_eq!(open.title(), "Untitled 1 (recovered)");
}

#[test]
fn a_recovered_drawing_has_its_shape_and_keeps_it_when_an_edit_is_undone() {
    let folder = tempfile::tempdir().unwrap();
    let mut crashed = Session::default();
    crashed.autosave = Some(Autosave::new(folder.path().into()));
    crashed.replay(Path::new("story"), crate::shape::SHAPED_BLOT).unwrap();
    crashed.keep();
    let picture = |document: &Document| {
        flatten(document, &Progress::default()).unwrap().to_straight_rgba(document.size.rect())
    };
    let before = picture(crashed.active().unwrap().document());
    crashed.autosave.as_ref().unwrap().wait_until_written();
    drop(crashed);
    let mut harness = window_recovering(folder.path());
    until(&mut harness, |harness| harness.query_by_label("Recover unsaved drawings?").is_some());
    harness.get_by_label("Recover Untitled 1").click();
    until(&mut harness, |harness| session(harness).active().is_some());
    let shown = |harness: &Story| picture(session(harness).active().unwrap().document());
    assert!(shown(&harness) == before);
    assert!(harness.query_by_label_contains("No surface").is_none());
    click(&mut harness, "+ Add");
    click(&mut harness, "Gradient layer");
    assert!(shown(&harness) != before);
    key(&mut harness, Modifiers::COMMAND, Key::Z);
    assert!(shown(&harness) == before);
}
