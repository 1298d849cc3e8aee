//! MyPaint's settings and curves in this program's terms: inputs from 0 to 1, and what is added along them.
//! Floor 5.

use crate::math::{Vec2, vec2};
use crate::paint::dynamics::{Curve, Input, MAX_POINTS, MOST_ADDED, px_per_sec_of};
use serde_json::{Map, Value};
use std::collections::BTreeSet;

/// The settings of a file. Those that are asked for count as carried over; the others are told of.
pub struct MyPaintSettings<'a> {
    all: &'a Map<String, Value>,
    asked: BTreeSet<&'static str>,
    notes: Vec<String>,
    /// The inputs' scales.
    scales: Scales,
}

/// What the inputs are measured by.
#[derive(Clone, Copy, Default)]
struct Scales {
    /// ln of the radius without what drives it.
    radius: f32,
    /// Of each of the two speeds, e^gamma.
    gammas: [f32; 2],
    pressure: f32,
    /// The custom input at 0 and at 1 of ours.
    custom: [f32; 2],
}

/// A setting: a base value and what inputs add to it.
#[derive(Clone)]
pub struct Added {
    pub base: f32,
    pub rows: Vec<Row>,
}

/// What an input of ours adds.
#[derive(Clone)]
pub struct Row {
    pub input: Input,
    /// From left to right.
    points: Vec<Vec2>,
}

/// Settings that say nothing about the mark, or only what is this program's own business.
const OF_NO_MATTER: [&str; 9] = [
    "anti_aliasing",
    "color_h",
    "color_s",
    "color_v",
    "restore_color",
    "gridmap_scale",
    "gridmap_scale_x",
    "gridmap_scale_y",
    "paint_mode",
];

/// Straight pieces by which a bent way is followed.
const STEPS: usize = 40;
/// How far beside a step its two ends are looked at.
const BESIDE: f32 = 1e-4;

impl<'a> MyPaintSettings<'a> {
    pub fn new(all: &'a Map<String, Value>) -> Self {
        let mut settings = Self { all, asked: BTreeSet::new(), notes: Vec::new(), scales: Scales::default() };
        let mut base = |name, default| settings.base(name, default);
        settings.scales = Scales {
            radius: base("radius_logarithmic", 2.0),
            gammas: [base("speed1_gamma", 4.0), base("speed2_gamma", 4.0)].map(f32::exp),
            pressure: base("pressure_gain_log", 0.0).exp(),
            custom: [0.0, 1.0],
        };
        settings
    }
    pub fn note(&mut self, note: &str) {
        if !self.notes.iter().any(|known| known == note) {
            self.notes.push(note.to_owned());
        }
    }
    /// A setting without what drives it; a damaged number is as good as none.
    pub fn base(&mut self, name: &'static str, default: f32) -> f32 {
        self.asked.insert(name);
        self.all.get(name).and_then(|value| number(value.get("base_value")?)).unwrap_or(default)
    }
    pub fn has(&self, name: &str) -> bool {
        self.all.contains_key(name)
    }
    /// Something drives a setting.
    pub fn is_driven(&self, name: &str) -> bool {
        let inputs = self.all.get(name).and_then(|value| value.get("inputs")?.as_object());
        inputs.into_iter().flatten().any(|(_, points)| curve_of(points).is_some())
    }
    /// A setting that nothing can drive here, where what drives it is halfway; that is told of.
    pub fn plain(&mut self, name: &'static str, default: f32) -> f32 {
        let added = self.added(name, default);
        if !added.rows.is_empty() {
            self.note(&format!("“{name}” follows nothing here"));
        }
        added.base + added.rows.iter().map(|row| level(&row.points, 0.5)).sum::<f32>()
    }
    /// A setting with all that adds to it. Inputs that never change are part of its base.
    pub fn added(&mut self, name: &'static str, default: f32) -> Added {
        let mut added = Added { base: self.base(name, default), rows: Vec::new() };
        let value = self.all.get(name);
        let inputs = value.and_then(|value| value.get("inputs")?.as_object());
        for (input, points) in inputs.into_iter().flatten() {
            let Some(points) = curve_of(points) else { continue };
            match self.way(input) {
                Some(Way::Still(x)) => added.base += at(&points, x),
                Some(Way::Runs(input, pieces)) => added.add(Row { input, points: sampled(&pieces, &points) }),
                None => {
                    let input: String = input.chars().filter(|c| !c.is_control()).take(60).collect();
                    self.note(&format!("“{name}” does not follow “{input}”"));
                }
            }
        }
        added
    }
    /// What a setting that follows the pressure from nothing adds.
    pub fn pressure(&self) -> Added {
        let points = vec![vec2(0.0, 0.0), vec2(1.0, self.scales.pressure)];
        Added { base: 0.0, rows: vec![Row { input: Input::Pressure, points }] }
    }
    /// The setting that drives the custom input, as what it adds to our own, which runs from 0 to 1.
    pub fn custom(&mut self) -> Added {
        if !self.is_driven("custom_input") {
            return Added { base: self.base("custom_input", 0.0), rows: Vec::new() };
        }
        let custom = self.added("custom_input", 0.0);
        let [least, most] = custom.range();
        if most > least {
            self.scales.custom = [least, most];
        }
        let width = if most > least { most - least } else { 1.0 };
        Added { base: custom.base - least, ..custom }.times(1.0 / width)
    }
    /// Which of our inputs is one of theirs, and how it runs.
    fn way(&self, input: &str) -> Option<Way> {
        let Scales { radius, gammas, pressure, custom } = self.scales;
        let whole = |input, x: [f32; 2]| Some(Way::Runs(input, vec![CurvePiece::straight([0.0, 1.0], x)]));
        let paces =
            |input, gamma| Some(Way::Runs(input, vec![CurvePiece { t: [0.0, 1.0], x: Course::Speed { gamma } }]));
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
                Some(Way::Runs(Input::Direction, vec![half(0.0), half(0.5)]))
            }
            "direction_angle" => whole(Input::Direction, [360.0, 0.0]),
            "tilt_declination" => whole(Input::Tilt, [90.0, 0.0]),
            // Of an upright pen 0, which is a quarter turn from where ours leans then; else clockwise from below.
            "tilt_ascension" => {
                let upright = CurvePiece::straight([0.0, 0.0], [0.0, 0.0]);
                let (right, rest) = (CurvePiece::straight([0.0, 0.25], [-90.0, -180.0]), [180.0, -90.0]);
                Some(Way::Runs(Input::TiltDirection, vec![upright, right, CurvePiece::straight([0.25, 1.0], rest)]))
            }
            "attack_angle" => whole(Input::Attack, [-180.0, 180.0]),
            "brush_radius" => Some(Way::Still(radius)),
            // As large as it is, not turned.
            "viewzoom" | "barrel_rotation" => Some(Way::Still(0.0)),
            _ => None,
        }
    }
    /// What was noted, and the settings that nothing asked for though they do something.
    pub fn into_notes(mut self) -> Vec<String> {
        let all = self.all;
        for (name, value) in all {
            let known = self.asked.contains(name.as_str()) || OF_NO_MATTER.contains(&name.as_str());
            let base = value.get("base_value").and_then(number).unwrap_or(0.0);
            if !known && (self.is_driven(name) || base != 0.0) {
                let name: String = name.chars().filter(|c| !c.is_control()).take(60).collect();
                self.note(&format!("“{name}” has no counterpart"));
            }
        }
        self.notes
    }
    /// What the first of these says counts as carried over where the second is idle.
    pub fn of_no_use(&mut self, names: &[&'static str]) {
        self.asked.extend(names);
    }
}

impl Added {
    fn add(&mut self, row: Row) {
        match self.rows.iter_mut().find(|known| known.input == row.input) {
            Some(known) => known.points = summed(&known.points, &row.points),
            None => self.rows.push(row),
        }
    }
    /// Multiplied as a whole.
    pub fn times(mut self, factor: f32) -> Self {
        self.base *= factor;
        self.rows.iter_mut().flat_map(|row| &mut row.points).for_each(|p| p.y *= factor);
        self
    }
    /// The base within a range; what it loses is added by a row.
    pub fn within(mut self, least: f32, most: f32) -> Self {
        let base = self.base.max(least).min(most);
        let rest = self.base - base;
        if rest != 0.0 && !self.rows.is_empty() {
            self.rows[0].points.iter_mut().for_each(|p| p.y += rest);
        }
        self.base = base;
        self
    }
    /// Its least and its most.
    pub fn range(&self) -> [f32; 2] {
        let ends = |row: &Row| {
            let all = row.points.iter().map(|p| p.y);
            [all.clone().fold(f32::INFINITY, f32::min), all.fold(f32::NEG_INFINITY, f32::max)]
        };
        self.rows.iter().map(ends).fold([self.base; 2], |sum, [least, most]| [sum[0] + least, sum[1] + most])
    }
    /// The value where one input is at a place and all others add nothing.
    pub fn at(&self, row: &Row, x: f32) -> f32 {
        self.base + level(&row.points, x)
    }
}

impl Row {
    /// As a curve that adds; `None` where it adds nothing that can be told.
    pub fn curve(&self) -> Option<Curve> {
        let points = self.points.iter().map(|p| vec2(p.x, p.y.max(-MOST_ADDED).min(MOST_ADDED)));
        Curve::added(straightened(&points.collect::<Vec<_>>()))
    }
    /// As a curve of factors; `value`: what a place makes of the whole, `[0, 1]`.
    pub fn factors(&self, value: impl Fn(f32) -> f32) -> Option<Curve> {
        let steps = (0..=STEPS).map(|i| i as f32 / STEPS as f32).chain(self.points.iter().map(|p| p.x));
        let mut places: Vec<f32> = steps.collect();
        places.sort_by(f32::total_cmp);
        places.dedup();
        let points: Vec<Vec2> = places.into_iter().map(|x| vec2(x, value(x).max(0.0).min(1.0))).collect();
        Curve::through(straightened(&points))
    }
}

/// How one of their inputs stands to ours.
enum Way {
    /// It is always this.
    Still(f32),
    Runs(Input, Vec<CurvePiece>),
}

/// A piece of an input's way: from `t[0]` to `t[1]` of ours.
struct CurvePiece {
    t: [f32; 2],
    x: Course,
}

/// What theirs does there.
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
        let corners = points.iter().map(|p| inner(p.x)).filter(|s| (0.0..=1.0).contains(s)).take(16);
        // Where two points stand above each other the curve steps: it is looked at on both sides.
        let steep = points.windows(2).filter(|pair| pair[0].x == pair[1].x).map(|pair| inner(pair[0].x));
        let sides = steep.flat_map(|s| [s - BESIDE, s + BESIDE]).filter(|s| (0.0..=1.0).contains(s)).take(16);
        let even = (0..=steps).map(|i| i as f32 / steps as f32);
        let mut shares: Vec<f32> = even.chain(corners).chain(sides).collect();
        shares.sort_by(f32::total_cmp);
        shares.dedup();
        shares
    }
}

fn number(value: &Value) -> Option<f32> {
    value.as_f64().map(|v| v as f32).filter(|v| v.abs() < 1e6)
}

/// A curve's points from left to right; `None` of one that adds nothing.
fn curve_of(points: &Value) -> Option<Vec<Vec2>> {
    let points = points.as_array()?.iter().take(MAX_POINTS);
    let points = points.filter_map(|p| Some(vec2(number(p.get(0)?)?, number(p.get(1)?)?)));
    let mut points: Vec<Vec2> = points.collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x));
    points.iter().any(|p| p.y != 0.0).then_some(points)
}

/// A curve of theirs: straight between its points, and straight on beyond them.
fn at(points: &[Vec2], x: f32) -> f32 {
    let inner = points.iter().skip(1).take(points.len().saturating_sub(2));
    // The piece it lies on: the first whose end is not before it, else the last.
    let i = inner.take_while(|p| x > p.x).count();
    match points.get(i..) {
        Some(&[from, to, ..]) if to.x > from.x => from.y + (to.y - from.y) * (x - from.x) / (to.x - from.x),
        Some(&[from, ..]) => from.y,
        _ => 0.0,
    }
}

/// A curve of ours: level beyond its ends.
fn level(points: &[Vec2], x: f32) -> f32 {
    match (points.first(), points.last()) {
        (Some(first), _) if x <= first.x => first.y,
        (_, Some(last)) if x >= last.x => last.y,
        _ => at(points, x),
    }
}

/// A curve of theirs over an input of ours.
fn sampled(pieces: &[CurvePiece], points: &[Vec2]) -> Vec<Vec2> {
    let of_piece = |piece: &CurvePiece| {
        let [from, to] = piece.t;
        let shares = piece.shares(points);
        shares.into_iter().map(|s| vec2((from + (to - from) * s).max(0.0).min(1.0), at(points, piece.at(s)))).collect()
    };
    pieces.iter().flat_map(|piece| -> Vec<Vec2> { of_piece(piece) }).collect()
}

/// Two curves added.
fn summed(a: &[Vec2], b: &[Vec2]) -> Vec<Vec2> {
    let mut places: Vec<f32> = a.iter().chain(b).map(|p| p.x).collect();
    places.sort_by(f32::total_cmp);
    places.dedup();
    places.into_iter().map(|x| vec2(x, level(a, x) + level(b, x))).collect()
}

/// Without the points that lie on the line between their neighbours, to a five hundredth of all that the curve spans.
fn straightened(points: &[Vec2]) -> Vec<Vec2> {
    let (least, most) = points.iter().fold((f32::MAX, f32::MIN), |(least, most), p| (least.min(p.y), most.max(p.y)));
    let near = 0.002 * (most - least).max(1e-6);
    let mut out: Vec<Vec2> = Vec::new();
    let mut start = 0;
    for (i, &point) in points.iter().enumerate() {
        let (before, next) = (points[start], points.get(i + 1).copied());
        // All that were left out since the last one count: small bends must not add up.
        let is_between = i > 0
            && next.is_some_and(|next| {
                let width = next.x - before.x;
                let off = |p: &Vec2| before.y + (next.y - before.y) * (p.x - before.x) / width - p.y;
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

    fn settings(text: &str) -> Value {
        serde_json::from_str(text).unwrap()
    }
    fn added(text: &str, name: &'static str) -> Added {
        let value = settings(text);
        MyPaintSettings::new(value.as_object().unwrap()).added(name, 0.0)
    }

    #[test]
    fn what_inputs_add_is_kept_for_every_one_of_them() {
        let text = r#"{ "r": { "base_value": 2, "inputs": {
            "pressure": [[0, -1], [1, 1]], "random": [[0, -0.5], [1, 0]], "brush_radius": [[0, 0], [4, 2]] } } }"#;
        let found = added(text, "r");
        assert_eq!(found.base, 3.0, "the radius is 2, which adds 1");
        assert_eq!(found.range(), [1.5, 4.0]);
        let of = |input| found.rows.iter().find(|row| row.input == input).unwrap().curve().unwrap();
        assert_eq!(of(Input::Pressure).at(0.25), -0.5);
        assert_eq!(of(Input::Chance).at(0.5), -0.25);
    }
    #[test]
    fn curves_go_straight_on_beyond_their_points() {
        let points = [vec2(0.2, 0.0), vec2(0.6, 1.0), vec2(0.8, 1.5)];
        for (x, y) in [(0.0, -0.5), (0.2, 0.0), (0.4, 0.5), (0.7, 1.25), (1.0, 2.0)] {
            assert!((at(&points, x) - y).abs() < 1e-5, "{x}: {}", at(&points, x));
        }
        assert_eq!((at(&points[..1], 7.0), at(&[], 7.0)), (0.0, 0.0));
    }
    #[test]
    fn a_step_stays_a_step() {
        let text =
            r#"{ "a": { "base_value": 0, "inputs": { "pressure": [[0, 0], [0.015, 0], [0.015, 1], [1, 1]] } } }"#;
        let curve = added(text, "a").rows[0].curve().unwrap();
        assert_eq!([0.01, 0.02, 0.5].map(|x| (curve.at(x) * 100.0).round()), [0.0, 100.0, 100.0]);
    }
    #[test]
    fn a_speed_is_the_same_speed_here() {
        let text = r#"{ "a": { "base_value": 0, "inputs": { "speed1": [[0, 0], [4, 4]] } },
                        "speed1_gamma": { "base_value": 4.0, "inputs": {} } }"#;
        let found = added(text, "a");
        let curve = found.rows[0].curve().unwrap();
        assert_eq!(found.rows[0].input, Input::Pace);
        for (px_per_sec, theirs) in [(45.0f32, 0.5f32), (46.0, 0.515), (1000.0, 4.025)] {
            let ours = curve.at(crate::paint::dynamics::pace_of(px_per_sec));
            assert!((ours - theirs).abs() < 0.03, "{px_per_sec}: {ours}, not {theirs}");
        }
    }
    #[test]
    fn what_is_known_nowhere_is_told() {
        let value = settings(
            r#"{ "gloss": { "base_value": 0.5, "inputs": {} },
                 "idle": { "base_value": 0, "inputs": { "random": [[0, 0], [1, 0]] } },
                 "a": { "base_value": 1, "inputs": { "gridmap_x": [[0, 0], [1, 1]] } } }"#,
        );
        let mut settings = MyPaintSettings::new(value.as_object().unwrap());
        settings.added("a", 0.0);
        assert_eq!(settings.into_notes(), ["“a” does not follow “gridmap_x”", "“gloss” has no counterpart"]);
    }
    #[test]
    fn a_tip_that_turns_with_the_stroke_turns_with_it_here() {
        let text = r#"{ "angle": { "base_value": 0, "inputs": { "direction": [[0, 0], [180, 180]] } } }"#;
        let turned = added(text, "angle").times(-1.0 / 360.0);
        let curve = turned.rows[0].curve().unwrap();
        for t in [0.0f32, 0.1, 0.25, 0.4, 0.6, 0.9] {
            // An ellipse looks the same after half a turn.
            let off = curve.at(t) - t;
            assert!((off * 2.0 - (off * 2.0).round()).abs() < 0.01, "{t}: {off}");
        }
    }
    #[test]
    fn the_custom_input_runs_from_its_least_to_its_most() {
        let value = settings(
            r#"{ "custom_input": { "base_value": 1, "inputs": { "random": [[0, -2], [1, 2]] } },
                 "a": { "base_value": 0, "inputs": { "custom": [[-1, -10], [3, 30]] } } }"#,
        );
        let mut settings = MyPaintSettings::new(value.as_object().unwrap());
        let custom = settings.custom();
        assert_eq!(custom.range(), [0.0, 1.0]);
        let curve = settings.added("a", 0.0).rows[0].curve().unwrap();
        assert_eq!([0.0, 0.5, 1.0].map(|t| curve.at(t)), [-10.0, 10.0, 30.0]);
    }
}
