//! Surface flows: the direction and the amount by which a picture on the surface is compressed (SF
//! sec. 4.3; MATH 3). Floor 2. For viewing: no operator reads them. Not here: their colors on
//! screen (`document::view`).

use super::differentiate::DifferencePairs;
use super::{Bend, Deformation, Surface};
use crate::math::{Mat2, Size, Vec2, Vec3, vec2};
use crate::raster::{Plane, blur};

/// A structure tensor JᵀJ: symmetric, image axes (y **down**).
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct StructureTensor {
    /// Its first entry.
    pub xx: f32,
    /// Its entries off the diagonal.
    pub xy: f32,
    /// Its last entry.
    pub yy: f32,
}

/// Eigenvalues and the direction of the larger one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eigen {
    /// The larger eigenvalue.
    pub larger: f32,
    /// The smaller eigenvalue.
    pub smaller: f32,
    /// Unit, image axes (y down), sign arbitrary; x where both eigenvalues are one.
    pub direction: Vec2,
}

impl StructureTensor {
    /// T = JᵀJ of J = [∂x, ∂y].
    pub fn of_columns(dx: Vec3, dy: Vec3) -> Self {
        Self { xx: dx.dot(dx), xy: dx.dot(dy), yy: dy.dot(dy) }
    }

    /// λ₁ ≥ λ₂ and the direction of λ₁, in closed form.
    pub fn eigen(self) -> Eigen {
        let (mean, half) = (0.5 * (self.xx + self.yy), 0.5 * (self.xx - self.yy));
        let radius = half.hypot(self.xy);
        let angle = 0.5 * self.xy.atan2(half);
        Eigen {
            larger: mean + radius,
            smaller: mean - radius,
            direction: vec2(angle.cos(), angle.sin()),
        }
    }
}

/// A tensor for every pixel.
pub struct FlowField {
    tensors: Plane<StructureTensor>,
    /// The stretch on a flat surface: 1 for positions, 0 for normals, which do not change there.
    unbent: f32,
}

/// T_p = JᵀJ, J = [∂x p, ∂y p], p = (x, y, z·Z): the first-order flow (SF sec. 4.3; MATH 3).
/// Derivatives per px, z·Z in px.
pub fn position_tensor(depth_slope_px: Vec2) -> StructureTensor {
    StructureTensor::of_columns(
        Vec3::new(1.0, 0.0, depth_slope_px.x),
        Vec3::new(0.0, 1.0, depth_slope_px.y),
    )
}

/// T_n = JᵀJ, J = [∂x n, ∂y n]: the second-order flow (SF sec. 4.3; MATH 3). Derivatives per px.
pub fn normal_tensor(dx_normal: Vec3, dy_normal: Vec3) -> StructureTensor {
    StructureTensor::of_columns(dx_normal, dy_normal)
}

/// The same of a deformation: JᵀJ with J = ∂D/∂q (SF fig. 3c).
pub fn deformation_tensor(jacobian: Mat2) -> StructureTensor {
    StructureTensor::of_columns(jacobian.x_axis.extend(0.0), jacobian.y_axis.extend(0.0))
}

impl FlowField {
    /// T_p of every pixel, from the depth.
    pub fn of_depth(surface: &Surface) -> Self {
        let range_px = surface.depth_range_px();
        let tensors = Plane::from_fn(surface.size(), |x, y| {
            position_tensor(
                DifferencePairs::between_links(surface, x, y).slope(|x, y| surface.depth(x, y))
                    * range_px,
            )
        });
        Self { tensors, unbent: 1.0 }
    }

    /// T_n of every pixel, from the normals.
    pub fn of_normals(surface: &Surface) -> Self {
        let tensors = Plane::from_fn(surface.size(), |x, y| {
            let near = DifferencePairs::between_links(surface, x, y);
            let slopes = [0, 1, 2].map(|c| near.slope(|x, y| surface.normal(x, y)[c]));
            normal_tensor(Vec3::from(slopes.map(|s| s.x)), Vec3::from(slopes.map(|s| s.y)))
        });
        Self { tensors, unbent: 0.0 }
    }

    /// ∂D/∂q of every pixel.
    pub fn of_deformation(surface: Option<&Surface>, size: Size, bend: &Bend) -> Self {
        let deformation = Deformation::new(surface, size, bend);
        let tensors = Plane::from_fn(size, |x, y| {
            deformation_tensor(deformation.jacobian(x as i32, y as i32))
        });
        Self { tensors, unbent: 1.0 }
    }

    /// The flow with its tensors blurred within the covered pixels, which averages the noise of
    /// coarse maps away.
    pub fn smoothed(&self, coverage: Option<&Plane<u8>>, sigma_px: f32) -> Self {
        let covered = |i: usize| coverage.is_none_or(|c| c.values().get(i).is_some_and(|&c| c > 0));
        let weighted = |(i, t): (usize, &StructureTensor)| {
            let m = if covered(i) { 1.0 } else { 0.0 };
            [m * t.xx, m * t.xy, m * t.yy, m]
        };
        let size = self.tensors.size();
        let pixels: Vec<[f32; 4]> =
            self.tensors.values().iter().enumerate().map(weighted).collect();
        let blurred = blur::gaussian_pixels(size, &pixels, sigma_px);
        let tensors = blurred.iter().map(|&[xx, xy, yy, m]| {
            let scale = if m > 1e-3 { 1.0 / m } else { 0.0 };
            StructureTensor { xx: xx * scale, xy: xy * scale, yy: yy * scale }
        });
        let tensors = Plane::from_values(size, tensors.collect()).expect("one tensor per pixel");
        Self { tensors, unbent: self.unbent }
    }

    /// Its sides, px.
    pub fn size(&self) -> Size {
        self.tensors.size()
    }

    /// The tensor of a pixel.
    pub fn at(&self, x: usize, y: usize) -> StructureTensor {
        self.tensors.at(x, y)
    }

    /// How much a pixel's flow differs from that on a flat surface: |√λ₁ − 1|, or √λ₁ for normals.
    pub fn magnitude(&self, x: usize, y: usize) -> f32 {
        (self.at(x, y).eigen().larger.max(0.0).sqrt() - self.unbent).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;
    use crate::surface::{Anchor, Maps, Operator};

    const RADIUS_PX: f32 = 40.0;

    /// A sphere in the middle of 100 × 100 pixels; the depth reaches from its pole to its rim.
    fn sphere() -> Surface {
        let size = Size::new(100, 100);
        let normals = Plane::from_fn(size, |x, y| {
            let (x, y) = ((x as f32 - 49.5) / RADIUS_PX, (49.5 - y as f32) / RADIUS_PX);
            let z2 = 1.0 - x * x - y * y;
            if z2 > 0.0 { vec3(x, y, z2.sqrt()) } else { Vec3::ZERO }
        });
        let depth = normals.map(|n| 1.0 - n.z);
        let coverage = normals.map(|n| if n == Vec3::ZERO { 0 } else { 255 });
        Surface::new(Maps { normals, depth, coverage }).unwrap()
    }

    fn assert_near(found: f32, expected: f32, within: f32) {
        assert!((found - expected).abs() <= within, "{found} is not {expected} ± {within}");
    }

    #[test]
    fn the_flow_of_a_spheres_normals_grows_toward_its_rim() {
        // T_n = (I + p pᵀ / z²) / R² at the point p of the unit sphere.
        let flow = FlowField::of_normals(&sphere());
        let (x, z) = (20.5 / RADIUS_PX, (1.0 - (20.5f32 / RADIUS_PX).powi(2)).sqrt());
        let eigen = flow.at(70, 49).eigen();
        assert_near(eigen.larger * RADIUS_PX * RADIUS_PX, 1.0 + x * x / (z * z), 5e-3);
        assert_near(eigen.smaller * RADIUS_PX * RADIUS_PX, 1.0, 5e-3);
        assert_near(eigen.direction.x.abs(), 1.0, 1e-2);
    }

    #[test]
    fn the_flow_of_depth_is_the_slope_of_the_surface() {
        // λ₁ = 1 + |∇h|², of a sphere 1 / z², along the slope; nothing changes across it.
        let flow = FlowField::of_depth(&sphere());
        let (r, z) = (20.5 / RADIUS_PX, (1.0 - (20.5f32 / RADIUS_PX).powi(2)).sqrt());
        let eigen = flow.at(49, 70).eigen();
        assert_near(eigen.larger, 1.0 + r * r / (z * z), 0.05);
        assert_near(eigen.smaller, 1.0, 1e-3);
        assert_near(eigen.direction.y.abs(), 1.0, 1e-2);
        assert_near(flow.magnitude(49, 70), 1.0 / z - 1.0, 0.03);
    }

    #[test]
    fn an_operator_that_moves_nothing_flows_nowhere() {
        let surface = sphere();
        let anchors = vec![Anchor::pin(vec2(50.5, 50.5))];
        let bend = |operator| Bend { operator, anchors: anchors.clone(), ..Bend::default() };
        let still =
            FlowField::of_deformation(Some(&surface), surface.size(), &bend(Operator::None));
        assert_near(still.magnitude(70, 49), 0.0, 1e-6);
        let bent = Operator::Normal { alpha: 1.0, beta: 0.0, detail: 0.0 };
        let flow = FlowField::of_deformation(Some(&surface), surface.size(), &bend(bent));
        assert!(flow.magnitude(70, 49) > 0.5);
    }

    #[test]
    fn smoothing_stays_within_the_surface() {
        let surface = sphere();
        let flow = FlowField::of_normals(&surface);
        let smooth = flow.smoothed(Some(surface.coverage_plane()), 2.0);
        // The rim changes most; nothing from beyond it may dilute it.
        assert!(smooth.magnitude(88, 49) > 0.7 * flow.magnitude(88, 49));
        assert_near(smooth.at(50, 50).xx, flow.at(50, 50).xx, 0.1 * flow.at(50, 50).xx);
    }
}
