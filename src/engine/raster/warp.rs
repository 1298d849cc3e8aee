//! Pixels seen through a map: each pixel of the canvas from the pixels that it shows, sampled once.
//! Floor 1. Maps are in `math`; this uses only their inverse.
//!
//! A map that moves whole pixels copies them. Otherwise a pixel is a weighted mean of the source
//! around the point that it shows. Where the source is magnified along an axis of the pixel, the
//! weights are a cubic's; where it is reduced, they are the share of each source pixel's tent in
//! the pixel's own piece of the source. `Linear` takes the four nearest pixels instead, as long as
//! this skips none. A tile that shows part of a 16-bit tile has 16 bits.

mod linear;
mod points;
mod rows;
mod source;
mod tile_map;
mod weights;
mod window;

pub use points::PointRow;
use source::{GridSource, PixelSource, PlaneSource};
pub use tile_map::{TileMap, TilePoints};
use window::SourceWindow;

use super::tile::sixteen_bit::{self, Row16};
use super::tile::{TILE, Tile, TileAt, TileF32, transparent_f32};
use super::{Plane, TileGrid};
use crate::math::fast::{max, min};
use crate::math::plane_map::PixelMove;
use crate::math::srgb::{quantize, quantize16};
use crate::math::{Mat2, Rect, Size, Vec2, parallel};
use std::sync::Arc;

crate::named! {
    /// How magnified or turned pixels are interpolated.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum Resampling {
        /// Mitchell and Netravali's cubic, B = C = ⅓: no rings, slightly soft.
        #[default]
        Smooth = "smooth",
        /// Catmull and Rom's cubic: sharp, with faint rings.
        Sharp = "sharp",
        /// The four nearest pixels, where a pixel shows no more than two of the source along a
        /// side: quick. Shown while a hand drags.
        Linear = "linear",
        /// The nearest pixel, for pixel art.
        Nearest = "nearest",
    }
}

/// The map that pixels are seen through.
pub trait PixelMap: Sync {
    /// The point of the source that a point of the canvas shows, and how it moves with that point;
    /// `None` if there is none.
    fn source_of(&self, q: Vec2) -> Option<(Vec2, Mat2)>;
    /// The same for the centers of `count` pixels from `(x, y)` on, at most a tile's side.
    fn source_row(&self, x: i32, y: i32, count: usize, row: &mut PointRow) {
        row.fill_by_points(self, x, y, count);
    }

    /// The move of whole pixels that it is, if it is one.
    fn pixel_move(&self) -> Option<PixelMove>;
    /// A rectangle of the source that holds everything a rectangle of the canvas shows; it may be
    /// larger.
    fn source_rect(&self, canvas: Rect) -> Rect;
}

/// The tiles of a grid seen through a map, only those in `wanted`.
pub fn warp_tiles(
    grid: &TileGrid,
    map: &dyn PixelMap,
    filter: Resampling,
    wanted: &[TileAt],
) -> TileGrid {
    let tiles: Vec<Option<Arc<Tile>>> =
        parallel::map(wanted, |&at| warp_tile(grid, map, filter, at));
    let mut out = TileGrid::default();
    if let Some(all) = wanted.iter().map(|at| at.rect()).reduce(Rect::union) {
        out.reserve(all);
    }
    wanted.iter().zip(tiles).for_each(|(&at, tile)| out.set(at, tile));
    out
}

/// One tile of a grid seen through a map; `None` if it is transparent.
pub fn warp_tile(
    grid: &TileGrid,
    map: &dyn PixelMap,
    filter: Resampling,
    at: TileAt,
) -> Option<Arc<Tile>> {
    warp_tile_within(grid, None, map, filter, at)
}

/// The same for pixels whose border is repeated beyond a rectangle, if there is one.
pub fn warp_tile_within(
    grid: &TileGrid,
    border: Option<Rect>,
    map: &dyn PixelMap,
    filter: Resampling,
    at: TileAt,
) -> Option<Arc<Tile>> {
    if let Some(by) = map.pixel_move() {
        return move_tile(grid, by, at);
    }
    let mut pixels = transparent_f32();
    let source = GridSource {
        grid,
        bounds: border.unwrap_or_else(|| grid.bounds()),
        continues: border.is_some(),
    };
    let wanted = source.rect_to_read(map.source_rect(at.rect()));
    Warp { source: &source, map, filter }.block_of(at.rect(), wanted, &mut |x, y, row| {
        let (x, y) = ((x - at.rect().x0) as usize, (y - at.rect().y0) as usize);
        limit_to_alpha(row, &mut pixels[y * TILE + x..][..row.len()]);
    });
    let is_16_bit = grid.is_16_bit_at(wanted);
    let tile =
        if is_16_bit { Tile::from_rows16(quantized16(&pixels)) } else { Tile::quantize(&pixels) };
    tile.map(Arc::new)
}

/// Pixels rounded to 16 bits.
fn quantized16(pixels: &TileF32) -> Box<[Row16]> {
    let mut rows = sixteen_bit::clear_rows();
    for (row, pixels) in rows.iter_mut().zip(pixels.chunks_exact(TILE)) {
        pixels
            .iter()
            .enumerate()
            .for_each(|(x, pixel)| sixteen_bit::put(row, x, pixel.map(quantize16)));
    }
    rows
}

crate::widest! {
    /// Premultiplied colors limited to their alpha, which rings of a cubic may exceed.
    fn limit_to_alpha(row: &[[f32; 4]], out: &mut [[f32; 4]]) {
        for (out, value) in out.iter_mut().zip(row) {
            let alpha = min(max(value[3], 0.0), 1.0);
            for c in 0..4 {
                out[c] = min(max(value[c], 0.0), alpha);
            }
        }
    }
}

fn move_tile(grid: &TileGrid, by: PixelMove, at: TileAt) -> Option<Arc<Tile>> {
    if by == PixelMove::NONE {
        return grid.tile(at).cloned();
    }
    let rect = at.rect();
    let read = [(rect.x0, rect.y0), (rect.x1 - 1, rect.y1 - 1)].map(|(x, y)| by.source(x, y));
    let read = read.map(|(x, y)| Rect::new(x, y, x.saturating_add(1), y.saturating_add(1)));
    let read = read[0].union(read[1]);
    if grid.is_16_bit_at(read) {
        let mut rows = sixteen_bit::clear_rows();
        for (row, y) in rows.iter_mut().zip(rect.y0..) {
            for x in 0..TILE {
                let (sx, sy) = by.source(rect.x0 + x as i32, y);
                sixteen_bit::put(row, x, grid.pixel16(sx, sy));
            }
        }
        return Tile::from_rows16(rows).map(Arc::new);
    }
    let mut bytes = Vec::with_capacity(TILE * TILE * 4);
    for y in rect.y0..rect.y1 {
        for x in rect.x0..rect.x1 {
            let (sx, sy) = by.source(x, y);
            bytes.extend(grid.pixel(sx, sy));
        }
    }
    Tile::from_pixels(bytes).map(Arc::new)
}

/// A map of the canvas, such as a mask's coverage, seen through a map; its border continues beyond
/// it.
pub fn warp_plane(plane: &Plane<u8>, map: &dyn PixelMap, filter: Resampling) -> Plane<u8> {
    warp_plane_onto(plane, map, filter, plane.size())
}

/// The same on a canvas of another size.
pub fn warp_plane_onto(
    plane: &Plane<u8>,
    map: &dyn PixelMap,
    filter: Resampling,
    size: Size,
) -> Plane<u8> {
    if let Some(by) = map.pixel_move() {
        return Plane::from_fn(size, |x, y| {
            let (x, y) = by.source(x as i32, y as i32);
            plane.at_clamped(x, y)
        });
    }
    let source = PlaneSource { plane };
    let warp = Warp { source: &source, map, filter };
    let canvas = size.rect();
    let blocks: Vec<TileAt> = TileAt::covering(canvas).collect();
    let values: Vec<Vec<(i32, i32, u8)>> =
        parallel::map(&blocks, |at| warp.values(at.rect().intersect(canvas)));
    let mut out = Plane::full(size, 0);
    values.into_iter().flatten().for_each(|(x, y, value)| out.set(x as usize, y as usize, value));
    out
}

/// The pixels of a rectangle of such a map, each with its position.
pub fn warp_block(
    plane: &Plane<u8>,
    map: &dyn PixelMap,
    filter: Resampling,
    rect: Rect,
) -> Vec<(i32, i32, u8)> {
    if let Some(by) = map.pixel_move() {
        let places = (rect.y0..rect.y1).flat_map(|y| (rect.x0..rect.x1).map(move |x| (x, y)));
        let moved = |(x, y): (i32, i32)| {
            let (sx, sy) = by.source(x, y);
            (x, y, plane.at_clamped(sx, sy))
        };
        return places.map(moved).collect();
    }
    Warp { source: &PlaneSource { plane }, map, filter }.values(rect)
}

struct Warp<'a, S> {
    source: &'a S,
    map: &'a dyn PixelMap,
    filter: Resampling,
}

/// Source pixels that are read at once for a part of a tile; parts that would need more are cut.
const MOST_READ: usize = 1 << 20;

impl<S: PixelSource> Warp<'_, S> {
    /// The alpha of every pixel of a block, as bytes.
    fn values(&self, block: Rect) -> Vec<(i32, i32, u8)> {
        let mut out = Vec::with_capacity(block.width() * block.height());
        self.block(block, &mut |x, y, row| {
            out.extend((x..).zip(row).map(|(x, value)| (x, y, quantize(value[3]))));
        });
        out
    }

    /// The pixels of a block no wider than a tile, in rows from a position on, if it shows any of
    /// the source.
    fn block(&self, block: Rect, put: &mut impl FnMut(i32, i32, &[[f32; 4]])) {
        if !block.is_empty() {
            self.block_of(block, self.source.rect_to_read(self.map.source_rect(block)), put);
        }
    }

    /// The same of a block of which it is known what of the source it shows.
    fn block_of(&self, block: Rect, wanted: Rect, put: &mut impl FnMut(i32, i32, &[[f32; 4]])) {
        if wanted.is_empty() {
            return;
        }
        let (w, h) = (block.width() as i32, block.height() as i32);
        if wanted.width() * wanted.height() > MOST_READ && (w > 1 || h > 1) {
            let (mx, my) = (block.x0 + (w + 1) / 2, block.y0 + (h + 1) / 2);
            for (x0, x1) in [(block.x0, mx), (mx, block.x1)] {
                for (y0, y1) in [(block.y0, my), (my, block.y1)] {
                    self.block(Rect::new(x0, y0, x1, y1), put);
                }
            }
            return;
        }
        let window = SourceWindow {
            rect: wanted,
            pixels: self.source.read(wanted),
            continues: self.source.has_continued_border(),
        };
        let (mut points, mut scratch) =
            (Box::<PointRow>::default(), Box::<rows::WarpScratch>::default());
        let mut out = [[0.0; 4]; TILE];
        for y in block.y0..block.y1 {
            self.map.source_row(block.x0, y, block.width(), &mut points);
            let row = &mut out[..block.width()];
            window.row(&points, self.filter, &mut scratch, row);
            put(block.x0, y, row);
        }
    }
}

#[cfg(test)]
mod tests;
