//! Strokes: readings of the pen, each stroke with its brush, operator and color. Read and written.
//! Floor 5. Not here: the readings (`samples`), brushes (`brush`, `tips`), the ones that come with
//! the program (`presets`).

use super::LayerReader;
use super::brush::{settings, write_brush};
use super::images::{operator, write_operator};
use super::selections::{with_selection, write_of_stroke};
use super::{presets, samples, tips, transforms};
use crate::Result;
use crate::document::{
    LayerTransform, SelectionList, StrokeAttachment, StrokeList, TransformShape,
};
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::math::srgb::Color;
use crate::paint::{Adjust, Brush, Stroke};
use crate::raster::Resampling;
use crate::surface::Operator;
use serde_json::Value;
use std::sync::Arc;

/// What a stroke may have of its own although it has the brush of the stroke before.
const OWN: [&str; 2] = ["facing", "seed"];

impl LayerReader<'_> {
    pub fn strokes(&mut self, fields: &mut Fields) -> Result<StrokeList> {
        let Some(node) = fields.get("strokes") else { return Ok(StrokeList::default()) };
        let mut strokes: Vec<Arc<Stroke>> = Vec::new();
        for item in node.list(usize::MAX)? {
            let before = strokes.last().map(|stroke| stroke.brush().clone());
            strokes.push(Arc::new(self.stroke(&item, before)?));
        }
        Ok(StrokeList { strokes })
    }

    fn stroke(&mut self, node: &JsonNode, before: Option<Brush>) -> Result<Stroke> {
        let mut fields = node.fields()?;
        let brush = fields.get("brush").map(|brush| self.brush(&brush, before)).transpose()?;
        let (brush, preset) = brush.unwrap_or_default();
        if brush.mode.is_retouching() {
            return Err(node.refusal(
                "has a brush that smudges, blurs or clones; strokes of a stroke layer paint",
            ));
        }
        let operator = operator(&mut fields)?.unwrap_or(preset);
        let color = fields.color("color", Color::BLACK)?;
        let most = self.source.budget.samples;
        let samples = match fields.get("samples") {
            Some(node) => samples::read(&node, most, &mut self.samples_left)?,
            None => Vec::new(),
        };
        let selection = self.stroke_selection(&mut fields)?;
        let attachment = self.stroke_attachment(&mut fields)?;
        fields.finish()?;
        Ok(Stroke::new(brush, operator, color, samples).within(selection).on(attachment))
    }

    /// The attachment of a stroke, if it is not that of its layer, and the place of its frame in
    /// the layer's.
    fn stroke_attachment(&self, fields: &mut Fields) -> Result<Option<Arc<StrokeAttachment>>> {
        let (on, transform) = (fields.get("on"), fields.get("transform"));
        let Some(on) = on else {
            return match transform {
                Some(node) => Err(node.refusal("is for strokes that have their own “on”")),
                None => Ok(None),
            };
        };
        let mut attachment = StrokeAttachment::new(self.attachment(&on)?);
        if let Some(node) = transform {
            attachment.own = match transforms::read(&node, None)?.shape {
                TransformShape::Matrix(coefficients) => coefficients,
                TransformShape::Quad(_) | TransformShape::Mesh(_) => {
                    return Err(node.refusal("must be a matrix"));
                }
            };
        }
        Ok(Some(Arc::new(attachment)))
    }

    /// A preset, an inline brush, or a preset or the brush of the stroke before with some of its
    /// fields changed.
    pub(super) fn brush(
        &mut self,
        node: &JsonNode,
        before: Option<Brush>,
    ) -> Result<(Brush, Operator)> {
        let mut fields = node.fields()?;
        let (base, operator) = match fields.get("preset") {
            Some(name) => presets::read_preset_name(&name)?,
            None if fields.boolean("same", false)? => match before {
                Some(before) => (before, Operator::None),
                None => {
                    return Err(
                        node.refusal("is the same as before, but there is no stroke before it")
                    );
                }
            },
            None => Default::default(),
        };
        let mut brush = settings(&mut fields, base)?;
        let mut picture =
            |node: &JsonNode| self.pictures.source(self.source, node, Adjust::default());
        tips::read(&mut fields, &mut brush, &mut picture)?;
        fields.finish()?;
        Ok((brush, operator))
    }
}

/// The strokes of a layer as in its `strokes`, one after the other.
pub fn write_strokes<'a>(
    list: &'a StrokeList,
    selections: &'a SelectionList,
) -> impl Iterator<Item = Value> + 'a {
    let mut before: Option<JsonObject> = None;
    list.strokes.iter().map(move |stroke| {
        let brush = write_brush(stroke.brush());
        let shortened = before.as_ref().and_then(|before| difference_from(&brush, before));
        let value = write(stroke, shortened.as_ref().unwrap_or(&brush));
        let value = with_selection(value, &write_of_stroke(stroke, selections));
        before = Some(brush);
        value
    })
}

/// One stroke by itself, without its selection.
pub fn write_stroke(stroke: &Stroke) -> Value {
    write(stroke, &write_brush(stroke.brush()))
}

fn write(stroke: &Stroke, brush: &JsonObject) -> Value {
    let mut out = JsonObject::default();
    out.object("brush", brush.clone());
    out.object("operator", write_operator(stroke.operator()));
    out.set("color", object::color(stroke.color()));
    if let Some(attachment) = stroke.attachment() {
        out.set("on", (*attachment.frame.part).into());
        if attachment.own != StrokeAttachment::UNMOVED {
            let (shape, filter) = (TransformShape::Matrix(attachment.own), Resampling::default());
            out.set("transform", transforms::write(&LayerTransform { shape, filter }));
        }
    }
    out.set("samples", samples::write(stroke.samples()));
    out.into_value()
}

/// The difference of a brush from the one before it, if it is only that; a plain brush needs no
/// fields.
fn difference_from(brush: &JsonObject, before: &JsonObject) -> Option<JsonObject> {
    let shared = |brush: &JsonObject| -> Vec<(String, Value)> {
        let fields = brush.fields().iter().filter(|(name, _)| !OWN.contains(&name.as_str()));
        fields.map(|(name, value)| (name.clone(), value.clone())).collect()
    };
    if brush.is_empty() || shared(brush) != shared(before) {
        return None;
    }
    let mut out = JsonObject::default();
    out.set("same", true.into());
    for (name, unsaid) in OWN.into_iter().zip([Value::Object(Default::default()), 0.into()]) {
        let (own, before) = (brush.fields().get(name), before.fields().get(name));
        if own != before {
            out.set(name, own.unwrap_or(&unsaid).clone());
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paint::{Sample, StrokeFrame, Tip};

    #[test]
    fn a_brush_that_stays_is_said_once() {
        let brush =
            Brush { size: 30.0, tip: Tip::Square { ratio: 0.5 }, seed: 7, ..Brush::default() };
        let turned = StrokeFrame { turn: 90.0, is_mirrored: true };
        let brushes = [
            brush.clone(),
            brush.clone(),
            Brush { seed: 0, facing: turned, ..brush.clone() },
            Brush { seed: 9, ..brush.clone() },
            Brush { size: 31.0, ..brush.clone() },
            Brush::default(),
            brush.clone(),
        ];
        let stroke = |brush: &Brush| {
            let samples = vec![Sample::at(crate::math::vec2(1.0, 2.0))];
            Arc::new(Stroke::new(brush.clone(), Operator::None, Color::BLACK, samples))
        };
        let list = StrokeList { strokes: brushes.iter().map(stroke).collect() };
        let none =
            SelectionList::of(&crate::document::Document::empty(crate::math::Size::new(4, 4)));
        let shortened: Vec<Value> =
            write_strokes(&list, &none).map(|stroke| stroke["brush"].clone()).collect();
        assert_eq!(
            shortened[1..3],
            [
                serde_json::json!({ "same": true }),
                serde_json::json!({ "same": true, "facing": { "turn": 90, "mirrored": true }, "seed": 0 }),
            ]
        );
        assert_eq!(shortened[3], serde_json::json!({ "same": true, "facing": {}, "seed": 9 }));
        assert_eq!((&shortened[4]["size"], &shortened[5]), (&31.into(), &Value::Null));
        assert_eq!(shortened[6], shortened[0]);
        let text = serde_json::json!({
            "canvas": { "width": 4, "height": 4 },
            "layers": [{ "kind": "strokes", "strokes": write_strokes(&list, &none).collect::<Value>() }],
        });
        let read = crate::project::sample::read(&text, &crate::UserFiles::default());
        for (stroke, brush) in read.strokes(read.layers[0].id).iter().zip(&brushes) {
            assert!(stroke.brush() == brush);
        }
    }

    #[test]
    fn the_same_as_nothing_is_refused() {
        let text = r#"{ "canvas": { "width": 4, "height": 4 },
            "layers": [{ "kind": "strokes", "strokes": [{ "brush": { "same": true } }] }] }"#;
        let budget = crate::Budget::default();
        let source = super::super::RecipeSource {
            file: std::path::Path::new("r.json"),
            files: &crate::UserFiles::default(),
            budget: &budget,
            onto: None,
        };
        let said = super::super::read(text.as_bytes(), source)
            .err()
            .map(|e| e.to_string())
            .unwrap_or_default();
        assert!(said.contains("layers[0].strokes[0].brush: is the same as before"), "{said}");
    }
}
