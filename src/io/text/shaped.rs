//! Lines that were shaped, kept while a text is typed: a key changes one line of it, and no other is
//! shaped again. Floor 5. Not here: where lines lie (`lines`).

use super::lines::{self, Line};
use super::{find_ink, markup, parse, texts};
use crate::Result;
use crate::paint::TextAlign;
use resvg::usvg::{self, Tree, WriteOptions};
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// A line as it looks where its baseline begins, ends or has its middle at the origin.
pub(super) struct ShapedLine {
    /// Its outlines as elements of an SVG.
    pub outlines: String,
    /// All that is inked of it, px.
    pub inked: Option<usvg::Rect>,
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
    /// Bytes that are kept new: some three times the outlines of 2,000 letters. As many are kept old.
    const MOST_BYTES: usize = 4 << 20;

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
    find: impl FnOnce(&Tree) -> T,
) -> Result<Arc<T>> {
    let lock = || known.lock().unwrap_or_else(PoisonError::into_inner);
    let found = lock().get(&markup, bytes);
    if let Some(found) = found {
        return Ok(found);
    }
    let found = Arc::new(find(&parse(&markup)?));
    lock().add(markup, found.clone(), bytes);
    Ok(found)
}

/// Shapes a line that is straight and no column.
pub(super) fn shape(line: &Line, align: TextAlign) -> Result<Arc<ShapedLine>> {
    static KNOWN: LazyLock<Mutex<KnownLines<ShapedLine>>> =
        LazyLock::new(|| Mutex::new(KnownLines::new()));
    let bytes = |shaped: &ShapedLine| shaped.outlines.len();
    know(&KNOWN, markup::of_straight_line(line, align), bytes, |tree| ShapedLine {
        outlines: markup::elements(&tree.to_string(&WriteOptions::default())).to_owned(),
        inked: find_ink(tree),
    })
}

/// Measures a line as if it were straight: where its letters begin, bytes within the line, and px
/// along it; the last one is its end.
pub(super) fn measure(line: &Line, align: TextAlign) -> Result<Arc<Letters>> {
    static KNOWN: LazyLock<Mutex<KnownLines<Letters>>> =
        LazyLock::new(|| Mutex::new(KnownLines::new()));
    let bytes = |letters: &Letters| size_of_val(letters.as_slice());
    know(&KNOWN, markup::of_straight_line(line, align), bytes, |tree| {
        lines::letters(line, &texts(tree.root()))
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
        let first = shape(&line, TextAlign::Start).unwrap();
        assert!(Arc::ptr_eq(&first, &shape(&line, TextAlign::Start).unwrap()));
        assert!(!Arc::ptr_eq(&first, &shape(&line, TextAlign::End).unwrap()));
        assert!(first.outlines.contains("<path") && first.inked.is_some());
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
