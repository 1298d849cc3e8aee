//! Edits that flatten layers: they can take long, so the window runs them on another thread. Floor 6. Flattening itself
//! is in `document::flatten`.

use super::LayerAction;
use super::layers::sibling;
use crate::document::{Content, Document, Layer, LayerId, LayerSlot, PixelLayer, Progress, flatten, flatten_layer};
use crate::raster::TileGrid;
use crate::session::open_document::Edit;
use std::sync::Arc;

impl LayerAction {
    /// A description of an edit that takes long.
    pub fn takes_long(&self) -> Option<&'static str> {
        match self {
            LayerAction::MergeDown { .. } => Some("Merging layers"),
            LayerAction::Bake { .. } => Some("Baking the layer"),
            LayerAction::Flatten {} => Some("Flattening the picture"),
            _ => None,
        }
    }
    /// Performs a long edit on a document; `None` for any other edit, if it is impossible, or if it was cancelled.
    pub fn flattened(&self, document: &Document, progress: &Progress) -> Option<Edit> {
        match self {
            LayerAction::MergeDown { layer } => merged(document, layer.find(document)?, progress),
            LayerAction::Bake { layer } => {
                let document = baked(document, layer.find(document)?, progress)?;
                Some(Edit { label: "Bake layer", document, select: None })
            }
            LayerAction::Flatten {} => {
                let flat = painted("Picture", flatten(document, progress)?);
                let select = Some(flat.id);
                let document = Document { layers: vec![Arc::new(flat)], ..document.clone() };
                Some(Edit { label: "Flatten picture", document, select })
            }
            _ => None,
        }
    }
}

/// A paint layer that holds these tiles.
pub fn painted(name: &str, tiles: TileGrid) -> Layer {
    Layer::new(name, Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }))
}

/// A live layer or a group as paint: what it shows alone, its opacity, mask and blending left to the layer.
fn baked(document: &Document, layer: &Layer, progress: &Progress) -> Option<Document> {
    let document = &document.with_transform_applied(layer.id)?;
    let mask = document.map_of(layer.id)?.layer_on_canvas(document.layer(layer.id)?).mask.clone();
    let bare = document.with_layer(layer.id, |layer| {
        (layer.opacity, layer.mask, layer.blend, layer.clip_to_surface) = (1.0, None, Default::default(), false);
    })?;
    let tiles = flatten_layer(&bare, layer.id, progress)?;
    document.with_layer(layer.id, |layer| {
        layer.content = Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() });
        (layer.transform, layer.mask) = (None, mask);
    })
}

/// A layer and the one beneath it as one paint layer.
fn merged(document: &Document, layer: &Layer, progress: &Progress) -> Option<Edit> {
    // Groups around hand their transforms down, so that what is merged lies as it shows.
    let document = &document.with_transform_applied(layer.id)?;
    let layer = document.layer(layer.id)?;
    let place = document.place_of(layer.id)?;
    let beneath: LayerId = sibling(document, LayerSlot { index: place.index.checked_sub(1)?, ..place })?;
    let beneath = document.layer(beneath)?.clone();
    // The two alone, in a canvas of their own that sees the same surface.
    let pair = vec![Arc::new(Layer { clip_below: false, blend: Default::default(), ..Layer::clone(&beneath) })];
    let mut pair = Document { layers: pair, ..document.clone() };
    pair.layers.push(layer.clone());
    let tiles = flatten(&pair, progress)?;
    let document = document.without_layer(layer.id)?.with_layer(beneath.id, |layer| {
        layer.content = Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() });
        (layer.opacity, layer.mask, layer.transform) = (1.0, None, None);
    })?;
    Some(Edit { label: "Merge down", document, select: Some(beneath.id) })
}
