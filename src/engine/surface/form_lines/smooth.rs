//! Normals diffused along links, and their derivatives. Floor 2. Nothing crosses a broken
//! link.

use crate::math::{Vec2, parallel, vec2};
use crate::raster::Plane;
use crate::surface::cache::HeapSize;
use crate::surface::{Surface, links};
use rayon::prelude::*;

/// Unit normals, image axes: n̄_x, n̄_y and n_z.
pub struct SmoothNormals {
    /// One plane each.
    pub planes: [Plane<f32>; 3],
    /// σ, px.
    pub smooth_px: f32,
}

impl HeapSize for SmoothNormals {
    fn heap_bytes(&self) -> u64 {
        self.planes.iter().map(Plane::heap_bytes).sum()
    }
}

/// What one step of the diffusion moves along a link; four of them keep it stable.
const SHARE: f32 = 0.2;

impl SmoothNormals {
    /// The normals of a surface after a diffusion as wide as a Gaussian of σ px.
    pub(super) fn of(surface: &Surface, smooth_px: f32) -> Self {
        let links = surface.links_plane();
        let mut planes = surface.normal_planes().map(Plane::clone);
        planes.iter_mut().for_each(|plane| diffuse(plane, links, smooth_px));
        let [nx, ny, nz] = &mut planes;
        let (ny, nz) = (ny.values_mut().par_iter_mut(), nz.values_mut().par_iter_mut());
        nx.values_mut().par_iter_mut().zip(ny).zip(nz).with_min_len(1 << 12).for_each(
            |((x, y), z)| {
                let length = (*x * *x + *y * *y + *z * *z).sqrt();
                let scale = if length > 1e-6 { 1.0 / length } else { 0.0 };
                (*x, *y, *z) = (*x * scale, *y * scale, *z * scale);
            },
        );
        Self { planes, smooth_px }
    }

    /// n̄ at a pixel.
    #[inline(always)]
    pub fn nbar(&self, x: usize, y: usize) -> Vec2 {
        vec2(self.planes[0].at(x, y), self.planes[1].at(x, y))
    }

    /// n_z at a pixel.
    #[inline(always)]
    pub fn nz(&self, x: usize, y: usize) -> f32 {
        self.planes[2].at(x, y)
    }
}

/// A map diffused along the links of a surface, as wide as a Gaussian of σ px.
pub(in crate::surface) fn diffuse_copy(
    plane: &Plane<f32>,
    surface: &Surface,
    sigma_px: f32,
) -> Plane<f32> {
    let mut plane = plane.clone();
    diffuse(&mut plane, surface.links_plane(), sigma_px);
    plane
}

/// A map blurred along the links of a surface, about as wide as a Gaussian of σ px: for wide ones,
/// where its soft corners do not matter.
pub(in crate::surface) fn blur_copy(
    plane: &Plane<f32>,
    surface: &Surface,
    sigma_px: f32,
) -> Plane<f32> {
    let mut plane = plane.clone();
    if sigma_px > 0.0 {
        blur_along_links(&mut plane, surface.links_plane(), sigma_px);
    }
    plane
}

/// Diffuses a map along links, as wide as a Gaussian of σ px: a step adds variance 2 · 0.2 px² on
/// each axis. Wide ones are diffused on steps of several pixels first.
pub(in crate::surface) fn diffuse(plane: &mut Plane<f32>, links: &Plane<u8>, sigma_px: f32) {
    /// Steps of a pixel: more are taken over several pixels.
    const MOST_STEPS: f32 = 24.0;
    let steps = sigma_px * sigma_px / (2.0 * SHARE);
    if steps.is_nan() || steps <= 0.0 {
        return;
    }
    let mut other = Plane::full(plane.size(), 0.0f32);
    if steps > MOST_STEPS {
        // The variance that is left for the recursive blur.
        let wide = (sigma_px * sigma_px - 2.0 * SHARE * MOST_STEPS).sqrt();
        blur_along_links(plane, links, wide);
    }
    let count = steps.min(MOST_STEPS).ceil();
    let share = SHARE * steps.min(MOST_STEPS) / count;
    for _ in 0..count as usize {
        let width = plane.width().max(1);
        let from = &*plane;
        parallel::for_each_row(other.values_mut(), width, 8, |y, row| {
            let here = from.row(y);
            let above = from.row(y.saturating_sub(1));
            let below = from.row((y + 1).min(from.height() - 1));
            step_row(here, [above, below], links.row(y), share, row);
        });
        std::mem::swap(plane, &mut other);
    }
}

crate::widest! {
    /// One step of a row: `v + s Σ (neighbor − v)` over the links.
    fn step_row(here: &[f32], beside: [&[f32]; 2], linked: &[u8], share: f32, out: &mut [f32]) {
        let n = out.len();
        let (here, linked) = (&here[..n], &linked[..n]);
        let (above, below) = (&beside[0][..n], &beside[1][..n]);
        let inner = n.saturating_sub(2);
        if let Some(out) = out.get_mut(1..inner + 1) {
            let (left, own, right) = (&here[..inner], &here[1..=inner], &here[2..]);
            let (linked, above) = (&linked[1..=inner], &above[1..=inner]);
            let below = &below[1..=inner];
            for i in 0..inner {
                let cross = [left[i], right[i], above[i], below[i]];
                out[i] = step(own[i], cross, linked[i], share);
            }
        }
        // What lies at the ends of a row has no neighbors there.
        for x in [0, n - 1] {
            let (left, right) = (here[x.saturating_sub(1)], here[(x + 1).min(n - 1)]);
            out[x] = step(here[x], [left, right, above[x], below[x]], linked[x], share);
        }
    }
}

/// One step of a pixel whose neighbors are at the left, at the right, above and below.
#[inline(always)]
fn step(own: f32, [left, right, above, below]: [f32; 4], linked: u8, share: f32) -> f32 {
    let moved = |bit: u8, other: f32| (if linked & bit != 0 { share } else { 0.0 }) * (other - own);
    own + (moved(links::LEFT, left) + moved(links::RIGHT, right))
        + (moved(links::UP, above) + moved(links::DOWN, below))
}

/// A wide blur whose cost does not depend on its width: passes of a recursive filter (Gastal and
/// Oliveira 2011, sec. 5) that a broken link ends, half along rows first and half along columns.
fn blur_along_links(plane: &mut Plane<f32>, links: &Plane<u8>, sigma_px: f32) {
    let mut turned = plane.clone();
    for (plane, is_turned) in [(&mut *plane, false), (&mut turned, true)] {
        for pass in 0..3 {
            let sigma = sigma_px * 3f32.sqrt() * 2f32.powi(2 - pass) / 63f32.sqrt();
            let feedback = (-std::f32::consts::SQRT_2 / sigma).exp();
            if !is_turned {
                smooth_rows(plane, links, feedback);
            }
            smooth_columns(plane, links, feedback);
            if is_turned {
                smooth_rows(plane, links, feedback);
            }
        }
    }
    let mean = plane.values_mut().par_iter_mut().zip(turned.values().par_iter());
    mean.with_min_len(1 << 12).for_each(|(v, turned)| *v = 0.5 * (*v + *turned));
}

fn smooth_rows(plane: &mut Plane<f32>, links: &Plane<u8>, feedback: f32) {
    let width = plane.width().max(1);
    parallel::for_each_row(plane.values_mut(), width, 1, |y, row| {
        let linked = links.row(y);
        for x in 1..width {
            let share = if linked[x] & links::LEFT != 0 { feedback } else { 0.0 };
            row[x] += share * (row[x - 1] - row[x]);
        }
        for x in (0..width - 1).rev() {
            let share = if linked[x] & links::RIGHT != 0 { feedback } else { 0.0 };
            row[x] += share * (row[x + 1] - row[x]);
        }
    });
}

fn smooth_columns(plane: &mut Plane<f32>, links: &Plane<u8>, feedback: f32) {
    let (w, h) = (plane.width(), plane.height());
    let values = plane.values_mut();
    let mut toward = |y: usize, from: usize, bit: u8| {
        let (first, second) = values.split_at_mut(y.max(from) * w);
        let (row, from) = if y > from {
            (&mut second[..w], &first[from * w..])
        } else {
            (&mut first[y * w..], &second[..w])
        };
        for ((v, from), linked) in row.iter_mut().zip(from).zip(links.row(y)) {
            let share = if linked & bit != 0 { feedback } else { 0.0 };
            *v += share * (from - *v);
        }
    };
    (1..h).for_each(|y| toward(y, y - 1, links::UP));
    (0..h.max(1) - 1).rev().for_each(|y| toward(y, y + 1, links::DOWN));
}

/// ∇ of a map at a pixel, per px: the mean of the differences to linked neighbors.
#[inline(always)]
pub(in crate::surface) fn gradient_of(plane: &Plane<f32>, linked: u8, x: usize, y: usize) -> Vec2 {
    let side = |bit: u8| usize::from(linked & bit != 0);
    let (left, right) = (x - side(links::LEFT), x + side(links::RIGHT));
    let (up, down) = (y - side(links::UP), y + side(links::DOWN));
    let along = |from: f32, to: f32, px: usize| (to - from) / px.max(1) as f32;
    vec2(
        along(plane.at(left, y), plane.at(right, y), right - left),
        along(plane.at(x, up), plane.at(x, down), down - up),
    )
}

/// The same of every pixel of a row.
pub(super) fn gradient_row(
    plane: &Plane<f32>,
    links: &Plane<u8>,
    y: usize,
    across: &mut [f32],
    down: &mut [f32],
) {
    let (here, linked) = (plane.row(y), links.row(y));
    let above = plane.row(y.saturating_sub(1));
    let below = plane.row((y + 1).min(plane.height() - 1));
    slopes_across(here, linked, across);
    slopes_down([above, here, below], linked, down);
    // What lies at the ends of a row has no neighbors there.
    for x in [0, here.len() - 1] {
        across[x] = gradient_of(plane, linked[x], x, y).x;
    }
}

/// Half of the difference from before to after where both are linked, else the whole of it.
#[inline(always)]
fn slope([before, here, after]: [f32; 3], is_linked: [bool; 2]) -> f32 {
    let from = if is_linked[0] { before } else { here };
    let to = if is_linked[1] { after } else { here };
    (to - from) * if is_linked[0] & is_linked[1] { 0.5 } else { 1.0 }
}

crate::widest! {
    /// Slopes along a row, but at its ends.
    fn slopes_across(here: &[f32], linked: &[u8], out: &mut [f32]) {
        let Some(n) = out.len().checked_sub(2) else { return };
        let (before, own, after) = (&here[..n], &here[1..n + 1], &here[2..n + 2]);
        let (linked, out) = (&linked[1..n + 1], &mut out[1..n + 1]);
        for i in 0..n {
            let is_linked = [linked[i] & links::LEFT != 0, linked[i] & links::RIGHT != 0];
            out[i] = slope([before[i], own[i], after[i]], is_linked);
        }
    }

    /// Slopes from row to row.
    fn slopes_down(rows: [&[f32]; 3], linked: &[u8], out: &mut [f32]) {
        let n = out.len();
        let ([above, here, below], linked) = (rows.map(|row| &row[..n]), &linked[..n]);
        for i in 0..n {
            let is_linked = [linked[i] & links::UP != 0, linked[i] & links::DOWN != 0];
            out[i] = slope([above[i], here[i], below[i]], is_linked);
        }
    }
}
