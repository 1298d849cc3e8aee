//! Heights that follow normals while the pointer changes these. Floor 3. Good enough to be looked
//! at for a moment; the lasting heights are those of `surface::integrate`.

use super::solver::Solver;
use crate::math::{Rect, Vec2, Vec3, vec2};
use crate::raster::Plane;
use crate::surface::integrate::{Slopes, depth_from_normals};

/// Heights of which each begins at the last ones, with the couplings of the first normals.
pub struct Following {
    solver: Solver,
    /// To the right and down.
    couplings: Plane<Vec2>,
    /// Away from the viewer, px; each piece about some depth of its own.
    heights: Vec<f32>,
}

impl Following {
    /// Begins at normals (unit, camera space, y up) over the pixels where `inside` holds, a margin
    /// away from the border; `None` where there are none.
    pub fn of(normals: &Plane<Vec3>, inside: &Plane<bool>) -> Option<Self> {
        let found = depth_from_normals(normals, inside)?;
        let slopes = Slopes { normals, inside };
        let couplings = Plane::from_fn(inside.size(), |x, y| {
            vec2(slopes.edge((x, y), 0).0, slopes.edge((x, y), 1).0)
        });
        let solver = Solver::of_couplings(
            couplings.map(|s| s.x),
            couplings.map(|s| s.y),
            Plane::full(inside.size(), 0.0),
        );
        let heights =
            found.depth.map(|z| if z.is_finite() { z * found.range_px } else { 0.0 }).into_values();
        Some(Self { solver, couplings, heights })
    }

    /// The heights near those of other normals over the same pixels, px away from the viewer.
    pub fn go_on(&mut self, normals: &Plane<Vec3>, inside: &Plane<bool>, near: Rect) -> &[f32] {
        let slopes = Slopes { normals, inside };
        // The flow along its own couplings, from the new slopes.
        let flow = Plane::from_fn(inside.size(), |x, y| {
            let couplings = self.couplings.at(x, y);
            let along =
                |axis: usize| if couplings[axis] > 0.0 { slopes.edge((x, y), axis).1 } else { 0.0 };
            if couplings == Vec2::ZERO { Vec2::ZERO } else { couplings * vec2(along(0), along(1)) }
        });
        let source = Plane::from_fn(inside.size(), |x, y| {
            let here = flow.at(x, y);
            let left = if x > 0 { flow.at(x - 1, y).x } else { 0.0 };
            let above = if y > 0 { flow.at(x, y - 1).y } else { 0.0 };
            left + above - here.x - here.y
        });
        self.heights =
            self.solver.approach(source.values(), std::mem::take(&mut self.heights), near);
        &self.heights
    }
}
