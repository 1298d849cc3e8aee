//! One grid of the solver: its couplings, and what is done row by row with planes over it.
//! Floor 3.

use crate::math::parallel;
use crate::memory::fill_or_unwind;

/// A rim is nearer to the middle of a block than to those of its pixels, but less than twice: the
/// block is held by this share of what holds its pixels there. Measured on discs and ragged stars:
/// 0.75 takes the fewest steps, 0.5 three times as many.
const HELD_BY_RIM: f32 = 0.75;
/// Rows that one task works on.
pub(super) const BAND: usize = 16;
/// Pixels that are worth a task: less is done sooner than it is handed to another thread.
const LEAST_PX: usize = 1 << 14;

/// Bands of a width that are not divided among threads.
pub(super) fn least_bands(w: usize) -> usize {
    LEAST_PX.div_ceil(w * BAND)
}

/// One grid: its first and last rows and columns hold no unknowns.
pub(super) struct Level {
    pub w: usize,
    pub h: usize,
    /// The coupling of each pixel to the next in its row, and its column.
    pub right: Vec<f32>,
    pub down: Vec<f32>,
    /// Couplings toward 0.
    pub held: Vec<f32>,
    /// Sum of all couplings at a pixel, and its inverse; 0 where there is no unknown.
    pub diagonal: Vec<f32>,
    pub inverse: Vec<f32>,
}

impl Level {
    pub(super) fn new(w: usize, h: usize, right: Vec<f32>, down: Vec<f32>, held: Vec<f32>) -> Self {
        let mut diagonal = fill_or_unwind(w * h, 0.0);
        let mut inverse = fill_or_unwind(w * h, 0.0);
        let rows = diagonal.chunks_mut(w).zip(inverse.chunks_mut(w)).enumerate();
        parallel::for_each(rows, 1, |(y, (diagonal, inverse))| {
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

    /// The grid of 2 × 2 blocks, shifted by a pixel so that its border is empty as well. Couplings
    /// between blocks are those that cross, halved because they are twice as long.
    pub(super) fn coarser(&self) -> Self {
        let (w, h) = ((self.w - 1) / 2 + 2, (self.h - 1) / 2 + 2);
        let blocks = |value: &(dyn Fn(usize, usize) -> f32 + Sync)| {
            let mut out = fill_or_unwind(w * h, 0.0);
            parallel::for_each_row(&mut out, w, 1, |y, row| {
                for (x, v) in row.iter_mut().enumerate() {
                    *v = value(x, y);
                }
            });
            out
        };
        let at = |plane: &[f32], x: usize, y: usize| self.at_number(plane, x, y);
        let right = blocks(&|x, y| {
            let x = 2 * x + 1;
            if x > self.w { 0.0 } else { 0.5 * (in_rows(self.h, 2 * y, |y| at(&self.right, x, y))) }
        });
        let down = blocks(&|x, y| {
            let y = 2 * y + 1;
            if y > self.h { 0.0 } else { 0.5 * (in_rows(self.w, 2 * x, |x| at(&self.down, x, y))) }
        });
        let held = blocks(&|x, y| self.held_of_block(x, y));
        Self::new(w, h, right, down, held)
    }

    /// The value of a pixel, numbered from 1; 0 beyond the grid. The pixels of block x have the
    /// numbers 2x and 2x + 1.
    #[inline(always)]
    fn at_number(&self, plane: &[f32], x: usize, y: usize) -> f32 {
        let inside = x > 0 && y > 0 && x <= self.w && y <= self.h;
        if inside { plane[(y - 1) * self.w + x - 1] } else { 0.0 }
    }

    /// The coupling toward 0 of a block of the coarser grid.
    pub(super) fn held_of_block(&self, x: usize, y: usize) -> f32 {
        let held = |x: usize, y: usize| {
            let held = self.at_number(&self.held, x, y);
            // A pixel with all its neighbors is not held by a rim, but where it is itself.
            let is_inner = held > 0.0 && self.at_number(&self.diagonal, x, y) - held > 3.999;
            if is_inner { held } else { HELD_BY_RIM * held }
        };
        in_rows(self.h, 2 * y, |y| in_rows(self.w, 2 * x, |x| held(x, y)))
    }

    /// Gives a pixel away from the border another coupling toward 0.
    pub(super) fn hold(&mut self, (x, y): (usize, usize), held: f32) {
        let (w, i) = (self.w, y * self.w + x);
        if x == 0 || y == 0 || x + 1 >= w || y + 1 >= self.h {
            return;
        }
        self.held[i] = held;
        let sum = self.right[i] + self.down[i] + self.right[i - 1] + self.down[i - w] + held;
        self.diagonal[i] = sum;
        self.inverse[i] = if sum > 0.0 { 1.0 / sum } else { 0.0 };
    }

    pub(super) fn row<'a>(&self, plane: &'a [f32], y: usize) -> &'a [f32] {
        &plane[y * self.w..(y + 1) * self.w]
    }

    /// Fills the inner rows of a plane; the function gets each row's number.
    pub(super) fn fill(&self, out: &mut [f32], row: impl Fn(usize, &mut [f32]) + Sync) {
        let (w, h) = (self.w, self.h);
        parallel::for_each_row(out, w * BAND, least_bands(w), |band, rows| {
            for (y, out) in (band * BAND..).zip(rows.chunks_mut(w)) {
                if y > 0 && y + 1 < h {
                    row(y, out);
                }
            }
        });
    }

    pub(super) fn couplings(&self, y: usize) -> Couplings<'_> {
        Couplings {
            right: self.row(&self.right, y),
            up: self.row(&self.down, y - 1),
            down: self.row(&self.down, y),
            diagonal: self.row(&self.diagonal, y),
            inverse: self.row(&self.inverse, y),
        }
    }

    /// Three rows of a field around a row.
    pub(super) fn rows_around<'a>(&self, v: &'a [f32], y: usize) -> [&'a [f32]; 3] {
        [self.row(v, y - 1), self.row(v, y), self.row(v, y + 1)]
    }

    /// One damped sweep of Jacobi from `v` into `out`.
    pub(super) fn relax(&self, v: &[f32], b: &[f32], step: f32, out: &mut [f32]) {
        self.fill(out, |y, out| {
            relax_row(self.couplings(y), self.rows_around(v, y), self.row(b, y), step, out)
        });
    }
}

/// The sum of a value over the two pixels of a block, numbered from 1 as blocks are; none beyond
/// `n`.
#[inline(always)]
pub(super) fn in_rows(n: usize, first: usize, value: impl Fn(usize) -> f32) -> f32 {
    let one = |i: usize| if i > 0 && i <= n { value(i) } else { 0.0 };
    one(first) + one(first + 1)
}

/// The couplings of one row of pixels.
#[derive(Clone, Copy)]
pub(super) struct Couplings<'a> {
    right: &'a [f32],
    up: &'a [f32],
    down: &'a [f32],
    diagonal: &'a [f32],
    inverse: &'a [f32],
}

crate::widest! {
    /// v + step (D⁻¹ (b + pull) − v).
    pub(super) fn relax_row(couplings: Couplings, v: [&[f32]; 3], b: &[f32], step: f32, out: &mut [f32]) {
        let n = out.len();
        let Couplings { right, up, down, inverse, .. } = couplings;
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
    pub(super) fn multiply(couplings: Couplings, v: [&[f32]; 3], out: &mut [f32]) {
        let n = out.len();
        let Couplings { right, up, down, diagonal, .. } = couplings;
        let [above, here, below] = v;
        let (right, up, down, diagonal) = (&right[..n], &up[..n], &down[..n], &diagonal[..n]);
        let (above, here, below) = (&above[..n], &here[..n], &below[..n]);
        for x in 1..n - 1 {
            let across = right[x - 1] * here[x - 1] + right[x] * here[x + 1];
            out[x] = diagonal[x] * here[x] - (across + up[x] * above[x] + down[x] * below[x]);
        }
    }

    /// b − A v.
    pub(super) fn compute_residual(couplings: Couplings, v: [&[f32]; 3], b: &[f32], out: &mut [f32]) {
        multiply_into(couplings, v, out);
        for (o, b) in out.iter_mut().zip(b) {
            *o = b - *o;
        }
    }

    /// Σ a b in eight lanes.
    pub(super) fn dot(a: &[f32], b: &[f32]) -> f64 {
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
    pub(super) fn add(v: &mut [f32], step: f32, d: &[f32]) {
        for (v, d) in v.iter_mut().zip(d) {
            *v += step * d;
        }
    }
}

/// The body of [`multiply`] for callers that are already inside `widest!`.
#[inline(always)]
pub(super) fn multiply_into(couplings: Couplings, v: [&[f32]; 3], out: &mut [f32]) {
    let n = out.len();
    let [above, here, below] = v;
    for x in 1..n - 1 {
        let across = couplings.right[x - 1] * here[x - 1] + couplings.right[x] * here[x + 1];
        let pull = across + couplings.up[x] * above[x] + couplings.down[x] * below[x];
        out[x] = couplings.diagonal[x] * here[x] - pull;
    }
}

/// Sums over two planes, folded band by band.
pub(super) fn dots(w: usize, a: &[f32], b: &[f32]) -> f64 {
    let [a, b] = [a, b].map(|values| values.chunks(w * BAND).collect::<Vec<_>>());
    parallel::collect(a.len(), least_bands(w), |i| dot(a[i], b[i])).iter().sum()
}
