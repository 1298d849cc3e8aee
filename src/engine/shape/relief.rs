//! Relief from a picture: its detail as height over a form, never its brightness as the form.
//! Floor 3. Edge-preserving smoothing is the guided filter (He, Sun and Tang 2013), inside the outline
//! only.

use super::Outline;
use crate::math::Range;
use crate::raster::Plane;

/// What part of a picture becomes height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detail {
    /// Height of the whole range of luminance at the coarse and the fine scale, px.
    pub coarse: f32,
    /// As `coarse`, at the fine scale.
    pub fine: f32,
    /// Radius of the coarse scale, px; the fine one's is a quarter of it.
    pub radius: f32,
    /// Steps of luminance that count as edges of the painting and stay out of the relief, `(0, 1]`.
    pub edge: f32,
}

impl Detail {
    /// What a height may be, px.
    pub const HEIGHT: Range = -512.0..=512.0;
    /// What a radius may be, px.
    pub const RADIUS: Range = 1.0..=512.0;
    /// The range of an edge.
    pub const EDGE: Range = 0.005..=1.0;
}

impl Default for Detail {
    fn default() -> Self {
        Self { coarse: 6.0, fine: 3.0, radius: 16.0, edge: 0.2 }
    }
}

/// The height layer of a picture's detail, px: each scale is what its base removes from the one
/// before.
///
/// `luminance`: `[0, 1]`, as large as the outline's planes.
pub fn relief(outline: &Outline, luminance: &Plane<f32>, detail: Detail) -> Plane<f32> {
    let inside = outline.inside_pixels();
    if luminance.size() != inside.size() {
        return Plane::full(inside.size(), 0.0);
    }
    let edge = detail.edge * detail.edge;
    let fine = filter_guided(luminance, inside, (0.25 * detail.radius).max(1.0) as usize, edge);
    let coarse = filter_guided(&fine, inside, detail.radius.max(1.0) as usize, edge);
    Plane::from_fn(inside.size(), |x, y| {
        if !inside.at(x, y) {
            return 0.0;
        }
        let (l, f, c) = (luminance.at(x, y), fine.at(x, y), coarse.at(x, y));
        detail.fine * (l - f) + detail.coarse * (f - c)
    })
}

/// The guided filter of a plane by itself: q = a p + b with a = var/(var + ε), both averaged over
/// the window.
pub fn filter_guided(
    plane: &Plane<f32>,
    inside: &Plane<bool>,
    radius: usize,
    epsilon: f32,
) -> Plane<f32> {
    let mean = mean_within(plane, inside, radius);
    let square = mean_within(&plane.map(|v| v * v), inside, radius);
    let share = Plane::from_fn(plane.size(), |x, y| {
        let variance = (square.at(x, y) - mean.at(x, y) * mean.at(x, y)).max(0.0);
        variance / (variance + epsilon)
    });
    let rest = Plane::from_fn(plane.size(), |x, y| mean.at(x, y) * (1.0 - share.at(x, y)));
    let (share, rest) = (mean_within(&share, inside, radius), mean_within(&rest, inside, radius));
    Plane::from_fn(plane.size(), |x, y| share.at(x, y) * plane.at(x, y) + rest.at(x, y))
}

/// The mean over a square window of what is inside; 0 where nothing is. Running sums along rows,
/// then columns.
fn mean_within(plane: &Plane<f32>, inside: &Plane<bool>, radius: usize) -> Plane<f32> {
    let (w, h) = (plane.width(), plane.height());
    let along = |value: &dyn Fn(usize) -> (f64, f64), n: usize| -> Vec<(f64, f64)> {
        let mut sums = vec![(0.0, 0.0); n + 1];
        for i in 0..n {
            let (v, c) = value(i);
            sums[i + 1] = (sums[i].0 + v, sums[i].1 + c);
        }
        let window = |i: usize| (i.saturating_sub(radius), (i + radius + 1).min(n));
        (0..n).map(window).map(|(a, b)| (sums[b].0 - sums[a].0, sums[b].1 - sums[a].1)).collect()
    };
    let mut rows = Vec::with_capacity(w * h);
    for y in 0..h {
        let value =
            |x: usize| if inside.at(x, y) { (f64::from(plane.at(x, y)), 1.0) } else { (0.0, 0.0) };
        rows.extend(along(&value, w));
    }
    let mut out = Plane::full(plane.size(), 0.0);
    for x in 0..w {
        for (y, (sum, count)) in along(&|y| rows[y * w + x], h).into_iter().enumerate() {
            out.set(x, y, if count > 0.0 { (sum / count) as f32 } else { 0.0 });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;

    fn square() -> Outline {
        Outline::new((0, 0), &Plane::full(Size::new(80, 80), 255)).unwrap()
    }

    #[test]
    fn ripples_become_relief_while_a_step_of_paint_does_not() {
        let outline = square();
        let picture = Plane::from_fn(outline.size(), |x, _| {
            let step = if x < 41 { 0.1 } else { 0.8 };
            step + 0.05 * (x as f32 * 1.4).sin()
        });
        let found =
            relief(&outline, &picture, Detail { coarse: 0.0, fine: 10.0, radius: 16.0, edge: 0.2 });
        let most = |from: usize, to: usize| {
            (from..to).map(|x| found.at(x, 40).abs()).fold(0.0f32, f32::max)
        };
        assert!(most(10, 30) > 0.2, "{}", most(10, 30));
        // The step is fourteen times as high as the ripples; in the relief it is not even three
        // times.
        assert!(most(36, 46) < 3.0 * most(10, 30), "{} beside {}", most(36, 46), most(10, 30));
    }

    #[test]
    fn an_even_picture_has_no_relief() {
        let outline = square();
        let found = relief(&outline, &Plane::full(outline.size(), 0.7), Detail::default());
        assert!(found.values().iter().all(|h| h.abs() < 1e-4));
    }
}
