//! Noise that repeats: gradient noise over a square whose opposite sides meet, so that a texture of
//! it has no seams. Floor 0.

use super::{Vec2, hash, vec2};
use std::f32::consts::TAU;

/// Gradient noise (Perlin 2002) at `p`, a lattice cell as unit; it repeats every `period ≥ 1`
/// cells. Within [−1, 1].
pub fn gradient(p: Vec2, period: u32, seed: u32) -> f32 {
    let period = period.clamp(1, 1 << 16) as i32;
    let floor = p.floor();
    let f = p - floor;
    let corner = |dx: i32, dy: i32| {
        let cell = |v: f32, d: i32| (v as i32).wrapping_add(d).rem_euclid(period) as u32;
        let (sin, cos) = (hash::unit(seed, cell(floor.x, dx), cell(floor.y, dy)) * TAU).sin_cos();
        vec2(cos, sin).dot(f - vec2(dx as f32, dy as f32))
    };
    let fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let lerp = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let rows = [0, 1].map(|dy| lerp(corner(0, dy), corner(1, dy), fade.x));
    // A gradient of length 1 reaches 1/√2 in the middle of a cell.
    lerp(rows[0], rows[1], fade.y) * std::f32::consts::SQRT_2
}

/// Octaves of [`gradient`] added up, each twice as fine as the previous one and `rough` times as
/// strong.
///
/// * `p`: in `[0, 1)²`, the square that repeats.
/// * `cells`: of the coarsest octave along a side.
pub fn octaves(p: Vec2, cells: u32, octaves: u32, rough: f32, seed: u32) -> f32 {
    let (mut sum, mut share, mut cells) = (0.0, 1.0, cells.max(1));
    for octave in 0..octaves {
        sum += share * gradient(p * cells as f32, cells, hash::mix(seed ^ hash::mix(octave)));
        (share, cells) = (share * rough, cells.saturating_mul(2));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opposite_sides_of_the_square_meet() {
        for i in 0..64 {
            let t = i as f32 / 64.0;
            let at = |x: f32, y: f32| octaves(vec2(x, y), 5, 3, 0.5, 7);
            assert!((at(0.0, t) - at(1.0 - 1e-6, t)).abs() < 1e-3);
            assert!((at(t, 0.0) - at(t, 1.0 - 1e-6)).abs() < 1e-3);
        }
    }

    #[test]
    fn noise_stays_in_its_range_and_changes_with_the_seed() {
        let values = |seed| {
            (0..4096).map(move |i| gradient(vec2(i as f32 * 0.37, i as f32 * 0.11), 16, seed))
        };
        assert!(values(1).all(|v| v.abs() <= 1.0));
        assert!(values(1).zip(values(2)).filter(|(a, b)| (a - b).abs() > 0.05).count() > 2000);
        let spread = values(1).map(|v| v * v).sum::<f32>() / 4096.0;
        assert!(spread > 0.05, "{spread}");
    }
}
