//! Paint and pictures whose numbers become those of another color profile. Floor 1. Not here: the
//! conversion of a color (`math::color_profile`), what of a document holds colors (`document`).

use crate::math::ProfileConversion;
use crate::math::parallel;
use crate::raster::picture::Texels;
use crate::raster::tile::sixteen_bit::{self, Row16};
use crate::raster::{Picture, TILE, Tile, TileAt, TileGrid};
use std::sync::Arc;

/// Converts the texels of a run: neighbors are often of one color, and the curve is costly.
fn convert_run<T: Copy + PartialEq>(
    texels: impl Iterator<Item = T>,
    mut convert: impl FnMut(T) -> T,
) -> Vec<T> {
    let mut last: Option<(T, T)> = None;
    let one = |texel: T| match last {
        Some((from, to)) if from == texel => to,
        _ => {
            let to = convert(texel);
            last = Some((texel, to));
            to
        }
    };
    texels.map(one).collect()
}

impl TileGrid {
    /// The same colors in the numbers of another profile, each tile with as many bits as before;
    /// and whether the other profile lacks some of them, which are then clamped.
    pub fn converted(&self, by: &ProfileConversion) -> (TileGrid, bool) {
        let all: Vec<(TileAt, &Arc<Tile>)> = self.iter().collect();
        let made: Vec<(TileAt, Option<Tile>, bool)> = parallel::map(&all, |(at, tile)| {
            let (tile, is_clamped) = convert_tile(tile, by);
            (*at, tile, is_clamped)
        });
        let mut next = TileGrid::for_rect(self.bounds());
        let is_clamped = made.iter().any(|(.., is_clamped)| *is_clamped);
        made.into_iter().for_each(|(at, tile, _)| next.set(at, tile.map(Arc::new)));
        (next, is_clamped)
    }
}

fn convert_tile(tile: &Tile, by: &ProfileConversion) -> (Option<Tile>, bool) {
    let mut is_clamped = false;
    let Some(rows) = tile.rows16() else {
        let texels = tile.bytes().as_chunks::<4>().0.iter().copied();
        let bytes = convert_run(texels, |t| by.premultiplied_noting(t, &mut is_clamped));
        return (Tile::from_pixels(bytes.into_flattened()), is_clamped);
    };
    let mut next: Box<[Row16]> = sixteen_bit::clear_rows();
    for (y, next) in next.iter_mut().enumerate() {
        let texels = (0..TILE).map(|x| sixteen_bit::pixel_of(rows, x, y));
        let convert = |texel| {
            let straight = by.texel16(sixteen_bit::straight(texel), &mut is_clamped);
            sixteen_bit::premultiplied(straight)
        };
        for (x, texel) in convert_run(texels, convert).into_iter().enumerate() {
            sixteen_bit::put(next, x, texel);
        }
    }
    (Tile::from_rows16(next), is_clamped)
}

impl Picture {
    /// The same colors in the numbers of another profile, without the file and the drawing that
    /// they came from; a picture that stays the same keeps both. And whether the other profile
    /// lacks some of them, which are then clamped.
    pub fn converted(&self, by: &ProfileConversion) -> (Picture, bool) {
        let mut is_clamped = false;
        let made = match (&self.texels, &self.texels16) {
            (Texels::Srgb8(_), Some(texels16)) => {
                let texels = texels16.iter().copied();
                let next = convert_run(texels, |texel| by.texel16(texel, &mut is_clamped));
                (next[..] != texels16[..]).then(|| Picture::srgb16(self.size, next))
            }
            (Texels::Srgb8(texels), None) => {
                let of = texels.iter().copied();
                let next = convert_run(of, |texel| by.texel8(texel, &mut is_clamped));
                (next[..] != texels[..]).then(|| Picture::srgb8(self.size, next))
            }
            (Texels::Linear(texels), _) => {
                let next = convert_run(texels.iter().copied(), |[r, g, b, a]| {
                    let [r, g, b] = if r == g && g == b { [r, g, b] } else { by.light([r, g, b]) };
                    [r, g, b, a]
                });
                (next[..] != texels[..]).then(|| Picture::linear(self.size, next))
            }
        };
        (made.flatten().unwrap_or_else(|| self.clone()), is_clamped)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{ColorProfile, Size};

    fn to_p3() -> &'static ProfileConversion {
        ColorProfile::Srgb.conversion_to(ColorProfile::DisplayP3).unwrap()
    }

    fn to_srgb() -> &'static ProfileConversion {
        ColorProfile::DisplayP3.conversion_to(ColorProfile::Srgb).unwrap()
    }

    #[test]
    fn paint_of_both_depths_is_converted_and_comes_back() {
        let pixel = |i: usize| [30 + i as u16 * 7, 9000, 60000 - i as u16, 40000 + i as u16];
        let pixels: Vec<[u16; 4]> = (0..100 * 3).map(pixel).collect();
        let fine = TileGrid::from_straight16(&pixels, 100, 3, -5, 60);
        let (there, _) = fine.converted(to_p3());
        assert!(there.is_16_bit_in(there.bounds()) && there.bounds() == fine.bounds());
        let (back, _) = there.converted(to_srgb());
        for (x, y) in [(-5, 60), (20, 61), (94, 62)] {
            let (a, b) = (fine.pixel16(x, y), back.pixel16(x, y));
            assert!((0..4).all(|c| a[c].abs_diff(b[c]) <= 30), "{a:?} {b:?}");
        }
        let red = TileGrid::from_straight_rgba(&[255, 0, 0, 255].repeat(6), 3, 2, 1, 1);
        let (there, is_clamped) = red.converted(to_p3());
        assert_eq!((there.pixel(2, 2), is_clamped), ([234, 51, 35, 255], false));
        assert_eq!(there.pixel(0, 0), [0; 4]);
        assert!(red.converted(to_srgb()).1, "sRGB lacks the red of Display P3");
    }

    #[test]
    fn a_picture_that_changes_loses_its_file_and_a_gray_one_keeps_it() {
        let made = |texel: [u8; 4]| {
            let picture = Picture::srgb8(Size::new(2, 1), vec![texel; 2]).unwrap();
            Picture { encoded: Some(vec![1].into()), ..picture }
        };
        let (red, _) = made([255, 0, 0, 9]).converted(to_p3());
        assert_eq!(red.texels, Texels::Srgb8(vec![[234, 51, 35, 9]; 2].into()));
        assert!(red.encoded.is_none());
        assert!(made([7, 7, 7, 255]).converted(to_p3()).0.encoded.is_some());
        let light = Picture::linear(Size::new(1, 1), vec![[9.0, 0.0, 0.0, 1.0]]).unwrap();
        let found = light.converted(to_p3()).0.linear_at(0, 0);
        assert!((found[0] - 9.0 * 0.822_462).abs() < 1e-3 && found[2] > 0.1, "{found:?}");
        let fine = Picture::srgb16(Size::new(1, 1), vec![[65535, 0, 0, 65535]]).unwrap();
        let (fine, _) = fine.converted(to_p3());
        assert_eq!(fine.texels, Texels::Srgb8(vec![[234, 51, 35, 255]].into()));
        assert!(fine.is_16_bit());
    }
}
