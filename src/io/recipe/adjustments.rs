//! Reads and writes adjustments of colors and filters by the parameters that they show. Floor 5. Each
//! is an object of its own within a layer: its kind, and what differs from how it begins.

use super::effects::contour;
use super::images::stops;
use super::value::RecipeValue;
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::math::srgb::Color;
use crate::paint::adjustment::{
    ColorTable, NumberParameter, ParameterName, ParameterVisitor, ToneCurve,
};
use crate::paint::{ColorAdjustment, GradientStop, PictureFilter};
use crate::{Result, base64};
use serde_json::Value;

impl RecipeValue for ColorAdjustment {
    fn to_json(&self) -> Value {
        write(self.name(), |writer| self.clone().visit(writer))
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        read(node, &Self::all(), Self::name, Self::visit)
    }
}

impl RecipeValue for PictureFilter {
    fn to_json(&self) -> Value {
        write(self.name(), |writer| self.clone().visit(writer))
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        read(node, &Self::all(), Self::name, Self::visit)
    }
}

/// The kind, and the parameters that are shown to a writer.
fn write(kind: &str, show: impl FnOnce(&mut dyn ParameterVisitor)) -> Value {
    let mut out = JsonObject::default();
    out.set("kind", kind.into());
    let mut writer = ParameterWriter(out);
    show(&mut writer);
    writer.0.into_value()
}

/// The kind that is named, with its parameters.
fn read<T: Clone>(
    node: &JsonNode,
    kinds: &[T],
    name: fn(&T) -> &'static str,
    show: fn(&mut T, &mut dyn ParameterVisitor),
) -> Result<T> {
    let mut fields = node.fields()?;
    let names: Vec<(usize, &str)> =
        kinds.iter().enumerate().map(|(i, kind)| (i, name(kind))).collect();
    let mut own = kinds[fields.require("kind")?.one_of(&names)?].clone();
    let mut reader = ParameterReader { fields, read: Ok(()) };
    show(&mut own, &mut reader);
    reader.read?;
    reader.fields.finish()?;
    Ok(own)
}

/// Reads each parameter; the first refusal ends it.
struct ParameterReader<'a> {
    fields: Fields<'a>,
    read: Result<()>,
}

impl<'a> ParameterReader<'a> {
    fn take<T>(
        &mut self,
        key: &'static str,
        value: &mut T,
        read: impl FnOnce(&JsonNode<'a>) -> Result<T>,
    ) {
        if self.read.is_ok()
            && let Some(node) = self.fields.get(key)
        {
            match read(&node) {
                Ok(found) => *value = found,
                Err(error) => self.read = Err(error),
            }
        }
    }
}

impl ParameterVisitor for ParameterReader<'_> {
    fn number(&mut self, parameter: NumberParameter, value: &mut f32) {
        self.take(parameter.name.key, value, |node| node.number(parameter.range()));
    }

    fn flag(&mut self, name: ParameterName, _: bool, value: &mut bool) {
        self.take(name.key, value, |node| node.boolean());
    }

    fn color(&mut self, name: ParameterName, _: Color, value: &mut Color) {
        self.take(name.key, value, |node| node.color());
    }

    fn curve(&mut self, name: ParameterName, value: &mut ToneCurve) {
        self.take(name.key, value, contour);
    }

    fn stops(&mut self, name: ParameterName, value: &mut Vec<GradientStop>) {
        self.take(name.key, value, stops);
    }

    fn table(&mut self, name: ParameterName, value: &mut Option<ColorTable>) {
        self.take(name.key, value, |node| table(node).map(Some));
    }

    fn group(&mut self, name: ParameterName, inside: &mut dyn FnMut(&mut dyn ParameterVisitor)) {
        self.take(name.key, &mut (), |node| {
            let mut reader = ParameterReader { fields: node.fields()?, read: Ok(()) };
            inside(&mut reader);
            reader.read?;
            reader.fields.finish()
        });
    }
}

/// `{ "title", "side", "separate", "values": base64 of 16-bit numbers, the low byte first }`.
fn table(node: &JsonNode) -> Result<ColorTable> {
    let mut fields = node.fields()?;
    let title = fields.get("title").map_or(Ok(""), |title| title.text())?;
    let side = fields.require("side")?.whole(2..=ColorTable::MOST_SEPARATE as u32)? as usize;
    let is_separate = fields.boolean("separate", false)?;
    let values = fields.require("values")?;
    let bytes = base64::decode(values.text()?);
    fields.finish()?;
    let read = |bytes: Vec<u8>| {
        let pairs = bytes.as_chunks().0;
        let values = pairs.iter().map(|pair| u16::from_le_bytes(*pair)).collect();
        ColorTable::new(title, side, is_separate, values).filter(|_| bytes.len().is_multiple_of(2))
    };
    bytes.and_then(read).ok_or_else(|| {
        values.refusal(format!("are not those of a table with {side} entries along its side"))
    })
}

/// Writes what differs from how an adjustment begins.
struct ParameterWriter(JsonObject);

impl ParameterVisitor for ParameterWriter {
    fn number(&mut self, parameter: NumberParameter, value: &mut f32) {
        self.0.number(parameter.name.key, *value, parameter.default);
    }

    fn flag(&mut self, name: ParameterName, default: bool, value: &mut bool) {
        self.0.flag(name.key, *value, default);
    }

    fn color(&mut self, name: ParameterName, default: Color, value: &mut Color) {
        self.0.color(name.key, *value, default);
    }

    fn curve(&mut self, name: ParameterName, value: &mut ToneCurve) {
        if !value.is_straight() {
            let point = |p: &[f32; 2]| Value::from(p.map(object::number).to_vec());
            self.0.set(name.key, value.points().iter().map(point).collect());
        }
    }

    fn stops(&mut self, name: ParameterName, value: &mut Vec<GradientStop>) {
        self.0.set(name.key, value.iter().map(GradientStop::to_json).collect());
    }

    fn table(&mut self, name: ParameterName, value: &mut Option<ColorTable>) {
        let Some(table) = value else { return };
        let mut out = JsonObject::default();
        out.text("title", table.title(), "");
        out.set("side", table.side().into());
        out.flag("separate", table.is_separate(), false);
        let bytes: Vec<u8> = table.values().iter().flat_map(|v| v.to_le_bytes()).collect();
        out.set("values", base64::encode(&bytes).into());
        self.0.set(name.key, out.into_value());
    }

    fn group(&mut self, name: ParameterName, inside: &mut dyn FnMut(&mut dyn ParameterVisitor)) {
        let mut writer = ParameterWriter(JsonObject::default());
        inside(&mut writer);
        self.0.object(name.key, writer.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::path::Path;

    fn read_adjustment(value: &Value) -> Result<ColorAdjustment> {
        ColorAdjustment::from_json(&JsonNode::root(Path::new("r.json"), value))
    }

    #[test]
    fn every_adjustment_is_read_as_it_was_written() {
        for adjustment in ColorAdjustment::all() {
            assert_eq!(read_adjustment(&adjustment.to_json()).unwrap(), adjustment);
        }
        let changed = json!({
            "kind": "levels",
            "master": { "black": 12, "gamma": 1.25 },
            "blue": { "out_white": 200 }
        });
        let levels = read_adjustment(&changed).unwrap();
        assert_eq!(levels.to_json(), changed);
        let curves = json!({ "kind": "curves", "red": [[0, 10], [128.5, 90], [255, 255]] });
        assert_eq!(read_adjustment(&curves).unwrap().to_json(), curves);
        let values = base64::encode(&[7; 48]);
        let table = json!({ "kind": "color-lookup", "table": { "side": 2, "values": values } });
        assert_eq!(read_adjustment(&table).unwrap().to_json(), table);
    }

    #[test]
    fn every_filter_is_read_as_it_was_written() {
        let filter =
            |value: &Value| PictureFilter::from_json(&JsonNode::root(Path::new("r.json"), value));
        for own in PictureFilter::all() {
            assert_eq!(filter(&own.to_json()).unwrap(), own);
        }
        let changed = json!({ "kind": "unsharp-mask", "radius": 1.5, "threshold": 3 });
        assert_eq!(filter(&changed).unwrap().to_json(), changed);
        let refused = filter(&json!({ "kind": "gaussian-blur", "radius": -1 })).unwrap_err();
        assert!(refused.to_string().contains("radius: is -1"), "{refused}");
    }

    #[test]
    fn what_cannot_be_is_refused_by_its_path() {
        for (value, why) in [
            (json!({}), "kind: is missing"),
            (json!({ "kind": "level" }), "must be one of"),
            (json!({ "kind": "levels", "master": { "black": 900 } }), "master.black: is 900"),
            (json!({ "kind": "levels", "mastr": {} }), "did you mean “master”"),
            (json!({ "kind": "curves", "red": [[9, 0], [3, 0]] }), "red: needs two points"),
            (json!({ "kind": "color-lookup", "table": { "side": 2, "values": "AAAA" } }), "values"),
            (json!({ "kind": "gradient-map", "stops": [] }), "at least one stop"),
        ] {
            let refused = read_adjustment(&value).unwrap_err().to_string();
            assert!(refused.contains(why), "{refused}");
        }
    }
}
