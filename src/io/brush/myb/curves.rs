//! MyPaint's inputs and curves in this program's terms: inputs from 0 to 1, and what is added along
//! them. Floor 5.

use crate::math::{Vec2, vec2};
use crate::paint::dynamics::{Input, MAX_POINTS, px_per_sec_of};
use serde_json::Value;

/// The scales of the inputs.
#[derive(Clone, Copy, Default)]
pub struct Scales {
    /// ln of the radius without what drives it.
    pub radius: f32,
    /// e^gamma for each of the two speeds.
    pub gammas: [f32; 2],
    pub pressure: f32,
    /// The custom input at 0 and at 1 of ours.
    pub custom: [f32; 2],
}
/// Straight pieces by which a bent way is followed.
pub const STEPS: usize = 40;
/// How far from a step its two ends are sampled.
const BESIDE: f32 = 1e-4;
impl Scales {
    /// Which of our inputs is one of theirs, and how it runs.
    pub fn way(&self, input: &str) -> Option<InputMapping> {
        let Scales { radius, gammas, pressure, custom } = *self;
        let whole = |input, x: [f32; 2]| {
            Some(InputMapping::Runs(input, vec![CurvePiece::straight([0.0, 1.0], x)]))
        };
        let paces = |input, gamma| {
            Some(InputMapping::Runs(
                input,
                vec![CurvePiece { t: [0.0, 1.0], x: Course::Speed { gamma } }],
            ))
        };
        match input {
            "pressure" => whole(Input::Pressure, [0.0, pressure]),
            "random" => whole(Input::Chance, [0.0, 1.0]),
            "custom" => whole(Input::Custom, custom),
            "stroke" => whole(Input::Cycle, [0.0, 1.0]),
            "speed1" => paces(Input::Pace, gammas[0]),
            "speed2" => paces(Input::SlowPace, gammas[1]),
            // Clockwise, and the same for both ways along a line.
            "direction" => {
                let half = |from: f32| CurvePiece::straight([from, from + 0.5], [180.0, 0.0]);
                Some(InputMapping::Runs(Input::Direction, vec![half(0.0), half(0.5)]))
            }
            "direction_angle" => whole(Input::Direction, [360.0, 0.0]),
            "tilt_declination" => whole(Input::Tilt, [90.0, 0.0]),
            // 0 for an upright pen, a quarter turn from where ours leans then; else clockwise from
            // below.
            "tilt_ascension" => {
                let upright = CurvePiece::straight([0.0, 0.0], [0.0, 0.0]);
                let (right, rest) =
                    (CurvePiece::straight([0.0, 0.25], [-90.0, -180.0]), [180.0, -90.0]);
                Some(InputMapping::Runs(
                    Input::TiltDirection,
                    vec![upright, right, CurvePiece::straight([0.25, 1.0], rest)],
                ))
            }
            "attack_angle" => whole(Input::Attack, [-180.0, 180.0]),
            "brush_radius" => Some(InputMapping::Still(radius)),
            // In its own size, not rotated.
            "viewzoom" | "barrel_rotation" => Some(InputMapping::Still(0.0)),
            _ => None,
        }
    }
}

/// How one of their inputs relates to ours.
pub enum InputMapping {
    /// Always this value.
    Still(f32),
    Runs(Input, Vec<CurvePiece>),
}

/// A piece of an input's way: from `t[0]` to `t[1]` of ours.
pub struct CurvePiece {
    t: [f32; 2],
    x: Course,
}

/// Their value at that place.
enum Course {
    Straight([f32; 2]),
    /// Speeds over a logarithm: 0.5 at 45 px a second, rising by 0.015 a px there.
    Speed {
        gamma: f32,
    },
}

impl CurvePiece {
    fn straight(t: [f32; 2], x: [f32; 2]) -> Self {
        Self { t, x: Course::Straight(x) }
    }

    /// Theirs at a share of the piece.
    fn at(&self, s: f32) -> f32 {
        match self.x {
            Course::Straight([from, to]) => from + (to - from) * s,
            Course::Speed { gamma } => {
                let slope = 0.015 * (45.0 + gamma);
                0.5 + slope * ((gamma + px_per_sec_of(s)) / (gamma + 45.0)).ln()
            }
        }
    }

    /// The shares at which a curve through these points is looked at.
    fn shares(&self, points: &[Vec2]) -> Vec<f32> {
        let inner = |x: f32| match self.x {
            Course::Straight([from, to]) => (x - from) / (to - from),
            // It rises: halve until it is found.
            Course::Speed { .. } => {
                let halve = |(low, high): (f32, f32), _| {
                    let middle = 0.5 * (low + high);
                    if self.at(middle) < x { (middle, high) } else { (low, middle) }
                };
                (0..24).fold((0.0, 1.0), halve).0
            }
        };
        let steps = if matches!(self.x, Course::Straight(_)) { 1 } else { STEPS };
        let corners =
            points.iter().map(|p| inner(p.x)).filter(|s| (0.0..=1.0).contains(s)).take(16);
        // Where two points share a position the curve steps: it is sampled on both sides.
        let steep =
            points.windows(2).filter(|pair| pair[0].x == pair[1].x).map(|pair| inner(pair[0].x));
        let sides = steep
            .flat_map(|s| [s - BESIDE, s + BESIDE])
            .filter(|s| (0.0..=1.0).contains(s))
            .take(16);
        let even = (0..=steps).map(|i| i as f32 / steps as f32);
        let mut shares: Vec<f32> = even.chain(corners).chain(sides).collect();
        shares.sort_by(f32::total_cmp);
        shares.dedup();
        shares
    }
}

pub fn number(value: &Value) -> Option<f32> {
    value.as_f64().map(|v| v as f32).filter(|v| v.abs() < 1e6)
}

/// A curve's points from left to right; `None` if it adds nothing.
pub fn curve_of(points: &Value) -> Option<Vec<Vec2>> {
    let points = points.as_array()?.iter().take(MAX_POINTS);
    let points = points.filter_map(|p| Some(vec2(number(p.get(0)?)?, number(p.get(1)?)?)));
    let mut points: Vec<Vec2> = points.collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x));
    points.iter().any(|p| p.y != 0.0).then_some(points)
}

/// A curve of theirs: straight between its points, and straight on beyond them.
pub fn at(points: &[Vec2], x: f32) -> f32 {
    let inner = points.iter().skip(1).take(points.len().saturating_sub(2));
    // The piece that contains it: the first whose end is not before it, else the last.
    let i = inner.take_while(|p| x > p.x).count();
    match points.get(i..) {
        Some(&[from, to, ..]) if to.x > from.x => {
            from.y + (to.y - from.y) * (x - from.x) / (to.x - from.x)
        }
        Some(&[from, ..]) => from.y,
        _ => 0.0,
    }
}

/// A curve of ours: level beyond its ends.
pub fn level(points: &[Vec2], x: f32) -> f32 {
    match (points.first(), points.last()) {
        (Some(first), _) if x <= first.x => first.y,
        (_, Some(last)) if x >= last.x => last.y,
        _ => at(points, x),
    }
}

/// A curve of theirs over an input of ours.
pub fn sample_curve(pieces: &[CurvePiece], points: &[Vec2]) -> Vec<Vec2> {
    let of_piece = |piece: &CurvePiece| {
        let [from, to] = piece.t;
        let shares = piece.shares(points);
        shares
            .into_iter()
            .map(|s| vec2((from + (to - from) * s).max(0.0).min(1.0), at(points, piece.at(s))))
            .collect()
    };
    pieces.iter().flat_map(|piece| -> Vec<Vec2> { of_piece(piece) }).collect()
}

/// Two curves added.
pub fn add_curves(a: &[Vec2], b: &[Vec2]) -> Vec<Vec2> {
    let mut places: Vec<f32> = a.iter().chain(b).map(|p| p.x).collect();
    places.sort_by(f32::total_cmp);
    places.dedup();
    places.into_iter().map(|x| vec2(x, level(a, x) + level(b, x))).collect()
}

/// Without the points that lie on the line between their neighbors, to a five hundredth of all
/// that the curve spans.
pub fn straightened(points: &[Vec2]) -> Vec<Vec2> {
    let (least, most) = points
        .iter()
        .fold((f32::MAX, f32::MIN), |(least, most), p| (least.min(p.y), most.max(p.y)));
    let near = 0.002 * (most - least).max(1e-6);
    let mut out: Vec<Vec2> = Vec::new();
    let mut start = 0;
    for (i, &point) in points.iter().enumerate() {
        let (before, next) = (points[start], points.get(i + 1).copied());
        // All that were left out since the last one count: small bends must not add up.
        let is_between = i > 0
            && next.is_some_and(|next| {
                let width = next.x - before.x;
                let off =
                    |p: &Vec2| before.y + (next.y - before.y) * (p.x - before.x) / width - p.y;
                width > 0.0 && points[start + 1..=i].iter().all(|p| off(p).abs() <= near)
            });
        if !is_between {
            out.push(point);
            start = i;
        }
    }
    out.truncate(MAX_POINTS);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_go_straight_on_beyond_their_points() {
        let points = [vec2(0.2, 0.0), vec2(0.6, 1.0), vec2(0.8, 1.5)];
        for (x, y) in [(0.0, -0.5), (0.2, 0.0), (0.4, 0.5), (0.7, 1.25), (1.0, 2.0)] {
            assert!((at(&points, x) - y).abs() < 1e-5, "{x}: {}", at(&points, x));
        }
        assert_eq!((at(&points[..1], 7.0), at(&[], 7.0)), (0.0, 0.0));
    }
}
