//! Descriptions of brushes in later versions of Photoshop: names, sizes, spacings, and the tips
//! they are of.
//! Floor 5. Not here: what drives them (`dynamics`).

use super::dynamics::with_dynamics;
use super::{MOST, SPACING};
use crate::brush::ImportedBrush;
use crate::brush::TipNames;
use crate::paint::{Brush, Tip};
use crate::psd::descriptor::DescriptorObject;
use crate::psd::pattern::PatternResource;
use std::path::Path;

/// One brush of a collection.
pub struct AbrPreset<'a> {
    /// Its whole description.
    description: &'a DescriptorObject,
    name: String,
    /// The key of its sampled tip; `None` of a computed one.
    pub sample: Option<String>,
    diameter_px: Option<f32>,
    spacing: f32,
    rotation: f32,
    roundness: f32,
    hardness: f32,
}

/// The brushes that a description of a collection names, in its order.
pub fn read(root: &DescriptorObject) -> Vec<AbrPreset<'_>> {
    root.objects("Brsh").filter_map(read_preset).take(MOST).collect()
}

fn read_preset(preset: &DescriptorObject) -> Option<AbrPreset<'_>> {
    let brush = preset.object("Brsh")?;
    let text = |object: &DescriptorObject, name: &str| {
        object.text(name).map(str::to_owned).filter(|text| !text.is_empty())
    };
    let percent = |name: &str, plain: f32| brush.number(name).map_or(plain, |v| v / 100.0);
    Some(AbrPreset {
        description: preset,
        name: text(preset, "Nm  ").or(text(brush, "Nm  ")).unwrap_or_default(),
        sample: text(brush, "sampledData"),
        diameter_px: brush.number("Dmtr"),
        spacing: percent("Spcn", SPACING),
        rotation: brush.number("Angl").unwrap_or(0.0),
        roundness: percent("Rndn", 1.0),
        hardness: percent("Hrdn", 1.0),
    })
}

/// Where the pictures of a collection come from and go to.
pub struct AbrPictures<'a> {
    pub file: &'a Path,
    pub patterns: &'a [PatternResource],
    pub tips: &'a mut TipNames,
}

impl AbrPreset<'_> {
    /// The brush, on its sampled tip where it has one.
    pub fn brush(self, tip: Option<&ImportedBrush>, pictures: &mut AbrPictures) -> ImportedBrush {
        let ratio = self.roundness.max(0.05).min(1.0);
        let plain = tip.map(|imported| imported.brush.clone());
        let is_sampled = plain.is_some();
        let computed = if ratio < 1.0 { Tip::Ellipse { ratio } } else { Tip::Round };
        let plain = plain.unwrap_or(Brush { tip: computed, ..Brush::default() });
        let brush = Brush {
            size: self.diameter_px.unwrap_or(plain.size).max(1.0).min(5000.0),
            spacing: self.spacing.max(0.01).min(10.0),
            rotation: self.rotation.max(-180.0).min(180.0),
            hardness: if is_sampled { plain.hardness } else { self.hardness.max(0.0).min(1.0) },
            ..plain
        };
        let mut notes = Vec::new();
        if is_sampled && ratio < 1.0 {
            notes.push(format!("its tip is squeezed to {:.0} % there", 100.0 * ratio));
        }
        let name = if self.name.is_empty() {
            tip.map_or("Brush".into(), |tip| tip.name.clone())
        } else {
            self.name
        };
        let mut carried = with_dynamics(self.description, brush, notes);
        carried.convert_texture(pictures.file, pictures.patterns, pictures.tips);
        ImportedBrush { name, brush: carried.brush, notes: carried.notes }
    }
}
