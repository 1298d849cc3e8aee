//! All blocks of a tile tested at once: the fast version of `SupportBounds::judge`.
//! Floor 2.

use super::{
    BLOCK, BlockImage, DabExtent, OperatorBounds, RadialOffset, SupportBounds, TILE_BLOCKS,
    TileBlocks,
};
use crate::math::{Vec2, vec2};
use crate::raster::{TILE, TileAt};
use crate::surface::pyramid::{BlockCover, BlockFigures, DepthSpan, Join, Pyramid, TurnSpan};

const BLOCKS: usize = TILE_BLOCKS * TILE_BLOCKS;

/// What is found of a tile's blocks.
pub struct JudgedBlocks {
    /// Those that may be touched.
    pub touched: TileBlocks,
    /// How long a pixel of each block is at most in the image plane, px; row by row.
    pub pixel: [f32; BLOCKS],
}

/// What is known of a tile's blocks: some of a block is surface, all of it is, and the ranges of
/// the maps there.
struct BlockRanges<'p, const N: usize> {
    cover: &'p [BlockFigures; 2],
    figures: &'p [BlockFigures; N],
}

impl<'p, const N: usize> BlockRanges<'p, N> {
    fn of<T: Join>(
        at: TileAt,
        cover: Option<&'p Pyramid<BlockCover>>,
        map: &'p Pyramid<T>,
    ) -> Self {
        let cover = cover.and_then(|cover| cover.tile(at)).unwrap_or(&[[0.0; BLOCKS]; 2]);
        Self { cover, figures: map.tile(at).unwrap_or(&[[0.0; BLOCKS]; N]) }
    }
}

/// The blocks of a tile that may be touched.
pub(super) fn judge_blocks(support: &SupportBounds, at: TileAt) -> JudgedBlocks {
    let corner =
        vec2((at.col * TILE as i32) as f32, (at.row * TILE as i32) as f32) + 0.5 - support.at;
    let (mut touched, mut pixel) = ([0; BLOCKS], [1.0; BLOCKS]);
    let (cover, extent) = (support.cover, support.extent);
    match &support.flow {
        // On the surface and off it alike.
        OperatorBounds::Still => still(corner, extent, &mut touched),
        OperatorBounds::Depth { pyramid, z, rate } => {
            let bend = ScaledBlocks { z: *z, rate: *rate };
            reach_of_scaled(
                BlockRanges::of(at, cover, pyramid),
                corner,
                extent,
                bend,
                &mut touched,
                &mut pixel,
            );
        }
        OperatorBounds::Turn { pyramid, turn, stretch } => {
            let bend = TurnedBlocks { turn: *turn, stretch: *stretch };
            reach_of_turned(
                BlockRanges::of(at, cover, pyramid),
                corner,
                extent,
                bend,
                &mut touched,
                &mut pixel,
            );
        }
        OperatorBounds::Unwrapped { surface, unwrapping, at: anchor } => {
            let ranges = BlockRanges::of(at, cover, unwrapping.bounds(surface));
            reach_of_unwrapped(
                ranges,
                corner,
                extent,
                LaidBlocks { at: *anchor },
                &mut touched,
                &mut pixel,
            );
        }
    }
    let there = support.on_canvas(at);
    let touched = std::array::from_fn(|row| {
        let bits =
            (0..TILE_BLOCKS).map(|col| ((touched[row * TILE_BLOCKS + col] & 1) as u8) << col);
        bits.sum::<u8>() & there[row]
    });
    JudgedBlocks { touched, pixel }
}

/// The centers of a block's first and last pixel relative to the anchor. Blocks that the canvas's
/// edge cuts count whole.
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
    fn image(
        self,
        [x0, y0, x1, y1, slope]: [f32; 5],
        block: (Vec2, Vec2),
        _: BlockImage,
    ) -> BlockImage {
        self.stretch.image(
            TurnSpan { low: vec2(x0, y0), high: vec2(x1, y1), slope },
            self.turn,
            block,
        )
    }
}

impl BlockBend<5> for LaidBlocks {
    #[inline(always)]
    fn image(
        self,
        [x0, y0, x1, y1, slope]: [f32; 5],
        _: (Vec2, Vec2),
        _: BlockImage,
    ) -> BlockImage {
        BlockImage::from_unwrapping(
            TurnSpan { low: vec2(x0, y0), high: vec2(x1, y1), slope },
            self.at,
        )
    }
}

/// For each block whether it may be touched, and how long a pixel is there.
#[inline(always)]
fn each<const N: usize>(
    ranges: BlockRanges<N>,
    corner: Vec2,
    extent: DabExtent,
    bend: impl BlockBend<N>,
    touched: &mut [u32; BLOCKS],
    pixel: &mut [f32; BLOCKS],
) {
    let [some, all] = ranges.cover;
    for i in 0..BLOCKS {
        let (low, high) = corners(corner, i);
        let flat = BlockImage::flat(low, high);
        let mut figures = [0.0; N];
        for (figure, row) in figures.iter_mut().zip(ranges.figures) {
            *figure = row[i];
        }
        let bent = bend.image(figures, (low, high), flat);
        let outside = if extent.can_hold(flat) { u32::from(all[i] < 1.0) } else { 0 };
        touched[i] = outside | if extent.can_hold(bent) { u32::from(some[i] > 0.0) } else { 0 };
        let longest = if some[i] > 0.0 { bent.pixel } else { 1.0 };
        // What is no number stays none.
        pixel[i] = if longest < 1.0 { 1.0 } else { longest };
    }
}

crate::widest! {
    fn still(corner: Vec2, extent: DabExtent, touched: &mut [u32; BLOCKS]) {
        for (i, touched) in touched.iter_mut().enumerate() {
            let (low, high) = corners(corner, i);
            *touched = u32::from(extent.can_hold(BlockImage::flat(low, high)));
        }
    }

    fn reach_of_scaled(
        ranges: BlockRanges<3>,
        corner: Vec2,
        extent: DabExtent,
        bend: ScaledBlocks,
        touched: &mut [u32; BLOCKS],
        pixel: &mut [f32; BLOCKS],
    ) {
        each(ranges, corner, extent, bend, touched, pixel);
    }

    fn reach_of_turned(
        ranges: BlockRanges<5>,
        corner: Vec2,
        extent: DabExtent,
        bend: TurnedBlocks,
        touched: &mut [u32; BLOCKS],
        pixel: &mut [f32; BLOCKS],
    ) {
        each(ranges, corner, extent, bend, touched, pixel);
    }

    fn reach_of_unwrapped(
        ranges: BlockRanges<5>,
        corner: Vec2,
        extent: DabExtent,
        bend: LaidBlocks,
        touched: &mut [u32; BLOCKS],
        pixel: &mut [f32; BLOCKS],
    ) {
        each(ranges, corner, extent, bend, touched, pixel);
    }
}
