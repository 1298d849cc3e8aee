//! The tiles of many dabs: those that follow each other closely are sought together, as one dab
//! whose anchor may be anywhere among theirs. Floor 2. Interval arithmetic goes down from the whole
//! canvas once for all of them; what it finds is judged for each dab alone.

use super::{
    BlockOverlap, DabExtent, OperatorBounds, PyramidBlock, ROUNDING_PX, SupportBounds, TILE_LEVEL,
};
use crate::math::{Vec2, vec2};
use crate::raster::TileAt;

/// Dabs that are sought together, and how far apart their anchors may lie, px; or in radii.
const RUN: usize = 32;
const APART_PX: f32 = 24.0;
const APART_RADII: f32 = 1.0;

/// Visits every tile of the canvas that each of some dabs may touch, with the dab's number; of a
/// tile in their order.
pub fn for_each_tile_of<'s, 'b>(
    dabs: &[&'b SupportBounds<'s>],
    mut visit: impl FnMut(usize, TileAt),
) where
    's: 'b,
{
    let mut start = 0;
    while start < dabs.len() {
        let run = run_of(&dabs[start..]);
        match join_bounds(&dabs[start..start + run]).filter(|_| run > 1) {
            Some(all) => all.for_each_tile(|at| {
                let tile = PyramidBlock { level: TILE_LEVEL, col: at.col, row: at.row };
                for (i, dab) in dabs.iter().enumerate().skip(start).take(run) {
                    if dab.judge(tile) != BlockOverlap::Nowhere {
                        visit(i, at);
                    }
                }
            }),
            None => (start..start + run).for_each(|i| dabs[i].for_each_tile(|at| visit(i, at))),
        }
        start += run;
    }
}

/// How many of the dabs, from the first on, are near each other.
fn run_of(dabs: &[&SupportBounds]) -> usize {
    let Some(first) = dabs.first() else { return 0 };
    let apart = (APART_RADII * first.extent.radius_px).max(APART_PX);
    let (mut low, mut high) = (first.at, first.at);
    let is_near = |dab: &&&SupportBounds| {
        (low, high) = (low.min(dab.at), high.max(dab.at));
        // Comparisons that NaN fails.
        let is_small = (high - low).max_element() < apart
            && dab.extent.radius_px < 2.0 * first.extent.radius_px;
        is_small && first.flow.is_like(&dab.flow)
    };
    dabs.iter().take(RUN).take_while(is_near).count().max(1)
}

/// One dab that reaches what any of a run reaches; `None` where their anchors are not finite, or
/// where none needs to go down from the whole canvas.
fn join_bounds<'s>(dabs: &[&SupportBounds<'s>]) -> Option<SupportBounds<'s>> {
    let first = dabs.first()?;
    let flow = first.flow.at_anchors(dabs.iter().map(|dab| &dab.flow))?;
    let (low, high) = range(dabs.iter().map(|dab| dab.at));
    let most =
        |figure: fn(&SupportBounds) -> f32| dabs.iter().map(|dab| figure(dab)).fold(0.0, f32::max);
    let at = 0.5 * (low + high);
    let extent = DabExtent {
        radius_px: most(|dab| dab.extent.radius_px) + ROUNDING_PX,
        filter_px: most(|dab| dab.extent.filter_px),
    };
    let (flow, turned) = flow;
    let spread = 0.5 * (high - low) + ROUNDING_PX;
    let is_finite = spread.is_finite() && turned.is_finite() && at.is_finite();
    is_finite.then(|| SupportBounds {
        size: first.size,
        at,
        extent,
        cover: first.cover,
        flow,
        border_px: most(|dab| dab.border_px),
        spread,
        turned,
    })
}

fn range(values: impl Iterator<Item = Vec2>) -> (Vec2, Vec2) {
    values.fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}

impl<'s> OperatorBounds<'s> {
    /// Whether both are the same operator on the same maps, but for the anchor.
    fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Depth { rate, .. }, Self::Depth { rate: other, .. }) => rate == other,
            (Self::Turn { stretch, .. }, Self::Turn { stretch: other, .. }) => stretch == other,
            (Self::Unwrapped { unwrapping, .. }, Self::Unwrapped { unwrapping: other, .. }) => {
                std::sync::Arc::ptr_eq(unwrapping, other)
            }
            _ => false,
        }
    }

    /// What the maps hold at its anchor, that of D_p in x.
    fn value(&self) -> Vec2 {
        match self {
            Self::Still => Vec2::ZERO,
            Self::Depth { z, .. } => vec2(*z, 0.0),
            Self::Turn { turn: at, .. } | Self::Unwrapped { at, .. } => *at,
        }
    }

    /// The same operator between the anchors of some, and how far from there their values lie at
    /// most.
    fn at_anchors<'a>(&self, others: impl Iterator<Item = &'a Self>) -> Option<(Self, Vec2)>
    where
        's: 'a,
    {
        /// Values are rounded; those of maps are shares of 1, those of a plane px.
        const ROUNDING: f32 = 1e-6;
        let (low, high) = range(others.map(Self::value));
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let spread = half + ROUNDING * (1.0 + middle.abs());
        let flow = match self {
            Self::Still => return None,
            Self::Depth { pyramid, rate, .. } => Self::Depth { pyramid, z: middle.x, rate: *rate },
            Self::Turn { pyramid, stretch, .. } => {
                Self::Turn { pyramid, turn: middle, stretch: *stretch }
            }
            Self::Unwrapped { surface, unwrapping, .. } => {
                Self::Unwrapped { surface, unwrapping: unwrapping.clone(), at: middle }
            }
        };
        Some((flow, spread))
    }
}
