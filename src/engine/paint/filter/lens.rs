//! Out of focus: each point becomes a disk, as large as its depth says. Floor 3. In linear light,
//! premultiplied, as in a camera.
//!
//! The picture is divided into layers by the size of their disks; each is blurred with its own, and
//! they are laid over each other, the farthest first. So what is sharp keeps its edge before a
//! soft background, and a soft foreground spreads over what is behind it.

mod disk;
mod layers;

use self::disk::{blurred, reach_px};
use self::layers::blur_layers;
use super::draft::{SoftKernel, detail_of_mean};
use super::sharpen::straight;
use super::window::FilterSource;
use super::{FilterKernel, FilterPlace};
use crate::math::{Rect, srgb};
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};
use std::f32::consts::PI;

/// The blur of a lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensBlur {
    /// Of the largest disk, px.
    pub radius: f32,
    /// The depth that is sharp, percent from near to far.
    pub focus: f32,
    /// How much of the depth is sharp, percent.
    pub range: f32,
    /// Disks as large as the depth says; else all are the largest.
    pub by_depth: bool,
    /// How much brighter what is bright becomes before it spreads, percent.
    pub highlights: f32,
    /// What counts as bright, levels of 255.
    pub threshold: f32,
}

impl Default for LensBlur {
    fn default() -> Self {
        Self {
            radius: 12.0,
            focus: 0.0,
            range: 10.0,
            by_depth: true,
            highlights: 0.0,
            threshold: 230.0,
        }
    }
}

impl Parameters for LensBlur {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let radius = parameter_name("radius", "Aperture", "Radius of the largest disk");
        let radius = NumberParameter::whole(radius, 0.0, 200.0, 12.0).decimals(1).px();
        v.number(radius, &mut self.radius);
        let hint = "As large as the depth of the surface says; without it all is out of focus";
        v.flag(parameter_name("by_depth", "By depth", hint), true, &mut self.by_depth);
        let percent = |name, default| NumberParameter::whole(name, 0.0, 100.0, default).decimals(1);
        let focus = parameter_name("focus", "Focus", "The depth that is sharp: 0 near, 100 far");
        v.number(percent(focus, 0.0), &mut self.focus);
        let range = parameter_name("range", "Range", "How much of the depth is sharp");
        v.number(percent(range, 10.0), &mut self.range);
        let bright =
            parameter_name("highlights", "Highlights", "How bright the disks of lights are");
        v.number(NumberParameter::whole(bright, 0.0, 1000.0, 0.0), &mut self.highlights);
        let threshold = parameter_name("threshold", "Threshold", "What counts as a light");
        v.number(NumberParameter::whole(threshold, 0.0, 255.0, 230.0), &mut self.threshold);
    }
}

impl LensBlur {
    /// The radius of a disk, px: below 0 it is nearer than the focus. `depth`: 0 near … 1 far.
    fn disk(&self, depth: f32) -> f32 {
        let (focus, range) = (self.focus / 100.0, self.range / 100.0);
        let off = depth - focus;
        let beyond = (off.abs() - 0.5 * range).max(0.0);
        let most = focus.max(1.0 - focus).max(1e-3);
        (self.radius * beyond / most).min(self.radius).copysign(off)
    }

    fn depth_of(&self, place: &FilterPlace, x: i32, y: i32) -> f32 {
        let Some(surface) = place.scene.surface.as_deref() else { return 1.0 };
        let (x, y) = (x * place.canvas_px, y * place.canvas_px);
        // Off the surface all is as far as can be.
        match surface.coverage_plane().get(x, y) {
            Some(coverage) if coverage > 0 => surface.depth_plane().at_clamped(x, y),
            _ => 1.0,
        }
    }

    fn is_by_depth(&self, place: &FilterPlace) -> bool {
        self.by_depth && place.scene.surface.is_some()
    }

    /// The radii of the disks at the pixels of a rectangle, row by row; beyond the picture its border
    /// is repeated.
    fn disks(&self, place: &FilterPlace, rect: Rect, bounds: Rect) -> Vec<f32> {
        let mut disks = Vec::with_capacity(rect.width() * rect.height());
        for y in rect.y0..rect.y1 {
            let y = y.max(bounds.y0).min(bounds.y1 - 1);
            disks.extend((rect.x0..rect.x1).map(|x| {
                let x = x.max(bounds.x0).min(bounds.x1 - 1);
                self.disk(self.depth_of(place, x, y))
            }));
        }
        disks
    }

    /// A pixel in linear light, lights brighter.
    #[inline(always)]
    fn brighten(&self, pixel: [f32; 4]) -> [f32; 4] {
        let color = straight(pixel);
        let luma = 0.3 * color[0] + 0.59 * color[1] + 0.11 * color[2];
        let dark = (self.threshold / 255.0).min(0.999);
        let t = ((luma - dark) / (1.0 - dark)).max(0.0).min(1.0);
        let share = pixel[3] * (1.0 + self.highlights / 100.0 * t * t * (3.0 - 2.0 * t));
        let decode = |v: f32| srgb::decode_fast(v.max(0.0)) * share;
        [decode(color[0]), decode(color[1]), decode(color[2]), pixel[3]]
    }
}

crate::widest! {
    fn brighten_all(lens: &LensBlur, pixels: &mut [[f32; 4]]) {
        for pixel in pixels {
            *pixel = lens.brighten(*pixel);
        }
    }

    fn encode_all(pixels: &mut [[f32; 4]]) {
        for part in pixels.chunks_mut(64) {
            let mut most = 0.0f32;
            for pixel in part.iter() {
                let [r, g, b] = straight(*pixel);
                most = most.max(r).max(g).max(b);
            }
            if most > WHITE {
                for pixel in part {
                    *pixel = encode_pixel(*pixel);
                }
            } else {
                for pixel in part {
                    let [r, g, b] = straight(*pixel);
                    let a = pixel[3];
                    *pixel = [encode_dark(r) * a, encode_dark(g) * a, encode_dark(b) * a, a];
                }
            }
        }
    }
}

/// What is no brighter is white but for rounding.
const WHITE: f32 = 1.0001;

/// What is no brighter than white, encoded.
#[inline(always)]
fn encode_dark(v: f32) -> f32 {
    srgb::encode_fast(v.max(0.0).min(1.0))
}

/// Encoded again; light beyond white stays.
#[inline(always)]
fn encode_pixel(pixel: [f32; 4]) -> [f32; 4] {
    let encode = |v: f32| if v <= WHITE { encode_dark(v) } else { srgb::encode(v) };
    let [r, g, b] = straight(pixel);
    [encode(r) * pixel[3], encode(g) * pixel[3], encode(b) * pixel[3], pixel[3]]
}

impl FilterKernel for LensBlur {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        reach_px(self.radius.max(0.0)) as f32
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let out = place.out;
        if self.radius < 0.5 {
            return source.window(out).cropped(out);
        }
        let reach = self.reach(out, out).ceil() as i32;
        let mut window = source.window(out.grown(reach));
        brighten_all(self, window.pixels_mut());
        if !self.is_by_depth(place) {
            let mut blurred = blurred(&window, out, self.radius);
            encode_all(&mut blurred);
            return blurred;
        }
        let disks = self.disks(place, window.rect(), source.bounds());
        let mut blurred = blur_layers(&window, &disks, self.radius, out);
        encode_all(&mut blurred);
        blurred
    }

    fn as_soft(&self) -> Option<&dyn SoftKernel> {
        Some(self)
    }
}

impl SoftKernel for LensBlur {
    /// Beside what is in focus too, so that its edge stays.
    fn detail_left(&self, place: &FilterPlace, bounds: Rect) -> Vec<f32> {
        let out = place.out;
        let left = |disk: f32| {
            let radius = disk * place.canvas_px as f32;
            detail_of_mean(PI * radius * radius)
        };
        if !self.is_by_depth(place) {
            return vec![left(self.radius); out.width() * out.height()];
        }
        let around = out.grown(1);
        let mut own = self.disks(place, around, bounds);
        own.iter_mut().for_each(|disk| *disk = left(*disk));
        let width = around.width();
        let mut all = Vec::with_capacity(out.width() * out.height());
        for y in 0..out.height() {
            let rows = [y, y + 1, y + 2].map(|y| &own[y * width..(y + 1) * width]);
            for x in 0..out.width() {
                let mut most = 0.0f32;
                for row in rows {
                    most = most.max(row[x]).max(row[x + 1]).max(row[x + 2]);
                }
                all.push(most);
            }
        }
        all
    }
}
