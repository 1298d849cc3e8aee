//! Closed paths as coverage: the exact area that a polygon takes of each pixel.
//! Floor 3. Not here: flattening of curves.

use super::Outline;
use crate::math::{Size, Vec2, vec2};
use crate::raster::Plane;

impl Outline {
    /// The inside of a closed polygon through `points`, canvas px: where the winding number is not
    /// 0.
    ///
    /// `None` where it encloses nothing, a point is not finite, or its rectangle has more than
    /// `most_px` pixels.
    pub fn of_path(points: &[Vec2], most_px: usize) -> Option<Self> {
        if points.len() < 3 || points.iter().any(|p| !p.is_finite() || p.abs().max_element() > 1e6)
        {
            return None;
        }
        let low = points.iter().fold(Vec2::MAX, |a, b| a.min(*b)).floor();
        let high = points.iter().fold(Vec2::MIN, |a, b| a.max(*b)).ceil();
        let (w, h) = ((high.x - low.x) as usize + 1, (high.y - low.y) as usize + 1);
        if w.checked_mul(h).is_none_or(|area| area > most_px) {
            return None;
        }
        let mut area = Accumulator { w: w + 1, sums: vec![0.0; (w + 1) * h] };
        for (i, p) in points.iter().enumerate() {
            let q = points[(i + 1) % points.len()];
            area.line(*p - low, q - low);
        }
        Self::new((low.x as i32, low.y as i32), &area.coverage(w, h))
    }
}

/// Signed areas to the right of edges, differenced along rows: a running sum gives coverage.
struct Accumulator {
    w: usize,
    sums: Vec<f32>,
}

impl Accumulator {
    /// One edge; both ends lie in the plane.
    fn line(&mut self, from: Vec2, to: Vec2) {
        if from.y == to.y {
            return;
        }
        let (sign, a, b) = if from.y < to.y { (1.0, from, to) } else { (-1.0, to, from) };
        let slope = (b.x - a.x) / (b.y - a.y);
        let rows = a.y.floor() as usize..(b.y.ceil() as usize).min(self.sums.len() / self.w);
        for y in rows {
            let (top, bottom) = (a.y.max(y as f32), b.y.min(y as f32 + 1.0));
            if bottom > top {
                let at = |v: f32| a.x + (v - a.y) * slope;
                self.span(y, at(top), at(bottom), sign * (bottom - top));
            }
        }
    }

    /// The part of an edge within one row: from column x0 to x1, `height` of the row high.
    fn span(&mut self, y: usize, x0: f32, x1: f32, height: f32) {
        let (left, right) = (x0.min(x1).max(0.0), x0.max(x1).max(0.0));
        let row = &mut self.sums[y * self.w..(y + 1) * self.w];
        let last = row.len() - 1;
        let first = (left as usize).min(last);
        let end = (right.ceil() as usize).max(first + 1).min(last + 1);
        let mut before = 0.0;
        for (column, sum) in (first..end).zip(&mut row[first..end]) {
            // The share of the row's height to the right of the edge within this column and all
            // before it.
            let x = column as f32 + 1.0;
            let mean = if right - left < 1e-6 {
                (x - left).max(0.0).min(1.0)
            } else {
                let ramp = |v: f32| 0.5 * (v.max(left).min(right) - left).powi(2) / (right - left);
                (ramp(x) - ramp(x - 1.0)) + (x - right.max(x - 1.0)).max(0.0)
            };
            *sum += height * (mean - before);
            before = mean;
        }
        if let Some(next) = row.get_mut(end) {
            *next += height * (1.0 - before);
        }
    }

    fn coverage(&self, w: usize, h: usize) -> Plane<u8> {
        let mut out = Plane::full(Size::new(w as u32, h as u32), 0);
        for y in 0..h {
            let mut sum = 0.0;
            for (x, c) in out.row_mut(y).iter_mut().enumerate() {
                sum += self.sums[y * self.w + x];
                *c = (sum.abs() * 255.0).round().min(255.0) as u8;
            }
        }
        out
    }
}

/// A polygon of `corners` points around an ellipse, for drawn outlines and for tests with known
/// results.
pub fn ellipse(center: Vec2, half_axes: Vec2, turn_rad: f32, corners: usize) -> Vec<Vec2> {
    let turn = Vec2::from_angle(turn_rad);
    let at = |i: usize| std::f32::consts::TAU * i as f32 / corners as f32;
    (0..corners).map(|i| center + turn.rotate(vec2(at(i).cos(), at(i).sin()) * half_axes)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(outline: &Outline) -> f64 {
        outline.coverage().values().iter().map(|c| f64::from(*c)).sum::<f64>() / 255.0
    }

    #[test]
    fn a_rectangle_between_pixels_covers_their_exact_shares() {
        let corners = [vec2(2.25, 3.0), vec2(5.0, 3.0), vec2(5.0, 4.5), vec2(2.25, 4.5)];
        for points in [corners.to_vec(), corners.iter().rev().copied().collect()] {
            let outline = Outline::of_path(&points, 1000).unwrap();
            let at = |x: i32, y: i32| {
                outline
                    .coverage()
                    .at((x - outline.corner().0) as usize, (y - outline.corner().1) as usize)
            };
            assert_eq!([at(2, 3), at(3, 3), at(4, 3)], [191, 255, 255]);
            assert_eq!([at(2, 4), at(3, 4)], [96, 128]);
        }
    }

    #[test]
    fn polygons_cover_their_area_whatever_way_they_turn() {
        for (i, turn) in [0.0f32, 0.3, 1.1, 2.9].iter().enumerate() {
            let points = ellipse(vec2(30.3, 24.7), vec2(20.0, 9.0), *turn, 400);
            let points: Vec<Vec2> =
                if i % 2 == 0 { points } else { points.into_iter().rev().collect() };
            let found = area(&Outline::of_path(&points, 1 << 20).unwrap());
            assert!((found / (std::f64::consts::PI * 180.0) - 1.0).abs() < 2e-3, "{found}");
        }
    }

    #[test]
    fn paths_that_enclose_nothing_or_too_much_give_nothing() {
        assert!(
            Outline::of_path(&[vec2(0.0, 0.0), vec2(5.0, 5.0), vec2(9.0, 9.0)], 1000).is_none()
        );
        assert!(
            Outline::of_path(&[vec2(0.0, 0.0), vec2(f32::NAN, 5.0), vec2(9.0, 0.0)], 1000)
                .is_none()
        );
        assert!(
            Outline::of_path(&[vec2(0.0, 0.0), vec2(900.0, 0.0), vec2(0.0, 900.0)], 1000).is_none()
        );
        assert!(Outline::of_path(&[vec2(0.0, 0.0); 2], 1000).is_none());
    }
}
