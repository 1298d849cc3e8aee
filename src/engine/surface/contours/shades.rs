//! The line of a contour that a mask of shades gives: the edge whose share of a pixel is the
//! pixel's shade (MATH 10). Floor 2.

use super::line::ContourLine;
use crate::math::{Vec2, vec2};
use crate::raster::Plane;

/// Shades that a line may predict wrongly at one neighbor of a pixel, and in the mean, and still
/// be the mask's edge.
const SHADE_OFF: f32 = 0.35;
const SHADES_OFF: f32 = 0.12;

impl ContourLine {
    /// The line of a direction that leaves a share of the unit pixel on its nearer side: the
    /// inverse of [`ContourLine::nearer_share`].
    ///
    /// * `share`: `[0, 1]`.
    /// * `toward_near`: unit.
    pub fn of_share(share: f32, toward_near: Vec2) -> Self {
        let g = toward_near.abs();
        let (a, b) = (g.max_element(), g.min_element());
        let larger = share.max(1.0 - share);
        let away = if larger - 0.5 <= 0.5 * (a - b) / a {
            (larger - 0.5) * a
        } else {
            0.5 * (a + b) - (2.0 * a * b * (1.0 - larger)).max(0.0).sqrt()
        };
        Self { distance_px: if share >= 0.5 { away } else { -away }, toward_near }
    }

    /// The edge of a mask of shades through a partly covered pixel, covered on the nearer side: the
    /// line with this share that explains the eight shades around best. `None` where none does, as
    /// in a soft ramp or at a wire.
    pub fn of_shades(coverage: &Plane<u8>, (x, y): (i32, i32)) -> Option<Self> {
        let share = f32::from(coverage.at(x as usize, y as usize)) / 255.0;
        let around: Vec<(Vec2, f32)> = (0..9)
            .filter(|&i| i != 4)
            .filter_map(|i| {
                let (dx, dy) = (i % 3 - 1, i / 3 - 1);
                let shade = coverage.get(x + dx, y + dy)?;
                Some((vec2(dx as f32, dy as f32), f32::from(shade) / 255.0))
            })
            .collect();
        let lean: Vec2 =
            around.iter().map(|&(at, shade)| at / at.length_squared() * (shade - share)).sum();
        let start = lean.try_normalize()?;
        let off = |line: Self| {
            let seen = around.iter().map(|&(at, shade)| (line.at(at).nearer_share() - shade).abs());
            seen.fold((0.0f32, 0.0), |(most, all), off| (most.max(off), all + off))
        };
        let turned =
            |k: i32| Self::of_share(share, Vec2::from_angle(k as f32 * 0.06).rotate(start));
        let tried = (-6..=6).map(|k| (turned(k), off(turned(k))));
        let (line, (most, all)) = tried.min_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
        (most <= SHADE_OFF && all <= SHADES_OFF * around.len() as f32).then_some(line)
    }

    /// The same line from another pixel's center.
    fn at(self, step: Vec2) -> Self {
        Self { distance_px: self.height(step), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_and_a_direction_give_the_line() {
        for turn in 0..40 {
            let toward_near = Vec2::from_angle(turn as f32 * 0.157);
            for k in 1..20 {
                let share = k as f32 * 0.05;
                let found = ContourLine::of_share(share, toward_near).nearer_share();
                assert!((found - share).abs() < 1e-4, "{toward_near}: {found} for {share}");
            }
        }
    }
}
