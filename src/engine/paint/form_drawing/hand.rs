//! How a hand follows a line: pressure by what the line is, tapered ends, overshoot and wobble.
//! Floor 3. All of it is fixed by where the line is, so that it does not flicker while others move.

use super::{FormDrawing, FormPattern};
use crate::math::number_settings::number_settings;
use crate::math::{NumberSetting, Vec2, Vec3, hash, vec2};
use crate::paint::sample::Sample;
use crate::paint::stroke::Stroke;
use crate::surface::form_lines::{FormLine, LinePoint};
use crate::surface::hatching::TAPER_OF_ROOM;
use crate::surface::{Operator, Surface};
use std::sync::Arc;

number_settings! {
    /// How a hand follows lines. Lengths are canvas px.
    pub struct DrawingHand {
        /// The length over which ends grow thin, px.
        taper: "Taper", "The length over which ends grow thin, px", 0.0..=500.0, 24.0, px;
        /// How far ends go on beyond the line, px.
        overshoot: "Overshoot", "How far ends go on beyond the line, px", 0.0..=100.0, 0.0, px;
        /// How far the hand strays, px.
        wobble: "Wobble", "How far the hand strays, px", 0.0..=50.0, 0.0, px;
        /// How much lighter the pressure is where a line is faint.
        by_strength: "Weight by strength", "How much thinner faint lines are", 0.0..=1.0, 0.6;
        /// How much lighter it is in the light.
        by_light: "Weight by light", "How much thinner lines are in the light", 0.0..=1.0, 0.4;
        /// How much lighter it is far away.
        by_distance: "Weight by nearness", "How much thinner lines are far away", 0.0..=1.0, 0.0;
        /// How much lighter it is where a line runs along the nib.
        by_angle: "Weight by angle", "How much thinner lines are that run along the nib", 0.0..=1.0, 0.0;
        /// The direction of the nib's edge, degrees, anticlockwise from the right as seen.
        nib_angle: "Nib angle", "Which way the thinnest lines run, degrees", 0.0..=180.0, 45.0;
        and
    }
}

/// From one sample to the next along a line, points.
const SAMPLE_EVERY: usize = 3;
/// Wavelengths of the wobble, px for each px of it, and their least.
const WAVES: [(f32, f32); 2] = [(14.0, 36.0), (5.0, 13.0)];
/// The share of a line that its tapers take at most, each.
const MOST_TAPER: f32 = 0.45;
/// The lightest pressure, and that of lines whose width is a tone.
const LEAST: f32 = 0.04;
const LEAST_OF_TONE: f32 = 0.01;
/// How fast a hand is, px a second.
const SPEED: f32 = 500.0;
/// How far beside a line the light on it is read, px.
const BESIDE_PX: f32 = 2.0;

/// The light that falls on a surface, for the weight of lines.
pub(super) struct LightOnLines<'s> {
    pub surface: &'s Surface,
    /// Toward the light, camera space (y up).
    pub light: Vec3,
}

impl LightOnLines<'_> {
    /// max(n·ℓ, 0) at a point, and how far away it is, both `[0, 1]`.
    fn at(&self, at: Vec2) -> (f32, f32) {
        let size = self.surface.size();
        let pixel = |v: f32, n: u32| (v.max(0.0) as usize).min(n.saturating_sub(1) as usize);
        let (x, y) = (pixel(at.x, size.width), pixel(at.y, size.height));
        let lit = self.surface.normal(x, y).dot(self.light.normalize_or(Vec3::Z));
        (lit.clamp(0.0, 1.0), self.surface.depth(x, y))
    }
}

impl DrawingHand {
    /// What changes a pattern: the weight of hatching is its tone, whatever the hand.
    pub fn settings_of(
        pattern: &FormPattern,
    ) -> impl Iterator<Item = &'static NumberSetting<Self>> + use<> {
        let has_weight = matches!(pattern, FormPattern::Lines(_));
        Self::SETTINGS.iter().filter(move |setting| has_weight || setting.is_length)
    }

    /// The same on a canvas `factor` times as large.
    pub fn scaled(&self, factor: f32) -> Self {
        let mut next = *self;
        Self::lengths().for_each(|setting| (setting.set)(&mut next, (setting.get)(self) * factor));
        next
    }

    /// The stroke along a line of the form.
    pub(super) fn stroke(
        &self,
        drawing: &FormDrawing,
        line: &FormLine,
        light: &LightOnLines,
    ) -> Arc<Stroke> {
        let last = line.points.len().saturating_sub(1);
        let kept = |(i, _): &(usize, &LinePoint)| i % SAMPLE_EVERY == 0 || *i == last;
        let every: Vec<LinePoint> =
            line.points.iter().enumerate().filter(kept).map(|(_, point)| *point).collect();
        let points = if line.is_closed {
            every.iter().chain(every.first()).copied().collect()
        } else {
            self.extend_ends(every)
        };
        // Lines that meet do not fade out before they do.
        let taper = line.is_joined.map(
            |is_joined| {
                if line.is_closed || is_joined { 0.0 } else { self.taper }
            },
        );
        let nib = Vec2::from_angle(-self.nib_angle.to_radians()); // canvas y is down
        self.draw(drawing, &points, taper, LEAST, |point, left| {
            let (lit, away) = light.at(point.at + BESIDE_PX * left);
            let along_nib = 1.0 - left.dot(nib).abs();
            let thin = |share: f32, by: f32| 1.0 - share * by.clamp(0.0, 1.0);
            thin(self.by_strength, 1.0 - point.strength)
                * thin(self.by_light, lit)
                * thin(self.by_distance, away)
                * thin(self.by_angle, along_nib)
        })
    }

    /// The stroke along a part of a line, whose strength is the pressure.
    ///
    /// * `from`: the position of its first point on the line: whatever is left of a line has the
    ///   same samples.
    /// * `room_px`: the distance of its neighbors at each end, which limits the tapers.
    pub(super) fn draw_part(
        &self,
        drawing: &FormDrawing,
        points: &[LinePoint],
        from: usize,
        room_px: [f32; 2],
    ) -> Arc<Stroke> {
        let last = points.len().saturating_sub(1);
        let kept = |(i, _): &(usize, &LinePoint)| {
            (from + i).is_multiple_of(SAMPLE_EVERY) || *i == 0 || *i == last
        };
        let every: Vec<LinePoint> =
            points.iter().enumerate().filter(kept).map(|(_, point)| *point).collect();
        let points = self.extend_ends(every);
        let taper = room_px.map(|px| self.taper.min(TAPER_OF_ROOM * px));
        self.draw(drawing, &points, taper, LEAST_OF_TONE, |point, _| point.strength)
    }

    /// A stroke through points.
    ///
    /// * `taper`: the length over which each end grows thin, px.
    /// * `least`: the lightest pressure.
    /// * `pressure`: of a point, and the direction to its left.
    fn draw(
        &self,
        drawing: &FormDrawing,
        points: &[LinePoint],
        taper: [f32; 2],
        least: f32,
        pressure: impl Fn(&LinePoint, Vec2) -> f32,
    ) -> Arc<Stroke> {
        let along = lengths(points);
        let whole = along.last().copied().unwrap_or(0.0);
        let taper = taper.map(|taper| taper.min(MOST_TAPER * whole));
        let sample = |i: usize| {
            let at = points[i].at;
            let (before, after) =
                (points[i.saturating_sub(1)], points[(i + 1).min(points.len() - 1)]);
            // What a line belongs to is on its left (y down).
            let left = vec2(after.at.y - before.at.y, before.at.x - after.at.x);
            let ends = taper_share(along[i], taper[0]) * taper_share(whole - along[i], taper[1]);
            let pressure = pressure(&points[i], left.normalize_or_zero()) * ends;
            let (pressure, time_secs) = (pressure.max(least), along[i] / SPEED);
            Sample { pressure, time_secs, ..Sample::at(at + self.stray(at)) }.normalized()
        };
        let samples: Vec<Sample> = (0..points.len()).map(sample).collect();
        let mut brush = drawing.brush.clone();
        if brush.is_random() {
            let first = points.first().map_or(Vec2::ZERO, |point| (point.at / 16.0).floor());
            brush.seed ^= hash::mix(first.x as i32 as u32 ^ hash::mix(first.y as i32 as u32));
        }
        Arc::new(Stroke::new(brush, Operator::None, drawing.color, samples))
    }

    /// Points that go on beyond both ends.
    fn extend_ends(&self, points: Vec<LinePoint>) -> Vec<LinePoint> {
        let n = points.len();
        if self.overshoot <= 0.0 || n < 2 {
            return points;
        }
        let beyond = |end: LinePoint, inner: LinePoint, seed: u32| {
            let [x, y] = [end.at.x, end.at.y].map(|v| (v / 8.0).floor() as i32 as u32);
            let far = self.overshoot * (0.5 + hash::unit(seed, x, y));
            LinePoint { at: end.at + (end.at - inner.at).normalize_or_zero() * far, ..end }
        };
        let first = beyond(points[0], points[2.min(n - 1)], 1);
        let last = beyond(points[n - 1], points[n.saturating_sub(3)], 2);
        std::iter::once(first).chain(points).chain([last]).collect()
    }

    /// Where a hand strays to from a point: noise that lies still on the paper.
    fn stray(&self, at: Vec2) -> Vec2 {
        if self.wobble <= 0.0 {
            return Vec2::ZERO;
        }
        let wave = |(per_px, least): (f32, f32), seed: u32| {
            let p = at / (per_px * self.wobble).max(least);
            vec2(noise(p, seed), noise(p, seed + 1))
        };
        self.wobble * (wave(WAVES[0], 11) * 0.8 + wave(WAVES[1], 23) * 0.2)
    }
}

/// The pressure so far from an end.
fn taper_share(from_end: f32, taper: f32) -> f32 {
    if taper <= 0.0 {
        return 1.0;
    }
    let t = (from_end / taper).clamp(0.0, 1.0);
    t * (2.0 - t)
}

/// Values of a lattice, smoothly between: within [−1, 1].
fn noise(p: Vec2, seed: u32) -> f32 {
    let cell = p.floor();
    let f = p - cell;
    let s = f * f * (3.0 - 2.0 * f);
    let [x, y] = [cell.x as i32, cell.y as i32];
    let value = |dx: i32, dy: i32| 2.0 * hash::unit(seed, (x + dx) as u32, (y + dy) as u32) - 1.0;
    let row = |dy: i32| value(0, dy) + s.x * (value(1, dy) - value(0, dy));
    row(0) + s.y * (row(1) - row(0))
}

/// How far each point is along its path, px.
fn lengths(points: &[LinePoint]) -> Vec<f32> {
    let mut so_far = 0.0;
    let mut before = points.first().map_or(Vec2::ZERO, |point| point.at);
    let length = |point: &LinePoint| {
        so_far += before.distance(point.at);
        before = point.at;
        so_far
    };
    points.iter().map(length).collect()
}
