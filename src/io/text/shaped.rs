//! Lines that were shaped, kept while a text is typed: a key changes one line of it, and no other is
//! shaped again. Floor 5. Not here: where lines lie (`lines`).

use super::columns::{self, Column};
use super::lines::{self, Line};
use super::{find_ink, markup, parse, texts};
use crate::Result;
use crate::paint::{Text, TextAlign};
use crate::svg::{PlainPath, plain_paths};
use resvg::usvg::{self, WriteOptions};
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, OnceLock, PoisonError};

/// A line as it looks where it is held at the origin: where its baseline begins, ends or has its
/// middle; along a curve in its place.
#[derive(Debug)]
pub(super) struct ShapedLine {
    /// Its outlines as elements of an SVG.
    pub outlines: String,
    /// All that is inked of it, px.
    pub inked: Option<usvg::Rect>,
    /// The same outlines, once they are read.
    paths: OnceLock<Option<Vec<PlainPath>>>,
}

impl ShapedLine {
    /// From an SVG of ours.
    fn of(markup: &str) -> Result<Self> {
        let tree = parse(markup)?;
        let outlines = markup::elements(&tree.to_string(&WriteOptions::default())).to_owned();
        Ok(Self { outlines, inked: find_ink(&tree), paths: OnceLock::new() })
    }

    /// Its outlines as those who read the file see them; `None` if there is something else in it,
    /// such as a letter that is a picture.
    pub fn paths(&self) -> Option<&[PlainPath]> {
        let read = || plain_paths(parse(&markup::document(&self.outlines)).ok()?.root());
        self.paths.get_or_init(read).as_deref()
    }
}

/// Where the letters of a line begin: bytes within it, and px along it; the last one is its end.
pub(super) type Letters = Vec<(usize, f32)>;

/// What is known of the lines of the last texts, by their SVG: when half of it is new, what was not
/// asked for since is forgotten.
struct KnownLines<T> {
    new: HashMap<String, Arc<T>>,
    old: HashMap<String, Arc<T>>,
    /// Of the new ones.
    bytes: usize,
}

impl<T> KnownLines<T> {
    /// Bytes that are kept new: some five times the outlines of 2,000 letters, as text and as paths. As
    /// many are kept old.
    const MOST_BYTES: usize = 12 << 20;

    fn new() -> Self {
        Self { new: HashMap::new(), old: HashMap::new(), bytes: 0 }
    }

    fn get(&mut self, markup: &str, bytes: impl Fn(&T) -> usize) -> Option<Arc<T>> {
        if let Some(known) = self.new.get(markup) {
            return Some(known.clone());
        }
        let (markup, line) = self.old.remove_entry(markup)?;
        self.add(markup, line.clone(), bytes);
        Some(line)
    }

    fn add(&mut self, markup: String, line: Arc<T>, bytes: impl Fn(&T) -> usize) {
        let bytes = markup.len() + bytes(&line);
        if self.bytes + bytes > Self::MOST_BYTES {
            self.old = std::mem::take(&mut self.new);
            self.bytes = 0;
        }
        self.bytes += bytes;
        self.new.insert(markup, line);
    }
}

/// What is known of a line, or what is found of it now.
fn know<T>(
    known: &LazyLock<Mutex<KnownLines<T>>>,
    markup: String,
    bytes: fn(&T) -> usize,
    find: impl FnOnce(&str) -> Result<T>,
) -> Result<Arc<T>> {
    let lock = || known.lock().unwrap_or_else(PoisonError::into_inner);
    let found = lock().get(&markup, bytes);
    if let Some(found) = found {
        return Ok(found);
    }
    let found = Arc::new(find(&markup)?);
    lock().add(markup, found.clone(), bytes);
    Ok(found)
}

/// Shapes a line of a text.
pub(super) fn shape(text: &Text, line: &Line) -> Result<Arc<ShapedLine>> {
    type Known = LazyLock<Mutex<KnownLines<ShapedLine>>>;
    static LINES: Known = LazyLock::new(|| Mutex::new(KnownLines::new()));
    static COLUMNS: Known = LazyLock::new(|| Mutex::new(KnownLines::new()));
    // As paths they take about as much again.
    let bytes = |shaped: &ShapedLine| 2 * shaped.outlines.len();
    let straight = || markup::of_straight_line(line, text.align);
    if text.is_in_columns() {
        return know(&COLUMNS, straight(), bytes, |_| {
            let column = lay(line, text.align)?;
            ShapedLine::of(&markup::of_column(&column, text.align))
        });
    }
    let markup = line.curve.as_ref().map_or_else(straight, |curve| markup::of_curve(line, curve));
    know(&LINES, markup, bytes, ShapedLine::of)
}

/// Lays a line out as a column.
pub(super) fn lay(line: &Line, align: TextAlign) -> Result<Arc<Column>> {
    static KNOWN: LazyLock<Mutex<KnownLines<Column>>> =
        LazyLock::new(|| Mutex::new(KnownLines::new()));
    let bytes = |column: &Column| column.outlines.iter().map(|(data, _)| data.len()).sum();
    know(&KNOWN, markup::of_straight_line(line, align), bytes, |_| Ok(columns::lay(line)))
}

/// Measures a line as if it were straight: where its letters begin, bytes within the line, and px
/// along it; the last one is its end.
pub(super) fn measure(line: &Line, align: TextAlign) -> Result<Arc<Letters>> {
    static KNOWN: LazyLock<Mutex<KnownLines<Letters>>> =
        LazyLock::new(|| Mutex::new(KnownLines::new()));
    let bytes = |letters: &Letters| size_of_val(letters.as_slice());
    know(&KNOWN, markup::of_straight_line(line, align), bytes, |markup| {
        Ok(lines::letters(line, &texts(parse(markup)?.root())))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paint::{TextRun, TextStyle};

    #[test]
    fn a_line_is_shaped_once() {
        let pieces = vec![TextRun { string: "once".into(), style: TextStyle::default() }];
        let line = Line::straight(pieces);
        let text = Text::default();
        let first = shape(&text, &line).unwrap();
        assert!(Arc::ptr_eq(&first, &shape(&text, &line).unwrap()));
        let ending = Text { align: TextAlign::End, ..text.clone() };
        assert!(!Arc::ptr_eq(&first, &shape(&ending, &line).unwrap()));
        let column = shape(&Text { vertical: true, ..text }, &line).unwrap();
        assert!(column.outlines != first.outlines && column.inked != first.inked);
        assert!(first.outlines.contains("<path") && first.inked.is_some());
        assert!(first.paths().is_some_and(|paths| !paths.is_empty()));
    }

    #[test]
    fn what_was_not_asked_for_is_forgotten() {
        let mut known = KnownLines::new();
        let bytes = |_: &usize| KnownLines::<usize>::MOST_BYTES / 4;
        for i in 0..10 {
            known.add(i.to_string(), Arc::new(i), bytes);
            assert!(known.get("0", bytes).is_some(), "asked for each time: {i}");
        }
        assert!(known.get("1", bytes).is_none() && known.get("9", bytes).is_some());
        assert!(known.new.len() + known.old.len() <= 8);
    }
}
