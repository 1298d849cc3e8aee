//! Noise and grain. Floor 3. A pure function of the place in the document and a seed: the same on
//! every machine and run. On straight encoded colors; alpha stays.

use super::sharpen::{amount, color_under_alpha, straight};
use super::window::FilterSource;
use super::{FilterKernel, FilterPlace};
use crate::math::noise::{self, GradientRows};
use crate::math::{Rect, Vec2, hash};
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterName, ParameterVisitor, Parameters, parameter_name,
};
use crate::surface::operator::UnwrapSettings;
use crate::surface::{Scene, unwrap::Unwrapping};
use std::ops::Range;
use std::sync::Arc;

const SEED: NumberParameter = NumberParameter::whole(
    parameter_name("seed", "Seed", "Other seeds give other noise"),
    0.0,
    9999.0,
    0.0,
);
const MONOCHROME: ParameterName =
    parameter_name("monochrome", "Monochrome", "The same for red, green and blue");

/// Random steps of each pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelNoise {
    /// The largest step of even noise, or the standard deviation of a Gaussian, percent.
    pub amount: f32,
    /// The side of what has one value, px.
    pub size: f32,
    /// Small steps are more likely than large ones.
    pub gaussian: bool,
    /// Red, green and blue step together.
    pub monochrome: bool,
    /// Other seeds give other noise.
    pub seed: f32,
}

impl Default for PixelNoise {
    fn default() -> Self {
        Self { amount: 10.0, size: 1.0, gaussian: false, monochrome: false, seed: 0.0 }
    }
}

impl Parameters for PixelNoise {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.number(amount("How large the steps are, percent", 100.0, 10.0), &mut self.amount);
        let size = parameter_name("size", "Size", "The side of what has one value");
        v.number(NumberParameter::whole(size, 1.0, 64.0, 1.0).decimals(1).px(), &mut self.size);
        let gaussian =
            parameter_name("gaussian", "Gaussian", "Small steps are more likely than large ones");
        v.flag(gaussian, false, &mut self.gaussian);
        v.flag(MONOCHROME, false, &mut self.monochrome);
        v.number(SEED, &mut self.seed);
    }
}

impl PixelNoise {
    /// A step, of mean 0: even in `[−1, 1]`, or a Gaussian of standard deviation 1.
    #[inline(always)]
    fn step(&self, channel: u32, i: i32, j: i32) -> f32 {
        let seed = hash::mix(self.seed as u32 ^ hash::mix(channel));
        let even = |seed: u32| hash::unit(seed, i as u32, j as u32);
        if !self.gaussian {
            return 2.0 * even(seed) - 1.0;
        }
        // Box and Muller 1958.
        let (u, v) = (even(seed), even(hash::mix(seed)));
        (-2.0 * (1.0 - u).ln()).max(0.0).sqrt() * (std::f32::consts::TAU * v).cos()
    }
}

impl FilterKernel for PixelNoise {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        0.0
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let window = source.window(place.out);
        let (share, size) = (self.amount / 100.0, self.size.max(0.01));
        let cell = |v: i32| (v as f32 / size).floor() as i32;
        let columns: Vec<i32> = (place.out.x0..place.out.x1).map(cell).collect();
        let mut all = Vec::with_capacity(window.pixels().len());
        for y in place.out.y0..place.out.y1 {
            let row = cell(y);
            all.extend(window.row(y).iter().zip(&columns).map(|(pixel, column)| {
                let steps = match self.monochrome {
                    true => [self.step(0, *column, row); 3],
                    false => [0, 1, 2].map(|channel| self.step(channel, *column, row)),
                };
                shift_color(*pixel, steps.map(|step| share * step))
            }));
        }
        all
    }
}

/// A pixel whose straight color is moved, within black and white.
#[inline(always)]
fn shift_color(pixel: [f32; 4], by: [f32; 3]) -> [f32; 4] {
    let color = straight(pixel);
    let mut shifted = color;
    for k in 0..3 {
        // Light beyond white stays beyond it.
        shifted[k] = (color[k] + by[k]).min(color[k].max(1.0));
    }
    color_under_alpha(shifted, pixel[3])
}

/// The grain of film or paper: soft, strongest in mid-tones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmGrain {
    /// Percent.
    pub amount: f32,
    /// Of the grains, px.
    pub size: f32,
    /// Share of finer grains: 0 soft, 100 rough.
    pub roughness: f32,
    /// Red, green and blue are grained together.
    pub monochrome: bool,
    /// It lies on the shape, as if that were grained, and not on the canvas.
    pub on_surface: bool,
    /// Other seeds give other grain.
    pub seed: f32,
}

impl Default for FilmGrain {
    fn default() -> Self {
        Self {
            amount: 25.0,
            size: 4.0,
            roughness: 50.0,
            monochrome: true,
            on_surface: false,
            seed: 0.0,
        }
    }
}

impl Parameters for FilmGrain {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.number(amount("How much lighter and darker, percent", 100.0, 25.0), &mut self.amount);
        let size = parameter_name("size", "Size", "Of the grains");
        v.number(NumberParameter::whole(size, 1.0, 500.0, 4.0).decimals(1).px(), &mut self.size);
        let rough = parameter_name("roughness", "Roughness", "How much finer grains show, percent");
        v.number(NumberParameter::whole(rough, 0.0, 100.0, 50.0), &mut self.roughness);
        v.flag(MONOCHROME, true, &mut self.monochrome);
        let hint = "The grain lies on the shape and is bent and foreshortened with it";
        v.flag(parameter_name("on_surface", "On the surface", hint), false, &mut self.on_surface);
        v.number(SEED, &mut self.seed);
    }
}

/// Octaves of the grain: each half as large as the one before.
const OCTAVES: u32 = 3;
/// Cells after which the noise repeats.
const PERIOD: u32 = 1 << 15;

impl FilmGrain {
    /// Of mean 0, around `[−1, 1]`.
    fn grain(&self, channel: u32, at: Vec2) -> f32 {
        let (mut sum, mut cell) = (0.0, at / self.size.max(0.01));
        for (seed, share) in self.octaves(channel) {
            sum += share * noise::gradient(cell, PERIOD, seed);
            cell *= 2.0;
        }
        sum * self.gain()
    }

    /// The octaves of a channel along rows of the canvas, each with its share.
    fn rows(&self, channel: u32, x: Range<i32>) -> Vec<(GradientRows, f32)> {
        let size = self.size.max(0.01);
        let mut across: Vec<f32> = x.map(|x| (x as f32 + 0.5) / size).collect();
        let mut rows = Vec::new();
        for (seed, share) in self.octaves(channel) {
            rows.push((GradientRows::new(&across, PERIOD, seed), share));
            across.iter_mut().for_each(|v| *v *= 2.0);
        }
        rows
    }

    /// The same as [`Self::grain`] along a row.
    fn grain_along(&self, rows: &mut [(GradientRows, f32)], y: i32, grain: &mut [f32]) {
        let mut down = (y as f32 + 0.5) / self.size.max(0.01);
        grain.fill(0.0);
        for (rows, share) in rows {
            rows.add(down, *share, grain);
            down *= 2.0;
        }
        let gain = self.gain();
        grain.iter_mut().for_each(|v| *v *= gain);
    }

    /// The seed and the share of each octave, the coarsest first.
    fn octaves(&self, channel: u32) -> impl Iterator<Item = (u32, f32)> {
        let seed = hash::mix(self.seed as u32 ^ hash::mix(channel ^ 0x6772_6169));
        let rough = self.roughness / 100.0;
        (0..OCTAVES).map(move |octave| (hash::mix(seed ^ octave), rough.powi(octave as i32)))
    }

    /// The standard deviation of gradient noise is about 0.35.
    fn gain(&self) -> f32 {
        let rough = self.roughness / 100.0;
        1.4 / (1.0 + rough * rough).sqrt()
    }

    fn unwrapping(&self, scene: &Scene) -> Option<Arc<Unwrapping>> {
        let surface = scene.surface.as_ref().filter(|_| self.on_surface)?;
        Some(surface.unwrapping(UnwrapSettings { amount: 1.0, smooth_px: 0.0 }))
    }
}

impl FilterKernel for FilmGrain {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        0.0
    }

    fn warm(&self, scene: &Scene) {
        let _ = self.unwrapping(scene);
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let window = source.window(place.out);
        let (out, unwrapped) = (place.out, self.unwrapping(place.scene));
        let channels = if self.monochrome { 0..1 } else { 0..3 };
        let mut rows: Vec<_> = channels.map(|channel| self.rows(channel, out.x0..out.x1)).collect();
        let mut grain = vec![vec![0.0; out.width()]; rows.len()];
        let mut all = window.cropped(out);
        for (y, pixels) in (out.y0..out.y1).zip(all.chunks_exact_mut(out.width().max(1))) {
            for (channel, (rows, grain)) in (0..).zip(rows.iter_mut().zip(&mut grain)) {
                self.grain_along(rows, y, grain);
                let Some(unwrapped) = &unwrapped else { continue };
                for (x, grain) in (out.x0..out.x1).zip(grain) {
                    let Some((column, row)) = place.on_surface(x, y) else { continue };
                    *grain = self.grain(channel, unwrapped.at(column, row));
                }
            }
            let of = |channel: usize| grain[channel.min(grain.len() - 1)].as_slice();
            shift_by_grain(pixels, [of(0), of(1), of(2)], self.amount / 100.0);
        }
        all
    }
}

crate::widest! {
    /// Half as strong in black and white as in mid-gray.
    fn shift_by_grain(pixels: &mut [[f32; 4]], grain: [&[f32]; 3], share: f32) {
        for (i, pixel) in pixels.iter_mut().enumerate() {
            let [r, g, b] = straight(*pixel);
            let luma = (0.3 * r + 0.59 * g + 0.11 * b).max(0.0).min(1.0);
            let strength = share * (0.5 + 2.0 * luma * (1.0 - luma));
            let by = [grain[0][i] * strength, grain[1][i] * strength, grain[2][i] * strength];
            *pixel = shift_color(*pixel, by);
        }
    }
}
