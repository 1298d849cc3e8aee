//! Derivatives of maps and normals from depth, by differences that do not cross depth jumps.
//! Floor 2. Not here: the reverse (`integrate`).

use super::{Surface, links};
use crate::math::{Vec2, Vec3, vec2, vec3};
use crate::raster::Plane;

/// Unit normals (camera space, y up) of a depth map.
///
/// * `depth`: 0 near … 1 far; not finite where there is no surface.
/// * `range_px`: how many pixels deep the range 0 … 1 is.
///
/// Zero where there is no surface. n ∝ (Z ∂z/∂x, −Z ∂z/∂y, 1), y down in the map.
pub fn normals_from_depth(depth: &Plane<f32>, range_px: f32) -> Plane<Vec3> {
    Plane::from_fn(depth.size(), |x, y| {
        let (x, y) = (x as i32, y as i32);
        let at = |dx: i32, dy: i32| depth.get(x + dx, y + dy).filter(|z| z.is_finite());
        let Some(here) = at(0, 0) else { return Vec3::ZERO };
        let slope = |dx: i32, dy: i32| {
            let before = SideSteps {
                near: at(-dx, -dy).map(|z| here - z),
                far: at(-dx, -dy).zip(at(-2 * dx, -2 * dy)).map(|(a, b)| a - b),
            };
            let after = SideSteps {
                near: at(dx, dy).map(|z| z - here),
                far: at(2 * dx, 2 * dy).zip(at(dx, dy)).map(|(a, b)| a - b),
            };
            edge_aware(before, after)
        };
        vec3(slope(1, 0) * range_px, -slope(0, 1) * range_px, 1.0).normalize_or(Vec3::Z)
    })
}

/// The step to the next pixel on one side, and the one after it.
#[derive(Clone, Copy)]
struct SideSteps {
    near: Option<f32>,
    far: Option<f32>,
}

impl SideSteps {
    /// How much the step changes further out: small where the surface goes on, large at a jump.
    fn bend(self) -> f32 {
        match (self.near, self.far) {
            (Some(near), Some(far)) => (near - far).abs(),
            (Some(near), None) => near.abs(),
            _ => f32::INFINITY,
        }
    }
}

/// The mean of both sides where they agree; the smoother side where the other is a jump; 0 where
/// there is neither.
fn edge_aware(before: SideSteps, after: SideSteps) -> f32 {
    match (before.near, after.near) {
        (Some(a), Some(b)) => {
            let (bend_a, bend_b) = (before.bend(), after.bend());
            let apart = (a - b).abs();
            // A side is a jump if it changes three times as much as the better side.
            if apart <= 3.0 * bend_a.min(bend_b) + 0.5 * a.abs().min(b.abs()) + 1e-6 {
                0.5 * (a + b)
            } else if bend_a < bend_b {
                a
            } else {
                b
            }
        }
        (Some(a), None) => a,
        (None, Some(b)) => b,
        (None, None) => 0.0,
    }
}

/// The pixels that a derivative at a pixel differences: both neighbors where they continue the
/// surface, the pixel itself in place of one that does not.
pub(super) struct DifferencePairs {
    /// Left and right, up and down.
    pairs: [[(usize, usize); 2]; 2],
    /// One over the distance of each pair; 1 where both are the pixel itself.
    per_px: [f32; 2],
}

impl DifferencePairs {
    pub fn between_links(surface: &Surface, x: usize, y: usize) -> Self {
        let bits = surface.smooth_links_plane().at(x, y);
        let side = |bit: u8| usize::from(bits & bit != 0);
        let (left, right) = (x - side(links::LEFT), x + side(links::RIGHT));
        let (up, down) = (y - side(links::UP), y + side(links::DOWN));
        let per_px = [(right - left).max(1), (down - up).max(1)].map(|d| 1.0 / d as f32);
        Self { pairs: [[(left, y), (right, y)], [(x, up), (x, down)]], per_px }
    }

    /// ∇ of a map, per px.
    pub fn slope(&self, map: impl Fn(usize, usize) -> f32) -> Vec2 {
        let along =
            |[a, b]: [(usize, usize); 2], per_px: f32| (map(b.0, b.1) - map(a.0, a.1)) * per_px;
        vec2(along(self.pairs[0], self.per_px[0]), along(self.pairs[1], self.per_px[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;

    #[test]
    fn a_sphere_gets_its_normals_back() {
        let (size, r) = (Size::new(101, 101), 45.0f32);
        let truth = |x: usize, y: usize| {
            let (dx, dy) = (x as f32 - 50.0, 50.0 - y as f32);
            let rest = r * r - dx * dx - dy * dy;
            (rest > 0.0).then(|| vec3(dx, dy, rest.sqrt()) / r)
        };
        let depth = Plane::from_fn(size, |x, y| truth(x, y).map_or(f32::NAN, |n| 1.0 - n.z));
        let normals = normals_from_depth(&depth, r);
        for y in 0..101 {
            for x in 0..101 {
                if let Some(n) = truth(x, y).filter(|n| n.z > 0.4) {
                    let angle = normals.at(x, y).dot(n).min(1.0).acos().to_degrees();
                    assert!(angle < 2.0, "{angle}° at {x}, {y}");
                }
            }
        }
        assert_eq!(normals.at(0, 0), Vec3::ZERO);
    }

    #[test]
    fn nothing_is_differenced_across_a_jump() {
        let depth =
            Plane::from_fn(Size::new(20, 9), |x, _| if x < 10 { x as f32 * 0.01 } else { 0.9 });
        let normals = normals_from_depth(&depth, 100.0);
        for x in 1..19 {
            let expected = if x < 10 { vec3(1.0, 0.0, 1.0).normalize() } else { Vec3::Z };
            assert!((normals.at(x, 4) - expected).length() < 1e-3, "{} at {x}", normals.at(x, 4));
        }
    }
}
