//! The settings of a brush. Read and written.
//! Floor 5. Not here: strokes and presets (`strokes`).

use super::value::RecipeValue;
use super::{brush_options, dynamics, tips};
use crate::Result;
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::math::{TURNS, UNIT};
use crate::paint::{Brush, BrushMode, ColorJitter, Stabilizer, StrokeFrame};
use crate::raster::BlendMode;
use crate::surface::PaintLimit;
use serde_json::{Value, json};

/// The fields of a brush; missing ones are taken from `base`.
pub fn settings(fields: &mut Fields, base: Brush) -> Result<Brush> {
    let brush = Brush {
        size: fields.number("size", base.size, Brush::SIZE)?,
        hardness: fields.number("hardness", base.hardness, UNIT)?,
        opacity: fields.number("opacity", base.opacity, UNIT)?,
        flow: fields.number("flow", base.flow, UNIT)?,
        spacing: fields.number("spacing", base.spacing, Brush::SPACING)?,
        rotation: fields.number("rotation", base.rotation, TURNS)?,
        facing: fields.get("facing").map_or(Ok(base.facing), |node| facing(&node))?,
        softness: fields.number("softness", base.softness, UNIT)?,
        scatter: fields.number("scatter", base.scatter, Brush::SCATTER)?,
        jitter: fields.get("jitter").map_or(Ok(base.jitter), |node| jitter(&node, base.jitter))?,
        blend: fields.one_of("blend", &BlendMode::ALL, base.blend)?,
        erases: fields.boolean("erases", base.erases)?,
        keeps_alpha: fields.boolean("keeps_alpha", base.keeps_alpha)?,
        bounded: fields.one_of("bounded", &PaintLimit::ALL, base.bounded)?,
        reach: fields.number("reach", base.reach, Brush::REACHES)?,
        mode: fields.get("mark").map_or(Ok(base.mode), |node| BrushMode::from_json(&node))?,
        stabilizer: fields
            .get("stabilizer")
            .map_or(Ok(base.stabilizer), |node| stabilizer(&node))?,
        dynamics: fields
            .get("dynamics")
            .map_or(Ok(base.dynamics.clone()), |node| dynamics::read(&node, &base.dynamics))?,
        seed: fields.get("seed").map_or(Ok(base.seed), |node| seed(&node))?,
        ..base
    };
    brush_options::read(fields, brush)
}

/// `{ "turn": 0, "mirrored": false }`: how symmetry turned the stroke, degrees counter-clockwise as
/// seen.
fn facing(node: &JsonNode) -> Result<StrokeFrame> {
    let mut fields = node.fields()?;
    let facing = StrokeFrame {
        turn: fields.number("turn", 0.0, TURNS)?,
        is_mirrored: fields.boolean("mirrored", false)?,
    };
    fields.finish()?;
    Ok(facing)
}

/// `{ "hue": 0, "saturation": 0, "value": 0 }`: how far a dab's color may be from the stroke's,
/// hue in degrees.
fn jitter(node: &JsonNode, base: ColorJitter) -> Result<ColorJitter> {
    let mut fields = node.fields()?;
    let jitter = ColorJitter {
        hue_degrees: fields.number("hue", base.hue_degrees, ColorJitter::HUE_DEGREES)?,
        saturation: fields.number("saturation", base.saturation, UNIT)?,
        value: fields.number("value", base.value, UNIT)?,
    };
    fields.finish()?;
    Ok(jitter)
}

/// `{ "kind": "smudge", "length": 0.8 }`, `{ "kind": "blur", "width": 0.3 }` or
/// `{ "kind": "clone", "aligned": true, "picture": false }`; `{ "kind": "paint" }` is the default.
impl RecipeValue for BrushMode {
    fn to_json(&self) -> Value {
        let mut out = write_mode(*self);
        if *self == BrushMode::Paint {
            out.set("kind", "paint".into());
        }
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        const KINDS: [(usize, &str); 4] = [(0, "paint"), (1, "smudge"), (2, "blur"), (3, "clone")];
        let mut fields = node.fields()?;
        let mode = match fields.one_of("kind", &KINDS, 0)? {
            0 => BrushMode::Paint,
            1 => BrushMode::Smudge {
                length: fields.number("length", BrushMode::SMUDGE_LENGTH, BrushMode::SHARE)?,
            },
            2 => BrushMode::Blur {
                width: fields.number("width", BrushMode::BLUR_WIDTH, BrushMode::SHARE)?,
            },
            _ => BrushMode::Clone {
                aligned: fields.boolean("aligned", true)?,
                picture: fields.boolean("picture", false)?,
            },
        };
        fields.finish()?;
        Ok(mode)
    }
}

fn write_mode(mode: BrushMode) -> JsonObject {
    let mut out = JsonObject::default();
    match mode {
        BrushMode::Paint => {}
        BrushMode::Smudge { length } => {
            out.set("kind", "smudge".into());
            out.number("length", length, BrushMode::SMUDGE_LENGTH);
        }
        BrushMode::Blur { width } => {
            out.set("kind", "blur".into());
            out.number("width", width, BrushMode::BLUR_WIDTH);
        }
        BrushMode::Clone { aligned, picture } => {
            out.set("kind", "clone".into());
            out.flag("aligned", aligned, true);
            out.flag("picture", picture, false);
        }
    }
    out
}

/// `{ "average": 0.8 }`, `{ "string": 20 }`, `{ "lag": 0.1 }`, or `{}` for none.
fn stabilizer(node: &JsonNode) -> Result<Stabilizer> {
    let mut fields = node.fields()?;
    let average =
        fields.get("average").map(|weight| weight.number(Stabilizer::WEIGHT)).transpose()?;
    let string =
        fields.get("string").map(|length| length.number(Stabilizer::LENGTH_PX)).transpose()?;
    let lag = fields.get("lag").map(|secs| secs.number(Stabilizer::SECS)).transpose()?;
    fields.finish()?;
    match (average, string, lag) {
        (Some(weight), None, None) => Ok(Stabilizer::Average { weight }),
        (None, Some(length_px), None) => Ok(Stabilizer::String { length_px }),
        (None, None, Some(secs)) => Ok(Stabilizer::Lag { secs }),
        (None, None, None) => Ok(Stabilizer::None),
        _ => Err(node.refusal("has more than one of average, string and lag; it must have one")),
    }
}

fn seed(node: &JsonNode) -> Result<u32> {
    node.integer(0..=i64::from(u32::MAX)).map(|seed| seed as u32)
}

pub fn write_brush(brush: &Brush) -> JsonObject {
    let plain = Brush::default();
    let mut out = JsonObject::default();
    out.number("size", brush.size, plain.size);
    out.number("hardness", brush.hardness, plain.hardness);
    out.number("opacity", brush.opacity, plain.opacity);
    out.number("flow", brush.flow, plain.flow);
    out.number("spacing", brush.spacing, plain.spacing);
    out.number("rotation", brush.rotation, plain.rotation);
    let mut facing = JsonObject::default();
    facing.number("turn", brush.facing.turn, 0.0);
    facing.flag("mirrored", brush.facing.is_mirrored, false);
    out.object("facing", facing);
    out.number("softness", brush.softness, plain.softness);
    out.number("scatter", brush.scatter, plain.scatter);
    let mut jitter = JsonObject::default();
    jitter.number("hue", brush.jitter.hue_degrees, 0.0);
    jitter.number("saturation", brush.jitter.saturation, 0.0);
    jitter.number("value", brush.jitter.value, 0.0);
    out.object("jitter", jitter);
    out.word("blend", &BlendMode::ALL, brush.blend, plain.blend);
    out.flag("erases", brush.erases, plain.erases);
    out.flag("keeps_alpha", brush.keeps_alpha, plain.keeps_alpha);
    out.word("bounded", &PaintLimit::ALL, brush.bounded, plain.bounded);
    out.number("reach", brush.reach, plain.reach);
    out.object("mark", write_mode(brush.mode));
    tips::write_tip(&mut out, &brush.tip);
    tips::write_grain(&mut out, brush.grain.as_ref());
    tips::write_dual(&mut out, brush.dual.as_deref());
    match brush.stabilizer {
        Stabilizer::None => {}
        Stabilizer::Average { weight } => {
            out.set("stabilizer", json!({ "average": object::number(weight) }))
        }
        Stabilizer::String { length_px } => {
            out.set("stabilizer", json!({ "string": object::number(length_px) }))
        }
        Stabilizer::Lag { secs } => out.set("stabilizer", json!({ "lag": object::number(secs) })),
    }
    brush_options::write(&mut out, brush);
    out.object("dynamics", dynamics::write(&brush.dynamics, &plain.dynamics));
    if brush.seed != plain.seed {
        out.set("seed", brush.seed.into());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paint::{Input, Property};
    use std::path::Path;

    fn read(value: &Value) -> Result<Brush> {
        let mut fields = JsonNode::root(Path::new("r.json"), value).fields()?;
        let brush = settings(&mut fields, Brush::default())?;
        fields.finish()?;
        Ok(brush)
    }

    #[test]
    fn every_field_is_written_as_it_was_read() {
        let text = json!({
            "size": 20, "hardness": 0.25, "opacity": 0.5, "flow": 0.75, "spacing": 0.3, "rotation": 30, "softness": 0.1,
            "scatter": 2, "jitter": { "hue": 20, "saturation": 0.1, "value": 0.2 }, "blend": "multiply", "erases": true,
            "keeps_alpha": true, "bounded": "object", "reach": 2.5,
            "mark": { "kind": "smudge", "length": 0.5 }, "stabilizer": { "string": 25 },
            "dynamics": {
                "size": { "pressure": 0.1, "speed": [[0, 1], [1, 0.3]] },
                "flow": { "pressure": 0, "curvature": [[0, 0], [0.5, 1]] },
                "rotation": { "tilt-direction": 1 },
            },
            "seed": 4_000_000_000u32,
        });
        let brush = read(&text).unwrap();
        assert_eq!(write_brush(&brush).into_value(), text);
        assert!(brush.dynamics.curve(Property::Flow, Input::Pressure).is_none());
        assert_eq!(write_brush(&Brush::default()).into_value(), json!({}));
        let average = json!({ "stabilizer": { "average": 0.5 } });
        assert_eq!(write_brush(&read(&average).unwrap()).into_value(), average);
    }

    #[test]
    fn what_cannot_be_is_refused_in_a_sentence() {
        let says = |value: Value, what: &str| {
            let said = read(&value).err().map(|e| e.to_string()).unwrap_or_default();
            assert!(said.contains(what), "{said}");
        };
        says(json!({ "scatter": 11 }), "scatter: is 11; it must be between 0 and 10");
        says(json!({ "dynamics": { "size": { "presure": 1 } } }), "did you mean “pressure”?");
        says(json!({ "dynamics": { "sise": {} } }), "did you mean “size”?");
        says(
            json!({ "dynamics": { "size": { "tilt": [[1, 0], [0, 1]] } } }),
            "dynamics.size.tilt: is not a curve",
        );
        says(json!({ "dynamics": { "size": { "tilt": [] } } }), "is not a curve");
        says(json!({ "dynamics": { "size": { "tilt": [[0, 2]] } } }), "must be between 0 and 1");
        says(json!({ "stabilizer": { "string": 3, "average": 0.5 } }), "it must have one");
        says(json!({ "bounded": "objects" }), "must be one of free, surface, object");
        says(json!({ "mark": { "kind": "blur", "length": 1 } }), "length");
        says(json!({ "seed": -1 }), "seed: is -1");
        says(json!({ "blend": "mulitply" }), "must be one of normal");
    }
}
