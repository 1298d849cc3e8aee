//! A part of the source of a warp, and what pixels show of it, one by one. Floor 1. Not here: rows
//! of pixels (`rows`).

use super::Resampling;
use crate::math::{Mat2, Rect, Vec2, vec2};

/// Source pixels read along each axis to either side of a point.
pub(super) const MOST_READ_ALONG: f32 = 24.0;
/// The most of the source that a pixel shows along an axis, px: more occurs only at the horizon.
pub(super) const WIDEST_PX: f32 = 512.0;
/// A side hardly longer than a pixel belongs to a turned picture.
pub(super) const LONGEST_KEPT_PX: f32 = 1.0 + 1e-3;
/// Half the tent of a source pixel, in sides, of the longest side that [`Resampling::Linear`]
/// leaves no pixel out of.
pub(super) const LEAST_LINEAR_TENT: f32 = 0.5;

/// A part of the source.
pub(super) struct SourceWindow {
    pub rect: Rect,
    pub pixels: Vec<[f32; 4]>,
    /// Whether the border is repeated beyond the rectangle; else there is nothing.
    pub continues: bool,
}

impl SourceWindow {
    /// The mean of the source about a point: what [`SourceWindow::rows`](super::rows) compute
    /// together, pixel by pixel.
    pub fn sample(&self, p: Vec2, jacobian: Mat2, filter: Resampling) -> [f32; 4] {
        let (right, down) =
            (PatchSide::of(jacobian.x_axis, filter), PatchSide::of(jacobian.y_axis, filter));
        match filter {
            Resampling::Nearest => self.pixel(p.x.floor() as i32, p.y.floor() as i32),
            Resampling::Linear
                if [right, down].iter().all(|side| side.tent >= LEAST_LINEAR_TENT) =>
            {
                self.linear(p)
            }
            _ if !right.reduces && !down.reduces => self.cubic(p, filter),
            _ => self.area_mean(p, [right, down]),
        }
    }

    /// One pixel of the source.
    pub fn pixel(&self, x: i32, y: i32) -> [f32; 4] {
        let Rect { x0, y0, x1, y1 } = self.rect;
        let (x, y) =
            if self.continues { (x.clamp(x0, x1 - 1), y.clamp(y0, y1 - 1)) } else { (x, y) };
        if !self.rect.contains(x, y) {
            return [0.0; 4];
        }
        self.pixels[(y - self.rect.y0) as usize * self.rect.width() + (x - self.rect.x0) as usize]
    }

    /// 4 × 4 pixels under a cubic along the source's axes.
    pub fn cubic(&self, p: Vec2, filter: Resampling) -> [f32; 4] {
        let (x, y) = (p.x - 0.5, p.y - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let weights = |t: f32| [t + 1.0, t, 1.0 - t, 2.0 - t].map(|d| cubic_weight(d, filter));
        let (wx, wy) = (weights(x - x0), weights(y - y0));
        let mut sum = [0.0; 4];
        for (j, wy) in wy.into_iter().enumerate() {
            for (i, wx) in wx.into_iter().enumerate() {
                let texel = self.pixel(x0 as i32 + i as i32 - 1, y0 as i32 + j as i32 - 1);
                (0..4).for_each(|c| sum[c] += wx * wy * texel[c]);
            }
        }
        sum
    }

    /// The pixels under a parallelogram, weighted along its two sides.
    pub fn area_mean(&self, p: Vec2, axes: [PatchSide; 2]) -> [f32; 4] {
        let sides = Mat2::from_cols(axes[0].side, axes[1].side);
        let determinant = sides.determinant();
        // Two collinear sides: treated as a square with the longer one's length.
        let to_sides = if determinant.abs() > 1e-3 {
            sides.inverse()
        } else {
            Mat2::from_diagonal(Vec2::splat(1.0 / axes[0].side.length().max(axes[1].side.length())))
        };
        let reach = axes[0].side.abs() * axes[0].reach + axes[1].side.abs() * axes[1].reach;
        let (low, high) = ((p - reach - 0.5).ceil(), (p + reach - 0.5).floor());
        // Of a thousand or more pixels some are enough.
        let step = ((reach.max_element() / MOST_READ_ALONG) as usize).max(1);
        let (mut sum, mut total) = ([0.0; 4], 0.0);
        for y in (low.y as i32..=high.y as i32).step_by(step) {
            for x in (low.x as i32..=high.x as i32).step_by(step) {
                let t = to_sides * (vec2(x as f32 + 0.5, y as f32 + 0.5) - p);
                let weight = axes[0].weight(t.x) * axes[1].weight(t.y);
                if weight != 0.0 {
                    total += weight;
                    let texel = self.pixel(x, y);
                    (0..4).for_each(|c| sum[c] += weight * texel[c]);
                }
            }
        }
        if total > 0.0 { sum.map(|v| v / total) } else { [0.0; 4] }
    }
}

/// One side of the piece of the source that a pixel shows, and its weights along it.
#[derive(Clone, Copy)]
pub(super) struct PatchSide {
    /// Source px; at least one long.
    pub side: Vec2,
    pub reduces: bool,
    filter: Resampling,
    /// How far weights extend, in sides.
    reach: f32,
    /// Half the tent of a source pixel, in sides.
    tent: f32,
}

impl PatchSide {
    pub fn of(side: Vec2, filter: Resampling) -> Self {
        let length = side.length().min(WIDEST_PX);
        let direction = side.normalize_or(Vec2::X);
        let reduces = length > LONGEST_KEPT_PX;
        let (length, reach) = if reduces { (length, 0.5 + 1.0 / length) } else { (1.0, 2.0) };
        Self { side: direction * length, reduces, filter, reach, tent: 1.0 / length }
    }

    fn weight(&self, t: f32) -> f32 {
        if self.reduces { share(t, self.tent) } else { cubic_weight(t, self.filter) }
    }
}

/// The share of a tent of half-width `tent` about `t` that lies in `[−½, ½]`.
fn share(t: f32, tent: f32) -> f32 {
    let below = |edge: f32| {
        let x = ((edge - t) / tent).max(-1.0).min(1.0);
        if x < 0.0 { 0.5 * (x + 1.0) * (x + 1.0) } else { 1.0 - 0.5 * (1.0 - x) * (1.0 - x) }
    };
    below(0.5) - below(-0.5)
}

/// B and C of Mitchell and Netravali 1988.
#[inline(always)]
pub(super) fn cubic_of(filter: Resampling) -> (f32, f32) {
    if filter == Resampling::Sharp { (0.0, 0.5) } else { (1.0 / 3.0, 1.0 / 3.0) }
}

/// The weight of a pixel `d` px away.
fn cubic_weight(d: f32, filter: Resampling) -> f32 {
    let (d, (b, c)) = (d.abs(), cubic_of(filter));
    if d < 1.0 {
        ((12.0 - 9.0 * b - 6.0 * c) * d * d * d
            + (-18.0 + 12.0 * b + 6.0 * c) * d * d
            + (6.0 - 2.0 * b))
            / 6.0
    } else if d < 2.0 {
        ((-b - 6.0 * c) * d * d * d
            + (6.0 * b + 30.0 * c) * d * d
            + (-12.0 * b - 48.0 * c) * d
            + (8.0 * b + 24.0 * c))
            / 6.0
    } else {
        0.0
    }
}
