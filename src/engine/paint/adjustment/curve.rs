//! A curve of tones: a natural cubic spline through points. Floor 3.

/// A curve through points, held at the tones of its ends; never NaN.
#[derive(Clone, Debug, PartialEq)]
pub struct ToneCurve {
    /// Tone before and after, in `[0, 255]`; tones before rise from point to point.
    points: Vec<[f32; 2]>,
}

impl Default for ToneCurve {
    /// Changes nothing.
    fn default() -> Self {
        Self { points: vec![[0.0, 0.0], [255.0, 255.0]] }
    }
}

impl ToneCurve {
    /// Points of a curve: those that Photoshop allows.
    pub const MOST_POINTS: usize = 19;
    /// Points are at least this far from each other.
    const APART: f32 = 1.0;

    /// Points in any order; those that lie above each other or are no numbers are left out. The
    /// straight line if fewer than two are left.
    pub fn new(points: Vec<[f32; 2]>) -> Self {
        let mut points: Vec<[f32; 2]> = points
            .into_iter()
            .filter(|p| p.iter().all(|v| v.is_finite()))
            .map(|p| p.map(|v| v.clamp(0.0, 255.0)))
            .collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut kept: Vec<[f32; 2]> = Vec::new();
        for point in points {
            if kept.last().is_none_or(|last| point[0] - last[0] >= Self::APART) {
                kept.push(point);
            }
        }
        kept.truncate(Self::MOST_POINTS);
        if kept.len() < 2 { Self::default() } else { Self { points: kept } }
    }

    /// At least two, tones before and after, `[0, 255]`.
    pub fn points(&self) -> &[[f32; 2]] {
        &self.points
    }

    /// It changes nothing.
    pub fn is_straight(&self) -> bool {
        *self == Self::default()
    }

    /// The curve, ready to be read.
    pub fn spline(&self) -> ToneSpline {
        ToneSpline::natural(self.points.iter().map(|p| [p[0] / 255.0, p[1] / 255.0]).collect())
    }
}

/// A natural cubic spline: its second derivative is 0 at both ends and continuous between.
#[derive(Clone, Debug)]
pub struct ToneSpline {
    points: Vec<[f32; 2]>,
    /// The second derivative at each point.
    bends: Vec<f32>,
}

impl ToneSpline {
    /// Through points whose first coordinates rise; at least one.
    pub fn natural(points: Vec<[f32; 2]>) -> Self {
        let n = points.len();
        // The tridiagonal system of the second derivatives, eliminated from the first row down.
        let (mut factors, mut bends) = (vec![0.0; n], vec![0.0; n]);
        for i in 1..n.saturating_sub(1) {
            let [[x0, y0], [x1, y1], [x2, y2]] = [points[i - 1], points[i], points[i + 1]];
            let (before, after) = (x1 - x0, x2 - x1);
            let pivot = 2.0 * (before + after) - before * factors[i - 1];
            factors[i] = after / pivot;
            let turn = 6.0 * ((y2 - y1) / after - (y1 - y0) / before);
            bends[i] = (turn - before * bends[i - 1]) / pivot;
        }
        for i in (1..n.saturating_sub(1)).rev() {
            bends[i] -= factors[i] * bends[i + 1];
        }
        Self { points, bends }
    }

    /// The tone after `x`, constant beyond the ends, not clipped.
    pub fn at(&self, x: f32) -> f32 {
        let after = self.points.partition_point(|p| p[0] <= x);
        let (Some(&last), Some(i)) = (self.points.last(), after.checked_sub(1)) else {
            return self.points.first().map_or(x, |first| first[1]);
        };
        let Some(&[x1, y1]) = self.points.get(after) else { return last[1] };
        let [x0, y0] = self.points[i];
        let width = x1 - x0;
        let (a, b) = ((x1 - x) / width, (x - x0) / width);
        let bend = (a * a * a - a) * self.bends[i] + (b * b * b - b) * self.bends[after];
        a * y0 + b * y1 + bend * width * width / 6.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_passes_its_points_and_is_held_beyond_them() {
        let curve = ToneCurve::new(vec![[200.0, 220.0], [51.0, 25.5], [102.0, 127.5]]);
        let spline = curve.spline();
        for [x, y] in curve.points() {
            assert!((spline.at(x / 255.0) - y / 255.0).abs() < 1e-5);
        }
        assert_eq!(spline.at(0.0), 0.1);
        assert_eq!(spline.at(1.0), 220.0 / 255.0);
    }

    #[test]
    fn the_middle_of_three_points_bends_as_computed_by_hand() {
        // Through (0, 0), (1/2, 3/4), (1, 1): the second derivative in the middle is
        // 6 (1/2 − 3/2) / 2 = −3, so at 1/4 the value is 3/8 + (1/8 − 1/2)(−3)/24 = 27/64.
        let spline = ToneSpline::natural(vec![[0.0, 0.0], [0.5, 0.75], [1.0, 1.0]]);
        assert!((spline.at(0.25) - 27.0 / 64.0).abs() < 1e-6, "{}", spline.at(0.25));
    }

    #[test]
    fn hostile_points_give_a_finite_curve() {
        let points = vec![[f32::NAN, 3.0], [4.0, f32::INFINITY], [9.0, -7.0], [9.2, 900.0]];
        assert_eq!(ToneCurve::new(points), ToneCurve::default());
        let many = ToneCurve::new((0..400).map(|i| [i as f32, 255.0 * (i % 2) as f32]).collect());
        assert_eq!(many.points().len(), ToneCurve::MOST_POINTS);
        assert!((0..=100).all(|i| many.spline().at(i as f32 / 100.0).is_finite()));
    }
}
