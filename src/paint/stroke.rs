//! The brush tool: a stroke is a list of dabs, each a footprint bent around its own centre (SF sec. 5.2, fig. 7).
//! Floor 3.

use super::brush::Brush;
use crate::math::{Vec2, srgb::Color};
use crate::surface::Operator;

/// One reading of the pen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Canvas px.
    pub at: Vec2,
    /// `[0, 1]`.
    pub pressure: f32,
    /// Degrees from upright, right and down positive.
    pub tilt: Vec2,
    /// Since the stroke began.
    pub time_secs: f32,
}

/// One stroke of a stroke layer.
#[derive(Clone)]
pub struct Stroke {
    pub brush: Brush,
    pub operator: Operator,
    pub color: Color,
    pub samples: Vec<Sample>,
}
