//! What the window draws for a document: a layer alone, or the selection under red. Floor 6.

use super::OpenDocument;
use crate::document::{Content, Document, Layer, LayerId, LayerMask, MaskKind};
use crate::math::srgb::Color;
use std::sync::Arc;

impl OpenDocument {
    /// The document as drawn: a solo layer hides the others.
    pub fn drawn_document(&self) -> Document {
        let shown = self.shown_document();
        if self.quick_mask {
            return with_red_mask(shown);
        }
        self.solo.and_then(|id| isolate(shown, id)).unwrap_or_else(|| shown.clone())
    }

    /// Why paint on the selected layer would not be seen: another layer is shown alone.
    pub fn why_hidden_beside(&self) -> Option<String> {
        let document = self.document();
        let (alone, selected) = (document.layer(self.solo?)?, document.layer(self.active_layer?)?);
        let is_seen =
            alone.id == selected.id || document.outermost(&[alone.id, selected.id]) == [alone.id];
        let (beside, shown) = (&selected.name, &alone.name);
        (!is_seen).then(|| {
            format!(
                "“{beside}” is hidden, since “{shown}” is shown alone. Show all (Layer, Show layer alone) to paint."
            )
        })
    }
}

/// The document with what is not selected under red.
fn with_red_mask(document: &Document) -> Document {
    let Some(selected) = document.active_coverage() else { return document.clone() };
    let coverage = Arc::new(selected.to_plane(document.size.rect()));
    let kind = MaskKind::File { file: String::new(), coverage };
    let mask = LayerMask { invert: true, ..LayerMask::new(kind) };
    let red = Content::Fill(Color { r: 230, g: 20, b: 20, a: 255 });
    let sheet = Layer {
        mask: Some(mask),
        opacity: 0.5,
        clip_to_surface: false,
        ..Layer::new("Quick mask", red)
    };
    let mut layers = document.layers.clone();
    layers.push(Arc::new(sheet));
    Document { layers, ..document.clone() }
}

/// The document with one layer shown alone; `None` if it has no such layer.
fn isolate(document: &Document, id: LayerId) -> Option<Document> {
    fn hide(layers: &[Arc<Layer>], id: LayerId) -> (Vec<Arc<Layer>>, bool) {
        let mut found = false;
        let layers = layers.iter().map(|layer| {
            let mut next = Layer::clone(layer);
            next.visible = layer.id == id || (layer.visible && layer.content.is_shaping_surface());
            if let Some(group) = next.content.group_mut()
                && layer.id != id
            {
                let (inner, inside) = hide(&group.layers, id);
                group.layers = inner;
                next.visible = inside;
            }
            found |= next.visible;
            next.clip_below &= layer.id != id;
            Arc::new(next)
        });
        (layers.collect(), found)
    }
    document.layer(id)?;
    let (layers, _) = hide(&document.layers, id);
    Some(Document { layers, ..document.clone() })
}
