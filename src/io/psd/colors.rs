//! A file's channels of color, in any color mode, as straight sRGB. Floor 5. Not here: reading
//! the channels (`channel`), profiles of RGB and gray (`picture`).

use super::channel::ChannelValue;
use crate::math::{Size, cielab, srgb};
use crate::picture;
use moxcms::{ColorProfile, DataColorSpace, Layout, RenderingIntent, TransformOptions};

/// What the channels of a file mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    Bitmap,
    Gray,
    Indexed,
    Rgb,
    Cmyk,
    Multichannel,
    Duotone,
    Lab,
}

impl Mode {
    /// By its number in the header.
    pub fn of(number: u16) -> Option<Self> {
        let modes = [Mode::Bitmap, Mode::Gray, Mode::Indexed, Mode::Rgb, Mode::Cmyk];
        match number {
            7 => Some(Mode::Multichannel),
            8 => Some(Mode::Duotone),
            9 => Some(Mode::Lab),
            _ => modes.get(usize::from(number)).copied(),
        }
    }

    /// Channels of color, at least.
    pub fn channels(self) -> u16 {
        match self {
            Mode::Bitmap | Mode::Gray | Mode::Indexed | Mode::Duotone | Mode::Multichannel => 1,
            Mode::Rgb | Mode::Lab => 3,
            Mode::Cmyk => 4,
        }
    }
}

/// The colors of one file.
#[derive(Clone, Copy, Debug)]
pub struct Colors<'a> {
    pub mode: Mode,
    /// Channels of color that the file has, at most four.
    pub channels: usize,
    /// 32 bits a channel hold light, which no profile changes.
    pub is_light: bool,
    /// Its a and b of Lab have 16 bits, which run to 256.
    pub is_deep_lab: bool,
    /// All reds, all greens, all blues.
    pub table: &'a [u8],
    /// The color of the table that means transparent.
    pub nothing: Option<u8>,
    pub icc: Option<&'a [u8]>,
}

/// Straight sRGB, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StraightPixels {
    /// Four bytes a pixel.
    pub rgba: Vec<u8>,
    /// What the bytes were rounded from, if they were read as 16 bits; else empty.
    pub rgba16: Vec<[u16; 4]>,
}

/// A channel's value whose colors are known.
pub trait ColorValue: ChannelValue {
    /// As [`Colors::to_srgb`].
    fn pixels(
        colors: Colors,
        size: Size,
        planes: &[Option<Vec<Self>>; 4],
        alpha: Option<&[Self]>,
    ) -> StraightPixels;
}

impl ColorValue for u8 {
    fn pixels(
        colors: Colors,
        size: Size,
        planes: &[Option<Vec<u8>>; 4],
        alpha: Option<&[u8]>,
    ) -> StraightPixels {
        StraightPixels { rgba: colors.to_srgb(size, planes, alpha), rgba16: Vec::new() }
    }
}

impl ColorValue for u16 {
    fn pixels(
        colors: Colors,
        size: Size,
        planes: &[Option<Vec<u16>>; 4],
        alpha: Option<&[u16]>,
    ) -> StraightPixels {
        let rgba16 = colors.to_srgb16(size, planes, alpha);
        StraightPixels { rgba: rgba16.as_flattened().iter().map(|v| v.byte()).collect(), rgba16 }
    }
}

impl Colors<'_> {
    /// Of a mode, without profile or table.
    pub fn of_mode(mode: Mode) -> Self {
        let channels = usize::from(mode.channels());
        Self {
            mode,
            channels,
            is_light: false,
            is_deep_lab: false,
            table: &[],
            nothing: None,
            icc: None,
        }
    }

    /// As [`to_srgb`](Self::to_srgb), of RGB and gray, in 16 bits.
    fn to_srgb16(
        self,
        size: Size,
        planes: &[Option<Vec<u16>>; 4],
        alpha: Option<&[u16]>,
    ) -> Vec<[u16; 4]> {
        if planes.iter().all(Option::is_none) && alpha.is_none() {
            return vec![[0; 4]; size.area()];
        }
        let value = |c: usize, i: usize| {
            planes[c].as_ref().and_then(|plane| plane.get(i)).copied().unwrap_or(0)
        };
        let opacity = |i: usize| {
            alpha.map_or(u16::WHOLE, |alpha| alpha.get(i).copied().unwrap_or(u16::WHOLE))
        };
        let is_gray = self.mode == Mode::Gray;
        let color =
            |i: usize| if is_gray { [value(0, i); 3] } else { [0, 1, 2].map(|c| value(c, i)) };
        let texel = |i: usize| {
            let [r, g, b] = color(i);
            [r, g, b, opacity(i)]
        };
        let texels = (0..size.area()).map(texel).collect();
        match self.profile() {
            Some(icc) => picture::to_srgb16(size, texels, is_gray, icc),
            None => texels,
        }
    }

    /// Straight sRGB of planes; without alpha opaque, without a color channel black, without any
    /// transparent.
    pub fn to_srgb(
        self,
        size: Size,
        planes: &[Option<Vec<u8>>; 4],
        alpha: Option<&[u8]>,
    ) -> Vec<u8> {
        let area = size.area();
        if planes.iter().all(Option::is_none) && alpha.is_none() {
            return vec![0; area * 4];
        }
        let value = |c: usize, i: usize| {
            planes[c].as_ref().and_then(|plane| plane.get(i)).copied().unwrap_or(0)
        };
        let opacity = |i: usize| alpha.map_or(255, |alpha| alpha.get(i).copied().unwrap_or(255));
        let pixels = |color: &dyn Fn(usize) -> [u8; 3]| -> Vec<u8> {
            let mut rgba = Vec::with_capacity(area * 4);
            for i in 0..area {
                rgba.extend(color(i));
                rgba.push(opacity(i));
            }
            rgba
        };
        match self.mode {
            Mode::Bitmap | Mode::Duotone => pixels(&|i| [value(0, i); 3]),
            Mode::Multichannel if self.channels < 3 => pixels(&|i| [value(0, i); 3]),
            Mode::Gray => self.convert_by_profile(size, pixels(&|i| [value(0, i); 3])),
            Mode::Rgb => {
                self.convert_by_profile(size, pixels(&|i| [value(0, i), value(1, i), value(2, i)]))
            }
            Mode::Indexed => {
                let mut rgba = pixels(&|i| self.look_up(value(0, i)));
                let gone = |i: usize| self.nothing == Some(value(0, i));
                rgba.as_chunks_mut::<4>()
                    .0
                    .iter_mut()
                    .enumerate()
                    .filter(|(i, _)| gone(*i))
                    .for_each(|(_, p)| p[3] = 0);
                rgba
            }
            Mode::Lab => {
                pixels(&|i| lab_to_srgb([value(0, i), value(1, i), value(2, i)], self.is_deep_lab))
            }
            Mode::Cmyk | Mode::Multichannel => {
                // Stored as light: 255 is no ink.
                let ink = |i: usize| {
                    [
                        value(0, i),
                        value(1, i),
                        value(2, i),
                        if self.channels < 4 { 255 } else { value(3, i) },
                    ]
                };
                let press = self.icc.filter(|_| self.mode == Mode::Cmyk).and_then(Press::new);
                let mut rgba = pixels(&|i| ideal_press(ink(i)));
                if let Some(press) = press {
                    press.print(&mut rgba, ink);
                }
                rgba
            }
        }
    }

    /// Whether RGB or gray goes through a profile.
    pub fn has_profile(&self) -> bool {
        matches!(self.mode, Mode::Rgb | Mode::Gray) && self.profile().is_some()
    }

    /// The profile that RGB and gray go through.
    fn profile(&self) -> Option<&[u8]> {
        self.icc.filter(|icc| !self.is_light && !crate::icc_profiles::is_own_srgb(icc))
    }

    fn convert_by_profile(&self, size: Size, rgba: Vec<u8>) -> Vec<u8> {
        match self.profile() {
            Some(icc) => picture::to_srgb(size, rgba, self.mode == Mode::Gray, icc),
            None => rgba,
        }
    }

    /// A color of the table by its number; a number beyond the table is black.
    fn look_up(&self, number: u8) -> [u8; 3] {
        let (count, number) = (self.table.len() / 3, usize::from(number));
        [0, 1, 2].map(|c| {
            self.table.get(c * count + number).filter(|_| number < count).copied().unwrap_or(0)
        })
    }
}

/// Ink on white, as if it were printed by an ideal press; each value is the light that the ink lets
/// through.
fn ideal_press([c, m, y, k]: [u8; 4]) -> [u8; 3] {
    [c, m, y].map(|ink| ((u32::from(ink) * u32::from(k) + 127) / 255) as u8)
}

/// CIE Lab of D50 in bytes, a and b about 128, as sRGB bytes.
fn lab_to_srgb(lab: [u8; 3], is_deep: bool) -> [u8; 3] {
    let linear = lab_to_linear(lab.map(|v| f32::from(v) / 255.0), is_deep);
    linear.map(|v| srgb::quantize(srgb::encode(v.max(0.0))))
}

/// The light of sRGB of CIE Lab whose values are parts of 1.
///
/// * `is_deep`: a and b run to 256 less 128, as 16 bits hold them, and not to 255.
pub fn lab_to_linear([l, a, b]: [f32; 3], is_deep: bool) -> [f32; 3] {
    let most = if is_deep { 256.0 } else { 255.0 };
    cielab::to_linear([l * 100.0, a * most - 128.0, b * most - 128.0])
}

/// A profile of four inks, made ready.
pub struct Press {
    transform: std::sync::Arc<moxcms::Transform16BitExecutor>,
    /// The inks of colors.
    separation: Option<std::sync::Arc<moxcms::Transform16BitExecutor>>,
    /// The light that the press's black still reflects: it becomes none, as Photoshop shows it
    /// (black point compensation).
    black: f32,
}

impl Press {
    /// `None` where the profile is of other colors, or cannot be used.
    pub fn new(icc: &[u8]) -> Option<Self> {
        let profile = ColorProfile::new_from_slice(icc)
            .ok()
            .filter(|p| p.color_space == DataColorSpace::Cmyk)?;
        let screen = ColorProfile::new_srgb();
        let by =
            |rendering_intent| TransformOptions { rendering_intent, ..TransformOptions::default() };
        let seen = by(RenderingIntent::RelativeColorimetric);
        let transform =
            profile.create_transform_16bit(Layout::Rgba, &screen, Layout::Rgb, seen).ok()?;
        let separation =
            screen.create_transform_16bit(Layout::Rgb, &profile, Layout::Rgba, seen).ok();
        let mut press = Self { transform, separation, black: 0.0 };
        press.black =
            press.blackest(&profile, &screen, by(RenderingIntent::Perceptual)).unwrap_or(0.0);
        Some(press)
    }

    /// The light of what the profile prints for black.
    fn blackest(
        &self,
        profile: &ColorProfile,
        screen: &ColorProfile,
        options: TransformOptions,
    ) -> Option<f32> {
        let printed =
            screen.create_transform_16bit(Layout::Rgb, profile, Layout::Rgba, options).ok()?;
        let (mut inks, mut rgb) = ([0; 4], [0; 3]);
        printed.transform(&[0; 3], &mut inks).ok()?;
        self.transform.transform(&inks, &mut rgb).ok()?;
        let [r, g, b] = rgb.map(|v| srgb::decode(f32::from(v) / 65535.0));
        // Beyond this it is not black.
        Some(srgb::luminance(r, g, b).max(0.0).min(0.18))
    }

    /// The light that each ink lets through where colors of encoded sRGB are printed.
    pub fn separate(&self, colors: &[[f32; 3]]) -> Option<Vec<[f32; 4]>> {
        let stored = |v: f32| {
            let light = srgb::decode(v) * (1.0 - self.black) + self.black;
            srgb::quantize16(srgb::encode(light))
        };
        let colors: Vec<u16> = colors.as_flattened().iter().map(|v| stored(*v)).collect();
        let mut inks = vec![0; colors.len() / 3 * 4];
        self.separation.as_ref()?.transform(&colors, &mut inks).ok()?;
        let light = |ink: u16| 1.0 - f32::from(ink) / 65535.0;
        Some(inks.as_chunks::<4>().0.iter().map(|inks| inks.map(light)).collect())
    }

    /// The encoded sRGB of the light that inks let through.
    pub fn show(&self, light: &[[f32; 4]]) -> Option<Vec<[f32; 3]>> {
        let inks: Vec<u16> =
            light.as_flattened().iter().map(|v| srgb::quantize16(1.0 - v)).collect();
        let mut rgb = vec![0; light.len() * 3];
        self.transform.transform(&inks, &mut rgb).ok()?;
        let color = |v: u16| srgb::encode(self.remove_black(v));
        Some(rgb.as_chunks::<3>().0.iter().map(|rgb| rgb.map(color)).collect())
    }

    /// Light of what the press shows, its black taken as none.
    fn remove_black(&self, v: u16) -> f32 {
        let light = (srgb::decode(f32::from(v) / 65535.0) - self.black) / (1.0 - self.black);
        light.max(0.0)
    }

    /// Puts the inks' colors into straight pixels, some thousand at a time.
    fn print(&self, rgba: &mut [u8], ink: impl Fn(usize) -> [u8; 4]) {
        const AT_ONCE: usize = 4096;
        let light = |v: u16| srgb::quantize(srgb::encode(self.remove_black(v)));
        for (part, pixels) in rgba.chunks_mut(AT_ONCE * 4).enumerate() {
            let count = pixels.len() / 4;
            let share = |light: u8| u16::from(255 - light) * 257;
            let inks: Vec<u16> =
                (0..count).flat_map(|i| ink(part * AT_ONCE + i).map(share)).collect();
            let mut rgb = vec![0; count * 3];
            if self.transform.transform(&inks, &mut rgb).is_ok() {
                for (pixel, color) in
                    pixels.as_chunks_mut::<4>().0.iter_mut().zip(rgb.as_chunks::<3>().0)
                {
                    pixel[..3].copy_from_slice(&color.map(light));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn colors(mode: Mode, channels: usize) -> Colors<'static> {
        Colors {
            mode,
            channels,
            is_light: false,
            is_deep_lab: false,
            table: &[],
            nothing: None,
            icc: None,
        }
    }

    fn one(colors: &Colors, values: [u8; 4]) -> [u8; 4] {
        let planes = values.map(|v| Some(vec![v]));
        colors.to_srgb(Size::new(1, 1), &planes, Some(&[200])).try_into().unwrap()
    }

    #[test]
    fn every_mode_gives_the_colors_it_means() {
        assert_eq!(one(&colors(Mode::Bitmap, 1), [255, 0, 0, 0]), [255, 255, 255, 200]);
        assert_eq!(one(&colors(Mode::Rgb, 3), [1, 2, 3, 0]), [1, 2, 3, 200]);
        assert_eq!(
            one(&colors(Mode::Cmyk, 4), [255, 0, 255, 128]),
            [128, 0, 128, 200],
            "magenta and half black"
        );
        assert_eq!(
            one(&colors(Mode::Multichannel, 3), [255, 0, 255, 0]),
            [255, 0, 255, 200],
            "no black ink"
        );
        let table =
            Colors { table: &[9, 8, 7, 6, 5, 4], nothing: Some(1), ..colors(Mode::Indexed, 1) };
        assert_eq!(one(&table, [0; 4]), [9, 7, 5, 200]);
        assert_eq!(one(&table, [1; 4])[3], 0, "the color that stands for nothing");
        assert_eq!(one(&table, [2; 4])[..3], [0; 3], "beyond the table");
    }

    #[test]
    fn lab_is_read_in_the_connection_space_s_white() {
        assert_eq!(one(&colors(Mode::Lab, 3), [255, 128, 128, 0])[..3], [255; 3]);
        assert_eq!(one(&colors(Mode::Lab, 3), [0, 128, 128, 0])[..3], [0; 3]);
        // L 53.24, a 80.09, b 67.2 under D65 is pure red; under D50 54.29, 80.8, 69.9.
        let red = one(&colors(Mode::Lab, 3), [138, 209, 198, 0]);
        assert!(red[0] > 250 && red[1] < 12 && red[2] < 12, "{red:?}");
        // The same of 16 bits, in bytes: 208.8 and 197.9 of 256.
        let deep = Colors { is_deep_lab: true, ..colors(Mode::Lab, 3) };
        let [r, g, b, _] = one(&deep, [138, 208, 197, 0]);
        assert!(r > 250 && g < 12 && b < 12, "{:?}", [r, g, b]);
    }
}
