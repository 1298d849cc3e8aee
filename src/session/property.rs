//! One property of a layer and its new value: what sliders, boxes and menus of the panels change.
//! Floor 6.

use super::replay::{actions, names, record};
use crate::document::{Content, Layer, LayerMask, Live, Lock, MaskKind};
use crate::math::{Vec2, Vec3, srgb::Color};
use crate::paint::{Adjust, Filter, Gradient, PictureSource, PlacedImage, Placement, Stop};
use crate::raster::{BlendMode, Outside};
use crate::shading::scaling::Reference;
use crate::shading::{FeatureScale, Features, Light, LightKind, Model, RadianceScaling, Scaling, Shading, Term};
use crate::surface::{Anchor, Operator, Weights};

names!(BlendMode);
names!(Lock, [Lock::None => "none", Lock::Alpha => "alpha", Lock::All => "all"]);
names!(Filter, [Filter::Antialias => "antialias", Filter::Bilinear => "bilinear"]);
names!(Outside, [
    Outside::None => "none", Outside::Clamp => "clamp", Outside::Repeat => "repeat", Outside::Mirror => "mirror",
]);
names!(Model, [
    Model::Phong => "phong", Model::Toon => "toon", Model::SubLambertian => "sub-lambertian",
    Model::Ashikhmin => "ashikhmin", Model::DiffuseEnvironment => "diffuse-environment",
    Model::AmbientOcclusion => "ambient-occlusion", Model::LitSphere => "lit-sphere", Model::Mirror => "mirror",
    Model::Refraction => "refraction",
]);
record!(Placement { center, scale, rotation });
record!(Adjust { blur, exposure, hue, saturation, brightness, contrast });
record!(Anchor { at, source });
record!(Stop { t, color });
record!(Scaling { alpha, gamma_convex, gamma_concave });
record!(Term { color, weight, scaling });
record!(FeatureScale { curvature_scale_px, blur_px, weight });
record!(Features { scales, lambda });
record!(Light { kind, color, intensity });

/// How marks follow the surface, as four words with their numbers.
impl super::replay::Replayed for Operator {
    fn written(&self) -> serde_json::Value {
        match *self {
            Operator::None => serde_json::json!({ "kind": "none" }),
            Operator::Depth { gamma } => serde_json::json!({ "kind": "depth", "gamma": gamma.written() }),
            Operator::Normal { alpha, beta, detail } => serde_json::json!({
                "kind": "normal", "alpha": alpha.written(), "beta": beta.written(), "detail": detail.written(),
            }),
            Operator::Reflection { alpha, detail } => serde_json::json!({
                "kind": "reflection", "alpha": alpha.written(), "detail": detail.written(),
            }),
        }
    }
    fn read(value: &serde_json::Value) -> Result<Self, String> {
        let number = |name| super::replay::field::<f32>(value, name);
        match value.get("kind").and_then(|kind| kind.as_str()) {
            Some("none") => Ok(Operator::None),
            Some("depth") => Ok(Operator::Depth { gamma: number("gamma")? }),
            Some("normal") => {
                Ok(Operator::Normal { alpha: number("alpha")?, beta: number("beta")?, detail: number("detail")? })
            }
            Some("reflection") => Ok(Operator::Reflection { alpha: number("alpha")?, detail: number("detail")? }),
            _ => Err("must be an operator of a known kind".into()),
        }
    }
}

impl super::replay::Replayed for LightKind {
    fn written(&self) -> serde_json::Value {
        match self {
            LightKind::Directional { direction } => serde_json::json!({ "direction": direction.written() }),
            LightKind::Point { position } => serde_json::json!({ "position": position.written() }),
        }
    }
    fn read(value: &serde_json::Value) -> Result<Self, String> {
        match value.get("direction") {
            Some(direction) => Ok(LightKind::Directional { direction: Vec3::read(direction)? }),
            None => Ok(LightKind::Point { position: super::replay::field(value, "position")? }),
        }
    }
}

/// Y*: a number, or the largest there is.
impl super::replay::Replayed for Reference {
    fn written(&self) -> serde_json::Value {
        match self {
            Reference::Auto => "auto".into(),
            Reference::Value(value) => value.written(),
        }
    }
    fn read(value: &serde_json::Value) -> Result<Self, String> {
        if value == "auto" { Ok(Reference::Auto) } else { f32::read(value).map(Reference::Value) }
    }
}

/// A mask derived from the surface; one that is a picture is kept as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DerivedMask(pub MaskNumbers);

/// The numbers of a derived mask.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MaskNumbers {
    Fresnel { f0: f32, power: f32 },
    Curvature { scale: f32, blur: f32, from: f32, to: f32 },
    Depth { from: f32, to: f32 },
}

impl super::replay::Replayed for DerivedMask {
    fn written(&self) -> serde_json::Value {
        let (kind, numbers): (&str, Vec<f32>) = match self.0 {
            MaskNumbers::Fresnel { f0, power } => ("fresnel", vec![f0, power]),
            MaskNumbers::Curvature { scale, blur, from, to } => ("curvature", vec![scale, blur, from, to]),
            MaskNumbers::Depth { from, to } => ("depth", vec![from, to]),
        };
        serde_json::json!({ "kind": kind, "numbers": numbers.written() })
    }
    fn read(value: &serde_json::Value) -> Result<Self, String> {
        let numbers: Vec<f32> = super::replay::field(value, "numbers")?;
        let kind = value.get("kind").and_then(|kind| kind.as_str()).unwrap_or_default();
        Ok(Self(match (kind, &numbers[..]) {
            ("fresnel", &[f0, power]) => MaskNumbers::Fresnel { f0, power },
            ("curvature", &[scale, blur, from, to]) => MaskNumbers::Curvature { scale, blur, from, to },
            ("depth", &[from, to]) => MaskNumbers::Depth { from, to },
            _ => return Err("must be a mask of a known kind with its numbers".into()),
        }))
    }
}

actions! {
    /// A property and its new value.
    Property {
        "name" Name { name: String }
        "visible" Visible { on: bool }
        "opacity" Opacity { to: f32 }
        "blend" Blend { mode: BlendMode }
        "linear" BlendLinear { on: bool }
        "clip" ClipBelow { on: bool }
        "lock" Locked { lock: Lock }
        "clip to surface" ClipToSurface { on: bool }
        "pass through" PassThrough { on: bool }
        "fill" Fill { color: Color }
        "operator" Bend { operator: Operator }
        "anchors" Anchors { anchors: Vec<Anchor> }
        "power" Power { to: f32 }
        "placement" Place { placement: Placement }
        "outside" Beyond { outside: Outside }
        "filter" Filtered { filter: Filter }
        "adjust" Adjusted { adjust: Adjust }
        "stops" Stops { stops: Vec<Stop> }
        "ends" Ends { from: Vec2, to: Vec2 }
        /// A mask derived from the surface, or none.
        "mask" Mask { mask: Option<DerivedMask> }
        "mask inverted" MaskInverted { on: bool }
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
        "features" Features { features: Features }
        "scaling" Scaled { scaling: Scaling }
        "scaling light" ScalingLight { light: Vec3 }
        "reference" ScalingReference { reference: Reference }
        "keep mean" KeepMean { on: bool }
        "strength" Strength { to: f32 }
    }
}

impl Property {
    /// What the step is called.
    pub fn label(&self) -> &'static str {
        match self {
            Property::Name { .. } => "Rename layer",
            Property::Visible { on: true } => "Show layer",
            Property::Visible { on: false } => "Hide layer",
            Property::Opacity { .. } => "Opacity",
            Property::Blend { .. } | Property::BlendLinear { .. } => "Blend mode",
            Property::ClipBelow { .. } => "Clip to layer below",
            Property::Locked { .. } => "Lock layer",
            Property::ClipToSurface { .. } => "Clip to surface",
            Property::PassThrough { .. } => "Pass through",
            Property::Fill { .. } => "Fill colour",
            Property::Bend { .. } => "Operator",
            Property::Anchors { .. } => "Anchors",
            Property::Power { .. } => "Anchor weights",
            Property::Place { .. } => "Placement",
            Property::Beyond { .. } => "Outside",
            Property::Filtered { .. } => "Filter",
            Property::Adjusted { .. } => "Adjust image",
            Property::Stops { .. } => "Gradient stops",
            Property::Ends { .. } => "Gradient ends",
            Property::Mask { .. } | Property::MaskInverted { .. } => "Layer mask",
            Property::ShadingModel { .. } => "Shading model",
            Property::Lights { .. } => "Lights",
            Property::Ambient { .. } | Property::Diffuse { .. } | Property::Specular { .. } => "Material",
            Property::Shininess { .. } | Property::Bands { .. } | Property::Exponent { .. } => "Material",
            Property::Anisotropy { .. } | Property::RefractiveIndex { .. } => "Material",
            Property::Features { .. } => "Features",
            Property::Scaled { .. } | Property::ScalingReference { .. } | Property::KeepMean { .. } => {
                "Radiance scaling"
            }
            Property::ScalingLight { .. } => "Radiance scaling",
            Property::Strength { .. } => "Strength",
        }
    }
    /// Gives a layer the value. What the layer does not have stays as it is.
    pub fn apply(&self, layer: &mut Layer) {
        match self {
            Property::Name { name } => layer.name.clone_from(name),
            Property::Visible { on } => layer.visible = *on,
            Property::Opacity { to } => layer.opacity = to.max(0.0).min(1.0),
            Property::Blend { mode } => layer.blend = *mode,
            Property::BlendLinear { on } => layer.blend_linear = *on,
            Property::ClipBelow { on } => layer.clip_below = *on,
            Property::Locked { lock } => layer.lock = *lock,
            Property::ClipToSurface { on } => layer.clip_to_surface = *on,
            Property::Mask { mask } => set_mask(layer, *mask),
            Property::MaskInverted { on } => {
                if let Some(mask) = &mut layer.mask {
                    mask.invert = *on;
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
                Property::Strength { to } => normals.strength = to.max(0.0),
                Property::Place { placement } => normals.placement = *placement,
                Property::Beyond { outside } => normals.outside = *outside,
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
            Content::Shading(live) => {
                if let Some(next) = self.shading(live.params()) {
                    *live = Live::new(next);
                }
            }
            Content::RadianceScaling(scaling) => self.scale(scaling),
            Content::Pixels(_) | Content::Strokes(_) => {}
        }
    }
    fn image(&self, image: &PlacedImage) -> Option<PlacedImage> {
        let mut next = image.clone();
        match self {
            Property::Bend { operator } => next.bend.operator = *operator,
            Property::Anchors { anchors } => next.bend.anchors.clone_from(anchors),
            Property::Power { to } => next.bend.weights = Weights::Shepard { power: *to },
            Property::Place { placement } => next.placement = *placement,
            Property::Beyond { outside } => next.outside = *outside,
            Property::Filtered { filter } => next.filter = *filter,
            Property::Adjusted { adjust } => {
                let source = &image.source;
                next.source = PictureSource::new(source.file.clone(), source.picture.clone(), *adjust);
            }
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
            Property::Filtered { filter } => next.filter = *filter,
            _ => return None,
        }
        Some(next)
    }
    fn shading(&self, shading: &Shading) -> Option<Shading> {
        let mut next = shading.clone();
        match self {
            Property::ShadingModel { model } => {
                // The pictures and lights stay; the terms are those the model begins with.
                let fresh = Shading::new(*model);
                next.model = *model;
                (next.ambient, next.diffuse, next.specular) = (fresh.ambient, fresh.diffuse, fresh.specular);
                if next.lights.is_empty() {
                    next.lights = fresh.lights;
                }
            }
            Property::Lights { lights } => next.lights.clone_from(lights),
            Property::Ambient { term } => next.ambient = *term,
            Property::Diffuse { term } => next.diffuse = *term,
            Property::Specular { term } => next.specular = *term,
            Property::Shininess { to } => next.shininess = to.max(0.0),
            Property::Bands { to } => next.bands = (*to).max(2),
            Property::Exponent { to } => next.exponent = to.max(0.0).min(1.0),
            Property::Anisotropy { nu, nv } => (next.nu, next.nv) = (nu.max(0.0), nv.max(0.0)),
            Property::RefractiveIndex { to } => next.index = to.max(0.01),
            Property::Features { features } => next.features = features.clone(),
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

fn set_mask(layer: &mut Layer, mask: Option<DerivedMask>) {
    let invert = layer.mask.as_ref().is_some_and(|mask| mask.invert);
    layer.mask = mask.map(|DerivedMask(numbers)| {
        let kind = match numbers {
            MaskNumbers::Fresnel { f0, power } => MaskKind::Fresnel { f0, power },
            MaskNumbers::Curvature { scale, blur, from, to } => MaskKind::Curvature { scale, blur, from, to },
            MaskNumbers::Depth { from, to } => MaskKind::Depth { from, to },
        };
        LayerMask { kind, invert }
    });
}
