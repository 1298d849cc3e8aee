//! Pixels seen through a map: each pixel of the canvas from the pixels that it shows, sampled once.
//! Floor 1. Maps are `math`'s; this knows them by their inverse alone.
//!
//! A map that moves whole pixels copies bytes. Elsewhere a pixel is a weighted mean of the source around the point that
//! it shows. Where the source is magnified along an axis of the pixel, the weights are a cubic's; where it is reduced,
//! they are the share of each source pixel's tent in the pixel's own piece of the source.

mod source;
mod tile_map;

use source::{GridSource, PixelSource, PlaneSource};
pub use tile_map::TileMap;

use super::tile::{TILE, Tile, TileAt, transparent_f32};
use super::{Plane, TileGrid};
use crate::math::plane_map::PixelMove;
use crate::math::srgb::quantise;
use crate::math::{Mat2, Rect, Size, Vec2, vec2};
use rayon::prelude::*;
use std::sync::Arc;

crate::named! {
    /// How magnified or turned pixels are interpolated.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum Resampling {
        /// Mitchell and Netravali's cubic, B = C = ⅓: no rings, a little soft.
        #[default]
        Smooth = "smooth",
        /// Catmull and Rom's cubic: sharp, with faint rings.
        Sharp = "sharp",
        /// The nearest pixel, for pixel art.
        Nearest = "nearest",
    }
}

/// The map that pixels are seen through.
pub trait PixelMap: Sync {
    /// The point of the source that shows at a point of the canvas, and how it moves with that point; `None` where
    /// none shows.
    fn source_of(&self, q: Vec2) -> Option<(Vec2, Mat2)>;
    /// The move of whole pixels that it is, if it is one.
    fn pixel_move(&self) -> Option<PixelMove>;
    /// A rectangle that holds all that a rectangle of the canvas shows of the source; it may be larger.
    fn source_rect(&self, canvas: Rect) -> Rect;
}

/// The tiles of a grid seen through a map, those of `wanted` alone.
pub fn warped(grid: &TileGrid, map: &dyn PixelMap, filter: Resampling, wanted: &[TileAt]) -> TileGrid {
    let tiles: Vec<Option<Arc<Tile>>> = wanted.par_iter().map(|&at| warped_tile(grid, map, filter, at)).collect();
    let mut out = TileGrid::default();
    if let Some(all) = wanted.iter().map(|at| at.rect()).reduce(Rect::union) {
        out.reserve(all);
    }
    wanted.iter().zip(tiles).for_each(|(&at, tile)| out.set(at, tile));
    out
}

/// One tile of a grid seen through a map; `None` where it is transparent.
pub fn warped_tile(grid: &TileGrid, map: &dyn PixelMap, filter: Resampling, at: TileAt) -> Option<Arc<Tile>> {
    warped_tile_within(grid, None, map, filter, at)
}

/// The same of pixels whose border goes on beyond a rectangle, if there is one.
pub fn warped_tile_within(
    grid: &TileGrid,
    border: Option<Rect>,
    map: &dyn PixelMap,
    filter: Resampling,
    at: TileAt,
) -> Option<Arc<Tile>> {
    if let Some(by) = map.pixel_move() {
        return moved_tile(grid, by, at);
    }
    let mut pixels = transparent_f32();
    let source = GridSource { grid, bounds: border.unwrap_or_else(|| grid.bounds()), continues: border.is_some() };
    Warp { source: &source, map, filter }.block(at.rect(), &mut |x, y, value| {
        let (x, y) = ((x - at.rect().x0) as usize, (y - at.rect().y0) as usize);
        // Rings of a cubic may leave what a pixel can be.
        let alpha = value[3].max(0.0).min(1.0);
        pixels[y * TILE + x] = value.map(|v| v.max(0.0).min(alpha));
    });
    Tile::quantised(&pixels).map(Arc::new)
}

fn moved_tile(grid: &TileGrid, by: PixelMove, at: TileAt) -> Option<Arc<Tile>> {
    if by == PixelMove::NONE {
        return grid.tile(at).cloned();
    }
    let rect = at.rect();
    let mut bytes = Vec::with_capacity(TILE * TILE * 4);
    for y in rect.y0..rect.y1 {
        for x in rect.x0..rect.x1 {
            let (sx, sy) = by.source(x, y);
            bytes.extend(grid.pixel(sx, sy));
        }
    }
    Tile::from_pixels(bytes).map(Arc::new)
}

/// A map of the canvas, such as a mask's coverage, seen through a map; its border continues beyond it.
pub fn warped_plane(plane: &Plane<u8>, map: &dyn PixelMap, filter: Resampling) -> Plane<u8> {
    warped_plane_onto(plane, map, filter, plane.size())
}

/// The same on a canvas of another size.
pub fn warped_plane_onto(plane: &Plane<u8>, map: &dyn PixelMap, filter: Resampling, size: Size) -> Plane<u8> {
    if let Some(by) = map.pixel_move() {
        return Plane::from_fn(size, |x, y| {
            let (x, y) = by.source(x as i32, y as i32);
            plane.clamped(x, y)
        });
    }
    let source = PlaneSource { plane };
    let warp = Warp { source: &source, map, filter };
    let canvas = size.rect();
    let blocks: Vec<TileAt> = TileAt::covering(canvas).collect();
    let values: Vec<Vec<(i32, i32, u8)>> =
        blocks.par_iter().map(|at| warp.values(at.rect().intersect(canvas))).collect();
    let mut out = Plane::filled(size, 0);
    values.into_iter().flatten().for_each(|(x, y, value)| out.set(x as usize, y as usize, value));
    out
}

/// The pixels of a rectangle of such a map, each with its place.
pub fn warped_block(plane: &Plane<u8>, map: &dyn PixelMap, filter: Resampling, rect: Rect) -> Vec<(i32, i32, u8)> {
    if let Some(by) = map.pixel_move() {
        let places = (rect.y0..rect.y1).flat_map(|y| (rect.x0..rect.x1).map(move |x| (x, y)));
        let moved = |(x, y): (i32, i32)| {
            let (sx, sy) = by.source(x, y);
            (x, y, plane.clamped(sx, sy))
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
/// Source pixels read along each axis to either side of a point.
const MOST_READ_ALONG: f32 = 24.0;
/// A pixel that would show more of the source than this along an axis shows so much, px: beyond lies the horizon.
const WIDEST_PX: f32 = 512.0;

impl<S: PixelSource> Warp<'_, S> {
    /// The alpha of every pixel of a block, as bytes.
    fn values(&self, block: Rect) -> Vec<(i32, i32, u8)> {
        let mut out = Vec::with_capacity(block.width() * block.height());
        self.block(block, &mut |x, y, value| out.push((x, y, quantise(value[3]))));
        out
    }
    /// Every pixel of a block that shows anything of the source.
    fn block(&self, block: Rect, put: &mut impl FnMut(i32, i32, [f32; 4])) {
        if block.is_empty() {
            return;
        }
        let wanted = self.source.held(self.map.source_rect(block));
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
        let window = Window { rect: wanted, pixels: self.source.read(wanted), continues: self.source.continues() };
        for y in block.y0..block.y1 {
            for x in block.x0..block.x1 {
                let q = vec2(x as f32 + 0.5, y as f32 + 0.5);
                if let Some((p, jacobian)) = self.map.source_of(q) {
                    put(x, y, window.sample(p, jacobian, self.filter));
                }
            }
        }
    }
}

/// A part of the source.
struct Window {
    rect: Rect,
    pixels: Vec<[f32; 4]>,
    continues: bool,
}

impl Window {
    /// The mean of the source about a point.
    fn sample(&self, p: Vec2, jacobian: Mat2, filter: Resampling) -> [f32; 4] {
        let (right, down) = (Axis::of(jacobian.x_axis, filter), Axis::of(jacobian.y_axis, filter));
        match filter {
            Resampling::Nearest => self.pixel(p.x.floor() as i32, p.y.floor() as i32),
            _ if !right.reduces && !down.reduces => self.cubic(p, filter),
            _ => self.reduced(p, [right, down]),
        }
    }
    fn pixel(&self, x: i32, y: i32) -> [f32; 4] {
        let Rect { x0, y0, x1, y1 } = self.rect;
        let (x, y) = if self.continues { (x.clamp(x0, x1 - 1), y.clamp(y0, y1 - 1)) } else { (x, y) };
        if !self.rect.contains(x, y) {
            return [0.0; 4];
        }
        self.pixels[(y - self.rect.y0) as usize * self.rect.width() + (x - self.rect.x0) as usize]
    }
    /// 4 × 4 pixels under a cubic along the source's axes.
    fn cubic(&self, p: Vec2, filter: Resampling) -> [f32; 4] {
        let (x, y) = (p.x - 0.5, p.y - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let weights = |t: f32| [t + 1.0, t, 1.0 - t, 2.0 - t].map(|d| cubic_weight(d, filter));
        let (wx, wy) = (weights(x - x0), weights(y - y0));
        let mut sum = [0.0; 4];
        for (j, wy) in wy.into_iter().enumerate() {
            for (i, wx) in wx.into_iter().enumerate() {
                let texel = self.pixel(x0 as i32 + i as i32 - 1, y0 as i32 + j as i32 - 1);
                (0..4).for_each(|c| sum[c] += wx * wy * texel[c]);
            }
        }
        sum
    }
    /// The pixels under a parallelogram, weighed along its two sides.
    fn reduced(&self, p: Vec2, axes: [Axis; 2]) -> [f32; 4] {
        let sides = Mat2::from_cols(axes[0].side, axes[1].side);
        let determinant = sides.determinant();
        // Two sides along one line: as a square of the longer one's length.
        let to_sides = if determinant.abs() > 1e-3 {
            sides.inverse()
        } else {
            Mat2::from_diagonal(Vec2::splat(1.0 / axes[0].side.length().max(axes[1].side.length())))
        };
        let reach = axes[0].side.abs() * axes[0].reach + axes[1].side.abs() * axes[1].reach;
        let (low, high) = ((p - reach - 0.5).ceil(), (p + reach - 0.5).floor());
        // Of a thousand pixels and more some are enough.
        let step = ((reach.max_element() / MOST_READ_ALONG) as usize).max(1);
        let (mut sum, mut total) = ([0.0; 4], 0.0);
        for y in (low.y as i32..=high.y as i32).step_by(step) {
            for x in (low.x as i32..=high.x as i32).step_by(step) {
                let t = to_sides * (vec2(x as f32 + 0.5, y as f32 + 0.5) - p);
                let weight = axes[0].weight(t.x) * axes[1].weight(t.y);
                if weight != 0.0 {
                    total += weight;
                    let texel = self.pixel(x, y);
                    (0..4).for_each(|c| sum[c] += weight * texel[c]);
                }
            }
        }
        if total > 0.0 { sum.map(|v| v / total) } else { [0.0; 4] }
    }
}

/// One side of the piece of the source that a pixel shows, and how it is weighed along it.
#[derive(Clone, Copy)]
struct Axis {
    /// Source px; at least one long.
    side: Vec2,
    reduces: bool,
    filter: Resampling,
    /// How far weights reach, in sides.
    reach: f32,
    /// Half the tent of a source pixel, in sides.
    tent: f32,
}

impl Axis {
    fn of(side: Vec2, filter: Resampling) -> Self {
        let length = side.length().min(WIDEST_PX);
        let direction = side.normalize_or(Vec2::X);
        // A side hardly longer than a pixel is one of a turned picture.
        let reduces = length > 1.0 + 1e-3;
        let (length, reach) = if reduces { (length, 0.5 + 1.0 / length) } else { (1.0, 2.0) };
        Self { side: direction * length, reduces, filter, reach, tent: 1.0 / length }
    }
    fn weight(&self, t: f32) -> f32 {
        if self.reduces { share(t, self.tent) } else { cubic_weight(t, self.filter) }
    }
}

/// The share of a tent of half-width `tent` about `t` that lies in `[−½, ½]`.
fn share(t: f32, tent: f32) -> f32 {
    let below = |edge: f32| {
        let x = ((edge - t) / tent).max(-1.0).min(1.0);
        if x < 0.0 { 0.5 * (x + 1.0) * (x + 1.0) } else { 1.0 - 0.5 * (1.0 - x) * (1.0 - x) }
    };
    below(0.5) - below(-0.5)
}

/// The weight of a pixel `d` px away.
fn cubic_weight(d: f32, filter: Resampling) -> f32 {
    let d = d.abs();
    // Mitchell and Netravali 1988: of B and C.
    let (b, c) = if filter == Resampling::Sharp { (0.0, 0.5) } else { (1.0 / 3.0, 1.0 / 3.0) };
    if d < 1.0 {
        ((12.0 - 9.0 * b - 6.0 * c) * d * d * d + (-18.0 + 12.0 * b + 6.0 * c) * d * d + (6.0 - 2.0 * b)) / 6.0
    } else if d < 2.0 {
        ((-b - 6.0 * c) * d * d * d + (6.0 * b + 30.0 * c) * d * d + (-12.0 * b - 48.0 * c) * d + (8.0 * b + 24.0 * c))
            / 6.0
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests;
