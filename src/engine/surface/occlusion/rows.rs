//! Occlusion of a whole map, many pixels of a row at a time: all read at the same offset, so that every read is a plain
//! load. Floor 2. The equations are in `super`.

use super::{FLOATS, HorizonDirection, HorizonSlices, excess, height_between, open_part, slope, tangents};
use crate::math::{Vec2, fast};
use crate::raster::Plane;
use crate::surface::{Surface, links};
use rayon::prelude::*;

/// Pixels computed side by side.
const LANES: usize = 64;
type Lanes = [f32; LANES];

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
        values[margin * stride..].par_chunks_mut(stride).enumerate().take(h).for_each(|(y, row)| {
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
    let mut open = Plane::filled(size, 1.0f32);
    open.values_mut().par_chunks_mut(size.width.max(1) as usize).enumerate().for_each(|(y, row)| {
        for (i, out) in row.chunks_mut(LANES).enumerate() {
            let x0 = i * LANES;
            if surface.coverage_plane().row(y)[x0..x0 + out.len()].iter().all(|&c| c == 0) {
                continue;
            }
            let mut found = [0.0; LANES];
            open_lanes(&heights, (x0, y), &LaneSlopes::of(surface, x0, y, out.len()), ways, &mut found);
            for (x, (out, &found)) in out.iter_mut().zip(&found).enumerate() {
                if surface.coverage(x0 + x, y) > 0 {
                    *out = found;
                }
            }
        }
    });
    open
}

/// The open part averaged over five pixels each way, never across a depth jump: the remaining artefacts of depth steps
/// and few directions are finer than that.
pub(super) fn smoothed(surface: &Surface, open: &Plane<f32>) -> Plane<f32> {
    let across = along_links(surface, open, (links::LEFT, links::RIGHT), (1, 0));
    along_links(surface, &across, (links::UP, links::DOWN), (0, 1))
}

/// Binomial weights 1 4 6 4 1 along a row or a column, as far as the links reach.
fn along_links(surface: &Surface, open: &Plane<f32>, (back, forth): (u8, u8), step: (usize, usize)) -> Plane<f32> {
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

/// How the surface stands at each pixel, image axes.
struct LaneSlopes {
    slope: [Lanes; 2],
    nbar: [Lanes; 2],
    nz: Lanes,
}

impl LaneSlopes {
    fn of(surface: &Surface, x0: usize, y: usize, width: usize) -> Self {
        let mut facing = Self { slope: [[0.0; LANES]; 2], nbar: [[0.0; LANES]; 2], nz: [1.0; LANES] };
        for i in 0..width {
            let (slope, nbar) = (slope(surface, x0 + i, y), surface.nbar(x0 + i, y));
            (facing.slope[0][i], facing.slope[1][i]) = (slope.x, slope.y);
            (facing.nbar[0][i], facing.nbar[1][i]) = (nbar.x, nbar.y);
            facing.nz[i] = surface.normal(x0 + i, y).z.max(0.0);
        }
        facing
    }
}

crate::widest! {
    /// The open part of the hemisphere over each pixel.
    fn open_lanes(heights: &Heights, at: (usize, usize), facing: &LaneSlopes, ways: &HorizonSlices, out: &mut Lanes) {
        let (mut open, mut whole) = ([0.0; LANES], [0.0; LANES]);
        for slice in &ways.slices {
            let toward = slice[0].toward;
            let (mut tangent, mut hidden) = ([[0.0; LANES]; 2], [[0.0; LANES]; 2]);
            let [ahead, behind] = &mut tangent;
            for (i, (ahead, behind)) in ahead.iter_mut().zip(behind).enumerate() {
                let along = along(&facing.slope, toward, i);
                let told = tangents(along, self::along(&facing.nbar, toward, i), facing.nz[i]);
                (*ahead, *behind) = (told[0], told[1]);
            }
            for side in 0..2 {
                march(heights, at, &slice[side], ways.radius_px, &tangent[side], &mut hidden[side]);
            }
            for i in 0..LANES {
                let along = -along(&facing.slope, toward, i);
                let free = [tangent[0][i], tangent[1][i]];
                whole[i] += open_part(along, 1.0, free);
                open[i] += open_part(along, 1.0, [free[0] + hidden[0][i], free[1] + hidden[1][i]]);
            }
        }
        for i in 0..LANES {
            out[i] = fast::min(fast::max(open[i] / fast::max(whole[i], 1e-6), 0.0), 1.0);
        }
    }
}

#[inline(always)]
fn along(vector: &[Lanes; 2], toward: Vec2, i: usize) -> f32 {
    vector[0][i] * toward.x + vector[1][i] * toward.y
}

/// How far the highest horizon along a way stands above the tangent plane's, in cosines.
#[inline(always)]
fn march(
    heights: &Heights,
    (x, y): (usize, usize),
    way: &HorizonDirection,
    radius_px: f32,
    tangent: &Lanes,
    hidden: &mut Lanes,
) {
    let here = heights.lanes(x, y, (0, 0));
    let (per_radius_2, per_cliff) = (1.0 / (radius_px * radius_px), 1.0 / (FLOATS * radius_px));
    let (mut before, mut cliffs) = ([0.0; LANES], [0.0; LANES]);
    for step in &way.steps {
        let (near, far) = (heights.lanes(x, y, step.near), heights.lanes(x, y, step.far));
        let distance_2 = step.distance_px * step.distance_px;
        for i in 0..LANES {
            let rise = height_between(near[i], far[i], step.between) - here[i];
            cliffs[i] += fast::max(rise - before[i] - step.cliff_px, 0.0);
            before[i] = rise;
            let space_2 = distance_2 + rise * rise;
            let above = rise / space_2.sqrt() - tangent[i];
            fast::raise(&mut hidden[i], excess(above, space_2 * per_radius_2, cliffs[i], per_cliff));
        }
    }
}
