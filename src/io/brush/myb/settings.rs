//! The settings of a MyPaint file, each looked up by name; those that nothing uses are reported.
//! Floor 5. Not here: what they make of a brush (`dab`, `stylus`), how curves run (`curves`).

use super::added::{Added, AddedInput};
use super::curves::{InputMapping, Scales, at, curve_of, number, sample_curve};
use crate::math::vec2;
use crate::paint::dynamics::Input;
use serde_json::{Map, Value};
use std::collections::BTreeSet;

/// The settings of a file. Those that are read count as carried over; the others are reported.
pub struct MyPaintSettings<'a> {
    all: &'a Map<String, Value>,
    asked: BTreeSet<&'static str>,
    notes: Vec<String>,
    /// The inputs' scales.
    scales: Scales,
}
/// Settings that do not affect the mark, or that this program decides itself.
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

impl<'a> MyPaintSettings<'a> {
    pub fn new(all: &'a Map<String, Value>) -> Self {
        let mut settings =
            Self { all, asked: BTreeSet::new(), notes: Vec::new(), scales: Scales::default() };
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

    /// The same without counting it as carried over.
    pub fn reads(&self, name: &str) -> f32 {
        self.all.get(name).and_then(|value| number(value.get("base_value")?)).unwrap_or(0.0)
    }

    pub fn has_setting(&self, name: &str) -> bool {
        self.all.contains_key(name)
    }

    /// Something drives a setting.
    pub fn is_driven(&self, name: &str) -> bool {
        let inputs = self.all.get(name).and_then(|value| value.get("inputs")?.as_object());
        inputs.into_iter().flatten().any(|(_, points)| curve_of(points).is_some())
    }

    /// A setting that nothing can drive here, with its inputs halfway; a drive is reported.
    pub fn plain(&mut self, name: &'static str, default: f32) -> f32 {
        let added = self.take_added(name, default);
        if !added.rows.is_empty() {
            self.note(&format!("“{name}” follows nothing here"));
        }
        added.middle_value()
    }

    /// A setting with all that adds to it. Inputs that never change are part of its base.
    pub fn take_added(&mut self, name: &'static str, default: f32) -> Added {
        let mut added = Added { base: self.base(name, default), rows: Vec::new() };
        let value = self.all.get(name);
        let inputs = value.and_then(|value| value.get("inputs")?.as_object());
        for (input, points) in inputs.into_iter().flatten() {
            let Some(points) = curve_of(points) else { continue };
            match self.scales.way(input) {
                Some(InputMapping::Still(x)) => added.base += at(&points, x),
                Some(InputMapping::Runs(input, pieces)) => {
                    added.add(AddedInput { input, points: sample_curve(&pieces, &points) })
                }
                None => {
                    let input: String =
                        input.chars().filter(|c| !c.is_control()).take(60).collect();
                    self.note(&format!("“{name}” does not follow “{input}”"));
                }
            }
        }
        added
    }

    /// What a setting that follows the pressure from 0 adds.
    pub fn pressure(&self) -> Added {
        let points = vec![vec2(0.0, 0.0), vec2(1.0, self.scales.pressure)];
        Added { base: 0.0, rows: vec![AddedInput { input: Input::Pressure, points }] }
    }

    /// The setting that drives the custom input, as what it adds to our own, which runs from 0 to
    /// 1.
    pub fn custom(&mut self) -> Added {
        if !self.is_driven("custom_input") {
            return Added { base: self.base("custom_input", 0.0), rows: Vec::new() };
        }
        let custom = self.take_added("custom_input", 0.0);
        let [least, most] = custom.range();
        if most > least {
            self.scales.custom = [least, most];
        }
        let width = if most > least { most - least } else { 1.0 };
        Added { base: custom.base - least, ..custom }.times(1.0 / width)
    }

    /// The notes, and the settings that were not read although they have an effect.
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

    /// Counts settings as carried over: details of another one that is idle or reported already.
    pub fn of_no_use(&mut self, names: &[&'static str]) {
        self.asked.extend(names);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(text: &str) -> Value {
        serde_json::from_str(text).unwrap()
    }

    fn added(text: &str, name: &'static str) -> Added {
        let value = settings(text);
        MyPaintSettings::new(value.as_object().unwrap()).take_added(name, 0.0)
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
    fn a_step_stays_a_step() {
        let text = r#"{ "a": { "base_value": 0, "inputs": { "pressure":
            [[0, 0], [0.015, 0], [0.015, 1], [1, 1]] } } }"#;
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
        settings.take_added("a", 0.0);
        assert_eq!(
            settings.into_notes(),
            ["“a” does not follow “gridmap_x”", "“gloss” has no counterpart"]
        );
    }

    #[test]
    fn a_tip_that_turns_with_the_stroke_turns_with_it_here() {
        let text =
            r#"{ "angle": { "base_value": 0, "inputs": { "direction": [[0, 0], [180, 180]] } } }"#;
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
        let curve = settings.take_added("a", 0.0).rows[0].curve().unwrap();
        assert_eq!([0.0, 0.5, 1.0].map(|t| curve.at(t)), [-10.0, 10.0, 30.0]);
    }
}
