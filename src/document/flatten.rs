//! Flattening: the layers of a document to one picture, tile by tile, in f32, quantised once.
//! Floor 4.

use super::Document;
use crate::raster::TileGrid;

/// Flattens the whole document.
pub fn flatten(document: &Document) -> TileGrid {
    TileGrid::for_rect(document.size.rect())
}
