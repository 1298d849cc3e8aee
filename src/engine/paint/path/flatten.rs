//! Paths as polygons: curves in straight pieces, for selections and strokes along them. Floor 3.

use super::live_path::LivePath;
use super::subpath::even_point_at;
use crate::math::Vec2;

/// How far a straight piece may run from its curve, px.
const ERROR_PX: f32 = 0.05;

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
        let lines = self.subpaths();
        let flat = lines.iter().map(|line| {
            let mut out = FlatLine::default();
            if let Some(first) = line.nodes.first() {
                out.points.push(map(first.at)?);
                out.widths.push(first.width);
            }
            for (i, curve) in line.curves().enumerate() {
                let [a, b] = line.ends(i).map(|node| node.width);
                let moved = [map(curve[0])?, map(curve[1])?, map(curve[2])?, map(curve[3])?];
                let pieces = count_pieces(moved);
                for piece in 1..=pieces {
                    let t = piece as f32 / pieces as f32;
                    out.points.push(map(even_point_at(curve, t))?);
                    out.widths.push(a + (b - a) * t);
                }
            }
            Some(out)
        });
        flat.flatten().collect()
    }
}

/// Enough pieces that none runs farther from its curve than is allowed.
fn count_pieces([a, b, c, d]: [Vec2; 4]) -> usize {
    // A cubic differs from its chord by at most an eighth of its second derivative.
    let bend = (a - 2.0 * b + c).length().max((b - 2.0 * c + d).length());
    (0.75 * bend / ERROR_PX).sqrt().ceil().max(1.0).min(MOST_PIECES) as usize
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
    fn a_line_beyond_a_horizon_is_left_out() {
        let line = Figure { kind: FigureKind::Line, to: vec2(9.0, 0.0), ..Figure::DEFAULT };
        let map = |p: Vec2| (p.x < 5.0).then_some(p);
        assert!(LivePath::new(line).flatten(map).is_empty());
    }
}
