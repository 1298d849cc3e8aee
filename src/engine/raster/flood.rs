//! Floods: all pixels that are joined to one over their four neighbors, tile by tile, a row of a
//! tile at a time. Floor 1. The caller says which pixels may be reached and which neighbors are
//! joined; only tiles that are reached are requested. The result does not depend on the order in
//! which pixels are found.

use super::bits::TileBits;
use super::tile::{TILE, TileAt};
use super::{CoverageGrid, CoverageTile};
use crate::math::{Rect, Size, parallel};

/// What a flood may do in a tile.
pub struct OpenTile {
    /// May be reached.
    pub open: TileBits,
    /// From which sides; absent: from all.
    pub links: Option<Box<TileLinks>>,
}

/// The pixels of a tile that may be reached from their neighbor on a side.
#[derive(Clone, Copy)]
pub struct TileLinks {
    /// Those that may be reached from the left.
    pub from_left: TileBits,
    /// Those that may be reached from the right.
    pub from_right: TileBits,
    /// Those that may be reached from above.
    pub from_above: TileBits,
    /// Those that may be reached from below.
    pub from_below: TileBits,
}

/// A tile that the flood has reached.
struct FloodTile {
    may: OpenTile,
    filled: TileBits,
}

/// Where the flood enters a tile.
#[derive(Clone, Copy, Default)]
struct FloodEntry {
    /// Of the top and the bottom row.
    rows: [u64; 2],
    /// Of the left and the right column, one bit per row.
    columns: [u64; 2],
    /// The pixel where it begins.
    start: Option<(usize, usize)>,
}

/// The pixels that a flood found.
pub struct Flooded {
    tiles: Vec<Option<Box<FloodTile>>>,
    columns: i32,
    canvas: Size,
}

impl Flooded {
    /// Everything that is joined to a pixel of the canvas.
    pub fn from(
        (x, y): (i32, i32),
        canvas: Size,
        opened: impl Fn(TileAt) -> OpenTile + Sync,
    ) -> Self {
        let first = TileAt::of_pixel(x, y);
        let start = ((x - first.rect().x0) as usize, (y - first.rect().y0) as usize);
        let (columns, rows) =
            (canvas.width.div_ceil(TILE as u32) as i32, canvas.height.div_ceil(TILE as u32) as i32);
        let index = |at: TileAt| {
            let is_there = (0..columns).contains(&at.col) && (0..rows).contains(&at.row);
            is_there.then(|| (at.row * columns + at.col) as usize)
        };
        let mut tiles: Vec<Option<Box<FloodTile>>> = (0..columns * rows).map(|_| None).collect();
        let mut wave = vec![(first, FloodEntry { start: Some(start), ..FloodEntry::default() })];
        while !wave.is_empty() {
            let taken: Vec<_> = wave
                .into_iter()
                .filter_map(|(at, entry)| Some((at, entry, tiles.get_mut(index(at)?)?.take())))
                .collect();
            let spread: Vec<(TileAt, Box<FloodTile>, FloodEntry)> =
                parallel::map(taken, |(at, entry, reached)| {
                    let mut reached = reached.unwrap_or_else(|| {
                        Box::new(FloodTile { may: opened(at), filled: [0; TILE] })
                    });
                    let before = reached.border();
                    reached.enter(entry);
                    let now = reached.border();
                    let new = |a: [u64; 2], b: [u64; 2]| [a[0] & !b[0], a[1] & !b[1]];
                    let left = FloodEntry {
                        rows: new(now.rows, before.rows),
                        columns: new(now.columns, before.columns),
                        start: None,
                    };
                    (at, reached, left)
                });
            wave = next_wave(&spread);
            for (at, reached, _) in spread {
                if let Some(slot) = index(at).and_then(|i| tiles.get_mut(i)) {
                    *slot = Some(reached);
                }
            }
        }
        Self { tiles, columns, canvas }
    }

    /// The tiles that hold a pixel that was reached, row by row.
    pub fn tiles(&self) -> impl Iterator<Item = (TileAt, &TileBits)> {
        let place = |i: usize| TileAt::new(i as i32 % self.columns, i as i32 / self.columns);
        let reached = self
            .tiles
            .iter()
            .enumerate()
            .filter_map(move |(i, tile)| Some((place(i), &tile.as_ref()?.filled)));
        reached.filter(|(_, bits)| bits.iter().any(|&row| row != 0))
    }

    /// The smallest rectangle of whole tiles that holds all pixels, on the canvas.
    pub fn rect(&self) -> Rect {
        self.tiles()
            .map(|(at, _)| at.rect())
            .fold(Rect::EMPTY, Rect::union)
            .intersect(self.canvas.rect())
    }

    /// The pixels as coverage, whole or none.
    pub fn coverage(&self) -> CoverageGrid {
        let mut grid = CoverageGrid::for_rect(self.rect());
        let tiles: Vec<_> = self.tiles().collect();
        let made: Vec<_> = parallel::map(&tiles, |(at, bits)| (*at, CoverageTile::of_bits(bits)));
        made.into_iter().for_each(|(at, tile)| grid.set(at, tile));
        grid
    }
}

/// Pixels that leave the tiles of a wave enter their neighbors: one entry per tile, in the order
/// of the tiles.
fn next_wave(spread: &[(TileAt, Box<FloodTile>, FloodEntry)]) -> Vec<(TileAt, FloodEntry)> {
    let mut entries = std::collections::BTreeMap::<TileAt, FloodEntry>::new();
    for (at, _, left) in spread {
        let mut into = |dx: i32, dy: i32, enter: &dyn Fn(&mut FloodEntry)| {
            enter(entries.entry(TileAt::new(at.col + dx, at.row + dy)).or_default());
        };
        let [top, bottom] = left.rows;
        let [west, east] = left.columns;
        // The top row leaves into the bottom row of the tile above.
        if top != 0 {
            into(0, -1, &|e| e.rows[1] |= top);
        }
        if bottom != 0 {
            into(0, 1, &|e| e.rows[0] |= bottom);
        }
        if west != 0 {
            into(-1, 0, &|e| e.columns[1] |= west);
        }
        if east != 0 {
            into(1, 0, &|e| e.columns[0] |= east);
        }
    }
    entries.into_iter().collect()
}

impl FloodTile {
    /// Continues the flood from its entry.
    fn enter(&mut self, entry: FloodEntry) {
        let joined = self.may.joined_sides();
        let [from_left, from_right, from_above, from_below] = joined.sides(&self.may.open);
        let filled = &mut self.filled;
        let before = *filled;
        filled[0] |= entry.rows[0] & from_above[0];
        filled[TILE - 1] |= entry.rows[1] & from_below[TILE - 1];
        for y in 0..TILE {
            let (west, east) = (entry.columns[0] >> y & 1, entry.columns[1] >> y & 1);
            filled[y] |= west & from_left[y] | east << (TILE - 1) & from_right[y];
        }
        if let Some((x, y)) = entry.start {
            filled[y] |= 1 << x & self.may.open[y];
        }
        // Rows that hold pixels which have not spread along them yet, one bit each: all others are
        // as full as they get until something enters them.
        let mut fresh =
            (0..TILE).fold(0u64, |rows, y| rows | u64::from(filled[y] != before[y]) << y);
        let mut spread = |filled: &mut TileBits, y: usize, entering: u64| {
            let seeds = filled[y] | entering;
            if seeds == filled[y] && fresh >> y & 1 == 0 {
                return false;
            }
            fresh &= !(1 << y);
            let now = runs_of(from_left[y], from_right[y], seeds);
            std::mem::replace(&mut filled[y], now) != now
        };
        // Down and up until nothing is added.
        loop {
            let mut grew = false;
            for y in 0..TILE {
                let above = if y > 0 { filled[y - 1] } else { 0 };
                grew |= spread(filled, y, above & from_above[y]);
            }
            for y in (0..TILE - 1).rev() {
                let below = filled[y + 1];
                grew |= spread(filled, y, below & from_below[y]);
            }
            if !grew {
                return;
            }
        }
    }

    fn border(&self) -> FloodEntry {
        let column = |x: usize| (0..TILE).fold(0, |bits, y| bits | (self.filled[y] >> x & 1) << y);
        FloodEntry {
            rows: [self.filled[0], self.filled[TILE - 1]],
            columns: [column(0), column(TILE - 1)],
            start: None,
        }
    }
}

impl OpenTile {
    /// The pixels that may be entered from each side, if that is not every open pixel.
    fn joined_sides(&self) -> JoinedSides {
        let both = |links: &TileBits| std::array::from_fn(|y| links[y] & self.open[y]);
        JoinedSides(self.links.as_ref().map(|links| {
            [
                both(&links.from_left),
                both(&links.from_right),
                both(&links.from_above),
                both(&links.from_below),
            ]
        }))
    }
}

/// From the left, the right, above and below.
struct JoinedSides(Option<[TileBits; 4]>);

impl JoinedSides {
    fn sides<'a>(&'a self, open: &'a TileBits) -> [&'a TileBits; 4] {
        self.0.as_ref().map_or([open; 4], |sides| sides.each_ref())
    }
}

/// What seeds reach along a row: to the right over pixels that may be entered from the left, to the
/// left over those that may be entered from the right; both by doubling steps.
fn runs_of(from_left: u64, from_right: u64, seeds: u64) -> u64 {
    let (mut up, mut down) = (seeds, seeds);
    let (mut up_free, mut down_free) = (from_left, from_right);
    for step in [1, 2, 4, 8, 16, 32] {
        up |= up_free & up << step;
        up_free &= up_free << step;
        down |= down_free & down >> step;
        down_free &= down_free >> step;
    }
    up | down
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash;
    use crate::raster::bits::{bits_of, bytes_of};
    use std::collections::BTreeSet;

    const CANVAS: Size = Size::new(150, 140);

    /// Whether a pixel is open, and whether it is joined to the right and below.
    fn pixel(seed: u32, x: i32, y: i32) -> (bool, bool, bool) {
        let unit = |i: u32| hash::unit(seed.wrapping_add(i), x as u32, y as u32);
        let inside = CANVAS.rect().contains(x, y);
        (inside && unit(0) < 0.8, unit(1) < 0.7, unit(2) < 0.7)
    }

    fn opened(seed: u32, at: TileAt) -> OpenTile {
        let bits = |is: &dyn Fn(i32, i32) -> bool| -> TileBits {
            let (x0, y0) = (at.rect().x0, at.rect().y0);
            let row = |y: usize| {
                (0..TILE)
                    .fold(0u64, |bits, x| bits | u64::from(is(x0 + x as i32, y0 + y as i32)) << x)
            };
            std::array::from_fn(row)
        };
        OpenTile {
            open: bits(&|x, y| pixel(seed, x, y).0),
            links: Some(Box::new(TileLinks {
                from_left: bits(&|x, y| pixel(seed, x - 1, y).1),
                from_right: bits(&|x, y| pixel(seed, x, y).1),
                from_above: bits(&|x, y| pixel(seed, x, y - 1).2),
                from_below: bits(&|x, y| pixel(seed, x, y).2),
            })),
        }
    }

    /// The same, a pixel at a time.
    fn reference(seed: u32, start: (i32, i32)) -> BTreeSet<(i32, i32)> {
        let (mut found, mut ends) = (BTreeSet::new(), vec![start]);
        while let Some((x, y)) = ends.pop() {
            if !pixel(seed, x, y).0 || !found.insert((x, y)) {
                continue;
            }
            let (_, right, below) = pixel(seed, x, y);
            let (_, left, _) = pixel(seed, x - 1, y);
            let (_, _, above) = pixel(seed, x, y - 1);
            let to = [(right, x + 1, y), (below, x, y + 1), (left, x - 1, y), (above, x, y - 1)];
            ends.extend(to.into_iter().filter(|step| step.0).map(|(_, x, y)| (x, y)));
        }
        found
    }

    #[test]
    fn bits_and_bytes_are_the_same_pixels() {
        for seed in 0..200 {
            let bits = u64::from(hash::mix(seed)) << 32 | u64::from(hash::mix(!seed));
            let bits = if seed % 3 == 0 { bits & bits.rotate_left(seed) } else { bits };
            let bytes = bytes_of(bits);
            assert!((0..TILE).all(|x| u64::from(bytes[x]) == bits >> x & 1), "{bits:x}: {bytes:?}");
            assert_eq!(bits_of(&bytes), bits);
        }
        assert_eq!(
            (bytes_of(u64::MAX), bits_of(&[1; TILE]), bits_of(&[0; TILE])),
            ([1; TILE], u64::MAX, 0)
        );
    }

    #[test]
    fn a_flood_crosses_neither_closed_pixels_nor_missing_links() {
        for seed in 0..8 {
            let start = (0..150).map(|x| (x, 70)).find(|&(x, y)| pixel(seed, x, y).0).unwrap();
            let found = Flooded::from(start, CANVAS, |at| opened(seed, at)).coverage();
            let expected = reference(seed, start);
            for (x, y) in (0..150).flat_map(|x| (0..140).map(move |y| (x, y))) {
                assert_eq!(found.at(x, y) == 255, expected.contains(&(x, y)), "{seed} at {x}, {y}");
            }
            assert_eq!(found.area_px(), expected.len() as f64);
        }
    }
}
