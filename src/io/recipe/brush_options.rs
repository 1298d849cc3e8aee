//! A brush's options: the numbers of [`SETTINGS`], and the other choices. Read and written. Floor 5.
//! Not here: ranges and defaults (`paint::brush_options`).

use crate::Result;
use crate::json::{Fields, JsonObject};
use crate::paint::brush_options::Bearing;
use crate::paint::settings::{GROUPS, SETTINGS};
use crate::paint::{Brush, DistanceMetric, Falloff, Offset, Spread};

/// What is absent stays as it is in `base`.
pub fn read(fields: &mut Fields, base: Brush) -> Result<Brush> {
    let mut brush = base;
    brush.falloff = fields.one_of("falloff", &Falloff::ALL, brush.falloff)?;
    brush.spread = fields.one_of("spread", &Spread::ALL, brush.spread)?;
    brush.spacing_on = fields.one_of("spacing_on", &DistanceMetric::ALL, brush.spacing_on)?;
    brush.stabilizer_on =
        fields.one_of("stabilizer_on", &DistanceMetric::ALL, brush.stabilizer_on)?;
    for group in GROUPS {
        if group.is_empty() {
            numbers(fields, group, &mut brush)?;
        } else if let Some(node) = fields.get(group) {
            let mut fields = node.fields()?;
            numbers(&mut fields, group, &mut brush)?;
            if group == "offset" {
                brush.offset.from = fields.one_of("from", &Bearing::ALL, brush.offset.from)?;
                brush.offset.alternates = fields.boolean("alternates", brush.offset.alternates)?;
            }
            fields.finish()?;
        }
    }
    Ok(brush)
}

fn numbers(fields: &mut Fields, group: &str, brush: &mut Brush) -> Result<()> {
    for setting in SETTINGS.iter().filter(|setting| setting.group == group) {
        let value =
            fields.number(setting.number.name, setting.of(brush), setting.number.range.clone())?;
        setting.set(brush, value);
    }
    Ok(())
}

pub fn write(out: &mut JsonObject, brush: &Brush) {
    out.word("falloff", &Falloff::ALL, brush.falloff, Falloff::default());
    out.word("spread", &Spread::ALL, brush.spread, Spread::default());
    out.word("spacing_on", &DistanceMetric::ALL, brush.spacing_on, DistanceMetric::default());
    out.word("stabilizer_on", &DistanceMetric::ALL, brush.stabilizer_on, DistanceMetric::default());
    for group in GROUPS {
        let mut own = JsonObject::default();
        let numbers = if group.is_empty() { &mut *out } else { &mut own };
        for setting in SETTINGS.iter().filter(|setting| setting.group == group) {
            numbers.number(setting.number.name, setting.of(brush), setting.default());
        }
        if group == "offset" {
            let plain = Offset::default();
            own.word("from", &Bearing::ALL, brush.offset.from, plain.from);
            own.flag("alternates", brush.offset.alternates, plain.alternates);
        }
        if !group.is_empty() {
            out.object(group, own);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::json::JsonNode;
    use serde_json::{Value, json};
    use std::path::Path;

    fn read_text(value: &Value) -> Result<Brush> {
        let mut fields = JsonNode::root(Path::new("b.json"), value).fields()?;
        let brush = read(&mut fields, Brush::default())?;
        fields.finish()?;
        Ok(brush)
    }

    fn written(brush: &Brush) -> Value {
        let mut out = JsonObject::default();
        write(&mut out, brush);
        out.into_value()
    }

    #[test]
    fn every_number_of_a_brush_is_written_and_read_at_both_ends_of_its_range() {
        for setting in &SETTINGS {
            for end in [*setting.number.range.start(), *setting.number.range.end()] {
                let mut brush = Brush::default();
                setting.set(&mut brush, end);
                let text = written(&brush);
                let back = read_text(&text)
                    .unwrap_or_else(|error| panic!("{}: {error}", setting.number.label));
                assert_eq!(setting.of(&back), end, "{text}");
            }
        }
        assert_eq!(written(&Brush::default()), json!({}));
    }

    #[test]
    fn choices_are_written_as_they_were_read_and_what_is_no_setting_is_refused() {
        let text = json!({
            "falloff": "peaked", "spread": "cloud", "spacing_on": "surface", "stabilizer_on": "surface",
            "offset": { "amount": 0.5, "from": "stroke", "alternates": true },
        });
        assert_eq!(written(&read_text(&text).unwrap()), text);
        let said =
            |text: Value| read_text(&text).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(said(json!({ "pickup": { "amount": 2 } })).contains("pickup.amount"));
        assert!(said(json!({ "hand": { "tremors": 1 } })).contains("tremors"));
    }
}
