//! Paths as polygons: curves in straight pieces, for selections and strokes along them. Floor 3.

use super::live_path::LivePath;
use super::subpath::{Subpath, even_point_at};
use crate::math::Vec2;

/// How far a straight piece may run from its curve, px.
const ERROR_PX: f32 = 0.05;

/// The same where exact areas are wanted: a whole circle's area is then one of 255 off in the pixels
/// of its edge.
const AREA_ERROR_PX: f32 = 1.0 / 256.0;

/// The most pieces of a curve.
const MOST_PIECES: f32 = 512.0;

/// A line in straight pieces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlatLine {
    /// Its corners; those of a closed one end where they begin.
    pub points: Vec<Vec2>,
    /// How wide the outline is at each of them, by its own width.
    pub widths: Vec<f32>,
}

impl LivePath {
    /// Its lines in straight pieces, each point moved by a map, such as onto the canvas. Lines with
    /// a point that the map has none for are left out.
    pub fn flatten(&self, map: impl Fn(Vec2) -> Option<Vec2>) -> Vec<FlatLine> {
        self.subpaths().iter().filter_map(|line| line.flatten(&map)).collect()
    }

    /// The same in pieces so short that areas between them are exact.
    pub fn flatten_for_area(&self, map: impl Fn(Vec2) -> Option<Vec2>) -> Vec<Vec<Vec2>> {
        let flat = |line: &Subpath| Some(line.flatten_within(AREA_ERROR_PX, &map)?.points);
        self.subpaths().iter().filter_map(flat).collect()
    }
}

impl Subpath {
    /// The line in straight pieces, each point moved by a map; `None` where the map has none for
    /// one.
    pub fn flatten(&self, map: &impl Fn(Vec2) -> Option<Vec2>) -> Option<FlatLine> {
        self.flatten_within(ERROR_PX, map)
    }

    fn flatten_within(
        &self,
        error_px: f32,
        map: &impl Fn(Vec2) -> Option<Vec2>,
    ) -> Option<FlatLine> {
        let mut out = FlatLine::default();
        if let Some(first) = self.nodes.first() {
            out.points.push(map(first.at)?);
            out.widths.push(first.width);
        }
        for (i, curve) in self.curves().enumerate() {
            let [a, b] = self.ends(i).map(|node| node.width);
            let moved = [map(curve[0])?, map(curve[1])?, map(curve[2])?, map(curve[3])?];
            let pieces = count_pieces(moved, error_px);
            for piece in 1..=pieces {
                let t = piece as f32 / pieces as f32;
                out.points.push(map(even_point_at(curve, t))?);
                out.widths.push(a + (b - a) * t);
            }
        }
        Some(out)
    }
}

/// A place on a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePlace {
    /// Where it is.
    pub at: Vec2,
    /// Where the line goes there, of length 1.
    pub direction: Vec2,
    /// How far it is along the line, px.
    pub along: f32,
}

impl FlatLine {
    /// Its straight pieces that have a length: where each begins along the line, its ends and its
    /// direction.
    fn pieces(&self) -> impl Iterator<Item = (f32, [Vec2; 2], Vec2)> + '_ {
        let mut along = 0.0;
        self.points.windows(2).filter_map(move |ends| {
            let (from, length) = (along, ends[0].distance(ends[1]));
            along += length;
            (length > 0.0).then(|| (from, [ends[0], ends[1]], (ends[1] - ends[0]) / length))
        })
    }

    /// Its length, px.
    pub fn length(&self) -> f32 {
        self.pieces().last().map_or(0.0, |(from, [a, b], _)| from + a.distance(b))
    }

    /// The place so many px along it; beyond its ends it goes straight on. `None` for a point.
    pub fn place_at(&self, along: f32) -> Option<LinePlace> {
        let mut pieces = self.pieces().peekable();
        let first = *pieces.peek()?;
        let (from, [a, _], direction) =
            pieces.take_while(|(from, ..)| *from <= along).last().unwrap_or(first);
        Some(LinePlace { at: a + direction * (along - from), direction, along })
    }

    /// Its place that is nearest to a point. `None` for a line that is a point.
    pub fn nearest_place(&self, to: Vec2) -> Option<LinePlace> {
        let places = self.pieces().map(|(from, [a, b], direction)| {
            let along = (to - a).dot(direction).max(0.0).min(a.distance(b));
            LinePlace { at: a + direction * along, direction, along: from + along }
        });
        places.min_by(|a, b| a.at.distance_squared(to).total_cmp(&b.at.distance_squared(to)))
    }
}

/// Enough pieces that none runs farther from its curve than is allowed.
fn count_pieces([a, b, c, d]: [Vec2; 4], error_px: f32) -> usize {
    // A cubic differs from its chord by at most an eighth of its second derivative.
    let bend = (a - 2.0 * b + c).length().max((b - 2.0 * c + d).length());
    (0.75 * bend / error_px).sqrt().ceil().max(1.0).min(MOST_PIECES) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use crate::paint::path::{Figure, FigureKind};

    #[test]
    fn pieces_of_a_circle_run_within_a_twentieth_of_a_pixel() {
        let (from, to) = (vec2(10.0, 10.0), vec2(210.0, 210.0));
        let circle = Figure { kind: FigureKind::Ellipse, from, to, ..Figure::DEFAULT };
        let lines = LivePath::new(circle).flatten(Some);
        let points = &lines[0].points;
        assert_eq!(points.first(), points.last());
        for pair in points.windows(2) {
            let apart = (0.5 * (pair[0] + pair[1])).distance(vec2(110.0, 110.0)) - 100.0;
            assert!(apart.abs() < 0.08, "{apart}");
        }
        assert!(points.len() < 130, "{}", points.len());
    }

    #[test]
    fn places_along_a_line_and_nearest_to_points_agree() {
        let corner = [vec2(0.0, 0.0), vec2(3.0, 0.0), vec2(3.0, 0.0), vec2(3.0, 4.0)];
        let line = FlatLine { points: corner.to_vec(), widths: vec![1.0; 4] };
        assert_eq!(line.length(), 7.0);
        let place = line.place_at(5.0).unwrap();
        assert_eq!((place.at, place.direction), (vec2(3.0, 2.0), vec2(0.0, 1.0)));
        assert_eq!(line.place_at(-1.0).unwrap().at, vec2(-1.0, 0.0));
        assert_eq!(line.place_at(9.0).unwrap().at, vec2(3.0, 6.0));
        assert_eq!(line.nearest_place(vec2(5.0, 2.0)), Some(place));
        let point = FlatLine { points: corner[1..3].to_vec(), widths: vec![1.0; 2] };
        assert!(point.place_at(0.0).is_none() && point.nearest_place(Vec2::ZERO).is_none());
        assert_eq!(point.length(), 0.0);
    }

    #[test]
    fn a_line_beyond_a_horizon_is_left_out() {
        let line = Figure { kind: FigureKind::Line, to: vec2(9.0, 0.0), ..Figure::DEFAULT };
        let map = |p: Vec2| (p.x < 5.0).then_some(p);
        assert!(LivePath::new(line).flatten(map).is_empty());
    }
}
