//! What an input does to a property: lines between points, as factors or as values that are added.
//! Floor 3.

use crate::math::{Vec2, vec2};
use std::sync::Arc;

/// What an input in `[0, 1]` does to a property.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// The line from 1 − p to 1: p in `[0, 1]` is the share of the property that follows the input.
    Share(f32),
    /// Straight lines between points, level beyond the first and the last; factors in `[0, 1]`.
    /// Only from [`Curve::through`].
    Points(Arc<[Vec2]>),
    /// The same, added to the property before anything multiplies it. Only from [`Curve::additive`].
    Added(Arc<[Vec2]>),
}

/// The most points of one curve: more than a user sets.
pub const MAX_POINTS: usize = 64;
/// The most that a curve adds or subtracts.
pub const MOST_ADDED: f32 = 1000.0;

impl Curve {
    /// The curve through points (input, output) of `[0, 1]²` from left to right; two above each
    /// other are a step. `None` for no points, too many, or invalid ones.
    pub fn through(points: Vec<Vec2>) -> Option<Self> {
        let is_inside = points.iter().all(|p| (0.0..=1.0).contains(&p.y));
        (is_inside && are_ordered(&points)).then(|| Curve::Points(points.into()))
    }

    /// The same for outputs up to [`MOST_ADDED`] either way, which are added.
    pub fn additive(points: Vec<Vec2>) -> Option<Self> {
        let is_inside = points.iter().all(|p| p.y.abs() <= MOST_ADDED);
        (is_inside && are_ordered(&points)).then(|| Curve::Added(points.into()))
    }

    /// The number of its points; a share has none.
    pub fn points(&self) -> usize {
        match self {
            Curve::Share(_) => 0,
            Curve::Points(points) | Curve::Added(points) => points.len(),
        }
    }

    /// Its outputs are added.
    pub fn is_additive(&self) -> bool {
        matches!(self, Curve::Added(_))
    }

    /// The output at an input; NaN counts as 0.
    pub fn at(&self, x: f32) -> f32 {
        let x = x.max(0.0).min(1.0);
        let points = match self {
            Curve::Share(p) => return 1.0 - p * (1.0 - x),
            Curve::Points(points) | Curve::Added(points) => points,
        };
        let mut before = points
            .first()
            .copied()
            .unwrap_or(vec2(0.0, if self.is_additive() { 0.0 } else { 1.0 }));
        for &point in points.iter() {
            if x <= point.x {
                let width = point.x - before.x;
                let along = if width > 0.0 { (x - before.x) / width } else { 1.0 };
                return before.y + (point.y - before.y) * along;
            }
            before = point;
        }
        before.y
    }

    /// It changes nothing anywhere.
    pub(super) fn is_idle(&self) -> bool {
        match self {
            Curve::Share(p) => *p == 0.0,
            Curve::Points(points) => points.iter().all(|p| p.y == 1.0),
            Curve::Added(points) => points.iter().all(|p| p.y == 0.0),
        }
    }
}

fn are_ordered(points: &[Vec2]) -> bool {
    let is_inside = points.iter().all(|p| (0.0..=1.0).contains(&p.x));
    let are_rising = points.windows(2).all(|pair| pair[0].x <= pair[1].x);
    (1..=MAX_POINTS).contains(&points.len()) && is_inside && are_rising
}

#[cfg(test)]
mod tests {
    use super::*;

    fn through(points: &[(f32, f32)]) -> Curve {
        Curve::through(points.iter().map(|&(x, y)| vec2(x, y)).collect()).unwrap()
    }

    #[test]
    fn a_curve_is_straight_between_its_points_and_level_beyond_them() {
        let curve = through(&[(0.2, 1.0), (0.6, 0.5), (0.6, 0.1), (0.8, 0.3)]);
        for (x, y) in [
            (0.0, 1.0),
            (0.2, 1.0),
            (0.4, 0.75),
            (0.6, 0.5),
            (0.7, 0.2),
            (0.9, 0.3),
            (f32::NAN, 1.0),
        ] {
            assert!((curve.at(x) - y).abs() < 1e-6, "{x}: {}", curve.at(x));
        }
        assert!(curve.at(0.6001) < 0.11, "two points above each other are a step");
        assert_eq!([0.0, 0.5, 1.0].map(|x| Curve::Share(0.5).at(x)), [0.5, 0.75, 1.0]);
    }

    #[test]
    fn points_that_run_back_or_leave_the_square_are_no_curve() {
        for points in [&[][..], &[(0.5, 0.5), (0.4, 0.5)], &[(0.0, 1.5)], &[(f32::NAN, 0.5)]] {
            assert!(
                Curve::through(points.iter().map(|&(x, y)| vec2(x, y)).collect()).is_none(),
                "{points:?}"
            );
        }
        assert!(Curve::through(vec![Vec2::ZERO; MAX_POINTS + 1]).is_none());
    }

    #[test]
    fn what_is_added_may_leave_the_square_but_not_every_bound() {
        let added = |y: f32| Curve::additive(vec![vec2(0.0, -y), vec2(1.0, y)]);
        assert_eq!(added(40.0).unwrap().at(0.75), 20.0);
        assert!(added(1e4).is_none() && added(f32::NAN).is_none());
    }
}
