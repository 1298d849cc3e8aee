//! A color for each luminosity. Floor 3.

use super::hsl;
use super::parameters::{ParameterVisitor, Parameters, black_to_white, parameter_name};
use crate::paint::{GradientStop, ramp::Ramp};

/// The ramp's color at the luminosity of each pixel; where the ramp is transparent, the pixel as
/// it is.
#[derive(Clone, Debug, PartialEq)]
pub struct GradientMap {
    /// The gradient, by brightness.
    pub stops: Vec<GradientStop>,
    /// White takes the first color.
    pub reverse: bool,
}

impl Default for GradientMap {
    fn default() -> Self {
        Self { stops: black_to_white(), reverse: false }
    }
}

impl GradientMap {
    /// Colors of the ramp that are looked up: more than 16 bits of luminosity tell apart on it.
    const COLORS: usize = 4096;

    /// What a color becomes, encoded, `[0, 1]`.
    pub fn color(&self) -> impl Fn([f32; 3]) -> [f32; 3] + use<> {
        let ramp = Ramp::new(&self.stops);
        let at = |i: usize| {
            let t = i as f32 / (Self::COLORS - 1) as f32;
            let t = if self.reverse { 1.0 - t } else { t };
            ramp.as_ref().map_or([t, t, t, 1.0], |ramp| ramp.at(t))
        };
        let colors: Vec<[f32; 4]> = (0..Self::COLORS).map(at).collect();
        move |rgb| {
            let place = hsl::luminosity(rgb).max(0.0).min(1.0) * (Self::COLORS - 1) as f32;
            let i = (place as usize).min(Self::COLORS - 2);
            let (share, low, high) = (place - i as f32, colors[i], colors[i + 1]);
            let mapped = |c: usize| low[c] + (high[c] - low[c]) * share;
            std::array::from_fn(|c| mapped(c) + (1.0 - mapped(3)) * rgb[c])
        }
    }
}

impl Parameters for GradientMap {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.stops(
            parameter_name("stops", "Stops", "From the darkest to the brightest"),
            &mut self.stops,
        );
        let hint = "The first color is for the brightest";
        v.flag(parameter_name("reverse", "Reverse", hint), false, &mut self.reverse);
    }
}
