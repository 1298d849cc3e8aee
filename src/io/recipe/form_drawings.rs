//! Drawings by the form: which lines, the hand that draws them, its brush and color. Read and
//! written. Floor 5. Not here: brushes (`brush`, `tips`).

use super::LayerReader;
use super::brush::write_brush;
use super::light::{direction, of_object, settings, write_settings};
use super::value::RecipeValue;
use crate::Result;
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::paint::{DrawingHand, FormDrawing, FormPattern};
use crate::surface::form_lines::{LineKind, LineKinds, LineSettings};
use serde_json::Value;

impl LayerReader<'_> {
    /// A layer of lines.
    pub fn form_lines(&mut self, fields: &mut Fields) -> Result<FormDrawing> {
        let pattern = FormPattern::Lines(lines(fields)?);
        self.form_drawing(fields, pattern)
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
            None => plain.brush,
        };
        let hand = fields.get("hand").map_or(Ok(plain.hand), |node| hand(&node))?;
        let color = fields.color("color", plain.color)?;
        Ok(FormDrawing { pattern, hand, brush, color, made: plain.made })
    }
}

/// The numbers of a table, which kinds there are, and the light.
fn lines(fields: &mut Fields) -> Result<LineSettings> {
    let plain = LineSettings::DEFAULT;
    let numbers = settings(fields, LineSettings::SETTINGS, plain)?;
    let kinds = fields.get("of").map_or(Ok(plain.kinds), |node| kinds(&node))?;
    let light = fields.get("light").map_or(Ok(plain.light), |node| direction(&node))?;
    Ok(LineSettings { kinds, light, ..numbers })
}

fn kinds(node: &JsonNode) -> Result<LineKinds> {
    let named = node.list(LineKind::ALL.len())?;
    named
        .iter()
        .try_fold(LineKinds::NONE, |kinds, node| Ok(kinds.with(node.one_of(&LineKind::ALL)?, true)))
}

fn hand(node: &JsonNode) -> Result<DrawingHand> {
    of_object(node, |fields| settings(fields, DrawingHand::SETTINGS, DrawingHand::DEFAULT))
}

fn write_lines(out: &mut JsonObject, lines: &LineSettings) {
    let plain = LineSettings::DEFAULT;
    write_settings(out, LineSettings::SETTINGS, lines, &plain);
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
    }
    let mut hand = JsonObject::default();
    write_settings(&mut hand, DrawingHand::SETTINGS, &drawing.hand, &DrawingHand::DEFAULT);
    out.object("hand", hand);
    let plain = FormDrawing::new(drawing.pattern);
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

impl RecipeValue for DrawingHand {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        write_settings(&mut out, DrawingHand::SETTINGS, self, &DrawingHand::DEFAULT);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        hand(node)
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
            "of": ["outlines", "ridges", "wires"], "light": [0, 1, 0.5],
        });
        let lines = read(&text).unwrap();
        assert_eq!(lines.to_json(), text);
        assert!(lines.kinds.has_kind(LineKind::Wire) && !lines.kinds.has_kind(LineKind::Crease));
        assert_eq!(LineSettings::DEFAULT.to_json(), json!({}));
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
