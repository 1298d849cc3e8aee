//! Ranges of numbers that a document may hold: those that many types share, and how a number is
//! checked. Floor 0. The range of a particular number is a constant of the type that holds it.
//! Readers, panels and replays use it.

use std::ops::RangeInclusive;

/// Numbers from the least to the most that a document may hold.
pub type Range = RangeInclusive<f32>;

/// Coordinates in canvas px: far beyond every canvas, well within what f32 resolves.
pub const COORDINATE: Range = -1e6..=1e6;
/// Turns either way, degrees.
pub const TURNS: Range = -36_000.0..=36_000.0;
/// Shares.
pub const UNIT: Range = 0.0..=1.0;
/// Exposures, stops.
pub const STOPS: Range = -32.0..=32.0;

/// The nearest number of a range; its least if `v` is NaN.
pub fn clamp_to_range(v: f32, range: &Range) -> f32 {
    v.max(*range.start()).min(*range.end())
}

/// Refuses a number outside its range with a sentence that begins with `what`.
pub fn check_range(what: &str, v: f32, range: &Range) -> Result<(), String> {
    let (least, most) = (range.start(), range.end());
    // NaN is in no range.
    if range.contains(&v) {
        Ok(())
    } else {
        Err(format!("{what} is {v}; it must be between {least} and {most}"))
    }
}

/// Refuses more of something than is allowed.
pub fn at_most(what: &str, count: usize, most: usize) -> Result<(), String> {
    if count <= most {
        Ok(())
    } else {
        Err(format!("{what} would be {count}; at most {most} are allowed"))
    }
}
