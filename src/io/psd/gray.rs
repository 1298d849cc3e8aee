//! Adjustments of gray files whose values have a tone curve of their own: as tables of sRGB, which
//! the values became. Floor 5.
//!
//! Photoshop adjusts the values that the file stores, and exposure their light.

use super::colors::{ColorValue, Colors, Mode};
use crate::math::{Size, srgb};
use crate::paint::ColorAdjustment;
use crate::paint::adjustment::{ColorLookup, ColorTable, Exposure};

/// Values of a file that are looked at, evenly spaced.
const VALUES: usize = 4096;
/// Entries of a table: each byte hits one.
const ENTRIES: usize = 255 * 16 + 1;

/// What a file's gray values are in sRGB.
#[derive(Clone, Debug, PartialEq)]
pub struct GrayTones {
    /// Of evenly spaced values, rising.
    srgb: Vec<f32>,
    /// The file has more than bytes.
    is_deep: bool,
}

impl GrayTones {
    /// `None` where the values are sRGB already, or colors.
    pub fn of(colors: &Colors, bits: u16) -> Option<Self> {
        if colors.mode != Mode::Gray || !colors.has_profile() {
            return None;
        }
        let value = |i: usize| (i * 65535 / (VALUES - 1)) as u16;
        let planes = [Some((0..VALUES).map(value).collect()), None, None, None];
        let shown = u16::pixels(*colors, Size::new(VALUES as u32, 1), &planes, None);
        let mut least = 0.0f32;
        let rising = |pixel: &[u16; 4]| {
            least = least.max(f32::from(pixel[0]) / 65535.0);
            least
        };
        let srgb: Vec<f32> = shown.rgba16.iter().map(rising).collect();
        (srgb.len() == VALUES).then_some(Self { srgb, is_deep: bits > 8 })
    }

    /// The same change of sRGB values.
    pub fn lookup(&self, adjustment: &ColorAdjustment) -> Option<ColorLookup> {
        let entry = |i: usize| {
            let tone = self.adjusted(adjustment, i as f32 / (ENTRIES - 1) as f32);
            [srgb::quantize16(tone); 3]
        };
        let values = (0..ENTRIES).flat_map(entry).collect();
        let table = ColorTable::new(adjustment.label(), ENTRIES, true, values)?;
        Some(ColorLookup { table: Some(table) })
    }

    /// What an sRGB tone becomes.
    fn adjusted(&self, adjustment: &ColorAdjustment, tone: f32) -> f32 {
        if let ColorAdjustment::Exposure(Exposure { exposure, offset, gamma }) = adjustment {
            let light = srgb::decode(tone) * exposure.exp2() + offset;
            return srgb::encode(light.max(0.0).min(1.0).powf(1.0 / gamma));
        }
        let gray = self.gray(tone);
        let gray = if self.is_deep { gray } else { (255.0 * gray).round() / 255.0 };
        let after = match adjustment {
            // Of 16 bits, tones are not those of bytes.
            ColorAdjustment::Posterize(own) if self.is_deep => own.tone_of_16_bits(gray),
            all => all.color([gray; 3])[0],
        };
        self.tone(after)
    }

    /// The sRGB tone of a gray value.
    pub fn tone(&self, gray: f32) -> f32 {
        let place = gray.max(0.0).min(1.0) * (VALUES - 1) as f32;
        let at = (place as usize).min(VALUES - 2);
        let (low, high) = (self.srgb[at], self.srgb[at + 1]);
        low + (high - low) * (place - at as f32)
    }

    /// The gray value of an sRGB tone.
    fn gray(&self, tone: f32) -> f32 {
        let next = self.srgb.partition_point(|v| *v < tone).max(1).min(VALUES - 1);
        let (low, high) = (self.srgb[next - 1], self.srgb[next]);
        let share = if high > low { ((tone - low) / (high - low)).max(0.0).min(1.0) } else { 0.0 };
        ((next - 1) as f32 + share) / (VALUES - 1) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paint::adjustment::{Invert, Threshold};

    /// sRGB is the square root of the values.
    fn square_root(bits: u16) -> GrayTones {
        let srgb = (0..VALUES).map(|i| (i as f32 / (VALUES - 1) as f32).sqrt()).collect();
        GrayTones { srgb, is_deep: bits > 8 }
    }

    #[test]
    fn the_file_s_values_are_adjusted() {
        let invert = ColorAdjustment::Invert(Invert);
        for bits in [8, 16] {
            let table = square_root(bits).lookup(&invert).unwrap().table.unwrap();
            let [shown, ..] = table.color([0.5; 3]);
            assert!((shown - 0.75f32.sqrt()).abs() < 0.002, "{bits} bits: {shown}");
        }
        let threshold = ColorAdjustment::Threshold(Threshold { level: 64.0 });
        let table = square_root(8).lookup(&threshold).unwrap().table.unwrap();
        // A quarter is half of sRGB.
        assert_eq!([126.0, 129.0].map(|v| table.color([v / 255.0; 3])[0]), [0.0, 1.0]);
    }

    #[test]
    fn exposure_changes_light() {
        let twice = Exposure { exposure: 1.0, ..Exposure::default() };
        let table = square_root(8).lookup(&ColorAdjustment::Exposure(twice)).unwrap();
        let [shown, ..] = table.table.unwrap().color([srgb::encode(0.25); 3]);
        assert!((srgb::decode(shown) - 0.5).abs() < 1e-3);
    }

    #[test]
    fn colors_and_values_without_a_profile_need_no_table() {
        for mode in [Mode::Gray, Mode::Rgb, Mode::Cmyk] {
            assert_eq!(GrayTones::of(&Colors::of_mode(mode), 8), None);
        }
    }
}
