//! A layer as a drawing: what it paints by itself, and its traits. Floor 6. Not here: what a drawing
//! is (`document::parts::drawing`).

use crate::document::parts::drawing::DrawingTraits;
use crate::document::{Document, LayerId, Progress, flatten_layer};
use crate::raster::TileGrid;
use std::sync::Arc;

/// What a layer paints on the canvas, without any surface.
pub fn render_layer(document: &Document, layer: LayerId) -> Option<TileGrid> {
    render_layer_with_progress(document, layer, &Progress::default())
}

/// The same; `None` also if canceled.
pub fn render_layer_with_progress(
    document: &Document,
    layer: LayerId,
    progress: &Progress,
) -> Option<TileGrid> {
    let flat = Document { surface: None, parts: Arc::default(), ..document.clone() };
    let flat = flat.with_layer(layer, |layer| (layer.visible, layer.opacity) = (true, 1.0))?;
    flatten_layer(&flat, layer, progress)
}

/// What a layer of a document looks like as a drawing.
pub fn traits_of(document: &Document, layer: LayerId) -> Option<DrawingTraits> {
    Some(DrawingTraits::of(&render_layer(document, layer)?, document.size))
}
