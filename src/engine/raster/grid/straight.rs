//! Pixels with straight alpha, as files hold them, cut into tiles and back. Floor 1.

use super::super::tile::{TILE, Tile, TileAt, sixteen_bit};
use super::TileGrid;
use crate::math::{Rect, parallel, srgb};
use std::sync::Arc;

impl TileGrid {
    /// Cuts straight-alpha RGBA bytes (`width · height · 4`, row by row) into premultiplied tiles,
    /// at a canvas offset.
    pub fn from_straight_rgba(rgba: &[u8], width: usize, height: usize, x: i32, y: i32) -> Self {
        let rect = Rect::new(x, y, x.saturating_add(width as i32), y.saturating_add(height as i32));
        let mut grid = Self::for_rect(rect);
        for at in TileAt::covering(rect) {
            let area = at.rect().intersect(rect);
            let mut bytes = vec![0u8; TILE * TILE * 4];
            for py in area.y0..area.y1 {
                let from = ((py - y) as usize * width + (area.x0 - x) as usize) * 4;
                let to =
                    ((py - at.rect().y0) as usize * TILE + (area.x0 - at.rect().x0) as usize) * 4;
                let n = area.width() * 4;
                premultiply(&rgba[from..from + n], &mut bytes[to..to + n]);
            }
            if bytes.iter().any(|&b| b != 0) {
                grid.set(at, Tile::from_bytes(bytes).map(Arc::new));
            }
        }
        grid
    }

    /// The same for straight values of 16 bits; tiles that bytes hold exactly become tiles of
    /// bytes.
    pub fn from_straight16(rgba: &[[u16; 4]], width: usize, height: usize, x: i32, y: i32) -> Self {
        Self::from_straight_rows16(rgba, [width, height], [x, y], sixteen_bit::premultiplied)
    }

    /// The same for straight linear light, which is clipped to white, encoded and premultiplied
    /// before it is rounded.
    pub fn from_light(light: &[[f32; 4]], width: usize, height: usize, x: i32, y: i32) -> Self {
        Self::from_straight_rows16(light, [width, height], [x, y], |[r, g, b, a]| {
            // In this order NaN becomes 0.
            let bounded = |v: f32| v.max(0.0).min(1.0);
            let a = bounded(a);
            let encoded = |v: f32| srgb::quantize16(srgb::encode(bounded(v)) * a);
            [encoded(r), encoded(g), encoded(b), srgb::quantize16(a)]
        })
    }

    /// `of`: a pixel's premultiplied 16 bits; colors above alpha are lowered to it.
    fn from_straight_rows16<T: Copy + Sync>(
        pixels: &[T],
        [width, height]: [usize; 2],
        [x, y]: [i32; 2],
        of: impl Fn(T) -> [u16; 4] + Sync,
    ) -> Self {
        let rect = Rect::new(x, y, x.saturating_add(width as i32), y.saturating_add(height as i32));
        let tile = |at: TileAt| {
            let (area, corner) = (at.rect().intersect(rect), at.rect());
            let mut rows = sixteen_bit::clear_rows();
            for py in area.y0..area.y1 {
                let from = (py - y) as usize * width + (area.x0 - x) as usize;
                let row = &mut rows[(py - corner.y0) as usize];
                let pixels =
                    pixels[from..from + area.width()].iter().zip((area.x0 - corner.x0) as usize..);
                pixels.for_each(|(pixel, x)| sixteen_bit::put(row, x, of(*pixel)));
            }
            (at, Tile::from_rows16(rows).map(Arc::new))
        };
        let tiles = parallel::map(TileAt::covering(rect), tile);
        let mut grid = Self::for_rect(rect);
        tiles.into_iter().for_each(|(at, tile)| grid.set(at, tile));
        grid
    }

    /// Straight-alpha RGBA bytes of a pixel rectangle, row by row.
    pub fn to_straight_rgba(&self, rect: Rect) -> Vec<u8> {
        let mut out = vec![0u8; rect.width() * rect.height() * 4];
        for at in TileAt::covering(rect) {
            let Some(tile) = self.tile(at) else { continue };
            let area = at.rect().intersect(rect);
            for py in area.y0..area.y1 {
                let from =
                    ((py - at.rect().y0) as usize * TILE + (area.x0 - at.rect().x0) as usize) * 4;
                let to =
                    ((py - rect.y0) as usize * rect.width() + (area.x0 - rect.x0) as usize) * 4;
                let n = area.width() * 4;
                unpremultiply(&tile.bytes()[from..from + n], &mut out[to..to + n]);
            }
        }
        out
    }

    /// The same in 16 bits, whatever the tiles hold; [`TileGrid::from_straight16`] is the exact
    /// inverse.
    pub fn to_straight16(&self, rect: Rect) -> Vec<[u16; 4]> {
        let mut out = vec![[0; 4]; rect.width() * rect.height()];
        for at in TileAt::covering(rect) {
            let Some(tile) = self.tile(at) else { continue };
            let (area, corner) = (at.rect().intersect(rect), at.rect());
            for py in area.y0..area.y1 {
                let to = (py - rect.y0) as usize * rect.width() + (area.x0 - rect.x0) as usize;
                let y = (py - corner.y0) as usize;
                let pixels =
                    out[to..to + area.width()].iter_mut().zip((area.x0 - corner.x0) as usize..);
                pixels.for_each(|(pixel, x)| *pixel = sixteen_bit::straight(tile.pixel16(x, y)));
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
            // 255 for alpha, which times alpha gives alpha.
            let whole = [s[0], s[1], s[2], 255];
            let a = u32::from(s[3]);
            *p = whole.map(|c| ((u32::from(c) * a + 127) / 255) as u8);
        }
    }

    /// Premultiplied bytes to straight bytes, rounded to nearest; transparent pixels become
    /// transparent black.
    pub fn unpremultiply(premultiplied: &[u8], straight: &mut [u8]) {
        let pixels = premultiplied.as_chunks::<4>().0;
        // Most paint is opaque, where both are the same.
        if pixels.iter().fold(255, |least, p| p[3].min(least)) == 255 {
            straight[..premultiplied.len()].copy_from_slice(premultiplied);
            return;
        }
        for (p, s) in pixels.iter().zip(straight.as_chunks_mut::<4>().0) {
            let a = i32::from(p[3]);
            // For numbers below 2¹⁶ a rounded-down f32 quotient is the integer quotient.
            let over = a.max(1) as f32;
            let held = if a == 0 { 0 } else { 255 };
            for c in 0..3 {
                s[c] = (((i32::from(p[c]) * 255 + a / 2) as f32 / over) as i32).min(held) as u8;
            }
            s[3] = p[3];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash;

    #[test]
    fn a_picture_cut_into_tiles_comes_back_whole() {
        let (w, h) = (130, 70);
        let rgba: Vec<u8> = (0..w * h)
            .flat_map(|i| [(i % 251) as u8, (i % 83) as u8, (i % 7) as u8, 255])
            .collect();
        let grid = TileGrid::from_straight_rgba(&rgba, w, h, -5, 3);
        assert_eq!(grid.to_straight_rgba(Rect::new(-5, 3, 125, 73)), rgba);
        assert_eq!(grid.pixel(-6, 3), [0; 4]);
    }

    #[test]
    fn straight_and_premultiplied_bytes_are_rounded_to_nearest() {
        let all: Vec<[u8; 4]> =
            (0..=255u8).flat_map(|a| (0..=255u8).map(move |c| [c, 255 - c, c / 2, a])).collect();
        let (mut premultiplied, mut straight) = (vec![0; all.len() * 4], vec![0; all.len() * 4]);
        premultiply(all.as_flattened(), &mut premultiplied);
        unpremultiply(all.as_flattened(), &mut straight);
        for ((of, p), s) in
            all.iter().zip(premultiplied.as_chunks::<4>().0).zip(straight.as_chunks::<4>().0)
        {
            let a = u32::from(of[3]);
            for c in 0..3 {
                let v = u32::from(of[c]);
                assert_eq!(u32::from(p[c]), (v * a + 127) / 255, "{of:?}");
                assert_eq!(
                    u32::from(s[c]),
                    if a == 0 { 0 } else { ((v * 255 + a / 2) / a).min(255) },
                    "{of:?}"
                );
            }
            assert_eq!((p[3], s[3]), (of[3], of[3]));
        }
        let opaque: Vec<u8> = (0..=255).flat_map(|c| [c, 255 - c, c / 2, 255]).collect();
        let mut straight = vec![0; opaque.len()];
        unpremultiply(&opaque, &mut straight);
        assert_eq!(straight, opaque);
    }

    #[test]
    fn light_becomes_16_bits_that_round_to_the_bytes_of_a_texture() {
        use crate::math::Size;
        use crate::raster::{Picture, Texture};
        let (w, h) = (70, 66);
        let light = |i: usize, c: u32| hash::unit(i as u32, c, 7) * 1.3 - 0.1;
        let mut texels: Vec<[f32; 4]> =
            (0..w * h).map(|i| [0, 1, 2, 3].map(|c| light(i, c))).collect();
        texels[0] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1.0];
        texels[1] = [1.0, 1.0, 1.0, f32::NAN];
        let grid = TileGrid::from_light(&texels, w, h, -3, 5);
        assert_eq!((grid.pixel16(-3, 5), grid.pixel16(-2, 5)), ([0, 65535, 0, 65535], [0; 4]));
        let texture =
            Texture::new(&Picture::linear(Size::new(w as u32, h as u32), texels.clone()).unwrap());
        for (i, bytes) in texture.levels()[0].texels.iter().enumerate().skip(2) {
            let (x, y) = ((i % w) as i32 - 3, (i / w) as i32 + 5);
            let pixel16 = grid.pixel16(x, y);
            let alpha = texels[i][3].clamp(0.0, 1.0);
            for c in 0..3 {
                let exact = srgb::encode(texels[i][c].clamp(0.0, 1.0)) * alpha * 65535.0;
                assert!(
                    (f32::from(pixel16[c]) - exact).abs() <= 0.51,
                    "{pixel16:?} for {:?}",
                    texels[i]
                );
            }
            // Rounded twice: a value near the middle between two bytes may become the other.
            let apart = |(d, b): (&u16, &u8)| (i32::from(*d) - i32::from(*b) * 257).abs();
            assert!(
                pixel16.iter().zip(bytes).map(apart).max() <= Some(129),
                "{pixel16:?} and {bytes:?}"
            );
        }
        assert!(grid.is_16_bit_in(grid.bounds()));
        // Light that bytes hold exactly takes no more than bytes.
        let plain: Vec<[f32; 4]> =
            (0..w * h).map(|i| [srgb::decode_u8((i % 256) as u8), 0.0, 1.0, 1.0]).collect();
        let plain = TileGrid::from_light(&plain, w, h, 0, 0);
        assert!(!plain.is_16_bit_in(plain.bounds()));
    }

    #[test]
    fn rounded_pixels_are_the_bytes_that_were_seen() {
        let value = |i: usize, c: u32| (hash::unit(i as u32, c, 0) * 65536.0) as u16;
        let pixels: Vec<[u16; 4]> =
            (0..130 * 70).map(|i| [0, 1, 2, 3].map(|c| value(i, c))).collect();
        let grid = TileGrid::from_straight16(&pixels, 130, 70, 0, 0);
        let rounded = grid.rounded();
        assert!(grid.is_16_bit_in(grid.bounds()) && !rounded.is_16_bit_in(rounded.bounds()));
        assert!(grid.iter().all(|(at, tile)| rounded.tile(at).unwrap().bytes() == tile.bytes()));
        assert_eq!(
            TileGrid::from_straight16(&[[9, 9, 9, 100]; 4], 2, 2, 0, 0).rounded().iter().count(),
            0
        );
    }

    #[test]
    fn pixels_of_16_bits_come_back_and_take_more_only_where_bytes_do_not_hold_them() {
        let (w, h) = (130, 70);
        let value = |i: usize, c: u32| (hash::unit(i as u32, c, 0) * 65536.0) as u16;
        let soft = |i: usize| [value(i, 0), value(i, 1), value(i, 2), value(i, 3)];
        let pixels: Vec<[u16; 4]> = (0..w * h)
            .map(|i| if i % w < 59 { [257 * (i % 97) as u16, 257, 0, 65535] } else { soft(i) })
            .collect();
        let grid = TileGrid::from_straight16(&pixels, w, h, -59, 3);
        let rect = Rect::new(-59, 3, 71, 73);
        let straight = grid.to_straight16(rect);
        let again = TileGrid::from_straight16(&straight, w, h, -59, 3);
        for (at, tile) in grid.iter() {
            assert!(again.tile(at).unwrap().is_same(tile), "{at:?}");
            assert_eq!(tile.is_16_bit(), at.col >= 0, "{at:?}");
        }
        assert_eq!(grid.bytes(), 2 * 16384 + 4 * 49152 + 6 * 8);
        for (x, y) in [(-59, 3), (-1, 40), (0, 70), (70, 72)] {
            let [_, _, _, a] = pixels[(y - 3) as usize * w + (x + 59) as usize];
            assert_eq!(grid.pixel16(x, y)[3], a);
        }
        // Moved, or joined from parts, they are the same.
        let moved = grid.translated(37, -101);
        assert!(moved.to_straight16(Rect::new(-22, -98, 108, -28)) == straight);
        let mut joined = TileGrid::from_straight16(&pixels[..w * 30], w, 30, -59, 3);
        joined.join(&TileGrid::from_straight16(&pixels[w * 30..], w, h - 30, -59, 33));
        assert!(joined.to_straight16(rect) == straight);
    }
}
