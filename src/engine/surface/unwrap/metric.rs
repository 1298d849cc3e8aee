//! The surface's own metric, from its normals in the picture: how long a step of a pixel is on the
//! surface. Floor 2. Pure functions; each is an equation of MATH 8. Not here: solving for the
//! deformation (`steps`).

use crate::math::{Mat2, Vec2, Vec3, vec2};
use crate::surface::operator::outer;

/// Below this n_z the surface is seen edge-on: it counts as no steeper, so that no picture is
/// stretched more than five times.
pub const STEEPEST_NZ: f32 = 0.2;

/// S(q) of MATH 8: `1 + (n_z^−a − 1) ĝ ĝᵀ`, the symmetric root of the surface's metric in the
/// picture.
///
/// A height field with ∇h = −n̄/n_z has the metric 1 + ∇h ∇hᵀ, whose root stretches by √(1 + |∇h|²)
/// = 1/n_z along the slope ĝ = n̄/|n̄| and not at all across it. Canvas px of the surface per px of
/// the picture.
///
/// * `nbar`, `nz`: a unit normal, image axes; n_z is held ≥ 0.2.
/// * `amount`: a, `[0, 2]`; 1 is the surface's own metric, 0 flat: the identity.
pub fn stretch(nbar: Vec2, nz: f32, amount: f32) -> Mat2 {
    let along = nbar / nbar.length().max(1e-9);
    Mat2::IDENTITY + outer(along, along) * (nz.max(STEEPEST_NZ).min(1.0).powf(-amount) - 1.0)
}

/// S(q) of MATH 8 of a surface that is seen from near: the symmetric root of its first fundamental
/// form, to the power a.
///
/// The point seen at q lies at Z (b, 1), b = (q − c)/f. Its normal says how Z grows, ∇Z/Z = g/f
/// with g = n̄/ν and ν = n_z − n̄·b, so that ∂P/∂q has the metric `(Z/Z̄)² (1 + b gᵀ + g bᵀ + (1 +
/// |b|²) g gᵀ)`, where a px is as long as on the picture plane at Z̄. With b = 0 it is that of a
/// parallel view.
///
/// * `nbar`, `nz`: a unit normal, image axes; ν is held ≥ 0.2 of the length of (b, 1).
/// * `beside`: b, focal lengths from the point before the eye; image axes.
/// * `farness`: Z/Z̄, `> 0`.
/// * `amount`: a, as in [`stretch`].
pub fn stretch_in_perspective(
    nbar: Vec2,
    nz: f32,
    beside: Vec2,
    farness: f32,
    amount: f32,
) -> Mat2 {
    let away = 1.0 + beside.length_squared();
    let slope = nbar / facing_in_perspective(nbar, nz, beside).max(STEEPEST_NZ) / away.sqrt();
    let metric =
        Mat2::IDENTITY + outer(beside, slope) + outer(slope, beside) + outer(slope, slope) * away;
    // Its larger axis u, and both eigenvalues.
    let half = 0.5 * vec2(metric.x_axis.x - metric.y_axis.y, 2.0 * metric.x_axis.y);
    let (middle, reach) = (0.5 * (metric.x_axis.x + metric.y_axis.y), half.length());
    let root = |v: f32| v.max(1e-4).sqrt().min(1.0 / STEEPEST_NZ).powf(amount);
    let (most, least) = (root(middle + reach), root(middle - reach));
    let twice = half / reach.max(1e-9);
    // u uᵀ from the double angle.
    let along = Mat2::from_cols(vec2(1.0 + twice.x, twice.y), vec2(twice.y, 1.0 - twice.x)) * 0.5;
    (Mat2::IDENTITY * least + along * (most - least)) * farness.powf(amount)
}

/// n·v of a surface that is seen from near: ν over the length of (b, 1); see [`stretch_in_perspective`].
#[inline(always)]
pub fn facing_in_perspective(nbar: Vec2, nz: f32, beside: Vec2) -> f32 {
    (nz - nbar.dot(beside)) / (1.0 + beside.length_squared()).sqrt()
}

/// R(q) of MATH 8: the rotation in J S⁻¹, by which the solution turned the surface at a pixel.
///
/// `angle = atan2(M₂₁ − M₁₂, M₁₁ + M₂₂)`, M = J S⁻¹: the rotation nearest to M. The identity where
/// M gives none.
pub fn turn(jacobian: Mat2, stretch: Mat2) -> Mat2 {
    let m = jacobian * stretch.inverse();
    let (cos, sin) = (m.x_axis.x + m.y_axis.y, m.x_axis.y - m.y_axis.x);
    let length = cos.hypot(sin);
    if length > 0.0 && length.is_finite() {
        Mat2::from_cols(Vec2::new(cos, sin), Vec2::new(-sin, cos)) * (1.0 / length)
    } else {
        Mat2::IDENTITY
    }
}

/// The angle of a hollow at which a link pulls e times less, rad: 15°.
const HOLLOW_RAD: f32 = 15.0 * std::f32::consts::PI / 180.0;
/// What is left of the pull of the deepest hollows.
const LEAST_PULL: f32 = 1e-3;

/// c_ij of MATH 8: `max(e^(−(φ/15°)²), 10⁻³)` on concave links, whose normals turn toward each
/// other by φ; else 1.
///
/// Where objects touch in a hollow they hardly pull on each other; across raised edges, a cube's,
/// the print goes on.
///
/// * `a`, `b`: unit normals of two neighbors, camera space.
/// * `along`: from the first to the second; image axes.
#[inline(always)]
pub fn concave_pull(a: Vec3, b: Vec3, along: Vec2) -> f32 {
    let turned = b - a;
    // Image axes: y of normals points the other way.
    if turned.x * along.x - turned.y * along.y >= 0.0 {
        return 1.0;
    }
    // φ from its chord 2 sin(φ/2); at 60°, where nothing is left, the series is 0.1 % short.
    let chord = turned.length_squared();
    let squared = chord * (1.0 + chord * (1.0 / 12.0 + chord * (1.0 / 90.0)));
    (-squared / (HOLLOW_RAD * HOLLOW_RAD)).exp().max(LEAST_PULL)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;

    #[test]
    fn the_root_squared_is_the_metric_of_the_slope() {
        for (x, y) in [(0.3f32, 0.4f32), (-0.7, 0.1), (0.0, 0.9), (0.0, 0.0)] {
            let nz = (1.0 - x * x - y * y).sqrt();
            let root = stretch(vec2(x, y), nz, 1.0);
            let slope = vec2(x, y) / nz;
            let metric = Mat2::IDENTITY + outer(slope, slope);
            assert!((root * root).abs_diff_eq(metric, 1e-4), "{:?} and {metric:?}", root * root);
        }
    }

    #[test]
    fn from_near_the_metric_is_that_of_the_points_that_are_seen() {
        // A plane through (0, 0, 3) with any normal: Z (b, 1) lies on it where Z n·(b, −1) = −3
        // n_z.
        let n = vec3(0.4, -0.25, 0.8).normalize();
        let point = |b: Vec2| vec3(b.x, b.y, 1.0) * (3.0 * n.z / (n.z - n.x * b.x - n.y * b.y));
        for b in [Vec2::ZERO, vec2(0.3, 0.1), vec2(-0.4, 0.35)] {
            let h = 1e-3;
            let [dx, dy] =
                [Vec2::X, Vec2::Y].map(|d| (point(b + d * h) - point(b - d * h)) / (2.0 * h));
            let metric =
                Mat2::from_cols(vec2(dx.dot(dx), dx.dot(dy)), vec2(dx.dot(dy), dy.dot(dy)))
                    * (1.0 / 9.0);
            let root = stretch_in_perspective(n.truncate(), n.z, b, point(b).z / 3.0, 1.0);
            assert!(
                (root * root).abs_diff_eq(metric, 3e-3),
                "{b}: {:?} and {metric:?}",
                root * root
            );
            let double = stretch_in_perspective(n.truncate(), n.z, b, point(b).z / 3.0, 2.0);
            assert!(double.abs_diff_eq(root * root, 1e-4));
        }
        for (x, y) in [(0.3f32, 0.4f32), (-0.7, 0.1), (0.0, 0.0)] {
            let (nbar, nz) = (vec2(x, y), (1.0 - x * x - y * y).sqrt());
            let near = stretch_in_perspective(nbar, nz, Vec2::ZERO, 1.0, 1.3);
            assert!(
                near.abs_diff_eq(stretch(nbar, nz, 1.3), 1e-5),
                "straight ahead it is the parallel one"
            );
        }
        let edge_on = stretch_in_perspective(vec2(1.0, 0.0), -0.3, vec2(0.2, 0.4), 1.0, 1.0);
        assert!(
            edge_on.x_axis.is_finite() && edge_on.y_axis.is_finite() && edge_on.determinant() > 0.0
        );
    }

    #[test]
    fn edge_on_it_is_held_and_flat_it_is_the_identity() {
        let steep = stretch(vec2(1.0, 0.0), 0.001, 1.0);
        assert!((steep.x_axis.x - 5.0).abs() < 1e-5 && (steep.y_axis.y - 1.0).abs() < 1e-6);
        assert_eq!(stretch(vec2(0.6, 0.0), 0.8, 0.0), Mat2::IDENTITY);
        assert!((stretch(vec2(0.6, 0.0), 0.8, 2.0).x_axis.x - 1.0 / 0.64).abs() < 1e-5);
        assert!(stretch(vec2(0.6, 0.0), -0.8, 1.0).x_axis.x <= 5.0, "perspective maps lean away");
    }

    #[test]
    fn the_rotation_of_a_stretched_turn_is_the_turn() {
        let s = stretch(vec2(0.5, -0.3), (1.0f32 - 0.34).sqrt(), 1.0);
        for angle in [0.0f32, 0.4, -2.0, 3.1] {
            let r = Mat2::from_angle(angle);
            assert!(turn(r * s, s).abs_diff_eq(r, 1e-5), "{angle}");
        }
        assert_eq!(turn(Mat2::ZERO, s), Mat2::IDENTITY);
    }

    #[test]
    fn concave_links_hardly_pull_and_edges_do() {
        let leaning =
            |degrees: f32| vec3(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos());
        // The right one leans left: a valley.
        let valley =
            |degrees: f32| concave_pull(leaning(degrees / 2.0), leaning(-degrees / 2.0), Vec2::X);
        assert!((valley(15.0) - (-1.0f32).exp()).abs() < 1e-4, "{}", valley(15.0));
        assert!((valley(5.0) - (-1.0f32 / 9.0).exp()).abs() < 1e-4);
        assert_eq!(valley(90.0), 1e-3);
        assert_eq!(concave_pull(leaning(-40.0), leaning(40.0), Vec2::X), 1.0, "a ridge");
        let (up, down) = (vec3(0.0, 0.5, 0.866), vec3(0.0, -0.5, 0.866));
        assert_eq!(concave_pull(up, down, Vec2::Y), 1.0, "a roof: the upper side looks up");
        assert_eq!(concave_pull(down, up, Vec2::Y), 1e-3, "a gutter");
    }
}
