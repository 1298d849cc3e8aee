//! A color ramp, read at a point or averaged over an interval in closed form.
//! Floor 3. Not here: which t a pixel has (`gradient`).

use crate::math::srgb::Color;

/// A color at a position of the ramp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GradientStop {
    /// In `[0, 1]`, never decreasing from stop to stop.
    pub t: f32,
    /// The color there; its alpha counts.
    pub color: Color,
}

/// The stops, sorted, with the integral of the premultiplied color up to each.
pub struct Ramp {
    /// One for each interval of nonzero length between neighboring stops.
    pieces: Vec<RampPiece>,
    /// Premultiplied, before the first piece and after the last.
    first: [f32; 4],
    last: [f32; 4],
}

/// Between two stops, with s = (t − start) / length: straight color and alpha are linear in s, so
/// the premultiplied color is a parabola a + b s + c s².
struct RampPiece {
    start: f32,
    length: f32,
    a: [f32; 4],
    b: [f32; 4],
    c: [f32; 4],
    /// ∫ of the premultiplied color from the first stop to `start`. Differences of it are divided
    /// by small widths: f64.
    before: [f64; 4],
}

impl RampPiece {
    fn between(from: GradientStop, to: GradientStop, before: [f64; 4]) -> Self {
        let (p, q) = (from.color.to_f32(), to.color.to_f32());
        // Alpha itself is linear: its factor, the fourth entry of `weight`, stays 1.
        let weight = |v: [f32; 4], i: usize| if i == 3 { 1.0 } else { v[3] };
        Self {
            start: from.t,
            length: to.t - from.t,
            a: std::array::from_fn(|i| p[i] * weight(p, i)),
            b: std::array::from_fn(|i| {
                (q[i] - p[i]) * weight(p, i) + p[i] * (weight(q, i) - weight(p, i))
            }),
            c: std::array::from_fn(|i| (q[i] - p[i]) * (weight(q, i) - weight(p, i))),
            before,
        }
    }

    fn at(&self, t: f32) -> [f32; 4] {
        let s = ((t - self.start) / self.length).max(0.0).min(1.0);
        std::array::from_fn(|i| self.a[i] + s * (self.b[i] + s * self.c[i]))
    }

    /// ∫ of the premultiplied color from the first stop to `t`, which lies in this piece.
    fn integral(&self, t: f32) -> [f64; 4] {
        let length = f64::from(self.length);
        let s = ((f64::from(t) - f64::from(self.start)) / length).max(0.0).min(1.0);
        std::array::from_fn(|i| {
            let [a, b, c] = [self.a[i], self.b[i], self.c[i]].map(f64::from);
            self.before[i] + length * s * (a + s * (b / 2.0 + s * c / 3.0))
        })
    }
}

impl Ramp {
    /// `None` without a stop at a finite position. Stops out of order are sorted; of two at one
    /// position the later wins there.
    pub fn new(stops: &[GradientStop]) -> Option<Self> {
        let mut stops: Vec<GradientStop> =
            stops.iter().copied().filter(|s| s.t.is_finite()).collect();
        stops.sort_by(|a, b| a.t.total_cmp(&b.t));
        let (first, last) =
            (stops.first()?.color.premultiplied(), stops.last()?.color.premultiplied());
        let mut pieces: Vec<RampPiece> = Vec::new();
        for pair in stops.windows(2).filter(|pair| pair[1].t > pair[0].t) {
            let before = pieces.last().map_or([0.0; 4], |p| p.integral(p.start + p.length));
            pieces.push(RampPiece::between(pair[0], pair[1], before));
        }
        Some(Self { pieces, first, last })
    }

    /// The piece that holds `t`, or the color before the first or after the last piece.
    fn piece(&self, t: f32) -> Result<&RampPiece, [f32; 4]> {
        let i = self.pieces.partition_point(|p| p.start <= t);
        match i.checked_sub(1).and_then(|i| self.pieces.get(i)) {
            None => Err(self.first),
            Some(p) if i == self.pieces.len() && t >= p.start + p.length => Err(self.last),
            Some(p) => Ok(p),
        }
    }

    /// The premultiplied encoded color at `t`, clamped to `[0, 1]`.
    pub fn at(&self, t: f32) -> [f32; 4] {
        let t = t.max(0.0).min(1.0);
        self.piece(t).map_or_else(|color| color, |p| p.at(t))
    }

    /// The mean of the premultiplied color over `[t − width/2, t + width/2]`, positions beyond
    /// `[0, 1]` clamped.
    ///
    /// In closed form, so it equals the mean of any number of samples. Widths too small to matter
    /// read the point.
    pub fn mean(&self, t: f32, width: f32) -> [f32; 4] {
        // A ten-thousandth of the ramp changes no byte unless two stops coincide, where the edge is
        // equally sharp.
        if width.is_nan() || width < 1e-4 {
            return self.at(t);
        }
        // A footprint wider than this covers only the two ends; the bound keeps infinities out.
        let half = width.min(1e6) / 2.0;
        let t = t.max(-1e6).min(1e6);
        let (low, high) = (self.integral(t - half), self.integral(t + half));
        let width = f64::from(t + half) - f64::from(t - half);
        std::array::from_fn(|i| ((high[i] - low[i]) / width) as f32)
    }

    /// The same of a ramp whose end meets its beginning, positions beyond `[0, 1]` wrapped.
    pub fn closed_mean(&self, t: f32, width: f32) -> [f32; 4] {
        if width.is_nan() || width < 1e-4 {
            return self.at(t);
        }
        let half = width.min(1e3) / 2.0;
        let t = t.max(-1e3).min(1e3);
        let (begin, end) = (self.integral(0.0), self.integral(1.0));
        let integral = |t: f32| {
            let turns = t.floor();
            let inside = self.integral(t - turns);
            std::array::from_fn::<f64, 4, _>(|i| f64::from(turns) * (end[i] - begin[i]) + inside[i])
        };
        let (low, high) = (integral(t - half), integral(t + half));
        let width = f64::from(t + half) - f64::from(t - half);
        std::array::from_fn(|i| ((high[i] - low[i]) / width) as f32)
    }

    /// ∫ of the premultiplied color from some fixed position to `t`; linear beyond `[0, 1]`.
    fn integral(&self, t: f32) -> [f64; 4] {
        let inside = t.max(0.0).min(1.0);
        let from_first = |t: f32| match self.piece(t) {
            Ok(p) => p.integral(t),
            Err(color) => {
                // Before the first piece the color is constant and the integral negative; after
                // the last it continues.
                let (from, before) = match self.pieces.as_slice() {
                    [first, ..] if t < first.start => (first.start, [0.0; 4]),
                    [.., last] => {
                        (last.start + last.length, last.integral(last.start + last.length))
                    }
                    [] => (0.0, [0.0; 4]),
                };
                std::array::from_fn(|i| {
                    before[i] + f64::from(color[i]) * (f64::from(t) - f64::from(from))
                })
            }
        };
        let edge = self.at(inside);
        let base = from_first(inside);
        std::array::from_fn(|i| base[i] + f64::from(edge[i]) * (f64::from(t) - f64::from(inside)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::srgb::Color;

    fn stop(t: f32, text: &str) -> GradientStop {
        GradientStop { t, color: Color::parse(text).unwrap() }
    }

    fn assert_near(a: [f32; 4], b: [f32; 4], tolerance: f32) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance), "{a:?} is not {b:?}");
    }

    #[test]
    fn halfway_between_two_stops_stands_the_mean_of_their_straight_colors() {
        let ramp = Ramp::new(&[stop(0.0, "#ff000000"), stop(1.0, "#00ff00ff")]).unwrap();
        assert_near(ramp.at(0.5), [0.25, 0.25, 0.0, 0.5], 1e-6);
        assert_near(ramp.at(-3.0), [0.0; 4], 0.0);
        assert_near(ramp.at(3.0), [0.0, 1.0, 0.0, 1.0], 0.0);
    }

    #[test]
    fn the_mean_equals_many_samples() {
        let stops = [
            stop(0.1, "#ff8000ff"),
            stop(0.4, "#0000ff20"),
            stop(0.4, "#ffffffff"),
            stop(0.9, "#10203040"),
        ];
        let ramp = Ramp::new(&stops).unwrap();
        for (t, width) in
            [(0.5, 0.3), (0.05, 0.5), (0.4, 0.01), (0.95, 2.0), (-0.5, 3.0), (1.4, 0.2)]
        {
            let n = 20_000;
            let mut sum = [0.0f64; 4];
            for i in 0..n {
                let at = ramp.at(t + width * ((i as f32 + 0.5) / n as f32 - 0.5));
                (0..4).for_each(|c| sum[c] += f64::from(at[c]) / f64::from(n));
            }
            assert_near(ramp.mean(t, width), sum.map(|v| v as f32), 2e-4);
        }
    }

    #[test]
    fn the_closed_mean_goes_on_at_the_beginning() {
        let stops = [stop(0.2, "#ff8000ff"), stop(0.7, "#0000ff20"), stop(0.9, "#ffffffff")];
        let ramp = Ramp::new(&stops).unwrap();
        for (t, width) in [(0.5, 0.3), (0.02, 0.2), (0.97, 0.5), (0.5, 3.0)] {
            let n = 20_000;
            let mut sum = [0.0f64; 4];
            for i in 0..n {
                let at = t + width * ((i as f32 + 0.5) / n as f32 - 0.5);
                let at = ramp.at(at.rem_euclid(1.0));
                (0..4).for_each(|c| sum[c] += f64::from(at[c]) / f64::from(n));
            }
            assert_near(ramp.closed_mean(t, width), sum.map(|v| v as f32), 5e-4);
        }
    }

    #[test]
    fn stops_out_of_order_are_sorted_and_one_stop_is_a_plain_color() {
        let sorted =
            Ramp::new(&[stop(0.0, "#000000"), stop(0.5, "#ff0000"), stop(1.0, "#ffffff")]).unwrap();
        let mixed =
            Ramp::new(&[stop(1.0, "#ffffff"), stop(0.0, "#000000"), stop(0.5, "#ff0000")]).unwrap();
        assert_eq!(sorted.at(0.3), mixed.at(0.3));
        let one = Ramp::new(&[stop(0.7, "#336699")]).unwrap();
        assert_near(one.at(0.1), Color::parse("#336699").unwrap().premultiplied(), 1e-6);
        assert_near(one.mean(0.9, 5.0), one.at(0.1), 1e-6);
        assert!(Ramp::new(&[]).is_none());
        assert!(Ramp::new(&[stop(f32::NAN, "#000000")]).is_none());
    }

    #[test]
    fn no_place_and_no_width_gives_a_value_that_is_not_a_color() {
        let ramp = Ramp::new(&[stop(0.0, "#ff000000"), stop(1.0, "#00ff00ff")]).unwrap();
        for t in [f32::NAN, f32::INFINITY, -f32::INFINITY, 1e30] {
            for width in [f32::NAN, 0.0, 1.0, f32::INFINITY] {
                assert!(
                    ramp.mean(t, width).iter().all(|v| (-1e-6..=1.0 + 1e-6).contains(v)),
                    "t {t}, width {width}"
                );
            }
        }
    }
}
