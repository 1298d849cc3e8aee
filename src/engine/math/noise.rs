//! Noise that repeats: gradient noise over a square whose opposite sides meet, so that a texture of
//! it has no seams. Floor 0.

use super::{Vec2, fast, hash, vec2};

/// Gradient noise (Perlin 2002) at `p`, a lattice cell as unit; it repeats every `period ≥ 1`
/// cells. Within [−1, 1].
pub fn gradient(p: Vec2, period: u32, seed: u32) -> f32 {
    let period = period.clamp(1, 1 << 16) as i32;
    let floor = p.floor();
    let f = p - floor;
    let corner = |dx: i32, dy: i32| {
        let cell = |v: f32, d: i32| (v as i32).wrapping_add(d).rem_euclid(period) as u32;
        let turn = hash::unit(seed, cell(floor.x, dx), cell(floor.y, dy));
        let (sin, cos) = fast::sin_cos_of_turn(turn);
        vec2(cos, sin).dot(f - vec2(dx as f32, dy as f32))
    };
    let fade = vec2(fade(f.x), fade(f.y));
    let lerp = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let rows = [0, 1].map(|dy| lerp(corner(0, dy), corner(1, dy), fade.x));
    // A gradient of length 1 reaches 1/√2 in the middle of a cell.
    lerp(rows[0], rows[1], fade.y) * std::f32::consts::SQRT_2
}

/// [`gradient`] at the same places of several rows; what rows have in common is found once.
pub struct GradientRows {
    /// Of each place: the number of the corner before it, how far behind that it is, and how much of
    /// the next corner's noise it has.
    before: Vec<u32>,
    behind: Vec<f32>,
    share: Vec<f32>,
    /// The cells of a row, as they repeat.
    cells: Vec<u32>,
    period: i32,
    seed: u32,
    /// The corners above the last row, and beneath it, with the number of the first of both.
    corners: [Vec<[f32; 2]>; 2],
    top: Option<i32>,
    /// Both, mixed for a row: the slope at each corner, and the height.
    mixed: Vec<[f32; 2]>,
}

impl GradientRows {
    /// * `x`: the places along a row, a lattice cell as unit.
    pub fn new(x: &[f32], period: u32, seed: u32) -> Self {
        let low = x.iter().copied().fold(f32::INFINITY, f32::min).floor();
        let high = x.iter().copied().fold(f32::NEG_INFINITY, f32::max).floor();
        let count = ((high - low).max(0.0) as i32).saturating_add(2);
        let period = period.clamp(1, 1 << 16) as i32;
        let cell = |i: i32| (low as i32).wrapping_add(i).rem_euclid(period) as u32;
        let behind: Vec<f32> = x.iter().map(|x| x - x.floor()).collect();
        Self {
            before: x.iter().map(|x| (x.floor() - low) as u32).collect(),
            share: behind.iter().map(|f| fade(*f)).collect(),
            behind,
            cells: (0..count).map(cell).collect(),
            period,
            seed,
            corners: Default::default(),
            top: None,
            mixed: Vec::new(),
        }
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
        self.mixed.resize(self.corners[0].len(), [0.0; 2]);
        mix_rows([&self.corners[0], &self.corners[1]], y - top, &mut self.mixed);
        let places = (&self.before[..], &self.behind[..], &self.share[..]);
        add_between(&self.mixed, places, share * std::f32::consts::SQRT_2, sums);
    }

    fn corners_of(&self, row: i32) -> Vec<[f32; 2]> {
        let mut corners = vec![[0.0; 2]; self.cells.len()];
        let row = row.rem_euclid(self.period) as u32;
        find_directions(self.seed, (&self.cells, row), &mut corners);
        corners
    }
}

#[inline(always)]
fn fade(f: f32) -> f32 {
    f * f * f * (f * (f * 6.0 - 15.0) + 10.0)
}

crate::widest! {
    /// `cells`: of a row, and the row.
    fn find_directions(seed: u32, cells: (&[u32], u32), corners: &mut [[f32; 2]]) {
        let (cells, row) = cells;
        for (corner, cell) in corners.iter_mut().zip(cells) {
            let (sin, cos) = fast::sin_cos_of_turn(hash::unit(seed, *cell, row));
            *corner = [cos, sin];
        }
    }

    /// What lies between two rows of corners, so far down: noise is a mix of both everywhere.
    fn mix_rows(corners: [&[[f32; 2]]; 2], fy: f32, mixed: &mut [[f32; 2]]) {
        let down = fade(fy);
        for (mixed, (above, beneath)) in mixed.iter_mut().zip(corners[0].iter().zip(corners[1])) {
            let (high, low) = (above[1] * fy, beneath[1] * (fy - 1.0));
            mixed[0] = above[0] + (beneath[0] - above[0]) * down;
            mixed[1] = high + (low - high) * down;
        }
    }

    /// `places`: the corner before each, how far behind it is, and its share of the next one.
    fn add_between(
        corners: &[[f32; 2]],
        places: (&[u32], &[f32], &[f32]),
        share: f32,
        sums: &mut [f32]
    ) {
        let (before, behind, shares) = places;
        for (sum, ((i, fx), across)) in sums.iter_mut().zip(before.iter().zip(behind).zip(shares)) {
            let (left, right) = (corners[*i as usize], corners[*i as usize + 1]);
            let (a, b) = (left[0] * fx + left[1], right[0] * (fx - 1.0) + right[1]);
            *sum += share * (a + (b - a) * across);
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
            let mut rows = GradientRows::new(&x, period, 9);
            for y in (0..20).map(|i| y + 0.3 * i as f32) {
                let mut sums = vec![0.5; 100];
                rows.add(y, 0.3, &mut sums);
                for (x, sum) in x.iter().zip(&sums) {
                    let wanted = 0.5 + 0.3 * gradient(vec2(*x, y), period, 9);
                    assert!((sum - wanted).abs() < 1e-6, "{sum}, not {wanted} at {x}, {y}");
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
