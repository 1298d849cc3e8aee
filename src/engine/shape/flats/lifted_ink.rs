//! The ink of a drawing lifted off its flats: the lines as paint of their own, and the drawing
//! without them. Floor 3. Not here: which pixels are lines (`ink`), layers that show them
//! (`document::ink_layers`).
//!
//! A pixel d of a line is f (1 − c) + L: the flat color f that continues under the line, and the
//! ink L, which covers c of it. c is the projection of d on the way from f to the tone of the line.

use super::areas::{pixels, spread};
use super::color_distance::{color_distance, share_on_the_way, uncomposite};
use super::palette::NONE;
use super::picture::{FlatReading, Pixel, REACH};
use super::shares::WithoutLines;
use crate::math::Rect;
use crate::raster::{Plane, Tile, TileAt, TileGrid, distance};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Ink that takes less of a pixel than this, of 255, is not seen: it may be noise.
const LEAST_INK: u8 = 3;
/// A line no farther from a flat than this, in any channel of 8 bits, is told from it only in its
/// middle.
const HARDLY_SEEN: u8 = 24;
/// How wide the halo of a line may be, px.
const HALO_PX: i32 = 2;
/// Nothing, and no ink.
const NOTHING: Pixel = [0; 4];

/// A drawing as two layers.
pub struct LiftedInk {
    /// The drawing.
    pub source: TileGrid,
    /// It without its lines: the colors beside them continue beneath.
    pub flats: TileGrid,
    /// The lines alone.
    pub lines: TileGrid,
}

impl LiftedInk {
    /// The ink of a drawing.
    pub fn of(source: &TileGrid) -> Self {
        match source.bounds().is_empty() {
            true => Self::none_of(source),
            false => Self::of_reading(source, &FlatReading::of(source, source.bounds())),
        }
    }

    /// The same where the whole of it was read.
    pub fn of_reading(source: &TileGrid, reading: &FlatReading) -> Self {
        let (rect, mut lifted) = (source.bounds(), Self::none_of(source));
        let read = WithoutLines::of(reading, &[]).with_thin_lines();
        if read.lines.values().iter().any(|line| *line != NONE) {
            let split = Lifting::of(&read, source, rect).split();
            lay(&mut lifted, &split, rect);
        }
        lifted
    }

    /// Of a drawing without ink.
    fn none_of(source: &TileGrid) -> Self {
        Self { source: source.clone(), flats: source.clone(), lines: TileGrid::default() }
    }

    /// Whether no ink was found.
    pub fn is_empty(&self) -> bool {
        self.lines.bounds().is_empty()
    }

    /// What is shown of paint of which this is the ink: tiles that were painted on since show all
    /// that is on them.
    pub fn visible_paint(&self, tiles: &TileGrid) -> TileGrid {
        let mut shown = self.flats.clone();
        if !self.source.ptr_eq(tiles) {
            for at in self.source.changed_tiles(tiles) {
                shown.set(at, tiles.tile(at).cloned());
            }
        }
        shown
    }
}

/// Takes in the pixels that were split, by their indices in a rectangle.
fn lay(lifted: &mut LiftedInk, split: &[(usize, [Pixel; 2])], rect: Rect) {
    let place = |i: usize| {
        let (x, y) = (i % rect.width(), i / rect.width());
        (rect.x0 + x as i32, rect.y0 + y as i32)
    };
    let touched: BTreeSet<TileAt> = split
        .iter()
        .map(|(i, _)| {
            let (x, y) = place(*i);
            TileAt::of_pixel(x, y)
        })
        .collect();
    let mut parts: BTreeMap<TileAt, [Vec<Pixel>; 2]> = touched
        .into_iter()
        .map(|at| {
            let own = at.rect();
            let all = (own.y0..own.y1).flat_map(|y| (own.x0..own.x1).map(move |x| (x, y)));
            let flats: Vec<Pixel> = all.map(|(x, y)| lifted.source.pixel(x, y)).collect();
            let lines = vec![NOTHING; flats.len()];
            (at, [flats, lines])
        })
        .collect();
    for (i, [flat, line]) in split {
        let (x, y) = place(*i);
        let at = TileAt::of_pixel(x, y);
        let own = at.rect();
        let within = (y - own.y0) as usize * own.width() + (x - own.x0) as usize;
        if let Some([flats, lines]) = parts.get_mut(&at) {
            (flats[within], lines[within]) = (*flat, *line);
        }
    }
    for (at, [flats, lines]) in parts {
        lifted.flats.set(at, tile_of(&flats));
        lifted.lines.set(at, tile_of(&lines));
    }
}

fn tile_of(pixels: &[Pixel]) -> Option<Arc<Tile>> {
    Tile::from_pixels(pixels.as_flattened().to_vec()).map(Arc::new)
}

/// What is known about the pixels near lines.
struct Lifting<'a> {
    read: &'a WithoutLines,
    /// The drawing, and where it was read: seams that reading closes are open in it.
    source: &'a TileGrid,
    rect: Rect,
    /// Those that are of a line for the most part, or next to one.
    is_near: Plane<bool>,
    /// The color of the nearest line, by its number, one more.
    tone: Plane<u32>,
    /// The nearest pixel of a flat area, by its index, one more.
    flat: Plane<u32>,
}

impl<'a> Lifting<'a> {
    fn of(read: &'a WithoutLines, source: &'a TileGrid, rect: Rect) -> Self {
        let WithoutLines { picture, lines, .. } = read;
        // In pixel art no line has a soft border.
        let reach = if picture.is_pixel_art { 0 } else { REACH as u16 };
        let away =
            distance::squared_distances(&lines.map(|line| u8::from(line != NONE)), reach + 1);
        let is_near = away.map(|away| away <= reach * reach);
        let mut tone = lines.map(|line| if line == NONE { 0 } else { u32::from(line) + 1 });
        spread(&mut tone, |x, y| is_near.at(x, y));
        let width = is_near.width();
        let is_area = |x: usize, y: usize| {
            lines.at(x, y) == NONE && picture.is_flat.at(x, y) && picture.pixels.at(x, y)[3] == 255
        };
        let mut flat = Plane::from_fn(lines.size(), |x, y| {
            if is_area(x, y) { (y * width + x) as u32 + 1 } else { 0 }
        });
        spread(&mut flat, |x, y| is_near.at(x, y));
        Self { read, source, rect, is_near, tone, flat }
    }

    /// The pixels that hold ink, by their indices: what is left of each, and its ink.
    fn split(&self) -> Vec<(usize, [Pixel; 2])> {
        let (width, height) = (self.is_near.width(), self.is_near.height());
        let one = |(x, y): (usize, usize)| Some((y * width + x, self.split_one(x, y)?));
        pixels((width, height)).filter_map(one).collect()
    }

    fn split_one(&self, x: usize, y: usize) -> Option<[Pixel; 2]> {
        let WithoutLines { lines, colors, .. } = self.read;
        let drawn = self.source.pixel(self.rect.x0 + x as i32, self.rect.y0 + y as i32);
        let tone = self.tone.at(x, y).checked_sub(1).filter(|_| self.is_near.at(x, y))?;
        let tone = colors[tone as usize].color;
        let is_line = lines.at(x, y) != NONE;
        if drawn[3] < 255 {
            let is_ink =
                is_line || share_on_the_way(drawn, NOTHING, tone) > 0 || self.is_halo((x, y));
            return (is_ink && drawn[3] > 0).then_some([NOTHING, drawn]);
        }
        if !is_line && self.is_area(x as i32, y as i32) {
            return None;
        }
        if !is_line && self.is_halo((x, y)) {
            return Some([NOTHING, drawn]);
        }
        let (flat, ink) = self.color_beneath((x, y), drawn, tone).unwrap_or_default();
        if is_line && (flat[3] < 255 || color_distance(flat, tone) <= HARDLY_SEEN) {
            return Some([if flat[3] < 255 { NOTHING } else { flat }, drawn]);
        }
        if flat[3] < 255 || !is_line && ink < LEAST_INK {
            return None;
        }
        let least = if is_line && ink == 0 { 255 } else { ink };
        let line = (least..=255).find_map(|alpha| uncomposite(drawn, alpha, flat));
        Some([flat, line.unwrap_or(drawn)])
    }

    /// Whether a pixel lies between a line and nothing: where a drawing was made smaller or
    /// compressed, its lines have such pixels around them, in colors of neither.
    fn is_halo(&self, (x, y): (usize, usize)) -> bool {
        let (x, y) = (x as i32, y as i32);
        let is_line = |x: i32, y: i32| self.read.lines.get(x, y).is_some_and(|line| line != NONE);
        let is_nothing = |x: i32, y: i32| {
            let is_inside = self.read.lines.get(x, y).is_some();
            is_inside && self.source.pixel(self.rect.x0 + x, self.rect.y0 + y)[3] == 0
        };
        let around = |reach: i32| {
            (-reach..=reach).flat_map(move |dy| (-reach..=reach).map(move |dx| (x + dx, y + dy)))
        };
        around(HALO_PX).any(|(x, y)| is_line(x, y))
            && around(HALO_PX).any(|(x, y)| is_nothing(x, y))
            // Not where a flat color ends beside a line.
            && !around(1).any(|(x, y)| self.is_area(x, y))
    }

    /// Whether a pixel is of a flat color alone.
    fn is_area(&self, x: i32, y: i32) -> bool {
        let index = self.flat.get(x, y).unwrap_or(0);
        index > 0 && index as usize - 1 == y as usize * self.flat.width() + x as usize
    }

    /// The flat color under a pixel of a line, and how much of the pixel the ink takes, of 255:
    /// of the areas around, the one of which it is a mixture with the tone of the line.
    fn color_beneath(
        &self,
        (x, y): (usize, usize),
        drawn: Pixel,
        tone: Pixel,
    ) -> Option<(Pixel, u8)> {
        let (x, y) = (x as i32, y as i32);
        let around = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)];
        let flats = around.into_iter().filter_map(|(dx, dy)| {
            let index = self.flat.get(x + dx, y + dy)?.checked_sub(1)?;
            Some(self.read.flat_color(index as usize))
        });
        let nearest = flats.clone().next();
        let mixed = flats
            .filter(|flat| color_distance(*flat, tone) > HARDLY_SEEN)
            .map(|flat| (flat, share_on_the_way(drawn, flat, tone)))
            .find(|(_, share)| *share > 0);
        mixed.or_else(|| nearest.map(|flat| (flat, 0)))
    }
}

#[cfg(test)]
mod tests;
