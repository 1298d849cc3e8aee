//! Symmetry: every stroke of the brush with its mirror images, each a stroke of its own over its
//! own part of the surface. A value of the document, not part of the picture. Floor 4.

use crate::math::range::{check_range, clamp_to_range};
use crate::math::{COORDINATE, Mat2, PlaneMap, Size, TURNS, Vec2, vec2};
use crate::paint::{Brush, Sample, StrokeFrame};

/// How strokes repeat about a point, by default the middle of the canvas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Symmetry {
    /// They do not.
    #[default]
    None,
    /// Left and right of an upright axis.
    Vertical,
    /// Above and below a level axis.
    Horizontal,
    /// About both axes.
    Both,
    /// Turned around so many times, `2..=64`.
    Radial(u32),
}

/// The most turns.
pub const MOST_ROUND: u32 = 64;

/// The place of the axes.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SymmetryAxes {
    /// The point about which strokes repeat; if absent, the middle of the canvas.
    pub center: Option<Vec2>,
    /// How far both axes are turned, counter-clockwise, degrees.
    pub turn: f32,
}

/// How strokes repeat, and about what.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SymmetrySettings {
    /// How they repeat.
    pub kind: Symmetry,
    /// The axes that they repeat about.
    pub axes: SymmetryAxes,
}

impl SymmetrySettings {
    /// The images of a stroke, the stroke itself first.
    pub fn images(&self, canvas: Size) -> Vec<SymmetryImage> {
        self.kind.images_about(canvas, self.axes)
    }

    /// Refuses what files cannot hold.
    pub fn fits(&self) -> Result<(), String> {
        if let Symmetry::Radial(turns) = self.kind
            && !(2..=MOST_ROUND).contains(&turns)
        {
            return Err(format!("Symmetry turns {turns} times; it must turn 2 to {MOST_ROUND}"));
        }
        if let Some(center) = self.axes.center {
            check_range("the middle of symmetry", center.x, &COORDINATE)?;
            check_range("the middle of symmetry", center.y, &COORDINATE)?;
        }
        check_range("the turn of symmetry", self.axes.turn, &TURNS)
    }

    /// The same axes after a map of the canvas from one size to another; without them where they go
    /// out of range.
    pub(super) fn transformed(&self, map: &PlaneMap, [from, to]: [Size; 2]) -> Self {
        let middle = self.axes.middle(from);
        let upward = middle - self.axes.rotation() * Vec2::Y * SPAN_PX;
        let (Some(center), Some(end)) = (map.to_canvas(middle), map.to_canvas(upward)) else {
            return Self { axes: SymmetryAxes::default(), ..*self };
        };
        let turn = match self.axes.turn == 0.0 && (end - center).x.abs() < 1e-3 && end.y < center.y
        {
            true => 0.0,
            false => turn_of(end - center),
        };
        // The middle of the canvas stays the middle of the canvas.
        let is_middle = self.axes.center.is_none() && center.distance(to.center()) < 1e-3;
        let next =
            Self { axes: SymmetryAxes { center: (!is_middle).then_some(center), turn }, ..*self };
        if next.fits().is_ok() { next } else { Self { axes: SymmetryAxes::default(), ..*self } }
    }

    /// On a canvas `per_axis` times as large.
    pub(super) fn scaled(&self, per_axis: Vec2) -> Self {
        let center = self.axes.center.map(|center| center * per_axis);
        Self { axes: SymmetryAxes { center, ..self.axes }.clamp_to_ranges(), ..*self }
    }
}

/// Far enough from the middle to see how an axis leans, px.
const SPAN_PX: f32 = 1024.0;

/// How far an axis is turned whose upper end lies there, degrees counter-clockwise.
fn turn_of(upward: Vec2) -> f32 {
    (-upward.x).atan2(-upward.y).to_degrees()
}

/// What the user drags.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisHandle {
    /// The point where the axes meet.
    Middle,
    /// At the upper end of the upright axis.
    End,
}

/// The distance of the turning handle from the middle, screen points.
const HANDLE_PT: f32 = 90.0;
/// Turns with Shift go in steps of this.
const STEP_DEGREES: f32 = 15.0;

impl SymmetryAxes {
    /// The point where the axes meet; by default the middle of the canvas.
    pub fn middle(&self, canvas: Size) -> Vec2 {
        self.center.unwrap_or(canvas.center())
    }

    /// With its numbers within their ranges.
    pub fn clamp_to_ranges(self) -> Self {
        let place =
            |p: Vec2| vec2(clamp_to_range(p.x, &COORDINATE), clamp_to_range(p.y, &COORDINATE));
        Self { center: self.center.map(place), turn: clamp_to_range(self.turn, &TURNS) }
    }

    fn rotation(&self) -> Mat2 {
        // y points down, so counter-clockwise as seen is a negative angle.
        if self.turn == 0.0 { Mat2::IDENTITY } else { Mat2::from_angle(-self.turn.to_radians()) }
    }

    /// The middle, and the end of the upright axis, canvas px.
    pub fn handles(&self, canvas: Size, px_per_pt: f32) -> [Vec2; 2] {
        let middle = self.middle(canvas);
        [middle, middle - self.rotation() * Vec2::Y * HANDLE_PT * px_per_pt]
    }

    /// The handle at a point, within so many px of the canvas, if there are axes.
    pub fn handle_at(
        &self,
        symmetry: Symmetry,
        canvas: Size,
        at: Vec2,
        px_per_pt: f32,
        near_px: f32,
    ) -> Option<AxisHandle> {
        let [middle, end] = self.handles(canvas, px_per_pt);
        let near = |handle: Vec2| symmetry != Symmetry::None && handle.distance(at) <= near_px;
        if near(end) { Some(AxisHandle::End) } else { near(middle).then_some(AxisHandle::Middle) }
    }

    /// The axes with a handle at a point; `steps`: only turns by whole steps.
    pub fn dragged(&self, handle: AxisHandle, canvas: Size, at: Vec2, steps: bool) -> Self {
        let next = match handle {
            AxisHandle::Middle => Self { center: Some(at), ..*self },
            AxisHandle::End => {
                let by = at - self.middle(canvas);
                let turn = if by.length() < 1.0 { self.turn } else { turn_of(by) };
                let turn = if steps { (turn / STEP_DEGREES).round() * STEP_DEGREES } else { turn };
                Self { turn, ..*self }
            }
        };
        next.clamp_to_ranges()
    }
}

/// The map of one of the strokes: a turn or mirror about the middle of the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SymmetryImage {
    center: Vec2,
    /// Orthogonal.
    turn: Mat2,
}

impl Symmetry {
    /// The images of a stroke, the stroke itself first.
    pub fn images_about(self, canvas: Size, axes: SymmetryAxes) -> Vec<SymmetryImage> {
        let (center, rotation) = (axes.middle(canvas), axes.rotation());
        let turned = |image: SymmetryImage| {
            let turn = if axes.turn == 0.0 {
                image.turn
            } else {
                rotation * image.turn * rotation.transpose()
            };
            SymmetryImage {
                center,
                turn: if image.turn == Mat2::IDENTITY { image.turn } else { turn },
            }
        };
        self.images(canvas).into_iter().map(turned).collect()
    }

    /// The lines across which strokes repeat, or between the turns; canvas px, as long as the
    /// canvas.
    pub fn lines_about(self, canvas: Size, axes: SymmetryAxes) -> Vec<[Vec2; 2]> {
        let (center, rotation) = (axes.middle(canvas), axes.rotation());
        let moved = |point: Vec2| center + rotation * (point - canvas.center());
        self.axes(canvas).into_iter().map(|line| line.map(moved)).collect()
    }

    /// About the middle of the canvas.
    fn images(self, canvas: Size) -> Vec<SymmetryImage> {
        let mirror = |x: f32, y: f32| Mat2::from_diagonal(Vec2::new(x, y));
        let turns = match self {
            Symmetry::None => vec![Mat2::IDENTITY],
            Symmetry::Vertical => vec![Mat2::IDENTITY, mirror(-1.0, 1.0)],
            Symmetry::Horizontal => vec![Mat2::IDENTITY, mirror(1.0, -1.0)],
            Symmetry::Both => {
                vec![Mat2::IDENTITY, mirror(-1.0, 1.0), mirror(1.0, -1.0), mirror(-1.0, -1.0)]
            }
            Symmetry::Radial(n) => {
                let n = n.clamp(1, MOST_ROUND);
                (0..n)
                    .map(|i| Mat2::from_angle(std::f32::consts::TAU * i as f32 / n as f32))
                    .collect()
            }
        };
        turns.into_iter().map(|turn| SymmetryImage { center: canvas.center(), turn }).collect()
    }

    /// The lines about the middle of the canvas.
    fn axes(self, canvas: Size) -> Vec<[Vec2; 2]> {
        let (middle, reach) = (canvas.center(), canvas.center().length());
        let across = |direction: Vec2| {
            [middle - direction * canvas.center(), middle + direction * canvas.center()]
        };
        match self {
            Symmetry::None => Vec::new(),
            Symmetry::Vertical => vec![across(Vec2::Y)],
            Symmetry::Horizontal => vec![across(Vec2::X)],
            Symmetry::Both => vec![across(Vec2::Y), across(Vec2::X)],
            Symmetry::Radial(n) => {
                let n = n.clamp(1, MOST_ROUND);
                let ray =
                    |i: u32| Vec2::from_angle(std::f32::consts::TAU * (i as f32 / n as f32 - 0.25));
                (0..n).map(|i| [middle, middle + ray(i) * reach]).collect()
            }
        }
    }
}

impl SymmetryImage {
    /// Left and right are exchanged.
    pub fn is_mirrored(&self) -> bool {
        self.turn.determinant() < 0.0
    }

    /// A sample of the stroke as one of the image.
    pub fn sample(&self, sample: &Sample) -> Sample {
        let at = self.center + self.turn * (sample.at - self.center);
        // The stroke itself, to the bit.
        let at = if self.turn == Mat2::IDENTITY { sample.at } else { at };
        Sample { at, tilt: self.turn * sample.tilt, ..*sample }
    }

    /// The brush that paints the image: its dabs are rotated and scattered in the mirrored frame.
    pub fn brush(&self, brush: &Brush) -> Brush {
        Brush { facing: StrokeFrame::of(self.turn * brush.facing.map()), ..brush.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::srgb::Color;
    use crate::paint::stroke::render_tile;
    use crate::paint::{
        Adjust, Curve, Dynamics, Input, PictureSource, Property, Scene, Stroke, Tip,
    };
    use crate::raster::{Picture, TileAt, TileGrid};
    use crate::surface::Operator;
    use std::sync::Arc;

    const CANVAS: Size = Size::new(200, 100);

    fn places(symmetry: Symmetry) -> Vec<Vec2> {
        let sample = Sample { tilt: vec2(30.0, 10.0), ..Sample::at(vec2(120.0, 40.0)) };
        symmetry.images(CANVAS).iter().map(|image| image.sample(&sample).at.round()).collect()
    }

    #[test]
    fn images_stand_across_their_axes_and_round_the_center() {
        assert_eq!(places(Symmetry::None), [vec2(120.0, 40.0)]);
        assert_eq!(places(Symmetry::Vertical), [vec2(120.0, 40.0), vec2(80.0, 40.0)]);
        assert_eq!(places(Symmetry::Horizontal), [vec2(120.0, 40.0), vec2(120.0, 60.0)]);
        assert_eq!(places(Symmetry::Both)[3], vec2(80.0, 60.0));
        let quarter = places(Symmetry::Radial(4));
        assert_eq!(
            quarter,
            [vec2(120.0, 40.0), vec2(110.0, 70.0), vec2(80.0, 60.0), vec2(90.0, 30.0)]
        );
        assert_eq!(Symmetry::Radial(u32::MAX).images(CANVAS).len(), MOST_ROUND as usize);
    }

    #[test]
    fn axes_run_through_the_middle_and_part_the_images() {
        assert_eq!(Symmetry::None.axes(CANVAS).len(), 0);
        assert_eq!(Symmetry::Vertical.axes(CANVAS), [[vec2(100.0, 0.0), vec2(100.0, 100.0)]]);
        assert_eq!(Symmetry::Both.axes(CANVAS)[1], [vec2(0.0, 50.0), vec2(200.0, 50.0)]);
        let rays = Symmetry::Radial(5).axes(CANVAS);
        assert!(rays.len() == 5 && rays.iter().all(|ray| ray[0] == vec2(100.0, 50.0)));
        assert!((rays[0][1].x - 100.0).abs() < 1e-3 && rays[0][1].y < 0.0, "the first goes up");
    }

    #[test]
    fn axes_stay_on_the_picture_when_the_canvas_changes() {
        let upright = SymmetrySettings { kind: Symmetry::Vertical, ..SymmetrySettings::default() };
        let larger = Size::new(260, 100);
        let shift = PlaneMap::translation(vec2(10.0, 0.0));
        let moved = upright.transformed(&shift, [CANVAS, larger]);
        assert_eq!(moved.axes, SymmetryAxes { center: Some(vec2(110.0, 50.0)), turn: 0.0 });
        let centered = PlaneMap::translation(vec2(30.0, 0.0));
        assert_eq!(upright.transformed(&centered, [CANVAS, larger]), upright);
        let leaning = SymmetryAxes { center: Some(vec2(20.0, 30.0)), turn: 25.0 };
        let own = SymmetrySettings { axes: leaning, ..upright };
        let same = own.transformed(&PlaneMap::IDENTITY, [CANVAS, CANVAS]).axes;
        assert!((same.turn - 25.0).abs() < 1e-3 && same.center == leaning.center, "{same:?}");
        assert!(own.fits().is_ok());
        let often = SymmetrySettings { kind: Symmetry::Radial(MOST_ROUND + 1), ..own };
        assert!(often.fits().is_err());
    }

    #[test]
    fn the_pen_leans_the_other_way_in_a_mirror() {
        let image = Symmetry::Vertical.images(CANVAS)[1];
        assert_eq!(
            image.sample(&Sample { tilt: vec2(30.0, 10.0), ..Sample::at(Vec2::ONE) }).tilt,
            vec2(-30.0, 10.0)
        );
    }

    #[test]
    fn brushes_face_as_their_image_does() {
        let facing =
            |symmetry: Symmetry| symmetry.images(CANVAS)[1].brush(&Brush::default()).facing;
        assert_eq!(facing(Symmetry::Vertical), StrokeFrame { turn: 0.0, is_mirrored: true });
        assert_eq!(facing(Symmetry::Horizontal), StrokeFrame { turn: 180.0, is_mirrored: true });
        // A quarter turn to the right, in image axes, is one clockwise as seen.
        assert_eq!(facing(Symmetry::Radial(4)), StrokeFrame { turn: -90.0, is_mirrored: false });
    }

    /// Paint on a level canvas of 200 × 100 px, row by row.
    fn painted(brush: &Brush, samples: &[Sample]) -> Vec<[u8; 4]> {
        let scene = Scene { size: CANVAS, surface: None };
        let stroke =
            [Arc::new(Stroke::new(brush.clone(), Operator::None, Color::BLACK, samples.to_vec()))];
        let mut tiles = TileGrid::default();
        tiles.reserve(CANVAS.rect());
        for at in TileAt::covering(CANVAS.rect()) {
            tiles.set(at, render_tile(&stroke, &scene, at).map(Arc::new));
        }
        (0..100)
            .flat_map(|y| (0..200).map(move |x| (x, y)))
            .map(|(x, y)| tiles.pixel(x, y))
            .collect()
    }

    #[test]
    fn scattered_stamps_that_turn_with_the_stroke_are_mirrored_pixel_by_pixel() {
        let texel =
            |x: i32, y: i32| if x < 16 && y < 8 { [255, 0, 0, 255] } else { [0, 90, 200, 255] };
        let texels = (0..16).flat_map(|y| (0..32).map(move |x| texel(x, y))).collect();
        let picture = Picture::srgb8(Size::new(32, 16), texels).unwrap();
        let brush = Brush {
            size: 24.0,
            rotation: 30.0,
            scatter: 0.8,
            spacing: 1.5,
            seed: 7,
            tip: Tip::Picture(PictureSource::new("flag.png".into(), picture, Adjust::default())),
            dynamics: Dynamics::none().with(
                Property::Rotation,
                Input::Direction,
                Curve::Share(1.0),
            ),
            ..Brush::default()
        };
        let samples: Vec<Sample> =
            [(20.0, 30.0), (50.0, 40.0), (70.0, 80.0)].map(|(x, y)| Sample::at(vec2(x, y))).into();
        let image = Symmetry::Vertical.images(CANVAS)[1];
        let drawn = painted(&brush, &samples);
        let mirrored: Vec<Sample> = samples.iter().map(|sample| image.sample(sample)).collect();
        let mirrored = painted(&image.brush(&brush), &mirrored);
        let across = |i: usize| i / 200 * 200 + 199 - i % 200;
        let worst = drawn.iter().enumerate().flat_map(|(i, p)| (0..4).map(move |c| (i, c, p[c])));
        let worst = worst.map(|(i, c, v)| v.abs_diff(mirrored[across(i)][c])).max();
        assert!(worst <= Some(1), "{worst:?}");
        assert!(drawn.iter().filter(|p| p[0] > 200).count() > 50, "the flag's corner shows");
    }
}
