//! Adjustments that change each channel by itself: levels, curves, brightness and contrast,
//! exposure, inversion, posterizing. Floor 3. Values are straight and sRGB-encoded, in `[0, 1]`.

use super::curve::{ToneCurve, ToneSpline};
use super::parameters::{
    NumberParameter, ParameterName, ParameterVisitor, Parameters, parameter_name,
};

/// The three channels and all of them together.
pub(super) const MASTER: ParameterName = parameter_name("master", "RGB", "All channels together");
pub(super) const CHANNELS: [ParameterName; 3] = [
    parameter_name("red", "Red", ""),
    parameter_name("green", "Green", ""),
    parameter_name("blue", "Blue", ""),
];

/// Tones from black to white of one channel or all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelsRange {
    /// The tone that becomes the least, `[0, 253]`.
    pub black: f32,
    /// The tone that becomes the most, `[2, 255]`.
    pub white: f32,
    /// γ: above 1 mid-tones become brighter.
    pub gamma: f32,
    /// The least and the most after, `[0, 255]`.
    pub out_black: f32,
    /// What white becomes.
    pub out_white: f32,
}

impl Default for LevelsRange {
    fn default() -> Self {
        Self { black: 0.0, white: 255.0, gamma: 1.0, out_black: 0.0, out_white: 255.0 }
    }
}

impl LevelsRange {
    /// lo + t^(1/γ) (hi − lo), t = (x − black) / (white − black).
    pub fn tone(&self, x: f32) -> f32 {
        // White is always beyond black, as in Photoshop.
        let white = self.white.max(self.black + 2.0);
        let t = ((255.0 * x - self.black) / (white - self.black)).max(0.0).min(1.0);
        (self.out_black + t.powf(1.0 / self.gamma) * (self.out_white - self.out_black)) / 255.0
    }
}

impl Parameters for LevelsRange {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let tone = |key, label, hint, least, most, default| {
            NumberParameter::whole(parameter_name(key, label, hint), least, most, default)
        };
        let hint = "Tones up to this become the darkest";
        v.number(tone("black", "Shadows", hint, 0.0, 253.0, 0.0), &mut self.black);
        let hint = "Above 1 mid-tones become brighter";
        let gamma = tone("gamma", "Mid-tones", hint, 0.1, 9.99, 1.0).decimals(2);
        v.number(gamma, &mut self.gamma);
        let hint = "Tones from this become the brightest";
        v.number(tone("white", "Highlights", hint, 2.0, 255.0, 255.0), &mut self.white);
        let hint = "The darkest tone afterwards";
        v.number(tone("out_black", "Output black", hint, 0.0, 255.0, 0.0), &mut self.out_black);
        let hint = "The brightest tone afterwards";
        v.number(tone("out_white", "Output white", hint, 0.0, 255.0, 255.0), &mut self.out_white);
    }
}

/// Levels of each channel, then of all.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Levels {
    /// The levels of all channels.
    pub master: LevelsRange,
    /// Those of red, green and blue.
    pub channels: [LevelsRange; 3],
}

impl Levels {
    /// What a tone of a channel becomes, `[0, 1]`.
    pub fn tone(&self, channel: usize, x: f32) -> f32 {
        self.master.tone(self.channels[channel].tone(x))
    }

    pub(super) fn is_gray(&self) -> bool {
        self.channels == [LevelsRange::default(); 3]
    }
}

impl Parameters for Levels {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.group(MASTER, &mut |v| self.master.visit(v));
        for (name, range) in CHANNELS.into_iter().zip(&mut self.channels) {
            v.group(name, &mut |v| range.visit(v));
        }
    }
}

/// A curve of each channel, then one of all.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves {
    /// The curve of all channels.
    pub master: ToneCurve,
    /// Those of red, green and blue.
    pub channels: [ToneCurve; 3],
}

impl Curves {
    /// The tone of a channel, as a function.
    pub fn tone(&self, channel: usize) -> impl Fn(f32) -> f32 + use<> {
        let (own, master) = (self.channels[channel].spline(), self.master.spline());
        move |x| master.at(own.at(x).max(0.0).min(1.0))
    }

    pub(super) fn is_gray(&self) -> bool {
        self.channels.iter().all(ToneCurve::is_straight)
    }
}

impl Parameters for Curves {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.curve(MASTER, &mut self.master);
        for (name, curve) in CHANNELS.into_iter().zip(&mut self.channels) {
            v.curve(name, curve);
        }
    }
}

/// Brightness, then contrast.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BrightnessContrast {
    /// `[−150, 150]`.
    pub brightness: f32,
    /// `[−100, 100]`.
    pub contrast: f32,
    /// Shifts and stretches all tones alike and clips them, as programs did before curves.
    pub legacy: bool,
}

impl BrightnessContrast {
    /// How far contrast moves the quarter tones, of 255 at 100: fitted to pictures of Photoshop.
    const CONTRAST: f32 = 26.0;

    /// The tone as a function.
    ///
    /// Brightness b: a natural cubic through (130 − 26 B, 130 + 51 B) and (233 − 48 B, 233 + 10 B),
    /// B = |b| / 100, and for b < 0 its inverse. Contrast: one through (64, 64 − k c) and
    /// (192, 192 + k c). The knots are fitted to pictures that Photoshop made.
    pub fn tone(&self) -> Box<dyn Fn(f32) -> f32> {
        let (b, c) = (self.brightness, self.contrast);
        if self.legacy {
            return Box::new(move |x| legacy(b, c, x));
        }
        let spline = |points: [[f32; 2]; 2]| {
            let [p, q] = points.map(|p| p.map(|v| v / 255.0));
            ToneSpline::natural(vec![[0.0, 0.0], p, q, [1.0, 1.0]])
        };
        let up = b.abs() / 100.0;
        let (low, high) =
            ([130.0 - 26.0 * up, 130.0 + 51.0 * up], [233.0 - 48.0 * up, 233.0 + 10.0 * up]);
        let brighter = spline([low, high]);
        let k = Self::CONTRAST * c / 100.0;
        let steeper = spline([[64.0, 64.0 - k], [192.0, 192.0 + k]]);
        Box::new(move |x| {
            let brightened = if b < 0.0 { inverse(&brighter, x) } else { brighter.at(x) };
            steeper.at(brightened.max(0.0).min(1.0))
        })
    }
}

/// The x at which a rising spline is `y`, by halving.
fn inverse(spline: &ToneSpline, y: f32) -> f32 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..20 {
        let middle = 0.5 * (low + high);
        if spline.at(middle) < y { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Brightness shifts, then contrast stretches around 127 of 255, at 100 without limit; below 0 it
/// draws tones together before they are shifted.
fn legacy(brightness: f32, contrast: f32, x: f32) -> f32 {
    const MIDDLE: f32 = 127.0 / 255.0;
    let (shift, c) = (brightness / 255.0, contrast / 100.0);
    if c > 0.0 {
        return MIDDLE + (x + shift - MIDDLE) / (1.0 - c).max(1e-3);
    }
    MIDDLE + (x - MIDDLE) * (1.0 + c) + shift
}

impl Parameters for BrightnessContrast {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let number =
            |key, label, most| NumberParameter::around(parameter_name(key, label, ""), most);
        v.number(number("brightness", "Brightness", 150.0), &mut self.brightness);
        v.number(number("contrast", "Contrast", 100.0), &mut self.contrast);
        let hint = "Shifts and stretches all tones alike and clips them";
        v.flag(parameter_name("legacy", "Legacy", hint), false, &mut self.legacy);
    }
}

/// Exposure in stops of linear light, an offset of it, and a γ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure {
    /// Stops.
    pub exposure: f32,
    /// Added to linear light.
    pub offset: f32,
    /// The exponent of what results, above 0.
    pub gamma: f32,
}

impl Default for Exposure {
    fn default() -> Self {
        Self { exposure: 0.0, offset: 0.0, gamma: 1.0 }
    }
}

impl Exposure {
    /// ((x^2.2 · 2^e + offset)^(1/γ))^(1/2.2): the curve of the light is taken as a power of 2.2.
    pub fn tone(&self, x: f32) -> f32 {
        const CURVE: f32 = 2.2;
        let light = (x.powf(CURVE) * self.exposure.exp2() + self.offset).max(0.0).min(1.0);
        light.powf(1.0 / (self.gamma * CURVE))
    }
}

impl Parameters for Exposure {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let number = |key, label, hint, least, most, default, decimals| {
            NumberParameter::whole(parameter_name(key, label, hint), least, most, default)
                .decimals(decimals)
        };
        let hint = "In stops: 1 doubles the light";
        v.number(number("exposure", "Exposure", hint, -20.0, 20.0, 0.0, 2), &mut self.exposure);
        let hint = "Added to the light: below 0 shadows become black";
        v.number(number("offset", "Offset", hint, -0.5, 0.5, 0.0, 4), &mut self.offset);
        let hint = "Above 1 mid-tones become brighter";
        v.number(number("gamma", "Gamma", hint, 0.01, 9.99, 1.0, 2), &mut self.gamma);
    }
}

/// Light becomes dark, and each color its complement.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Invert;

impl Invert {
    /// What a tone becomes, `[0, 1]`.
    pub fn tone(x: f32) -> f32 {
        1.0 - x
    }
}

impl Parameters for Invert {
    fn visit(&mut self, _: &mut dyn ParameterVisitor) {}
}

/// A few tones of each channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posterize {
    /// Tones, `[2, 255]`.
    pub levels: f32,
    /// Its steps are those of pictures of 16 bits, whatever the pixels hold.
    pub of_16_bits: bool,
}

impl Default for Posterize {
    fn default() -> Self {
        Self { levels: 4.0, of_16_bits: false }
    }
}

impl Posterize {
    /// ⌊n x 255/256⌋ / (n − 1) of what a byte can hold, as Photoshop does; of 16 bits ⌊n x⌋ / (n − 1).
    pub fn tone(&self, x: f32) -> f32 {
        let value = (x * 65535.0).round();
        if self.of_16_bits || value % 257.0 != 0.0 {
            return self.tone_of_16_bits(x);
        }
        self.step(f64::from(value) / 65535.0 * (255.0 / 256.0))
    }

    /// ⌊n x⌋ / (n − 1).
    pub fn tone_of_16_bits(&self, x: f32) -> f32 {
        // The nearest value first: one on a step is not to be rounded below it.
        self.step(f64::from((x * 65535.0).round()) / 65535.0)
    }

    fn step(&self, x: f64) -> f32 {
        let n = self.levels.round();
        let step = (x * f64::from(n) + 1e-9).floor() as f32;
        step.min(n - 1.0) / (n - 1.0)
    }
}

impl Parameters for Posterize {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let name = parameter_name("levels", "Levels", "How many tones each channel has");
        v.number(NumberParameter::whole(name, 2.0, 255.0, 4.0), &mut self.levels);
        let hint = "Steps as in pictures of 16 bits";
        v.flag(parameter_name("of_16_bits", "16-bit steps", hint), false, &mut self.of_16_bits);
    }
}
