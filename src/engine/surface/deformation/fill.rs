//! D over whole rows: the fast twin of `Deformation::at`, in plain loops that the compiler
//! vectorizes. Floor 2. The operator and the number of anchors are dispatched once per row, outside
//! the pixel loops.

mod kernels;
mod rows;

pub(super) use rows::try_fill_dab;

use super::{Deformation, LaidPlanes, Pin};
use crate::math::{Rect, simd::prefetch};
use crate::raster::Plane;
use crate::surface::Surface;
use crate::surface::anchor::{Weights, segment_slope};
use crate::surface::operator::{Operator, first_order, reflection, second_order};
use kernels::{
    DepthKernel, KernelSpan, MirrorKernel, NormalKernel, add_mean, coverage_gain, depth_add,
    depth_one, fill_laid_row, fill_pulled_row, fill_shifted_row, inverse_powers, inverse_squares,
    mirror_add, mirror_one, mirror_row, nearer, normal_add, normal_one, segment_weights, still_add,
    still_one,
};
use std::ops::Range;

/// Pixels in flight: the scratch rows of a span (3.5 KiB) stay in the first-level cache.
const SPAN: usize = 128;

/// Fills `out_x`, `out_y` (one value per pixel of `rect`) with D, in the given columns of each row.
pub(super) fn fill(
    deformation: &Deformation,
    rect: Rect,
    columns: impl Fn(i32) -> Range<i32>,
    out_x: &mut [f32],
    out_y: &mut [f32],
) {
    let width = rect.width();
    if width == 0 {
        return;
    }
    if deformation.is_identity() {
        let rows = out_x.chunks_exact_mut(width).zip(out_y.chunks_exact_mut(width));
        for (y, (row_x, row_y)) in (rect.y0..).zip(rows) {
            deformation.place(rect.x0, y, row_x, row_y);
        }
        return;
    }
    let map = deformation.surface.map_or(Rect::EMPTY, |s| s.size().rect());
    let unwrapped = deformation.planes.as_ref().zip(deformation.surface);
    let plan = FillPlan::new(deformation);
    let mut scratch = SpanScratch::default();
    let rows = out_x.chunks_exact_mut(width).zip(out_y.chunks_exact_mut(width));
    for (y, (row_x, row_y)) in (rect.y0..).zip(rows) {
        let columns = columns(y);
        let (mut x, stop) = (columns.start.max(rect.x0), columns.end.min(rect.x1));
        while x < stop {
            // A span lies wholly inside the maps' columns or wholly outside.
            let inside = map.contains(x, y);
            let end = if inside {
                map.x1
            } else if x < map.x0 {
                map.x0
            } else {
                stop
            };
            let n = (end.min(stop) - x).min(SPAN as i32) as usize;
            let at = (x - rect.x0) as usize;
            let maps = inside.then_some(MapSpan { x: x as usize, y: y as usize, n });
            if inside && y + 1 < map.y1 {
                let next = MapSpan { x: x as usize, y: y as usize + 1, n };
                plan.prefetch(next);
                if let Some((planes, _)) = unwrapped {
                    prefetch_laid(planes, next);
                }
            }
            let (out_x, out_y) = (&mut row_x[at..at + n], &mut row_y[at..at + n]);
            let is_laid = unwrapped.zip(maps).is_some_and(|((planes, surface), maps)| {
                try_laid_span(planes, surface, maps, out_x, out_y)
            });
            if !is_laid {
                let [place_x, place_y] = &mut scratch.place;
                deformation.place(x, y, &mut place_x[..n], &mut place_y[..n]);
                plan.span(maps, &mut scratch, out_x, out_y);
            }
            if let Some(((planes, surface), maps)) = unwrapped.zip(maps).filter(|_| !is_laid) {
                fill_laid(planes, surface, maps, out_x, out_y);
            }
            x += n as i32;
        }
    }
}

/// D_s over a span that the surface covers wholly; `false` where it does not, and nothing is
/// written.
fn try_laid_span(
    planes: &LaidPlanes,
    surface: &Surface,
    at: MapSpan,
    out_x: &mut [f32],
    out_y: &mut [f32],
) -> bool {
    if at.of(surface.coverage_plane()).contains(&0) {
        return false;
    }
    let [u, v] = planes.unwrapping.planes().map(|plane| at.of(plane));
    let objects = at.of(planes.objects.labels());
    // Without an early end the loop is vectorized.
    let one = objects.iter().fold(0, |differs, object| differs | (object ^ objects[0])) == 0;
    match planes.fits().iter().find(|fit| fit.object == objects[0]).filter(|_| one) {
        Some(fit) => match fit.pulled.zip(planes.displacement.as_ref()) {
            Some((pulled, displacement)) => {
                let by = displacement.planes().map(|plane| at.of(plane));
                fill_pulled_row([u, v], by, (fit.linear, fit.shift, pulled), out_x, out_y);
            }
            None => fill_laid_row(u, v, fit.linear, fit.shift, out_x, out_y),
        },
        None if one && planes.fits().iter().all(|fit| fit.object != objects[0]) => {
            let away = planes.default_shift_px();
            fill_shifted_row(u, v, away, out_x, out_y);
        }
        None => fill_laid(planes, surface, at, out_x, out_y),
    }
    true
}

/// Prefetches what D_s reads of a span.
fn prefetch_laid(planes: &LaidPlanes, span: MapSpan) {
    planes.unwrapping.planes().into_iter().for_each(|plane| prefetch(span.of(plane)));
    prefetch(span.of(planes.objects.labels()));
    if let Some(displacement) = &planes.displacement {
        displacement.planes().into_iter().for_each(|plane| prefetch(span.of(plane)));
    }
}

/// D_s at the pixels of a span that the surface covers, one by one: where objects meet, and at
/// edges.
fn fill_laid(
    planes: &LaidPlanes,
    surface: &Surface,
    at: MapSpan,
    out_x: &mut [f32],
    out_y: &mut [f32],
) {
    for (k, (out_x, out_y)) in out_x.iter_mut().zip(out_y).enumerate() {
        if surface.coverage(at.x + k, at.y) > 0 {
            (*out_x, *out_y) = planes.at(at.x + k, at.y).into();
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
struct SpanScratch {
    /// The pixels' centers.
    place: [[f32; SPAN]; 2],
    /// r̄, where the operator needs it.
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

impl Default for SpanScratch {
    fn default() -> Self {
        let row = [0.0; SPAN];
        Self {
            place: [row; 2],
            mirrored: [row; 2],
            gain: row,
            weight: row,
            weight_sum: row,
            nearest: row,
            moved: [row; 2],
        }
    }
}

const NOTHING: [f32; SPAN] = [0.0; SPAN];
/// The gain where all is surface.
const WHOLE: [f32; SPAN] = [1.0; SPAN];

/// What is constant over all pixels.
struct FillPlan<'d> {
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

impl Kernel {
    fn of(deformation: &Deformation) -> Self {
        let unit_px = deformation.unit_px;
        match deformation.operator {
            _ if deformation.surface.is_none() => Kernel::Still,
            operator if operator.is_identity() => Kernel::Still,
            Operator::None | Operator::Surface { .. } => Kernel::Still,
            Operator::Depth { gamma } => {
                Kernel::Depth(DepthKernel { rate: first_order::rate(gamma) })
            }
            Operator::Normal { alpha, beta, .. } => Kernel::Normal(NormalKernel {
                alpha_px: alpha * unit_px,
                softness: second_order::softness(beta),
            }),
            Operator::Reflection { alpha, .. } => {
                Kernel::Mirror(MirrorKernel { alpha_px: alpha * unit_px })
            }
        }
    }

    fn pin(self, &Pin { anchor, map_values }: &Pin) -> FastPin {
        let [a, b] = match self {
            Kernel::Still => [0.0; 2],
            Kernel::Depth(_) => [map_values.depth, 0.0],
            Kernel::Normal(_) => map_values.nbar.to_array(),
            Kernel::Mirror(_) => reflection::mirrored(map_values.nbar, map_values.nz).to_array(),
        };
        let moved = anchor.source - anchor.at;
        FastPin { x: anchor.at.x, y: anchor.at.y, a, b, move_x: moved.x, move_y: moved.y }
    }
}

impl<'d> FillPlan<'d> {
    fn new(deformation: &'d Deformation<'d>) -> Self {
        let kernel = Kernel::of(deformation);
        Self {
            deformation,
            pins: deformation.pins.iter().map(|pin| kernel.pin(pin)).collect(),
            kernel,
            slope: match deformation.weights {
                Weights::Segment => segment_slope(&deformation.anchors()).to_array(),
                Weights::Shepard { .. } => [0.0; 2],
            },
        }
    }

    /// Prefetches what a span of the maps holds.
    fn prefetch(&self, span: MapSpan) {
        let Some(surface) = self.deformation.surface else { return };
        prefetch(span.of(surface.coverage_plane()));
        let [nbar_x, nbar_y, nz] = surface.normal_planes();
        match self.kernel {
            Kernel::Still => {}
            Kernel::Depth(_) => prefetch(span.of(surface.depth_plane())),
            Kernel::Normal(_) => [nbar_x, nbar_y].into_iter().for_each(|p| prefetch(span.of(p))),
            Kernel::Mirror(_) => {
                [nbar_x, nbar_y, nz].into_iter().for_each(|p| prefetch(span.of(p)))
            }
        }
    }

    /// 0 outside the surface, 1 + μκ on it; `scratch` as long as the span.
    fn gains<'s>(&self, surface: &Surface, span: MapSpan, scratch: &'s mut [f32]) -> &'s [f32] {
        let coverage = span.of(surface.coverage_plane());
        let is_detailed = self.deformation.curvature.is_some();
        if !is_detailed && coverage.iter().fold(u8::MAX, |least, &c| least.min(c)) > 0 {
            return &WHOLE[..span.n];
        }
        coverage_gain(coverage, scratch);
        if is_detailed {
            for (x, gain) in (span.x..).zip(&mut *scratch) {
                *gain *= self.deformation.detail_gain(x, span.y);
            }
        }
        scratch
    }

    /// D over a span whose pixels are placed in the scratch; `maps` is `None` beyond the maps.
    fn span(
        &self,
        maps: Option<MapSpan>,
        scratch: &mut SpanScratch,
        out_x: &mut [f32],
        out_y: &mut [f32],
    ) {
        let n = out_x.len();
        let SpanScratch { place: [x, y], mirrored, gain, weight, weight_sum, nearest, moved } =
            scratch;
        let surface = self.deformation.surface;
        let (mut a, mut b) = (&NOTHING[..n], &NOTHING[..n]);
        let mut gains = &NOTHING[..n];
        if let (Some(span), Some(surface)) = (maps, surface) {
            gains = self.gains(surface, span, &mut gain[..n]);
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
        let span = KernelSpan { x: &x[..n], y: &y[..n], a, b, gain: gains };
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
                Weights::Shepard { power } => {
                    inverse_powers(span, pin, power, &nearest[..n], weight, weight_sum)
                }
                Weights::Segment => {
                    segment_weights(span, &self.pins[0], self.slope, i, weight, weight_sum)
                }
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
