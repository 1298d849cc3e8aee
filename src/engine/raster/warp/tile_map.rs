//! A map of one tile, given pixel by pixel. Floor 1.

use super::window::WIDEST_PX;
use super::{PixelMap, PointRow};
use crate::math::plane_map::PixelMove;
use crate::math::{Mat2, Rect, Vec2, vec2};

/// The points of the source that the pixels of a rectangle show, row by row, each coordinate in its
/// own row.
#[derive(Clone, Debug, Default)]
pub struct TilePoints {
    /// The first coordinates.
    pub x: Vec<f32>,
    /// The second coordinates.
    pub y: Vec<f32>,
    /// How the points move with the pixel: with a step to the right (x, y), and with one down (x,
    /// y).
    pub jacobian: [Vec<f32>; 4],
}

/// The same with the rectangle.
pub struct TileMap {
    rect: Rect,
    points: TilePoints,
}

/// Farther away than any pixel.
const FAR: f32 = 1e6;

impl TilePoints {
    /// Room for this many points, all at the corner.
    pub fn new(count: usize) -> Self {
        let row = || vec![0.0; count];
        Self { x: row(), y: row(), jacobian: std::array::from_fn(|_| row()) }
    }

    /// How many points there are.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// There is no point.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// A point, and how it changes from pixel to pixel.
    pub fn at(&self, k: usize) -> (Vec2, Mat2) {
        let [a, b, c, d] = &self.jacobian;
        (vec2(self.x[k], self.y[k]), Mat2::from_cols_array(&[a[k], b[k], c[k], d[k]]))
    }

    /// Sets a point, and how it changes from pixel to pixel.
    pub fn set(&mut self, k: usize, (p, jacobian): (Vec2, Mat2)) {
        (self.x[k], self.y[k]) = (p.x, p.y);
        self.jacobian.iter_mut().zip(jacobian.to_cols_array()).for_each(|(row, v)| row[k] = v);
    }

    /// Whether a pixel shows a point: its numbers are finite, as is their sum.
    fn is_known(&self, k: usize) -> bool {
        let sum = self
            .jacobian
            .iter()
            .fold(self.x[k].abs() + self.y[k].abs(), |sum, row| sum + row[k].abs());
        sum < f32::INFINITY
    }
}

impl TileMap {
    /// * `points`: one for each pixel of `rect`; NaN shows nothing.
    pub fn new(rect: Rect, points: TilePoints) -> Self {
        Self { rect, points }
    }

    /// The index of a pixel of the rectangle.
    fn place(&self, x: i32, y: i32) -> usize {
        (y - self.rect.y0) as usize * self.rect.width() + (x - self.rect.x0) as usize
    }
}

impl PixelMap for TileMap {
    fn source_of(&self, q: Vec2) -> Option<(Vec2, Mat2)> {
        let (x, y) = (q.x.floor() as i32, q.y.floor() as i32);
        let place = self.rect.contains(x, y).then(|| self.place(x, y))?;
        self.points.is_known(place).then(|| self.points.at(place))
    }

    fn source_row(&self, x: i32, y: i32, count: usize, row: &mut PointRow) {
        let is_within = self.rect.contains(x, y) && self.rect.contains(x + count as i32 - 1, y);
        if !is_within {
            row.fill_by_points(self, x, y, count);
            return;
        }
        let (from, points) = (self.place(x, y), &self.points);
        row.x[..count].copy_from_slice(&points.x[from..from + count]);
        row.y[..count].copy_from_slice(&points.y[from..from + count]);
        for (to, of) in row.jacobian.iter_mut().zip(&points.jacobian) {
            to[..count].copy_from_slice(&of[from..from + count]);
        }
        let [a, b, c, d] = &points.jacobian;
        let within = from..from + count;
        let [a, b, c, d] = [a, b, c, d].map(|row| &row[within.clone()]);
        mark_known(
            &points.x[within.clone()],
            &points.y[within],
            [a, b, c, d],
            &mut row.shows[..count],
        );
    }

    fn pixel_move(&self) -> Option<PixelMove> {
        None
    }

    fn source_rect(&self, canvas: Rect) -> Rect {
        let mut extent = PointBounds {
            low: [f32::INFINITY; 2],
            high: [f32::NEG_INFINITY; 2],
            sides_squared: [0.0; 2],
        };
        let area = canvas.intersect(self.rect);
        for y in area.y0..area.y1 {
            let row = self.place(area.x0, y)..self.place(area.x0, y) + area.width();
            let p = &self.points;
            let [a, b, c, d] = &p.jacobian;
            let jacobian = [&a[row.clone()], &b[row.clone()], &c[row.clone()], &d[row.clone()]];
            widen(&mut extent, &p.x[row.clone()], &p.y[row], jacobian);
        }
        let PointBounds { low, high, sides_squared: [right, down] } = extent;
        if low[0] > high[0] {
            return Rect::EMPTY;
        }
        let side = |v: f32| v.max(-FAR).min(FAR) as i32;
        let longest = |squared: f32| squared.sqrt().min(WIDEST_PX);
        let reach = 2.0 + (longest(right) + longest(down)).max(1.0);
        Rect::new(
            side(low[0] - reach),
            side(low[1] - reach),
            side(high[0] + reach) + 1,
            side(high[1] + reach) + 1,
        )
    }
}

/// What points reach, and how long the sides of their pieces of the source are at most.
struct PointBounds {
    low: [f32; 2],
    high: [f32; 2],
    sides_squared: [f32; 2],
}

/// Lanes for extents, so that rows are read in parallel.
const LANES: usize = 8;

crate::widest! {
    fn widen(extent: &mut PointBounds, x: &[f32], y: &[f32], jacobian: [&[f32]; 4]) {
        let n = x.len();
        let (y, [a, b, c, d]) = (&y[..n], jacobian.map(|row| &row[..n]));
        let (mut low, mut high, mut sides) =
            ([[f32::INFINITY; LANES]; 2], [[f32::NEG_INFINITY; LANES]; 2], [[0.0f32; LANES]; 2]);
        for from in (0..n).step_by(LANES) {
            let count = LANES.min(n - from);
            for l in 0..count {
                let k = from + l;
                let (right, down) = (a[k] * a[k] + b[k] * b[k], c[k] * c[k] + d[k] * d[k]);
                let is_known = (x[k] + y[k] + a[k] + b[k] + c[k] + d[k]).abs() < f32::INFINITY;
                low[0][l] = if is_known && x[k] < low[0][l] { x[k] } else { low[0][l] };
                low[1][l] = if is_known && y[k] < low[1][l] { y[k] } else { low[1][l] };
                high[0][l] = if is_known && x[k] > high[0][l] { x[k] } else { high[0][l] };
                high[1][l] = if is_known && y[k] > high[1][l] { y[k] } else { high[1][l] };
                sides[0][l] = if is_known && right > sides[0][l] { right } else { sides[0][l] };
                sides[1][l] = if is_known && down > sides[1][l] { down } else { sides[1][l] };
            }
        }
        for l in 0..LANES {
            for i in 0..2 {
                extent.low[i] = extent.low[i].min(low[i][l]);
                extent.high[i] = extent.high[i].max(high[i][l]);
                extent.sides_squared[i] = extent.sides_squared[i].max(sides[i][l]);
            }
        }
    }

    /// As [`TilePoints::is_known`], of a row.
    fn mark_known(x: &[f32], y: &[f32], jacobian: [&[f32]; 4], out: &mut [bool]) {
        let n = out.len();
        let (x, y, [a, b, c, d]) = (&x[..n], &y[..n], jacobian.map(|row| &row[..n]));
        for k in 0..n {
            let sum = x[k].abs() + y[k].abs() + a[k].abs() + b[k].abs() + c[k].abs() + d[k].abs();
            out[k] = sum < f32::INFINITY;
        }
    }
}
