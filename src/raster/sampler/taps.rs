//! Bilinear taps by the hundred: the fast twin of `bilinear`.
//! Floor 1. Two passes: positions to indices and fractions, several taps an instruction; then the texels, one tap at a time
//! with its texels' channels side by side. LLVM does not vectorise the second on its own (three times slower), so it is
//! written in AVX2 where the processor has it; both versions give the same bits.

use super::super::texture::{Level, Outside};
use super::{bilinear_in, mix};
use crate::math::vec2;

/// Marks a tap whose four texels do not lie together inside the picture.
const SEAM: u32 = u32::MAX;

/// Where taps read: index of the upper left texel ([`SEAM`] where there is none) and fractions of the way right and down.
#[derive(Default)]
pub struct Taps {
    index: Vec<u32>,
    tx: Vec<f32>,
    ty: Vec<f32>,
}

/// The positions of taps in one level, in its texels, and what lies beyond it.
#[derive(Clone, Copy)]
pub struct Positions<'a> {
    pub level: &'a Level,
    pub x: &'a [f32],
    pub y: &'a [f32],
    pub outside: Outside,
}

impl Taps {
    /// Finds the texels of every position.
    pub fn find(&mut self, at: Positions) {
        let n = at.x.len();
        // Every value is written below: what is left from the last call does no harm.
        if n != self.index.len() {
            self.index.resize(n, 0);
            self.tx.resize(n, 0.0);
            self.ty.resize(n, 0.0);
        }
        find(at, &mut self.index, &mut self.tx, &mut self.ty);
    }
    /// Writes the rounded mean of the next `count` taps to each run's pixel, four bytes of `out`.
    pub fn means(&self, at: Positions, runs: &[Run], out: &mut [[u8; 4]]) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has AVX2, asked on the line above.
            return unsafe { wide::means(self, at, runs, out) };
        }
        self.means_portably(at, runs, out);
    }
    fn means_portably(&self, at: Positions, runs: &[Run], out: &mut [[u8; 4]]) {
        let mut taps = self.iter().enumerate();
        for run in runs {
            let mut sum = [0.0; 4];
            for (k, tap) in taps.by_ref().take(usize::from(run.count)) {
                let color = match tap.texels(at.level) {
                    Some([top, bottom]) => mix(*top, *bottom, tap.tx, tap.ty),
                    None => at.reference(k),
                };
                (0..4).for_each(|c| sum[c] += color[c]);
            }
            let share = run.share();
            if let Some(out) = out.get_mut(usize::from(run.pixel)) {
                *out = sum.map(|v| round(v * share));
            }
        }
    }
    #[inline(always)]
    fn iter(&self) -> impl Iterator<Item = Tap> {
        self.index.iter().zip(&self.tx).zip(&self.ty).map(|((&index, &tx), &ty)| Tap { index, tx, ty })
    }
}

#[derive(Clone, Copy)]
struct Tap {
    index: u32,
    tx: f32,
    ty: f32,
}

impl Tap {
    /// The upper and the lower pair of texels of a tap; `None` at a seam.
    #[inline(always)]
    fn texels(self, level: &Level) -> Option<[&[[u8; 4]; 2]; 2]> {
        let (first, width) = (self.index as usize, level.size.width as usize);
        // One test for both rows: a seam's index lies beyond every texture.
        let both = level.texels.get(first..first + width + 2)?;
        Some([both.first_chunk()?, both.last_chunk()?])
    }
}

impl Positions<'_> {
    #[cold]
    #[inline(never)]
    fn reference(&self, tap: usize) -> [f32; 4] {
        bilinear_in(self.level, vec2(self.x[tap], self.y[tap]), self.outside)
    }
}

/// How many of the taps belong to a pixel: at most 31.
#[derive(Clone, Copy, Default)]
pub struct Run {
    pub pixel: u16,
    pub count: u16,
}

impl Run {
    /// One tap a pixel, in order.
    pub const ONE_EACH: &[Run] = &{
        let mut runs = [Run { pixel: 0, count: 1 }; 256];
        let mut i = 0;
        while i < runs.len() {
            runs[i].pixel = i as u16;
            i += 1;
        }
        runs
    };
    #[inline(always)]
    fn share(self) -> f32 {
        SHARES[usize::from(self.count) % SHARES.len()]
    }
}

/// 1 / n: a division a pixel would cost as much as a tap.
const SHARES: [f32; 32] = {
    let mut shares = [0.0; 32];
    let mut n = 1;
    while n < 32 {
        shares[n] = 1.0 / n as f32;
        n += 1;
    }
    shares
};

/// The nearest byte of a value in `[0, 255]`, ties to even: adding 2²³ leaves the integer in the low bits.
#[inline(always)]
fn round(value: f32) -> u8 {
    (value + 8_388_608.0).to_bits() as u8
}

#[cfg(target_arch = "x86_64")]
mod wide {
    use super::{Positions, Run, Tap, Taps};
    use std::arch::x86_64::*;

    /// `Taps::means_portably`, eight lanes at a time: the two texels of a row, four channels each.
    #[target_feature(enable = "avx2")]
    pub fn means(taps: &Taps, at: Positions, runs: &[Run], out: &mut [[u8; 4]]) {
        let mut taps = taps.iter().enumerate();
        for run in runs {
            let mut sum = _mm_setzero_ps();
            for (k, tap) in taps.by_ref().take(usize::from(run.count)) {
                let color = match tap.texels(at.level) {
                    Some([top, bottom]) => blend(top, bottom, tap),
                    None => color(at.reference(k)),
                };
                sum = _mm_add_ps(sum, color);
            }
            let whole = _mm_cvtps_epi32(_mm_mul_ps(sum, _mm_set1_ps(run.share())));
            let bytes = _mm_packus_epi16(_mm_packs_epi32(whole, whole), whole);
            if let Some(out) = out.get_mut(usize::from(run.pixel)) {
                *out = _mm_cvtsi128_si32(bytes).to_le_bytes();
            }
        }
    }
    #[inline]
    #[target_feature(enable = "avx2")]
    fn color([r, g, b, a]: [f32; 4]) -> __m128 {
        _mm_setr_ps(r, g, b, a)
    }
    #[inline]
    #[target_feature(enable = "avx2")]
    fn blend(top: &[[u8; 4]; 2], bottom: &[[u8; 4]; 2], at: Tap) -> __m128 {
        let (top, bottom) = (pair(top), pair(bottom));
        let both = _mm256_add_ps(top, _mm256_mul_ps(_mm256_sub_ps(bottom, top), _mm256_set1_ps(at.ty)));
        let (left, right) = (_mm256_castps256_ps128(both), _mm256_extractf128_ps(both, 1));
        _mm_add_ps(left, _mm_mul_ps(_mm_sub_ps(right, left), _mm_set1_ps(at.tx)))
    }
    #[inline]
    #[target_feature(enable = "avx2")]
    fn pair(texels: &[[u8; 4]; 2]) -> __m256 {
        // SAFETY: the eight bytes read are the two texels.
        let bytes = unsafe { _mm_loadl_epi64(texels.as_ptr().cast()) };
        _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(bytes))
    }
}

crate::widest! {
    fn find(at: Positions, index: &mut [u32], tx: &mut [f32], ty: &mut [f32]) {
        let (w, h) = (at.level.size.width as i32, at.level.size.height as i32);
        if w < 2 || h < 2 || w > MAX_SIDE || h > MAX_SIDE {
            return index.fill(SEAM);
        }
        match at.outside {
            Outside::None => find_folded(at, |c, _| c, index, tx, ty),
            Outside::Clamp => find_folded(at, within, index, tx, ty),
            Outside::Repeat => find_folded(at, repeated, index, tx, ty),
            Outside::Mirror => find_folded(at, |c, n| within(mirrored(c, n), n), index, tx, ty),
        }
    }
}

/// `fold` brings a position into a picture of a side, where there is anything.
#[inline(always)]
fn find_folded(at: Positions, fold: impl Fn(f32, f32) -> f32, index: &mut [u32], tx: &mut [f32], ty: &mut [f32]) {
    let (w, h) = (at.level.size.width as i32, at.level.size.height as i32);
    let n = at.x.len();
    let (x, y, index, tx, ty) = (&at.x[..n], &at.y[..n], &mut index[..n], &mut tx[..n], &mut ty[..n]);
    for k in 0..n {
        let (column, fraction_x) = first_of_pair(fold(x[k], w as f32) - 0.5, w as f32);
        let (row, fraction_y) = first_of_pair(fold(y[k], h as f32) - 0.5, h as f32);
        index[k] = if (row | column) < 0 { SEAM } else { row.wrapping_mul(w).wrapping_add(column) as u32 };
        tx[k] = fraction_x;
        ty[k] = fraction_y;
    }
}

/// The texel at or before a position `u` (in texel centres) and how far beyond it `u` lies; −1 outside `[0, n − 1]`.
#[inline(always)]
fn first_of_pair(u: f32, n: f32) -> (i32, f32) {
    let first = floor(u).min(n - 2.0);
    let inside = u >= 0.0 && u <= n - 1.0;
    (if inside { integer(first) } else { -1 }, u - first)
}

/// Clamped so that both texels of the pair are the border's own.
#[inline(always)]
fn within(c: f32, n: f32) -> f32 {
    c.max(0.5).min(n - 0.5)
}

/// The position in `[0, n]` that a mirrored picture shows at `c`.
#[inline(always)]
fn mirrored(c: f32, n: f32) -> f32 {
    let period = 2.0 * n;
    let m = c - floor(c / period) * period;
    if m > n { period - m } else { m }
}

/// The position in `[0, n]` that a repeated picture shows at `c`.
#[inline(always)]
fn repeated(c: f32, n: f32) -> f32 {
    c - floor(c / n) * n
}

/// 1.5 · 2²³: added to a number below 2²² it leaves its nearest integer in the low bits. Rust's own casts saturate, which
/// keeps LLVM from converting eight at a time.
const TO_INTEGER: f32 = 12_582_912.0;
/// Longest side of a level whose texels are found that way.
const MAX_SIDE: i32 = 1 << 22;

/// `f32::floor`, for values below 2²² in size.
#[inline(always)]
fn floor(v: f32) -> f32 {
    let nearest = (v + TO_INTEGER) - TO_INTEGER;
    if nearest > v { nearest - 1.0 } else { nearest }
}

/// The integer that a whole number below 2²² in size is.
#[inline(always)]
fn integer(v: f32) -> i32 {
    (v + TO_INTEGER).to_bits() as i32 - TO_INTEGER.to_bits() as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;

    #[test]
    fn the_wide_means_are_the_portable_ones_to_the_bit() {
        let texels = (0..9 * 7u32).map(|i| (i.wrapping_mul(0x9e37_79b9)).to_le_bytes()).collect();
        let level = Level { size: Size::new(9, 7), texels };
        let x: Vec<f32> = (0..300).map(|i| (i as f32 * 0.37) % 14.0 - 2.0).collect();
        let y: Vec<f32> = (0..300).map(|i| (i as f32 * 0.61) % 10.0 - 1.5).collect();
        let runs: Vec<Run> = (0..100).map(|i| Run { pixel: i, count: 1 + i % 5 }).collect();
        for outside in [Outside::None, Outside::Clamp, Outside::Repeat, Outside::Mirror] {
            let at = Positions { level: &level, x: &x, y: &y, outside };
            let mut taps = Taps::default();
            taps.find(at);
            let (mut wide, mut portable) = ([[0; 4]; 100], [[0; 4]; 100]);
            taps.means(at, &runs, &mut wide);
            taps.means_portably(at, &runs, &mut portable);
            assert_eq!(wide, portable, "{outside:?}");
        }
    }
}
