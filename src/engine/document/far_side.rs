//! The other sides of a tile's contour pixels, packed into rows: only as many pixels as there
//! are contour pixels (MATH 10). Layers are rendered and composed on them like on a tile. Floor 4.
//! Here: their order and their pixels. Not here: composing them (`compose`), rendering them
//! (`content`).

use crate::math::srgb;
use crate::paint::Scene;
use crate::raster::blend::spec;
use crate::raster::tile::sixteen_bit::{self, Row16};
use crate::raster::{PlanarTile, TILE, Tile, TileAt, TilePaint};
use crate::surface::contours::{ContourPixel, TileContours, place_of};
use std::sync::Arc;

/// The other sides of one tile. Rows of those that see a surface come first; rows of those
/// that see none follow.
#[derive(Clone, Copy)]
pub struct FarTile<'c> {
    pub at: TileAt,
    contours: TileContours<'c>,
}

/// Pixels of a layer as other sides see them: row after row, like a tile's.
pub struct PackedTile {
    pixels: PackedPixels,
    opaque: bool,
}

enum PackedPixels {
    Bytes(Box<[u8]>),
    Rows16(Box<[Row16]>),
}

/// What a layer sees behind a contour, and before it.
#[derive(Clone, Copy)]
pub struct FarScene<'s> {
    pub tile: FarTile<'s>,
    pub front: &'s Scene,
    /// `None` where no other side sees a surface.
    pub far: Option<&'s Scene>,
}

impl<'c> FarTile<'c> {
    pub fn new(at: TileAt, contours: TileContours<'c>) -> Self {
        Self { at, contours }
    }

    fn seen_rows(&self) -> usize {
        self.contours.seen.div_ceil(TILE)
    }

    /// Rows of all.
    pub fn rows(&self) -> usize {
        self.seen_rows() + (self.contours.pixels.len() - self.contours.seen).div_ceil(TILE)
    }

    /// Every contour pixel with its place among the packed ones, row by row.
    pub fn places(&self) -> impl Iterator<Item = (usize, &'c ContourPixel)> + use<'c> {
        let (seen, first_bare) = (self.contours.seen, self.seen_rows() * TILE);
        let place = move |i: usize| if i < seen { i } else { first_bare + i - seen };
        self.contours.pixels.iter().enumerate().map(move |(i, pixel)| (place(i), pixel))
    }

    /// The pixel of the sheet for a place; `None` where no surface is seen.
    pub fn far_pixel(&self, place: usize) -> Option<(usize, usize)> {
        let (x, y) = (place < self.contours.seen).then(|| place_of(place))?;
        Some((self.contours.far.x0 as usize + x, self.contours.far.y0 as usize + y))
    }

    /// Some other side sees no surface.
    pub fn has_bare(&self) -> bool {
        self.contours.seen < self.contours.pixels.len()
    }

    /// One value for each place from its contour pixel; 0 at places that are not used.
    pub fn values(&self, value: impl Fn(usize, &ContourPixel) -> f32) -> Vec<f32> {
        let mut values = vec![0.0; self.rows() * TILE];
        self.places().for_each(|(place, pixel)| values[place] = value(place, pixel));
        values
    }

    /// Packs pixels: those rendered on the sheet and, where no surface is seen, those of the tile
    /// itself.
    pub fn pack(&self, on_far_side: Option<&Tile>, bare: Option<&Tile>) -> PackedTile {
        let corner = self.at.rect();
        self.gather(|place, pixel| {
            let (tile, x, y) = match place < self.contours.seen {
                true => {
                    let (x, y) = place_of(place);
                    (on_far_side, x, y)
                }
                false => (bare, (pixel.x - corner.x0) as usize, (pixel.y - corner.y0) as usize),
            };
            tile.map_or([0; 4], |tile| pixel_of(tile, (x, y)))
        })
    }

    /// The same for pixels that are not rounded to bytes.
    pub fn packed16(
        &self,
        on_far_side: Option<&PlanarTile>,
        bare: Option<&PlanarTile>,
    ) -> PlanarTile {
        let (mut packed, corner) = (PlanarTile::of_rows(self.rows()), self.at.rect());
        for (place, contour) in self.places() {
            let (tile, x, y) = match place < self.contours.seen {
                true => {
                    let (x, y) = place_of(place);
                    (on_far_side, x, y)
                }
                false => (bare, (contour.x - corner.x0) as usize, (contour.y - corner.y0) as usize),
            };
            if let Some(row) = tile.and_then(|tile| tile.rows().get(y)) {
                packed.rows_mut()[place / TILE].set(place % TILE, row.pixel(x));
            }
        }
        packed
    }

    /// Packs the pixels of a tile itself: both sides see the same.
    pub fn same(&self, tile: &Tile) -> PackedTile {
        let corner = self.at.rect();
        let place =
            |pixel: &ContourPixel| ((pixel.x - corner.x0) as usize, (pixel.y - corner.y0) as usize);
        if !tile.is_16_bit() {
            return self.gather(|_, pixel| pixel_of(tile, place(pixel)));
        }
        let mut rows = vec![sixteen_bit::CLEAR_ROW; self.rows()].into_boxed_slice();
        let mut opaque = true;
        for (at, contour) in self.places() {
            let (x, y) = place(contour);
            let pixel = tile.pixel16(x, y);
            opaque &= pixel[3] == u16::MAX;
            sixteen_bit::put(&mut rows[at / TILE], at % TILE, pixel);
        }
        PackedTile { pixels: PackedPixels::Rows16(rows), opaque }
    }

    /// The same for pixels in flight.
    pub fn same_pixels(&self, tile: &PlanarTile) -> PlanarTile {
        let (mut packed, corner) = (PlanarTile::of_rows(self.rows()), self.at.rect());
        for (place, pixel) in self.places() {
            let (x, y) = ((pixel.x - corner.x0) as usize, (pixel.y - corner.y0) as usize);
            if let Some(row) = tile.rows().get(y) {
                packed.rows_mut()[place / TILE].set(place % TILE, row.pixel(x));
            }
        }
        packed
    }

    fn gather(&self, pixel: impl Fn(usize, &ContourPixel) -> [u8; 4]) -> PackedTile {
        let mut bytes = vec![0; self.rows() * TILE * 4].into_boxed_slice();
        let mut opaque = true;
        for (place, contour) in self.places() {
            let pixel = pixel(place, contour);
            opaque &= pixel[3] == 255;
            bytes[place * 4..place * 4 + 4].copy_from_slice(&pixel);
        }
        PackedTile { pixels: PackedPixels::Bytes(bytes), opaque }
    }

    /// Keeps each pixel whole or removes it, as dissolving paint does at its place on the canvas.
    pub fn dissolve(&self, pixels: &mut PlanarTile) {
        for (place, contour) in self.places() {
            let row = &mut pixels.rows_mut()[place / TILE];
            let x = place % TILE;
            row.set(x, spec::dissolve(row.pixel(x), [contour.x, contour.y]));
        }
    }

    /// Mixes both sides of each contour pixel: c · own + (1 − c) · other (MATH 10). Where one
    /// of them sees no surface, the share is an opacity, wherever the pixel's center lies.
    ///
    /// * `brightest`: the straight encoded color above which light is clipped; 1 is white.
    pub fn mix_into(&self, other: &PlanarTile, own: &mut PlanarTile, brightest: f32) {
        let corner = self.at.rect();
        for (place, pixel) in self.places() {
            let from = other.rows()[place / TILE].pixel(place % TILE);
            let (x, y) = ((pixel.x - corner.x0) as usize, (pixel.y - corner.y0) as usize);
            let row = &mut own.rows_mut()[y];
            let to = row.pixel(x);
            if to != from {
                let share = 1.0 - pixel.share;
                let mixed = match pixel.is_between_parts() {
                    true => in_light(to, from, share, brightest),
                    false => mix(to, from, share),
                };
                row.set(x, mixed);
            }
        }
    }
}

impl FarTile<'_> {
    /// As [`FarTile::mix_into`], but where one side alone sees a surface the pixel is wholly
    /// that one's.
    pub fn take_surface_into(&self, other: &PlanarTile, own: &mut PlanarTile) {
        let corner = self.at.rect();
        for (place, pixel) in self.places().filter(|(_, pixel)| pixel.is_other_on_surface()) {
            let from = other.rows()[place / TILE].pixel(place % TILE);
            let (x, y) = ((pixel.x - corner.x0) as usize, (pixel.y - corner.y0) as usize);
            let row = &mut own.rows_mut()[y];
            let taken = match pixel.is_own_on_surface() {
                true => in_light(row.pixel(x), from, 1.0 - pixel.share, 1.0),
                false => from,
            };
            row.set(x, taken);
        }
    }
}

/// A share of one pixel in another, premultiplied: coverage, as opacity.
fn mix(to: [f32; 4], from: [f32; 4], share: f32) -> [f32; 4] {
    std::array::from_fn(|i| to[i] + share * (from[i] - to[i]))
}

/// The same for their light: two parts of one surface are seen side by side.
fn in_light(to: [f32; 4], from: [f32; 4], share: f32, brightest: f32) -> [f32; 4] {
    let light = |p: [f32; 4]| {
        let per_a = 1.0 / p[3].max(f32::MIN_POSITIVE);
        [0, 1, 2].map(|i| srgb::decode((p[i] * per_a).min(brightest)) * p[3])
    };
    let (a, b) = (light(to), light(from));
    let alpha = to[3] + share * (from[3] - to[3]);
    let per_alpha = 1.0 / alpha.max(f32::MIN_POSITIVE);
    let encoded =
        |i: usize| srgb::encode((a[i] + share * (b[i] - a[i])) * per_alpha).min(brightest) * alpha;
    [encoded(0), encoded(1), encoded(2), alpha]
}

fn pixel_of(tile: &Tile, (x, y): (usize, usize)) -> [u8; 4] {
    tile.bytes().as_chunks::<4>().0[y * TILE + x]
}

impl PackedTile {
    pub fn as_paint(&self) -> TilePaint<'_> {
        match &self.pixels {
            PackedPixels::Bytes(bytes) => TilePaint::Bytes(bytes),
            PackedPixels::Rows16(rows) => TilePaint::Rows16(rows),
        }
    }

    /// Bytes that its pixels take.
    pub fn held_bytes(&self) -> u64 {
        match &self.pixels {
            PackedPixels::Bytes(bytes) => bytes.len() as u64,
            PackedPixels::Rows16(rows) => size_of_val::<[Row16]>(rows) as u64,
        }
    }

    /// Every used pixel is opaque.
    pub fn is_opaque(&self) -> bool {
        self.opaque
    }
}

/// What is known about a live layer behind the contours of a tile.
#[derive(Clone)]
pub enum FarPixels {
    /// The same as the tile itself: for strokes that are still being drawn.
    Same,
    Packed(Arc<PackedTile>),
}

impl FarPixels {
    /// Known to be the same pixels.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Same, Self::Same) => true,
            (Self::Packed(a), Self::Packed(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }
}
