//! The gradient tool: a colour ramp between two anchors, bent before it is applied (SF sec. 5.2, fig. 8).
//! Floor 3.

use super::scene::Filter;
use crate::math::{Vec2, srgb::Color};
use crate::surface::Operator;

/// A colour at a place of the ramp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// In `[0, 1]`, not decreasing from stop to stop.
    pub t: f32,
    pub color: Color,
}

/// ramp(t(D(q))), t the projection on the segment [from, to], clamped. Its two ends are its anchors.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    pub from: Vec2,
    pub to: Vec2,
    /// At least one. Between two stops straight-alpha encoded values are interpolated linearly.
    pub stops: Vec<Stop>,
    pub operator: Operator,
    pub filter: Filter,
}
