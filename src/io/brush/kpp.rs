//! Krita's presets: a PNG whose text holds the settings as XML, and within them the tip as XML
//! again. Floor 5. Reads presets of the pixel, color smudge and clone brushes with generated tips;
//! a tip that is one of Krita's own files is not in the preset, and becomes a round one with a
//! note.

mod sensors;

use super::{ImportedBrush, text_of};
use crate::Budget;
use crate::paint::dynamics::{Dynamics, Property};
use crate::paint::{Brush, BrushMode, Pickup, Tip};
use crate::{Error, Result};
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::collections::BTreeMap;
use std::path::Path;

/// Bytes that a preset's text may have; the largest of Krita's have a hundred thousand.
const MOST_BYTES: usize = 4 << 20;
const KEYWORD: &str = "preset";

/// The settings of a preset.
#[derive(Default)]
struct KppPreset {
    name: String,
    engine: String,
    settings: BTreeMap<String, String>,
}

impl KppPreset {
    fn text(&self, name: &str) -> &str {
        self.settings.get(name).map_or("", String::as_str)
    }

    fn is_true(&self, name: &str) -> bool {
        self.text(name) == "true"
    }

    /// Finite.
    fn number(&self, name: &str) -> Option<f32> {
        number(self.text(name))
    }
}

fn number(text: &str) -> Option<f32> {
    text.trim().parse().ok().filter(|v: &f32| v.is_finite())
}

pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<ImportedBrush> {
    let text = preset_text(file, bytes)?;
    if text.len() as u64 > budget.json_bytes {
        return Err(Error::too_large(file, "its settings are longer than any preset's"));
    }
    let preset = preset(file, &text)?;
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
    let brush = Brush { mode, dynamics: Dynamics::none(), ..Brush::default() };
    let brush = tip(&preset, brush, &mut notes);
    let brush = Brush {
        opacity: preset.number("OpacityValue").unwrap_or(1.0).max(0.0).min(1.0),
        flow: preset.number("FlowValue").unwrap_or(1.0).max(0.0).min(1.0),
        erases: preset.text("CompositeOp") == "erase" || preset.is_true("EraserMode"),
        pickup: pickup(&preset),
        ..brush
    };
    let brush = read_drives(&preset, brush, &mut notes);
    for (key, what) in
        [("Texture/Pattern/Enabled", "texture"), ("MaskingBrush/Enabled", "masked brush")]
    {
        if preset.is_true(key) {
            notes.push(format!("its {what} has no counterpart"));
        }
    }
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let name = [text_of(preset.name.as_bytes()), stem].into_iter().find(|name| !name.is_empty());
    Ok(ImportedBrush { name: name.unwrap_or_else(|| "Brush".to_owned()), brush, notes })
}

/// The text of the settings.
fn preset_text(file: &Path, bytes: &[u8]) -> Result<String> {
    let limits = png::Limits { bytes: 4 * MOST_BYTES };
    let decoder = png::Decoder::new_with_limits(std::io::Cursor::new(bytes), limits);
    let reader = decoder
        .read_info()
        .map_err(|e| Error::decode(file, format!("it is no Krita preset: {e}")))?;
    let info = reader.info();
    let is_preset = |keyword: &str| keyword == KEYWORD;
    let mut found = None;
    for chunk in info.compressed_latin1_text.iter().filter(|chunk| is_preset(&chunk.keyword)) {
        let mut chunk = chunk.clone();
        if chunk.decompress_text_with_limit(MOST_BYTES).is_ok() {
            found = chunk.get_text().ok();
        }
    }
    for chunk in info.utf8_text.iter().filter(|chunk| is_preset(&chunk.keyword)) {
        let mut chunk = chunk.clone();
        if chunk.decompress_text_with_limit(MOST_BYTES).is_ok() {
            found = chunk.get_text().ok();
        }
    }
    let plain = info.uncompressed_latin1_text.iter().find(|chunk| is_preset(&chunk.keyword));
    let found = found.or(plain.map(|chunk| chunk.text.clone()));
    found.ok_or_else(|| Error::decode(file, "it is a PNG without a Krita preset"))
}

fn preset(file: &Path, text: &str) -> Result<KppPreset> {
    let broken =
        |e: &dyn std::fmt::Display| Error::decode(file, format!("the settings are damaged: {e}"));
    let mut reader = Reader::from_str(text);
    let mut preset = KppPreset::default();
    let mut param: Option<String> = None;
    loop {
        match reader.read_event().map_err(|e| broken(&e))? {
            Event::Start(start) | Event::Empty(start) => match start.local_name().as_ref() {
                "Preset" => {
                    preset.name = attribute(&start, "name").unwrap_or_default();
                    preset.engine = attribute(&start, "paintopid").unwrap_or_default();
                }
                "param" => {
                    param = attribute(&start, "name");
                    if let Some(name) = &param {
                        preset.settings.insert(name.clone(), String::new());
                    }
                }
                _ => {}
            },
            Event::CData(data) => append(&mut preset, &param, &data),
            Event::Text(text) => append(&mut preset, &param, &text),
            Event::End(end) if end.local_name().as_ref() == "param" => param = None,
            Event::Eof => return Ok(preset),
            _ => {}
        }
    }
}

fn append(preset: &mut KppPreset, param: &Option<String>, text: &str) {
    if let Some(value) = param.as_ref().and_then(|name| preset.settings.get_mut(name)) {
        value.push_str(text.trim());
    }
}

fn attribute(start: &BytesStart, name: &str) -> Option<String> {
    let attribute = start.try_get_attribute(name).ok().flatten()?;
    attribute.normalized_value(XmlVersion::Implicit1_0).ok().map(|value| value.into_owned())
}

/// The first element of a name in a text, by its attributes.
fn element<'a>(text: &'a str, name: &str) -> Option<BytesStart<'a>> {
    let mut reader = Reader::from_str(text);
    loop {
        match reader.read_event().ok()? {
            Event::Start(start) | Event::Empty(start) if start.local_name().as_ref() == name => {
                return Some(start);
            }
            Event::Eof => return None,
            _ => {}
        }
    }
}

/// Tip, size, hardness, spacing, turn.
fn tip(preset: &KppPreset, brush: Brush, notes: &mut Vec<String>) -> Brush {
    let definition = preset.text("brush_definition");
    let Some(outer) = element(definition, "Brush") else {
        notes.push("its tip is missing".to_owned());
        return brush;
    };
    let of = |name: &str| attribute(&outer, name).and_then(|text| number(&text));
    let mut brush =
        Brush { rotation: of("angle").unwrap_or(0.0).to_degrees().rem_euclid(360.0), ..brush };
    if let Some(mask) = element(definition, "MaskGenerator") {
        let of = |name: &str| attribute(&mask, name).and_then(|text| number(&text));
        let fade = |name: &str| of(name).unwrap_or(1.0).max(0.0).min(1.0);
        let ratio = of("ratio").unwrap_or(1.0).max(*Tip::RATIO.start());
        // If the tip is higher than wide, its height is the longer side.
        let (ratio, longer) = if ratio > 1.0 { (1.0 / ratio, ratio) } else { (ratio, 1.0) };
        if longer > 1.0 {
            brush.rotation = (brush.rotation + 90.0).rem_euclid(360.0);
        }
        let radius = of("radius").map(|radius| 2.0 * radius);
        brush.size = (of("diameter").or(radius).unwrap_or(40.0) * longer).max(0.1).min(20_000.0);
        brush.hardness = 0.5 * (fade("hfade") + fade("vfade"));
        brush.tip = match attribute(&mask, "type").as_deref() {
            Some("rect") => Tip::Square { ratio: ratio.max(*Tip::RATIO.start()) },
            _ if ratio < 1.0 => Tip::Ellipse { ratio: ratio.max(*Tip::RATIO.start()) },
            _ => Tip::Round,
        };
        if of("spikes").unwrap_or(2.0) > 2.0 {
            notes.push("the spikes of its tip have no counterpart".to_owned());
        }
    } else {
        let name =
            attribute(&outer, "filename").map(|name| text_of(name.as_bytes())).unwrap_or_default();
        notes.push(format!("its tip “{name}” is not in the file; it is round here"));
    }
    let is_auto =
        attribute(&outer, "useAutoSpacing").is_some_and(|text| text == "1" || text == "true");
    let spacing = if is_auto {
        // So many roots of the diameter.
        of("autoSpacingCoeff").unwrap_or(1.0) / brush.size.sqrt()
    } else {
        of("spacing").unwrap_or(0.1)
    };
    Brush { spacing: spacing.max(0.01).min(10.0), ..brush }
}

/// A color smudge preset: what is not its own color was picked up.
fn pickup(preset: &KppPreset) -> Pickup {
    if preset.engine != "colorsmudge" {
        return Pickup::default();
    }
    let unit = |name: &str, plain: f32| preset.number(name).unwrap_or(plain).max(0.0).min(1.0);
    let color = if preset.is_true("PressureColorRate") { unit("ColorRateValue", 0.5) } else { 0.0 };
    Pickup { amount: 1.0 - color, length: unit("SmudgeRateValue", 1.0), ..Pickup::default() }
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

fn read_drives(preset: &KppPreset, brush: Brush, notes: &mut Vec<String>) -> Brush {
    let mut brush = brush;
    let mut follow = |brush: &mut Brush, option: &str, property: Property| {
        if !preset.is_true(&format!("Pressure{option}"))
            || preset.text(&format!("{option}UseCurve")) == "false"
        {
            return;
        }
        for (input, curve) in sensors::read(preset.text(&format!("{option}Sensor")), notes) {
            brush.dynamics = brush.dynamics.with(property, input, curve);
        }
    };
    for (option, property) in OPTIONS {
        follow(&mut brush, option, property);
    }
    if preset.is_true("PressureScatter") {
        // Theirs is a width, ours a radius.
        brush.scatter = (0.5 * preset.number("ScatterValue").unwrap_or(1.0)).max(0.0).min(10.0);
        follow(&mut brush, "Scatter", Property::Scatter);
    }
    brush
}

#[cfg(test)]
mod tests;
