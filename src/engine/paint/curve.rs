//! The smooth curve through the samples of a stroke, segment by segment.
//! Floor 3. Not here: the dabs along it (`dab_walker`).

use crate::math::Vec2;

/// Samples nearer to each other than this count as one.
pub const SAME_PX: f32 = 1e-3;

/// The curve between two samples: a centripetal Catmull-Rom spline (Barry and Goldman 1988; Yuksel
/// et al. 2011: no cusp or loop within a segment).
#[derive(Clone, Copy)]
pub struct CurveSegment {
    from: Vec2,
    to: Vec2,
    /// Its derivatives at both ends.
    out: Vec2,
    into: Vec2,
}

impl CurveSegment {
    /// From `from` to `to`, with the neighbors `before` and `after`; without a neighbor that end
    /// is straight.
    pub fn new(before: Option<Vec2>, from: Vec2, to: Vec2, after: Option<Vec2>) -> Self {
        let (before, after) = (before.unwrap_or(2.0 * from - to), after.unwrap_or(2.0 * to - from));
        let (out, into) = tangents([before, from, to, after]);
        Self { from, to, out, into }
    }

    /// The direction at its start.
    pub fn out(&self) -> Vec2 {
        self.out
    }

    /// The number of straight pieces that approximate it: two px each, at most 128; a longer one is
    /// nearly straight.
    pub fn pieces(&self) -> usize {
        let length =
            self.from.distance(self.to).max((self.out.length() + self.into.length()) / 3.0);
        (length / 2.0).ceil().max(1.0).min(128.0) as usize
    }

    /// The point at a ratio in `[0, 1]` along it.
    pub fn at(&self, s: f32) -> Vec2 {
        hermite(self.from, self.out, self.to, self.into, s)
    }
}

/// The curve's derivatives at the two inner points, over the segment between them, with knots at
/// √distance.
fn tangents([p0, p1, p2, p3]: [Vec2; 4]) -> (Vec2, Vec2) {
    let [d0, d1, d2] =
        [p0.distance(p1), p1.distance(p2), p2.distance(p3)].map(|d| d.max(SAME_PX).sqrt());
    let m1 = (p1 - p0) / d0 - (p2 - p0) / (d0 + d1) + (p2 - p1) / d1;
    let m2 = (p2 - p1) / d1 - (p3 - p1) / (d1 + d2) + (p3 - p2) / d2;
    (m1 * d1, m2 * d1)
}

fn hermite(p1: Vec2, m1: Vec2, p2: Vec2, m2: Vec2, s: f32) -> Vec2 {
    let (s2, s3) = (s * s, s * s * s);
    p1 * (2.0 * s3 - 3.0 * s2 + 1.0)
        + m1 * (s3 - 2.0 * s2 + s)
        + p2 * (3.0 * s2 - 2.0 * s3)
        + m2 * (s3 - s2)
}
