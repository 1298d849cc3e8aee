//! Strokes: samples of the pen, each stroke with its brush, operator and colour. Read and written.
//! Floor 5. The presets are files in `brushes/`, built into the program: a new one is a file and a line here.

use super::Reader;
use super::brush::{settings, write_brush};
use super::images::{operator, write_operator};
use crate::Result;
use crate::document::StrokeList;
use crate::io::Budget;
use crate::io::json::{self, Fields, Node, Object, fields::COORDINATE, object};
use crate::math::{srgb::Color, vec2};
use crate::paint::{Adjust, Brush, Sample, Stroke, Tip};
use crate::surface::Operator;
use serde_json::Value;
use std::{path::Path, sync::Arc};

/// Every preset: its name and its file.
const PRESETS: [(&str, &str); 6] = [
    ("soft-round", include_str!("../../../brushes/soft-round.json")),
    ("hard-round", include_str!("../../../brushes/hard-round.json")),
    ("ink", include_str!("../../../brushes/ink.json")),
    ("airbrush", include_str!("../../../brushes/airbrush.json")),
    ("highlight-satin", include_str!("../../../brushes/highlight-satin.json")),
    ("decal", include_str!("../../../brushes/decal.json")),
];

/// The names of the brushes that come with the program.
pub fn preset_names() -> impl Iterator<Item = &'static str> {
    PRESETS.iter().map(|(name, _)| *name)
}

/// A brush that comes with the program, and the operator it is meant for.
pub fn preset_brush(name: &str) -> Option<(Brush, Operator)> {
    let (_, text) = PRESETS.iter().find(|(known, _)| *known == name)?;
    read_preset(text).ok().map(|preset| (preset.brush, preset.operator))
}

/// A brush that comes with the program, and the operator it is meant for.
#[derive(Default)]
struct Preset {
    brush: Brush,
    operator: Operator,
}

/// A reading of the pen whose last fields are absent.
const UNSAID: [f32; 4] = [1.0, 0.0, 0.0, 0.0];

impl Reader<'_> {
    pub fn strokes(&mut self, fields: &mut Fields) -> Result<StrokeList> {
        let Some(node) = fields.get("strokes") else { return Ok(StrokeList::default()) };
        let items = node.list(usize::MAX)?;
        let strokes = items.iter().map(|item| self.stroke(item).map(Arc::new)).collect::<Result<_>>()?;
        Ok(StrokeList { strokes })
    }
    fn stroke(&mut self, node: &Node) -> Result<Stroke> {
        let mut fields = node.fields()?;
        let preset = fields.get("brush").map_or(Ok(Preset::default()), |brush| self.brush(&brush))?;
        if preset.brush.mark.is_retouching() {
            return Err(node.refused("has a brush that smudges, blurs or clones; strokes of a stroke layer paint"));
        }
        let operator = operator(&mut fields)?.unwrap_or(preset.operator);
        let color = fields.color("color", Color::BLACK)?;
        let most = self.source.budget.samples;
        let samples = match fields.get("samples") {
            Some(node) => node.list(most)?.iter().map(sample).collect::<Result<_>>()?,
            None => Vec::new(),
        };
        fields.finish()?;
        Ok(Stroke::new(preset.brush, operator, color, samples))
    }
    /// A preset, an inline brush, or a preset with some of its fields changed.
    fn brush(&mut self, node: &Node) -> Result<Preset> {
        let mut fields = node.fields()?;
        let preset = fields.get("preset").map_or(Ok(Preset::default()), |name| preset(&name))?;
        let mut brush = settings(&mut fields, preset.brush)?;
        if let Some(node) = fields.get("tip") {
            let mut tip = node.fields()?;
            let file = tip.required("file")?;
            tip.finish()?;
            brush.tip = Tip::Picture(self.pictures.source(self.source, &file, Adjust::default())?);
        }
        fields.finish()?;
        Ok(Preset { brush, operator: preset.operator })
    }
}

fn preset(name: &Node) -> Result<Preset> {
    let wanted = name.text()?;
    let Some((_, text)) = PRESETS.iter().find(|(known, _)| *known == wanted) else {
        let names: Vec<_> = preset_names().collect();
        return Err(name.refused(format!("is “{wanted}”; the presets are {}", names.join(", "))));
    };
    read_preset(text).map_err(|e| name.led_to(e))
}

/// A preset's file: `{ "brush": { … }, "operator": { … } }`, with the fields of a stroke.
fn read_preset(text: &str) -> Result<Preset> {
    let file = Path::new("brushes");
    let value = json::parse(file, text.as_bytes(), &Budget::default())?;
    let mut root = Node::root(file, &value).fields()?;
    let operator = operator(&mut root)?.unwrap_or_default();
    let mut fields = root.required("brush")?.fields()?;
    let brush = settings(&mut fields, Brush::default())?;
    fields.finish()?;
    root.finish()?;
    Ok(Preset { brush, operator })
}

/// [x, y, pressure 1, tilt_x 0, tilt_y 0, time_secs 0]; the last four may be absent.
fn sample(node: &Node) -> Result<Sample> {
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

pub fn write(out: &mut Object, list: &StrokeList) {
    out.set("strokes", list.strokes.iter().map(|stroke| write_stroke(stroke)).collect());
}

/// One stroke, as it stands in a layer's `strokes`.
pub fn write_stroke(stroke: &Stroke) -> Value {
    let mut out = Object::default();
    out.object("brush", write_brush(stroke.brush()));
    out.object("operator", write_operator(stroke.operator()));
    out.set("color", object::color(stroke.color()));
    out.set("samples", stroke.samples().iter().map(write_sample).collect());
    out.done()
}

/// As few numbers as say it.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_reads() {
        for (name, text) in PRESETS {
            read_preset(text).unwrap_or_else(|e| panic!("{name}: {e}"));
        }
    }
}
