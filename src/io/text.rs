//! Text as pictures: laid out in the fonts of this machine, and kept as outlines, so that it is
//! the same on every machine. Floor 5. Not here: what a text says (`paint::text`), SVG files (`svg`).
//!
//! A text becomes an SVG with one `text` element a line, which `usvg` shapes: ligatures, kerning,
//! scripts from right to left, letters along a curve; columns are shaped here (`columns`). Its outlines
//! are the file of the picture.

#![warn(missing_docs)]

mod columns;
mod lines;
mod markup;

use super::{Budget, svg};
use crate::math::{Rect, Vec2, vec2};
use crate::paint::Text;
use crate::raster::Picture;
use crate::{Error, Result};
use lines::{Line, lines};
use resvg::usvg::{self, Node, Tree, WriteOptions};
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
    let file = Path::new(FILE);
    let lines = lines(text)?;
    let tree = parse(&markup::of_lines(text, &lines))?;
    let bounds = bounds(&tree);
    let outlines = markup::drawing_within(&tree.to_string(&WriteOptions::default()), bounds);
    let outlines = outlines.ok_or_else(|| Error::decode(file, "the text has no outlines"))?;
    let picture = svg::decode(file, outlines.as_bytes(), budget)?;
    let origin = vec2(-bounds.x0 as f32, -bounds.y0 as f32);
    let size = vec2(bounds.width() as f32, bounds.height() as f32);
    Ok(TextPicture { text: Text { origin, ..text.clone() }, picture, size })
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

/// All that is inked, in whole px, with a pixel around it; a pixel where nothing is.
fn bounds(tree: &Tree) -> Rect {
    let mut bounds: Option<usvg::Rect> = None;
    let texts = texts(tree.root());
    let lines = texts.iter().map(|text| text.flattened().abs_stroke_bounding_box());
    // Columns are outlines already.
    let columns = texts.is_empty().then(|| tree.root().abs_stroke_bounding_box());
    for inked in lines.chain(columns) {
        let is_inked = inked.width() > 0.0 || inked.height() > 0.0;
        if is_inked {
            let joined = bounds.map_or(Some(inked), |known| union(known, inked));
            bounds = joined.or(bounds);
        }
    }
    let Some(bounds) = bounds else { return Rect { x0: 0, y0: 0, x1: 1, y1: 1 } };
    Rect {
        x0: bounds.left().floor() as i32 - 1,
        y0: bounds.top().floor() as i32 - 1,
        x1: bounds.right().ceil() as i32 + 1,
        y1: bounds.bottom().ceil() as i32 + 1,
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
        let mut column = columns::lay(line);
        let begin = columns::begin(text.align, column.length());
        column.letters.iter_mut().for_each(|(_, at)| *at += begin);
        return column.letters;
    }
    let tree = parse(&markup::of_lines(text, std::slice::from_ref(line)));
    let Ok(tree) = tree else { return vec![(0, 0.0)] };
    lines::letters(line, &texts(tree.root()))
}

#[cfg(test)]
mod tests;
