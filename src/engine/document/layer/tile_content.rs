//! The pixels of a layer in one tile, in the form that its kind has. Floor 4. Not here: composing
//! layers (`compose`).

use crate::document::far_side::PackedTile;
use crate::raster::{PlanarTile, Tile, TilePaint};
use std::sync::Arc;

/// The pixels of a layer in one tile.
pub(in crate::document) enum TileContent {
    Nothing,
    /// One premultiplied color everywhere.
    Solid([f32; 4]),
    Tile(Arc<Tile>),
    Packed(Arc<PackedTile>),
    Group(PlanarTile),
}

impl TileContent {
    pub fn of_tile(tile: Option<Arc<Tile>>) -> Self {
        tile.map_or(TileContent::Nothing, TileContent::Tile)
    }

    pub fn as_paint(&self) -> Option<TilePaint<'_>> {
        match self {
            TileContent::Nothing => None,
            TileContent::Solid(color) => Some(TilePaint::Solid(*color)),
            TileContent::Tile(tile) => Some(TilePaint::of(tile)),
            TileContent::Packed(packed) => Some(packed.as_paint()),
            TileContent::Group(pixels) => Some(TilePaint::Planar(pixels)),
        }
    }

    /// Whether it is known to cover every pixel fully.
    pub fn is_opaque(&self) -> bool {
        match self {
            TileContent::Solid(color) => color[3] >= 1.0,
            TileContent::Tile(tile) => tile.is_opaque(),
            TileContent::Packed(packed) => packed.is_opaque(),
            TileContent::Nothing | TileContent::Group(_) => false,
        }
    }
}
