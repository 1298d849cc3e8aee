//! Reads and writes strokes: the samples of the pen, with brush, operator and colour.
//! Floor 5. Not here: brushes (`brush`, `tips`), the ones that come with the program (`presets`).

use super::LayerReader;
use super::brush::{settings, write_brush};
use super::images::{operator, write_operator};
use super::{presets, tips};
use crate::Result;
use crate::document::StrokeList;
use crate::json::{Fields, JsonNode, JsonObject, fields::COORDINATE, object};
use crate::math::{srgb::Color, vec2};
use crate::paint::{Adjust, Brush, Sample, Stroke};
use crate::surface::Operator;
use serde_json::Value;
use std::sync::Arc;

/// A sample whose last fields are absent.
const UNSAID: [f32; 4] = [1.0, 0.0, 0.0, 0.0];

impl LayerReader<'_> {
    pub fn strokes(&mut self, fields: &mut Fields) -> Result<StrokeList> {
        let Some(node) = fields.get("strokes") else { return Ok(StrokeList::default()) };
        let items = node.list(usize::MAX)?;
        let strokes = items.iter().map(|item| self.stroke(item).map(Arc::new)).collect::<Result<_>>()?;
        Ok(StrokeList { strokes })
    }
    fn stroke(&mut self, node: &JsonNode) -> Result<Stroke> {
        let mut fields = node.fields()?;
        let (brush, preset) = fields.get("brush").map_or(Ok(Default::default()), |brush| self.brush(&brush))?;
        if brush.mode.is_retouching() {
            return Err(node.refused("has a brush that smudges, blurs or clones; strokes of a stroke layer paint"));
        }
        let operator = operator(&mut fields)?.unwrap_or(preset);
        let color = fields.color("color", Color::BLACK)?;
        let most = self.source.budget.samples;
        let samples = match fields.get("samples") {
            Some(node) => node.list(most)?.iter().map(sample).collect::<Result<_>>()?,
            None => Vec::new(),
        };
        fields.finish()?;
        Ok(Stroke::new(brush, operator, color, samples))
    }
    /// A preset, an inline brush, or a preset with some of its fields changed.
    fn brush(&mut self, node: &JsonNode) -> Result<(Brush, Operator)> {
        let mut fields = node.fields()?;
        let (base, operator) = fields.get("preset").map_or(Ok(Default::default()), |name| presets::named(&name))?;
        let mut brush = settings(&mut fields, base)?;
        let mut picture = |node: &JsonNode| self.pictures.source(self.source, node, Adjust::default());
        tips::read(&mut fields, &mut brush, &mut picture)?;
        fields.finish()?;
        Ok((brush, operator))
    }
}

/// [x, y, pressure 1, tilt_x 0, tilt_y 0, time_secs 0]; the last four may be absent.
fn sample(node: &JsonNode) -> Result<Sample> {
    let values = node.numbers(2, 6, COORDINATE)?;
    let value = |i: usize| values.get(i).copied().unwrap_or(UNSAID[i - 2]);
    let (pressure, tilt, time_secs) = (value(2), vec2(value(3), value(4)), value(5));
    if !(0.0..=1.0).contains(&pressure) {
        return Err(node.refused(format!("has the pressure {pressure}; it must be between 0 and 1")));
    }
    if tilt.abs().max_element() > 90.0 {
        return Err(node.refused("is tilted by more than 90 degrees"));
    }
    if time_secs < 0.0 {
        return Err(node.refused("has a time before the stroke began"));
    }
    Ok(Sample { at: vec2(values[0], values[1]), pressure, tilt, time_secs })
}

pub fn write(out: &mut JsonObject, list: &StrokeList) {
    out.set("strokes", list.strokes.iter().map(|stroke| write_stroke(stroke)).collect());
}

/// One stroke, as it stands in a layer's `strokes`.
pub fn write_stroke(stroke: &Stroke) -> Value {
    let mut out = JsonObject::default();
    out.object("brush", write_brush(stroke.brush()));
    out.object("operator", write_operator(stroke.operator()));
    out.set("color", object::color(stroke.color()));
    out.set("samples", stroke.samples().iter().map(write_sample).collect());
    out.done()
}

/// As few numbers as possible.
fn write_sample(sample: &Sample) -> Value {
    let Sample { at, pressure, tilt, time_secs } = *sample;
    let mut values = vec![at.x, at.y, pressure, tilt.x, tilt.y, time_secs];
    for unsaid in UNSAID.iter().rev() {
        if values.last() != Some(unsaid) {
            break;
        }
        values.pop();
    }
    values.into_iter().map(object::number).collect()
}
