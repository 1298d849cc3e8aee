//! The loops of the solver over a row of the grid, in plain loops that the compiler vectorizes.
//! Floor 2. Their twin that reads like the equation is `PoissonGrid::pull`.

/// The couplings of a row of unknowns: to the right, up (none in the first row) and down.
#[derive(Clone, Copy)]
pub(super) struct GridRow<'g> {
    pub right: &'g [f32],
    pub up: &'g [f32],
    pub down: &'g [f32],
}

/// Visits every unknown of a row with Σ w, its own value and Σ w v over its neighbors.
///
/// `[above, here, below]`: the values; above and below are empty beyond the grid.
#[inline(always)]
fn each(
    row: GridRow,
    [above, here, below]: [&[f32]; 3],
    mut visit: impl FnMut(usize, f32, f32, f32),
) {
    let n = here.len();
    // The first and last rows have couplings to nowhere, of stiffness 0: any row of the right length
    // will do.
    let (up, above) =
        if row.up.len() == n && above.len() == n { (row.up, above) } else { (&ZEROS[..0], here) };
    let below = if below.len() == n { below } else { here };
    let (right, down) = (&row.right[..n], &row.down[..n]);
    let edge = |x: usize| {
        let u = up.get(x).copied().unwrap_or(0.0);
        let left = if x > 0 { (right[x - 1], here[x - 1]) } else { (0.0, 0.0) };
        let ahead = if x + 1 < n { (right[x], here[x + 1]) } else { (0.0, 0.0) };
        let sum = left.0 + ahead.0 + u + down[x];
        (sum, left.0 * left.1 + ahead.0 * ahead.1 + u * above[x] + down[x] * below[x])
    };
    if n == 0 {
        return;
    }
    let (sum, pull) = edge(0);
    visit(0, sum, here[0], pull);
    if up.len() == n {
        let (up, above, below) = (&up[..n], &above[..n], &below[..n]);
        for x in 1..n - 1 {
            let (l, r, u, d) = (right[x - 1], right[x], up[x], down[x]);
            let pull = l * here[x - 1] + r * here[x + 1] + u * above[x] + d * below[x];
            visit(x, l + r + u + d, here[x], pull);
        }
    } else {
        for x in 1..n - 1 {
            let (l, r, d) = (right[x - 1], right[x], down[x]);
            visit(x, l + r + d, here[x], l * here[x - 1] + r * here[x + 1] + d * below[x]);
        }
    }
    if n > 1 {
        let (sum, pull) = edge(n - 1);
        visit(n - 1, sum, here[n - 1], pull);
    }
}

const ZEROS: [f32; 1] = [0.0];
/// Divides in place of Σ w = 0, where the numerator is 0 too.
const LEAST: f32 = 1e-30;

crate::widest! {
    /// The first sweep of Jacobi, from nothing: `step · b / Σ w`.
    pub(super) fn start_row(row: GridRow, b: &[f32], step: f32, out: &mut [f32]) {
        each(row, [b, b, b], |x, sum, b, _| out[x] = step * b / sum.max(LEAST));
    }

    /// One sweep of Jacobi: `v + step ((b + Σ w v) / Σ w − v)`.
    pub(super) fn relax_row(row: GridRow, v: [&[f32]; 3], b: &[f32], step: f32, out: &mut [f32]) {
        let (b, out) = (&b[..v[1].len()], &mut out[..v[1].len()]);
        each(row, v, |x, sum, v, pull| out[x] = v + step * ((b[x] + pull) / sum.max(LEAST) - v));
    }

    /// b − A v.
    pub(super) fn residual_row(row: GridRow, v: [&[f32]; 3], b: &[f32], out: &mut [f32]) {
        let (b, out) = (&b[..v[1].len()], &mut out[..v[1].len()]);
        each(row, v, |x, sum, v, pull| out[x] = b[x] - (sum * v - pull));
    }

    /// A v.
    pub(super) fn apply_row(row: GridRow, v: [&[f32]; 3], out: &mut [f32]) {
        let out = &mut out[..v[1].len()];
        each(row, v, |x, sum, v, pull| out[x] = sum * v - pull);
    }

    /// z + turn · direction, in place.
    pub(super) fn turn(z: &[f32], turn: f32, direction: &mut [f32]) {
        for (d, z) in direction.iter_mut().zip(z) {
            *d = z + turn * *d;
        }
    }

    /// v + step · direction, in place.
    pub(super) fn walk(step: f32, direction: &[f32], v: &mut [f32]) {
        for (v, d) in v.iter_mut().zip(direction) {
            *v += step * d;
        }
    }

    /// Σ a b: eight sums side by side in f32 over a short run, runs in f64.
    pub(super) fn dot(a: &[f32], b: &[f32]) -> f64 {
        const LANES: usize = 16;
        const RUN: usize = 1024;
        let mut total = 0.0;
        for (a, b) in a.chunks(RUN).zip(b.chunks(RUN)) {
            let mut sums = [0.0f32; LANES];
            let (whole, rest) = (a.chunks_exact(LANES), a.len() / LANES * LANES);
            for (a, b) in whole.zip(b.chunks_exact(LANES)) {
                for k in 0..LANES {
                    sums[k] += a[k] * b[k];
                }
            }
            total += sums.iter().map(|&s| f64::from(s)).sum::<f64>();
            total += a[rest..].iter().zip(&b[rest..]).map(|(a, b)| f64::from(a * b)).sum::<f64>();
        }
        total
    }
}
