//! The dab walker: turns the samples of a pen into dabs. It fits a smooth curve and walks it at even steps of arc
//! length, sample by sample as they arrive. Floor 3. Not here: the curve (`curve`), what a dab looks like (`profile`,
//! `stamp`), where it lands (`dab`).

use super::brush::Brush;
use super::curve::{CurveSegment, SAME_PX};
use super::dynamics::{DabInputs, FAR_DIAMETERS, FAST_LENGTHS_PER_SEC, Input, Property, turns_of};
use super::scene::Scene;
use super::stroke::Sample;
use super::tint;
use crate::math::{Mat2, Vec2, hash, srgb::Color};
use crate::surface::{Curvature, Operator};
use std::f32::consts::TAU;
use std::sync::Arc;

/// Farther from the canvas's corner than any canvas reaches: such samples come from a broken pen.
const FAR_PX: f32 = 1e6;
/// The smallest step between dabs. Below it neighbouring dabs of any size are the same to a byte.
const MIN_STEP_PX: f32 = 0.1;
/// A dab due this soon after the end of a piece is placed on the end: sums of lengths are rounded.
const ROUNDING_PX: f64 = 1e-3;
/// The most steps along a stroke, so that a hostile one ends: a hundred canvases' width of the smallest steps.
const MAX_STEPS: u32 = 1 << 20;
/// The smallest dab, a little wider than a pixel.
const PIXEL_RADIUS_PX: f32 = 0.75;
/// After this time the estimate has moved two thirds of the way to a new speed: single reports of a pen are noisy.
const SPEED_SECS: f32 = 0.05;
/// *s* of the κ that drives a brush: *L* over this. Relative, so that a larger canvas paints the same.
const CURVATURE_SCALES: f32 = 32.0;
/// Blur of the normals under that κ: one pixel suppresses the noise of 8-bit maps.
const CURVATURE_BLUR_PX: f32 = 1.0;

/// One placement of the footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dab {
    /// q_0: its centre and its one anchor, canvas px.
    pub at: Vec2,
    /// Of the undeformed footprint, px; positive.
    pub radius: f32,
    /// Counter-clockwise as seen.
    pub rotation_rad: f32,
    /// The footprint is exchanged left to right, as it lies in its own frame.
    pub is_mirrored: bool,
    /// See [`Brush::hardness`], [`Brush::softness`].
    pub hardness: f32,
    pub softness: f32,
    /// Coverage that it adds, `(0, 1]`.
    pub flow: f32,
    /// The coverage that it may bring a pixel to, `(0, 1]`.
    pub ceiling: f32,
    /// Of one-colour tips where the brush's colours vary; else the stroke's.
    pub color: Color,
    pub operator: Operator,
    /// How far from its centre it may land, px; 0 is anywhere.
    pub reach_px: f32,
    /// Which of the stroke it is, counted from 0; those that cannot be seen count too.
    pub number: u32,
    /// The inputs that drove it; the seed belongs to this dab alone.
    pub inputs: DabInputs,
}

#[cfg(test)]
impl Dab {
    /// A hard, upright dab on a flat canvas.
    pub fn plain(at: Vec2, radius: f32) -> Self {
        Self {
            at,
            radius,
            rotation_rad: 0.0,
            is_mirrored: false,
            hardness: 1.0,
            softness: 0.0,
            flow: 1.0,
            ceiling: 1.0,
            color: Color::BLACK,
            operator: Operator::None,
            reach_px: 0.0,
            number: 0,
            inputs: DabInputs::default(),
        }
    }
}

/// The rules by which the dabs of a stroke are made.
#[derive(Clone)]
struct DabRules {
    brush: Brush,
    operator: Operator,
    color: Color,
    scene: Scene,
    /// Canvas from the frame that the stroke was drawn in.
    facing: Mat2,
    /// If some property follows it.
    curvature: Option<Arc<Curvature>>,
    reads_surface: bool,
    varies_in_color: bool,
}

/// The pen at one point of the curve.
#[derive(Clone, Copy)]
struct CurvePoint {
    at: Vec2,
    pressure: f32,
    tilt: Vec2,
    px_per_sec: f32,
}

impl CurvePoint {
    fn lerp(self, to: CurvePoint, s: f32) -> CurvePoint {
        CurvePoint {
            at: self.at.lerp(to.at, s),
            pressure: self.pressure + (to.pressure - self.pressure) * s,
            tilt: self.tilt.lerp(to.tilt, s),
            px_per_sec: self.px_per_sec + (to.px_per_sec - self.px_per_sec) * s,
        }
    }
}

impl DabRules {
    fn new(brush: &Brush, operator: Operator, color: Color, scene: &Scene) -> Self {
        let follows = |input| brush.dynamics.follow(input);
        let curvature = scene.surface.as_ref().filter(|_| follows(Input::Curvature));
        Self {
            brush: brush.clone(),
            operator,
            color,
            scene: scene.clone(),
            facing: brush.facing.map(),
            curvature: curvature.map(|surface| surface.curvature(CURVATURE_BLUR_PX)),
            reads_surface: [Input::Slope, Input::Curvature, Input::Depth].into_iter().any(follows),
            varies_in_color: tint::varies(brush),
        }
    }
    fn inputs(&self, place: CurvePoint, direction: Vec2, travelled_px: f64, number: u32) -> DabInputs {
        let unit = |v: f32| v.max(0.0).min(1.0);
        let in_frame = |v: Vec2| self.facing.transpose() * v;
        let inputs = DabInputs {
            pressure: place.pressure,
            tilt: unit(place.tilt.length() / 90.0),
            tilt_direction: turns_of(in_frame(place.tilt)),
            direction: turns_of(in_frame(direction)),
            speed: unit(place.px_per_sec / (FAST_LENGTHS_PER_SEC * self.scene.size.longer_side())),
            distance: unit(travelled_px as f32 / (FAR_DIAMETERS * self.brush.size)),
            seed: hash::mix(self.brush.seed ^ hash::mix(number.wrapping_add(0x9e37_79b9))),
            ..DabInputs::default()
        };
        self.over_surface(place.at, inputs)
    }
    /// Adds the surface inputs at the pixel that holds a dab's centre.
    fn over_surface(&self, at: Vec2, inputs: DabInputs) -> DabInputs {
        let flat = DabInputs::default();
        let nowhere = DabInputs { slope: flat.slope, curvature: flat.curvature, depth: flat.depth, ..inputs };
        let is_over = self.reads_surface && self.scene.size.rect().contains(at.x.floor() as i32, at.y.floor() as i32);
        let Some(surface) = self.scene.surface.as_deref().filter(|_| is_over) else { return nowhere };
        let (x, y) = surface.pixel_of(at);
        if surface.coverage(x, y) == 0 {
            return nowhere;
        }
        let scale_px = surface.size().longer_side() / CURVATURE_SCALES;
        let kappa = self.curvature.as_ref().map_or(0.0, |curvature| curvature.kappa(x, y, scale_px));
        let slope = 1.0 - surface.normal(x, y).z.max(0.0).min(1.0);
        DabInputs { slope, curvature: 0.5 + 0.5 * kappa, depth: surface.depth(x, y).max(0.0).min(1.0), ..inputs }
    }
    fn diameter(&self, inputs: &DabInputs) -> f32 {
        self.brush.size * self.brush.dynamics.factor(Property::Size, inputs)
    }
    /// The distance from a dab to the next, px. A step that is not a number must not stop the walk.
    fn step(&self, inputs: &DabInputs) -> f64 {
        let spacing = self.brush.spacing * self.brush.dynamics.factor(Property::Spacing, inputs);
        f64::from((spacing * self.diameter(inputs)).max(MIN_STEP_PX))
    }
    /// The scattered position of a dab: a random point of a disc around its place on the curve.
    fn scattered(&self, at: Vec2, inputs: &DabInputs) -> Vec2 {
        let ratio = self.brush.scatter * self.brush.dynamics.factor(Property::Scatter, inputs);
        let farthest = ratio * self.diameter(inputs);
        // Comparisons that NaN fails.
        if !(farthest > 0.0 && farthest <= FAR_PX) {
            return at;
        }
        let (turn, share) = (hash::unit(inputs.seed, 0, 3), hash::unit(inputs.seed, 1, 3));
        // The root spreads them evenly over the disc.
        at + self.facing * (farthest * share.sqrt() * Vec2::from_angle(TAU * turn))
    }
    /// The dab at a point of the curve; `None` where it would be invisible.
    fn dab(&self, place: Vec2, inputs: DabInputs, number: u32) -> Option<Dab> {
        let at = self.scattered(place, &inputs);
        let inputs = if at == place { inputs } else { self.over_surface(at, inputs) };
        let (brush, dynamics) = (&self.brush, &self.brush.dynamics);
        let driven = |value: f32, property| value * dynamics.factor(property, &inputs);
        let radius = 0.5 * self.diameter(&inputs);
        let flow = driven(brush.flow, Property::Flow);
        let unit = |v: f32| v.max(0.0).min(1.0);
        let ceiling = unit(dynamics.factor(Property::Opacity, &inputs));
        // Comparisons that NaN fails.
        let is_visible = radius > 0.01 && radius <= FAR_PX && flow > 0.0 && ceiling > 0.0;
        // A dab smaller than a pixel becomes a fainter one of a pixel's size: it covers as much.
        let share = (radius / PIXEL_RADIUS_PX).min(1.0);
        let flow = flow * share * share;
        let rotation_rad = if brush.rotation.is_finite() { brush.rotation.to_radians() } else { 0.0 };
        is_visible.then(|| Dab {
            at,
            radius: radius.max(PIXEL_RADIUS_PX),
            rotation_rad: brush.facing.rotation_rad(rotation_rad + TAU * dynamics.turns(Property::Rotation, &inputs)),
            is_mirrored: brush.facing.is_mirrored,
            hardness: unit(driven(brush.hardness, Property::Hardness)),
            softness: unit(driven(brush.softness, Property::Softness)),
            flow: unit(flow),
            ceiling,
            color: if self.varies_in_color { tint::of(brush, self.color, &inputs) } else { self.color },
            operator: self.operator(&inputs),
            reach_px: 2.0 * radius * brush.reach,
            number,
            inputs,
        })
    }
    fn operator(&self, inputs: &DabInputs) -> Operator {
        let by = |value: f32, property| value * self.brush.dynamics.factor(property, inputs);
        match self.operator {
            Operator::None => Operator::None,
            Operator::Depth { gamma } => Operator::Depth { gamma: by(gamma, Property::Gamma) },
            Operator::Normal { alpha, beta, detail } => {
                Operator::Normal { alpha: by(alpha, Property::Alpha), beta, detail: by(detail, Property::Detail) }
            }
            Operator::Reflection { alpha, detail } => {
                Operator::Reflection { alpha: by(alpha, Property::Alpha), detail: by(detail, Property::Detail) }
            }
        }
    }
}

/// How far a stroke has been walked.
#[derive(Clone, Copy)]
struct WalkState {
    from: CurvePoint,
    to_next: f64,
    travelled_px: f64,
    number: u32,
}

impl WalkState {
    /// Places a dab; the next one is due a step further.
    fn stand(&mut self, place: CurvePoint, direction: Vec2, travelled_px: f64, rules: &DabRules, dabs: &mut Vec<Dab>) {
        let inputs = rules.inputs(place, direction, travelled_px, self.number);
        dabs.extend(rules.dab(place.at, inputs, self.number));
        self.to_next = rules.step(&inputs);
        self.number += 1;
    }
    /// Along the curve from one sample to the next.
    fn along(&mut self, curve: &CurveSegment, to: CurvePoint, rules: &DabRules, dabs: &mut Vec<Dab>) {
        let from = self.from;
        if self.number == 0 {
            self.stand(from, curve.out(), 0.0, rules, dabs);
        }
        let pieces = curve.pieces();
        for piece in 1..=pieces {
            let s = piece as f32 / pieces as f32;
            self.straight(CurvePoint { at: curve.at(s), ..from.lerp(to, s) }, rules, dabs);
        }
    }
    fn straight(&mut self, to: CurvePoint, rules: &DabRules, dabs: &mut Vec<Dab>) {
        let from = self.from;
        let length = f64::from(from.at.distance(to.at));
        let mut walked = 0.0;
        while walked + self.to_next <= length + ROUNDING_PX && self.number <= MAX_STEPS {
            walked += self.to_next;
            let place = from.lerp(to, (walked / length).min(1.0) as f32);
            self.stand(place, to.at - from.at, self.travelled_px + walked, rules, dabs);
        }
        self.to_next -= length - walked;
        self.travelled_px += length;
        self.from = to;
    }
}

/// The hand's speed, from where it was and when.
#[derive(Clone, Copy)]
struct HandSpeed {
    /// `None` until time has passed.
    px_per_sec: Option<f32>,
    /// When it was last estimated, and the distance since.
    at_secs: f32,
    since_px: f32,
}

impl HandSpeed {
    /// The pen has moved this far at this time. Samples with equal times count together.
    fn moved(&mut self, px: f32, secs: f32) {
        self.since_px += px;
        let elapsed = secs - self.at_secs;
        if elapsed > 0.0 {
            let now = self.since_px / elapsed;
            let share = 1.0 - (-elapsed / SPEED_SECS).exp();
            self.px_per_sec = Some(self.px_per_sec.map_or(now, |before| before + (now - before) * share));
            (self.at_secs, self.since_px) = (secs, 0.0);
        }
    }
}

/// Walks along a stroke: samples go in one by one, and dabs that no later sample changes come out.
///
/// The dabs do not depend on how samples are batched, nor on how densely the curve is sampled. Samples that are not
/// finite, lie beyond all canvases, or are earlier than the one before are skipped.
#[derive(Clone)]
pub struct DabWalker {
    rules: DabRules,
    /// The last samples, at most three: the curve is settled up to the one before the last.
    places: Vec<CurvePoint>,
    speed: HandSpeed,
    walk: Option<WalkState>,
}

impl DabWalker {
    pub fn new(brush: &Brush, operator: Operator, color: Color, scene: &Scene) -> Self {
        let speed = HandSpeed { px_per_sec: None, at_secs: f32::MIN, since_px: 0.0 };
        Self { rules: DabRules::new(brush, operator, color, scene), places: Vec::with_capacity(4), speed, walk: None }
    }
    /// Takes the next sample, and adds the dabs that are now final.
    pub fn push(&mut self, sample: &Sample, dabs: &mut Vec<Dab>) {
        let Sample { at, pressure, tilt, time_secs } = *sample;
        let is_good = at.is_finite() && at.abs().max_element() <= FAR_PX && pressure.is_finite();
        if !is_good || !time_secs.is_finite() || time_secs < self.speed.at_secs {
            return;
        }
        let tilt = if tilt.is_finite() { tilt } else { Vec2::ZERO };
        let place = CurvePoint { at, pressure: pressure.clamp(0.0, 1.0), tilt, px_per_sec: 0.0 };
        let Some(last) = self.places.last_mut() else {
            self.speed.at_secs = time_secs;
            self.places.push(place);
            return;
        };
        let distance = last.at.distance(at);
        if distance < SAME_PX {
            // Of samples at one place, the one with the greatest pressure counts.
            last.pressure = last.pressure.max(place.pressure);
            self.speed.moved(0.0, time_secs);
            return;
        }
        let is_first_speed = self.speed.px_per_sec.is_none();
        self.speed.moved(distance, time_secs);
        let px_per_sec = self.speed.px_per_sec.unwrap_or(0.0);
        if is_first_speed {
            last.px_per_sec = px_per_sec;
        }
        self.places.push(CurvePoint { px_per_sec, ..place });
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
        let walk = self.walk.get_or_insert(WalkState { from, to_next: 0.0, travelled_px: 0.0, number: 0 });
        walk.from = from;
        walk.along(&curve, to, &self.rules, dabs);
        if before.is_some() {
            self.places.remove(0);
        }
    }
    /// The dabs from the end of the final ones to the last sample, as if the stroke ended there.
    pub fn tail(&self) -> Vec<Dab> {
        let mut dabs = Vec::new();
        let Some(&first) = self.places.first() else { return dabs };
        let mut walk = self.walk.unwrap_or(WalkState { from: first, to_next: 0.0, travelled_px: 0.0, number: 0 });
        match self.places[..] {
            [only] => walk.stand(only, Vec2::ZERO, 0.0, &self.rules, &mut dabs),
            [from, to] => walk.along(&CurveSegment::new(None, from.at, to.at, None), to, &self.rules, &mut dabs),
            [before, from, to] => {
                walk.along(&CurveSegment::new(Some(before.at), from.at, to.at, None), to, &self.rules, &mut dabs);
            }
            _ => {}
        }
        dabs
    }
}

/// All dabs of a stroke.
pub fn dabs(brush: &Brush, operator: Operator, color: Color, samples: &[Sample], scene: &Scene) -> Vec<Dab> {
    let mut walker = DabWalker::new(brush, operator, color, scene);
    let mut dabs = Vec::new();
    samples.iter().for_each(|sample| walker.push(sample, &mut dabs));
    dabs.extend(walker.tail());
    dabs
}

#[cfg(test)]
mod tests;
