//! A picture in pixels whose sides are powers of two. Floor 3.

use crate::math::{Rect, Size};
use crate::paint::filter::window::{FilterSource, FilterWindow};
use crate::raster::blur;

/// A picture in pixels whose sides are powers of two; their grid begins at the origin, so that
/// every part of a picture has the same.
pub struct CoarsePixels {
    level: u32,
    /// In coarse pixels.
    rect: Rect,
    pixels: Vec<[f32; 4]>,
}

impl CoarsePixels {
    /// Of the pixels themselves; `rect` counts them.
    pub fn new(level: u32, rect: Rect, pixels: Vec<[f32; 4]>) -> Self {
        Self { level, rect, pixels }
    }

    /// As if they were pixels.
    pub fn as_window(&self) -> FilterWindow {
        FilterWindow::new(self.rect, self.pixels.clone())
    }

    /// Of those that a rectangle touches: each is the mean under a tent twice as wide as it, since
    /// a mean over it alone would let the finest detail through as coarse.
    pub fn of(source: &dyn FilterSource, rect: Rect, level: u32) -> Self {
        let rect = coarse_rect(rect, level);
        let side = 1usize << level;
        let half = side as i32 / 2;
        let (left, right) = ((rect.x0 << level) - half, (rect.x1 << level) + half);
        let width = rect.width();
        // A pixel more at each end, for what tents leave there.
        let mut line = vec![[0.0; 4]; width + 2];
        let mut sums = vec![[0.0; 4]; width * (rect.height() + 2)];
        let share = 1.0 / (side * side) as f32;
        for (row, j) in (rect.y0 - 1..rect.y1).enumerate() {
            let top = (j << level) + half;
            let window = source.window(Rect::new(left, top, right, top + side as i32));
            for (k, pixels) in window.pixels().chunks_exact((right - left) as usize).enumerate() {
                line.fill([0.0; 4]);
                add_tents(pixels, side, &mut line);
                let t = (k as f32 + 0.5) / side as f32;
                for (to, weight) in [(row, (1.0 - t) * share), (row + 1, t * share)] {
                    let to = &mut sums[to * width..(to + 1) * width];
                    add_weighed(line[1..=width].as_flattened(), weight, to.as_flattened_mut());
                }
            }
        }
        let pixels = sums[width..width * (rect.height() + 1)].to_vec();
        Self { level, rect, pixels }
    }

    pub fn blurred(self, sigma: f32) -> Self {
        let size = Size::new(self.rect.width() as u32, self.rect.height() as u32);
        Self { pixels: blur::gaussian_pixels(size, &self.pixels, sigma), ..self }
    }

    /// The pixels of a rectangle, read by a cubic B-spline.
    pub fn read(&self, out: Rect) -> Vec<[f32; 4]> {
        let across: Vec<SplineTap> = (out.x0..out.x1)
            .map(|x| SplineTap::new(x, self.level, self.rect.x0, self.rect.width()))
            .collect();
        let width = self.rect.width();
        let mut line = vec![[0.0; 4]; width];
        let mut all = Vec::with_capacity(out.width() * out.height());
        for y in out.y0..out.y1 {
            let down = SplineTap::new(y, self.level, self.rect.y0, self.rect.height());
            let row = |i: usize| &self.pixels[down.at[i] * width..(down.at[i] + 1) * width];
            let rows = [row(0), row(1), row(2), row(3)];
            weigh_rows(rows.map(|row| row.as_flattened()), &down.weights, line.as_flattened_mut());
            weigh_columns(&line, &across, &mut all);
        }
        all
    }
}

/// The coarse pixels that a rectangle touches.
fn coarse_rect(rect: Rect, level: u32) -> Rect {
    let up = |v: i32| (v + (1 << level) - 1) >> level;
    Rect::new(rect.x0 >> level, rect.y0 >> level, up(rect.x1), up(rect.y1))
}

/// The four coarse pixels around a fine one along an axis, and their weights.
struct SplineTap {
    at: [usize; 4],
    weights: [f32; 4],
}

impl SplineTap {
    fn new(fine: i32, level: u32, first: i32, count: usize) -> Self {
        let place = (fine as f32 + 0.5) / (1 << level) as f32 - 0.5 - first as f32;
        let whole = place.floor();
        let t = place - whole;
        let (t2, t3) = (t * t, t * t * t);
        let s = 1.0 - t;
        let weights = [
            s * s * s / 6.0,
            (3.0 * t3 - 6.0 * t2 + 4.0) / 6.0,
            (-3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0) / 6.0,
            t3 / 6.0,
        ];
        let last = count.saturating_sub(1) as i32;
        let at = [-1, 0, 1, 2].map(|d| (whole as i32 + d).max(0).min(last) as usize);
        Self { at, weights }
    }
}

crate::widest! {
    /// Adds each pixel of a row to the two coarse ones between whose middles it lies.
    fn add_tents(line: &[[f32; 4]], side: usize, sums: &mut [[f32; 4]]) {
        for (i, between) in line.chunks_exact(side).enumerate() {
            let (mut left, mut right) = ([0.0; 4], [0.0; 4]);
            for (k, pixel) in between.iter().enumerate() {
                let t = (k as f32 + 0.5) / side as f32;
                for c in 0..4 {
                    left[c] += (1.0 - t) * pixel[c];
                    right[c] += t * pixel[c];
                }
            }
            for c in 0..4 {
                sums[i][c] += left[c];
                sums[i + 1][c] += right[c];
            }
        }
    }

    fn add_weighed(row: &[f32], weight: f32, sums: &mut [f32]) {
        for (sum, v) in sums.iter_mut().zip(row) {
            *sum += weight * v;
        }
    }

    fn weigh_rows(rows: [&[f32]; 4], weights: &[f32; 4], out: &mut [f32]) {
        let [a, b, c, d] = rows;
        for (i, out) in out.iter_mut().enumerate() {
            *out = weights[0] * a[i] + weights[1] * b[i] + weights[2] * c[i] + weights[3] * d[i];
        }
    }

    fn weigh_columns(line: &[[f32; 4]], across: &[SplineTap], out: &mut Vec<[f32; 4]>) {
        for tap in across {
            let mut sum = [0.0; 4];
            for (at, weight) in tap.at.iter().zip(&tap.weights) {
                let pixel = line[*at];
                for k in 0..4 {
                    sum[k] += weight * pixel[k];
                }
            }
            out.push(sum);
        }
    }
}
