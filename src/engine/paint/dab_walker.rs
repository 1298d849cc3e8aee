//! From the pen's samples to dabs: a smooth curve walked at even steps of arc length, sample by
//! sample as they come. Floor 3. `walk` says where dabs are due, `rules` sets their properties,
//! `stylus` says how the pen is read. Not here: the curve (`curve`), what a dab looks like
//! (`profile`, `stamp`), where it lands (`dab`).

mod rules;
mod stylus;
mod walk;

use super::brush::Brush;
use super::curve::{CurveSegment, SAME_PX};
use super::dynamics::DabInputs;
use super::rim::Rim;
use super::sample::Sample;
use super::scene::Scene;
use crate::math::{Vec2, srgb::Color};
use crate::surface::Operator;
use rules::DabRules;
use stylus::{CurvePoint, Speeds, Tremor};
use walk::Walk;

/// Farther from the canvas's corner than any canvas extends: such samples come from a broken pen.
const FAR_PX: f32 = 1e6;
/// One placement of the footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dab {
    /// q_0: its center and its one anchor, canvas px.
    pub at: Vec2,
    /// Of the undeformed footprint, px; positive.
    pub radius: f32,
    /// The ratio of the tip's shorter side to its longer one, `(0, 1]`; 1 for tips without sides.
    pub ratio: f32,
    /// Counter-clockwise as seen.
    pub rotation_rad: f32,
    /// The footprint is mirrored left to right, in its own frame.
    pub is_mirrored: bool,
    /// See [`Brush::hardness`], [`Brush::softness`].
    pub hardness: f32,
    pub softness: f32,
    /// Coverage that it adds, `(0, 1]`.
    pub flow: f32,
    /// Its width as a ratio of the least width that is drawn, `(0, 1]`: dabs thinner than a pixel
    /// reach a part of it.
    pub thin: f32,
    /// Where strokes of such dabs end.
    pub rim: Rim,
    /// The coverage that it may bring a pixel to, `(0, 1]`.
    pub ceiling: f32,
    /// For one-color tips, if the brush's colors vary; else the stroke's.
    pub color: Color,
    pub operator: Operator,
    /// How far from its center it may land, px; 0 is no limit.
    pub reach_px: f32,
    /// Its number in the stroke, from 0; invisible dabs count too.
    pub number: u32,
    /// The inputs that drove it; the seed is unique to this dab.
    pub inputs: DabInputs,
}

#[cfg(test)]
impl Dab {
    /// A hard, upright dab on a flat canvas.
    pub fn plain(at: Vec2, radius: f32) -> Self {
        Self {
            at,
            radius,
            ratio: 1.0,
            rotation_rad: 0.0,
            is_mirrored: false,
            hardness: 1.0,
            softness: 0.0,
            flow: 1.0,
            thin: 1.0,
            rim: Rim::SOFT,
            ceiling: 1.0,
            color: Color::BLACK,
            operator: Operator::None,
            reach_px: 0.0,
            number: 0,
            inputs: DabInputs::default(),
        }
    }
}

/// Walks along a stroke: samples go in one by one, and dabs that no later sample changes come out.
///
/// The dabs do not depend on how samples are batched, nor on how densely the curve is sampled. The
/// path is computed from the pixel of the first sample on, and dabs are on a fine grid: a stroke
/// that is moved by whole px gives exactly the same dabs, moved by them. Samples that are not
/// finite, lie beyond all canvases, or are earlier than the previous one are skipped.
#[derive(Clone)]
pub struct DabWalker {
    rules: DabRules,
    /// The last samples, at most three: the curve is settled up to the one before the last.
    places: Vec<CurvePoint>,
    speeds: Speeds,
    tremor: Tremor,
    walk: Option<Walk>,
}

impl DabWalker {
    pub fn new(brush: &Brush, operator: Operator, color: Color, scene: &Scene) -> Self {
        Self {
            rules: DabRules::new(brush, operator, color, scene),
            places: Vec::with_capacity(4),
            speeds: Speeds::new(&brush.stylus),
            tremor: Tremor::new(brush),
            walk: None,
        }
    }

    /// The walker of a second tip along the same path: a hand that shakes moves both alike.
    pub fn beside(&self, second: &Brush) -> Self {
        let DabRules { operator, color, scene, .. } = &self.rules;
        Self { tremor: self.tremor, ..Self::new(second, *operator, *color, scene) }
    }

    /// Takes the next sample, and adds the dabs that are now final.
    pub fn push(&mut self, sample: &Sample, dabs: &mut Vec<Dab>) {
        let Sample { at, pressure, tilt, time_secs } = *sample;
        let is_good = at.is_finite() && at.abs().max_element() <= FAR_PX && pressure.is_finite();
        if !is_good || !time_secs.is_finite() || time_secs < self.speeds.at_secs() {
            return;
        }
        let origin = *self.rules.origin.get_or_insert(at.floor());
        let Some(at) = self.tremor.shaken(at - origin) else { return };
        let tilt = if tilt.is_finite() { tilt } else { Vec2::ZERO };
        let place = CurvePoint {
            at,
            pressure: pressure.clamp(0.0, 1.0),
            tilt,
            ..CurvePoint::at_rest(time_secs)
        };
        let Some(last) = self.places.last_mut() else {
            self.speeds.begin(time_secs);
            self.places.push(place);
            return;
        };
        let distance = last.at.distance(at);
        if distance < SAME_PX {
            // Of several samples at one point, the one with the greatest pressure counts.
            last.pressure = last.pressure.max(place.pressure);
            last.until_secs = time_secs;
            self.speeds.advance(0.0, time_secs);
            return;
        }
        let is_first_speed = !self.speeds.are_known();
        self.speeds.advance(distance, time_secs);
        if is_first_speed {
            last.px_per_sec = self.speeds.px_per_sec();
        }
        self.places.push(self.speeds.apply_to(place));
        self.settle(dabs);
    }

    /// Walks the curve as far as later samples cannot change it.
    fn settle(&mut self, dabs: &mut Vec<Dab>) {
        let (before, from, to, after) = match self.places[..] {
            [from, to, after] => (None, from, to, after),
            [before, from, to, after] => (Some(before.at), from, to, after),
            _ => return,
        };
        let curve = CurveSegment::new(before, from.at, to.at, Some(after.at));
        let walk = self.walk.get_or_insert_with(|| Walk::from(from));
        walk.from = from;
        walk.follow_curve(&curve, to, &self.rules, dabs);
        if before.is_some() {
            self.places.remove(0);
        }
    }

    /// The dabs from the end of the final ones to the last sample, as if the stroke ended there.
    pub fn tail(&self) -> Vec<Dab> {
        let mut dabs = Vec::new();
        let Some(&first) = self.places.first() else { return dabs };
        let mut walk = self.walk.unwrap_or_else(|| Walk::from(first));
        match self.places[..] {
            [only] => walk.begin(only, Vec2::ZERO, &self.rules, &mut dabs),
            [from, to] => walk.follow_curve(
                &CurveSegment::new(None, from.at, to.at, None),
                to,
                &self.rules,
                &mut dabs,
            ),
            [before, from, to] => {
                walk.follow_curve(
                    &CurveSegment::new(Some(before.at), from.at, to.at, None),
                    to,
                    &self.rules,
                    &mut dabs,
                );
            }
            _ => {}
        }
        // The pen may still rest where it is.
        walk.rest(&self.rules, &mut dabs);
        dabs
    }
}

/// Roughly the most dabs that a path of this many px and seconds takes.
pub fn most_dabs(brush: &Brush, way_px: f32, secs: f32) -> usize {
    let timed = (brush.rate.per_sec * secs).max(0.0);
    // A float that is too large becomes the largest integer.
    ((way_px / rules::MIN_STEP_PX + timed) as usize).saturating_add(1).min(walk::MAX_STEPS as usize)
}

/// All dabs of a stroke; `walker`: as it begins.
pub fn all_dabs(mut walker: DabWalker, samples: &[Sample]) -> Vec<Dab> {
    let mut dabs = Vec::new();
    samples.iter().for_each(|sample| walker.push(sample, &mut dabs));
    dabs.extend(walker.tail());
    dabs
}

/// Those of a brush.
#[cfg(test)]
pub fn dabs(
    brush: &Brush,
    operator: Operator,
    color: Color,
    samples: &[Sample],
    scene: &Scene,
) -> Vec<Dab> {
    all_dabs(DabWalker::new(brush, operator, color, scene), samples)
}

#[cfg(test)]
mod measured;
#[cfg(test)]
mod tests;
