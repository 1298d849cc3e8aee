//! Pictures pasted from the clipboard, by the keys and the menu.

use super::{Story, command, key, layers, session, until, window_of};
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use rilievo_engine::document::{Content, Document};
use rilievo_engine::math::{Rect, Size};
use rilievo_engine::raster::{CoverageGrid, Picture};
use rilievo_program::session::actions::PastedPicture;
use rilievo_window::{MainWindow, PastedContent};

/// A window with an empty canvas, whose clipboard holds a picture of 60 × 40 red pixels.
fn window() -> Story {
    let red = || {
        let picture = Picture::srgb8(Size::new(60, 40), vec![[255, 0, 0, 255]; 60 * 40]).unwrap();
        Ok(PastedContent::Picture(PastedPicture { name: "Pasted.png".into(), picture }))
    };
    let mut harness = window_of(1.0, move |ctx| MainWindow::new(ctx).pasting_from(red).recording());
    super::click(&mut harness, "File");
    super::click(&mut harness, "New…");
    super::click(&mut harness, "Create");
    harness
}

fn document(harness: &Story) -> &Document {
    session(harness).active().unwrap().document()
}

fn covered(harness: &Story) -> Rect {
    match &session(harness).layer().unwrap().content {
        Content::Pixels(pixels) => CoverageGrid::of_alpha(&pixels.tiles).covered_rect(),
        _ => panic!("it can be painted on"),
    }
}

#[test]
fn ctrl_v_pastes_paint_under_the_pointer_and_the_line_replays() {
    let mut harness = window();
    let middle = harness.get_by_label("Canvas").rect().center();
    harness.hover_at(middle + vec2(80.0, 50.0));
    super::steps(&mut harness);
    let view = session(&harness).active().unwrap().view.unwrap();
    key(&mut harness, Modifiers::COMMAND, Key::V);
    until(&mut harness, |harness| layers(harness).len() == 2);
    let found = covered(&harness);
    assert_eq!((found.width(), found.height()), (60, 40));
    let at = view.center + rilievo_engine::math::Vec2::new(80.0, 50.0) / view.zoom;
    assert!(
        (found.x0 as f32 + 30.0 - at.x).abs() <= 2.0
            && (found.y0 as f32 + 20.0 - at.y).abs() <= 2.0,
        "{found:?}"
    );
    let lines = harness.state().as_ref().unwrap().replay_text();
    let mut again = rilievo_program::session::Session::default();
    again.replay(std::path::Path::new("story"), &lines).unwrap();
    let Content::Pixels(pixels) = &again.layer().unwrap().content else { panic!("paint") };
    assert_eq!(CoverageGrid::of_alpha(&pixels.tiles).covered_rect(), found);
}

#[test]
fn a_picture_of_another_program_becomes_a_document_or_an_image_layer_where_that_is_asked_for() {
    let mut harness = window();
    command(&mut harness, "Paste as image layer");
    until(&mut harness, |harness| layers(harness).len() == 2);
    assert!(matches!(session(&harness).layer().unwrap().content, Content::Image(_)));
    key(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::V);
    until(&mut harness, |harness| session(harness).open_documents.len() == 2);
    assert_eq!(document(&harness).size, Size::new(60, 40));
    assert_eq!(covered(&harness), Rect::new(0, 0, 60, 40));
}

#[test]
fn a_picture_is_pasted_as_a_reference_and_stays_beside_the_document() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("references");
    let mut harness = window();
    harness.state_mut().as_mut().unwrap().keep_references_in(folder.clone());
    command(&mut harness, "Paste as reference");
    until(&mut harness, |harness| harness.query_by_label_contains("Reference pasted-").is_some());
    let files: Vec<_> = std::fs::read_dir(&folder).unwrap().flatten().collect();
    assert_eq!(files.len(), 1);
    assert_eq!(image::image_dimensions(files[0].path()).unwrap(), (60, 40));
    let past = session(&harness).active().unwrap().history.past_names().len();
    assert_eq!((past, layers(&harness).len()), (0, 1), "the document has nothing of it");
}
