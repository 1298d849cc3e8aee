//! Contours: where one piece of the surface ends before another, or before nothing. A pixel there
//! is seen by two sides: its own, whose readings the maps hold, and the other, for which the
//! maps are continued from its side (MATH 10). Floor 2. Here: which pixels these are, the share of
//! each side, and where the other one's readings are kept. Not here: mixing both
//! (`document::compose`).

mod both_sides;
mod continued;
mod enlarged;
mod far_side;
mod find;
mod line;
mod maps;
mod moved;
mod plane;
mod rim;
mod shades;
mod window;

#[cfg(test)]
mod tests;

pub use both_sides::FrontSurface;
pub use far_side::{FarSide, place_of};

use crate::math::{Rect, Size, Vec2, Vec3, vec2, vec3};
use crate::raster::TileAt;
use std::ops::Range;

pub(super) use continued::mean_of;
pub(super) use enlarged::EnlargedContours;
pub(super) use find::{Found, find};
pub(super) use line::bits;
pub(super) use maps::ContourMaps;
pub(super) use window::{BESIDE, PixelWindow};

/// A pixel that two sides see.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourPixel {
    /// Canvas pixel.
    pub x: i32,
    /// Its row on the canvas.
    pub y: i32,
    /// The share that its own side sees, `[0, 1]`: the one whose readings the maps hold at
    /// the pixel, or no surface where they hold none.
    pub share: f32,
    /// Its own side sees a surface.
    is_own_on_surface: bool,
    /// Which pixels of the window around it belong to the other side's piece of surface; none
    /// where it sees no surface.
    others: u64,
    /// The middle of what the other side sees, from the pixel's center, px: what is read for
    /// it is read there.
    other_at: Vec2,
    /// How n̄ differs in the middle of what its own side sees from the pixel's center.
    own_turn: Vec2,
}

impl ContourPixel {
    /// The unit normal (camera space) in the middle of what the pixel's own side sees, from
    /// that at its center.
    pub fn own_normal(&self, center: Vec3) -> Vec3 {
        if self.own_turn == Vec2::ZERO || center.z <= 0.0 {
            return center;
        }
        let nbar = continued::shorten_to_rim(vec2(center.x, -center.y) + self.own_turn);
        vec3(nbar.x, -nbar.y, continued::nz_of(nbar))
    }

    /// The other side sees a surface.
    pub fn is_other_on_surface(&self) -> bool {
        self.others != 0
    }

    /// Its own side sees a surface: the mask covers the pixel.
    pub fn is_own_on_surface(&self) -> bool {
        self.is_own_on_surface
    }

    /// Both sides see a surface.
    pub fn is_between_parts(&self) -> bool {
        self.is_own_on_surface && self.is_other_on_surface()
    }
}

/// The contour pixels of a surface, tile by tile.
#[derive(Default)]
pub struct Contours {
    /// Tiles across the canvas.
    columns: i32,
    /// Row by row.
    tiles: Vec<TilePixels>,
    pixels: Vec<ContourPixel>,
    /// Tiles, by their number, of the blocks of rows of the far side.
    far_rows: Vec<Range<u32>>,
}

/// Where a tile's pixels lie among all: those whose other side sees a surface first.
#[derive(Clone, Copy)]
struct TilePixels {
    start: u32,
    seen: u32,
    end: u32,
    /// The first block of rows of the far side.
    far_row: u32,
}

/// The contour pixels of one tile.
#[derive(Clone, Copy)]
pub struct TileContours<'c> {
    /// Those whose other side sees a surface first.
    pub pixels: &'c [ContourPixel],
    /// How many those are.
    pub seen: usize,
    /// Where their readings are on the far side.
    pub far: Rect,
}

impl<'c> TileContours<'c> {
    /// Those in a row of the canvas, in any order.
    pub fn in_row(self, y: i32) -> impl Iterator<Item = &'c ContourPixel> {
        let (seen, bare) = self.pixels.split_at(self.seen);
        let block = |v: i32| v / far_side::BLOCK as i32;
        let from = seen.partition_point(|p| block(p.y) < block(y));
        let beside = seen[from..].iter().take_while(move |p| block(p.y) == block(y));
        let first = bare.partition_point(|p| p.y < y);
        beside.chain(bare[first..].iter().take_while(move |p| p.y == y)).filter(move |p| p.y == y)
    }
}

impl Contours {
    /// The most pixels of a tile whose other side sees a surface; of more, those most evenly
    /// shared are taken. Their readings fill a tile of the far side.
    pub const MOST_SEEN: usize = 1024;

    fn of_tiles(size: Size, found: Vec<Vec<ContourPixel>>) -> Self {
        let columns = size.width.div_ceil(crate::raster::TILE as u32) as i32;
        let mut contours = Self {
            columns,
            tiles: Vec::with_capacity(found.len()),
            pixels: Vec::new(),
            far_rows: Vec::new(),
        };
        for mut tile in found {
            let start = contours.pixels.len();
            far_side::sort(&mut tile);
            let seen = tile.partition_point(ContourPixel::is_other_on_surface);
            let far_row = contours.far_rows.len() as u32;
            contours.pixels.extend(&tile);
            contours.far_rows.extend(far_side::rows(start..start + seen));
            let [start, seen, end] = [start, start + seen, contours.pixels.len()].map(|i| i as u32);
            contours.tiles.push(TilePixels { start, seen, end, far_row });
        }
        contours.pixels.shrink_to_fit();
        contours
    }

    /// There is none.
    pub fn is_empty(&self) -> bool {
        self.pixels.is_empty()
    }

    /// Every contour pixel, tile by tile.
    pub fn pixels(&self) -> &[ContourPixel] {
        &self.pixels
    }

    /// Those of a tile of the canvas; `None` where there are none.
    pub fn on(&self, at: TileAt) -> Option<TileContours<'_>> {
        let is_column = (0..self.columns).contains(&at.col) && at.row >= 0;
        let tile =
            self.tiles.get((at.row * self.columns + at.col) as usize).filter(|_| is_column)?;
        let pixels = &self.pixels[tile.start as usize..tile.end as usize];
        let seen = (tile.seen - tile.start) as usize;
        (!pixels.is_empty()).then(|| TileContours {
            pixels,
            seen,
            far: far_side::rect(tile.far_row, seen),
        })
    }

    /// A pixel of the canvas, if it is one.
    pub fn at(&self, x: i32, y: i32) -> Option<&ContourPixel> {
        self.on(TileAt::of_pixel(x, y))?.in_row(y).find(|pixel| pixel.x == x)
    }

    /// The tiles with pixels whose other side sees a surface.
    pub fn seen_tiles(&self) -> impl Iterator<Item = TileAt> + '_ {
        let columns = self.columns.max(1);
        let at = move |i: usize| TileAt::new(i as i32 % columns, i as i32 / columns);
        self.tiles
            .iter()
            .enumerate()
            .filter(|(_, tile)| tile.seen > tile.start)
            .map(move |(i, _)| at(i))
    }

    /// Bytes that they and the other sides' readings take.
    pub fn bytes(&self) -> u64 {
        let pixels = self.pixels.len() * size_of::<ContourPixel>();
        (pixels + self.far_rows.len() * far_side::COLUMNS * far_side::BLOCK * FarSide::BYTES) as u64
    }
}
