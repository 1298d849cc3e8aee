//! Poisson equations over outlines: conjugate gradients, preconditioned by one multigrid V-cycle, begun at the solution
//! of the coarser grid.
//! Floor 3. Springs are 1 or 0 here and rims hold; `surface` solves springs of any stiffness that nothing holds.
//! Sums are formed band by band and added in order, so that the bits do not depend on the number of threads.

use crate::math::Size;
use crate::memory::filled_or_unwind;
use crate::raster::Plane;
use rayon::prelude::*;

/// Rows that one task works on.
const BAND: usize = 16;
/// Two sweeps of Jacobi with these steps leave the least of every error between half the steepest and the steepest that
/// a grid holds: Chebyshev's polynomial over [½, 2].
const STEPS: [f32; 2] = [0.561_7, 1.389_5];
/// A rim is nearer to the middle of a block than to those of its pixels, but less than twice: of what holds the pixels
/// this share holds the block. Measured on discs and ragged stars: 0.75 takes the fewest steps, 0.5 three times as
/// many.
const HELD_BY_RIM: f32 = 0.75;
/// Steps of conjugate gradients at most.
const MOST_STEPS: usize = 60;

/// One grid: its first and last rows and columns hold no unknowns.
struct Level {
    w: usize,
    h: usize,
    /// The spring of each pixel to the next in its row, and its column.
    right: Vec<f32>,
    down: Vec<f32>,
    /// Springs toward 0.
    held: Vec<f32>,
    /// Sum of all springs at a pixel, and its inverse; 0 where there is no unknown.
    diagonal: Vec<f32>,
    inverse: Vec<f32>,
}

/// A grid with its coarser ones, ready to be solved for several right-hand sides.
pub struct Solver {
    levels: Vec<Level>,
}

impl Level {
    fn new(w: usize, h: usize, right: Vec<f32>, down: Vec<f32>, held: Vec<f32>) -> Self {
        let mut diagonal = filled_or_unwind(w * h, 0.0);
        let mut inverse = filled_or_unwind(w * h, 0.0);
        diagonal.par_chunks_mut(w).zip(inverse.par_chunks_mut(w)).enumerate().for_each(|(y, (diagonal, inverse))| {
            if y == 0 || y + 1 == h {
                return;
            }
            let at = y * w;
            for x in 1..w - 1 {
                let i = at + x;
                let sum = right[i] + down[i] + right[i - 1] + down[i - w] + held[i];
                diagonal[x] = sum;
                inverse[x] = if sum > 0.0 { 1.0 / sum } else { 0.0 };
            }
        });
        Self { w, h, right, down, held, diagonal, inverse }
    }
    /// The grid of 2 × 2 blocks, shifted by a pixel so that its border is empty as well. Springs between blocks are
    /// those that cross, halved because they are twice as long.
    fn coarser(&self) -> Self {
        let (w, h) = ((self.w - 1) / 2 + 2, (self.h - 1) / 2 + 2);
        let blocks = |value: &(dyn Fn(usize, usize) -> f32 + Sync)| {
            let mut out = filled_or_unwind(w * h, 0.0);
            out.par_chunks_mut(w).enumerate().for_each(|(y, row)| {
                for (x, v) in row.iter_mut().enumerate() {
                    *v = value(x, y);
                }
            });
            out
        };
        // The pixels of block x are 2x − 1 and 2x.
        let at = |plane: &[f32], x: usize, y: usize| {
            let inside = x > 0 && y > 0 && x <= self.w && y <= self.h;
            if inside { plane[(y - 1) * self.w + x - 1] } else { 0.0 }
        };
        let right = blocks(&|x, y| {
            let x = 2 * x + 1;
            if x > self.w { 0.0 } else { 0.5 * (in_rows(self.h, 2 * y, |y| at(&self.right, x, y))) }
        });
        let down = blocks(&|x, y| {
            let y = 2 * y + 1;
            if y > self.h { 0.0 } else { 0.5 * (in_rows(self.w, 2 * x, |x| at(&self.down, x, y))) }
        });
        let held =
            blocks(&|x, y| HELD_BY_RIM * in_rows(self.h, 2 * y, |y| in_rows(self.w, 2 * x, |x| at(&self.held, x, y))));
        Self::new(w, h, right, down, held)
    }
    fn row<'a>(&self, plane: &'a [f32], y: usize) -> &'a [f32] {
        &plane[y * self.w..(y + 1) * self.w]
    }
    /// Fills the inner rows of a plane, each from its number.
    fn fill(&self, out: &mut [f32], row: impl Fn(usize, &mut [f32]) + Sync) {
        let (w, h) = (self.w, self.h);
        out.par_chunks_mut(w * BAND).enumerate().for_each(|(band, rows)| {
            for (y, out) in (band * BAND..).zip(rows.chunks_mut(w)) {
                if y > 0 && y + 1 < h {
                    row(y, out);
                }
            }
        });
    }
    fn springs(&self, y: usize) -> Springs<'_> {
        Springs {
            right: self.row(&self.right, y),
            up: self.row(&self.down, y - 1),
            down: self.row(&self.down, y),
            diagonal: self.row(&self.diagonal, y),
            inverse: self.row(&self.inverse, y),
        }
    }
    /// Three rows of a field around a row.
    fn around<'a>(&self, v: &'a [f32], y: usize) -> [&'a [f32]; 3] {
        [self.row(v, y - 1), self.row(v, y), self.row(v, y + 1)]
    }
    /// One damped sweep of Jacobi from `v` into `out`.
    fn relax(&self, v: &[f32], b: &[f32], step: f32, out: &mut [f32]) {
        self.fill(out, |y, out| relaxed(self.springs(y), self.around(v, y), self.row(b, y), step, out));
    }
}

/// The sum of a value over the two pixels of a block, numbered from 1 as blocks are; none beyond `n`.
#[inline(always)]
fn in_rows(n: usize, first: usize, value: impl Fn(usize) -> f32) -> f32 {
    let one = |i: usize| if i > 0 && i <= n { value(i) } else { 0.0 };
    one(first) + one(first + 1)
}

/// The springs of one row of pixels.
#[derive(Clone, Copy)]
struct Springs<'a> {
    right: &'a [f32],
    up: &'a [f32],
    down: &'a [f32],
    diagonal: &'a [f32],
    inverse: &'a [f32],
}

crate::widest! {
    /// v + step (D⁻¹ (b + pull) − v).
    fn relaxed(springs: Springs, v: [&[f32]; 3], b: &[f32], step: f32, out: &mut [f32]) {
        let n = out.len();
        let Springs { right, up, down, inverse, .. } = springs;
        let [above, here, below] = v;
        let (right, up, down, inverse) = (&right[..n], &up[..n], &down[..n], &inverse[..n]);
        let (above, here, below, b) = (&above[..n], &here[..n], &below[..n], &b[..n]);
        for x in 1..n - 1 {
            let across = right[x - 1] * here[x - 1] + right[x] * here[x + 1];
            let pull = across + up[x] * above[x] + down[x] * below[x];
            out[x] = here[x] + step * ((b[x] + pull) * inverse[x] - here[x]);
        }
    }
    /// A v.
    fn applied(springs: Springs, v: [&[f32]; 3], out: &mut [f32]) {
        let n = out.len();
        let Springs { right, up, down, diagonal, .. } = springs;
        let [above, here, below] = v;
        let (right, up, down, diagonal) = (&right[..n], &up[..n], &down[..n], &diagonal[..n]);
        let (above, here, below) = (&above[..n], &here[..n], &below[..n]);
        for x in 1..n - 1 {
            let across = right[x - 1] * here[x - 1] + right[x] * here[x + 1];
            out[x] = diagonal[x] * here[x] - (across + up[x] * above[x] + down[x] * below[x]);
        }
    }
    /// b − A v.
    fn left_over(springs: Springs, v: [&[f32]; 3], b: &[f32], out: &mut [f32]) {
        applied_into(springs, v, out);
        for (o, b) in out.iter_mut().zip(b) {
            *o = b - *o;
        }
    }
    /// Σ a b in eight lanes.
    fn dot(a: &[f32], b: &[f32]) -> f64 {
        let mut sum = 0.0f64;
        for (a, b) in a.chunks(512).zip(b.chunks(512)) {
            let mut lanes = [0.0f32; 8];
            for (a, b) in a.chunks_exact(8).zip(b.chunks_exact(8)) {
                for i in 0..8 {
                    lanes[i] += a[i] * b[i];
                }
            }
            let rest = a.chunks_exact(8).remainder().iter().zip(b.chunks_exact(8).remainder());
            let rest: f32 = rest.map(|(a, b)| a * b).sum();
            sum += f64::from(lanes.iter().sum::<f32>() + rest);
        }
        sum
    }
    /// v += step d.
    fn add(v: &mut [f32], step: f32, d: &[f32]) {
        for (v, d) in v.iter_mut().zip(d) {
            *v += step * d;
        }
    }
}

/// The body of [`applied`] for those who stand in a wide body already.
#[inline(always)]
fn applied_into(springs: Springs, v: [&[f32]; 3], out: &mut [f32]) {
    let n = out.len();
    let [above, here, below] = v;
    for x in 1..n - 1 {
        let across = springs.right[x - 1] * here[x - 1] + springs.right[x] * here[x + 1];
        let pull = across + springs.up[x] * above[x] + springs.down[x] * below[x];
        out[x] = springs.diagonal[x] * here[x] - pull;
    }
}

/// Sums over two planes, folded band by band.
fn dots(w: usize, a: &[f32], b: &[f32]) -> f64 {
    let bands: Vec<f64> = a.par_chunks(w * BAND).zip(b.par_chunks(w * BAND)).map(|(a, b)| dot(a, b)).collect();
    bands.iter().sum()
}

impl Solver {
    /// −∇²v + held · v over the pixels where `inside` holds: springs of 1 between them.
    ///
    /// * `inside`: its border holds no pixel.
    /// * `held`: the spring of each pixel toward 0, `≥ 0`: rims, screening. 0 outside.
    pub fn new(inside: &Plane<bool>, held: Plane<f32>) -> Self {
        let Size { width, height } = inside.size();
        let (w, h) = (width as usize, height as usize);
        let linked = |a: bool, b: bool| if a && b { 1.0 } else { 0.0 };
        let right = Plane::from_fn(inside.size(), |x, y| linked(inside.at(x, y), x + 1 < w && inside.at(x + 1, y)));
        let down = Plane::from_fn(inside.size(), |x, y| linked(inside.at(x, y), y + 1 < h && inside.at(x, y + 1)));
        let mut levels = vec![Level::new(w, h, right.into_values(), down.into_values(), held.into_values())];
        while let Some(last) = levels.last().filter(|level| level.w > 5 || level.h > 5) {
            let coarser = last.coarser();
            levels.push(coarser);
        }
        Self { levels }
    }
    /// Solves A v = b until the residual is a part of b, squared, as small as `goal`, or as far as 60 steps go.
    ///
    /// `start`: where the search begins; without it the solution of the coarser grids.
    pub fn solve(&self, b: &[f32], start: Option<Vec<f32>>, goal: f64) -> Vec<f32> {
        let (grid, w) = (&self.levels[0], self.levels[0].w);
        let mut v = start.unwrap_or_else(|| self.nested(0, b));
        let buffer = || filled_or_unwind(b.len(), 0.0);
        let mut residual = buffer();
        grid.fill(&mut residual, |y, out| left_over(grid.springs(y), grid.around(&v, y), grid.row(b, y), out));
        let goal = dots(w, b, b) * goal;
        let (mut direction, mut pulled, mut rz_before) = (buffer(), buffer(), 0.0);
        let mut scratch = Scratch::default();
        for step in 0..MOST_STEPS {
            let left = dots(w, &residual, &residual);
            if left.is_nan() || left <= goal {
                break;
            }
            let z = self.cycle(0, &residual, &mut scratch);
            let rz = dots(w, &residual, &z);
            let turn = if step == 0 { 0.0 } else { (rz / rz_before) as f32 };
            direction.par_chunks_mut(w * BAND).zip(z.par_chunks(w * BAND)).for_each(|(d, z)| {
                d.iter_mut().zip(z).for_each(|(d, z)| *d = z + turn * *d);
            });
            scratch.keep(z);
            grid.fill(&mut pulled, |y, out| applied(grid.springs(y), grid.around(&direction, y), out));
            let energy = dots(w, &direction, &pulled);
            if energy.is_nan() || energy <= 0.0 || rz <= 0.0 {
                break;
            }
            let along = (rz / energy) as f32;
            let bands = v.par_chunks_mut(w * BAND).zip(residual.par_chunks_mut(w * BAND));
            let moved = direction.par_chunks(w * BAND).zip(pulled.par_chunks(w * BAND));
            bands.zip(moved).for_each(|((v, r), (d, p))| {
                add(v, along, d);
                add(r, -along, p);
            });
            rz_before = rz;
        }
        v
    }
    /// The coarser grid's solution, itself begun on the one below, read between its blocks and corrected once.
    fn nested(&self, at: usize, b: &[f32]) -> Vec<f32> {
        let mut scratch = Scratch::default();
        let grid = &self.levels[at];
        let Some(below) = self.levels.get(at + 1) else { return self.cycle(at, b, &mut scratch) };
        let mut rest = filled_or_unwind(below.w * below.h, 0.0);
        restrict(grid, below, b, &mut rest);
        let coarse = self.nested(at + 1, &rest);
        let mut v = filled_or_unwind(b.len(), 0.0);
        grid.fill(&mut v, |y, out| between_blocks(grid, below, &coarse, y, out));
        let mut left = filled_or_unwind(b.len(), 0.0);
        grid.fill(&mut left, |y, out| left_over(grid.springs(y), grid.around(&v, y), grid.row(b, y), out));
        let z = self.cycle(at, &left, &mut scratch);
        add(&mut v, 1.0, &z);
        v
    }
    /// One symmetric V-cycle: an approximate solution of A v = b on a level.
    fn cycle(&self, at: usize, b: &[f32], scratch: &mut Scratch) -> Vec<f32> {
        let grid = &self.levels[at];
        let (mut v, mut twin) = (scratch.take(b.len()), scratch.take(b.len()));
        grid.fill(&mut twin, |y, out| {
            for ((v, b), inverse) in out.iter_mut().zip(grid.row(b, y)).zip(grid.row(&grid.inverse, y)) {
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
                grid.fill(&mut twin, |y, out| left_over(grid.springs(y), grid.around(&v, y), grid.row(b, y), out));
                let mut rest = scratch.take(below.w * below.h);
                restrict(grid, below, &twin, &mut rest);
                let correction = self.cycle(at + 1, &rest, scratch);
                scratch.keep(rest);
                let inner = &correction;
                grid.fill(&mut v, |y, out| {
                    let (row, inverse) = (below.row(inner, y.div_ceil(2)), grid.row(&grid.inverse, y));
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
fn between_blocks(grid: &Level, below: &Level, coarse: &[f32], y: usize, out: &mut [f32]) {
    // The middle of a pixel lies a quarter of a block from that of its own.
    let beside = |i: usize| if i % 2 == 1 { (i.div_ceil(2), i.div_ceil(2) - 1) } else { (i / 2, i / 2 + 1) };
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

/// Buffers that are used again, zero where no unknown is.
#[derive(Default)]
struct Scratch(Vec<Vec<f32>>);

impl Scratch {
    fn take(&mut self, len: usize) -> Vec<f32> {
        match self.0.iter().position(|buffer| buffer.len() == len) {
            Some(at) => self.0.swap_remove(at),
            None => filled_or_unwind(len, 0.0),
        }
    }
    fn keep(&mut self, buffer: Vec<f32>) {
        self.0.push(buffer);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// −∇²v + held v at a pixel, as the equation reads.
    fn applied_at(inside: &Plane<bool>, held: &Plane<f32>, v: &[f32], x: usize, y: usize) -> f32 {
        let w = inside.width();
        let beside = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
        let inner = beside.iter().filter(|p| inside.at(p.0, p.1));
        let here = v[y * w + x];
        inner.map(|p| here - v[p.1 * w + p.0]).sum::<f32>() + held.at(x, y) * here
    }
    #[test]
    fn the_equation_holds_on_a_ragged_grid_from_any_start() {
        let size = Size::new(97, 61);
        let is_inner = |x: usize, y: usize| x > 0 && y > 0 && x < 96 && y < 60;
        let inside =
            Plane::from_fn(size, |x, y| is_inner(x, y) && (x * 7 + y * 3) % 11 != 0 && (x / 9 + y / 8) % 4 != 3);
        let held = Plane::from_fn(size, |x, y| if inside.at(x, y) { ((x + y) % 5) as f32 * 0.3 + 0.01 } else { 0.0 });
        let b: Vec<f32> =
            inside.values().iter().enumerate().map(|(i, is)| if *is { (i % 7) as f32 } else { 0.0 }).collect();
        let solver = Solver::new(&inside, held.clone());
        for start in [None, Some(vec![0.0; size.area()])] {
            let v = solver.solve(&b, start, 1e-11);
            for (x, y) in (1..60).flat_map(|y| (1..96).map(move |x| (x, y))).filter(|p| inside.at(p.0, p.1)) {
                let left = b[y * 97 + x] - applied_at(&inside, &held, &v, x, y);
                assert!(left.abs() < 2e-3, "{left} left at ({x}, {y})");
            }
        }
    }
    /// v = 0 outside a disc and −∇²v = 4 inside: v = R² − r², off by the stairs of the rim.
    #[test]
    fn few_steps_from_nothing_solve_a_large_disc() {
        let (n, radius) = (301usize, 140.0f32);
        let size = Size::new(n as u32, n as u32);
        let inside = Plane::from_fn(size, |x, y| (x as f32 - 150.0).hypot(y as f32 - 150.0) < radius);
        let held = Plane::from_fn(size, |x, y| {
            let out = |x: usize, y: usize| if inside.at(x, y) { 0.0 } else { 1.0 };
            if !inside.at(x, y) { 0.0 } else { out(x - 1, y) + out(x + 1, y) + out(x, y - 1) + out(x, y + 1) }
        });
        let b: Vec<f32> = inside.values().iter().map(|is| if *is { 4.0 } else { 0.0 }).collect();
        let v = Solver::new(&inside, held).solve(&b, None, 1e-9);
        let top = v[150 * n + 150];
        assert!((top / (radius * radius) - 1.0).abs() < 0.01, "{top}");
    }
}
