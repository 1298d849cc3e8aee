//! Occlusion of a whole map, many pixels of a row at a time: all read at the same offset, so that
//! every read is a plain load. Floor 2. The equations are in `super`.

use super::{
    FLOATS, HorizonDirection, HorizonSlices, excess, height_between, open_part, slope, tangents,
};
use crate::math::{Vec2, fast, parallel};
use crate::raster::Plane;
use crate::surface::{Surface, links};

/// Pixels computed side by side.
const LANES: usize = 64;
type Lanes = [f32; LANES];
/// Of them, pixels that are looked at together.
const TOGETHER: usize = 16;

/// Height where there is no surface, px: so low that the step back up is a cliff.
const NOWHERE: f32 = -1e6;

/// Heights toward the viewer, px, with a margin on all sides that no read leaves.
struct Heights {
    values: Vec<f32>,
    stride: usize,
    margin: usize,
}

impl Heights {
    fn of(surface: &Surface, ways: &HorizonSlices) -> Self {
        let (w, h) = (surface.size().width as usize, surface.size().height as usize);
        let margin = ways.reach() as usize;
        let stride = w.next_multiple_of(LANES) + 2 * margin;
        let mut values = vec![NOWHERE; stride * (h + 2 * margin)];
        let rows = &mut values[margin * stride..][..h * stride];
        parallel::for_each_row(rows, stride, 1, |y, row| {
            for (x, v) in row[margin..margin + w].iter_mut().enumerate() {
                if surface.coverage(x, y) > 0 {
                    *v = -surface.depth(x, y) * surface.depth_range_px();
                }
            }
        });
        Self { values, stride, margin }
    }

    /// The heights of the pixels from (x, y) on, moved by an offset.
    #[inline(always)]
    fn lanes(&self, x: usize, y: usize, (dx, dy): (i32, i32)) -> &[f32] {
        let row = (y + self.margin) as i32 + dy;
        let column = (x + self.margin) as i32 + dx;
        &self.values[row as usize * self.stride + column as usize..][..LANES]
    }
}

/// A(p) of every pixel.
pub(super) fn compute(surface: &Surface, ways: &HorizonSlices) -> Plane<f32> {
    let size = surface.size();
    let heights = Heights::of(surface, ways);
    let mut open = Plane::full(size, 1.0f32);
    parallel::for_each_row(open.values_mut(), size.width.max(1) as usize, 1, |y, row| {
        for (i, out) in row.chunks_mut(LANES).enumerate() {
            let x0 = i * LANES;
            if surface.coverage_plane().row(y)[x0..x0 + out.len()].iter().all(|&c| c == 0) {
                continue;
            }
            let mut found = [0.0; LANES];
            open_lanes(
                &heights,
                (x0, y),
                &LaneSlopes::of(surface, &heights, (x0, y), out.len()),
                ways,
                &mut found,
            );
            for (x, (out, &found)) in out.iter_mut().zip(&found).enumerate() {
                if surface.coverage(x0 + x, y) > 0 {
                    *out = found;
                }
            }
        }
    });
    open
}

/// The open part averaged over five pixels each way, never across a depth jump: the remaining
/// artifacts of depth steps and few directions are finer than that.
pub(super) fn smooth(surface: &Surface, open: &Plane<f32>) -> Plane<f32> {
    let across = smooth_along_links(surface, open, (links::LEFT, links::RIGHT), (1, 0));
    smooth_along_links(surface, &across, (links::UP, links::DOWN), (0, 1))
}

/// Binomial weights 1 4 6 4 1 along a row or a column, as far as the links reach.
fn smooth_along_links(
    surface: &Surface,
    open: &Plane<f32>,
    (back, forth): (u8, u8),
    step: (usize, usize),
) -> Plane<f32> {
    let joined = surface.links_plane();
    Plane::from_fn(open.size(), |x, y| {
        let (mut sum, mut weights) = (6.0 * open.at(x, y), 6.0);
        let mut add = |at: (usize, usize), weight: f32| {
            sum += weight * open.at(at.0, at.1);
            weights += weight;
        };
        let (mut before, mut after) = ((x, y), (x, y));
        for weight in [4.0, 1.0] {
            if joined.at(before.0, before.1) & back == 0 {
                break;
            }
            before = (before.0 - step.0, before.1 - step.1);
            add(before, weight);
        }
        for weight in [4.0, 1.0] {
            if joined.at(after.0, after.1) & forth == 0 {
                break;
            }
            after = (after.0 + step.0, after.1 + step.1);
            add(after, weight);
        }
        sum / weights
    })
}

/// How the surface is inclined at each pixel, image axes.
struct LaneSlopes {
    slope: [Lanes; 2],
    nbar: [Lanes; 2],
    nz: Lanes,
}

impl LaneSlopes {
    fn of(surface: &Surface, heights: &Heights, (x0, y): (usize, usize), width: usize) -> Self {
        let mut facing =
            Self { slope: [[0.0; LANES]; 2], nbar: [[0.0; LANES]; 2], nz: [1.0; LANES] };
        let [nbar_x, nbar_y, nz] =
            surface.normal_planes().map(|plane| &plane.row(y)[x0..x0 + width]);
        facing.nbar[0][..width].copy_from_slice(nbar_x);
        facing.nbar[1][..width].copy_from_slice(nbar_y);
        facing.nz.iter_mut().zip(nz).for_each(|(out, z)| *out = z.max(0.0));
        if is_whole(surface, (x0, y), width) {
            let row = |dy: i32| [-1, 0, 1].map(|dx| heights.lanes(x0, y, (dx, dy)));
            slopes_of_whole([row(-1), row(0), row(1)], &mut facing.slope);
            return facing;
        }
        for i in 0..width {
            (facing.slope[0][i], facing.slope[1][i]) = slope(surface, x0 + i, y).into();
        }
        facing
    }
}

/// Whether all pixels from (x, y) on, and those around them, are linked.
fn is_whole(surface: &Surface, (x, y): (usize, usize), width: usize) -> bool {
    const INSIDE: u8 = links::LEFT | links::RIGHT | links::UP | links::DOWN;
    let size = surface.size();
    let is_inside =
        x > 0 && y > 0 && x + width < size.width as usize && y + 1 < size.height as usize;
    let row = |y: usize| &surface.links_plane().row(y)[x - 1..x + width + 1];
    is_inside
        && [y - 1, y, y + 1]
            .iter()
            .all(|&y| row(y).iter().fold(u8::MAX, |all, bits| all & bits) & INSIDE == INSIDE)
}

crate::widest! {
    /// [`slope`] where all pixels around are linked, to the same bits.
    ///
    /// `rows`: the heights above, here and below, each one px to the left, there and one to the
    /// right.
    fn slopes_of_whole(rows: [[&[f32]; 3]; 3], out: &mut [Lanes; 2]) {
        let [[a, b, c], [d, e, f], [g, h, k]] = rows.map(|row| row.map(|lanes| &lanes[..LANES]));
        for i in 0..LANES {
            // In the order of `slope`, which adds up in rows and in columns.
            let across = (e[i] - d[i]) + (f[i] - e[i]) + (b[i] - a[i]) + (c[i] - b[i]) + (h[i] - g[i]) + (k[i] - h[i]);
            let along = (e[i] - b[i]) + (h[i] - e[i]) + (d[i] - a[i]) + (g[i] - d[i]) + (f[i] - c[i]) + (k[i] - f[i]);
            (out[0][i], out[1][i]) = (across / 6.0, along / 6.0);
        }
    }

    /// The open part of the hemisphere over each pixel.
    fn open_lanes(heights: &Heights, at: (usize, usize), facing: &LaneSlopes, ways: &HorizonSlices, out: &mut Lanes) {
        let (mut open, mut whole, mut part) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        for slice in &ways.slices {
            let toward = slice[0].toward;
            let (mut tangent, mut hidden) = ([[0.0; LANES]; 2], [[0.0; LANES]; 2]);
            let [ahead, behind] = &mut tangent;
            for (i, (ahead, behind)) in ahead.iter_mut().zip(behind).enumerate() {
                let along = component_along(&facing.slope, toward, i);
                let both = tangents(along, self::component_along(&facing.nbar, toward, i), facing.nz[i]);
                (*ahead, *behind) = (both[0], both[1]);
            }
            let mut is_open = true;
            for side in 0..2 {
                is_open &= !march(heights, at, &slice[side], ways.radius_px, &tangent[side], &mut hidden[side]);
            }
            for i in 0..LANES {
                let along = -component_along(&facing.slope, toward, i);
                part[i] = open_part(along, 1.0, [tangent[0][i], tangent[1][i]]);
                whole[i] += part[i];
            }
            if is_open {
                open.iter_mut().zip(&part).for_each(|(open, part)| *open += part);
                continue;
            }
            for i in 0..LANES {
                let along = -component_along(&facing.slope, toward, i);
                open[i] += open_part(along, 1.0, [tangent[0][i] + hidden[0][i], tangent[1][i] + hidden[1][i]]);
            }
        }
        for i in 0..LANES {
            out[i] = fast::min(fast::max(open[i] / fast::max(whole[i], 1e-6), 0.0), 1.0);
        }
    }
}

#[inline(always)]
fn component_along(vector: &[Lanes; 2], toward: Vec2, i: usize) -> f32 {
    vector[0][i] * toward.x + vector[1][i] * toward.y
}

/// How far the highest horizon along a way is above the tangent plane's, in cosines; whether it may
/// do so anywhere.
///
/// Most places lie below the tangent plane, which their rise shows without a root or a division.
/// Only where that of one of a few neighbors does not, they are looked at.
#[inline(always)]
fn march(
    heights: &Heights,
    (x, y): (usize, usize),
    way: &HorizonDirection,
    radius_px: f32,
    tangent: &Lanes,
    hidden: &mut Lanes,
) -> bool {
    let here = heights.lanes(x, y, (0, 0));
    let (per_radius_2, per_cliff) = (1.0 / (radius_px * radius_px), 1.0 / (FLOATS * radius_px));
    let (mut rise, mut cliffs) = ([0.0; LANES], [0.0; LANES]);
    let (mut steep, mut over) = ([0.0; LANES], [0u32; LANES]);
    for i in 0..LANES {
        steep[i] = steepness(tangent[i]);
    }
    let mut is_hidden = false;
    for step in &way.steps {
        let (near, far) = (heights.lanes(x, y, step.near), heights.lanes(x, y, step.far));
        for i in 0..LANES {
            let before = rise[i];
            rise[i] = height_between(near[i], far[i], step.between) - here[i];
            cliffs[i] += fast::max(rise[i] - before - step.cliff_px, 0.0);
            // NaN is looked at.
            over[i] = if rise[i] <= step.distance_px * steep[i] { 0 } else { 1 };
        }
        let distance_2 = step.distance_px * step.distance_px;
        for start in (0..LANES).step_by(TOGETHER) {
            let lanes = start..start + TOGETHER;
            if over[lanes.clone()].iter().fold(0, |any, over| any | over) == 0 {
                continue;
            }
            is_hidden = true;
            let (rise, tangent, cliffs) =
                (&rise[lanes.clone()], &tangent[lanes.clone()], &cliffs[lanes.clone()]);
            let hidden = &mut hidden[lanes];
            for i in 0..TOGETHER {
                let space_2 = distance_2 + rise[i] * rise[i];
                let above = rise[i] / space_2.sqrt() - tangent[i];
                fast::raise(
                    &mut hidden[i],
                    excess(above, space_2 * per_radius_2, cliffs[i], per_cliff),
                );
            }
        }
    }
    is_hidden
}

/// The rise a px, or a little less, that a cosine to the view means.
#[inline(always)]
pub(super) fn steepness(cosine: f32) -> f32 {
    /// More than the error of rounding. Nothing is taken from level ground: there both are exactly
    /// 0.
    const LESS: f32 = 1e-5;
    let cosine = cosine - LESS * cosine.abs();
    cosine / fast::max(1.0 - cosine * cosine, 0.0).sqrt()
}

/// The slopes of some pixels of a row.
#[cfg(test)]
pub(super) fn slopes(
    surface: &Surface,
    ways: &HorizonSlices,
    at: (usize, usize),
    width: usize,
) -> Vec<Vec2> {
    let [x, y] = LaneSlopes::of(surface, &Heights::of(surface, ways), at, width).slope;
    x.into_iter().zip(y).take(width).map(Vec2::from).collect()
}
