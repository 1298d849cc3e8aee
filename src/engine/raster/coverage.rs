//! Coverage in sparse tiles of one byte a pixel, cheap to clone and shared tile by tile: what a
//! selection holds. Floor 1. `shapes` and `winding` draw exact coverage, `edges` moves and softens its edges,
//! `contour` finds its outline. Not here: what a selection was made of (`paint::selection`).

pub mod contour;
pub mod edges;
pub mod shapes;
pub mod trace;
pub mod winding;

use super::bits::{TileBits, bytes_of};
use super::grid::Grid;
use super::tile::{TILE, TILE_AREA, TileAt};
use super::{Plane, Tile};
use crate::math::{Rect, Size, parallel};
use std::sync::{Arc, OnceLock};

/// The coverage of one tile; 255 is wholly covered. `None` in a grid means no coverage.
pub struct CoverageTile {
    bytes: Box<[u8; TILE_AREA]>,
    is_whole: bool,
}

/// Coverage on the canvas lattice.
pub type CoverageGrid = Grid<CoverageTile>;

impl CoverageTile {
    /// A tile of coverage; `None` where nothing is covered. Wholly covered tiles are one and the
    /// same.
    pub fn new(bytes: Box<[u8; TILE_AREA]>) -> Option<Arc<Self>> {
        let (mut least, mut most) = (u8::MAX, 0);
        for &b in bytes.iter() {
            (least, most) = (least.min(b), most.max(b));
        }
        match (least, most) {
            (_, 0) => None,
            (u8::MAX, _) => Some(Self::whole()),
            _ => Some(Arc::new(Self { bytes, is_whole: false })),
        }
    }

    /// Every pixel covered.
    pub fn whole() -> Arc<Self> {
        static WHOLE: OnceLock<Arc<CoverageTile>> = OnceLock::new();
        WHOLE.get_or_init(|| Arc::new(Self { bytes: blank(u8::MAX), is_whole: true })).clone()
    }

    /// From one bit per pixel, as floods give them.
    pub fn of_bits(bits: &TileBits) -> Option<Arc<Self>> {
        if bits.iter().all(|row| *row == u64::MAX) {
            return Some(Self::whole());
        }
        let mut bytes = blank(0);
        for (row, bits) in bytes.as_chunks_mut::<TILE>().0.iter_mut().zip(bits) {
            *row = bytes_of(*bits).map(|b| b * u8::MAX);
        }
        Self::new(bytes)
    }

    /// Bytes that it takes: none of its own if it is the shared, wholly covered tile.
    pub fn held_bytes(&self) -> u64 {
        if self.is_whole { 0 } else { TILE_AREA as u64 }
    }

    /// One byte a pixel, row by row.
    pub fn bytes(&self) -> &[u8; TILE_AREA] {
        &self.bytes
    }

    /// Every pixel is wholly covered.
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }
}

/// A tile of one value.
pub fn blank(value: u8) -> Box<[u8; TILE_AREA]> {
    vec![value; TILE_AREA].into_boxed_slice().try_into().expect("a vector of TILE_AREA bytes")
}

crate::named! {
    /// How a new selection combines with the existing one.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum SelectionMode {
        #[default]
        Replace = "replace",
        Add = "add",
        TakeAway = "take away",
        Intersect = "intersect",
    }
}

impl SelectionMode {
    /// For one pixel: the larger, what is left, the smaller. Adding or intersecting the same again
    /// changes nothing, and subtracting the same leaves nothing, even at soft edges.
    #[inline(always)]
    pub fn of(self, old: u8, new: u8) -> u8 {
        match self {
            SelectionMode::Replace => new,
            SelectionMode::Add => old.max(new),
            SelectionMode::TakeAway => old.saturating_sub(new),
            SelectionMode::Intersect => old.min(new),
        }
    }
}

/// a · b of two coverages, rounded to nearest.
#[inline(always)]
pub fn product(a: u8, b: u8) -> u8 {
    ((u32::from(a) * u32::from(b) + 127) / 255) as u8
}

impl Grid<CoverageTile> {
    /// Computes the tiles of a rectangle, in parallel. `fill` gets a blank tile; what it writes
    /// beyond the rectangle does not count.
    pub fn from_tiles(rect: Rect, fill: impl Fn(TileAt, &mut [u8; TILE_AREA]) + Sync) -> Self {
        Self::gather(rect, |at| {
            let mut bytes = blank(0);
            fill(at, &mut bytes);
            clip(&mut bytes, at, rect);
            CoverageTile::new(bytes)
        })
    }

    /// Computes the tiles that a rectangle touches, in parallel.
    pub fn gather(rect: Rect, tile: impl Fn(TileAt) -> Option<Arc<CoverageTile>> + Sync) -> Self {
        let tiles: Vec<TileAt> = TileAt::covering(rect).collect();
        let made: Vec<_> = parallel::map(&tiles, |&at| tile(at));
        let mut grid = Self::for_rect(rect);
        for (at, tile) in tiles.into_iter().zip(made) {
            grid.set(at, tile);
        }
        grid
    }

    /// Every pixel of a rectangle.
    pub fn full(rect: Rect) -> Self {
        Self::gather(rect, |at| {
            if at.rect().intersect(rect) == at.rect() {
                return Some(CoverageTile::whole());
            }
            let mut bytes = blank(u8::MAX);
            clip(&mut bytes, at, rect);
            CoverageTile::new(bytes)
        })
    }

    /// A map whose corner lies at a canvas pixel.
    pub fn from_plane(plane: &Plane<u8>, x: i32, y: i32) -> Self {
        let (width, height) = (plane.width() as i32, plane.height() as i32);
        let rect = Rect::new(x, y, x.saturating_add(width), y.saturating_add(height));
        Self::from_tiles(rect, |at, bytes| {
            let (tile, area) = (at.rect(), at.rect().intersect(rect));
            for py in area.y0..area.y1 {
                let from = &plane.row((py - y) as usize)[(area.x0 - x) as usize..][..area.width()];
                bytes[index(tile, area.x0, py)..][..area.width()].copy_from_slice(from);
            }
        })
    }

    /// The coverage of a rectangle as a map.
    pub fn to_plane(&self, rect: Rect) -> Plane<u8> {
        let mut plane = Plane::full(Size::new(rect.width() as u32, rect.height() as u32), 0u8);
        if rect.is_empty() {
            return plane;
        }
        parallel::for_each_row(plane.values_mut(), rect.width(), 1, |y, row| {
            self.copy_row(rect.x0, rect.y0 + y as i32, row);
        });
        plane
    }

    /// Copies the coverage of a row of pixels from a canvas pixel on; pixels that no tile holds are
    /// left unchanged.
    pub fn copy_row(&self, x0: i32, y: i32, row: &mut [u8]) {
        let line = Rect::new(x0, y, x0.saturating_add(row.len() as i32), y.saturating_add(1));
        for at in TileAt::covering(line) {
            let Some(tile) = self.tile(at) else { continue };
            let area = at.rect().intersect(line);
            let from = &tile.bytes()[index(at.rect(), area.x0, y)..][..area.width()];
            row[(area.x0 - x0) as usize..][..area.width()].copy_from_slice(from);
        }
    }

    /// The coverage of a pixel.
    pub fn at(&self, x: i32, y: i32) -> u8 {
        let at = TileAt::of_pixel(x, y);
        self.tile(at).map_or(0, |tile| tile.bytes()[index(at.rect(), x, y)])
    }

    /// Nothing is covered.
    pub fn is_empty(&self) -> bool {
        self.iter().next().is_none()
    }

    /// The smallest rectangle that holds every pixel that is covered at all.
    pub fn covered_rect(&self) -> Rect {
        self.iter().fold(Rect::EMPTY, |all, (at, tile)| {
            let rect = at.rect();
            // Tiles inside it need no scan.
            if tile.is_whole() || all.intersect(rect) == rect {
                all.union(rect)
            } else {
                all.union(covered_rect(at, tile))
            }
        })
    }

    /// The number of covered pixels, each weighted by its coverage.
    pub fn area_px(&self) -> f64 {
        let sum = |tile: &CoverageTile| tile.bytes().iter().map(|&b| u64::from(b)).sum::<u64>();
        self.iter()
            .map(
                |(_, tile)| {
                    if tile.is_whole() { TILE_AREA as f64 } else { sum(tile) as f64 / 255.0 }
                },
            )
            .sum()
    }

    /// Its bytes if nothing were shared. A wholly covered tile takes none.
    pub fn bytes(&self) -> usize {
        self.iter().filter(|(_, tile)| !tile.is_whole()).count() * (TILE_AREA + 64)
    }

    /// Combines both by a rule for each pixel, over the tiles that either holds. `rule` of 0 and 0
    /// must be 0.
    pub fn combined(&self, other: &Self, rule: impl Fn(u8, u8) -> u8 + Sync) -> Self {
        let rect = self.bounds().union(other.bounds());
        Self::gather(rect, |at| {
            let (a, b) = (self.tile(at), other.tile(at));
            let uniform = |tile: Option<&Arc<CoverageTile>>| match tile {
                None => Some(0),
                Some(tile) => tile.is_whole().then_some(u8::MAX),
            };
            if let (Some(a), Some(b)) = (uniform(a), uniform(b)) {
                match rule(a, b) {
                    0 => return None,
                    u8::MAX => return Some(CoverageTile::whole()),
                    _ => {}
                }
            }
            let none = blank(0);
            let (a, b) =
                (a.map_or(&*none, |tile| tile.bytes()), b.map_or(&*none, |tile| tile.bytes()));
            let mut bytes = blank(0);
            for ((to, a), b) in bytes.iter_mut().zip(a).zip(b) {
                *to = rule(*a, *b);
            }
            CoverageTile::new(bytes)
        })
    }

    /// The uncovered part of a rectangle; nothing beyond it.
    pub fn inverted(&self, rect: Rect) -> Self {
        Self::full(rect).combined(self, |whole, own| whole.saturating_sub(own))
    }

    /// The part within a rectangle.
    pub fn within(&self, rect: Rect) -> Self {
        if self.bounds().intersect(rect) == self.bounds() {
            return self.clone();
        }
        Self::full(rect).combined(self, u8::min)
    }

    /// The same coverage elsewhere: moved by whole pixels, byte for byte.
    pub fn shifted(&self, dx: i32, dy: i32) -> Self {
        let b = self.bounds();
        let moved = |v: i32, d: i32| v.saturating_add(d);
        let to = Rect::new(moved(b.x0, dx), moved(b.y0, dy), moved(b.x1, dx), moved(b.y1, dy));
        Self::from_tiles(to, |at, bytes| {
            for (y, row) in (at.rect().y0..).zip(bytes.as_chunks_mut::<TILE>().0) {
                self.copy_row(moved(at.rect().x0, -dx), moved(y, -dy), row);
            }
        })
    }

    /// Every pixel is covered alike in both.
    pub fn is_same(&self, other: &Self) -> bool {
        let holds = |a: &Self, b: &Self| {
            a.iter().all(|(at, tile)| {
                b.tile(at)
                    .is_some_and(|other| Arc::ptr_eq(tile, other) || tile.bytes() == other.bytes())
            })
        };
        self.ptr_eq(other) || holds(self, other) && holds(other, self)
    }

    /// How opaque the pixels of a paint layer are.
    pub fn of_alpha(pixels: &Grid<Tile>) -> Self {
        Self::gather(pixels.bounds(), |at| {
            let tile = pixels.tile(at)?;
            if tile.is_opaque() {
                return Some(CoverageTile::whole());
            }
            let mut bytes = blank(0);
            bytes.iter_mut().zip(tile.bytes().as_chunks::<4>().0).for_each(|(b, p)| *b = p[3]);
            CoverageTile::new(bytes)
        })
    }
}

/// The index of a pixel among a tile's bytes.
fn index(tile: Rect, x: i32, y: i32) -> usize {
    (y - tile.y0) as usize * TILE + (x - tile.x0) as usize
}

/// Removes what lies beyond a rectangle.
fn clip(bytes: &mut [u8; TILE_AREA], at: TileAt, rect: Rect) {
    let (tile, area) = (at.rect(), at.rect().intersect(rect));
    if area == tile {
        return;
    }
    let columns = (area.x0 - tile.x0).max(0) as usize..(area.x1 - tile.x0).max(0) as usize;
    for (y, row) in (tile.y0..).zip(bytes.as_chunks_mut::<TILE>().0) {
        if y < area.y0 || y >= area.y1 {
            row.fill(0);
        } else {
            row[..columns.start].fill(0);
            row[columns.end..].fill(0);
        }
    }
}

fn covered_rect(at: TileAt, tile: &CoverageTile) -> Rect {
    let (mut x0, mut x1, mut y0, mut y1) = (TILE, 0, TILE, 0);
    for (y, row) in tile.bytes().as_chunks::<TILE>().0.iter().enumerate() {
        let Some(first) = row.iter().position(|&b| b != 0) else { continue };
        let last = row.iter().rposition(|&b| b != 0).unwrap_or(first);
        (x0, x1) = (x0.min(first), x1.max(last + 1));
        (y0, y1) = (y0.min(y), y + 1);
    }
    let corner = at.rect();
    let place = |x: usize, y: usize| (corner.x0 + x as i32, corner.y0 + y as i32);
    let ((x0, y0), (x1, y1)) = (place(x0, y0), place(x1, y1));
    Rect::new(x0, y0, x1, y1)
}

#[cfg(test)]
mod tests;
