//! Adjustments of the inks of a CMYK file: as tables of sRGB, which the inks became. Floor 5.
//!
//! Photoshop adjusts each ink by itself. Which inks made a color follows from the file's profile,
//! as its colors were separated.

use super::colors::{Colors, Mode, Press};
use crate::math::srgb;
use crate::paint::ColorAdjustment;
use crate::paint::adjustment::{ColorLookup, ColorTable};

/// Entries along each side of a table.
const SIDE: usize = 33;
/// Tones of an ink that are adjusted, evenly spaced.
const TONES: usize = 1025;

/// The inks of evenly spaced colors.
pub struct InkTones {
    press: Press,
    /// The light that each ink lets through, red fastest.
    light: Vec<[f32; 4]>,
}

impl InkTones {
    /// `None` of other colors, and without a profile of inks.
    pub fn of(colors: &Colors) -> Option<Self> {
        let press = colors.icc.filter(|_| colors.mode == Mode::Cmyk).and_then(Press::new)?;
        let place = |i: usize| (i % SIDE) as f32 / (SIDE - 1) as f32;
        let color = |i: usize| [i, i / SIDE, i / SIDE / SIDE].map(place);
        let colors: Vec<[f32; 3]> = (0..SIDE * SIDE * SIDE).map(color).collect();
        let light = press.separate(&colors)?;
        Some(Self { press, light })
    }

    /// The same change of sRGB colors; `None` of what does not change each ink by itself.
    ///
    /// * `of_black`: what is done to black, if it is something else.
    pub fn lookup(
        &self,
        adjustment: &ColorAdjustment,
        of_black: Option<&ColorAdjustment>,
    ) -> Option<ColorLookup> {
        use ColorAdjustment as A;
        if !matches!(
            adjustment,
            A::Levels(_) | A::Curves(_) | A::BrightnessContrast(_) | A::Invert(_)
        ) {
            return None;
        }
        let of_ink = |ink: usize| -> Vec<f32> {
            let (by, channel) = match ink {
                3 => (of_black.unwrap_or(adjustment), 0),
                ink => (adjustment, ink),
            };
            let tone = |i: usize| by.color([i as f32 / (TONES - 1) as f32; 3])[channel];
            (0..TONES).map(tone).collect()
        };
        let tones = [0, 1, 2, 3].map(of_ink);
        let adjusted: Vec<[f32; 4]> = self
            .light
            .iter()
            .map(|light| std::array::from_fn(|ink| tone_at(&tones[ink], light[ink])))
            .collect();
        let shown = self.press.show(&adjusted)?;
        let values = shown.into_iter().flatten().map(srgb::quantize16).collect();
        let table = ColorTable::new(adjustment.label(), SIDE, false, values)?;
        Some(ColorLookup { table: Some(table) })
    }
}

fn tone_at(tones: &[f32], v: f32) -> f32 {
    let place = v.max(0.0).min(1.0) * (TONES - 1) as f32;
    let at = (place as usize).min(TONES - 2);
    tones[at] + (tones[at + 1] - tones[at]) * (place - at as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use moxcms::ColorProfile;

    #[test]
    fn other_colors_and_other_profiles_have_no_inks() {
        let icc = ColorProfile::new_display_p3().encode().unwrap();
        for mode in [Mode::Rgb, Mode::Cmyk] {
            let colors = Colors { icc: Some(&icc), ..Colors::of_mode(mode) };
            assert!(InkTones::of(&colors).is_none());
        }
    }
}
