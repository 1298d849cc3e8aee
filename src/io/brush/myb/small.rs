//! The size of a MyPaint dab that is only a few pixels wide: its rim is smoothed in a way that
//! lengthens its axes. Floor 5.

use super::added::{Added, AddedInput};
use super::curves::STEPS;
use super::settings::MyPaintSettings;
use crate::math::vec2;
use crate::paint::Tip;

/// Dabs of a smaller radius are smoothed there, px.
const SMOOTHED_PX: f32 = 3.0;
/// How much longer each half-axis becomes, px, per hardness beyond that of the faintest dabs, which
/// stay as they are; half of it for dabs of radius [`SPECK_PX`]. Measured: within 15 % of the area
/// from 0.4 px on, for round dabs and ellipses with a hardness of 0.3 and more.
const LONGER_PX: f32 = 0.45;
const SPECK_PX: f32 = 0.1;
const FAINTEST: f32 = 0.1;

/// What a dab's size depends on besides its radius, with all inputs halfway.
#[derive(Clone, Copy, Debug)]
pub struct DabSmoothing {
    hardness: f32,
    /// The hardness that the same dab has here.
    here: f32,
    /// The least width of its rim, px.
    rim_px: f32,
    /// Ratio of the longer half-axis to the shorter one, at least 1.
    elongation: f32,
    /// It covers whole pixels, and is as large as it says.
    snaps: bool,
}

impl DabSmoothing {
    /// `here`: the hardness that the brush has here.
    pub fn new(settings: &mut MyPaintSettings, here: f32) -> Self {
        let most = 1.0 / *Tip::RATIO.start();
        let snaps = settings.reads("snap_to_pixel") > 0.5;
        let mut halfway = |name, default| settings.take_added(name, default).middle_value();
        Self {
            hardness: halfway("hardness", 0.8).max(0.0).min(1.0),
            here: here.max(0.02).min(1.0),
            rim_px: halfway("anti_aliasing", 1.0).max(0.0).min(SMOOTHED_PX),
            elongation: halfway("elliptical_dab_ratio", 1.0).max(1.0).min(most),
            snaps,
        }
    }

    /// The radius of a dab that covers as much here as theirs of this one, px.
    pub fn radius_here(&self, radius_px: f32) -> f32 {
        let (wide, hard) = self.with_rim(radius_px);
        if self.snaps || wide >= SMOOTHED_PX {
            return radius_px;
        }
        let longer = LONGER_PX * (hard - FAINTEST).max(0.0) * wide / (wide + SPECK_PX);
        let covered = (wide + longer) * (wide + longer * self.elongation) * hard.max(0.0);
        // Never smaller: what one of several inputs would take away from the radius, others cannot
        // give back.
        (covered / self.here).sqrt().max(radius_px)
    }

    /// Radius and hardness of a dab whose rim is as wide as required; the radius of half coverage
    /// stays.
    fn with_rim(&self, radius_px: f32) -> (f32, f32) {
        if radius_px * (1.0 - self.hardness) >= self.rim_px {
            return (radius_px, self.hardness);
        }
        let middle = radius_px * (1.0 + self.hardness) / 2.0;
        let half = 0.5 * self.rim_px;
        (middle + half, (middle - half) / (middle + half))
    }

    /// The logarithm of a radius, as ours. Of several rows the one that does most follows exactly,
    /// the others being halfway.
    pub fn radius_log_here(&self, theirs: Added) -> Added {
        let here = |log: f32| self.radius_here(log.max(-20.0).min(20.0).exp()).ln();
        let [least, _] = theirs.range();
        if here(least) == least || self.with_rim(least.exp()).0 >= SMOOTHED_PX {
            return theirs;
        }
        let Some(main) = theirs.main_row() else {
            return Added { base: here(theirs.base), ..theirs };
        };
        let rest = theirs.middle_value() - theirs.rows[main].middle_value();
        let base = here(rest);
        let row = &theirs.rows[main];
        let even = (0..=STEPS).map(|i| i as f32 / STEPS as f32);
        let mut places: Vec<f32> = even.chain(row.points.iter().map(|p| p.x)).collect();
        places.sort_by(f32::total_cmp);
        places.dedup();
        let points = places.into_iter().map(|x| vec2(x, here(rest + row.at(x)) - base)).collect();
        let row = AddedInput { input: row.input, points };
        let mut ours = Added { base: theirs.base + base - rest, ..theirs };
        ours.rows[main] = row;
        ours
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paint::dynamics::Input;

    fn dab(hardness: f32, rim_px: f32, elongation: f32) -> DabSmoothing {
        DabSmoothing { hardness, here: hardness, rim_px, elongation, snaps: false }
    }

    #[test]
    fn a_small_dab_covers_what_mypaint_makes_of_it() {
        // Radius, hardness, elongation; coverage over the profile's own, the mean of libmypaint's
        // 64 places.
        for (radius, hardness, elongation, times) in [
            (0.39, 1.0, 1.0, 3.06),
            (0.95, 1.0, 1.0, 1.81),
            (1.86, 1.0, 1.0, 1.43),
            (2.91, 1.0, 1.0, 1.28),
            (3.64, 1.0, 1.0, 1.0),
            (0.95, 0.6, 1.0, 1.54),
            (1.86, 0.6, 1.0, 1.34),
            (0.95, 0.3, 1.0, 1.13),
            (0.95, 0.9, 3.0, 2.94),
            (1.86, 0.9, 3.0, 2.09),
        ] {
            let found = (dab(hardness, 0.0, elongation).radius_here(radius) / radius).powi(2);
            assert!(
                (found / times - 1.0).abs() < 0.16,
                "{radius} {hardness} {elongation}: {found}, not {times}"
            );
        }
    }

    #[test]
    fn large_dabs_and_those_that_snap_to_pixels_are_as_large_as_they_say_and_none_is_smaller() {
        let pen = dab(0.8, 1.0, 1.0);
        assert_eq!(
            [0.1, 0.5, 3.0, 50.0].map(|radius| pen.radius_here(radius)),
            [0.1, 0.5, 3.0, 50.0]
        );
        assert!(pen.radius_here(2.0) > 2.05);
        assert_eq!(DabSmoothing { snaps: true, ..dab(1.0, 0.0, 1.0) }.radius_here(0.6), 0.6);
    }

    #[test]
    fn what_drives_the_radius_most_drives_what_is_seen() {
        let row =
            |input, to: f32| AddedInput { input, points: vec![vec2(0.0, -to), vec2(1.0, to)] };
        let theirs =
            Added { base: 0.2, rows: vec![row(Input::Pressure, 1.0), row(Input::Chance, 0.1)] };
        let hard = dab(1.0, 0.0, 1.0);
        let ours = hard.radius_log_here(theirs.clone());
        assert_eq!(ours.rows[1].points, theirs.rows[1].points);
        for x in [0.0, 0.3, 1.0] {
            let (log, expected) = (
                ours.base + ours.rows[0].at(x),
                hard.radius_here((0.2 + theirs.rows[0].at(x)).exp()),
            );
            assert!((log.exp() - expected).abs() < 0.02, "{x}: {} not {expected}", log.exp());
        }
        let large = Added { base: 3.0, rows: vec![row(Input::Pressure, 1.0)] };
        assert_eq!(hard.radius_log_here(large.clone()).rows[0].points, large.rows[0].points);
    }
}
