//! Layers of paths: new ones, and other paths in those that are there. Floor 5.

use crate::document::{Content, Document, Layer, LayerId, Live};
use crate::paint::{LivePath, PlacedImage};

/// A layer of a path whose points are canvas points.
pub fn make_layer(document: &Document, path: LivePath) -> Layer {
    let name = document.free_layer_name(path.label());
    let image = PlacedImage::of_path(document.size, path);
    Layer { clip_to_surface: false, ..Layer::new(name, Content::Image(Live::new(image))) }
}

/// The document with another path in the layers of paths among some; `None` where none is. A layer
/// that is named after its figure is named after the new one.
pub fn replace_paths(document: &Document, ids: &[LayerId], path: &LivePath) -> Option<Document> {
    let is_path = |id: &LayerId| document.layer(*id).is_some_and(|layer| of_layer(layer).is_some());
    let ids: Vec<LayerId> = ids.iter().copied().filter(is_path).collect();
    if ids.is_empty() {
        return None;
    }
    document.with_layers(&ids, |layer| {
        let Some(image) = of_layer(layer) else { return };
        let (was, label) = (image.source.path().map(|path| path.label()), path.label());
        let Some(next) = image.with_path(document.size, path.clone()) else { return };
        layer.content = Content::Image(Live::new(next));
        if was.is_some_and(|was| was != label && layer.name == was) {
            layer.name = document.free_layer_name(label);
        }
    })
}

/// The image of a layer that is a path.
pub fn of_layer(layer: &Layer) -> Option<&PlacedImage> {
    match &layer.content {
        Content::Image(live) => live.params().source.path().map(|_| live.params()),
        _ => None,
    }
}
