//! Colors of other spaces as sRGB, and a palette that is being read. Floor 5. Colors that are only
//! approximately the same are counted, and noted once.

use super::ImportedPalette;
use crate::math::srgb::{self, Color};
use crate::math::{cielab, hsv};
use crate::paint::color_palette::tidy_name;
use crate::paint::{ColorPalette, NamedColor};
use crate::{Error, Result};
use std::path::Path;

/// A color as a file says it.
#[derive(Clone, Copy, Debug)]
pub enum SwatchColor {
    /// Encoded sRGB.
    Rgb([f32; 3]),
    /// Encoded, of a space that is not known to be sRGB.
    OtherRgb([f32; 3]),
    /// Linear light of sRGB's primaries.
    Light([f32; 3]),
    /// Hue in turns, saturation, brightness.
    Hsb([f32; 3]),
    /// Ink: 1 is all of it.
    Cmyk([f32; 4]),
    /// CIE Lab of D50, L to 100.
    Lab([f32; 3]),
    /// Encoded; 1 is white.
    Gray(f32),
}

impl SwatchColor {
    /// Encoded sRGB; may lie outside `[0, 1]`.
    fn to_srgb(self) -> [f32; 3] {
        match self {
            SwatchColor::Rgb(rgb) | SwatchColor::OtherRgb(rgb) => rgb,
            SwatchColor::Light(rgb) => rgb.map(srgb::encode),
            SwatchColor::Hsb(color) => hsv::to_rgb(color),
            // Each ink lets through what it does not cover, as an ideal press prints.
            SwatchColor::Cmyk([c, m, y, k]) => [c, m, y].map(|ink| (1.0 - ink) * (1.0 - k)),
            SwatchColor::Lab(lab) => cielab::to_linear(lab).map(srgb::encode),
            SwatchColor::Gray(v) => [v; 3],
        }
    }
}

/// A palette that is being read.
pub struct SwatchReader<'a> {
    /// For messages.
    pub file: &'a Path,
    palette: ColorPalette,
    inks: usize,
    other_rgb: usize,
    clipped: usize,
    skipped: usize,
}

impl<'a> SwatchReader<'a> {
    pub fn new(file: &'a Path) -> Self {
        let palette = ColorPalette::default();
        Self { file, palette, inks: 0, other_rgb: 0, clipped: 0, skipped: 0 }
    }

    /// What the file says that the palette is called.
    pub fn name(&mut self, name: &str) {
        self.palette.name = tidy_name(name);
    }

    /// How many colors stand in a row; as many as there is room for if that is none or too many.
    pub fn columns(&mut self, columns: u32) {
        self.palette.columns = if columns <= ColorPalette::MOST_COLUMNS { columns } else { 0 };
    }

    /// How many colors were added.
    pub fn count(&self) -> usize {
        self.palette.colors.len()
    }

    /// Adds a color. Fails where there are too many.
    pub fn add(&mut self, color: SwatchColor, name: &str) -> Result<()> {
        if self.palette.colors.len() >= ColorPalette::MOST {
            let reason = format!("a palette may have {} colors", ColorPalette::MOST);
            return Err(Error::too_large(self.file, reason));
        }
        match color {
            SwatchColor::Cmyk(_) => self.inks += 1,
            SwatchColor::OtherRgb(_) => self.other_rgb += 1,
            _ => {}
        }
        let rgb = color.to_srgb();
        /// What rounding to a byte hides.
        const HALF: f32 = 0.5 / 255.0;
        self.clipped += usize::from(!rgb.iter().all(|v| (-HALF..=1.0 + HALF).contains(v)));
        let [r, g, b] = rgb.map(srgb::quantize);
        self.palette.colors.push(NamedColor::new(Color::rgb(r, g, b), name));
        Ok(())
    }

    /// A color that cannot be read.
    pub fn skip(&mut self) {
        self.skipped += 1;
    }

    pub fn refusal(&self, reason: impl ToString) -> Error {
        Error::decode(self.file, reason)
    }

    pub fn finish(self) -> ImportedPalette {
        let Self { file, mut palette, inks, other_rgb, clipped, skipped } = self;
        if palette.name.is_empty() {
            palette.name = tidy_name(&file.file_stem().unwrap_or_default().to_string_lossy());
        }
        let count = |count: usize, one: &str, several: &str| {
            if count == 1 {
                format!("One color {one}")
            } else {
                format!("{count} colors {several}")
            }
        };
        let mut notes = Vec::new();
        if inks > 0 {
            let what = count(inks, "is a mix of inks (CMYK)", "are mixes of inks (CMYK)");
            notes.push(format!("{what}, which are approximate here: as an ideal press prints"));
        }
        if other_rgb > 0 {
            let what = count(other_rgb, "is of", "are of");
            notes.push(format!("{what} another RGB space than sRGB, and approximate here"));
        }
        if clipped > 0 {
            let what = count(clipped, "lies beyond", "lie beyond");
            notes.push(format!("{what} sRGB, and became the nearest there"));
        }
        if skipped > 0 {
            let what = count(skipped, "is", "are");
            notes.push(format!("{what} of an unknown kind and left out"));
        }
        ImportedPalette { palette, notes }
    }
}

/// Bytes as text: UTF-8, or Latin-1 if they are not.
pub fn text_of(bytes: &[u8]) -> String {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|b| char::from(*b)).collect(),
    }
}

/// UTF-16 in big-endian bytes as text, up to its NUL.
pub fn text_of_utf16(bytes: &[u8]) -> String {
    let units: Vec<u16> =
        bytes.as_chunks().0.iter().map(|unit| u16::from_be_bytes(*unit)).collect();
    String::from_utf16_lossy(units.split(|unit| *unit == 0).next().unwrap_or_default())
}

/// Text as UTF-16 in big-endian units, with a NUL.
pub fn utf16_of(text: &str) -> Vec<u16> {
    text.encode_utf16().chain([0]).collect()
}
