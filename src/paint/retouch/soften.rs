//! What blur makes of pixels: their mean over a Gaussian, in which nothing counts that the stroke may not touch.
//! Floor 3.

use super::Touch;
use super::wet::Wet;
use crate::math::Rect;
use crate::paint::laying::Dab;
use crate::paint::scene::Scene;
use crate::surface::objects::Part;

/// The widest Gaussian of one dab, px.
const WIDEST_PX: f32 = 40.0;
/// Beyond so many standard deviations a Gaussian is nothing.
const CUT: f32 = 3.0;

/// The blurred colours of the pixels of a touched area, row by row.
///
/// * `width`: the standard deviation that a stroke leaves in its middle, a ratio of the dab's radius. The variances of the dabs
///   over a pixel add up, 2 r / step of them: so each has the variance (width · r)² · step / 2 r, however close they stand.
pub(super) fn blurred(
    touch: &Touch,
    dab: &Dab,
    before: Option<&Dab>,
    width: f32,
    part: &Part,
    wet: &Wet,
    scene: &Scene,
) -> Vec<[f32; 4]> {
    // A single dab is as a stroke of them a tenth of the diameter apart.
    let step = before.map_or(0.2 * dab.radius, |before| dab.at.distance(before.at).min(2.0 * dab.radius));
    let variance = (width.max(0.0).min(10.0) * dab.radius).powi(2) * step / (2.0 * dab.radius);
    let kernel = kernel(variance.min(WIDEST_PX * WIDEST_PX));
    let reach = kernel.len() as i32 - 1;
    let area = touch.area;
    let seen = area.grown(reach).intersect(scene.size.rect());
    let weighed = weighed(seen, part, wet);
    let across = along_rows(&weighed, seen, area, &kernel);
    down_columns(&across, seen, area, &kernel)
}

/// Half of a symmetric kernel, its middle first, that sums to 1 over both sides and has a variance, px².
fn kernel(variance: f32) -> Vec<f32> {
    if variance.is_nan() || variance <= 0.0 {
        return vec![1.0];
    }
    if variance < 0.64 {
        // Too narrow to be sampled: three pixels of that very variance.
        return vec![1.0 - variance, 0.5 * variance];
    }
    let reach = (CUT * variance.sqrt()).ceil() as i32;
    let half: Vec<f32> = (0..=reach).map(|k| (-0.5 * (k * k) as f32 / variance).exp()).collect();
    let sum = 2.0 * half.iter().sum::<f32>() - half[0];
    half.into_iter().map(|w| w / sum).collect()
}

/// A premultiplied pixel times how much it counts, and that.
type Weighed = [f32; 5];

fn weighed(rect: Rect, part: &Part, wet: &Wet) -> Vec<Weighed> {
    let mut reader = wet.reader();
    let mut all = Vec::with_capacity(rect.width() * rect.height());
    for y in rect.y0..rect.y1 {
        for x in rect.x0..rect.x1 {
            let weight = if part.is_whole() { 1.0 } else { part.coverage(x, y) };
            let [r, g, b, a] = reader.pixel(x, y).map(|c| c * weight);
            all.push([r, g, b, a, weight]);
        }
    }
    all
}

/// The rows of `seen`, the columns of `area`.
fn along_rows(pixels: &[Weighed], seen: Rect, area: Rect, kernel: &[f32]) -> Vec<Weighed> {
    let width = seen.width();
    let mut out = Vec::with_capacity(area.width() * seen.height());
    for row in pixels.chunks_exact(width) {
        for x in area.x0..area.x1 {
            let i = (x - seen.x0) as usize;
            out.push(summed(kernel, |k| row.get(i.wrapping_sub(k)), |k| row.get(i + k)));
        }
    }
    out
}

fn down_columns(pixels: &[Weighed], seen: Rect, area: Rect, kernel: &[f32]) -> Vec<[f32; 4]> {
    let width = area.width();
    let mut out = Vec::with_capacity(width * area.height());
    for y in area.y0..area.y1 {
        for x in 0..width {
            let i = (y - seen.y0) as usize * width + x;
            let [r, g, b, a, weight] =
                summed(kernel, |k| pixels.get(i.wrapping_sub(k * width)), |k| pixels.get(i + k * width));
            let per = if weight > 0.0 { 1.0 / weight } else { 0.0 };
            out.push([r * per, g * per, b * per, a * per]);
        }
    }
    out
}

/// The kernel's sum over the pixels before and after one; beyond the canvas there are none.
#[inline(always)]
fn summed<'p>(
    kernel: &[f32],
    before: impl Fn(usize) -> Option<&'p Weighed>,
    after: impl Fn(usize) -> Option<&'p Weighed>,
) -> Weighed {
    let mut sum = [0.0; 5];
    for (k, &weight) in kernel.iter().enumerate() {
        for pixel in [before(k).filter(|_| k > 0), after(k)].into_iter().flatten() {
            for c in 0..5 {
                sum[c] += weight * pixel[c];
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_sum_to_one_and_have_the_variance_asked_for() {
        for variance in [0.0f32, 0.1, 0.5, 0.9, 4.0, 60.0] {
            let half = kernel(variance);
            let sum = 2.0 * half.iter().sum::<f32>() - half[0];
            let spread: f32 = half.iter().enumerate().map(|(k, w)| 2.0 * (k * k) as f32 * w).sum();
            assert!((sum - 1.0).abs() < 1e-5, "{variance}");
            assert!((spread - variance).abs() < 0.06 * variance + 1e-6, "{variance}: {spread}");
        }
        assert_eq!(kernel(f32::NAN), [1.0]);
    }
}
