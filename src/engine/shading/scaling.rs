//! The scaling function σ: how much reflected light is raised or lowered on a feature (RS sec. 4,
//! MATH 5). Floor 3. Not here: which curvature (`features`), which reflectance (`radiance`,
//! `material`).

use crate::math::{Range, fast};

/// How a term is scaled: the scaling-invariant point and the magnitude.
///
/// RS names separate strengths for convex and concave features as future work; with both equal it
/// is the paper's γ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaling {
    /// α in (0, 1): light of this reflectance is unchanged; on a convex feature brighter light
    /// rises, dimmer light falls.
    pub alpha: f32,
    /// γ on convex features (κ > 0), `≥ 0`.
    pub gamma_convex: f32,
    /// γ on concave features (κ < 0), `≥ 0`.
    pub gamma_concave: f32,
}

/// The scaling function.
///
/// RS eq. 2: `σ = (α E + δ (1 − α (1 + E))) / (α + δ (E − α (1 + E)))`, `E = e^(−γκ)`.
///
/// * `kappa`: κ in `[−1, 1]`, convex > 0.
/// * `delta`: reflectance δ in `[0, 1]`.
/// * `alpha`: in (0, 1); `gamma`: `≥ 0`.
///
/// Positive; 1 at δ = α and at κ = 0, e^(γκ) at δ = 1, e^(−γκ) at δ = 0.
pub fn sigma(kappa: f32, delta: f32, alpha: f32, gamma: f32) -> f32 {
    ratio((-gamma * kappa).exp(), delta, alpha)
}

/// RS eq. 2 for a given E, sorted so that every summand is positive: no cancellation, no zero below
/// the line.
#[inline(always)]
fn ratio(e: f32, delta: f32, alpha: f32) -> f32 {
    let (dim, bright) = (alpha * (1.0 - delta), delta * (1.0 - alpha));
    (dim * e + bright) / (dim + bright * e)
}

impl Scaling {
    /// The paper's default α: convexities are mostly brightened (RS fig. 3).
    pub const ALPHA: f32 = 0.2;
    /// Excludes 0 and 1.
    pub const INVARIANT: Range = 0.001..=0.999;
    /// The range of γ.
    pub const GAMMA: Range = 0.0..=20.0;
    /// Changes no term.
    pub const NONE: Scaling = Scaling::new(Self::ALPHA, 0.0);

    /// The same magnitude on convex and concave features.
    pub const fn new(alpha: f32, gamma: f32) -> Self {
        Self { alpha, gamma_convex: gamma, gamma_concave: gamma }
    }

    /// Whether σ is 1 everywhere.
    pub fn is_none(&self) -> bool {
        self.gamma_convex == 0.0 && self.gamma_concave == 0.0
    }

    /// σ(κ, δ); δ is clamped to `[0, 1]`.
    pub fn sigma(&self, kappa: f32, delta: f32) -> f32 {
        let gamma = if kappa > 0.0 { self.gamma_convex } else { self.gamma_concave };
        sigma(kappa, delta.max(0.0).min(1.0), self.alpha, gamma)
    }

    /// [`Scaling::sigma`] for inner loops, relative error below 1e-5.
    #[inline(always)]
    pub fn sigma_fast(self, kappa: f32, delta: f32) -> f32 {
        self.sigma_of(self.exponential(kappa), delta)
    }

    /// E = e^(−γκ) of [`Scaling::sigma_fast`].
    #[inline(always)]
    pub fn exponential(self, kappa: f32) -> f32 {
        // Both are read first: a choice between two addresses would prevent vectorization of loops.
        let Scaling { gamma_convex, gamma_concave, .. } = self;
        let gamma = if kappa > 0.0 { gamma_convex } else { gamma_concave };
        fast::exp(-gamma * kappa)
    }

    /// The rest of [`Scaling::sigma_fast`].
    #[inline(always)]
    pub fn sigma_of(self, exponential: f32, delta: f32) -> f32 {
        ratio(exponential, fast::min(fast::max(delta, 0.0), 1.0), self.alpha)
    }
}

/// The reflectance that counts as 1: Y*.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Reference {
    /// The largest luminance over the surface (or in the environment, or on the lit sphere).
    #[default]
    Auto,
    /// Luminance in linear light, `> 0`.
    Value(f32),
}

impl Reference {
    /// The range of a given reference.
    pub const VALUE: Range = 1e-4..=65_504.0;

    /// Y*, given the largest luminance; never 0.
    pub fn resolve(self, largest: f32) -> f32 {
        let value = match self {
            Reference::Auto => largest,
            Reference::Value(value) => value,
        };
        // A wholly black picture has no reflectance: any δ is right.
        if value > 0.0 && value.is_finite() { value.max(f32::MIN_POSITIVE) } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn assert_near(found: f32, expected: f32, ratio: f32) {
        assert!(
            (found - expected).abs() <= ratio * expected.abs().max(1e-3),
            "{found} is not {expected}"
        );
    }

    #[test]
    #[expect(clippy::approx_constant, reason = "the table is written as it stands")]
    fn sigma_has_the_values_of_the_table() {
        let deltas = [0.0, 0.2, 0.5, 0.8, 1.0];
        for (alpha, kappa, values) in [
            (0.2, 1.0, [0.367879, 1.0, 1.767286, 2.376955, 2.718282]),
            (0.2, -0.5, [1.648721, 1.0, 0.743753, 0.644595, 0.606531]),
            (0.8, 1.0, [0.367879, 0.420706, 0.565839, 1.0, 2.718282]),
        ] {
            for (delta, value) in deltas.into_iter().zip(values) {
                assert_near(sigma(kappa, delta, alpha, 1.0), value, 2e-6);
                assert_near(Scaling::new(alpha, 1.0).sigma_fast(kappa, delta), value, 1e-5);
            }
        }
    }

    #[test]
    fn convex_features_brighten_above_the_invariant_point_and_darken_below_it() {
        let s = Scaling::new(0.3, 1.5);
        assert!(s.sigma(0.7, 0.6) > 1.0 && s.sigma(0.7, 0.1) < 1.0);
        assert!(s.sigma(-0.7, 0.6) < 1.0 && s.sigma(-0.7, 0.1) > 1.0);
    }

    #[test]
    fn convex_and_concave_features_can_be_scaled_apart() {
        let s = Scaling { alpha: 0.2, gamma_convex: 0.0, gamma_concave: 2.0 };
        assert_eq!(s.sigma(0.8, 0.9), 1.0);
        assert_near(s.sigma(-0.8, 0.9), sigma(-0.8, 0.9, 0.2, 2.0), 1e-6);
    }

    #[test]
    fn a_black_reference_does_not_divide_by_zero() {
        assert_eq!(Reference::Auto.resolve(0.0), 1.0);
        assert_eq!(Reference::Auto.resolve(f32::NAN), 1.0);
        assert_eq!(Reference::Value(0.5).resolve(0.9), 0.5);
    }

    proptest! {
        #[test]
        fn sigma_is_one_at_the_invariant_point_and_on_flat_ground(
            kappa in -1.0f32..1.0, delta in 0.0f32..=1.0, alpha in 0.01f32..0.99, gamma in 0.0f32..6.0
        ) {
            assert_near(sigma(kappa, alpha, alpha, gamma), 1.0, 1e-5);
            assert_near(sigma(0.0, delta, alpha, gamma), 1.0, 1e-6);
            assert_near(sigma(kappa, delta, alpha, 0.0), 1.0, 1e-6);
            assert_near(sigma(kappa, 1.0, alpha, gamma), (gamma * kappa).exp(), 1e-5);
            assert_near(sigma(kappa, 0.0, alpha, gamma), (-gamma * kappa).exp(), 1e-5);
        }

        #[test]
        fn convex_and_concave_are_reciprocal(
            kappa in -1.0f32..1.0, delta in 0.0f32..=1.0, alpha in 0.01f32..0.99, gamma in 0.0f32..6.0
        ) {
            assert_near(sigma(-kappa, delta, alpha, gamma), 1.0 / sigma(kappa, delta, alpha, gamma), 1e-4);
            assert_near(sigma(kappa, delta, alpha, gamma), 1.0 / sigma(kappa, 1.0 - delta, 1.0 - alpha, gamma), 1e-4);
        }

        #[test]
        fn sigma_is_monotonic_and_convex_features_gain_no_new_extremum(
            kappa in 0.0f32..1.0, a in 0.0f32..=1.0, b in 0.0f32..=1.0, alpha in 0.01f32..0.99, gamma in 0.0f32..6.0
        ) {
            let (low, high) = (a.min(b), a.max(b));
            let convex = |delta| sigma(kappa, delta, alpha, gamma);
            let concave = |delta| sigma(-kappa, delta, alpha, gamma);
            prop_assert!(convex(low) <= convex(high) * (1.0 + 1e-5));
            prop_assert!(concave(low) >= concave(high) * (1.0 - 1e-5));
            prop_assert!(low * convex(low) <= high * convex(high) * (1.0 + 1e-5));
        }

        #[test]
        fn the_fast_sigma_is_the_same_function(
            kappa in -1.0f32..1.0, delta in -0.5f32..1.5, alpha in 0.01f32..0.99, gamma in 0.0f32..6.0
        ) {
            let s = Scaling { alpha, gamma_convex: gamma, gamma_concave: 0.5 * gamma };
            assert_near(s.sigma_fast(kappa, delta), s.sigma(kappa, delta), 1e-5);
        }
    }
}
