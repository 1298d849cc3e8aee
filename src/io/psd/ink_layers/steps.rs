//! In which order the inks of a file are composed, and what adjustments do to them. Floor 5.

use super::super::effects::RecordEffects;
use super::super::{LayerRecord, PASS_THROUGH, RecordSection};
use super::InkView;
use crate::math::srgb::Color;
use crate::paint::ColorAdjustment;
use crate::raster::BlendMode;

/// Tones of an ink that are adjusted: each byte hits one.
const TONES: usize = 255 * 16 + 1;

/// One of the things that are done from the bottom to the top, with the number of its record.
pub enum InkStep {
    /// A group that is composed by itself begins.
    Open(usize),
    /// It is laid on what is beneath it.
    Close(usize, BlendMode),
    Paint(usize, BlendMode),
    Adjust(usize, InkTone),
}

impl InkStep {
    /// The layer that gets pixels.
    pub fn layer(&self) -> Option<usize> {
        match self {
            InkStep::Paint(number, _) | InkStep::Adjust(number, _) => Some(*number),
            _ => None,
        }
    }
}

/// What an adjustment does to the light that inks let through.
pub enum InkTone {
    /// Each ink by itself, evenly spaced tones.
    Each([Vec<f32>; 4]),
    /// The same of each, without anything between its tones.
    Steps(ColorAdjustment),
    /// Paper from this luminosity on, black beneath it.
    Threshold(f32),
}

impl InkTone {
    /// `None` of what does neither.
    fn read(record: &LayerRecord, view: &InkView, is_deep: bool) -> Option<Self> {
        use ColorAdjustment as A;
        let adjustment = match record.adjustment.clone()? {
            A::Posterize(own) => A::Posterize(crate::paint::adjustment::Posterize {
                of_16_bits: own.of_16_bits || is_deep,
                ..own
            }),
            other => other,
        };
        match (view, &adjustment) {
            (InkView::Inks(_), A::Threshold(own)) => {
                return Some(Self::Threshold(own.level / 255.0));
            }
            (InkView::Lab(_), _) => return None,
            _ => {}
        }
        if matches!(adjustment, A::Posterize(_) | A::Threshold(_)) {
            return Some(Self::Steps(adjustment));
        }
        let is_each = matches!(
            adjustment,
            A::Levels(_) | A::Curves(_) | A::BrightnessContrast(_) | A::Invert(_)
        );
        if !is_each {
            return None;
        }
        let of_ink = |ink: usize| -> Vec<f32> {
            let (by, channel) = match ink {
                3 => (record.adjustment_of_black.as_ref().unwrap_or(&adjustment), 0),
                ink => (&adjustment, ink),
            };
            (0..TONES).map(|i| by.color([i as f32 / (TONES - 1) as f32; 3])[channel]).collect()
        };
        Some(Self::Each([0, 1, 2, 3].map(of_ink)))
    }

    pub fn of(&self, light: [f32; 4]) -> [f32; 4] {
        match self {
            Self::Threshold(level) => {
                let [c, m, y, k] = light;
                let luminosity = (0.3 * c + 0.59 * m + 0.11 * y) * k;
                // Rounded as a byte.
                let is_paper = (255.0 * luminosity).round() >= 255.0 * level;
                [1.0, 1.0, 1.0, if is_paper { 1.0 } else { 0.0 }]
            }
            Self::Steps(adjustment) => light.map(|v| adjustment.color([v.max(0.0).min(1.0); 3])[0]),
            Self::Each(tones) => {
                let tone = |ink: usize| {
                    let place = light[ink].max(0.0).min(1.0) * (TONES - 1) as f32;
                    let at = (place as usize).min(TONES - 2);
                    let (low, high) = (tones[ink][at], tones[ink][at + 1]);
                    low + (high - low) * (place - at as f32)
                };
                [0, 1, 2, 3].map(tone)
            }
        }
    }
}

/// All steps; `None` if something in the file is not known of inks.
pub fn plan(records: &[LayerRecord], view: &InkView, is_deep: bool) -> Option<Vec<InkStep>> {
    let heads = heads(records)?;
    let mut steps = Vec::new();
    let mut number = 0;
    while let Some(record) = records.get(number) {
        match record.section {
            RecordSection::End => {
                let head = heads[number]?;
                let group = &records[head];
                if !group.visible {
                    number = head;
                } else if !is_passing(group) {
                    steps.push(InkStep::Open(head));
                }
            }
            RecordSection::Group => {
                let is_known = !record.clipped && !has_effects(record) && has_known_ground(record);
                let mode = BlendMode::from_photoshop(record.blend);
                let mode = mode.filter(|mode| view.can_blend(*mode));
                if !is_passing(record) {
                    steps.push(InkStep::Close(number, mode.filter(|_| is_known)?));
                } else if !is_known {
                    return None;
                }
            }
            RecordSection::Layer if record.visible => {
                steps.extend(layer_step(record, number, view, is_deep)?);
            }
            RecordSection::Layer => {}
        }
        number += 1;
    }
    Some(steps)
}

/// For each beginning of a group the record that ends it; `None` where they do not match.
fn heads(records: &[LayerRecord]) -> Option<Vec<Option<usize>>> {
    let mut heads = vec![None; records.len()];
    let mut open = Vec::new();
    for (number, record) in records.iter().enumerate() {
        match record.section {
            RecordSection::End => open.push(number),
            RecordSection::Group => heads[open.pop()?] = Some(number),
            RecordSection::Layer => {}
        }
    }
    open.is_empty().then_some(heads)
}

/// A layer that shows something; `None` if it is not known of inks what.
fn layer_step(
    record: &LayerRecord,
    number: usize,
    view: &InkView,
    is_deep: bool,
) -> Option<Option<InkStep>> {
    let mode = BlendMode::from_photoshop(record.blend);
    let is_known = !record.clipped
        && !has_effects(record)
        && !record.has_unknown_fill
        && record.lost.is_empty();
    let mode = mode.filter(|mode| is_known && view.can_blend(*mode))?;
    if record.adjustment.is_some() {
        let tone = InkTone::read(record, view, is_deep).filter(|_| mode == BlendMode::Normal)?;
        return Some(Some(InkStep::Adjust(number, tone)));
    }
    if record.inks.is_empty() {
        // A fill without pixels is not known as inks.
        return if record.fill.is_none() { Some(None) } else { None };
    }
    // What is dissolved is whole or nothing.
    let mode = if mode == BlendMode::Dissolve { BlendMode::Normal } else { mode };
    Some(Some(InkStep::Paint(number, mode)))
}

/// Its layers lie on what is beneath the group.
fn is_passing(group: &LayerRecord) -> bool {
    let is_masked = group.mask.as_ref().is_some_and(|mask| !mask.disabled);
    group.blend == PASS_THROUGH
        && group.opacity == 255
        && group.fill_opacity == 255
        && !is_masked
        && group.ground.is_none()
}

fn has_effects(record: &LayerRecord) -> bool {
    record.effects.as_ref().is_some_and(RecordEffects::is_shown)
}

/// White is paper; other colors of artboards are not known as inks.
fn has_known_ground(record: &LayerRecord) -> bool {
    record.ground.is_none_or(|ground| ground.color.is_none_or(|color| color == Color::WHITE))
}
