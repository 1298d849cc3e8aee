//! How a ramp runs between two points: which position a pixel has on it, and how fast that changes.
//! Floor 3. Not here: its colors (`ramp`), how it is bent (`gradient`), the rectangle that an effect
//! fills (`effect`).

use crate::math::{Vec2, vec2};
use std::f32::consts::TAU;

crate::named! {
    /// How a ramp runs.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum RampStyle {
        /// Straight.
        #[default]
        Linear = "linear" => "Linear",
        /// From the middle outward.
        Radial = "radial" => "Radial",
        /// Around the middle.
        Angle = "angle" => "Angle",
        /// Straight, both ways from the middle.
        Reflected = "reflected" => "Reflected",
        /// From the middle outward in a diamond.
        Diamond = "diamond" => "Diamond",
    }
}

impl RampStyle {
    /// The position on the ramp, not clamped.
    ///
    /// * `p`: along the line from its beginning to its end, whose length is 1, and across it, down
    ///   where the line runs to the right.
    pub fn position(self, p: Vec2) -> f32 {
        match self {
            RampStyle::Linear => p.x,
            RampStyle::Reflected => p.x.abs(),
            RampStyle::Radial => p.length(),
            RampStyle::Diamond => p.x.abs() + p.y.abs(),
            RampStyle::Angle => (-p.y.atan2(p.x) / TAU).rem_euclid(1.0),
        }
    }

    /// The gradient of the position at the same point; where the ramp has a tip, that of one side.
    pub fn slope(self, p: Vec2) -> Vec2 {
        let sign = |v: f32| if v < 0.0 { -1.0 } else { 1.0 };
        match self {
            RampStyle::Linear => Vec2::X,
            RampStyle::Reflected => vec2(sign(p.x), 0.0),
            RampStyle::Radial => p.try_normalize().unwrap_or(Vec2::X),
            RampStyle::Diamond => vec2(sign(p.x), sign(p.y)),
            RampStyle::Angle => vec2(p.y, -p.x) / (TAU * p.length_squared()).max(1e-12),
        }
    }

    /// Whether its end meets its beginning.
    pub fn is_closed(self) -> bool {
        self == RampStyle::Angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_style_has_its_positions() {
        let at = |style: RampStyle| {
            [(0.5, 0.0), (-0.5, 0.0), (0.0, 0.25), (0.375, -0.5)]
                .map(|(x, y)| style.position(vec2(x, y)))
        };
        assert_eq!(at(RampStyle::Linear), [0.5, -0.5, 0.0, 0.375]);
        assert_eq!(at(RampStyle::Reflected), [0.5, 0.5, 0.0, 0.375]);
        assert_eq!(at(RampStyle::Radial), [0.5, 0.5, 0.25, 0.625]);
        assert_eq!(at(RampStyle::Diamond), [0.5, 0.5, 0.25, 0.875]);
        // Counter-clockwise as seen, y down: below the line is three quarters round.
        assert_eq!(at(RampStyle::Angle)[..3], [0.0, 0.5, 0.75]);
    }

    #[test]
    fn slopes_are_differences_of_positions() {
        for (style, _) in RampStyle::ALL {
            for p in [vec2(0.4, 0.3), vec2(-0.2, 0.7), vec2(0.1, -0.9), vec2(-1.3, -0.2)] {
                let step = 1e-3;
                let along = |d: Vec2| {
                    (style.position(p + d * step) - style.position(p - d * step)) / (2.0 * step)
                };
                let measured = vec2(along(Vec2::X), along(Vec2::Y));
                let slope = style.slope(p);
                assert!(measured.distance(slope) < 2e-3, "{style:?} {p}: {measured} {slope}");
            }
        }
    }

    #[test]
    fn no_point_gives_a_position_or_slope_that_is_no_number() {
        for (style, _) in RampStyle::ALL {
            for p in [Vec2::ZERO, vec2(-0.0, 0.0), vec2(1e-30, -1e-30), vec2(1e18, -1e18)] {
                assert!(
                    style.position(p).is_finite() && style.slope(p).is_finite(),
                    "{style:?} {p}"
                );
            }
        }
    }
}
