//! Draws brushes as files hold them, with and without a second tip.

use super::dice::{Dice, Roll};
use crate::io::recipe::value::RecipeValue;
use crate::paint::{BrushMode, DualMode, DualSettings};
use serde_json::{Value, json};

/// A second tip; at times with a number that it may not have.
fn dual_brush(dice: &mut Dice) -> Value {
    let mode = dice.one_of(&DualMode::ALL).1;
    let mut dual = json!({ "mode": mode });
    for setting in DualSettings::SETTINGS {
        if dice.is(40) {
            let (least, most) = (*setting.range.start(), setting.range.end().min(3.0));
            dual[setting.name] =
                json!(f64::from(dice.in_range(least..=most, setting.range.clone())));
        }
    }
    if dice.is(50) {
        dual["tip"] = json!({ "kind": "square", "ratio": 0.5 });
    }
    if dice.is(30) {
        dual["dynamics"] = json!({ "rotation": { "random": 1 }, "flow": { "pressure": 0.5 } });
    }
    if dice.is(3) {
        dual["size"] = json!(-1);
    }
    dual
}

/// A whole brush.
pub fn brush(dice: &mut Dice) -> Value {
    let share = |dice: &mut Dice| f64::from(dice.within(0.0, 1.0));
    let number = |dice: &mut Dice, high: f32| f64::from(dice.within(0.0, high));
    let mut brush =
        json!({ "size": number(dice, 30.0) + 1.0, "hardness": share(dice), "flow": share(dice) });
    let more = [
        ("scatter", json!(share(dice))),
        ("jitter", json!({ "hue": number(dice, 60.0), "value": share(dice) })),
        ("stabilizer", json!({ "string": number(dice, 9.0) })),
        ("stabilizer", json!({ "average": share(dice) * 0.9 })),
        ("stabilizer", json!({ "lag": share(dice) * 0.2 })),
        ("tip", json!({ "kind": "noise", "cells": 2 + dice.below(9) })),
        ("keeps_alpha", json!(dice.is(50))),
        ("erases", json!(dice.is(50))),
        ("softness", json!(share(dice))),
        ("seed", json!(dice.below(1000))),
        ("mark", BrushMode::roll(dice).to_json()),
        ("dual", dual_brush(dice)),
    ];
    for _ in 0..dice.below(4) {
        let (name, value) = dice.one_of(&more);
        brush[name] = value;
    }
    brush
}
