//! How much of its size a brush covers, so that hatching is as dark as it was asked to be. Floor 3.

use crate::math::vec2;
use crate::paint::brush::{Brush, Tip};
use crate::paint::profile::RoundProfile;

/// Steps across a stroke, and of its dabs along it.
const STEPS: (usize, usize) = (48, 16);
/// The least that is reckoned with: fainter brushes are not made up for.
const LEAST: f32 = 0.5;

/// What a brush at full flow covers, of what its size says.
#[derive(Clone, Copy, Debug)]
pub struct BrushCoverage {
    /// The width of a stroke, of its diameter.
    pub width: f32,
    /// The area of one dab, of the disc's.
    pub area: f32,
}

impl BrushCoverage {
    /// Of a round brush; other tips and dual brushes count as what their size says.
    pub fn of(brush: &Brush) -> Self {
        if brush.tip != Tip::Round || brush.dual.is_some() {
            return Self { width: 1.0, area: 1.0 };
        }
        let profile = RoundProfile::new(brush.hardness, brush.softness);
        let outer = profile.outer_radius();
        let ring = |i: usize| {
            let r = (i as f32 + 0.5) / STEPS.0 as f32 * outer;
            2.0 * r * profile.mean(r, 0.0)
        };
        let area = (0..STEPS.0).map(ring).sum::<f32>() * outer / STEPS.0 as f32;
        // Between dabs, in radii.
        let every = (2.0 * brush.spacing).max(0.02);
        let reach = (outer / every).ceil() as i32;
        let covered = |across: f32, phase: f32| {
            let free =
                |i: i32| 1.0 - profile.mean(vec2((i as f32 + phase) * every, across).length(), 0.0);
            1.0 - (-reach..=reach).map(free).product::<f32>()
        };
        let row = |i: usize| {
            let across = (i as f32 + 0.5) / STEPS.0 as f32 * outer;
            let phases = (0..STEPS.1).map(|j| (j as f32 + 0.5) / STEPS.1 as f32);
            let phases = phases.map(|phase| covered(across, phase));
            phases.sum::<f32>() / STEPS.1 as f32
        };
        let width = (0..STEPS.0).map(row).sum::<f32>() * outer / STEPS.0 as f32;
        Self { width: width.max(LEAST), area: area.max(LEAST * LEAST) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hard_brush_covers_what_its_size_says_and_a_soft_one_less() {
        let of = |hardness: f32, spacing: f32| {
            BrushCoverage::of(&Brush { hardness, spacing, ..Brush::default() })
        };
        let hard = of(1.0, 0.02);
        assert!((hard.width - 1.0).abs() < 0.02 && (hard.area - 1.0).abs() < 0.03, "{hard:?}");
        // Wide apart, dabs leave notches: a disc has π/4 of its square.
        let apart = of(1.0, 0.999);
        assert!((apart.width - std::f32::consts::FRAC_PI_4).abs() < 0.02, "{apart:?}");
        let soft = of(0.5, 0.1);
        assert!(soft.width < 0.95 && soft.area < 0.7, "{soft:?}");
    }
}
