//! Words as a document keeps them: what they say, in which type, and how they are laid out.
//! Floor 3. Not here: fonts, and the outlines of the letters (`io::text`).

use crate::math::range::Range;
use crate::math::srgb::Color;
use crate::math::{Vec2, range};
use crate::paint::Subpath;

/// A text. Lines end with `\n`.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// What it says; each piece in one style.
    pub runs: Vec<TextRun>,
    /// Where lines begin.
    pub align: TextAlign,
    /// The distance of baselines, in sizes of the largest type of a line.
    pub leading: f32,
    /// Where lines are broken, px; 0: only where the text says so.
    pub width: f32,
    /// Lines run down, the first one on the right.
    pub vertical: bool,
    /// Degrees of a circle along which a line without `width` runs: positive arches up.
    pub arc: f32,
    /// A line along which it runs instead, its points from where the first baseline would begin.
    pub path: Option<TextPath>,
    /// Where the first baseline begins, px from the corner of the picture that shows it.
    pub origin: Vec2,
}

/// A line that a text runs along. Where it ends, letters are left out; a closed one goes on.
#[derive(Clone, Debug, PartialEq)]
pub struct TextPath {
    /// What it runs along.
    pub line: Subpath,
    /// How much farther along it than the alignment says, px.
    pub shift: f32,
}

/// A piece of text in one style.
#[derive(Clone, Debug, PartialEq)]
pub struct TextRun {
    /// What it says.
    pub string: String,
    /// How it looks.
    pub style: TextStyle,
}

/// Type.
#[derive(Clone, Debug, PartialEq)]
pub struct TextStyle {
    /// The font's family; empty: the sans-serif of the machine.
    pub family: String,
    /// The size, px.
    pub size: f32,
    /// From thin (100) over regular (400) to black (900).
    pub weight: u16,
    /// Slanted.
    pub italic: bool,
    /// Of the letters.
    pub color: Color,
    /// Added between letters, in thousandths of the size.
    pub tracking: f32,
    /// Letters that leave a gap are moved together, as the font says.
    pub kerning: bool,
    /// The width of a line around the letters, px; 0: none.
    pub outline: f32,
    /// Of that line.
    pub outline_color: Color,
}

crate::named! {
    /// Where lines of text begin.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum TextAlign {
        #[default]
        Start = "start" => "Left",
        Middle = "middle" => "Center",
        End = "end" => "Right",
    }
}

impl TextStyle {
    /// The range of a size, px.
    pub const SIZE: Range = 1.0..=4096.0;
    /// The range of a weight.
    pub const WEIGHT: std::ops::RangeInclusive<u16> = 1..=1000;
    /// The range of a tracking, thousandths of the size.
    pub const TRACKING: Range = -1000.0..=10_000.0;
    /// The range of an outline, px.
    pub const OUTLINE: Range = 0.0..=1024.0;
    /// Letters of the longest name of a family.
    pub const LONGEST_FAMILY: usize = 200;
}

impl Default for TextStyle {
    fn default() -> Self {
        Self {
            family: String::new(),
            size: 48.0,
            weight: 400,
            italic: false,
            color: Color::BLACK,
            tracking: 0.0,
            kerning: true,
            outline: 0.0,
            outline_color: Color::WHITE,
        }
    }
}

impl Default for Text {
    fn default() -> Self {
        Self {
            runs: Vec::new(),
            align: TextAlign::Start,
            leading: 1.2,
            width: 0.0,
            vertical: false,
            arc: 0.0,
            path: None,
            origin: Vec2::ZERO,
        }
    }
}

impl Text {
    /// The range of a leading.
    pub const LEADING: Range = 0.1..=20.0;
    /// The range of a width, px.
    pub const WIDTH: Range = 0.0..=65_536.0;
    /// The range of an arc, degrees.
    pub const ARC: Range = -360.0..=360.0;
    /// The range of a shift along a path, px.
    pub const SHIFT: Range = range::COORDINATE;
    /// The range of its origin, px.
    pub const ORIGIN: Range = range::COORDINATE;
    /// The most letters.
    pub const MOST_LETTERS: usize = 20_000;
    /// The most runs.
    pub const MOST_RUNS: usize = 2_000;

    /// A text in one style.
    pub fn new(string: impl Into<String>, style: TextStyle) -> Self {
        Self { runs: vec![TextRun { string: string.into(), style }], ..Self::default() }
    }

    /// All that it says.
    pub fn string(&self) -> String {
        self.runs.iter().map(|run| run.string.as_str()).collect()
    }

    /// Whether its lines are columns.
    pub fn is_in_columns(&self) -> bool {
        self.vertical && self.path.is_none()
    }

    /// The style of the letter that ends at a byte, or of the first one; of an empty text the
    /// default.
    pub fn style_at(&self, byte: usize) -> TextStyle {
        let mut end = 0;
        for run in &self.runs {
            end += run.string.len();
            if byte <= end {
                return run.style.clone();
            }
        }
        self.runs.last().map_or_else(TextStyle::default, |run| run.style.clone())
    }

    /// The same text that says something else: what both begin and end with keeps its style, and
    /// what is new between has the style before it.
    pub fn saying(&self, string: &str) -> Self {
        let old = self.string();
        let start = common(old.chars(), string.chars()).min(old.len()).min(string.len());
        let rest = old.len().min(string.len()) - start;
        let end = common(old.chars().rev(), string.chars().rev());
        // What ends alike is within what follows the start, and ends at a letter.
        let end = (0..=end.min(rest)).rev().find(|end| {
            old.is_char_boundary(old.len() - end) && string.is_char_boundary(string.len() - end)
        });
        let end = end.unwrap_or(0);
        let mut next = Self { runs: Vec::new(), ..self.clone() };
        next.push_pieces(self.pieces(0, start));
        let new = string[start..string.len() - end].to_owned();
        next.push_pieces([TextRun { string: new, style: self.style_at(start) }]);
        next.push_pieces(self.pieces(old.len() - end, old.len()));
        if next.runs.is_empty() {
            next.runs.push(TextRun { string: String::new(), style: self.style_at(0) });
        }
        next
    }

    /// The same text with another style from one byte to another.
    pub fn styled(&self, from: usize, to: usize, change: impl Fn(&mut TextStyle)) -> Self {
        let mut next = Self { runs: Vec::new(), ..self.clone() };
        let len = self.runs.iter().map(|run| run.string.len()).sum();
        next.push_pieces(self.pieces(0, from));
        next.push_pieces(self.pieces(from, to).into_iter().map(|mut run| {
            change(&mut run.style);
            run
        }));
        next.push_pieces(self.pieces(to, len));
        if next.runs.is_empty() {
            next.runs = self.runs.clone();
            next.runs.iter_mut().for_each(|run| change(&mut run.style));
        }
        next
    }

    /// The runs between two bytes.
    fn pieces(&self, from: usize, to: usize) -> Vec<TextRun> {
        let (mut pieces, mut start) = (Vec::new(), 0);
        for run in &self.runs {
            let within = |byte: usize| byte.max(start).min(start + run.string.len()) - start;
            if let Some(piece) = run.string.get(within(from)..within(to).max(within(from))) {
                pieces.push(TextRun { string: piece.to_owned(), style: run.style.clone() });
            }
            start += run.string.len();
        }
        pieces
    }

    /// Adds runs that say something; neighbors of the same style become one.
    fn push_pieces(&mut self, pieces: impl IntoIterator<Item = TextRun>) {
        for piece in pieces.into_iter().filter(|piece| !piece.string.is_empty()) {
            match self.runs.last_mut() {
                Some(last) if last.style == piece.style => last.string.push_str(&piece.string),
                _ => self.runs.push(piece),
            }
        }
    }
}

/// Bytes of the letters with which both begin.
fn common(a: impl Iterator<Item = char>, b: impl Iterator<Item = char>) -> usize {
    a.zip(b).take_while(|(a, b)| a == b).map(|(a, _)| a.len_utf8()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bold(style: &mut TextStyle) {
        style.weight = 700;
    }

    fn shape(text: &Text) -> Vec<(&str, u16)> {
        text.runs.iter().map(|run| (run.string.as_str(), run.style.weight)).collect()
    }

    #[test]
    fn a_style_of_some_letters_stays_with_them_while_others_are_typed() {
        let text = Text::new("one two three", TextStyle::default()).styled(4, 7, bold);
        assert_eq!(shape(&text), [("one ", 400), ("two", 700), (" three", 400)]);
        let typed = text.saying("one twos three");
        assert_eq!(shape(&typed), [("one ", 400), ("twos", 700), (" three", 400)]);
        let before = text.saying("none two three");
        assert_eq!(shape(&before), [("none ", 400), ("two", 700), (" three", 400)]);
        assert_eq!(shape(&text.styled(0, 13, bold)), [("one two three", 700)]);
        assert_eq!(shape(&text.saying("")), [("", 400)]);
    }

    #[test]
    fn what_is_typed_between_equal_letters_never_cuts_one() {
        let text = Text::new("ää", TextStyle::default());
        for next in ["ä", "äää", "äöä", "aä", "ö", "ä€ä", ""] {
            assert_eq!(text.saying(next).string(), next);
            assert_eq!(Text::new(next, TextStyle::default()).saying("ää").string(), "ää");
        }
    }
}
