//! Ambient occlusion: how much of the hemisphere over each point the surface itself leaves open (RS
//! sec. 5.3.1's A(p)). Floor 2. It is computed from depth, in pixels. Here: the horizon equations
//! and the cache; `rows` is the fast way over a map.
//!
//! Along directions all around each pixel the highest horizon is found, and the cosine-weighted
//! light above it is integrated in closed form (Jiménez et al. 2016, "Practical realtime strategies
//! for accurate indirect occlusion"). Every pixel looks along the same directions at the same
//! distances: there is no noise, and the result does not depend on threads.

mod rows;

#[cfg(test)]
mod tests;

use super::{Surface, links};
use crate::math::{Vec2, fast, vec2};
use crate::raster::Plane;
use std::f32::consts::PI;
use std::sync::Arc;

/// Directions, in pairs of opposite ones.
const SLICES: usize = 10;
/// From one distance to the next, as a ratio of it, once it is more than a pixel.
const STRIDE: f32 = 0.16;
/// Cosine above the tangent plane below which an occluder counts less: depth is not that fine.
const UNSURE: f32 = 0.03;
/// Slope from which a rise is a cliff, px per px; and the tolerance for coarse depth, px.
pub(super) const CLIFF: (f32, f32) = (4.0, 1.5);
/// A cliff of this share of the radius hides nothing: such an object floats in front.
const FLOATS: f32 = 0.5;

/// Where a pixel looks for occluders.
struct HorizonSlices {
    slices: Vec<[HorizonDirection; 2]>,
    radius_px: f32,
}

/// One direction, image axes (y down).
struct HorizonDirection {
    toward: Vec2,
    steps: Vec<HorizonStep>,
}

/// A place along the way, between two neighboring pixels.
struct HorizonStep {
    near: (i32, i32),
    far: (i32, i32),
    /// From the one to the other.
    between: f32,
    distance_px: f32,
    /// A greater rise since the step before is a cliff.
    cliff_px: f32,
}

impl HorizonSlices {
    fn new(radius_px: f32) -> Self {
        let slice = |i: usize| {
            let (sin, cos) = (i as f32 / SLICES as f32 * PI).sin_cos();
            // Neighboring directions look at different distances, so that an edge casts no echo.
            let phase = (i as f32 * 0.618_034).fract();
            [
                way(vec2(cos, sin), radius_px, phase),
                way(vec2(-cos, -sin), radius_px, (phase + 0.5).fract()),
            ]
        };
        Self { slices: (0..SLICES).map(slice).collect(), radius_px }
    }

    /// The largest distance that is read, px.
    fn reach(&self) -> i32 {
        self.radius_px.ceil() as i32 + 1
    }
}

/// Steps by whole pixels along the nearer axis and interpolates between two pixels across it:
/// jumping from pixel to pixel would pick the higher neighbor.
fn way(toward: Vec2, radius_px: f32, phase: f32) -> HorizonDirection {
    let is_across = toward.x.abs() >= toward.y.abs();
    let (along, across) = if is_across { (toward.x, toward.y) } else { (toward.y, toward.x) };
    let pixel = |along: f32, across: f32| {
        let at = (along as i32, across as i32);
        if is_across { at } else { (at.1, at.0) }
    };
    let per_pixel = 1.0 / along.abs();
    let (mut steps, mut count, mut before) = (Vec::new(), 1.0f32, 0.0f32);
    while count * per_pixel < radius_px {
        let distance_px = count * per_pixel;
        let aside = across * distance_px;
        let main = along.signum() * count;
        let cliff_px = CLIFF.0 * (distance_px - before) + CLIFF.1;
        let (near, far) = (pixel(main, aside.floor()), pixel(main, aside.floor() + 1.0));
        steps.push(HorizonStep {
            near,
            far,
            between: aside - aside.floor(),
            distance_px,
            cliff_px,
        });
        before = distance_px;
        count = (count * (1.0 + STRIDE) + phase).floor().max(count + 1.0);
    }
    HorizonDirection { toward, steps }
}

/// The open part of one slice of the hemisphere, weighted by the cosine to the normal; 1 for a
/// plane that faces the viewer.
///
/// * `along`, `up`: the normal in the slice, along its direction and to the viewer; not both 0.
/// * `horizons`: cosines between the view and the horizon in the slice's direction and in the
///   opposite one.
#[inline(always)]
fn open_part(along: f32, up: f32, horizons: [f32; 2]) -> f32 {
    // ¼ |n| Σ (−cos(2h − γ) + cos γ + 2h sin γ), h the horizon's angle, γ the normal's.
    let length = (along * along + up * up).sqrt();
    let (sin, cos) = (along / length, up / length);
    let half = |cosine: f32, side: f32| {
        let angle = side * fast::acos(cosine);
        let sine = side * fast::max(1.0 - cosine * cosine, 0.0).sqrt();
        let doubled = (2.0 * cosine * cosine - 1.0) * cos + 2.0 * sine * cosine * sin;
        cos - doubled + 2.0 * angle * sin
    };
    0.25 * length * (half(horizons[0], 1.0) + half(horizons[1], -1.0))
}

/// The height between two neighboring pixels, `t` of the way; across a cliff, the lower one's
/// height.
#[inline(always)]
fn height_between(near: f32, far: f32, t: f32) -> f32 {
    let mixed = near + (far - near) * t;
    if (far - near).abs() > CLIFF.0 + CLIFF.1 { fast::min(near, far) } else { mixed }
}

/// How strongly an occluder counts.
///
/// * `above`: its cosine above the tangent plane's.
/// * `away`: (distance / radius)², in space.
/// * `cliffs_px`: cliffs on the way to it, added up; `per_cliff`: 1 / how many hide nothing.
#[inline(always)]
fn excess(above: f32, away: f32, cliffs_px: f32, per_cliff: f32) -> f32 {
    let above = fast::max(above, 0.0);
    let sure = fast::min(above * (1.0 / UNSURE), 1.0);
    // Whole up to half the radius, nearly.
    above * sure * fast::max(1.0 - away * away, 0.0) * fast::max(1.0 - cliffs_px * per_cliff, 0.0)
}

/// The slope of the height (toward the viewer, px a px, image axes) from the depth around a pixel,
/// never across a jump.
fn slope(surface: &Surface, x: usize, y: usize) -> Vec2 {
    let links = surface.links_plane();
    let height = |x: usize, y: usize| -surface.depth(x, y) * surface.depth_range_px();
    let here = links.at(x, y);
    // The mean of the steps next to the pixel and, where linked, next to its two neighbors across.
    let mean = |steps: &[Option<f32>]| {
        let (sum, count) =
            steps.iter().flatten().fold((0.0, 0.0), |(s, n), step| (s + step, n + 1.0));
        if count > 0.0 { sum / count } else { 0.0 }
    };
    let row = |y: usize| {
        let joined = links.at(x, y);
        let left = (joined & links::LEFT != 0).then(|| height(x, y) - height(x - 1, y));
        let right = (joined & links::RIGHT != 0).then(|| height(x + 1, y) - height(x, y));
        [left, right]
    };
    let column = |x: usize| {
        let joined = links.at(x, y);
        let up = (joined & links::UP != 0).then(|| height(x, y) - height(x, y - 1));
        let down = (joined & links::DOWN != 0).then(|| height(x, y + 1) - height(x, y));
        [up, down]
    };
    let if_joined = |bit: u8, steps: &dyn Fn() -> [Option<f32>; 2]| {
        if here & bit != 0 { steps() } else { [None; 2] }
    };
    let rows =
        [row(y), if_joined(links::UP, &|| row(y - 1)), if_joined(links::DOWN, &|| row(y + 1))];
    let columns = [
        column(x),
        if_joined(links::LEFT, &|| column(x - 1)),
        if_joined(links::RIGHT, &|| column(x + 1)),
    ];
    vec2(mean(rows.as_flattened()), mean(columns.as_flattened()))
}

impl Surface {
    /// A(p) of every pixel, `[0, 1]`: 1 where nothing hides the light, 1 off the surface.
    ///
    /// Occluders count less the farther they are, those `radius_px` away (in the picture and in
    /// depth) not at all; nor does what floats in front, beyond a depth jump of half the radius. It
    /// depends on depth alone: normal layers do not change it. For a far side it is that of the other
    /// sides' pixels nearby. Cached; call it once before going parallel.
    pub fn occlusion(&self, radius_px: f32) -> Arc<Plane<f32>> {
        const KEPT: usize = 3;
        // NaN.max is the other one.
        let radius_px = radius_px.max(1.0).min(Self::WIDEST_OCCLUSION_PX);
        // Detail combined onto the surface casts no shade.
        let base = self.base();
        base.derived.occlusions.get_or_compute(radius_px.to_bits(), KEPT, |_| {
            self.on_either_side(
                || {
                    let open = rows::compute(base, &HorizonSlices::new(radius_px));
                    rows::smooth(base, &open)
                },
                |far, front| {
                    let open = front.map(|front| front.occlusion(radius_px));
                    let of = |x: usize, y: usize| open.as_ref().map_or(1.0, |open| open.at(x, y));
                    far.map(self.size(), |pixel| pixel.other_mean(of))
                },
            )
        })
    }
    /// The widest radius of occlusion, px.
    pub const WIDEST_OCCLUSION_PX: f32 = 1024.0;
}

/// The tangent plane's horizon on both sides of a slice, as cosines to the view: the higher of what
/// depth and normals give.
#[inline(always)]
fn tangents(along_slope: f32, along_normal: f32, up_normal: f32) -> [f32; 2] {
    let from_depth = along_slope / (1.0 + along_slope * along_slope).sqrt();
    let length = fast::max((along_normal * along_normal + up_normal * up_normal).sqrt(), 1e-6);
    let from_normal = -along_normal / length;
    [fast::max(from_depth, from_normal), fast::max(-from_depth, -from_normal)]
}
