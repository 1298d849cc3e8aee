//! A texture: a picture ready to be sampled, premultiplied sRGB with its mip levels: usually bytes,
//! floats for pictures of more than 8 bits a channel. Floor 1. Never edited; shared by `Arc`.
//! Sampling is `sampler`.

use super::picture::{Picture, Texels};
use crate::math::{Size, srgb};
use rayon::prelude::*;
use std::ops::Range;
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
                let mut texels = vec![[0; 4]; t.len()];
                super::grid::premultiply(t.as_flattened(), texels.as_flattened_mut());
                texels
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

impl Texture {
    /// The texture of another picture of bytes of the same size that is the same beyond some rows;
    /// `None` if it can be none.
    pub fn repainted(&self, picture: &Picture, rows: Range<u32>) -> Option<Self> {
        let Texels::Srgb8(straight) = &picture.texels else { return None };
        if picture.size != self.size() || self.first != 0 {
            return None;
        }
        let mut levels: Vec<MipLevel> = self.levels.to_vec();
        let start = rows.start.min(picture.size.height);
        let mut rows = start..rows.end.min(picture.size.height).max(start);
        let width = picture.size.width as usize;
        let part = rows.start as usize * width..rows.end as usize * width;
        let first = levels[0].texels[part.clone()].as_flattened_mut();
        super::grid::premultiply(straight[part].as_flattened(), first);
        for i in 1..levels.len() {
            let (above, beneath) = levels.split_at_mut(i);
            let (level, half) = (&above[i - 1], &mut beneath[0]);
            // A texel covers up to three rows.
            let ratio = f64::from(level.size.height) / f64::from(half.size.height);
            let first = (f64::from(rows.start) / ratio).floor() as u32;
            let last = (f64::from(rows.end) / ratio).ceil() as u32;
            rows = first.saturating_sub(1)..(last + 1).min(half.size.height);
            halve_rows(level, half, rows.clone());
        }
        Some(Self { levels: levels.into(), first: 0 })
    }
}

/// The next mip level: each texel the mean of the texels it covers (2 × 2, or 3 wide where the side
/// is odd, weighted by area).
fn halve<T: Texel>(level: &MipLevel<T>) -> Option<MipLevel<T>> {
    let size = half_size(level.size)?;
    let mut half = MipLevel { size, texels: vec![T::default(); size.area()] };
    halve_rows(level, &mut half, 0..size.height);
    Some(half)
}

/// The size of the next mip level; `None` for the last one.
fn half_size(Size { width, height }: Size) -> Option<Size> {
    (width > 1 || height > 1).then(|| Size::new((width / 2).max(1), (height / 2).max(1)))
}

/// Makes rows of the next mip level.
fn halve_rows<T: Texel>(level: &MipLevel<T>, half: &mut MipLevel<T>, rows: Range<u32>) {
    let (from, to) = (level.size, half.size);
    let are_pairs = from.width == 2 * to.width;
    let xs = if are_pairs { Vec::new() } else { coverage_weights(from.width, to.width) };
    let ys = coverage_weights(from.height, to.height);
    let (wide, width) = (from.width as usize, to.width as usize);
    let mut sums = vec![[0.0f32; 4]; width];
    let rows = rows.start as usize..rows.end as usize;
    for (y, covered) in ys.iter().enumerate().take(rows.end).skip(rows.start) {
        sums.fill([0.0; 4]);
        for &(j, weight) in covered {
            let row = &level.texels[j as usize * wide..(j as usize + 1) * wide];
            if are_pairs {
                add_pairs(row, 0.5 * weight, &mut sums);
            } else {
                add_covered(row, &xs, weight, &mut sums);
            }
        }
        let out = &mut half.texels[y * width..(y + 1) * width];
        out.iter_mut().zip(&sums).for_each(|(texel, sum)| *texel = T::of(*sum));
    }
}

/// Adds both texels that each one covers.
fn add_pairs<T: Texel>(row: &[T], weight: f32, sums: &mut [[f32; 4]]) {
    for (sum, pair) in sums.iter_mut().zip(row.as_chunks::<2>().0) {
        for texel in pair {
            let value = texel.value();
            for c in 0..4 {
                sum[c] += weight * value[c];
            }
        }
    }
}

/// Adds the texels that each one covers, by their weights.
fn add_covered<T: Texel>(
    row: &[T],
    weights: &[Vec<(u32, f32)>],
    weight: f32,
    sums: &mut [[f32; 4]],
) {
    for (sum, covered) in sums.iter_mut().zip(weights) {
        for &(i, share) in covered {
            let value = row[i as usize].value();
            for c in 0..4 {
                sum[c] += share * weight * value[c];
            }
        }
    }
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
    use crate::math::hash;

    #[test]
    fn mirror_repeats_the_border_texel() {
        let m: Vec<_> = (-3..7).map(|i| Outside::Mirror.index(i, 3).unwrap()).collect();
        assert_eq!(m, [2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
        assert_eq!(Outside::None.index(-1, 3), None);
        assert_eq!(Outside::Repeat.index(-1, 3), Some(2));
    }

    #[test]
    fn rows_that_are_painted_again_leave_the_texture_of_the_whole_picture() {
        let texels = |seed: u32, n: usize| -> Vec<[u8; 4]> {
            let byte = |i: usize, c: u32| (hash::unit(seed, i as u32, c) * 256.0) as u8;
            (0..n).map(|i| [byte(i, 0), byte(i, 1), byte(i, 2), byte(i, 3)]).collect()
        };
        for size in [Size::new(37, 53), Size::new(64, 48), Size::new(128, 33), Size::new(1, 90)] {
            let old = texels(1, size.area());
            let picture = Picture::srgb8(size, old.clone()).unwrap();
            for rows in [0..1, 7..19, 20..33, 0..size.height, 5..5] {
                let mut new = old.clone();
                let part = (rows.start * size.width) as usize..(rows.end * size.width) as usize;
                new[part.clone()].copy_from_slice(&texels(2, size.area())[part]);
                let next = Picture::srgb8(size, new).unwrap();
                let again = Texture::new(&picture).repainted(&next, rows.clone()).unwrap();
                for (a, b) in again.levels().iter().zip(Texture::new(&next).levels()) {
                    assert_eq!(a.size, b.size);
                    assert!(a.texels == b.texels, "{size} {rows:?}, level of {}", a.size);
                }
            }
        }
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
