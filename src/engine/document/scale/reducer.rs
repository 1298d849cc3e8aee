//! Scales a changing document down again and again: parts that did not change are not scaled twice. Floor 4. The
//! scaling of one layer is in `scale`.

use super::super::{Content, Document, Group, Layer, LayerId};
use super::CanvasScale;
use crate::surface::{Surface, SurfaceError};
use std::collections::HashMap;
use std::sync::{Arc, Weak};

/// Scales documents down by one factor, and remembers the parts of the last one.
///
/// Parts that did not change come back as the same `Arc`, so that [`diff`](super::super::diff()) reports only what did.
pub struct DocumentReducer {
    factor: f32,
    surface: Option<(Weak<Surface>, Arc<Surface>)>,
    layers: HashMap<LayerId, (Weak<Layer>, Arc<Layer>)>,
}

impl DocumentReducer {
    /// `factor`: as of [`Document::scaled`].
    pub fn new(factor: f32) -> Self {
        Self { factor, surface: None, layers: HashMap::new() }
    }
    /// The reduced document: equal to [`Document::scaled`], with the same errors; what was selected by the surface is
    /// resampled and not found anew.
    pub fn of(&mut self, document: &Document) -> Result<Document, SurfaceError> {
        let Some(scale) = CanvasScale::of(document.size, self.factor) else { return Ok(document.clone()) };
        let surface = document.surface.as_ref().map(|surface| self.surface(surface, &scale)).transpose()?;
        let mut layers = HashMap::new();
        let small = self.stack(&document.layers, &scale, &mut layers);
        self.layers = layers;
        Ok(Document { size: scale.to, surface, layers: small, ..scale.selected(document) })
    }
    /// Scales one more part of the document in advance for [`DocumentReducer::of`]; returns whether there was one.
    /// An idle thread can prepare in steps with this; the surface is one of them and takes half a second at 4096².
    pub fn prepare(&mut self, document: &Document) -> bool {
        let Some(scale) = CanvasScale::of(document.size, self.factor) else { return false };
        if let Some(surface) = &document.surface
            && self.surface.as_ref().is_none_or(|(known, _)| known.as_ptr() != Arc::as_ptr(surface))
        {
            return self.surface(surface, &scale).is_ok();
        }
        // Groups cost nothing once their layers are known.
        let is_new = |layer: &&Arc<Layer>| {
            let known = self.layers.get(&layer.id).is_some_and(|(known, _)| known.as_ptr() == Arc::as_ptr(layer));
            !known && layer.content.group().is_none()
        };
        let Some(layer) = document.walk().into_iter().map(|(_, layer)| layer).find(is_new) else { return false };
        self.layers.insert(layer.id, (Arc::downgrade(layer), Arc::new(scale.layer(layer))));
        true
    }
    fn surface(&mut self, surface: &Arc<Surface>, scale: &CanvasScale) -> Result<Arc<Surface>, SurfaceError> {
        if let Some((known, small)) = &self.surface
            && known.as_ptr() == Arc::as_ptr(surface)
            && small.size() == scale.to
        {
            return Ok(small.clone());
        }
        let small = Arc::new(surface.stretched(scale.to)?);
        self.surface = Some((Arc::downgrade(surface), small.clone()));
        Ok(small)
    }
    /// Scales a list of layers, taking known ones from last time; `next` collects what is known from now on.
    fn stack(
        &self,
        layers: &[Arc<Layer>],
        scale: &CanvasScale,
        next: &mut HashMap<LayerId, (Weak<Layer>, Arc<Layer>)>,
    ) -> Vec<Arc<Layer>> {
        let mut small = Vec::with_capacity(layers.len());
        for layer in layers {
            let known = self.layers.get(&layer.id).filter(|(known, _)| known.as_ptr() == Arc::as_ptr(layer));
            // Also if the group itself is known: its layers must stay known.
            let inner = layer.content.group().map(|group| Group {
                layers: self.stack(&group.layers, scale, next),
                pass_through: group.pass_through,
            });
            let made = match (known, inner) {
                (Some((_, made)), _) => made.clone(),
                (None, Some(group)) => {
                    let hollow = Layer { content: Content::Group(Group::default()), ..Layer::clone(layer) };
                    Arc::new(Layer { content: Content::Group(group), ..scale.layer(&hollow) })
                }
                (None, None) => Arc::new(scale.layer(layer)),
            };
            next.insert(layer.id, (Arc::downgrade(layer), made.clone()));
            small.push(made);
        }
        small
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Progress, diff, flatten};
    use crate::math::{Size, srgb::Color};

    fn fill(name: &str, v: u8) -> Layer {
        Layer::new(name, Content::Fill(Color { r: v, g: v, b: v, a: 255 }))
    }

    #[test]
    fn what_did_not_change_is_the_very_same_and_the_picture_is_that_of_scaling() {
        let group =
            Layer::new("group", Content::Group(Group { layers: vec![Arc::new(fill("in", 9))], pass_through: true }));
        let layers = vec![Arc::new(fill("beneath", 40)), Arc::new(group)];
        let document = Document { layers, ..Document::empty(Size::new(300, 200)) };
        let mut reduced = DocumentReducer::new(0.5);
        let first = reduced.of(&document).unwrap();
        assert_eq!(first.size, Size::new(150, 100));
        let inner = document.layer_named("in").unwrap().id;
        let changed = document.with_layer(inner, |layer| layer.opacity = 0.5).unwrap();
        let second = reduced.of(&changed).unwrap();
        assert!(Arc::ptr_eq(&first.layers[0], &second.layers[0]));
        assert!(!diff(&first, &second).is_empty());
        assert!(diff(&second, &reduced.of(&changed).unwrap()).is_empty());
        let (ours, whole) =
            (flatten(&second, &Progress::default()), flatten(&changed.scaled(0.5).unwrap(), &Progress::default()));
        let area = second.size.rect();
        assert!(ours.unwrap().to_straight_rgba(area) == whole.unwrap().to_straight_rgba(area));
    }
    #[test]
    fn what_was_prepared_part_by_part_is_not_made_again() {
        let document = Document {
            layers: vec![Arc::new(fill("beneath", 40)), Arc::new(fill("above", 90))],
            ..Document::empty(Size::new(300, 200))
        };
        let mut reduced = DocumentReducer::new(0.5);
        assert!(reduced.prepare(&document) && reduced.prepare(&document) && !reduced.prepare(&document));
        let made: Vec<_> = document.layers.iter().map(|layer| reduced.layers[&layer.id].1.clone()).collect();
        let small = reduced.of(&document).unwrap();
        assert!(small.layers.iter().zip(&made).all(|(a, b)| Arc::ptr_eq(a, b)));
        let changed = document.with_layer(document.layers[1].id, |layer| layer.opacity = 0.5).unwrap();
        assert!(reduced.prepare(&changed) && !reduced.prepare(&changed), "only the layer that changed");
    }
}
