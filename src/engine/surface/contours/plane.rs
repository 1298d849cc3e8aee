//! A plane fitted to values of a contour pixel's window (MATH 10).
//! Floor 2.

use super::window::offset_of;
use crate::math::{Vec2, vec2};

/// A plane v(x, y) fitted to a window's values by weighted least squares.
#[derive(Clone, Copy, Debug)]
pub struct LeastSquaresPlane {
    /// At the middle pixel's center.
    pub here: f32,
    /// Per px, image axes.
    pub slope: Vec2,
}

impl LeastSquaresPlane {
    /// `ridge`: added to both slopes' weights, so that few pixels give a flat plane. `None` without
    /// any weight.
    pub fn fit_weighted(
        members: impl Iterator<Item = u32>,
        ridge: f32,
        weight_and_value: impl Fn(u32) -> (f32, f32),
    ) -> Option<Self> {
        let [plane] = Self::of_each(members, ridge, |i| {
            let (weight, value) = weight_and_value(i);
            (weight, [value])
        })?;
        Some(plane)
    }

    /// The planes of several values that have the same weights.
    pub fn of_each<const N: usize>(
        members: impl Iterator<Item = u32>,
        ridge: f32,
        weight_and_values: impl Fn(u32) -> (f32, [f32; N]),
    ) -> Option<[Self; N]> {
        let mut of_places = [0.0f64; 6];
        let mut of_values = [[0.0f64; 3]; N];
        for i in members {
            let (weight, values) = weight_and_values(i);
            let (w, at) = (f64::from(weight), offset_of(i).as_dvec2());
            let terms = [1.0, at.x, at.y, at.x * at.x, at.x * at.y, at.y * at.y];
            for (sum, term) in of_places.iter_mut().zip(&terms) {
                *sum += w * term;
            }
            for (sums, value) in of_values.iter_mut().zip(&values) {
                let v = f64::from(*value);
                for (sum, term) in sums.iter_mut().zip(&[v, at.x * v, at.y * v]) {
                    *sum += w * term;
                }
            }
        }
        let [w, x, y, xx, xy, yy] = of_places;
        if w <= 1e-12 {
            return None;
        }
        // Centered, the two slopes come from a 2 × 2 system.
        let ridge = f64::from(ridge);
        let (a, b, c) = (xx - x * x / w + ridge, xy - x * y / w, yy - y * y / w + ridge);
        let det = a * c - b * b;
        Some(of_values.map(|[v, xv, yv]| {
            let (p, q) = (xv - x * v / w, yv - y * v / w);
            let (sx, sy) = if det > 1e-18 {
                ((c * p - b * q) / det, (a * q - b * p) / det)
            } else {
                (0.0, 0.0)
            };
            let here = (v - sx * x - sy * y) / w;
            Self { here: here as f32, slope: vec2(sx as f32, sy as f32) }
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::contours::line::bits;
    use crate::surface::contours::window::ALL;

    #[test]
    fn a_plane_is_fitted_exactly() {
        let value = |i: u32| (1.0, 3.0 + vec2(0.5, -0.25).dot(offset_of(i)));
        let fit = LeastSquaresPlane::fit_weighted(bits(0b1011 << 14), 0.0, value);
        assert!(
            fit.is_some_and(|fit| fit.slope.y == 0.0),
            "one row tells nothing about y: {fit:?}"
        );
        let fit = LeastSquaresPlane::fit_weighted(bits(ALL & !0xfff), 0.0, value).unwrap();
        assert!(
            (fit.here - 3.0).abs() < 1e-5 && (fit.slope - vec2(0.5, -0.25)).length() < 1e-5,
            "{fit:?}"
        );
        assert!(LeastSquaresPlane::fit_weighted(bits(0), 1.0, value).is_none());
    }
}
