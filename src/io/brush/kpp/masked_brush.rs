//! Krita's masked brushes as dual brushes: a second pixel brush, whose settings are in the preset
//! under a prefix. Floor 5.
//!
//! Krita paints both along the same samples, the second in white on a device of its own, and lets
//! it act on the alpha of the first's whole stroke before that is laid down. Such strokes are never
//! painted into the layer dab by dab, even those that build up; nor are strokes here.

use super::options;
use super::pictures::KppPictures;
use super::sensors;
use super::settings::KppPreset;
use super::tip::{self, TipUse};
use crate::brush::text_of;
use crate::math::range::clamp_to_range;
use crate::math::vec2;
use crate::paint::{Brush, Curve, DualBrush, DualMode, Dynamics, Input, Property};
use std::sync::Arc;

/// Krita's words for the modes.
const MODES: [(&str, DualMode); 11] = [
    ("multiply", DualMode::Multiply),
    ("darken", DualMode::Darken),
    ("overlay", DualMode::Overlay),
    ("dodge", DualMode::ColorDodge),
    ("burn", DualMode::ColorBurn),
    ("linear_dodge", DualMode::LinearDodge),
    ("linear_burn", DualMode::LinearBurn),
    // Both are Photoshop's.
    ("hard mix", DualMode::HardMix),
    ("hard_mix_photoshop", DualMode::HardMix),
    ("hard_mix_softer_photoshop", DualMode::SoftHardMix),
    ("subtract", DualMode::Subtract),
];
/// Options of the second tip without a counterpart.
const LEFT_OUT: [(&str, &str); 2] = [
    ("PressureMirror", "the dabs of its dual brush are not mirrored"),
    ("PressureRatio", "the tip of its dual brush keeps its ratio"),
];

/// A brush with the second tip of a preset, if it has one. `masked`: the settings of that.
pub fn read(
    preset: &KppPreset,
    masked: &KppPreset,
    brush: Brush,
    pictures: &mut KppPictures,
    notes: &mut Vec<String>,
) -> Brush {
    if !preset.is_true("MaskingBrush/Enabled") {
        return brush;
    }
    if brush.is_wet() {
        notes.push(
            "its masked brush has no counterpart where a brush works on existing paint".to_owned(),
        );
        return brush;
    }
    let op = preset.text("MaskingBrush/MaskingCompositeOp");
    let known = MODES.iter().find(|(word, _)| *word == op).map(|(_, mode)| *mode);
    let mode = known.unwrap_or_default();
    if known.is_none() && !op.is_empty() {
        let op = text_of(op.replace('_', " ").as_bytes());
        notes.push(format!("its dual brush, “{op}” there, multiplies here"));
    }
    match second_tip(preset, masked, &brush, pictures) {
        Ok((second, of_second)) => {
            notes.extend(of_second.iter().map(|note| format!("its dual brush: {note}")));
            let lost = LEFT_OUT.iter().filter(|(option, _)| masked.is_true(option));
            notes.extend(lost.map(|(_, note)| (*note).to_owned()));
            let dual = DualBrush::of_brush(&second, &brush, mode);
            Brush { dual: Some(Arc::new(dual)), ..with_opacity_of_dabs(brush) }
        }
        Err(reason) => {
            notes.push(format!("its dual brush is left out: its tip {reason}"));
            brush
        }
    }
}

/// A brush whose opacity is that of each dab: Krita's acts before both tips meet, that of a stroke
/// here after it.
fn with_opacity_of_dabs(brush: Brush) -> Brush {
    let opacity = brush.opacity;
    match Curve::through(vec![vec2(0.0, opacity), vec2(1.0, opacity)]) {
        Some(level) if opacity < 1.0 => {
            let brush = Brush { opacity: 1.0, ..brush };
            sensors::with_factor(brush, Property::Opacity, Input::Pressure, level)
        }
        _ => brush,
    }
}

/// The second tip as a brush of its own, with notes; or why its tip is not found: a round one in
/// its place could take everything away.
fn second_tip(
    preset: &KppPreset,
    masked: &KppPreset,
    first: &Brush,
    pictures: &mut KppPictures,
) -> Result<(Brush, Vec<String>), String> {
    let mut notes = Vec::new();
    let is_relative = preset.text("MaskingBrush/UseMasterSize") != "false";
    let ratio = preset.number("MaskingBrush/MasterSizeCoeff").unwrap_or(1.0);
    let ratio = clamp_to_range(ratio, &DualBrush::SIZE);
    let size = is_relative.then_some(ratio * first.size);
    let brush = Brush {
        dynamics: Dynamics::none(),
        opacity: masked.unit("OpacityValue", 1.0),
        flow: masked.unit("FlowValue", 1.0),
        ..Brush::default()
    };
    let (brush, missing) = tip::read(masked, brush, TipUse::Second(size), pictures, &mut notes);
    if let Some(reason) = missing {
        return Err(reason);
    }
    let brush = options::read(masked, brush, &mut notes);
    Ok((brush, notes))
}

#[cfg(test)]
mod tests;
