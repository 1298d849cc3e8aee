//! The outline of coverage: the sides of pixels between those covered by half or more and the
//! others, tile by tile, so that it can be cached. Floor 1. Not here: how it is drawn (`window`).

use super::CoverageGrid;
use crate::raster::bits::{TileBits, bits_of};
use crate::raster::{TILE, TileAt};
use std::sync::Arc;

/// A straight piece of the outline along sides of pixels, canvas px.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// Its upper or left end.
    pub x: i32,
    /// The row of its first corner.
    pub y: i32,
    /// How many pixels long it is.
    pub length: i32,
    /// It runs down; else to the right.
    pub is_vertical: bool,
}

/// The coarsest level: a tile is one block.
pub const COARSEST: u32 = TILE.trailing_zeros();

/// What the outline in one tile depends on: the tile, and those left of it and above it.
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct RunsKey {
    at: TileAt,
    level: u32,
    tiles: [usize; 3],
}

impl RunsKey {
    /// Whether its outline belongs to this grid, too.
    pub fn is_of(&self, grid: &CoverageGrid) -> bool {
        *self == key(grid, self.at, self.level)
    }
}

/// The tiles in which a grid may have an outline: each holds the sides left of and above its
/// pixels.
pub fn tiles(grid: &CoverageGrid) -> impl Iterator<Item = TileAt> {
    let bounds = grid.bounds();
    let reach = if bounds.is_empty() {
        bounds
    } else {
        crate::math::Rect { x1: bounds.x1 + 1, y1: bounds.y1 + 1, ..bounds }
    };
    TileAt::covering(reach)
}

/// Outlines with the same key are the same as long as their grids live.
pub fn key(grid: &CoverageGrid, at: TileAt, level: u32) -> RunsKey {
    let address = |at: TileAt| grid.tile(at).map_or(0, |tile| Arc::as_ptr(tile) as usize);
    RunsKey { at, level, tiles: [at, tile_at_left(at), tile_above(at)].map(address) }
}

/// The outline left of and above the pixels of a tile.
///
/// * `level`: blocks of 2^level pixels a side, at most [`COARSEST`], count as covered if one of
///   their pixels is.
pub fn runs(grid: &CoverageGrid, at: TileAt, level: u32) -> Vec<Run> {
    let level = level.min(COARSEST);
    let n = TILE >> level;
    let here = bits(grid, at, level, 0);
    // The last row of blocks of the tile above, and the last column of the tile on the left.
    let above_here = bits(grid, tile_above(at), level, n - 1)[n - 1];
    let left = last_column(grid, tile_at_left(at), level);
    let mut vertical = [0u64; TILE];
    let mut out = Vec::new();
    let (corner, step) = (at.rect(), 1 << level);
    let mut add = |x: usize, y: usize, length: usize, is_vertical: bool| {
        let (x, y) = (corner.x0 + x as i32 * step, corner.y0 + y as i32 * step);
        out.push(Run { x, y, length: length as i32 * step, is_vertical });
    };
    for y in 0..n {
        let before = if y > 0 { here[y - 1] } else { above_here };
        stretches(here[y] ^ before, |x, length| add(x, y, length, false));
        let beside = here[y] << 1 | left >> y & 1;
        let mut rest = (here[y] ^ beside) & mask(n);
        while rest != 0 {
            vertical[rest.trailing_zeros() as usize] |= 1 << y;
            rest &= rest - 1;
        }
    }
    for (x, column) in vertical.iter().enumerate().take(n) {
        stretches(*column, |y, length| add(x, y, length, true));
    }
    out
}

fn tile_at_left(at: TileAt) -> TileAt {
    TileAt::new(at.col - 1, at.row)
}

fn tile_above(at: TileAt) -> TileAt {
    TileAt::new(at.col, at.row - 1)
}

fn mask(n: usize) -> u64 {
    if n >= 64 { u64::MAX } else { (1 << n) - 1 }
}

/// The covered blocks of a tile, one number per row, from a row of blocks on.
fn bits(grid: &CoverageGrid, at: TileAt, level: u32, from: usize) -> TileBits {
    let mut out = [0; TILE];
    let n = TILE >> level;
    match grid.tile(at) {
        None => {}
        Some(tile) if tile.is_whole() => out[from..n].fill(mask(n)),
        Some(tile) => {
            for (y, row) in
                tile.bytes().as_chunks::<TILE>().0.iter().enumerate().skip(from << level)
            {
                out[y >> level] |= row_bits(row);
            }
            out[from..n].iter_mut().for_each(|row| *row = in_blocks(*row, level));
        }
    }
    out
}

/// The last column of blocks of a tile, one bit per row.
fn last_column(grid: &CoverageGrid, at: TileAt, level: u32) -> u64 {
    let Some(tile) = grid.tile(at) else { return 0 };
    if tile.is_whole() {
        return mask(TILE >> level);
    }
    let block = TILE - (1 << level);
    let rows = tile.bytes().as_chunks::<TILE>().0.iter().enumerate();
    rows.fold(0, |bits, (y, row)| {
        bits | u64::from(row[block..].iter().any(|&c| c >= 128)) << (y >> level)
    })
}

/// A bit for every block of a row of pixels in which one is set.
fn in_blocks(row: u64, level: u32) -> u64 {
    if level == 0 {
        return row;
    }
    let block = mask(1 << level);
    (0..TILE >> level).fold(0, |bits, x| bits | u64::from(row >> (x << level) & block != 0) << x)
}

/// A bit for every pixel that is covered by half or more.
fn row_bits(row: &[u8; TILE]) -> u64 {
    bits_of(&row.map(|c| c >> 7))
}

/// The first bit and the length of every stretch of set bits.
fn stretches(mut bits: u64, mut each: impl FnMut(usize, usize)) {
    let mut passed = 0;
    while bits != 0 {
        let zeros = bits.trailing_zeros();
        bits >>= zeros;
        let ones = bits.trailing_ones();
        each((passed + zeros) as usize, ones as usize);
        passed += zeros + ones;
        bits = if ones >= 64 { 0 } else { bits >> ones };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Rect, Size, hash};
    use crate::raster::Plane;
    use std::collections::BTreeSet;

    fn all(grid: &CoverageGrid, level: u32) -> Vec<Run> {
        tiles(grid).flat_map(|at| runs(grid, at, level)).collect()
    }

    #[test]
    fn the_outline_is_every_side_between_covered_and_not_once() {
        let plane = Plane::from_fn(Size::new(150, 130), |x, y| {
            hash::mix((x / 3 * 77 + y / 2) as u32) as u8
        });
        let grid = CoverageGrid::from_plane(&plane, -40, 0);
        let is_in = |x: i32, y: i32| grid.at(x, y) >= 128;
        let mut expected = BTreeSet::new();
        for (x, y) in (-70..200).flat_map(|x| (-70..200).map(move |y| (x, y))) {
            if is_in(x, y) != is_in(x - 1, y) {
                expected.insert((x, y, true));
            }
            if is_in(x, y) != is_in(x, y - 1) {
                expected.insert((x, y, false));
            }
        }
        let mut found = BTreeSet::new();
        for run in all(&grid, 0) {
            for i in 0..run.length {
                let (dx, dy) = if run.is_vertical { (0, i) } else { (i, 0) };
                assert!(
                    found.insert((run.x + dx, run.y + dy, run.is_vertical)),
                    "{run:?} comes twice"
                );
            }
        }
        assert!(found == expected);
    }

    #[test]
    fn coarser_outlines_go_round_the_blocks_that_hold_something() {
        let mut plane = Plane::full(Size::new(130, 130), 0u8);
        plane.set(70, 9, 255);
        let grid = CoverageGrid::from_plane(&plane, 0, 0);
        let run = |x, y, is_vertical| Run { x, y, length: 8, is_vertical };
        let square = [run(64, 8, false), run(64, 16, false), run(64, 8, true), run(72, 8, true)];
        assert_eq!(all(&grid, 3), square);
        let whole = CoverageGrid::full(Rect::new(0, 0, 128, 128));
        let length: i32 = all(&whole, COARSEST + 3).iter().map(|run| run.length).sum();
        assert_eq!(length, 4 * 128);
    }

    #[test]
    fn the_outline_of_a_tile_is_known_again_while_the_tiles_about_it_stay() {
        let grid = CoverageGrid::full(Rect::new(0, 0, 300, 300));
        let (far, near) = (TileAt::new(4, 4), TileAt::new(1, 1));
        let cut = grid.combined(&CoverageGrid::full(Rect::new(64, 64, 70, 70)), u8::saturating_sub);
        assert!(
            key(&grid, far, 0) == key(&cut, far, 0)
                || grid.tile(far).is_some_and(|tile| !tile.is_whole())
        );
        assert!(key(&grid, near, 0) != key(&cut, near, 0));
    }
}
