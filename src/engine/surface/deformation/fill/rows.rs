//! D of one dab over the rows of a part of a tile: most dabs are a few short rows, and what `fill` does for each row of
//! a larger picture would cost more than its pixels.
//! Floor 2. The same bits as `fill`, which paints what this one leaves.

use super::kernels::{DepthKernel, MirrorKernel, NormalKernel, OffsetKernel, mirrored};
use super::{FastPin, Kernel, MapSpan};
use crate::math::{Rect, simd::prefetch};
use crate::surface::Surface;
use crate::surface::deformation::Deformation;
use std::ops::Range;

/// D in some columns of each row of `rect`; `false`, and nothing is written, where that is not one anchor's plain
/// offset over pixels that the maps hold.
pub(in crate::surface::deformation) fn fill_dab(
    deformation: &Deformation,
    rect: Rect,
    columns: impl Fn(i32) -> Range<i32>,
    out_x: &mut [f32],
    out_y: &mut [f32],
) -> bool {
    let (Some(surface), [pin]) = (deformation.surface, &deformation.pins[..]) else { return false };
    let is_plain = deformation.planes.is_none() && deformation.curvature.is_none() && deformation.sheet().is_none();
    let kernel = Kernel::of(deformation);
    let is_held = rect.intersect(surface.size().rect()) == rect && !rect.is_empty();
    if !is_plain || !is_held || matches!(kernel, Kernel::Still) {
        return false;
    }
    let pin = kernel.pinned(pin);
    let span_of = |y: i32| {
        let Range { start, end } = columns(y);
        let (start, end) = (start.max(rect.x0), end.min(rect.x1));
        MapSpan { x: start.max(0) as usize, y: y as usize, n: (end - start).max(0) as usize }
    };
    let width = rect.width();
    let rows = out_x.chunks_exact_mut(width).zip(out_y.chunks_exact_mut(width));
    let mut next = span_of(rect.y0);
    for (y, (out_x, out_y)) in (rect.y0..rect.y1).zip(rows) {
        let span = next;
        if y + 1 < rect.y1 {
            next = span_of(y + 1);
            ask(surface, kernel, next);
        }
        let start = span.x - rect.x0 as usize;
        let (out_x, out_y) = (&mut out_x[start..start + span.n], &mut out_y[start..start + span.n]);
        let first = deformation.centre(span.x as i32, y).into();
        let (row, coverage) = (DabRow { first, pin }, span.of(surface.coverage_plane()));
        let [x, y, z] = surface.normal_planes();
        match kernel {
            Kernel::Still => {}
            Kernel::Depth(k) => depth_row(row, coverage, span.of(surface.depth_plane()), k, out_x, out_y),
            Kernel::Normal(k) => normal_row(row, coverage, span.of(x), span.of(y), k, out_x, out_y),
            Kernel::Mirror(k) => mirrored_row(row, coverage, [x, y, z].map(|plane| span.of(plane)), k, out_x, out_y),
        }
    }
    true
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
    /// The centre of the first pixel.
    first: (f32, f32),
    pin: FastPin,
}

impl DabRow {
    /// D of the `k`th pixel, whose map values are `a` and `b`.
    #[inline(always)]
    fn d(self, k: usize, coverage: u8, (a, b): (f32, f32), kernel: impl OffsetKernel) -> (f32, f32) {
        let pin = self.pin;
        // Through i32: AVX2 converts no 64-bit integers.
        let (x, y) = (self.first.0 + k as i32 as f32, self.first.1);
        let (dx, dy) = kernel.offset(x - pin.x, y - pin.y, a, b, &pin);
        let gain = if coverage > 0 { 1.0 } else { 0.0 };
        (x + (gain * dx + pin.move_x), y + (gain * dy + pin.move_y))
    }
}

crate::widest! {
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
    fn mirrored_row(
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
