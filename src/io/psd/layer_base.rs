//! What layers are clipped to, where Photoshop composes both otherwise than this program. Floor 5.

use super::RecordMask;
use crate::document::{Content, Document, Group, Layer, LayerMask, Progress, flatten};
use crate::math::Size;
use std::sync::Arc;

/// What is noted of a layer whose transparency others ignore.
pub const IGNORES_ALPHA: &str =
    "in other programs its effects and the layers clipped to it ignore its transparency";

/// What is noted of a layer that is clipped to another one's own pixels.
pub const CLIPPED_TOGETHER: &str =
    "in other programs it is blended with what is beneath the layer that it is clipped to";

/// What is noted of a layer that is clipped to a group that passes through.
pub const CLIPPED_TO_PASSING: &str =
    "in other programs it is blended with all that its group lets through, too";

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

    /// Whether it is a group that passes through.
    pub fn is_passing(&self, layers: &[Arc<Layer>]) -> bool {
        let group = layers.get(self.index).and_then(|layer| layer.content.group());
        group.is_some_and(|group| group.pass_through)
    }

    /// Whether something in it changes what is beneath: what is clipped to it limits that to what its
    /// layers cover.
    pub fn has_adjustments(&self, layers: &[Arc<Layer>]) -> bool {
        let adjusts =
            |layer: &Layer| layer.visible && matches!(layer.content, Content::Adjustment(_));
        layers.get(self.index).is_some_and(|base| {
            let mut all = vec![base];
            while let Some(layer) = all.pop() {
                if adjusts(layer) {
                    return true;
                }
                all.extend(layer.content.group().into_iter().flat_map(|group| &group.layers));
            }
            false
        })
    }

    /// What is clipped to a group that passes through lies on all that the group lets through, where
    /// its layers cover that wholly. Where they cover it in part, or adjust it, nothing here is the
    /// same.
    pub fn clip_to_passing(&mut self, layers: &[Arc<Layer>], size: Size) {
        if self.has_adjustments(layers) {
            return;
        }
        let Some(group) = layers.get(self.index) else { return };
        let alone = Document { layers: vec![group.clone()], ..Document::empty(size) };
        let Some(shown) = flatten(&alone, &Progress::default()) else { return };
        let alphas = shown.to_straight_rgba(size.rect()).into_iter().skip(3).step_by(4);
        let alphas: Vec<u8> = alphas.collect();
        if alphas.iter().all(|alpha| [0, 255].contains(alpha)) {
            let shape = RecordMask::of_canvas(size, alphas).to_layer_mask(size);
            (self.shape, self.clips_apart) = (Some(shape), true);
        }
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

/// Whether a layer has neither pixels nor effects.
pub fn is_empty(layer: &Layer) -> bool {
    let has_pixels = match &layer.content {
        Content::Pixels(pixels) => pixels.tiles.iter().next().is_some(),
        _ => true,
    };
    !has_pixels && layer.effects.is_empty()
}
