//! The peaked tip: coverage that falls in two straight lines over the squared distance, averaged in
//! closed form. Floor 3. Pure functions. The smooth one is `profile`'s.

use super::profile::{Profile, farther};

/// A radial profile, the radius of the undeformed footprint being 1, of hardness h: 1 in the
/// middle, h at the squared distance h, 0 at the rim, straight lines over the squared distance
/// between. So it covers the share h of its disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeakedProfile {
    /// √h, where the lines meet.
    knee: f32,
    /// How much the inner line falls over a squared distance of 1, and the outer one.
    inner: f32,
    outer: f32,
    /// The integral up to the knee, less that of the outer line.
    start: f32,
    /// Width of the box that blurs it, squared.
    blur_squared: f32,
    /// The length of the tip's mean chord: its area over its extent along a line through the
    /// center; with the box.
    chord: f32,
}

impl PeakedProfile {
    /// Narrower boxes than this are points, as in `RoundProfile`.
    const NARROW: f32 = 5e-4;
    /// Beyond these hardnesses it is a needle and a disc.
    const HARDNESS: [f32; 2] = [1e-3, 0.9999];

    /// Hardness and softness in `[0, 1]`.
    pub fn new(hardness: f32, softness: f32) -> Self {
        let [least, most] = Self::HARDNESS;
        let h = hardness.max(least).min(most);
        let (knee, inner, outer) = (h.sqrt(), 1.0 / h - 1.0, h / (1.0 - h));
        let at = |x: f32, slope: f32| x - slope * x * x * x / 3.0;
        let start = at(knee, inner) - outer * at(knee, 1.0);
        // The area is π h, half the extent the integral up to the rim.
        let chord = std::f32::consts::FRAC_PI_2 * h / (start + outer * (2.0 / 3.0));
        Self {
            knee,
            inner,
            outer,
            start,
            blur_squared: softness * softness,
            chord: chord.hypot(softness),
        }
    }

    /// ∫ from 0 to x ≥ 0 of the profile before the box.
    #[inline(always)]
    fn integral(&self, x: f32) -> f32 {
        let x = if x < 1.0 { x } else { 1.0 };
        let cubed = x * x * x * (1.0 / 3.0);
        if x < self.knee { x - self.inner * cubed } else { self.start + self.outer * (x - cubed) }
    }
}

impl Profile for PeakedProfile {
    fn outer_radius(&self) -> f32 {
        1.0 + 0.5 * self.blur_squared.sqrt()
    }

    #[inline(always)]
    fn mean(&self, r: f32, width_squared: f32) -> f32 {
        let width = (self.blur_squared + width_squared).sqrt();
        let width = if width > Self::NARROW { width } else { Self::NARROW };
        let (inner, outer) = (r - 0.5 * width, r + 0.5 * width);
        // The integral is odd, since the profile continues evenly beyond the center.
        (self.integral(outer) - self.integral(inner.abs()).copysign(inner)) / width
    }

    /// Over a pixel of two dimensions, as [`super::profile::RoundProfile::mean_over`] is.
    #[inline(always)]
    fn mean_over(&self, r: f32, width_squared: f32, across_squared: f32) -> f32 {
        let across = if across_squared > 0.0 { across_squared } else { 0.0 };
        let filled = self.chord / (across.sqrt() + 1e-6);
        self.mean(farther(r, across), width_squared) * if filled < 1.0 { filled } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_falls_in_two_lines_over_the_squared_distance() {
        let tip = PeakedProfile::new(0.25, 0.0);
        for (squared, coverage) in
            [(0.0f32, 1.0), (0.125, 0.625), (0.25, 0.25), (0.625, 0.125), (1.0, 0.0), (1.3, 0.0)]
        {
            let found = tip.mean(squared.sqrt(), 0.0);
            assert!((found - coverage).abs() < 2e-3, "at {squared}: {found}");
        }
    }

    #[test]
    fn it_covers_the_share_of_its_disc_that_its_hardness_says() {
        for hardness in [0.02, 0.3, 0.7, 1.0] {
            let tip = PeakedProfile::new(hardness, 0.0);
            // Rings of equal area.
            let n = 2000;
            let sum: f32 =
                (0..n).map(|i| tip.mean(((i as f32 + 0.5) / n as f32).sqrt(), 0.0)).sum();
            assert!((sum / n as f32 - hardness).abs() < 5e-3, "{hardness}: {}", sum / n as f32);
        }
    }

    #[test]
    fn the_mean_equals_many_samples() {
        for (hardness, softness) in [(0.05, 0.0), (0.4, 0.3), (1.0, 0.2)] {
            let tip = PeakedProfile::new(hardness, softness);
            let bare = PeakedProfile { blur_squared: 0.0, ..tip };
            for (r, width) in [(0.0f32, 0.1f32), (0.4, 0.3), (0.9, 1.5)] {
                let (over, n) = (softness.hypot(width), 4000);
                let sum: f32 = (0..n)
                    .map(|i| bare.mean((r + over * ((i as f32 + 0.5) / n as f32 - 0.5)).abs(), 0.0))
                    .sum();
                let (found, expected) = (tip.mean(r, width * width), sum / n as f32);
                assert!(
                    (found - expected).abs() < 2e-3,
                    "{hardness} {softness} at {r}: {found}, not {expected}"
                );
            }
        }
    }

    #[test]
    fn a_pixel_wider_than_the_tip_is_filled_by_its_area() {
        const SIDE: usize = 48;
        let place = |i: usize| (i as f32 + 0.5) / SIDE as f32 - 0.5;
        for (hardness, softness) in [(0.9, 0.0), (0.5, 0.0), (0.25, 0.0), (0.1, 0.0), (0.1, 0.35)] {
            let tip = PeakedProfile::new(hardness, softness);
            let (mut off, mut bias, mut plain, mut n) = (0.0, 0.0, 0.0, 0.0);
            for width in [0.5f32, 1.0, 1.33, 2.0, 3.0, 5.0] {
                for step in 0..20 {
                    let r = step as f32 / 20.0 * (1.0 + width);
                    let points = (0..SIDE * SIDE)
                        .map(|i| (r + width * place(i % SIDE)).hypot(width * place(i / SIDE)));
                    let truth =
                        points.map(|r| tip.mean(r, 0.0)).sum::<f32>() / (SIDE * SIDE) as f32;
                    let error = 255.0 * (tip.mean_over(r, width * width, width * width) - truth);
                    (off, bias, n) = (off + error.abs(), bias + error, n + 1.0);
                    plain += 255.0 * (tip.mean(r, width * width) - truth);
                }
            }
            let (off, bias, plain) = (off / n, bias / n, plain / n);
            assert!(
                off < 5.0 && bias.abs() < 3.0,
                "{hardness} {softness}: {off} off, {bias} too bright"
            );
            assert!(
                plain > 10.0,
                "{hardness} {softness}: one dimension alone is {plain} too bright"
            );
        }
    }
}
