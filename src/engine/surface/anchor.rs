//! Anchors: the points of the surface where an image is pinned, and how they share their influence.
//! Floor 2.

use super::operator::Operator;
use super::plane_piece::PlanePiece;
use crate::math::{Mat2, Vec2};

/// Pins the point `source` of the undeformed image at the canvas point `at`: D(at) = source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// q_i, canvas px; the maps are read there, between pixels.
    pub at: Vec2,
    /// s_i, canvas px; equal to `at` unless the content was dragged.
    pub source: Vec2,
}

impl Anchor {
    /// Pins the image where it lies.
    pub fn pin(at: Vec2) -> Self {
        Self { at, source: at }
    }
}

/// How anchors share their influence; the weights of a point add up to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weights {
    /// Inverse distance (Shepard 1968), `power > 0`; exactly 1 at an anchor.
    Shepard {
        /// How steeply influence falls with the distance.
        power: f32,
    },
    /// Linear along the segment from the first anchor to the second, clamped beyond its ends.
    Segment,
}

impl Bend {
    /// The anchors of one layer.
    pub const MOST_ANCHORS: usize = 10_000;

    /// An operator with the image pinned at some points, canvas px.
    pub fn pin_at(operator: Operator, at: impl IntoIterator<Item = Vec2>) -> Self {
        Self { operator, anchors: at.into_iter().map(Anchor::pin).collect(), ..Self::default() }
    }

    /// Moves anchors and pieces with the canvas.
    ///
    /// * `point`: where a point is now; `stretch`: how lengths and directions changed about it.
    pub fn go_along(&mut self, point: impl Fn(Vec2) -> Vec2, stretch: impl Fn(Vec2) -> Mat2) {
        for Anchor { at, source } in &mut self.anchors {
            (*at, *source) = (point(*at), point(*source));
        }
        PlanePiece::go_along(&mut self.pieces, point, stretch);
    }
}

impl Default for Weights {
    fn default() -> Self {
        Weights::Shepard { power: 2.0 }
    }
}

/// The *where* of a footprint: operator, anchors and weights.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Bend {
    /// Which surface flow is followed.
    pub operator: Operator,
    /// Where the image is pinned; without any it is not bent.
    pub anchors: Vec<Anchor>,
    /// How the anchors share their influence.
    pub weights: Weights,
    /// Of the operator that unwraps the surface: pieces whose picture is turned, moved and scaled
    /// alone.
    pub pieces: Vec<PlanePiece>,
}

impl Weights {
    /// The range of a power.
    pub const POWER: crate::math::Range = 0.1..=16.0;

    /// w_i(q) of every anchor: `≥ 0`, adding up to 1; empty where there are no anchors.
    pub fn at(self, anchors: &[Anchor], q: Vec2) -> Vec<f32> {
        match self {
            Weights::Shepard { power } => shepard(anchors, q, power),
            Weights::Segment => segment(anchors, q),
        }
    }

    /// ∇w_i(q) of every anchor, per px; they add up to 0.
    pub fn gradients(self, anchors: &[Anchor], q: Vec2) -> Vec<Vec2> {
        match self {
            Weights::Shepard { power } => shepard_gradients(anchors, q, power),
            Weights::Segment => segment_gradients(anchors, q),
        }
    }
}

/// Inverse-distance weights (Shepard 1968; MATH 2): `w_i(q) = |q − q_i|^−p / Σ_j |q − q_j|^−p`,
/// exactly 1 at `q = q_i`.
///
/// Distances are taken relative to the nearest anchor's, so that no power overflows; anchors at the
/// same place share.
pub fn shepard(anchors: &[Anchor], q: Vec2, power: f32) -> Vec<f32> {
    let distance = |a: &Anchor| q.distance(a.at);
    let nearest = anchors.iter().map(distance).fold(f32::INFINITY, f32::min);
    let closeness = |a: &Anchor| match distance(a) {
        d if d == nearest => 1.0,
        d => (nearest / d).powf(power),
    };
    let sum: f32 = anchors.iter().map(closeness).sum();
    anchors.iter().map(|a| closeness(a) / sum).collect()
}

/// ∇w_i of [`shepard`]: `w_i (ℓ_i − Σ_j w_j ℓ_j)`, with `ℓ_i = −p (q − q_i) / |q − q_i|²` the
/// gradient of the logarithm. 0 at an anchor (its limit for `p > 1`).
fn shepard_gradients(anchors: &[Anchor], q: Vec2, power: f32) -> Vec<Vec2> {
    let weights = shepard(anchors, q, power);
    let logarithmic = |a: &Anchor| {
        let d = q - a.at;
        if d.length_squared() < 1e-12 { Vec2::ZERO } else { -power * d / d.length_squared() }
    };
    let mean: Vec2 = anchors.iter().zip(&weights).map(|(a, &w)| w * logarithmic(a)).sum();
    anchors.iter().zip(&weights).map(|(a, &w)| w * (logarithmic(a) - mean)).collect()
}

/// The gradient tool's weights (MATH 2): `w_0 = 1 − clamp(((q − q_0)·(q_1 − q_0)) / |q_1 − q_0|²,
/// 0, 1)`, `w_1 = 1 − w_0`.
///
/// Anchors beyond the second have no weight; a single one, or two at the same place, leave all of
/// it to the first.
pub fn segment(anchors: &[Anchor], q: Vec2) -> Vec<f32> {
    let along = project_onto_segment(anchors, q).max(0.0).min(1.0);
    (0..anchors.len()).map(|i| [1.0 - along, along].get(i).copied().unwrap_or(0.0)).collect()
}

/// ∇w_i of [`segment`]; 0 beyond its ends.
fn segment_gradients(anchors: &[Anchor], q: Vec2) -> Vec<Vec2> {
    let inside = (0.0..=1.0).contains(&project_onto_segment(anchors, q));
    let slope = if inside { segment_slope(anchors) } else { Vec2::ZERO };
    (0..anchors.len()).map(|i| [-slope, slope].get(i).copied().unwrap_or(Vec2::ZERO)).collect()
}

/// The projection of q on the line through the first two anchors: 0 at the first, 1 at the second.
fn project_onto_segment(anchors: &[Anchor], q: Vec2) -> f32 {
    anchors.first().map_or(0.0, |first| (q - first.at).dot(segment_slope(anchors)))
}

/// Gradient of [`project_onto_segment`]: (q_1 − q_0) / |q_1 − q_0|², 0 where there is no segment.
pub(super) fn segment_slope(anchors: &[Anchor]) -> Vec2 {
    match anchors {
        [first, second, ..] if first.at != second.at => {
            let d = second.at - first.at;
            d / d.length_squared()
        }
        _ => Vec2::ZERO,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use proptest::prelude::*;

    fn anchors(at: &[(f32, f32)]) -> Vec<Anchor> {
        at.iter().map(|&(x, y)| Anchor::pin(vec2(x, y))).collect()
    }

    #[test]
    fn an_anchor_has_all_the_weight_where_it_stands() {
        let three = anchors(&[(1.5, 2.5), (30.0, 4.0), (9.0, 60.0)]);
        assert_eq!(Weights::Shepard { power: 2.0 }.at(&three, three[1].at), [0.0, 1.0, 0.0]);
        assert_eq!(Weights::Shepard { power: 0.5 }.at(&three, three[2].at), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn inverse_squares_share_the_weight() {
        let two = anchors(&[(0.0, 0.0), (30.0, 0.0)]);
        let w = shepard(&two, vec2(10.0, 0.0), 2.0);
        assert!((w[0] - 0.8).abs() < 1e-6 && (w[1] - 0.2).abs() < 1e-6, "1/100 to 1/400: {w:?}");
    }

    #[test]
    fn anchors_at_one_place_share_its_weight() {
        let w = shepard(&anchors(&[(5.0, 5.0), (5.0, 5.0)]), vec2(5.0, 5.0), 2.0);
        assert_eq!(w, [0.5, 0.5]);
    }

    #[test]
    fn segment_weights_run_from_the_first_anchor_to_the_second_and_stop() {
        let two = anchors(&[(10.0, 0.0), (20.0, 0.0)]);
        for (x, w1) in [(0.0, 0.0), (10.0, 0.0), (12.5, 0.25), (20.0, 1.0), (99.0, 1.0)] {
            assert_eq!(segment(&two, vec2(x, 7.0)), [1.0 - w1, w1]);
        }
        assert_eq!(segment(&anchors(&[(3.0, 3.0), (3.0, 3.0)]), vec2(8.0, 8.0)), [1.0, 0.0]);
    }
    proptest! {
        #[test]
        fn weights_add_up_to_one(x in -50.0f32..50.0, y in -50.0f32..50.0, power in 0.1f32..60.0) {
            let many = anchors(&[(0.0, 0.0), (7.0, 3.0), (-20.0, 44.0), (7.0, 3.5)]);
            for weights in [Weights::Shepard { power }, Weights::Segment] {
                let w = weights.at(&many, vec2(x, y));
                prop_assert!((w.iter().sum::<f32>() - 1.0).abs() < 1e-5 && w.iter().all(|w| (0.0..=1.0).contains(w)));
            }
        }

        #[test]
        fn gradients_of_weights_are_their_derivatives(x in -40.0f32..40.0, y in -40.0f32..40.0) {
            let many = anchors(&[(0.0, 0.0), (17.0, 3.0), (-20.0, 44.0)]);
            let q = vec2(x, y);
            prop_assume!(many.iter().all(|a| a.at.distance(q) > 3.0));
            let t = project_onto_segment(&many, q);
            prop_assume!(t.abs() > 0.02 && (t - 1.0).abs() > 0.02);
            for weights in [Weights::Shepard { power: 2.0 }, Weights::Shepard { power: 3.0 }, Weights::Segment] {
                let gradients = weights.gradients(&many, q);
                let h = 0.05;
                let difference = |d: Vec2, i: usize| {
                    (weights.at(&many, q + d)[i] - weights.at(&many, q - d)[i]) / (2.0 * h)
                };
                for (i, g) in gradients.iter().enumerate() {
                    let differenced = vec2(difference(vec2(h, 0.0), i), difference(vec2(0.0, h), i));
                    prop_assert!((*g - differenced).length() < 3e-4, "{g} ≠ {differenced}");
                }
            }
        }
    }
}
