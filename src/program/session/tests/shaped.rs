//! A drawing with a shape, however it comes in and whatever is done to the layer that outlines it:
//! what is shown, what is exported, and what is saved are the same picture.

use super::*;
use crate::document::{Document, Progress, flatten};
use crate::io::{self, Budget, Overwrite};
use crate::raster::{TileGrid, picture::Texels};
use crate::session::autosave::{Autosave, RestoredDocument};
use crate::session::{OpenDocument, actions::files, storage};
use std::path::PathBuf;

/// A drawing in flat colors with a shape, its base lit.
fn shaped_drawing() -> Session {
    let size = crate::math::Size::new(160, 120);
    let texel = |i: usize| {
        let (x, y) = ((i % 160) as f32 + 0.5, (i / 160) as f32 + 0.5);
        let within = |cx: f32, cy: f32, r: f32| (x - cx).hypot(y - cy) < r;
        match () {
            () if within(60.0, 50.0, 30.0) => [220, 160, 80, 255],
            () if within(100.0, 70.0, 34.0) => [60, 90, 200, 255],
            () => [0; 4],
        }
    };
    let rgba: Vec<u8> = (0..size.area()).flat_map(texel).collect();
    let tiles = TileGrid::from_straight_rgba(&rgba, 160, 120, 0, 0);
    let paint = crate::document::PixelLayer { tiles, ..Default::default() };
    let layer = Arc::new(Layer::new("flats", Content::Pixels(paint)));
    let mut session = Session::default();
    let document = Document { layers: vec![layer], ..Document::empty(size) };
    session.add_document(OpenDocument::new("flats", document, None));
    tell(&mut session, r#"{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":true}"#);
    assert_eq!(document_of(&session).parts.list.len(), 2);
    session
}

fn tell(session: &mut Session, lines: &str) {
    session.replay(Path::new("story"), lines).unwrap_or_else(|e| panic!("{e}"));
}

fn document_of(session: &Session) -> &Document {
    session.active().unwrap().document()
}

fn picture(document: &Document) -> Vec<u8> {
    flatten(document, &Progress::default()).unwrap().to_straight_rgba(document.size.rect())
}

fn read_picture(file: &Path) -> Vec<u8> {
    let bytes = std::fs::read(file).unwrap();
    match io::picture::decode(file, &bytes, &Budget::default()).unwrap().texels {
        Texels::Srgb8(texels) => texels.as_flattened().to_vec(),
        _ => panic!("a picture of bytes"),
    }
}

/// What is shown of a document, exported, saved for other programs, and seen after it is opened
/// again.
fn everywhere(document: &Document, folder: &Path) -> [Vec<u8>; 4] {
    let at = |name: &str| -> PathBuf { folder.join(name) };
    let (settings, terms) = (
        crate::session::ExportSettings::default(),
        io::Terms::export(Overwrite::Forced, Vec::new()),
    );
    files::export(document, &at("a.png"), &settings, terms, &Progress::default()).unwrap();
    storage::save(&at("a.ora"), document, Overwrite::Forced, &Progress::default())
        .unwrap()
        .unwrap();
    let opened = storage::open(&at("a.ora")).unwrap();
    assert!(opened.notes.is_empty(), "{:?}", opened.notes);
    let merged = opened
        .open
        .stored_preview
        .take()
        .expect("a merged picture")
        .to_straight_rgba(document.size.rect());
    [picture(document), read_picture(&at("a.png")), merged, picture(opened.open.document())]
}

fn assert_same_everywhere(document: &Document, what: &str) {
    let folder = tempfile::tempdir().unwrap();
    let [shown, exported, merged, opened] = everywhere(document, folder.path());
    let differing =
        |other: &[u8]| shown.chunks(4).zip(other.chunks(4)).filter(|(a, b)| a != b).count();
    let found = [
        ("exported", differing(&exported)),
        ("merged", differing(&merged)),
        ("opened", differing(&opened)),
    ];
    assert!(
        found.iter().all(|(_, pixels)| *pixels == 0),
        "{what}: pixels that differ from what is shown: {found:?}"
    );
}

const LIQUIFY: &str = r##"{"in":"layer","do":"select","layer":"0"}
{"in":"pointer","do":"press","tool":"liquify","pen":[50,60],"px_per_pt":1}
{"in":"pointer","do":"drag","pens":[[70,66],[90,70]]}
{"in":"pointer","do":"release"}"##;

#[test]
fn liquify_on_the_layer_that_outlines_parts_shows_what_the_file_shows() {
    let mut session = shaped_drawing();
    let before = picture(document_of(&session));
    tell(&mut session, LIQUIFY);
    let document = document_of(&session);
    assert!(document.layers[0].liquify.is_some() && before != picture(document));
    assert_same_everywhere(document, "liquify");
    let bent = picture(document);
    tell(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert!(before == picture(document_of(&session)));
    tell(&mut session, r#"{"in":"edit","do":"redo"}"#);
    assert!(bent == picture(document_of(&session)));
}

#[test]
fn after_a_crash_a_drawing_has_its_shape() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = shaped_drawing();
    session.autosave = Some(Autosave::new(folder.path().into()));
    session.keep();
    tell(&mut session, LIQUIFY);
    session.keep();
    let before = picture(document_of(&session));
    session.autosave.as_ref().unwrap().wait_until_written();
    drop(session);
    let lost = Autosave::new(folder.path().into()).find_lost_sessions();
    let left = lost.list().pop().unwrap();
    let RestoredDocument { open, .. } =
        lost.bring_back(left, &Progress::default()).unwrap().unwrap();
    let mut session = Session::default();
    session.add_document(open);
    assert!(before == picture(document_of(&session)));
    assert_same_everywhere(document_of(&session), "recovered");
    tell(&mut session, r##"{"in":"layer","do":"add","kind":"gradient"}"##);
    tell(&mut session, r#"{"in":"edit","do":"undo"}"#);
    assert!(before == picture(document_of(&session)), "an edit that is undone leaves the shape");
}

#[test]
fn a_recovery_that_is_canceled_is_offered_again() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = shaped_drawing();
    session.autosave = Some(Autosave::new(folder.path().into()));
    session.keep();
    session.autosave.as_ref().unwrap().wait_until_written();
    drop(session);
    let lost = Autosave::new(folder.path().into()).find_lost_sessions();
    let given_up = Progress::default();
    given_up.cancel();
    assert!(lost.bring_back(lost.list().pop().unwrap(), &given_up).unwrap().is_none());
    let left = lost.list();
    assert!(left.len() == 1 && !left[0].has_failed);
}

#[test]
fn a_document_whose_shape_is_still_to_be_made_is_shown_exported_and_saved_with_it() {
    let session = shaped_drawing();
    let document = document_of(&session);
    let flat = Document { surface: None, ..document.clone() };
    assert!(picture(&flat) != picture(document) && !flat.is_shaped());
    let open = OpenDocument::new("came in flat", flat.clone(), None);
    assert!(open.document().is_shaped() && !open.is_dirty());
    let folder = tempfile::tempdir().unwrap();
    let [_, exported, merged, opened] = everywhere(&flat, folder.path());
    let shown = picture(document);
    assert!(shown == exported && shown == merged && shown == opened);
    // What waits for the shape can be canceled while it waits.
    let given_up = Progress::default();
    given_up.cancel();
    let file = folder.path().join("b.ora");
    assert!(
        storage::save(&file, &flat, Overwrite::Nothing, &given_up).unwrap().is_none()
            && !file.exists()
    );
}

#[test]
fn a_lit_drawing_is_made_small_though_its_contact_shade_reaches_as_little_as_it_can() {
    let mut session = shaped_drawing();
    tell(&mut session, r#"{"in":"canvas","do":"scale","width":40,"height":30,"filter":"smooth"}"#);
    assert_eq!(document_of(&session).size, crate::math::Size::new(40, 30), "{:?}", session.notes);
    assert_same_everywhere(document_of(&session), "made small");
}
