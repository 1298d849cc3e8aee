//! Which pixels are joined to one by colours like its own, over their four neighbours: tile by tile, a row of a tile at
//! a time. Floor 3. Only tiles that are reached are read. The result does not depend on the order in which pixels are
//! found.

use super::PixelSet;
use crate::math::{Rect, Size};
use crate::raster::{Plane, TILE, Tile, TileAt};
use crate::surface::objects::CanvasPart;
use rayon::prelude::*;
use std::sync::Arc;

/// A pixel a bit: rows of a tile, the leftmost pixel the lowest bit.
type TileBits = [u64; TILE];

/// A tile that the fill has reached.
struct FloodTile {
    /// May be filled.
    open: TileBits,
    filled: TileBits,
}

/// Where the fill enters a tile.
#[derive(Clone, Copy, Default)]
struct FloodEntry {
    /// Of the top and the bottom row.
    rows: [u64; 2],
    /// Of the left and the right column, a row a bit.
    columns: [u64; 2],
    /// The pixel where it begins.
    start: Option<(usize, usize)>,
}

/// All that is joined to a pixel of the canvas; `None` where that pixel may not be touched. `tolerance` in bytes.
pub(super) fn joined(
    (x, y): (i32, i32),
    canvas: Size,
    part: &CanvasPart,
    tolerance: u8,
    tile: impl Fn(TileAt) -> Option<Arc<Tile>> + Sync,
) -> Option<PixelSet> {
    if part.coverage(x, y) <= 0.0 {
        return None;
    }
    let first = TileAt::of_pixel(x, y);
    let start = ((x - first.rect().x0) as usize, (y - first.rect().y0) as usize);
    let like = pixel(tile(first).as_deref(), start);
    let opened = |at: TileAt| opened(at, tile(at).as_deref(), like, tolerance, canvas, part);
    let (columns, rows) = (canvas.width.div_ceil(TILE as u32) as i32, canvas.height.div_ceil(TILE as u32) as i32);
    let index = |at: TileAt| {
        let is_there = (0..columns).contains(&at.col) && (0..rows).contains(&at.row);
        is_there.then(|| (at.row * columns + at.col) as usize)
    };
    let mut tiles: Vec<Option<Box<FloodTile>>> = (0..columns * rows).map(|_| None).collect();
    let mut wave = vec![(first, FloodEntry { start: Some(start), ..FloodEntry::default() })];
    while !wave.is_empty() {
        let taken: Vec<_> =
            wave.into_iter().filter_map(|(at, entry)| Some((at, entry, tiles.get_mut(index(at)?)?.take()))).collect();
        let spread: Vec<(TileAt, Box<FloodTile>, FloodEntry)> = taken
            .into_par_iter()
            .map(|(at, entry, reached)| {
                let mut reached =
                    reached.unwrap_or_else(|| Box::new(FloodTile { open: opened(at), filled: [0; TILE] }));
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
            })
            .collect();
        wave = next_wave(&spread);
        for (at, reached, _) in spread {
            if let Some(slot) = index(at).and_then(|i| tiles.get_mut(i)) {
                *slot = Some(reached);
            }
        }
    }
    Some(gathered(&tiles, columns, canvas))
}

/// Pixels that leave the tiles of a wave enter their neighbours: one entry per tile, in the order of the tiles.
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
    /// Continues the fill from its entry.
    fn enter(&mut self, entry: FloodEntry) {
        self.filled[0] |= entry.rows[0] & self.open[0];
        self.filled[TILE - 1] |= entry.rows[1] & self.open[TILE - 1];
        for y in 0..TILE {
            let (west, east) = (entry.columns[0] >> y & 1, entry.columns[1] >> y & 1);
            self.filled[y] |= (west | east << (TILE - 1)) & self.open[y];
        }
        if let Some((x, y)) = entry.start {
            self.filled[y] |= 1 << x & self.open[y];
        }
        // Down and up until nothing is added.
        loop {
            let mut grew = false;
            for y in 0..TILE {
                grew |= self.spread(y, if y > 0 { self.filled[y - 1] } else { 0 });
            }
            for y in (0..TILE - 1).rev() {
                grew |= self.spread(y, self.filled[y + 1]);
            }
            if !grew {
                return;
            }
        }
    }
    /// Fills a row from what it holds and from a row beside it; whether it grew.
    fn spread(&mut self, y: usize, beside: u64) -> bool {
        let (open, before) = (self.open[y], self.filled[y]);
        let seeds = before | beside & open;
        self.filled[y] = runs_of(open, seeds);
        self.filled[y] != before
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

/// The runs of set bits in `open` that hold a seed: both ways by doubling steps.
fn runs_of(open: u64, seeds: u64) -> u64 {
    let (mut up, mut down) = (seeds, seeds);
    let (mut up_free, mut down_free) = (open, open);
    for step in [1, 2, 4, 8, 16, 32] {
        up |= up_free & up << step;
        up_free &= up_free << step;
        down |= down_free & down >> step;
        down_free &= down_free >> step;
    }
    up | down
}

fn pixel(tile: Option<&Tile>, (x, y): (usize, usize)) -> [u8; 4] {
    let bytes = tile.and_then(|tile| tile.bytes().as_chunks::<4>().0.get(y * TILE + x).copied());
    bytes.unwrap_or_default()
}

/// The pixels of a tile that may be filled.
fn opened(at: TileAt, tile: Option<&Tile>, like: [u8; 4], tolerance: u8, canvas: Size, part: &CanvasPart) -> TileBits {
    let area = at.rect().intersect(canvas.rect());
    let mut open = [0; TILE];
    let blank_is_open = is_like([0; 4], like, tolerance);
    for y in area.y0..area.y1 {
        let row = (y - at.rect().y0) as usize;
        let mut bits = match tile {
            Some(tile) => row_like(&tile.bytes().as_chunks::<4>().0[row * TILE..][..TILE], like, tolerance),
            None => {
                if blank_is_open {
                    u64::MAX
                } else {
                    0
                }
            }
        };
        if area.width() < TILE {
            bits &= (1 << area.width()) - 1;
        }
        if !part.is_whole() {
            for x in (0..area.width()).filter(|x| bits >> x & 1 != 0).collect::<Vec<_>>() {
                if part.coverage(area.x0 + x as i32, y) <= 0.0 {
                    bits &= !(1 << x);
                }
            }
        }
        open[row] = bits;
    }
    open
}

crate::widest! {
    /// A bit for each of 64 pixels.
    fn row_like(pixels: &[[u8; 4]], like: [u8; 4], tolerance: u8) -> u64 {
        let mut alike = [0u8; TILE];
        for (a, p) in alike.iter_mut().zip(pixels) {
            *a = u8::from(is_like(*p, like, tolerance));
        }
        alike.iter().rev().fold(0, |bits, a| bits << 1 | u64::from(*a))
    }
}

/// Whether no channel differs by more than the tolerance.
#[inline(always)]
fn is_like(a: [u8; 4], b: [u8; 4], tolerance: u8) -> bool {
    let near = |c: usize| a[c].abs_diff(b[c]) <= tolerance;
    near(0) & near(1) & near(2) & near(3)
}

/// The filled pixels in the smallest rectangle of whole tiles that holds them, on the canvas.
fn gathered(tiles: &[Option<Box<FloodTile>>], columns: i32, canvas: Size) -> PixelSet {
    let place = |i: usize| TileAt::new(i as i32 % columns, i as i32 / columns);
    let reached = || tiles.iter().enumerate().filter_map(|(i, tile)| Some((place(i), tile.as_ref()?)));
    let is_filled = |tile: &FloodTile| tile.filled.iter().any(|&bits| bits != 0);
    let held = reached().filter(|(_, tile)| is_filled(tile)).map(|(at, _)| at.rect());
    let rect = held.fold(Rect::EMPTY, Rect::union).intersect(canvas.rect());
    let mut pixels = Plane::filled(Size::new(rect.width() as u32, rect.height() as u32), 0u8);
    for (at, tile) in reached() {
        let area = at.rect().intersect(rect);
        for y in area.y0..area.y1 {
            let bits = tile.filled[(y - at.rect().y0) as usize];
            let row = &mut pixels.row_mut((y - rect.y0) as usize)[(area.x0 - rect.x0) as usize..][..area.width()];
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = (bits >> x & 1) as u8;
            }
        }
    }
    PixelSet { rect, pixels }
}
