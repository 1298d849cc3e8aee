//! What one stroke lays on one tile, dab by dab, in f32, before its opacity caps it and it meets the layer.
//! Floor 3.

use crate::math::srgb::Color;
use crate::raster::planar::Row;
use crate::raster::tile::TILE_AREA;
use crate::raster::{PlanarTile, TILE};

/// The paint of a stroke, still wet.
pub enum Wash {
    /// Coverage by the stroke's one colour, `[0, 1]`, row by row.
    OneColor(Box<[f32; TILE_AREA]>),
    /// Premultiplied colours of stamps.
    Colors(PlanarTile),
}

impl Wash {
    pub fn one_color() -> Self {
        Wash::OneColor(Box::new([0.0; TILE_AREA]))
    }
    pub fn colors() -> Self {
        Wash::Colors(PlanarTile::transparent())
    }
    /// Coverage of `n` pixels from the `start`th on; nothing of a wash of colours.
    pub fn coverage(&mut self, start: usize, n: usize) -> &mut [f32] {
        match self {
            Wash::OneColor(coverage) => coverage.get_mut(start..start + n).unwrap_or_default(),
            Wash::Colors(_) => &mut [],
        }
    }
    /// Adds a row of a stamp, premultiplied bytes, from the `start`th pixel on: a ← a + f (1 − a), f = flow · F.
    pub fn stamp(&mut self, start: usize, stamped: &[[u8; 4]], flow: f32) {
        match self {
            Wash::OneColor(_) => add_coverage(stamped, flow / 255.0, self.coverage(start, stamped.len())),
            Wash::Colors(tile) => {
                if let Some(row) = tile.rows_mut().get_mut(start / TILE) {
                    add_colors(stamped, flow / 255.0, start % TILE, row);
                }
            }
        }
    }
    /// Lays the dried paint over pixels (source over). Of stamps only the colour's alpha counts.
    pub fn lay_over(&self, pixels: &mut PlanarTile, color: Color, opacity: f32) {
        match self {
            Wash::OneColor(coverage) => {
                let color = color.premultiplied().map(|c| c * opacity);
                for (coverage, row) in coverage.as_chunks::<TILE>().0.iter().zip(pixels.rows_mut()) {
                    lay_coverage(coverage, color, row);
                }
            }
            Wash::Colors(tile) => {
                let opacity = opacity * f32::from(color.a) / 255.0;
                for (from, row) in tile.rows().iter().zip(pixels.rows_mut()) {
                    lay_colors(from, opacity, row);
                }
            }
        }
    }
}

crate::widest! {
    fn add_coverage(stamped: &[[u8; 4]], flow: f32, coverage: &mut [f32]) {
        for (a, s) in coverage.iter_mut().zip(stamped) {
            *a += flow * f32::from(s[3]) * (1.0 - *a);
        }
    }
    /// `x`: column of the first pixel.
    fn add_colors(stamped: &[[u8; 4]], flow: f32, x: usize, row: &mut Row) {
        for (c, plane) in row.rgb.iter_mut().chain([&mut row.a]).enumerate() {
            for (p, s) in plane[x..].iter_mut().zip(stamped) {
                *p = *p * (1.0 - flow * f32::from(s[3])) + flow * f32::from(s[c]);
            }
        }
    }
    /// Lays one premultiplied colour over a row, as far as each pixel is covered.
    fn lay_coverage(coverage: &[f32; TILE], color: [f32; 4], row: &mut Row) {
        for (plane, c) in row.rgb.iter_mut().chain([&mut row.a]).zip(color) {
            for (p, a) in plane.iter_mut().zip(coverage) {
                *p = *p * (1.0 - color[3] * a) + c * a;
            }
        }
    }
    fn lay_colors(from: &Row, opacity: f32, row: &mut Row) {
        for (plane, over) in row.rgb.iter_mut().chain([&mut row.a]).zip(from.rgb.iter().chain([&from.a])) {
            for ((p, s), a) in plane.iter_mut().zip(over).zip(&from.a) {
                *p = *p * (1.0 - opacity * a) + opacity * s;
            }
        }
    }
}
