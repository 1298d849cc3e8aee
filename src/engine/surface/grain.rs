//! Grain: the normals of a noise relief, which are detail without a picture.
//! Floor 2. A pure function of position and seed: the same on every machine and run.

use crate::math::{Vec2, Vec3, hash, vec2};
use std::f32::consts::TAU;

/// A relief of gradient noise, octaves added up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseRelief {
    /// Size of the largest bumps, px, `> 0`.
    pub size_px: f32,
    /// Each half as large as the one before, `≥ 1`.
    pub octaves: u32,
    /// Slope of each octave relative to the one before: 0 is smooth, 1 rough.
    pub roughness: f32,
    /// How many times longer the bumps are along x than along y: brushed.
    pub stretch: f32,
    /// Other seeds give other noise.
    pub seed: u32,
}

impl Default for NoiseRelief {
    fn default() -> Self {
        Self { size_px: 24.0, octaves: 4, roughness: 0.6, stretch: 1.0, seed: 0 }
    }
}

impl NoiseRelief {
    /// What a size may be, px.
    pub const SIZE_PX: crate::math::Range = 0.1..=100_000.0;
    /// How many layers of noise there may be.
    pub const OCTAVES: std::ops::RangeInclusive<u32> = 1..=12;
    /// The range of a roughness.
    pub const ROUGHNESS: crate::math::Range = 0.0..=2.0;
    /// The range of a stretch.
    pub const STRETCH: crate::math::Range = 0.01..=1000.0;

    /// The normal of the relief (y up, not of unit length), at a place in px from its origin (y
    /// down), seen through a pixel `px` wide: bumps too small for it fade away.
    pub fn normal(&self, at: Vec2, px: f32) -> Vec3 {
        let mut slope = Vec2::ZERO;
        let (mut size, mut share) = (self.size_px, 1.0);
        for octave in 0..self.octaves {
            let bump = vec2(size * self.stretch, size);
            // A bump below two pixels cannot be resolved; from four pixels on it counts in full.
            let visibility = ((bump.min_element() / px.max(1e-6) - 2.0) / 2.0).clamp(0.0, 1.0);
            if visibility > 0.0 {
                // The height scales with the bump, so its slope is that of the noise, smaller along
                // a stretched bump.
                let lean = gradient(at / bump, hash::mix(self.seed ^ hash::mix(octave)));
                slope += lean * vec2(1.0 / self.stretch.max(1e-6), 1.0) * share * visibility;
            }
            (size, share) = (size * 0.5, share * self.roughness);
        }
        if slope.is_finite() { Vec3::new(-slope.x, slope.y, 1.0) } else { Vec3::Z }
    }
}

/// The gradient of gradient noise (Perlin 1985, with his quintic of 2002): derivative by x and y, a
/// lattice cell as unit.
fn gradient(p: Vec2, seed: u32) -> Vec2 {
    let floor = p.floor();
    let f = p - floor;
    let (i, j) = (floor.x as i32 as u32, floor.y as i32 as u32);
    let lean = |di: u32, dj: u32| {
        let (sin, cos) = (hash::unit(seed, i.wrapping_add(di), j.wrapping_add(dj)) * TAU).sin_cos();
        vec2(cos, sin)
    };
    let fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let fading = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    let [a, b, c, d] = [lean(0, 0), lean(1, 0), lean(0, 1), lean(1, 1)];
    let [va, vb, vc, vd] = [a.dot(f), b.dot(f - Vec2::X), c.dot(f - Vec2::Y), d.dot(f - Vec2::ONE)];
    // N = lerp(lerp(va, vb, fade_x), lerp(vc, vd, fade_x), fade_y); its derivative by parts.
    let leans = a.lerp(b, fade.x).lerp(c.lerp(d, fade.x), fade.y);
    let by_x = (vb - va) + ((vd - vc) - (vb - va)) * fade.y;
    let by_y = (vc - va) + ((vd - vb) - (vc - va)) * fade.x;
    leans + fading * vec2(by_x, by_y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grain_leans_every_way_alike_and_is_the_same_every_time() {
        let grain = NoiseRelief::default();
        let at = |i: u32| vec2((i % 90) as f32 * 1.7, (i / 90) as f32 * 2.3);
        let slopes: Vec<Vec2> = (0..8100).map(|i| grain.normal(at(i), 1.0).truncate()).collect();
        let mean = slopes.iter().sum::<Vec2>() / 8100.0;
        let spread = slopes.iter().map(|s| s.length_squared()).sum::<f32>() / 8100.0;
        assert!(mean.length() < 0.1, "{mean}");
        assert!((0.1..2.0).contains(&spread), "{spread}");
        assert_eq!(grain.normal(at(77), 1.0), NoiseRelief::default().normal(at(77), 1.0));
        assert_ne!(grain.normal(at(77), 1.0), NoiseRelief { seed: 1, ..grain }.normal(at(77), 1.0));
    }

    #[test]
    fn the_gradient_is_that_of_one_continuous_relief() {
        // The slopes around any closed loop add up to zero.
        let step = 0.002f32;
        let side: Vec<f32> = (0..1500).map(|i| i as f32 * step).collect();
        let corner = vec2(3.1, -2.4);
        let length = 1500.0 * step;
        let sum: f32 = side
            .iter()
            .map(|&t| {
                let along =
                    gradient(corner + vec2(t, 0.0), 9).x + gradient(corner + vec2(length, t), 9).y;
                along
                    - gradient(corner + vec2(t, length), 9).x
                    - gradient(corner + vec2(0.0, t), 9).y
            })
            .sum();
        assert!((sum * step).abs() < 0.01, "{}", sum * step);
    }

    #[test]
    fn bumps_too_small_to_be_seen_fade_and_stretched_ones_lean_across() {
        let grain = NoiseRelief { size_px: 8.0, octaves: 1, ..NoiseRelief::default() };
        assert_eq!(grain.normal(vec2(5.3, 1.1), 8.0), Vec3::Z);
        let brushed = NoiseRelief { size_px: 8.0, stretch: 20.0, ..NoiseRelief::default() };
        let sum = |f: fn(Vec3) -> f32| {
            (0..900)
                .map(|i| f(brushed.normal(vec2(i as f32 * 3.7, i as f32 * 0.9), 1.0)).abs())
                .sum::<f32>()
        };
        assert!(sum(|n| n.y) > 8.0 * sum(|n| n.x));
        assert!(
            NoiseRelief { size_px: f32::NAN, ..brushed }.normal(vec2(1.0, 1.0), 1.0).is_finite()
        );
    }
}
