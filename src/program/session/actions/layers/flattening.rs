//! Edits that flatten layers: they can take long, so the window runs them on another thread.
//! Floor 6. Not here: flattening itself (`document::flatten`).

use super::{LayerAction, sibling};
use crate::document::{
    Content, Document, Layer, LayerId, LayerSlot, PixelLayer, Progress, flatten_to_be_clipped,
    flatten_to_paint,
};
use crate::io::Budget;
use crate::raster::TileGrid;
use crate::session::open_document::Edit;
use std::sync::Arc;

impl LayerAction {
    /// A description of a long edit.
    pub fn takes_long(&self) -> Option<&'static str> {
        match self {
            LayerAction::MergeDown { .. } => Some("Merging layers"),
            LayerAction::Bake { .. } => Some("Turning the layer into pixels"),
            LayerAction::Flatten {} => Some("Flattening the picture"),
            _ => None,
        }
    }

    /// Why a long edit cannot begin: the layers that it paints take more memory than is free.
    pub fn no_room(&self, document: &Document, budget: &Budget) -> Option<String> {
        let what = self.takes_long()?;
        let one = |id: &LayerId| Some(document.with_only(&[*id])?.painting_bytes());
        let bytes = match self {
            LayerAction::MergeDown { layer } => {
                let ids = document.outermost(&layer.find(document)?);
                let beneath = match &ids[..] {
                    [only] if !layer.is_several() => layer_beneath(document, *only),
                    _ => None,
                };
                ids.iter().chain(&beneath).filter_map(one).fold(0, u64::saturating_add)
            }
            LayerAction::Bake { layer } => document
                .outermost(&layer.find(document)?)
                .iter()
                .filter_map(one)
                .fold(0, u64::saturating_add),
            _ => document.painting_bytes(),
        };
        budget.room_for(what, bytes).err().map(|why| format!("{why}."))
    }

    /// Performs a long edit on a document; `None` for any other edit, if it is impossible, or if it
    /// was canceled.
    pub fn perform_long(&self, document: &Document, progress: &Progress) -> Option<Edit> {
        match self {
            LayerAction::MergeDown { layer } => {
                match &document.outermost(&layer.find(document)?)[..] {
                    [one] if !layer.is_several() => merge_down(document, *one, progress),
                    several => merge_several(document, several, progress),
                }
            }
            LayerAction::Bake { layer } => {
                let ids = document.outermost(&layer.find(document)?);
                let label = if ids.len() > 1 {
                    "Turn layers into pixels"
                } else {
                    "Turn layer into pixels"
                };
                let baked = |next: Document, id| {
                    // What a frame clips stays clipped.
                    let next = next.with_frame_as_mask(id).unwrap_or(next);
                    bake(&next, next.layer(id)?, progress)
                };
                let document = ids.into_iter().try_fold(document.clone(), baked)?;
                Some(Edit { label, document, select: Vec::new(), note: None })
            }
            LayerAction::Flatten {} => {
                let all: Vec<LayerId> = document.layers.iter().map(|layer| layer.id).collect();
                let document = &document.with_outlines_frozen(&all, progress)?;
                let flat = paint_layer("Picture", flatten_to_paint(document, progress)?);
                let select = vec![flat.id];
                let document = Document { layers: vec![Arc::new(flat)], ..document.clone() };
                Some(Edit { label: "Flatten picture", document, select, note: None })
            }
            _ => None,
        }
    }
}

/// A paint layer that holds these tiles.
pub fn paint_layer(name: &str, tiles: TileGrid) -> Layer {
    Layer::new(name, Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }))
}

/// A live layer or a group as paint: what it shows alone, its opacity, mask and blending left to
/// the layer.
pub(super) fn bake(document: &Document, layer: &Layer, progress: &Progress) -> Option<Document> {
    let document = &document.with_transform_applied(layer.id)?;
    let mask = document.map_of(layer.id)?.layer_on_canvas(document.layer(layer.id)?).mask.clone();
    let bare = document.with_layer(layer.id, |layer| {
        (layer.opacity, layer.mask, layer.blend, layer.clip_to_surface) =
            (1.0, None, Default::default(), false);
    })?;
    // The surface cuts it as it cut the layer.
    let flatten = if layer.clip_to_surface { flatten_to_be_clipped } else { flatten_to_paint };
    let tiles = flatten(&bare.with_only(&[layer.id])?, progress)?;
    // What was drawn lies on the canvas; the layer's attachment carries it from there.
    let transform = document.transform_to_canvas(layer.id)?;
    document.with_layer(layer.id, |layer| {
        layer.content = Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() });
        (layer.transform, layer.liquify, layer.mask) = (transform, None, mask);
    })
}

/// With a layer that a mesh or liquify displaces as paint of what it shows, if its kind cannot
/// express that.
pub(super) fn bake_displacement(
    document: &Document,
    id: LayerId,
    progress: &Progress,
) -> Option<Document> {
    let next = document.with_transform_applied(id)?;
    let layer = next.layer(id)?;
    if layer.is_warped() { bake(&next, layer, progress) } else { Some(next) }
}

/// The layer beneath one in its list.
pub(super) fn layer_beneath(document: &Document, id: LayerId) -> Option<LayerId> {
    let place = document.place_of(id)?;
    sibling(document, LayerSlot { index: place.index.checked_sub(1)?, ..place })
}

/// A layer and the one beneath it as one paint layer.
fn merge_down(document: &Document, id: LayerId, progress: &Progress) -> Option<Edit> {
    // Groups around hand down their transforms, so that what is merged lies as it shows.
    let document = &bake_displacement(document, id, progress)?;
    let beneath = layer_beneath(document, id)?;
    let document = &document.with_outlines_frozen(&[beneath, id], progress)?;
    let is_group = document.layer(beneath)?.content.group().is_some();
    let is_warped = document.layer(beneath)?.is_warped() && !is_group;
    let document =
        &if is_warped { bake_displacement(document, beneath, progress)? } else { document.clone() };
    let (layer, beneath) = (document.layer(id)?, document.layer(beneath)?.clone());
    // The two alone, in a canvas of their own that sees the same surface.
    // The layers of groups are taken one by one.
    let seen = |layer: &Arc<Layer>| match layer.content.group() {
        Some(_) => Some(layer.clone()),
        None => Some(document.map_of(layer.id)?.layer_on_canvas(layer)),
    };
    let lower =
        Layer { clip_below: false, blend: Default::default(), ..Layer::clone(&*seen(&beneath)?) };
    let pair = Document { layers: vec![Arc::new(lower), seen(layer)?], ..document.clone() };
    let tiles = flatten_to_paint(&pair, progress)?;
    let transform = document.transform_to_canvas(beneath.id)?;
    let document = document.without_layer(layer.id)?.with_layer(beneath.id, |layer| {
        layer.content = Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() });
        (layer.opacity, layer.mask, layer.transform, layer.liquify) = (1.0, None, transform, None);
    })?;
    Some(Edit { label: "Merge down", document, select: vec![beneath.id], note: None })
}

/// Layers, bottom first, as one paint layer in the place of the topmost of them; it has the name
/// and the blend mode of the bottom one.
fn merge_several(document: &Document, ids: &[LayerId], progress: &Progress) -> Option<Edit> {
    let in_place = |next: Document, id: &LayerId| next.with_transform_applied(*id);
    let document = &ids.iter().try_fold(document.clone(), in_place)?;
    let document = &document.with_outlines_frozen(ids, progress)?;
    let mut layers: Vec<Arc<Layer>> =
        ids.iter().map(|id| document.layer(*id).cloned()).collect::<Option<_>>()?;
    let bottom = layers.first()?.clone();
    layers[0] =
        Arc::new(Layer { clip_below: false, blend: Default::default(), ..Layer::clone(&bottom) });
    let visible = layers.iter().any(|layer| layer.visible);
    let tiles = flatten_to_paint(&Document { layers, ..document.clone() }, progress)?;
    let Layer { name, blend, blend_linear, clip_below, clip_to_surface, .. } =
        Layer::clone(&bottom);
    let one = Layer {
        visible,
        blend,
        blend_linear,
        clip_below,
        clip_to_surface,
        ..paint_layer(&name, tiles)
    };
    let select = vec![one.id];
    let document = document.with_one_for(ids, one)?;
    Some(Edit { label: "Merge layers", document, select, note: None })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, srgb::Color};
    use crate::session::LayerPaths;

    #[test]
    fn a_long_edit_that_memory_does_not_hold_says_so_in_figures() {
        let fill = || Layer::new("Fill", Content::Fill(Color::BLACK));
        let layers = (0..3).map(|_| Arc::new(fill())).collect();
        let document = Document { layers, ..Document::empty(Size::new(1000, 1000)) };
        let top = LayerPaths::of(&document, &[document.layers[2].id]);
        // A picture of bytes and one of 16 bits for each layer that is painted.
        let no_room = |action: &LayerAction, bytes| {
            action.no_room(&document, &Budget::default().within(bytes))
        };
        let (bake, merge) =
            (LayerAction::Bake { layer: top.clone() }, LayerAction::MergeDown { layer: top });
        assert_eq!(no_room(&bake, 16_000_000), None);
        let why = no_room(&bake, 15_000_000).unwrap();
        assert_eq!(
            why,
            "Turning the layer into pixels takes 16 MB of memory, and 15 MB are free for it."
        );
        assert_eq!(no_room(&merge, 32_000_000), None);
        assert!(no_room(&merge, 31_000_000).unwrap().starts_with("Merging layers takes 32 MB"));
        assert_eq!(no_room(&LayerAction::Flatten {}, 16_000_000), None);
        assert!(no_room(&LayerAction::Flatten {}, 15_000_000).is_some());
    }

    #[test]
    fn a_frame_that_becomes_paint_still_clips() {
        use crate::document::{Group, Live, flatten};
        use crate::math::vec2;
        use crate::paint::{Figure, FigureKind, LivePath, PlacedImage};
        let size = Size::new(100, 80);
        let (from, to) = (vec2(20.0, 10.0), vec2(60.5, 50.0));
        let figure = Figure { kind: FigureKind::Rectangle, from, to, ..Figure::DEFAULT };
        let path = LivePath { outline: 4.0, frames: true, ..LivePath::new(figure) };
        let frame =
            Layer::new("Frame", Content::Image(Live::new(PlacedImage::of_path(size, path))));
        let fill = Layer::new("Fill", Content::Fill(Color::rgb(200, 20, 10)));
        let layers = vec![Arc::new(fill), Arc::new(frame)];
        let group = Group { layers, pass_through: false };
        let group = Layer::new("Panel", Content::Group(group));
        let document = Document { layers: vec![Arc::new(group)], ..Document::empty(size) };
        let frame = document.layers[0].content.group().unwrap().layers[1].id;
        let bake = LayerAction::Bake { layer: LayerPaths::of(&document, &[frame]) };
        let progress = Progress::default();
        let baked = bake.perform_long(&document, &progress).unwrap().document;
        assert!(matches!(baked.layer(frame).unwrap().content, Content::Pixels(_)));
        let [before, after] =
            [&document, &baked].map(|document| flatten(document, &progress).unwrap());
        assert_eq!((before.pixel(5, 5)[3], before.pixel(40, 30)), (0, [200, 20, 10, 255]));
        for (x, y) in (0..100).flat_map(|x| (0..80).map(move |y| (x, y))) {
            let both = [before.pixel(x, y), after.pixel(x, y)];
            let off = (0..4).map(|k| both[0][k].abs_diff(both[1][k])).max();
            assert!(off <= Some(1), "{x} {y}: {both:?}");
        }
    }
}
