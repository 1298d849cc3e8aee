//! Edits that flatten layers: they can take long, so the window runs them on another thread. Floor 6. Not here:
//! flattening itself (`document::flatten`).

use super::{LayerAction, sibling};
use crate::document::{Content, Document, Layer, LayerId, LayerSlot, PixelLayer, Progress, flatten_to_paint};
use crate::raster::TileGrid;
use crate::session::open_document::Edit;
use std::sync::Arc;

impl LayerAction {
    /// A description of a long edit.
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
            LayerAction::MergeDown { layer } => match &document.outermost(&layer.find(document)?)[..] {
                [one] if !layer.is_several() => merged(document, *one, progress),
                several => merged_several(document, several, progress),
            },
            LayerAction::Bake { layer } => {
                let ids = document.outermost(&layer.find(document)?);
                let label = if ids.len() > 1 { "Bake layers" } else { "Bake layer" };
                let baked = |next: Document, id| baked(&next, next.layer(id)?, progress);
                let document = ids.into_iter().try_fold(document.clone(), baked)?;
                Some(Edit { label, document, select: Vec::new() })
            }
            LayerAction::Flatten {} => {
                let flat = painted("Picture", flatten_to_paint(document, progress)?);
                let select = vec![flat.id];
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
pub(super) fn baked(document: &Document, layer: &Layer, progress: &Progress) -> Option<Document> {
    let document = &document.with_transform_applied(layer.id)?;
    let mask = document.map_of(layer.id)?.layer_on_canvas(document.layer(layer.id)?).mask.clone();
    let bare = document.with_layer(layer.id, |layer| {
        (layer.opacity, layer.mask, layer.blend, layer.clip_to_surface) = (1.0, None, Default::default(), false);
    })?;
    let tiles = flatten_to_paint(&bare.with_only(&[layer.id])?, progress)?;
    // What was drawn lies on the canvas; the layer's home carries it from there.
    let transform = document.transform_to_canvas(layer.id)?;
    document.with_layer(layer.id, |layer| {
        layer.content = Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() });
        (layer.transform, layer.liquify, layer.mask) = (transform, None, mask);
    })
}

/// With a layer that a mesh or liquify displaces as paint of what it shows, if its kind cannot express that.
pub(super) fn undisplaced(document: &Document, id: LayerId, progress: &Progress) -> Option<Document> {
    let next = document.with_transform_applied(id)?;
    let layer = next.layer(id)?;
    if layer.is_warped() { baked(&next, layer, progress) } else { Some(next) }
}

/// A layer and the one beneath it as one paint layer.
fn merged(document: &Document, id: LayerId, progress: &Progress) -> Option<Edit> {
    // Groups around hand down their transforms, so that what is merged lies as it shows.
    let document = &undisplaced(document, id, progress)?;
    let layer = document.layer(id)?;
    let place = document.place_of(layer.id)?;
    let beneath: LayerId = sibling(document, LayerSlot { index: place.index.checked_sub(1)?, ..place })?;
    let is_group = document.layer(beneath)?.content.group().is_some();
    let is_warped = document.layer(beneath)?.is_warped() && !is_group;
    let document = &if is_warped { undisplaced(document, beneath, progress)? } else { document.clone() };
    let (layer, beneath) = (document.layer(id)?, document.layer(beneath)?.clone());
    // The two alone, in a canvas of their own that sees the same surface.
    // The layers of groups are taken one by one.
    let seen = |layer: &Arc<Layer>| match layer.content.group() {
        Some(_) => Some(layer.clone()),
        None => Some(document.map_of(layer.id)?.layer_on_canvas(layer)),
    };
    let lower = Layer { clip_below: false, blend: Default::default(), ..Layer::clone(&*seen(&beneath)?) };
    let pair = Document { layers: vec![Arc::new(lower), seen(layer)?], ..document.clone() };
    let tiles = flatten_to_paint(&pair, progress)?;
    let transform = document.transform_to_canvas(beneath.id)?;
    let document = document.without_layer(layer.id)?.with_layer(beneath.id, |layer| {
        layer.content = Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() });
        (layer.opacity, layer.mask, layer.transform, layer.liquify) = (1.0, None, transform, None);
    })?;
    Some(Edit { label: "Merge down", document, select: vec![beneath.id] })
}

/// Layers, bottom first, as one paint layer in the place of the topmost of them; it has the name and the blend mode of
/// the bottom one.
fn merged_several(document: &Document, ids: &[LayerId], progress: &Progress) -> Option<Edit> {
    let in_place = |next: Document, id: &LayerId| next.with_transform_applied(*id);
    let document = &ids.iter().try_fold(document.clone(), in_place)?;
    let mut layers: Vec<Arc<Layer>> = ids.iter().map(|id| document.layer(*id).cloned()).collect::<Option<_>>()?;
    let bottom = layers.first()?.clone();
    layers[0] = Arc::new(Layer { clip_below: false, blend: Default::default(), ..Layer::clone(&bottom) });
    let visible = layers.iter().any(|layer| layer.visible);
    let tiles = flatten_to_paint(&Document { layers, ..document.clone() }, progress)?;
    let Layer { name, blend, blend_linear, clip_below, clip_to_surface, .. } = Layer::clone(&bottom);
    let one = Layer { visible, blend, blend_linear, clip_below, clip_to_surface, ..painted(&name, tiles) };
    let select = vec![one.id];
    let document = document.with_one_for(ids, one)?;
    Some(Edit { label: "Merge layers", document, select })
}
