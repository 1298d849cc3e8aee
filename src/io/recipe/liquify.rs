//! Reads and writes the liquify of layers.
//! Floor 5.

use crate::Result;
use crate::document::Document;
use crate::json::JsonNode;
use crate::math::{Vec2, vec2};
use crate::raster::lattice::{LatticeBlock, SIDE};
use crate::raster::{Lattice, TileAt};
use serde_json::{Value, json};
use std::sync::Arc;

/// Nodes of a block.
const NODES: usize = SIDE * SIDE;
/// Most blocks of a layer: as many as a description with nothing else can hold.
const MOST_BLOCKS: usize = Document::MOST_VALUES / 150;

/// `{ "blocks": [{ "at": [column, row], "x": [64 numbers], "y": [64 numbers] }, …] }`: for each 64
/// px wide block the displacements of its nodes, row by row, in 64ths of a pixel. `None` if nothing
/// is displaced.
pub fn read(node: &JsonNode) -> Result<Option<Arc<Lattice>>> {
    let mut fields = node.fields()?;
    let mut lattice = Lattice::default();
    for block in fields.require("blocks")?.list(MOST_BLOCKS)? {
        let mut fields = block.fields()?;
        let at = place(&fields.require("at")?)?;
        let (x, y) = (side(&fields.require("x")?)?, side(&fields.require("y")?)?);
        fields.finish()?;
        lattice.set(at, LatticeBlock(std::array::from_fn(|k| vec2(x[k], y[k]))));
    }
    fields.finish()?;
    Ok((!lattice.is_empty()).then(|| Arc::new(lattice)))
}

fn place(node: &JsonNode) -> Result<TileAt> {
    let items = node.list(2)?;
    let [column, row] = &items[..] else {
        return Err(node.refusal("is not a place [column, row]"));
    };
    let far = i64::from(Lattice::FARTHEST_BLOCK);
    Ok(TileAt::new(column.integer(-far..=far)? as i32, row.integer(-far..=far)? as i32))
}

fn side(node: &JsonNode) -> Result<Vec<f32>> {
    let items = node.list(NODES)?;
    if items.len() != NODES {
        return Err(node.refusal(format!("has {} numbers; it must have {NODES}", items.len())));
    }
    let most = (Lattice::FARTHEST_PX * Lattice::PER_PX) as i64;
    items.iter().map(|item| Ok(item.integer(-most..=most)? as f32 / Lattice::PER_PX)).collect()
}

pub fn write(lattice: &Lattice) -> Value {
    let parts = |block: &LatticeBlock, side: fn(&Vec2) -> f32| -> Vec<i32> {
        block.0.iter().map(|u| (side(u) * Lattice::PER_PX) as i32).collect()
    };
    let block = |(at, block): (TileAt, &Arc<LatticeBlock>)| {
        let (x, y) = (parts(block, |u| u.x), parts(block, |u| u.y));
        json!({ "at": [at.col, at.row], "x": x, "y": y })
    };
    json!({ "blocks": lattice.blocks().map(block).collect::<Vec<_>>() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rect;
    use std::path::Path;

    fn parsed(value: &Value) -> Result<Option<Arc<Lattice>>> {
        read(&JsonNode::root(Path::new("r.json"), value))
    }

    #[test]
    fn what_is_written_is_read_back_to_the_last_bit() {
        let mut lattice = Lattice::default();
        lattice.change(Rect::new(-100, 20, 150, 90), |_, q, _| vec2(q.x * 0.013, 7.7 - q.y * 0.11));
        assert_eq!(*parsed(&write(&lattice)).unwrap().unwrap(), lattice);
        assert_eq!(parsed(&json!({ "blocks": [] })).unwrap(), None);
    }

    #[test]
    fn what_is_no_displacement_is_refused_by_its_path() {
        let block = |x: Value| json!({ "blocks": [{ "at": [0, 0], "x": x, "y": vec![0; 64] }] });
        for (value, why) in [
            (json!({}), "blocks"),
            (block(json!([1, 2])), "blocks[0].x: has 2 numbers"),
            (block(json!(vec![Value::Null; 64])), "blocks[0].x[0]"),
            (block(json!(vec![1e12; 64])), "blocks[0].x[0]"),
            (json!({ "blocks": [{ "at": [1e9, 0], "x": [], "y": [] }] }), "blocks[0].at[0]"),
        ] {
            let refused = parsed(&value).unwrap_err().to_string();
            assert!(refused.contains(why), "{refused}");
        }
    }
}
