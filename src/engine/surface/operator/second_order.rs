//! Second-order operator: how an image bends where the surface turns.
//! Floor 2. Pure functions; each is an equation of the papers (docs/EQUATIONS.md).
//! Not here: reading maps (`Surface`), anchors and weights (`anchor`), pixels (`raster`).

use super::outer;
use crate::math::{Mat2, Vec2};

/// Largest distinct rate: e^−60 and a large magnitude divided by it both fit an f32, so that 0 / 0
/// cannot occur.
const MAX_BETA: f32 = 60.0;

/// Offset factor of the second-order operator at a relative normal of length `u`.
///
/// SF eq. 14: `f_n(u) = α u / (e^−β + u (1 − e^−β))`.
///
/// * `u`: |n̄ − n̄ᵢ|, in `[0, 2]`.
/// * `alpha`: signed magnitude, in canvas lengths; positive reflects, negative refracts.
/// * `beta`: rate, `≥ 0`; 0 is linear, above 60 nothing changes any more.
///
/// Total: 0 at `u = 0`, `alpha` at `u = 1` for every `beta`.
#[inline(always)]
pub fn offset_factor(u: f32, alpha: f32, beta: f32) -> f32 {
    offset_factor_of_softness(u, alpha, softness(beta))
}

/// e^−β, the only form in which β enters SF eq. 14, in `(0, 1]`; to be taken once for many points.
#[inline(always)]
pub fn softness(beta: f32) -> f32 {
    (-beta.max(0.0).min(MAX_BETA)).exp()
}

/// SF eq. 14 with `softness` = e^−β at hand.
#[inline(always)]
pub fn offset_factor_of_softness(u: f32, alpha: f32, softness: f32) -> f32 {
    alpha * u / (softness + u * (1.0 - softness))
}

/// d f_n / du: the derivative of [`offset_factor`].
pub fn offset_factor_slope(u: f32, alpha: f32, beta: f32) -> f32 {
    offset_factor_slope_of_softness(u, alpha, softness(beta))
}

/// [`offset_factor_slope`] with `softness` = e^−β at hand.
#[inline(always)]
pub fn offset_factor_slope_of_softness(u: f32, alpha: f32, softness: f32) -> f32 {
    let denominator = softness + u * (1.0 - softness);
    alpha / denominator * (softness / denominator)
}

/// How far one anchor's second-order operator moves a point: the summand of SF eq. 15 before its
/// weight and *L*.
///
/// * `turn`: n̄ − n̄ᵢ, image axes (y down), of length `≤ 2`.
///
/// Canvas lengths.
pub fn offset(turn: Vec2, alpha: f32, beta: f32) -> Vec2 {
    offset_factor(turn.length(), alpha, beta) * turn
}

/// ∂/∂q of [`offset`]: `(f_n′(u) d dᵀ/u + f_n(u) I) ∂n̄/∂q`, with `d = n̄ − n̄ᵢ`, `u = |d|`; 0 at
/// `u = 0`.
///
/// * `nbar_slopes`: ∂n̄/∂q, columns per px along x and y.
pub fn offset_jacobian(turn: Vec2, nbar_slopes: Mat2, alpha: f32, beta: f32) -> Mat2 {
    let u = turn.length();
    let along = outer(turn * offset_factor_slope(u, alpha, beta), turn.normalize_or_zero());
    (along + Mat2::IDENTITY * offset_factor(u, alpha, beta)) * nbar_slopes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use proptest::prelude::*;

    #[test]
    fn f_n_takes_the_values_of_the_table() {
        const U: [f32; 5] = [0.0, 0.1, 0.5, 1.0, 2.0];
        for (alpha, beta, row) in [
            (3.0, 0.0, [0.0, 0.3, 1.5, 3.0, 6.0]),
            (3.0, 3.0, [0.0, 2.071704, 2.857722, 3.0, 3.076587]),
            (-1.0, 2.0, [0.0, -0.450853, -0.880797, -1.0, -1.072579]),
        ] {
            for (u, expected) in U.into_iter().zip(row) {
                let f = offset_factor(u, alpha, beta);
                assert!((f - expected).abs() <= 1e-6, "f_n({u}), α = {alpha}, β = {beta}: {f}");
            }
        }
    }

    #[test]
    fn f_n_slope_is_its_derivative() {
        for (u, beta) in [(0.01f32, 3.0f32), (0.2, 0.0), (0.7, 1.0), (1.9, 2.0)] {
            let h = 1e-3;
            let differenced =
                (offset_factor(u + h, 2.0, beta) - offset_factor(u - h, 2.0, beta)) / (2.0 * h);
            let slope = offset_factor_slope(u, 2.0, beta);
            assert!(
                (slope - differenced).abs() < 2e-3 * slope.abs(),
                "at {u}, β = {beta}: {slope} ≠ {differenced}"
            );
        }
    }

    #[test]
    fn the_offset_turns_with_the_normal_and_flips_with_the_sign_of_alpha() {
        let d = vec2(0.3, -0.4);
        let reflected = offset(d, 2.0, 1.0);
        assert!(
            (reflected - d * (2.0 * 0.5 / (0.367879 + 0.5 * 0.632121))).length() < 1e-5,
            "{reflected}"
        );
        assert_eq!(offset(d, -2.0, 1.0), -reflected);
    }

    #[test]
    fn the_jacobian_vanishes_at_the_anchor_where_the_offset_is_quadratic() {
        assert_eq!(offset_jacobian(Vec2::ZERO, Mat2::IDENTITY, 3.0, 2.0), Mat2::ZERO);
    }
    proptest! {
        #[test]
        fn f_n_at_one_is_alpha_for_every_beta(alpha in -5.0f32..5.0, beta in 0.0f32..20.0) {
            prop_assert!((offset_factor(1.0, alpha, beta) - alpha).abs() <= 1e-6 * alpha.abs());
        }

        #[test]
        fn f_n_is_linear_at_beta_zero(alpha in -5.0f32..5.0, u in 0.0f32..2.0) {
            prop_assert_eq!(offset_factor(u, alpha, 0.0), alpha * u);
        }

        #[test]
        fn f_n_is_finite_and_zero_at_the_anchor_for_any_beta(u in 0.0f32..=2.0, beta in 0.0f32..1e30) {
            prop_assert!(offset_factor(u, 1.0, beta).is_finite());
            prop_assert_eq!(offset_factor(0.0, 1.0, beta), 0.0);
            prop_assert_eq!(offset_factor(u, 0.0, beta), 0.0);
        }
    }
}
