//! First-order operator: an image grows where the surface is nearer and shrinks where it is
//! farther. Floor 2. Pure functions; each is an equation of the papers (docs/EQUATIONS.md). Not
//! here: reading maps (`Surface`), anchors and weights (`anchor`), pixels (`raster`).

use super::outer;
use crate::math::{Mat2, Vec2};

/// Largest distinct rate: e^40 times a canvas still fits an f32, with headroom for squaring.
const MAX_GAMMA: f32 = 40.0;

/// Scaling factor of the first-order operator at a relative depth `u`.
///
/// SF eq. 12: `f_p(u) = 2u(e^γ − 1) / ((e^γ + 1) − u(e^γ − 1))`.
///
/// * `u`: z − zᵢ, in `[−1, 1]` (clamped).
/// * `gamma`: rate, `≥ 0`; 0 is the identity, above 40 nothing changes any more.
///
/// Total: 0 at `u = 0`, `e^γ − 1` at 1, `e^−γ − 1` at −1; always above −1, so an image is never
/// turned inside out.
#[inline(always)]
pub fn scale_factor(u: f32, gamma: f32) -> f32 {
    scale_factor_of_rate(u, rate(gamma))
}

/// e^γ − 1, the only form in which γ enters SF eq. 12; to be taken once for many points.
#[inline(always)]
pub fn rate(gamma: f32) -> f32 {
    gamma.max(0.0).min(MAX_GAMMA).exp_m1()
}

/// SF eq. 12 with `rate` = e^γ − 1 at hand. The denominator is written `2 + (1 − u) rate`, which
/// cancels nothing.
#[inline(always)]
pub fn scale_factor_of_rate(u: f32, rate: f32) -> f32 {
    let u = u.max(-1.0).min(1.0);
    2.0 * u * rate / (2.0 + (1.0 - u) * rate)
}

/// d f_p / du: the derivative of [`scale_factor`], per unit of depth.
pub fn scale_factor_slope(u: f32, gamma: f32) -> f32 {
    scale_factor_slope_of_rate(u, rate(gamma))
}

/// [`scale_factor_slope`] with `rate` = e^γ − 1 at hand.
#[inline(always)]
pub fn scale_factor_slope_of_rate(u: f32, rate: f32) -> f32 {
    let denominator = 2.0 + (1.0 - u.max(-1.0).min(1.0)) * rate;
    2.0 * rate / denominator * ((rate + 2.0) / denominator)
}

/// How far one anchor's first-order operator moves a point: the summand of SF eq. 13 before its
/// weight.
///
/// * `from_anchor`: q − qᵢ, canvas px.
/// * `u`: z − zᵢ, in `[−1, 1]`; negative (nearer than the anchor) moves the lookup toward the
///   anchor: it inflates.
///
/// Canvas px.
pub fn offset(from_anchor: Vec2, u: f32, gamma: f32) -> Vec2 {
    scale_factor(u, gamma) * from_anchor
}

/// ∂/∂q of [`offset`]: `f_p′(u) (q − qᵢ) ∇zᵀ + f_p(u) I`.
///
/// * `slope`: ∇z, depth per px.
pub fn offset_jacobian(from_anchor: Vec2, u: f32, slope: Vec2, gamma: f32) -> Mat2 {
    outer(scale_factor_slope(u, gamma) * from_anchor, slope)
        + Mat2::IDENTITY * scale_factor(u, gamma)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use proptest::prelude::*;

    #[test]
    fn f_p_takes_the_values_of_the_table() {
        const U: [f32; 6] = [-1.0, -0.5, 0.0, 0.25, 0.5, 1.0];
        for (gamma, row) in [
            (1.0, [-0.632121, -0.375382, 0.0, 0.261239, 0.600978, 1.718282]),
            (3.0, [-0.950213, -0.623134, 0.0, 0.584938, 1.653463, 19.085537]),
        ] {
            for (u, expected) in U.into_iter().zip(row) {
                let f = scale_factor(u, gamma);
                assert!(
                    (f - expected).abs() <= 2e-6 * expected.abs().max(1.0),
                    "f_p({u}), γ = {gamma}: {f}"
                );
            }
        }
    }

    #[test]
    fn f_p_slope_is_its_derivative() {
        for (u, gamma) in [(-0.9f32, 1.0f32), (-0.2, 3.0), (0.0, 2.0), (0.4, 3.0), (0.8, 1.5)] {
            let h = 1e-3;
            let differenced = (scale_factor(u + h, gamma) - scale_factor(u - h, gamma)) / (2.0 * h);
            let slope = scale_factor_slope(u, gamma);
            assert!(
                (slope - differenced).abs() < 2e-3 * slope,
                "at {u}, γ = {gamma}: {slope} ≠ {differenced}"
            );
        }
    }

    #[test]
    fn a_nearer_surface_inflates_and_a_farther_one_deflates() {
        let d = vec2(10.0, -4.0);
        assert!(
            (d + offset(d, -0.3, 1.0)).length() < d.length(),
            "the lookup moves toward the anchor"
        );
        assert!((d + offset(d, 0.3, 1.0)).length() > d.length(), "the lookup moves away");
    }
    proptest! {
        #[test]
        fn f_p_of_opposite_depths_are_inverse_scales(u in -1.0f32..=1.0, gamma in 0.0f32..5.0) {
            let product = (1.0 + scale_factor(u, gamma)) * (1.0 + scale_factor(-u, gamma));
            prop_assert!((product - 1.0).abs() < 1e-4, "{product}");
        }

        #[test]
        fn f_p_is_finite_and_zero_at_the_anchor_for_any_gamma(u in -1.0f32..=1.0, gamma in 0.0f32..1e30) {
            prop_assert!(scale_factor(u, gamma).is_finite());
            prop_assert_eq!(scale_factor(0.0, gamma), 0.0);
            prop_assert_eq!(scale_factor(u, 0.0), 0.0);
        }

        #[test]
        fn f_p_ends_at_the_scales_of_gamma(gamma in 0.0f32..8.0) {
            prop_assert!((scale_factor(1.0, gamma) / gamma.exp_m1().max(1e-9) - 1.0).abs() < 1e-5 || gamma < 1e-6);
            prop_assert!((scale_factor(-1.0, gamma) - (-gamma).exp_m1()).abs() < 1e-6);
        }
    }
}
