//! Weighted Laplace equations on a grid of any shape: conjugate gradients, preconditioned by one
//! multigrid V-cycle. Floor 2. Sums are formed row by row and added in order, so that the bits do
//! not depend on the number of threads. `rows` holds the loops over the grid, `graph` the coarser
//! levels, `merge` which unknowns these join. Not here: what the couplings mean (`integrate`,
//! `unwrap`).
//!
//! Coarser levels are graphs, not grids: the pixels of a block of 2 × 2 become one unknown only
//! where strong couplings join them. So no level mixes what a cut or a row of weak couplings separates,
//! and cuts cost no convergence.

mod constraints;
mod graph;
mod merge;
mod rows;

use crate::math::conjugate_gradients::{
    ConjugateSystem, JACOBI_STEPS as STEPS, conjugate_gradients,
};
use crate::math::parallel;
use crate::memory::fill_or_unwind;
pub use constraints::SoftConstraints;
use graph::PoissonGraph;
use rayon::prelude::*;
use rows::{GridRow, relax_row, residual_row, start_row};

/// A grid of unknowns with couplings to the right and down; 0 where two are not coupled.
pub struct PoissonGrid {
    w: usize,
    right: Vec<f32>,
    down: Vec<f32>,
}

impl PoissonGrid {
    /// `right` and `down`: the stiffness, `≥ 0`, of the coupling from each unknown to the next in its
    /// row and its column, `w` a row. Couplings that would leave the grid are dropped.
    pub fn new(w: usize, mut right: Vec<f32>, mut down: Vec<f32>) -> Self {
        right
            .iter_mut()
            .skip(w.saturating_sub(1))
            .step_by(w.max(1))
            .for_each(|coupling| *coupling = 0.0);
        let last = down.len().saturating_sub(w);
        down[last..].fill(0.0);
        Self { w, right, down }
    }

    pub fn width(&self) -> usize {
        self.w
    }

    /// The couplings from each unknown to the right, and down.
    pub fn couplings(&self) -> [&[f32]; 2] {
        [&self.right, &self.down]
    }

    fn height(&self) -> usize {
        self.right.len() / self.w.max(1)
    }

    /// The couplings of a row of unknowns.
    fn row(&self, y: usize) -> GridRow<'_> {
        let at = y * self.w..(y + 1) * self.w;
        let up = if y == 0 { &[][..] } else { &self.down[at.start - self.w..at.start] };
        GridRow { right: &self.right[at.clone()], up, down: &self.down[at] }
    }

    /// Σ_j w_ij of an unknown, and Σ_j w_ij v_j: what reads like the equation.
    fn pull(&self, v: &[f32], i: usize) -> (f32, f32) {
        let w = self.w;
        let left = if !i.is_multiple_of(w) { (self.right[i - 1], v[i - 1]) } else { (0.0, 0.0) };
        let up = if i >= w { (self.down[i - w], v[i - w]) } else { (0.0, 0.0) };
        let right = (self.right[i], if !(i + 1).is_multiple_of(w) { v[i + 1] } else { 0.0 });
        let down = (self.down[i], v.get(i + w).copied().unwrap_or(0.0));
        [left, right, up, down].iter().fold((0.0, 0.0), |sum, (k, v)| (sum.0 + k, sum.1 + k * v))
    }
}

/// Rows that one task works on: enough that the rows around them, read by two tasks, weigh little.
const BAND: usize = 16;

/// Steps without a smaller residual after which f32 is too coarse to go on.
const PATIENCE: usize = 3;

/// Couplings with all their coarser levels, ready to be solved for many right-hand sides.
pub struct PoissonSolver {
    grid: PoissonGrid,
    /// For each unknown of the grid, its unknown on the first coarser level; [`graph::NONE`]
    /// without couplings.
    parent: Vec<u32>,
    graphs: Vec<PoissonGraph>,
}

/// Buffers of a solve, used again for the next.
#[derive(Default)]
pub struct SolveScratch {
    residual: Vec<f32>,
    direction: Vec<f32>,
    pulled: Vec<f32>,
    /// The preconditioned residual, and its twin for sweeps.
    z: [Vec<f32>; 2],
    levels: Vec<graph::GraphScratch>,
}

/// Called between the steps of long work: whether to go on.
pub type GoOn<'g> = &'g dyn Fn() -> bool;

/// How far a solve goes.
#[derive(Clone, Copy)]
pub struct Effort {
    /// The length of the residual as a share of the right-hand side's.
    pub goal: f64,
    pub most_steps: usize,
}

impl Effort {
    pub const EXACT: Self = Self { goal: 1e-5, most_steps: 60 };
}

impl PoissonSolver {
    pub fn new(grid: PoissonGrid) -> Self {
        let (parent, first) = PoissonGraph::of_grid(&grid);
        let mut graphs = vec![first];
        while let Some(coarser) = graphs.last_mut().and_then(PoissonGraph::coarser) {
            graphs.push(coarser);
        }
        Self { grid, parent, graphs }
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> u64 {
        let [right, down] = self.grid.couplings();
        let levels: usize = self.graphs.iter().map(PoissonGraph::bytes).sum();
        (size_of_val(right) + size_of_val(down) + size_of_val(&self.parent[..]) + levels) as u64
    }

    pub fn grid(&self) -> &PoissonGrid {
        &self.grid
    }

    /// For each unknown the number of its piece (unknowns that couplings join); [`u32::MAX`] without
    /// couplings. And the number of pieces.
    pub fn pieces(&self) -> (Vec<u32>, usize) {
        let Some((last, finer)) = self.graphs.split_last() else { return (Vec::new(), 0) };
        let (mut labels, count) = last.pieces().clone();
        for graph in finer.iter().rev() {
            labels = graph.parents().iter().map(|&p| labels[p as usize]).collect();
        }
        let of = |&p: &u32| if p == graph::NONE { u32::MAX } else { labels[p as usize] };
        (self.parent.par_iter().map(of).collect(), count)
    }

    /// Moves `v` toward A v = b, (A v)_i = Σ_j w_ij (v_i − v_j), and returns the steps it took.
    ///
    /// * `b`: adds up to 0 over every piece.
    /// * `v`: where to begin; a constant a piece stays free.
    pub fn solve(
        &self,
        b: &[f32],
        v: &mut [f32],
        effort: Effort,
        scratch: &mut SolveScratch,
    ) -> usize {
        self.solve_constrained(&SoftConstraints::default(), b, v, effort, scratch)
    }

    /// The same, but `go_on` is called before each step; once it returns false, the result is of no
    /// use.
    pub fn solve_while(&self, b: &[f32], v: &mut [f32], effort: Effort, go_on: GoOn) -> usize {
        self.steps(&SoftConstraints::default(), b, v, effort, &mut SolveScratch::default(), go_on)
    }

    /// The same with some unknowns constrained: (A + K) v = b, K the stiffness of what holds them.
    ///
    /// * `b`: adds up to 0 over every piece without a constrained unknown.
    pub fn solve_constrained(
        &self,
        constraints: &SoftConstraints,
        b: &[f32],
        v: &mut [f32],
        effort: Effort,
        scratch: &mut SolveScratch,
    ) -> usize {
        self.steps(constraints, b, v, effort, scratch, &|| true)
    }

    fn steps(
        &self,
        constraints: &SoftConstraints,
        b: &[f32],
        v: &mut [f32],
        effort: Effort,
        scratch: &mut SolveScratch,
        go_on: GoOn,
    ) -> usize {
        let n = b.len();
        let SolveScratch { residual, direction, pulled, z, levels } = scratch;
        for buffer in [&mut *residual, direction, pulled].into_iter().chain(z.iter_mut()) {
            if buffer.len() != n {
                *buffer = fill_or_unwind(n, 0.0);
            }
        }
        levels.resize_with(self.graphs.len(), Default::default);
        let goal = self.dot(b, b) * effort.goal * effort.goal;
        let left = self.residual(constraints, v, b, residual);
        let (mut least, mut least_at) = (left, 0);
        let is_done = |step: usize, left: f64| {
            if left < least {
                (least, least_at) = (left, step);
            }
            left.is_nan() || left <= goal || step > least_at + PATIENCE || !go_on()
        };
        let mut system =
            PoissonSystem { solver: self, constraints, v, residual, direction, pulled, z, levels };
        conjugate_gradients(&mut system, left, effort.most_steps, is_done)
    }

    /// Σ a b, folded row by row.
    fn dot(&self, a: &[f32], b: &[f32]) -> f64 {
        let w = self.grid.w * BAND;
        parallel::map(a.chunks(w).zip(b.chunks(w)), |(a, b)| rows::dot(a, b)).iter().sum()
    }

    /// `out` = b − A v; returns its length, squared.
    fn residual(
        &self,
        constraints: &SoftConstraints,
        v: &[f32],
        b: &[f32],
        out: &mut [f32],
    ) -> f64 {
        let w = self.grid.w;
        let bands = parallel::map(out.chunks_mut(w * BAND).enumerate(), |(band, out)| {
            for (y, out) in (band * BAND..).zip(out.chunks_mut(w)) {
                residual_row(
                    self.grid.row(y),
                    neighboring_rows(v, w, y),
                    &b[y * w..(y + 1) * w],
                    out,
                );
                constraints
                    .each_in(y * w..(y + 1) * w, |i, stiffness| out[i - y * w] -= stiffness * v[i]);
            }
            rows::dot(out, out)
        });
        bands.iter().sum()
    }

    /// `direction` = z + turn · direction and `pulled` = A direction; returns the two's product.
    fn turn_direction(
        &self,
        constraints: &SoftConstraints,
        z: &[f32],
        turn: f32,
        direction: &mut [f32],
        pulled: &mut [f32],
    ) -> f64 {
        let w = self.grid.w;
        let bands = direction.chunks_mut(w * BAND).zip(z.chunks(w * BAND));
        parallel::for_each(bands, 1, |(d, z)| rows::turn(z, turn, d));
        let direction = &*direction;
        let bands = parallel::map(pulled.chunks_mut(w * BAND).enumerate(), |(band, out)| {
            let mut sum = 0.0;
            for (y, out) in (band * BAND..).zip(out.chunks_mut(w)) {
                rows::apply_row(self.grid.row(y), neighboring_rows(direction, w, y), out);
                constraints.each_in(y * w..(y + 1) * w, |i, stiffness| {
                    out[i - y * w] += stiffness * direction[i]
                });
                sum += rows::dot(&direction[y * w..(y + 1) * w], out);
            }
            sum
        });
        bands.iter().sum()
    }

    /// v += step · direction and residual −= step · pulled; returns the residual's length, squared.
    fn walk(
        &self,
        step: f32,
        (direction, pulled): (&[f32], &[f32]),
        v: &mut [f32],
        residual: &mut [f32],
    ) -> f64 {
        let w = self.grid.w * BAND;
        let ways = direction.chunks(w).zip(pulled.chunks(w));
        let bands = v.chunks_mut(w).zip(residual.chunks_mut(w)).zip(ways);
        let lengths = parallel::map(bands, |((v, r), (d, p))| {
            rows::walk(step, d, v);
            rows::walk(-step, p, r);
            rows::dot(r, r)
        });
        lengths.iter().sum()
    }

    /// One symmetric V-cycle: `z[0]` becomes an approximate solution of A z = b.
    fn cycle(
        &self,
        constraints: &SoftConstraints,
        b: &[f32],
        [z, twin]: &mut [Vec<f32>; 2],
        levels: &mut [graph::GraphScratch],
    ) {
        let w = self.grid.w;
        let rows_of = |out: &mut [f32], each: &(dyn Fn(usize, &mut [f32]) + Sync)| {
            parallel::for_each_row(out, w * BAND, 1, |band, out| {
                (band * BAND..).zip(out.chunks_mut(w)).for_each(|(y, out)| each(y, out));
            });
        };
        let relax = |step: f32, from: &[f32], to: &mut [f32]| {
            rows_of(to, &|y, out| {
                relax_row(
                    self.grid.row(y),
                    neighboring_rows(from, w, y),
                    &b[y * w..(y + 1) * w],
                    step,
                    out,
                );
                constraints.each_in(y * w..(y + 1) * w, |i, stiffness| {
                    let (sum, pull) = self.grid.pull(from, i);
                    out[i - y * w] = from[i] + step * ((b[i] + pull) / (sum + stiffness) - from[i]);
                });
            });
        };
        rows_of(twin, &|y, out| {
            start_row(self.grid.row(y), &b[y * w..(y + 1) * w], STEPS[0], out);
            constraints.each_in(y * w..(y + 1) * w, |i, stiffness| {
                out[i - y * w] = STEPS[0] * b[i] / (self.grid.pull(b, i).0 + stiffness);
            });
        });
        relax(STEPS[1], twin, z);
        self.residual(constraints, z, b, twin);
        graph::gather(&self.parent, twin, levels, &self.graphs);
        graph::cycle(&self.graphs, levels, constraints.coarser());
        if let Some(coarse) = levels.first() {
            let bands = z.chunks_mut(w * BAND).zip(self.parent.chunks(w * BAND));
            parallel::for_each(bands, 1, |(z, parents)| graph::spread(parents, coarse, z));
        }
        relax(STEPS[0], z, twin);
        relax(STEPS[1], twin, z);
    }
}

/// What a solve works on.
struct PoissonSystem<'a> {
    solver: &'a PoissonSolver,
    constraints: &'a SoftConstraints,
    v: &'a mut [f32],
    residual: &'a mut [f32],
    direction: &'a mut [f32],
    pulled: &'a mut [f32],
    z: &'a mut [Vec<f32>; 2],
    levels: &'a mut [graph::GraphScratch],
}

impl ConjugateSystem for PoissonSystem<'_> {
    fn precondition(&mut self) -> f64 {
        self.solver.cycle(self.constraints, self.residual, self.z, self.levels);
        self.solver.dot(self.residual, &self.z[0])
    }

    fn turn(&mut self, turn: f32) -> f64 {
        self.solver.turn_direction(self.constraints, &self.z[0], turn, self.direction, self.pulled)
    }

    fn walk(&mut self, along: f32) -> f64 {
        self.solver.walk(along, (self.direction, self.pulled), self.v, self.residual)
    }
}

/// A row of values with those above and below; none beyond the grid.
fn neighboring_rows(v: &[f32], w: usize, y: usize) -> [&[f32]; 3] {
    let row = |y: usize| v.get(y * w..(y + 1) * w).unwrap_or(&[]);
    [if y == 0 { &[] } else { row(y - 1) }, row(y), row(y + 1)]
}

#[cfg(test)]
mod tests;
