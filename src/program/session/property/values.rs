//! The values of properties in replays.
//! Floor 6.

use crate::document::{Layer, LayerLabel, LayerLock, LayerMask, LayerTransform, MaskKind};
use crate::io::json::JsonNode;
use crate::io::recipe::transforms;
use crate::math::Vec3;
use crate::paint::{Adjust, GradientStop, ImageFilter, Placement};
use crate::raster::{BlendMode, Outside};
use crate::session::replay::{names, record};
use crate::shading::scaling::Reference;
use crate::shading::{FeatureScale, Features, Light, LightKind, Model, Projection, Scaling, Term};
use crate::surface::region::SurfaceRegion;
use crate::surface::unwrap::PlanePiece;
use crate::surface::{Anchor, NoiseRelief, Operator};

names!(BlendMode);
names!(LayerLabel);
names!(LayerLock, [LayerLock::None => "none", LayerLock::Alpha => "alpha", LayerLock::All => "all"]);
names!(ImageFilter, [ImageFilter::Antialias => "antialias", ImageFilter::Bilinear => "bilinear"]);
names!(Outside, [
    Outside::None => "none", Outside::Clamp => "clamp", Outside::Repeat => "repeat", Outside::Mirror => "mirror",
]);
names!(Model, [
    Model::Phong => "phong", Model::Toon => "toon", Model::SubLambertian => "sub-lambertian",
    Model::Ashikhmin => "ashikhmin", Model::DiffuseEnvironment => "diffuse-environment",
    Model::AmbientOcclusion => "ambient-occlusion", Model::LitSphere => "lit-sphere", Model::Mirror => "mirror",
    Model::Refraction => "refraction",
]);
names!(Projection, [
    Projection::LatLong => "lat-long", Projection::Angular => "angular", Projection::MirrorBall => "mirror-ball",
]);
record!(NoiseRelief { size_px, octaves, roughness, stretch, seed });
record!(Placement { center, scale, rotation });
record!(Adjust { blur, exposure, hue, saturation, brightness, contrast });
record!(Anchor { at, source });
record!(PlanePiece { at, moved, scale, rotation });
record!(GradientStop { t, color });
record!(Scaling { alpha, gamma_convex, gamma_concave });
record!(Term { color, weight, scaling });
record!(FeatureScale { curvature_scale_px, blur_px, weight });
record!(Features { scales, lambda });
record!(Light { kind, color, intensity });

/// As a document says it.
impl crate::session::replay::ReplayValue for LayerTransform {
    fn written(&self) -> serde_json::Value {
        transforms::write(self)
    }
    fn read(value: &serde_json::Value) -> Result<Self, String> {
        transforms::read(&JsonNode::root(std::path::Path::new("transform"), value), None)
            .map_err(|error| error.to_string())
    }
}

/// How marks follow the surface: a kind with its numbers.
impl crate::session::replay::ReplayValue for Operator {
    fn written(&self) -> serde_json::Value {
        let mut written = serde_json::Map::new();
        written.insert("kind".into(), self.row().1.into());
        self.numbers().into_iter().for_each(|(number, value)| {
            written.insert(number.key.into(), value.written());
        });
        written.into()
    }
    fn read(value: &serde_json::Value) -> Result<Self, String> {
        let kind = value.get("kind").and_then(|kind| kind.as_str());
        let known = Operator::KINDS.iter().find(|(_, name)| Some(*name) == kind);
        let (operator, _) = known.ok_or("must be an operator of a known kind")?;
        operator.try_map(|number, _| crate::session::replay::field::<f32>(value, number.key))
    }
}

impl crate::session::replay::ReplayValue for LightKind {
    fn written(&self) -> serde_json::Value {
        match self {
            LightKind::Directional { direction } => serde_json::json!({ "direction": direction.written() }),
            LightKind::Point { position } => serde_json::json!({ "position": position.written() }),
        }
    }
    fn read(value: &serde_json::Value) -> Result<Self, String> {
        match value.get("direction") {
            Some(direction) => Ok(LightKind::Directional { direction: Vec3::read(direction)? }),
            None => Ok(LightKind::Point { position: crate::session::replay::field(value, "position")? }),
        }
    }
}

/// Y*: a number, or the largest there is.
impl crate::session::replay::ReplayValue for Reference {
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
pub struct DerivedMask(pub DerivedMaskNumbers);

/// The numbers of a derived mask.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DerivedMaskNumbers {
    Fresnel { f0: f32, power: f32 },
    Curvature { scale: f32, blur: f32, from: f32, to: f32 },
    Depth { from: f32, to: f32 },
    Region(SurfaceRegion),
}

impl crate::session::replay::ReplayValue for DerivedMask {
    fn written(&self) -> serde_json::Value {
        let (kind, numbers): (&str, Vec<f32>) = match self.0 {
            DerivedMaskNumbers::Region(region) => return serde_json::json!({ "region": region.written() }),
            DerivedMaskNumbers::Fresnel { f0, power } => ("fresnel", vec![f0, power]),
            DerivedMaskNumbers::Curvature { scale, blur, from, to } => ("curvature", vec![scale, blur, from, to]),
            DerivedMaskNumbers::Depth { from, to } => ("depth", vec![from, to]),
        };
        serde_json::json!({ "kind": kind, "numbers": numbers.written() })
    }
    fn read(value: &serde_json::Value) -> Result<Self, String> {
        if let Some(region) = value.get("region") {
            return SurfaceRegion::read(region).map(|region| Self(DerivedMaskNumbers::Region(region)));
        }
        let numbers: Vec<f32> = crate::session::replay::field(value, "numbers")?;
        let kind = value.get("kind").and_then(|kind| kind.as_str()).unwrap_or_default();
        Ok(Self(match (kind, &numbers[..]) {
            ("fresnel", &[f0, power]) => DerivedMaskNumbers::Fresnel { f0, power },
            ("curvature", &[scale, blur, from, to]) => DerivedMaskNumbers::Curvature { scale, blur, from, to },
            ("depth", &[from, to]) => DerivedMaskNumbers::Depth { from, to },
            _ => return Err("must be a mask of a known kind with its numbers".into()),
        }))
    }
}

/// Gives a layer a derived mask, or none; inversion and enabling stay.
pub(super) fn set_mask(layer: &mut Layer, mask: Option<DerivedMask>) {
    let invert = layer.mask.as_ref().is_some_and(|mask| mask.invert);
    layer.mask = mask.map(|DerivedMask(numbers)| {
        let kind = match numbers {
            DerivedMaskNumbers::Fresnel { f0, power } => MaskKind::Fresnel { f0, power },
            DerivedMaskNumbers::Curvature { scale, blur, from, to } => MaskKind::Curvature { scale, blur, from, to },
            DerivedMaskNumbers::Depth { from, to } => MaskKind::Depth { from, to },
            DerivedMaskNumbers::Region(region) => MaskKind::Region(region),
        };
        LayerMask { invert, ..LayerMask::new(kind) }
    });
}
