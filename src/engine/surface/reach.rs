//! How far from the pen a bent mark may land. On a rugged surface the normals or depths that a dab
//! is painted by come back far away, and the dab with them; within its reach it stays near the pen.
//! Floor 2. Part of D of a dab (`deformation`), so that filters see a soft border and not a cut.

use crate::math::{Rect, Vec2, vec2};

/// The share of the reach within which a mark lands unchanged; beyond, it fades out to the border.
const FULL: f32 = 0.75;

/// A disc about the pen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DabReach {
    at: Vec2,
    border_px: f32,
    push_px: f32,
}

impl DabReach {
    /// `None`: anywhere.
    ///
    /// * `at`: q_0, canvas px.
    /// * `border_px`: the disc's radius; infinite, or not a number above 0, is anywhere.
    /// * `push_px`: beyond this distance in the image plane no footprint covers anything.
    pub fn new(at: Vec2, border_px: f32, push_px: f32) -> Option<Self> {
        (border_px > 0.0 && border_px.is_finite() && at.is_finite()).then_some(Self {
            at,
            border_px,
            push_px,
        })
    }

    /// Farther from the pen than this, px, nothing lands.
    pub fn border_px(&self) -> f32 {
        self.border_px
    }

    /// Whether any pixel of a rectangle is so far from the pen that D changes there.
    pub fn is_near(&self, rect: Rect) -> bool {
        let far =
            |low: i32, high: i32, at: f32| (low as f32 - at).abs().max((high as f32 - at).abs());
        let corner = vec2(far(rect.x0, rect.x1, self.at.x), far(rect.y0, rect.y1, self.at.y));
        corner.length() > FULL * self.border_px
    }

    /// D(q), pushed out of the footprint as q nears the border: `D + push · t · (D − q_0) / |D −
    /// q_0|`, where t rises from 0 at `FULL` of the reach to 1 at its border.
    pub fn limit(&self, q: Vec2, d: Vec2) -> Vec2 {
        let t = (q.distance(self.at) / self.border_px - FULL) / (1.0 - FULL);
        if t <= 0.0 {
            return d;
        }
        // At the very center every way leads out.
        let away = (d - self.at).try_normalize().unwrap_or(Vec2::X);
        d + away * (self.push_px * t.min(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_the_pen_nothing_changes_and_beyond_the_border_nothing_lands() {
        let reach = DabReach::new(vec2(50.0, 40.0), 20.0, 9.0).unwrap();
        let splatter = vec2(50.5, 40.0);
        assert_eq!(reach.limit(vec2(60.0, 40.0), splatter), splatter);
        for far in [vec2(70.5, 40.0), vec2(50.0, 400.0)] {
            assert!(reach.limit(far, splatter).distance(vec2(50.0, 40.0)) >= 9.0);
            assert!(reach.limit(far, vec2(50.0, 40.0)).distance(vec2(50.0, 40.0)) >= 9.0);
        }
    }

    #[test]
    fn the_border_is_soft() {
        let reach = DabReach::new(Vec2::ZERO, 20.0, 9.0).unwrap();
        let pushed = |q: f32| reach.limit(vec2(q, 0.0), vec2(1.0, 0.0)).x;
        for step in 0..200 {
            let q = step as f32 * 0.15;
            let grown = pushed(q + 0.15) - pushed(q);
            assert!((0.0..=0.3).contains(&grown), "{q}: {grown}");
        }
    }

    #[test]
    fn no_reach_is_anywhere() {
        for none in [0.0, -1.0, f32::INFINITY, f32::NAN] {
            assert_eq!(DabReach::new(Vec2::ZERO, none, 1.0), None);
        }
    }
}
