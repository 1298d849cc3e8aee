//! The blur brush: the Gaussian mean of pixels, excluding what the stroke may not touch. Floor 3.
//! The filter is in `raster::blur`; its cost does not grow with its width.

use super::TileDab;
use super::pixels::RetouchPixels;
use crate::math::{Rect, Size};
use crate::paint::dab_walker::Dab;
use crate::paint::scene::Scene;
use crate::raster::blur;
use crate::surface::objects::CanvasPart;

/// The widest Gaussian of one dab, px.
const WIDEST_PX: f32 = 40.0;
/// Beyond this many standard deviations a Gaussian is negligible.
const CUT: f32 = 3.0;

/// If less than this of a Gaussian's weight may count, its own error would be divided: such pixels
/// do not change.
const LEAST_WEIGHT: f32 = 1e-3;

/// The blurred colors of the pixels of a touched area, row by row.
///
/// * `width`: the standard deviation that a stroke leaves in its middle, a ratio of the dab's
///   radius. The variances of the dabs over a pixel add up, 2 r / step of them: so each has the
///   variance (width · r)² · step / 2 r, however close they are.
pub(super) fn blurred(
    touch: &TileDab,
    dab: &Dab,
    before: Option<&Dab>,
    width: f32,
    part: &CanvasPart,
    retouched: &RetouchPixels,
    scene: &Scene,
) -> Vec<[f32; 4]> {
    // A single dab counts as one of a stroke with a spacing of a tenth of the diameter.
    let step =
        before.map_or(0.2 * dab.radius, |before| dab.at.distance(before.at).min(2.0 * dab.radius));
    let variance = (width.max(0.0).min(10.0) * dab.radius).powi(2) * step / (2.0 * dab.radius);
    let variance = variance.max(0.0).min(WIDEST_PX * WIDEST_PX);
    let area = touch.area;
    let seen = area.grown((CUT * variance.sqrt()).ceil() as i32 + 1);
    let before = weigh_pixels(seen, part, retouched, scene.size.rect());
    let after = blur::spread_pixels(
        Size::new(seen.width() as u32, seen.height() as u32),
        &before,
        variance,
    );
    let width = area.width();
    let mut out = Vec::with_capacity(width * area.height());
    for y in area.y0..area.y1 {
        let start = (y - seen.y0) as usize * seen.width() + (area.x0 - seen.x0) as usize;
        let row = before.iter().zip(&after).skip(start).take(width);
        out.extend(
            row.map(|(before, after)| mean(if after[4] > LEAST_WEIGHT { after } else { before })),
        );
    }
    out
}

/// The weighted mean color, premultiplied.
fn mean([r, g, b, a, weight]: &WeightedPixel) -> [f32; 4] {
    let per = if *weight > 0.0 { 1.0 / weight } else { 0.0 };
    // The filter for wide Gaussians can undershoot 0 by its error.
    let a = (a * per).max(0.0).min(1.0);
    let [r, g, b] = [r, g, b].map(|c| (c * per).max(0.0).min(a));
    [r, g, b, a]
}

/// A premultiplied pixel times its weight, and the weight.
type WeightedPixel = [f32; 5];

/// The pixels of a rectangle; those beyond the canvas count nothing.
fn weigh_pixels(
    rect: Rect,
    part: &CanvasPart,
    retouched: &RetouchPixels,
    canvas: Rect,
) -> Vec<WeightedPixel> {
    let mut reader = retouched.reader();
    let mut all = vec![[0.0; 5]; rect.width() * rect.height()];
    let inside = rect.intersect(canvas);
    for y in inside.y0..inside.y1 {
        let start = (y - rect.y0) as usize * rect.width() + (inside.x0 - rect.x0) as usize;
        for (x, to) in (inside.x0..inside.x1).zip(&mut all[start..]) {
            let weight = if part.is_whole() { 1.0 } else { part.coverage(x, y) };
            let [r, g, b, a] = reader.pixel(x, y).map(|c| c * weight);
            *to = [r, g, b, a, weight];
        }
    }
    all
}
