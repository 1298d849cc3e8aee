//! Reads and writes paths: figures as numbers, nodes as lists of them. Floor 5. Not here: how they
//! are drawn (`paint::path`).

use super::value::RecipeValue;
use crate::Result;
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::math::{COORDINATE, Vec2, vec2};
use crate::paint::{
    Figure, FigureKind, LivePath, PanelDrag, PanelSettings, PathCap, PathGeometry, PathJoin,
    PathNode, PathRule, Subpath,
};
use serde_json::Value;

/// `{ "figure": { … } }` or `{ "lines": [ … ] }`, and how it looks.
impl RecipeValue for LivePath {
    fn to_json(&self) -> Value {
        let plain = LivePath::new(Vec::new());
        let mut out = JsonObject::default();
        match &self.geometry {
            PathGeometry::Figure(figure) => out.set("figure", figure.to_json()),
            PathGeometry::Nodes(lines) => {
                out.set("lines", lines.iter().map(RecipeValue::to_json).collect())
            }
        }
        out.set_some("fill", self.fill, object::color);
        out.word("rule", &PathRule::ALL, self.rule, plain.rule);
        out.number("outline", self.outline, plain.outline);
        out.color("outline_color", self.outline_color, plain.outline_color);
        out.word("cap", &PathCap::ALL, self.cap, plain.cap);
        out.word("join", &PathJoin::ALL, self.join, plain.join);
        if !self.dashes.is_empty() {
            out.set("dashes", self.dashes.iter().map(|dash| object::number(*dash)).collect());
        }
        out.flag("frames", self.frames, plain.frames);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let geometry = match (fields.get("figure"), fields.get("lines")) {
            (Some(figure), None) => PathGeometry::Figure(Figure::from_json(&figure)?),
            (None, Some(lines)) => PathGeometry::Nodes(read_lines(&lines)?),
            _ => return Err(node.refusal("needs either a “figure” or “lines”")),
        };
        let plain = LivePath::new(Vec::new());
        let path = LivePath {
            geometry,
            fill: fields.get("fill").map(|node| node.color()).transpose()?,
            rule: fields.one_of("rule", &PathRule::ALL, plain.rule)?,
            outline: fields.number("outline", plain.outline, LivePath::OUTLINE)?,
            outline_color: fields.color("outline_color", plain.outline_color)?,
            cap: fields.one_of("cap", &PathCap::ALL, plain.cap)?,
            join: fields.one_of("join", &PathJoin::ALL, plain.join)?,
            dashes: fields.get("dashes").map_or(Ok(Vec::new()), |node| read_dashes(&node))?,
            frames: fields.boolean("frames", plain.frames)?,
        };
        fields.finish()?;
        Ok(path)
    }
}

fn read_dashes(node: &JsonNode) -> Result<Vec<f32>> {
    let items = node.list(LivePath::MOST_DASHES)?;
    items.iter().map(|item| item.number(LivePath::DASH)).collect()
}

/// `{ "kind": "star", "from": [x, y], "to": [x, y], … }`.
impl RecipeValue for Figure {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        out.set("kind", self.kind.name().into());
        out.set("from", object::point(self.from));
        out.set("to", object::point(self.to));
        for setting in Figure::SETTINGS {
            out.number(setting.name, (setting.get)(self), (setting.get)(&Figure::DEFAULT));
        }
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let kind = fields.require("kind")?.one_of(&FigureKind::ALL)?;
        let (from, to) = (fields.require("from")?.point()?, fields.require("to")?.point()?);
        let mut figure = Figure { kind, from, to, ..Figure::DEFAULT };
        for setting in Figure::SETTINGS {
            let default = (setting.get)(&figure);
            let to = fields.number(setting.name, default, setting.range.clone())?;
            (setting.set)(&mut figure, to);
        }
        fields.finish()?;
        Ok(figure)
    }
}

/// `{ "rows": 3, "columns": 2, "margin": 40, … }`.
impl RecipeValue for PanelSettings {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        for setting in PanelSettings::SETTINGS {
            out.number(setting.name, (setting.get)(self), (setting.get)(&PanelSettings::DEFAULT));
        }
        let plain = PanelSettings::DEFAULT;
        out.color("border_color", self.border_color, plain.border_color);
        out.flag("paper", self.paper, plain.paper);
        out.color("paper_color", self.paper_color, plain.paper_color);
        out.flag("right_to_left", self.right_to_left, plain.right_to_left);
        out.word("drag", &PanelDrag::ALL, self.drag, plain.drag);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let mut settings = PanelSettings::DEFAULT;
        for setting in PanelSettings::SETTINGS {
            let default = (setting.get)(&settings);
            let to = fields.number(setting.name, default, setting.range.clone())?;
            (setting.set)(&mut settings, to);
        }
        settings.border_color = fields.color("border_color", settings.border_color)?;
        settings.paper = fields.boolean("paper", settings.paper)?;
        settings.paper_color = fields.color("paper_color", settings.paper_color)?;
        settings.right_to_left = fields.boolean("right_to_left", settings.right_to_left)?;
        settings.drag = fields.one_of("drag", &PanelDrag::ALL, settings.drag)?;
        fields.finish()?;
        Ok(settings)
    }
}

/// `{ "nodes": [ … ], "closed": true }`.
impl RecipeValue for Subpath {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        out.set("nodes", self.nodes.iter().map(write_node).collect());
        out.flag("closed", self.closed, false);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields: Fields = node.fields()?;
        let nodes = fields.require("nodes")?.list(LivePath::MOST_NODES)?;
        let nodes = nodes.iter().map(read_node).collect::<Result<Vec<_>>>()?;
        let line = Subpath { nodes, closed: fields.boolean("closed", false)? };
        fields.finish()?;
        Ok(line)
    }
}

fn read_lines(node: &JsonNode) -> Result<Vec<Subpath>> {
    let mut count = 0;
    let mut lines = Vec::new();
    for item in node.list(LivePath::MOST_LINES)? {
        let line = Subpath::from_json(&item)?;
        count += line.nodes.len();
        if count > LivePath::MOST_NODES {
            let most = LivePath::MOST_NODES;
            return Err(node.too_large(format!("has more than {most} nodes")));
        }
        lines.push(line);
    }
    Ok(lines)
}

/// `[x, y]`, and if it has them its handles, as steps from it, and its width:
/// `[x, y, before x, before y, after x, after y, width]`.
fn write_node(node: &PathNode) -> Value {
    let mut values: Vec<f32> = node.at.to_array().to_vec();
    let corner = PathNode::corner(node.at);
    if *node != corner {
        values.extend([node.before, node.after].iter().flat_map(|p| p.to_array()));
    }
    if node.width != corner.width {
        values.push(node.width);
    }
    values.into_iter().map(object::number).collect()
}

fn read_node(node: &JsonNode) -> Result<PathNode> {
    let values = node.numbers(2, 7, COORDINATE)?;
    let point = |i: usize| values.get(i..i + 2).map_or(Vec2::ZERO, |v| vec2(v[0], v[1]));
    if ![2, 6, 7].contains(&values.len()) {
        let count = values.len();
        return Err(node.refusal(format!("has {count} items; it must have 2, 6 or 7")));
    }
    let width = match node.list(7)?.get(6) {
        Some(width) => width.number(PathNode::WIDTH)?,
        None => 1.0,
    };
    Ok(PathNode { at: point(0), before: point(2), after: point(4), width })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::srgb::Color;
    use serde_json::json;
    use std::path::Path;

    fn read(json: &Value) -> Result<LivePath> {
        LivePath::from_json(&JsonNode::root(Path::new("a.json"), json))
    }

    #[test]
    fn a_path_is_read_as_it_was_written() {
        let mut nodes = vec![
            PathNode::corner(vec2(1.5, 2.0)),
            PathNode::smooth(vec2(30.0, -4.0), vec2(5.0, 0.25)),
            PathNode::corner(vec2(9.0, 90.0)),
        ];
        nodes[2].width = 0.5;
        let lines = vec![Subpath { nodes, closed: true }, Subpath::default()];
        let path = LivePath {
            outline: 3.0,
            outline_color: Color::WHITE,
            cap: PathCap::Round,
            join: PathJoin::Bevel,
            dashes: vec![4.0, 2.5],
            rule: PathRule::EvenOdd,
            frames: true,
            ..LivePath::new(lines).with_fill(Color::BLACK)
        };
        assert_eq!(read(&path.to_json()).unwrap(), path);
        let (from, to) = (vec2(1.0, 2.0), vec2(3.0, 4.0));
        for kind in FigureKind::ALL.map(|row| row.0) {
            let path = LivePath::new(Figure { kind, from, to, inner: 0.7, ..Figure::DEFAULT });
            assert_eq!(read(&path.to_json()).unwrap(), path);
        }
        let short = json!({ "lines": [{ "nodes": [[1, 2], [3, 4]] }], "fill": "#000000" });
        assert_eq!(read(&short).unwrap().to_json(), short);
    }

    #[test]
    fn what_a_path_cannot_be_is_named() {
        let refused = |json: Value| read(&json).unwrap_err().to_string();
        let box_of = |more: Value| {
            let mut figure = json!({ "kind": "star", "from": [0, 0], "to": [9, 9] });
            more.as_object().unwrap().iter().for_each(|(k, v)| figure[k] = v.clone());
            json!({ "figure": figure })
        };
        assert!(refused(json!({})).contains("“figure” or “lines”"));
        assert!(refused(json!({ "figure": {}, "lines": [] })).contains("either"));
        assert!(refused(box_of(json!({ "kind": "blob" }))).contains("figure.kind: is “blob”"));
        assert!(refused(box_of(json!({ "sides": 2 }))).contains("figure.sides: is 2"));
        let node = |node: Value| refused(json!({ "lines": [{ "nodes": [node] }] }));
        assert!(node(json!([1, 2, 3])).contains("lines[0].nodes[0]: has 3 items; it must have 2"));
        assert!(node(json!([1, 2, 0, 0, 0, 0, -1])).contains("nodes[0][6]: is -1"));
        assert!(refused(json!({ "lines": [], "dashes": [-1] })).contains("dashes[0]: is -1"));
        assert!(refused(json!({ "lines": [], "outline": 9999 })).contains("outline: is 9999"));
    }
}
