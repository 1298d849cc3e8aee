//! Coverage of a window of the canvas, blurred and dilated: what layer effects are made from. Floor
//! 1. Not here: which effect uses what (`paint::effect`).

use crate::math::Rect;

/// Coverage of a rectangle of the canvas, `[0, 1]`, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Matte {
    rect: Rect,
    values: Vec<f32>,
}

impl Matte {
    /// One value everywhere.
    pub fn full(rect: Rect, value: f32) -> Self {
        Self { rect, values: vec![value; rect.width() * rect.height()] }
    }

    /// What it covers, canvas px.
    pub fn rect(&self) -> Rect {
        self.rect
    }

    /// The values, row by row.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// A row of the canvas, to be written; empty beyond the rectangle.
    pub fn row_mut(&mut self, y: i32) -> &mut [f32] {
        let width = self.rect.width();
        if y < self.rect.y0 || y >= self.rect.y1 {
            return &mut [];
        }
        let start = (y - self.rect.y0) as usize * width;
        &mut self.values[start..start + width]
    }

    /// The value of a pixel of the canvas; 0 beyond the rectangle.
    pub fn at(&self, x: i32, y: i32) -> f32 {
        if !self.rect.contains(x, y) {
            return 0.0;
        }
        let row = (y - self.rect.y0) as usize * self.rect.width();
        self.values[row + (x - self.rect.x0) as usize]
    }

    /// The value between pixels: `x` and `y` count from pixel centers.
    pub fn interpolate(&self, x: f32, y: f32) -> f32 {
        let (left, top) = (x.floor(), y.floor());
        let (s, t) = (x - left, y - top);
        let (left, top) = (left as i32, top as i32);
        let along = |y| {
            let first = self.at(left, y);
            if s > 0.0 { first + s * (self.at(left + 1, y) - first) } else { first }
        };
        let upper = along(top);
        if t > 0.0 { upper + t * (along(top + 1) - upper) } else { upper }
    }

    /// 1 − the values.
    pub fn complement(mut self) -> Self {
        self.values.iter_mut().for_each(|v| *v = 1.0 - *v);
        self
    }

    /// Each value changed by a function.
    pub fn map(mut self, change: impl Fn(f32) -> f32) -> Self {
        self.values.iter_mut().for_each(|v| *v = change(*v));
        self
    }

    /// Two means over `width` px along each axis: a tent that reaches `width` px, as Photoshop
    /// blurs shadows and glows. Values within that of the rectangle's border are too small.
    pub fn blurred(self, width: f32) -> Self {
        if width.is_nan() || width <= 1.0 {
            return self;
        }
        let (w, h) = (self.rect.width(), self.rect.height());
        let mut across = vec![0.0; self.values.len()];
        mean_rows(&self.values, w, width, &mut across);
        let sideways = transpose(&across, w);
        mean_rows(&sideways, h, width, &mut across);
        Self { rect: self.rect, values: transpose(&across, h) }
    }

    /// What lies within a distance of what is covered: max over q of clamp(by + a(q) − |p − q|), a
    /// partly covered pixel reaching as much less far.
    ///
    /// Lengths are those of ways in the eight `STEPS` and those opposite, as in Photoshop's
    /// pictures: up to 2.7 % longer than straight ones.
    pub fn dilated(self, by_px: f32) -> Self {
        self.reaching(by_px, |reach, _| reach.min(1.0))
    }

    /// 1 on what is covered, falling straight to 0 over a distance: the same reach as a share of
    /// the distance.
    pub fn fading(self, over_px: f32) -> Self {
        self.reaching(over_px, |reach, over| (reach / over).min(1.0))
    }

    /// What `value` makes of how far beyond each pixel what is covered reaches, and of how far it
    /// reaches at all.
    fn reaching(mut self, by: f32, value: impl Fn(f32, f32) -> f32) -> Self {
        if by.is_nan() || by <= 0.0 {
            return self;
        }
        let width = self.rect.width();
        let reach = spread_along_ways(&self.values, width);
        let reach = reach.chunks_exact(width + 2 * AROUND).skip(AROUND);
        let rows = self.values.chunks_exact_mut(width.max(1));
        for (row, reach) in rows.zip(reach) {
            for (v, reach) in row.iter_mut().zip(reach.iter().skip(AROUND)) {
                *v = value((by + *reach as f32 / UNIT as f32).max(0.0), by);
            }
        }
        self
    }
}

/// A pixel in whole parts, which add up to the same length in any order.
const UNIT: i32 = 1 << 16;
/// Less than any way through a window leaves.
const UNREACHED: i32 = i32::MIN / 2;
/// How far a step goes along an axis at most.
const AROUND: usize = 2;
/// Steps to pixels that come before in reading order, `(x, y, length)`: straight, diagonal, and a
/// knight's move.
const STEPS: [(isize, isize, i32); 8] = [
    (-1, 0, UNIT),
    (0, -1, UNIT),
    (-1, -1, 92_682),
    (1, -1, 92_682),
    (-2, -1, 146_543),
    (2, -1, 146_543),
    (-1, -2, 146_543),
    (1, -2, 146_543),
];

/// What the best way from a covered pixel leaves of its coverage, in units: coverage less length.
/// With a border of [`AROUND`] pixels.
fn spread_along_ways(values: &[f32], width: usize) -> Vec<i32> {
    let stride = width + 2 * AROUND;
    let height = values.len() / width.max(1);
    let mut left = vec![UNREACHED; stride * (height + 2 * AROUND)];
    let rows = left.chunks_exact_mut(stride).skip(AROUND);
    for (row, values) in rows.zip(values.chunks_exact(width.max(1))) {
        for (v, covered) in row[AROUND..].iter_mut().zip(values).filter(|(_, c)| **c > 0.0) {
            *v = (covered * UNIT as f32 + 0.5) as i32;
        }
    }
    let back = |(x, y, length): (isize, isize, i32)| ((-y * stride as isize - x) as usize, length);
    let steps = STEPS.map(back);
    // Once from each end: any way can be gone with all steps that lead on first.
    for _ in 0..2 {
        for y in AROUND..AROUND + height {
            let first = y * stride + AROUND;
            for at in first..first + width {
                let best = steps.iter().map(|(back, length)| left[at - back] - length);
                left[at] = best.fold(left[at], i32::max);
            }
        }
        left.reverse();
    }
    left
}

/// The mean over `width` px around each value of rows, twice.
fn mean_rows(values: &[f32], length: usize, width: f32, out: &mut [f32]) {
    let mut sums = vec![0.0f64; length + 1];
    for (row, out) in values.chunks_exact(length).zip(out.chunks_exact_mut(length)) {
        mean_row(row, width, &mut sums, out);
        let once = out.to_vec();
        mean_row(&once, width, &mut sums, out);
    }
}

/// Sums of the row up to each place, read a half width beyond and before each pixel, between two
/// places where the width is no whole number.
fn mean_row(row: &[f32], width: f32, sums: &mut [f64], out: &mut [f32]) {
    let mut sum = 0.0f64;
    for (kept, v) in sums[1..].iter_mut().zip(row) {
        sum += f64::from(*v);
        *kept = sum;
    }
    let (half, last) = (f64::from(width) / 2.0, row.len());
    let after = 0.5 + half;
    let (whole, share) = (after.floor() as usize, after.fract());
    let sum_at = |place: i64| sums[place.clamp(0, last as i64) as usize];
    for (x, v) in out.iter_mut().enumerate() {
        let x = x as i64;
        // The place before is that after, mirrored about the middle of the pixel.
        let (high, low) = (x + whole as i64, x + 1 - whole as i64);
        let up = sum_at(high) + share * (sum_at(high + 1) - sum_at(high));
        let down = sum_at(low) + share * (sum_at(low - 1) - sum_at(low));
        *v = ((up - down) / f64::from(width)) as f32;
    }
}

fn transpose(values: &[f32], width: usize) -> Vec<f32> {
    let height = values.len() / width.max(1);
    let mut out = vec![0.0; values.len()];
    for (y, row) in values.chunks_exact(width.max(1)).enumerate() {
        for (x, v) in row.iter().enumerate() {
            out[x * height + y] = *v;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dot(side: i32) -> Matte {
        let mut matte = Matte::full(Rect::new(-side, -side, side + 1, side + 1), 0.0);
        matte.row_mut(0)[side as usize] = 1.0;
        matte
    }

    #[test]
    fn a_blur_is_a_tent_whose_weight_is_one() {
        let blurred = dot(12).blurred(5.0);
        let sum: f32 = blurred.values().iter().sum();
        assert!((sum - 1.0).abs() < 1e-5, "{sum}");
        // Two means over five pixels: 5, 4, 3, 2, 1 of 25.
        for (x, weight) in [(0, 5.0), (1, 4.0), (-2, 3.0), (4, 1.0), (5, 0.0)] {
            let found = blurred.at(x, 0) / (5.0 / 25.0);
            assert!((found - weight / 25.0).abs() < 1e-6, "{x}: {found}");
        }
        let between = dot(12).blurred(4.5);
        assert!((between.values().iter().sum::<f32>() - 1.0).abs() < 1e-5);
        assert!((between.at(3, 2) - between.at(-3, -2)).abs() < 1e-7, "it lies in the middle");
    }

    #[test]
    fn what_is_dilated_is_nearly_round_and_a_faint_pixel_reaches_less_far() {
        let dilated = dot(9).dilated(4.0);
        assert_eq!([dilated.at(4, 0), dilated.at(5, 0), dilated.at(6, 0)], [1.0, 0.0, 0.0]);
        assert!((dilated.at(3, 3) - (5.0 - 18f32.sqrt())).abs() < 1e-4, "{}", dilated.at(3, 3));
        // A knight's move and two straight steps, where the way as the crow flies is 4.12.
        let way = 5f32.sqrt() + 2.0;
        assert!((dilated.at(4, 1) - (5.0 - way)).abs() < 1e-4, "{}", dilated.at(4, 1));
        assert_eq!(dilated.at(-1, 4), dilated.at(4, 1));
        let faint = dot(9).map(|v| v * 0.25).dilated(4.0);
        assert_eq!([faint.at(3, 0), faint.at(4, 0), faint.at(5, 0)], [1.0, 0.25, 0.0]);
    }

    #[test]
    fn every_window_gives_the_same_values() {
        let noise = |x: i32, y: i32| {
            let v = crate::math::hash::unit(3, x as u32, y as u32);
            if v > 0.97 { v } else { 0.0 }
        };
        let window = |rect: Rect| {
            let mut matte = Matte::full(rect, 0.0);
            for y in rect.y0..rect.y1 {
                let row = matte.row_mut(y).iter_mut().zip(rect.x0..);
                row.for_each(|(v, x)| *v = noise(x, y));
            }
            matte
        };
        let (a, b) = (Rect::new(-30, -30, 30, 30), Rect::new(-21, -26, 40, 33));
        for y in -4..4 {
            for x in -4..4 {
                let dilated = [a, b].map(|rect| window(rect).dilated(7.5).at(x, y));
                assert_eq!(dilated[0], dilated[1], "({x}, {y})");
                let blurred = [a, b].map(|rect| window(rect).blurred(8.0).at(x, y));
                assert!((blurred[0] - blurred[1]).abs() < 1e-6, "({x}, {y}): {blurred:?}");
            }
        }
    }
}
