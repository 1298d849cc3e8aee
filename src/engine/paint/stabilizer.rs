//! The stabilizer: turns the pen's samples into a smoother line as they arrive, and completes the
//! line when the pen lifts. Floor 3.

use super::brush::{Brush, Stabilizer};
use super::brush_options::DistanceMetric;
use super::sample::Sample;
use super::surface_metric::SurfaceMetric;
use crate::math::Vec2;
use crate::surface::{Operator, Scene};

/// The weight of a [`Stabilizer::Average`] is the share of the past that is left after the pen has
/// moved this many px.
const WEIGHED_PX: f32 = 10.0;
/// A greater weight would hold the line at its start.
const MOST_WEIGHT: f32 = 0.99;
/// The string is pulled in steps no longer than this, so that the line does not depend on the rate
/// of the pen's reports.
const PULL_PX: f32 = 1.0;
/// On a surface the lag of an average is measured in steps no longer than this.
const MEASURED_PX: f32 = 4.0;
/// The most steps between two samples: a pen that jumps leaves a straighter line.
const MOST_PULLS: f32 = 4096.0;

/// The stabilized pen: a line that follows the pen.
#[derive(Clone)]
pub struct StabilizedPen {
    stabilizer: Stabilizer,
    /// The surface that lengths are measured on; absent: the canvas.
    measured: Option<SurfaceMetric>,
    /// The end of the line, and the last sample of the pen.
    line: Option<(Vec2, Sample)>,
}

impl StabilizedPen {
    /// With lengths in px of the canvas.
    pub fn new(stabilizer: Stabilizer) -> Self {
        Self { stabilizer, measured: None, line: None }
    }

    /// The stabilizer of a brush, with lengths in px of what the brush measures them on.
    pub fn of_brush(brush: &Brush, operator: Operator, scene: &Scene) -> Self {
        let measured = SurfaceMetric::of(scene, operator)
            .filter(|_| brush.stabilizer_on == DistanceMetric::Surface);
        Self { measured, ..Self::new(brush.stabilizer) }
    }

    /// Takes the pen's next sample; `None` while the line does not move.
    ///
    /// A sample whose position is not finite is passed on unchanged; the stroke skips it.
    pub fn push(&mut self, pen: Sample) -> Option<Sample> {
        if self.stabilizer == Stabilizer::None || !pen.at.is_finite() {
            return Some(pen);
        }
        let Some((end, last)) = self.line else {
            self.line = Some((pen.at, pen));
            return Some(pen);
        };
        let at = match self.stabilizer {
            Stabilizer::None => pen.at,
            Stabilizer::Average { weight } => self.trail_pen(end, last.at, pen.at, weight),
            Stabilizer::String { length_px } => self.pull_string(end, last.at, pen.at, length_px),
            Stabilizer::Lag { secs } => delay(end, &last, &pen, secs),
        };
        // A hostile jump may overflow f32: the line stays.
        let at = if at.is_finite() { at } else { end };
        self.line = Some((at, pen));
        (at != end).then_some(Sample { at, ..pen })
    }

    /// The rest of the way to where the pen lifts; `None` if the line is there already.
    pub fn finish(&mut self) -> Option<Sample> {
        let (end, last) = self.line.take()?;
        // A line that lags in time ends where it is.
        let is_done = end == last.at || matches!(self.stabilizer, Stabilizer::Lag { .. });
        (!is_done).then_some(last)
    }

    /// The length of a px in a direction, on what lengths are measured on.
    fn stretch(&self, at: Vec2, way: Vec2) -> f32 {
        self.measured.as_ref().map_or(1.0, |measured| measured.stretch(at, way))
    }

    /// The number of parts into which the pen's path is divided, each at most this long, px.
    fn parts(from: Vec2, to: Vec2, longest_px: f32) -> usize {
        (from.distance(to) / longest_px).ceil().max(1.0).min(MOST_PULLS) as usize
    }

    /// The end of a line that trails behind a pen; on a surface the lag has the same length
    /// everywhere, and looks shorter where the surface is tilted.
    fn trail_pen(&self, end: Vec2, from: Vec2, to: Vec2, weight: f32) -> Vec2 {
        let parts = if self.measured.is_some() { Self::parts(from, to, MEASURED_PX) } else { 1 };
        let at = |part: usize| from.lerp(to, part as f32 / parts as f32);
        (0..parts).fold(end, |end, part| {
            let (from, to) = (at(part), at(part + 1));
            trail(end, (from, to), self.stretch(from.midpoint(to), to - from), weight)
        })
    }

    /// The end of a string of this length whose other end is pulled straight from `from` to `to`.
    fn pull_string(&self, end: Vec2, from: Vec2, to: Vec2, length_px: f32) -> Vec2 {
        let (length_px, steps) = (length_px.max(0.0), Self::parts(from, to, PULL_PX));
        (1..=steps).fold(end, |end, step| {
            let hand = from.lerp(to, step as f32 / steps as f32);
            let string = end - hand;
            let length = string.length() * self.stretch(hand, string);
            if length > length_px { hand + string * (length_px / length) } else { end }
        })
    }
}

/// The end of a line that follows a pen from `from` to `to`: every px it makes up 1/ℓ of its lag,
/// e^(−10/ℓ) = weight. Exact for a pen that moves straight, so that samples between change nothing.
///
/// * `stretch`: the measured length of a px of the path.
fn trail(end: Vec2, (from, to): (Vec2, Vec2), stretch: f32, weight: f32) -> Vec2 {
    let weight = weight.max(0.0).min(MOST_WEIGHT);
    let way = to - from;
    let (length, lag) =
        (way.length(), if weight > 0.0 { -WEIGHED_PX / weight.ln() / stretch } else { 0.0 });
    if lag <= 0.0 || length <= 0.0 {
        return if lag <= 0.0 { to } else { end };
    }
    // Its final lag behind the pen.
    let behind = way / length * lag;
    to - behind + (end - from + behind) * (-length / lag).exp()
}

/// The end of a line that follows a pen in time. Exact for a pen that moves evenly, so that samples
/// between change nothing.
fn delay(end: Vec2, from: &Sample, to: &Sample, secs: f32) -> Vec2 {
    let elapsed = to.time_secs - from.time_secs;
    let is_late = secs > 0.0 && elapsed > 0.0;
    if !is_late {
        return if secs > 0.0 { end } else { to.at };
    }
    let behind = (to.at - from.at) / elapsed * secs;
    to.at - behind + (end - from.at + behind) * (-elapsed / secs).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec2, vec3};
    use crate::raster::Plane;
    use crate::surface::{Maps, Surface};
    use std::sync::Arc;

    /// The complete stabilized line of a pen.
    fn line(stabilizer: Stabilizer, pens: &[Vec2]) -> Vec<Vec2> {
        let mut stabilized = StabilizedPen::new(stabilizer);
        let mut line: Vec<Vec2> =
            pens.iter().filter_map(|&at| stabilized.push(Sample::at(at))).map(|s| s.at).collect();
        line.extend(stabilized.finish().map(|s| s.at));
        line
    }

    fn wiggle(step: f32) -> Vec<Vec2> {
        let n = (200.0 / step) as usize;
        (0..=n).map(|i| vec2(step * i as f32, 8.0 * (0.4 * step * i as f32).sin())).collect()
    }
    const CALM: [Stabilizer; 2] =
        [Stabilizer::Average { weight: 0.6 }, Stabilizer::String { length_px: 20.0 }];

    #[test]
    fn wiggles_flatten_and_the_line_ends_where_the_pen_lifts() {
        for stabilizer in CALM {
            let (pens, line) = (wiggle(1.0), line(stabilizer, &wiggle(1.0)));
            let reach =
                |points: &[Vec2]| points[60..150].iter().map(|p| p.y.abs()).fold(0.0, f32::max);
            assert!(reach(&line) < 0.5 * reach(&pens), "{stabilizer:?}: {}", reach(&line));
            assert_eq!((line.first(), line.last()), (pens.first(), pens.last()));
        }
    }

    #[test]
    fn how_densely_the_pen_reports_changes_the_line_little() {
        for stabilizer in CALM {
            let corner = |n: usize| {
                let leg =
                    |from: Vec2, to: Vec2| (0..n).map(move |i| from.lerp(to, i as f32 / n as f32));
                let (a, b, c) = (vec2(0.0, 0.0), vec2(100.0, 0.0), vec2(100.0, 80.0));
                let mut stabilized = StabilizedPen::new(stabilizer);
                let end = leg(a, b)
                    .chain(leg(b, c))
                    .chain([c])
                    .filter_map(|at| stabilized.push(Sample::at(at)))
                    .last();
                end.map(|sample| sample.at).unwrap_or_default()
            };
            assert!(
                corner(2).distance(corner(500)) < 0.2,
                "{stabilizer:?}: {} and {}",
                corner(2),
                corner(500)
            );
        }
    }

    #[test]
    fn a_straight_pull_trails_by_the_strings_length_and_by_the_averages_lag() {
        let to = vec2(300.0, 0.0);
        assert_eq!(
            StabilizedPen::new(CALM[1]).pull_string(Vec2::ZERO, Vec2::ZERO, to, 20.0),
            vec2(280.0, 0.0)
        );
        // e^(−10/ℓ) = 0.6: ℓ is 19.58 px.
        assert!((trail(Vec2::ZERO, (Vec2::ZERO, to), 1.0, 0.6).x - (300.0 - 19.576)).abs() < 0.01);
    }

    #[test]
    fn on_a_slope_the_line_trails_by_what_it_trails_by_on_the_surface() {
        // z falls by two px for each px to the right: n_z is 1/√5, and a px to the right is √5 px
        // long.
        let size = Size::new(400, 40);
        let slope = vec3(-2.0, 0.0, 1.0).normalize();
        let maps = Maps {
            normals: Plane::full(size, slope),
            depth: Plane::from_fn(size, |x, _| 1.0 - x as f32 / 400.0),
            coverage: Plane::full(size, 255),
        };
        let scene = Scene { size, surface: Some(Arc::new(Surface::new(maps).unwrap())) };
        let drawn = |stabilizer, stabilizer_on, way: Vec2| {
            let brush = Brush { stabilizer, stabilizer_on, ..Brush::default() };
            let mut pen = StabilizedPen::of_brush(&brush, Operator::None, &scene);
            let ends = (0..=10)
                .filter_map(|i| pen.push(Sample::at(vec2(20.0, 4.0) + way * (0.1 * i as f32))));
            (vec2(20.0, 4.0) + way).distance(ends.last().unwrap().at)
        };
        for (stabilizer, trails) in [(CALM[0], 19.576), (CALM[1], 20.0)] {
            let across = drawn(stabilizer, DistanceMetric::Surface, vec2(0.0, 32.0));
            let along = drawn(stabilizer, DistanceMetric::Surface, vec2(300.0, 0.0));
            assert!(
                (along - trails / 5.0f32.sqrt()).abs() < 0.02 * trails,
                "{stabilizer:?}: {along}"
            );
            let seen = drawn(stabilizer, DistanceMetric::Canvas, vec2(300.0, 0.0));
            assert!((seen - trails).abs() < 0.02 * trails, "{stabilizer:?}: {seen}");
            let flat = drawn(stabilizer, DistanceMetric::Canvas, vec2(0.0, 32.0));
            assert!(
                (across - flat).abs() < 0.01,
                "across the slope nothing is longer: {across} and {flat}"
            );
        }
    }

    #[test]
    fn a_tap_within_the_string_leaves_its_dot_and_reaches_the_pen() {
        assert_eq!(line(CALM[1], &[Vec2::ZERO, vec2(5.0, 0.0)]), [Vec2::ZERO, vec2(5.0, 0.0)]);
    }

    #[test]
    fn hostile_samples_and_settings_leave_the_line_finite() {
        for stabilizer in [
            Stabilizer::Average { weight: f32::NAN },
            Stabilizer::Average { weight: 7.0 },
            Stabilizer::String { length_px: f32::NAN },
            Stabilizer::String { length_px: -3.0 },
            Stabilizer::String { length_px: 0.0 },
        ] {
            let mut stabilized = StabilizedPen::new(stabilizer);
            for at in
                [Vec2::ZERO, Vec2::NAN, vec2(3e38, -3e38), vec2(f32::INFINITY, 0.0), vec2(9.0, 9.0)]
            {
                stabilized.push(Sample::at(at));
            }
            assert_eq!(stabilized.finish().map_or(vec2(9.0, 9.0), |s| s.at), vec2(9.0, 9.0));
        }
    }

    #[test]
    fn a_line_that_waits_trails_by_the_way_of_its_time_and_ends_there() {
        let pen = |i: usize| Sample {
            time_secs: 0.01 * i as f32,
            ..Sample::at(vec2(5.0 * i as f32, 0.0))
        };
        let drawn = |step: usize| {
            let mut stabilized = StabilizedPen::new(Stabilizer::Lag { secs: 0.1 });
            let last = (0..=200).step_by(step).filter_map(|i| stabilized.push(pen(i))).last();
            (last.map(|sample| sample.at.x).unwrap_or_default(), stabilized.finish())
        };
        // 500 px a second, a tenth of one late.
        assert!((drawn(1).0 - 950.0).abs() < 0.1 && drawn(1).1.is_none(), "{}", drawn(1).0);
        assert!((drawn(1).0 - drawn(20).0).abs() < 0.01, "however often the pen reports");
    }
}
