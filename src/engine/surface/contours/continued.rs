//! Maps continued from one side of a contour: by a plane through that side's pixels of the window
//! (MATH 10). Floor 2.

use super::ContourPixel;
use super::line::{CONTINUED_WEIGHTS, NEAREST_WEIGHTS, bits};
use super::plane::LeastSquaresPlane;
use super::window::{PixelWindow, steps_of};
use crate::math::{Vec2, vec2};

/// Slopes are drawn toward 0 by this weight: few pixels, or a row of them, give none.
const RIDGE: f32 = 1e-2;
/// Fewer pixels give their mean.
const LEAST_FOR_A_PLANE: u32 = 6;
/// The longest n̄ that a plane may give.
const RIM_NBAR: f32 = 0.999;

/// What a side reads at a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Continued {
    nbar: [LeastSquaresPlane; 2],
    depth: LeastSquaresPlane,
}

impl Continued {
    /// From the pixels of a window; `None` without any.
    pub fn from(window: &PixelWindow, members: u64) -> Option<Self> {
        let ridge = if members.count_ones() < LEAST_FOR_A_PLANE { f32::MAX } else { RIDGE };
        let [x, y, depth] = LeastSquaresPlane::of_each(bits(members), ridge, |i| {
            let nbar = window.nbar(i);
            (CONTINUED_WEIGHTS.at(i), [nbar.x, nbar.y, window.depth(i)])
        })?;
        Some(Self { nbar: [x, y], depth })
    }

    /// n̄ at a distance from the pixel's center, px, shortened to the disc where it leaves it.
    pub fn nbar(&self, from_center: Vec2) -> Vec2 {
        let [x, y] = self.nbar.map(|fit| fit.here + fit.slope.dot(from_center));
        shorten_to_rim(vec2(x, y))
    }

    /// z at a distance from the pixel's center, `[0, 1]`.
    pub fn depth(&self, from_center: Vec2) -> f32 {
        (self.depth.here + self.depth.slope.dot(from_center)).clamp(0.0, 1.0)
    }
}

/// Any map of the canvas, continued likewise to a contour pixel's other side.
pub fn plane_of(
    pixel: &ContourPixel,
    map: impl Fn(usize, usize) -> f32,
) -> Option<LeastSquaresPlane> {
    let ridge = if pixel.others.count_ones() < LEAST_FOR_A_PLANE { f32::MAX } else { RIDGE };
    LeastSquaresPlane::fit_weighted(bits(pixel.others), ridge, |i| {
        let (dx, dy) = steps_of(i);
        (CONTINUED_WEIGHTS.at(i), map((pixel.x + dx) as usize, (pixel.y + dy) as usize))
    })
}

/// n̄ shortened to the disc where it leaves it.
pub fn shorten_to_rim(nbar: Vec2) -> Vec2 {
    let length = nbar.length();
    if length > RIM_NBAR { nbar * (RIM_NBAR / length) } else { nbar }
}

/// n_z of an n̄ within the disc.
pub fn nz_of(nbar: Vec2) -> f32 {
    (1.0 - nbar.length_squared()).max(0.0).sqrt()
}

/// The mean of a map over members of the window around a canvas pixel, the nearest counting most.
pub fn mean_of(members: u64, (x, y): (i32, i32), map: impl Fn(usize, usize) -> f32) -> f32 {
    let (mut sum, mut all) = (0.0, 0.0);
    for i in bits(members) {
        let ((dx, dy), w) = (steps_of(i), NEAREST_WEIGHTS.at(i));
        sum += w * map((x + dx) as usize, (y + dy) as usize);
        all += w;
    }
    if all > 0.0 { sum / all } else { 0.0 }
}
