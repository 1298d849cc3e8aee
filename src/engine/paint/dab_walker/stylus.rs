//! The pen as a stroke reads it: its position, its speed, and the tremor of the hand.
//! Floor 3.

use crate::math::{Vec2, hash};
use crate::paint::brush::Brush;
use crate::paint::brush_options::StylusFilter;

/// Within this time a speed covers two thirds of the way to a new one: single readings of a pen
/// jump.
const SPEED_SECS: f32 = 0.05;

/// The hand at one point of the curve.
#[derive(Clone, Copy)]
pub(super) struct CurvePoint {
    pub at: Vec2,
    pub pressure: f32,
    pub tilt: Vec2,
    pub px_per_sec: f32,
    /// Averaged over each of the hand's two times, px a second.
    pub paces: [f32; 2],
    /// When the pen arrived here, and when it left.
    pub secs: f32,
    pub until_secs: f32,
}

impl CurvePoint {
    /// At the corner of the canvas, without pressure.
    pub fn at_rest(secs: f32) -> Self {
        let (at, tilt) = (Vec2::ZERO, Vec2::ZERO);
        Self { at, pressure: 0.0, tilt, px_per_sec: 0.0, paces: [0.0; 2], secs, until_secs: secs }
    }

    /// Between two points, never at rest.
    pub fn lerp(self, to: CurvePoint, s: f32) -> CurvePoint {
        let between = |from: f32, to: f32| from + (to - from) * s;
        let secs = between(self.until_secs, to.secs);
        CurvePoint {
            at: self.at.lerp(to.at, s),
            pressure: self.pressure + (to.pressure - self.pressure) * s,
            tilt: self.tilt.lerp(to.tilt, s),
            px_per_sec: self.px_per_sec + (to.px_per_sec - self.px_per_sec) * s,
            paces: [0, 1].map(|i| between(self.paces[i], to.paces[i])),
            secs,
            until_secs: secs,
        }
    }
}

/// The hand's speeds, from its positions and times.
#[derive(Clone, Copy)]
pub(super) struct Speeds {
    /// `None` until the clock has moved.
    px_per_sec: Option<f32>,
    /// They begin at rest.
    paces: [f32; 2],
    over_secs: [f32; 2],
    /// When they were last computed, and how far the hand has moved since.
    at_secs: f32,
    since_px: f32,
}

impl Speeds {
    pub fn new(stylus: &StylusFilter) -> Self {
        let over_secs = [stylus.pace_secs, stylus.slow_pace_secs];
        Self { px_per_sec: None, paces: [0.0; 2], over_secs, at_secs: f32::MIN, since_px: 0.0 }
    }

    pub fn begin(&mut self, secs: f32) {
        self.at_secs = secs;
    }

    pub fn at_secs(&self) -> f32 {
        self.at_secs
    }

    pub fn are_known(&self) -> bool {
        self.px_per_sec.is_some()
    }

    pub fn px_per_sec(&self) -> f32 {
        self.px_per_sec.unwrap_or(0.0)
    }

    /// The hand has moved this far by then. Samples with the same time count together.
    pub fn advance(&mut self, px: f32, secs: f32) {
        self.since_px += px;
        let elapsed = secs - self.at_secs;
        if elapsed > 0.0 {
            let now = self.since_px / elapsed;
            let share = 1.0 - (-elapsed / SPEED_SECS).exp();
            self.px_per_sec =
                Some(self.px_per_sec.map_or(now, |before| before + (now - before) * share));
            for (pace, over_secs) in self.paces.iter_mut().zip(self.over_secs) {
                *pace += (now - *pace) * smoothing_share(elapsed, over_secs);
            }
            (self.at_secs, self.since_px) = (secs, 0.0);
        }
    }

    pub fn apply_to(&self, place: CurvePoint) -> CurvePoint {
        CurvePoint { px_per_sec: self.px_per_sec(), paces: self.paces, ..place }
    }
}

/// How far an average over `time` has moved to a new value after `elapsed`, `[0, 1]`.
pub(super) fn smoothing_share(elapsed: f32, time: f32) -> f32 {
    if time > 0.0 { 1.0 - (-elapsed / time).exp() } else { 1.0 }
}

/// Four uniform numbers in `[0, 1)` added up: nearly normal, mean 0, variance 1, never beyond 3.5.
pub(super) fn gauss(seed: u32, channel: u32) -> f32 {
    let sum: f32 = (0..4).map(|i| hash::unit(seed, 4 * channel + i, 5)).sum();
    (sum - 2.0) * 3f32.sqrt()
}

/// A hand that shakes: the more it shakes, the less often it is read, at random positions around
/// its own.
#[derive(Clone, Copy)]
pub(super) struct Tremor {
    seed: u32,
    deviation_px: f32,
    /// Where the pen was last, and how far it has to move before it is read again.
    last: Option<Vec2>,
    left_px: f32,
    number: u32,
}

impl Tremor {
    pub fn new(brush: &Brush) -> Self {
        let deviation_px = brush.stylus.tremor * brush.size;
        // Comparisons that NaN fails.
        let deviation_px =
            if deviation_px > 1e-3 && deviation_px < super::FAR_PX { deviation_px } else { 0.0 };
        Self {
            seed: hash::mix(brush.seed ^ 0x7e3a),
            deviation_px,
            last: None,
            left_px: 0.0,
            number: 0,
        }
    }

    /// Where a pen at a point is read; `None` if it is not.
    pub fn shaken(&mut self, at: Vec2) -> Option<Vec2> {
        if self.deviation_px <= 0.0 {
            return Some(at);
        }
        if let Some(last) = self.last.replace(at) {
            self.left_px -= last.distance(at);
            if self.left_px > 0.0 {
                return None;
            }
        }
        self.left_px = 0.5 * self.deviation_px;
        self.number = self.number.wrapping_add(1);
        let seed = hash::mix(self.seed ^ self.number);
        Some(at + self.deviation_px * Vec2::new(gauss(seed, 0), gauss(seed, 1)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    #[test]
    fn chance_is_normal_enough() {
        let values: Vec<f32> = (0..4000).map(|seed| gauss(hash::mix(seed), 2)).collect();
        let mean = values.iter().sum::<f32>() / 4000.0;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f32>() / 4000.0;
        assert!(mean.abs() < 0.06 && (variance - 1.0).abs() < 0.08, "{mean} {variance}");
        assert!(values.iter().any(|v| *v > 2.0) && values.iter().all(|v| v.abs() < 3.5));
    }

    #[test]
    fn a_hand_that_shakes_is_read_once_in_half_its_tremor() {
        let brush = Brush {
            size: 40.0,
            stylus: StylusFilter { tremor: 0.5, ..StylusFilter::default() },
            ..Brush::default()
        };
        let mut tremor = Tremor::new(&brush);
        let read: Vec<Vec2> =
            (0..=1000).filter_map(|x| tremor.shaken(vec2(x as f32, 0.0))).collect();
        assert!((99..=101).contains(&read.len()), "{}", read.len());
        assert!(read.iter().any(|at| at.y.abs() > 20.0) && read.iter().all(|at| at.y.abs() < 70.0));
        let mut still = Tremor::new(&Brush::default());
        assert_eq!(still.shaken(vec2(3.0, 4.0)), Some(vec2(3.0, 4.0)));
    }
}
