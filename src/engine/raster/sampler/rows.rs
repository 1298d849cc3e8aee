//! Bilinear taps for whole rows.
//! Floor 1.

use super::taps::{TapPositions, Taps};
use crate::raster::{Outside, Texture};

/// Scratch for bilinear rows, kept from row to row.
#[derive(Default)]
pub struct Bilinear {
    taps: Taps,
}

impl Bilinear {
    /// The picture's premultiplied bytes at each position (`x`, `y`; texels), rounded: one pixel of
    /// `out` for each.
    pub fn row(
        &mut self,
        texture: &Texture,
        x: &[f32],
        y: &[f32],
        outside: Outside,
        out: &mut [[u8; 4]],
    ) {
        // Pixels in flight: their taps stay in the first-level cache.
        const SPAN: usize = 256;
        for ((x, y), out) in x.chunks(SPAN).zip(y.chunks(SPAN)).zip(out.chunks_mut(SPAN)) {
            let at = TapPositions { level: &texture.levels()[0], x, y, outside };
            self.taps.find(at);
            self.taps.singles(at, out);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, hash, vec2};
    use crate::raster::Picture;

    fn noise(size: Size) -> Texture {
        let texel = |i| {
            let byte = |c| (hash::unit(1, i, c) * 256.0) as u8;
            [byte(0), byte(1), byte(2), byte(3)]
        };
        Texture::new(&Picture::srgb8(size, (0..size.area() as u32).map(texel).collect()).unwrap())
    }

    #[test]
    fn rows_equal_the_reference_inside_at_the_border_and_far_beyond() {
        for size in [Size::new(13, 9), Size::new(2, 2), Size::new(1, 5), Size::new(1, 1)] {
            let texture = noise(size);
            for outside in [Outside::None, Outside::Clamp, Outside::Repeat, Outside::Mirror] {
                let at = |i: u32, spread: f32| (hash::unit(2, i, 0) - 0.5) * spread;
                let spread = |i: u32| [12.0, 40.0, 40.0, 3000.0][i as usize % 4];
                let x: Vec<f32> = (0..2000).map(|i| at(i, spread(i)) + 6.0).collect();
                let y: Vec<f32> = (0..2000).map(|i| at(i + 5000, spread(i)) + 4.5).collect();
                let mut bytes = vec![[0; 4]; x.len()];
                Bilinear::default().row(&texture, &x, &y, outside, &mut bytes);
                for (i, pixel) in bytes.iter().enumerate() {
                    let reference = super::super::bilinear(&texture, vec2(x[i], y[i]), outside);
                    for c in 0..4 {
                        let difference = (f32::from(pixel[c]) - reference[c] * 255.0).abs();
                        assert!(
                            difference <= 0.52,
                            "{outside:?} {size} at {}, {}: {difference}",
                            x[i],
                            y[i]
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn texel_centers_give_the_texels_themselves() {
        let texture = noise(Size::new(300, 2));
        let x: Vec<f32> = (0..300).map(|i| i as f32 + 0.5).collect();
        let mut bytes = vec![[0; 4]; 300];
        for outside in [Outside::None, Outside::Clamp, Outside::Repeat, Outside::Mirror] {
            Bilinear::default().row(&texture, &x, &[1.5; 300], outside, &mut bytes);
            assert_eq!(bytes, texture.levels()[0].texels[300..]);
        }
    }

    #[test]
    fn positions_without_bound_read_something_without_panicking() {
        let texture = noise(Size::new(7, 5));
        let x = [f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 1e30, -1e30, 3e9];
        for outside in [Outside::None, Outside::Clamp, Outside::Repeat, Outside::Mirror] {
            Bilinear::default().row(&texture, &x, &x, outside, &mut [[0; 4]; 6]);
        }
    }
}
