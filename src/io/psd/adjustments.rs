//! Adjustment layers: the blocks that say what they do, in and out. Floor 5. Numbers are those of
//! this program's adjustments, whose ranges are Photoshop's. Not here: the records around them
//! (`blocks`, `write`).

mod write;

pub use write::blocks;

use super::colors::{Colors, Mode};
use super::cursor::ByteCursor;
use super::descriptor;
use super::fill::{self, Mark};
use super::ramp::{self, RampMixing};
use crate::cube;
use crate::document::Content;
use crate::math::srgb::{self, Color};
use crate::paint::ColorAdjustment;
use crate::paint::adjustment::{
    BlackWhite, BrightnessContrast, ChannelMixer, ColorBalance, ColorLookup, Curves, Exposure,
    GradientMap, HslShift, HueSaturation, Invert, Levels, LevelsRange, PhotoFilter, Posterize,
    SelectiveColor, Threshold, ToneCurve, Vibrance,
};
use std::path::Path;

/// Blocks that say an adjustment.
pub const KEYS: [[u8; 4]; 17] = [
    *b"levl", *b"curv", *b"brit", *b"hue2", *b"hue ", *b"blnc", *b"blwh", *b"phfl", *b"mixr",
    *b"clrL", *b"nvrt", *b"post", *b"thrs", *b"selc", *b"grdm", *b"expA", *b"vibA",
];
/// The newer numbers of brightness and contrast; elsewhere only the name of a preset.
pub const NEWER: [u8; 4] = *b"CgEd";
/// The most colors of a gradient map.
const MOST_STOPS: u16 = 1000;

/// Reads a block; `None` where it holds what is not understood.
pub fn read(key: [u8; 4], data: &mut ByteCursor, colors: &Colors) -> Option<ColorAdjustment> {
    let adjustment: ColorAdjustment = match &key {
        b"levl" => ColorAdjustment::Levels(levels(data)?),
        b"curv" => ColorAdjustment::Curves(curves(data)?),
        b"brit" => {
            let (brightness, contrast) = (number(data)?, number(data)?);
            let legacy = BrightnessContrast { brightness, contrast, legacy: true };
            ColorAdjustment::BrightnessContrast(legacy)
        }
        b"hue2" | b"hue " => ColorAdjustment::HueSaturation(hue_saturation(data)?),
        b"blnc" => {
            let ranges = [triple(data)?, triple(data)?, triple(data)?];
            let keep_luminosity = data.u8()? != 0;
            ColorAdjustment::ColorBalance(ColorBalance { ranges, keep_luminosity })
        }
        b"blwh" => ColorAdjustment::BlackWhite(black_white(data, colors)?),
        b"phfl" => ColorAdjustment::PhotoFilter(photo_filter(data, colors)?),
        b"mixr" => ColorAdjustment::ChannelMixer(channel_mixer(data)?),
        b"clrL" => ColorAdjustment::ColorLookup(color_lookup(data)?),
        b"nvrt" => ColorAdjustment::Invert(Invert),
        b"post" => ColorAdjustment::Posterize(Posterize {
            levels: f32::from(data.u16()?),
            ..Posterize::default()
        }),
        b"thrs" => ColorAdjustment::Threshold(Threshold { level: f32::from(data.u16()?) }),
        b"selc" => ColorAdjustment::SelectiveColor(selective_color(data)?),
        b"grdm" => ColorAdjustment::GradientMap(gradient_map(data, colors)?),
        b"expA" => {
            data.u16().filter(|version| *version == 1)?;
            let [exposure, offset, gamma] = [float(data)?, float(data)?, float(data)?];
            ColorAdjustment::Exposure(Exposure { exposure, offset, gamma })
        }
        b"vibA" => {
            let said = descriptor::read(data)?;
            let number = |name| said.number(name).unwrap_or(0.0);
            let (vibrance, saturation) = (number("vibrance"), number("Strt"));
            ColorAdjustment::Vibrance(Vibrance { vibrance, saturation })
        }
        _ => return None,
    };
    Some(adjustment.clamp_to_ranges())
}

/// An adjustment as other programs will read it, its numbers rounded to those of the format; `None`
/// for other content, and where the format has no word for it.
pub fn as_read(content: &Content) -> Option<ColorAdjustment> {
    let Content::Adjustment(live) = content else { return None };
    let colors = Colors::of_mode(Mode::Rgb);
    blocks(live.params()).iter().fold(None, |known, (key, data)| {
        let data = &mut ByteCursor::new(data);
        if *key == NEWER { newer_brightness(data) } else { read(*key, data, &colors) }.or(known)
    })
}

/// The newer numbers of brightness and contrast; `None` if a block of that key holds the name of a
/// preset, as it does in other adjustments.
pub fn newer_brightness(data: &mut ByteCursor) -> Option<ColorAdjustment> {
    let said = descriptor::read(data)?;
    let presets = ["presetFileName", "curvesPresetFileName", "mixerPresetFileName"];
    if presets.iter().any(|name| said.text(name).is_some()) {
        return None;
    }
    let (brightness, contrast) = (said.number("Brgh")?, said.number("Cntr")?);
    let own = BrightnessContrast { brightness, contrast, legacy: said.is_set("useLegacy") };
    Some(ColorAdjustment::BrightnessContrast(own).clamp_to_ranges())
}

fn number(data: &mut ByteCursor) -> Option<f32> {
    data.i16().map(f32::from)
}

fn triple(data: &mut ByteCursor) -> Option<[f32; 3]> {
    Some([number(data)?, number(data)?, number(data)?])
}

fn float(data: &mut ByteCursor) -> Option<f32> {
    data.u32().map(f32::from_bits).filter(|value| value.is_finite())
}

/// What levels and curves do to black, the fourth ink of CMYK, as a first channel; `None` of others.
pub fn read_black(key: [u8; 4], mut data: ByteCursor) -> Option<ColorAdjustment> {
    let adjustment = match &key {
        b"levl" => {
            data.u16().filter(|version| *version == 2)?;
            let master = levels_range(&mut data)?;
            data.take(3 * LEVELS_BYTES)?;
            let channels = [levels_range(&mut data)?; 3];
            ColorAdjustment::Levels(Levels { master, channels })
        }
        b"curv" => {
            let [master, _, _, _, black] = inks_curves(&mut data)?;
            let channels = [black.clone(), black.clone(), black];
            ColorAdjustment::Curves(Curves { master, channels })
        }
        _ => return None,
    };
    Some(adjustment.clamp_to_ranges())
}

/// All channels, then each; what follows is for more channels than colors have here.
fn levels(data: &mut ByteCursor) -> Option<Levels> {
    data.u16().filter(|version| *version == 2)?;
    let master = levels_range(data)?;
    let channels = [levels_range(data)?, levels_range(data)?, levels_range(data)?];
    Some(Levels { master, channels })
}

/// Five numbers of two bytes.
const LEVELS_BYTES: usize = 10;

fn levels_range(data: &mut ByteCursor) -> Option<LevelsRange> {
    let [black, white, out_black, out_white, gamma] =
        [number(data)?, number(data)?, number(data)?, number(data)?, number(data)?];
    Some(LevelsRange { black, white, out_black, out_white, gamma: gamma / 100.0 })
}

/// Curves by the bits of their channels, or in newer blocks by number; what follows these repeats
/// them with the numbers of the channels, and is preferred.
fn curves(data: &mut ByteCursor) -> Option<Curves> {
    let [master, red, green, blue, _] = inks_curves(data)?;
    Some(Curves { master, channels: [red, green, blue] })
}

/// Of all channels, then of as many as colors have at most.
fn inks_curves(data: &mut ByteCursor) -> Option<[ToneCurve; 5]> {
    const SET: u32 = 32;
    let is_map = data.u8()? != 0;
    let version = data.u16()?;
    let said = data.u32()?;
    let is_said = |channel: u32| match version {
        1 => said & 1 << channel != 0,
        _ => channel < said,
    };
    let mut curves: [ToneCurve; 5] = Default::default();
    let mut put = |channel: usize, curve: ToneCurve| {
        if let Some(slot) = curves.get_mut(channel) {
            *slot = curve;
        }
    };
    for channel in (0..SET).filter(|channel| is_said(*channel)) {
        put(channel as usize, curve(data, is_map)?);
    }
    if data.key() == Some(*b"Crv ") {
        data.u16()?;
        for _ in 0..data.u32()?.min(SET) {
            let channel = data.u16()?;
            put(usize::from(channel), curve(data, is_map)?);
        }
    }
    Some(curves)
}

/// Points with the tone after first, or a tone for each byte, which becomes points.
fn curve(data: &mut ByteCursor, is_map: bool) -> Option<ToneCurve> {
    if is_map {
        let tones = data.take(256)?;
        let steps = ToneCurve::MOST_POINTS - 1;
        let point = |i: usize| {
            let x = i * 255 / steps;
            [x as f32, f32::from(tones[x])]
        };
        return Some(ToneCurve::new((0..=steps).map(point).collect()));
    }
    let count = data.u16()?;
    let point = |_| {
        let (after, before) = (number(data)?, number(data)?);
        Some([before, after])
    };
    (0..count).map(point).collect::<Option<Vec<_>>>().map(ToneCurve::new)
}

fn hue_saturation(data: &mut ByteCursor) -> Option<HueSaturation> {
    data.u16().filter(|version| *version == 2)?;
    let colorize = data.u8()? != 0;
    data.u8()?;
    let shift = |data: &mut ByteCursor| {
        let [hue, saturation, lightness] = triple(data)?;
        Some(HslShift { hue, saturation, lightness })
    };
    let mut own = HueSaturation { colorize, ..HueSaturation::default() };
    let tint = shift(data)?;
    own.tint = HslShift { hue: tint.hue.rem_euclid(360.0), ..tint };
    own.master = shift(data)?;
    for range in &mut own.ranges {
        range.angles = [number(data)?, number(data)?, number(data)?, number(data)?];
        range.shift = shift(data)?;
    }
    Some(own)
}

/// The weights of the hues, in this program's order.
const HUES: [&str; 6] = ["Rd  ", "Yllw", "Grn ", "Cyn ", "Bl  ", "Mgnt"];

fn black_white(data: &mut ByteCursor, colors: &Colors) -> Option<BlackWhite> {
    let said = descriptor::read(data)?;
    let begins = BlackWhite::default();
    let weight = |i: usize| said.number(HUES[i]).unwrap_or(begins.weights[i]);
    let tint = said.object("tintColor").and_then(|tint| fill::color(tint, colors));
    Some(BlackWhite {
        weights: std::array::from_fn(weight),
        is_tinted: said.is_set("useTint"),
        color: tint.unwrap_or(begins.color),
    })
}

/// A color in one of the ways of older blocks: what its numbers mean, then four of them.
pub fn color(data: &mut ByteCursor, colors: &Colors) -> Option<Color> {
    let space = data.u16()?;
    let [a, b, c, _] = [data.u16()?, data.u16()?, data.u16()?, data.u16()?];
    let signed = |v: u16| f32::from(v as i16) / 100.0;
    match space {
        0 => {
            let [r, g, b] = [a, b, c].map(|v| srgb::quantize(f32::from(v) / 65535.0));
            Some(Color { r, g, b, a: 255 })
        }
        7 => Some(fill::lab_color([signed(a), signed(b), signed(c)], colors)),
        8 => {
            let gray = srgb::quantize(1.0 - f32::from(a) / 10_000.0);
            Some(Color { r: gray, g: gray, b: gray, a: 255 })
        }
        _ => None,
    }
}

/// Density in percent. Version 3 says its color in XYZ, D50, of 65536ths.
fn photo_filter(data: &mut ByteCursor, colors: &Colors) -> Option<PhotoFilter> {
    let color = match data.u16()? {
        2 => color(data, colors)?,
        3 => {
            let mut part = || data.i32().map(|v| v as f32 / 65536.0);
            fill::xyz_color([part()?, part()?, part()?], colors)
        }
        _ => return None,
    };
    let density = data.u32()? as f32;
    let keep_luminosity = data.u8()? != 0;
    Some(PhotoFilter { color, density, keep_luminosity })
}

/// For each output red, green, blue, a fourth that RGB has not, and the constant; a single output
/// if it is monochrome.
fn channel_mixer(data: &mut ByteCursor) -> Option<ChannelMixer> {
    data.u16().filter(|version| *version == 1)?;
    let monochrome = data.u16()? != 0;
    let mut output = || {
        let [r, g, b] = triple(data)?;
        number(data)?;
        Some([r, g, b, number(data)?])
    };
    let mut own = ChannelMixer { monochrome, ..ChannelMixer::default() };
    if monochrome {
        own.gray = output()?;
    } else {
        own.outputs = [output()?, output()?, output()?];
    }
    Some(own)
}

/// A table whose `.cube` file is within, or none yet, which changes nothing; profiles are not
/// applied.
fn color_lookup(data: &mut ByteCursor) -> Option<ColorLookup> {
    data.u16().filter(|version| *version == 1)?;
    let said = descriptor::read(data)?;
    if ["LUT3DFileData", "profile", "lookupType"].iter().all(|name| !said.has_value(name)) {
        return Some(ColorLookup { table: None });
    }
    let is_cube = said.word("LUTFormat").is_none_or(|word| word == b"LUTFormatCUBE");
    let table = said.bytes("LUT3DFileData").filter(|_| is_cube)?;
    let name = said.text("LUT3DFileName").unwrap_or("table.cube");
    let table = cube::parse(Path::new(name), table).ok()?;
    Some(ColorLookup { table: Some(table) })
}

/// Reds, yellows, greens, cyans, blues, magentas, whites, neutrals and blacks; before them one that
/// is not used.
fn selective_color(data: &mut ByteCursor) -> Option<SelectiveColor> {
    data.u16().filter(|version| *version == 1)?;
    let absolute = data.u16()? == 1;
    data.take(8)?;
    let mut own = SelectiveColor { absolute, ..SelectiveColor::default() };
    for range in &mut own.ranges {
        let [c, m, y] = triple(data)?;
        *range = [c, m, y, number(data)?];
    }
    Some(own)
}

fn gradient_map(data: &mut ByteCursor, colors: &Colors) -> Option<GradientMap> {
    let version = data.u16().filter(|version| matches!(version, 1 | 3))?;
    let reverse = data.u8()? != 0;
    data.u8()?;
    let mixing = if version == 3 { RampMixing::of(&data.key()?) } else { RampMixing::Classic };
    data.unicode()?;
    let place = |data: &mut ByteCursor| {
        let t = data.u32()? as f32 / 4096.0;
        let middle = data.u32()? as f32 / 100.0;
        Some((t.max(0.0).min(1.0), middle.max(0.01).min(0.99)))
    };
    let mut inks = Vec::new();
    for _ in 0..data.u16()?.min(MOST_STOPS) {
        let (t, middle) = place(data)?;
        let [r, g, b, _] = color(data, colors)?.to_f32();
        data.u16()?;
        inks.push(Mark { t, middle, value: [r, g, b] });
    }
    let mut opacities = Vec::new();
    for _ in 0..data.u16()?.min(MOST_STOPS) {
        let (t, middle) = place(data)?;
        opacities.push(Mark { t, middle, value: [f32::from(data.u16()?) / 255.0] });
    }
    // How many numbers follow, and the first of them.
    let smoothness = data.u16().and_then(|_| data.u16()).map_or(0.0, f32::from);
    Some(GradientMap { stops: ramp::stops(inks, opacities, smoothness, mixing)?, reverse })
}

#[cfg(test)]
mod tests;
