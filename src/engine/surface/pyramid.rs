//! Min–max pyramids of the maps: the range of values in each block of pixels, and how fast they
//! change there. Floor 2. `support` uses them to bound an operator.

use super::operator::reflection;
use super::{Surface, links};
use crate::math::{Rect, Size, Vec2, vec2};
use crate::raster::{Plane, TILE, TileAt};
use std::sync::OnceLock;

/// Side of the smallest blocks, px.
pub const BLOCK: usize = 8;
/// Blocks along the side of a tile.
pub const TILE_BLOCKS: usize = TILE / BLOCK;
/// The part of a tile that may be touched: bit `c` of row `r` is the block of 8 × 8 px in column
/// `c`.
pub type TileBlocks = [u8; TILE_BLOCKS];
/// The level of the pyramid whose blocks are tiles.
pub(super) const TILE_LEVEL: usize = TILE_BLOCKS.ilog2() as usize;

/// The maps' pyramids, each built when an operator first needs it.
///
/// Built by the calling thread alone: a worker that waited for others here could be given a tile
/// that waits for the same pyramid.
#[derive(Default)]
pub struct MapPyramids {
    cover: OnceLock<Pyramid<BlockCover>>,
    depth: OnceLock<Pyramid<DepthSpan>>,
    nbar: OnceLock<Pyramid<TurnSpan>>,
    mirrored: OnceLock<Pyramid<TurnSpan>>,
}

impl MapPyramids {
    /// Bytes of those that were made.
    pub(super) fn bytes(&self) -> u64 {
        let turns = [&self.nbar, &self.mirrored].map(|cell| cell.get().map_or(0, Pyramid::bytes));
        let cover = self.cover.get().map_or(0, Pyramid::bytes);
        cover + self.depth.get().map_or(0, Pyramid::bytes) + turns.iter().sum::<u64>()
    }
}

impl<T: Copy> Pyramid<T> {
    /// Bytes that it holds.
    pub fn bytes(&self) -> u64 {
        self.levels.iter().map(|level| (level.size().area() * size_of::<T>()) as u64).sum()
    }
}

/// Levels of blocks: 8 px, 16 px, … one block for all. At least up to tiles.
pub(super) struct Pyramid<T> {
    /// From the level of the tiles on.
    levels: Vec<Plane<T>>,
    /// The smallest blocks as figures, tile by tile: all 64 of a tile are judged side by side.
    tiles: Vec<BlockFigures>,
    tile_columns: usize,
}

/// One figure of each block of a tile, row by row; 0 where the map has no block.
pub(super) type BlockFigures = [f32; TILE_BLOCKS * TILE_BLOCKS];

/// Values that can be merged: those of two blocks give those of their union.
pub(super) trait Join: Copy {
    /// What it is made of.
    type Figures: AsRef<[f32]>;
    fn figures(self) -> Self::Figures;
    fn join(self, other: Self) -> Self;
}

impl<T: Join> Pyramid<T> {
    /// `leaf` is called for every block of pixels, clipped to the map.
    fn new(size: Size, mut leaf: impl FnMut(Rect) -> T) -> Self {
        let blocks = level_size(size, 0);
        let leaves = (0..blocks.height as i32)
            .flat_map(|row| (0..blocks.width as i32).map(move |col| block_rect(size, 0, col, row)))
            .map(&mut leaf)
            .collect();
        let mut levels: Vec<Plane<T>> = Plane::from_values(blocks, leaves).into_iter().collect();
        let tiles = levels.first().map(join_by_tiles).unwrap_or_default();
        while let Some(last) = levels.last()
            && (levels.len() <= TILE_LEVEL || last.size().area() > 1)
        {
            levels.push(join_level(last, level_size(size, levels.len())));
        }
        levels.drain(..TILE_LEVEL.min(levels.len()));
        Self { levels, tiles, tile_columns: level_size(size, TILE_LEVEL).width as usize }
    }

    /// The figures of a tile's smallest blocks, as many rows as a block has figures; `None` beyond
    /// the map.
    pub(super) fn tile<const N: usize>(&self, at: TileAt) -> Option<&[BlockFigures; N]> {
        let (col, row) = (usize::try_from(at.col).ok()?, usize::try_from(at.row).ok()?);
        let start = (col < self.tile_columns).then(|| (row * self.tile_columns + col) * N)?;
        self.tiles.get(start..start + N)?.try_into().ok()
    }

    /// Of a tile or a larger block.
    pub(super) fn at(&self, block: PyramidBlock) -> Option<T> {
        self.levels.get(block.level.checked_sub(TILE_LEVEL)?)?.get(block.col, block.row)
    }
}

impl Pyramid<TurnSpan> {
    /// The ranges of points that a surface's pixels are taken to.
    pub(super) fn of_points(surface: &Surface, point: impl Fn(usize, usize) -> Vec2) -> Self {
        Self::new(surface.size(), |block| turn_span(surface, block, &point))
    }
}

fn join_by_tiles<T: Join>(leaves: &Plane<T>) -> Vec<BlockFigures> {
    let across = leaves.width().div_ceil(TILE_BLOCKS);
    let figures =
        if leaves.size().area() > 0 { leaves.at(0, 0).figures().as_ref().len() } else { 0 };
    let mut tiles = vec![
        [0.0; TILE_BLOCKS * TILE_BLOCKS];
        across * leaves.height().div_ceil(TILE_BLOCKS) * figures
    ];
    for row in 0..leaves.height() {
        for col in 0..leaves.width() {
            let tile = row / TILE_BLOCKS * across + col / TILE_BLOCKS;
            let place = row % TILE_BLOCKS * TILE_BLOCKS + col % TILE_BLOCKS;
            let of_block = leaves.at(col, row).figures();
            for (figure, value) in tiles[tile * figures..].iter_mut().zip(of_block.as_ref()) {
                figure[place] = *value;
            }
        }
    }
    tiles
}

fn join_level<T: Join>(below: &Plane<T>, size: Size) -> Plane<T> {
    let mut values = Vec::with_capacity(size.area());
    for row in 0..size.height as usize {
        for col in 0..size.width as usize {
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| (2 * col + i, 2 * row + j));
            let there = four.iter().filter(|&&(i, j)| i < below.width() && j < below.height());
            values.extend(there.map(|&(i, j)| below.at(i, j)).reduce(T::join));
        }
    }
    Plane::from_values(size, values).unwrap_or_else(|| below.clone())
}

/// How many blocks a level has.
pub(super) fn level_size(size: Size, level: usize) -> Size {
    let side = (BLOCK << level) as u32;
    Size::new(size.width.div_ceil(side), size.height.div_ceil(side))
}

/// The pixels of a block, clipped to the map.
pub(super) fn block_rect(size: Size, level: usize, col: i32, row: i32) -> Rect {
    let side = (BLOCK << level) as i32;
    Rect::new(col * side, row * side, (col + 1) * side, (row + 1) * side).intersect(size.rect())
}

/// How much of a block is surface.
#[derive(Clone, Copy)]
pub(super) struct BlockCover {
    /// Some pixel is.
    pub(super) some: bool,
    /// Every pixel is.
    pub(super) all: bool,
}

impl Join for BlockCover {
    type Figures = [f32; 2];
    fn figures(self) -> [f32; 2] {
        [self.some, self.all].map(|is| if is { 1.0 } else { 0.0 })
    }

    fn join(self, o: Self) -> Self {
        Self { some: self.some || o.some, all: self.all && o.all }
    }
}

/// z over a block and the pixels around it, and the longest ∇z in it.
#[derive(Clone, Copy)]
pub(super) struct DepthSpan {
    pub(super) low: f32,
    pub(super) high: f32,
    pub(super) slope: f32,
}

impl Join for DepthSpan {
    type Figures = [f32; 3];
    fn figures(self) -> [f32; 3] {
        [self.low, self.high, self.slope]
    }

    fn join(self, o: Self) -> Self {
        Self {
            low: self.low.min(o.low),
            high: self.high.max(o.high),
            slope: self.slope.max(o.slope),
        }
    }
}

/// n̄, r̄ or a point of the unwrapped plane over a block and the pixels around it, and the largest
/// norm of its derivative in it.
#[derive(Clone, Copy)]
pub(super) struct TurnSpan {
    pub(super) low: Vec2,
    pub(super) high: Vec2,
    pub(super) slope: f32,
}

impl Join for TurnSpan {
    type Figures = [f32; 5];
    fn figures(self) -> [f32; 5] {
        [self.low.x, self.low.y, self.high.x, self.high.y, self.slope]
    }

    fn join(self, o: Self) -> Self {
        Self {
            low: self.low.min(o.low),
            high: self.high.max(o.high),
            slope: self.slope.max(o.slope),
        }
    }
}

impl DepthSpan {
    /// Of values that lie farther out than these by so much.
    pub(super) fn spread(self, by: f32) -> Self {
        Self { low: self.low - by, high: self.high + by, ..self }
    }
}

impl TurnSpan {
    /// Of values that lie farther out than these by so much.
    pub(super) fn spread(self, by: Vec2) -> Self {
        Self { low: self.low - by, high: self.high + by, ..self }
    }
}

/// A value over a block's pixels and the ring around it, which the block's differences read.
struct BlockRing {
    block: Rect,
    /// The ring and what is in it, clipped to the map.
    rect: Rect,
    values: [Vec2; RING * RING],
}

const RING: usize = BLOCK + 2;

impl BlockRing {
    fn around(surface: &Surface, block: Rect, value: impl Fn(usize, usize) -> Vec2) -> Self {
        let rect = block.grown(1).intersect(surface.size().rect());
        let mut values = [Vec2::ZERO; RING * RING];
        for y in 0..rect.height() {
            for x in 0..rect.width() {
                values[y * RING + x] = value(rect.x0 as usize + x, rect.y0 as usize + y);
            }
        }
        Self { block, rect, values }
    }

    fn at(&self, x: usize, y: usize) -> Vec2 {
        self.values[(y - self.rect.y0 as usize) * RING + x - self.rect.x0 as usize]
    }

    /// The range of the values over the surface.
    fn range(&self, surface: &Surface) -> (Vec2, Vec2) {
        let Rect { x0, y0, x1, y1 } = self.rect;
        let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for y in y0 as usize..y1 as usize {
            let covered = surface.coverage_plane().row(y);
            for x in (x0 as usize..x1 as usize).filter(|&x| covered[x] > 0) {
                (low, high) = (low.min(self.at(x, y)), high.max(self.at(x, y)));
            }
        }
        (low, high)
    }

    /// The longest derivative over the block's surface: differences between linked neighbors, per
    /// px.
    fn longest_slope(&self, surface: &Surface) -> f32 {
        let Rect { x0, y0, x1, y1 } = self.block;
        let mut longest = 0.0f32;
        for y in y0 as usize..y1 as usize {
            for x in x0 as usize..x1 as usize {
                let linked = surface.smooth_links_plane().at(x, y);
                let step = |bit: u8| usize::from(linked & bit != 0);
                let (l, r, u, d) =
                    (step(links::LEFT), step(links::RIGHT), step(links::UP), step(links::DOWN));
                let dx = (self.at(x + r, y) - self.at(x - l, y)) / (l + r).max(1) as f32;
                let dy = (self.at(x, y + d) - self.at(x, y - u)) / (u + d).max(1) as f32;
                longest = longest.max(dx.length_squared() + dy.length_squared());
            }
        }
        longest.sqrt()
    }
}

fn turn_span(surface: &Surface, block: Rect, value: impl Fn(usize, usize) -> Vec2) -> TurnSpan {
    let ring = BlockRing::around(surface, block, value);
    let (low, high) = ring.range(surface);
    TurnSpan { low, high, slope: ring.longest_slope(surface) }
}

impl MapPyramids {
    pub(super) fn cover(&self, surface: &Surface) -> &Pyramid<BlockCover> {
        self.cover.get_or_init(|| {
            Pyramid::new(surface.size(), |block| {
                let mut cover = BlockCover { some: false, all: true };
                for y in block.y0 as usize..block.y1 as usize {
                    for &c in &surface.coverage_plane().row(y)[block.x0 as usize..block.x1 as usize]
                    {
                        cover = BlockCover { some: cover.some || c > 0, all: cover.all && c > 0 };
                    }
                }
                cover
            })
        })
    }

    pub(super) fn depth(&self, surface: &Surface) -> &Pyramid<DepthSpan> {
        self.depth.get_or_init(|| {
            Pyramid::new(surface.size(), |block| {
                let TurnSpan { low, high, slope } =
                    turn_span(surface, block, |x, y| vec2(surface.depth(x, y), 0.0));
                DepthSpan { low: low.x, high: high.x, slope }
            })
        })
    }

    pub(super) fn nbar(&self, surface: &Surface) -> &Pyramid<TurnSpan> {
        self.nbar.get_or_init(|| Pyramid::of_points(surface, |x, y| surface.nbar(x, y)))
    }

    pub(super) fn reflections(&self, surface: &Surface) -> &Pyramid<TurnSpan> {
        let value = |x, y| reflection::mirrored(surface.nbar(x, y), surface.normal(x, y).z);
        self.mirrored.get_or_init(|| Pyramid::of_points(surface, value))
    }
}

/// A block of a level.
#[derive(Clone, Copy)]
pub(super) struct PyramidBlock {
    pub(super) level: usize,
    pub(super) col: i32,
    pub(super) row: i32,
}

impl PyramidBlock {
    /// The one that holds a whole map.
    pub(super) fn whole(size: Size) -> Self {
        let level =
            (TILE_LEVEL..).find(|level| level_size(size, *level).area() <= 1).unwrap_or(TILE_LEVEL);
        Self { level, col: 0, row: 0 }
    }

    /// The four blocks one level below.
    pub(super) fn quarters(self) -> [PyramidBlock; 4] {
        let PyramidBlock { level, col, row } = self;
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| PyramidBlock {
            level: level - 1,
            col: 2 * col + i,
            row: 2 * row + j,
        })
    }
}
