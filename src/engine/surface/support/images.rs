//! What operators make of blocks: where the image of a block lies and how long its pixels are.
//! Floor 2. Interval arithmetic: never less than D does.

use crate::math::{Vec2, vec2};
use crate::surface::Surface;
use crate::surface::operator::{MapValues, Operator, first_order, reflection, second_order};
use crate::surface::pyramid::{DepthSpan, Pyramid, PyramidBlock, TurnSpan};
use crate::surface::unwrap::Unwrapping;
use std::sync::Arc;

/// The operator on the surface, its maps read at the anchor.
pub(super) enum OperatorBounds<'s> {
    Still,
    /// `rate`: e^γ − 1.
    Depth {
        pyramid: &'s Pyramid<DepthSpan>,
        z: f32,
        rate: f32,
    },
    Turn {
        pyramid: &'s Pyramid<TurnSpan>,
        turn: Vec2,
        stretch: RadialOffset,
    },
    /// The surface unwrapped, and where the anchor lies in its plane.
    Unwrapped {
        surface: &'s Surface,
        unwrapping: Arc<Unwrapping>,
        at: Vec2,
    },
}

/// The offset of D_n or D_r as a function of the relative normal, canvas px: an odd radial map.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct RadialOffset {
    /// α L.
    pub alpha_px: f32,
    /// e^−β; `None` is linear: D_r.
    pub softness: Option<f32>,
    /// μ: curvature multiplies the offset by something in [1 − μ, 1 + μ].
    pub detail: f32,
}

impl RadialOffset {
    /// Factor of a relative normal of length u, without detail.
    #[inline(always)]
    fn factor(self, u: f32) -> f32 {
        let curved = |softness| second_order::offset_factor_of_softness(u, self.alpha_px, softness);
        self.softness.map_or(self.alpha_px, curved)
    }

    /// The range of one component of the offset, exact but for the detail: it grows with the
    /// component itself and, in magnitude, with the other one, which `across` bounds in magnitude.
    #[inline(always)]
    fn range(self, (low, high): (f32, f32), across: (f32, f32)) -> (f32, f32) {
        let offset = |v: f32, across: f32| self.factor(vec2(v, across).length()) * v;
        let (a, b) = if self.alpha_px >= 0.0 { (low, high) } else { (high, low) };
        // `a` gives the least offset (a negative one is largest farther out), `b` the greatest.
        let sign = self.alpha_px.signum();
        let least = offset(a, if sign * a < 0.0 { across.1 } else { across.0 });
        let most = offset(b, if sign * b > 0.0 { across.1 } else { across.0 });
        let (d, e) = (1.0 - self.detail, 1.0 + self.detail);
        ((least * d).min(least * e), (most * d).max(most * e))
    }

    /// The most by which the offset changes per change of the normal, up to a relative normal of
    /// length u; and, with detail, per px by the change of curvature alone.
    #[inline(always)]
    fn steepness(self, u: f32) -> (f32, f32) {
        let curved =
            |softness| second_order::offset_factor_slope_of_softness(u, self.alpha_px, softness);
        let slope = self.softness.map_or(0.0, curved);
        let factor = self.factor(u).abs();
        // κ lies in (−1, 1): a difference to one neighbor is below 2 in each direction.
        let by_curvature = factor * u * self.detail.abs() * 2.0 * std::f32::consts::SQRT_2;
        ((factor + u * slope.abs()) * (1.0 + self.detail.abs()), by_curvature)
    }
}

/// The image of a block under D: its distances from the anchor and the greatest length of a pixel,
/// px.
#[derive(Clone, Copy)]
pub(super) struct BlockImage {
    pub near: f32,
    pub far: f32,
    pub pixel: f32,
}

impl OperatorBounds<'_> {
    /// The image of the surface's part of a block whose pixels lie between two corners relative to
    /// the anchor.
    ///
    /// `spread`: how far the map's value at an anchor lies from the one here at most.
    pub fn image(
        &self,
        block: PyramidBlock,
        (low, high): (Vec2, Vec2),
        flat: BlockImage,
        spread: Vec2,
    ) -> BlockImage {
        const ANYWHERE: BlockImage =
            BlockImage { near: 0.0, far: f32::INFINITY, pixel: f32::INFINITY };
        match self {
            OperatorBounds::Still => flat,
            OperatorBounds::Depth { pyramid, z, rate } => pyramid
                .at(block)
                .map_or(ANYWHERE, |span| flat.scaled(span.spread(spread.x), *z, *rate)),
            OperatorBounds::Turn { pyramid, turn, stretch } => pyramid
                .at(block)
                .map_or(ANYWHERE, |span| stretch.image(span.spread(spread), *turn, (low, high))),
            OperatorBounds::Unwrapped { surface, unwrapping, at } => {
                let span = unwrapping.bounds(surface).at(block);
                span.map_or(ANYWHERE, |span| BlockImage::from_unwrapping(span.spread(spread), *at))
            }
        }
    }
}

impl BlockImage {
    /// Where D is the identity: pixels between two corners relative to the anchor.
    #[inline(always)]
    pub fn flat(low: Vec2, high: Vec2) -> Self {
        Self {
            near: distance_to_box(low, high),
            far: low.abs().max(high.abs()).length(),
            pixel: 1.0,
        }
    }

    /// What D_s makes of a block whose points of the unwrapped plane span so much: it turns them
    /// about the anchor's.
    #[inline(always)]
    pub fn from_unwrapping(span: TurnSpan, at: Vec2) -> Self {
        Self { pixel: span.slope, ..Self::flat(span.low - at, span.high - at) }
    }

    /// What D_p makes of a flat block whose depths span so much, the anchor's being `z`.
    #[inline(always)]
    pub fn scaled(self, span: DepthSpan, z: f32, rate: f32) -> Self {
        let scale = |u| 1.0 + first_order::scale_factor_of_rate(u, rate);
        let (nearest, farthest) = (span.low - z, span.high - z);
        // One px more: the differences' neighbors.
        let steepest = first_order::scale_factor_slope_of_rate(farthest, rate) * span.slope;
        let pixel = scale(farthest) + (self.far + 1.0) * steepest;
        Self { near: scale(nearest) * self.near, far: scale(farthest) * self.far, pixel }
    }
}

impl RadialOffset {
    /// What D_n or D_r makes of a block between two corners whose n̄ or r̄ spans so much, the
    /// anchor's being `turn`.
    #[inline(always)]
    pub fn image(self, span: TurnSpan, turn: Vec2, (low, high): (Vec2, Vec2)) -> BlockImage {
        let (a, b) = (span.low - turn, span.high - turn);
        let across_x = (interval_distance(a.x, b.x), a.x.abs().max(b.x.abs()));
        let across_y = (interval_distance(a.y, b.y), a.y.abs().max(b.y.abs()));
        let (x0, x1) = self.range((a.x, b.x), across_y);
        let (y0, y1) = self.range((a.y, b.y), across_x);
        let (low, high) = (low + vec2(x0, y0), high + vec2(x1, y1));
        let (steepness, by_curvature) = self.steepness(vec2(across_x.1, across_y.1).length());
        let pixel = 1.0 + steepness * span.slope + by_curvature;
        BlockImage { pixel, ..BlockImage::flat(low, high) }
    }
}

impl<'s> OperatorBounds<'s> {
    pub fn new(surface: &'s Surface, operator: Operator, at: Vec2) -> Self {
        let MapValues { depth, nbar, nz } = surface.values_near(at);
        let unit_px = surface.size().longer_side();
        match operator {
            Operator::None => OperatorBounds::Still,
            Operator::Depth { gamma } => OperatorBounds::Depth {
                pyramid: surface.bounds().depth(surface),
                z: depth,
                rate: first_order::rate(gamma),
            },
            Operator::Normal { alpha, beta, detail } => {
                let stretch = RadialOffset {
                    alpha_px: alpha * unit_px,
                    softness: Some(second_order::softness(beta)),
                    detail,
                };
                OperatorBounds::Turn {
                    pyramid: surface.bounds().nbar(surface),
                    turn: nbar,
                    stretch,
                }
            }
            Operator::Reflection { alpha, detail } => {
                let stretch = RadialOffset { alpha_px: alpha * unit_px, softness: None, detail };
                let turn = reflection::mirrored(nbar, nz);
                OperatorBounds::Turn {
                    pyramid: surface.bounds().reflections(surface),
                    turn,
                    stretch,
                }
            }
            Operator::Surface { .. } => match operator.unwrapping() {
                Some(settings) => {
                    let unwrapping = surface.unwrapping(settings);
                    let at = unwrapping.place(surface, at).at;
                    OperatorBounds::Unwrapped { surface, unwrapping, at }
                }
                None => OperatorBounds::Still,
            },
        }
    }
}

/// From 0 to the nearest value of an interval.
#[inline(always)]
fn interval_distance(low: f32, high: f32) -> f32 {
    low.max(-high).max(0.0)
}

/// From the origin to the nearest point of a box.
#[inline(always)]
fn distance_to_box(low: Vec2, high: Vec2) -> f32 {
    vec2(interval_distance(low.x, high.x), interval_distance(low.y, high.y)).length()
}
