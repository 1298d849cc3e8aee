//! Filters that sharpen: by the nearest pixels, by a mask of what a blur takes away, and what it
//! takes away alone. Floor 3. On straight encoded colors, weighted by alpha; alpha stays, so that
//! nothing grows darker or lighter at transparent edges.

use super::blur::{gaussian, gaussian_reach, radius};
use super::surface::blurred_on_surface;
use super::window::{FilterSource, FilterWindow};
use super::{FilterKernel, FilterPlace};
use crate::math::Rect;
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};

/// The parameter that strengths share: percent.
pub(super) const fn amount(hint: &'static str, most: f32, default: f32) -> NumberParameter {
    NumberParameter::whole(parameter_name("amount", "Amount", hint), 0.0, most, default)
}

/// A color without its alpha; nothing is black.
#[inline(always)]
pub(super) fn straight(p: [f32; 4]) -> [f32; 3] {
    let per_a = if p[3] > 1e-6 { 1.0 / p[3] } else { 0.0 };
    [p[0] * per_a, p[1] * per_a, p[2] * per_a]
}

/// A straight color under an alpha; not below black.
#[inline(always)]
pub(super) fn color_under_alpha(color: [f32; 3], a: f32) -> [f32; 4] {
    let [r, g, b] = color;
    [r.max(0.0) * a, g.max(0.0) * a, b.max(0.0) * a, a]
}

/// Each pixel farther from those around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sharpen {
    /// Percent of the difference from the nearest pixels that is added.
    pub amount: f32,
}

impl Default for Sharpen {
    fn default() -> Self {
        Self { amount: 50.0 }
    }
}

impl Parameters for Sharpen {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.number(amount("How crisp edges become, percent", 500.0, 50.0), &mut self.amount);
    }
}

impl FilterKernel for Sharpen {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        1.0
    }

    /// x + a (x − m), m the mean with weights 1 2 1 both ways.
    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let (out, share) = (place.out, self.amount / 100.0);
        let window = source.window(out.grown(1));
        let mut all = Vec::with_capacity(out.width() * out.height());
        for y in out.y0..out.y1 {
            put_sharpened([-1, 0, 1].map(|dy| window.row(y + dy)), share, &mut all);
        }
        all
    }
}

crate::widest! {
    /// `rows`: the one above, its own and the one beneath, a pixel longer at both ends.
    fn put_sharpened(rows: [&[[f32; 4]]; 3], share: f32, out: &mut Vec<[f32; 4]>) {
        let [above, own, beneath] = rows.map(|row| row.windows(3));
        for ((a, b), c) in above.zip(own).zip(beneath) {
            let mut sum = [0.0; 4];
            for k in 0..4 {
                let row = |row: &[[f32; 4]]| row[0][k] + 2.0 * row[1][k] + row[2][k];
                sum[k] = row(a) + 2.0 * row(b) + row(c);
            }
            out.push(sharpen(b[1], sum, share, 0.0));
        }
    }

    /// Sharpens each pixel against its mean.
    fn sharpen_all(pixels: &mut [[f32; 4]], means: &[[f32; 4]], share: f32, threshold: f32) {
        for (pixel, mean) in pixels.iter_mut().zip(means) {
            *pixel = sharpen(*pixel, *mean, share, threshold);
        }
    }
}

/// x + a (x − m) where these differ by a threshold. `mean` may have any weight.
#[inline(always)]
fn sharpen(pixel: [f32; 4], mean: [f32; 4], share: f32, threshold: f32) -> [f32; 4] {
    let (own, mean) = (straight(pixel), straight(mean));
    let mut color = own;
    for k in 0..3 {
        let more = own[k] - mean[k];
        color[k] += if more.abs() < threshold { 0.0 } else { share * more };
    }
    color_under_alpha(color, pixel[3])
}

/// Sharpening by what a Gaussian blur takes away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnsharpMask {
    /// Percent of what the blur takes away that is added.
    pub amount: f32,
    /// Standard deviation of the blur, px.
    pub radius: f32,
    /// Differences below so many levels of 255 stay.
    pub threshold: f32,
    /// The blur goes over the surface and stops at its contours, which get no rims.
    pub stop_at_contours: bool,
}

impl Default for UnsharpMask {
    fn default() -> Self {
        Self { amount: 100.0, radius: 2.0, threshold: 0.0, stop_at_contours: false }
    }
}

impl Parameters for UnsharpMask {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.number(amount("How crisp edges become, percent", 500.0, 100.0), &mut self.amount);
        v.number(radius("How wide the edges are that become crisp", 250.0, 2.0), &mut self.radius);
        let hint = "Smaller differences, such as noise, stay: levels of 255";
        let threshold = parameter_name("threshold", "Threshold", hint);
        v.number(NumberParameter::whole(threshold, 0.0, 255.0, 0.0), &mut self.threshold);
        let hint = "Contours of the surface get no light or dark rims";
        let stop = parameter_name("stop_at_contours", "Stop at contours", hint);
        v.flag(stop, false, &mut self.stop_at_contours);
    }
}

impl FilterKernel for UnsharpMask {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        gaussian_reach(self.radius)
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let mut pixels = source.window(place.out).cropped(place.out);
        let means = match self.stop_at_contours && place.scene.surface.is_some() {
            true => blurred_on_surface(place, source, self.radius),
            false => gaussian(source, place.out, self.radius),
        };
        sharpen_all(&mut pixels, &means, self.amount / 100.0, self.threshold / 255.0);
        pixels
    }
}

/// What a Gaussian blur takes away, around mid gray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HighPass {
    /// Standard deviation of the blur, px.
    pub radius: f32,
}

impl Default for HighPass {
    fn default() -> Self {
        Self { radius: 10.0 }
    }
}

impl Parameters for HighPass {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.number(radius("How wide the details are that stay", 250.0, 10.0), &mut self.radius);
    }
}

impl FilterKernel for HighPass {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        gaussian_reach(self.radius)
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let (own, blurred) = read_and_blur(place, source, self.radius);
        let passed = |(own, mean): ([f32; 4], [f32; 4])| {
            let (color, mean) = (straight(own), straight(mean));
            color_under_alpha(std::array::from_fn(|k| (0.5 + color[k] - mean[k]).min(1.0)), own[3])
        };
        own.into_iter().zip(blurred).map(passed).collect()
    }
}

/// The pixels themselves, and blurred.
pub(super) fn read_and_blur(
    place: &FilterPlace,
    source: &dyn FilterSource,
    radius: f32,
) -> (Vec<[f32; 4]>, Vec<[f32; 4]>) {
    let own: FilterWindow = source.window(place.out);
    (own.cropped(place.out), gaussian(source, place.out, radius))
}
