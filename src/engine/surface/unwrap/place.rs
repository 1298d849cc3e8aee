//! Points of an unwrapped surface between pixels, and beyond its edge.
//! Floor 2.

use super::Unwrapping;
use crate::math::{Mat2, Vec2, vec2};
use crate::surface::Surface;
use crate::surface::differentiate::DifferencePairs;

/// Where a canvas point lies in the plane of the piece of surface under it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanePlace {
    /// The number of its object: see [`crate::surface::Objects::labels`].
    pub object: u32,
    /// D(q), canvas px.
    pub at: Vec2,
    /// R(q): how the plane lies turned against the picture there.
    pub turn: Mat2,
}

impl Unwrapping {
    /// Where a point lies; off the surface the plane of the nearest piece goes on flat, so that strokes cross the
    /// silhouette evenly.
    pub fn place(&self, surface: &Surface, q: Vec2) -> PlanePlace {
        let (x, y) = nearest_covered(surface, q);
        let jacobian = self.jacobian(surface, x, y);
        // The rotation in J: of J = R S, S symmetric, it is R itself.
        let turn = super::metric::turn(jacobian, Mat2::IDENTITY);
        let from = q - (vec2(x as f32, y as f32) + 0.5);
        let is_on = from.abs().max_element() <= 0.5;
        let at = self.at(x, y) + if is_on { jacobian * from } else { turn * from };
        PlanePlace { object: surface.objects().labels().at(x, y), at, turn }
    }
    /// ∂D/∂q at a pixel, differenced within its piece; where a pixel has no neighbour along an axis, 1.
    pub fn jacobian(&self, surface: &Surface, x: usize, y: usize) -> Mat2 {
        let near = DifferencePairs::linked(surface, x, y);
        let rows = [near.slope(|x, y| self.at(x, y).x), near.slope(|x, y| self.at(x, y).y)];
        let mut jacobian = Mat2::from_cols(rows[0], rows[1]).transpose();
        if jacobian.x_axis == Vec2::ZERO {
            jacobian.x_axis = Vec2::X;
        }
        if jacobian.y_axis == Vec2::ZERO {
            jacobian.y_axis = Vec2::Y;
        }
        jacobian
    }
}

/// The pixel that holds a point, or the nearest on the surface: searched in growing squares around it.
pub(super) fn nearest_covered(surface: &Surface, q: Vec2) -> (usize, usize) {
    let coverage = surface.coverage_plane();
    let held = surface.pixel_of(q);
    if coverage.at(held.0, held.1) > 0 || !q.is_finite() {
        return held;
    }
    let (x, y) = (held.0 as i32, held.1 as i32);
    let mut best: Option<(f32, (usize, usize))> = None;
    for r in 1..coverage.width().max(coverage.height()) as i32 {
        if best.is_some_and(|(distance, _)| distance <= r as f32 - 1.0) {
            break;
        }
        let sides = (-r..=r).flat_map(|k| [(k, -r), (k, r), (-r, k), (r, k)]);
        for (x, y) in sides.map(|(dx, dy)| (x + dx, y + dy)) {
            if coverage.get(x, y).is_some_and(|c| c > 0) {
                let distance = vec2(x as f32 + 0.5, y as f32 + 0.5).distance(q);
                if best.is_none_or(|(least, _)| distance < least) {
                    best = Some((distance, (x as usize, y as usize)));
                }
            }
        }
    }
    best.map_or(held, |(_, at)| at)
}
