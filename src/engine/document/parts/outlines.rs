//! The outlines that parts name: of layers, colours, pictures, paths and objects.
//! Floor 4.

use super::{CoverageFile, OutlineSource};
use crate::document::{Content, Document, Layer, Progress, flatten_layer};
use crate::math::srgb::Color;
use crate::math::{Rect, Size};
use crate::raster::{Plane, TileGrid};
use crate::shape::Outline;
use crate::surface::Surface;
use std::sync::Arc;

/// What an outline is made of: while it is the same, so is the outline.
#[derive(Clone)]
pub enum OutlineKey {
    Layer(Arc<Layer>, Option<Color>),
    Coverage(Arc<Plane<u8>>),
    Path(OutlineSource),
    Object(Arc<Surface>, u32),
}

impl OutlineKey {
    /// `None` where what is named is not there.
    pub fn of(document: &Document, source: &OutlineSource) -> Option<Self> {
        Some(match source {
            OutlineSource::Layer { layer, color } => Self::Layer(document.layer_named(layer)?.clone(), *color),
            OutlineSource::File(CoverageFile { coverage, .. }) => Self::Coverage(coverage.clone()),
            OutlineSource::Path(_) => Self::Path(source.clone()),
            OutlineSource::Object(object) => Self::Object(document.maps_surface()?.clone(), *object),
        })
    }
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Layer(a, x), Self::Layer(b, y)) => x == y && (Arc::ptr_eq(a, b) || same_pixels(a, b)),
            (Self::Coverage(a), Self::Coverage(b)) => Arc::ptr_eq(a, b),
            (Self::Path(a), Self::Path(b)) => a == b,
            (Self::Object(a, x), Self::Object(b, y)) => Arc::ptr_eq(a, b) && x == y,
            _ => false,
        }
    }
    /// The outline; `None` where nothing is covered.
    pub fn outline(&self, document: &Document, most_px: usize) -> Option<Outline> {
        match self {
            Self::Layer(layer, color) => {
                let tiles = pixels(document, layer)?;
                let rect = tiles.bounds();
                if rect.is_empty() || rect.width().checked_mul(rect.height()).is_none_or(|px| px > most_px) {
                    return None;
                }
                let coverage = match color {
                    None => alpha(&tiles, rect),
                    Some(color) => of_color(&tiles, rect, *color),
                };
                Outline::new((rect.x0, rect.y0), &coverage)
            }
            Self::Coverage(coverage) => Outline::new((0, 0), coverage),
            Self::Path(OutlineSource::Path(points)) => Outline::of_path(points, most_px),
            Self::Path(_) => None,
            Self::Object(surface, object) => {
                let labels = surface.objects().labels();
                let coverage =
                    Plane::from_fn(
                        surface.size(),
                        |x, y| {
                            if labels.at(x, y) == *object { surface.coverage(x, y) } else { 0 }
                        },
                    );
                Outline::new((0, 0), &coverage)
            }
        }
    }
}

/// Whether two versions of a layer hold the same paint: its name, mode or opacity change no outline.
fn same_pixels(a: &Layer, b: &Layer) -> bool {
    match (&a.content, &b.content) {
        (Content::Pixels(a), Content::Pixels(b)) => a.tiles.ptr_eq(&b.tiles),
        _ => false,
    }
}

/// What a layer paints: its own pixels, or what it shows alone, without any surface, which follows from it.
fn pixels(document: &Document, layer: &Arc<Layer>) -> Option<TileGrid> {
    if let Content::Pixels(pixels) = &layer.content {
        return Some(pixels.tiles.clone());
    }
    let flat = Document { surface: None, ..document.clone() };
    flatten_layer(&flat, layer.id, &Progress::default())
}

fn size_of(rect: Rect) -> Size {
    Size::new(rect.width() as u32, rect.height() as u32)
}

fn alpha(tiles: &TileGrid, rect: Rect) -> Plane<u8> {
    Plane::from_fn(size_of(rect), |x, y| tiles.pixel(rect.x0 + x as i32, rect.y0 + y as i32)[3])
}

/// Colours nearer than this, in any channel of 8 bits, are one flat.
pub const NEAR: i32 = 8;

pub fn is_near(pixel: [u8; 4], color: [u8; 4]) -> bool {
    pixel.iter().zip(color).all(|(a, b)| (i32::from(*a) - i32::from(b)).abs() <= NEAR)
}

/// The share of each pixel that a flat colour takes: all of it where the pixel has the colour; at its edge as far as
/// the pixel lies on the way from what is beside it to the colour.
pub fn of_color(tiles: &TileGrid, rect: Rect, color: Color) -> Plane<u8> {
    let color = color.premultiplied().map(|v| (v * 255.0).round() as u8);
    let at = |x: i32, y: i32| tiles.pixel(rect.x0 + x, rect.y0 + y);
    Plane::from_fn(size_of(rect), |x, y| {
        let (x, y) = (x as i32, y as i32);
        let here = at(x, y);
        if is_near(here, color) {
            return 255;
        }
        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy))).map(|(x, y)| at(x, y));
        let (mut beside, mut other) = (false, None);
        for pixel in around {
            if is_near(pixel, color) {
                beside = true;
            } else if other.is_none_or(|known| apart(pixel, color) > apart(known, color)) {
                other = Some(pixel);
            }
        }
        match (beside, other) {
            (true, Some(other)) => share_on_the_way(here, other, color),
            _ => 0,
        }
    })
}

fn apart(a: [u8; 4], b: [u8; 4]) -> i32 {
    a.iter().zip(b).map(|(a, b)| (i32::from(*a) - i32::from(b)).pow(2)).sum()
}

/// How far a pixel lies from one colour toward another, 255 at the other; 0 where it lies beside the way.
pub fn share_on_the_way(pixel: [u8; 4], from: [u8; 4], to: [u8; 4]) -> u8 {
    let way: [f32; 4] = std::array::from_fn(|c| f32::from(to[c]) - f32::from(from[c]));
    let gone: [f32; 4] = std::array::from_fn(|c| f32::from(pixel[c]) - f32::from(from[c]));
    let dot = |a: &[f32; 4], b: &[f32; 4]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
    let length = dot(&way, &way);
    if length < 1.0 {
        return 0;
    }
    let t = (dot(&gone, &way) / length).max(0.0).min(1.0);
    let off: [f32; 4] = std::array::from_fn(|c| gone[c] - t * way[c]);
    if dot(&off, &off) > (4 * NEAR * NEAR) as f32 { 0 } else { (t * 255.0).round() as u8 }
}
