//! `rilievo brush`: brushes of other programs as files of this one, and pictures of what a brush
//! paints. Floor 7.

use super::force::Force;
use super::{LimitArgs, messages};
use crate::io::export::{ExportOptions, OutputFile};
use crate::io::recipe::{BrushPreset, preset};
use crate::io::{Terms, brush, picture};
use crate::math::{ColorProfile, Size};
use crate::raster::{Picture, TileGrid};
use crate::session::{brushes, swatch};
use crate::{Error, Result};
use std::path::{Path, PathBuf};

/// Convert brushes of GIMP, Krita, MyPaint and Photoshop, or show what a brush paints
///
/// FROM is a brush file of another program, a preset (.json), or the key of a built-in brush.
#[derive(clap::Args)]
pub struct BrushArgs {
    /// The brush, or the collection of brushes, to read
    #[arg(value_name = "FROM")]
    from: PathBuf,
    /// A .json to write the brush to, with its pictures next to it, or a .png to show a stroke over
    /// a ball. Each brush of a collection gets a numbered file
    #[arg(value_name = "TO")]
    to: PathBuf,
    /// Side of the picture, in pixels
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(16..=4096))]
    side: u32,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    limits: LimitArgs,
}

pub fn run(args: &BrushArgs) -> Result<()> {
    args.limits.install(|| {
        let built_in = args.from.to_str().and_then(preset).filter(|_| !args.from.exists());
        let (brushes, reads) = match built_in {
            Some(preset) => (vec![(preset, Vec::new())], Vec::new()),
            None => {
                let brushes = brushes::read(&args.from, &args.limits.budget())?;
                let reads = brushes
                    .iter()
                    .flat_map(|(preset, _)| brush::pictures_beside(&args.from, preset));
                let reads = std::iter::once(args.from.clone()).chain(reads).collect();
                (brushes, reads)
            }
        };
        let terms = args.force.export(reads);
        let count = brushes.len();
        let mut made = Vec::new();
        for (i, (preset, notes)) in brushes.into_iter().enumerate() {
            notes.iter().for_each(|note| messages::print_line(&format!("{}: {note}", preset.name)));
            let to = if count == 1 { args.to.clone() } else { numbered_path(&args.to, i + 1) };
            made.push(ConvertedBrush::of(&to, &preset, args.side, &terms)?);
        }
        // Either all may be written, or none is.
        made.into_iter().try_for_each(|made| made.write(&terms))
    })
}

/// `set.json` as `set-3.json`.
fn numbered_path(file: &Path, number: usize) -> PathBuf {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let extension = file.extension().unwrap_or_default().to_string_lossy();
    file.with_file_name(format!("{stem}-{number}.{extension}"))
}

/// A converted brush, not written yet.
enum ConvertedBrush {
    Preset(Box<brush::Encoded>),
    Picture(OutputFile, TileGrid, Size),
}

impl ConvertedBrush {
    /// Fails if it may not be written.
    fn of(to: &Path, preset: &BrushPreset, side: u32, terms: &Terms) -> Result<Self> {
        let extension = to.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        if extension == "json" {
            let encoded = brush::encode(to, preset)?;
            encoded.check(terms)?;
            return Ok(ConvertedBrush::Preset(encoded.into()));
        }
        let target = OutputFile::new(to, terms.clone())?;
        let none = || Error::unsupported_file(to, "the brush cannot be shown");
        let (pixels, size) =
            (swatch::render_swatch(preset, side).ok_or_else(none)?, Size::new(side, side));
        let picture = Picture::srgb8(size, pixels.as_chunks().0.to_vec()).ok_or_else(none)?;
        Ok(ConvertedBrush::Picture(target, picture::to_tiles(&picture, 0, 0), size))
    }

    fn write(self, terms: &Terms) -> Result<()> {
        match self {
            ConvertedBrush::Preset(encoded) => encoded.write(terms),
            ConvertedBrush::Picture(target, tiles, size) => {
                target.write(&tiles, size, &ExportOptions::default(), ColorProfile::Srgb)
            }
        }
    }
}
