//! MyPaint's settings and curves in this program's terms: inputs from 0 to 1, factors from 0 to 1.
//! Floor 5.

use crate::math::{Vec2, vec2};
use crate::paint::dynamics::{Curve, Input, MAX_POINTS};
use serde_json::{Map, Value};
use std::collections::BTreeSet;

/// The settings of a file. Those that are read count as imported; the others are reported.
pub struct MyPaintSettings<'a> {
    all: &'a Map<String, Value>,
    asked: BTreeSet<&'static str>,
    notes: Vec<String>,
}

/// A base value and what is added to it.
pub struct MyPaintSetting {
    pub base: f32,
    /// Points (input, what it adds) from left to right.
    pub inputs: Vec<(String, Vec<Vec2>)>,
}

/// A setting's maximum, and the factors by which inputs reduce it.
pub struct DrivenSetting {
    pub most: f32,
    pub rows: Vec<(Input, Curve)>,
}

/// Settings that do not affect marks, or that this program handles itself.
const OF_NO_MATTER: [&str; 16] = [
    "anti_aliasing",
    "color_h",
    "color_s",
    "color_v",
    "restore_color",
    "snap_to_pixel",
    "stroke_duration_logarithmic",
    "stroke_holdtime",
    "stroke_threshold",
    "speed1_gamma",
    "speed1_slowness",
    "speed2_gamma",
    "speed2_slowness",
    "direction_filter",
    "slow_tracking_per_dab",
    "gridmap_scale",
];

/// A piece of an input's way: from `t0` to `t1` of ours it goes from `x0` to `x1` of theirs.
struct CurvePiece {
    t: [f32; 2],
    x: [f32; 2],
}

/// The number of straight pieces that approximate a curve.
const STEPS: usize = 12;

impl<'a> MyPaintSettings<'a> {
    pub fn new(all: &'a Map<String, Value>) -> Self {
        Self { all, asked: BTreeSet::new(), notes: Vec::new() }
    }
    pub fn has(&self, name: &str) -> bool {
        self.all.contains_key(name)
    }
    pub fn note(&mut self, note: &str) {
        if !self.notes.iter().any(|known| known == note) {
            self.notes.push(note.to_owned());
        }
    }
    /// A setting as in the file; damaged numbers are ignored.
    pub fn setting(&mut self, name: &'static str, default: f32) -> MyPaintSetting {
        self.asked.insert(name);
        let value = self.all.get(name);
        let base = value.and_then(|v| number(v.get("base_value")?)).unwrap_or(default);
        let inputs = value.and_then(|v| v.get("inputs")?.as_object());
        let curve = |points: &Value| {
            let points = points.as_array()?.iter().take(MAX_POINTS);
            let points = points.filter_map(|p| Some(vec2(number(p.get(0)?)?, number(p.get(1)?)?)));
            let mut points: Vec<Vec2> = points.collect();
            points.sort_by(|a, b| a.x.total_cmp(&b.x));
            // A curve that adds nothing is dropped.
            points.iter().any(|p| p.y != 0.0).then_some(points)
        };
        let inputs = inputs.into_iter().flatten().filter_map(|(input, points)| Some((input.clone(), curve(points)?)));
        MyPaintSetting { base, inputs: inputs.collect() }
    }
    /// A setting as a maximum and factors. `value`: the meaning of the setting, increasing and not negative.
    pub fn driven(&mut self, name: &'static str, default: f32, value: impl Fn(f32) -> f32) -> DrivenSetting {
        let MyPaintSetting { base, inputs } = self.setting(name, default);
        let most_of = |curve: &[Vec2]| curve.iter().map(|p| p.y).fold(f32::NEG_INFINITY, f32::max);
        let mut most = base;
        let mut rows = Vec::new();
        for (input, points) in &inputs {
            let Some((ours, pieces)) = self.way(input) else {
                self.note(&format!("“{name}” does not follow “{input}”"));
                continue;
            };
            most += most_of(points);
            let top = value(base + most_of(points));
            let factor = |x: f32| if top > 0.0 { value(base + at(points, x)) / top } else { 1.0 };
            rows.extend(sampled(&pieces, points, factor).map(|curve| (ours, curve)));
        }
        DrivenSetting { most: value(most), rows }
    }
    /// A curve of degrees clockwise as turns: the input, the degrees to start from, and what is added from there.
    pub fn turns(&mut self, input: &str, points: &[Vec2]) -> Option<(Input, f32, Curve)> {
        let (ours, pieces) = self.way(input)?;
        let most = points.iter().map(|p| p.y).fold(f32::NEG_INFINITY, f32::max);
        let curve = sampled(&pieces, points, |x| (most - at(points, x)) / 360.0)?;
        Some((ours, -most, curve))
    }
    /// Maps an input of MyPaint to one of ours.
    fn way(&mut self, input: &str) -> Option<(Input, Vec<CurvePiece>)> {
        let whole = |x: [f32; 2]| vec![CurvePiece { t: [0.0, 1.0], x }];
        Some(match input {
            "pressure" => (Input::Pressure, whole([0.0, 1.0])),
            "random" => (Input::Random, whole([0.0, 1.0])),
            "speed1" | "speed2" => {
                self.note("Speeds are measured on another scale");
                (Input::Speed, whole([0.0, 4.0]))
            }
            // Clockwise, and the same for both ways along a line.
            "direction" => {
                let half = |from: f32| CurvePiece { t: [from, from + 0.5], x: [180.0, 0.0] };
                (Input::Direction, vec![half(0.0), half(0.5)])
            }
            "direction_angle" => (Input::Direction, whole([360.0, 0.0])),
            "tilt_declination" => (Input::Tilt, whole([90.0, 0.0])),
            "stroke" => {
                // Theirs ends after e^d radii, ours after twenty.
                let radii = self.setting("stroke_duration_logarithmic", 4.0).base.clamp(-1.0, 7.0).exp();
                (Input::Distance, whole([0.0, 20.0 / radii]))
            }
            _ => return None,
        })
    }
    /// The notes, and the settings that were not read although they have an effect.
    pub fn into_notes(mut self) -> Vec<String> {
        let all = self.all;
        for (name, value) in all {
            let known = self.asked.contains(name.as_str()) || OF_NO_MATTER.contains(&name.as_str());
            let base = value.get("base_value").and_then(number).unwrap_or(0.0);
            let inputs = value.get("inputs").and_then(Value::as_object).is_some_and(|inputs| !inputs.is_empty());
            if !known && (inputs || base != idle(name)) {
                let name: String = name.chars().filter(|c| !c.is_control()).take(60).collect();
                self.note(&format!("“{name}” has no counterpart"));
            }
        }
        self.notes
    }
}

/// The base value at which a setting has no effect, if it is not 0.
fn idle(name: &str) -> f32 {
    match name {
        "smudge_length" => 0.5,
        "paint_mode" | "gridmap_scale_x" | "gridmap_scale_y" => 1.0,
        _ => 0.0,
    }
}

fn number(value: &Value) -> Option<f32> {
    value.as_f64().map(|v| v as f32).filter(|v| v.abs() < 1e6)
}

/// A curve of theirs: straight between its points, level beyond.
fn at(points: &[Vec2], x: f32) -> f32 {
    let Some(first) = points.first() else { return 0.0 };
    let mut before = *first;
    for &point in points {
        if x <= point.x {
            let width = point.x - before.x;
            return if width > 0.0 { before.y + (point.y - before.y) * (x - before.x) / width } else { point.y };
        }
        before = point;
    }
    before.y
}

/// A function of their input as a curve over ours. `None` where too little is left of it to be one.
fn sampled(pieces: &[CurvePiece], points: &[Vec2], value: impl Fn(f32) -> f32) -> Option<Curve> {
    let mut out: Vec<Vec2> = Vec::new();
    for CurvePiece { t: [t0, t1], x: [x0, x1] } in pieces {
        let steps = (0..=STEPS).map(|i| i as f32 / STEPS as f32);
        let corners = points.iter().map(|p| (p.x - x0) / (x1 - x0)).filter(|s| (0.0..=1.0).contains(s));
        let mut shares: Vec<f32> = steps.chain(corners.take(16)).collect();
        shares.sort_by(f32::total_cmp);
        shares.dedup();
        out.extend(shares.into_iter().map(|s| {
            let y = value(x0 + (x1 - x0) * s);
            vec2((t0 + (t1 - t0) * s).clamp(0.0, 1.0), y.max(0.0).min(1.0))
        }));
    }
    Curve::through(straightened(&out))
}

/// Without the points that lie on the line between their neighbours.
fn straightened(points: &[Vec2]) -> Vec<Vec2> {
    let mut out: Vec<Vec2> = Vec::new();
    for (i, &point) in points.iter().enumerate() {
        let next = points.get(i + 1).copied();
        let is_between = out.last().zip(next).is_some_and(|(before, next)| {
            let width = next.x - before.x;
            width > 0.0 && (before.y + (next.y - before.y) * (point.x - before.x) / width - point.y).abs() < 0.002
        });
        if !is_between {
            out.push(point);
        }
    }
    out.truncate(MAX_POINTS);
    out
}

/// Two curves multiplied.
pub fn product(a: &Curve, b: &Curve) -> Option<Curve> {
    let points: Vec<Vec2> = (0..=32).map(|i| i as f32 / 32.0).map(|x| vec2(x, a.at(x) * b.at(x))).collect();
    Curve::through(straightened(&points))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(text: &str) -> Value {
        serde_json::from_str(text).unwrap()
    }
    #[test]
    fn what_adds_up_in_a_logarithm_is_a_factor_here() {
        let value = settings(
            r#"{ "r": { "base_value": 2,
                        "inputs": { "pressure": [[0, -1], [1, 1]], "random": [[0, -0.5], [1, 0]] } } }"#,
        );
        let mut settings = MyPaintSettings::new(value.as_object().unwrap());
        let driven = settings.driven("r", 0.0, f32::exp);
        assert!((driven.most - 3f32.exp()).abs() < 1e-3);
        for (pressure, random) in [(0.0f32, 0.0f32), (0.3, 0.8), (1.0, 1.0), (0.77, 0.2)] {
            let expected = (2.0 + (2.0 * pressure - 1.0) + (-0.5 + 0.5 * random)).exp();
            let of = |input| driven.rows.iter().find(|(i, _)| *i == input).unwrap().1.clone();
            let found = driven.most * of(Input::Pressure).at(pressure) * of(Input::Random).at(random);
            assert!((found / expected - 1.0).abs() < 0.03, "{found} for {expected}");
        }
    }
    #[test]
    fn what_is_known_nowhere_is_told() {
        let value = settings(
            r#"{ "smudge": { "base_value": 0.5, "inputs": {} }, "smudge_length": { "base_value": 0.5, "inputs": {} },
                 "a": { "base_value": 1, "inputs": { "custom": [[0, 0], [1, 1]] } } }"#,
        );
        let mut settings = MyPaintSettings::new(value.as_object().unwrap());
        settings.driven("a", 0.0, |v| v);
        assert_eq!(settings.into_notes(), ["“a” does not follow “custom”", "“smudge” has no counterpart"]);
    }
    #[test]
    fn a_tip_that_turns_with_the_stroke_turns_with_it_here() {
        let value = settings("{}");
        let mut settings = MyPaintSettings::new(value.as_object().unwrap());
        let (input, start, curve) = settings.turns("direction", &[vec2(0.0, 0.0), vec2(180.0, 180.0)]).unwrap();
        assert_eq!(input, Input::Direction);
        for t in [0.0f32, 0.1, 0.25, 0.4, 0.6, 0.9] {
            // An ellipse looks the same after half a turn.
            let turned = start / 360.0 + curve.at(t) - t;
            assert!((turned - (turned * 2.0).round() / 2.0).abs() < 0.01, "{t}: {turned}");
        }
    }
}
