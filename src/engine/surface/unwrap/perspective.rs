//! A surface that is seen from near: how far away its points are against each other, for its metric
//! (MATH 8). Floor 2. Not here: the equations (`metric`).

use super::metric;
use crate::math::{Mat2, Vec2, vec2};
use crate::surface::view::Eye;
use crate::surface::{Surface, links};

/// The eye before a surface, and how far from it the depths are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerspectiveView {
    focal_px: f32,
    /// The point before the eye, map px.
    before: Vec2,
    /// Depth z lies at Z/Z̄ = `at_zero + per_depth` z.
    at_zero: f32,
    per_depth: f32,
}

/// The nearest and the farthest that depth 0 may be found, in ranges of the depth.
const NEAREST: f64 = 0.02;
const FARTHEST: f64 = 1e4;

impl PerspectiveView {
    /// `None` for a surface that is seen from afar.
    pub fn of(surface: &Surface) -> Option<Self> {
        let Eye::At { focal_px, beside } = surface.eye() else { return None };
        let before = surface.size().center() + beside;
        let seen = Self { focal_px, before, at_zero: 1.0, per_depth: 0.0 };
        Some(seen.fitted(surface).unwrap_or(seen))
    }

    /// With the distances that agree with the normals: where Z = R (ζ + z), R the range of the
    /// depth, ∇z = (ζ + z) ∇Z/Z, and the normals give ∇Z/Z. Least squares over ζ. `None` where the
    /// depth says nothing.
    fn fitted(self, surface: &Surface) -> Option<Self> {
        let (mut product, mut squared, mut sum, mut count) = (0.0f64, 0.0f64, 0.0f64, 0u64);
        let links = surface.links_plane();
        for y in 0..links.height() {
            for x in (0..links.width())
                .filter(|&x| links.at(x, y) == links::LEFT | links::RIGHT | links::UP | links::DOWN)
            {
                let (nbar, nz, beside) =
                    (surface.nbar(x, y), surface.normal(x, y).z, self.offset_of_pixel(x, y));
                let z = surface.depth(x, y);
                (sum, count) = (sum + f64::from(z), count + 1);
                let facing = metric::facing_in_perspective(nbar, nz, beside);
                if facing < 2.0 * metric::STEEPEST_NZ {
                    continue;
                }
                let slope =
                    nbar / (facing * (1.0 + beside.length_squared()).sqrt() * self.focal_px);
                let step = 0.5
                    * vec2(
                        surface.depth(x + 1, y) - surface.depth(x - 1, y),
                        surface.depth(x, y + 1) - surface.depth(x, y - 1),
                    );
                product += f64::from((step - slope * z).dot(slope));
                squared += f64::from(slope.length_squared());
            }
        }
        let at_zero = Some(product / squared)
            .filter(|at_zero| at_zero.is_finite() && *at_zero > NEAREST)?
            .min(FARTHEST);
        let mean = at_zero + sum / count as f64;
        Some(Self { at_zero: (at_zero / mean) as f32, per_depth: (1.0 / mean) as f32, ..self })
    }

    /// b of a pixel's center: focal lengths from the point before the eye.
    #[inline(always)]
    pub fn offset_of_pixel(&self, x: usize, y: usize) -> Vec2 {
        self.offset_at(vec2(x as f32 + 0.5, y as f32 + 0.5))
    }

    /// b of a point of the map, px.
    #[inline(always)]
    pub fn offset_at(&self, q: Vec2) -> Vec2 {
        (q - self.before) / self.focal_px
    }

    /// f, px of the map.
    pub fn focal_px(&self) -> f32 {
        self.focal_px
    }

    /// Z/Z̄ at a depth.
    #[inline(always)]
    pub fn farness(&self, depth: f32) -> f32 {
        self.at_zero + self.per_depth * depth
    }
}

impl Surface {
    /// From where it is seen, if that is near: with the distances from its depth and its normals.
    pub fn perspective_view(&self) -> Option<PerspectiveView> {
        *crate::memory::once(&self.derived.perspective_view, || PerspectiveView::of(self))
    }

    /// S(q) of MATH 8 at a pixel: how long steps of the picture are on the surface, seen as it is.
    ///
    /// * `amount`: a, `[0, 2]`.
    pub fn stretch(&self, x: usize, y: usize, amount: f32) -> Mat2 {
        let (nbar, nz) = (self.nbar(x, y), self.normal(x, y).z);
        match self.perspective_view() {
            None => metric::stretch(nbar, nz, amount),
            Some(near) => metric::stretch_in_perspective(
                nbar,
                nz,
                near.offset_of_pixel(x, y),
                near.farness(self.depth(x, y)),
                amount,
            ),
        }
    }
}
