//! Pixels that the four nearest of the source give, one by one and in rows. Floor 1.

use super::points::PointRow;
use super::weights::TileRow;
use super::window::SourceWindow;
use crate::math::Vec2;
use crate::raster::TILE;

/// The upper left of the four pixels around each point of a row, and how far each point is from its
/// middle, px.
pub(super) struct LinearRow {
    left: [i32; TILE],
    top: [i32; TILE],
    right_by: TileRow,
    down_by: TileRow,
    /// Whether the pixel is one of four.
    pub takes: [bool; TILE],
}

impl Default for LinearRow {
    fn default() -> Self {
        let (place, by) = ([0; TILE], [0.0; TILE]);
        Self { left: place, top: place, right_by: by, down_by: by, takes: [false; TILE] }
    }
}

impl SourceWindow {
    /// 2 × 2 pixels, weighed by how near they are.
    pub fn linear(&self, p: Vec2) -> [f32; 4] {
        let (x, y) = (p.x - 0.5, p.y - 0.5);
        let (left, top) = (x.floor(), y.floor());
        self.of_four(left as i32, top as i32, x - left, y - top)
    }

    /// The same of the pixels of a row that take it, to the bit.
    pub(super) fn linear_row(&self, points: &PointRow, row: &mut LinearRow, out: &mut [[f32; 4]]) {
        let n = out.len();
        nearest(&points.x[..n], &mut row.left[..n], &mut row.right_by[..n]);
        nearest(&points.y[..n], &mut row.top[..n], &mut row.down_by[..n]);
        for (k, out) in out.iter_mut().enumerate().filter(|(k, _)| row.takes[*k]) {
            *out = self.of_four(row.left[k], row.top[k], row.right_by[k], row.down_by[k]);
        }
    }

    #[inline(always)]
    fn of_four(&self, x: i32, y: i32, s: f32, t: f32) -> [f32; 4] {
        let width = self.rect.width();
        let (i, j) =
            (i64::from(x) - i64::from(self.rect.x0), i64::from(y) - i64::from(self.rect.y0));
        let is_within =
            i >= 0 && j >= 0 && i + 1 < width as i64 && j + 1 < self.rect.height() as i64;
        let [a, b, c, d] = if is_within {
            let first = j as usize * width + i as usize;
            let (upper, lower) =
                (&self.pixels[first..first + 2], &self.pixels[first + width..first + width + 2]);
            [upper[0], upper[1], lower[0], lower[1]]
        } else {
            let (right, below) = (x.saturating_add(1), y.saturating_add(1));
            [self.pixel(x, y), self.pixel(right, y), self.pixel(x, below), self.pixel(right, below)]
        };
        let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t];
        std::array::from_fn(|i| {
            weights[0] * a[i] + weights[1] * b[i] + weights[2] * c[i] + weights[3] * d[i]
        })
    }
}

crate::widest! {
    /// The pixel whose middle lies at a place or before it, and how far behind it the place is.
    fn nearest(p: &[f32], pixel: &mut [i32], behind: &mut [f32]) {
        let n = p.len();
        let (pixel, behind) = (&mut pixel[..n], &mut behind[..n]);
        for k in 0..n {
            let x = p[k] - 0.5;
            let floor = x.floor();
            (pixel[k], behind[k]) = (floor as i32, x - floor);
        }
    }
}
