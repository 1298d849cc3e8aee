//! Tubes along smooth curves: a uniform cubic B-spline in space whose radius is a spline too.
//! Exact distance by Newton's method, so normals and curvature have no facets.

use glam::{DVec3, DVec4};

/// Samples per span for the coarse search; enough that each bracket holds one minimum.
const SAMPLES_PER_SPAN: usize = 6;
/// Newton steps from the coarse minimum; four already reach 1e-10 on the sample objects.
const NEWTON_STEPS: usize = 5;
/// Beyond this a lower bound replaces the distance. Wider than any blend between a tube and its
/// neighbors.
const FAR: f64 = 0.16;

/// A tube of varying radius along a cubic B-spline.
pub struct Tube {
    /// Control points (x, y, z, radius) with the ends repeated (open) or wrapped (closed).
    control: Vec<DVec4>,
    /// Per span: a bounding sphere (center, radius with the tube's own).
    bounds: Vec<(DVec3, f64)>,
    /// Per span: the coarse samples, `SAMPLES_PER_SPAN + 1` each.
    samples: Vec<DVec4>,
}

/// Position and first two derivatives of the curve, radius in w.
struct Jet(DVec4, DVec4, DVec4);

impl Tube {
    /// An open tube; the spline starts and ends at the first and last control point, with round
    /// caps.
    pub fn open(control: &[DVec4]) -> Self {
        let (first, last) = (control[0], control[control.len() - 1]);
        // Reflected phantom points make the spline pass through its ends with a live tangent.
        let before = first * 2.0 - control[1];
        let after = last * 2.0 - control[control.len() - 2];
        Self::from_padded([&[before], control, &[after]].concat())
    }

    /// A closed tube.
    pub fn closed(control: &[DVec4]) -> Self {
        Self::from_padded([control, &control[..3]].concat())
    }

    /// An open tube close to every given point, for shapes drawn by hand.
    ///
    /// A Catmull–Rom curve through the points is resampled and used as control points: what it
    /// lacks in second derivatives the spline restores.
    pub fn through(points: &[DVec4]) -> Self {
        const RESAMPLE: usize = 3;
        let at = |i: isize| points[i.clamp(0, points.len() as isize - 1) as usize];
        let mut control = Vec::with_capacity(points.len() * RESAMPLE);
        for i in 0..points.len() as isize - 1 {
            let (a, b, c, d) = (at(i - 1), at(i), at(i + 1), at(i + 2));
            for step in 0..RESAMPLE {
                let t = step as f64 / RESAMPLE as f64;
                let bend = (a * 2.0 - b * 5.0 + c * 4.0 - d) * t * t
                    + (b * 3.0 - a - c * 3.0 + d) * t * t * t;
                control.push(b + ((c - a) * t + bend) * 0.5);
            }
        }
        control.push(points[points.len() - 1]);
        Self::open(&control)
    }

    fn from_padded(control: Vec<DVec4>) -> Self {
        let mut tube = Self { control, bounds: Vec::new(), samples: Vec::new() };
        for span in 0..tube.control.len() - 3 {
            let points = (0..=SAMPLES_PER_SPAN).map(|i| i as f64 / SAMPLES_PER_SPAN as f64);
            let points: Vec<DVec4> = points.map(|t| tube.jet(span, t).0).collect();
            let hull = &tube.control[span..span + 4];
            let center = hull.iter().map(|c| c.truncate()).sum::<DVec3>() / 4.0;
            let reach =
                points.iter().map(|s| s.truncate().distance(center) + s.w).fold(0.0, f64::max);
            // Between samples the curve leaves their hull by less than this share.
            tube.bounds.push((center, reach * 1.05));
            tube.samples.extend(points);
        }
        tube
    }

    fn jet(&self, span: usize, t: f64) -> Jet {
        let c = &self.control[span..span + 4];
        let s = 1.0 - t;
        let (t2, t3) = (t * t, t * t * t);
        let at = (c[0] * s * s * s
            + c[1] * (3.0 * t3 - 6.0 * t2 + 4.0)
            + c[2] * (-3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0)
            + c[3] * t3)
            / 6.0;
        let d1 = (c[0] * (-s * s)
            + c[1] * (3.0 * t2 - 4.0 * t)
            + c[2] * (-3.0 * t2 + 2.0 * t + 1.0)
            + c[3] * t2)
            * 0.5;
        let d2 = c[0] * s + c[1] * (3.0 * t - 2.0) + c[2] * (1.0 - 3.0 * t) + c[3] * t;
        Jet(at, d1, d2)
    }

    /// Signed distance to the tube.
    pub fn distance(&self, p: DVec3) -> f64 {
        self.nearest(p).0
    }

    /// Signed distance, and where along the tube (in spans) the nearest point lies. Farther than
    /// [`FAR`]: a lower bound, and the span it comes from.
    pub fn nearest(&self, p: DVec3) -> (f64, f64) {
        let lower = |span: usize| p.distance(self.bounds[span].0) - self.bounds[span].1;
        let mut first = (f64::INFINITY, 0);
        for span in 0..self.bounds.len() {
            let bound = lower(span);
            if bound < first.0 {
                first = (bound, span);
            }
        }
        if first.0 > FAR {
            return (first.0, first.1 as f64);
        }
        let mut best = self.nearest_in_span(first.1, p, f64::INFINITY);
        for span in 0..self.bounds.len() {
            if span != first.1 && lower(span) < best.0 {
                let found = self.nearest_in_span(span, p, best.0);
                if found.0 < best.0 {
                    best = found;
                }
            }
        }
        best
    }

    /// As [`Self::nearest`] within one span; coarse where it cannot come below `best`.
    fn nearest_in_span(&self, span: usize, p: DVec3, best: f64) -> (f64, f64) {
        let row = &self.samples[span * (SAMPLES_PER_SPAN + 1)..(span + 1) * (SAMPLES_PER_SPAN + 1)];
        let coarse = row.iter().map(|s| p.distance(s.truncate()) - s.w).enumerate();
        let (index, found) = coarse.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0));
        // The true minimum lies at most half a sample step from the coarse one.
        if found - row[0].distance(row[SAMPLES_PER_SPAN]).max(row[0].distance(row[1]) * 2.0) > best
        {
            return (found, span as f64);
        }
        let step = 1.0 / SAMPLES_PER_SPAN as f64;
        let (low, high) =
            ((index as f64 - 1.0).max(0.0) * step, ((index + 1) as f64 * step).min(1.0));
        let mut t = index as f64 * step;
        for _ in 0..NEWTON_STEPS {
            let Jet(at, d1, d2) = self.jet(span, t);
            let e = at.truncate() - p;
            let m = e.length().max(1e-9);
            let slope = e.dot(d1.truncate()) / m;
            let g1 = slope - d1.w;
            let g2 =
                (d1.truncate().length_squared() + e.dot(d2.truncate()) - slope * slope) / m - d2.w;
            let next = if g2 > 1e-12 { t - g1 / g2 } else { t - g1.signum() * step * 0.25 };
            let moved = (next.clamp(low, high) - t).abs();
            t = next.clamp(low, high);
            if moved < 1e-9 {
                break;
            }
        }
        let at = self.jet(span, t).0;
        (p.distance(at.truncate()) - at.w, span as f64 + t)
    }
}
