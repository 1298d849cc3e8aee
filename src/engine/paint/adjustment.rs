//! Adjustments of colors, as photographs are edited: levels, curves, hue and saturation and their
//! like. Floor 3. A pixel depends on the pixel alone, alpha stays, and values beyond white become
//! white. Not here: the layers that hold them (`document`), adjustments of placed pictures
//! (`adjust`).
//!
//! | file | |
//! |---|---|
//! | `parameters` | how their parameters are named, read, written and set |
//! | `tones`, `curve` | those of each channel by itself |
//! | `hue_saturation`, `mixing`, `hsl` | those that weigh channels against each other |
//! | `gradient_map`, `lookup`, `table` | those that look colors up |
//! | `rows` | what they do to rows of pixels |

mod curve;
mod gradient_map;
mod hsl;
mod hue_saturation;
mod lookup;
mod mixing;
pub(in crate::paint) mod parameters;
mod rows;
mod table;
mod tones;

pub use curve::{ToneCurve, ToneSpline};
pub use gradient_map::GradientMap;
pub use hue_saturation::{HslShift, HueRange, HueSaturation};
pub use lookup::ColorLookup;
pub use mixing::{
    BlackWhite, ChannelMixer, ColorBalance, PhotoFilter, SelectiveColor, Threshold, Vibrance,
};
pub use parameters::{NumberParameter, ParameterName, ParameterVisitor};
pub use rows::LiveAdjustment;
pub use table::ColorTable;
pub use tones::{BrightnessContrast, Curves, Exposure, Invert, Levels, LevelsRange, Posterize};

use parameters::{Holder, Parameters, parameter_kinds};

parameter_kinds! {
    /// An adjustment with its parameters.
    pub enum ColorAdjustment;
    BrightnessContrast = "brightness-contrast"
        => ("Brightness/contrast", "Brighter or darker, with more or less contrast"),
    Levels = "levels" => ("Levels", "What becomes black and what white, and the mid-tones between"),
    Curves = "curves" => ("Curves", "Each tone by a curve, of all channels or of one"),
    Exposure = "exposure" => ("Exposure", "More or less light, in stops"),
    Vibrance = "vibrance" => ("Vibrance", "More saturation where there is little"),
    HueSaturation = "hue-saturation"
        => ("Hue/saturation", "Hue, saturation and lightness, of all colors or of a range; or one hue"),
    ColorBalance = "color-balance"
        => ("Color balance", "Warmer or cooler, in shadows, mid-tones and highlights"),
    BlackWhite = "black-white" => ("Black & white", "Grays, with a brightness for each hue"),
    PhotoFilter = "photo-filter" => ("Photo filter", "A colored glass in front of the picture"),
    ChannelMixer = "channel-mixer" => ("Channel mixer", "Each channel as a sum of all three"),
    ColorLookup = "color-lookup" => ("Color look-up", "The colors of a .cube file"),
    Invert = "invert" => ("Invert", "Light becomes dark, and each color its complement"),
    Posterize = "posterize" => ("Posterize", "A few tones of each channel"),
    Threshold = "threshold" => ("Threshold", "Black and white only"),
    GradientMap = "gradient-map" => ("Gradient map", "A color of a gradient for each brightness"),
    SelectiveColor = "selective-color"
        => ("Selective color", "Cyan, magenta, yellow and black for each range of colors"),
}

impl ColorAdjustment {
    /// Whether Photoshop's format has a word for it: of a table it wants a profile too.
    pub fn is_said_by_photoshop(&self) -> bool {
        !matches!(self, Self::ColorLookup(_))
    }

    /// A straight encoded color, adjusted: what each kind says, without tables. Each channel in
    /// `[0, 1]`, never NaN.
    pub fn color(&self, rgb: [f32; 3]) -> [f32; 3] {
        let rgb = rgb.map(|v| v.max(0.0).min(1.0));
        let out: [f32; 3] = match self {
            Self::Levels(own) => std::array::from_fn(|c| own.tone(c, rgb[c])),
            Self::Curves(own) => std::array::from_fn(|c| own.tone(c)(rgb[c])),
            Self::BrightnessContrast(own) => rgb.map(own.tone()),
            Self::Exposure(own) => rgb.map(|v| own.tone(v)),
            Self::Invert(_) => rgb.map(Invert::tone),
            Self::Posterize(own) => rgb.map(|v| own.tone(v)),
            Self::HueSaturation(own) => own.color()(rgb),
            Self::ColorBalance(own) => own.color(rgb),
            Self::Vibrance(own) => own.color(rgb),
            Self::PhotoFilter(own) => own.color(rgb),
            Self::ChannelMixer(own) => own.color(rgb),
            Self::BlackWhite(own) => own.color(rgb),
            Self::SelectiveColor(own) => own.color(rgb),
            Self::Threshold(own) => own.color(rgb),
            Self::GradientMap(own) => own.color()(rgb),
            Self::ColorLookup(own) => own.table.as_ref().map_or(rgb, |table| table.color(rgb)),
        };
        out.map(|v| v.max(0.0).min(1.0))
    }
}

#[cfg(test)]
mod tests;
