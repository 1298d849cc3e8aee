//! Renders the content of a layer for one tile. Floor 4. The rendering of marks is in `paint` and `shading`.

use super::Content;
use crate::paint::{Scene, stroke};
use crate::raster::{PlanarTile, Tile, TileAt, TilePaint};
use crate::surface::{Bend, Deformation};
use std::sync::Arc;

/// The pixels of a layer in one tile.
pub(super) enum TileContent {
    Nothing,
    /// One premultiplied colour everywhere.
    Solid([f32; 4]),
    Tile(Arc<Tile>),
    Group(PlanarTile),
}

impl TileContent {
    fn of_tile(tile: Option<Arc<Tile>>) -> Self {
        tile.map_or(TileContent::Nothing, TileContent::Tile)
    }
    pub fn as_paint(&self) -> Option<TilePaint<'_>> {
        match self {
            TileContent::Nothing => None,
            TileContent::Solid(color) => Some(TilePaint::Solid(*color)),
            TileContent::Tile(tile) => Some(TilePaint::Bytes(tile)),
            TileContent::Group(pixels) => Some(TilePaint::Planar(pixels)),
        }
    }
    /// Whether it is known to cover every pixel fully.
    pub fn is_opaque(&self) -> bool {
        match self {
            TileContent::Solid(color) => color[3] >= 1.0,
            TileContent::Tile(tile) => tile.is_opaque(),
            TileContent::Nothing | TileContent::Group(_) => false,
        }
    }
}

/// Renders one tile of a layer's content, or takes it from the cache. Groups, adjustments and normals have no pixels of
/// their own.
pub(super) fn render(content: &Content, scene: &Scene, at: TileAt) -> TileContent {
    match content {
        Content::Fill(color) => TileContent::Solid(color.premultiplied()),
        Content::Pixels(pixels) => TileContent::of_tile(pixels.tiles.tile(at).cloned()),
        Content::Gradient(live) => TileContent::of_tile(live.tile(scene, at, || live.params().render_tile(scene, at))),
        Content::Strokes(live) => {
            TileContent::of_tile(live.tile(scene, at, || stroke::render_tile(&live.params().strokes, scene, at)))
        }
        Content::Image(live) => TileContent::of_tile(live.tile(scene, at, || live.params().render_tile(scene, at))),
        Content::Shading(live) => TileContent::of_tile(live.tile(scene, at, || live.params().render_tile(scene, at))),
        Content::RadianceScaling(_) | Content::Normals(_) | Content::Group(_) => TileContent::Nothing,
    }
}

/// Fills the caches that many tiles would otherwise compute at the same time.
pub(super) fn warm_caches(content: &Content, scene: &Scene) {
    let bend = |bend: &Bend| drop(Deformation::new(scene.surface.as_deref(), scene.size, bend));
    match content {
        Content::Image(live) => {
            live.params().source.texture();
            bend(&live.params().bend);
        }
        Content::Gradient(live) => bend(&Bend { operator: live.params().operator, ..Bend::default() }),
        Content::Strokes(live) => {
            for stroke in &live.params().strokes {
                bend(&Bend { operator: stroke.operator(), ..Bend::default() });
            }
        }
        Content::RadianceScaling(scaling) => {
            let _ = scene.surface.as_deref().map(|surface| scaling.features.on(surface));
        }
        Content::Shading(live) => live.params().warm(scene),
        Content::Fill(_) | Content::Pixels(_) | Content::Normals(_) | Content::Group(_) => {}
    }
}
