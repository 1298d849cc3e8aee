//! Draws new versions of the parts of a shape, as the panel of the shape and its handles make them.

use super::dice::{Dice, Roll};
use crate::document::parts::{OutlineSource, Part, PartKind};
use crate::io::recipe::parts::write_part;
use crate::math::{Vec2, srgb::Color};
use crate::session::replay::ReplayValue;
use crate::shape::{BevelCurve, Body, Combine, LineForm};
use serde_json::{Value, json};
use std::sync::Arc;

/// Numbers that a part of a kind may have, by their names in files. A new kind belongs here.
fn numbers(kind: &PartKind) -> &'static [(&'static str, f32, f32)] {
    match kind {
        PartKind::Inflate { .. } => {
            &[("puff", 0.1, 3.0), ("profile", 0.0, 1.0), ("rim", 10.0, 90.0)]
        }
        PartKind::Bevel { .. } => &[("width", 1.0, 20.0), ("height", 0.0, 20.0)],
        PartKind::Primitive(_) => &[
            ("radius", 4.0, 40.0),
            ("length", 4.0, 60.0),
            ("tube", 2.0, 12.0),
            ("round", 0.0, 1.0),
        ],
        PartKind::Lathe { .. } | PartKind::Sweep { .. } => &[("puff", 0.2, 2.0)],
        PartKind::Touches { .. }
        | PartKind::Sculpt { .. }
        | PartKind::Maps(_)
        | PartKind::Profiles { .. } => &[],
        PartKind::Lines { .. } => &[("angle", 5.0, 80.0), ("reach", 1.0, 30.0)],
        PartKind::Relief { .. } => {
            &[("coarse", -4.0, 4.0), ("fine", -4.0, 4.0), ("radius", 1.0, 12.0), ("edge", 0.1, 1.0)]
        }
    }
}

/// A part of the document in front in a new version; of a document without parts one that is not
/// there.
pub fn change_part(dice: &mut Dice) -> Value {
    if dice.facts.parts.is_empty() {
        return json!({ "id": "part-1", "kind": "primitive", "shape": "cone", "center": [9, 9] });
    }
    let parts = dice.facts.parts.clone();
    let part: Arc<Part> = dice.one_of(&parts);
    let mut value = write_part(&part);
    for _ in 0..1 + dice.below(2) {
        match dice.below(6) {
            0 => all_have(dice, &mut value),
            1 => draw_fields_of_kind(dice, &part.kind, &mut value),
            2 => {
                let outline = |dice: &mut Dice| outline(dice, part.outline());
                let drawn = part.outline().map(|_| outline(dice));
                drawn.into_iter().for_each(|drawn| value["outline"] = drawn);
            }
            _ => {
                let numbers = numbers(&part.kind);
                if !numbers.is_empty() {
                    let (name, low, high) = dice.one_of(numbers);
                    value[name] = json!(dice.within(low, high));
                }
            }
        }
    }
    value
}

/// What every part has.
fn all_have(dice: &mut Dice, value: &mut Value) {
    let pair =
        |dice: &mut Dice, most: f32| json!([dice.within(-most, most), dice.within(-most, most)]);
    match dice.below(7) {
        0 => value["combine"] = dice.one_of(&Combine::ALL).1.into(),
        1 => value["tilt"] = pair(dice, 50.0),
        2 => value["raise"] = json!(dice.within(-20.0, 20.0)),
        3 => value["name"] = dice.one_of(&["Head", "é", "a\"b"]).into(),
        4 => value["visible"] = json!(dice.is(50)),
        5 => (value["combine"], value["smooth"]) = ("union".into(), json!(dice.within(0.0, 12.0))),
        _ => value["matrix"] = <[f64; 6]>::roll(dice).to_value(),
    }
}

/// What only some kinds have.
fn draw_fields_of_kind(dice: &mut Dice, kind: &PartKind, value: &mut Value) {
    let turn =
        json!([dice.within(-90.0, 90.0), dice.within(-90.0, 90.0), dice.within(-90.0, 90.0)]);
    let ids: Vec<String> = dice.facts.parts.iter().map(|part| part.id.clone()).collect();
    match kind {
        PartKind::Bevel { .. } => value["curve"] = dice.one_of(&BevelCurve::NAMED).1.into(),
        PartKind::Primitive(_) if dice.is(50) => value["turn"] = turn,
        PartKind::Primitive(_) => value["shape"] = dice.one_of(&Body::ALL).1.into(),
        PartKind::Lathe { .. } => value["axis"] = json!([place(dice), place(dice)]),
        PartKind::Sweep { .. } => {
            let ball = |dice: &mut Dice| {
                json!([dice.within(0.0, 80.0), dice.within(0.0, 60.0), dice.within(1.0, 12.0)])
            };
            value["balls"] = (0..2 + dice.below(60)).map(|_| ball(dice)).collect();
        }
        PartKind::Touches { .. } => {
            let touch = |dice: &mut Dice| {
                let normal = json!([dice.within(-0.7, 0.7), dice.within(-0.7, 0.7), 0.6]);
                json!({ "at": place(dice), "radius": dice.within(1.0, 12.0), "normal": normal })
            };
            value["touches"] = (0..1 + dice.below(5)).map(|_| touch(dice)).collect();
        }
        PartKind::Lines { .. } if dice.is(50) => {
            value["form"] = dice.one_of(&LineForm::ALL).1.into()
        }
        // Also on itself, in a circle, or on what is gone.
        PartKind::Sculpt { .. } | PartKind::Lines { .. } | PartKind::Relief { .. } => {
            value["on"] = dice.one_of(&ids).into();
        }
        PartKind::Inflate { .. } | PartKind::Maps(_) | PartKind::Profiles { .. } => {}
    }
}

fn place(dice: &mut Dice) -> Value {
    Vec2::roll(dice).to_value()
}

/// Where a part has its outline from; a file stays the one it is.
fn outline(dice: &mut Dice, known: Option<&OutlineSource>) -> Value {
    let drawn = match dice.below(5) {
        0 => OutlineSource::Layer { layer: String::new(), color: None },
        1 => OutlineSource::Path(Vec::new()),
        2 => OutlineSource::Selection("a".into()),
        3 => OutlineSource::Object(1),
        _ => match known {
            Some(OutlineSource::File(file)) => OutlineSource::File(file.clone()),
            _ => OutlineSource::Path(Vec::new()),
        },
    };
    match drawn {
        OutlineSource::Layer { .. } => {
            let names = dice.facts.names.clone();
            let layer = dice.one_or(&names, "Ink".into());
            match dice.is(70) {
                true => json!({ "layer": layer }),
                false => json!({ "layer": layer, "color": Color::roll(dice).to_value() }),
            }
        }
        OutlineSource::Path(_) => {
            json!({ "path": (0..3 + dice.below(5)).map(|_| place(dice)).collect::<Vec<_>>() })
        }
        OutlineSource::Selection(_) => json!({ "selection": dice.one_of(&["a", "b", "sky"]) }),
        OutlineSource::Object(_) => json!({ "object": 1 + dice.below(3) }),
        OutlineSource::File(file) => json!({ "file": file.file }),
    }
}
