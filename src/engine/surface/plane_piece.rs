//! Pieces of an unwrapped surface whose picture is turned, moved and scaled alone (MATH 8).
//! Floor 2. Not here: anchors, which lay a plane as well (`deformation::plane`).

use crate::math::{Affine2, COORDINATE, Mat2, Range, TURNS, Vec2};

/// How the picture lies turned, moved and scaled in the plane of one piece, on top of what anchors
/// make of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanePiece {
    /// A point on the piece, canvas px. The picture is turned and scaled about what it shows there.
    pub at: Vec2,
    /// How far the picture is moved in the piece's plane, canvas px.
    pub moved: Vec2,
    /// Larger than 1: the picture is larger.
    pub scale: f32,
    /// Counter-clockwise as seen, degrees.
    pub rotation: f32,
}

impl PlanePiece {
    /// What a move may be, px.
    pub const MOVED: Range = COORDINATE;
    /// The range of a scale.
    pub const SCALE: Range = 0.01..=100.0;
    /// What a rotation may be, degrees.
    pub const ROTATION: Range = TURNS;
    /// Pieces that a bend may name.
    pub const MOST: usize = 10_000;

    /// The piece at a point, its picture as it is.
    pub fn at(at: Vec2) -> Self {
        Self { at, moved: Vec2::ZERO, scale: 1.0, rotation: 0.0 }
    }

    /// It changes nothing.
    pub fn is_still(&self) -> bool {
        *self == Self::at(self.at)
    }

    /// From a point of the plane to the point of the picture that is shown there now.
    ///
    /// MATH 8: `p ↦ c + Tᵀ (p − c − m) / s`, c what was shown at the piece's point, T its rotation.
    /// What is not finite counts as nothing, the scale is held in its range.
    pub fn picture_from_plane(&self, shown: Vec2) -> Affine2 {
        let finite = |v: f32| if v.is_finite() { v } else { 0.0 };
        let moved = Vec2::new(finite(self.moved.x), finite(self.moved.y));
        let scale = self.scale.max(*Self::SCALE.start()).min(*Self::SCALE.end());
        // Counter-clockwise as seen is clockwise where y points down; the inverse turns the other
        // way again.
        let linear = Mat2::from_angle(finite(self.rotation).to_radians()) * (1.0 / scale);
        Affine2::from_mat2_translation(linear, shown - linear * (shown + moved))
    }

    /// Moves pieces with the canvas.
    ///
    /// * `point`: where a point is now; `stretch`: how lengths and directions changed about it.
    pub fn go_along(
        pieces: &mut [Self],
        point: impl Fn(Vec2) -> Vec2,
        stretch: impl Fn(Vec2) -> Mat2,
    ) {
        pieces
            .iter_mut()
            .for_each(|piece| *piece = piece.mapped(point(piece.at), stretch(piece.at)));
    }

    /// The same piece after the canvas was mapped.
    ///
    /// * `at`: where its point is now; `stretch`: how lengths and directions changed about it.
    pub fn mapped(&self, at: Vec2, stretch: Mat2) -> Self {
        let rotation = if stretch.determinant() < 0.0 { -self.rotation } else { self.rotation };
        Self { at, moved: stretch * self.moved, rotation, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    #[test]
    fn a_picture_is_turned_counter_clockwise_scaled_and_moved_about_its_point() {
        let piece = PlanePiece {
            moved: vec2(5.0, 0.0),
            scale: 2.0,
            rotation: 90.0,
            ..PlanePiece::at(Vec2::ZERO)
        };
        let look = piece.picture_from_plane(vec2(10.0, 20.0));
        assert!(look.transform_point2(vec2(15.0, 20.0)).distance(vec2(10.0, 20.0)) < 1e-5);
        // What lay 3 px to the right lies 6 px above now: y points down.
        assert!(look.transform_point2(vec2(15.0, 14.0)).distance(vec2(13.0, 20.0)) < 1e-5);
        assert!(PlanePiece::at(vec2(3.0, 4.0)).is_still());
        let still = PlanePiece::at(Vec2::ZERO).picture_from_plane(vec2(7.0, 8.0));
        assert!(still.transform_point2(vec2(1.0, 2.0)).distance(vec2(1.0, 2.0)) < 1e-6);
    }

    #[test]
    fn a_mirrored_canvas_turns_the_other_way() {
        let piece =
            PlanePiece { moved: vec2(5.0, 2.0), rotation: 30.0, ..PlanePiece::at(vec2(1.0, 1.0)) };
        let mirrored = piece.mapped(vec2(99.0, 1.0), Mat2::from_diagonal(vec2(-2.0, 2.0)));
        assert_eq!(
            (mirrored.moved, mirrored.rotation, mirrored.scale),
            (vec2(-10.0, 4.0), -30.0, 1.0)
        );
    }

    #[test]
    fn what_is_no_number_counts_as_nothing() {
        let piece = PlanePiece {
            moved: vec2(f32::NAN, f32::INFINITY),
            scale: f32::NAN,
            rotation: f32::NAN,
            at: Vec2::ZERO,
        };
        assert!(
            piece.picture_from_plane(vec2(1.0, 2.0)).transform_point2(vec2(3.0, 4.0)).is_finite()
        );
    }
}
