//! A blur over the surface, by the distance on it, which stops at contours. Floor 3. On premultiplied
//! encoded pixels. Without a surface the canvas is one, flat. Not here: along its lines (`flow`).

use super::blur::{gaussian, gaussian_reach, radius};
use super::window::{FilterSource, FilterWindow};
use super::{FilterKernel, FilterPlace};
use crate::math::{Rect, fast};
use crate::paint::adjustment::parameters::{ParameterVisitor, Parameters};
use crate::surface::{Surface, links};
use std::ops::Range;

/// Soft by the distance on the surface: what is seen steeply is blurred less, as if the paint itself
/// were soft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceBlur {
    /// Standard deviation, px on the surface.
    pub radius: f32,
}

impl Default for SurfaceBlur {
    fn default() -> Self {
        Self { radius: 8.0 }
    }
}

impl Parameters for SurfaceBlur {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.number(radius("Standard deviation, on the surface", 250.0, 8.0), &mut self.radius);
    }
}

impl FilterKernel for SurfaceBlur {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        gaussian_reach(self.radius)
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        blurred_on_surface(place, source, self.radius)
    }
}

/// Blurred over the surface that a place sees, else by a Gaussian.
pub(super) fn blurred_on_surface(
    place: &FilterPlace,
    source: &dyn FilterSource,
    sigma: f32,
) -> Vec<[f32; 4]> {
    let Some(surface) = place.scene.surface.as_deref().filter(|_| sigma > 0.0) else {
        return gaussian(source, place.out, sigma);
    };
    let reads = place.out.grown(gaussian_reach(sigma).ceil() as i32).intersect(source.bounds());
    let mut window = source.window(reads.union(place.out));
    // Gastal and Oliveira 2011, eq. 14: each pass of rows and columns is half as wide as the one
    // before, so that its weights are the squares of those.
    let widest = sigma * 3f32.sqrt() * ((PASSES - 1) as f32).exp2();
    let rate = 2f32.sqrt() * (4f32.powi(PASSES) - 1.0).sqrt() / widest;
    let mut weights = StepWeights::of(surface, window.rect(), rate);
    for pass in 1..=PASSES {
        weights.blend(&mut window);
        if pass < PASSES {
            weights.square();
        }
    }
    window.cropped(place.out)
}

/// So many times rows and columns are filtered: the fewest after which squares look round.
const PASSES: i32 = 3;

/// How much of the pixel before it each pixel takes: aᵈ, with d how far it is on the surface, px;
/// nothing across a contour.
struct StepWeights {
    rect: Rect,
    /// From the pixel to the left, and from the one above.
    across: Vec<f32>,
    down: Vec<f32>,
}

impl StepWeights {
    /// a = e^−`rate`.
    fn of(surface: &Surface, rect: Rect, rate: f32) -> Self {
        let known = rect.intersect(surface.size().rect());
        let (plain, width) = (fast::exp(-rate), rect.width());
        // Off the surface's canvas all is flat.
        let [mut across, mut down] = [0, 1].map(|_| vec![plain; width * rect.height()]);
        let step = SurfaceStep { range: surface.depth_range_px(), rate, plain };
        let row = |y: i32, columns: Range<usize>| StepRow {
            depth: &surface.depth_plane().row(y as usize)[columns.clone()],
            coverage: &surface.coverage_plane().row(y as usize)[columns.clone()],
            links: &surface.links_plane().row(y as usize)[columns],
        };
        for y in known.y0..known.y1 {
            let first = (y - rect.y0) as usize * width + (known.x0 - rect.x0) as usize;
            let columns = known.x0 as usize..known.x1 as usize;
            if y > 0 {
                let rows = [row(y - 1, columns.clone()), row(y, columns.clone())];
                put_weights(rows, links::UP, step, &mut down[first..first + columns.len()]);
            }
            // The first column of the canvas has none to its left.
            let beside = columns.start.max(1)..columns.end.max(1);
            let first = first + beside.start - columns.start;
            let rows = [row(y, beside.start - 1..beside.end - 1), row(y, beside.clone())];
            put_weights(rows, links::LEFT, step, &mut across[first..first + beside.len()]);
        }
        Self { rect, across, down }
    }

    /// Those of a blur half as wide.
    fn square(&mut self) {
        self.across.iter_mut().chain(&mut self.down).for_each(|weight| *weight *= *weight);
    }

    /// J ← I + aᵈ (J before − I) along rows, both ways, then along columns.
    fn blend(&self, window: &mut FilterWindow) {
        let width = self.rect.width().max(1);
        let rows = window.pixels_mut().chunks_mut(SIDE_BY_SIDE * width);
        for (rows, weights) in rows.zip(self.across.chunks(SIDE_BY_SIDE * width)) {
            match rows.len() == SIDE_BY_SIDE * width {
                true => blend_rows_along(rows, weights, width),
                false => {
                    let rows = rows.chunks_exact_mut(width).zip(weights.chunks_exact(width));
                    rows.for_each(|(row, weights)| blend_along(row, weights));
                }
            }
        }
        let height = self.rect.height();
        let pixels = window.pixels_mut();
        for y in 1..height {
            let (before, from) = pixels.split_at_mut(y * width);
            let weights = &self.down[y * width..(y + 1) * width];
            blend_rows(&before[(y - 1) * width..], weights, &mut from[..width]);
        }
        for y in (1..height).rev() {
            let (before, from) = pixels.split_at_mut(y * width);
            let weights = &self.down[y * width..(y + 1) * width];
            blend_rows(&from[..width], weights, &mut before[(y - 1) * width..]);
        }
    }
}

/// How a step on the surface is weighed.
#[derive(Clone, Copy)]
struct SurfaceStep {
    /// Of the depth, px.
    range: f32,
    rate: f32,
    /// The weight of a step on flat ground.
    plain: f32,
}

/// Part of a row of a surface.
struct StepRow<'a> {
    depth: &'a [f32],
    coverage: &'a [u8],
    links: &'a [u8],
}

/// Rows that are blended at once: each pixel waits for the one before it, and other rows do not.
const SIDE_BY_SIDE: usize = 4;

crate::widest! {
    /// The weights of steps from one row of pixels to another, which has the bit `link`.
    fn put_weights(rows: [StepRow; 2], link: u8, step: SurfaceStep, weights: &mut [f32]) {
        let [from, to] = rows;
        let depths = from.depth.iter().zip(to.depth);
        let covered = from.coverage.iter().zip(to.coverage);
        let places = depths.zip(covered).zip(to.links);
        for (weight, ((depths, covered), links)) in weights.iter_mut().zip(places) {
            let deeper = (depths.1 - depths.0) * step.range;
            let on_surface = fast::exp(-step.rate * (1.0 + deeper * deeper).sqrt());
            let linked = if links & link == 0 { 0.0 } else { on_surface };
            *weight = if covered.0 | covered.1 == 0 { step.plain } else { linked };
        }
    }

    /// Along a row, both ways.
    fn blend_along(row: &mut [[f32; 4]], weights: &[f32]) {
        for x in 1..row.len() {
            let (before, weight) = (row[x - 1], weights[x]);
            for k in 0..4 {
                row[x][k] += weight * (before[k] - row[x][k]);
            }
        }
        for x in (1..row.len()).rev() {
            let (behind, weight) = (row[x], weights[x]);
            for k in 0..4 {
                row[x - 1][k] += weight * (behind[k] - row[x - 1][k]);
            }
        }
    }

    /// The same for several rows.
    fn blend_rows_along(rows: &mut [[f32; 4]], weights: &[f32], width: usize) {
        let (rows, weights) = (&mut rows[..SIDE_BY_SIDE * width], &weights[..SIDE_BY_SIDE * width]);
        let mut before = [[0.0; 4]; SIDE_BY_SIDE];
        for (j, before) in before.iter_mut().enumerate() {
            *before = rows[j * width];
        }
        for x in 1..width {
            for (j, before) in before.iter_mut().enumerate() {
                let (pixel, weight) = (&mut rows[j * width + x], weights[j * width + x]);
                for k in 0..4 {
                    pixel[k] += weight * (before[k] - pixel[k]);
                }
                *before = *pixel;
            }
        }
        for x in (1..width).rev() {
            for (j, behind) in before.iter_mut().enumerate() {
                let (pixel, weight) = (&mut rows[j * width + x - 1], weights[j * width + x]);
                for k in 0..4 {
                    pixel[k] += weight * (behind[k] - pixel[k]);
                }
                *behind = *pixel;
            }
        }
    }

    /// From one row to the next.
    fn blend_rows(before: &[[f32; 4]], weights: &[f32], row: &mut [[f32; 4]]) {
        for ((pixel, before), weight) in row.iter_mut().zip(before).zip(weights) {
            for k in 0..4 {
                pixel[k] += weight * (before[k] - pixel[k]);
            }
        }
    }
}
