//! A texture: a picture ready to be sampled, premultiplied sRGB with its mip levels: usually bytes,
//! floats for pictures of more than 8 bits a channel. Floor 1. Never edited; shared by `Arc`.
//! Sampling is `sampler`.

use super::picture::{Picture, Texels};
use crate::math::{Size, srgb};
use rayon::prelude::*;
use std::sync::Arc;

crate::named! {
    /// What a lookup beyond the picture's border returns.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum Outside {
        /// The picture mirrored at its border (… b a | a b …).
        #[default]
        Mirror = "mirror",
        /// The picture again.
        Repeat = "repeat",
        /// The nearest border texel.
        Clamp = "clamp",
        /// Nothing: transparent.
        None = "none",
    }
}

impl Outside {
    /// The texel at index `i` of a row of `n`, `n ≥ 1`; `None` if there is none.
    #[inline(always)]
    pub fn index(self, i: i32, n: i32) -> Option<i32> {
        if (0..n).contains(&i) {
            return Some(i);
        }
        match self {
            Outside::None => None,
            Outside::Clamp => Some(i.clamp(0, n - 1)),
            Outside::Repeat => Some(i.rem_euclid(n)),
            Outside::Mirror => {
                let m = i.rem_euclid(2 * n);
                Some(if m < n { m } else { 2 * n - 1 - m })
            }
        }
    }
}

/// What a texture holds of a texel, premultiplied and sRGB-encoded.
pub trait Texel: Copy + Send + Sync + Default {
    /// In the unit of the kind: 0 … 255 for bytes, 0 … 1 and beyond for floats.
    fn value(self) -> [f32; 4];
    /// The nearest that can be held.
    fn of(value: [f32; 4]) -> Self;
}

impl Texel for [u8; 4] {
    #[inline(always)]
    fn value(self) -> [f32; 4] {
        self.map(f32::from)
    }

    fn of(value: [f32; 4]) -> Self {
        value.map(|v| (v + 0.5) as u8)
    }
}

impl Texel for [f32; 4] {
    #[inline(always)]
    fn value(self) -> [f32; 4] {
        self
    }

    fn of(value: [f32; 4]) -> Self {
        value
    }
}

/// One mip level.
#[derive(Clone)]
pub struct MipLevel<T = [u8; 4]> {
    /// Its size, texels.
    pub size: Size,
    /// Premultiplied RGBA, sRGB-encoded, row by row.
    pub texels: Vec<T>,
}

/// A mip chain; level 0 is the picture itself, each next one half as large down to 1 × 1.
#[derive(Clone)]
pub struct Texture<T = [u8; 4]> {
    levels: Arc<[MipLevel<T>]>,
    /// The level that is read as level 0.
    first: usize,
}

/// A texture of floats; light brighter than white is above 1.
pub type FloatTexture = Texture<[f32; 4]>;

impl Texture {
    /// Encodes scene-referred pictures (clipped at 1), premultiplies, and builds the mip chain.
    pub fn new(picture: &Picture) -> Self {
        let texels = match &picture.texels {
            Texels::Srgb8(t) => {
                t.iter().map(|&[r, g, b, a]| premultiplied_u8([r, g, b, a])).collect()
            }
            Texels::Linear(t) => t
                .par_iter()
                .map(|&[r, g, b, a]| {
                    let e = |v: f32| srgb::quantize(srgb::encode(v).min(1.0) * a);
                    [e(r), e(g), e(b), srgb::quantize(a)]
                })
                .collect(),
        };
        Self::of_texels(picture.size, texels)
    }
}

impl FloatTexture {
    /// From straight encoded texels, one for each pixel.
    pub fn floats(size: Size, straight: Vec<[f32; 4]>) -> Self {
        Self::of_texels(
            size,
            straight.into_iter().map(|[r, g, b, a]| [r * a, g * a, b * a, a]).collect(),
        )
    }
}

impl<T: Texel> Texture<T> {
    fn of_texels(size: Size, texels: Vec<T>) -> Self {
        let mut levels = vec![MipLevel { size, texels }];
        while let Some(next) = levels.last().and_then(halve) {
            levels.push(next);
        }
        Self { levels: levels.into(), first: 0 }
    }

    /// Bytes that its levels take.
    pub fn bytes(&self) -> u64 {
        self.levels.iter().map(|level| size_of_val(&level.texels[..]) as u64).sum()
    }

    /// The same texture without its finest levels, as if the picture were that much smaller; one
    /// level is always left.
    pub fn coarser(&self, levels: u32) -> Self {
        let first = self.first.saturating_add(levels as usize).min(self.levels.len() - 1);
        Self { levels: self.levels.clone(), first }
    }

    /// The size of the largest level, texels.
    pub fn size(&self) -> Size {
        self.levels[self.first].size
    }

    /// Level 0 is the picture; there is always at least one.
    pub fn levels(&self) -> &[MipLevel<T>] {
        &self.levels[self.first..]
    }
}

fn premultiplied_u8(straight: [u8; 4]) -> [u8; 4] {
    let mut out = [0; 4];
    super::grid::premultiply(&straight, &mut out);
    out
}

/// The next mip level: each texel the mean of the texels it covers (2 × 2, or 3 wide where the side
/// is odd, weighted by area).
fn halve<T: Texel>(level: &MipLevel<T>) -> Option<MipLevel<T>> {
    let Size { width: w, height: h } = level.size;
    if w == 1 && h == 1 {
        return None;
    }
    let size = Size::new((w / 2).max(1), (h / 2).max(1));
    let (xs, ys) = (coverage_weights(w, size.width), coverage_weights(h, size.height));
    let mut texels = Vec::with_capacity(size.area());
    for y in &ys {
        for x in &xs {
            let mut sum = [0.0f32; 4];
            for &(j, wy) in y {
                for &(i, wx) in x {
                    let t = level.texels[(j * w + i) as usize].value();
                    for c in 0..4 {
                        sum[c] += wx * wy * t[c];
                    }
                }
            }
            texels.push(T::of(sum));
        }
    }
    Some(MipLevel { size, texels })
}

/// For each of `to` cells, the cells of `from ≥ to` it covers and their weights, which add up to 1.
fn coverage_weights(from: u32, to: u32) -> Vec<Vec<(u32, f32)>> {
    let ratio = from as f32 / to as f32;
    (0..to)
        .map(|i| {
            let (a, b) = (i as f32 * ratio, (i + 1) as f32 * ratio);
            (a as u32..(b.ceil() as u32).min(from))
                .map(|j| (j, ((b.min(j as f32 + 1.0) - a.max(j as f32)) / ratio).max(0.0)))
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mirror_repeats_the_border_texel() {
        let m: Vec<_> = (-3..7).map(|i| Outside::Mirror.index(i, 3).unwrap()).collect();
        assert_eq!(m, [2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
        assert_eq!(Outside::None.index(-1, 3), None);
        assert_eq!(Outside::Repeat.index(-1, 3), Some(2));
    }

    #[test]
    fn the_last_level_is_the_mean_color() {
        let texels = (0..15).map(|i| [i * 16, 0, 0, 255]).collect();
        let t = Texture::new(&Picture::srgb8(Size::new(5, 3), texels).unwrap());
        let last = t.levels().last().unwrap();
        assert_eq!(last.size, Size::new(1, 1));
        assert!(last.texels[0][0].abs_diff(112) <= 1, "{:?}", last.texels[0]);
    }
}
