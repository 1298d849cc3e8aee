//! Descriptions of brushes in later versions of Photoshop: names, sizes, spacings, and the tips
//! they are of.
//! Floor 5. Not here: what drives them (`dynamics`).

use super::dynamics::with_dynamics;
use super::{MOST, SPACING};
use crate::brush::{ImportedBrush, TipNames, text_of};
use crate::paint::{Brush, DualBrush, DualMode, Tip};
use crate::psd::descriptor::DescriptorObject;
use crate::psd::pattern::PatternResource;
use std::path::Path;
use std::sync::Arc;

/// One brush of a collection.
pub struct AbrPreset<'a> {
    /// Its whole description.
    description: &'a DescriptorObject,
    name: String,
    /// The key of its sampled tip; `None` of a computed one.
    pub sample: Option<String>,
    /// Of a dual brush.
    second: Option<Box<AbrSecondTip<'a>>>,
    diameter_px: Option<f32>,
    spacing: f32,
    rotation: f32,
    roundness: f32,
    hardness: f32,
}

/// The second tip of a dual brush, described as a brush is.
struct AbrSecondTip<'a> {
    tip: AbrPreset<'a>,
    mode: DualMode,
    notes: Vec<String>,
}

/// Photoshop's keys of the modes.
const MODES: [(&[u8], DualMode); 8] = [
    (b"Mltp", DualMode::Multiply),
    (b"Drkn", DualMode::Darken),
    (b"Ovrl", DualMode::Overlay),
    (b"CDdg", DualMode::ColorDodge),
    (b"CBrn", DualMode::ColorBurn),
    (b"linearBurn", DualMode::LinearBurn),
    (b"hardMix", DualMode::HardMix),
    (b"Sbtr", DualMode::Subtract),
];

/// The brushes that a description of a collection names, in its order.
pub fn read(root: &DescriptorObject) -> Vec<AbrPreset<'_>> {
    root.objects("Brsh").filter_map(read_with_second).take(MOST).collect()
}

fn read_with_second(preset: &DescriptorObject) -> Option<AbrPreset<'_>> {
    let second = preset.object("dualBrush").and_then(|dual| {
        let is_on = preset.is_set("useDualBrush") || dual.is_set("useDualBrush");
        if is_on { read_second(dual) } else { None }
    });
    Some(AbrPreset { second: second.map(Box::new), ..read_preset(preset)? })
}

fn read_second(dual: &DescriptorObject) -> Option<AbrSecondTip<'_>> {
    let tip = read_preset(dual)?;
    let spacing = dual.number("Spcn").map_or(tip.spacing, |v| v / 100.0);
    let key = dual.word("BlnM").unwrap_or(b"Mltp");
    let known = MODES.iter().find(|(known, _)| *known == key).map(|(_, mode)| *mode);
    let mut notes = Vec::new();
    if known.is_none() {
        let key = text_of(key);
        notes.push(format!("its dual brush, “{key}” there, multiplies here"));
    }
    Some(AbrSecondTip { tip: AbrPreset { spacing, ..tip }, mode: known.unwrap_or_default(), notes })
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
        second: None,
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
    /// The sampled tips, and the place of each key among them.
    pub sampled: &'a [ImportedBrush],
    pub keys: &'a [(String, usize)],
}

impl<'a> AbrPictures<'a> {
    /// The place of a sampled tip.
    pub fn place(&self, key: &str) -> Option<usize> {
        self.keys.iter().find(|(known, _)| known == key).map(|(_, i)| *i)
    }

    fn sampled_tip(&self, key: &str) -> Option<&'a ImportedBrush> {
        self.place(key).and_then(|i| self.sampled.get(i))
    }
}

impl AbrPreset<'_> {
    /// The keys of its sampled tips.
    pub fn samples(&self) -> impl Iterator<Item = &str> {
        let second = self.second.as_ref().and_then(|second| second.tip.sample.as_deref());
        self.sample.as_deref().into_iter().chain(second)
    }

    /// The brush with its second tip, on the sampled tips where it has some.
    pub fn brush(
        mut self,
        tip: Option<&ImportedBrush>,
        pictures: &mut AbrPictures,
    ) -> ImportedBrush {
        let second = self.second.take();
        let mut imported = self.first_brush(tip, pictures);
        let Some(AbrSecondTip { tip, mode, notes }) = second.map(|second| *second) else {
            return imported;
        };
        let sampled = match &tip.sample {
            Some(key) => match pictures.sampled_tip(key) {
                None => {
                    let left_out = "its dual brush is left out: its tip is not in the collection";
                    imported.notes.push(left_out.to_owned());
                    return imported;
                }
                found => found,
            },
            None => None,
        };
        let second = tip.first_brush(sampled, pictures);
        let of_second = second.notes.iter().map(|note| format!("its dual brush: {note}"));
        imported.notes.extend(notes.into_iter().chain(of_second));
        let dual = DualBrush::of_brush(&second.brush, &imported.brush, mode);
        imported.brush.dual = Some(Arc::new(dual));
        imported
    }

    fn first_brush(self, tip: Option<&ImportedBrush>, pictures: &mut AbrPictures) -> ImportedBrush {
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
