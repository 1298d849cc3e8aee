//! How live layers are rendered without rounding to bytes. Floor 4. Not here: composing the results
//! (`floats`), rendering marks (`paint`, `shading`).

use crate::document::Progress;
use crate::paint::Scene;
use crate::raster::{FloatTexture, PlanarTile, TileAt};
use std::sync::Arc;

/// What a live layer is rendered from.
pub(in crate::document) trait Marks {
    /// One tile, not rounded to bytes; `None` where there is nothing. Colors may be brighter than
    /// white.
    fn pixels(&self, scene: &Scene, at: TileAt) -> Option<PlanarTile>;
    /// Where another side of a contour pixel sees no surface the tile's own pixels stay.
    fn is_kept_off_surface(&self) -> bool {
        true
    }

    /// The texture that tiles are read from, to be kept meanwhile.
    fn texture(&self) -> Option<Arc<FloatTexture>> {
        None
    }

    /// The memory that it takes.
    fn texture_bytes(&self) -> u64 {
        0
    }

    /// Renders tiles that cost less together than one by one, if they do.
    fn render_together(
        &self,
        _scene: &Scene,
        _tiles: &[TileAt],
        _progress: &Progress,
        _done: &Done,
    ) {
    }
}

/// Takes a rendered tile.
pub(in crate::document) type Done<'d> = dyn Fn(TileAt, Option<PlanarTile>) + Sync + 'd;
