//! Glow: what is bright shines beyond its edge. Floor 3. On premultiplied encoded pixels.

use super::blur::{gaussian, gaussian_reach, radius};
use super::sharpen::{amount, straight};
use super::window::{FilterSource, FilterWindow};
use super::{FilterKernel, FilterPlace};
use crate::math::Rect;
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};

/// What is bright, blurred, and laid over the picture as light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrightGlow {
    /// Percent of the light.
    pub amount: f32,
    /// Standard deviation of the blur, px.
    pub radius: f32,
    /// What is darker does not glow: levels of 255.
    pub threshold: f32,
}

impl Default for BrightGlow {
    fn default() -> Self {
        Self { amount: 60.0, radius: 12.0, threshold: 128.0 }
    }
}

impl Parameters for BrightGlow {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.number(amount("How strong the light is, percent", 200.0, 60.0), &mut self.amount);
        v.number(radius("How far it shines", 250.0, 12.0), &mut self.radius);
        let threshold = parameter_name("threshold", "Threshold", "What is darker does not glow");
        v.number(NumberParameter::whole(threshold, 0.0, 255.0, 128.0), &mut self.threshold);
    }
}

impl BrightGlow {
    /// What of a pixel glows: from the threshold on, all of it at white.
    fn glow_of(&self, pixel: [f32; 4]) -> [f32; 4] {
        let [r, g, b] = straight(pixel);
        let luma = 0.3 * r + 0.59 * g + 0.11 * b;
        let dark = (self.threshold / 255.0).min(0.999);
        let share = ((luma - dark) / (1.0 - dark)).max(0.0).min(1.0) * self.amount / 100.0;
        pixel.map(|v| v * share)
    }
}

/// A picture of what glows.
struct LitSource<'a> {
    glow: &'a BrightGlow,
    source: &'a dyn FilterSource,
}

impl FilterSource for LitSource<'_> {
    fn bounds(&self) -> Rect {
        self.source.bounds()
    }

    fn window(&self, rect: Rect) -> FilterWindow {
        let mut window = self.source.window(rect);
        window.pixels_mut().iter_mut().for_each(|pixel| *pixel = self.glow.glow_of(*pixel));
        window
    }
}

impl FilterKernel for BrightGlow {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        gaussian_reach(self.radius)
    }

    /// Screen: x + g − x g, alpha too.
    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let own = source.window(place.out).cropped(place.out);
        let light = gaussian(&LitSource { glow: self, source }, place.out, self.radius);
        let screened = |(own, light): ([f32; 4], [f32; 4])| {
            std::array::from_fn(|k| own[k] + light[k] - own[k] * light[k].min(1.0))
        };
        own.into_iter().zip(light).map(screened).collect()
    }
}
