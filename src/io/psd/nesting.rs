//! Layers that become groups, since their effects, their fill opacity and their lines are composed in
//! another order in Photoshop. Floor 5.

use crate::document::{Content, Group, Layer, LayerMask};
use crate::math::srgb::Color;
use crate::paint::{EffectKind, LayerEffect};
use crate::raster::BlendMode;
use std::sync::Arc;

/// A layer whose effects within it are part of what its fill opacity and its blend mode are of: in
/// a group that has these.
pub fn with_effects_within(layer: Layer) -> Layer {
    let is_plain = layer.fill_opacity >= 1.0 && layer.blend == BlendMode::Normal;
    if is_plain || !layer.effects.iter().any(|effect| effect.on && is_of_fill(effect)) {
        return layer;
    }
    let (within, others) = layer.effects.iter().cloned().partition(is_of_fill);
    let inner = Layer {
        effects: Arc::new(within),
        mask: layer.mask.clone(),
        blend_linear: layer.blend_linear,
        clip_to_surface: false,
        ..Layer::new(layer.name.clone(), layer.content)
    };
    let group = Group { layers: vec![Arc::new(inner)], pass_through: false };
    Layer { content: Content::Group(group), effects: Arc::new(others), mask: None, ..layer }
}

/// A layer whose effects follow a shape that it does not cover everywhere: in a group with a layer
/// that has the effects and shows nothing else.
pub fn with_effects_of_shape(layer: Layer, shape: LayerMask) -> Layer {
    let holder = Layer {
        effects: layer.effects.clone(),
        mask: Some(shape),
        fill_opacity: 0.0,
        blend_linear: layer.blend_linear,
        clip_to_surface: false,
        ..Layer::new("Effects", Content::Fill(Color::BLACK))
    };
    let inner = Layer {
        opacity: layer.fill_opacity,
        mask: layer.mask.clone(),
        blend_linear: layer.blend_linear,
        clip_to_surface: false,
        ..Layer::new(layer.name.clone(), layer.content)
    };
    let pass_through =
        layer.blend == BlendMode::Normal && layer.opacity >= 1.0 && !layer.clip_below;
    let group = Group { layers: vec![Arc::new(inner), Arc::new(holder)], pass_through };
    Layer {
        content: Content::Group(group),
        effects: Arc::default(),
        fill_opacity: 1.0,
        mask: None,
        ..layer
    }
}

/// A shape whose line lies on what is clipped to it and on its effects within: a group of both,
/// which has the others.
pub fn with_line_over(layer: Layer, line: Layer) -> Layer {
    let is_within =
        |effect: &LayerEffect| is_of_fill(effect) || effect.kind == EffectKind::InnerShadow;
    let (within, others) = layer.effects.iter().cloned().partition(is_within);
    let inner = Layer {
        effects: Arc::new(within),
        mask: layer.mask.clone(),
        blend_linear: layer.blend_linear,
        clip_to_surface: false,
        ..Layer::new(layer.name.clone(), layer.content)
    };
    let group = Group { layers: vec![Arc::new(inner), Arc::new(line)], pass_through: false };
    Layer { content: Content::Group(group), effects: Arc::new(others), mask: None, ..layer }
}

/// Effects that lie on what a layer is filled with.
pub fn is_of_fill(effect: &LayerEffect) -> bool {
    use EffectKind as Kind;
    matches!(effect.kind, Kind::InnerGlow | Kind::Satin)
        || matches!(effect.kind, Kind::ColorOverlay | Kind::GradientOverlay | Kind::PatternOverlay)
}
