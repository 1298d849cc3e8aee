//! Lines of stories whose numbers and places are drawn from dice.

use super::Dice;
use crate::document::Document;
use serde_json::{Value, json};
use std::path::PathBuf;

/// A ball, a part of a layer, touches and a long stroke of sculpting, and layers that lie on them,
/// one in a group.
pub const SHAPED: &str = r#"
{"in":"part","do":"add","kind":"sphere"}
{"in":"part","do":"set","part":{"id":"part-1","kind":"sweep","balls":[[20,18,14],[30,22,9]],"raise":2},"done":true}
{"in":"layer","do":"select","layer":"0"}
{"in":"part","do":"add","kind":"inflate"}
{"in":"layer","do":"home","layer":"3","part":"part-1"}
{"in":"layer","do":"group","layer":["1","2"]}
{"in":"layer","do":"home","layer":"1","part":"part-1"}
{"in":"layer","do":"home","layer":"1.0","part":"canvas"}"#;

const CANVAS: &[&str] = &["crop", "size", "scale", "turn", "quarter", "mirror", "scale evenly"];
const LAYER: &[&str] = &[
    "matrix",
    "quad",
    "no transform",
    "turn",
    "mirror",
    "take along",
    "group",
    "ungroup",
    "into",
    "out",
    "home",
    "home canvas",
    "no home",
    "apply",
    "mesh",
    "duplicate",
    "merge",
    "bake",
    "mask",
    "derived mask",
    "delete",
];
const PART: &[&str] = &[
    "sphere",
    "box",
    "inflate",
    "inflate selection",
    "bevel",
    "lathe",
    "sweep",
    "touches",
    "sculpt",
    "lines",
    "relief",
    "profiles",
    "set",
    "order",
    "copy",
    "delete part",
    "hide",
    "take shape",
    "sculpted",
    "touched",
];
const OTHER: &[&str] = &[
    "region",
    "select",
    "keep",
    "forget",
    "stroke",
    "undo",
    "redo",
    "add maps",
    "replace maps",
    "guides",
    "lasso",
    "liquify",
];

/// One line, or some that belong together.
#[allow(clippy::too_many_lines, reason = "a table: one row for each of its kinds")]
pub fn line(dice: &mut Dice, document: &Document, maps: &[PathBuf; 3]) -> String {
    let pool: Vec<&str> =
        CANVAS.iter().chain(CANVAS).chain(LAYER).chain(PART).chain(OTHER).copied().collect();
    let what = *dice.one(&pool);
    let paths: Vec<String> =
        document.walk().into_iter().map(|(path, _)| as_replayed(&path)).collect();
    let layer = if paths.is_empty() { "0".to_owned() } else { dice.one(&paths).clone() };
    let other = if paths.is_empty() { "0".to_owned() } else { dice.one(&paths).clone() };
    let ids: Vec<String> = document.parts.list.iter().map(|part| part.id.clone()).collect();
    let part = if ids.is_empty() { "part-1".to_owned() } else { dice.one(&ids).clone() };
    let (w, h) = (document.size.width as f32, document.size.height as f32);
    let at = |dice: &mut Dice| [dice.number(-0.2 * w, 1.2 * w), dice.number(-0.2 * h, 1.2 * h)];
    let map = |dice: &mut Dice| {
        let sides = [
            dice.number(0.4, 1.8),
            dice.number(-0.5, 0.5),
            dice.number(-0.5, 0.5),
            dice.number(0.4, 1.8),
        ];
        let [a, b, c, d] = sides.map(f64::from);
        let sign = if dice.below(4) == 0 { -1.0 } else { 1.0 };
        [
            sign * a,
            b,
            sign * c,
            d,
            f64::from(dice.number(-20.0, 20.0)),
            f64::from(dice.number(-20.0, 20.0)),
        ]
    };
    let angle =
        |dice: &mut Dice| [15.0, 30.0, 45.0, -7.0, dice.number(-180.0, 180.0)][dice.below(5)];
    let side = |dice: &mut Dice| 8 + dice.below(64);
    let add = |kind: &str| json!({ "in": "part", "do": "add", "kind": kind });
    let set =
        |to: Value| json!({ "in": "layer", "do": "set", "layer": layer, "to": to, "done": true });
    let value = match what {
        "crop" => {
            let (x0, y0) = (dice.number(-12.0, 20.0) as i32, dice.number(-12.0, 16.0) as i32);
            let (x1, y1) = (x0 + side(dice) as i32, y0 + side(dice) as i32);
            json!({ "in": "canvas", "do": "crop", "to": { "x0": x0, "y0": y0, "x1": x1, "y1": y1 } })
        }
        "size" => {
            let anchor = dice.one(&["center", "top-left", "bottom", "right"]);
            json!({ "in": "canvas", "do": "size", "width": side(dice), "height": side(dice), "anchor": anchor })
        }
        "scale" => {
            let filter = dice.one(&["smooth", "nearest", "sharp", "linear"]);
            json!({ "in": "canvas", "do": "scale", "width": side(dice), "height": side(dice), "filter": filter })
        }
        "scale evenly" => {
            let by = *dice.one(&[0.5, 1.5, 2.0, 0.37]);
            let side = |v: f32| ((v * by).round() as u32).max(1);
            json!({ "in": "canvas", "do": "scale", "width": side(w.min(90.0)), "height": side(h.min(90.0)),
                "filter": "smooth" })
        }
        "turn" => match dice.below(2) {
            0 if w.max(h) < 120.0 => {
                json!({ "in": "canvas", "do": "turn", "degrees": angle(dice) })
            }
            _ => json!({ "in": "layer", "do": "turn", "layer": layer, "degrees": angle(dice) }),
        },
        "quarter" => json!({ "in": "canvas", "do": "turn", "degrees": dice.one(&[90, 180, 270]) }),
        "mirror" => match dice.below(2) {
            0 => {
                json!({ "in": "canvas", "do": "mirror", "mirror": dice.one(&["left-right", "up-down"]) })
            }
            _ => {
                json!({ "in": "layer", "do": "mirror", "layer": layer, "upright": dice.below(2) == 0 })
            }
        },
        "matrix" => set(json!({ "do": "transform", "transform": { "matrix": map(dice) } })),
        "quad" => {
            let far = [[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]];
            let corner = |[x, y]: [f32; 2]| {
                [x + dice.number(-0.2 * w, 0.2 * w), y + dice.number(-0.2 * h, 0.2 * h)]
            };
            set(json!({ "do": "transform", "transform": { "quad": far.map(corner) } }))
        }
        "no transform" => set(json!({ "do": "transform", "transform": null })),
        "take along" => {
            json!({ "in": "layer", "do": "take along", "layer": layer, "by": map(dice), "done": true })
        }
        "group" => json!({ "in": "layer", "do": "group", "layer": [layer, other] }),
        "ungroup" => json!({ "in": "layer", "do": "ungroup", "layer": layer }),
        "into" => {
            json!({ "in": "layer", "do": "move", "layer": layer, "group": other, "index": dice.below(3) })
        }
        "out" => {
            json!({ "in": "layer", "do": "move", "layer": layer, "group": null, "index": dice.below(5) })
        }
        "home" => json!({ "in": "layer", "do": "home", "layer": layer, "part": part }),
        "home canvas" => json!({ "in": "layer", "do": "home", "layer": layer, "part": "canvas" }),
        "no home" => json!({ "in": "layer", "do": "home", "layer": layer, "part": null }),
        "apply" => json!({ "in": "layer", "do": "apply transform", "layer": layer }),
        "mesh" => {
            json!({ "in": "layer", "do": "mesh", "layer": layer, "columns": 3, "rows": 2 + dice.below(3) })
        }
        "duplicate" => json!({ "in": "layer", "do": "duplicate", "layer": layer }),
        "merge" => json!({ "in": "layer", "do": "merge down", "layer": layer }),
        "bake" => json!({ "in": "layer", "do": "bake", "layer": layer }),
        "mask" => {
            json!({ "in": "layer", "do": "paint mask", "layer": layer, "hides": dice.below(4) == 0 })
        }
        "derived mask" => {
            set(json!({ "do": "mask", "mask": { "kind": "shine", "at": at(dice), "tolerance": 0.2,
            "softness": 0.1, "contiguous": false } }))
        }
        "delete" => json!({ "in": "layer", "do": "delete", "layer": layer }),
        "inflate" | "bevel" | "lathe" | "sweep" | "lines" | "relief" | "profiles" => {
            let select = json!({ "in": "layer", "do": "select", "layer": layer });
            let both = json!({ "in": "layer", "do": "choose", "layer": [layer, other], "active_layer": layer });
            let first = if what == "profiles" { both } else { select };
            return format!("{first}\n{}", add(what));
        }
        "sphere" | "box" | "inflate selection" | "touches" | "sculpt" => add(what),
        "set" => return with_part(dice, document, &part),
        "order" => json!({ "in": "part", "do": "order", "part": part, "index": dice.below(4) }),
        "copy" => json!({ "in": "part", "do": "duplicate", "part": part }),
        "delete part" => json!({ "in": "part", "do": "delete", "part": part }),
        "hide" => json!({ "in": "part", "do": "visible", "part": part, "on": false }),
        "take shape" => json!({ "in": "part", "do": "take along", "by": map(dice), "done": true }),
        "sculpted" | "touched" => {
            let tool = if what == "sculpted" { "sculpt" } else { "touch" };
            let select = json!({ "in": "part", "do": "select", "part": part });
            return format!("{select}\n{}", stroke(dice, tool, w, h));
        }
        "region" => {
            let kind = *dice.one(&["direction", "depth", "curvature", "object", "shine"]);
            let region = json!({ "kind": kind, "at": at(dice), "softness": 0.1, "contiguous": dice.below(2) == 0 });
            let how = dice.one(&["replace", "add", "intersect"]);
            json!({ "in": "selection", "do": "region", "region": region, "how": how })
        }
        "select" => {
            json!({ "in": "selection", "do": *dice.one(&["all", "none", "invert", "again"]) })
        }
        "keep" => json!({ "in": "selection", "do": "keep", "name": *dice.one(&["a", "b"]) }),
        "forget" => json!({ "in": "selection", "do": "forget", "name": *dice.one(&["a", "b"]) }),
        "stroke" => {
            let select = json!({ "in": "layer", "do": "select", "layer": layer });
            return format!("{select}\n{}", stroke(dice, "brush", w, h));
        }
        "undo" => json!({ "in": "edit", "do": "undo" }),
        "redo" => json!({ "in": "edit", "do": "redo" }),
        "add maps" => {
            json!({ "in": "file", "do": "add maps", "normal": dice.one(maps), "depth": null })
        }
        "replace maps" => {
            json!({ "in": "file", "do": "replace maps", "normal": dice.one(maps), "depth": null })
        }
        "guides" => {
            json!({ "in": "guide", "do": "set", "guides": { "vertical": at(dice), "horizontal": at(dice) } })
        }
        "liquify" => {
            let select = json!({ "in": "layer", "do": "select", "layer": layer });
            return format!("{select}\n{}", stroke(dice, "liquify", w, h));
        }
        _ => return stroke(dice, "select rectangle", w, h),
    };
    value.to_string()
}

/// The part with another matrix, or put on another.
fn with_part(dice: &mut Dice, document: &Document, id: &str) -> String {
    let Some(part) = document.parts.part(id) else { return r#"{"in":"edit","do":"undo"}"#.into() };
    let mut value = crate::io::recipe::parts::write_part(part);
    let matrix: Vec<f32> =
        [1.0, 0.0, 0.0, 1.0, 0.0, 0.0].iter().map(|v| v + dice.number(-0.3, 0.3)).collect();
    value["matrix"] = json!(matrix);
    value["raise"] = json!(dice.number(-4.0, 9.0));
    json!({ "in": "part", "do": "set", "part": value, "done": true }).to_string()
}

/// A stroke of 2 to 80 readings.
fn stroke(dice: &mut Dice, tool: &str, w: f32, h: f32) -> String {
    let pen =
        |dice: &mut Dice| json!([dice.number(0.0, w), dice.number(0.0, h), dice.number(0.1, 1.0)]);
    let press =
        json!({ "in": "pointer", "do": "press", "tool": tool, "pen": pen(dice), "px_per_pt": 1 });
    let count = *dice.one(&[1, 2, 31, 32, 33, 80]);
    let pens: Vec<Value> = (0..count).map(|_| pen(dice)).collect();
    let drag = json!({ "in": "pointer", "do": "drag", "pens": pens });
    format!("{press}\n{drag}\n{}", json!({ "in": "pointer", "do": "release" }))
}

/// `layers[1].layers[0]` as replays say it: `1.0`.
fn as_replayed(path: &str) -> String {
    path.replace("layers[", "").replace(']', "")
}
