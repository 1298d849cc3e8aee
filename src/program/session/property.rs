//! One property of a layer and its new value, as changed by sliders, boxes and menus of the panels.
//! Floor 6.

mod values;

use super::PicturePart;
use super::replay::actions;
use crate::document::{
    Content, DerivedMask, DetailSource, Layer, LayerLabel, LayerLock, LayerTransform, Live,
    NormalLayer,
};
use crate::io::recipe::preset_brush;
use crate::math::range::{STOPS, clamp_to_range};
use crate::math::{TURNS, Vec2, Vec3, srgb::Color};
use crate::paint::{
    Adjust, Brush, ColorAdjustment, DrawingHand, FormDrawing, FormPattern, Gradient, GradientStop,
    ImageFilter, LayerEffect, LiveAdjustment, LiveFilter, LivePath, PictureFilter, PlacedImage,
    Placement, RampStyle, Text,
};
use crate::raster::{BlendMode, Outside, Resampling};
use crate::shading::scaling::Reference;
use crate::shading::{
    BallStrokes, Features, Light, Model, Mood, Painter, PixelShading, Projection, RadianceScaling,
    Scaling, Shading, Shadows, SolidGlass, Term,
};
use crate::surface::form_lines::LineSettings;
use crate::surface::hatching::HatchSettings;
use crate::surface::plane_piece::PlanePiece;
use crate::surface::{Anchor, NoiseRelief, Operator, Weights};
use std::sync::Arc;
use values::set_mask;

actions! {
    /// A property and its new value.
    Property {
        "name" Name { name: String }
        "visible" Visible { on: bool }
        "opacity" Opacity { to: f32 }
        /// Of what the layer holds, not of its effects.
        "fill opacity" FillOpacity { to: f32 }
        /// All of its effects, the topmost of a kind first.
        "effects" Effects { effects: Vec<LayerEffect> }
        "blend" Blend { mode: BlendMode }
        "linear" BlendLinear { on: bool }
        "clip" ClipBelow { on: bool }
        "lock" Locked { lock: LayerLock }
        "label" Labeled { label: LayerLabel }
        "clip to surface" ClipToSurface { on: bool }
        /// Where the layer's frame lies on the canvas; none: it is the canvas.
        "transform" Transformed { transform: Option<LayerTransform> }
        /// How the pixels of a transformed layer are sampled.
        "sampling" Sampled { filter: Resampling }
        /// Without its liquify.
        "without liquify" Unliquified {}
        "pass through" PassThrough { on: bool }
        "fill" Fill { color: Color }
        "operator" Bend { operator: Operator }
        "anchors" Anchors { anchors: Vec<Anchor> }
        /// For an image or a gradient on the unwrapped surface: pieces on which it is turned, moved
        /// and scaled alone.
        "pieces" Pieces { pieces: Vec<PlanePiece> }
        "power" Power { to: f32 }
        "placement" Place { placement: Placement }
        "outside" Beyond { outside: Outside }
        "filter" Filtered { filter: ImageFilter }
        "adjust" Adjusted { adjust: Adjust }
        /// Which lines a drawing by the form has.
        "lines" Lines { lines: LineSettings }
        /// What hatching is like.
        "hatching" Hatched { hatching: HatchSettings }
        /// The stroke layer whose strokes hatching follows, by its name.
        "guided by" GuidedBy { name: String }
        /// The stroke layer whose strokes stand in the place of form lines, by its name.
        "redrawn on" RedrawnOn { name: String }
        /// The layer whose tone hatching has, by its name.
        "tone of" ToneOf { name: String }
        /// How a hand follows the lines of such a drawing.
        "hand" Hand { hand: DrawingHand }
        /// The size of its brush, px.
        "line size" LineSize { to: f32 }
        /// A brush that comes with the program, by its key, in the size that lines have.
        "drawn with" DrawnWith { preset: String }
        /// What a text says, in which type.
        "text" Worded { text: Text }
        /// The lines of a path, and how it looks.
        "path" Drawn { path: LivePath }
        "stops" Stops { stops: Vec<GradientStop> }
        "ends" Ends { from: Vec2, to: Vec2 }
        /// How a gradient runs from end to end.
        "ramp" Ramp { style: RampStyle }
        /// A mask derived from the surface, or none.
        "mask" Mask { mask: Option<DerivedMask> }
        "mask inverted" MaskInverted { on: bool }
        /// Disables or enables the mask.
        "mask disabled" MaskDisabled { on: bool }
        /// The rotation and exposure of the environment: degrees about the vertical axis, stops.
        "environment" Surrounded { projection: Projection, rotation: f32, exposure: f32 }
        /// Removes that picture from the layer.
        "without" Without { part: PicturePart }
        /// The distance up to which occluders count, px.
        "occlusion" Occlusion { to: f32 }
        /// How often rays that meet the surface itself are sent on.
        "bounces" Bounces { to: u32 }
        /// For a normal layer without a map.
        "grain" Grained { grain: NoiseRelief }
        "model" ShadingModel { model: Model }
        "lights" Lights { lights: Vec<Light> }
        "ambient" Ambient { term: Term }
        "diffuse" Diffuse { term: Term }
        "specular" Specular { term: Term }
        "shininess" Shininess { to: f32 }
        "bands" Bands { to: u32 }
        "exponent" Exponent { to: f32 }
        "anisotropy" Anisotropy { nu: f32, nv: f32 }
        "index" RefractiveIndex { to: f32 }
        "shadows" Shadowed { shadows: Shadows }
        "painter" Painted { painter: Painter }
        "pixels" Pixeled { pixel: PixelShading }
        "ball strokes" BallMarks { strokes: BallStrokes }
        "solid glass" Solid { solid: SolidGlass }
        /// Lamps, shadows and painter's light of a mood.
        "mood" InMood { mood: Mood }
        "features" Features { features: Features }
        "scaling" Scaled { scaling: Scaling }
        "scaling light" ScalingLight { light: Vec3 }
        "reference" ScalingReference { reference: Reference }
        "keep mean" KeepMean { on: bool }
        "strength" Strength { to: f32 }
        /// What an adjustment layer does.
        "adjustment" Adjustment { to: ColorAdjustment }
        /// What a filter layer does.
        "filter layer" FilterLayer { to: PictureFilter }
    }
}

impl Property {
    /// The name of the step.
    pub fn label(&self) -> &'static str {
        match self {
            Property::Name { .. } => "Rename layer",
            Property::Visible { on: true } => "Show layer",
            Property::Visible { on: false } => "Hide layer",
            Property::Opacity { .. } => "Opacity",
            Property::FillOpacity { .. } => "Fill opacity",
            Property::Effects { .. } => "Effects",
            Property::Blend { .. } | Property::BlendLinear { .. } => "Blend mode",
            Property::ClipBelow { .. } => "Clip to layer below",
            Property::Locked { .. } => "Lock layer",
            Property::Labeled { .. } => "Label",
            Property::ClipToSurface { .. } => "Clip to surface",
            Property::Transformed { .. } | Property::Sampled { .. } => "Transform",
            Property::Unliquified {} => "Remove liquify",
            Property::PassThrough { .. } => "Pass through",
            Property::Fill { .. } => "Fill color",
            Property::Bend { .. } => "Bend",
            Property::Anchors { .. } => "Anchors",
            Property::Pieces { .. } => "Pieces",
            Property::Power { .. } => "Anchor weights",
            Property::Place { .. } => "Placement",
            Property::Beyond { .. } => "Outside",
            Property::Filtered { .. } => "Filter",
            Property::Adjusted { .. } => "Adjust image",
            Property::Lines { .. } | Property::RedrawnOn { .. } => "Form lines",
            Property::Hatched { .. } | Property::GuidedBy { .. } | Property::ToneOf { .. } => {
                "Hatching"
            }
            Property::Hand { .. } => "Hand",
            Property::LineSize { .. } | Property::DrawnWith { .. } => "Brush of the lines",
            Property::Worded { .. } => "Text",
            Property::Drawn { .. } => "Path",
            Property::Stops { .. } => "Gradient stops",
            Property::Ends { .. } => "Gradient ends",
            Property::Ramp { .. } => "Gradient style",
            Property::Mask { .. }
            | Property::MaskInverted { .. }
            | Property::MaskDisabled { .. } => "Layer mask",
            Property::Surrounded { .. } => "Environment",
            Property::Without { .. } => "Remove picture",
            Property::Occlusion { .. } | Property::Bounces { .. } => "Material",
            Property::Grained { .. } => "Detail normals",
            Property::ShadingModel { .. } => "Shading model",
            Property::Lights { .. } => "Lights",
            Property::Ambient { .. } | Property::Diffuse { .. } | Property::Specular { .. } => {
                "Material"
            }
            Property::Shininess { .. } | Property::Bands { .. } | Property::Exponent { .. } => {
                "Material"
            }
            Property::Anisotropy { .. } | Property::RefractiveIndex { .. } => "Material",
            Property::Solid { .. } => "Solid glass",
            Property::Shadowed { .. } => "Shadows",
            Property::Painted { .. } => "Painter's light",
            Property::Pixeled { .. } => "Pixel shading",
            Property::BallMarks { .. } => "Strokes of the ball",
            Property::InMood { .. } => "Mood",
            Property::Features { .. } => "Features",
            Property::Scaled { .. }
            | Property::ScalingReference { .. }
            | Property::KeepMean { .. } => "Bring out form",
            Property::ScalingLight { .. } => "Bring out form",
            Property::Strength { .. } => "Strength",
            Property::Adjustment { to } => to.label(),
            Property::FilterLayer { to } => to.label(),
        }
    }

    /// Sets the value of a layer. A layer without the property is left as it is; so is what a text
    /// says, which takes fonts (`texts`), and a path, which takes the canvas (`paths`).
    pub fn apply(&self, layer: &mut Layer) {
        match self {
            Property::Name { name } => layer.name.clone_from(name),
            Property::Visible { on } => layer.visible = *on,
            Property::Sampled { filter } => {
                if let Some(transform) = &mut layer.transform {
                    transform.filter = *filter;
                }
            }
            Property::Transformed { transform } => layer.transform.clone_from(transform),
            Property::Unliquified {} => layer.liquify = None,
            Property::Opacity { to } => layer.opacity = clamp_to_range(*to, &Layer::OPACITY),
            Property::FillOpacity { to } => {
                layer.fill_opacity = clamp_to_range(*to, &Layer::OPACITY);
            }
            Property::Effects { effects } => {
                let fitted = effects.iter().take(LayerEffect::MOST).cloned();
                layer.effects = Arc::new(fitted.map(LayerEffect::clamp_to_ranges).collect());
            }
            Property::Blend { mode } => layer.blend = *mode,
            Property::BlendLinear { on } => layer.blend_linear = *on,
            Property::ClipBelow { on } => layer.clip_below = *on,
            Property::Locked { lock } => layer.lock = *lock,
            Property::Labeled { label } => layer.label = *label,
            Property::ClipToSurface { on } => layer.clip_to_surface = *on,
            Property::Mask { mask } => set_mask(layer, *mask),
            Property::MaskInverted { on } => {
                if let Some(mask) = &mut layer.mask {
                    mask.invert = *on;
                }
            }
            Property::MaskDisabled { on } => {
                if let Some(mask) = &mut layer.mask {
                    mask.disabled = *on;
                }
            }
            _ => self.apply_to_content(&mut layer.content),
        }
    }

    fn apply_to_content(&self, content: &mut Content) {
        match content {
            Content::Fill(color) => {
                if let Property::Fill { color: next } = self {
                    *color = *next;
                }
            }
            Content::Group(group) => {
                if let Property::PassThrough { on } = self {
                    group.pass_through = *on;
                }
            }
            Content::Normals(normals) => match self {
                Property::Strength { to } => {
                    normals.strength = clamp_to_range(*to, &NormalLayer::STRENGTH)
                }
                Property::Place { placement } => normals.placement = *placement,
                Property::Beyond { outside } => normals.outside = *outside,
                Property::Grained { grain } => normals.source = DetailSource::Grain(finite(*grain)),
                _ => {}
            },
            Content::Image(live) => {
                if let Some(next) = self.image(live.params()) {
                    *live = Live::new(next);
                }
            }
            Content::Gradient(live) => {
                if let Some(next) = self.gradient(live.params()) {
                    *live = Live::new(next);
                }
            }
            Content::FormDrawing(live) => {
                if let Some(next) = self.form_drawing(live.params()) {
                    *live = Live::new(next);
                }
            }
            Content::Shading(live) => {
                if let Some(next) = self.shading(live.params()) {
                    *live = Live::new(next);
                }
            }
            Content::RadianceScaling(scaling) => self.scale(scaling),
            Content::Adjustment(live) => {
                if let Property::Adjustment { to } = self {
                    *live = LiveAdjustment::new(to.clone());
                }
            }
            Content::Filter(live) => {
                if let Property::FilterLayer { to } = self {
                    *live = LiveFilter::new(to.clone());
                }
            }
            Content::Pixels(_) | Content::Strokes(_) | Content::Ink(_) => {}
        }
    }

    fn image(&self, image: &PlacedImage) -> Option<PlacedImage> {
        let mut next = image.clone();
        match self {
            Property::Bend { operator } => next.bend.operator = *operator,
            Property::Anchors { anchors } => next.bend.anchors.clone_from(anchors),
            Property::Pieces { pieces } => next.bend.pieces.clone_from(pieces),
            Property::Power { to } => next.bend.weights = Weights::Shepard { power: *to },
            Property::Place { placement } => next.placement = *placement,
            Property::Beyond { outside } => next.outside = *outside,
            Property::Filtered { filter } => next.filter = *filter,
            Property::Adjusted { adjust } => next.source = image.source.adjusted(*adjust),
            _ => return None,
        }
        Some(next)
    }

    fn gradient(&self, gradient: &Gradient) -> Option<Gradient> {
        let mut next = gradient.clone();
        match self {
            Property::Bend { operator } => next.operator = *operator,
            Property::Stops { stops } if !stops.is_empty() => next.stops.clone_from(stops),
            Property::Ends { from, to } => (next.from, next.to) = (*from, *to),
            Property::Ramp { style } => next.style = *style,
            Property::Pieces { pieces } => next.pieces.clone_from(pieces),
            Property::Filtered { filter } => next.filter = *filter,
            _ => return None,
        }
        Some(next)
    }

    fn form_drawing(&self, drawing: &FormDrawing) -> Option<FormDrawing> {
        let mut next = drawing.clone();
        match (self, &mut next.pattern) {
            (Property::Lines { lines }, FormPattern::Lines(own)) => *own = *lines,
            (Property::Hatched { hatching }, FormPattern::Hatching(own)) => *own = *hatching,
            (Property::GuidedBy { name }, FormPattern::Hatching(_)) => {
                next.sources.guides.clone_from(name);
            }
            (Property::RedrawnOn { name }, FormPattern::Lines(_)) => {
                next.sources.redrawn.clone_from(name);
            }
            (Property::ToneOf { name }, FormPattern::Hatching(_)) => {
                next.sources.tone.clone_from(name);
            }
            (Property::Hand { hand }, _) => next.hand = *hand,
            (Property::Fill { color }, _) => next.color = *color,
            (Property::LineSize { to }, _) => next.brush.size = clamp_to_range(*to, &Brush::SIZE),
            (Property::DrawnWith { preset }, _) => {
                let (brush, _) = preset_brush(preset).filter(|(b, _)| !b.mode.is_retouching())?;
                next.brush = Brush { size: next.brush.size, ..brush };
            }
            _ => return None,
        }
        Some(next)
    }

    fn shading(&self, shading: &Shading) -> Option<Shading> {
        let mut next = shading.clone();
        match self {
            Property::ShadingModel { model } => {
                // Keeps pictures and lights; the terms become the model's defaults.
                let fresh = Shading::new(*model);
                next.model = *model;
                (next.ambient, next.diffuse, next.specular) =
                    (fresh.ambient, fresh.diffuse, fresh.specular);
                next.shadows.on |= fresh.shadows.on;
                if next.lights.is_empty() {
                    next.lights = fresh.lights;
                }
            }
            Property::Lights { lights } => next.lights.clone_from(lights),
            Property::Ambient { term } => next.ambient = *term,
            Property::Diffuse { term } => next.diffuse = *term,
            Property::Specular { term } => next.specular = *term,
            Property::Shininess { to } => next.shininess = clamp_to_range(*to, &Shading::SHININESS),
            Property::Bands { to } => {
                next.bands = (*to).clamp(*Shading::BANDS.start(), *Shading::BANDS.end())
            }
            Property::Exponent { to } => next.exponent = clamp_to_range(*to, &Shading::EXPONENT),
            Property::Anisotropy { nu, nv } => {
                (next.nu, next.nv) = (
                    clamp_to_range(*nu, &Shading::SHININESS),
                    clamp_to_range(*nv, &Shading::SHININESS),
                );
            }
            Property::RefractiveIndex { to } => next.index = clamp_to_range(*to, &Shading::INDEX),
            Property::Shadowed { shadows } => next.shadows = *shadows,
            Property::Painted { painter } => next.painter = *painter,
            Property::Pixeled { pixel } => next.pixel.clone_from(pixel),
            Property::BallMarks { strokes } => next.strokes = *strokes,
            Property::Solid { solid } => next.solid = *solid,
            Property::InMood { mood } => next = mood.on(shading),
            Property::Features { features } => next.features = features.clone(),
            Property::Occlusion { to } => {
                next.occlusion_radius_px = clamp_to_range(*to, &Shading::OCCLUSION_RADIUS_PX);
            }
            Property::Bounces { to } => next.bounces = (*to).min(*Shading::BOUNCES.end()),
            Property::Surrounded { projection, rotation, exposure } => {
                let environment = next.environment.as_mut()?;
                environment.projection = *projection;
                (environment.rotation, environment.exposure) =
                    (clamp_to_range(*rotation, &TURNS), clamp_to_range(*exposure, &STOPS));
            }
            Property::Without { part: PicturePart::Environment } => next.environment = None,
            Property::Without { part: PicturePart::Sphere } => next.sphere = None,
            Property::Without { part: PicturePart::ConcaveSphere } => next.sphere_concave = None,
            _ => return None,
        }
        Some(next)
    }

    fn scale(&self, scaling: &mut RadianceScaling) {
        match self {
            Property::Features { features } => scaling.features = features.clone(),
            Property::Scaled { scaling: next } => scaling.scaling = *next,
            Property::ScalingLight { light } => scaling.light = *light,
            Property::ScalingReference { reference } => scaling.reference = *reference,
            Property::KeepMean { on } => scaling.keep_mean = *on,
            _ => {}
        }
    }
}

/// A grain with numbers that a document may hold.
fn finite(grain: NoiseRelief) -> NoiseRelief {
    NoiseRelief {
        size_px: clamp_to_range(grain.size_px, &NoiseRelief::SIZE_PX),
        octaves: grain.octaves.clamp(*NoiseRelief::OCTAVES.start(), *NoiseRelief::OCTAVES.end()),
        roughness: clamp_to_range(grain.roughness, &NoiseRelief::ROUGHNESS),
        stretch: clamp_to_range(grain.stretch, &NoiseRelief::STRETCH),
        seed: grain.seed,
    }
}
