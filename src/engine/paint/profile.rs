//! The round tip: coverage as a function of the distance from the dab's center, blurred in closed
//! form. Floor 3. Pure functions.

/// How coverage falls off from the middle of a dab, the radius of the undeformed footprint being 1.
pub trait Profile {
    /// Beyond this distance coverage is 0 where no pixel's footprint widens it.
    fn outer_radius(&self) -> f32;
    /// Mean coverage at distance `r ≥ 0` over a pixel whose width along the radius has this square,
    /// both in radii.
    fn mean(&self, r: f32, width_squared: f32) -> f32;
    /// The same over a pixel whose width across the radius has the square `across_squared`: its
    /// second dimension.
    #[inline(always)]
    fn mean_over(&self, r: f32, width_squared: f32, _across_squared: f32) -> f32 {
        self.mean(r, width_squared)
    }
}

impl Profile for RoundProfile {
    fn outer_radius(&self) -> f32 {
        RoundProfile::outer_radius(self)
    }

    #[inline(always)]
    fn mean(&self, r: f32, width_squared: f32) -> f32 {
        RoundProfile::mean(self, r, width_squared)
    }

    #[inline(always)]
    fn mean_over(&self, r: f32, width_squared: f32, across_squared: f32) -> f32 {
        RoundProfile::mean_over(self, r, width_squared, across_squared)
    }
}

/// A radial profile, the radius of the undeformed footprint being 1.
///
/// Coverage is 1 up to the hardness and falls to 0 at the rim as a smoothstep. Softness blurs it
/// with two kernels of half its extent each: one widens the smoothstep, the other is a box, which
/// the integral below applies exactly. So the rim moves out to 1 + softness, the middle sinks as
/// light spreads, and neither does so by jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundProfile {
    /// Where the falloff ends, its length, and 1 / length.
    end: f32,
    length: f32,
    per_length: f32,
    /// Width of the box, squared.
    blur_squared: f32,
    /// The integral up to the center, where [`RoundProfile::integral`] starts.
    start: f32,
    /// The length of the tip's mean chord: its area over its extent along a line through the
    /// center.
    chord: f32,
}

impl RoundProfile {
    /// Falloffs and boxes narrower than this count as steps and points: their differences would be
    /// lost in rounding.
    const NARROW: f32 = 5e-4;

    /// Hardness and softness in `[0, 1]`.
    pub fn new(hardness: f32, softness: f32) -> Self {
        let (middle, half) = (0.5 * (1.0 + hardness), 0.5 * (1.0 - hardness + softness));
        let half = half.max(0.5 * Self::NARROW);
        let (end, length) = (middle + half, 2.0 * half);
        let (per_length, blur_squared) = (1.0 / length, softness * softness);
        // ½ π for a disc, 0.942 for a smoothstep from the center.
        let chord = std::f32::consts::FRAC_PI_2 * (0.6 + 0.4 * hardness);
        Self {
            end,
            length,
            per_length,
            blur_squared,
            start: smoothstep_integral(end * per_length),
            chord,
        }
    }

    /// Beyond this distance coverage is 0, apart from the width of a pixel's footprint.
    pub fn outer_radius(&self) -> f32 {
        self.end + 0.5 * self.blur_squared.sqrt()
    }

    /// Mean coverage at distance `r ≥ 0` over a pixel whose width along the radius has this square,
    /// both in radii.
    ///
    /// The box of the softness and the pixel's own add as variances do, so one mean serves both.
    #[inline(always)]
    pub fn mean(&self, r: f32, width_squared: f32) -> f32 {
        let width = (self.blur_squared + width_squared).sqrt();
        let width = if width > Self::NARROW { width } else { Self::NARROW };
        let (inner, outer) = (r - 0.5 * width, r + 0.5 * width);
        // The integral is odd, since the profile continues evenly beyond the center.
        (self.integral(outer) - self.integral(inner.abs()).copysign(inner)) / width
    }

    /// Mean coverage over a pixel of two dimensions, u along the radius and v across it: `mean(r′,
    /// u²) · min(1, c / v)` with `r′ = r + v²/24 · r / (r² + v²/4)`.
    ///
    /// Across the radius a pixel's points lie farther out, by v²/24r in the mean; and a tip
    /// narrower than the pixel fills no more of it than its mean chord c. Within 28 of 255 of the
    /// mean of many samples for pixels of up to five radii, 3 in the mean, whereas u alone is off
    /// by 81 and 14.
    #[inline(always)]
    pub fn mean_over(&self, r: f32, width_squared: f32, across_squared: f32) -> f32 {
        let across = if across_squared > 0.0 { across_squared } else { 0.0 };
        let filled = self.chord / (across.sqrt() + 1e-6);
        self.mean_over_narrow(r, width_squared, across_squared)
            * if filled < 1.0 { filled } else { 1.0 }
    }

    /// The same, to the bit, for a pixel that is narrower across the radius than
    /// [`RoundProfile::chord`].
    #[inline(always)]
    pub fn mean_over_narrow(&self, r: f32, width_squared: f32, across_squared: f32) -> f32 {
        let across = if across_squared > 0.0 { across_squared } else { 0.0 };
        self.mean(farther(r, across), width_squared)
    }

    /// c: the tip fills pixels that are this narrow across the radius, in radii.
    pub fn chord(&self) -> f32 {
        self.chord
    }

    /// The distances between which coverage falls from 1 to 0 before the box; the first may be
    /// below 0.
    pub fn falloff(&self) -> (f32, f32) {
        (self.end - self.length, self.end)
    }

    /// [`RoundProfile::mean`] if the box lies within the falloff: the mean of a cubic over a width
    /// is its value in the middle and a 24th of its curvature times the width's square. So only the
    /// square of the width is needed.
    #[inline(always)]
    pub fn mean_in_falloff(&self, r: f32, width_squared: f32) -> f32 {
        let v = (self.end - r) * self.per_length;
        let half_squared =
            0.25 * (self.blur_squared + width_squared) * (self.per_length * self.per_length);
        v * v * (3.0 - 2.0 * v) + (1.0 - 2.0 * v) * half_squared
    }

    /// Half the width of the box over a pixel whose width's square is at most this, in radii.
    #[inline(always)]
    pub fn half_width(&self, width_squared: f32) -> f32 {
        0.5 * (self.blur_squared + width_squared).sqrt() + 0.5 * Self::NARROW
    }

    /// Bounds half the width of the box, `½ √(blur² + w²)`, from above by `a + b w²`, w² the square
    /// of a pixel's width: the root's tangent, close around the width `usual`. In radii; gives (a,
    /// b).
    pub fn half_width_bound(&self, usual: f32) -> (f32, f32) {
        let at = (self.blur_squared + usual * usual).max(Self::NARROW * Self::NARROW);
        let slope = 0.25 / at.sqrt();
        (slope * (self.blur_squared + at) + 0.5 * Self::NARROW, slope)
    }

    /// ∫ from 0 to x ≥ 0 of the profile before the box.
    #[inline(always)]
    fn integral(&self, x: f32) -> f32 {
        self.length * (self.start - smoothstep_integral((self.end - x) * self.per_length))
    }
}

/// How far out the points of a pixel at r lie in the mean, its width across the radius having this
/// square: by v²/24r farther than its middle, if that is not near the center.
#[inline(always)]
pub fn farther(r: f32, across_squared: f32) -> f32 {
    r + across_squared * (1.0 / 24.0) * r / (r * r + 0.25 * across_squared + 1e-12)
}

/// ∫ up to v of the smoothstep 3v² − 2v³, which is 0 below 0 and 1 above 1.
#[inline(always)]
fn smoothstep_integral(v: f32) -> f32 {
    // Comparisons, not `max` and `min`, which take three instructions each to treat NaN.
    let v = if v > 0.0 { v } else { 0.0 };
    let s = if v < 1.0 { v } else { 1.0 };
    s * s * s * (1.0 - 0.5 * s) + (v - s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hard_tip_is_a_disc_and_its_rim_half_covers_a_pixel() {
        let disc = RoundProfile::new(1.0, 0.0);
        let pixel = 1.0 / 1600.0;
        for (r, coverage) in [(0.0, 1.0), (0.9, 1.0), (1.0, 0.5), (1.00625, 0.25), (1.1, 0.0)] {
            assert!(
                (disc.mean(r, pixel) - coverage).abs() < 2e-3,
                "at {r}: {}",
                disc.mean(r, pixel)
            );
        }
        assert!((disc.outer_radius() - 1.0).abs() < 1e-3);
    }

    #[test]
    fn coverage_is_whole_up_to_the_hardness_and_falls_as_a_smoothstep() {
        let tip = RoundProfile::new(0.5, 0.0);
        for (r, coverage) in [(0.0, 1.0), (0.49, 1.0), (0.625, 0.84375), (0.75, 0.5), (1.0, 0.0)] {
            assert!((tip.mean(r, 0.0) - coverage).abs() < 1e-3, "at {r}: {}", tip.mean(r, 0.0));
        }
    }

    #[test]
    fn the_mean_equals_many_samples() {
        for (hardness, softness) in [(0.0, 0.0), (0.3, 0.4), (1.0, 0.2), (0.0, 1.0)] {
            let tip = RoundProfile::new(hardness, softness);
            let inner = RoundProfile { blur_squared: 0.0, ..tip };
            for (r, width) in [(0.0, 0.1f32), (0.4, 0.3), (0.9, 1.5), (1.3, 4.0)] {
                let box_width = softness.hypot(width);
                let n = 4000;
                let sum: f64 = (0..n)
                    .map(|i| r + box_width * ((i as f32 + 0.5) / n as f32 - 0.5))
                    .map(|r| f64::from(inner.mean(r.abs(), 0.0)))
                    .sum();
                assert!((f64::from(tip.mean(r, width * width)) - sum / f64::from(n)).abs() < 1e-3);
            }
        }
    }

    #[test]
    fn a_pixel_wider_than_the_tip_is_filled_by_its_area() {
        const SIDE: usize = 48;
        let place = |i: usize| (i as f32 + 0.5) / SIDE as f32 - 0.5;
        for hardness in [0.97, 0.6, 0.0] {
            let tip = RoundProfile::new(hardness, 0.0);
            let (mut sum, mut plain, mut n) = (0.0, 0.0, 0);
            for width in [0.25f32, 0.5, 1.0, 1.33, 2.0, 3.0, 5.0] {
                for step in 0..20 {
                    let r = step as f32 / 20.0 * (1.0 + width);
                    let points = (0..SIDE * SIDE)
                        .map(|i| (r + width * place(i % SIDE)).hypot(width * place(i / SIDE)));
                    let truth =
                        points.map(|r| tip.mean(r, 0.0)).sum::<f32>() / (SIDE * SIDE) as f32;
                    let found = tip.mean_over(r, width * width, width * width);
                    assert!(
                        (found - truth).abs() < 30.0 / 255.0,
                        "{hardness} {width} at {r}: {found}, not {truth}"
                    );
                    (sum, n) = (sum + (found - truth).abs(), n + 1);
                    plain += (tip.mean(r, width * width) - truth).abs();
                }
            }
            let (mean, plain) = (255.0 * sum / n as f32, 255.0 * plain / n as f32);
            assert!(
                mean < 5.0 && plain > 2.0 * mean,
                "{hardness}: {mean}, of one dimension {plain}"
            );
        }
    }

    #[test]
    fn within_the_falloff_the_mean_needs_no_width() {
        for (hardness, softness) in [(0.0, 0.0), (0.3, 0.4), (0.6, 0.1)] {
            let tip = RoundProfile::new(hardness, softness);
            let (start, end) = tip.falloff();
            for (share, width) in [(0.5, 0.02f32), (0.5, 0.05), (0.3, 0.02), (0.8, 0.03)] {
                let r = start + share * (end - start);
                let (a, b) = (tip.mean_in_falloff(r, width * width), tip.mean(r, width * width));
                assert!(
                    (a - b).abs() < 2e-4,
                    "hardness {hardness}, softness {softness}, at {r}: {a}, not {b}"
                );
            }
        }
    }

    #[test]
    fn the_bound_of_the_box_is_above_it_and_close_where_it_is_usual() {
        for softness in [0.0, 0.2, 1.0] {
            let tip = RoundProfile::new(0.4, softness);
            let (a, b) = tip.half_width_bound(0.05);
            for width in [0.0f32, 0.01, 0.05, 0.3, 4.0, 100.0] {
                assert!(
                    a + b * width * width >= 0.5 * softness.hypot(width),
                    "softness {softness}, width {width}"
                );
            }
            assert!(a + b * 0.05 * 0.05 < 0.5 * softness.hypot(0.05) + 0.001);
        }
    }

    #[test]
    fn softness_changes_coverage_without_jumps() {
        for hardness in [0.0, 0.5, 1.0] {
            for r in [0.0, 0.5, 0.97, 1.2] {
                let mut last = RoundProfile::new(hardness, 0.0).mean(r, 0.0025);
                for i in 1..=200 {
                    let next = RoundProfile::new(hardness, i as f32 / 200.0).mean(r, 0.0025);
                    assert!(
                        (next - last).abs() < 0.04,
                        "hardness {hardness}, r {r}, step {i}: {last} to {next}"
                    );
                    last = next;
                }
            }
        }
    }

    #[test]
    fn a_profile_never_rises_outward_and_ends_at_its_reach() {
        for (hardness, softness) in [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (0.0, 1.0), (1.0, 0.0)] {
            let tip = RoundProfile::new(hardness, softness);
            let values: Vec<f32> =
                (0..300).map(|i| tip.mean(i as f32 * tip.outer_radius() / 250.0, 0.0)).collect();
            assert!(values.windows(2).all(|v| v[1] <= v[0] + 1e-3), "{hardness} {softness}");
            assert!(values[251..].iter().all(|v| v.abs() < 1e-3));
            assert!(values.iter().all(|v| (-1e-3..=1.001).contains(v)));
        }
    }
}
