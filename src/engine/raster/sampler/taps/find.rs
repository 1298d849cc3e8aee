//! Where taps read: the first texel of each tap and the weights of its four, several taps an
//! instruction. Floor 1. Not here: reading them (`taps`, `wide`).

use super::{ONE, TapPositions};
use crate::raster::Outside;

crate::widest! {
    /// Fills index, weights and fractions; the least and the largest index.
    pub(super) fn find(at: TapPositions, index: &mut [i32], across: &mut [u32], down: &mut [f32]) -> [i32; 2] {
        let (w, h) = (at.level.size.width as i32, at.level.size.height as i32);
        if w < 2 || h < 2 || w > MAX_SIDE || h > MAX_SIDE {
            index.fill(-1);
            return [-1; 2];
        }
        let (wide, high) = (w as f32, h as f32);
        if are_within(at.x, 0.5, wide - 0.5) && are_within(at.y, 0.5, high - 0.5) {
            return find_folded(at, |c, n| pair(c - 0.5, n), index, across, down);
        }
        match at.outside {
            Outside::None => find_folded(at, pair_or_seam, index, across, down),
            Outside::Clamp => {
                let place = |c, n| pair(clamp_position(c, n) - 0.5, n);
                find_folded(at, place, index, across, down)
            }
            Outside::Repeat => {
                find_folded(at, |c, n| pair_or_seam(wrap_position(c, n), n), index, across, down)
            }
            // Few pictures are bent so far that they repeat twice.
            Outside::Mirror
                if are_within(at.x, -2.0 * wide, 1.999 * wide)
                    && are_within(at.y, -2.0 * high, 1.999 * high) =>
            {
                let place = |c, n| pair(clamp_position(mirrored_once(c, n), n) - 0.5, n);
                find_folded(at, place, index, across, down)
            }
            Outside::Mirror => {
                let place = |c, n| pair(clamp_position(mirrored(c, n), n) - 0.5, n);
                find_folded(at, place, index, across, down)
            }
        }
    }
}

/// Every position is a number between two.
#[inline(always)]
fn are_within(positions: &[f32], low: f32, high: f32) -> bool {
    positions.iter().fold(0, |beyond, &c| beyond | u32::from(!(c >= low && c <= high))) == 0
}

/// `pair` finds, for a position in a picture of a side, the first texel of the pair around it and
/// how far beyond it lies.
#[inline(always)]
fn find_folded(
    at: TapPositions,
    pair: impl Fn(f32, f32) -> (i32, f32),
    index: &mut [i32],
    across: &mut [u32],
    down: &mut [f32],
) -> [i32; 2] {
    let (w, h) = (at.level.size.width as i32, at.level.size.height as i32);
    let n = at.x.len();
    let (x, y, index, across, down) =
        (&at.x[..n], &at.y[..n], &mut index[..n], &mut across[..n], &mut down[..n]);
    let (mut least, mut most) = (i32::MAX, i32::MIN);
    for k in 0..n {
        let (column, right) = pair(x[k], w as f32);
        let (row, below) = pair(y[k], h as f32);
        let first = if (row | column) < 0 { -1 } else { row.wrapping_mul(w).wrapping_add(column) };
        (least, most) = (least.min(first), most.max(first));
        let right = integer(right * ONE) as u32;
        (index[k], across[k], down[k]) =
            (first, (ONE as u32).wrapping_sub(right) | right << 16, below);
    }
    [least, most]
}

/// The texel at or before a position `u` (in texel centers, `[0, n − 1]`) and how far beyond it `u`
/// lies.
#[inline(always)]
fn pair(u: f32, n: f32) -> (i32, f32) {
    let first = floor(u).min(n - 2.0);
    (integer(first), u - first)
}

/// The same for any position `c`; −1 if the pair is not in the picture.
#[inline(always)]
fn pair_or_seam(c: f32, n: f32) -> (i32, f32) {
    let u = c - 0.5;
    let (first, beyond) = pair(u, n);
    (if u >= 0.0 && u <= n - 1.0 { first } else { -1 }, beyond)
}

/// Clamped so that both texels of the pair are the border's own.
#[inline(always)]
fn clamp_position(c: f32, n: f32) -> f32 {
    c.max(0.5).min(n - 0.5)
}

/// The position in `[0, n]` that a mirrored picture shows at `c`.
#[inline(always)]
fn mirrored(c: f32, n: f32) -> f32 {
    let period = 2.0 * n;
    let m = c - floor(c / period) * period;
    if m > n { period - m } else { m }
}

/// The same to the bit after [`clamp_position`], for `c` in `[−2 n, 2 n)`; without a division.
#[inline(always)]
fn mirrored_once(c: f32, n: f32) -> f32 {
    let period = 2.0 * n;
    let m = if c < 0.0 { c + period } else { c };
    if m > n { period - m } else { m }
}

/// The position in `[0, n]` that a repeated picture shows at `c`.
#[inline(always)]
fn wrap_position(c: f32, n: f32) -> f32 {
    c - floor(c / n) * n
}

/// 1.5 · 2²³: added to a number below 2²² it leaves its nearest integer in the low bits. Rust's own
/// casts saturate, which keeps LLVM from converting eight at a time.
const TO_INTEGER: f32 = 12_582_912.0;
/// Longest side of a level whose texels are found this way.
const MAX_SIDE: i32 = 1 << 22;

/// `f32::floor`, for magnitudes below 2²².
#[inline(always)]
fn floor(v: f32) -> f32 {
    let nearest = (v + TO_INTEGER) - TO_INTEGER;
    if nearest > v { nearest - 1.0 } else { nearest }
}

/// A whole number with a magnitude below 2²² as an integer.
#[inline(always)]
fn integer(v: f32) -> i32 {
    (v + TO_INTEGER).to_bits() as i32 - TO_INTEGER.to_bits() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_mirrored_once_is_mirrored_to_the_bit() {
        for n in [2.0f32, 3.0, 640.0, 1080.0, 4095.0, 1e5] {
            let near =
                [-2.0 * n, -n, -0.5, -1e-20, -0.0, 0.0, 0.5, n - 0.5, n, 1.999 * n].into_iter();
            let around =
                near.flat_map(|c: f32| [c.next_down(), c, c.next_up()]).filter(|c| *c >= -2.0 * n);
            let all = around.chain((0..5000).map(|i| (i as f32 * 0.000_799 - 2.0) * n));
            for c in all {
                let [once, often] =
                    [mirrored_once(c, n), mirrored(c, n)].map(|m| clamp_position(m, n));
                assert_eq!(once.to_bits(), often.to_bits(), "{c} in {n}: {once} and {often}");
            }
        }
    }
}
