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
//! | `sensors` | what the options follow |

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
use crate::paint::dynamics::{Dynamics, Property};
use crate::paint::{Brush, BrushMode, Pickup};
use crate::project::krita_blend;
use crate::raster::BlendMode;
use crate::{Error, Result};
use settings::KppPreset;
use std::path::Path;

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
    let preset = KppPreset::read(file, bytes, pictures.budget())?;
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
    let brush = tip::read(&preset, brush, pictures, &mut notes);
    let brush = read_drives(&preset, brush, &mut notes);
    let brush = texture::read(&preset, brush, pictures, &mut notes);
    if preset.is_true("MaskingBrush/Enabled") {
        let mode = match preset.text("MaskingBrush/MaskingCompositeOp") {
            "" => "multiply".to_owned(),
            mode => text_of(mode.replace('_', " ").as_bytes()),
        };
        notes.push(format!("its masked brush, a second tip by “{mode}”, has no counterpart"));
    }
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

/// The options that follow a sensor, by the words that Krita keeps them under.
const OPTIONS: [(&str, Property); 6] = [
    ("Size", Property::Size),
    ("Opacity", Property::Opacity),
    ("Flow", Property::Flow),
    ("Softness", Property::Hardness),
    ("Rotation", Property::Rotation),
    ("Spacing", Property::Spacing),
];
/// Options that later presets cannot switch off, and do not say to be on.
const ALWAYS: [&str; 2] = ["Opacity", "Flow"];

fn read_drives(preset: &KppPreset, brush: Brush, notes: &mut Vec<String>) -> Brush {
    let mut brush = brush;
    // Dabs that build up have their opacity each, not the stroke.
    let is_built_up = preset.number("PaintOpAction") == Some(1.0);
    if is_built_up {
        brush.flow *= std::mem::replace(&mut brush.opacity, 1.0);
    }
    let follow = |brush: Brush, option: &str, property: Property, notes: &mut Vec<String>| {
        let is_on = match preset.text(&format!("Pressure{option}")) {
            "true" => true,
            "" => ALWAYS.contains(&option),
            _ => false,
        };
        if !is_on {
            return brush;
        }
        let found = sensors::of_option(preset, option, &brush, notes);
        let add = |brush, (input, curve)| sensors::with_factor(brush, property, input, curve);
        found.into_iter().fold(brush, add)
    };
    for (option, property) in OPTIONS {
        let each = is_built_up && property == Property::Opacity;
        let property = if each { Property::Flow } else { property };
        brush = follow(brush, option, property, notes);
    }
    if preset.is_true("PressureScatter") {
        // Theirs is a width, ours a radius.
        brush.scatter = (0.5 * preset.number("ScatterValue").unwrap_or(1.0)).max(0.0).min(10.0);
        brush = follow(brush, "Scatter", Property::Scatter, notes);
    }
    brush
}
