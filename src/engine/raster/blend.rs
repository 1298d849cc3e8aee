//! Blend modes: how a layer's color meets the color below it (W3C Compositing and Blending Level
//! 1, and what painting programs have in addition). Floor 1. `modes` is the table: a mode is one
//! row of it, one formula of `spec` and one picture of `tests/goldens`. `spec` reads like the
//! specification; `rows` is fast.

mod bright;
mod modes;
mod rows;
pub mod spec;

use super::planar::{PlanarTile, sane};
use super::tile::sixteen_bit::Row16;
use super::tile::{TILE_AREA, Tile, TileAt};
pub use modes::{BlendMode, blend_pixel};

/// How paint meets what it is painted on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Mix {
    /// How colors are mixed.
    pub mode: BlendMode,
    /// Blend linear light instead of encoded values.
    pub linear: bool,
    /// Only where the backdrop is, without changing its alpha: a clipped layer.
    pub atop: bool,
    /// The tile's corner on the canvas, to which noise is fixed.
    pub corner: [i32; 2],
}

impl Mix {
    /// The same on the tile at this place.
    pub fn on(self, at: TileAt) -> Self {
        let rect = at.rect();
        Self { corner: [rect.x0, rect.y0], ..self }
    }
}

/// What is painted on a tile.
#[derive(Clone, Copy)]
pub enum TilePaint<'a> {
    /// One premultiplied color everywhere.
    Solid([f32; 4]),
    /// Premultiplied bytes, row by row; one row for each that is painted on.
    Bytes(&'a [u8]),
    /// Premultiplied rows of 16 bits; one for each that is painted on.
    Rows16(&'a [Row16]),
    /// Premultiplied floats.
    Planar(&'a PlanarTile),
}

impl<'a> TilePaint<'a> {
    /// Everything that a tile holds.
    pub fn of(tile: &'a Tile) -> Self {
        tile.rows16().map_or_else(|| TilePaint::Bytes(tile.bytes()), TilePaint::Rows16)
    }
}

/// How much of the paint arrives at each pixel of a tile: an opacity times the mask, if there is
/// one.
#[derive(Clone, Debug)]
pub struct TileCoverage {
    opacity: f32,
    /// Values in `[0, 1]`: `TILE_AREA` for a tile.
    mask: Option<Box<[f32]>>,
}

impl TileCoverage {
    /// All of the tile.
    pub const FULL: TileCoverage = TileCoverage { opacity: 1.0, mask: None };

    /// The same everywhere; clamped to `[0, 1]`, NaN is 0.
    pub fn uniform(opacity: f32) -> Self {
        Self { opacity: opacity.max(0.0).min(1.0), mask: None }
    }

    /// Multiplies by a value for each pixel of the tile, row by row; each is clamped to `[0, 1]`,
    /// NaN is 0.
    pub fn times(mut self, value: impl Fn(usize, usize) -> f32) -> Self {
        let mask = self.mask.get_or_insert_with(|| vec![1.0; TILE_AREA].into_boxed_slice());
        for (i, m) in mask.iter_mut().enumerate() {
            *m *= value(i % super::TILE, i / super::TILE).max(0.0).min(1.0);
        }
        self
    }

    /// Multiplies by one value for each pixel of some rows; each is clamped to `[0, 1]`, NaN is 0.
    pub fn times_values(mut self, values: Vec<f32>) -> Self {
        let values = values.into_iter().map(|v| v.max(0.0).min(1.0));
        self.mask = Some(match self.mask {
            Some(mask) => mask.iter().zip(values).map(|(m, v)| m * v).collect(),
            None => values.collect(),
        });
        self
    }

    /// Without the opacity: the mask alone.
    pub fn mask_only(&self) -> Self {
        Self { opacity: 1.0, mask: self.mask.clone() }
    }

    /// Without the mask: the opacity alone.
    pub fn opacity_only(&self) -> Self {
        Self { opacity: self.opacity, mask: None }
    }

    /// Nothing arrives anywhere.
    pub fn is_none(&self) -> bool {
        self.opacity <= 0.0 || self.mask.as_ref().is_some_and(|mask| mask.iter().all(|&m| m <= 0.0))
    }

    /// Everything arrives everywhere.
    pub fn is_full(&self) -> bool {
        self.opacity >= 1.0 && self.mask.as_ref().is_none_or(|mask| mask.iter().all(|&m| m >= 1.0))
    }

    #[inline(always)]
    fn opacity(&self) -> f32 {
        self.opacity
    }

    #[inline(always)]
    fn mask(&self) -> Option<&[f32]> {
        self.mask.as_deref()
    }
}

impl PlanarTile {
    /// The pixels of a tile, if there is one.
    pub fn of_tile(tile: Option<&Tile>) -> Self {
        let mut pixels = Self::transparent();
        if let Some(tile) = tile {
            pixels.blend(Mix::default(), TilePaint::of(tile), &TileCoverage::FULL);
        }
        pixels
    }

    /// Blends paint into the tile. It gives no NaN: paint is finite, and coverage in `[0, 1]`, by
    /// construction.
    pub fn blend(&mut self, mix: Mix, paint: TilePaint<'_>, coverage: &TileCoverage) {
        let paint =
            if let TilePaint::Solid(color) = paint { TilePaint::Solid(sane(color)) } else { paint };
        rows::blend_rows(self.rows_mut(), mix, &paint, coverage);
    }

    /// Moves the tile toward another by a coverage: none leaves it, full replaces it.
    pub fn mix_toward(&mut self, other: &PlanarTile, coverage: &TileCoverage) {
        rows::mix_rows(self.rows_mut(), other.rows(), coverage);
    }
}

#[cfg(test)]
mod tests;
