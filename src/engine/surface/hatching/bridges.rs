//! Short pieces between lines of hatching that end face to face. Where neighbors come near, lines end,
//! and begin anew where there is room again: side by side, such gaps are seen as a hole. Floor 2.

use crate::math::Vec2;
use crate::surface::line_ends::{JoinedEnds, LineEnd, LineGap};
use std::collections::HashMap;

/// The widest gap, in distances of the lines, and the least cosine of its angles: 20°.
const GAP: f32 = 3.0;
const GAP_COS: f32 = 0.94;
/// Points of a ring that are drawn twice, so that its ends lie on each other.
const OVERLAP: usize = 12;

/// What lies between two ends.
pub struct Bridge {
    /// Where it begins.
    pub from: LineEnd,
    /// Where it ends.
    pub to: LineEnd,
    /// Its points between both, a pixel apart.
    pub points: Vec<Vec2>,
}

impl Bridge {
    /// A curve that leaves both lines in their directions (a cubic Hermite spline).
    fn between(from: LineEnd, to: LineEnd) -> Self {
        let gap = from.at.distance(to.at);
        let (out, into) = (from.out * gap, -to.out * gap);
        let steps = gap.ceil().max(1.0);
        let point = |i: usize| {
            let t = i as f32 / steps;
            let (t2, t3) = (t * t, t * t * t);
            from.at * (2.0 * t3 - 3.0 * t2 + 1.0)
                + out * (t3 - 2.0 * t2 + t)
                + to.at * (3.0 * t2 - 2.0 * t3)
                + into * (t3 - t2)
        };
        Self { from, to, points: (1..steps as usize).map(point).collect() }
    }
}

/// All bridges of the lines of one family.
#[derive(Default)]
pub struct Bridges {
    joined: JoinedEnds,
    /// The points beyond an end: of which line, and whether of its last point.
    points: HashMap<(usize, bool), Vec<Vec2>>,
}

impl Bridges {
    /// Joins ends of lines of one level.
    ///
    /// * `apart`: the distance of its lines, px.
    /// * `try_bridge`: whether a bridge can stay; it is placed then.
    pub fn join(
        &mut self,
        ends: &[LineEnd],
        apart: f32,
        mut try_bridge: impl FnMut(&Bridge) -> bool,
    ) {
        let gap = LineGap { px: GAP * apart, cos: GAP_COS };
        let points = &mut self.points;
        self.joined.join(ends, gap, |a, b| {
            let bridge = Bridge::between(*a, *b);
            let is_possible = try_bridge(&bridge);
            if is_possible {
                let back = bridge.points.iter().rev().copied().collect();
                points.insert((a.line, a.is_last), bridge.points);
                points.insert((b.line, b.is_last), back);
            }
            is_possible
        });
    }

    /// Lines, each with its level, strung together over the bridges.
    pub fn string_lines(&self, lines: Vec<(u8, Vec<Vec2>)>) -> Vec<(u8, Vec<Vec2>)> {
        let strung = self.joined.string_lines(lines.len());
        let whole = strung.into_iter().map(|line| {
            let mut points = Vec::new();
            for (i, (part, is_reversed)) in line.parts.iter().enumerate() {
                let own = &lines[*part].1;
                match is_reversed {
                    false => points.extend(own.iter().copied()),
                    true => points.extend(own.iter().rev().copied()),
                }
                let goes_on = i + 1 < line.parts.len() || line.is_closed;
                if let Some(bridge) = self.points.get(&(*part, !is_reversed)).filter(|_| goes_on) {
                    points.extend(bridge.iter().copied());
                }
            }
            if line.is_closed {
                points.extend_from_within(..OVERLAP.min(points.len()));
            }
            (lines[line.parts[0].0].0, points)
        });
        whole.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    fn straight(y: f32, from: i32, to: i32) -> (u8, Vec<Vec2>) {
        (2, (from..to).map(|x| vec2(x as f32, y)).collect())
    }

    #[test]
    fn lines_that_end_face_to_face_go_on_in_each_other_without_a_gap() {
        let lines = vec![straight(0.0, 0, 20), straight(1.0, 28, 50), straight(9.0, 0, 50)];
        let ends = |i: usize| LineEnd::both_of(i, lines[i].1.iter().copied());
        let ends: Vec<LineEnd> = (0..3).flat_map(ends).collect();
        let mut bridges = Bridges::default();
        bridges.join(&ends, 4.0, |_| true);
        let strung = bridges.string_lines(lines.clone());
        assert_eq!(strung.len(), 2);
        assert_eq!(strung[1], lines[2]);
        let steps = strung[0].1.windows(2).map(|pair| pair[0].distance(pair[1]));
        let farthest = steps.fold(0.0, f32::max);
        assert!(strung[0].1.len() >= 50 && farthest < 1.3, "{farthest}");

        // Where another line is in the way, both end.
        let mut bridges = Bridges::default();
        bridges.join(&ends, 4.0, |_| false);
        assert_eq!(bridges.string_lines(lines.clone()), lines);
    }
}
