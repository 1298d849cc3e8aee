//! A surface unwrapped: a map of it onto a plane that changes lengths as little as can be, from its
//! normals (MATH 8). Floor 2. `metric` holds the equations, `steps` the local and global steps over
//! rows, `smooth` the blur before them. Not here: the linear systems (`poisson`), anchors, and how
//! marks use the plane (`deformation`).

mod constrained;
mod layout;
pub mod metric;
mod perspective;
mod piece_shifts;
mod place;
mod seen;
mod smooth;
mod steps;

pub(super) use constrained::DisplacementKey;
pub use constrained::{PlaneConstraint, PlaneDisplacement, PlaneSolver};
pub use layout::{CanvasPlace, LaidPiece, PlaneLayout};
pub use perspective::PerspectiveView;
pub use place::PlanePlace;
pub use seen::PlaneView;

use super::cache::HeapSize;
use super::contours::FarSide;
use super::operator::UnwrapSettings;
use super::poisson::{Effort, GoOn, PoissonGrid, PoissonSolver, SolveScratch};
use super::pyramid::{Pyramid, TurnSpan};
use super::{Surface, links};
use crate::math::{Rect, Size, Vec2, parallel, vec2};
use crate::memory::fill_or_unwind;
use crate::raster::Plane;
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};
use steps::Metric;

/// Where each pixel of a surface lies in the plane it is unwrapped to, canvas px: D_s without
/// anchors.
///
/// Each piece lies as near to where it is in the picture as a shift brings it. Off the surface the
/// identity.
pub struct Unwrapping {
    x: Plane<f32>,
    y: Plane<f32>,
    /// The ranges of both over blocks, for `support`.
    bounds: OnceLock<Pyramid<TurnSpan>>,
}

impl HeapSize for Unwrapping {
    fn heap_bytes(&self) -> u64 {
        self.x.heap_bytes() + self.y.heap_bytes() + self.bounds.get().map_or(0, Pyramid::bytes)
    }
}

/// How often S is turned as the solution turned it, and solved again.
const TURNS: usize = 3;
/// How far the solves go before S is turned again, and the last one.
const ROUGH: Effort = Effort { goal: 3e-2, most_steps: 30 };
const FINE: Effort = Effort { goal: 1e-3, most_steps: 60 };

/// How many systems are solved for one unwrapping: `GoOn` is called after each.
pub const SOLVES: u64 = (TURNS as u64 + 1) * 2;

impl Unwrapping {
    /// Unwraps all that a surface covers.
    pub fn new(surface: &Surface, settings: UnwrapSettings) -> Self {
        Self::with_progress(surface, settings, &|| true).expect("nobody gives it up")
    }

    /// The same, calling `go_on` after each solve: `None` if it says no.
    pub fn with_progress(surface: &Surface, settings: UnwrapSettings, go_on: GoOn) -> Option<Self> {
        let size = surface.size();
        let mut planes = [
            Plane::from_fn(size, |x, _| x as f32 + 0.5),
            Plane::from_fn(size, |_, y| y as f32 + 0.5),
        ];
        let rect = covered_rect(surface);
        if settings.amount > 0.0 && !rect.is_empty() {
            let moved = solve_plane(surface, rect, settings, go_on)?;
            for (plane, moved) in planes.iter_mut().zip(&moved) {
                let w = size.width as usize;
                let rows =
                    plane.values_mut()[rect.y0 as usize * w..rect.y1 as usize * w].chunks_mut(w);
                for (row, moved) in rows.zip(moved.chunks(rect.width())) {
                    row[rect.x0 as usize..rect.x1 as usize]
                        .iter_mut()
                        .zip(moved)
                        .for_each(|(v, d)| *v += d);
                }
            }
        }
        let [x, y] = planes;
        Some(Self { x, y, bounds: OnceLock::new() })
    }

    /// What the other sides of contour pixels lie on.
    fn on_far_side(
        size: Size,
        far: &FarSide,
        front: Option<&Surface>,
        settings: UnwrapSettings,
    ) -> Self {
        let whole = front.map(|front| front.unwrapping(settings));
        let [x, y] = [0, 1].map(|axis| {
            far.continue_map(size, |x, y| {
                whole.as_ref().map_or(0.0, |whole| whole.planes()[axis].at(x, y))
            })
        });
        Self { x, y, bounds: OnceLock::new() }
    }

    /// The size of the surface, px.
    pub fn size(&self) -> Size {
        self.x.size()
    }

    /// Where a pixel's center lies.
    #[inline(always)]
    pub fn at(&self, x: usize, y: usize) -> Vec2 {
        vec2(self.x.at(x, y), self.y.at(x, y))
    }

    /// x and y as planes, for loops over rows.
    pub fn planes(&self) -> [&Plane<f32>; 2] {
        [&self.x, &self.y]
    }

    /// Built by the calling thread alone: see `pyramid`.
    pub(super) fn bounds(&self, surface: &Surface) -> &Pyramid<TurnSpan> {
        self.bounds.get_or_init(|| Pyramid::of_points(surface, |x, y| self.at(x, y)))
    }
}

/// The smallest rectangle that holds the surface.
fn covered_rect(surface: &Surface) -> Rect {
    let coverage = surface.coverage_plane();
    let row = |y: usize| {
        let row = coverage.row(y);
        let first = row.iter().position(|c| *c > 0)? as i32;
        let last = row.iter().rposition(|c| *c > 0)? as i32;
        Some(Rect::new(first, y as i32, last + 1, y as i32 + 1))
    };
    (0..coverage.height()).filter_map(row).fold(Rect::EMPTY, Rect::union)
}

/// δ = D − q over a rectangle, x and y: the steps of MATH 8; `None` where it is given up.
fn solve_plane(
    surface: &Surface,
    rect: Rect,
    settings: UnwrapSettings,
    go_on: GoOn,
) -> Option<[Vec<f32>; 2]> {
    let normals = smooth::normals(surface, rect, settings.smooth_px);
    let metric = Metric::of(surface, rect, &normals, settings.amount);
    let solver = PoissonSolver::new(couplings(surface, rect, &normals));
    drop(normals);
    let n = rect.width() * rect.height();
    let mut moved = [fill_or_unwind(n, 0.0), fill_or_unwind(n, 0.0)];
    let mut sources = [fill_or_unwind(n, 0.0), fill_or_unwind(n, 0.0)];
    let mut scratch = SolveScratch::default();
    for step in 0..=TURNS {
        let before = (step > 0).then(|| moved.each_ref().map(|v| &v[..]));
        steps::sources(solver.grid(), &metric, before, sources.each_mut().map(|v| &mut v[..]));
        let effort = if step < TURNS { ROUGH } else { FINE };
        for (v, b) in moved.iter_mut().zip(&sources) {
            solver.solve(b, v, effort, &mut scratch);
            if !go_on() {
                return None;
            }
        }
    }
    let pieces = solver.pieces();
    drop((solver, scratch, sources, metric));
    piece_shifts::shift_pieces(surface, rect, &mut moved, pieces);
    Some(moved)
}

impl Metric {
    /// S − 1 over a rectangle of a surface whose normals there are these.
    fn of(surface: &Surface, rect: Rect, normals: &smooth::Normals, amount: f32) -> Self {
        let [nx, ny, nz] = &normals.0;
        let (w, near) = (rect.width(), surface.perspective_view());
        let entries = |(i, (nx, (ny, nz))): (usize, (&f32, (&f32, &f32)))| {
            let (nbar, nz) = (vec2(*nx, *ny), *nz);
            let s = match near {
                None => metric::stretch(nbar, nz, amount),
                Some(near) => {
                    let (x, y) = (rect.x0 as usize + i % w, rect.y0 as usize + i / w);
                    metric::stretch_in_perspective(
                        nbar,
                        nz,
                        near.offset_of_pixel(x, y),
                        near.farness(surface.depth(x, y)),
                        amount,
                    )
                }
            };
            (s.x_axis.x - 1.0, (s.x_axis.y, s.y_axis.y - 1.0))
        };
        let (xx, (xy, yy)) =
            nx.par_iter().zip(ny.par_iter().zip(nz)).enumerate().map(entries).unzip();
        Self { xx, xy, yy }
    }
}

/// The links of MATH 8 as couplings: `w = the mean of n_z × c_ij`, nothing across depth jumps and the
/// mask's edge.
fn couplings(surface: &Surface, rect: Rect, normals: &smooth::Normals) -> PoissonGrid {
    let (w, n) = (rect.width(), rect.width() * rect.height());
    let [nx, ny, nz] = &normals.0;
    let normal = |i: usize| crate::math::vec3(nx[i], -ny[i], nz[i]);
    let near = surface.perspective_view();
    let facing = |i: usize| {
        let facing = near.map_or(nz[i], |near| {
            let (x, y) = (rect.x0 as usize + i % w, rect.y0 as usize + i / w);
            metric::facing_in_perspective(vec2(nx[i], ny[i]), nz[i], near.offset_of_pixel(x, y))
        });
        facing.max(metric::STEEPEST_NZ).min(1.0)
    };
    let plane = |bit: u8, step: usize, along: Vec2| {
        let mut plane = fill_or_unwind(n, 0.0f32);
        parallel::for_each_row(&mut plane, w, 1, |y, row| {
            let linked = surface.links_plane().row(y + rect.y0 as usize);
            for (x, (coupling, linked)) in
                row.iter_mut().zip(&linked[rect.x0 as usize..]).enumerate()
            {
                let i = y * w + x;
                if linked & bit != 0 && i + step < n {
                    let concave_pull = metric::concave_pull(normal(i), normal(i + step), along);
                    *coupling = 0.5 * (facing(i) + facing(i + step)) * concave_pull;
                }
            }
        });
        plane
    };
    PoissonGrid::new(w, plane(links::RIGHT, 1, Vec2::X), plane(links::DOWN, w, Vec2::Y))
}

/// Pixels of all unwrappings kept, 8 bytes each.
const KEPT_PX: usize = 32 << 20;

impl Surface {
    /// The surface unwrapped, cached. Call it once before going parallel: threads that call it at
    /// the same time may each compute it. Settings that are not finite count as 0. For a far side
    /// it is that of the surface in front, continued.
    pub fn unwrapping(&self, settings: UnwrapSettings) -> Arc<Unwrapping> {
        let settings = settings.clamp_to_ranges(self.size());
        self.derived.unwrappings.get_or_compute(settings.key(), self.kept_unwrappings(), |_| {
            self.on_either_side(
                || Unwrapping::new(self, settings),
                |far, front| Unwrapping::on_far_side(self.size(), far, front, settings),
            )
        })
    }

    /// The same, calling `go_on` after each solve: `None` if it says no. It is not called for what
    /// is cached.
    pub fn unwrapping_with_progress(
        &self,
        settings: UnwrapSettings,
        go_on: GoOn,
    ) -> Option<Arc<Unwrapping>> {
        if self.is_unwrapped(settings) {
            return Some(self.unwrapping(settings));
        }
        let settings = settings.clamp_to_ranges(self.size());
        let unwrapped = self.on_either_side(
            || Unwrapping::with_progress(self, settings, go_on),
            |far, front| Some(Unwrapping::on_far_side(self.size(), far, front, settings)),
        )?;
        Some(self.derived.unwrappings.get_or_compute(
            settings.key(),
            self.kept_unwrappings(),
            |_| unwrapped,
        ))
    }

    /// Whether it is unwrapped with these settings already.
    pub fn is_unwrapped(&self, settings: UnwrapSettings) -> bool {
        self.derived.unwrappings.get(&settings.clamp_to_ranges(self.size()).key()).is_some()
    }

    fn kept_unwrappings(&self) -> usize {
        (KEPT_PX / self.size().area().max(1)).clamp(2, 8)
    }
}

#[cfg(test)]
mod tests;
