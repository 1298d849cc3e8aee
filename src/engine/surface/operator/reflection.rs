//! Reflection operator: how an image bends when it is a mirror's angular map (beyond the paper).
//! Floor 2. Pure functions; each is an equation of the papers (docs/EQUATIONS.md).
//! Not here: reading maps (`Surface`), anchors and weights (`anchor`), pixels (`raster`).

use super::outer;
use crate::math::{Mat2, Vec2};
use std::f32::consts::FRAC_2_PI;

/// r̄: where the reflected view direction falls on an angular map.
///
/// MATH 2: `r̄ = (2/π) acos(n_z) n̄/|n̄|`, 0 where n̄ = 0. The angle is taken as `atan2(|n̄|,
/// n_z)`: the same for a unit normal, and exact where n_z is nearly 1.
///
/// * `nbar`, `nz`: a unit normal, image axes (y down).
///
/// Length in `[0, 1]` for a surface that faces the viewer; 1 is a reflection straight away from the
/// viewer.
pub fn mirrored(nbar: Vec2, nz: f32) -> Vec2 {
    let length = nbar.length();
    let angle_rad = length.atan2(nz);
    if length > 0.0 { nbar * (FRAC_2_PI * angle_rad / length) } else { Vec2::ZERO }
}

/// ∂r̄/∂q of [`mirrored`].
///
/// With `m = n̄/|n̄|`, `θ = acos n_z`: `∂r̄ = (2/π) (m ∂θ + θ/|n̄| (I − m mᵀ) ∂n̄)`, `∂θ = n_z
/// m·∂n̄ − |n̄| ∂n_z`.
///
/// * `nbar_slopes`: ∂n̄/∂q, columns per px; `nz_slope`: ∇n_z.
pub fn mirrored_jacobian(nbar: Vec2, nz: f32, nbar_slopes: Mat2, nz_slope: Vec2) -> Mat2 {
    let length = nbar.length();
    if length < 1e-6 {
        return nbar_slopes * FRAC_2_PI;
    }
    let m = nbar / length;
    let angle_slope = nbar_slopes.transpose() * m * nz - nz_slope * length;
    let across = Mat2::IDENTITY - outer(m, m);
    (outer(m, angle_slope) + across * nbar_slopes * (length.atan2(nz) / length)) * FRAC_2_PI
}

/// How far one anchor's reflection operator moves a point: the summand of MATH 2's `D_r` before its
/// weight and *L*.
///
/// * `mirrored`, `mirrored_at_anchor`: r̄ and r̄ᵢ.
/// * `alpha`: signed magnitude, in canvas lengths.
///
/// Canvas lengths.
pub fn offset(mirrored: Vec2, mirrored_at_anchor: Vec2, alpha: f32) -> Vec2 {
    alpha * (mirrored - mirrored_at_anchor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    #[test]
    fn a_normal_at_45_degrees_mirrors_sideways_and_one_at_90_straight_away() {
        let s = 0.5f32.sqrt();
        assert!((mirrored(vec2(s, 0.0), s) - vec2(0.5, 0.0)).length() < 1e-6);
        assert!((mirrored(vec2(0.0, -1.0), 0.0) - vec2(0.0, -1.0)).length() < 1e-6);
        assert_eq!(mirrored(Vec2::ZERO, 1.0), Vec2::ZERO);
    }

    #[test]
    fn the_angle_is_the_acos_of_n_z() {
        for nz in [-0.4f32, 0.0, 0.3, 0.8, 0.99] {
            let r = mirrored(vec2((1.0 - nz * nz).sqrt(), 0.0), nz);
            assert!((r.x - nz.acos() * FRAC_2_PI).abs() < 1e-6, "{nz}");
        }
    }

    #[test]
    fn nearly_facing_normals_keep_their_precision() {
        let r = mirrored(vec2(1e-4, 0.0), 1.0);
        assert!((r.x / (FRAC_2_PI * 1e-4) - 1.0).abs() < 1e-5, "{r}");
    }

    #[test]
    fn the_offset_is_nothing_at_the_anchor() {
        let r = vec2(0.3, 0.2);
        assert_eq!(offset(r, r, 2.0), Vec2::ZERO);
        assert_eq!(offset(r, Vec2::ZERO, -2.0), -2.0 * r);
    }

    #[test]
    fn the_jacobian_is_the_derivative_over_a_sphere() {
        // On a sphere of radius 100 px n̄ = q / 100 and n_z follows.
        let normal = |q: Vec2| {
            let n = q / 100.0;
            (n, (1.0 - n.length_squared()).sqrt())
        };
        for q in [vec2(0.0, 0.0), vec2(20.0, -30.0), vec2(-70.0, 40.0)] {
            let (n, nz) = normal(q);
            let r = |q| {
                let (n, nz) = normal(q);
                mirrored(n, nz)
            };
            let h = 0.25;
            let differenced = Mat2::from_cols(
                (r(q + vec2(h, 0.0)) - r(q - vec2(h, 0.0))) / (2.0 * h),
                (r(q + vec2(0.0, h)) - r(q - vec2(0.0, h))) / (2.0 * h),
            );
            let jacobian = mirrored_jacobian(n, nz, Mat2::IDENTITY * 0.01, -n * 0.01 / nz);
            assert!(
                (jacobian - differenced).abs_diff_eq(Mat2::ZERO, 2e-5),
                "at {q}: {jacobian} ≠ {differenced}"
            );
        }
    }
}
