//! The steps between neighboring pixels that normals give: computed pixel by pixel, never stored.
//! Floor 2.

use crate::math::{Vec3, vec2};
use crate::raster::Plane;

/// Unit normals (camera space, y up) over the pixels where `inside` holds.
pub struct Slopes<'a> {
    /// The normals, y up.
    pub normals: &'a Plane<Vec3>,
    /// Where they count.
    pub inside: &'a Plane<bool>,
}

/// Slopes beyond 20 px a px are noise at the rim.
const STEEPEST: f32 = 0.05;

impl Slopes<'_> {
    /// Weight and height of the step from a pixel to the one at its right (axis 0) or below (1);
    /// nothing where there is none.
    #[inline(always)]
    pub fn edge(&self, (x, y): (usize, usize), axis: usize) -> (f32, f32) {
        let b = if axis == 0 { (x + 1, y) } else { (x, y + 1) };
        if b.0 >= self.inside.width() || b.1 >= self.inside.height() {
            return (0.0, 0.0);
        }
        if !self.inside.at(x, y) || !self.inside.at(b.0, b.1) {
            return (0.0, 0.0);
        }
        let (na, nb) = (self.normals.at(x, y), self.normals.at(b.0, b.1));
        let along = vec2(na.x + nb.x, -na.y - nb.y)[axis];
        let facing = (na.z + nb.z) * 0.5;
        let weight = facing.max(STEEPEST).powi(2);
        (weight, along * 0.5 / facing.max(STEEPEST))
    }

    /// The right-hand side of the normal equations: what flows out of a pixel.
    pub fn source(&self, x: usize, y: usize) -> f32 {
        let flow = |(weight, slope): (f32, f32)| weight * slope;
        let mut b = 0.0;
        b -= flow(self.edge((x, y), 0)) + flow(self.edge((x, y), 1));
        if x > 0 {
            b += flow(self.edge((x - 1, y), 0));
        }
        if y > 0 {
            b += flow(self.edge((x, y - 1), 1));
        }
        b
    }
}
