//! D over whole rows: the fast twin of `Deformation::at`, in plain loops that the compiler vectorises.
//! Floor 2. Operator kind and number of anchors are chosen once a row, outside the pixel loops.

use super::{Deformation, Pin};
use crate::math::{Rect, simd::prefetch};
use crate::raster::Plane;
use crate::surface::anchor::{Weights, segment_slope};
use crate::surface::operator::{Operator, first_order, reflection, second_order};

/// Pixels in flight: the scratch rows of a span (3.5 KiB) stay in the first-level cache.
const SPAN: usize = 128;

/// Fills `out_x`, `out_y` (one value per pixel of `rect`) with D.
pub(super) fn fill(deformation: &Deformation, rect: Rect, out_x: &mut [f32], out_y: &mut [f32]) {
    let width = rect.width();
    if width == 0 {
        return;
    }
    if deformation.is_identity() {
        let rows = out_x.chunks_exact_mut(width).zip(out_y.chunks_exact_mut(width));
        for (y, (row_x, row_y)) in (rect.y0..).zip(rows) {
            row_x.iter_mut().zip(rect.x0..).for_each(|(out, x)| *out = x as f32 + 0.5);
            row_y.fill(y as f32 + 0.5);
        }
        return;
    }
    let map = deformation.surface.map_or(Rect::EMPTY, |s| s.size().rect());
    let plan = Plan::new(deformation);
    let mut scratch = Scratch::default();
    let rows = out_x.chunks_exact_mut(width).zip(out_y.chunks_exact_mut(width));
    for (y, (row_x, row_y)) in (rect.y0..).zip(rows) {
        let mut x = rect.x0;
        while x < rect.x1 {
            // A span lies wholly inside the maps' columns or wholly outside.
            let inside = map.contains(x, y);
            let end = if inside {
                map.x1
            } else if x < map.x0 {
                map.x0
            } else {
                rect.x1
            };
            let n = (end.min(rect.x1) - x).min(SPAN as i32) as usize;
            let at = (x - rect.x0) as usize;
            let maps = inside.then_some(MapSpan { x: x as usize, y: y as usize, n });
            if inside && y + 1 < map.y1 {
                plan.prefetch(MapSpan { x: x as usize, y: y as usize + 1, n });
            }
            plan.span(
                maps,
                x as f32 + 0.5,
                y as f32 + 0.5,
                &mut scratch,
                &mut row_x[at..at + n],
                &mut row_y[at..at + n],
            );
            x += n as i32;
        }
    }
}

/// A piece of a row of the maps.
#[derive(Clone, Copy)]
struct MapSpan {
    x: usize,
    y: usize,
    n: usize,
}

impl MapSpan {
    fn of<T: Copy>(self, plane: &Plane<T>) -> &[T] {
        &plane.row(self.y)[self.x..self.x + self.n]
    }
}

/// Rows of intermediate values, one per pixel of a span.
struct Scratch {
    /// r̄, where the operator asks for it.
    mirrored: [[f32; SPAN]; 2],
    /// 0 outside the surface, 1 + μκ on it.
    gain: [f32; SPAN],
    /// One anchor's weight, before they are made to add up to 1.
    weight: [f32; SPAN],
    weight_sum: [f32; SPAN],
    /// Squared distance to the nearest anchor.
    nearest: [f32; SPAN],
    moved: [[f32; SPAN]; 2],
}

impl Default for Scratch {
    fn default() -> Self {
        let row = [0.0; SPAN];
        Self { mirrored: [row; 2], gain: row, weight: row, weight_sum: row, nearest: row, moved: [row; 2] }
    }
}

const NOTHING: [f32; SPAN] = [0.0; SPAN];

/// What stays the same over all pixels.
struct Plan<'d> {
    deformation: &'d Deformation<'d>,
    pins: Vec<FastPin>,
    kernel: Kernel,
    /// Of the segment, for its weights.
    slope: [f32; 2],
}

/// An anchor with the two map values its operator compares.
#[derive(Clone, Copy)]
struct FastPin {
    x: f32,
    y: f32,
    a: f32,
    b: f32,
    move_x: f32,
    move_y: f32,
}

#[derive(Clone, Copy)]
enum Kernel {
    Still,
    Depth(DepthKernel),
    Normal(NormalKernel),
    Mirror(MirrorKernel),
}

impl<'d> Plan<'d> {
    fn new(deformation: &'d Deformation<'d>) -> Self {
        let unit_px = deformation.unit_px;
        let kernel = match deformation.operator {
            _ if deformation.surface.is_none() => Kernel::Still,
            operator if operator.is_identity() => Kernel::Still,
            Operator::None => Kernel::Still,
            Operator::Depth { gamma } => Kernel::Depth(DepthKernel { rate: first_order::rate(gamma) }),
            Operator::Normal { alpha, beta, .. } => {
                Kernel::Normal(NormalKernel { alpha_px: alpha * unit_px, softness: second_order::softness(beta) })
            }
            Operator::Reflection { alpha, .. } => Kernel::Mirror(MirrorKernel { alpha_px: alpha * unit_px }),
        };
        let pin = |&Pin { anchor, reading }: &Pin| {
            let [a, b] = match kernel {
                Kernel::Still => [0.0; 2],
                Kernel::Depth(_) => [reading.depth, 0.0],
                Kernel::Normal(_) => reading.nbar.to_array(),
                Kernel::Mirror(_) => reflection::mirrored(reading.nbar, reading.nz).to_array(),
            };
            let moved = anchor.source - anchor.at;
            FastPin { x: anchor.at.x, y: anchor.at.y, a, b, move_x: moved.x, move_y: moved.y }
        };
        Self {
            deformation,
            pins: deformation.pins.iter().map(pin).collect(),
            kernel,
            slope: segment_slope(&deformation.anchors()).to_array(),
        }
    }
    /// Asks for what a span of the maps holds.
    fn prefetch(&self, span: MapSpan) {
        let Some(surface) = self.deformation.surface else { return };
        prefetch(span.of(surface.coverage_plane()));
        let [nbar_x, nbar_y, nz] = surface.normal_planes();
        match self.kernel {
            Kernel::Still => {}
            Kernel::Depth(_) => prefetch(span.of(surface.depth_plane())),
            Kernel::Normal(_) => [nbar_x, nbar_y].into_iter().for_each(|p| prefetch(span.of(p))),
            Kernel::Mirror(_) => [nbar_x, nbar_y, nz].into_iter().for_each(|p| prefetch(span.of(p))),
        }
    }
    /// D over a span whose first pixel has its centre at (x, y); `maps` is `None` beyond the maps.
    fn span(&self, maps: Option<MapSpan>, x: f32, y: f32, scratch: &mut Scratch, out_x: &mut [f32], out_y: &mut [f32]) {
        let n = out_x.len();
        let Scratch { mirrored, gain, weight, weight_sum, nearest, moved } = scratch;
        let surface = self.deformation.surface;
        let (mut a, mut b) = (&NOTHING[..n], &NOTHING[..n]);
        gain[..n].fill(0.0);
        if let (Some(span), Some(surface)) = (maps, surface) {
            coverage_gain(span.of(surface.coverage_plane()), &mut gain[..n]);
            if self.deformation.curvature.is_some() {
                let pixels = (span.x..).zip(&mut gain[..n]);
                pixels.for_each(|(x, gain)| *gain *= self.deformation.detail_gain(x, span.y));
            }
            let [nbar_x, nbar_y, nz] = surface.normal_planes().map(|p| span.of(p));
            match self.kernel {
                Kernel::Still => {}
                Kernel::Depth(_) => a = span.of(surface.depth_plane()),
                Kernel::Normal(_) => (a, b) = (nbar_x, nbar_y),
                Kernel::Mirror(_) => {
                    let [mirrored_x, mirrored_y] = mirrored;
                    mirror_row(nbar_x, nbar_y, nz, &mut mirrored_x[..n], &mut mirrored_y[..n]);
                    (a, b) = (&mirrored_x[..n], &mirrored_y[..n]);
                }
            }
        }
        let span = Span { x, y, a, b, gain: &gain[..n] };
        if let [pin] = &self.pins[..] {
            return match self.kernel {
                Kernel::Still => still_one(span, pin, out_x, out_y),
                Kernel::Depth(k) => depth_one(span, pin, k, out_x, out_y),
                Kernel::Normal(k) => normal_one(span, pin, k, out_x, out_y),
                Kernel::Mirror(k) => mirror_one(span, pin, k, out_x, out_y),
            };
        }
        let [moved_x, moved_y] = moved;
        let (moved_x, moved_y) = (&mut moved_x[..n], &mut moved_y[..n]);
        let (weight, weight_sum) = (&mut weight[..n], &mut weight_sum[..n]);
        moved_x.fill(0.0);
        moved_y.fill(0.0);
        weight_sum.fill(0.0);
        let weights = self.deformation.weights;
        if let Weights::Shepard { power } = weights
            && power != 2.0
        {
            nearest[..n].fill(f32::INFINITY);
            self.pins.iter().for_each(|pin| nearer(span, pin, &mut nearest[..n]));
        }
        for (i, pin) in self.pins.iter().enumerate() {
            match weights {
                Weights::Shepard { power: 2.0 } => inverse_squares(span, pin, weight, weight_sum),
                Weights::Shepard { power } => inverse_powers(span, pin, power, &nearest[..n], weight, weight_sum),
                Weights::Segment => segment_weights(span, &self.pins[0], self.slope, i, weight, weight_sum),
            }
            match self.kernel {
                Kernel::Still => still_add(span, pin, weight, moved_x, moved_y),
                Kernel::Depth(k) => depth_add(span, pin, k, weight, moved_x, moved_y),
                Kernel::Normal(k) => normal_add(span, pin, k, weight, moved_x, moved_y),
                Kernel::Mirror(k) => mirror_add(span, pin, k, weight, moved_x, moved_y),
            }
        }
        add_mean(span, moved_x, moved_y, weight_sum, out_x, out_y);
    }
}

/// The pixels of a row: centre of the first, and what the maps hold.
#[derive(Clone, Copy)]
struct Span<'s> {
    x: f32,
    y: f32,
    a: &'s [f32],
    b: &'s [f32],
    gain: &'s [f32],
}

/// offset_i of one pixel: (q − q_i, its two map values, the anchor) → canvas px.
trait Offset: Copy {
    fn offset(self, from_x: f32, from_y: f32, a: f32, b: f32, pin: &FastPin) -> (f32, f32);
}

#[derive(Clone, Copy)]
struct StillKernel;
#[derive(Clone, Copy)]
struct DepthKernel {
    rate: f32,
}
#[derive(Clone, Copy)]
struct NormalKernel {
    alpha_px: f32,
    softness: f32,
}
#[derive(Clone, Copy)]
struct MirrorKernel {
    alpha_px: f32,
}

impl Offset for StillKernel {
    #[inline(always)]
    fn offset(self, _: f32, _: f32, _: f32, _: f32, _: &FastPin) -> (f32, f32) {
        (0.0, 0.0)
    }
}
impl Offset for DepthKernel {
    #[inline(always)]
    fn offset(self, from_x: f32, from_y: f32, z: f32, _: f32, pin: &FastPin) -> (f32, f32) {
        let f = first_order::scale_factor_of_rate(z - pin.a, self.rate);
        (f * from_x, f * from_y)
    }
}
impl Offset for NormalKernel {
    #[inline(always)]
    fn offset(self, _: f32, _: f32, nbar_x: f32, nbar_y: f32, pin: &FastPin) -> (f32, f32) {
        let (dx, dy) = (nbar_x - pin.a, nbar_y - pin.b);
        let f = second_order::offset_factor_of_softness((dx * dx + dy * dy).sqrt(), self.alpha_px, self.softness);
        (f * dx, f * dy)
    }
}
impl Offset for MirrorKernel {
    #[inline(always)]
    fn offset(self, _: f32, _: f32, mirrored_x: f32, mirrored_y: f32, pin: &FastPin) -> (f32, f32) {
        (self.alpha_px * (mirrored_x - pin.a), self.alpha_px * (mirrored_y - pin.b))
    }
}

/// D with a single anchor, whose weight is 1.
#[inline(always)]
fn one(span: Span, pin: &FastPin, kernel: impl Offset, out_x: &mut [f32], out_y: &mut [f32]) {
    let n = out_x.len();
    let (a, b, gain, out_y) = (&span.a[..n], &span.b[..n], &span.gain[..n], &mut out_y[..n]);
    for k in 0..n {
        let (x, y) = (span.x + k as i32 as f32, span.y);
        let (dx, dy) = kernel.offset(x - pin.x, y - pin.y, a[k], b[k], pin);
        out_x[k] = x + (gain[k] * dx + pin.move_x);
        out_y[k] = y + (gain[k] * dy + pin.move_y);
    }
}

/// Adds one of several anchors: `moved += w (offset + s − q_i)`.
#[inline(always)]
fn add(span: Span, pin: &FastPin, kernel: impl Offset, weight: &[f32], moved_x: &mut [f32], moved_y: &mut [f32]) {
    let n = moved_x.len();
    let (a, b, gain, weight) = (&span.a[..n], &span.b[..n], &span.gain[..n], &weight[..n]);
    let moved_y = &mut moved_y[..n];
    for k in 0..n {
        let (x, y) = (span.x + k as i32 as f32, span.y);
        let (dx, dy) = kernel.offset(x - pin.x, y - pin.y, a[k], b[k], pin);
        moved_x[k] += weight[k] * (gain[k] * dx + pin.move_x);
        moved_y[k] += weight[k] * (gain[k] * dy + pin.move_y);
    }
}

/// Squared distance below which a pixel stands at an anchor: smaller ones no f32 canvas coordinate tells apart.
const AT_ANCHOR: f32 = 1e-12;

#[inline(always)]
fn distance_squared(span: Span, pin: &FastPin, k: usize) -> f32 {
    let (dx, dy) = (span.x + k as i32 as f32 - pin.x, span.y - pin.y);
    dx * dx + dy * dy
}

crate::widest! {
    fn still_one(span: Span, pin: &FastPin, out_x: &mut [f32], out_y: &mut [f32]) {
        one(span, pin, StillKernel, out_x, out_y)
    }
    fn depth_one(span: Span, pin: &FastPin, kernel: DepthKernel, out_x: &mut [f32], out_y: &mut [f32]) {
        one(span, pin, kernel, out_x, out_y)
    }
    fn normal_one(span: Span, pin: &FastPin, kernel: NormalKernel, out_x: &mut [f32], out_y: &mut [f32]) {
        one(span, pin, kernel, out_x, out_y)
    }
    fn mirror_one(span: Span, pin: &FastPin, kernel: MirrorKernel, out_x: &mut [f32], out_y: &mut [f32]) {
        one(span, pin, kernel, out_x, out_y)
    }
    fn still_add(span: Span, pin: &FastPin, weight: &[f32], moved_x: &mut [f32], moved_y: &mut [f32]) {
        add(span, pin, StillKernel, weight, moved_x, moved_y)
    }
    fn depth_add(span: Span, pin: &FastPin, kernel: DepthKernel, weight: &[f32], moved_x: &mut [f32], moved_y: &mut [f32]) {
        add(span, pin, kernel, weight, moved_x, moved_y)
    }
    fn normal_add(span: Span, pin: &FastPin, kernel: NormalKernel, weight: &[f32], moved_x: &mut [f32], moved_y: &mut [f32]) {
        add(span, pin, kernel, weight, moved_x, moved_y)
    }
    fn mirror_add(span: Span, pin: &FastPin, kernel: MirrorKernel, weight: &[f32], moved_x: &mut [f32], moved_y: &mut [f32]) {
        add(span, pin, kernel, weight, moved_x, moved_y)
    }
    /// 1 on the surface, 0 outside.
    fn coverage_gain(coverage: &[u8], gain: &mut [f32]) {
        for (g, &c) in gain.iter_mut().zip(coverage) {
            *g = if c > 0 { 1.0 } else { 0.0 };
        }
    }
    /// Shepard's weight at power 2, not yet made to add up to 1.
    fn inverse_squares(span: Span, pin: &FastPin, weight: &mut [f32], weight_sum: &mut [f32]) {
        for (k, (w, sum)) in weight.iter_mut().zip(weight_sum).enumerate() {
            *w = 1.0 / distance_squared(span, pin, k).max(AT_ANCHOR);
            *sum += *w;
        }
    }
    fn nearer(span: Span, pin: &FastPin, nearest: &mut [f32]) {
        for (k, d) in nearest.iter_mut().enumerate() {
            *d = d.min(distance_squared(span, pin, k).max(AT_ANCHOR));
        }
    }
    /// The weight along the segment of anchor `i`, whose first anchor is `first`.
    fn segment_weights(
        span: Span,
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
            let along = (span.x + k as i32 as f32 - first.x) * slope[0] + (span.y - first.y) * slope[1];
            *w = offset + factor * along.max(0.0).min(1.0);
            *sum += *w;
        }
    }
    /// D = q + Σ w (…) / Σ w; q where there is no weight at all.
    fn add_mean(span: Span, moved_x: &[f32], moved_y: &[f32], weight_sum: &[f32], out_x: &mut [f32], out_y: &mut [f32]) {
        let n = out_x.len();
        let (moved_x, moved_y, weight_sum, out_y) = (&moved_x[..n], &moved_y[..n], &weight_sum[..n], &mut out_y[..n]);
        for k in 0..n {
            let share = if weight_sum[k] > 0.0 { 1.0 / weight_sum[k] } else { 0.0 };
            out_x[k] = span.x + k as i32 as f32 + moved_x[k] * share;
            out_y[k] = span.y + moved_y[k] * share;
        }
    }
    /// r̄ over a row: `reflection::mirrored` with a polynomial for the arc tangent.
    fn mirror_row(nbar_x: &[f32], nbar_y: &[f32], nz: &[f32], out_x: &mut [f32], out_y: &mut [f32]) {
        let n = out_x.len();
        let (nbar_x, nbar_y, nz, out_y) = (&nbar_x[..n], &nbar_y[..n], &nz[..n], &mut out_y[..n]);
        for k in 0..n {
            let length = (nbar_x[k] * nbar_x[k] + nbar_y[k] * nbar_y[k]).sqrt();
            let factor = std::f32::consts::FRAC_2_PI * half_plane_angle(length, nz[k]) / length.max(1e-20);
            out_x[k] = nbar_x[k] * factor;
            out_y[k] = nbar_y[k] * factor;
        }
    }
}

/// Shepard's weight at any power, relative to the nearest anchor's. `powf` is a call: this one stays scalar.
fn inverse_powers(span: Span, pin: &FastPin, power: f32, nearest: &[f32], weight: &mut [f32], weight_sum: &mut [f32]) {
    for (k, (w, sum)) in weight.iter_mut().zip(weight_sum).enumerate() {
        *w = (nearest[k] / distance_squared(span, pin, k).max(AT_ANCHOR)).powf(0.5 * power);
        *sum += *w;
    }
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

/// atan(t)/t as a polynomial of t² over [0, 1]: a least-squares fit at Chebyshev nodes, within 3·10⁻⁸.
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
