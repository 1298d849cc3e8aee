//! The points of the source that a row of pixels shows, each coordinate in its own row. Floor 1.

use super::PixelMap;
use crate::math::plane_map::PlaneMap;
use crate::math::{Mat2, Vec2, vec2};
use crate::raster::TILE;

/// What a row of at most this many pixels shows.
#[derive(Clone, Debug)]
pub struct PointRow {
    /// Px of the source.
    pub x: [f32; TILE],
    /// The second coordinates.
    pub y: [f32; TILE],
    /// How the points move with the pixel: with a step to the right (x, y), and with one down (x,
    /// y).
    pub jacobian: [[f32; TILE]; 4],
    /// Whether a pixel shows any point.
    pub shows: [bool; TILE],
}

impl Default for PointRow {
    fn default() -> Self {
        let row = [0.0; TILE];
        Self { x: row, y: row, jacobian: [row; 4], shows: [false; TILE] }
    }
}

impl PointRow {
    /// The points of `count` pixels from `(x, y)` on, computed one by one.
    pub fn fill_by_points(&mut self, map: &(impl PixelMap + ?Sized), x: i32, y: i32, count: usize) {
        for k in 0..count.min(TILE) {
            let q = vec2((x + k as i32) as f32 + 0.5, y as f32 + 0.5);
            self.set(k, map.source_of(q));
        }
    }

    /// The same for a map of the plane. For an affine one all points of a row are computed
    /// together.
    pub fn fill_by_plane(&mut self, map: &PlaneMap, x: i32, y: i32, count: usize) {
        let count = count.min(TILE);
        let first = vec2(x as f32 + 0.5, y as f32 + 0.5);
        match map.from_canvas(first) {
            Some((_, jacobian))
                if map.affine_row_from_canvas(
                    first,
                    &mut self.x[..count],
                    &mut self.y[..count],
                ) =>
            {
                self.jacobian
                    .iter_mut()
                    .zip(jacobian.to_cols_array())
                    .for_each(|(row, v)| row[..count].fill(v));
                let both = self.x.iter().zip(&self.y);
                self.shows
                    .iter_mut()
                    .zip(both)
                    .for_each(|(shows, (x, y))| *shows = x.is_finite() && y.is_finite());
            }
            _ => (0..count).for_each(|k| self.set(k, map.from_canvas(first + vec2(k as f32, 0.0)))),
        }
    }

    /// One point, and how it moves.
    pub(super) fn at(&self, k: usize) -> (Vec2, Mat2) {
        let [a, b, c, d] = &self.jacobian;
        (vec2(self.x[k], self.y[k]), Mat2::from_cols_array(&[a[k], b[k], c[k], d[k]]))
    }

    fn set(&mut self, k: usize, point: Option<(Vec2, Mat2)>) {
        self.shows[k] = point.is_some();
        if let Some((p, jacobian)) = point {
            (self.x[k], self.y[k]) = (p.x, p.y);
            self.jacobian.iter_mut().zip(jacobian.to_cols_array()).for_each(|(row, v)| row[k] = v);
        }
    }
}
