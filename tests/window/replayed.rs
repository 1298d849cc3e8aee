//! Actions recorded in the window, replayed without it, end in the very same document.

use super::{
    Story, click, command, drag, drop_files, key, layers, press, session, steps, until, window_of,
};
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use rilievo::{Document, Overwrite, Progress, flatten};
use rilievo_program::session::{Session, storage};
use rilievo_window::MainWindow;
use std::io::Read;
use std::path::Path;

/// A project with a shape in it, as a file.
pub fn project(folder: &Path) -> std::path::PathBuf {
    let normals = folder.join("wave_normal.png");
    let at = |x: u32, y: u32| {
        let n = [0.6 * (x as f32 * 0.06).sin(), 0.5 * (y as f32 * 0.05).cos(), 0.7f32];
        let length = n.iter().map(|v| v * v).sum::<f32>().sqrt();
        image::Rgb(n.map(|v| (v / length * 127.5 + 128.0) as u8))
    };
    image::RgbImage::from_fn(256, 192, at).save(&normals).unwrap();
    let opened = storage::open_maps(&storage::maps_of(Some(&normals), None)).unwrap();
    let file = folder.join("wave.ora");
    storage::save(&file, opened.open.document(), Overwrite::Nothing, &Progress::default())
        .unwrap()
        .unwrap();
    file
}

/// The bytes of the picture, and of the document as its project describes it.
pub fn bytes(document: &Document, folder: &Path, name: &str) -> (Vec<u8>, Vec<u8>) {
    let picture =
        flatten(document, &Progress::default()).unwrap().to_straight_rgba(document.size.rect());
    let file = folder.join(name);
    storage::save(&file, document, Overwrite::Anything, &Progress::default()).unwrap().unwrap();
    let mut archive = zip::ZipArchive::new(std::fs::File::open(file).unwrap()).unwrap();
    let mut text = Vec::new();
    archive.by_name("rilievo/document.json").unwrap().read_to_end(&mut text).unwrap();
    (picture, text)
}

fn slide(harness: &mut Story, label: &str, by_pt: f32) {
    let slider = harness.get_all_by_label(label).last().unwrap().rect();
    harness.drag_at(slider.center());
    steps(harness);
    harness.hover_at(slider.center() + vec2(0.5 * by_pt, 0.0));
    steps(harness);
    harness.drop_at(slider.center() + vec2(by_pt, 0.0));
    steps(harness);
}

#[test]
fn a_story_of_photo_strokes_moves_and_masks_replays_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let (file, photo) = (project(folder.path()), folder.path().join("photo.png"));
    image::RgbImage::from_fn(90, 60, |x, y| {
        image::Rgb([(x * 2) as u8, (y * 4) as u8, (x * y % 255) as u8])
    })
    .save(&photo)
    .unwrap();
    let mut harness = window_of(1.0, move |ctx| {
        let mut window = MainWindow::new(ctx).recording();
        window.begin(vec![file.clone()]);
        window
    });
    until(&mut harness, |harness| session(harness).active().is_some());
    drop_files(&mut harness, &[&photo]);
    until(&mut harness, |harness| layers(harness).contains(&"photo".to_owned()));
    // The photo becomes a reflection, and one of its anchors is moved.
    key(&mut harness, Modifiers::NONE, Key::A);
    slide(&mut harness, "Strength", 18.0);
    drag(&mut harness, vec2(0.0, 0.0), vec2(60.0, 25.0));
    // Highlights that cling, one of them moved.
    key(&mut harness, Modifiers::NONE, Key::B);
    key(&mut harness, Modifiers::NONE, Key::F3);
    drag(&mut harness, vec2(-120.0, -40.0), vec2(40.0, -70.0));
    drag(&mut harness, vec2(-60.0, 60.0), vec2(90.0, 90.0));
    key(&mut harness, Modifiers::NONE, Key::V);
    drag(&mut harness, vec2(-40.0, -55.0), vec2(10.0, -10.0));
    command(&mut harness, "Undo");
    command(&mut harness, "Redo");
    // A layer masked, one turned to paint outside the window, one moved in the list.
    press(&mut harness, "Properties");
    press(&mut harness, "Show all");
    key(&mut harness, Modifiers::NONE, Key::B);
    key(&mut harness, Modifiers::NONE, Key::D);
    drag(&mut harness, vec2(-100.0, 0.0), vec2(-20.0, 30.0));
    click(&mut harness, "+ Add");
    click(&mut harness, "Gradient layer");
    slide(&mut harness, "Opacity", -14.0);
    command(&mut harness, "Turn layer into pixels");
    until(&mut harness, |harness| {
        matches!(session(harness).layer().unwrap().content, rilievo::Content::Pixels(_))
    });
    command(&mut harness, "Move layer down");
    let seen = session(&harness).active().unwrap().document().clone();
    assert_eq!(seen.layers.len(), 5, "{:?}", layers(&harness));
    assert!(harness.query_by_label("Dismiss").is_none(), "nothing went wrong");

    let text = harness.state().as_ref().unwrap().replay_text();
    let mut again = Session::default();
    again.replay(Path::new("story.jsonl"), &text).unwrap();
    let replayed = again.active().unwrap().document();
    let [(picture, described), (again, described_again)] =
        [bytes(&seen, folder.path(), "seen.ora"), bytes(replayed, folder.path(), "again.ora")];
    assert!(picture == again, "the pictures differ");
    assert_eq!(String::from_utf8(described), String::from_utf8(described_again));
}
