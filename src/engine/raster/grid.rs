//! A sparse grid of tiles, cheap to clone, shared tile by tile: the pixels of a paint layer
//! ([`TileGrid`]), the coverage of a selection (`coverage`). Floor 1. Straight pixels go in and out
//! in `straight`.

mod straight;

pub use straight::{premultiply, unpremultiply};

use super::tile::sixteen_bit::{self, Row16};
use super::tile::{TILE, Tile, TileAt};
use crate::math::Rect;
use std::sync::Arc;

/// Tiles on the canvas lattice; what is not held is empty. It may reach beyond the canvas on every
/// side.
///
/// A clone shares everything; writing one tile of a shared grid copies the list of tiles, never
/// their pixels.
pub struct Grid<T> {
    /// Columns and rows of tiles held, half open, in tile units.
    extent: TileExtent,
    tiles: Arc<Vec<Option<Arc<T>>>>,
}

/// The pixels of a paint layer; what is not held is transparent.
pub type TileGrid = Grid<Tile>;

// Derived implementations would require the same of the tiles, which are shared.
impl<T> Clone for Grid<T> {
    fn clone(&self) -> Self {
        Self { extent: self.extent, tiles: self.tiles.clone() }
    }
}

impl<T> Default for Grid<T> {
    fn default() -> Self {
        Self { extent: TileExtent::default(), tiles: Arc::default() }
    }
}

#[derive(Clone, Copy, Default, PartialEq, Eq)]
struct TileExtent {
    col0: i32,
    row0: i32,
    cols: i32,
    rows: i32,
}

impl TileExtent {
    fn index(self, at: TileAt) -> Option<usize> {
        let (c, r) = (at.col - self.col0, at.row - self.row0);
        (c >= 0 && r >= 0 && c < self.cols && r < self.rows).then(|| (r * self.cols + c) as usize)
    }

    /// The smallest extent that holds this one and one more tile.
    fn with(self, at: TileAt) -> Self {
        if self.cols == 0 || self.rows == 0 {
            return Self { col0: at.col, row0: at.row, cols: 1, rows: 1 };
        }
        let (col0, row0) = (self.col0.min(at.col), self.row0.min(at.row));
        let (col1, row1) =
            ((self.col0 + self.cols).max(at.col + 1), (self.row0 + self.rows).max(at.row + 1));
        Self { col0, row0, cols: col1 - col0, rows: row1 - row0 }
    }
}

impl<T> Grid<T> {
    /// An empty grid ready for the tiles of a pixel rectangle, so that writing them does not grow
    /// it.
    pub fn for_rect(rect: Rect) -> Self {
        if rect.is_empty() {
            return Self::default();
        }
        let (a, b) =
            (TileAt::of_pixel(rect.x0, rect.y0), TileAt::of_pixel(rect.x1 - 1, rect.y1 - 1));
        let extent = TileExtent {
            col0: a.col,
            row0: a.row,
            cols: b.col - a.col + 1,
            rows: b.row - a.row + 1,
        };
        Self { extent, tiles: Arc::new(vec![None; (extent.cols * extent.rows) as usize]) }
    }

    /// Makes room for the tiles of a pixel rectangle, so that writing them does not grow the grid
    /// one by one.
    pub fn reserve(&mut self, rect: Rect) {
        let extent = TileAt::covering(rect).fold(self.extent, TileExtent::with);
        if extent != self.extent {
            self.grow(extent);
        }
    }

    /// The tile at a place; `None` where nothing is held.
    pub fn tile(&self, at: TileAt) -> Option<&Arc<T>> {
        self.tiles[self.extent.index(at)?].as_ref()
    }

    /// Puts a tile in place, or removes it.
    pub fn set(&mut self, at: TileAt, tile: Option<Arc<T>>) {
        if self.extent.index(at).is_none() {
            if tile.is_none() {
                return;
            }
            self.grow(self.extent.with(at));
        }
        if let Some(i) = self.extent.index(at) {
            Arc::make_mut(&mut self.tiles)[i] = tile;
        }
    }

    fn grow(&mut self, extent: TileExtent) {
        let mut tiles = vec![None; (extent.cols * extent.rows) as usize];
        for (at, tile) in self.iter() {
            if let Some(i) = extent.index(at) {
                tiles[i] = Some(tile.clone());
            }
        }
        *self = Self { extent, tiles: Arc::new(tiles) };
    }

    /// The tiles that hold something, row by row.
    pub fn iter(&self) -> impl Iterator<Item = (TileAt, &Arc<T>)> {
        let e = self.extent;
        self.tiles.iter().enumerate().filter_map(move |(i, tile)| {
            let i = i as i32;
            Some((TileAt::new(e.col0 + i % e.cols, e.row0 + i / e.cols), tile.as_ref()?))
        })
    }

    /// The pixels of all held tiles, a multiple of [`TILE`] on every side.
    pub fn bounds(&self) -> Rect {
        self.iter().fold(Rect::EMPTY, |r, (at, _)| r.union(at.rect()))
    }

    /// Both grids are the same value in memory: nothing has changed between them.
    pub fn ptr_eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.tiles, &other.tiles)
    }

    /// The tiles in which two grids differ, compared by pointer.
    pub fn changed_tiles<'a>(&'a self, other: &'a Self) -> Vec<TileAt> {
        if self.ptr_eq(other) {
            return Vec::new();
        }
        let differs = |a: Option<&Arc<T>>, b: Option<&Arc<T>>| match (a, b) {
            (None, None) => false,
            (Some(a), Some(b)) => !Arc::ptr_eq(a, b),
            _ => true,
        };
        TileAt::covering(self.bounds().union(other.bounds()))
            .filter(|&at| differs(self.tile(at), other.tile(at)))
            .collect()
    }
}

impl Grid<Tile> {
    /// Copies a row of pixels, premultiplied, from a canvas pixel on, in levels: 255 is whole.
    pub fn copy_row(&self, x0: i32, y: i32, row: &mut [[f32; 4]]) {
        let line = Rect::new(x0, y, x0.saturating_add(row.len() as i32), y.saturating_add(1));
        for at in TileAt::covering(line) {
            let (tile, area) = (at.rect(), at.rect().intersect(line));
            let to = &mut row[(area.x0 - x0) as usize..][..area.width()];
            match self.tile(at) {
                Some(held) if held.is_16_bit() => {
                    let pixels = to.iter_mut().zip((area.x0 - tile.x0) as usize..);
                    let row = (y - tile.y0) as usize;
                    pixels.for_each(|(to, x)| {
                        *to = held.pixel16(x, row).map(|v| f32::from(v) / 257.0)
                    });
                }
                Some(held) => {
                    let start = (y - tile.y0) as usize * TILE + (area.x0 - tile.x0) as usize;
                    let bytes = &held.bytes().as_chunks::<4>().0[start..start + area.width()];
                    to.iter_mut().zip(bytes).for_each(|(to, bytes)| *to = bytes.map(f32::from));
                }
                None => to.fill([0.0; 4]),
            }
        }
    }

    /// Adds the tiles of a grid that paints no pixel that this one paints.
    pub fn join(&mut self, other: &TileGrid) {
        self.reserve(other.bounds());
        for (at, tile) in other.iter() {
            let joined = match self.tile(at) {
                None => Some(tile.clone()),
                Some(own) if own.is_16_bit() || tile.is_16_bit() => {
                    let mut both = own.to_rows16();
                    let values = both.as_flattened_mut().as_flattened_mut().iter_mut();
                    values
                        .zip(tile.to_rows16().as_flattened().as_flattened())
                        .for_each(|(a, b)| *a |= b);
                    Tile::from_rows16(both).map(Arc::new)
                }
                Some(own) => {
                    let both = own.bytes().iter().zip(tile.bytes()).map(|(a, b)| a | b).collect();
                    Tile::from_bytes(both).map(Arc::new)
                }
            };
            self.set(at, joined);
        }
    }

    /// Its bytes if nothing were shared.
    pub fn bytes(&self) -> usize {
        let held: u64 = self.tiles.iter().flatten().map(|tile| tile.held_bytes()).sum();
        held as usize + self.tiles.len() * size_of::<Option<Arc<Tile>>>()
    }

    /// A tile that a rectangle touches holds more than bytes can.
    pub fn is_16_bit_in(&self, rect: Rect) -> bool {
        self.iter().any(|(at, tile)| tile.is_16_bit() && !at.rect().intersect(rect).is_empty())
    }

    /// The same pixels in 8 bits everywhere; what is fainter than that is gone.
    pub fn rounded(&self) -> TileGrid {
        let mut grid = self.clone();
        for (at, tile) in self.iter().filter(|(_, tile)| tile.is_16_bit()) {
            grid.set(at, Tile::from_pixels(tile.bytes().to_vec()).map(Arc::new));
        }
        grid
    }

    /// A premultiplied pixel of 16 bits; transparent where there is no tile.
    pub fn pixel16(&self, x: i32, y: i32) -> [u16; 4] {
        let at = TileAt::of_pixel(x, y);
        let (x, y) = ((x - at.rect().x0) as usize, (y - at.rect().y0) as usize);
        self.tile(at).map_or([0; 4], |tile| tile.pixel16(x, y))
    }

    /// A premultiplied pixel; transparent where there is no tile.
    pub fn pixel(&self, x: i32, y: i32) -> [u8; 4] {
        let at = TileAt::of_pixel(x, y);
        let Some(tile) = self.tile(at) else { return [0; 4] };
        let i = ((y - at.rect().y0) as usize * TILE + (x - at.rect().x0) as usize) * 4;
        tile.bytes()[i..i + 4].try_into().unwrap_or([0; 4])
    }

    /// The same pixels elsewhere: moved by whole pixels, byte for byte.
    pub fn translated(&self, dx: i32, dy: i32) -> TileGrid {
        let b = self.bounds();
        let moved = |v: i32, d: i32| v.saturating_add(d);
        let to = Rect::new(moved(b.x0, dx), moved(b.y0, dy), moved(b.x1, dx), moved(b.y1, dy));
        let mut grid = TileGrid::for_rect(to);
        for at in TileAt::covering(to) {
            let from = at.rect();
            let from = Rect::new(
                moved(from.x0, -dx),
                moved(from.y0, -dy),
                moved(from.x1, -dx),
                moved(from.y1, -dy),
            );
            let tile = if self.is_16_bit_at(from) { self.block16(from) } else { self.block(from) };
            grid.set(at, tile.map(Arc::new));
        }
        grid
    }

    /// [`TileGrid::is_16_bit_in`] for a rectangle of few tiles.
    pub fn is_16_bit_at(&self, rect: Rect) -> bool {
        TileAt::covering(rect).any(|at| self.tile(at).is_some_and(|tile| tile.is_16_bit()))
    }

    /// A square of a tile's size at any position, as a tile; copied as bytes.
    fn block(&self, from: Rect) -> Option<Tile> {
        let mut bytes = vec![0u8; TILE * TILE * 4];
        for (tile, area, source) in self.parts(from) {
            for y in area.y0..area.y1 {
                let read = ((y - source.rect().y0) as usize * TILE
                    + (area.x0 - source.rect().x0) as usize)
                    * 4;
                let write = ((y - from.y0) as usize * TILE + (area.x0 - from.x0) as usize) * 4;
                let n = area.width() * 4;
                bytes[write..write + n].copy_from_slice(&tile.bytes()[read..read + n]);
            }
        }
        Tile::from_pixels(bytes)
    }

    /// The same in 16 bits.
    fn block16(&self, from: Rect) -> Option<Tile> {
        let mut rows = sixteen_bit::clear_rows();
        for (tile, area, source) in self.parts(from) {
            let held = tile.to_rows16();
            let (read, write) =
                ((area.x0 - source.rect().x0) as usize, (area.x0 - from.x0) as usize);
            for y in area.y0..area.y1 {
                let own: &Row16 = &held[(y - source.rect().y0) as usize];
                for (to, own) in rows[(y - from.y0) as usize].iter_mut().zip(own) {
                    to[write..write + area.width()]
                        .copy_from_slice(&own[read..read + area.width()]);
                }
            }
        }
        Tile::from_rows16(rows)
    }

    /// The tiles under a rectangle, and the part of it on each.
    fn parts(&self, from: Rect) -> impl Iterator<Item = (&Tile, Rect, TileAt)> {
        let part = move |at: TileAt| Some((&**self.tile(at)?, at.rect().intersect(from), at));
        TileAt::covering(from).filter_map(part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_joined_from_strips_is_the_picture() {
        let rgba: Vec<u8> = (0..130 * 90 * 4).map(|i| (i % 249) as u8 | 1).collect();
        let whole = TileGrid::from_straight_rgba(&rgba, 130, 90, -5, 3);
        let mut joined = TileGrid::default();
        for (i, strip) in rgba.chunks(130 * 4 * 25).enumerate() {
            joined.join(&TileGrid::from_straight_rgba(
                strip,
                130,
                strip.len() / 520,
                -5,
                3 + 25 * i as i32,
            ));
        }
        assert_eq!(joined.bounds(), whole.bounds());
        assert!(whole.iter().all(|(at, tile)| joined.tile(at).unwrap().bytes() == tile.bytes()));
        assert_eq!(joined.bytes(), 6 * (16384 + 8));
    }

    #[test]
    fn a_moved_grid_holds_the_same_bytes_elsewhere() {
        let rgba: Vec<u8> = (0..130 * 70 * 4).map(|i| (i % 249) as u8).collect();
        let grid = TileGrid::from_straight_rgba(&rgba, 130, 70, -5, 3);
        let moved = grid.translated(37, -101);
        for (x, y) in [(-5, 3), (0, 40), (124, 72), (60, 20)] {
            assert_eq!(moved.pixel(x + 37, y - 101), grid.pixel(x, y));
        }
    }

    #[test]
    fn a_clone_shares_every_tile_until_one_is_written() {
        let a = TileGrid::from_straight_rgba(&[255; 4 * 128 * 128], 128, 128, 0, 0);
        let mut b = a.clone();
        assert!(a.ptr_eq(&b));
        b.set(TileAt::new(1, 1), None);
        assert_eq!(a.changed_tiles(&b), [TileAt::new(1, 1)]);
        assert!(Arc::ptr_eq(
            a.tile(TileAt::new(0, 0)).unwrap(),
            b.tile(TileAt::new(0, 0)).unwrap()
        ));
    }
}
