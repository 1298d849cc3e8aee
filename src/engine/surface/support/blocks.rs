//! All blocks of a tile tested at once: the fast version of `SupportBounds::judge`.
//! Floor 2.

use super::{BLOCK, BlockImage, DabExtent, OperatorBounds, RadialOffset, SupportBounds, TILE_BLOCKS, TileBlocks};
use crate::math::{Vec2, vec2};
use crate::raster::{Plane, TILE, TileAt};
use crate::surface::pyramid::{BlockCover, DepthSpan, TurnSpan};

const BLOCKS: usize = TILE_BLOCKS * TILE_BLOCKS;

/// The ranges of the maps in each block of a tile: one value per row of the array.
struct BlockRanges<const N: usize> {
    figures: [[f32; BLOCKS]; N],
    /// 1 where some of the block is surface; 1 where some is not.
    inside: [u32; BLOCKS],
    outside: [u32; BLOCKS],
}

impl<const N: usize> BlockRanges<N> {
    fn of<T: Copy>(
        at: TileAt,
        cover: Option<&Plane<BlockCover>>,
        map: Option<&Plane<T>>,
        figures: impl Fn(T) -> [f32; N],
    ) -> Self {
        let mut spans = Self { figures: [[0.0; BLOCKS]; N], inside: [0; BLOCKS], outside: [1; BLOCKS] };
        for i in 0..BLOCKS {
            let (col, row) = place(at, i);
            if let Some(cover) = cover.and_then(|cover| cover.get(col, row)) {
                (spans.inside[i], spans.outside[i]) = (u32::from(cover.some), u32::from(!cover.all));
            }
            if let Some(span) = map.and_then(|map| map.get(col, row)) {
                for (row, figure) in spans.figures.iter_mut().zip(figures(span)) {
                    row[i] = figure;
                }
            }
        }
        spans
    }
}

/// The column and row of a tile's `i`th block.
fn place(at: TileAt, i: usize) -> (i32, i32) {
    let side = TILE_BLOCKS as i32;
    (at.col * side + i as i32 % side, at.row * side + i as i32 / side)
}

/// The blocks of a tile that may be touched.
pub(super) fn judged(support: &SupportBounds, at: TileAt) -> TileBlocks {
    let corner = vec2((at.col * TILE as i32) as f32, (at.row * TILE as i32) as f32) + 0.5 - support.at;
    let cover = support.cover.and_then(|cover| cover.leaves());
    let mut touched = [0; BLOCKS];
    match &support.flow {
        // On the surface and off it alike.
        OperatorBounds::Still => still(corner, support.extent, &mut touched),
        OperatorBounds::Depth { pyramid, z, rate } => {
            let figures = |span: DepthSpan| [span.low, span.high, span.slope];
            let spans = BlockRanges::of(at, cover, pyramid.leaves(), figures);
            scaled(&spans, corner, support.extent, ScaledBlocks { z: *z, rate: *rate }, &mut touched);
        }
        OperatorBounds::Turn { pyramid, turn, stretch } => {
            let figures = |span: TurnSpan| [span.low.x, span.low.y, span.high.x, span.high.y, span.slope];
            let spans = BlockRanges::of(at, cover, pyramid.leaves(), figures);
            turned(&spans, corner, support.extent, TurnedBlocks { turn: *turn, stretch: *stretch }, &mut touched);
        }
        OperatorBounds::Unwrapped { surface, unwrapping, at: anchor } => {
            let leaves = unwrapping.bounds(surface).leaves();
            let figures = |span: TurnSpan| [span.low.x, span.low.y, span.high.x, span.high.y, span.slope];
            let spans = BlockRanges::of(at, cover, leaves, figures);
            laid(&spans, corner, support.extent, LaidBlocks { at: *anchor }, &mut touched);
        }
    }
    let there = support.on_canvas(at);
    std::array::from_fn(|row| {
        let bits = (0..TILE_BLOCKS).map(|col| ((touched[row * TILE_BLOCKS + col] & 1) as u8) << col);
        bits.sum::<u8>() & there[row]
    })
}

/// The centres of a block's first and last pixel relative to the anchor. Blocks that the canvas's edge cuts count
/// whole.
#[inline(always)]
fn corners(corner: Vec2, i: usize) -> (Vec2, Vec2) {
    // Through i32: AVX2 converts no 64-bit integers.
    let (i, side) = (i as i32, TILE_BLOCKS as i32);
    let low = corner + BLOCK as f32 * vec2((i % side) as f32, (i / side) as f32);
    (low, low + (BLOCK - 1) as f32)
}

/// What an operator makes of a block.
trait BlockBend<const N: usize>: Copy {
    /// Of the part of a block that is surface; `figures` are its [`BlockRanges`].
    fn image(self, figures: [f32; N], block: (Vec2, Vec2), flat: BlockImage) -> BlockImage;
}

#[derive(Clone, Copy)]
struct ScaledBlocks {
    z: f32,
    rate: f32,
}
#[derive(Clone, Copy)]
struct TurnedBlocks {
    turn: Vec2,
    stretch: RadialOffset,
}

#[derive(Clone, Copy)]
struct LaidBlocks {
    at: Vec2,
}

impl BlockBend<3> for ScaledBlocks {
    #[inline(always)]
    fn image(self, [low, high, slope]: [f32; 3], _: (Vec2, Vec2), flat: BlockImage) -> BlockImage {
        flat.scaled(DepthSpan { low, high, slope }, self.z, self.rate)
    }
}
impl BlockBend<5> for TurnedBlocks {
    #[inline(always)]
    fn image(self, [x0, y0, x1, y1, slope]: [f32; 5], block: (Vec2, Vec2), _: BlockImage) -> BlockImage {
        self.stretch.image(TurnSpan { low: vec2(x0, y0), high: vec2(x1, y1), slope }, self.turn, block)
    }
}

impl BlockBend<5> for LaidBlocks {
    #[inline(always)]
    fn image(self, [x0, y0, x1, y1, slope]: [f32; 5], _: (Vec2, Vec2), _: BlockImage) -> BlockImage {
        BlockImage::laid(TurnSpan { low: vec2(x0, y0), high: vec2(x1, y1), slope }, self.at)
    }
}

/// For each block whether it may be touched.
#[inline(always)]
fn each<const N: usize>(
    spans: &BlockRanges<N>,
    corner: Vec2,
    extent: DabExtent,
    bend: impl BlockBend<N>,
    touched: &mut [u32],
) {
    let n = touched.len().min(BLOCKS);
    let (inside, outside, touched) = (&spans.inside[..n], &spans.outside[..n], &mut touched[..n]);
    for i in 0..n {
        let (low, high) = corners(corner, i);
        let flat = BlockImage::flat(low, high);
        let mut figures = [0.0; N];
        for (figure, row) in figures.iter_mut().zip(&spans.figures) {
            *figure = row[i];
        }
        let bent = bend.image(figures, (low, high), flat);
        let outside = if extent.may_hold(flat) { outside[i] } else { 0 };
        touched[i] = outside | if extent.may_hold(bent) { inside[i] } else { 0 };
    }
}

crate::widest! {
    fn still(corner: Vec2, extent: DabExtent, touched: &mut [u32]) {
        for (i, touched) in touched.iter_mut().enumerate() {
            let (low, high) = corners(corner, i);
            *touched = u32::from(extent.may_hold(BlockImage::flat(low, high)));
        }
    }
    fn scaled(spans: &BlockRanges<3>, corner: Vec2, extent: DabExtent, bend: ScaledBlocks, touched: &mut [u32]) {
        each(spans, corner, extent, bend, touched);
    }
    fn turned(spans: &BlockRanges<5>, corner: Vec2, extent: DabExtent, bend: TurnedBlocks, touched: &mut [u32]) {
        each(spans, corner, extent, bend, touched);
    }
    fn laid(spans: &BlockRanges<5>, corner: Vec2, extent: DabExtent, bend: LaidBlocks, touched: &mut [u32]) {
        each(spans, corner, extent, bend, touched);
    }
}
