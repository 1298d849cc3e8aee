//! Symmetry: every stroke of the brush with its mirror images, each a stroke of its own over its own part of the surface.
//! Floor 5.

use crate::math::{Mat2, Size, Vec2};
use crate::paint::{Brush, Input, Property, Sample};

/// How strokes repeat about the middle of the canvas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Symmetry {
    #[default]
    None,
    /// Left and right of an upright axis.
    Vertical,
    /// Above and below a level axis.
    Horizontal,
    /// About both axes.
    Both,
    /// So many times round, `2..=64`.
    Radial(u32),
}

/// The most times round.
pub const MOST_ROUND: u32 = 64;

/// Where one of the strokes goes: turned or mirrored about the canvas's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Image {
    center: Vec2,
    /// Orthogonal.
    turn: Mat2,
}

impl Symmetry {
    /// The images of a stroke, itself first.
    pub fn images(self, canvas: Size) -> Vec<Image> {
        let mirror = |x: f32, y: f32| Mat2::from_diagonal(Vec2::new(x, y));
        let turns = match self {
            Symmetry::None => vec![Mat2::IDENTITY],
            Symmetry::Vertical => vec![Mat2::IDENTITY, mirror(-1.0, 1.0)],
            Symmetry::Horizontal => vec![Mat2::IDENTITY, mirror(1.0, -1.0)],
            Symmetry::Both => vec![Mat2::IDENTITY, mirror(-1.0, 1.0), mirror(1.0, -1.0), mirror(-1.0, -1.0)],
            Symmetry::Radial(n) => {
                let n = n.clamp(1, MOST_ROUND);
                (0..n).map(|i| Mat2::from_angle(std::f32::consts::TAU * i as f32 / n as f32)).collect()
            }
        };
        turns.into_iter().map(|turn| Image { center: canvas.center(), turn }).collect()
    }
}

impl Image {
    pub fn sample(&self, sample: &Sample) -> Sample {
        let at = self.center + self.turn * (sample.at - self.center);
        // The stroke itself, to the bit.
        let at = if self.turn == Mat2::IDENTITY { sample.at } else { at };
        Sample { at, tilt: self.turn * sample.tilt, ..*sample }
    }
    /// The brush that paints the image: its tip turned with it, unless the tip turns with the stroke or the pen anyway.
    pub fn brush(&self, brush: &Brush) -> Brush {
        let follows = |input| brush.dynamics.curve(Property::Rotation, input).is_some();
        let is_mirrored = self.turn.determinant() < 0.0;
        // Where "up" goes; image axes are y down, turns counter-clockwise as seen.
        let turned = (-self.turn.x_axis.y).atan2(self.turn.x_axis.x).to_degrees();
        let turns_with_stroke = follows(Input::Direction) || follows(Input::TiltDirection);
        let rotation = match (is_mirrored, turns_with_stroke) {
            (true, true) => -brush.rotation,
            (true, false) => turned - brush.rotation,
            (false, true) => brush.rotation,
            (false, false) => brush.rotation + turned,
        };
        let rotation = if self.turn == Mat2::IDENTITY { brush.rotation } else { rotation };
        Brush { rotation: (rotation + 180.0).rem_euclid(360.0) - 180.0, ..brush.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use crate::paint::{Curve, Dynamics};

    const CANVAS: Size = Size::new(200, 100);

    fn places(symmetry: Symmetry) -> Vec<Vec2> {
        let sample = Sample { tilt: vec2(30.0, 10.0), ..Sample::at(vec2(120.0, 40.0)) };
        symmetry.images(CANVAS).iter().map(|image| image.sample(&sample).at.round()).collect()
    }

    #[test]
    fn images_stand_across_their_axes_and_round_the_centre() {
        assert_eq!(places(Symmetry::None), [vec2(120.0, 40.0)]);
        assert_eq!(places(Symmetry::Vertical), [vec2(120.0, 40.0), vec2(80.0, 40.0)]);
        assert_eq!(places(Symmetry::Horizontal), [vec2(120.0, 40.0), vec2(120.0, 60.0)]);
        assert_eq!(places(Symmetry::Both)[3], vec2(80.0, 60.0));
        let quarter = places(Symmetry::Radial(4));
        assert_eq!(quarter, [vec2(120.0, 40.0), vec2(110.0, 70.0), vec2(80.0, 60.0), vec2(90.0, 30.0)]);
        assert_eq!(Symmetry::Radial(u32::MAX).images(CANVAS).len(), MOST_ROUND as usize);
    }
    #[test]
    fn the_pen_leans_the_other_way_in_a_mirror() {
        let image = Symmetry::Vertical.images(CANVAS)[1];
        assert_eq!(image.sample(&Sample { tilt: vec2(30.0, 10.0), ..Sample::at(Vec2::ONE) }).tilt, vec2(-30.0, 10.0));
    }
    #[test]
    fn tips_turn_with_their_image() {
        let brush = Brush { rotation: 30.0, ..Brush::default() };
        let turned = |symmetry: Symmetry, brush: &Brush| symmetry.images(CANVAS)[1].brush(brush).rotation;
        // A mark that rises to the right by 30° rises to the left by 30° in the mirror: half a turn less 30°.
        assert!((turned(Symmetry::Vertical, &brush) - 150.0).abs() < 1e-3);
        assert!((turned(Symmetry::Horizontal, &brush) + 30.0).abs() < 1e-3);
        // A quarter turn to the right, in image axes, is one clockwise as seen.
        assert!((turned(Symmetry::Radial(4), &brush) + 60.0).abs() < 1e-3);
        let dynamics = Dynamics::none().with(Property::Rotation, Input::Direction, Curve::Share(1.0));
        let following = Brush { dynamics, ..brush };
        assert!((turned(Symmetry::Radial(4), &following) - 30.0).abs() < 1e-3);
        assert!((turned(Symmetry::Vertical, &following) + 30.0).abs() < 1e-3);
    }
}
