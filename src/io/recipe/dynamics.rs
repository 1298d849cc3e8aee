//! What the properties of a brush follow. Read and written.
//! Floor 5. Not here: the other settings of a brush (`brush`).

use crate::Result;
use crate::json::{JsonNode, JsonObject, object};
use crate::math::{UNIT, Vec2, vec2};
use crate::paint::dynamics::{MAX_POINTS, MOST_ADDED};
use crate::paint::{Curve, Dynamics, Input, Property};
use serde_json::Value;

/// `{ "size": { "pressure": 0.5, "speed": [[0, 1], [1, 0.3]], "tilt": { "add": [[0, 0], [1, 2]] } }
/// }`: what each property follows, and how. A number p is the line from 1 − p to 1.
pub fn read(node: &JsonNode, base: &Dynamics) -> Result<Dynamics> {
    let mut fields = node.fields()?;
    let mut dynamics = base.clone();
    for (property, name) in Property::ALL {
        let Some(node) = fields.get(name) else { continue };
        let mut inputs = node.fields()?;
        for (input, name) in Input::ALL {
            if let Some(node) = inputs.get(name) {
                for curve in curves(&node)?.into_iter().flatten() {
                    dynamics = dynamics.with(property, input, curve);
                }
            }
        }
        inputs.finish()?;
    }
    fields.finish()?;
    Ok(dynamics)
}

/// One curve; or `{ "add": …, "times": … }`: what is added first, and the curve that multiplies.
fn curves(node: &JsonNode) -> Result<[Option<Curve>; 2]> {
    if !node.value().is_object() {
        return Ok([Some(curve(node)?), None]);
    }
    let mut fields = node.fields()?;
    let added = fields.get("add").map(|node| {
        let refused = || {
            node.refusal(
                "is not a curve; the first numbers of its points must be between 0 and 1 and must \
                 not fall",
            )
        };
        Curve::additive(points(&node, -MOST_ADDED..=MOST_ADDED)?).ok_or_else(refused)
    });
    let times = fields.get("times").map(|node| curve(&node));
    fields.finish()?;
    Ok([added.transpose()?, times.transpose()?])
}

fn curve(node: &JsonNode) -> Result<Curve> {
    if node.value().is_number() {
        return node.number(UNIT).map(Curve::Share);
    }
    let curve = Curve::through(points(node, UNIT)?);
    curve.ok_or_else(|| {
        node.refusal("is not a curve; the first numbers of its points must not fall")
    })
}

fn points(node: &JsonNode, range: std::ops::RangeInclusive<f32>) -> Result<Vec<Vec2>> {
    let points = node.list(MAX_POINTS)?;
    points
        .iter()
        .map(|point| point.numbers(2, 2, range.clone()).map(|p| vec2(p[0], p[1])))
        .collect()
}

/// The differences from a plain brush's: a row that only the plain one has is written as 0.
pub fn write(dynamics: &Dynamics, plain: &Dynamics) -> JsonObject {
    let mut out = JsonObject::default();
    for (property, property_name) in Property::ALL {
        let mut inputs = JsonObject::default();
        for (input, name) in Input::ALL {
            let own = dynamics.curve(property, input);
            let times =
                (own != plain.curve(property, input)).then(|| own.map_or(0.into(), write_curve));
            match (dynamics.added_curve(property, input).map(write_curve), times) {
                (None, None) => {}
                (None, Some(times)) => inputs.set(name, times),
                (Some(added), times) => {
                    let mut both = JsonObject::default();
                    both.set("add", added);
                    both.set_some("times", times, |times| times);
                    inputs.set(name, both.into_value());
                }
            }
        }
        out.object(property_name, inputs);
    }
    out
}

fn write_curve(curve: &Curve) -> Value {
    match curve {
        Curve::Share(p) => object::number(*p),
        Curve::Points(points) | Curve::Added(points) => {
            points.iter().map(|p| object::point(*p)).collect()
        }
    }
}
