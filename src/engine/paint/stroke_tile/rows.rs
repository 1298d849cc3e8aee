//! Rows of a stroke tile: how a dab adds to each pixel, and how the result is laid on a layer.
//! Floor 3.

use super::{CoveredRow, DabPaint};
use crate::paint::brush::dual_brush::DualMode;
use crate::raster::TILE;
use crate::raster::planar::PixelRow;

/// Adds a dab to a pixel's coverage a: with g its coverage of the pixel and p the share that it
/// reaches,
///
/// ```text
/// M ← max(M, p),    a ← a + g / M · (c M − a)
/// ```
///
/// up to the ceiling c. What earlier dabs left bare beyond M stays bare; what they reached they
/// covered evenly. For p = 1 that is a ← a + g (c − a). Coverage above the ceiling does not change.
#[inline(always)]
pub fn raise(coverage: &mut f32, reach: &mut f32, g: f32, share: f32, ceiling: f32) {
    let most = if g > 0.0 && share > *reach { share } else { *reach };
    let room = ceiling * most - *coverage;
    let part = if most > 0.0 { g / most } else { 0.0 };
    *coverage += part * if room > 0.0 { room } else { 0.0 };
    *reach = most;
}

/// Adds coverage of weight f up to a ceiling; coverage above the ceiling does not change.
#[inline(always)]
fn raise_to_ceiling(coverage: f32, f: f32, ceiling: f32) -> f32 {
    let room = ceiling - coverage;
    coverage + f * if room > 0.0 { room } else { 0.0 }
}

/// One premultiplied pixel with a color over it that covers g of it, k of what is there; up to a
/// ceiling: colors mix as in source over, coverage rises no higher than the ceiling.
#[inline(always)]
fn mix_pixel(p: [f32; 4], (g, k): (f32, f32), source: [f32; 3], ceiling: f32) -> [f32; 4] {
    let over = |c: usize| p[c] * (1.0 - k) + source[c];
    let a_over = p[3] * (1.0 - k) + g;
    let a = raise_to_ceiling(p[3], k, ceiling);
    let (part, whole) =
        if ceiling < 1.0 && a_over > 0.0 && a < a_over { (a, a_over) } else { (1.0, 1.0) };
    // Multiplied first: a channel equal to the coverage stays equal to the bit, however often dabs
    // mix.
    [over(0), over(1), over(2), a_over].map(|v| v * part / whole)
}

crate::widest! {
    pub(super) fn keep(shares: &[u8; TILE], values: &mut [f32; TILE]) {
        for (v, share) in values.iter_mut().zip(shares) {
            *v *= f32::from(*share) * (1.0 / 255.0);
        }
    }

    pub(super) fn add_covered(row: CoveredRow, paint: DabPaint, coverage: &mut [f32], reach: &mut [f32]) {
        for (((a, m), g), p) in coverage.iter_mut().zip(reach).zip(row.coverage).zip(row.shares) {
            raise(a, m, paint.flow * g, *p, paint.ceiling);
        }
    }

    pub(super) fn add_alpha(stamped: &[[u8; 4]], flow: f32, ceiling: f32, coverage: &mut [f32]) {
        for (a, s) in coverage.iter_mut().zip(stamped) {
            *a = raise_to_ceiling(*a, flow * f32::from(s[3]), ceiling);
        }
    }

    /// `x`: column of the first pixel.
    pub(super) fn add_stamped(stamped: &[[u8; 4]], flow: f32, ceiling: f32, x: usize, row: &mut PixelRow) {
        let PixelRow { rgb: [r, g, b], a } = row;
        let (r, g, b, a) = (&mut r[x..], &mut g[x..], &mut b[x..], &mut a[x..]);
        for (i, s) in stamped.iter().enumerate().take(a.len()) {
            let source = [0, 1, 2].map(|c| flow * f32::from(s[c]));
            let f = flow * f32::from(s[3]);
            [r[i], g[i], b[i], a[i]] = mix_pixel([r[i], g[i], b[i], a[i]], (f, f), source, ceiling);
        }
    }

    /// Two tips' coverage of each pixel becomes the stroke's. `opacity`: of the second.
    pub(super) fn combine_coverage(mode: DualMode, second: &[f32], opacity: f32, first: &mut [f32]) {
        for (a, b) in first.iter_mut().zip(second) {
            *a = mode.combine(a.max(0.0).min(1.0), opacity * b);
        }
    }

    /// The same where the first has colors, which stay: premultiplied, they are scaled.
    pub(super) fn combine_colors(mode: DualMode, second: &[f32; TILE], opacity: f32, row: &mut PixelRow) {
        let PixelRow { rgb, a } = row;
        let mut shares = [0.0; TILE];
        for ((share, a), b) in shares.iter_mut().zip(&mut *a).zip(second) {
            let both = mode.combine(a.max(0.0).min(1.0), opacity * b);
            *share = if *a > 0.0 { both / *a } else { 0.0 };
            *a = both;
        }
        for plane in rgb {
            for (v, share) in plane.iter_mut().zip(&shares) {
                *v *= share;
            }
        }
    }

    /// Blends one premultiplied color over a row, weighted by each pixel's coverage.
    pub(super) fn lay_coverage(coverage: &[f32; TILE], color: [f32; 4], row: &mut PixelRow) {
        for (plane, c) in row.rgb.iter_mut().chain([&mut row.a]).zip(color) {
            for (p, a) in plane.iter_mut().zip(coverage) {
                *p = *p * (1.0 - color[3] * a) + c * a;
            }
        }
    }

    pub(super) fn lay_colors(from: &PixelRow, opacity: f32, row: &mut PixelRow) {
        for (plane, over) in row.rgb.iter_mut().chain([&mut row.a]).zip(from.rgb.iter().chain([&from.a])) {
            for ((p, s), a) in plane.iter_mut().zip(over).zip(&from.a) {
                *p = *p * (1.0 - opacity * a) + opacity * s;
            }
        }
    }

    pub(super) fn take_out_row(coverage: &[f32; TILE], opacity: f32, row: &mut PixelRow) {
        for plane in row.rgb.iter_mut().chain([&mut row.a]) {
            for (p, a) in plane.iter_mut().zip(coverage) {
                *p *= 1.0 - opacity * a;
            }
        }
    }
}

/// Adds colors to a row from column `x` on, as many as `reach` has pixels; `source`: the coverage
/// of each pixel, the straight color, and the share that is reached.
pub(super) fn add_colors(
    source: impl Fn(usize) -> (f32, [f32; 3], f32),
    ceiling: f32,
    x: usize,
    row: &mut PixelRow,
    reach: &mut [f32],
) {
    let PixelRow { rgb: [r, g, b], a } = row;
    for (i, reach) in reach.iter_mut().enumerate().take(TILE - x) {
        let (f, color, share) = source(i);
        *reach = if f > 0.0 { reach.max(share) } else { *reach };
        let part = if *reach > 0.0 { f / *reach } else { 0.0 };
        let p = [r[x + i], g[x + i], b[x + i], a[x + i]];
        let color = color.map(|c| c * f);
        // The ceiling applies to what is reached; 1 stays 1, which caps nothing.
        let ceiling = if ceiling < 1.0 { ceiling * *reach } else { 1.0 };
        [r[x + i], g[x + i], b[x + i], a[x + i]] = mix_pixel(p, (f, part), color, ceiling);
    }
}
