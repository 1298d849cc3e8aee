//! The loops of D over a span of a row: offsets by operator, weights of anchors.
//! Floor 2. Not here: which of them a span needs (`fill`).

use super::FastPin;
use crate::math::{Mat2, Vec2};
use crate::surface::operator::{first_order, second_order};

/// The pixels of a row: their centers, and what the maps hold.
#[derive(Clone, Copy)]
pub(super) struct KernelSpan<'s> {
    pub(super) x: &'s [f32],
    pub(super) y: &'s [f32],
    pub(super) a: &'s [f32],
    pub(super) b: &'s [f32],
    pub(super) gain: &'s [f32],
}

/// offset_i of one pixel: (q − q_i, its two map values, the anchor) → canvas px.
pub(super) trait OffsetKernel: Copy {
    fn offset(self, from_x: f32, from_y: f32, a: f32, b: f32, pin: &FastPin) -> (f32, f32);
}

#[derive(Clone, Copy)]
struct StillKernel;
#[derive(Clone, Copy)]
pub(super) struct DepthKernel {
    pub(super) rate: f32,
}

#[derive(Clone, Copy)]
pub(super) struct NormalKernel {
    pub(super) alpha_px: f32,
    pub(super) softness: f32,
}

#[derive(Clone, Copy)]
pub(super) struct MirrorKernel {
    pub(super) alpha_px: f32,
}

impl OffsetKernel for StillKernel {
    #[inline(always)]
    fn offset(self, _: f32, _: f32, _: f32, _: f32, _: &FastPin) -> (f32, f32) {
        (0.0, 0.0)
    }
}

impl OffsetKernel for DepthKernel {
    #[inline(always)]
    fn offset(self, from_x: f32, from_y: f32, z: f32, _: f32, pin: &FastPin) -> (f32, f32) {
        let f = first_order::scale_factor_of_rate(z - pin.a, self.rate);
        (f * from_x, f * from_y)
    }
}

impl OffsetKernel for NormalKernel {
    #[inline(always)]
    fn offset(self, _: f32, _: f32, nbar_x: f32, nbar_y: f32, pin: &FastPin) -> (f32, f32) {
        let (dx, dy) = (nbar_x - pin.a, nbar_y - pin.b);
        let f = second_order::offset_factor_of_softness(
            (dx * dx + dy * dy).sqrt(),
            self.alpha_px,
            self.softness,
        );
        (f * dx, f * dy)
    }
}

impl OffsetKernel for MirrorKernel {
    #[inline(always)]
    fn offset(self, _: f32, _: f32, mirrored_x: f32, mirrored_y: f32, pin: &FastPin) -> (f32, f32) {
        (self.alpha_px * (mirrored_x - pin.a), self.alpha_px * (mirrored_y - pin.b))
    }
}

/// D with a single anchor, whose weight is 1.
#[inline(always)]
fn one(
    span: KernelSpan,
    pin: &FastPin,
    kernel: impl OffsetKernel,
    out_x: &mut [f32],
    out_y: &mut [f32],
) {
    let n = out_x.len();
    let (a, b, gain, out_y) = (&span.a[..n], &span.b[..n], &span.gain[..n], &mut out_y[..n]);
    let (x, y) = (&span.x[..n], &span.y[..n]);
    for k in 0..n {
        let (x, y) = (x[k], y[k]);
        let (dx, dy) = kernel.offset(x - pin.x, y - pin.y, a[k], b[k], pin);
        out_x[k] = x + (gain[k] * dx + pin.move_x);
        out_y[k] = y + (gain[k] * dy + pin.move_y);
    }
}

/// Adds one of several anchors: `moved += w (offset + s − q_i)`.
#[inline(always)]
fn add(
    span: KernelSpan,
    pin: &FastPin,
    kernel: impl OffsetKernel,
    weight: &[f32],
    moved_x: &mut [f32],
    moved_y: &mut [f32],
) {
    let n = moved_x.len();
    let (a, b, gain, weight) = (&span.a[..n], &span.b[..n], &span.gain[..n], &weight[..n]);
    let (x, y, moved_y) = (&span.x[..n], &span.y[..n], &mut moved_y[..n]);
    for k in 0..n {
        let (x, y) = (x[k], y[k]);
        let (dx, dy) = kernel.offset(x - pin.x, y - pin.y, a[k], b[k], pin);
        moved_x[k] += weight[k] * (gain[k] * dx + pin.move_x);
        moved_y[k] += weight[k] * (gain[k] * dy + pin.move_y);
    }
}

/// Squared distance below which a pixel is at an anchor: f32 canvas coordinates cannot resolve
/// smaller ones.
const AT_ANCHOR: f32 = 1e-12;

#[inline(always)]
fn distance_squared(span: KernelSpan, pin: &FastPin, k: usize) -> f32 {
    let (dx, dy) = (span.x[k] - pin.x, span.y[k] - pin.y);
    dx * dx + dy * dy
}

crate::widest! {
    pub(super) fn still_one(span: KernelSpan, pin: &FastPin, out_x: &mut [f32], out_y: &mut [f32]) {
        one(span, pin, StillKernel, out_x, out_y)
    }

    pub(super) fn depth_one(
        span: KernelSpan,
        pin: &FastPin,
        kernel: DepthKernel,
        out_x: &mut [f32],
        out_y: &mut [f32],
    ) {
        one(span, pin, kernel, out_x, out_y)
    }

    pub(super) fn normal_one(
        span: KernelSpan,
        pin: &FastPin,
        kernel: NormalKernel,
        out_x: &mut [f32],
        out_y: &mut [f32],
    ) {
        one(span, pin, kernel, out_x, out_y)
    }

    pub(super) fn mirror_one(
        span: KernelSpan,
        pin: &FastPin,
        kernel: MirrorKernel,
        out_x: &mut [f32],
        out_y: &mut [f32],
    ) {
        one(span, pin, kernel, out_x, out_y)
    }

    pub(super) fn still_add(span: KernelSpan, pin: &FastPin, weight: &[f32], moved_x: &mut [f32], moved_y: &mut [f32]) {
        add(span, pin, StillKernel, weight, moved_x, moved_y)
    }

    pub(super) fn depth_add(
        span: KernelSpan,
        pin: &FastPin,
        kernel: DepthKernel,
        weight: &[f32],
        moved_x: &mut [f32],
        moved_y: &mut [f32],
    ) {
        add(span, pin, kernel, weight, moved_x, moved_y)
    }

    pub(super) fn normal_add(
        span: KernelSpan,
        pin: &FastPin,
        kernel: NormalKernel,
        weight: &[f32],
        moved_x: &mut [f32],
        moved_y: &mut [f32],
    ) {
        add(span, pin, kernel, weight, moved_x, moved_y)
    }

    pub(super) fn mirror_add(
        span: KernelSpan,
        pin: &FastPin,
        kernel: MirrorKernel,
        weight: &[f32],
        moved_x: &mut [f32],
        moved_y: &mut [f32],
    ) {
        add(span, pin, kernel, weight, moved_x, moved_y)
    }

    /// 1 on the surface, 0 outside.
    pub(super) fn coverage_gain(coverage: &[u8], gain: &mut [f32]) {
        for (g, &c) in gain.iter_mut().zip(coverage) {
            *g = if c > 0 { 1.0 } else { 0.0 };
        }
    }

    /// Shepard's weight at power 2, not yet normalized.
    pub(super) fn inverse_squares(span: KernelSpan, pin: &FastPin, weight: &mut [f32], weight_sum: &mut [f32]) {
        for (k, (w, sum)) in weight.iter_mut().zip(weight_sum).enumerate() {
            *w = 1.0 / distance_squared(span, pin, k).max(AT_ANCHOR);
            *sum += *w;
        }
    }

    pub(super) fn nearer(span: KernelSpan, pin: &FastPin, nearest: &mut [f32]) {
        for (k, d) in nearest.iter_mut().enumerate() {
            *d = d.min(distance_squared(span, pin, k).max(AT_ANCHOR));
        }
    }

    /// The weight along the segment of anchor `i`, whose first anchor is `first`.
    pub(super) fn segment_weights(
        span: KernelSpan,
        first: &FastPin,
        slope: [f32; 2],
        i: usize,
        weight: &mut [f32],
        weight_sum: &mut [f32],
    ) {
        // w_i = offset + factor · along: 1 − t, t, then nothing.
        let (offset, factor) = match i {
            0 => (1.0, -1.0),
            1 => (0.0, 1.0),
            _ => (0.0, 0.0),
        };
        for (k, (w, sum)) in weight.iter_mut().zip(weight_sum).enumerate() {
            let along = (span.x[k] - first.x) * slope[0] + (span.y[k] - first.y) * slope[1];
            *w = offset + factor * along.max(0.0).min(1.0);
            *sum += *w;
        }
    }

    /// D = linear U + shift over a row of points of the unwrapped plane.
    pub(super) fn fill_laid_row(u: &[f32], v: &[f32], linear: Mat2, shift: Vec2, out_x: &mut [f32], out_y: &mut [f32]) {
        let n = out_x.len();
        let (u, v, out_y) = (&u[..n], &v[..n], &mut out_y[..n]);
        let ([xx, yx], [xy, yy]) = (linear.x_axis.to_array(), linear.y_axis.to_array());
        for k in 0..n {
            out_x[k] = xx * u[k] + xy * v[k] + shift.x;
            out_y[k] = yx * u[k] + yy * v[k] + shift.y;
        }
    }

    /// The same of a displaced plane: its displacement is turned and scaled as the plane is, and
    /// added.
    pub(super) fn fill_pulled_row(
        uv: [&[f32]; 2],
        by: [&[f32]; 2],
        laid: (Mat2, Vec2, Mat2),
        out_x: &mut [f32],
        out_y: &mut [f32],
    ) {
        let n = out_x.len();
        let (u, v, by_x, by_y) = (&uv[0][..n], &uv[1][..n], &by[0][..n], &by[1][..n]);
        let (out_y, (linear, shift, pulled)) = (&mut out_y[..n], laid);
        let ([xx, yx], [xy, yy]) = (linear.x_axis.to_array(), linear.y_axis.to_array());
        let ([pxx, pyx], [pxy, pyy]) = (pulled.x_axis.to_array(), pulled.y_axis.to_array());
        for k in 0..n {
            out_x[k] = (xx * u[k] + xy * v[k] + shift.x) + (pxx * by_x[k] + pxy * by_y[k]);
            out_y[k] = (yx * u[k] + yy * v[k] + shift.y) + (pyx * by_x[k] + pyy * by_y[k]);
        }
    }

    /// Points of the unwrapped plane where they lie, but for a shift in both directions.
    pub(super) fn fill_shifted_row(u: &[f32], v: &[f32], by: f32, out_x: &mut [f32], out_y: &mut [f32]) {
        for (out, from) in out_x.iter_mut().zip(u).chain(out_y.iter_mut().zip(v)) {
            *out = from + by;
        }
    }

    /// D = q + Σ w (…) / Σ w; q where there is no weight at all.
    pub(super) fn add_mean(
        span: KernelSpan,
        moved_x: &[f32],
        moved_y: &[f32],
        weight_sum: &[f32],
        out_x: &mut [f32],
        out_y: &mut [f32],
    ) {
        let n = out_x.len();
        let (moved_x, moved_y, weight_sum, out_y) = (&moved_x[..n], &moved_y[..n], &weight_sum[..n], &mut out_y[..n]);
        let (x, y) = (&span.x[..n], &span.y[..n]);
        for k in 0..n {
            let share = if weight_sum[k] > 0.0 { 1.0 / weight_sum[k] } else { 0.0 };
            out_x[k] = x[k] + moved_x[k] * share;
            out_y[k] = y[k] + moved_y[k] * share;
        }
    }

    /// r̄ over a row.
    pub(super) fn mirror_row(nbar_x: &[f32], nbar_y: &[f32], nz: &[f32], out_x: &mut [f32], out_y: &mut [f32]) {
        let n = out_x.len();
        let (nbar_x, nbar_y, nz, out_y) = (&nbar_x[..n], &nbar_y[..n], &nz[..n], &mut out_y[..n]);
        for k in 0..n {
            (out_x[k], out_y[k]) = mirrored(nbar_x[k], nbar_y[k], nz[k]);
        }
    }
}

/// Shepard's weight at any power, relative to the nearest anchor's. `powf` is a call: this one
/// stays scalar.
pub(super) fn inverse_powers(
    span: KernelSpan,
    pin: &FastPin,
    power: f32,
    nearest: &[f32],
    weight: &mut [f32],
    weight_sum: &mut [f32],
) {
    for (k, (w, sum)) in weight.iter_mut().zip(weight_sum).enumerate() {
        *w = (nearest[k] / distance_squared(span, pin, k).max(AT_ANCHOR)).powf(0.5 * power);
        *sum += *w;
    }
}

/// r̄ of one pixel: `reflection::mirrored` with a polynomial for the arc tangent.
#[inline(always)]
pub(super) fn mirrored(nbar_x: f32, nbar_y: f32, nz: f32) -> (f32, f32) {
    let length = (nbar_x * nbar_x + nbar_y * nbar_y).sqrt();
    let factor = std::f32::consts::FRAC_2_PI * half_plane_angle(length, nz) / length.max(1e-20);
    (nbar_x * factor, nbar_y * factor)
}

/// atan2(y, x) for `y ≥ 0`, (x, y) not both 0; within 10⁻⁶.
#[inline(always)]
fn half_plane_angle(y: f32, x: f32) -> f32 {
    let (low, high) = (y.min(x.abs()), y.max(x.abs()));
    let t = low / high.max(1e-20);
    let s = t * t;
    let mut angle = t * ATAN.iter().rev().fold(0.0, |sum, c| sum * s + c);
    angle = if y > x.abs() { std::f32::consts::FRAC_PI_2 - angle } else { angle };
    if x < 0.0 { std::f32::consts::PI - angle } else { angle }
}

/// atan(t)/t as a polynomial of t² over [0, 1]: a least-squares fit at Chebyshev nodes, within
/// 3·10⁻⁸.
const ATAN: [f32; 9] = [
    0.999_999_98,
    -0.333_330_67,
    0.199_924_84,
    -0.142_025_7,
    0.106_367_54,
    -0.074_954_45,
    0.042_587_61,
    -0.016_005_03,
    0.002_834_064,
];
