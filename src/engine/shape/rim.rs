//! The condition on a height field at the rim of an outline: held at 0 between pixels, or free
//! where it is joined. Floor 3. It makes the equations that `solver` solves.

use super::Outline;
use super::solver::Solver;
use crate::math::{Rect, Vec2, vec2};
use crate::raster::Plane;

/// The four neighbors of a pixel.
const STEPS: [(i32, i32); 4] = [(1, 0), (-1, 0), (0, 1), (0, -1)];

/// An outline, and which pieces of its rim hold a field at 0.
pub struct OutlineRim<'a> {
    outline: &'a Outline,
    /// Outside pixels toward which the rim is free.
    joined: Option<&'a Plane<bool>>,
}

/// −∇²v + s v = b over an outline, ready to be solved for several b.
pub struct Equation {
    solver: Solver,
}

impl<'a> OutlineRim<'a> {
    /// A silhouette all around: the field is 0 there.
    pub fn silhouette(outline: &'a Outline) -> Self {
        Self { outline, joined: None }
    }

    /// A silhouette except toward the pixels of `joined`, a plane as large as the outline's: there
    /// the link is left out (Neumann), so that the field joins its neighbor level. A plane of
    /// another size joins nothing.
    pub fn with_joined_pixels(outline: &'a Outline, joined: &'a Plane<bool>) -> Self {
        Self { outline, joined: (joined.size() == outline.size()).then_some(joined) }
    }

    /// A silhouette, or one that is joined in part.
    pub fn of(outline: &'a Outline, joined: Option<&'a Plane<bool>>) -> Self {
        joined.map_or_else(
            || Self::silhouette(outline),
            |joined| Self::with_joined_pixels(outline, joined),
        )
    }

    fn is_free(&self, x: i32, y: i32) -> bool {
        self.joined.is_some_and(|joined| joined.get(x, y).unwrap_or(false))
    }

    /// The rim from an inside pixel toward a neighbor: none if that is inside too or joined, else
    /// θ.
    fn side_toward(&self, (x, y): (usize, usize), step: (i32, i32)) -> Side {
        let other = (x as i32 + step.0, y as i32 + step.1);
        if self.outline.inside_pixels().get(other.0, other.1).unwrap_or(false) {
            Side::Inside
        } else if self.is_free(other.0, other.1) {
            Side::Free
        } else {
            Side::Rim(self.outline.crossing((x, y), step))
        }
    }

    /// The couplings of −∇²v + s v: 1 between inside pixels, 1/θ toward the rim (Gibou et al. 2002,
    /// symmetric), and `s`, px⁻², `≥ 0`.
    pub fn equation(&self, screen: impl Fn(usize, usize) -> f32 + Sync) -> Equation {
        let (inside, size) = (self.outline.inside_pixels(), self.outline.size());
        let held = Plane::from_fn(size, |x, y| self.rim_coupling((x, y), &screen));
        Equation { solver: Solver::new(inside, held) }
    }

    /// The coupling of a pixel toward 0.
    fn rim_coupling(&self, (x, y): (usize, usize), screen: &impl Fn(usize, usize) -> f32) -> f32 {
        let inside = self.outline.inside_pixels();
        if !inside.at(x, y) {
            return 0.0;
        }
        // A piece that is free all around would rise without limit: it is held weakly, with the
        // plane's length as its reach.
        let faint = if self.joined.is_some() { inside.size().longer_side().powi(-2) } else { 0.0 };
        let sides = STEPS.map(|step| match self.side_toward((x, y), step) {
            Side::Rim(theta) => 1.0 / theta,
            Side::Inside | Side::Free => 0.0,
        });
        sides.iter().sum::<f32>() + screen(x, y) + faint
    }

    /// The slope of a field at an inside pixel, image axes, a px: central differences, of unequal
    /// steps at the rim, where the field is 0.
    #[inline(always)]
    pub fn slope(&self, field: &Plane<f32>, x: usize, y: usize) -> Vec2 {
        let inside = self.outline.inside_pixels();
        // Inside pixels are a margin away from the border.
        if inside.at(x - 1, y) && inside.at(x + 1, y) && inside.at(x, y - 1) && inside.at(x, y + 1)
        {
            let across = field.at(x + 1, y) - field.at(x - 1, y);
            return vec2(across, field.at(x, y + 1) - field.at(x, y - 1)) * 0.5;
        }
        let here = field.at(x, y);
        let along = |step: (i32, i32)| {
            let side = |sign: i32| {
                let step = (sign * step.0, sign * step.1);
                match self.side_toward((x, y), step) {
                    Side::Inside => {
                        (1.0, field.at((x as i32 + step.0) as usize, (y as i32 + step.1) as usize))
                    }
                    Side::Free => (1.0, here),
                    Side::Rim(theta) => (theta, 0.0),
                }
            };
            let ((a, ahead), (b, behind)) = (side(1), side(-1));
            (b * b * (ahead - here) + a * a * (here - behind)) / (a * b * (a + b))
        };
        vec2(along((1, 0)), along((0, 1)))
    }
}

/// What lies next to an inside pixel.
enum Side {
    Inside,
    Free,
    /// The rim, at this fraction of a px.
    Rim(f32),
}

impl Equation {
    /// With another `s` at some pixels.
    pub fn hold(
        &mut self,
        rim: &OutlineRim,
        pixels: &[(usize, usize)],
        screen: impl Fn(usize, usize) -> f32,
    ) {
        self.solver.hold(pixels, |x, y| rim.rim_coupling((x, y), &screen));
    }

    /// A field of the right-hand side's size that is nearly right, nearer to the solution
    /// ([`Solver::approach`]).
    pub fn approach(&self, b: &Plane<f32>, start: Plane<f32>, near: Rect) -> Plane<f32> {
        let found = self.solver.approach(b.values(), start.into_values(), near);
        Plane::from_values(b.size(), found).unwrap_or_else(|| Plane::full(b.size(), 0.0))
    }

    /// The field for a right-hand side, row by row; `start`: the field that the search begins at,
    /// nearly right.
    pub fn solve(&self, b: &Plane<f32>, start: Option<&Plane<f32>>, goal: f64) -> Plane<f32> {
        let start =
            start.filter(|start| start.size() == b.size()).map(|start| start.values().to_vec());
        let found = self.solver.solve(b.values(), start, goal);
        Plane::from_values(b.size(), found).unwrap_or_else(|| Plane::full(b.size(), 0.0))
    }
}
