//! Anchors: the points of the surface where an image is pinned, and how they share their influence.
//! Floor 2.

use super::operator::Operator;
use crate::math::Vec2;

/// Pins the point `source` of the undeformed image at the canvas point `at`: D(at) = source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// q_i, canvas px; the maps are read at the pixel that holds it.
    pub at: Vec2,
    /// s_i, canvas px; equal to `at` unless the content was dragged.
    pub source: Vec2,
}

impl Anchor {
    pub fn fixed(at: Vec2) -> Self {
        Self { at, source: at }
    }
}

/// How anchors share their influence; the weights of a point add up to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weights {
    /// Inverse distance (Shepard 1968), `power > 0`; exactly 1 at an anchor.
    Shepard { power: f32 },
    /// Linear along the segment from the first anchor to the second, clamped beyond its ends.
    Segment,
}

impl Default for Weights {
    fn default() -> Self {
        Weights::Shepard { power: 2.0 }
    }
}

/// The *where* of a footprint: operator, anchors and weights.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Bend {
    pub operator: Operator,
    pub anchors: Vec<Anchor>,
    pub weights: Weights,
}
