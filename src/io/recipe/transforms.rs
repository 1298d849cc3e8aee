//! Reads and writes the transforms of layers.
//! Floor 5.

use crate::Result;
use crate::document::{LayerTransform, Mesh, MeshFrame, TransformShape};
use crate::json::{JsonNode, JsonObject, object};
use crate::math::{COORDINATE, DVec2, Size, vec2};
use crate::raster::Resampling;
use serde_json::{Value, json};
use std::sync::Arc;

/// `{ "matrix": [a, b, c, d, e, f] }`, `{ "quad": [[x, y] × 4] }` or `{ "mesh": … }`, with a
/// `filter`.
///
/// * `canvas`: the frame of a mesh that states none; without it a mesh must state one.
pub fn read(node: &JsonNode, canvas: Option<Size>) -> Result<LayerTransform> {
    let mut fields = node.fields()?;
    let filter = fields.one_of("filter", &Resampling::ALL, Resampling::default())?;
    let (matrix, quad, mesh) = (fields.get("matrix"), fields.get("quad"), fields.get("mesh"));
    let shape = match (&matrix, &quad, &mesh) {
        (Some(node), None, None) => TransformShape::Matrix(matrix_of(node)?),
        (None, Some(node), None) => TransformShape::Quad(corners(node)?),
        (None, None, Some(node)) => TransformShape::Mesh(Arc::new(mesh_of(node, canvas)?)),
        (None, None, None) => {
            return Err(node.refusal("has neither “matrix” nor “quad” nor “mesh”"));
        }
        (Some(_), Some(_), _) => {
            return Err(node.refusal("has both “matrix” and “quad”; it must have one"));
        }
        _ => return Err(node.refusal("has “mesh” and another shape; it must have one")),
    };
    fields.finish()?;
    let transform = LayerTransform { shape, filter };
    transform.fits().map_err(|why| matrix.or(quad).unwrap_or_else(|| node.clone()).refusal(why))?;
    Ok(transform)
}

/// A matrix, with the range of each number.
pub fn matrix_of(node: &JsonNode) -> Result<[f64; 6]> {
    let items = node.list(6)?;
    let [a, b, c, d, e, f] = &items[..] else {
        return Err(
            node.refusal(format!("has {} numbers; it must have 6: a, b, c, d, e, f", items.len()))
        );
    };
    let [a, b, c, d] = [a, b, c, d].map(|item| item.exact_number(LayerTransform::FACTOR));
    let [e, f] = [e, f].map(|item| item.exact_number(COORDINATE));
    Ok([a?, b?, c?, d?, e?, f?])
}

/// `{ "columns": 4, "rows": 4, "frame": [x, y, width, height], "points": [[x, y], …] }`, points row
/// by row.
fn mesh_of(node: &JsonNode, canvas: Option<Size>) -> Result<Mesh> {
    let mut fields = node.fields()?;
    let side = *Mesh::SIDE.start() as i64..=*Mesh::SIDE.end() as i64;
    let columns = fields.require("columns")?.integer(side.clone())? as usize;
    let rows = fields.require("rows")?.integer(side)? as usize;
    let frame = match (fields.get("frame"), canvas) {
        (Some(node), _) => {
            let items = node.list(4)?;
            let [x, y, w, h] = &items[..] else {
                return Err(node.refusal("is not a frame [x, y, width, height]"));
            };
            let side = |node: &JsonNode| node.number(MeshFrame::SIDE_PX);
            let corner = vec2(x.number(COORDINATE)?, y.number(COORDINATE)?);
            MeshFrame { corner, size: vec2(side(w)?, side(h)?) }
        }
        (None, Some(canvas)) => MeshFrame::of(canvas),
        (None, None) => return Err(node.refusal("needs a “frame”")),
    };
    let list = fields.require("points")?;
    let items = list.list(columns * rows)?;
    if items.len() != columns * rows {
        let (found, wanted) = (items.len(), columns * rows);
        return Err(list.refusal(format!("has {found} points; {columns} × {rows} make {wanted}")));
    }
    let point = |node: &JsonNode| -> Result<_> {
        let items = node.list(2)?;
        let [x, y] = &items[..] else { return Err(node.refusal("is not a point [x, y]")) };
        Ok(vec2(x.number(COORDINATE)?, y.number(COORDINATE)?))
    };
    let points = items.iter().map(point).collect::<Result<_>>()?;
    fields.finish()?;
    Mesh::new(columns, rows, frame, points).ok_or_else(|| node.refusal("is no mesh"))
}

fn corners(node: &JsonNode) -> Result<[DVec2; 4]> {
    let corner = |node: &JsonNode| -> Result<DVec2> {
        let items = node.list(2)?;
        let [x, y] = &items[..] else { return Err(node.refusal("is not a point [x, y]")) };
        Ok(DVec2::new(x.exact_number(COORDINATE)?, y.exact_number(COORDINATE)?))
    };
    let items = node.list(4)?;
    let corners: Vec<DVec2> = items.iter().map(corner).collect::<Result<_>>()?;
    corners
        .try_into()
        .map_err(|_| node.refusal(format!("has {} points; it must have 4", items.len())))
}

/// A transform as recipes write it.
pub fn write(transform: &LayerTransform) -> Value {
    let mut out = JsonObject::default();
    match &transform.shape {
        TransformShape::Matrix(coefficients) => out.set("matrix", json!(coefficients)),
        TransformShape::Quad(corners) => {
            out.set("quad", json!(corners.map(|corner| [corner.x, corner.y])))
        }
        TransformShape::Mesh(mesh) => {
            let MeshFrame { corner, size } = mesh.frame();
            let frame = [corner.x, corner.y, size.x, size.y].map(object::number);
            let points: Vec<Value> = mesh.points().iter().map(|p| object::point(*p)).collect();
            let (columns, rows) = (mesh.columns(), mesh.rows());
            out.set(
                "mesh",
                json!({ "columns": columns, "rows": rows, "frame": frame, "points": points }),
            );
        }
    }
    out.word("filter", &Resampling::ALL, transform.filter, Resampling::default());
    out.into_value()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn parsed(text: &str) -> Result<LayerTransform> {
        let value: Value = serde_json::from_str(text).unwrap();
        read(&JsonNode::root(Path::new("r.json"), &value), Some(Size::new(80, 60)))
    }

    #[test]
    fn what_is_written_is_read_back_to_the_last_digit() {
        for text in [
            r#"{"matrix":[0.8090169943749475,-0.5877852522924731,0.5877852522924731,0.8090169943749475,12.5,-3.0]}"#,
            r#"{"mesh":{"columns":2,"rows":2,"frame":[0,0,80,60],"points":[[1.5,2],[70,3],[4,55.25],[79,61]]}}"#,
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
            (r#"{"quad":[[0,0],[9,9],[9,0],[0,9]]}"#, "not a convex quadrilateral"),
            (r#"{"quad":[[0,0],[9,0],[9,9],[0,9]],"matrix":[1,0,0,1,0,0]}"#, "has both"),
            (r#"{"mesh":{"columns":1,"rows":2,"points":[]}}"#, "mesh.columns"),
            (r#"{"mesh":{"columns":2,"rows":34,"points":[]}}"#, "mesh.rows"),
            (
                r#"{"mesh":{"columns":2,"rows":2,"points":[[0,0],[1,0],[0,1]]}}"#,
                "has 3 points; 2 × 2 make 4",
            ),
            (
                r#"{"mesh":{"columns":2,"rows":2,"points":[[0,0],[1,0],[0,1],[1,null]]}}"#,
                "mesh.points[3][1]",
            ),
            (
                r#"{"mesh":{"columns":2,"rows":2,"points":[[0,0],[1,0],[0,1],[1,1e9]]}}"#,
                "mesh.points[3][1]",
            ),
            (
                r#"{"mesh":{"columns":2,"rows":2,"frame":[0,0,0,9],"points":[[0,0],[1,0],[0,1],[1,1]]}}"#,
                "mesh.frame[2]",
            ),
            (r#"{"matrix":[1,0,0,1,0,0],"mesh":{}}"#, "and another shape"),
            (r#"{"matrix":[1,0,0,1,0,0],"filter":"best"}"#, "filter"),
            (r#"{"matrix":[1,0,0,1,0,0],"turn":3}"#, "turn"),
        ] {
            let refused = parsed(text).unwrap_err().to_string();
            assert!(refused.contains(why), "{text}: {refused}");
        }
    }
}
