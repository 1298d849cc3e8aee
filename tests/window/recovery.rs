//! What an accident left is offered at the next start.

use super::{Story, click, layers, session, until, window_of};
use egui_kittest::kittest::Queryable;
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
    until(&mut harness, |harness| harness.query_by_label_contains("no whole version").is_some());
    harness.get_by_label("Recover all").click();
    until(&mut harness, |harness| session(harness).active().is_some());
    assert!(harness.query_by_label("Recover unsaved drawings?").is_none());
    assert_eq!(layers(&harness), ["Background", "Gradient"]);
    let tab = session(&harness).active().unwrap();
    assert!(tab.is_dirty() && tab.file.is_none());
    assert_eq!(tab.title(), "Untitled 1 (recovered)");
}
