//! The pen's samples, as strokes keep them. Floor 3. Not here: how a stroke follows from them
//! (`dab_walker`).

use crate::math::{COORDINATE, Range, UNIT, Vec2, range, vec2};

/// One point of the pen's path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Canvas px.
    pub at: Vec2,
    /// `[0, 1]`.
    pub pressure: f32,
    /// Degrees from upright, right and down positive.
    pub tilt: Vec2,
    /// Since the stroke began.
    pub time_secs: f32,
}

impl Sample {
    /// A sample as a mouse gives it: full pressure, upright.
    pub fn at(at: Vec2) -> Self {
        Self { at, pressure: 1.0, tilt: Vec2::ZERO, time_secs: 0.0 }
    }
    /// The range of a pressure.
    pub const PRESSURE: Range = UNIT;
    /// Degrees, each way.
    pub const TILT: Range = -90.0..=90.0;
    /// Characters that a reading takes in a file at most, among so many that the rest of their text
    /// is nothing beside them: seven bytes each for a place and a time on the finest grid, four for
    /// the pressure and five each for the tilt, in base64.
    pub const MOST_CHARS: u64 = 47;
    /// Ten days.
    pub const TIME_SECS: Range = 0.0..=1e6;
    /// The reading as a stroke keeps it: within what a document may hold, and on a grid finer than
    /// any pen reports (1/256 px, 1/16384 of the pressure, 1/64°, 1/8192 s), so that a file stores
    /// each step in a byte or two.
    pub fn normalized(&self) -> Self {
        let on = |v: f32, per_unit: f32, range: &Range| {
            // As f64: every value in the range stays a whole number of steps.
            let steps = f64::from(range::clamp_to_range(v, range)) * f64::from(per_unit);
            // The nearest whole number, halves away from zero: a cast is faster than `round`.
            let whole = (steps + 0.5f64.copysign(steps)) as i64;
            (whole as f64 / f64::from(per_unit)) as f32
        };
        let place = |v: f32| on(v, 256.0, &COORDINATE);
        let tilt = |v: f32| on(v, 64.0, &Self::TILT);
        Self {
            at: vec2(place(self.at.x), place(self.at.y)),
            pressure: on(self.pressure, 16_384.0, &Self::PRESSURE),
            tilt: vec2(tilt(self.tilt.x), tilt(self.tilt.y)),
            time_secs: on(self.time_secs, 8_192.0, &Self::TIME_SECS),
        }
    }
}
