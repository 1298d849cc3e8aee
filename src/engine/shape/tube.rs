//! Tubes: the union of the largest balls inside an outline, smoothed across its ridges. Floor 3. A
//! strip rises to its half width here, not to √2 of it as in `inflate`.

use super::nearest::{lower_envelope, silhouette_distance};
use super::{Outline, OutlineRim};
use crate::math::{Size, parallel};
use crate::raster::Plane;

/// A residual of 3e-3 of the right-hand side, squared.
const GOAL: f64 = 1e-5;
/// The same for a field of which only the curvature is used.
const ROUGH_GOAL: f64 = 1e-3;
/// How far ridges are smoothed, as a share of the height there: facets vanish, cross-sections stay.
const SMOOTHING: f32 = 0.26;
/// The least smoothing, px: a ball centered between pixels has its top half a pixel away.
const LEAST_SMOOTHING_PX: f32 = 0.5;
/// −∇²h of a straight limb, h = w² − x²; and of a ball, h = r² − x² − y².
const BENDS: [f32; 2] = [2.0, 4.0];

/// h, px², over the planes of an outline: the squared height of its maximal balls, smoothed, 0 at
/// the rim.
///
/// Unsmoothed it is h₀ = max_c (r²(c) − |x − c|²), r the distance to the rim. Smoothed: h − t∇²h =
/// h₀ + t b, √t about a quarter of the height. Smoothing lowers what is bent by t times its −∇²h; b
/// makes up for that: it is −∇² of the field that was smoothed with b = 2, in `[2, 4]`, so that
/// limbs and balls stay as high as they are and only ridges between balls are leveled. `joined`
/// and `start` as for `inflate`.
pub fn tube(
    outline: &Outline,
    joined: Option<&Plane<bool>>,
    start: Option<&Plane<f32>>,
) -> Plane<f32> {
    let reach = silhouette_distance(outline, joined);
    let rim = OutlineRim::of(outline, joined);
    let raw = balls(outline, &reach);
    let inside = outline.inside_pixels();
    let screen = |x: usize, y: usize| {
        let length = (SMOOTHING * raw.at(x, y).max(0.0).sqrt()).max(LEAST_SMOOTHING_PX);
        1.0 / (length * length)
    };
    let equation = rim.equation(screen);
    let smoothed = |bend: &(dyn Fn(usize, usize) -> f32 + Sync), start: &Plane<f32>, goal: f64| {
        let source = Plane::from_fn(raw.size(), |x, y| {
            if inside.at(x, y) { raw.at(x, y) * screen(x, y) + bend(x, y) } else { 0.0 }
        });
        equation.solve(&source, Some(start), goal)
    };
    let [limb, ball] = BENDS;
    let first = smoothed(&|_, _| limb, start.unwrap_or(&raw), ROUGH_GOAL);
    // What the equation leaves as −∇² of its solution.
    let bend = |x: usize, y: usize| {
        ((raw.at(x, y) - first.at(x, y)) * screen(x, y) + limb).max(limb).min(ball)
    };
    // Where the bend hardly varies, this is the solution.
    let raised = Plane::from_fn(raw.size(), |x, y| {
        if inside.at(x, y) { first.at(x, y) + (bend(x, y) - limb) / screen(x, y) } else { 0.0 }
    });
    let h = smoothed(&bend, &raised, GOAL);
    h.updated(|x, y, h| if inside.at(x, y) && h.is_finite() { h.max(0.0) } else { 0.0 })
}

/// max_c (r²(c) − |x − c|²) over the inside: rows first, then columns, each an upper envelope of
/// parabolas.
pub fn balls(outline: &Outline, reach: &Plane<f32>) -> Plane<f32> {
    let (size, inside) = (outline.size(), outline.inside_pixels());
    let (w, h) = (size.width as usize, size.height as usize);
    let ball = |x: usize, y: usize| {
        if inside.at(x, y) { -f64::from(reach.at(x, y)).powi(2) } else { f64::INFINITY }
    };
    // Along rows, then mirrored at the diagonal so that columns are rows too.
    let along = envelopes(size, ball);
    let mirrored = envelopes(Size::new(size.height, size.width), |x, y| along[x * w + y]);
    Plane::from_fn(size, |x, y| {
        let least = mirrored[x * h + y];
        if inside.at(x, y) && least.is_finite() { (-least).max(0.0) as f32 } else { 0.0 }
    })
}

/// min_v ((x − v)² + f(v, y)) for every pixel.
fn envelopes(size: Size, f: impl Fn(usize, usize) -> f64 + Sync) -> Vec<f64> {
    let w = size.width as usize;
    let mut out = crate::memory::fill_or_unwind(size.area(), f64::INFINITY);
    parallel::for_each_row(&mut out, w, 1, |y, row| {
        let line: Vec<f64> = (0..w).map(|x| f(x, y)).collect();
        lower_envelope(&line, |q, v| row[q] = (q as f64 - v as f64).powi(2) + line[v]);
    });
    out
}

/// A squared height between the pillow and the tube: (1 − t) u + t h, t in `[0, 1]`.
pub fn blend(pillow: &Plane<f32>, tube: &Plane<f32>, t: f32) -> Plane<f32> {
    Plane::from_fn(pillow.size(), |x, y| (1.0 - t) * pillow.at(x, y) + t * tube.at(x, y))
}
