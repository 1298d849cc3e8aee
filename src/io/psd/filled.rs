//! What a record's layer holds: pixels, or the fill that they show.
//! Floor 5.

use super::effects::RecordEffects;
use super::fill::{GradientFill, LayerFill};
use super::line::ShapeLine;
use super::pattern::PatternResource;
use super::{LayerRecord, RecordMask};
use crate::document::{Content, Group, Layer, Live, PixelLayer};
use crate::math::srgb::Color;
use crate::math::{Rect, Size};
use crate::paint::PlacedImage;
use crate::raster::TileGrid;
use std::sync::Arc;

/// How far a fill's pixels may differ from it, of 255, before they win over it.
const SAME: u8 = 3;
/// The name of the layer that is a line around a shape.
const LINE: &str = "Line";

/// What is noted where a line around a shape cannot be drawn.
const NO_LINE: &str = "the line around its shape is left out";

/// The content of a layer. The shape that its fill's pixels show goes into its mask.
pub fn content(record: &mut LayerRecord, size: Size, patterns: &[PatternResource]) -> Content {
    if let Some(path) = record.path.take() {
        (record.rgba, record.rgba16) = (Vec::new(), Vec::new());
        return Content::Image(Live::new(PlacedImage::of_path(size, path)));
    }
    match record.fill.take() {
        None => {
            if record.rgba.is_empty() {
                if record.stroked {
                    record.leave_out(NO_LINE);
                }
                if record.has_unknown_fill {
                    record.leave_out("its fill is left out: a gradient of noise, or damaged");
                }
            } else if record.has_unknown_fill {
                record.note_conversion("its fill, a gradient of noise or damaged, became pixels");
            }
            own_pixels(record)
        }
        Some(fill) if record.rgba.is_empty() => draw_fill(record, fill, size, patterns),
        Some(fill) => show_fill(record, fill, size),
    }
}

/// A fill whose pixels the file does not hold, with the line around it.
fn draw_fill(
    record: &mut LayerRecord,
    fill: LayerFill,
    size: Size,
    patterns: &[PatternResource],
) -> Content {
    let line = record.line.take().filter(|line| line.coverage.is_some());
    if record.stroked && line.is_none() {
        record.leave_out(NO_LINE);
    }
    let filled = match record.unfilled {
        true => None,
        false => Some(fill_content(record, fill, size, patterns)),
    };
    let Some(line) = line else {
        return filled.unwrap_or_else(|| pixels(Vec::new(), Rect::EMPTY));
    };
    let inner = filled.map(|filled| {
        let mask = record.mask.take().map(|mask| mask.to_layer_mask(size));
        Layer { mask, clip_to_surface: false, ..Layer::new(record.name.clone(), filled) }
    });
    record.mask = None;
    let drawn = line_layer(record, line, size, patterns);
    let layers = inner.into_iter().chain([drawn]).map(Arc::new).collect();
    Content::Group(Group { layers, pass_through: false })
}

/// The line around a shape, as a fill with a mask.
pub fn line_layer(
    record: &mut LayerRecord,
    line: ShapeLine,
    size: Size,
    patterns: &[PatternResource],
) -> Layer {
    // What it fills is as large as its mask.
    let mut own = LayerRecord { mask: line.coverage, ..LayerRecord::default() };
    let content = fill_content(&mut own, line.fill, size, patterns);
    std::mem::take(&mut own.lost).into_iter().for_each(|what| record.leave_out(what));
    Layer {
        mask: own.mask.map(|mask| mask.to_layer_mask(size)),
        opacity: line.opacity,
        blend: line.blend,
        clip_to_surface: false,
        ..Layer::new(LINE, content)
    }
}

/// A fill whose pixels the file does not hold.
fn fill_content(
    record: &mut LayerRecord,
    fill: LayerFill,
    size: Size,
    patterns: &[PatternResource],
) -> Content {
    match fill {
        LayerFill::Solid(color) => Content::Fill(color),
        LayerFill::Gradient(gradient) => {
            Content::Gradient(Live::new(gradient.live(filled_rect(record, &gradient, size))))
        }
        LayerFill::Pattern(fill) => {
            match patterns.iter().find_map(|pattern| pattern.pixels(&fill, size)) {
                Some(drawn) => {
                    record.note_conversion("its pattern became pixels");
                    pixels(drawn, size.rect())
                }
                None => {
                    record.leave_out("its pattern is not in the file, or is damaged");
                    pixels(Vec::new(), Rect::EMPTY)
                }
            }
        }
    }
}

/// A fill and its pixels, which show its shape: if their colors differ, the pixels win.
fn show_fill(record: &mut LayerRecord, fill: LayerFill, size: Size) -> Content {
    if has_cut_effects(record, size) {
        record.note_conversion(
            "its fill became pixels: it reaches beyond the canvas, and its effects follow its edge there",
        );
        return own_pixels(record);
    }
    let is_plain = !record.stroked && !record.unfilled;
    let live = match fill {
        LayerFill::Solid(color) if is_plain && is_of(record, |_| Some(color)) => {
            Some(Content::Fill(color))
        }
        LayerFill::Gradient(gradient) if is_plain => opaque_gradient(record, &gradient, size),
        _ => None,
    };
    let Some(live) = live else {
        record.note_conversion("its fill became pixels");
        return own_pixels(record);
    };
    let values: Vec<u8> = record.rgba.iter().skip(3).step_by(4).copied().collect();
    let covers_all =
        record.rect.intersect(size.rect()) == size.rect() && values.iter().all(|v| *v == 255);
    if !covers_all {
        let shape = RecordMask { rect: record.rect, outside: 0, values, disabled: false };
        record.mask = Some(match record.mask.take().filter(|mask| !mask.disabled) {
            Some(mask) => mask.times(size, &shape),
            None => shape,
        });
    }
    (record.rgba, record.rgba16) = (Vec::new(), Vec::new());
    live
}

/// Whether its effects follow an edge beyond the canvas, where a fill with a mask has none.
pub fn has_cut_effects(record: &LayerRecord, size: Size) -> bool {
    let is_shown = |effects: &RecordEffects| effects.list.iter().any(|effect| effect.on);
    record.rect.intersect(size.rect()) != record.rect
        && record.effects.as_ref().is_some_and(is_shown)
}

/// An opaque gradient whose colors the pixels have.
fn opaque_gradient(record: &LayerRecord, gradient: &GradientFill, size: Size) -> Option<Content> {
    let rect = filled_rect(record, gradient, size);
    let is_opaque = gradient.stops.iter().all(|stop| stop.color.a == 255);
    let is_shown = is_opaque && is_of(record, |at| gradient.color_at(rect, at));
    is_shown.then(|| Content::Gradient(Live::new(gradient.live(rect))))
}

/// What a gradient fills: the layer as far as its pixels and mask reach, or the canvas.
fn filled_rect(record: &LayerRecord, gradient: &GradientFill, size: Size) -> Rect {
    let layer = match &record.mask {
        _ if !record.rect.is_empty() => covered_rect(record),
        Some(mask) if mask.outside == 0 => mask.bounds(),
        _ => size.rect(),
    };
    if gradient.aligned && !layer.is_empty() { layer } else { size.rect() }
}

/// The least rectangle around its pixels that are not transparent, or that of all.
fn covered_rect(record: &LayerRecord) -> Rect {
    let width = record.rect.width().max(1);
    let covered =
        record.rgba.as_chunks::<4>().0.iter().enumerate().filter(|(_, pixel)| pixel[3] > 0);
    let all = covered.fold(Rect::EMPTY, |all, (i, _)| {
        let (x, y) = (record.rect.x0 + (i % width) as i32, record.rect.y0 + (i / width) as i32);
        all.union(Rect::new(x, y, x + 1, y + 1))
    });
    if all.is_empty() { record.rect } else { all }
}

/// Whether the pixels have those colors, faint ones aside.
fn is_of(record: &LayerRecord, color: impl Fn([i32; 2]) -> Option<Color>) -> bool {
    let width = record.rect.width().max(1);
    record.rgba.as_chunks::<4>().0.iter().enumerate().all(|(i, &[r, g, b, a])| {
        // A faint pixel keeps too little of its color.
        let at = [record.rect.x0 + (i % width) as i32, record.rect.y0 + (i / width) as i32];
        a < 64
            || color(at).is_some_and(|c| {
                [(r, c.r), (g, c.g), (b, c.b)].iter().all(|(x, y)| x.abs_diff(*y) <= SAME)
            })
    })
}

/// Straight pixels of a rectangle as paint, of 16 bits where there are some.
pub fn paint(rgba: &[u8], rgba16: &[[u16; 4]], rect: Rect) -> Content {
    let (w, h, x, y) = (rect.width(), rect.height(), rect.x0, rect.y0);
    let tiles = match rect.is_empty() || rgba.is_empty() {
        true => TileGrid::default(),
        false if rgba16.is_empty() => TileGrid::from_straight_rgba(rgba, w, h, x, y),
        false => TileGrid::from_straight16(rgba16, w, h, x, y),
    };
    Content::Pixels(PixelLayer { file: String::new(), x, y, tiles })
}

fn pixels(rgba: Vec<u8>, rect: Rect) -> Content {
    paint(&rgba, &[], rect)
}

/// The pixels that the file holds of a record, which it loses.
fn own_pixels(record: &mut LayerRecord) -> Content {
    let (rgba, rgba16) = (std::mem::take(&mut record.rgba), std::mem::take(&mut record.rgba16));
    paint(&rgba, &rgba16, record.rect)
}
