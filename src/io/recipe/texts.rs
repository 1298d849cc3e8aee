//! Reads and writes texts. Floor 5. Not here: their outlines (`text`).

use super::value::RecipeValue;
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::paint::{Subpath, Text, TextAlign, TextPath, TextRun, TextStyle};
use crate::{Error, Result};
use serde_json::Value;

/// `{ "string": "…", "size": 48, … }`, the style of all of it; or `"runs"`, pieces with their own.
impl RecipeValue for Text {
    fn to_json(&self) -> Value {
        let (mut out, plain) = (JsonObject::default(), Text::default());
        if let [run] = &self.runs[..] {
            write_run(&mut out, run);
        } else {
            let run = |run: &TextRun| {
                let mut out = JsonObject::default();
                write_run(&mut out, run);
                out.into_value()
            };
            out.set("runs", self.runs.iter().map(run).collect());
        }
        out.word("align", &TextAlign::ALL, self.align, plain.align);
        out.number("leading", self.leading, plain.leading);
        out.number("width", self.width, plain.width);
        out.flag("vertical", self.vertical, plain.vertical);
        out.number("arc", self.arc, plain.arc);
        out.set_some("path", self.path.as_ref(), RecipeValue::to_json);
        if self.origin != plain.origin {
            out.set("origin", object::point(self.origin));
        }
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let plain = Text::default();
        let runs = match fields.get("runs") {
            Some(runs) => {
                runs.list(Text::MOST_RUNS)?.iter().map(run).collect::<Result<Vec<_>>>()?
            }
            None => vec![read_run(&mut fields)?],
        };
        let text = Text {
            runs,
            align: fields.one_of("align", &TextAlign::ALL, plain.align)?,
            leading: fields.number("leading", plain.leading, Text::LEADING)?,
            width: fields.number("width", plain.width, Text::WIDTH)?,
            vertical: fields.boolean("vertical", plain.vertical)?,
            arc: fields.number("arc", plain.arc, Text::ARC)?,
            path: fields.get("path").map(|node| TextPath::from_json(&node)).transpose()?,
            origin: fields.point("origin", plain.origin)?,
        };
        fields.finish()?;
        let letters: usize = text.runs.iter().map(|run| run.string.chars().count()).sum();
        if letters > Text::MOST_LETTERS {
            let most = Text::MOST_LETTERS;
            return Err(node.too_large(format!("has {letters} letters; {most} are allowed")));
        }
        Ok(text)
    }
}

/// `{ "line": { "nodes": [ … ] }, "shift": 12 }`.
impl RecipeValue for TextPath {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        out.set("line", self.line.to_json());
        out.number("shift", self.shift, 0.0);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let line = Subpath::from_json(&fields.require("line")?)?;
        let path = TextPath { line, shift: fields.number("shift", 0.0, Text::SHIFT)? };
        fields.finish()?;
        Ok(path)
    }
}

fn run(node: &JsonNode) -> Result<TextRun> {
    let mut fields = node.fields()?;
    let run = read_run(&mut fields)?;
    fields.finish()?;
    Ok(run)
}

fn read_run(fields: &mut Fields) -> Result<TextRun> {
    let plain = TextStyle::default();
    let string = fields.require("string")?.text()?.to_owned();
    let family = fields.get("font").map(|node| family(&node)).transpose()?;
    let weight = fields.get("weight").map(|node| {
        let (least, most) = (*TextStyle::WEIGHT.start(), *TextStyle::WEIGHT.end());
        node.whole(u32::from(least)..=u32::from(most))
    });
    let weight = weight.transpose()?.and_then(|weight| u16::try_from(weight).ok());
    let style = TextStyle {
        family: family.unwrap_or_default(),
        size: fields.number("size", plain.size, TextStyle::SIZE)?,
        weight: weight.unwrap_or(plain.weight),
        italic: fields.boolean("italic", plain.italic)?,
        color: fields.color("color", plain.color)?,
        tracking: fields.number("tracking", plain.tracking, TextStyle::TRACKING)?,
        kerning: fields.boolean("kerning", plain.kerning)?,
        outline: fields.number("outline", plain.outline, TextStyle::OUTLINE)?,
        outline_color: fields.color("outline_color", plain.outline_color)?,
    };
    Ok(TextRun { string, style })
}

fn family(node: &JsonNode) -> Result<String, Error> {
    let family = node.text()?;
    match family.chars().count() > TextStyle::LONGEST_FAMILY {
        true => Err(node.refusal(format!("is longer than {}", TextStyle::LONGEST_FAMILY))),
        false => Ok(family.to_owned()),
    }
}

fn write_run(out: &mut JsonObject, run: &TextRun) {
    let plain = TextStyle::default();
    let TextStyle { family, size, weight, italic, color, tracking, .. } = &run.style;
    out.set("string", run.string.as_str().into());
    out.text("font", family, &plain.family);
    out.number("size", *size, plain.size);
    out.number("weight", f32::from(*weight), f32::from(plain.weight));
    out.flag("italic", *italic, plain.italic);
    out.color("color", *color, plain.color);
    out.number("tracking", *tracking, plain.tracking);
    out.flag("kerning", run.style.kerning, plain.kerning);
    out.number("outline", run.style.outline, plain.outline);
    out.color("outline_color", run.style.outline_color, plain.outline_color);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use crate::paint::PathNode;

    #[test]
    fn a_text_is_read_as_it_was_written() {
        let style = TextStyle { weight: 700, tracking: -20.0, ..TextStyle::default() };
        let mut text = Text::new("Ink & <gold>\n“ß”", style).styled(4, 9, |style| {
            style.family = "Noto Sans".into();
            style.outline = 2.5;
        });
        (text.arc, text.width, text.origin) = (90.0, 200.0, vec2(1.0, 30.0));
        assert_eq!(Text::from_value(&text.to_json()), Ok(text.clone()));
        let nodes = vec![
            PathNode::smooth(vec2(1.0, 2.0), vec2(9.0, 0.0)),
            PathNode::corner(vec2(90.0, 4.5)),
        ];
        text.path = Some(TextPath { line: Subpath { nodes, closed: true }, shift: -3.5 });
        assert_eq!(Text::from_value(&text.to_json()), Ok(text));
        let short = Text::new("Hello", TextStyle::default());
        assert_eq!(short.to_json(), serde_json::json!({ "string": "Hello" }));
    }

    #[test]
    fn what_a_text_cannot_be_is_named() {
        let refused = |json: serde_json::Value| {
            let node = JsonNode::root(std::path::Path::new("a.json"), &json);
            Text::from_json(&node).unwrap_err().to_string()
        };
        assert!(refused(serde_json::json!({ "size": 5 })).contains("string"));
        assert!(refused(serde_json::json!({ "string": "a", "size": 0 })).contains("size"));
        assert!(refused(serde_json::json!({ "string": "a", "weight": 1001 })).contains("weight"));
        let long = "x".repeat(Text::MOST_LETTERS + 1);
        assert!(refused(serde_json::json!({ "string": long })).contains("letters"));
    }
}
