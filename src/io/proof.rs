//! Soft proofs: how the colors of a picture look once a press or another screen, whose ICC profile is
//! known, has shown them, and which of them it cannot show. Floor 5.
//!
//! Colors go to the profile and back by relative colorimetric intent, with black point compensation
//! for presses (ICC.1:2022, 6.2 and 6.3.3). A table holds the way of 33³ colors; those in between are
//! interpolated in tetrahedra (Kasson et al. 1995).

use crate::math::{oklch, vec3};
use crate::psd::Press;
use crate::{Error, Result};
use moxcms::{ColorProfile, DataColorSpace, Layout, RenderingIntent, TransformOptions};
use std::path::Path;

/// Colors along each side of the table.
const SIDE: usize = 33;
/// The largest profile that is read, bytes.
pub const LARGEST_BYTES: u64 = 32 << 20;
/// A color that comes back farther off than this, in OKLab, cannot be shown: about two steps that
/// the eye tells apart.
const FAR: f32 = 0.04;

/// What becomes of each color.
#[derive(Debug)]
pub struct ProofTable {
    /// Encoded sRGB as shown, and how far that is from the color, in OKLab; red first.
    values: Vec<[f32; 4]>,
}

impl ProofTable {
    /// Reads a profile. Fails with a sentence if it is none, or has no colors of screens or presses.
    pub fn read(file: &Path, icc: &[u8]) -> Result<Self> {
        let damaged = |_| Error::decode(file, "it is not an ICC profile");
        let profile = ColorProfile::new_from_slice(icc).map_err(damaged)?;
        let colors = grid();
        let shown = match profile.color_space {
            DataColorSpace::Cmyk => Press::new(icc).and_then(|press| {
                let light = press.separate(&colors)?;
                press.show(&light)
            }),
            DataColorSpace::Rgb => show_on(&profile, Layout::Rgb, &colors),
            DataColorSpace::Gray => show_on(&profile, Layout::Gray, &colors),
            _ => None,
        };
        let shown = shown.filter(|shown| shown.len() == colors.len());
        let shown = shown.ok_or_else(|| {
            let reason = "its colors are not red, green and blue, gray, or four inks, both ways";
            Error::unsupported_file(file, reason)
        })?;
        let value = |(color, shown): (&[f32; 3], [f32; 3])| {
            let [r, g, b] = shown.map(|v| v.max(0.0).min(1.0));
            [r, g, b, distance(*color, [r, g, b])]
        };
        Ok(Self { values: colors.iter().zip(shown).map(value).collect() })
    }

    /// A premultiplied texel as it is shown.
    ///
    /// * `mark`: the color of what cannot be shown, if that is to be seen.
    pub fn show(&self, [r, g, b, a]: [u8; 4], mark: Option<[u8; 3]>) -> [u8; 4] {
        if a == 0 {
            return [0; 4];
        }
        let alpha = f32::from(a);
        let [sr, sg, sb, far] = self.at([r, g, b].map(|v| (f32::from(v) / alpha).min(1.0)));
        let straight = match mark.filter(|_| far > FAR) {
            Some(mark) => mark.map(|v| f32::from(v) / 255.0),
            None => [sr, sg, sb],
        };
        let [r, g, b] = straight.map(|v| (v * alpha).round() as u8);
        [r, g, b, a]
    }

    /// The table at a color, interpolated between the four corners of a tetrahedron.
    fn at(&self, color: [f32; 3]) -> [f32; 4] {
        const STEPS: [usize; 3] = [SIDE * SIDE, SIDE, 1];
        let (mut corner, mut shares) = (0, [(0.0f32, 0usize); 3]);
        for i in 0..3 {
            let place = color[i].max(0.0).min(1.0) * (SIDE - 1) as f32;
            let cell = (place as usize).min(SIDE - 2);
            corner += cell * STEPS[i];
            shares[i] = (place - cell as f32, STEPS[i]);
        }
        shares.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut value = self.values[corner].map(|v| v * (1.0 - shares[0].0));
        for i in 0..3 {
            corner += shares[i].1;
            let next = shares.get(i + 1).map_or(0.0, |share| share.0);
            for (sum, v) in value.iter_mut().zip(self.values[corner]) {
                *sum += v * (shares[i].0 - next);
            }
        }
        value
    }
}

/// Encoded sRGB at the table's places.
fn grid() -> Vec<[f32; 3]> {
    let level = |i: usize| i as f32 / (SIDE - 1) as f32;
    (0..SIDE.pow(3))
        .map(|i| [level(i / (SIDE * SIDE)), level(i / SIDE % SIDE), level(i % SIDE)])
        .collect()
}

/// Colors as a screen of a profile shows them; encoded sRGB.
fn show_on(profile: &ColorProfile, layout: Layout, colors: &[[f32; 3]]) -> Option<Vec<[f32; 3]>> {
    let screen = ColorProfile::new_srgb();
    let options = TransformOptions {
        rendering_intent: RenderingIntent::RelativeColorimetric,
        ..TransformOptions::default()
    };
    let there = screen.create_transform_f32(Layout::Rgb, profile, layout, options).ok()?;
    let back = profile.create_transform_f32(layout, &screen, Layout::Rgb, options).ok()?;
    let mut sent = vec![0.0; colors.len() * layout.channels()];
    there.transform(colors.as_flattened(), &mut sent).ok()?;
    // No screen shows more than all or less than nothing.
    sent.iter_mut().for_each(|v| *v = v.max(0.0).min(1.0));
    let mut shown = vec![0.0; colors.len() * 3];
    back.transform(&sent, &mut shown).ok()?;
    Some(shown.as_chunks().0.to_vec())
}

fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    let place = |color: [f32; 3]| {
        let [lightness, chroma, hue] = oklch::from_srgb(color);
        let (sin, cos) = (hue * std::f32::consts::TAU).sin_cos();
        vec3(lightness, chroma * cos, chroma * sin)
    };
    place(a).distance(place(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MARK: Option<[u8; 3]> = Some([128, 128, 128]);

    fn table(profile: &ColorProfile) -> ProofTable {
        ProofTable::read(Path::new("a.icc"), &profile.encode().unwrap()).unwrap()
    }

    #[test]
    fn a_screen_like_ours_and_a_wider_one_show_every_color() {
        for profile in [ColorProfile::new_srgb(), ColorProfile::new_display_p3()] {
            let table = table(&profile);
            for texel in
                [[255, 0, 0, 255], [0, 255, 0, 255], [12, 34, 56, 255], [255; 4], [0, 0, 0, 255]]
            {
                let shown = table.show(texel, MARK);
                let off = (0..4).map(|i| shown[i].abs_diff(texel[i])).max();
                assert!(off <= Some(2), "{texel:?} becomes {shown:?}");
            }
            // Half of a color is half of what it becomes.
            let half = table.show([100, 0, 20, 128], MARK);
            assert!(half[0].abs_diff(100) <= 1 && half[3] == 128, "{half:?}");
            assert_eq!(table.show([0; 4], MARK), [0; 4]);
        }
    }

    #[test]
    fn a_screen_of_grays_shows_grays_and_colors_are_marked() {
        let table = table(&ColorProfile::new_gray_with_gamma(2.2));
        for texel in [[255, 0, 0, 255], [20, 90, 200, 255]] {
            let [r, g, b, _] = table.show(texel, None);
            assert!(r.abs_diff(g) <= 2 && g.abs_diff(b) <= 2, "{texel:?} becomes {:?}", [r, g, b]);
            assert_eq!(table.show(texel, MARK), [128, 128, 128, 255]);
        }
        for v in [0u8, 40, 128, 255] {
            let shown = table.show([v, v, v, 255], Some([255, 0, 0]));
            assert!(shown[0].abs_diff(v) <= 3 && shown[1].abs_diff(v) <= 3, "{v}: {shown:?}");
        }
    }

    #[test]
    fn what_lies_between_the_places_of_the_table_is_interpolated() {
        let flat = ProofTable { values: grid().iter().map(|&[r, g, b]| [g, b, r, 0.0]).collect() };
        for color in [[0.013, 0.5, 0.77], [0.9, 0.2, 0.3], [0.31, 0.64, 0.32], [1.0, 1.0, 1.0]] {
            let [r, g, b, _] = flat.at(color);
            let off = [r - color[1], g - color[2], b - color[0]].map(f32::abs);
            assert!(off.iter().all(|off| *off < 1e-5), "{color:?}: {off:?}");
        }
    }

    #[test]
    fn what_is_no_profile_is_refused_with_a_sentence() {
        for bytes in [&b""[..], b"not a profile", &[0; 200]] {
            let refused = ProofTable::read(Path::new("a.icc"), bytes).unwrap_err().to_string();
            assert!(refused.ends_with("it is not an ICC profile"), "{refused}");
        }
    }
}
