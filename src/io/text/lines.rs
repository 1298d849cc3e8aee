//! The lines of a text: where they are broken, and where they lie. Floor 5.

use super::Caret;
use crate::math::{Vec2, vec2};
use crate::paint::{FlatLine, Text, TextAlign, TextPath, TextRun};
use crate::path_svg;
use crate::{Error, Result};
use resvg::usvg;
use std::fmt::Write;
use std::path::Path;

/// One line.
#[derive(Clone, Debug)]
pub(super) struct Line {
    /// What it says.
    pub pieces: Vec<TextRun>,
    /// The bytes of the text before it.
    pub start: usize,
    /// Where its baseline begins, ends or has its middle, px, by the alignment.
    pub at: Vec2,
    /// What it runs along instead.
    pub curve: Option<LineCurve>,
}

/// What a line runs along.
#[derive(Clone, Debug)]
pub(super) struct LineCurve {
    /// As SVG writes it.
    pub data: String,
    /// Where on it the line begins, has its middle or ends, as SVG writes that.
    pub start: String,
    /// In straight pieces.
    flat: FlatLine,
    /// The same place in px, and the alignment that tells which it is.
    along: f32,
    pub align: TextAlign,
    /// How far to the right of it the baseline lies, px.
    pub below: f32,
}

impl Line {
    fn new(pieces: Vec<TextRun>, start: usize) -> Self {
        Self { pieces, start, at: Vec2::ZERO, curve: None }
    }

    /// A line by itself.
    #[cfg(test)]
    pub(super) fn straight(pieces: Vec<TextRun>) -> Self {
        Self::new(pieces, 0)
    }

    fn string(&self) -> String {
        self.pieces.iter().map(|run| run.string.as_str()).collect()
    }

    /// The size of its largest type.
    fn size(&self) -> f32 {
        self.pieces.iter().map(|run| run.style.size).fold(0.0, f32::max)
    }

    /// The bytes from one place of it to another, as a line.
    fn cut(&self, from: usize, to: usize) -> Line {
        let (mut pieces, mut start) = (Vec::new(), 0);
        for run in &self.pieces {
            let end = start + run.string.len();
            let (a, b) = (from.max(start).min(end) - start, to.max(start).min(end) - start);
            if let Some(piece) = run.string.get(a..b).filter(|piece| !piece.is_empty()) {
                pieces.push(TextRun { string: piece.to_owned(), style: run.style.clone() });
            }
            start = end;
        }
        if let Some(first) = self.pieces.first().filter(|_| pieces.is_empty()) {
            pieces.push(TextRun { string: String::new(), style: first.style.clone() });
        }
        Line::new(pieces, self.start + from)
    }
}

/// The lines of a text in their places; refuses one that is too long.
pub(super) fn lines(text: &Text) -> Result<Vec<Line>> {
    let letters = text.runs.iter().map(|run| run.string.chars().count()).sum::<usize>();
    if letters > Text::MOST_LETTERS {
        let reason = format!("{letters} letters; a text has {} at most", Text::MOST_LETTERS);
        return Err(Error::too_large(Path::new(super::FILE), reason));
    }
    if text.runs.len() > Text::MOST_RUNS {
        let reason = format!("{} pieces; a text has {} at most", text.runs.len(), Text::MOST_RUNS);
        return Err(Error::too_large(Path::new(super::FILE), reason));
    }
    let mut lines = Vec::new();
    for paragraph in paragraphs(text) {
        if text.width > 0.0 && text.arc == 0.0 && text.path.is_none() {
            lines.extend(break_lines(text, paragraph));
        } else {
            lines.push(paragraph);
        }
    }
    place(text, &mut lines);
    Ok(lines)
}

/// What lies between the ends of lines that the text has.
fn paragraphs(text: &Text) -> Vec<Line> {
    let mut whole = Line::new(text.runs.clone(), 0);
    whole.pieces.iter_mut().for_each(|run| {
        // What XML has no other word for is a space, of as many bytes.
        run.string = run.string.replace(['\r', '\t', '\u{b}', '\u{c}'], " ");
    });
    let string = whole.string();
    let mut found = Vec::new();
    let mut start = 0;
    for line in string.split('\n') {
        let mut cut = whole.cut(start, start + line.len());
        if line.is_empty() {
            // An empty line is as high as what was typed before it.
            cut.pieces = vec![TextRun { string: String::new(), style: text.style_at(start) }];
        }
        found.push(cut);
        start += line.len() + 1;
    }
    found
}

/// A paragraph in lines of the text's width.
fn break_lines(text: &Text, paragraph: Line) -> Vec<Line> {
    let string = paragraph.string();
    let letters = super::advances(text, &paragraph);
    let begins = |byte: usize| {
        let after = letters.partition_point(|(at, _)| *at < byte);
        letters.get(after).or(letters.last()).map_or(0.0, |(_, x)| *x)
    };
    let (mut lines, mut start, mut last_break) = (Vec::new(), 0, None);
    for (byte, letter) in string.char_indices() {
        let end = byte + letter.len_utf8();
        let is_over = !letter.is_whitespace() && (begins(end) - begins(start)).abs() > text.width;
        if is_over && byte > start {
            let at = last_break.unwrap_or(byte);
            lines.push(paragraph.cut(start, at));
            (start, last_break) = (at, None);
        }
        if is_break_after(&string, byte, letter) && end < string.len() {
            last_break = Some(end);
        }
    }
    lines.push(paragraph.cut(start, string.len()));
    lines
}

/// A line may end after spaces and hyphens, and between the letters of scripts that are written
/// without spaces, but not before what closes.
fn is_break_after(string: &str, byte: usize, letter: char) -> bool {
    let next = string[byte + letter.len_utf8()..].chars().next();
    let Some(next) = next else { return false };
    let closes =
        "、。，．・：；？！）］｝〕〉》」』】ー…ぁぃぅぇぉっゃゅょァィゥェォッャュョ)]}.,:;!?"
            .contains(next);
    let opens = "（［｛〔〈《「『【([{".contains(letter);
    let is_spaced = letter.is_whitespace() || letter == '-' || letter == '\u{2013}';
    let is_dense = is_without_spaces(letter) || is_without_spaces(next);
    (is_spaced && !next.is_whitespace()) || (is_dense && !closes && !opens)
}

/// Chinese and Japanese.
fn is_without_spaces(letter: char) -> bool {
    matches!(u32::from(letter), 0x2e80..=0x9fff | 0xf900..=0xfaff | 0xff00..=0xff60 | 0x20000..=0x3ffff)
}

/// Lays lines beneath each other, or in columns from right to left.
fn place(text: &Text, lines: &mut [Line]) {
    let mut along = 0.0;
    for i in 0..lines.len() {
        if i > 0 {
            along += text.leading * lines[i].size();
        }
        let side = match text.align {
            TextAlign::Start => 0.0,
            TextAlign::Middle => text.width / 2.0,
            TextAlign::End => text.width,
        };
        lines[i].at = if text.is_in_columns() { vec2(-along, side) } else { vec2(side, along) };
        if let Some(path) = &text.path {
            lines[i].curve = Some(along_path(path, text.align, along));
        } else if text.arc != 0.0 && !text.vertical {
            lines[i].curve = Some(arc(text, &lines[0], along));
        }
    }
}

/// A path that a line runs along, so far below it. One that is closed goes around twice, so that
/// text that begins anywhere on it goes once around.
fn along_path(path: &TextPath, align: TextAlign, below: f32) -> LineCurve {
    let mut flat = path.line.flatten(&Some).unwrap_or_default();
    let length = flat.length();
    let share = match align {
        TextAlign::Start => 0.0,
        TextAlign::Middle => 0.5,
        TextAlign::End => 1.0,
    };
    let mut along = share * length + path.shift;
    let mut data = path_svg::line(&path.line);
    if path.line.closed && length > 0.0 {
        along = along.rem_euclid(length) + share * length;
        data = format!("{data} {data}").replace(" Z M", " L");
        flat.points.extend_from_within(..);
        flat.widths.extend_from_within(..);
    }
    LineCurve { data, start: along.to_string(), flat, along, align, below }
}

/// The straight pieces of a circle that carets stand on.
const ARC_PIECES: usize = 360;

/// The circle along which a line runs whose distance from the first one is given. The middle of
/// the first line stays where it is.
fn arc(text: &Text, first: &Line, along: f32) -> LineCurve {
    let measured = super::advances(text, first);
    let (start, end) = (measured.first(), measured.last());
    let length = start.zip(end).map_or(0.0, |((_, from), (_, to))| to - from).max(1.0);
    let radius = length / text.arc.abs().to_radians().max(1e-3);
    let up = text.arc.signum();
    let radius = (radius - up * along).max(1.0);
    let middle = match text.align {
        TextAlign::Start => length / 2.0,
        TextAlign::Middle => 0.0,
        TextAlign::End => -length / 2.0,
    };
    // From the far side of the circle all around, so that the middle of the path is the top (or,
    // where letters hang, the bottom).
    let (y0, y1) = (along + up * 2.0 * radius, along);
    let sweep = if up > 0.0 { 1 } else { 0 };
    let mut data = String::new();
    let _ = write!(
        data,
        "M{middle} {y0} A{radius} {radius} 0 0 {sweep} {middle} {y1} A{radius} {radius} 0 0 {sweep} {middle} {y0}"
    );
    let center = vec2(middle, along + up * radius);
    let points = (0..=ARC_PIECES).map(|piece| {
        let turn = std::f32::consts::TAU * piece as f32 / ARC_PIECES as f32;
        center + radius * up * vec2(-turn.sin(), turn.cos())
    });
    let flat = FlatLine { points: points.collect(), widths: vec![1.0; ARC_PIECES + 1] };
    let along = flat.length() / 2.0;
    LineCurve { data, start: "50%".into(), flat, along, align: TextAlign::Middle, below: 0.0 }
}

/// Where the letters of a line that was laid out at the origin begin: bytes within the line, and px along it;
/// the last one is its end. A letter from right to left begins at its right side.
pub(super) fn letters(line: &Line, laid: &[&usvg::Text]) -> Vec<(usize, f32)> {
    let string = line.string();
    let glyphs = laid.iter().flat_map(|text| text.layouted()).flat_map(|s| &s.positioned_glyphs);
    let mut glyphs: Vec<(&str, f32, f32)> = glyphs
        .map(|glyph| {
            let at = glyph.transform();
            let begin = at.tx;
            (glyph.text.as_str(), begin, begin)
        })
        .collect();
    let side = laid.first().map(|laid| laid.abs_bounding_box().right());
    let end = side.unwrap_or(0.0);
    for i in 0..glyphs.len() {
        glyphs[i].2 = glyphs.get(i + 1).map_or(end, |next| next.1);
    }
    let mut last = end;
    if is_from_right_to_left(&string) {
        // The glyphs stand as they are seen.
        last = glyphs.first().map_or(end, |first| first.1);
        glyphs.reverse();
        glyphs.iter_mut().for_each(|(_, begin, end)| *begin = *end);
    }
    let (mut found, mut byte) = (Vec::new(), 0);
    for (letters, begin, _) in glyphs {
        let Some(rest) = string.get(byte..) else { break };
        if let Some(skipped) = rest.find(letters).filter(|_| !letters.is_empty()) {
            byte += skipped;
            found.push((byte, begin));
            byte += letters.len();
        }
    }
    found.push((string.len(), last));
    found
}

/// Whether the first letter that has a direction is one of Hebrew, Arabic or a relative of theirs.
fn is_from_right_to_left(string: &str) -> bool {
    let letter = string.chars().find(|letter| letter.is_alphabetic());
    letter
        .is_some_and(|c| matches!(u32::from(c), 0x590..=0x8ff | 0xfb1d..=0xfdff | 0xfe70..=0xfeff))
}

impl LineCurve {
    /// Where a place of a line that was measured straight lies, and the direction of the baseline
    /// there.
    fn place(&self, along: f32, measured: &[(usize, f32)]) -> (Vec2, Vec2) {
        let ends = measured.first().zip(measured.last());
        let (from, to) = ends.map_or((0.0, 0.0), |((_, from), (_, to))| (*from, *to));
        let held = match self.align {
            TextAlign::Start => from,
            TextAlign::Middle => 0.5 * (from + to),
            TextAlign::End => to,
        };
        let place = self.flat.place_at(self.along + along - held);
        place.map_or((Vec2::ZERO, Vec2::X), |place| {
            (place.at + self.below * place.direction.perp(), place.direction)
        })
    }
}

/// The places between the letters of a text.
pub(super) fn carets(text: &Text, lines: &[Line]) -> Vec<Caret> {
    let mut found = Vec::new();
    for (number, line) in lines.iter().enumerate() {
        let straight = Line { curve: None, ..line.clone() };
        let measured = super::advances(text, &straight);
        let string = line.string();
        let ends = string.char_indices().map(|(byte, _)| byte).chain([string.len()]);
        for byte in ends {
            let along = interpolate(&measured, byte);
            let (at, direction) = match &line.curve {
                Some(curve) => curve.place(along, &measured),
                None if text.is_in_columns() => (line.at + vec2(0.0, along), Vec2::Y),
                None => (line.at + vec2(along, 0.0), Vec2::X),
            };
            let byte = line.start + byte;
            found.push(Caret {
                byte,
                line: number,
                at,
                direction,
                height: text.style_at(byte).size,
            });
        }
    }
    found
}

/// Where a byte lies between the letters that were measured: within a ligature at its share.
fn interpolate(measured: &[(usize, f32)], byte: usize) -> f32 {
    let after = measured.iter().rposition(|(at, _)| *at <= byte).unwrap_or(0);
    let (from, x) = measured[after];
    match measured[after..].iter().find(|(at, _)| *at > byte) {
        Some((to, next)) => x + (next - x) * (byte - from) as f32 / (to - from) as f32,
        None => x,
    }
}
