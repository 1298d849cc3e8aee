//! Along the curve of a stroke: where dabs are due. Floor 3. Not here: their properties there
//! (`rules`).

use super::rules::{DabRules, Due, Moment};
use super::stylus::{CurvePoint, smoothing_share};
use super::{CurveSegment, Dab};
use crate::math::Vec2;
use crate::paint::brush_options::Cycle;

/// A dab due this soon after the end of a piece of the curve is placed on its end: sums of lengths
/// are rounded.
const ROUNDING_PX: f64 = 1e-3;
/// The most steps along a stroke, so that a hostile one ends: the smallest steps over a hundred
/// canvas widths.
pub(super) const MAX_STEPS: u32 = 1 << 20;

/// How far a stroke has been walked.
#[derive(Clone, Copy)]
pub(super) struct Walk {
    pub from: CurvePoint,
    /// How densely dabs follow the last one, and the share of the path to the next that is left.
    due: Due,
    left: f64,
    traveled_px: f64,
    number: u32,
    /// The averaged direction of the path; zero before the first.
    direction: Vec2,
    /// The position of the last dab, which the next one follows.
    lagging: Option<Vec2>,
    cycle: f32,
    custom: Option<f32>,
}

impl Walk {
    pub fn from(from: CurvePoint) -> Self {
        Self {
            from,
            due: Due::NEVER,
            left: 0.0,
            traveled_px: 0.0,
            number: 0,
            direction: Vec2::ZERO,
            lagging: None,
            // As if a cycle had ended long ago, until the pen presses.
            cycle: f32::NEG_INFINITY,
            custom: None,
        }
    }

    /// The first dab.
    pub fn begin(
        &mut self,
        from: CurvePoint,
        direction: Vec2,
        rules: &DabRules,
        dabs: &mut Vec<Dab>,
    ) {
        self.direction = direction.normalize_or_zero();
        self.turn_cycle(&from, 0.0, rules);
        self.stand(from, rules, dabs);
    }

    /// A dab at a point; the next one is due a step farther.
    fn stand(&mut self, place: CurvePoint, rules: &DabRules, dabs: &mut Vec<Dab>) {
        let lag = smoothing_share(1.0, rules.brush.stylus.lag_dabs);
        let at = self.lagging.map_or(place.at, |last| last.lerp(place.at, lag));
        let at = if lag < 1.0 { at } else { place.at };
        self.lagging = Some(at);
        let moment = Moment {
            place: CurvePoint { at, ..place },
            direction: self.direction,
            traveled_px: self.traveled_px,
            cycle: self.cycle_reading(),
            custom: self.custom.unwrap_or(0.0),
            number: self.number,
        };
        let inputs = rules.inputs(&moment);
        dabs.extend(rules.dab(&moment, inputs));
        let custom = rules.custom(&inputs);
        let share = smoothing_share(1.0, rules.brush.stylus.custom_dabs);
        self.custom = Some(self.custom.map_or(custom, |before| before + (custom - before) * share));
        self.due = rules.due(&inputs);
        self.left = 1.0;
        self.number += 1;
    }

    fn cycle_reading(&self) -> f32 {
        if self.cycle >= 0.0 { self.cycle.min(1.0) } else { 1.0 }
    }

    /// The cycle advances by a path length; it begins where the pen presses, and each time it
    /// presses again.
    fn turn_cycle(&mut self, place: &CurvePoint, px: f32, rules: &DabRules) {
        /// The pen has let go below this ratio of the pressure at which the cycle began.
        const LET_GO: f32 = 0.9;
        let Cycle { length, hold, pressure } = rules.brush.cycle;
        let (is_begun, least) =
            (self.cycle >= 0.0, if self.cycle >= 0.0 { LET_GO * pressure } else { pressure });
        if place.pressure <= least {
            // A cycle without a pressure continues.
            if pressure > 0.0 || !is_begun {
                self.cycle = f32::NEG_INFINITY;
                return;
            }
        } else if !is_begun {
            self.cycle = 0.0;
        }
        let step = px / (length * rules.brush.size);
        let next = self.cycle + if step.is_finite() { step } else { 0.0 };
        let whole = 1.0 + hold.max(0.0);
        self.cycle = if next < whole {
            next
        } else if hold >= Cycle::FOR_EVER {
            1.0
        } else {
            next % whole
        };
    }

    /// Along the curve from one sample to the next.
    pub fn follow_curve(
        &mut self,
        curve: &CurveSegment,
        to: CurvePoint,
        rules: &DabRules,
        dabs: &mut Vec<Dab>,
    ) {
        if self.number == 0 {
            self.begin(self.from, curve.out(), rules, dabs);
        }
        self.rest(rules, dabs);
        let from = self.from;
        let pieces = curve.pieces();
        for piece in 1..=pieces {
            let s = piece as f32 / pieces as f32;
            let at = curve.at(s);
            let place = if piece == pieces {
                CurvePoint { at, ..to }
            } else {
                CurvePoint { at, ..from.lerp(to, s) }
            };
            let begin = self.from;
            let parts = rules.parts(begin.at, at);
            for part in 1..parts {
                self.straight(begin.lerp(place, part as f32 / parts as f32), rules, dabs);
            }
            self.straight(place, rules, dabs);
        }
    }

    /// While the pen rests.
    pub fn rest(&mut self, rules: &DabRules, dabs: &mut Vec<Dab>) {
        let from = self.from;
        let secs = f64::from(from.until_secs - from.secs);
        if self.number == 0 || secs.is_nan() || secs <= 0.0 {
            return;
        }
        let mut rested = 0.0;
        while self.due.per_sec > 0.0 && self.number <= MAX_STEPS {
            let wait = self.left / self.due.per_sec;
            if rested + wait > secs {
                break;
            }
            rested += wait;
            self.stand(from, rules, dabs);
        }
        self.left -= (secs - rested) * self.due.per_sec;
        self.from.secs = from.until_secs;
    }

    fn straight(&mut self, to: CurvePoint, rules: &DabRules, dabs: &mut Vec<Dab>) {
        let from = self.from;
        let way = to.at - from.at;
        let length = f64::from(from.at.distance(to.at));
        let secs = f64::from((to.secs - from.until_secs).max(0.0));
        let stretch = rules.stretch(from.at.midpoint(to.at), way);
        let mut walked = 0.0;
        loop {
            let per_px = self.due.per_px(way) * stretch
                + if length > 0.0 { self.due.per_sec * secs / length } else { 0.0 };
            let to_next = self.left / per_px;
            if walked + to_next > length + ROUNDING_PX
                || to_next.is_nan()
                || self.number > MAX_STEPS
            {
                self.left = (self.left - (length - walked) * per_px).max(0.0);
                self.go(&to, way, [length - walked, (length - walked) * stretch], rules);
                break;
            }
            walked += to_next;
            let place = from.lerp(to, (walked / length).min(1.0) as f32);
            self.go(&place, way, [to_next, to_next * stretch], rules);
            self.stand(place, rules, dabs);
        }
        self.from = to;
    }

    /// Advances by a piece of the path, with its length as seen and as measured.
    fn go(&mut self, place: &CurvePoint, way: Vec2, [px, measured_px]: [f64; 2], rules: &DabRules) {
        let ahead = way.normalize_or_zero();
        self.direction +=
            (ahead - self.direction) * smoothing_share(px as f32, rules.brush.stylus.direction_px);
        self.traveled_px += measured_px;
        self.turn_cycle(place, measured_px as f32, rules);
    }
}
