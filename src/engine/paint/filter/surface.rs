//! Blurs that the surface leads: over it, by the distance on it, and along its lines. Floor 3. Both
//! stop at contours. On premultiplied encoded pixels. Without a surface the canvas is one, flat.

use super::blur::{gaussian, gaussian_reach, radius};
use super::window::{FilterSource, FilterWindow};
use super::{FilterKernel, FilterPlace};
use crate::math::{Rect, Vec2, fast, vec2};
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};
use crate::surface::{Curvature, Scene, Surface, links};

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
    let steps = SurfaceSteps::of(surface, window.rect());
    // Gastal and Oliveira 2011, eq. 14: each pass of a row and a column is half as wide.
    for pass in 1..=PASSES {
        let wide = 3f32.sqrt() * ((PASSES - pass) as f32).exp2();
        let own = sigma * wide / (4f32.powi(PASSES) - 1.0).sqrt();
        steps.pass(&mut window, 2f32.sqrt() / own);
    }
    window.cropped(place.out)
}

/// So many times rows and columns are filtered: the fewest after which squares look round.
const PASSES: i32 = 3;

/// How far each pixel is on the surface from the one before it, px; infinite across a contour.
struct SurfaceSteps {
    rect: Rect,
    /// From the pixel to the left, and from the one above.
    across: Vec<f32>,
    down: Vec<f32>,
}

impl SurfaceSteps {
    fn of(surface: &Surface, rect: Rect) -> Self {
        let range = surface.depth_range_px();
        let (size, linked) = (surface.size().rect(), surface.links_plane());
        let (depth, coverage) = (surface.depth_plane(), surface.coverage_plane());
        let step = |x: i32, y: i32, (dx, dy): (i32, i32), bit: u8| {
            let (i, j) = (x - dx, y - dy);
            if !size.contains(x, y) || !size.contains(i, j) {
                return 1.0;
            }
            if coverage.at_clamped(x, y) == 0 && coverage.at_clamped(i, j) == 0 {
                return 1.0;
            }
            if linked.at_clamped(x, y) & bit == 0 {
                return f32::INFINITY;
            }
            let deeper = (depth.at_clamped(x, y) - depth.at_clamped(i, j)) * range;
            (1.0 + deeper * deeper).sqrt()
        };
        let places = || (rect.y0..rect.y1).flat_map(|y| (rect.x0..rect.x1).map(move |x| (x, y)));
        let across = places().map(|(x, y)| step(x, y, (1, 0), links::LEFT)).collect();
        let down = places().map(|(x, y)| step(x, y, (0, 1), links::UP)).collect();
        Self { rect, across, down }
    }

    /// J ← I + aᵈ (J before − I) along rows, both ways, then along columns, with a = e^−`rate`.
    fn pass(&self, window: &mut FilterWindow, rate: f32) {
        let width = self.rect.width().max(1);
        let weights = |steps: &[f32]| -> Vec<f32> {
            steps.iter().map(|d| if d.is_finite() { fast::exp(-rate * d) } else { 0.0 }).collect()
        };
        let (across, down) = (weights(&self.across), weights(&self.down));
        let rows = window.pixels_mut().chunks_exact_mut(width).zip(across.chunks_exact(width));
        rows.for_each(|(row, weights)| blend_along(row, weights));
        let height = self.rect.height();
        let pixels = window.pixels_mut();
        for y in 1..height {
            let (before, from) = pixels.split_at_mut(y * width);
            let weights = &down[y * width..(y + 1) * width];
            blend_rows(&before[(y - 1) * width..], weights, &mut from[..width]);
        }
        for y in (1..height).rev() {
            let (before, from) = pixels.split_at_mut(y * width);
            let weights = &down[y * width..(y + 1) * width];
            blend_rows(&from[..width], weights, &mut before[(y - 1) * width..]);
        }
    }
}

crate::widest! {
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

    /// From one row to the next.
    fn blend_rows(before: &[[f32; 4]], weights: &[f32], row: &mut [[f32; 4]]) {
        for ((pixel, before), weight) in row.iter_mut().zip(before).zip(weights) {
            for k in 0..4 {
                pixel[k] += weight * (before[k] - pixel[k]);
            }
        }
    }
}

/// Smeared along the lines in which the surface bends least, or across them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowBlur {
    /// Of the way, px.
    pub length: f32,
    /// How smooth the lines are: the standard deviation of a blur of the normals, px.
    pub smooth: f32,
    /// Along the lines in which it bends most.
    pub across: bool,
}

impl Default for FlowBlur {
    fn default() -> Self {
        Self { length: 24.0, smooth: 4.0, across: false }
    }
}

impl Parameters for FlowBlur {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let length = parameter_name("length", "Length", "How far paint is smeared");
        let length = NumberParameter::whole(length, 0.0, 200.0, 24.0).decimals(1).px();
        v.number(length, &mut self.length);
        let smooth =
            parameter_name("smooth", "Smoothness", "How much small bumps are left out of the flow");
        let smooth = NumberParameter::whole(smooth, 0.0, 100.0, 4.0).decimals(1).px();
        v.number(smooth, &mut self.smooth);
        let across = parameter_name("across", "Across", "Around the form and not along it");
        v.flag(across, false, &mut self.across);
    }
}

impl FilterKernel for FlowBlur {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        self.length.max(0.0) * 0.5 + 4.0
    }

    fn warm(&self, scene: &Scene) {
        let _ = scene.surface.as_deref().map(|surface| surface.curvature(self.smooth));
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let out = place.out;
        let Some(surface) = place.scene.surface.as_deref().filter(|_| self.length > 1.0) else {
            return source.window(out).cropped(out);
        };
        let curvature = surface.curvature(self.smooth);
        // Two means, of steps of one pixel and of as many as those were, read few pixels: n + L/n.
        let near = self.length.sqrt().ceil().max(1.0);
        let far_steps = (self.length / near).ceil().max(1.0);
        let around = out.grown((0.5 * self.length).ceil() as i32 + 2).intersect(source.bounds());
        let reads = around.grown((0.5 * near).ceil() as i32 + 2).intersect(source.bounds());
        let reads = reads.intersect(out.grown(self.reach(out, out).ceil() as i32));
        let window = source.window(reads.union(out));
        let lines = FlowLines::of(surface, &curvature, self.across, window.rect());
        let around = around.intersect(window.rect());
        let first = lines.means(&window, around, 1, near);
        lines.means(&first, out, near as usize, far_steps).cropped(out)
    }
}

/// The directions that paint is smeared in.
struct FlowLines<'a> {
    surface: &'a Surface,
    rect: Rect,
    /// Unit, image axes (y down), sign arbitrary; zero off the surface.
    directions: Vec<Vec2>,
}

impl<'a> FlowLines<'a> {
    fn of(surface: &'a Surface, curvature: &Curvature, across: bool, rect: Rect) -> Self {
        let (size, coverage) = (surface.size().rect(), surface.coverage_plane());
        let direction = |(x, y): (i32, i32)| {
            if !size.contains(x, y) || coverage.at_clamped(x, y) == 0 {
                return Vec2::ZERO;
            }
            let (most, least, along) = curvature.principal(x as usize, y as usize);
            // The one that is larger in size, y down.
            let bent = match most.abs() >= least.abs() {
                true => vec2(along.x, -along.y),
                false => vec2(along.y, along.x),
            };
            if across { bent } else { bent.perp() }
        };
        let places = (rect.y0..rect.y1).flat_map(|y| (rect.x0..rect.x1).map(move |x| (x, y)));
        Self { surface, rect, directions: places.map(direction).collect() }
    }

    fn at(&self, x: i32, y: i32) -> Vec2 {
        if !self.rect.contains(x, y) {
            return Vec2::ZERO;
        }
        let (column, row) = ((x - self.rect.x0) as usize, (y - self.rect.y0) as usize);
        self.directions.get(row * self.rect.width() + column).copied().unwrap_or_default()
    }

    /// Means of readings along the lines through some pixels.
    ///
    /// * `apart`: steps of a pixel from one reading to the next.
    /// * `count`: readings; the outermost count in part.
    fn means(&self, window: &FilterWindow, out: Rect, apart: usize, count: f32) -> FilterWindow {
        let half = 0.5 * (count - 1.0);
        let places = (out.y0..out.y1).flat_map(|y| (out.x0..out.x1).map(move |x| (x, y)));
        let mean = |(x, y): (i32, i32)| {
            let mut sum = window.at(x, y);
            let along = self.at(x, y);
            if along == Vec2::ZERO || half <= 0.0 {
                return sum;
            }
            let mut weight = 1.0;
            for heading in [along, -along] {
                self.trace((x, y), heading, apart, half, |share, at| {
                    let reading = window.sample(at.x, at.y);
                    (0..4).for_each(|k| sum[k] += share * reading[k]);
                    weight += share;
                });
            }
            sum.map(|v| v / weight)
        };
        FilterWindow::new(out, places.map(mean).collect())
    }

    /// Follows a line until it leaves the piece of surface.
    fn trace(
        &self,
        from: (i32, i32),
        heading: Vec2,
        apart: usize,
        half: f32,
        mut read: impl FnMut(f32, Vec2),
    ) {
        let (mut here, mut heading) = (from, heading);
        let mut at = vec2(from.0 as f32 + 0.5, from.1 as f32 + 0.5);
        let mut left = half;
        while left > 0.0 {
            for _ in 0..apart {
                at += heading;
                let next = (at.x.floor() as i32, at.y.floor() as i32);
                if !self.is_linked(here, next) {
                    return;
                }
                let along = self.at(next.0, next.1);
                here = next;
                heading = if along.dot(heading) < 0.0 { -along } else { along };
                if heading == Vec2::ZERO {
                    return;
                }
            }
            read(left.min(1.0), at);
            left -= 1.0;
        }
    }

    /// Whether two pixels that touch belong to the same piece of surface, by one way at least.
    fn is_linked(&self, from: (i32, i32), to: (i32, i32)) -> bool {
        let linked = self.surface.links_plane();
        let passes = |x: i32, y: i32, dx: i32, dy: i32| {
            let bits = linked.get(x, y).unwrap_or(0);
            let across = match dx {
                0 => true,
                1 => bits & links::RIGHT != 0,
                _ => bits & links::LEFT != 0,
            };
            across
                && match dy {
                    0 => true,
                    1 => bits & links::DOWN != 0,
                    _ => bits & links::UP != 0,
                }
        };
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        if dx == 0 || dy == 0 {
            return passes(from.0, from.1, dx.signum(), dy.signum());
        }
        let (dx, dy) = (dx.signum(), dy.signum());
        passes(from.0, from.1, dx, 0) && passes(from.0 + dx, from.1, 0, dy)
            || passes(from.0, from.1, 0, dy) && passes(from.0, from.1 + dy, dx, 0)
    }
}
