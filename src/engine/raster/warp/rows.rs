//! Pixels of a warp computed together: to the bit as [`SourceWindow::sample`] gives them one by
//! one. Floor 1.
//!
//! Weights of a row of pixels are computed tap by tap (`weights`); then each pixel adds up what it
//! reads, in the order of the taps.

use super::Resampling;
use super::linear::LinearRow;
use super::points::PointRow;
use super::weights::{
    SideKind, TileRow, WarpPatchRow, cubic_weights, extents, invert_sides, sides, steps, weigh,
};
use super::window::{LEAST_LINEAR_TENT, MOST_READ_ALONG, SourceWindow};
use crate::raster::TILE;

/// Taps along each axis that are weighted together; patches that take more are read pixel by pixel.
const MOST_TAPS: usize = 8;

/// Buffers for a row of pixels.
pub(super) struct WarpScratch {
    sides: [SideRow; 2],
    linear: LinearRow,
    patches: WarpPatchRow,
    /// For each tap, row by row of the source, the weights of all pixels.
    weights: Vec<TileRow>,
    /// The weights along both axes.
    cubic: [[TileRow; 4]; 2],
}

impl Default for WarpScratch {
    fn default() -> Self {
        Self {
            sides: std::array::from_fn(|_| SideRow::default()),
            linear: LinearRow::default(),
            patches: WarpPatchRow::default(),
            weights: vec![[0.0; TILE]; MOST_TAPS * MOST_TAPS],
            cubic: [[[0.0; TILE]; 4]; 2],
        }
    }
}

/// One side of the piece of the source that each pixel shows, like `PatchSide` for one pixel.
struct SideRow {
    x: TileRow,
    y: TileRow,
    reach: TileRow,
    /// Below 1 where the side reduces.
    tent: TileRow,
}

impl Default for SideRow {
    fn default() -> Self {
        Self { x: [0.0; TILE], y: [0.0; TILE], reach: [0.0; TILE], tent: [1.0; TILE] }
    }
}

impl SideRow {
    fn fill(&mut self, x: &[f32], y: &[f32]) {
        let n = x.len();
        sides(
            x,
            y,
            (&mut self.x[..n], &mut self.y[..n]),
            &mut self.reach[..n],
            &mut self.tent[..n],
        );
    }

    fn is_reduced(&self, k: usize) -> bool {
        self.tent[k] < 1.0
    }

    /// Short enough for four pixels to leave none out.
    fn is_linear(&self, k: usize) -> bool {
        self.tent[k] >= LEAST_LINEAR_TENT
    }

    fn kind(&self, n: usize) -> SideKind {
        match self.tent[..n].iter().filter(|tent| **tent < 1.0).count() {
            0 => SideKind::Cubic,
            count if count == n => SideKind::Reduces,
            _ => SideKind::Either,
        }
    }
}

impl SourceWindow {
    /// What the first pixels of a row show; transparent where they show no point.
    pub fn row(
        &self,
        points: &PointRow,
        filter: Resampling,
        scratch: &mut WarpScratch,
        out: &mut [[f32; 4]],
    ) {
        let n = out.len();
        let shown = || {
            points.shows[..n]
                .iter()
                .copied()
                .enumerate()
                .filter(|(_, shows)| *shows)
                .map(|(k, _)| k)
        };
        out.fill([0.0; 4]);
        if filter == Resampling::Nearest {
            shown().for_each(|k| {
                out[k] = self.pixel(points.x[k].floor() as i32, points.y[k].floor() as i32)
            });
            return;
        }
        let WarpScratch { sides: [right, down], linear, .. } = scratch;
        linear.takes.fill(false);
        let [a, b, c, d] = &points.jacobian;
        right.fill(&a[..n], &b[..n]);
        down.fill(&c[..n], &d[..n]);
        let (mut some_cubic, mut some_reduced) = (false, false);
        for k in shown() {
            let reduces = right.is_reduced(k) || down.is_reduced(k);
            linear.takes[k] =
                filter == Resampling::Linear && right.is_linear(k) && down.is_linear(k);
            some_cubic |= !reduces && !linear.takes[k];
            some_reduced |= reduces && !linear.takes[k];
        }
        if filter == Resampling::Linear {
            self.linear_row(points, linear, out);
        }
        if some_cubic {
            cubic_weights(&points.x[..n], filter, &mut scratch.cubic[0]);
            cubic_weights(&points.y[..n], filter, &mut scratch.cubic[1]);
        }
        let taps = if some_reduced { scratch.patches_of(points, n, filter) } else { [0; 2] };
        for k in shown().filter(|_| some_cubic || some_reduced) {
            if scratch.linear.takes[k] {
                continue;
            }
            let reduces = scratch.sides.iter().any(|side| side.is_reduced(k));
            out[k] = match reduces {
                true => self.patch(points, k, filter, scratch, taps),
                false => self.interpolate_cubic(points, k, &scratch.cubic),
            };
        }
    }

    /// Like [`SourceWindow::cubic`], with known weights.
    fn interpolate_cubic(
        &self,
        points: &PointRow,
        k: usize,
        weights: &[[TileRow; 4]; 2],
    ) -> [f32; 4] {
        let (x, y) =
            ((points.x[k] - 0.5).floor() as i32 - 1, (points.y[k] - 0.5).floor() as i32 - 1);
        let mut sum = [0.0; 4];
        if let Some(first) = self.place_within(x, y, [4, 4]) {
            let wx: [f32; 4] = std::array::from_fn(|i| weights[0][i][k]);
            for (j, wy) in weights[1].iter().enumerate() {
                let row = &self.pixels[first + j * self.rect.width()..][..4];
                for (texel, wx) in row.iter().zip(wx) {
                    let weight = wx * wy[k];
                    (0..4).for_each(|c| sum[c] += weight * texel[c]);
                }
            }
            return sum;
        }
        if self.is_beyond(x, y, [4, 4]) {
            return sum;
        }
        for (j, wy) in weights[1].iter().enumerate() {
            for (i, wx) in weights[0].iter().enumerate() {
                let texel = self.pixel(x.saturating_add(i as i32), y.saturating_add(j as i32));
                (0..4).for_each(|c| sum[c] += wx[k] * wy[k] * texel[c]);
            }
        }
        sum
    }

    /// Like [`SourceWindow::area_mean`], with known weights if there are any.
    fn patch(
        &self,
        points: &PointRow,
        k: usize,
        filter: Resampling,
        scratch: &WarpScratch,
        known: [usize; 2],
    ) -> [f32; 4] {
        let patches = &scratch.patches;
        let taps = patches.taps(k);
        let is_plain =
            patches.determinant[k].abs() > 1e-3 && patches.reach[k] < 2.0 * MOST_READ_ALONG;
        let (Some([nx, ny]), true) = (taps, is_plain) else {
            let (p, jacobian) = points.at(k);
            return self.sample(p, jacobian, filter);
        };
        let (x, y) = (patches.low[0][k] as i32, patches.low[1][k] as i32);
        let (mut sum, mut total) = ([0.0; 4], 0.0);
        if let Some(first) = self.place_within(x, y, [nx, ny]) {
            for j in 0..ny {
                let row = &self.pixels[first + j * self.rect.width()..][..nx];
                for (texel, weights) in row.iter().zip(&scratch.weights[j * known[0]..]) {
                    let weight = weights[k];
                    total += weight;
                    (0..4).for_each(|c| sum[c] += weight * texel[c]);
                }
            }
        } else if !self.is_beyond(x, y, [nx, ny]) {
            for j in 0..ny {
                for (i, weights) in scratch.weights[j * known[0]..][..nx].iter().enumerate() {
                    let weight = weights[k];
                    total += weight;
                    let texel = self.pixel(x + i as i32, y + j as i32);
                    (0..4).for_each(|c| sum[c] += weight * texel[c]);
                }
            }
        }
        if total > 0.0 { sum.map(|v| v / total) } else { [0.0; 4] }
    }

    /// The index of the pixel at a corner, if the whole rectangle is held.
    fn place_within(&self, x: i32, y: i32, [nx, ny]: [usize; 2]) -> Option<usize> {
        let (x, y) =
            (i64::from(x) - i64::from(self.rect.x0), i64::from(y) - i64::from(self.rect.y0));
        let is_within = x >= 0
            && y >= 0
            && x + nx as i64 <= self.rect.width() as i64
            && y + ny as i64 <= self.rect.height() as i64;
        is_within.then(|| y as usize * self.rect.width() + x as usize)
    }

    /// Whether nothing of a rectangle is held and no border is repeated there.
    fn is_beyond(&self, x: i32, y: i32, [nx, ny]: [usize; 2]) -> bool {
        let apart = |low: i32, n: usize, from: i32, to: i32| {
            i64::from(low) >= i64::from(to) || i64::from(low) + n as i64 <= i64::from(from)
        };
        let rect = self.rect;
        !self.continues && (apart(x, nx, rect.x0, rect.x1) || apart(y, ny, rect.y0, rect.y1))
    }
}

impl WarpPatchRow {
    /// The number of taps that a pixel takes along each axis, if they are few.
    fn taps(&self, k: usize) -> Option<[usize; 2]> {
        let count = |i: usize| self.high[i][k] - self.low[i][k] + 1.0;
        let most = MOST_TAPS as f32;
        let [nx, ny] = [count(0), count(1)];
        // NaN, and positions so far away that neighbors are the same number, are not counted.
        let is_near = self.low[0][k].abs() < 1e6 && self.low[1][k].abs() < 1e6;
        (nx >= 0.0 && ny >= 0.0 && nx <= most && ny <= most && is_near)
            .then_some([nx as usize, ny as usize])
    }
}

impl WarpScratch {
    /// Finds the taps of a row of pixels and weights them; returns the greatest number of taps
    /// along each axis.
    fn patches_of(&mut self, points: &PointRow, n: usize, filter: Resampling) -> [usize; 2] {
        let Self { sides: [right, down], patches, weights, .. } = self;
        invert_sides([&right.x[..n], &right.y[..n], &down.x[..n], &down.y[..n]], patches);
        for (axis, p) in [&points.x, &points.y].into_iter().enumerate() {
            let of = |side: &SideRow| if axis == 0 { side.x } else { side.y };
            let (a, b) = (of(right), of(down));
            let (low, high) = (&mut patches.low[axis][..n], &mut patches.high[axis][..n]);
            let reach = &mut patches.reach[..n];
            extents(
                &p[..n],
                [&a[..n], &b[..n]],
                [&right.reach[..n], &down.reach[..n]],
                axis == 0,
                (low, high, reach),
            );
        }
        let counted = (0..n).filter(|k| points.shows[*k]).filter_map(|k| patches.taps(k));
        let taps = counted
            .fold([0; 2], |most: [usize; 2], taps| [most[0].max(taps[0]), most[1].max(taps[1])]);
        let kinds = [right.kind(n), down.kind(n)];
        let (mut s, mut t, mut along, mut across) =
            ([0.0; TILE], [0.0; TILE], [0.0; TILE], [0.0; TILE]);
        for (tap, out) in weights[..taps[0] * taps[1]].iter_mut().enumerate() {
            let step = [(tap % taps[0]) as f32, (tap / taps[0]) as f32];
            steps(patches, [&points.x[..n], &points.y[..n]], step, (&mut s[..n], &mut t[..n]));
            weigh(kinds[0], &s[..n], &right.tent[..n], filter, &mut along[..n]);
            weigh(kinds[1], &t[..n], &down.tent[..n], filter, &mut across[..n]);
            out[..n]
                .iter_mut()
                .zip(along.iter().zip(&across))
                .for_each(|(out, (a, b))| *out = a * b);
        }
        taps
    }
}
