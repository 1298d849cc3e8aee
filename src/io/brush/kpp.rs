//! Krita's presets: a PNG whose text holds the settings as XML, and within them the tip as XML
//! again. Floor 5. Reads presets of the pixel, color smudge and clone brushes. Tips and patterns
//! that are files are in the preset, or are asked for (`beside`).
//!
//! | file | |
//! |---|---|
//! | `settings` | names and texts, and the files within |
//! | `pictures` | where tips and patterns come from |
//! | `tip` | the tip: generated, or of a `tip_file` |
//! | `texture` | the texture as grain |
//! | `options` | the options that follow sensors |
//! | `sensors` | what an option follows |
//! | `masked_brush` | the second tip as a dual brush |

mod masked_brush;
mod options;
mod pictures;
mod sensors;
mod settings;
#[cfg(test)]
pub mod tests;
mod texture;
mod tip;
mod tip_file;

pub use pictures::KppPictures;

use super::{BrushFiles, ImportedBrush, text_of};
use crate::Budget;
use crate::paint::{Brush, BrushMode, Dynamics, Pickup};
use crate::project::krita_blend;
use crate::raster::BlendMode;
use crate::{Error, Result};
use settings::KppPreset;
use std::path::Path;
use tip::TipUse;

pub fn read(
    file: &Path,
    bytes: &[u8],
    files: &dyn BrushFiles,
    budget: &Budget,
) -> Result<ImportedBrush> {
    read_preset(file, bytes, &mut KppPictures::new(file, files, budget))
}

/// The same for one preset of several, whose pictures count together.
pub fn read_preset(file: &Path, bytes: &[u8], pictures: &mut KppPictures) -> Result<ImportedBrush> {
    let mut preset = KppPreset::read(file, bytes, pictures.budget())?;
    let masked = preset.split_masked();
    let mut notes = Vec::new();
    let mode = match preset.engine.as_str() {
        "paintbrush" | "colorsmudge" => BrushMode::Paint,
        "duplicate" => BrushMode::Clone { aligned: true, picture: false },
        other => {
            let other = text_of(other.as_bytes());
            let reason = format!(
                "Krita's brush engine “{other}”; pixel, color smudge and clone presets are read"
            );
            return Err(Error::unsupported_file(file, reason));
        }
    };
    let brush = Brush {
        mode,
        dynamics: Dynamics::none(),
        opacity: preset.unit("OpacityValue", 1.0),
        flow: preset.unit("FlowValue", 1.0),
        erases: preset.text("CompositeOp") == "erase" || preset.is_true("EraserMode"),
        blend: blend(&preset, &mut notes),
        pickup: pickup(&preset),
        ..Brush::default()
    };
    let (brush, missing) = tip::read(&preset, brush, TipUse::First, pictures, &mut notes);
    notes.extend(missing.map(|reason| format!("its tip {reason}; it is round here")));
    let brush = options::read(&preset, brush, &mut notes);
    let brush = texture::read(&preset, brush, pictures, &mut notes);
    let brush = masked_brush::read(&preset, &masked, brush, pictures, &mut notes);
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let name = [text_of(preset.name.as_bytes()), stem].into_iter().find(|name| !name.is_empty());
    Ok(ImportedBrush { name: name.unwrap_or_else(|| "Brush".to_owned()), brush, notes })
}

/// A brush of nothing but a tip's file, as Krita shows it in its list of tips.
pub fn read_tip(file: &Path, name: &str, pictures: &mut KppPictures) -> Result<ImportedBrush> {
    let tip = pictures.find_tip(&KppPreset::default(), name);
    let tip = tip.map_err(|reason| Error::decode(file, format!("the tip {reason}")))?;
    let brush = tip::plain_brush(tip, name, pictures);
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    Ok(ImportedBrush { name: text_of(stem.as_bytes()), brush, notes: Vec::new() })
}

fn blend(preset: &KppPreset, notes: &mut Vec<String>) -> BlendMode {
    let op = preset.text("CompositeOp");
    krita_blend(op).unwrap_or_else(|| {
        if op != "erase" {
            notes.push(format!("its blend mode “{}” has no counterpart", text_of(op.as_bytes())));
        }
        BlendMode::Normal
    })
}

/// A color smudge preset: what is not its own color was picked up.
fn pickup(preset: &KppPreset) -> Pickup {
    if preset.engine != "colorsmudge" {
        return Pickup::default();
    }
    let color =
        if preset.is_true("PressureColorRate") { preset.unit("ColorRateValue", 0.5) } else { 0.0 };
    let length = preset.unit("SmudgeRateValue", 1.0);
    Pickup { amount: 1.0 - color, length, ..Pickup::default() }
}
