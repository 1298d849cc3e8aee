//! Support bounds: the blocks of the canvas that a dab may touch. Interval arithmetic on D_p, D_n,
//! D_r and D_s over the maps' pyramids finds them without reading pixels. Floor 2. `images` is what
//! operators make of a block, `blocks` tests all blocks of a tile at once, `runs` many dabs. The
//! bounds are conservative: `deformation` decides about pixels.

mod blocks;
mod images;
mod runs;

pub use super::pyramid::{BLOCK, TILE_BLOCKS, TileBlocks};
pub use blocks::JudgedBlocks;
pub use runs::for_each_tile_of;

use super::operator::Operator;
use super::pyramid::{BlockCover, Pyramid, PyramidBlock, TILE_LEVEL, block_rect, level_size};
use super::{DabReach, Surface};
use crate::math::{Rect, Size, Vec2, vec2};
use crate::raster::TileAt;
use images::{BlockImage, OperatorBounds, RadialOffset};

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
    fn can_hold(self, image: BlockImage) -> bool {
        let limit = self.radius_px + self.filter_px * image.pixel + ROUNDING_PX;
        !(image.near > limit + 1e-5 * image.near)
    }
}

/// Whether an anchor lies so far beyond the canvas that its mark touches nothing, whatever the
/// surface is like. Off the surface the plane of an unwrapping goes on flat, so no pixel is nearer
/// to the anchor there than the canvas is, less what the plane extends. Other operators are quick
/// to judge.
///
/// Conservative, as [`SupportBounds`] is.
pub fn is_out_of_reach(surface: &Surface, operator: Operator, at: Vec2, extent: DabExtent) -> bool {
    let Some(settings) = operator.finite().unwrapping() else { return false };
    let canvas = vec2(surface.size().width as f32, surface.size().height as f32);
    let away = at.distance(at.max(Vec2::ZERO).min(canvas));
    if away <= canvas.max_element() {
        return false;
    }
    let unwrapping = surface.unwrapping(settings);
    let span = unwrapping.bounds(surface).at(PyramidBlock::whole(surface.size()));
    span.is_some_and(|span| {
        // Rounded where they are computed, the anchor's place most of all.
        let near = 0.999 * away - (span.high - span.low).length() - 1.0;
        near > extent.radius_px + extent.filter_px * span.slope.max(1.0) + ROUNDING_PX
    })
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
    /// For a run of dabs (`runs`): the greatest distance of their anchors from `at`, in each
    /// direction.
    spread: Vec2,
    /// And of the map's values there from the one that `flow` holds.
    turned: Vec2,
}

impl<'s> SupportBounds<'s> {
    /// `at` is q_0; `surface`, where there is one, has the canvas's size.
    pub fn new(
        surface: Option<&'s Surface>,
        size: Size,
        operator: Operator,
        at: Vec2,
        extent: DabExtent,
    ) -> Self {
        let operator = operator.finite();
        let flow = surface
            .filter(|_| !operator.is_identity())
            .map_or(OperatorBounds::Still, |s| OperatorBounds::new(s, operator, at));
        let cover = surface.map(|s| s.bounds().cover(s));
        Self {
            size,
            at,
            extent,
            cover,
            flow,
            border_px: f32::INFINITY,
            spread: Vec2::ZERO,
            turned: Vec2::ZERO,
        }
    }

    /// Of a mark that touches nothing: it lies beyond the canvas, farther than its operator brings
    /// it.
    pub fn nowhere(size: Size, at: Vec2, extent: DabExtent) -> Self {
        Self { border_px: 0.0, ..Self::new(None, size, Operator::None, at, extent) }
    }

    /// The same, of a mark that stays within a reach.
    pub fn within(self, reach: Option<DabReach>) -> Self {
        Self { border_px: reach.map_or(f32::INFINITY, |reach| reach.border_px()), ..self }
    }

    /// Visits every tile of the canvas that may be touched.
    pub fn for_each_tile(&self, mut visit: impl FnMut(TileAt)) {
        if let (OperatorBounds::Still, Some(rect)) = (&self.flow, self.flat_rect()) {
            // An operator that moves nothing touches only tiles about the anchor.
            let is_touched = |at: &TileAt| {
                self.judge(PyramidBlock { level: TILE_LEVEL, col: at.col, row: at.row })
                    != BlockOverlap::Nowhere
            };
            return TileAt::covering(rect).filter(is_touched).for_each(visit);
        }
        self.descend(PyramidBlock::whole(self.size), TILE_LEVEL, &mut |b| {
            visit(TileAt::new(b.col, b.row))
        });
    }

    /// The blocks of a tile that may be touched.
    pub fn blocks(&self, at: TileAt) -> TileBlocks {
        self.judge_blocks(at).map_or(TileBlocks::default(), |judged| judged.touched)
    }

    /// The same, and how long pixels are there; `None` where nothing may be touched.
    pub fn judge_blocks(&self, at: TileAt) -> Option<JudgedBlocks> {
        match self.judge(PyramidBlock { level: TILE_LEVEL, col: at.col, row: at.row }) {
            BlockOverlap::Nowhere => None,
            BlockOverlap::Everywhere => {
                Some(JudgedBlocks { touched: self.on_canvas(at), ..blocks::judge_blocks(self, at) })
            }
            BlockOverlap::Perhaps => Some(blocks::judge_blocks(self, at)),
        }
    }

    /// A rectangle of the canvas that holds all that an extent may reach where D is the identity;
    /// `None` where its numbers are not finite or too large.
    fn flat_rect(&self) -> Option<Rect> {
        // A little more than `DabExtent::can_hold` allows for.
        let reach = 1.001 * (self.extent.radius_px + self.extent.filter_px + ROUNDING_PX) + 1.0;
        let is_finite =
            self.at.is_finite() && self.at.abs().max_element() < 1e7 && (0.0..1e7).contains(&reach);
        is_finite.then(|| {
            let (low, high) = (self.at - reach, self.at + reach);
            let rect =
                Rect::new(low.x as i32 - 1, low.y as i32 - 1, high.x as i32 + 1, high.y as i32 + 1);
            rect.intersect(self.size.rect())
        })
    }

    /// The blocks of a tile that hold pixels.
    fn on_canvas(&self, at: TileAt) -> TileBlocks {
        let all = level_size(self.size, 0);
        let there = |first: i32, all: u32| {
            (all as i32 - first * TILE_BLOCKS as i32).clamp(0, TILE_BLOCKS as i32)
        };
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
        let low = vec2(rect.x0 as f32, rect.y0 as f32) + 0.5 - self.at - self.spread;
        let high = vec2(rect.x1 as f32, rect.y1 as f32) - 0.5 - self.at + self.spread;
        let flat = BlockImage::flat(low, high);
        if flat.near > self.border_px {
            return BlockOverlap::Nowhere;
        }
        if let OperatorBounds::Still = self.flow {
            // On the surface and off it alike.
            return self.touch(flat);
        }
        let cover =
            self.cover.and_then(|c| c.at(block)).unwrap_or(BlockCover { some: false, all: false });
        let outside = if cover.all { None } else { Some(flat) };
        let inside = if cover.some {
            Some(self.flow.image(block, (low, high), flat, self.turned))
        } else {
            None
        };
        let parts = [outside, inside].into_iter().flatten().map(|image| self.touch(image));
        parts
            .reduce(|a, b| if a == b { a } else { BlockOverlap::Perhaps })
            .unwrap_or(BlockOverlap::Nowhere)
    }

    fn touch(&self, image: BlockImage) -> BlockOverlap {
        if !self.extent.can_hold(image) {
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

#[cfg(test)]
mod tests;
