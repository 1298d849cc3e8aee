//! A group. Whoever walks the stack does to the layers in it what is done to the group. Floor 4.

use super::{CanvasScale, Changed, Content, LayerKind, Role, VisibleArea};
use crate::document::Layer;
use crate::math::Vec2;
use crate::paint::Scene;
use std::sync::Arc;

/// Layers flattened together before they are blended with what lies beneath.
#[derive(Clone, Default)]
pub struct Group {
    /// Bottom first.
    pub layers: Vec<Arc<Layer>>,
    /// Blend each layer with what is below the group, as if the group were not there.
    pub pass_through: bool,
}

impl LayerKind for Group {
    fn name(&self) -> &'static str {
        "group"
    }

    fn label(&self) -> &'static str {
        "Group"
    }

    fn role(&self) -> Role<'_> {
        Role::Groups(self)
    }

    fn scaled(&self, scale: &CanvasScale) -> Content {
        Content::Group(Group { layers: scale.layers(&self.layers), ..*self })
    }

    fn moved(&self, by: Vec2) -> Option<Content> {
        let moved = |layer: &Arc<Layer>| {
            Arc::new(Layer { content: layer.content.moved(by), ..Layer::clone(layer) })
        };
        Some(Content::Group(Group { layers: self.layers.iter().map(moved).collect(), ..*self }))
    }

    /// Each of its layers says this itself.
    fn visible_area(&self, _scene: Option<&Scene>) -> VisibleArea {
        VisibleArea::Nowhere
    }

    fn difference_from(&self, _old: &Content, _scene: &dyn Fn() -> Scene) -> Changed {
        Changed::Wholly
    }
}
