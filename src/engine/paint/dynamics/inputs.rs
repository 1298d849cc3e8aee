//! The readings at a dab, as the inputs that drive brushes. Floor 3. Not here: where they are read
//! (`dab_walker`).

use super::{Input, Property};
use crate::math::{Vec2, hash};
use std::f32::consts::TAU;

/// The speed that reads 1, canvas lengths *L* a second.
pub const FAST_LENGTHS_PER_SEC: f32 = 2.0;
/// The distance that reads 1, diameters.
pub const FAR_DIAMETERS: f32 = 10.0;
/// The pace up to which the scale is nearly linear, and the one that reads 1, px a second.
pub const PACES_PX_PER_SEC: [f32; 2] = [50.0, 5000.0];

/// A speed as a pace, `[0, 1]`: `ln(1 + v / 50) / ln(1 + 5000 / 50)`. Slow hands are distinguished
/// as well as fast ones.
pub fn pace_of(px_per_sec: f32) -> f32 {
    let [even, most] = PACES_PX_PER_SEC;
    ((px_per_sec.max(0.0) / even).ln_1p() / (most / even).ln_1p()).min(1.0)
}

/// The speed of a pace, px a second: the inverse of [`pace_of`].
pub fn px_per_sec_of(pace: f32) -> f32 {
    let [even, most] = PACES_PX_PER_SEC;
    even * (pace * (most / even).ln_1p()).exp_m1()
}

/// The readings at a dab, each in `[0, 1]` as [`Input`] says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DabInputs {
    /// The pressure of the pen.
    pub pressure: f32,
    /// How far the pen leans: 0 upright, 1 flat.
    pub tilt: f32,
    /// Where the pen leans, in turns.
    pub tilt_direction: f32,
    /// Where the stroke goes, in turns.
    pub direction: f32,
    /// The averaged speed; 1 is two canvas lengths a second.
    pub speed: f32,
    /// The path so far; 1 is ten diameters.
    pub distance: f32,
    /// How far the surface turns away from the viewer.
    pub slope: f32,
    /// How raised the surface is; ½ is flat.
    pub curvature: f32,
    /// How far away the surface is.
    pub depth: f32,
    /// The logarithmic pace.
    pub pace: f32,
    /// The same, averaged for longer.
    pub slow_pace: f32,
    /// Where the stroke is in its cycle.
    pub cycle: f32,
    /// What the beginning of the stroke has reached.
    pub attack: f32,
    /// What the brush set with its last dab.
    pub custom: f32,
    /// Unique to this dab: everything random about it depends on it.
    pub seed: u32,
}

impl Default for DabInputs {
    /// Full pressure, upright, at rest, off the surface.
    fn default() -> Self {
        Self {
            pressure: 1.0,
            tilt: 0.0,
            tilt_direction: 0.0,
            direction: 0.0,
            speed: 0.0,
            distance: 0.0,
            slope: 0.0,
            curvature: 0.5,
            depth: 1.0,
            pace: 0.0,
            slow_pace: 0.0,
            cycle: 1.0,
            attack: 0.0,
            custom: 0.0,
            seed: 0,
        }
    }
}

impl DabInputs {
    /// The value of an input for a property.
    pub(super) fn of(&self, input: Input, property: Property) -> f32 {
        match input {
            Input::Pressure => self.pressure,
            Input::Tilt => self.tilt,
            Input::TiltDirection => self.tilt_direction,
            Input::Direction => self.direction,
            Input::Speed => self.speed,
            Input::Distance => self.distance,
            Input::Random => hash::unit(self.seed, property as u32, 1),
            Input::Slope => self.slope,
            Input::Curvature => self.curvature,
            Input::Depth => self.depth,
            Input::Pace => self.pace,
            Input::SlowPace => self.slow_pace,
            // A property's number is never as large.
            Input::Chance => hash::unit(self.seed, u32::MAX, 1),
            Input::Cycle => self.cycle,
            Input::Attack => self.attack,
            Input::Custom => self.custom,
        }
    }
}

/// The direction of a vector in image axes (y down), in turns counter-clockwise as seen, `[0, 1)`;
/// 0 for a zero vector.
pub fn turns_of(v: Vec2) -> f32 {
    let turns = if v == Vec2::ZERO { 0.0 } else { (-v.y).atan2(v.x) / TAU };
    // A turn just below 0 rounds up to 1.
    (turns - turns.floor()) % 1.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    #[test]
    fn directions_turn_counter_clockwise_as_seen() {
        let turns = [vec2(1.0, 0.0), vec2(0.0, -2.0), vec2(-1.0, 0.0), vec2(0.0, 3.0), Vec2::ZERO]
            .map(turns_of);
        assert_eq!(turns, [0.0, 0.25, 0.5, 0.75, 0.0]);
        assert!(turns_of(vec2(1.0, 1e-9)) < 1.0);
    }

    #[test]
    fn a_pace_tells_slow_hands_apart_and_goes_back() {
        assert_eq!(
            (pace_of(0.0), pace_of(5000.0), pace_of(1e9), pace_of(f32::NAN)),
            (0.0, 1.0, 1.0, 0.0)
        );
        assert!(pace_of(100.0) - pace_of(50.0) > pace_of(1100.0) - pace_of(1050.0));
        for v in [3.0f32, 80.0, 900.0] {
            assert!((px_per_sec_of(pace_of(v)) / v - 1.0).abs() < 1e-3, "{v}");
        }
    }
}
