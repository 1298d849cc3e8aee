//! Adjustments as Photoshop's blocks. Floor 5.

use super::super::descriptor::DescriptorWriter;
use crate::math::srgb::Color;
use crate::paint::adjustment::{
    BlackWhite, BrightnessContrast, ChannelMixer, Curves, GradientMap, HslShift, HueSaturation,
    Levels, PhotoFilter, SelectiveColor, ToneCurve,
};
use crate::paint::{ColorAdjustment, GradientStop};

/// A block: its key and data.
type Block = ([u8; 4], Vec<u8>);

/// The blocks of an adjustment, its numbers rounded to those that they hold; empty for what
/// Photoshop has no word for.
pub fn blocks(adjustment: &ColorAdjustment) -> Vec<Block> {
    use ColorAdjustment as A;
    let one = |key: &[u8; 4], data: Vec<u8>| vec![(*key, data)];
    match adjustment {
        A::Levels(own) => one(b"levl", levels(own)),
        A::Curves(own) => one(b"curv", curves(own)),
        A::BrightnessContrast(own) => brightness(own),
        A::HueSaturation(own) => one(b"hue2", hue_saturation(own)),
        A::ColorBalance(own) => {
            let mut out = Vec::new();
            own.ranges.iter().flatten().for_each(|value| number(&mut out, *value));
            out.extend([u8::from(own.keep_luminosity), 0]);
            one(b"blnc", out)
        }
        A::BlackWhite(own) => one(b"blwh", black_white(own)),
        A::PhotoFilter(own) => one(b"phfl", photo_filter(own)),
        A::ChannelMixer(own) => one(b"mixr", channel_mixer(own)),
        A::Invert(_) => one(b"nvrt", Vec::new()),
        A::Posterize(own) => one(b"post", pad(own.levels)),
        A::Threshold(own) => one(b"thrs", pad(own.level)),
        A::SelectiveColor(own) => one(b"selc", selective_color(own)),
        A::GradientMap(own) => one(b"grdm", gradient_map(own)),
        A::Exposure(own) => {
            let mut out = 1u16.to_be_bytes().to_vec();
            [own.exposure, own.offset, own.gamma]
                .iter()
                .for_each(|value| out.extend(value.to_be_bytes()));
            out.extend([0; 2]);
            one(b"expA", out)
        }
        A::Vibrance(own) => {
            let mut said = DescriptorWriter::default();
            said.whole("vibrance", own.vibrance);
            said.whole("Strt", own.saturation);
            one(b"vibA", said.into_bytes())
        }
        // A table needs a profile that says the same, which this program does not make.
        A::ColorLookup(_) => Vec::new(),
    }
}

/// A whole number of 16 bits.
fn number(out: &mut Vec<u8>, value: f32) {
    out.extend((value.round() as i16).to_be_bytes());
}

fn numbers(out: &mut Vec<u8>, values: &[f32]) {
    values.iter().for_each(|value| number(out, *value));
}

fn pad(value: f32) -> Vec<u8> {
    let mut out = Vec::new();
    number(&mut out, value);
    out.extend([0; 2]);
    out
}

/// As many ranges as Photoshop writes.
fn levels(own: &Levels) -> Vec<u8> {
    const RANGES: usize = 29;
    let mut out = 2u16.to_be_bytes().to_vec();
    let used = std::iter::once(own.master).chain(own.channels);
    for range in used.chain(std::iter::repeat(Default::default())).take(RANGES) {
        numbers(&mut out, &[range.black, range.white, range.out_black, range.out_white]);
        number(&mut out, 100.0 * range.gamma);
    }
    out
}

fn curves(own: &Curves) -> Vec<u8> {
    let all = std::iter::once(&own.master).chain(&own.channels);
    let used: Vec<(u16, &ToneCurve)> = (0..).zip(all).filter(|(_, c)| !c.is_straight()).collect();
    let points = |out: &mut Vec<u8>, curve: &ToneCurve| {
        out.extend((curve.points().len() as u16).to_be_bytes());
        // The tone after comes first.
        curve.points().iter().for_each(|[before, after]| numbers(out, &[*after, *before]));
    };
    let mut out = vec![0];
    out.extend(1u16.to_be_bytes());
    let bits = used.iter().fold(0, |bits, (channel, _)| bits | 1u32 << channel);
    out.extend(bits.to_be_bytes());
    used.iter().for_each(|(_, curve)| points(&mut out, curve));
    out.extend(b"Crv ");
    out.extend(4u16.to_be_bytes());
    out.extend((used.len() as u32).to_be_bytes());
    for (channel, curve) in used {
        out.extend(channel.to_be_bytes());
        points(&mut out, curve);
    }
    out
}

/// The old numbers, and the newer ones, which count.
fn brightness(own: &BrightnessContrast) -> Vec<Block> {
    const MIDDLE: f32 = 127.0;
    let mut old = Vec::new();
    numbers(&mut old, &[own.brightness, own.contrast, MIDDLE]);
    old.extend([0; 2]);
    let mut newer = DescriptorWriter::default();
    newer.whole("Vrsn", 1.0);
    newer.whole("Brgh", own.brightness);
    newer.whole("Cntr", own.contrast);
    newer.whole("means", MIDDLE);
    newer.flag("Lab ", false);
    newer.flag("useLegacy", own.legacy);
    newer.flag("Auto", false);
    vec![(*b"brit", old), (super::NEWER, newer.into_bytes())]
}

fn hue_saturation(own: &HueSaturation) -> Vec<u8> {
    let shift = |out: &mut Vec<u8>, shift: &HslShift| {
        numbers(out, &[shift.hue, shift.saturation, shift.lightness]);
    };
    let mut out = 2u16.to_be_bytes().to_vec();
    out.extend([u8::from(own.colorize), 0]);
    let hue = if own.tint.hue > 180.0 { own.tint.hue - 360.0 } else { own.tint.hue };
    shift(&mut out, &HslShift { hue, ..own.tint });
    shift(&mut out, &own.master);
    for range in &own.ranges {
        numbers(&mut out, &range.angles);
        shift(&mut out, &range.shift);
    }
    out
}

fn black_white(own: &BlackWhite) -> Vec<u8> {
    let mut out = DescriptorWriter::default();
    for (name, weight) in super::HUES.into_iter().zip(own.weights) {
        out.whole(name, weight);
    }
    out.flag("useTint", own.is_tinted);
    out.color("tintColor", own.color);
    // One that the user made.
    out.whole("bwPresetKind", 3.0);
    out.into_bytes()
}

/// RGB, then four numbers of 16 bits.
fn color(out: &mut Vec<u8>, color: Color) {
    out.extend(0u16.to_be_bytes());
    for byte in [color.r, color.g, color.b] {
        out.extend((u16::from(byte) * 257).to_be_bytes());
    }
    out.extend([0; 2]);
}

fn photo_filter(own: &PhotoFilter) -> Vec<u8> {
    let mut out = 2u16.to_be_bytes().to_vec();
    color(&mut out, own.color);
    out.extend((own.density.round() as u32).to_be_bytes());
    out.extend([u8::from(own.keep_luminosity), 0, 0, 0]);
    out
}

fn channel_mixer(own: &ChannelMixer) -> Vec<u8> {
    let mut out = 1u16.to_be_bytes().to_vec();
    out.extend(u16::from(own.monochrome).to_be_bytes());
    let outputs = if own.monochrome { [own.gray, [0.0; 4], [0.0; 4]] } else { own.outputs };
    for [r, g, b, constant] in outputs.into_iter().chain([[0.0; 4]]) {
        numbers(&mut out, &[r, g, b, 0.0, constant]);
    }
    out
}

fn selective_color(own: &SelectiveColor) -> Vec<u8> {
    let mut out = 1u16.to_be_bytes().to_vec();
    out.extend(u16::from(own.absolute).to_be_bytes());
    out.extend([0; 8]);
    own.ranges.iter().for_each(|inks| numbers(&mut out, inks));
    out
}

/// Classic, smooth, of solid colors.
fn gradient_map(own: &GradientMap) -> Vec<u8> {
    const WHOLE: f32 = 4096.0;
    const MIDDLE: u32 = 50;
    let place = |out: &mut Vec<u8>, stop: &GradientStop| {
        out.extend(((stop.t * WHOLE).round() as u32).to_be_bytes());
        out.extend(MIDDLE.to_be_bytes());
    };
    let mut out = 1u16.to_be_bytes().to_vec();
    out.extend([u8::from(own.reverse), 0]);
    // No name.
    out.extend(0u32.to_be_bytes());
    let count = (own.stops.len() as u16).to_be_bytes();
    out.extend(count);
    for stop in &own.stops {
        place(&mut out, stop);
        color(&mut out, stop.color);
        out.extend([0; 2]);
    }
    out.extend(count);
    for stop in &own.stops {
        place(&mut out, stop);
        out.extend(u16::from(stop.color.a).to_be_bytes());
    }
    // Straight between stops, as here.
    const SMOOTHNESS: u16 = 0;
    for part in [2, SMOOTHNESS, 32, 0] {
        out.extend(u16::to_be_bytes(part));
    }
    // Of noise: a seed, no transparency, no restriction, roughness, RGB, from black to white.
    out.extend(0u32.to_be_bytes());
    out.extend([0; 4]);
    out.extend((WHOLE as u32 / 2).to_be_bytes());
    out.extend(3u16.to_be_bytes());
    out.extend([0; 8]);
    out.extend([0x80, 0].repeat(4));
    out.extend([0; 4]);
    out
}
