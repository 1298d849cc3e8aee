//! Tree edits: each gives a new document that shares everything it did not touch.
//! Floor 4. Not here: the list of documents that undo walks (`history`).

#![warn(missing_docs)]

use super::{Document, Layer, LayerId};
use std::sync::Arc;

/// A position among layers: the group (`None`: the document itself) and the number of layers
/// beneath it there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerSlot {
    /// The group; absent: none.
    pub group: Option<LayerId>,
    /// Larger than the number of layers means on top.
    pub index: usize,
}

impl LayerSlot {
    /// Among the layers of the document itself.
    pub fn top_level(index: usize) -> Self {
        Self { group: None, index }
    }

    /// At this height in a group.
    pub fn in_group(group: LayerId, index: usize) -> Self {
        Self { group: Some(group), index }
    }
}

/// The edits. Each is `None` where the layer or the place does not exist; `self` never changes.
impl Document {
    /// A layer by its id, groups opened.
    pub fn layer(&self, id: LayerId) -> Option<&Arc<Layer>> {
        fn find(layers: &[Arc<Layer>], id: LayerId) -> Option<&Arc<Layer>> {
            layers.iter().find_map(|layer| match layer.content.group() {
                _ if layer.id == id => Some(layer),
                Some(group) => find(&group.layers, id),
                None => None,
            })
        }
        find(&self.layers, id)
    }

    /// The slot of a layer.
    pub fn place_of(&self, id: LayerId) -> Option<LayerSlot> {
        fn find(layers: &[Arc<Layer>], group: Option<LayerId>, id: LayerId) -> Option<LayerSlot> {
            layers.iter().enumerate().find_map(|(index, layer)| match layer.content.group() {
                _ if layer.id == id => Some(LayerSlot { group, index }),
                Some(inner) => find(&inner.layers, Some(layer.id), id),
                None => None,
            })
        }
        find(&self.layers, None, id)
    }

    /// With one layer changed. Its id stays whatever `change` does to it, and outlines that name it
    /// follow its name.
    pub fn with_layer(&self, id: LayerId, change: impl FnOnce(&mut Layer)) -> Option<Document> {
        let next = self.with_siblings(self.place_of(id)?, |layers, index| {
            let layer = Arc::make_mut(layers.get_mut(index)?);
            change(layer);
            layer.id = id;
            Some(())
        })?;
        let next = next.with_ink_layers_renamed(self, id).with_form_sources_renamed(self, id);
        Some(if self.parts.is_empty() {
            next
        } else {
            next.with_outlines_renamed(self, id).with_areas_carried(self)
        })
    }

    /// With one more layer. `None` also if the document already has a layer of that id. What it has
    /// on parts that are not in this document stays where it shows.
    pub fn with_inserted(&self, layer: Layer, place: LayerSlot) -> Option<Document> {
        let layer = self.adopt(layer);
        let new = Document { layers: vec![Arc::new(layer)], ..Document::empty(self.size) };
        if new.walk().iter().any(|(_, layer)| self.layer(layer.id).is_some()) {
            return None;
        }
        let layer = new.layers.into_iter().next()?;
        self.with_siblings(place, |layers, index| {
            layers.insert(index.min(layers.len()), layer);
            Some(())
        })
    }

    /// Without a layer and, if it is a group, those in it.
    pub fn without_layer(&self, id: LayerId) -> Option<Document> {
        self.with_siblings(self.place_of(id)?, |layers, index| {
            layers.remove(index);
            Some(())
        })
    }

    /// With a layer moved; `place` counts the layers without it. `None` also if a group would go
    /// into itself.
    pub fn with_moved(&self, id: LayerId, place: LayerSlot) -> Option<Document> {
        let layer = self.layer(id)?.clone();
        let rest = self.without_layer(id)?;
        rest.with_siblings(place, |layers, index| {
            layers.insert(index.min(layers.len()), layer);
            Some(())
        })
    }

    /// Changes the list of layers that a place is in.
    pub(super) fn with_siblings(
        &self,
        place: LayerSlot,
        change: impl FnOnce(&mut Vec<Arc<Layer>>, usize) -> Option<()>,
    ) -> Option<Document> {
        let mut next = self.clone();
        change(siblings(&mut next.layers, place.group)?, place.index)?;
        Some(next)
    }
}

/// The list of layers of a group; only the groups on the way to it are copied.
fn siblings(layers: &mut Vec<Arc<Layer>>, group: Option<LayerId>) -> Option<&mut Vec<Arc<Layer>>> {
    let Some(id) = group else { return Some(layers) };
    let holds = |layer: &Arc<Layer>| layer.id == id || layer.has_layer_within(id);
    let outer = layers.iter_mut().find(|layer| holds(layer))?;
    let found = outer.id == id;
    let inner = Arc::make_mut(outer).content.group_mut()?;
    siblings(&mut inner.layers, if found { None } else { group })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Content, Group};
    use crate::math::{Size, srgb::Color};

    fn fill(name: &str) -> Layer {
        Layer::new(name, Content::Fill(Color::BLACK))
    }

    fn group(name: &str, layers: Vec<Layer>) -> Layer {
        let layers = layers.into_iter().map(Arc::new).collect();
        Layer::new(name, Content::Group(Group { layers, pass_through: false }))
    }

    /// a, g(b, h(c)), d
    fn document() -> Document {
        let inner = group("g", vec![fill("b"), group("h", vec![fill("c")])]);
        let layers = [fill("a"), inner, fill("d")].map(Arc::new).into();
        Document { layers, ..Document::empty(Size::new(8, 8)) }
    }

    fn id(document: &Document, name: &str) -> LayerId {
        document.layer_named(name).unwrap().id
    }

    fn names(document: &Document) -> String {
        document.walk().iter().map(|(_, layer)| layer.name.as_str()).collect()
    }

    #[test]
    fn changing_a_layer_leaves_the_old_document_and_shares_the_others() {
        let old = document();
        let c = id(&old, "c");
        let new = old.with_layer(c, |layer| layer.opacity = 0.5).unwrap();
        assert_eq!((old.layer(c).unwrap().opacity, new.layer(c).unwrap().opacity), (1.0, 0.5));
        assert!(Arc::ptr_eq(&old.layers[0], &new.layers[0]));
        assert!(!Arc::ptr_eq(&old.layers[1], &new.layers[1]));
        assert!(Arc::ptr_eq(old.layer_named("b").unwrap(), new.layer_named("b").unwrap()));
    }

    #[test]
    fn a_layer_keeps_its_id_whatever_is_done_to_it() {
        let old = document();
        let c = id(&old, "c");
        let new = old.with_layer(c, |layer| *layer = fill("other")).unwrap();
        assert_eq!(new.layer(c).unwrap().name, "other");
    }

    #[test]
    fn layers_are_inserted_removed_and_moved_in_and_out_of_groups() {
        let old = document();
        assert_eq!(names(&old), "abchgd");
        let h = id(&old, "h");
        assert_eq!(
            names(&old.with_inserted(fill("x"), LayerSlot::in_group(h, 0)).unwrap()),
            "abxchgd"
        );
        assert_eq!(
            names(&old.with_inserted(fill("x"), LayerSlot::top_level(99)).unwrap()),
            "abchgdx"
        );
        assert_eq!(names(&old.without_layer(h).unwrap()), "abgd");
        let moved = old.with_moved(id(&old, "a"), LayerSlot::in_group(h, 1)).unwrap();
        assert_eq!(names(&moved), "bcahgd");
        assert_eq!(moved.place_of(id(&old, "a")), Some(LayerSlot::in_group(h, 1)));
        assert_eq!(names(&moved.with_moved(h, LayerSlot::top_level(0)).unwrap()), "cahbgd");
    }

    #[test]
    fn what_cannot_be_done_is_not_done_by_halves() {
        let old = document();
        let (g, h) = (id(&old, "g"), id(&old, "h"));
        assert!(old.with_moved(g, LayerSlot::in_group(h, 0)).is_none(), "a group into itself");
        assert!(old.with_moved(g, LayerSlot::in_group(LayerId::fresh(), 0)).is_none());
        assert!(old.without_layer(LayerId::fresh()).is_none());
        assert!(
            old.with_inserted(fill("x"), LayerSlot::in_group(id(&old, "a"), 0)).is_none(),
            "into no group"
        );
        let twin = Layer::clone(old.layer(h).unwrap());
        assert!(old.with_inserted(twin, LayerSlot::top_level(0)).is_none(), "the same layer twice");
    }
}
