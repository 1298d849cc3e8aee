//! Texts through a session: written, retyped, bent, saved, opened again, drawn larger.

use super::*;
use crate::document::Document;
use crate::math::Size;
use crate::paint::PlacedImage;
use crate::raster::{Outside, TileAt, TileGrid};

fn write(lines: &[&str]) -> Session {
    let mut session = Session::default();
    session.add_document(OpenDocument::new("page", Document::empty(Size::new(200, 120)), None));
    for line in lines {
        let line = line.replace('\n', "");
        session.replay(Path::new("story"), &line).unwrap_or_else(|e| panic!("{e}"));
    }
    session
}

/// The first layer that is a text.
fn text_of(session: &Session) -> (String, PlacedImage) {
    let document = session.active().unwrap().document();
    let found = document.walk().into_iter().find_map(|(_, layer)| match &layer.content {
        Content::Image(live) if live.params().source.text().is_some() => {
            Some((layer.name.clone(), live.params().clone()))
        }
        _ => None,
    });
    found.unwrap()
}

fn render(document: &Document) -> TileGrid {
    flatten(document, &Progress::default()).unwrap()
}

const WRITE: &str = r##"{"in":"layer","do":"write","at":[40,60],
"text":{"string":"Rel","font":"Hack","size":30,"color":"#c03020"}}"##;

/// A half circle above its ends, and a text of the same document.
const BOW: &str = r##"{"in":"path","do":"draw","path":{"outline":1,"lines":[{"nodes":
[[40,100,0,33,0,-80],[160,100,0,-80,0,33]]}]}}"##;

/// Where the middle of all that is inked in a color of its own is, and how much that is.
fn ink(session: &Session, is_inked: impl Fn([u8; 4]) -> bool) -> (f32, f32, usize) {
    let picture = render(session.active().unwrap().document());
    let all = (0..200 * 120).filter(|i| is_inked(picture.pixel(i % 200, i / 200)));
    let (mut x, mut y, mut count) = (0.0, 0.0, 0);
    all.for_each(|i| {
        (x, y, count) = (x + (i % 200) as f32, y + (i / 200) as f32, count + 1);
    });
    (x / count.max(1) as f32, y / count.max(1) as f32, count)
}

#[test]
fn a_text_runs_along_a_path_and_straight_again() {
    let text = r##"{"in":"layer","do":"write","at":[40,60],
"text":{"string":"bows","font":"Hack","size":24,"align":"middle","color":"#c03020"}}"##;
    let carry = r#"{"in":"path","do":"carry text","layer":"0","text":"1"}"#;
    let is_red = |[r, g, _, a]: [u8; 4]| a > 200 && r > 150 && g < 90;
    let mut session = write(&[BOW, text]);
    let straight = ink(&session, is_red);
    session.replay(Path::new("story"), carry).unwrap();
    // The middle of the letters is above the top of the bow, which is at y = 40.
    let (x, y, count) = ink(&session, is_red);
    assert!((x - 100.0).abs() < 3.0 && (25.0..42.0).contains(&y), "{x} {y}");
    assert!((count as f32 / straight.2 as f32 - 1.0).abs() < 0.1, "{count} of {}", straight.2);
    // It is kept in files, and as it was once it is undone.
    let (_, image) = text_of(&session);
    let words = image.source.text().unwrap();
    assert!(words.path.as_ref().is_some_and(|path| path.line.nodes.len() == 2));
    session.replay(Path::new("story"), r#"{"in":"edit","do":"undo"}"#).unwrap();
    assert_eq!(ink(&session, is_red), straight);
    // A layer that is no path, and one that is no text.
    for wrong in [r#""layer":"1","text":"1""#, r#""layer":"0","text":"0""#] {
        let line = format!("{{\"in\":\"path\",\"do\":\"carry text\",{wrong}}}");
        session.said.clear();
        session.replay(Path::new("story"), &line).unwrap();
        assert_eq!(session.said.len(), 1, "{line}");
    }
}

#[test]
fn a_press_of_the_text_tool_on_a_path_begins_a_text_there() {
    let press = r#"{"in":"pointer","do":"press","tool":"text","pen":[100,40],"px_per_pt":1}"#;
    let session = write(&[BOW, press]);
    let (_, image) = text_of(&session);
    let path = image.source.text().unwrap().path.clone().unwrap();
    // Half of the bow is before it.
    let length = path.line.flatten(&Some).unwrap().length();
    assert!((path.shift / length - 0.5).abs() < 0.02, "{} of {length}", path.shift);
    let beside = press.replace("[100,40]", "[100,80]");
    let session = write(&[BOW, &beside]);
    assert_eq!(text_of(&session).1.source.text().unwrap().path, None);
}

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

/// Each key, as the window shows it, against the same document painted from nothing.
#[test]
fn what_is_typed_is_shown_as_if_it_were_painted_at_once() {
    use crate::document::{Live, PreparedDocument, diff};
    use crate::paint::PictureSource;
    let text = |string: &str| {
        format!(
            r##"{{"string":"{string}","font":"Hack","size":13,"width":150,"color":"#c03020"}}"##
        )
    };
    let start = "one two three four five six seven eight nine ten eleven twelve";
    let write = format!(r#"{{"in":"layer","do":"write","at":[20,20],"text":{}}}"#, text(start));
    let mut session = self::write(&[&write]);
    let drawn = |session: &Session| session.active().unwrap().drawn_document();
    let (mut shown, progress) = (drawn(&session), Progress::default());
    let mut picture = render(&shown);
    let mut kept = 0;
    for (typed, done) in [
        ("one two three four five six sevenn eight nine ten eleven twelve", false),
        ("one two three four five six sevennn eight nine ten eleven twelve", false),
        ("one two three four five six sevennn  eight nine ten eleven twelve", true),
        ("one two three four five six sevennn o eight nine ten eleven twelve", false),
        ("one two three four five six eight nine ten eleven twelve", false),
        ("one two\\nthree four five six eight nine ten eleven twelve", true),
        ("one two\\nthree four five six eight nine ten eleven twelvg", false),
        ("one", true),
    ] {
        let set = format!(
            r#"{{"in":"layer","do":"set","layer":"0","done":{done},"to":{{"do":"text","text":{}}}}}"#,
            text(typed)
        );
        session.replay(Path::new("story"), &set).unwrap();
        let next = drawn(&session);
        let tiles: Vec<_> = diff(&shown, &next).into_iter().collect();
        kept += usize::from(tiles.len() < 8);
        let prepared = PreparedDocument::new(&next, &progress).unwrap();
        picture = prepared.flatten_tiles(&picture, &tiles, &progress).unwrap();
        let anew = next.with_layer(next.layers[0].id, |layer| {
            let Content::Image(live) = &layer.content else { panic!() };
            let mut image = live.params().clone();
            let (file, picture) = (image.source.file.clone(), image.source.picture.clone());
            image.source = PictureSource::new(file, picture, image.source.adjust);
            layer.content = Content::Image(Live::new(image));
        });
        let rect = Size::new(200, 120).rect();
        let whole = render(&anew.unwrap()).to_straight_rgba(rect);
        assert!(picture.to_straight_rgba(rect) == whole, "{typed:?} is shown otherwise");
        shown = next;
    }
    assert!(kept >= 3, "{kept} keys left tiles as they were");
}

/// The keys of a hand that types on: none of them is a step yet, and a line is added on the way.
#[test]
fn a_key_in_a_long_text_changes_the_tiles_of_its_lines_alone() {
    use crate::document::diff;
    let size = Size::new(600, 800);
    let mut session = Session::default();
    session.add_document(OpenDocument::new("page", Document::empty(size), None));
    let text = |typed: &str| {
        let words = ["shade follows the form of a turning surface"; 4].join(" ");
        let string = format!("{words}\\n{words} {typed} {words}\\n{words}\\n{words}\\n{words}");
        format!(r#"{{"string":"{string}","font":"Hack","size":16,"width":500}}"#)
    };
    let write = format!(r#"{{"in":"layer","do":"write","at":[40,40],"text":{}}}"#, text(""));
    session.replay(Path::new("story"), &write).unwrap();
    let drawn = |session: &Session| session.active().unwrap().drawn_document();
    let mut shown = drawn(&session);
    render(&shown);
    let all = TileAt::covering(size.rect()).count();
    let mut changed: Vec<usize> = Vec::new();
    for keys in 1..=60 {
        let typed: String = (0..keys).map(|i| if i % 6 == 5 { ' ' } else { 'n' }).collect();
        let set = format!(
            r#"{{"in":"layer","do":"set","layer":"0","done":false,"to":{{"do":"text","text":{}}}}}"#,
            text(&typed)
        );
        session.replay(Path::new("story"), &set).unwrap();
        let next = drawn(&session);
        changed.push(diff(&shown, &next).len());
        render(&next);
        shown = next;
    }
    let whole = changed.iter().filter(|tiles| 2 * **tiles > all).count();
    assert!(whole <= 2, "{whole} of 60 keys changed most of {all} tiles: {changed:?}");
    changed.sort_unstable();
    assert!(4 * changed[30] < all, "the middle key changed {} of {all} tiles", changed[30]);
}
