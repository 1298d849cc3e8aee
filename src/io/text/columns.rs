//! Columns of vertical text, in the forms that fonts have for them: `usvg` lays lines, and turns small
//! kana and commas over. Floor 5.
//!
//! What stands upright in columns (Unicode annex 50) is shaped from top to bottom, so that fonts give
//! their vertical forms; the rest is shaped as a line that runs down. Both keep the axis of the column
//! in their middle.

use super::lines::Line;
use crate::math::{Vec2, vec2};
use crate::paint::{TextAlign, TextRun, TextStyle};
use crate::svg;
use harfrust::{Direction, Feature, ShapeOptions, ShaperData, ShaperInstance, Tag, UnicodeBuffer};
use resvg::usvg::fontdb::{Database, Family, ID, Query, Style, Weight};
use skrifa::instance::LocationRef;
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::prelude::Size;
use skrifa::{FontRef, GlyphId, MetadataProvider};
use std::fmt::Write;
use unicode_vo::{Orientation, char_orientation};

/// A line that was laid out as a column.
pub(super) struct Column {
    /// The outlines of its letters as SVG has them, the column beginning at the origin; each with
    /// the style of its run.
    pub outlines: Vec<(String, TextStyle)>,
    /// Where its letters begin: bytes within the line, and px down it; the last one is its end.
    pub letters: Vec<(usize, f32)>,
}

impl Column {
    /// How long it is, px.
    pub fn length(&self) -> f32 {
        self.letters.last().map_or(0.0, |(_, end)| *end)
    }
}

/// Where a column of a length begins, px from where its alignment holds it.
pub(super) fn begin(align: TextAlign, length: f32) -> f32 {
    match align {
        TextAlign::Start => 0.0,
        TextAlign::Middle => -length / 2.0,
        TextAlign::End => -length,
    }
}

/// Letters of one font that lie the same way.
struct ColumnPiece<'a> {
    text: &'a str,
    font: ID,
    is_upright: bool,
}

/// Lays a line out as a column.
pub(super) fn lay(line: &Line) -> Column {
    let fonts = svg::fonts();
    let mut column = Column { outlines: Vec::new(), letters: Vec::new() };
    let (mut down, mut start) = (0.0, 0);
    for run in &line.pieces {
        let mut outlines = String::new();
        let mut byte = start;
        for piece in pieces(&fonts, run) {
            let shaped = fonts.with_face_data(piece.font, |data, face| {
                shape(data, face, &piece, &run.style, down)
            });
            if let Some(shaped) = shaped.flatten() {
                outlines.push_str(&shaped.outlines);
                let letters = shaped.letters.into_iter().map(|(at, y)| (byte + at, y));
                column.letters.extend(letters);
                down = shaped.end;
            }
            byte += piece.text.len();
        }
        column.outlines.push((outlines, run.style.clone()));
        start += run.string.len();
    }
    column.letters.sort_by_key(|(byte, _)| *byte);
    column.letters.push((start, down));
    column
}

/// A run in pieces; letters that no font has are in the font of the run.
fn pieces<'a>(fonts: &Database, run: &'a TextRun) -> Vec<ColumnPiece<'a>> {
    let Some(own) = own_font(fonts, &run.style) else { return Vec::new() };
    let mut known = vec![own];
    let mut found: Vec<ColumnPiece> = Vec::new();
    let mut begin = 0;
    for (byte, letter) in run.string.char_indices() {
        let end = byte + letter.len_utf8();
        let font = font_of(fonts, &mut known, &run.style, letter);
        let is_upright = is_upright(fonts, font, letter);
        match found.last_mut() {
            Some(last) if last.font == font && last.is_upright == is_upright => {
                last.text = &run.string[begin..end];
            }
            _ => {
                begin = byte;
                found.push(ColumnPiece { text: &run.string[byte..end], font, is_upright });
            }
        }
    }
    found
}

fn own_font(fonts: &Database, style: &TextStyle) -> Option<ID> {
    let families = match style.family.as_str() {
        "" => vec![Family::SansSerif],
        family => vec![Family::Name(family), Family::SansSerif],
    };
    let slant = if style.italic { Style::Italic } else { Style::Normal };
    let weight = Weight(style.weight);
    let query = Query { families: &families, weight, style: slant, ..Query::default() };
    fonts.query(&query).or_else(|| fonts.faces().next().map(|face| face.id))
}

/// The first of the known fonts that has a letter, or else the one of the others that is nearest in
/// weight.
fn font_of(fonts: &Database, known: &mut Vec<ID>, style: &TextStyle, letter: char) -> ID {
    if letter.is_whitespace() || letter.is_control() {
        return known[0];
    }
    if let Some(has_it) = known.iter().find(|font| has_letter(fonts, **font, letter)) {
        return *has_it;
    }
    let weight = |of: u16| of.abs_diff(style.weight);
    let others = fonts.faces().filter(|face| has_letter(fonts, face.id, letter));
    let nearest = others.min_by_key(|face| (weight(face.weight.0), face.style != Style::Normal));
    nearest.map_or(known[0], |face| {
        known.push(face.id);
        face.id
    })
}

pub(super) fn has_letter(fonts: &Database, font: ID, letter: char) -> bool {
    glyph_of(fonts, font, letter).is_some()
}

fn glyph_of(fonts: &Database, font: ID, letter: char) -> Option<GlyphId> {
    fonts.with_face_data(font, |data, face| {
        FontRef::from_index(data, face).ok()?.charmap().map(letter)
    })?
}

/// Whether a letter stands upright in columns. Brackets and long dashes do where the font has forms
/// of them for columns, else they are turned.
fn is_upright(fonts: &Database, font: ID, letter: char) -> bool {
    match char_orientation(letter) {
        Orientation::Upright | Orientation::TransformedOrUpright => true,
        Orientation::Rotated => false,
        Orientation::TransformedOrRotated => {
            let plain = glyph_of(fonts, font, letter);
            let upright = fonts.with_face_data(font, |data, face| {
                let font = harfrust::FontRef::from_index(data, face).ok()?;
                let mut buffer = UnicodeBuffer::new();
                buffer.push_str(letter.encode_utf8(&mut [0; 4]));
                buffer.set_direction(Direction::TopToBottom);
                buffer.guess_segment_properties();
                let shaper_data = ShaperData::new(&font);
                let shaped = shaper_data.shaper(&font).build().shape(buffer, ShapeOptions::new());
                shaped.glyph_infos().first().map(|info| GlyphId::new(info.glyph_id))
            });
            upright.flatten().is_some_and(|upright| Some(upright) != plain)
        }
    }
}

/// A piece that was shaped.
struct Shaped {
    outlines: String,
    /// Bytes within the piece, and px down the column.
    letters: Vec<(usize, f32)>,
    end: f32,
}

/// Shapes a piece that begins so far down its column; `None` for a broken font.
fn shape(
    data: &[u8],
    face: u32,
    piece: &ColumnPiece,
    style: &TextStyle,
    begin: f32,
) -> Option<Shaped> {
    let font = FontRef::from_index(data, face).ok()?;
    let metrics = font.metrics(Size::unscaled(), LocationRef::default());
    let scale = style.size / f32::from(metrics.units_per_em.max(1));
    let weight = (skrifa::Tag::new(b"wght"), f32::from(style.weight));
    let location = font.axes().location([weight]);
    let for_shaping = harfrust::FontRef::from_index(data, face).ok()?;
    let instance = ShaperInstance::from_variations(&for_shaping, [("wght", weight.1)]);
    let mut buffer = UnicodeBuffer::new();
    buffer.push_str(piece.text);
    if piece.is_upright {
        buffer.set_direction(Direction::TopToBottom);
    }
    buffer.guess_segment_properties();
    let is_backward = buffer.direction() == Direction::RightToLeft;
    let loose = [Tag::new(b"kern"), Tag::new(b"vkrn")].map(|tag| Feature::new(tag, 0, ..));
    let features: &[Feature] = if style.kerning { &[] } else { &loose };
    let shaper_data = ShaperData::new(&for_shaping);
    let shaper = shaper_data.shaper(&for_shaping).instance(Some(&instance)).build();
    let shaped = shaper.shape(buffer, ShapeOptions::new().features(features));
    // The middle of a line that runs down is on the axis.
    let aside = -0.5 * scale * (metrics.ascent + metrics.descent);
    let outlines = font.outline_glyphs();
    let (mut pen, mut letters) = (SvgPen::default(), Vec::new());
    let mut down = begin;
    for (info, at) in shaped.glyph_infos().iter().zip(shaped.glyph_positions()) {
        let offset = vec2(at.x_offset as f32, at.y_offset as f32);
        let advance = if piece.is_upright { -at.y_advance } else { at.x_advance };
        let next = down + scale * advance as f32 + style.tracking * style.size / 1000.0;
        pen.place = match piece.is_upright {
            true => GlyphPlace { from: vec2(0.0, down), x: vec2(scale, 0.0), y: vec2(0.0, -scale) },
            false => {
                GlyphPlace { from: vec2(aside, down), x: vec2(0.0, scale), y: vec2(scale, 0.0) }
            }
        };
        pen.place.from = pen.place.at(offset.x, offset.y);
        if let Some(glyph) = outlines.get(GlyphId::new(info.glyph_id)) {
            // A glyph without an outline shows nothing.
            let _ = glyph.draw(DrawSettings::unhinted(Size::unscaled(), &location), &mut pen);
        }
        letters.push((info.cluster as usize, if is_backward { next } else { down }));
        down = next;
    }
    letters.dedup_by_key(|(byte, _)| *byte);
    Some(Shaped { outlines: pen.data, letters, end: down })
}

/// Where a glyph lies in its column: its origin, and its units of the font.
#[derive(Clone, Copy, Default)]
struct GlyphPlace {
    from: Vec2,
    x: Vec2,
    y: Vec2,
}

impl GlyphPlace {
    fn at(self, x: f32, y: f32) -> Vec2 {
        self.from + self.x * x + self.y * y
    }
}

/// Writes outlines as SVG's path data.
#[derive(Default)]
struct SvgPen {
    place: GlyphPlace,
    data: String,
}

impl SvgPen {
    fn push<const N: usize>(&mut self, command: char, points: [(f32, f32); N]) {
        self.data.push(command);
        for (x, y) in points {
            let at = self.place.at(x, y);
            let _ = write!(self.data, "{:.3} {:.3} ", at.x, at.y);
        }
    }
}

impl OutlinePen for SvgPen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.push('M', [(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.push('L', [(x, y)]);
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.push('Q', [(cx, cy), (x, y)]);
    }

    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        self.push('C', [(ax, ay), (bx, by), (x, y)]);
    }

    fn close(&mut self) {
        self.data.push('Z');
    }
}
