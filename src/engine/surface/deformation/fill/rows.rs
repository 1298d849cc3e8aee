//! D of one dab over the rows of a part of a tile: most dabs are a few short rows, and what `fill`
//! does for each row of a larger picture would cost more than its pixels. Floor 2. The same bits as
//! `fill`, which paints what this one leaves.

use super::kernels::{DepthKernel, MirrorKernel, NormalKernel, OffsetKernel, mirrored};
use super::{FastPin, Kernel, MapSpan};
use crate::math::{Mat2, Rect, Vec2, simd::prefetch};
use crate::surface::Surface;
use crate::surface::deformation::{Deformation, LaidPlanes};
use std::ops::Range;

/// D in some columns of each row of `rect`; `false`, and nothing is written, where that is not one
/// anchor's plain offset over pixels that the maps hold.
pub(in crate::surface::deformation) fn try_fill_dab(
    deformation: &Deformation,
    rect: Rect,
    columns: impl Fn(i32) -> Range<i32>,
    out_x: &mut [f32],
    out_y: &mut [f32],
) -> bool {
    let (Some(surface), [pin]) = (deformation.surface, &deformation.pins[..]) else { return false };
    let is_plain = deformation.curvature.is_none() && !deformation.is_on_far_side();
    let kernel = Kernel::of(deformation);
    let is_held = rect.intersect(surface.size().rect()) == rect && !rect.is_empty();
    if !is_plain || !is_held {
        return false;
    }
    if let Some(planes) = &deformation.planes {
        return try_fill_laid(deformation, surface, planes, rect, columns, out_x, out_y);
    }
    if matches!(kernel, Kernel::Still) {
        return false;
    }
    let pin = kernel.pin(pin);
    let ask = |next: MapSpan| ask(surface, kernel, next);
    for_each_span(rect, columns, (out_x, out_y), ask, |y, span, out_x, out_y| {
        let first = deformation.center(span.x as i32, y).into();
        let (row, coverage) = (DabRow { first, pin }, span.of(surface.coverage_plane()));
        let [x, y, z] = surface.normal_planes();
        match kernel {
            Kernel::Still => {}
            Kernel::Depth(k) => {
                depth_row(row, coverage, span.of(surface.depth_plane()), k, out_x, out_y)
            }
            Kernel::Normal(k) => normal_row(row, coverage, span.of(x), span.of(y), k, out_x, out_y),
            Kernel::Mirror(k) => fill_mirrored_row(
                row,
                coverage,
                [x, y, z].map(|plane| span.of(plane)),
                k,
                out_x,
                out_y,
            ),
        }
    });
    true
}

/// Fills some columns of each row of `rect`, the top one first.
///
/// * `ask`: prefetches what the row after it reads.
/// * `fill`: takes a row's number, its span and D there.
#[inline(always)]
fn for_each_span(
    rect: Rect,
    columns: impl Fn(i32) -> Range<i32>,
    (out_x, out_y): (&mut [f32], &mut [f32]),
    ask: impl Fn(MapSpan),
    mut fill: impl FnMut(i32, MapSpan, &mut [f32], &mut [f32]),
) {
    let span_of = |y: i32| span_of(rect, columns(y), y);
    let width = rect.width();
    let rows = out_x.chunks_exact_mut(width).zip(out_y.chunks_exact_mut(width));
    let mut next = span_of(rect.y0);
    for (y, (out_x, out_y)) in (rect.y0..rect.y1).zip(rows) {
        let span = next;
        if y + 1 < rect.y1 {
            next = span_of(y + 1);
            ask(next);
        }
        let start = span.x - rect.x0 as usize;
        fill(y, span, &mut out_x[start..start + span.n], &mut out_y[start..start + span.n]);
    }
}

/// Some columns of a row of `rect`, which the maps hold.
#[inline(always)]
fn span_of(rect: Rect, columns: Range<i32>, y: i32) -> MapSpan {
    let (start, end) = (columns.start.max(rect.x0), columns.end.min(rect.x1));
    MapSpan { x: start.max(0) as usize, y: y as usize, n: (end - start).max(0) as usize }
}

/// The same for a dab on the unwrapped surface: what other objects cover lies out of its reach.
fn try_fill_laid(
    deformation: &Deformation,
    surface: &Surface,
    planes: &LaidPlanes,
    rect: Rect,
    columns: impl Fn(i32) -> Range<i32>,
    out_x: &mut [f32],
    out_y: &mut [f32],
) -> bool {
    let [fit] = planes.fits() else { return false };
    if fit.pulled.is_some() {
        return false;
    }
    let [u, v] = planes.unwrapping.planes();
    let ask = |next: MapSpan| {
        [u, v].into_iter().for_each(|plane| prefetch(next.of(plane)));
        prefetch(next.of(planes.objects.labels()));
        prefetch(next.of(surface.coverage_plane()));
        prefetch(next.of(surface.smooth_links_plane()));
    };
    for_each_span(rect, columns, (out_x, out_y), ask, |y, span, out_x, out_y| {
        let first = deformation.center(span.x as i32, y).into();
        let row = LaidRow {
            first,
            object: fit.object,
            linear: fit.linear,
            shift: fit.shift,
            away: planes.default_shift_px(),
        };
        let coverage = span.of(surface.coverage_plane());
        fill_laid_dab_row(
            row,
            coverage,
            span.of(planes.objects.labels()),
            span.of(u),
            span.of(v),
            out_x,
            out_y,
        );
    });
    true
}

/// A row of pixels, and how the plane of a dab's object is laid.
#[derive(Clone, Copy)]
struct LaidRow {
    /// The center of the first pixel.
    first: (f32, f32),
    object: u32,
    linear: Mat2,
    shift: Vec2,
    /// What is added on other objects.
    away: f32,
}

/// Prefetches what a dab reads of a row, also the links of its pixels, which are read after D.
fn ask(surface: &Surface, kernel: Kernel, span: MapSpan) {
    prefetch(span.of(surface.coverage_plane()));
    prefetch(span.of(surface.smooth_links_plane()));
    let [x, y, z] = surface.normal_planes();
    match kernel {
        Kernel::Still => {}
        Kernel::Depth(_) => prefetch(span.of(surface.depth_plane())),
        Kernel::Normal(_) => [x, y].into_iter().for_each(|plane| prefetch(span.of(plane))),
        Kernel::Mirror(_) => [x, y, z].into_iter().for_each(|plane| prefetch(span.of(plane))),
    }
}

/// A row of pixels and the anchor of their dab.
#[derive(Clone, Copy)]
struct DabRow {
    /// The center of the first pixel.
    first: (f32, f32),
    pin: FastPin,
}

impl DabRow {
    /// D of the `k`th pixel, whose map values are `a` and `b`.
    #[inline(always)]
    fn d(
        self,
        k: usize,
        coverage: u8,
        (a, b): (f32, f32),
        kernel: impl OffsetKernel,
    ) -> (f32, f32) {
        let pin = self.pin;
        // Through i32: AVX2 converts no 64-bit integers.
        let (x, y) = (self.first.0 + k as i32 as f32, self.first.1);
        let (dx, dy) = kernel.offset(x - pin.x, y - pin.y, a, b, &pin);
        let gain = if coverage > 0 { 1.0 } else { 0.0 };
        (x + (gain * dx + pin.move_x), y + (gain * dy + pin.move_y))
    }
}

crate::widest! {
    fn fill_laid_dab_row(
        row: LaidRow,
        coverage: &[u8],
        objects: &[u32],
        u: &[f32],
        v: &[f32],
        out_x: &mut [f32],
        out_y: &mut [f32],
    ) {
        let n = out_x.len();
        let (coverage, objects, u, v, out_y) = (&coverage[..n], &objects[..n], &u[..n], &v[..n], &mut out_y[..n]);
        let ([xx, yx], [xy, yy]) = (row.linear.x_axis.to_array(), row.linear.y_axis.to_array());
        for k in 0..n {
            let is_own = objects[k] == row.object;
            let laid_x = xx * u[k] + xy * v[k] + row.shift.x;
            let laid_y = yx * u[k] + yy * v[k] + row.shift.y;
            let x = if is_own { laid_x } else { u[k] + row.away };
            let y = if is_own { laid_y } else { v[k] + row.away };
            let is_covered = coverage[k] > 0;
            out_x[k] = if is_covered { x } else { row.first.0 + k as i32 as f32 };
            out_y[k] = if is_covered { y } else { row.first.1 };
        }
    }

    fn depth_row(
        row: DabRow,
        coverage: &[u8],
        z: &[f32],
        kernel: DepthKernel,
        out_x: &mut [f32],
        out_y: &mut [f32],
    ) {
        let n = out_x.len();
        let (coverage, z, out_y) = (&coverage[..n], &z[..n], &mut out_y[..n]);
        for k in 0..n {
            (out_x[k], out_y[k]) = row.d(k, coverage[k], (z[k], 0.0), kernel);
        }
    }

    fn normal_row(
        row: DabRow,
        coverage: &[u8],
        x: &[f32],
        y: &[f32],
        kernel: NormalKernel,
        out_x: &mut [f32],
        out_y: &mut [f32],
    ) {
        let n = out_x.len();
        let (coverage, x, y, out_y) = (&coverage[..n], &x[..n], &y[..n], &mut out_y[..n]);
        for k in 0..n {
            (out_x[k], out_y[k]) = row.d(k, coverage[k], (x[k], y[k]), kernel);
        }
    }

    fn fill_mirrored_row(
        row: DabRow,
        coverage: &[u8],
        normals: [&[f32]; 3],
        kernel: MirrorKernel,
        out_x: &mut [f32],
        out_y: &mut [f32],
    ) {
        let n = out_x.len();
        let ([x, y, z], coverage, out_y) = (normals.map(|plane| &plane[..n]), &coverage[..n], &mut out_y[..n]);
        for k in 0..n {
            (out_x[k], out_y[k]) = row.d(k, coverage[k], mirrored(x[k], y[k], z[k]), kernel);
        }
    }
}
