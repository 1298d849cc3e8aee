//! Adjustments that weigh channels against each other: color balance, vibrance, photo filter,
//! channel mixer, black and white, selective color, threshold. Floor 3.

use super::hsl;
use super::parameters::{
    NumberParameter, ParameterName, ParameterVisitor, Parameters, parameter_name,
};
use super::tones::CHANNELS;
use crate::math::srgb::Color;

/// What is added to red, green and blue of shadows, mid-tones and highlights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorBalance {
    /// For each range of tones, red, green and blue, `[−100, 100]`.
    pub ranges: [[f32; 3]; 3],
    /// The lightness stays.
    pub keep_luminosity: bool,
}

impl Default for ColorBalance {
    fn default() -> Self {
        Self { ranges: [[0.0; 3]; 3], keep_luminosity: true }
    }
}

impl ColorBalance {
    /// How much of a lightness is in shadows, mid-tones and highlights: the definition of GIMP.
    #[inline(always)]
    pub fn weights(lightness: f32) -> [f32; 3] {
        const SLOPE: f32 = 4.0;
        const EDGE: f32 = 0.333;
        const SCALE: f32 = 0.7;
        let ramp = |v: f32| (v * SLOPE + 0.5).max(0.0).min(1.0);
        let shadows = ramp(EDGE - lightness);
        let middle = ramp(lightness - EDGE) * ramp(1.0 - EDGE - lightness);
        let lights = ramp(lightness + EDGE - 1.0);
        [shadows, middle, lights].map(|weight| weight * SCALE)
    }

    /// What a color becomes, encoded, `[0, 1]`.
    #[inline(always)]
    pub fn color(&self, rgb: [f32; 3]) -> [f32; 3] {
        let (low, high) = hsl::extent(rgb);
        let lightness = 0.5 * (low + high);
        let weights = Self::weights(lightness);
        let mut out = rgb;
        for (c, out) in out.iter_mut().enumerate() {
            for (range, weight) in self.ranges.iter().zip(weights) {
                *out += weight * range[c] / 100.0;
            }
            *out = out.max(0.0).min(1.0);
        }
        if self.keep_luminosity {
            let [hue, saturation, _] = hsl::of_rgb(out);
            out = hsl::to_rgb([hue, saturation, lightness]);
        }
        out
    }
}

impl Parameters for ColorBalance {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        const RANGES: [ParameterName; 3] = [
            parameter_name("shadows", "Shadows", ""),
            parameter_name("midtones", "Mid-tones", ""),
            parameter_name("highlights", "Highlights", ""),
        ];
        const AXES: [ParameterName; 3] = [
            parameter_name("red", "Red", "Below 0 cyan"),
            parameter_name("green", "Green", "Below 0 magenta"),
            parameter_name("blue", "Blue", "Below 0 yellow"),
        ];
        // Most is done to mid-tones, so these are offered first.
        for i in [1, 0, 2] {
            let range = &mut self.ranges[i];
            v.group(RANGES[i], &mut |v| {
                for (name, value) in AXES.into_iter().zip(range.iter_mut()) {
                    v.number(NumberParameter::around(name, 100.0), value);
                }
            });
        }
        let name = parameter_name("keep_luminosity", "Preserve luminosity", "The lightness stays");
        v.flag(name, true, &mut self.keep_luminosity);
    }
}

/// Saturation, more of it for colors that have little.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vibrance {
    /// `[−100, 100]`.
    pub vibrance: f32,
    /// The same for all colors, `[−100, 100]`.
    pub saturation: f32,
}

impl Vibrance {
    /// x' = Y + (x − Y)(1 + v (1 − sgn(v) s)), s the extent of the channels, Y the luma (Rec. 709):
    /// the definition of FFmpeg; then saturation as a factor 1 + s.
    #[inline(always)]
    pub fn color(&self, rgb: [f32; 3]) -> [f32; 3] {
        let luma = |[r, g, b]: [f32; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
        let (low, high) = hsl::extent(rgb);
        let v = self.vibrance / 100.0;
        let factor = 1.0 + v * (1.0 - v.signum() * (high - low));
        let y = luma(rgb);
        let vivid = rgb.map(|x| (y + (x - y) * factor).max(0.0).min(1.0));
        let y = luma(vivid);
        vivid.map(|x| y + (x - y) * (1.0 + self.saturation / 100.0))
    }
}

impl Parameters for Vibrance {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let hint = "Saturation, most for colors that have little of it";
        let number = |name| NumberParameter::around(name, 100.0);
        v.number(number(parameter_name("vibrance", "Vibrance", hint)), &mut self.vibrance);
        v.number(number(parameter_name("saturation", "Saturation", "")), &mut self.saturation);
    }
}

/// A colored glass in front of the lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotoFilter {
    /// The color of the glass.
    pub color: Color,
    /// Percent.
    pub density: f32,
    /// The picture becomes no darker.
    pub keep_luminosity: bool,
}

impl PhotoFilter {
    /// A warming filter 85.
    const WARMING: Color = Color { r: 0xec, g: 0x8a, b: 0x00, a: 255 };
}

impl Default for PhotoFilter {
    fn default() -> Self {
        Self { color: Self::WARMING, density: 25.0, keep_luminosity: true }
    }
}

impl PhotoFilter {
    /// x (1 − d + d c), then the luminosity that it had.
    #[inline(always)]
    pub fn color(&self, rgb: [f32; 3]) -> [f32; 3] {
        let d = self.density / 100.0;
        let [r, g, b, _] = self.color.to_f32();
        let glass = [r, g, b];
        let filtered = std::array::from_fn(|c| rgb[c] * (1.0 - d + d * glass[c]));
        if self.keep_luminosity {
            hsl::with_luminosity(filtered, hsl::luminosity(rgb))
        } else {
            filtered
        }
    }
}

impl Parameters for PhotoFilter {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.color(
            parameter_name("color", "Color", "Color of the filter"),
            Self::WARMING,
            &mut self.color,
        );
        let density = NumberParameter::whole(
            parameter_name("density", "Density", "Percent"),
            1.0,
            100.0,
            25.0,
        );
        v.number(density, &mut self.density);
        let name = parameter_name("keep_luminosity", "Preserve luminosity", "The luminosity stays");
        v.flag(name, true, &mut self.keep_luminosity);
    }
}

/// Each channel as a sum of all three.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelMixer {
    /// For red, green and blue: percent of red, green and blue, and a constant, `[−200, 200]`.
    pub outputs: [[f32; 4]; 3],
    /// All channels become the one of `gray`.
    pub monochrome: bool,
    /// The shares of gray, with a constant.
    pub gray: [f32; 4],
}

/// What each channel consists of where nothing is mixed, and the gray that is offered.
const UNMIXED: [[f32; 4]; 3] =
    [[100.0, 0.0, 0.0, 0.0], [0.0, 100.0, 0.0, 0.0], [0.0, 0.0, 100.0, 0.0]];
const GRAY: [f32; 4] = [40.0, 40.0, 20.0, 0.0];

impl Default for ChannelMixer {
    fn default() -> Self {
        Self { outputs: UNMIXED, monochrome: false, gray: GRAY }
    }
}

impl ChannelMixer {
    /// What a color becomes, encoded, `[0, 1]`.
    #[inline(always)]
    pub fn color(&self, rgb: [f32; 3]) -> [f32; 3] {
        let mixed = |[r, g, b, constant]: [f32; 4]| {
            (r * rgb[0] + g * rgb[1] + b * rgb[2] + constant) / 100.0
        };
        if self.monochrome { [mixed(self.gray); 3] } else { self.outputs.map(mixed) }
    }
}

impl Parameters for ChannelMixer {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        const SHARES: [ParameterName; 4] = [
            parameter_name("red", "Red", "Percent"),
            parameter_name("green", "Green", "Percent"),
            parameter_name("blue", "Blue", "Percent"),
            parameter_name("constant", "Constant", "Percent of white that is added"),
        ];
        let mut output = |name, defaults: [f32; 4], shares: &mut [f32; 4]| {
            v.group(name, &mut |v| {
                for ((name, value), default) in
                    SHARES.into_iter().zip(shares.iter_mut()).zip(defaults)
                {
                    v.number(NumberParameter::whole(name, -200.0, 200.0, default), value);
                }
            });
        };
        for ((name, shares), defaults) in CHANNELS.into_iter().zip(&mut self.outputs).zip(UNMIXED) {
            output(name, defaults, shares);
        }
        output(parameter_name("gray", "Gray", "Used if it is monochrome"), GRAY, &mut self.gray);
        v.flag(parameter_name("monochrome", "Monochrome", "Grays"), false, &mut self.monochrome);
    }
}

/// Grays, by hues.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlackWhite {
    /// Percent of reds, yellows, greens, cyans, blues and magentas, `[−200, 300]`.
    pub weights: [f32; 6],
    /// The grays are given the hue and saturation of `color`.
    pub is_tinted: bool,
    /// The color of the tint.
    pub color: Color,
}

impl BlackWhite {
    const WEIGHTS: [f32; 6] = [40.0, 60.0, 40.0, 60.0, 20.0, 80.0];
    const TINT: Color = Color { r: 225, g: 211, b: 179, a: 255 };
}

impl Default for BlackWhite {
    fn default() -> Self {
        Self { weights: Self::WEIGHTS, is_tinted: false, color: Self::TINT }
    }
}

impl BlackWhite {
    /// min + (mid − min) · weight of the secondary color + (max − mid) · weight of the primary.
    #[inline(always)]
    pub fn gray(&self, [r, g, b]: [f32; 3]) -> f32 {
        let [reds, yellows, greens, cyans, blues, magentas] = self.weights;
        let (low, high) = hsl::extent([r, g, b]);
        let middle = r.max(g).min(r.min(g).max(b));
        let primary = if high == r {
            reds
        } else if high == g {
            greens
        } else {
            blues
        };
        let secondary = if low == r {
            cyans
        } else if low == g {
            magentas
        } else {
            yellows
        };
        low + ((middle - low) * secondary + (high - middle) * primary) / 100.0
    }

    /// What a color becomes, encoded, `[0, 1]`.
    #[inline(always)]
    pub fn color(&self, rgb: [f32; 3]) -> [f32; 3] {
        let gray = self.gray(rgb).max(0.0).min(1.0);
        if !self.is_tinted {
            return [gray; 3];
        }
        let [r, g, b, _] = self.color.to_f32();
        hsl::with_luminosity([r, g, b], gray)
    }
}

impl Parameters for BlackWhite {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let names = super::hue_saturation::HUE_RANGES.map(|(name, _)| name);
        for ((name, value), default) in names.into_iter().zip(&mut self.weights).zip(Self::WEIGHTS)
        {
            v.number(NumberParameter::whole(name, -200.0, 300.0, default), value);
        }
        v.flag(
            parameter_name("tint", "Tint", "Give the grays a color"),
            false,
            &mut self.is_tinted,
        );
        v.color(parameter_name("color", "Color of the tint", ""), Self::TINT, &mut self.color);
    }
}

/// Inks added to ranges of colors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SelectiveColor {
    /// For reds, yellows, greens, cyans, blues, magentas, whites, neutrals and blacks: percent of
    /// cyan, magenta, yellow and black, `[−100, 100]`.
    pub ranges: [[f32; 4]; 9],
    /// Percent of white, not of the ink that is there.
    pub absolute: bool,
}

impl SelectiveColor {
    /// How much of a color is in each range.
    #[inline(always)]
    pub fn weights(rgb: [f32; 3]) -> [f32; 9] {
        let [r, g, b] = rgb;
        let (low, high) = hsl::extent(rgb);
        let middle = r.max(g).min(r.min(g).max(b));
        let (primary, secondary) = (high - middle, middle - low);
        let if_so = |is: bool, weight: f32| if is { weight } else { 0.0 };
        [
            if_so(high == r, primary),
            if_so(low == b, secondary),
            if_so(high == g, primary),
            if_so(low == r, secondary),
            if_so(high == b, primary),
            if_so(low == g, secondary),
            (2.0 * low - 1.0).max(0.0),
            1.0 - (high - 0.5).abs() - (low - 0.5).abs(),
            (1.0 - 2.0 * high).max(0.0),
        ]
    }

    /// What a color becomes, encoded, `[0, 1]`.
    #[inline(always)]
    pub fn color(&self, rgb: [f32; 3]) -> [f32; 3] {
        let weights = Self::weights(rgb);
        std::array::from_fn(|c| {
            let x = rgb[c];
            let slope = if self.absolute { -1.0 } else { x - 1.0 };
            let mut out = x;
            for (range, weight) in self.ranges.iter().zip(weights) {
                let (ink, black) = (range[c] / 100.0, range[3] / 100.0);
                let moved = (ink + black * (1.0 + ink)) * slope;
                out += moved.max(-x).min(1.0 - x) * weight;
            }
            out
        })
    }
}

impl Parameters for SelectiveColor {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        const NEUTRALS: [ParameterName; 3] = [
            parameter_name("whites", "Whites", ""),
            parameter_name("neutrals", "Neutrals", ""),
            parameter_name("blacks", "Blacks", ""),
        ];
        const INKS: [ParameterName; 4] = [
            parameter_name("cyan", "Cyan", "Percent"),
            parameter_name("magenta", "Magenta", "Percent"),
            parameter_name("yellow", "Yellow", "Percent"),
            parameter_name("black", "Black", "Percent"),
        ];
        let hues = super::hue_saturation::HUE_RANGES.map(|(name, _)| name);
        for (name, inks) in hues.into_iter().chain(NEUTRALS).zip(&mut self.ranges) {
            v.group(name, &mut |v| {
                for (name, value) in INKS.into_iter().zip(inks.iter_mut()) {
                    v.number(NumberParameter::around(name, 100.0), value);
                }
            });
        }
        let hint = "Percent of all ink, not of the color's own ink";
        v.flag(parameter_name("absolute", "Absolute", hint), false, &mut self.absolute);
    }
}

/// Black below a luminosity and white from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// `[1, 255]`.
    pub level: f32,
}

impl Default for Threshold {
    fn default() -> Self {
        Self { level: 128.0 }
    }
}

impl Threshold {
    /// What a color becomes, encoded, `[0, 1]`.
    #[inline(always)]
    pub fn color(&self, rgb: [f32; 3]) -> [f32; 3] {
        let is_light = (255.0 * hsl::luminosity(rgb) + 0.5).floor() >= self.level.round();
        [if is_light { 1.0 } else { 0.0 }; 3]
    }
}

impl Parameters for Threshold {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let name = parameter_name("level", "Level", "Luminosities from this become white");
        v.number(NumberParameter::whole(name, 1.0, 255.0, 128.0), &mut self.level);
    }
}
