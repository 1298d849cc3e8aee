//! Reading a texture of floats: the same taps as for bytes, weighted and added without rounding.
//! Floor 1. For pictures that are written once, so it follows the definition and is not optimized.

use super::antialias::Antialias;
use super::{PatchRow, bilinear_in};
use crate::math::vec2;
use crate::raster::Outside;
use crate::raster::texture::FloatTexture;

/// The picture's premultiplied color at each position (`x`, `y`; texels), one of `out` for each:
/// twin of [`Bilinear::row`](super::Bilinear::row).
pub fn bilinear_row(
    texture: &FloatTexture,
    x: &[f32],
    y: &[f32],
    outside: Outside,
    out: &mut [[f32; 4]],
) {
    for ((x, y), out) in x.iter().zip(y).zip(out) {
        *out = bilinear_in(&texture.levels()[0], vec2(*x, *y), outside);
    }
}

impl Antialias {
    /// The picture's premultiplied color averaged over each patch, one of `out` for each: twin of
    /// [`Antialias::row`].
    pub fn float_row(
        &mut self,
        texture: &FloatTexture,
        patches: PatchRow,
        outside: Outside,
        out: &mut [[f32; 4]],
    ) {
        let last = texture.levels().len() as u32 - 1;
        self.for_each_grid(patches, out.len(), last, |k, level, taps| {
            let level = &texture.levels()[level as usize];
            let [across, down] = [
                level.size.width as f32 / texture.size().width as f32,
                level.size.height as f32 / texture.size().height as f32,
            ];
            let mut sum = [0.0; 4];
            for &[x, y] in taps {
                let tap = bilinear_in(level, vec2(x * across, y * down), outside);
                sum.iter_mut().zip(tap).for_each(|(sum, v)| *sum += v);
            }
            out[k] = sum.map(|v| v / taps.len().max(1) as f32);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, hash};
    use crate::raster::sampler::Bilinear;
    use crate::raster::{Picture, Texture};

    /// The same texels as bytes and as floats.
    fn both(size: Size) -> (Texture, FloatTexture) {
        let byte = |i: u32, c: u32| (hash::unit(1, i, c) * 256.0) as u8;
        let texels: Vec<[u8; 4]> =
            (0..size.area() as u32).map(|i| [0, 1, 2, 3].map(|c| byte(i, c))).collect();
        let floats = texels.iter().map(|t| t.map(|v| f32::from(v) / 255.0)).collect();
        (Texture::new(&Picture::srgb8(size, texels).unwrap()), FloatTexture::floats(size, floats))
    }

    fn farthest(bytes: &[[u8; 4]], floats: &[[f32; 4]]) -> f32 {
        let apart = |(b, d): (&u8, &f32)| (f32::from(*b) - d * 255.0).abs();
        bytes.as_flattened().iter().zip(floats.as_flattened()).map(apart).fold(0.0, f32::max)
    }

    #[test]
    fn rows_of_floats_are_those_of_bytes_before_they_are_rounded() {
        let (bytes, floats) = both(Size::new(37, 23));
        let at = |i: u32, c: u32, spread: f32| (hash::unit(2, i, c) - 0.3) * spread;
        let (x, y): (Vec<f32>, Vec<f32>) =
            (0..1000).map(|i| (at(i, 0, 70.0), at(i, 1, 50.0))).unzip();
        let half = |c: u32| (0..1000).map(|i| at(i, c, 9.0)).collect::<Vec<f32>>();
        let edges: Vec<[Vec<f32>; 2]> =
            (0..4).map(|side| [half(2 + side), half(6 + side)]).collect();
        let edges: [[&[f32]; 2]; 4] =
            std::array::from_fn(|side| [&edges[side][0][..], &edges[side][1][..]]);
        for outside in [Outside::None, Outside::Clamp, Outside::Repeat, Outside::Mirror] {
            let (mut of_bytes, mut of_floats) = (vec![[0; 4]; 1000], vec![[0.0; 4]; 1000]);
            Bilinear::default().row(&bytes, &x, &y, outside, &mut of_bytes);
            bilinear_row(&floats, &x, &y, outside, &mut of_floats);
            // Half a step for the result, and as much for the texels themselves.
            assert!(farthest(&of_bytes, &of_floats) <= 1.05, "{outside:?}");
            let patches = PatchRow { x: &x, y: &y, edges };
            Antialias::default().row(&bytes, patches, outside, &mut of_bytes);
            Antialias::default().float_row(&floats, patches, outside, &mut of_floats);
            // The levels of bytes were rounded one after another.
            assert!(
                farthest(&of_bytes, &of_floats) <= 2.6,
                "{outside:?}: {}",
                farthest(&of_bytes, &of_floats)
            );
        }
    }

    #[test]
    fn texel_centers_give_the_texels_themselves() {
        let (_, floats) = both(Size::new(300, 2));
        let x: Vec<f32> = (0..300).map(|i| i as f32 + 0.5).collect();
        let mut out = vec![[0.0; 4]; 300];
        bilinear_row(&floats, &x, &[1.5; 300], Outside::None, &mut out);
        assert_eq!(out, floats.levels()[0].texels[300..]);
    }

    #[test]
    fn positions_without_bound_read_something_without_panicking() {
        let (_, floats) = both(Size::new(7, 5));
        let x = [f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 1e30, -1e30, 3e9];
        for outside in [Outside::None, Outside::Clamp, Outside::Repeat, Outside::Mirror] {
            let mut out = [[0.0; 4]; 6];
            bilinear_row(&floats, &x, &x, outside, &mut out);
            assert!(out.as_flattened().iter().all(|v| v.is_finite()), "{out:?}");
        }
    }
}
