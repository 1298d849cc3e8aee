//! `rilievo convert`: from any file that can be opened to any that can be written.
//! Floor 7. Losses are reported. Not here: the formats themselves (`io`).

use super::force::Force;
use super::messages::print_notes;
use super::painted::{refuse_incomplete, scale_document};
use super::{LimitArgs, progress, values};
use crate::Result;
use crate::document::Document;
use crate::io::export::{ExportFormat, ExportOptions, Output, OutputFile, layers};
use crate::io::fs::Disk;
use crate::io::replace::{Terms, check};
use crate::io::{OpenedDocument, open, save};
use crate::math::{Rect, srgb::Color};
use std::path::{Path, PathBuf};

/// Convert between projects, Photoshop files, recipes and pictures
///
/// FROM and the pictures, maps and tips that it names are never overwritten. Other files are
/// replaced only with --force; the previous version of a project is kept as TO~.
#[derive(clap::Args)]
pub struct ConvertArgs {
    /// What to read: .ora, .psd, .json, or a picture
    #[arg(value_name = "FROM")]
    from: PathBuf,
    /// What to write: .ora, .psd, or a picture of everything visible (.png, .exr, .jpg, .webp,
    /// .tif)
    #[arg(value_name = "TO")]
    to: PathBuf,
    /// Size of the result relative to the canvas
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = values::scale)]
    scale: f32,
    /// Crop a picture to the surface
    #[arg(long)]
    crop_to_surface: bool,
    /// Write each layer to its own picture, with its number and name added to TO; in an .exr, to
    /// its own channels
    #[arg(long)]
    layers: bool,
    /// Bits per channel: 8 or 16 for a .png or .tif (default 8), 16 or 32 for an .exr (default 16)
    #[arg(long, value_name = "N", value_parser = values::depth)]
    bits: Option<u8>,
    /// Print resolution stored in a .png, in dots per inch
    #[arg(long, value_name = "N", value_parser = dots_per_inch)]
    dpi: Option<f32>,
    /// Background behind transparent parts, as #rrggbb
    #[arg(long, value_name = "COLOR", value_parser = values::color)]
    background: Option<Color>,
    /// Quality of a JPEG, 1 to 100
    #[arg(long, value_name = "N", default_value_t = ExportOptions::default().quality,
          value_parser = clap::value_parser!(u8).range(1..=100))]
    quality: u8,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    limits: LimitArgs,
}

fn dots_per_inch(text: &str) -> std::result::Result<f32, String> {
    let dots = text.parse().ok().filter(|dots| (1.0..=100_000.0).contains(dots));
    dots.ok_or_else(|| "a resolution is a number between 1 and 100000".to_owned())
}

pub fn run(args: &ConvertArgs) -> Result<()> {
    args.limits.install(|| {
        let output = Output::of(&args.to)?;
        let OpenedDocument { document, notes, reads, .. } =
            open(&args.from, &args.limits.budget())?;
        let terms = terms(args, output, reads);
        let document = scale_document(&args.from, args.scale, &args.limits, document)?;
        args.limits.room_to_paint(&args.from, &document)?;
        match output {
            Output::Project | Output::Psd => {
                check(&Disk, &args.to, &terms)?;
                whole(&args.to, &document, &terms)?;
            }
            Output::Picture(format) => {
                refuse_incomplete(&args.from, &document)?;
                picture(args, &document, format, terms)?;
            }
        }
        // Notes would only hide an error.
        print_notes(&args.from, &notes);
        Ok(())
    })
}

fn terms(args: &ConvertArgs, output: Output, reads: Vec<PathBuf>) -> Terms {
    match output {
        Output::Project => args.force.project(reads),
        Output::Psd | Output::Picture(_) => args.force.export(reads),
    }
}

/// The document with all that the format can hold.
fn whole(to: &Path, document: &Document, terms: &Terms) -> Result<()> {
    progress::run_with_progress(|progress| {
        // Nothing here cancels, so it is always saved.
        let Some(encoded) = save::encode(document, to, progress)? else { return Ok(()) };
        encoded.save(to, terms, progress)?;
        print_notes(to, &encoded.notes);
        Ok(())
    })
}

fn picture(
    args: &ConvertArgs,
    document: &Document,
    format: ExportFormat,
    terms: Terms,
) -> Result<()> {
    let crop = args.crop_to_surface.then(|| covered_rect(document)).flatten();
    let options = ExportOptions {
        background: args.background,
        quality: args.quality,
        dots_per_inch: args.dpi,
        crop,
        bits: args.bits,
        profile: None,
    };
    // Checked before the work of painting.
    let bits = format.bits(&args.to, args.bits)?;
    let budget = args.limits.budget();
    let is_exr = format == ExportFormat::Exr;
    if args.layers && !is_exr {
        return each_layer(args, document, &options, &terms);
    }
    let target = OutputFile::new(&args.to, terms)?;
    if args.layers {
        let bytes = progress::run_with_progress(|progress| {
            layers::encode(&args.to, document, bits, &budget, progress)
        })?;
        return target.replace(&bytes.unwrap_or_default());
    }
    progress::run_with_progress(|progress| {
        target.write_document(document, &options, &budget, progress)
    })
}

/// Every layer with pixels, hidden ones too, by a name made from the requested one:
/// `out-00-sky.png`. None if one of them would replace a file that must stay.
fn each_layer(
    args: &ConvertArgs,
    document: &Document,
    options: &ExportOptions,
    terms: &Terms,
) -> Result<()> {
    let stem = args.to.file_stem().unwrap_or_default().to_string_lossy();
    let extension = args.to.extension().unwrap_or_default().to_string_lossy();
    let mut targets = Vec::new();
    for (i, (_, layer)) in document.walk().into_iter().enumerate() {
        if !layer.content.has_pixels() {
            continue;
        }
        let plain = |c: char| if c.is_alphanumeric() || "-_".contains(c) { c } else { '-' };
        let name: String = layer.name.chars().take(60).map(plain).collect();
        let file = args.to.with_file_name(format!("{stem}-{i:02}-{name}.{extension}"));
        targets.push((OutputFile::new(&file, terms.clone())?, layer.id));
    }
    for (target, layer) in targets {
        let Some(alone) = document.with_only(&[layer]) else { continue };
        progress::run_with_progress(|progress| {
            target.write_document(&alone, options, &args.limits.budget(), progress)
        })?;
    }
    Ok(())
}

/// The smallest rectangle that holds the surface; `None` if there is none.
fn covered_rect(document: &Document) -> Option<Rect> {
    let coverage = document.surface.as_deref()?.coverage_plane();
    let mut rect = Rect::EMPTY;
    for y in 0..document.size.height as usize {
        let row = coverage.row(y);
        let is_covered = |c: &u8| *c > 0;
        if let (Some(first), Some(last)) =
            (row.iter().position(is_covered), row.iter().rposition(is_covered))
        {
            rect = rect.union(Rect::new(first as i32, y as i32, last as i32 + 1, y as i32 + 1));
        }
    }
    Some(rect)
}
