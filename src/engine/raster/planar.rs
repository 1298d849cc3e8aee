//! Pixels in flight while a picture is flattened: one tile, f32, premultiplied, each channel of a
//! row separate so that loops over a row need no shuffles. Floor 1. Stored pixels are `tile`; how
//! they mix is `blend`.

use super::tile::sixteen_bit::{self, Row16};
use super::tile::{TILE, TILE_AREA, Tile, TileF32};
use crate::math::srgb::quantize;

/// A premultiplied pixel brought into range: alpha in `[0, 1]`, colors in `[0, alpha]`, NaN 0.
#[inline(always)]
pub fn sane(p: [f32; 4]) -> [f32; 4] {
    let a = p[3].max(0.0).min(1.0);
    [p[0].max(0.0).min(a), p[1].max(0.0).min(a), p[2].max(0.0).min(a), a]
}

/// One row of a tile, premultiplied, encoded. A KiB, so that a row and what is mixed into it stay
/// in the first-level cache.
#[derive(Clone, Copy)]
pub struct PixelRow {
    /// Red, green, blue, each in `[0, alpha]`; above alpha only if a picture keeps light that is
    /// brighter than white.
    pub rgb: [[f32; TILE]; 3],
    /// Alpha, `[0, 1]`.
    pub a: [f32; TILE],
}

impl PixelRow {
    /// A row without paint.
    pub const TRANSPARENT: PixelRow = PixelRow { rgb: [[0.0; TILE]; 3], a: [0.0; TILE] };
}

/// The brightest encoded color: light that a half float still holds is below it.
pub const BRIGHTEST: f32 = 128.0;

/// A tile of accumulated pixels.
#[derive(Clone)]
pub struct PlanarTile {
    rows: Vec<PixelRow>,
}

impl PlanarTile {
    /// A tile without paint.
    pub fn transparent() -> Self {
        Self::of_rows(TILE)
    }

    /// Fewer or more rows than a tile has, transparent.
    pub fn of_rows(rows: usize) -> Self {
        Self { rows: vec![PixelRow::TRANSPARENT; rows] }
    }

    /// Reads pixels; values that are out of range or NaN are brought into range.
    pub fn from_pixels(pixels: &TileF32) -> Self {
        let mut tile = Self::transparent();
        for (row, pixels) in tile.rows.iter_mut().zip(pixels.chunks_exact(TILE)) {
            for (x, &p) in pixels.iter().enumerate() {
                let [r, g, b, a] = sane(p);
                (row.rgb[0][x], row.rgb[1][x], row.rgb[2][x], row.a[x]) = (r, g, b, a);
            }
        }
        tile
    }

    /// The same, but colors may be brighter than white: above alpha.
    pub fn from_bright(pixels: &TileF32) -> Self {
        let mut tile = Self::transparent();
        for (row, pixels) in tile.rows.iter_mut().zip(pixels.chunks_exact(TILE)) {
            for (x, [r, g, b, a]) in pixels.iter().enumerate() {
                let bounded = |v: f32| v.max(0.0).min(BRIGHTEST);
                let PixelRow { rgb: [red, green, blue], a: alpha } = row;
                (red[x], green[x], blue[x], alpha[x]) =
                    (bounded(*r), bounded(*g), bounded(*b), a.max(0.0).min(1.0));
            }
        }
        tile
    }

    /// Lowers colors that are brighter than white to white.
    pub fn clip_to_white(&mut self) {
        for PixelRow { rgb, a } in &mut self.rows {
            for channel in rgb {
                channel.iter_mut().zip(a.iter()).for_each(|(v, a)| *v = v.min(*a));
            }
        }
    }

    /// Gives every pixel that is there its straight color, wholly opaque.
    pub fn make_opaque(&mut self) {
        for PixelRow { rgb, a } in &mut self.rows {
            for channel in rgb {
                for (v, &a) in channel.iter_mut().zip(a.iter()).filter(|(_, a)| **a > 0.0) {
                    *v = (*v / a).min(BRIGHTEST);
                }
            }
            a.iter_mut().filter(|a| **a > 0.0).for_each(|a| *a = 1.0);
        }
    }

    /// Writes every pixel out.
    pub fn to_pixels(&self, pixels: &mut TileF32) {
        for (row, pixels) in self.rows.iter().zip(pixels.chunks_exact_mut(TILE)) {
            for (x, p) in pixels.iter_mut().enumerate() {
                *p = row.pixel(x);
            }
        }
    }

    /// The rows, `TILE` for a tile, the top one first.
    pub fn rows(&self) -> &[PixelRow] {
        &self.rows
    }

    /// Its rows, to be painted on.
    pub fn rows_mut(&mut self) -> &mut [PixelRow] {
        &mut self.rows
    }

    /// Rounds to bytes; `None` where the tile is wholly transparent.
    pub fn quantize(&self) -> Option<Tile> {
        let mut bytes = vec![0u8; TILE_AREA * 4];
        quantize_rows(&self.rows, &mut bytes);
        if bytes.chunks_exact(4).all(|p| p[3] == 0) {
            return None;
        }
        Tile::from_bytes(bytes)
    }

    /// As a paint layer keeps it, painted on `was`: rounded to 16 bits if it is smooth
    /// ([`sixteen_bit::is_smooth`]) or had them before, else to bytes. `None` if the tile is wholly
    /// transparent.
    pub fn to_tile_over(&self, was: Option<&Tile>) -> Option<Tile> {
        self.to_tile(was.is_some_and(Tile::is_16_bit))
    }

    /// The same; `was_16_bit`: the pixels contain paint of 16 bits.
    pub fn to_tile(&self, was_16_bit: bool) -> Option<Tile> {
        let put = |y: usize, rows16: &mut Row16| {
            let PixelRow { rgb: [r, g, b], a } = &self.rows[y];
            sixteen_bit::quantize_row([r, g, b, a], rows16);
        };
        if self.rows.len() != TILE || !(was_16_bit || sixteen_bit::is_smooth(put)) {
            return self.quantize();
        }
        let mut rows = sixteen_bit::clear_rows();
        rows.iter_mut().enumerate().for_each(|(y, row)| put(y, row));
        Tile::from_rows16(rows)
    }
}

impl PixelRow {
    /// One premultiplied pixel; `x < TILE`.
    #[inline(always)]
    pub fn pixel(&self, x: usize) -> [f32; 4] {
        [self.rgb[0][x], self.rgb[1][x], self.rgb[2][x], self.a[x]]
    }

    /// Writes one premultiplied pixel; `x < TILE`.
    #[inline(always)]
    pub fn set(&mut self, x: usize, pixel: [f32; 4]) {
        let [r, g, b] = &mut self.rgb;
        [r[x], g[x], b[x], self.a[x]] = pixel;
    }
}

crate::widest! {
    /// Rounds rows to premultiplied bytes, `4 · TILE` a row.
    fn quantize_rows(rows: &[PixelRow], bytes: &mut [u8]) {
        for (row, bytes) in rows.iter().zip(bytes.chunks_exact_mut(4 * TILE)) {
            let PixelRow { rgb: [r, g, b], a } = row;
            let mut packed = [0u32; TILE];
            for x in 0..TILE {
                packed[x] = byte(r[x]) | byte(g[x]) << 8 | byte(b[x]) << 16 | byte(a[x]) << 24;
            }
            for (bytes, packed) in bytes.chunks_exact_mut(4).zip(packed) {
                bytes.copy_from_slice(&packed.to_le_bytes());
            }
        }
    }
}

#[inline(always)]
fn byte(value: f32) -> u32 {
    u32::from(quantize(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_go_in_and_out_unchanged() {
        let byte = |i: usize, c: usize| ((i * 7 + c * 31) % 256) as u8;
        let pixels: Vec<[f32; 4]> = (0..TILE_AREA)
            .map(|i| {
                let a = byte(i, 3);
                [0, 1, 2, 3].map(|c| f32::from(if c == 3 { a } else { byte(i, c).min(a) }) / 255.0)
            })
            .collect();
        let pixels: Box<TileF32> = pixels.into_boxed_slice().try_into().unwrap();
        let planar = PlanarTile::from_pixels(&pixels);
        let tile = planar.quantize().unwrap();
        for (i, p) in tile.bytes().chunks_exact(4).enumerate() {
            assert_eq!(p[3], byte(i, 3));
            assert_eq!(p[0], byte(i, 0).min(byte(i, 3)));
        }
        let mut back = super::super::tile::transparent_f32();
        planar.to_pixels(&mut back);
        assert_eq!(back[..], pixels[..]);
    }

    #[test]
    fn nan_and_colors_beyond_their_alpha_do_not_get_in() {
        let mut pixels = super::super::tile::transparent_f32();
        pixels[0] = [f32::NAN, f32::INFINITY, -1.0, 0.5];
        pixels[1] = [0.5, 0.5, 0.5, f32::NAN];
        let planar = PlanarTile::from_pixels(&pixels);
        assert_eq!(planar.rows()[0].pixel(0), [0.0, 0.5, 0.0, 0.5]);
        assert_eq!(planar.rows()[0].pixel(1), [0.0; 4]);
    }
}
