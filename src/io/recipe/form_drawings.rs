//! Drawings by the form: which lines, the hand that draws them, its brush and color. Read and
//! written. Floor 5. Not here: brushes (`brush`, `tips`).

use super::LayerReader;
use super::brush::write_brush;
use super::light::{direction, of_object, settings, write_settings};
use super::value::RecipeValue;
use crate::Result;
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::paint::{DrawingHand, DrawingSources, FormDrawing, FormPattern};
use crate::surface::form_lines::{LineKind, LineKinds, LineSettings};
use crate::surface::hatching::{HatchSettings, HatchStyle, HatchTone, HatchWay};
use serde_json::Value;

impl LayerReader<'_> {
    /// A layer of lines.
    pub fn form_lines(&mut self, fields: &mut Fields) -> Result<FormDrawing> {
        let pattern = FormPattern::Lines(lines(fields)?);
        let sources =
            DrawingSources { redrawn: name(fields, "redrawn_on")?, ..DrawingSources::default() };
        Ok(FormDrawing { sources, ..self.form_drawing(fields, pattern)? })
    }

    /// A layer of hatching.
    pub fn hatching(&mut self, fields: &mut Fields) -> Result<FormDrawing> {
        let pattern = FormPattern::Hatching(hatch(fields)?);
        let (guides, tone) = (name(fields, "guides")?, name(fields, "tone_of")?);
        let sources = DrawingSources { guides, tone, ..DrawingSources::default() };
        Ok(FormDrawing { sources, ..self.form_drawing(fields, pattern)? })
    }

    fn form_drawing(&mut self, fields: &mut Fields, pattern: FormPattern) -> Result<FormDrawing> {
        let plain = FormDrawing::new(pattern);
        let brush = match fields.get("brush") {
            Some(node) => {
                let (brush, _) = self.brush(&node, None)?;
                if brush.mode.is_retouching() {
                    return Err(node.refusal("smudges, blurs or clones; lines are painted"));
                }
                brush
            }
            None => plain.brush.clone(),
        };
        let hand = fields.get("hand").map_or(Ok(plain.hand), |node| hand(&node, plain.hand))?;
        let color = fields.color("color", plain.color)?;
        Ok(FormDrawing { hand, brush, color, ..plain })
    }
}

/// The name of a layer; empty if it is absent.
fn name(fields: &mut Fields, key: &'static str) -> Result<String> {
    fields.get(key).map_or(Ok(String::new()), |node| node.text().map(str::to_owned))
}

/// The numbers of a table, which kinds there are, and the light.
fn lines(fields: &mut Fields) -> Result<LineSettings> {
    let plain = LineSettings::DEFAULT;
    let numbers = settings(fields, LineSettings::SETTINGS, plain)?;
    let kinds = fields.get("of").map_or(Ok(plain.kinds), |node| kinds(&node))?;
    let light = fields.get("light").map_or(Ok(plain.light), |node| direction(&node))?;
    let skip_ink = fields.boolean("skip_ink", plain.skip_ink)?;
    Ok(LineSettings { kinds, light, skip_ink, ..numbers })
}

fn kinds(node: &JsonNode) -> Result<LineKinds> {
    let named = node.list(LineKind::ALL.len())?;
    named
        .iter()
        .try_fold(LineKinds::NONE, |kinds, node| Ok(kinds.with(node.one_of(&LineKind::ALL)?, true)))
}

/// The numbers of a table, how tone becomes lines, their way, and the light.
fn hatch(fields: &mut Fields) -> Result<HatchSettings> {
    let plain = HatchSettings::DEFAULT;
    let numbers = settings(fields, HatchSettings::SETTINGS, plain)?;
    let style = fields.one_of("style", &HatchStyle::ALL, plain.style)?;
    let way = fields.one_of("way", &HatchWay::ALL, plain.way)?;
    let tone = fields.one_of("tone", &HatchTone::ALL, plain.tone)?;
    let light = fields.get("light").map_or(Ok(plain.light), |node| direction(&node))?;
    Ok(HatchSettings { style, way, tone, light, ..numbers })
}

fn write_hatch(out: &mut JsonObject, hatch: &HatchSettings) {
    let plain = HatchSettings::DEFAULT;
    out.word("style", &HatchStyle::ALL, hatch.style, plain.style);
    out.word("way", &HatchWay::ALL, hatch.way, plain.way);
    out.word("tone", &HatchTone::ALL, hatch.tone, plain.tone);
    write_settings(out, HatchSettings::SETTINGS, hatch, &plain);
    if hatch.light != plain.light {
        out.set("light", object::vector(hatch.light));
    }
}

/// Fields that are not given are those of `base`.
fn hand(node: &JsonNode, base: DrawingHand) -> Result<DrawingHand> {
    of_object(node, |fields| settings(fields, DrawingHand::SETTINGS, base))
}

fn write_lines(out: &mut JsonObject, lines: &LineSettings) {
    let plain = LineSettings::DEFAULT;
    write_settings(out, LineSettings::SETTINGS, lines, &plain);
    out.flag("skip_ink", lines.skip_ink, plain.skip_ink);
    if lines.kinds != plain.kinds {
        let all = LineKind::ALL.iter().filter(|(kind, _)| lines.kinds.has_kind(*kind));
        out.set("of", all.map(|(_, name)| Value::from(*name)).collect());
    }
    if lines.light != plain.light {
        out.set("light", object::vector(lines.light));
    }
}

/// What a layer has in addition to every layer.
pub fn write(out: &mut JsonObject, drawing: &FormDrawing) {
    match &drawing.pattern {
        FormPattern::Lines(lines) => write_lines(out, lines),
        FormPattern::Hatching(hatch) => write_hatch(out, hatch),
    }
    let DrawingSources { guides, redrawn, tone } = &drawing.sources;
    out.text("guides", guides, "");
    out.text("redrawn_on", redrawn, "");
    out.text("tone_of", tone, "");
    let plain = FormDrawing::new(drawing.pattern);
    let mut hand = JsonObject::default();
    write_settings(&mut hand, DrawingHand::SETTINGS, &drawing.hand, &plain.hand);
    out.object("hand", hand);
    if drawing.brush != plain.brush {
        out.set("brush", write_brush(&drawing.brush).into_value());
    }
    out.color("color", drawing.color, plain.color);
}

impl RecipeValue for LineSettings {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        write_lines(&mut out, self);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        of_object(node, lines)
    }
}

impl RecipeValue for HatchSettings {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        write_hatch(&mut out, self);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        of_object(node, hatch)
    }
}

impl RecipeValue for DrawingHand {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        write_settings(&mut out, DrawingHand::SETTINGS, self, &DrawingHand::DEFAULT);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        hand(node, DrawingHand::DEFAULT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn read(value: &Value) -> Result<LineSettings> {
        LineSettings::from_json(&JsonNode::root(std::path::Path::new("r.json"), value))
    }

    #[test]
    fn every_field_is_written_as_it_was_read() {
        let text = json!({
            "smooth": 3, "detail": 0.75, "shortest": 20, "gap": 4, "lit": 0.25, "wires": 30,
            "skip_ink": true, "of": ["outlines", "ridges", "wires"], "light": [0, 1, 0.5],
        });
        let lines = read(&text).unwrap();
        assert_eq!(lines.to_json(), text);
        assert!(lines.kinds.has_kind(LineKind::Wire) && !lines.kinds.has_kind(LineKind::Crease));
        assert_eq!(LineSettings::DEFAULT.to_json(), json!({}));
    }

    #[test]
    fn hatching_is_written_as_it_was_read() {
        let text = json!({
            "style": "engraving", "way": "slope", "tone": "beneath",
            "spacing": 6, "angle": 30, "smooth": 4, "spread": 10,
            "darkness": 0.75, "paper": 0.5, "shadow": 0.25, "hollows": 1, "light": [1, 0, 0.5],
        });
        let node = JsonNode::root(std::path::Path::new("r.json"), &text);
        assert_eq!(HatchSettings::from_json(&node).unwrap().to_json(), text);
        assert_eq!(HatchSettings::DEFAULT.to_json(), json!({}));
    }

    #[test]
    fn what_cannot_be_is_refused_in_a_sentence() {
        let says = |value: Value, what: &str| {
            let said = read(&value).err().map(|e| e.to_string()).unwrap_or_default();
            assert!(said.contains(what), "{said}");
        };
        says(json!({ "of": ["outline"] }), "of[0]: is “outline”; it must be one of outlines");
        says(json!({ "detail": 2 }), "detail: is 2; it must be between 0 and 1");
        says(json!({ "light": [0, 0, 0] }), "has no direction");
    }
}
