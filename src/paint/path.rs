//! From the pen's samples to dabs: a smooth curve through the samples, walked at even steps of arc length.
//! Floor 3. Not here: what a dab looks like (`profile`, `stamp`), where it lands (`dab`).

use super::brush::Brush;
use super::stroke::Sample;
use crate::math::Vec2;

/// Farther from the canvas's corner than any canvas reaches: such samples are a broken pen's.
const FAR_PX: f32 = 1e6;
/// Samples nearer than this are one.
const SAME_PX: f32 = 1e-3;
/// The smallest step between dabs. Below it neighbouring dabs of any size are the same to a byte.
const MIN_STEP_PX: f32 = 0.1;
/// A dab due this soon after a piece of the curve ends stands on its end: sums of lengths are rounded.
const ROUNDING_PX: f64 = 1e-3;
/// The most steps along a stroke, so that a hostile one ends: a hundred canvases' width of the smallest steps.
const MAX_STEPS: usize = 1 << 20;

/// The smallest dab, a little wider than a pixel.
const PIXEL_RADIUS_PX: f32 = 0.75;

/// One placement of the footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dab {
    /// q_0: its centre and its one anchor, canvas px.
    pub at: Vec2,
    /// Of the undeformed footprint, px; positive.
    pub radius: f32,
    /// Counter-clockwise as seen.
    pub rotation_rad: f32,
    /// See [`Brush::hardness`], [`Brush::softness`].
    pub hardness: f32,
    pub softness: f32,
    /// Coverage that it adds, `(0, 1]`.
    pub flow: f32,
}

impl Dab {
    /// The dab that a brush leaves under a pen; `None` where nothing would be seen.
    fn of(brush: &Brush, pen: Pen) -> Option<Self> {
        let (radius, flow) = (0.5 * diameter(brush, pen), brush.flow * brush.dynamics.flow.factor(pen.pressure));
        // Comparisons that NaN fails.
        let is_seen = radius > 0.01 && radius <= FAR_PX && flow > 0.0;
        let unit = |v: f32| v.max(0.0).min(1.0);
        // A dab smaller than a pixel is a fainter one of a pixel's size: what it covers is the same.
        let share = (radius / PIXEL_RADIUS_PX).min(1.0);
        let flow = flow * share * share;
        is_seen.then(|| Self {
            at: pen.at,
            radius: radius.max(PIXEL_RADIUS_PX),
            rotation_rad: if brush.rotation.is_finite() { brush.rotation.to_radians() } else { 0.0 },
            hardness: unit(brush.hardness),
            softness: unit(brush.softness),
            flow: unit(flow),
        })
    }
}

fn diameter(brush: &Brush, pen: Pen) -> f32 {
    brush.size * brush.dynamics.size.factor(pen.pressure)
}

/// The pen between two samples.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pen {
    at: Vec2,
    pressure: f32,
}

impl Pen {
    fn lerp(self, to: Pen, s: f32) -> Pen {
        Pen { at: self.at.lerp(to.at, s), pressure: self.pressure + (to.pressure - self.pressure) * s }
    }
}

/// The dabs of a stroke: the first at its first sample, each next `spacing` diameters further along the curve.
///
/// Independent of how densely the curve was sampled. Samples that are not finite are dropped.
pub fn dabs(brush: &Brush, samples: &[Sample]) -> Vec<Dab> {
    let pens = cleaned(samples);
    let Some(&first) = pens.first() else { return Vec::new() };
    let mut dabs: Vec<Dab> = Dab::of(brush, first).into_iter().collect();
    // A step that is not a number must not stop the walk.
    let step = |pen| f64::from((brush.spacing * diameter(brush, pen)).max(MIN_STEP_PX));
    let mut to_next = step(first);
    let mut steps = 0;
    let mut from = first;
    for_each_point(&pens, |to| {
        let length = f64::from(from.at.distance(to.at));
        let mut walked = 0.0;
        while walked + to_next <= length + ROUNDING_PX && steps < MAX_STEPS {
            walked += to_next;
            let pen = from.lerp(to, (walked / length).min(1.0) as f32);
            dabs.extend(Dab::of(brush, pen));
            to_next = step(pen);
            steps += 1;
        }
        to_next -= length - walked;
        from = to;
    });
    dabs
}

/// Finite samples, pressures in `[0, 1]`; of samples at one place, the heaviest.
fn cleaned(samples: &[Sample]) -> Vec<Pen> {
    let mut pens: Vec<Pen> = Vec::with_capacity(samples.len());
    for s in samples {
        if s.at.abs().max_element() > FAR_PX || !s.at.is_finite() || !s.pressure.is_finite() {
            continue;
        }
        let pen = Pen { at: s.at, pressure: s.pressure.clamp(0.0, 1.0) };
        match pens.last_mut() {
            Some(last) if last.at.distance(pen.at) < SAME_PX => last.pressure = last.pressure.max(pen.pressure),
            _ => pens.push(pen),
        }
    }
    pens
}

/// Visits the curve through the pens, after the first, as points near enough for straight lines between them.
///
/// A centripetal Catmull-Rom spline (Barry and Goldman 1988; Yuksel et al. 2011: no cusp or loop within a segment),
/// its ends continued straight.
fn for_each_point(pens: &[Pen], mut visit: impl FnMut(Pen)) {
    for i in 1..pens.len() {
        let (p1, p2) = (pens[i - 1], pens[i]);
        let p0 = if i >= 2 { pens[i - 2].at } else { 2.0 * p1.at - p2.at };
        let p3 = pens.get(i + 1).map_or(2.0 * p2.at - p1.at, |p| p.at);
        let (m1, m2) = tangents([p0, p1.at, p2.at, p3]);
        // Two px a piece; a segment so long that it takes more than 128 is nearly straight.
        let length = p1.at.distance(p2.at).max((m1.length() + m2.length()) / 3.0);
        let pieces = (length / 2.0).ceil().max(1.0).min(128.0) as usize;
        for piece in 1..=pieces {
            let s = piece as f32 / pieces as f32;
            visit(Pen { at: hermite(p1.at, m1, p2.at, m2, s), ..p1.lerp(p2, s) });
        }
    }
}

/// The curve's derivatives at the two inner points, over the segment between them, with knots at √distance.
fn tangents([p0, p1, p2, p3]: [Vec2; 4]) -> (Vec2, Vec2) {
    let [d0, d1, d2] = [p0.distance(p1), p1.distance(p2), p2.distance(p3)].map(|d| d.max(SAME_PX).sqrt());
    let m1 = (p1 - p0) / d0 - (p2 - p0) / (d0 + d1) + (p2 - p1) / d1;
    let m2 = (p2 - p1) / d1 - (p3 - p1) / (d1 + d2) + (p3 - p2) / d2;
    (m1 * d1, m2 * d1)
}

fn hermite(p1: Vec2, m1: Vec2, p2: Vec2, m2: Vec2, s: f32) -> Vec2 {
    let (s2, s3) = (s * s, s * s * s);
    p1 * (2.0 * s3 - 3.0 * s2 + 1.0) + m1 * (s3 - 2.0 * s2 + s) + p2 * (3.0 * s2 - 2.0 * s3) + m2 * (s3 - s2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use crate::paint::{Drive, Dynamics};

    fn brush(size: f32) -> Brush {
        Brush { size, spacing: 0.25, ..Brush::default() }
    }
    fn line(n: usize) -> Vec<Sample> {
        (0..n).map(|i| Sample::at(vec2(10.0, 20.0).lerp(vec2(110.0, 95.0), i as f32 / (n - 1) as f32))).collect()
    }

    #[test]
    fn dabs_stand_a_share_of_their_diameter_apart() {
        let dabs = dabs(&brush(20.0), &line(2));
        assert_eq!(dabs.len(), 26, "125 px in steps of 5, and the first");
        for pair in dabs.windows(2) {
            assert!((pair[0].at.distance(pair[1].at) - 5.0).abs() < 1e-3);
        }
        assert_eq!(dabs[0].at, vec2(10.0, 20.0));
        assert_eq!(dabs[0].radius, 10.0);
    }
    #[test]
    fn dabs_do_not_depend_on_how_densely_a_line_was_sampled() {
        let (few, many) = (dabs(&brush(20.0), &line(2)), dabs(&brush(20.0), &line(1234)));
        assert!(few.len().abs_diff(many.len()) <= 1, "{} and {}", few.len(), many.len());
        for (a, b) in few.iter().zip(&many) {
            assert!(a.at.distance(b.at) < 0.01, "{} and {}", a.at, b.at);
        }
    }
    #[test]
    fn a_circle_sampled_at_twelve_points_stays_round() {
        let on_circle = |i: usize| vec2(200.0, 200.0) + 100.0 * Vec2::from_angle(i as f32 * std::f32::consts::PI / 6.0);
        let samples: Vec<Sample> = (0..14).map(|i| Sample::at(on_circle(i))).collect();
        // Away from its ends, where the curve does not know how it goes on.
        for dab in dabs(&brush(10.0), &samples).iter().filter(|d| d.at.distance(on_circle(0)) > 60.0) {
            let radius = dab.at.distance(vec2(200.0, 200.0));
            assert!((radius - 100.0).abs() < 0.25, "{radius}");
        }
    }
    #[test]
    fn the_curve_passes_through_every_sample() {
        let samples: Vec<Sample> =
            [(0.0, 0.0), (30.0, 5.0), (32.0, 40.0), (90.0, 41.0)].map(|(x, y)| Sample::at(vec2(x, y))).into();
        let dabs = dabs(&Brush { size: 1.0, ..brush(1.0) }, &samples);
        for s in &samples {
            assert!(dabs.iter().any(|d| d.at.distance(s.at) < 0.3), "{}", s.at);
        }
    }
    #[test]
    fn one_sample_and_many_at_one_place_leave_one_dab() {
        let one = dabs(&brush(20.0), &[Sample::at(vec2(5.0, 5.0))]);
        assert_eq!(one.len(), 1);
        let pressed: Vec<Sample> =
            [0.2, 0.9, 0.4].map(|pressure| Sample { pressure, ..Sample::at(vec2(5.0, 5.0)) }).into();
        let dabs = dabs(&brush(20.0), &pressed);
        assert_eq!((dabs.len(), dabs[0].flow), (1, 0.9));
    }
    #[test]
    fn pressure_drives_what_the_dynamics_say() {
        let dynamics = Dynamics { size: Drive { pressure: 0.5 }, flow: Drive { pressure: 1.0 } };
        let brush = Brush { dynamics, ..brush(20.0) };
        let dab = dabs(&brush, &[Sample { pressure: 0.5, ..Sample::at(Vec2::ONE) }])[0];
        assert_eq!((dab.radius, dab.flow), (7.5, 0.5));
        let none = dabs(&brush, &[Sample { pressure: 0.0, ..Sample::at(Vec2::ONE) }]);
        assert!(none.is_empty(), "without pressure nothing flows");
    }
    #[test]
    fn hostile_samples_are_dropped_and_hostile_brushes_paint_nothing() {
        let mut samples = line(5);
        let clean = dabs(&brush(20.0), &samples);
        for (i, bad) in [f32::NAN, f32::INFINITY, -1e30].into_iter().enumerate() {
            samples.insert(2 * i, Sample::at(vec2(bad, 3.0)));
            samples.push(Sample { pressure: f32::NAN, ..Sample::at(vec2(3.0, 3.0)) });
        }
        assert_eq!(dabs(&brush(20.0), &samples), clean);
        for size in [f32::NAN, f32::INFINITY, 0.0, -5.0] {
            assert!(dabs(&brush(size), &line(3)).is_empty(), "{size}");
        }
        let ends = [Sample::at(vec2(-9e5, 0.0)), Sample::at(vec2(9e5, 0.0))];
        assert!(dabs(&Brush { spacing: f32::NAN, ..brush(1.0) }, &ends).len() <= MAX_STEPS + 1);
    }
}
