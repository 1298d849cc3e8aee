//! Hue, saturation and lightness, of all colors and of ranges of hues; or everything in one hue.
//! Floor 3.

use super::hsl;
use super::parameters::{
    NumberParameter, ParameterName, ParameterVisitor, Parameters, parameter_name,
};

/// What is added to hue, saturation and lightness.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HslShift {
    /// Degrees, `[−180, 180]`.
    pub hue: f32,
    /// `[−100, 100]`.
    pub saturation: f32,
    /// `[−100, 100]`.
    pub lightness: f32,
}

impl Parameters for HslShift {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let number =
            |key, label, most| NumberParameter::around(parameter_name(key, label, ""), most);
        v.number(number("hue", "Hue", 180.0), &mut self.hue);
        v.number(number("saturation", "Saturation", 100.0), &mut self.saturation);
        v.number(number("lightness", "Lightness", 100.0), &mut self.lightness);
    }
}

/// A range of hues: wholly from the second angle to the third, fading to the first and fourth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HueRange {
    /// Degrees, going up, past 360 where they go on beyond red.
    pub angles: [f32; 4],
    /// What becomes of colors in it.
    pub shift: HslShift,
}

impl HueRange {
    /// How much of a hue (degrees) is in the range: a trapezoid over its angles.
    #[inline(always)]
    pub fn weight(&self, degrees: f32) -> f32 {
        let [first, from, to, last] = self.angles;
        let turn = |angle: f32| (angle - first).rem_euclid(360.0);
        let (at, from, to, last) = (turn(degrees), turn(from), turn(to), turn(last));
        if at < from {
            at / from
        } else if at <= to {
            1.0
        } else if at <= last {
            (last - at) / (last - to).max(1e-6)
        } else {
            0.0
        }
    }
}

/// The ranges, as in Photoshop.
pub const HUE_RANGES: [(ParameterName, [f32; 4]); 6] = [
    (parameter_name("reds", "Reds", ""), [315.0, 345.0, 15.0, 45.0]),
    (parameter_name("yellows", "Yellows", ""), [15.0, 45.0, 75.0, 105.0]),
    (parameter_name("greens", "Greens", ""), [75.0, 105.0, 135.0, 165.0]),
    (parameter_name("cyans", "Cyans", ""), [135.0, 165.0, 195.0, 225.0]),
    (parameter_name("blues", "Blues", ""), [195.0, 225.0, 255.0, 285.0]),
    (parameter_name("magentas", "Magentas", ""), [255.0, 285.0, 315.0, 345.0]),
];

/// Shifts of all colors, of six ranges of them, or one hue for all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HueSaturation {
    /// The shift of all colors.
    pub master: HslShift,
    /// The shifts of ranges, reds first.
    pub ranges: [HueRange; 6],
    /// Everything gets the hue, saturation and lightness of `tint`.
    pub colorize: bool,
    /// The one hue, and its saturation and lightness.
    pub tint: HslShift,
}

impl Default for HueSaturation {
    fn default() -> Self {
        Self {
            master: HslShift::default(),
            ranges: HUE_RANGES.map(|(_, angles)| HueRange { angles, shift: HslShift::default() }),
            colorize: false,
            tint: HslShift { hue: 0.0, saturation: 25.0, lightness: 0.0 },
        }
    }
}

/// Toward white above 0, toward black below.
#[inline(always)]
fn lighter(x: f32, by: f32) -> f32 {
    if by > 0.0 { x + (1.0 - x) * by } else { x * (1.0 + by) }
}

/// The factor of the saturation: 1 / (1 − s) above 0, 1 + s below.
#[inline(always)]
fn saturation_factor(by: f32) -> f32 {
    if by > 0.0 { 1.0 / (1.0 - by).max(0.01) } else { 1.0 + by }
}

impl HueSaturation {
    /// The key of what everything is colorized with.
    pub const TINT: &'static str = "tint";

    /// Lightness of all first, then what ranges darken or lighten, then hue and saturation.
    pub fn color(&self) -> impl Fn([f32; 3]) -> [f32; 3] + use<> {
        let changes = |range: &HueRange| range.shift != HslShift::default();
        let used: Vec<HueRange> = self.ranges.iter().copied().filter(changes).collect();
        let Self { master, colorize, tint, .. } = *self;
        move |rgb| {
            if colorize {
                let [.., lightness] = hsl::of_rgb(rgb);
                let lightness = lighter(lightness, tint.lightness / 100.0);
                return hsl::to_rgb([tint.hue / 60.0, tint.saturation.max(0.0) / 100.0, lightness]);
            }
            let rgb = rgb.map(|v| lighter(v, master.lightness / 100.0));
            let (mut turned, mut lightness_by, mut factor) = (0.0, 0.0, 1.0f32);
            if !used.is_empty() {
                let degrees = 60.0 * hsl::hue(rgb);
                for range in &used {
                    let weight = range.weight(degrees);
                    turned += weight * range.shift.hue;
                    lightness_by += weight * range.shift.lightness / 100.0;
                    // Factors add up, which was found on pictures that Photoshop made: S 0.10 with
                    // +89 and −92 in one range becomes 0.80, 0.10 (9.1 + 0.08 − 1).
                    let own = saturation_factor(range.shift.saturation / 100.0);
                    factor = (factor + weight * (own - 1.0)).max(0.0);
                }
            }
            let rgb = range_lighter(rgb, lightness_by.max(-1.0).min(1.0));
            let [hue, saturation, lightness] = hsl::of_rgb(rgb);
            let saturation = saturation * saturation_factor(master.saturation / 100.0);
            let saturation = (saturation.min(1.0) * factor).min(1.0);
            hsl::to_rgb([hue + (master.hue + turned) / 60.0, saturation, lightness])
        }
    }
}

/// The lightness of a range moves a color along the side of the cone of values: its greatest
/// channel stays where it becomes lighter, and its least where it becomes darker.
#[inline(always)]
fn range_lighter(rgb: [f32; 3], by: f32) -> [f32; 3] {
    let (low, high) = hsl::extent(rgb);
    if by >= 0.0 { rgb.map(|v| v + (high - v) * by) } else { rgb.map(|v| v + (v - low) * by) }
}

impl Parameters for HueSaturation {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        self.master.visit(v);
        let hint = "Give everything one hue";
        v.flag(parameter_name("colorize", "Colorize", hint), false, &mut self.colorize);
        let hint = "The hue, saturation and lightness of what is colorized";
        v.group(parameter_name(Self::TINT, "Colorized", hint), &mut |v| {
            let number = NumberParameter::whole;
            v.number(number(parameter_name("hue", "Hue", ""), 0.0, 360.0, 0.0), &mut self.tint.hue);
            let saturation =
                number(parameter_name("saturation", "Saturation", ""), 0.0, 100.0, 25.0);
            v.number(saturation, &mut self.tint.saturation);
            let lightness =
                NumberParameter::around(parameter_name("lightness", "Lightness", ""), 100.0);
            v.number(lightness, &mut self.tint.lightness);
        });
        for ((name, angles), range) in HUE_RANGES.into_iter().zip(&mut self.ranges) {
            v.group(name, &mut |v| {
                range.shift.visit(v);
                const ANGLES: [ParameterName; 4] = [
                    parameter_name("fade_from", "Fades from", "Degrees of the color circle"),
                    parameter_name("from", "From", "Degrees of the color circle"),
                    parameter_name("to", "To", "Degrees of the color circle"),
                    parameter_name("fade_to", "Fades to", "Degrees of the color circle"),
                ];
                for ((name, angle), default) in
                    ANGLES.into_iter().zip(&mut range.angles).zip(angles)
                {
                    v.number(NumberParameter::whole(name, 0.0, 360.0, default), angle);
                }
            });
        }
    }
}
