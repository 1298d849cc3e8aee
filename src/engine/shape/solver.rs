//! Poisson equations over outlines: conjugate gradients, preconditioned by one multigrid V-cycle,
//! starting from the solution of the coarser grid. Floor 3. Couplings are mostly 1 or 0 here. Not
//! here: exact solutions with couplings of any stiffness (`surface`). Sums are formed band by band
//! and added in order, so that the bits do not depend on the number of threads.

mod level;

use crate::math::conjugate_gradients::{
    ConjugateSystem, JACOBI_STEPS as STEPS, conjugate_gradients,
};
use crate::math::{Rect, Size, parallel};
use crate::memory::fill_or_unwind;
use crate::raster::Plane;
use level::*;

/// The most steps of conjugate gradients.
const MOST_STEPS: usize = 60;

/// A grid with its coarser ones, ready to be solved for several right-hand sides.
pub struct Solver {
    levels: Vec<Level>,
}

impl Solver {
    /// −∇²v + held · v over the pixels where `inside` holds: couplings of 1 between them.
    ///
    /// * `inside`: its border holds no pixel.
    /// * `held`: the coupling of each pixel toward 0, `≥ 0`: rims, screening. 0 outside.
    pub fn new(inside: &Plane<bool>, held: Plane<f32>) -> Self {
        let Size { width, height } = inside.size();
        let (w, h) = (width as usize, height as usize);
        let linked = |a: bool, b: bool| if a && b { 1.0 } else { 0.0 };
        let right = Plane::from_fn(inside.size(), |x, y| {
            linked(inside.at(x, y), x + 1 < w && inside.at(x + 1, y))
        });
        let down = Plane::from_fn(inside.size(), |x, y| {
            linked(inside.at(x, y), y + 1 < h && inside.at(x, y + 1))
        });
        Self::of_couplings(right, down, held)
    }

    /// The same with couplings of any stiffness to the right and down, none of them at the border.
    pub fn of_couplings(right: Plane<f32>, down: Plane<f32>, held: Plane<f32>) -> Self {
        let (w, h) = (held.width(), held.height());
        let mut levels =
            vec![Level::new(w, h, right.into_values(), down.into_values(), held.into_values())];
        while let Some(last) = levels.last().filter(|level| level.w > 5 || level.h > 5) {
            let coarser = last.coarser();
            levels.push(coarser);
        }
        Self { levels }
    }

    /// Gives some pixels another coupling toward 0: as if the solver had been made with it.
    pub fn hold(&mut self, pixels: &[(usize, usize)], held: impl Fn(usize, usize) -> f32) {
        let mut changed = pixels.to_vec();
        for &(x, y) in &changed {
            self.levels[0].hold((x, y), held(x, y));
        }
        for at in 1..self.levels.len() {
            changed.iter_mut().for_each(|(x, y)| (*x, *y) = (x.div_ceil(2), y.div_ceil(2)));
            changed.sort_unstable();
            changed.dedup();
            for &(x, y) in &changed {
                let held = self.levels[at - 1].held_of_block(x, y);
                self.levels[at].hold((x, y), held);
            }
        }
    }

    /// A field that is nearly right, nearer to the solution of A v = b, in a fourth of the time of
    /// [`Self::solve`].
    ///
    /// `near`: where much has changed. It is settled by itself; what varies slowly is corrected on
    /// the next coarser grid, and a few sweeps smooth the rest.
    pub fn approach(&self, b: &[f32], mut v: Vec<f32>, near: Rect) -> Vec<f32> {
        const GOAL: f64 = 1e-3;
        let grid = &self.levels[0];
        let mut other = fill_or_unwind(b.len(), 0.0);
        self.settle(b, &mut v, near, 30);
        if let Some(below) = self.levels.get(1) {
            grid.fill(&mut other, |y, out| {
                compute_residual(grid.couplings(y), grid.rows_around(&v, y), grid.row(b, y), out)
            });
            let mut rest = fill_or_unwind(below.w * below.h, 0.0);
            restrict(grid, below, &other, &mut rest);
            let nothing = fill_or_unwind(rest.len(), 0.0);
            let coarse = self.solve_by_conjugate_gradients(1, &rest, nothing, GOAL);
            grid.fill(&mut other, |y, out| interpolate_blocks(grid, below, &coarse, y, out));
            let bands = v.chunks_mut(grid.w * BAND).zip(other.chunks(grid.w * BAND));
            parallel::for_each(bands, 1, |(v, c)| add(v, 1.0, c));
        }
        grid.relax(&v, b, STEPS[1], &mut other);
        grid.relax(&other, b, STEPS[0], &mut v);
        self.settle(b, &mut v, near, 10);
        v
    }

    /// Sweeps of successive over-relaxation over some pixels, the others held; fewer over many
    /// pixels.
    fn settle(&self, b: &[f32], v: &mut [f32], near: Rect, most_sweeps: usize) {
        const OVER: f32 = 1.7;
        const MOST_PX: usize = 200_000;
        let grid = &self.levels[0];
        let w = grid.w;
        let inner = near.intersect(Rect::new(1, 1, w as i32 - 1, grid.h as i32 - 1));
        let area = (inner.width() * inner.height()).max(1);
        for _ in 0..most_sweeps.min(MOST_PX / area) {
            for y in inner.y0 as usize..inner.y1 as usize {
                for i in y * w + inner.x0 as usize..y * w + inner.x1 as usize {
                    let across = grid.right[i - 1] * v[i - 1] + grid.right[i] * v[i + 1];
                    let pull = across + grid.down[i - w] * v[i - w] + grid.down[i] * v[i + w];
                    v[i] += OVER * ((b[i] + pull) * grid.inverse[i] - v[i]);
                }
            }
        }
    }

    /// Solves A v = b until the squared residual, relative to b's, is as small as `goal`, or for 60
    /// steps.
    ///
    /// `start`: where the search begins; if absent, at the solution of the coarser grids.
    pub fn solve(&self, b: &[f32], start: Option<Vec<f32>>, goal: f64) -> Vec<f32> {
        let start = start.unwrap_or_else(|| self.solve_nested(0, b));
        self.solve_by_conjugate_gradients(0, b, start, goal)
    }

    /// The same on any level.
    fn solve_by_conjugate_gradients(
        &self,
        at: usize,
        b: &[f32],
        mut v: Vec<f32>,
        goal: f64,
    ) -> Vec<f32> {
        let (grid, w) = (&self.levels[at], self.levels[at].w);
        let buffer = || fill_or_unwind(b.len(), 0.0);
        let mut residual = buffer();
        grid.fill(&mut residual, |y, out| {
            compute_residual(grid.couplings(y), grid.rows_around(&v, y), grid.row(b, y), out)
        });
        let goal = dots(w, b, b) * goal;
        let left = dots(w, &residual, &residual);
        let mut system = SolverSystem {
            solver: self,
            at,
            v: &mut v,
            residual,
            z: Vec::new(),
            direction: buffer(),
            pulled: buffer(),
            scratch: SolverBuffers::default(),
        };
        let is_done = |_, left: f64| left.is_nan() || left <= goal;
        conjugate_gradients(&mut system, left, MOST_STEPS, is_done);
        v
    }

    /// The coarser grid's solution, itself started from the next coarser one, read between its
    /// blocks and corrected once.
    fn solve_nested(&self, at: usize, b: &[f32]) -> Vec<f32> {
        let mut scratch = SolverBuffers::default();
        let grid = &self.levels[at];
        let Some(below) = self.levels.get(at + 1) else { return self.cycle(at, b, &mut scratch) };
        let mut rest = fill_or_unwind(below.w * below.h, 0.0);
        restrict(grid, below, b, &mut rest);
        let coarse = self.solve_nested(at + 1, &rest);
        let mut v = fill_or_unwind(b.len(), 0.0);
        grid.fill(&mut v, |y, out| interpolate_blocks(grid, below, &coarse, y, out));
        let mut left = fill_or_unwind(b.len(), 0.0);
        grid.fill(&mut left, |y, out| {
            compute_residual(grid.couplings(y), grid.rows_around(&v, y), grid.row(b, y), out)
        });
        let z = self.cycle(at, &left, &mut scratch);
        add(&mut v, 1.0, &z);
        v
    }

    /// One symmetric V-cycle: an approximate solution of A v = b on a level.
    fn cycle(&self, at: usize, b: &[f32], scratch: &mut SolverBuffers) -> Vec<f32> {
        let grid = &self.levels[at];
        let (mut v, mut twin) = (scratch.take(b.len()), scratch.take(b.len()));
        grid.fill(&mut twin, |y, out| {
            for ((v, b), inverse) in
                out.iter_mut().zip(grid.row(b, y)).zip(grid.row(&grid.inverse, y))
            {
                *v = STEPS[0] * b * inverse;
            }
        });
        grid.relax(&twin, b, STEPS[1], &mut v);
        match self.levels.get(at + 1) {
            None => {
                for _ in 0..10 {
                    grid.relax(&v, b, STEPS[0], &mut twin);
                    grid.relax(&twin, b, STEPS[1], &mut v);
                    grid.relax(&v, b, STEPS[1], &mut twin);
                    grid.relax(&twin, b, STEPS[0], &mut v);
                }
            }
            Some(below) => {
                grid.fill(&mut twin, |y, out| {
                    compute_residual(
                        grid.couplings(y),
                        grid.rows_around(&v, y),
                        grid.row(b, y),
                        out,
                    )
                });
                let mut rest = scratch.take(below.w * below.h);
                restrict(grid, below, &twin, &mut rest);
                let correction = self.cycle(at + 1, &rest, scratch);
                scratch.keep(rest);
                let inner = &correction;
                grid.fill(&mut v, |y, out| {
                    let (row, inverse) =
                        (below.row(inner, y.div_ceil(2)), grid.row(&grid.inverse, y));
                    for (x, (v, inverse)) in out.iter_mut().zip(inverse).enumerate() {
                        *v += if *inverse > 0.0 { row[x.div_ceil(2)] } else { 0.0 };
                    }
                });
                scratch.keep(correction);
            }
        }
        grid.relax(&v, b, STEPS[1], &mut twin);
        grid.relax(&twin, b, STEPS[0], &mut v);
        scratch.keep(twin);
        v
    }
}

/// Sums over the pixels of each block.
fn restrict(grid: &Level, below: &Level, fine: &[f32], out: &mut [f32]) {
    below.fill(out, |y, out| {
        let rows = [2 * y - 1, 2 * y].map(|y| if y < grid.h { grid.row(fine, y) } else { &[][..] });
        for (x, out) in out.iter_mut().enumerate().skip(1) {
            let sum = |row: &[f32]| {
                let at = |x: usize| row.get(x).copied().unwrap_or(0.0);
                at(2 * x - 1) + at(2 * x)
            };
            *out = sum(rows[0]) + sum(rows[1]);
        }
    });
}

/// A field of blocks read between their middles, at the unknowns of one row.
fn interpolate_blocks(grid: &Level, below: &Level, coarse: &[f32], y: usize, out: &mut [f32]) {
    // The middle of a pixel lies a quarter of a block from that of its own.
    let beside =
        |i: usize| if i % 2 == 1 { (i.div_ceil(2), i.div_ceil(2) - 1) } else { (i / 2, i / 2 + 1) };
    let (own, other) = beside(y);
    let rows = [below.row(coarse, own), below.row(coarse, other.min(below.h - 1))];
    let inverse = grid.row(&grid.inverse, y);
    for (x, out) in out.iter_mut().enumerate() {
        if inverse[x] > 0.0 {
            let (near, far) = beside(x);
            let far = far.min(below.w - 1);
            let row = |r: &[f32]| 0.75 * r[near] + 0.25 * r[far];
            *out = 0.75 * row(rows[0]) + 0.25 * row(rows[1]);
        }
    }
}

/// What a solve on a level works on.
struct SolverSystem<'a> {
    solver: &'a Solver,
    at: usize,
    v: &'a mut [f32],
    residual: Vec<f32>,
    z: Vec<f32>,
    direction: Vec<f32>,
    pulled: Vec<f32>,
    scratch: SolverBuffers,
}

impl SolverSystem<'_> {
    fn grid(&self) -> &Level {
        &self.solver.levels[self.at]
    }
}

impl ConjugateSystem for SolverSystem<'_> {
    fn precondition(&mut self) -> f64 {
        self.z = self.solver.cycle(self.at, &self.residual, &mut self.scratch);
        dots(self.grid().w, &self.residual, &self.z)
    }

    fn turn(&mut self, turn: f32) -> f64 {
        let (grid, w) = (&self.solver.levels[self.at], self.grid().w);
        let bands = self.direction.chunks_mut(w * BAND).zip(self.z.chunks(w * BAND));
        parallel::for_each(bands, least_bands(w), |(d, z)| {
            d.iter_mut().zip(z).for_each(|(d, z)| *d = z + turn * *d);
        });
        self.scratch.keep(std::mem::take(&mut self.z));
        let direction = &self.direction;
        grid.fill(&mut self.pulled, |y, out| {
            multiply(grid.couplings(y), grid.rows_around(direction, y), out)
        });
        dots(w, direction, &self.pulled)
    }

    fn walk(&mut self, along: f32) -> f64 {
        let w = self.grid().w;
        let bands = self.v.chunks_mut(w * BAND).zip(self.residual.chunks_mut(w * BAND));
        let moved = self.direction.chunks(w * BAND).zip(self.pulled.chunks(w * BAND));
        parallel::for_each(bands.zip(moved), least_bands(w), |((v, r), (d, p))| {
            add(v, along, d);
            add(r, -along, p);
        });
        dots(w, &self.residual, &self.residual)
    }
}

/// Buffers that are reused, zero where no unknown is.
#[derive(Default)]
struct SolverBuffers(Vec<Vec<f32>>);

impl SolverBuffers {
    fn take(&mut self, len: usize) -> Vec<f32> {
        match self.0.iter().position(|buffer| buffer.len() == len) {
            Some(at) => self.0.swap_remove(at),
            None => fill_or_unwind(len, 0.0),
        }
    }

    fn keep(&mut self, buffer: Vec<f32>) {
        self.0.push(buffer);
    }
}

#[cfg(test)]
mod tests;
