//! Weighted Laplace equations on a grid of any shape: conjugate gradients, preconditioned by one multigrid V-cycle.
//! Floor 2. Sums are formed row by row and added in order, so that the bits do not depend on the number of threads.

use crate::memory::filled_or_unwind;
use rayon::prelude::*;

/// A grid of unknowns with springs to the right and down; no spring, no coupling.
pub struct SpringGrid {
    w: usize,
    h: usize,
    right: Vec<f32>,
    down: Vec<f32>,
    /// Sum of the springs at each unknown.
    diagonal: Vec<f32>,
}

impl SpringGrid {
    pub fn new(w: usize, h: usize, right: Vec<f32>, down: Vec<f32>) -> Self {
        let diagonal = (0..w * h)
            .map(|i| {
                let left = if i % w > 0 { right[i - 1] } else { 0.0 };
                let up = if i >= w { down[i - w] } else { 0.0 };
                right[i] + down[i] + left + up
            })
            .collect();
        Self { w, h, right, down, diagonal }
    }
    /// Σ_j w_ij v_j over the neighbours of pixel (x, y).
    #[inline(always)]
    fn pull(&self, v: &[f32], x: usize, y: usize) -> f32 {
        let (w, i) = (self.w, y * self.w + x);
        let mut sum = 0.0;
        if x > 0 {
            sum += self.right[i - 1] * v[i - 1];
        }
        if x + 1 < w {
            sum += self.right[i] * v[i + 1];
        }
        if y > 0 {
            sum += self.down[i - w] * v[i - w];
        }
        if y + 1 < self.h {
            sum += self.down[i] * v[i + w];
        }
        sum
    }
    /// A v: the force of the springs at each unknown.
    fn apply(&self, v: &[f32]) -> Vec<f32> {
        self.rows(|x, y| {
            let i = y * self.w + x;
            self.diagonal[i] * v[i] - self.pull(v, x, y)
        })
    }
    pub fn rows(&self, value: impl Fn(usize, usize) -> f32 + Sync) -> Vec<f32> {
        let mut out = filled_or_unwind(self.w * self.h, 0.0);
        out.par_chunks_mut(self.w).enumerate().for_each(|(y, row)| {
            for (x, v) in row.iter_mut().enumerate() {
                *v = value(x, y);
            }
        });
        out
    }
    /// One damped Jacobi sweep toward A v = b.
    fn relax(&self, v: &mut Vec<f32>, b: &[f32]) {
        const DAMPING: f32 = 0.75;
        let next = self.rows(|x, y| {
            let i = y * self.w + x;
            let d = self.diagonal[i];
            if d > 0.0 { v[i] + DAMPING * ((b[i] + self.pull(v, x, y)) / d - v[i]) } else { 0.0 }
        });
        *v = next;
    }
    /// The grid of 2 × 2 blocks: springs between blocks are those that cross, halved because they are twice as long.
    fn coarser(&self) -> SpringGrid {
        let (w, h) = (self.w.div_ceil(2), self.h.div_ceil(2));
        let at = |plane: &[f32], x: usize, y: usize| if x < self.w && y < self.h { plane[y * self.w + x] } else { 0.0 };
        let sum = |plane: &[f32], dx: usize, dy: usize| -> Vec<f32> {
            (0..w * h)
                .map(|i| {
                    let (x, y) = (i % w * 2, i / w * 2);
                    let (a, b) = if dx == 1 { ((x + 1, y), (x + 1, y + 1)) } else { ((x, y + 1), (x + 1, y + 1)) };
                    debug_assert!(dx + dy == 1);
                    0.5 * (at(plane, a.0, a.1) + at(plane, b.0, b.1))
                })
                .collect()
        };
        SpringGrid::new(w, h, sum(&self.right, 1, 0), sum(&self.down, 0, 1))
    }
}

/// A grid and the coarser ones under it, down to a few unknowns.
pub fn levels(grid: SpringGrid) -> Vec<SpringGrid> {
    let mut levels = vec![grid];
    while let Some(last) = levels.last().filter(|g| g.w * g.h > 16) {
        let coarser = last.coarser();
        levels.push(coarser);
    }
    levels
}

/// A residual of 1e-5 of the right-hand side, squared.
pub const EXACT: f64 = 1e-10;

/// Solves A v = b until the residual is so small a part of b, squared, or as far as 60 steps go.
pub fn solve(levels: &[SpringGrid], b: &[f32], goal: f64) -> Vec<f32> {
    let grid = &levels[0];
    let dot = |a: &[f32], b: &[f32]| -> f64 {
        let rows: Vec<f64> = a
            .par_chunks(grid.w)
            .zip(b.par_chunks(grid.w))
            .map(|(a, b)| a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum())
            .collect();
        rows.iter().sum()
    };
    let mut v = filled_or_unwind(b.len(), 0.0);
    let mut residual = b.to_vec();
    let goal = dot(b, b) * goal;
    let mut z = cycle(levels, &residual);
    let mut direction = z.clone();
    let mut rz = dot(&residual, &z);
    for _ in 0..60 {
        let pulled = grid.apply(&direction);
        let energy = dot(&direction, &pulled);
        if energy <= 0.0 || rz <= 0.0 || dot(&residual, &residual) <= goal {
            break;
        }
        let step = (rz / energy) as f32;
        v.iter_mut().zip(&direction).for_each(|(v, d)| *v += step * d);
        residual.iter_mut().zip(&pulled).for_each(|(r, p)| *r -= step * p);
        drop((pulled, z));
        z = cycle(levels, &residual);
        let next = dot(&residual, &z);
        let turn = (next / rz) as f32;
        rz = next;
        direction.iter_mut().zip(&z).for_each(|(d, z)| *d = z + turn * *d);
    }
    v
}

/// One symmetric V-cycle: an approximate solution of A v = b on the finest level.
fn cycle(levels: &[SpringGrid], b: &[f32]) -> Vec<f32> {
    let Some((grid, coarser)) = levels.split_first() else { return Vec::new() };
    let mut v = filled_or_unwind(b.len(), 0.0);
    let sweeps = if coarser.is_empty() { 40 } else { 2 };
    (0..sweeps).for_each(|_| grid.relax(&mut v, b));
    let Some(below) = coarser.first() else { return v };
    let pulled = grid.apply(&v);
    let rest = below.rows(|x, y| {
        let mut sum = 0.0;
        for (fx, fy) in [(2 * x, 2 * y), (2 * x + 1, 2 * y), (2 * x, 2 * y + 1), (2 * x + 1, 2 * y + 1)] {
            if fx < grid.w && fy < grid.h {
                sum += b[fy * grid.w + fx] - pulled[fy * grid.w + fx];
            }
        }
        sum
    });
    drop(pulled);
    let correction = cycle(coarser, &rest);
    v.par_chunks_mut(grid.w).enumerate().for_each(|(y, row)| {
        for (x, v) in row.iter_mut().enumerate() {
            *v += correction[y / 2 * below.w + x / 2];
        }
    });
    (0..2).for_each(|_| grid.relax(&mut v, b));
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_solution_is_found_on_a_ragged_grid() {
        let (w, h) = (53, 38);
        let held = |x: usize, y: usize| (x as f32 - 26.0).hypot(y as f32 - 19.0) < 18.0 || y < 4;
        let spring = |x: usize, y: usize, dx: usize, dy: usize| {
            let there = x + dx < w && y + dy < h && held(x, y) && held(x + dx, y + dy);
            if there { 0.1 + 0.9 * ((x * 7 + y * 3) % 5) as f32 / 4.0 } else { 0.0 }
        };
        let plane = |dx, dy| (0..w * h).map(|i| spring(i % w, i / w, dx, dy)).collect();
        let grid = SpringGrid::new(w, h, plane(1, 0), plane(0, 1));
        let truth: Vec<f32> = (0..w * h).map(|i| ((i % w) as f32 * 0.2).sin() * 5.0 + (i / w) as f32 * 0.3).collect();
        let b = grid.apply(&truth);
        let springs = SpringGrid::new(w, h, plane(1, 0), plane(0, 1));
        let found = solve(&levels(grid), &b, EXACT);
        let off = springs.apply(&found).iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off < 1e-3, "residual {off}");
    }
}
