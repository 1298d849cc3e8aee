//! A recorded pen, for tests: one report per line, `[x, y, pressure, secs]`, `null` for a missing
//! pressure and `"nan"` for an invalid number. Reports of a platform have its own numbers, or a name
//! and its numbers. Floor 7.

use super::{PenPhase, PenReport, PenSource};
use eframe::egui::{PointerButton, pos2};
use serde_json::Value;
use std::collections::VecDeque;

/// Reports that are returned one by one: the first comes down, the others move.
pub struct RecordedPen {
    reports: VecDeque<PenReport>,
}

impl RecordedPen {
    pub fn of(lines: &str) -> Self {
        let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
        let report = |(i, line): (usize, &str)| {
            let value: Value = serde_json::from_str(line).expect("a list of numbers");
            PenReport {
                phase: if i == 0 { PenPhase::Down(PointerButton::Primary) } else { PenPhase::Move },
                at: pos2(number(&value[0]) as f32, number(&value[1]) as f32),
                pressure: (!value[2].is_null()).then(|| number(&value[2]) as f32),
                tilt: (0.0, 0.0),
                twist: None,
                secs: number(&value[3]),
                is_eraser: false,
            }
        };
        Self { reports: lines.lines().enumerate().map(report).collect() }
    }
}

impl PenSource for RecordedPen {
    fn next(&mut self) -> Option<PenReport> {
        self.reports.pop_front()
    }
}

/// The numbers of each line.
pub fn numbers(lines: &str) -> Vec<Vec<f64>> {
    lines.lines().map(|line| serde_json::from_str(line).expect("a list of numbers")).collect()
}

/// The name that begins each line, and the numbers after it.
pub fn named(lines: &str) -> Vec<(String, Vec<f64>)> {
    let line = |line: &str| {
        let values: Vec<Value> = serde_json::from_str(line).expect("a name and numbers");
        let name = values[0].as_str().expect("a name").to_owned();
        (name, values[1..].iter().filter_map(Value::as_f64).collect())
    };
    lines.lines().map(line).collect()
}
