//! A key typed in the middle of a text: ms from the text that it makes to its letters, to its
//! carets, and to the flattened tiles of the layer, as least, middle, and what nine of ten stay
//! within. `cargo bench --bench text`.

#[allow(dead_code)] // Gestures are measured elsewhere.
mod timing;

use rilievo::document::{PreparedDocument, diff};
use rilievo::math::vec2;
use rilievo::paint::{PathNode, Subpath};
use rilievo::raster::TileAt;
use rilievo::{Budget, Document, Progress, Size};
use rilievo_engine::paint::{Text, TextPath, TextStyle};
use rilievo_io::text;
use rilievo_program::session::actions::LayerAction;
use rilievo_program::session::{Action, LayerPaths, OpenDocument, Property, Session};
use std::time::Instant;

const CANVAS: Size = Size::new(1920, 1080);
const KEYS: usize = 60;
const LETTERS: usize = 2_000;

/// Words of two to nine letters, so many letters in all, in paragraphs.
fn words(letters: usize, paragraphs: usize) -> String {
    const WORDS: [&str; 12] = [
        "relief", "and", "shade", "follow", "the", "form", "of", "a", "turning", "surface", "in",
        "light",
    ];
    let (mut out, mut i) = (String::new(), 0usize);
    while out.len() < letters {
        out.push_str(WORDS[(i * 7 + i / 5) % WORDS.len()]);
        let is_end = out.len() * paragraphs / letters > out.matches('\n').count() + 1;
        out.push(if is_end { '\n' } else { ' ' });
        i += 1;
    }
    out.truncate(letters);
    out
}

fn style() -> TextStyle {
    TextStyle { family: "Ubuntu".into(), size: 24.0, ..TextStyle::default() }
}

/// The text after so many keys of a hand that types words in its middle.
fn typed(text: &Text, keys: usize) -> Text {
    let old = text.string();
    let middle = old.len() / 2;
    let new: String = (0..keys).map(|i| if i % 6 == 5 { ' ' } else { 'n' }).collect();
    text.saying(&format!("{}{new}{}", &old[..middle], &old[middle..]))
}

/// ms of each key.
fn keys(text: &Text, mut key: impl FnMut(Text)) -> Vec<f64> {
    key(typed(text, 0));
    let time = |i: usize| {
        let next = typed(text, i);
        let start = Instant::now();
        key(next);
        start.elapsed().as_secs_f64() * 1e3
    };
    (1..=KEYS).map(time).collect()
}

/// A layer of the text, shown again after each key, as the window does.
fn shown(text: &Text) -> Vec<f64> {
    let mut session = Session::default();
    session.add_document(OpenDocument::new("page", Document::empty(CANVAS), None));
    let write = LayerAction::Write { text: typed(text, 0), at: vec2(100.0, 60.0) };
    Action::Layer(write).apply(&mut session).expect("it is written");
    let layer = session.layer_path().expect("it was written");
    let progress = Progress::default();
    let first = session.active().expect("it is open").drawn_document();
    let mut picture = rilievo::flatten(&first, &progress).unwrap_or_default();
    let mut document = first;
    keys(text, |text| {
        let to = Property::Worded { text };
        let layer = LayerPaths::from(layer.clone());
        let set = Action::Layer(LayerAction::Set { layer, to, done: false });
        set.apply(&mut session).expect("it is set");
        let next = session.active().expect("it is open").drawn_document();
        let tiles: Vec<TileAt> = diff(&document, &next).into_iter().collect();
        let prepared = PreparedDocument::new(&next, &progress).expect("nobody cancels");
        picture = prepared.flatten_tiles(&picture, &tiles, &progress).expect("nobody cancels");
        document = next;
    })
}

fn main() {
    println!("{:56} {:>8} {:>8} {:>8}", "ms a key", "least", "middle", "9 of 10");
    let boxed =
        |paragraphs: usize| Text { width: 900.0, ..Text::new(words(LETTERS, paragraphs), style()) };
    let line = Subpath {
        nodes: [vec2(0.0, 0.0), vec2(900.0, 100.0), vec2(1700.0, 0.0)].map(PathNode::corner).into(),
        closed: false,
    };
    let on_path = Text {
        path: Some(TextPath { line, shift: 0.0 }),
        ..Text::new(words(LETTERS, 30), style())
    };
    let texts = [
        ("in six paragraphs", boxed(6)),
        ("in one paragraph", boxed(1)),
        ("in lines of its own", Text { width: 0.0, ..boxed(30) }),
        ("in columns", Text { vertical: true, ..boxed(6) }),
        ("along a path", on_path),
    ];
    for (name, text) in texts {
        let name = |what: &str| format!("{LETTERS} letters {name}, {what}");
        let laid = keys(&text, |text| drop(text::lay_out(&text, &Budget::default())));
        timing::row(&name("laid out"), laid);
        timing::row(&name("carets"), keys(&text, |text| drop(text::carets(&text))));
        timing::row(&name("shown"), shown(&text));
    }
}
