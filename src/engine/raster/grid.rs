//! A sparse grid of tiles, cheap to clone, shared tile by tile: the pixels of a paint layer ([`TileGrid`]), the
//! coverage of a selection (`coverage`). Floor 1.

use super::tile::{TILE, Tile, TileAt};
use crate::math::Rect;
use std::sync::Arc;

/// Tiles on the canvas lattice; what is not held is empty. It may reach beyond the canvas on every side.
///
/// A clone shares everything; writing one tile of a shared grid copies the list of tiles, never their pixels.
pub struct Grid<T> {
    /// Columns and rows of tiles held, half open, in tile units.
    extent: TileExtent,
    tiles: Arc<Vec<Option<Arc<T>>>>,
}

/// The pixels of a paint layer; what is not held is transparent.
pub type TileGrid = Grid<Tile>;

// Derived ones would ask the same of the tiles, which are shared.
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
        let (col1, row1) = ((self.col0 + self.cols).max(at.col + 1), (self.row0 + self.rows).max(at.row + 1));
        Self { col0, row0, cols: col1 - col0, rows: row1 - row0 }
    }
}

impl<T> Grid<T> {
    /// An empty grid ready for the tiles of a pixel rectangle, so that writing them does not grow it.
    pub fn for_rect(rect: Rect) -> Self {
        if rect.is_empty() {
            return Self::default();
        }
        let (a, b) = (TileAt::of_pixel(rect.x0, rect.y0), TileAt::of_pixel(rect.x1 - 1, rect.y1 - 1));
        let extent = TileExtent { col0: a.col, row0: a.row, cols: b.col - a.col + 1, rows: b.row - a.row + 1 };
        Self { extent, tiles: Arc::new(vec![None; (extent.cols * extent.rows) as usize]) }
    }
    /// Makes room for the tiles of a pixel rectangle, so that writing them does not grow the grid one by one.
    pub fn reserve(&mut self, rect: Rect) {
        let extent = TileAt::covering(rect).fold(self.extent, TileExtent::with);
        if extent != self.extent {
            self.grow(extent);
        }
    }
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
    /// The tiles in which two grids differ, by pointer.
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
    /// Copies a row of pixels, premultiplied, from a canvas pixel on.
    pub fn copy_row(&self, x0: i32, y: i32, row: &mut [[u8; 4]]) {
        let line = Rect::new(x0, y, x0.saturating_add(row.len() as i32), y.saturating_add(1));
        for at in TileAt::covering(line) {
            let (tile, area) = (at.rect(), at.rect().intersect(line));
            let to = &mut row[(area.x0 - x0) as usize..][..area.width()];
            match self.tile(at) {
                Some(held) => {
                    let start = (y - tile.y0) as usize * TILE + (area.x0 - tile.x0) as usize;
                    to.copy_from_slice(&held.bytes().as_chunks::<4>().0[start..start + area.width()]);
                }
                None => to.fill([0; 4]),
            }
        }
    }
    /// Takes in the tiles of a grid that paints no pixel that this one paints.
    pub fn join(&mut self, other: &TileGrid) {
        self.reserve(other.bounds());
        for (at, tile) in other.iter() {
            let joined = match self.tile(at) {
                None => Some(tile.clone()),
                Some(own) => {
                    let both = own.bytes().iter().zip(tile.bytes()).map(|(a, b)| a | b).collect();
                    Tile::from_bytes(both).map(Arc::new)
                }
            };
            self.set(at, joined);
        }
    }
    /// What it takes, were nothing of it shared.
    pub fn bytes(&self) -> usize {
        let held = self.tiles.iter().flatten().count();
        held * TILE * TILE * 4 + self.tiles.len() * size_of::<Option<Arc<Tile>>>()
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
            let mut bytes = vec![0u8; TILE * TILE * 4];
            let from = at.rect();
            let from = Rect::new(moved(from.x0, -dx), moved(from.y0, -dy), moved(from.x1, -dx), moved(from.y1, -dy));
            for source in TileAt::covering(from) {
                let Some(tile) = self.tile(source) else { continue };
                let area = source.rect().intersect(from);
                for y in area.y0..area.y1 {
                    let read = ((y - source.rect().y0) as usize * TILE + (area.x0 - source.rect().x0) as usize) * 4;
                    let write = ((y - from.y0) as usize * TILE + (area.x0 - from.x0) as usize) * 4;
                    let n = area.width() * 4;
                    bytes[write..write + n].copy_from_slice(&tile.bytes()[read..read + n]);
                }
            }
            grid.set(at, Tile::from_pixels(bytes).map(Arc::new));
        }
        grid
    }
    /// Cuts straight-alpha RGBA bytes (`width · height · 4`, row by row) into premultiplied tiles, at a canvas offset.
    pub fn from_straight_rgba(rgba: &[u8], width: usize, height: usize, x: i32, y: i32) -> Self {
        let rect = Rect::new(x, y, x.saturating_add(width as i32), y.saturating_add(height as i32));
        let mut grid = Self::for_rect(rect);
        for at in TileAt::covering(rect) {
            let area = at.rect().intersect(rect);
            let mut bytes = vec![0u8; TILE * TILE * 4];
            for py in area.y0..area.y1 {
                let from = ((py - y) as usize * width + (area.x0 - x) as usize) * 4;
                let to = ((py - at.rect().y0) as usize * TILE + (area.x0 - at.rect().x0) as usize) * 4;
                let n = area.width() * 4;
                premultiply(&rgba[from..from + n], &mut bytes[to..to + n]);
            }
            if bytes.iter().any(|&b| b != 0) {
                grid.set(at, Tile::from_bytes(bytes).map(Arc::new));
            }
        }
        grid
    }
    /// Straight-alpha RGBA bytes of a pixel rectangle, row by row.
    pub fn to_straight_rgba(&self, rect: Rect) -> Vec<u8> {
        let mut out = vec![0u8; rect.width() * rect.height() * 4];
        for at in TileAt::covering(rect) {
            let Some(tile) = self.tile(at) else { continue };
            let area = at.rect().intersect(rect);
            for py in area.y0..area.y1 {
                let from = ((py - at.rect().y0) as usize * TILE + (area.x0 - at.rect().x0) as usize) * 4;
                let to = ((py - rect.y0) as usize * rect.width() + (area.x0 - rect.x0) as usize) * 4;
                let n = area.width() * 4;
                unpremultiply(&tile.bytes()[from..from + n], &mut out[to..to + n]);
            }
        }
        out
    }
}

crate::widest! {
    /// Straight bytes to premultiplied bytes, rounded to nearest.
    pub fn premultiply(straight: &[u8], premultiplied: &mut [u8]) {
        let (straight, premultiplied) = (straight.as_chunks::<4>().0, premultiplied.as_chunks_mut::<4>().0);
        for (s, p) in straight.iter().zip(premultiplied) {
            // The alpha itself as a colour that is whole.
            let whole = [s[0], s[1], s[2], 255];
            let a = u32::from(s[3]);
            *p = whole.map(|c| ((u32::from(c) * a + 127) / 255) as u8);
        }
    }

    /// Premultiplied bytes to straight bytes, rounded to nearest; transparent pixels become transparent black.
    pub fn unpremultiply(premultiplied: &[u8], straight: &mut [u8]) {
        let (premultiplied, straight) = (premultiplied.as_chunks::<4>().0, straight.as_chunks_mut::<4>().0);
        for (p, s) in premultiplied.iter().zip(straight) {
            let a = i32::from(p[3]);
            // Of numbers below 2¹⁶ a rounded-down f32 quotient is the whole quotient.
            let over = a.max(1) as f32;
            let color = [p[0], p[1], p[2]].map(|c| ((i32::from(c) * 255 + a / 2) as f32 / over) as i32);
            let held = if a == 0 { 0 } else { 255 };
            *s = [color[0].min(held) as u8, color[1].min(held) as u8, color[2].min(held) as u8, p[3]];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_cut_into_tiles_comes_back_whole() {
        let (w, h) = (130, 70);
        let rgba: Vec<u8> = (0..w * h).flat_map(|i| [(i % 251) as u8, (i % 83) as u8, (i % 7) as u8, 255]).collect();
        let grid = TileGrid::from_straight_rgba(&rgba, w, h, -5, 3);
        assert_eq!(grid.to_straight_rgba(Rect::new(-5, 3, 125, 73)), rgba);
        assert_eq!(grid.pixel(-6, 3), [0; 4]);
    }
    #[test]
    fn a_picture_joined_from_strips_is_the_picture() {
        let rgba: Vec<u8> = (0..130 * 90 * 4).map(|i| (i % 249) as u8 | 1).collect();
        let whole = TileGrid::from_straight_rgba(&rgba, 130, 90, -5, 3);
        let mut joined = TileGrid::default();
        for (i, strip) in rgba.chunks(130 * 4 * 25).enumerate() {
            joined.join(&TileGrid::from_straight_rgba(strip, 130, strip.len() / 520, -5, 3 + 25 * i as i32));
        }
        assert_eq!(joined.bounds(), whole.bounds());
        assert!(whole.iter().all(|(at, tile)| joined.tile(at).unwrap().bytes() == tile.bytes()));
        assert_eq!(joined.bytes(), 6 * (16384 + 8));
    }
    #[test]
    fn straight_and_premultiplied_bytes_are_rounded_to_nearest() {
        let all: Vec<[u8; 4]> = (0..=255u8).flat_map(|a| (0..=255u8).map(move |c| [c, 255 - c, c / 2, a])).collect();
        let (mut premultiplied, mut straight) = (vec![0; all.len() * 4], vec![0; all.len() * 4]);
        premultiply(all.as_flattened(), &mut premultiplied);
        unpremultiply(all.as_flattened(), &mut straight);
        for ((of, p), s) in all.iter().zip(premultiplied.as_chunks::<4>().0).zip(straight.as_chunks::<4>().0) {
            let a = u32::from(of[3]);
            for c in 0..3 {
                let v = u32::from(of[c]);
                assert_eq!(u32::from(p[c]), (v * a + 127) / 255, "{of:?}");
                assert_eq!(u32::from(s[c]), if a == 0 { 0 } else { ((v * 255 + a / 2) / a).min(255) }, "{of:?}");
            }
            assert_eq!((p[3], s[3]), (of[3], of[3]));
        }
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
        assert!(Arc::ptr_eq(a.tile(TileAt::new(0, 0)).unwrap(), b.tile(TileAt::new(0, 0)).unwrap()));
    }
}
