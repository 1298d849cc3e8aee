//! Palettes in the files of other programs, told apart by their content. Floor 5.
//!
//! | file | |
//! |---|---|
//! | `gpl` | GIMP, and most others: text |
//! | `photoshop` | Photoshop's swatches (`.aco`) and color tables (`.act`) |
//! | `ase` | Adobe's swatch exchange |
//! | `pal` | Windows (RIFF) and Paint Shop Pro (text) |
//! | `kpl` | Krita: a zip with XML |
//! | `swatch` | colors of other spaces as sRGB |

#![warn(missing_docs)]

mod ase;
mod gpl;
mod kpl;
mod pal;
mod photoshop;
mod swatch;
#[cfg(test)]
mod tests;

use super::Budget;
use super::project::Archive;
use crate::paint::ColorPalette;
use crate::{Error, Result};
use std::path::Path;
use swatch::SwatchReader;

rilievo_engine::named! {
    /// The formats of palettes.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum PaletteFormat {
        Gimp = "gpl" => "GIMP (.gpl)",
        Swatches = "aco" => "Photoshop swatches (.aco)",
        ColorTable = "act" => "Photoshop color table (.act)",
        Exchange = "ase" => "Adobe swatch exchange (.ase)",
        PaintShop = "jasc" => "Paint Shop Pro (.pal)",
        Windows = "riff" => "Windows (.pal)",
        KritaPalette = "kpl" => "Krita (.kpl)",
    }
}

impl PaletteFormat {
    /// The endings of all files of palettes.
    pub const EXTENSIONS: [&'static str; 6] = ["gpl", "aco", "act", "ase", "pal", "kpl"];

    /// The ending of its files.
    pub fn extension(self) -> &'static str {
        match self {
            PaletteFormat::PaintShop | PaletteFormat::Windows => "pal",
            other => other.name(),
        }
    }

    /// The format of a file to be written, by its ending; `.pal` is Paint Shop Pro's.
    pub fn of_extension(file: &Path) -> Option<Self> {
        let extension = file.extension()?.to_string_lossy().to_lowercase();
        let mut formats = Self::ALL.into_iter().map(|(format, _)| format);
        formats.find(|format| format.extension() == extension)
    }

    /// Recognizes a file by its content.
    pub fn of_content(bytes: &[u8]) -> Option<Self> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        if text.starts_with(b"GIMP Palette") {
            return Some(PaletteFormat::Gimp);
        }
        if text.starts_with(b"JASC-PAL") {
            return Some(PaletteFormat::PaintShop);
        }
        if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"PAL ") {
            return Some(PaletteFormat::Windows);
        }
        if bytes.starts_with(b"ASEF") {
            return Some(PaletteFormat::Exchange);
        }
        if Archive::is_zip(bytes) {
            return Some(PaletteFormat::KritaPalette);
        }
        if photoshop::is_color_table(bytes) {
            return Some(PaletteFormat::ColorTable);
        }
        photoshop::is_swatches(bytes).then_some(PaletteFormat::Swatches)
    }
}

/// A palette that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedPalette {
    /// Named as the file says, else as the file.
    pub palette: ColorPalette,
    /// Sentences about colors that could not be carried over exactly, without full stops.
    pub notes: Vec<String>,
}

/// Reads a palette. Fails with a sentence if the file has none of these formats, is damaged, or has
/// more colors than a palette may.
pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<ImportedPalette> {
    let mut reader = SwatchReader::new(file);
    match PaletteFormat::of_content(bytes) {
        Some(PaletteFormat::Gimp) => gpl::read(&mut reader, bytes)?,
        Some(PaletteFormat::Swatches) => photoshop::read_swatches(&mut reader, bytes)?,
        Some(PaletteFormat::ColorTable) => photoshop::read_color_table(&mut reader, bytes)?,
        Some(PaletteFormat::Exchange) => ase::read(&mut reader, bytes)?,
        Some(PaletteFormat::PaintShop) => pal::read_text(&mut reader, bytes)?,
        Some(PaletteFormat::Windows) => pal::read_riff(&mut reader, bytes)?,
        Some(PaletteFormat::KritaPalette) => kpl::read(&mut reader, bytes, budget)?,
        None => {
            let reason = "it is no palette of GIMP, Krita, Photoshop, Paint Shop Pro or Windows";
            return Err(Error::unsupported_file(file, reason));
        }
    }
    Ok(reader.finish())
}

/// The bytes of a palette's file. Fails if the format cannot hold as many colors.
pub fn write(file: &Path, palette: &ColorPalette, format: PaletteFormat) -> Result<Vec<u8>> {
    Ok(match format {
        PaletteFormat::Gimp => gpl::write(palette).into_bytes(),
        PaletteFormat::Swatches => photoshop::write_swatches(palette),
        PaletteFormat::ColorTable => photoshop::write_color_table(file, palette)?,
        PaletteFormat::Exchange => ase::write(palette),
        PaletteFormat::PaintShop => pal::write_text(palette).into_bytes(),
        PaletteFormat::Windows => pal::write_riff(palette),
        PaletteFormat::KritaPalette => kpl::write(file, palette)?,
    })
}
