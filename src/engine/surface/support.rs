//! Support bounds: the blocks of the canvas that a dab may touch. Interval arithmetic on D_p, D_n, D_r and D_s over the
//! maps' pyramids finds them without reading pixels. Floor 2. `blocks` tests all blocks of a tile at once. The bounds
//! are conservative: `deformation` decides about pixels.

mod blocks;

use super::operator::{Operator, first_order, reflection, second_order};
pub use super::pyramid::{BLOCK, TILE_BLOCKS, TileBlocks};
use super::pyramid::{BlockCover, DepthSpan, Pyramid, PyramidBlock, TILE_LEVEL, TurnSpan, block_rect, level_size};
use super::unwrap::Unwrapping;
use super::{DabReach, Surface};
use crate::math::{Rect, Size, Vec2, vec2};
use crate::raster::TileAt;
use std::sync::Arc;

/// Tolerance added to every distance, px, because D is computed in f32.
const ROUNDING_PX: f32 = 0.05;

/// How far around its anchor a footprint reaches, in the image plane.
#[derive(Clone, Copy, Debug)]
pub struct DabExtent {
    /// Of the footprint itself, px.
    pub radius_px: f32,
    /// What the filter adds: this many pixels, each as long as D makes it there.
    pub filter_px: f32,
}

impl DabExtent {
    /// Written so that NaN counts as inside: only a proof may exclude a block.
    #[inline(always)]
    #[expect(clippy::neg_cmp_op_on_partial_ord, reason = "NaN is not beyond")]
    fn may_hold(self, image: BlockImage) -> bool {
        let limit = self.radius_px + self.filter_px * image.pixel + ROUNDING_PX;
        !(image.near > limit + 1e-5 * image.near)
    }
}

/// The blocks in which one anchored operator brings the image plane within an extent of the anchor.
///
/// Conservative: no block is left out that holds a pixel q with |D(q) − q_0| within the extent.
pub struct SupportBounds<'s> {
    size: Size,
    at: Vec2,
    extent: DabExtent,
    cover: Option<&'s Pyramid<BlockCover>>,
    flow: OperatorBounds<'s>,
    /// Nothing lands farther from the anchor than this; infinite where anything may.
    border_px: f32,
}

/// The operator on the surface, its maps read at the anchor.
enum OperatorBounds<'s> {
    Still,
    /// `rate`: e^γ − 1.
    Depth {
        pyramid: &'s Pyramid<DepthSpan>,
        z: f32,
        rate: f32,
    },
    Turn {
        pyramid: &'s Pyramid<TurnSpan>,
        turn: Vec2,
        stretch: RadialOffset,
    },
    /// The surface unwrapped, and where the anchor lies in its plane.
    Unwrapped {
        surface: &'s Surface,
        unwrapping: Arc<Unwrapping>,
        at: Vec2,
    },
}

/// The offset of D_n or D_r as a function of the relative normal, canvas px: an odd radial map.
#[derive(Clone, Copy)]
struct RadialOffset {
    /// α L.
    alpha_px: f32,
    /// e^−β; `None` is linear: D_r.
    softness: Option<f32>,
    /// μ: curvature multiplies the offset by something in [1 − μ, 1 + μ].
    detail: f32,
}

impl RadialOffset {
    /// Factor of a relative normal of length u, without detail.
    #[inline(always)]
    fn factor(self, u: f32) -> f32 {
        let curved = |softness| second_order::offset_factor_of_softness(u, self.alpha_px, softness);
        self.softness.map_or(self.alpha_px, curved)
    }
    /// The range of one component of the offset, exact but for the detail: it grows with the component itself and, in
    /// magnitude, with the other one, which `across` bounds in magnitude.
    #[inline(always)]
    fn range(self, (low, high): (f32, f32), across: (f32, f32)) -> (f32, f32) {
        let offset = |v: f32, across: f32| self.factor(vec2(v, across).length()) * v;
        let (a, b) = if self.alpha_px >= 0.0 { (low, high) } else { (high, low) };
        // `a` gives the least offset (a negative one is largest farther out), `b` the greatest.
        let sign = self.alpha_px.signum();
        let least = offset(a, if sign * a < 0.0 { across.1 } else { across.0 });
        let most = offset(b, if sign * b > 0.0 { across.1 } else { across.0 });
        let (d, e) = (1.0 - self.detail, 1.0 + self.detail);
        ((least * d).min(least * e), (most * d).max(most * e))
    }
    /// The most by which the offset changes per change of the normal, up to a relative normal of length u; and, with
    /// detail, per px by the change of curvature alone.
    #[inline(always)]
    fn steepness(self, u: f32) -> (f32, f32) {
        let curved = |softness| second_order::offset_factor_slope_of_softness(u, self.alpha_px, softness);
        let slope = self.softness.map_or(0.0, curved);
        let factor = self.factor(u).abs();
        // κ lies in (−1, 1): a difference to one neighbour is below 2 in each direction.
        let by_curvature = factor * u * self.detail.abs() * 2.0 * std::f32::consts::SQRT_2;
        ((factor + u * slope.abs()) * (1.0 + self.detail.abs()), by_curvature)
    }
}

impl<'s> SupportBounds<'s> {
    /// `at` is q_0; `surface`, where there is one, has the canvas's size.
    pub fn new(surface: Option<&'s Surface>, size: Size, operator: Operator, at: Vec2, extent: DabExtent) -> Self {
        let operator = operator.finite();
        let flow = surface
            .filter(|_| !operator.is_identity())
            .map_or(OperatorBounds::Still, |s| OperatorBounds::new(s, operator, at));
        let cover = surface.map(|s| s.bounds().cover(s));
        Self { size, at, extent, cover, flow, border_px: f32::INFINITY }
    }
    /// The same, of a mark that stays within a reach.
    pub fn within(self, reach: Option<DabReach>) -> Self {
        Self { border_px: reach.map_or(f32::INFINITY, |reach| reach.border_px()), ..self }
    }
    /// Visits every tile of the canvas that may be touched.
    pub fn for_each_tile(&self, mut visit: impl FnMut(TileAt)) {
        if let (OperatorBounds::Still, Some(rect)) = (&self.flow, self.flat_rect()) {
            // Without a surface's say the tiles about the anchor are all there can be.
            let is_touched = |at: &TileAt| {
                self.judge(PyramidBlock { level: TILE_LEVEL, col: at.col, row: at.row }) != BlockOverlap::Nowhere
            };
            return TileAt::covering(rect).filter(is_touched).for_each(visit);
        }
        let mut level = TILE_LEVEL;
        while level_size(self.size, level).area() > 1 {
            level += 1;
        }
        self.descend(PyramidBlock { level, col: 0, row: 0 }, TILE_LEVEL, &mut |b| visit(TileAt::new(b.col, b.row)));
    }
    /// The blocks of a tile that may be touched.
    pub fn blocks(&self, at: TileAt) -> TileBlocks {
        match self.judge(PyramidBlock { level: TILE_LEVEL, col: at.col, row: at.row }) {
            BlockOverlap::Nowhere => TileBlocks::default(),
            BlockOverlap::Everywhere => self.on_canvas(at),
            BlockOverlap::Perhaps => blocks::judged(self, at),
        }
    }
    /// A rectangle of the canvas that holds all that an extent may reach where D is the identity; `None` where it is
    /// not told by numbers.
    fn flat_rect(&self) -> Option<Rect> {
        // A little more than `DabExtent::may_hold` allows for.
        let reach = 1.001 * (self.extent.radius_px + self.extent.filter_px + ROUNDING_PX) + 1.0;
        let is_told = self.at.is_finite() && self.at.abs().max_element() < 1e7 && (0.0..1e7).contains(&reach);
        is_told.then(|| {
            let (low, high) = (self.at - reach, self.at + reach);
            let rect = Rect::new(low.x as i32 - 1, low.y as i32 - 1, high.x as i32 + 1, high.y as i32 + 1);
            rect.intersect(self.size.rect())
        })
    }
    /// The blocks of a tile that hold pixels.
    fn on_canvas(&self, at: TileAt) -> TileBlocks {
        let all = level_size(self.size, 0);
        let there = |first: i32, all: u32| (all as i32 - first * TILE_BLOCKS as i32).clamp(0, TILE_BLOCKS as i32);
        let (columns, rows) = (there(at.col, all.width), there(at.row, all.height) as usize);
        std::array::from_fn(|row| if row < rows { ((1u16 << columns) - 1) as u8 } else { 0 })
    }
    fn descend(&self, block: PyramidBlock, to: usize, visit: &mut impl FnMut(PyramidBlock)) {
        match self.judge(block) {
            BlockOverlap::Nowhere => {}
            BlockOverlap::Perhaps if block.level > to => {
                block.quarters().into_iter().for_each(|b| self.descend(b, to, visit));
            }
            _ => self.visit_all(block, to, visit),
        }
    }
    fn visit_all(&self, block: PyramidBlock, to: usize, visit: &mut impl FnMut(PyramidBlock)) {
        if block_rect(self.size, block.level, block.col, block.row).is_empty() {
            return;
        }
        if block.level == to {
            return visit(block);
        }
        block.quarters().into_iter().for_each(|b| self.visit_all(b, to, visit));
    }
    fn judge(&self, block: PyramidBlock) -> BlockOverlap {
        let rect = block_rect(self.size, block.level, block.col, block.row);
        if rect.is_empty() {
            return BlockOverlap::Nowhere;
        }
        let low = vec2(rect.x0 as f32, rect.y0 as f32) + 0.5 - self.at;
        let high = vec2(rect.x1 as f32, rect.y1 as f32) - 0.5 - self.at;
        let flat = BlockImage::flat(low, high);
        if flat.near > self.border_px {
            return BlockOverlap::Nowhere;
        }
        if let OperatorBounds::Still = self.flow {
            // On the surface and off it alike.
            return self.touch(flat);
        }
        let cover = self.cover.and_then(|c| c.at(block)).unwrap_or(BlockCover { some: false, all: false });
        let outside = if cover.all { None } else { Some(flat) };
        let inside = if cover.some { Some(self.flow.image(block, (low, high), flat)) } else { None };
        let parts = [outside, inside].into_iter().flatten().map(|image| self.touch(image));
        parts.reduce(|a, b| if a == b { a } else { BlockOverlap::Perhaps }).unwrap_or(BlockOverlap::Nowhere)
    }
    fn touch(&self, image: BlockImage) -> BlockOverlap {
        if !self.extent.may_hold(image) {
            BlockOverlap::Nowhere
        } else if image.far < self.extent.radius_px {
            BlockOverlap::Everywhere
        } else {
            BlockOverlap::Perhaps
        }
    }
}

/// Where a block's pixels may lie within the extent.
#[derive(Clone, Copy, PartialEq)]
enum BlockOverlap {
    Nowhere,
    Perhaps,
    Everywhere,
}

/// The image of a block under D: its distances from the anchor and the greatest length of a pixel, px.
#[derive(Clone, Copy)]
struct BlockImage {
    near: f32,
    far: f32,
    pixel: f32,
}

impl OperatorBounds<'_> {
    /// The image of the surface's part of a block whose pixels lie between two corners relative to the anchor.
    fn image(&self, block: PyramidBlock, (low, high): (Vec2, Vec2), flat: BlockImage) -> BlockImage {
        const ANYWHERE: BlockImage = BlockImage { near: 0.0, far: f32::INFINITY, pixel: f32::INFINITY };
        match self {
            OperatorBounds::Still => flat,
            OperatorBounds::Depth { pyramid, z, rate } => {
                pyramid.at(block).map_or(ANYWHERE, |span| flat.scaled(span, *z, *rate))
            }
            OperatorBounds::Turn { pyramid, turn, stretch } => {
                pyramid.at(block).map_or(ANYWHERE, |span| stretch.image(span, *turn, (low, high)))
            }
            OperatorBounds::Unwrapped { surface, unwrapping, at } => {
                unwrapping.bounds(surface).at(block).map_or(ANYWHERE, |span| BlockImage::laid(span, *at))
            }
        }
    }
}

impl BlockImage {
    /// Where D is the identity: pixels between two corners relative to the anchor.
    #[inline(always)]
    fn flat(low: Vec2, high: Vec2) -> Self {
        Self { near: distance_to_box(low, high), far: low.abs().max(high.abs()).length(), pixel: 1.0 }
    }
    /// What D_s makes of a block whose points of the unwrapped plane span so much: it turns them about the anchor's.
    #[inline(always)]
    fn laid(span: TurnSpan, at: Vec2) -> Self {
        Self { pixel: span.slope, ..Self::flat(span.low - at, span.high - at) }
    }
    /// What D_p makes of a flat block whose depths span so much, the anchor's being `z`.
    #[inline(always)]
    fn scaled(self, span: DepthSpan, z: f32, rate: f32) -> Self {
        let scale = |u| 1.0 + first_order::scale_factor_of_rate(u, rate);
        let (nearest, farthest) = (span.low - z, span.high - z);
        // One px more: the differences' neighbours.
        let steepest = first_order::scale_factor_slope_of_rate(farthest, rate) * span.slope;
        let pixel = scale(farthest) + (self.far + 1.0) * steepest;
        Self { near: scale(nearest) * self.near, far: scale(farthest) * self.far, pixel }
    }
}

impl RadialOffset {
    /// What D_n or D_r makes of a block between two corners whose n̄ or r̄ spans so much, the anchor's being `turn`.
    #[inline(always)]
    fn image(self, span: TurnSpan, turn: Vec2, (low, high): (Vec2, Vec2)) -> BlockImage {
        let (a, b) = (span.low - turn, span.high - turn);
        let across_x = (interval_distance(a.x, b.x), a.x.abs().max(b.x.abs()));
        let across_y = (interval_distance(a.y, b.y), a.y.abs().max(b.y.abs()));
        let (x0, x1) = self.range((a.x, b.x), across_y);
        let (y0, y1) = self.range((a.y, b.y), across_x);
        let (low, high) = (low + vec2(x0, y0), high + vec2(x1, y1));
        let (steepness, by_curvature) = self.steepness(vec2(across_x.1, across_y.1).length());
        let pixel = 1.0 + steepness * span.slope + by_curvature;
        BlockImage { pixel, ..BlockImage::flat(low, high) }
    }
}

impl<'s> OperatorBounds<'s> {
    fn new(surface: &'s Surface, operator: Operator, at: Vec2) -> Self {
        let (x, y) = surface.pixel_of(at);
        let (nbar, nz) = (surface.nbar(x, y), surface.normal(x, y).z);
        let unit_px = surface.size().longer_side();
        match operator {
            Operator::None => OperatorBounds::Still,
            Operator::Depth { gamma } => OperatorBounds::Depth {
                pyramid: surface.bounds().depth(surface),
                z: surface.depth(x, y),
                rate: first_order::rate(gamma),
            },
            Operator::Normal { alpha, beta, detail } => {
                let stretch =
                    RadialOffset { alpha_px: alpha * unit_px, softness: Some(second_order::softness(beta)), detail };
                OperatorBounds::Turn { pyramid: surface.bounds().nbar(surface), turn: nbar, stretch }
            }
            Operator::Reflection { alpha, detail } => {
                let stretch = RadialOffset { alpha_px: alpha * unit_px, softness: None, detail };
                let turn = reflection::mirrored(nbar, nz);
                OperatorBounds::Turn { pyramid: surface.bounds().mirrored(surface), turn, stretch }
            }
            Operator::Surface { .. } => match operator.unwrapping() {
                Some(settings) => {
                    let unwrapping = surface.unwrapped(settings);
                    let at = unwrapping.place(surface, at).at;
                    OperatorBounds::Unwrapped { surface, unwrapping, at }
                }
                None => OperatorBounds::Still,
            },
        }
    }
}

/// From 0 to the nearest value of an interval.
#[inline(always)]
fn interval_distance(low: f32, high: f32) -> f32 {
    low.max(-high).max(0.0)
}

/// From the origin to the nearest point of a box.
#[inline(always)]
fn distance_to_box(low: Vec2, high: Vec2) -> f32 {
    vec2(interval_distance(low.x, high.x), interval_distance(low.y, high.y)).length()
}

#[cfg(test)]
mod tests;
