//! Reads and writes the effects of layers by the settings that each kind has, and their common
//! light. Floor 5.

use super::images::stops;
use super::value::RecipeValue;
use crate::document::{Document, Layer};
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::math::Size;
use crate::paint::adjustment::ToneCurve;
use crate::paint::effect::{EffectField, EffectPattern};
use crate::paint::{EffectKind, EffectLight, GradientStop, LayerEffect};
use crate::{Result, base64};
use serde_json::Value;
use std::sync::Arc;

/// A list of `{ "kind": …, and what differs from how such an effect begins }`.
pub fn read(node: &JsonNode) -> Result<Vec<LayerEffect>> {
    node.list(LayerEffect::MOST)?.iter().map(LayerEffect::from_json).collect()
}

/// Absent ones are not written.
pub fn write(out: &mut JsonObject, layer: &Layer) {
    if !layer.effects.is_empty() {
        out.set("effects", layer.effects.iter().map(LayerEffect::to_json).collect());
    }
    out.number("fill_opacity", layer.fill_opacity, 1.0);
}

/// `{ "angle", "altitude" }`, degrees.
pub fn read_light(node: &JsonNode) -> Result<EffectLight> {
    let (mut fields, plain) = (node.fields()?, EffectLight::default());
    let angle = fields.number("angle", plain.angle, EffectLight::ANGLE)?;
    let altitude = fields.number("altitude", plain.altitude, EffectLight::ALTITUDE)?;
    fields.finish()?;
    Ok(EffectLight { angle, altitude })
}

/// The light, unless it is as it begins.
pub fn write_light(out: &mut JsonObject, light: EffectLight) {
    let plain = EffectLight::default();
    let mut written = JsonObject::default();
    written.number("angle", light.angle, plain.angle);
    written.number("altitude", light.altitude, plain.altitude);
    out.object("effect_light", written);
}

/// Whether the first version has no words for what is there.
pub fn is_needed(document: &Document) -> bool {
    let has_some = |layer: &Layer| !layer.effects.is_empty() || layer.fill_opacity < 1.0;
    document.effect_light != EffectLight::default()
        || document.walk().iter().any(|(_, layer)| has_some(layer))
}

impl RecipeValue for EffectLight {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        out.set("angle", object::number(self.angle));
        out.set("altitude", object::number(self.altitude));
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        read_light(node)
    }
}

impl RecipeValue for LayerEffect {
    fn to_json(&self) -> Value {
        let (mut out, plain) = (JsonObject::default(), LayerEffect::new(self.kind));
        out.set("kind", self.kind.name().into());
        out.flag("on", self.on, true);
        for field in self.kind.fields() {
            write_field(&mut out, field, self, &plain);
        }
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let mut effect = LayerEffect::new(fields.require("kind")?.one_of(&EffectKind::ALL)?);
        effect.on = fields.boolean("on", true)?;
        for field in effect.kind.fields() {
            read_field(&mut fields, field, &mut effect)?;
        }
        fields.finish()?;
        Ok(effect)
    }
}

fn read_field(fields: &mut Fields, field: EffectField, effect: &mut LayerEffect) -> Result<()> {
    let all = &mut effect.settings;
    match field {
        EffectField::Number(number) => {
            let before = (number.get)(all);
            (number.set)(all, fields.number(number.name, before, number.range.clone())?);
        }
        EffectField::Flag(flag) => {
            let before = (flag.get)(all);
            (flag.set)(all, fields.boolean(flag.name, before)?);
        }
        EffectField::Color(color) => {
            let before = (color.get)(all);
            (color.set)(all, fields.color(color.name, before)?);
        }
        EffectField::Choice(choice) => {
            let names = (choice.choices)();
            let names: Vec<(usize, &str)> =
                names.iter().enumerate().map(|(i, (name, _))| (i, *name)).collect();
            if let Some(node) = fields.get(choice.name) {
                (choice.set)(all, node.one_of(&names)?);
            }
        }
        EffectField::Stops => {
            if let Some(node) = fields.get("stops") {
                effect.stops = stops(&node)?;
            }
        }
        EffectField::Contour => {
            if let Some(node) = fields.get("contour") {
                effect.contour = contour(&node)?;
            }
        }
        EffectField::Pattern => {
            if let Some(node) = fields.get("pattern") {
                effect.pattern = Some(Arc::new(pattern(&node)?));
            }
        }
    }
    Ok(())
}

fn write_field(
    out: &mut JsonObject,
    field: EffectField,
    effect: &LayerEffect,
    plain: &LayerEffect,
) {
    let (all, before) = (&effect.settings, &plain.settings);
    match field {
        EffectField::Number(number) => {
            out.number(number.name, (number.get)(all), (number.get)(before));
        }
        EffectField::Flag(flag) => out.flag(flag.name, (flag.get)(all), (flag.get)(before)),
        EffectField::Color(color) => out.color(color.name, (color.get)(all), (color.get)(before)),
        EffectField::Choice(choice) => {
            let chosen = (choice.get)(all);
            if let Some((name, _)) =
                (choice.choices)().get(chosen).filter(|_| chosen != (choice.get)(before))
            {
                out.set(choice.name, (*name).into());
            }
        }
        EffectField::Stops if effect.stops != plain.stops => {
            out.set("stops", effect.stops.iter().map(GradientStop::to_json).collect());
        }
        EffectField::Contour if !effect.contour.is_straight() => {
            let point = |p: &[f32; 2]| Value::from(p.map(object::number).to_vec());
            out.set("contour", effect.contour.points().iter().map(point).collect());
        }
        EffectField::Pattern => {
            out.set_some("pattern", effect.pattern.as_deref(), write_pattern);
        }
        EffectField::Stops | EffectField::Contour => {}
    }
}

/// Points `[before, after]` of a curve, 0 to 255.
pub fn contour(node: &JsonNode) -> Result<ToneCurve> {
    let items = node.list(ToneCurve::MOST_POINTS)?;
    let point = |item: &JsonNode| item.numbers(2, 2, 0.0..=255.0).map(|p| [p[0], p[1]]);
    let points: Vec<[f32; 2]> = items.iter().map(point).collect::<Result<_>>()?;
    let curve = ToneCurve::new(points.clone());
    if curve.points() == points {
        return Ok(curve);
    }
    Err(node
        .refusal("needs two points or more, the first number of each at least 1 above the last"))
}

/// `{ "name", "width", "height", "pixels": base64 of straight RGBA }`.
fn pattern(node: &JsonNode) -> Result<EffectPattern> {
    let mut fields = node.fields()?;
    let name = fields.get("name").map_or(Ok(""), |name| name.text())?;
    let mut side = |name| fields.require(name)?.whole(1..=EffectPattern::LONGEST_PX);
    let size = Size::new(side("width")?, side("height")?);
    let pixels = fields.require("pixels")?;
    let bytes = base64::decode(pixels.text()?);
    fields.finish()?;
    bytes
        .and_then(|bytes| EffectPattern::new(name, size, bytes))
        .ok_or_else(|| pixels.refusal(format!("are not four bytes for each pixel of {size}")))
}

fn write_pattern(pattern: &EffectPattern) -> Value {
    let (size, rgba) = pattern.picture();
    let mut out = JsonObject::default();
    out.text("name", pattern.name(), "");
    out.set("width", size.width.into());
    out.set("height", size.height.into());
    out.set("pixels", base64::encode(rgba).into());
    out.into_value()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::path::Path;

    fn read_one(value: &Value) -> Result<LayerEffect> {
        LayerEffect::from_json(&JsonNode::root(Path::new("r.json"), value))
    }

    #[test]
    fn every_effect_is_read_as_it_was_written() {
        for (kind, _) in EffectKind::ALL {
            let effect = LayerEffect::new(kind);
            assert_eq!(effect.to_json(), json!({ "kind": kind.name() }));
            assert_eq!(read_one(&effect.to_json()).unwrap(), effect);
        }
        for value in [
            json!({ "kind": "drop-shadow", "on": false, "size": 12.5, "document_light": false }),
            json!({ "kind": "stroke", "fill": "gradient", "stops": [[0, "#ff0000"], [1, "#00ff00"]] }),
            json!({ "kind": "outer-glow", "contour": [[0, 0], [128, 200], [255, 255]] }),
            json!({ "kind": "bevel", "shade_blend": "normal", "shade_color": "#102030" }),
            json!({ "kind": "pattern-overlay", "pattern": {
                "name": "dots", "width": 1, "height": 2, "pixels": base64::encode(&[9; 8]) } }),
        ] {
            assert_eq!(read_one(&value).unwrap().to_json(), value);
        }
    }

    #[test]
    fn what_cannot_be_is_refused_by_its_path() {
        for (value, why) in [
            (json!({}), "kind: is missing"),
            (json!({ "kind": "drop-shadow", "size": -3 }), "size: is -3"),
            (json!({ "kind": "satin", "spread": 0.5 }), "spread"),
            (json!({ "kind": "stroke", "position": "around" }), "must be one of"),
            (
                json!({ "kind": "pattern-overlay", "pattern": {
                "width": 2, "height": 2, "pixels": "AAAA" } }),
                "pattern.pixels",
            ),
        ] {
            let refused = read_one(&value).unwrap_err().to_string();
            assert!(refused.contains(why), "{refused}");
        }
    }
}
