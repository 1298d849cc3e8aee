//! Layers of one document that are drawn alone, one after the other: what has no part in one is
//! left out beforehand, so that all of them take time by their number, not by its square. Floor 4.
//! Not here: drawing them (`flatten_layers`).

use crate::document::edit::LayerSlot;
use crate::document::{Content, Document, Group, Layer, LayerId};
use std::collections::HashMap;
use std::sync::Arc;

/// The layers of a document by their places.
pub struct SingleLayers<'d> {
    /// The document without layers.
    bare: Document,
    places: HashMap<LayerId, LayerSlot>,
    lists: HashMap<Option<LayerId>, Siblings<'d>>,
}

/// The layers of one list, and of which of them others must know, by index.
struct Siblings<'d> {
    layers: &'d [Arc<Layer>],
    /// They change the surface for the others.
    shaping: Vec<usize>,
    /// Others may be clipped to them.
    bases: Vec<usize>,
}

impl<'d> SingleLayers<'d> {
    /// Those of a document.
    pub fn of(document: &'d Document) -> Self {
        let bare = Document { layers: Vec::new(), ..document.clone() };
        let mut all = Self { bare, places: HashMap::new(), lists: HashMap::new() };
        all.add(None, &document.layers);
        all
    }

    fn add(&mut self, group: Option<LayerId>, layers: &'d [Arc<Layer>]) {
        let indices = |which: &dyn Fn(&Layer) -> bool| {
            let numbered = layers.iter().enumerate();
            numbered.filter(|(_, layer)| which(layer)).map(|(index, _)| index).collect()
        };
        let shaping = indices(&|layer| layer.content.is_shaping_surface());
        let bases = indices(&|layer| !layer.clip_below && !layer.content.is_shaping_surface());
        self.lists.insert(group, Siblings { layers, shaping, bases });
        for (index, layer) in layers.iter().enumerate() {
            self.places.insert(layer.id, LayerSlot { group, index });
            if let Content::Group(inner) = &layer.content {
                self.add(Some(layer.id), &inner.layers);
            }
        }
    }

    /// A document of which [`flatten_layers`](super::flatten_layers) draws the one layer as it does
    /// of the whole one; `None` if there is no such layer.
    ///
    /// * `change`: made to the layer before.
    pub fn isolate_layer(&self, id: LayerId, change: impl FnOnce(&mut Layer)) -> Option<Document> {
        let mut slot = *self.places.get(&id)?;
        let mut own = Layer::clone(self.layer_at(slot)?);
        change(&mut own);
        own.id = id;
        loop {
            let layers = self.lists.get(&slot.group)?.with_one(slot.index, own);
            let Some(group) = slot.group else {
                return Some(Document { layers, ..self.bare.clone() });
            };
            slot = *self.places.get(&group)?;
            let around = Layer::clone(self.layer_at(slot)?);
            let pass_through = around.content.group().is_some_and(|group| group.pass_through);
            own = Layer { content: Content::Group(Group { layers, pass_through }), ..around };
        }
    }

    fn layer_at(&self, slot: LayerSlot) -> Option<&Arc<Layer>> {
        self.lists.get(&slot.group)?.layers.get(slot.index)
    }
}

impl Siblings<'_> {
    /// One of them, with those that shape the surface, and the next base above, which ends what is
    /// clipped to it.
    fn with_one(&self, index: usize, own: Layer) -> Vec<Arc<Layer>> {
        let next = self.bases.partition_point(|base| *base <= index);
        let mut kept: Vec<usize> = self.shaping.clone();
        kept.extend(self.bases.get(next));
        kept.extend((!self.layers[index].content.is_shaping_surface()).then_some(index));
        kept.sort_unstable();
        let own = Arc::new(own);
        let at = |i: usize| if i == index { own.clone() } else { self.layers[i].clone() };
        kept.into_iter().map(at).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, srgb::Color};

    #[test]
    fn a_fill_among_thousands_is_drawn_without_the_others() {
        let fill = |_| Arc::new(Layer::new("fill", Content::Fill(Color::WHITE)));
        let layers = (0..3000).map(fill).collect();
        let document = Document { layers, ..Document::empty(Size::new(8, 8)) };
        let singles = SingleLayers::of(&document);
        let around = singles.isolate_layer(document.layers[1500].id, |_| {}).unwrap();
        assert!(around.walk().len() <= 2, "{}", around.walk().len());
        assert!(singles.isolate_layer(LayerId::fresh(), |_| {}).is_none());
    }
}
