//! The weights of a row of pixels of a warp, in plain loops over rows of numbers that the compiler
//! vectorizes. Floor 1. Their twins for one pixel are in `window`.

use super::Resampling;
use super::window::{LONGEST_KEPT_PX, WIDEST_PX, cubic_of};
use crate::math::fast::{max, min};
use crate::raster::TILE;

/// A number for each pixel.
pub type TileRow = [f32; TILE];

/// How a side weights what lies along it.
#[derive(Clone, Copy, PartialEq)]
pub enum SideKind {
    Cubic,
    Reduces,
    Either,
}

/// The pieces of the source that pixels show, and the taps in them.
pub struct WarpPatchRow {
    /// The matrix from a step of the source to ratios of the two sides, column by column.
    pub to_sides: [TileRow; 4],
    pub determinant: TileRow,
    /// The first and the last tap, columns and rows.
    pub low: [TileRow; 2],
    pub high: [TileRow; 2],
    /// The farther reach of the two.
    pub reach: TileRow,
}

impl Default for WarpPatchRow {
    fn default() -> Self {
        let row = [0.0; TILE];
        Self { to_sides: [row; 4], determinant: row, low: [row; 2], high: [row; 2], reach: row }
    }
}

/// The weight of steps along a side.
pub fn weigh(kind: SideKind, t: &[f32], tent: &[f32], filter: Resampling, out: &mut [f32]) {
    let cubic = Cubic::of(filter);
    match kind {
        SideKind::Cubic => cubic_steps(t, cubic, out),
        SideKind::Reduces => shares(t, tent, out),
        SideKind::Either => shares_or_cubic(t, tent, cubic, out),
    }
}

/// The two pieces of a cubic, highest power first.
#[derive(Clone, Copy)]
struct Cubic {
    near: [f32; 3],
    far: [f32; 4],
}

impl Cubic {
    #[inline(always)]
    fn of(filter: Resampling) -> Self {
        let (b, c) = cubic_of(filter);
        let near = [12.0 - 9.0 * b - 6.0 * c, -18.0 + 12.0 * b + 6.0 * c, 6.0 - 2.0 * b];
        Self {
            near,
            far: [-b - 6.0 * c, 6.0 * b + 30.0 * c, -12.0 * b - 48.0 * c, 8.0 * b + 24.0 * c],
        }
    }

    /// In the order of the scalar twin.
    #[inline(always)]
    fn weight(self, d: f32) -> f32 {
        let d = d.abs();
        let near = self.near[0] * d * d * d + self.near[1] * d * d + self.near[2];
        let far = self.far[0] * d * d * d + self.far[1] * d * d + self.far[2] * d + self.far[3];
        let sixfold = if d < 1.0 { near } else { far };
        if d < 2.0 { sixfold / 6.0 } else { 0.0 }
    }
}

#[inline(always)]
fn share(t: f32, tent: f32) -> f32 {
    let below = |edge: f32| {
        let x = min(max((edge - t) / tent, -1.0), 1.0);
        let (rising, falling) = (0.5 * (x + 1.0) * (x + 1.0), 1.0 - 0.5 * (1.0 - x) * (1.0 - x));
        if x < 0.0 { rising } else { falling }
    };
    below(0.5) - below(-0.5)
}

crate::widest! {
    pub fn sides(x: &[f32], y: &[f32], out: (&mut [f32], &mut [f32]), reach: &mut [f32], tent: &mut [f32]) {
        let n = x.len();
        let (y, sx, sy, reach, tent) = (&y[..n], &mut out.0[..n], &mut out.1[..n], &mut reach[..n], &mut tent[..n]);
        for k in 0..n {
            let length = (x[k] * x[k] + y[k] * y[k]).sqrt();
            let recip = 1.0 / length;
            let is_known = recip > 0.0 && recip < f32::INFINITY;
            let (dx, dy) = (if is_known { x[k] * recip } else { 1.0 }, if is_known { y[k] * recip } else { 0.0 });
            let length = if length < WIDEST_PX { length } else { WIDEST_PX };
            let reduces = length > LONGEST_KEPT_PX;
            let length = if reduces { length } else { 1.0 };
            tent[k] = 1.0 / length;
            reach[k] = if reduces { 0.5 + tent[k] } else { 2.0 };
            (sx[k], sy[k]) = (dx * length, dy * length);
        }
    }

    /// The inverses of two sides.
    pub fn invert_sides(sides: [&[f32]; 4], out: &mut WarpPatchRow) {
        let n = sides[0].len();
        let [a, b, c, d] = sides.map(|row| &row[..n]);
        let WarpPatchRow { to_sides: [p, q, r, s], determinant, .. } = out;
        let (p, q, r, s, determinant) =
            (&mut p[..n], &mut q[..n], &mut r[..n], &mut s[..n], &mut determinant[..n]);
        for k in 0..n {
            determinant[k] = a[k] * d[k] - b[k] * c[k];
            let recip = 1.0 / determinant[k];
            p[k] = d[k] * recip;
            q[k] = b[k] * -recip;
            r[k] = c[k] * -recip;
            s[k] = a[k] * recip;
        }
    }

    /// The first and the last tap along an axis, and how far they reach.
    pub fn extents(
        p: &[f32],
        sides: [&[f32]; 2],
        reaches: [&[f32]; 2],
        is_first: bool,
        out: (&mut [f32], &mut [f32], &mut [f32]),
    ) {
        let n = p.len();
        let ([a, b], [u, v]) = (sides.map(|row| &row[..n]), reaches.map(|row| &row[..n]));
        let (low, high, farther) = (&mut out.0[..n], &mut out.1[..n], &mut out.2[..n]);
        for k in 0..n {
            let reach = a[k].abs() * u[k] + b[k].abs() * v[k];
            low[k] = (p[k] - reach - 0.5).ceil();
            high[k] = (p[k] + reach - 0.5).floor();
            farther[k] = if is_first || reach > farther[k] { reach } else { farther[k] };
        }
    }

    /// The distance of a tap from each point, in ratios of the two sides.
    pub fn steps(patches: &WarpPatchRow, points: [&[f32]; 2], step: [f32; 2], out: (&mut [f32], &mut [f32])) {
        let n = points[0].len();
        let [px, py] = points.map(|row| &row[..n]);
        let [p, q, r, s] = &patches.to_sides;
        let (p, q, r, s) = (&p[..n], &q[..n], &r[..n], &s[..n]);
        let (x, y) = (&patches.low[0][..n], &patches.low[1][..n]);
        let (along, across) = (&mut out.0[..n], &mut out.1[..n]);
        for k in 0..n {
            let (dx, dy) = (x[k] + step[0] + 0.5 - px[k], y[k] + step[1] + 0.5 - py[k]);
            along[k] = p[k] * dx + r[k] * dy;
            across[k] = q[k] * dx + s[k] * dy;
        }
    }

    fn cubic_steps(t: &[f32], cubic: Cubic, out: &mut [f32]) {
        for (out, t) in out.iter_mut().zip(t) {
            *out = cubic.weight(*t);
        }
    }

    fn shares(t: &[f32], tent: &[f32], out: &mut [f32]) {
        for (out, (t, tent)) in out.iter_mut().zip(t.iter().zip(tent)) {
            *out = share(*t, *tent);
        }
    }

    fn shares_or_cubic(t: &[f32], tent: &[f32], cubic: Cubic, out: &mut [f32]) {
        for (out, (t, tent)) in out.iter_mut().zip(t.iter().zip(tent)) {
            let (share, weight) = (share(*t, *tent), cubic.weight(*t));
            *out = if *tent < 1.0 { share } else { weight };
        }
    }

    /// The weights of the four pixels around each point along one axis.
    pub fn cubic_weights(p: &[f32], filter: Resampling, out: &mut [TileRow; 4]) {
        let n = p.len();
        let cubic = Cubic::of(filter);
        let [a, b, c, d] = out;
        let (a, b, c, d) = (&mut a[..n], &mut b[..n], &mut c[..n], &mut d[..n]);
        for k in 0..n {
            let x = p[k] - 0.5;
            let t = x - x.floor();
            a[k] = cubic.weight(t + 1.0);
            b[k] = cubic.weight(t);
            c[k] = cubic.weight(1.0 - t);
            d[k] = cubic.weight(2.0 - t);
        }
    }
}
