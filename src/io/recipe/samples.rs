//! Readings of the pen in a document, of every kind of stroke: rows of numbers where they are few,
//! one text where they are many. Floor 5. What the numbers of a reading may be is `paint::Sample`'s
//! own.
//!
//! | file | |
//! |---|---|
//! | `columns` | many readings as one text |
//! | `rows` | rows in a text, found before it is parsed |

mod columns;
mod rows;
#[cfg(test)]
mod tests;

use crate::json::{self, JsonNode, object};
use crate::math::{COORDINATE, Vec2, vec2};
use crate::paint::Sample;
use crate::{Budget, Error, Result};
use columns::{Unreadable, pack, unpack};
use rows::with_rows_packed;
use serde_json::Value;
use std::borrow::Cow;
use std::path::Path;

/// Readings of a stroke that are still written as rows: a touch or a short hatch, which a person
/// may want to read.
const ROWS: usize = 32;
/// A reading whose last fields are absent.
const UNSAID: [f32; 4] = [1.0, 0.0, 0.0, 0.0];
const COLUMNS: usize = 6;

pub fn write(samples: &[Sample]) -> Value {
    if samples.len() > ROWS { pack(samples).into() } else { samples.iter().map(row).collect() }
}

/// As few numbers as say it.
fn row(sample: &Sample) -> Value {
    let mut values = &numbers(sample)[..];
    for unsaid in UNSAID.iter().rev() {
        match values.split_last() {
            Some((last, rest)) if last == unsaid => values = rest,
            _ => break,
        }
    }
    values.iter().copied().map(object::number).collect()
}

/// Rows or a text; `left`: how many readings the document may still have.
pub fn read(node: &JsonNode, most: usize, left: &mut usize) -> Result<Vec<Sample>> {
    let most = most.min(*left);
    let samples = match node.value() {
        Value::String(text) => {
            let read = unpack(text, most).map_err(|why| match why {
                Unreadable::TooMany => {
                    node.too_large(format!("has more than {most} readings of the pen"))
                }
                Unreadable::Damaged => {
                    node.refusal("is no text of readings as Rilievo writes them")
                }
            })?;
            match read.iter().enumerate().find_map(|(i, sample)| Some((i, trouble(sample)?))) {
                Some((i, reason)) => return Err(node.item(i).refusal(reason)),
                None => read,
            }
        }
        _ => node.list(most)?.iter().map(read_row).collect::<Result<_>>()?,
    };
    *left -= samples.len();
    Ok(samples)
}

/// The same of strokes that have no more than places and pressures.
pub fn write_pressed(samples: &[(Vec2, f32)]) -> Value {
    write(
        &samples
            .iter()
            .map(|(at, pressure)| Sample { pressure: *pressure, ..Sample::at(*at) })
            .collect::<Vec<_>>(),
    )
}

/// What [`write_pressed`] writes. A reading with a tilt or a time is refused.
pub fn read_pressed(node: &JsonNode, most: usize, left: &mut usize) -> Result<Vec<(Vec2, f32)>> {
    let pressed = |(i, sample): (usize, Sample)| {
        let Sample { at, pressure, tilt, time_secs } = sample;
        let is_pressed = tilt == Vec2::ZERO && time_secs == 0.0;
        is_pressed
            .then_some((at, pressure))
            .ok_or_else(|| node.item(i).refusal("has more than a place and a pressure"))
    };
    read(node, most, left)?.into_iter().enumerate().map(pressed).collect()
}

/// [x, y, pressure 1, tilt_x 0, tilt_y 0, time_secs 0]; the last four may be absent.
fn read_row(node: &JsonNode) -> Result<Sample> {
    let values = node.numbers(2, COLUMNS, COORDINATE)?;
    let value = |i: usize| values.get(i).copied().unwrap_or(UNSAID[i - 2]);
    let sample = of_numbers([values[0], values[1], value(2), value(3), value(4), value(5)]);
    trouble(&sample).map_or(Ok(sample), |reason| Err(node.refusal(reason)))
}

/// Why a reading cannot be one.
fn trouble(sample: &Sample) -> Option<String> {
    let Sample { at, pressure, tilt, time_secs } = *sample;
    if !(COORDINATE.contains(&at.x) && COORDINATE.contains(&at.y)) {
        return Some(format!(
            "is at {at}; a place lies between {} and {}",
            COORDINATE.start(),
            COORDINATE.end()
        ));
    }
    if !Sample::PRESSURE.contains(&pressure) {
        return Some(format!("has the pressure {pressure}; it must be between 0 and 1"));
    }
    if !(Sample::TILT.contains(&tilt.x) && Sample::TILT.contains(&tilt.y)) {
        return Some("is tilted by more than 90 degrees".into());
    }
    if !Sample::TIME_SECS.contains(&time_secs) {
        return Some("has a time before the stroke began, or no time".into());
    }
    None
}

fn numbers(sample: &Sample) -> [f32; COLUMNS] {
    let Sample { at, pressure, tilt, time_secs } = *sample;
    [at.x, at.y, pressure, tilt.x, tilt.y, time_secs]
}

fn of_numbers([x, y, pressure, tilt_x, tilt_y, time_secs]: [f32; COLUMNS]) -> Sample {
    Sample { at: vec2(x, y), pressure, tilt: vec2(tilt_x, tilt_y), time_secs }
}

/// A text from a file that is parsed into values: see `with_rows_packed`.
pub fn parse(file: &Path, text: &[u8], budget: &Budget) -> Result<Value> {
    match with_rows_packed(text) {
        Cow::Borrowed(_) => json::parse(file, text, budget),
        // Lines and columns are those of the text itself.
        Cow::Owned(packed) => json::parse(file, &packed, budget).or_else(|error| match error {
            Error::Decode { .. } => json::parse(file, text, budget),
            _ => Err(error),
        }),
    }
}
