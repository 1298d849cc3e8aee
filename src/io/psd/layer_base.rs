//! What layers are clipped to, where Photoshop composes both otherwise than this program. Floor 5.

use crate::document::{Content, Group, Layer, LayerMask};
use std::sync::Arc;

/// What is noted of a layer whose transparency others ignore.
pub const IGNORES_ALPHA: &str =
    "in other programs its effects and the layers clipped to it ignore its transparency";

/// What is noted of a layer that is clipped to another one's own pixels.
pub const CLIPPED_TOGETHER: &str =
    "in other programs it is blended with what is beneath the layer that it is clipped to";

/// A layer that others may be clipped to.
#[derive(Default)]
pub struct LayerBase {
    /// Its place in the list.
    pub index: usize,
    /// It is a group of a shape and the line that lies on what is clipped to the shape.
    pub has_line_over: bool,
    /// What is clipped to it lies on what is beneath it, too.
    pub clips_apart: bool,
    /// Its shape, if that is known from its pixels.
    pub shape: Option<LayerMask>,
    /// The place of the group of what is clipped to it apart.
    pub apart: Option<usize>,
    /// Its name, if what is clipped to it ignores its transparency.
    pub ignores_alpha: Option<String>,
}

impl LayerBase {
    /// Puts a layer that is clipped to a shape beneath the shape's line.
    pub fn clip_beneath_line(&self, layers: &mut [Arc<Layer>], layer: Layer) {
        let Some(base) = layers.get_mut(self.index) else { return };
        let mut inner = base.content.group().map_or(Vec::new(), |group| group.layers.clone());
        inner.insert(inner.len().saturating_sub(1), Arc::new(layer));
        let group = Content::Group(Group { layers: inner, pass_through: false });
        *base = Arc::new(Layer { content: group, ..Layer::clone(base) });
    }

    /// Whether what is clipped to it lies on what is beneath it, and its shape is known.
    pub fn can_clip_apart(&self) -> bool {
        self.clips_apart && (self.shape.is_some() || self.apart.is_some())
    }

    /// Puts a layer that is clipped to the base into a group that passes through, in the base's
    /// shape, so that it lies on what is beneath the base, too.
    pub fn clip_apart(&mut self, layers: &mut Vec<Arc<Layer>>, layer: Layer) {
        let Some(base) = layers.get(self.index).cloned() else { return };
        let passing = |name: &str, layers| {
            let group = Group { layers, pass_through: true };
            Layer { clip_to_surface: false, ..Layer::new(name, Content::Group(group)) }
        };
        let free = |layer: Layer| Arc::new(Layer { clip_below: false, ..layer });
        if let Some(apart) = self.apart.and_then(|index| layers.get_mut(index)) {
            let mut inner = apart.content.group().map_or(Vec::new(), |group| group.layers.clone());
            inner.push(free(layer));
            let group = Content::Group(Group { layers: inner, pass_through: true });
            *apart = Arc::new(Layer { content: group, ..Layer::clone(apart) });
        } else if let Some(shape) = self.shape.take() {
            self.apart = Some(layers.len());
            let name = format!("Clipped to {}", base.name);
            layers.push(Arc::new(Layer {
                mask: Some(shape),
                opacity: base.opacity,
                visible: base.visible,
                ..passing(&name, vec![free(layer)])
            }));
        }
    }
}
