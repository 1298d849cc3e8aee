//! A layer as a drawing: what it paints by itself, and its traits. Floor 6. Not here: what a drawing
//! is (`document::parts::drawing`).

use crate::document::parts::drawing::DrawingTraits;
use crate::document::parts::pixel_art::colors_of;
use crate::document::{
    Document, DocumentReducer, LayerId, Progress, flatten, flatten_layer, flatten_layers,
};
use crate::math::Vec2;
use crate::math::srgb::Color;
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

/// The colors of the picture that a layer is composed with: what lies beneath it in its group.
pub fn colors_beneath(document: &Document, layer: LayerId) -> Option<Vec<Color>> {
    let place = document.place_of(layer)?;
    let layers = match place.group {
        Some(group) => &document.layer(group)?.content.group()?.layers,
        None => &document.layers,
    };
    let beneath: Vec<LayerId> = (0..place.index)
        .filter_map(|index| layers.get(index))
        .filter(|layer| layer.visible)
        .map(|layer| layer.id)
        .collect();
    let tiles = flatten_layers(document, &beneath, &Progress::default())?;
    Some(colors_of(&tiles, document.size))
}

/// The color that a document shows at a canvas point, if it is opaque there.
pub fn color_at(document: &Document, at: Vec2) -> Option<Color> {
    let factor = (128.0 / document.size.longer_side()).min(1.0);
    let small = DocumentReducer::new(factor).of(document).ok()?;
    let unlit = Document { surface: None, parts: Arc::default(), ..small };
    let tiles = flatten(&unlit, &Progress::default())?;
    let [r, g, b, a] = tiles.pixel((at.x * factor) as i32, (at.y * factor) as i32);
    (a == 255).then_some(Color::rgb(r, g, b))
}

/// What a layer of a document looks like as a drawing.
pub fn traits_of(document: &Document, layer: LayerId) -> Option<DrawingTraits> {
    Some(DrawingTraits::of(&render_layer(document, layer)?, document.size))
}
