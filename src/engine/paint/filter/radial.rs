//! Blurs around a point: along circles, and toward it. Floor 3. On premultiplied encoded pixels.
//!
//! A part of the picture is read on circles and rays around the point, at most a pixel apart; the
//! means along them are running sums, and a pixel is read between two of them. Means of many readings
//! hardly differ from one to the next, so only some of them are kept. Circles and rays lie where they
//! would for the whole picture.
//!
//! | file | |
//! |---|---|
//! | `spin`, `zoom` | the filters |
//! | `polar` | a part of a picture in distances and angles, and pixels between lines |

mod polar;
mod spin;
mod zoom;

pub use spin::SpinBlur;
pub use zoom::ZoomBlur;

use super::draft::{SoftKernel, detail_of_mean};
use super::window::{FilterSource, FilterWindow};
use super::{FilterKernel, FilterPlace};
use crate::math::{Rect, Vec2, vec2};
use crate::paint::adjustment::parameters::{NumberParameter, ParameterVisitor, parameter_name};

/// A point of a picture, percent of its width and height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlurCenter {
    /// From the left.
    pub x: f32,
    /// From the top.
    pub y: f32,
}

impl Default for BlurCenter {
    fn default() -> Self {
        Self { x: 50.0, y: 50.0 }
    }
}

impl BlurCenter {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let number = |name| NumberParameter::whole(name, -100.0, 200.0, 50.0).decimals(1);
        let x = parameter_name("x", "Center across", "Percent of the width, from the left");
        v.number(number(x), &mut self.x);
        let y = parameter_name("y", "Center down", "Percent of the height, from the top");
        v.number(number(y), &mut self.y);
    }

    /// In px.
    fn at(&self, bounds: Rect) -> Vec2 {
        let share = vec2(self.x, self.y) / 100.0;
        let size = vec2(bounds.width() as f32, bounds.height() as f32);
        vec2(bounds.x0 as f32, bounds.y0 as f32) + share * size
    }
}

/// How far apart the means of so many readings are kept: a sixteenth of them changes little.
fn step_between(readings: f32) -> usize {
    (readings / 16.0).max(1.0).min(1e4) as usize
}

/// How many are kept of so many means, two at least; the last one is no farther in than these.
fn count_kept(means: i32, apart: usize) -> usize {
    (means.max(1) as usize - 1).div_ceil(apart).max(1) + 1
}

/// How far a rectangle reaches from a point, px.
fn farthest(rect: Rect, from: Vec2) -> f32 {
    let across = (rect.x0 as f32 - from.x).abs().max((rect.x1 as f32 - from.x).abs());
    across.hypot((rect.y0 as f32 - from.y).abs().max((rect.y1 as f32 - from.y).abs()))
}

/// How much detail the means at each pixel of a place leave, by its distance from the center.
///
/// * `length`: of the way of a mean, by that distance.
fn detail_by_distance(place: &FilterPlace, center: Vec2, length: f32) -> Vec<f32> {
    let (out, length) = (place.out, length * place.canvas_px as f32);
    let mut all = vec![0.0; out.width() * out.height()];
    for (y, row) in (out.y0..out.y1).zip(all.chunks_exact_mut(out.width().max(1))) {
        let down = y as f32 + 0.5 - center.y;
        for (x, left) in (out.x0..out.x1).zip(row) {
            let across = x as f32 + 0.5 - center.x;
            *left = detail_of_mean(length * (across * across + down * down).sqrt());
        }
    }
    all
}

/// What a kernel reads of a picture.
fn window_around(
    kernel: &dyn FilterKernel,
    place: &FilterPlace,
    source: &dyn FilterSource,
) -> FilterWindow {
    let reach = kernel.reach(place.out, source.bounds()).ceil() as i32;
    let reads = place.out.grown(reach).intersect(source.bounds().grown(1));
    source.window(if reads.is_empty() { place.out } else { reads })
}
