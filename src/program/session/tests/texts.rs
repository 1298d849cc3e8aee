//! Texts through a session: written, retyped, bent, saved, opened again, drawn larger.

use super::*;
use crate::document::Document;
use crate::math::Size;
use crate::paint::PlacedImage;
use crate::raster::{Outside, TileGrid};

fn write(lines: &[&str]) -> Session {
    let mut session = Session::default();
    session.add_document(OpenDocument::new("page", Document::empty(Size::new(200, 120)), None));
    for line in lines {
        let line = line.replace('\n', "");
        session.replay(Path::new("story"), &line).unwrap_or_else(|e| panic!("{e}"));
    }
    session
}

fn text_of(session: &Session) -> (String, PlacedImage) {
    let document = session.active().unwrap().document();
    let found = document.walk().into_iter().find_map(|(_, layer)| match &layer.content {
        Content::Image(live) => Some((layer.name.clone(), live.params().clone())),
        _ => None,
    });
    found.unwrap()
}

fn render(document: &Document) -> TileGrid {
    flatten(document, &Progress::default()).unwrap()
}

const WRITE: &str = r##"{"in":"layer","do":"write","at":[40,60],
"text":{"string":"Rel","font":"Hack","size":30,"color":"#c03020"}}"##;

#[test]
fn a_text_is_seen_where_it_was_written_and_keeps_its_place_while_it_is_retyped() {
    let mut session = write(&[WRITE]);
    let (name, image) = text_of(&session);
    assert_eq!((name.as_str(), image.outside), ("Rel", Outside::None));
    let bounds = |session: &Session| {
        let picture = render(session.active().unwrap().document());
        let inked = (0..120 * 200).filter(|i| picture.pixel(i % 200, i / 200)[3] > 127);
        inked.fold((200, 120, 0, 0), |(x0, y0, x1, y1), i| {
            let (x, y) = (i % 200, i / 200);
            (x0.min(x), y0.min(y), x1.max(x), y1.max(y))
        })
    };
    let first = bounds(&session);
    assert!((40..46).contains(&first.0) && (58..=60).contains(&first.3), "{first:?}");
    let retype = r##"{"in":"layer","do":"set","layer":"0","done":true,
"to":{"do":"text","text":{"string":"Rels and more","font":"Hack","size":30,"color":"#c03020"}}}"##
        .replace('\n', "");
    session.replay(Path::new("story"), &retype).unwrap();
    let longer = bounds(&session);
    assert!(longer.0 == first.0 && longer.2 > first.2 + 20, "{first:?} {longer:?}");
    assert_eq!(longer.1, first.1);
    assert_eq!(text_of(&session).0, "Rels and more");
}

#[test]
fn a_text_is_saved_with_its_words_and_outlines_and_opened_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("words.ora").to_string_lossy().replace('\\', "/");
    let save = format!(r#"{{"in":"file","do":"save","file":"{file}"}}"#);
    let open = format!(r#"{{"in":"file","do":"open","file":"{file}"}}"#);
    let session = write(&[WRITE, &save, &open]);
    let [made, read] = &session.open_documents[..] else { panic!("there are not two documents") };
    let both = [made, read]
        .map(|open| render(open.document()).to_straight_rgba(Size::new(200, 120).rect()));
    assert!(both[0] == both[1], "other pixels");
    let (_, image) = text_of(&session);
    let text = image.source.text().unwrap();
    assert_eq!((text.string().as_str(), text.runs[0].style.size), ("Rel", 30.0));
    assert!(made.document().difference(read.document()).is_none());
}

#[test]
fn a_text_is_as_sharp_at_eight_times_the_size() {
    let session = write(&[WRITE]);
    let document = session.active().unwrap().document();
    let larger = render(&document.scaled(8.0).unwrap());
    // Along a row through the letters, pixels that are neither ink nor paper are two at an edge.
    let row: Vec<u8> = (0..1600).map(|x| larger.pixel(x, 8 * 50)[3]).collect();
    let edges = row.windows(2).filter(|pair| (pair[0] > 127) != (pair[1] > 127)).count();
    let between = row.iter().filter(|a| (8..248).contains(*a)).count();
    assert!(edges >= 4 && between <= 3 * edges, "{between} pixels at {edges} edges");
}
