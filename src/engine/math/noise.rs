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

/// [`gradient`] at the same places of several rows; the directions of each corner are found once.
pub struct GradientRows {
    x: Vec<f32>,
    /// The first corner of a row, and how many there are.
    low: f32,
    count: i32,
    period: i32,
    seed: u32,
    /// The corners above the last row, and beneath it, with the number of the first of both.
    corners: [Vec<[f32; 2]>; 2],
    top: Option<i32>,
}

impl GradientRows {
    /// * `x`: the places along a row, a lattice cell as unit.
    pub fn new(x: Vec<f32>, period: u32, seed: u32) -> Self {
        let low = x.iter().copied().fold(f32::INFINITY, f32::min).floor();
        let high = x.iter().copied().fold(f32::NEG_INFINITY, f32::max).floor();
        let count = ((high - low).max(0.0) as i32).saturating_add(2);
        let period = period.clamp(1, 1 << 16) as i32;
        Self { x, low, count, period, seed, corners: Default::default(), top: None }
    }

    /// Adds `share` times the noise of a row.
    pub fn add(&mut self, y: f32, share: f32, sums: &mut [f32]) {
        let top = y.floor();
        let row = top as i32;
        if self.top != Some(row) {
            let above = match self.top {
                Some(before) if before.wrapping_add(1) == row => {
                    std::mem::take(&mut self.corners[1])
                }
                _ => self.corners_of(row),
            };
            self.corners = [above, self.corners_of(row.wrapping_add(1))];
            self.top = Some(row);
        }
        mix_corners(&self.corners, (&self.x, self.low, y - top), share, sums);
    }

    fn corners_of(&self, row: i32) -> Vec<[f32; 2]> {
        let cell = |v: i32| v.rem_euclid(self.period) as u32;
        let corner = |i: i32| {
            let angle =
                hash::unit(self.seed, cell((self.low as i32).wrapping_add(i)), cell(row)) * TAU;
            let (sin, cos) = angle.sin_cos();
            [cos, sin]
        };
        (0..self.count).map(corner).collect()
    }
}

crate::widest! {
    /// `places`: along the row, the first corner, and how far down between corners.
    fn mix_corners(
        corners: &[Vec<[f32; 2]>; 2],
        places: (&[f32], f32, f32),
        share: f32,
        sums: &mut [f32]
    ) {
        let (x, low, fy) = places;
        let fade = |f: f32| f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
        let lerp = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let down = fade(fy);
        for (sum, x) in sums.iter_mut().zip(x) {
            let whole = x.floor();
            let (i, fx) = ((whole - low) as usize, x - whole);
            let across = fade(fx);
            let row = |corners: &[[f32; 2]], fy: f32| {
                let dot = |corner: [f32; 2], fx: f32| corner[0] * fx + corner[1] * fy;
                lerp(dot(corners[i], fx), dot(corners[i + 1], fx - 1.0), across)
            };
            let value = lerp(row(&corners[0], fy), row(&corners[1], fy - 1.0), down);
            *sum += share * (value * std::f32::consts::SQRT_2);
        }
    }
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
    fn a_row_has_the_same_values() {
        for (start, step, y, period) in
            [(-3.7, 0.26, 5.2, 16), (1e4, 1.7, -8.9, 1 << 15), (0.0, 0.0, 0.0, 1)]
        {
            let x: Vec<f32> = (0..100).map(|i| start + step * i as f32).collect();
            let mut rows = GradientRows::new(x.clone(), period, 9);
            for y in (0..20).map(|i| y + 0.3 * i as f32) {
                let mut sums = vec![0.5; 100];
                rows.add(y, 0.3, &mut sums);
                for (x, sum) in x.iter().zip(&sums) {
                    assert_eq!(*sum, 0.5 + 0.3 * gradient(vec2(*x, y), period, 9), "at {x}, {y}");
                }
            }
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
