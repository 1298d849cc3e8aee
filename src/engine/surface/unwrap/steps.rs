//! The local and the global steps that unwrap a surface: S is turned as the last solution turned
//! it, then solved again (MATH 8). Floor 2. Here they run over whole rows; `reference` in the tests
//! reads like the equation.

use crate::math::{Vec2, parallel};
use crate::surface::poisson::PoissonGrid;

/// S − 1 of every pixel of a grid: the entries xx, xy and yy.
pub(super) struct Metric {
    pub xx: Vec<f32>,
    pub xy: Vec<f32>,
    pub yy: Vec<f32>,
}

/// Rows that one task works on.
const BAND: usize = 32;

/// R S − 1 of a row of pixels, entry by entry: xx, xy, yx, yy.
#[derive(Clone)]
struct TurnedRow([Vec<f32>; 4]);

/// Σ_j w_ij t_ij into `out`: the right-hand side of MATH 8 for δ = D − q, its x and its y.
///
/// t_ij is the column of R S − 1 along the link, averaged over its two ends.
///
/// * `moved`: δ of the last step, whose rotation turns S; `None` at first: R = 1.
pub(super) fn sources(
    grid: &PoissonGrid,
    metric: &Metric,
    moved: Option<[&[f32]; 2]>,
    out: [&mut [f32]; 2],
) {
    let w = grid.width();
    let [out_x, out_y] = out;
    let bands = out_x.chunks_mut(w * BAND).zip(out_y.chunks_mut(w * BAND)).enumerate();
    parallel::for_each(bands, 1, |(band, (out_x, out_y))| {
        let empty = TurnedRow(std::array::from_fn(|_| vec![0.0; w]));
        let (mut above, mut here, mut below) = (empty.clone(), empty.clone(), empty);
        let first = band * BAND;
        if first > 0 {
            solve_local_steps(grid, metric, moved, first - 1, &mut above);
        }
        solve_local_steps(grid, metric, moved, first, &mut here);
        let rows = out_x.chunks_mut(w).zip(out_y.chunks_mut(w));
        for (y, (out_x, out_y)) in (first..).zip(rows) {
            if (y + 1) * w < grid.couplings()[0].len() {
                solve_local_steps(grid, metric, moved, y + 1, &mut below);
            }
            let couplings = CouplingRows::of(grid, y);
            let [xx, xy, yx, yy] = &here.0;
            add_row_links(couplings, xx, out_x);
            add_row_links(couplings, yx, out_y);
            down_row(couplings, [&above.0[1], xy, &below.0[1]], out_x);
            down_row(couplings, [&above.0[3], yy, &below.0[3]], out_y);
            std::mem::swap(&mut above, &mut here);
            std::mem::swap(&mut here, &mut below);
        }
    });
}

/// The couplings that begin or end in a row of pixels; `up` is empty in the first.
#[derive(Clone, Copy)]
struct CouplingRows<'g> {
    right: &'g [f32],
    up: &'g [f32],
    down: &'g [f32],
}

impl<'g> CouplingRows<'g> {
    fn of(grid: &'g PoissonGrid, y: usize) -> Self {
        let (w, [right, down]) = (grid.width(), grid.couplings());
        let up = if y == 0 { &[][..] } else { &down[(y - 1) * w..y * w] };
        Self { right: &right[y * w..(y + 1) * w], up, down: &down[y * w..(y + 1) * w] }
    }
}

fn solve_local_steps(
    grid: &PoissonGrid,
    metric: &Metric,
    moved: Option<[&[f32]; 2]>,
    y: usize,
    out: &mut TurnedRow,
) {
    let w = grid.width();
    let at = y * w..(y + 1) * w;
    let s = [&metric.xx[at.clone()], &metric.xy[at.clone()], &metric.yy[at.clone()]];
    let [xx, xy, yx, yy] = &mut out.0;
    let Some(moved) = moved else {
        [(xx, 0), (xy, 1), (yx, 1), (yy, 2)]
            .into_iter()
            .for_each(|(out, i)| out.copy_from_slice(s[i]));
        return;
    };
    let rows = moved.map(|v| {
        let row = |y: usize| v.get(y * w..(y + 1) * w).unwrap_or(&v[at.clone()]);
        [row(y.max(1) - 1), row(y), row(y + 1)]
    });
    let none = vec![0.0; if y == 0 { w } else { 0 }];
    let couplings = CouplingRows::of(grid, y);
    let couplings = CouplingRows { up: if y == 0 { &none } else { couplings.up }, ..couplings };
    fill_local_steps(couplings, s, rows, [xx, xy, yx, yy]);
}

/// The local step at one pixel: R S − 1.
///
/// * `s`: S − 1; `dx`, `dy`: ∂δ/∂x and ∂δ/∂y, each with whether the pixel has a neighbor that way.
#[inline(always)]
fn local_step_at(
    [a, b, c]: [f32; 3],
    (dx, has_x): (Vec2, f32),
    (dy, has_y): (Vec2, f32),
) -> [f32; 4] {
    // J, rows of it; M = J S⁻¹ up to a positive factor, which its angle does not see.
    let (jxx, jyx, jxy, jyy) = (dx.x + has_x, dx.y, dy.x, dy.y + has_y);
    let cos = jxx * (1.0 + c) - jxy * b - jyx * b + jyy * (1.0 + a);
    let sin = jyx * (1.0 + c) - jyy * b + jxx * b - jxy * (1.0 + a);
    let squared = cos * cos + sin * sin;
    let (cos, sin) =
        if squared > 0.0 { (cos / squared.sqrt(), sin / squared.sqrt()) } else { (1.0, 0.0) };
    [
        cos * (1.0 + a) - sin * b - 1.0,
        cos * b - sin * (1.0 + c),
        sin * (1.0 + a) + cos * b,
        sin * b + cos * (1.0 + c) - 1.0,
    ]
}

crate::widest! {
    /// The local step over a row; δ as rows above, here and below, x and y.
    fn fill_local_steps(couplings: CouplingRows, s: [&[f32]; 3], moved: [[&[f32]; 3]; 2], out: [&mut [f32]; 4]) {
        let n = s[0].len();
        let [a, b, c] = s.map(|s| &s[..n]);
        let (right, up, down) = (&couplings.right[..n], &couplings.up[..n], &couplings.down[..n]);
        let [[above_x, x, below_x], [above_y, y, below_y]] = moved.map(|rows| rows.map(|row| &row[..n]));
        let [xx, xy, yx, yy] = out;
        let (xx, xy, yx, yy) = (&mut xx[..n], &mut xy[..n], &mut yx[..n], &mut yy[..n]);
        let is = |coupling: f32| if coupling > 0.0 { 1.0f32 } else { 0.0 };
        let mut one = |i: usize, before: usize, after: usize, left: f32| {
            let (l, r, u, d) = (is(left), is(right[i]), is(up[i]), is(down[i]));
            let half = |n: f32| if n > 1.5 { 0.5f32 } else { 1.0 };
            let slope = |v: &[f32]| (r * (v[after] - v[i]) + l * (v[i] - v[before])) * half(l + r);
            let fall = |a: &[f32], v: &[f32], b: &[f32]| (d * (b[i] - v[i]) + u * (v[i] - a[i])) * half(u + d);
            let dx = (Vec2::new(slope(x), slope(y)), l.max(r));
            let dy = (Vec2::new(fall(above_x, x, below_x), fall(above_y, y, below_y)), u.max(d));
            [xx[i], xy[i], yx[i], yy[i]] = local_step_at([a[i], b[i], c[i]], dx, dy);
        };
        if n > 0 {
            one(0, 0, 1.min(n - 1), 0.0);
        }
        for i in 1..n.max(1) - 1 {
            one(i, i - 1, i + 1, right[i - 1]);
        }
        if n > 1 {
            one(n - 1, n - 2, n - 1, right[n - 2]);
        }
    }

    /// Sets `out` to what the links along a row bring: those at the left, less those at the right.
    fn add_row_links(couplings: CouplingRows, t: &[f32], out: &mut [f32]) {
        let n = out.len();
        let (right, t) = (&couplings.right[..n], &t[..n]);
        let flow = |i: usize| if i + 1 < n { right[i] * 0.5 * (t[i] + t[i + 1]) } else { 0.0 };
        if n > 0 {
            out[0] = -flow(0);
        }
        for i in 1..n.max(1) - 1 {
            out[i] = right[i - 1] * 0.5 * (t[i - 1] + t[i]) - right[i] * 0.5 * (t[i] + t[i + 1]);
        }
        if n > 1 {
            out[n - 1] = flow(n - 2);
        }
    }

    /// Adds what the links down the columns bring.
    fn down_row(couplings: CouplingRows, t: [&[f32]; 3], out: &mut [f32]) {
        let (n, [above, here, below]) = (out.len(), t);
        let (down, above, here, below) = (&couplings.down[..n], &above[..n], &here[..n], &below[..n]);
        for i in 0..n {
            out[i] -= down[i] * 0.5 * (here[i] + below[i]);
        }
        for (i, up) in couplings.up.iter().enumerate() {
            out[i] += up * 0.5 * (above[i] + here[i]);
        }
    }
}
