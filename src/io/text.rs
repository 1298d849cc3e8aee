//! Text as pictures: laid out in the fonts of this machine, and kept as outlines, so that it is
//! the same on every machine. Floor 5. Not here: what a text says (`paint::text`), SVG files (`svg`).
//!
//! A text becomes an SVG with one `text` element a line, which `usvg` shapes: ligatures, kerning,
//! scripts from right to left, letters along a curve; columns are shaped here (`columns`). Its outlines
//! are the file of the picture. A text that is typed keeps its lines (`shaped`), and of its picture what
//! the key did not change (`drawing`).

#![warn(missing_docs)]

mod columns;
mod drawing;
mod installed;
mod lines;
mod markup;
mod shaped;

pub use installed::{InstalledFont, find_font};

use super::{Budget, svg};
use crate::Result;
use crate::math::{Rect, Vec2, vec2};
use crate::paint::Text;
use crate::raster::Picture;
use drawing::{PlacedLine, TextDrawing};
use lines::{Line, lines};
use resvg::usvg::{self, Node, Tree};
use std::path::Path;

/// The name of a text's file, for messages.
const FILE: &str = "text.svg";

/// A text that was laid out.
#[derive(Clone, Debug)]
pub struct TextPicture {
    /// The same text; its `origin` is where its first baseline begins in the picture.
    pub text: Text,
    /// What it looks like, larger than its type; a drawing.
    pub picture: Picture,
    /// Its sides at the size of its type, px.
    pub size: Vec2,
    /// The texels that differ from those of the picture that it was laid out in the place of;
    /// `None` where any may.
    pub changed: Option<Rect>,
}

/// A place between letters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Caret {
    /// The bytes of the text before it.
    pub byte: usize,
    /// Of which line, counted from 0.
    pub line: usize,
    /// Where it stands on the baseline, px from where the first baseline begins.
    pub at: Vec2,
    /// Where the baseline goes there, of length 1: down in columns.
    pub direction: Vec2,
    /// The size of the type, px.
    pub height: f32,
}

/// Lays a text out.
///
/// Fails where its letters are too many or its picture does not fit the budget. An empty text is a
/// picture of one transparent pixel.
pub fn lay_out(text: &Text, budget: &Budget) -> Result<TextPicture> {
    lay_out_over(text, None, within_box, budget)
}

/// The same, its picture no larger than what is inked, as documents that hold no outlines of a text
/// place it.
pub fn lay_out_inked(text: &Text, budget: &Budget) -> Result<TextPicture> {
    lay_out_over(text, None, |_, _, inked| inked, budget)
}

/// The same in the place of another text's picture: what both have in common is not painted again.
pub fn lay_out_again(text: &Text, old: &Picture, budget: &Budget) -> Result<TextPicture> {
    lay_out_over(text, Some(old), within_box, budget)
}

/// * `around`: what the picture shows of a text in lines, of which so much is inked.
fn lay_out_over(
    text: &Text,
    old: Option<&Picture>,
    around: fn(&Text, &[Line], usvg::Rect) -> usvg::Rect,
    budget: &Budget,
) -> Result<TextPicture> {
    let file = Path::new(FILE);
    let broken = lines(text)?;
    let shaped: Vec<PlacedLine> = broken
        .iter()
        .map(|line| Ok(PlacedLine { shaped: shaped::shape(text, line)?, at: place(text, line) }))
        .collect::<Result<_>>()?;
    let all = shaped.iter().fold(None, |all, line| join(all, line.inked_rect()));
    let bounds = bounds(all.map(|inked| around(text, &broken, inked)));
    let mut elements = String::new();
    shaped
        .iter()
        .for_each(|line| markup::push_moved(&mut elements, &line.shaped.outlines, line.at));
    let outlines = markup::drawing_of(&elements, bounds);
    let drawn = TextDrawing::of(&shaped, bounds, old, budget)?;
    let (picture, changed) = match drawn {
        Some((picture, changed)) => {
            (Picture { encoded: Some(outlines.into_bytes().into()), ..picture }, changed)
        }
        None => (svg::decode(file, outlines.as_bytes(), budget)?, None),
    };
    let origin = vec2(-bounds.x0 as f32, -bounds.y0 as f32);
    let size = vec2(bounds.width() as f32, bounds.height() as f32);
    Ok(TextPicture { text: Text { origin, ..text.clone() }, picture, size, changed })
}

/// Where a line that was shaped at the origin lies.
fn place(text: &Text, line: &Line) -> Vec2 {
    let is_in_place = line.curve.is_some() && !text.is_in_columns();
    if is_in_place { Vec2::ZERO } else { line.at }
}

/// What is inked, and the whole width of a text that is broken in lines: so its picture stays as
/// large while it is typed.
fn within_box(text: &Text, lines: &[Line], inked: usvg::Rect) -> usvg::Rect {
    let paragraphs =
        text.runs.iter().map(|run| run.string.matches('\n').count()).sum::<usize>() + 1;
    if text.width <= 0.0 || lines.len() <= paragraphs {
        return inked;
    }
    let whole = match text.is_in_columns() {
        true => usvg::Rect::from_ltrb(inked.left(), 0.0, inked.right(), text.width),
        false => usvg::Rect::from_ltrb(0.0, inked.top(), text.width, inked.bottom()),
    };
    whole.and_then(|whole| union(inked, whole)).unwrap_or(inked)
}

/// The places between the letters of a text, by their bytes.
pub fn carets(text: &Text) -> Result<Vec<Caret>> {
    let lines = lines(text)?;
    Ok(lines::carets(text, &lines))
}

/// The families of all fonts, sorted, each once.
pub fn families() -> Vec<String> {
    let fonts = svg::fonts();
    let names = fonts.faces().filter_map(|face| Some(face.families.first()?.0.clone()));
    let mut names: Vec<String> = names.collect();
    names.sort();
    names.dedup();
    names
}

/// The families that a text asks for and this machine lacks.
pub fn missing_families(text: &Text) -> Vec<&str> {
    let fonts = svg::fonts();
    let is_here = |family: &str| {
        fonts.faces().any(|face| face.families.iter().any(|(name, _)| name == family))
    };
    let mut missing: Vec<&str> = text.runs.iter().map(|run| run.style.family.as_str()).collect();
    missing.retain(|family| !family.is_empty() && !is_here(family));
    missing.sort_unstable();
    missing.dedup();
    missing
}

/// An SVG of ours with text, in the fonts of this machine.
fn parse(markup: &str) -> Result<Tree> {
    svg::tree(Path::new(FILE), markup.as_bytes(), &Budget::default())
}

/// All that is inked of a drawing of ours.
fn find_ink(tree: &Tree) -> Option<usvg::Rect> {
    let texts = texts(tree.root());
    let lines = texts.iter().map(|text| text.flattened().abs_stroke_bounding_box());
    // Columns are outlines already.
    let columns = texts.is_empty().then(|| tree.root().abs_stroke_bounding_box());
    let all = lines.chain(columns).filter(|inked| inked.width() > 0.0 || inked.height() > 0.0);
    all.fold(None, |all, inked| join(all, Some(inked)))
}

/// What is inked, in whole px, with a pixel around it; a pixel where nothing is.
fn bounds(inked: Option<usvg::Rect>) -> Rect {
    let Some(bounds) = inked else { return Rect { x0: 0, y0: 0, x1: 1, y1: 1 } };
    Rect {
        x0: bounds.left().floor() as i32 - 1,
        y0: bounds.top().floor() as i32 - 1,
        x1: bounds.right().ceil() as i32 + 1,
        y1: bounds.bottom().ceil() as i32 + 1,
    }
}

fn join(a: Option<usvg::Rect>, b: Option<usvg::Rect>) -> Option<usvg::Rect> {
    match (a, b) {
        (Some(a), Some(b)) => union(a, b).or(Some(a)),
        (a, b) => a.or(b),
    }
}

fn union(a: usvg::Rect, b: usvg::Rect) -> Option<usvg::Rect> {
    usvg::Rect::from_ltrb(
        a.left().min(b.left()),
        a.top().min(b.top()),
        a.right().max(b.right()),
        a.bottom().max(b.bottom()),
    )
}

/// The text elements of a drawing, in their order.
fn texts(group: &usvg::Group) -> Vec<&usvg::Text> {
    let mut found = Vec::new();
    for node in group.children() {
        match node {
            Node::Text(text) => found.push(&**text),
            Node::Group(group) => found.extend(texts(group)),
            Node::Path(_) | Node::Image(_) => {}
        }
    }
    found
}

/// A line of text as it is measured: where each of its letters begins along the line, and its end.
fn advances(text: &Text, line: &Line) -> Vec<(usize, f32)> {
    if text.is_in_columns() {
        let Ok(column) = shaped::lay(line, text.align) else { return vec![(0, 0.0)] };
        let begin = columns::begin(text.align, column.length());
        return column.letters.iter().map(|(byte, at)| (*byte, at + begin)).collect();
    }
    shaped::measure(line, text.align).map_or_else(|_| vec![(0, 0.0)], |letters| letters.to_vec())
}

#[cfg(test)]
mod tests;
