//! Reads and writes the transforms of layers.
//! Floor 5.

use crate::Result;
use crate::document::{LayerTransform, TransformShape};
use crate::json::{JsonNode, JsonObject};
use crate::math::{COORDINATE, DVec2};
use crate::raster::Resampling;
use serde_json::{Value, json};

/// `{ "matrix": [a, b, c, d, e, f] }` or `{ "quad": [[x, y] × 4] }`, with a `filter`.
pub fn read(node: &JsonNode) -> Result<LayerTransform> {
    let mut fields = node.fields()?;
    let filter = fields.one_of("filter", &Resampling::ALL, Resampling::default())?;
    let (matrix, quad) = (fields.get("matrix"), fields.get("quad"));
    let shape = match (&matrix, &quad) {
        (Some(node), None) => TransformShape::Matrix(matrix_of(node)?),
        (None, Some(node)) => TransformShape::Quad(corners(node)?),
        (None, None) => return Err(node.refused("has neither “matrix” nor “quad”")),
        (Some(_), Some(_)) => return Err(node.refused("has both “matrix” and “quad”; it must have one")),
    };
    fields.finish()?;
    let transform = LayerTransform { shape, filter };
    transform.fits().map_err(|why| matrix.or(quad).unwrap_or_else(|| node.clone()).refused(why))?;
    Ok(transform)
}

/// A matrix, with the range of each number.
pub fn matrix_of(node: &JsonNode) -> Result<[f64; 6]> {
    let items = node.list(6)?;
    let [a, b, c, d, e, f] = &items[..] else {
        return Err(node.refused(format!("has {} numbers; it must have 6: a, b, c, d, e, f", items.len())));
    };
    let [a, b, c, d] = [a, b, c, d].map(|item| item.exact_number(LayerTransform::FACTOR));
    let [e, f] = [e, f].map(|item| item.exact_number(COORDINATE));
    Ok([a?, b?, c?, d?, e?, f?])
}

fn corners(node: &JsonNode) -> Result<[DVec2; 4]> {
    let corner = |node: &JsonNode| -> Result<DVec2> {
        let items = node.list(2)?;
        let [x, y] = &items[..] else { return Err(node.refused("is no point [x, y]")) };
        Ok(DVec2::new(x.exact_number(COORDINATE)?, y.exact_number(COORDINATE)?))
    };
    let items = node.list(4)?;
    let corners: Vec<DVec2> = items.iter().map(corner).collect::<Result<_>>()?;
    corners.try_into().map_err(|_| node.refused(format!("has {} points; it must have 4", items.len())))
}

pub fn write(transform: &LayerTransform) -> Value {
    let mut out = JsonObject::default();
    match transform.shape {
        TransformShape::Matrix(coefficients) => out.set("matrix", json!(coefficients)),
        TransformShape::Quad(corners) => out.set("quad", json!(corners.map(|corner| [corner.x, corner.y]))),
    }
    out.word("filter", &Resampling::ALL, transform.filter, Resampling::default());
    out.done()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn parsed(text: &str) -> Result<LayerTransform> {
        let value: Value = serde_json::from_str(text).unwrap();
        read(&JsonNode::root(Path::new("r.json"), &value))
    }

    #[test]
    fn what_is_written_is_read_back_to_the_last_digit() {
        for text in [
            r#"{"matrix":[0.8090169943749475,-0.5877852522924731,0.5877852522924731,0.8090169943749475,12.5,-3.0]}"#,
            r#"{"quad":[[0.1,0.2],[99.0,1.0],[90.5,80.25],[3.0,70.0]],"filter":"nearest"}"#,
        ] {
            let transform = parsed(text).unwrap();
            assert_eq!(write(&transform).to_string(), text);
            assert_eq!(parsed(&write(&transform).to_string()).unwrap(), transform);
        }
    }
    #[test]
    fn what_is_no_map_is_refused_by_its_path() {
        for (text, why) in [
            ("{}", "neither"),
            (r#"{"matrix":[1,0,0,1,0]}"#, "has 5 numbers; it must have 6"),
            (r#"{"matrix":[1,2,2,4,0,0]}"#, "cannot be inverted"),
            (r#"{"matrix":[1,0,0,1,1e9,0]}"#, "must be between"),
            (r#"{"quad":[[0,0],[9,9],[9,0],[0,9]]}"#, "no convex quadrilateral"),
            (r#"{"quad":[[0,0],[9,0],[9,9],[0,9]],"matrix":[1,0,0,1,0,0]}"#, "has both"),
            (r#"{"matrix":[1,0,0,1,0,0],"filter":"best"}"#, "filter"),
            (r#"{"matrix":[1,0,0,1,0,0],"turn":3}"#, "turn"),
        ] {
            let refused = parsed(text).unwrap_err().to_string();
            assert!(refused.contains(why), "{text}: {refused}");
        }
    }
}
