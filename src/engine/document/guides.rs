//! Guides: straight lines across the canvas that what is dragged snaps to. A value of the document,
//! not part of the picture. Floor 4. Not here: what snaps to them (`tools`).

use crate::math::range::{at_most, check_range};
use crate::math::{COORDINATE, PlaneMap, Vec2, vec2};

/// Lines across the canvas, px from its left or upper edge; in the order in which they were drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Guides {
    /// Upright lines, by their x.
    pub vertical: Vec<f32>,
    /// Level lines, by their y.
    pub horizontal: Vec<f32>,
}

impl Guides {
    /// The most of either direction.
    pub const MOST: usize = 1_000;

    /// There is none.
    pub fn is_empty(&self) -> bool {
        self.vertical.is_empty() && self.horizontal.is_empty()
    }

    /// Refuses what files cannot hold.
    pub fn fits(&self) -> Result<(), String> {
        for lines in [&self.vertical, &self.horizontal] {
            at_most("Guides", lines.len(), Self::MOST)?;
            lines
                .iter()
                .try_for_each(|at| check_range("the place of a guide", *at, &COORDINATE))?;
        }
        Ok(())
    }

    /// The same lines after a map of the canvas. One that is then neither upright nor level is left
    /// out.
    pub fn transformed(&self, map: &PlaneMap) -> Self {
        /// Far enough apart to see how a line leans, px.
        const SPAN: f32 = 1024.0;
        let mut out = Self::default();
        let mut take = |a: Vec2, b: Vec2| {
            let (Some(a), Some(b)) = (map.to_canvas(a), map.to_canvas(b)) else { return };
            let by = (b - a).abs();
            let is_straight = by.min_element() <= 1e-4 * by.max_element();
            if is_straight && by.x < by.y {
                out.vertical.push(a.x);
            } else if is_straight && by.y < by.x {
                out.horizontal.push(a.y);
            }
        };
        self.vertical.iter().for_each(|x| take(vec2(*x, 0.0), vec2(*x, SPAN)));
        self.horizontal.iter().for_each(|y| take(vec2(0.0, *y), vec2(SPAN, *y)));
        let range = |at: &f32| COORDINATE.contains(at);
        out.vertical.retain(range);
        out.horizontal.retain(range);
        out
    }

    /// On a canvas `per_axis` times as large.
    pub(super) fn scaled(&self, per_axis: Vec2) -> Self {
        let by = |lines: &[f32], factor: f32| lines.iter().map(|at| at * factor).collect();
        Self {
            vertical: by(&self.vertical, per_axis.x),
            horizontal: by(&self.horizontal, per_axis.y),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guides() -> Guides {
        Guides { vertical: vec![10.0, 40.5], horizontal: vec![7.0] }
    }

    #[test]
    fn guides_turn_with_the_canvas_and_those_that_lean_then_go() {
        // A canvas of 100 × 60 turned to the left is 60 × 100.
        let quarter = PlaneMap::affine([0.0, -1.0, 1.0, 0.0, 0.0, 100.0]).unwrap();
        let turned = guides().transformed(&quarter);
        assert_eq!(turned, Guides { vertical: vec![7.0], horizontal: vec![90.0, 59.5] });
        let four = (1..4).fold(turned, |guides, i| {
            let side = if i % 2 == 1 { 60.0 } else { 100.0 };
            guides.transformed(&PlaneMap::affine([0.0, -1.0, 1.0, 0.0, 0.0, side]).unwrap())
        });
        assert_eq!(four, guides());
        let mirrored =
            guides().transformed(&PlaneMap::affine([-1.0, 0.0, 0.0, 1.0, 100.0, 0.0]).unwrap());
        assert_eq!(mirrored, Guides { vertical: vec![90.0, 59.5], horizontal: vec![7.0] });
        assert!(guides().transformed(&PlaneMap::rotation(30.0, Vec2::ZERO)).is_empty());
    }

    #[test]
    fn guides_that_no_file_gives_back_are_refused() {
        assert!(guides().fits().is_ok());
        for at in [f32::NAN, f32::INFINITY, 2e6] {
            assert!(Guides { vertical: vec![at], ..Guides::default() }.fits().is_err(), "{at}");
        }
        assert!(
            Guides { horizontal: vec![0.0; Guides::MOST + 1], ..Guides::default() }.fits().is_err()
        );
    }
}
