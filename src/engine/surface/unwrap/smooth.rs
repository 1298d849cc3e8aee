//! Normals blurred before a surface is unwrapped, so that fine relief does not shear a print.
//! Floor 2. The blur crosses neither the mask's edge nor a depth jump.

use crate::math::{Rect, parallel};
use crate::memory::fill_or_unwind;
use crate::surface::{Surface, links};
use rayon::prelude::*;

/// n̄_x, n̄_y (image axes) and n_z over a rectangle of a surface, row by row; unit length.
pub(super) struct Normals(pub [Vec<f32>; 3]);

/// Passes along the rows and down the columns. Three, each half as wide as the one before, leave no
/// stripes.
const PASSES: i32 = 3;

/// The surface's normals, blurred by about a Gaussian of standard deviation `blur_px`, finite, `≥
/// 0`.
///
/// A recursive filter (Gastal and Oliveira 2011, sec. 5) forth and back along rows and columns: its
/// cost does not depend on the width, and a broken link ends it like the border of a picture.
pub(super) fn normals(surface: &Surface, rect: Rect, blur_px: f32) -> Normals {
    let mut planes = surface.normal_planes().map(|plane| {
        let mut out = fill_or_unwind(rect.width() * rect.height(), 0.0f32);
        parallel::for_each_row(&mut out, rect.width(), 1, |y, row| {
            row.copy_from_slice(
                &plane.row(y + rect.y0 as usize)[rect.x0 as usize..rect.x1 as usize],
            );
        });
        out
    });
    if blur_px > 0.0 {
        parallel::for_each(&mut planes, 1, |plane| blur(surface, rect, plane, blur_px));
        let [nx, ny, nz] = &mut planes;
        nx.par_iter_mut().zip(ny.par_iter_mut().zip(nz)).for_each(|(nx, (ny, nz))| {
            let length = (*nx * *nx + *ny * *ny + *nz * *nz).sqrt();
            (*nx, *ny, *nz) = if length > 1e-6 {
                (*nx / length, *ny / length, *nz / length)
            } else {
                (0.0, 0.0, 1.0)
            };
        });
    }
    Normals(planes)
}

fn blur(surface: &Surface, rect: Rect, plane: &mut [f32], blur_px: f32) {
    let (w, h) = (rect.width(), rect.height());
    let links = |y: usize| {
        &surface.links_plane().row(y + rect.y0 as usize)[rect.x0 as usize..rect.x1 as usize]
    };
    for pass in 0..PASSES {
        let sigma =
            blur_px * 3f32.sqrt() * 2f32.powi(PASSES - 1 - pass) / (4f32.powi(PASSES) - 1.0).sqrt();
        let feedback = (-std::f32::consts::SQRT_2 / sigma).exp();
        for (y, row) in plane.chunks_mut(w).enumerate() {
            let links = links(y);
            for x in 1..w {
                let share = if links[x] & links::LEFT != 0 { feedback } else { 0.0 };
                row[x] += share * (row[x - 1] - row[x]);
            }
            for x in (0..w.max(1) - 1).rev() {
                let share = if links[x] & links::RIGHT != 0 { feedback } else { 0.0 };
                row[x] += share * (row[x + 1] - row[x]);
            }
        }
        let mut toward = |y: usize, from: usize, bit: u8| {
            let (first, second) = plane.split_at_mut(y.max(from) * w);
            let (row, from) = if y > from {
                (&mut second[..w], &first[from * w..])
            } else {
                (&mut first[y * w..], &second[..w])
            };
            for ((v, from), links) in row.iter_mut().zip(from).zip(links(y)) {
                let share = if links & bit != 0 { feedback } else { 0.0 };
                *v += share * (from - *v);
            }
        };
        (1..h).for_each(|y| toward(y, y - 1, links::UP));
        (0..h.max(1) - 1).rev().for_each(|y| toward(y, y + 1, links::DOWN));
    }
}
