//! Reads and writes what is lit and by what: lights, terms of materials, scalings and the features
//! that they follow. Floor 5. Not here: the layers that have them (`shading`).

use super::value::RecipeValue;
use crate::Result;
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::math::{COORDINATE, Vec3, srgb::Color};
use crate::shading::{
    BallStrokes, FeatureScale, Features, Light, LightKind, NumberSetting, Painter, PixelShading,
    Reference, Scaling, Shadows, SolidGlass, Term,
};
use serde_json::Value;

/// A term with no fields given.
const PLAIN: Term = Term::plain(Color::WHITE, 1.0);

#[derive(Clone, Copy)]
enum RecipeLightKind {
    FarAway,
    Here,
}

impl RecipeValue for Light {
    fn to_json(&self) -> Value {
        let base = Light::default();
        let mut out = JsonObject::default();
        match self.kind {
            LightKind::Directional { direction } => {
                out.set("kind", "directional".into());
                out.set("direction", object::vector(direction));
            }
            LightKind::Point { position } => {
                out.set("kind", "point".into());
                out.set("position", object::vector(position));
            }
        }
        out.color("color", self.color, base.color);
        out.number("intensity", self.intensity, base.intensity);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let base = Light::default();
        let kinds = [(RecipeLightKind::FarAway, "directional"), (RecipeLightKind::Here, "point")];
        let kind = match fields.one_of("kind", &kinds, RecipeLightKind::FarAway)? {
            RecipeLightKind::FarAway => match fields.get("direction") {
                Some(node) => LightKind::Directional { direction: direction(&node)? },
                None => base.kind,
            },
            RecipeLightKind::Here => {
                LightKind::Point { position: fields.require("position")?.vector(COORDINATE)? }
            }
        };
        let color = fields.color("color", base.color)?;
        let intensity = fields.number("intensity", base.intensity, Light::INTENSITY)?;
        fields.finish()?;
        Ok(Light { kind, color, intensity })
    }
}

impl RecipeValue for Scaling {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        write_scaling(&mut out, self, &Scaling::NONE);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        of_object(node, |fields| scaling(fields, Scaling::NONE))
    }
}

impl RecipeValue for Term {
    fn to_json(&self) -> Value {
        write_term(self, &PLAIN).into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        of_object(node, |fields| term(fields, PLAIN))
    }
}

impl RecipeValue for Features {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        write_features(&mut out, self);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        of_object(node, features)
    }
}

impl RecipeValue for Shadows {
    fn to_json(&self) -> Value {
        write_shadows(self, &Shadows::DEFAULT).into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        shadows(node, Shadows::DEFAULT)
    }
}

/// `true`, `false`, or an object.
impl RecipeValue for BallStrokes {
    fn to_json(&self) -> Value {
        write_ball_strokes(self)
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        ball_strokes(node)
    }
}

/// `true`, `false`, or an object.
impl RecipeValue for SolidGlass {
    fn to_json(&self) -> Value {
        write_solid_glass(self)
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        solid_glass(node)
    }
}

impl RecipeValue for Painter {
    fn to_json(&self) -> Value {
        write_painter(self, &Painter::DEFAULT).into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        painter(node, Painter::DEFAULT)
    }
}

impl RecipeValue for PixelShading {
    fn to_json(&self) -> Value {
        write_pixel(self).into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        of_object(node, |fields| {
            let bands =
                fields.get("bands").map_or(Ok(0), |node| node.whole(0..=*Self::BANDS.end()));
            let colors = match fields.get("colors") {
                Some(node) => {
                    node.list(Self::MOST_COLORS)?.iter().map(|node| node.color()).collect()
                }
                None => Ok(Vec::new()),
            };
            let bands = bands?;
            if bands == 1 {
                return Err(node.refusal("has 1 tone of each color; there may be 2 to 5, or 0"));
            }
            Ok(Self { bands, dither: fields.number("dither", 0.0, Self::DITHER)?, colors: colors? })
        })
    }
}

/// Y*: a luminance, or the largest there is.
impl RecipeValue for Reference {
    fn to_json(&self) -> Value {
        match self {
            Reference::Auto => "auto".into(),
            Reference::Value(value) => object::number(*value),
        }
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        if node.value().is_string() {
            return node.one_of(&[(Reference::Auto, "auto")]);
        }
        Ok(Reference::Value(node.number(Reference::VALUE)?))
    }
}

/// Reads an object; refuses fields that `read` does not know.
pub(super) fn of_object<T>(
    node: &JsonNode,
    read: impl FnOnce(&mut Fields) -> Result<T>,
) -> Result<T> {
    let mut fields = node.fields()?;
    let value = read(&mut fields)?;
    fields.finish()?;
    Ok(value)
}

/// `alpha` and `gamma`, or `gamma_convex` and `gamma_concave` where the two differ.
pub fn scaling(fields: &mut Fields, base: Scaling) -> Result<Scaling> {
    let alpha = fields.number("alpha", base.alpha, Scaling::INVARIANT)?;
    let gamma = fields.get("gamma").map(|node| node.number(Scaling::GAMMA)).transpose()?;
    Ok(Scaling {
        alpha,
        gamma_convex: fields.number(
            "gamma_convex",
            gamma.unwrap_or(base.gamma_convex),
            Scaling::GAMMA,
        )?,
        gamma_concave: fields.number(
            "gamma_concave",
            gamma.unwrap_or(base.gamma_concave),
            Scaling::GAMMA,
        )?,
    })
}

/// `curvature_scale`, `blur` and `lambda`; or `lambda` and a list of `scales`, each with its
/// `weight`.
pub fn features(fields: &mut Fields) -> Result<Features> {
    let lambda = fields.number("lambda", 0.0, Features::LAMBDA)?;
    let Some(node) = fields.get("scales") else {
        return Ok(Features { scales: vec![feature_scale(fields)?], lambda });
    };
    let items = node.list(Features::MOST_SCALES)?;
    if items.is_empty() {
        return Err(node.refusal("is empty; at least one scale is needed"));
    }
    let one = |item: &JsonNode| {
        let mut fields = item.fields()?;
        let scale = feature_scale(&mut fields)?;
        let weight = fields.number("weight", scale.weight, FeatureScale::WEIGHT)?;
        fields.finish()?;
        Ok(FeatureScale { weight, ..scale })
    };
    Ok(Features { scales: items.iter().map(one).collect::<Result<_>>()?, lambda })
}

fn feature_scale(fields: &mut Fields) -> Result<FeatureScale> {
    let base = FeatureScale::default();
    Ok(FeatureScale {
        curvature_scale_px: fields.number(
            "curvature_scale",
            base.curvature_scale_px,
            FeatureScale::CURVATURE_PX,
        )?,
        blur_px: fields.number("blur", base.blur_px, FeatureScale::BLUR_PX)?,
        weight: base.weight,
    })
}

/// `"auto"` or a luminance.
pub fn reference(fields: &mut Fields) -> Result<Reference> {
    fields.get("reference").map_or(Ok(Reference::Auto), |node| Reference::from_json(&node))
}

/// The fields that every term has.
pub fn term(fields: &mut Fields, base: Term) -> Result<Term> {
    let color = fields.color("color", base.color)?;
    let weight = fields.number("weight", base.weight, Term::WEIGHT)?;
    let scaling = fields
        .get("scaling")
        .map_or(Ok(base.scaling), |node| of_object(&node, |f| scaling(f, base.scaling)))?;
    Ok(Term { color, weight, scaling })
}

/// The numbers of a table, each in its range.
pub(super) fn settings<T>(
    fields: &mut Fields,
    table: &'static [NumberSetting<T>],
    mut all: T,
) -> Result<T> {
    for setting in table {
        let to = fields.number(setting.name, (setting.get)(&all), setting.range.clone())?;
        (setting.set)(&mut all, to);
    }
    Ok(all)
}

pub(super) fn write_settings<T>(
    out: &mut JsonObject,
    table: &'static [NumberSetting<T>],
    all: &T,
    base: &T,
) {
    for setting in table {
        out.number(setting.name, (setting.get)(all), (setting.get)(base));
    }
}

/// Fields that are not given are those of `base`.
pub fn shadows(node: &JsonNode, base: Shadows) -> Result<Shadows> {
    of_object(node, |fields| {
        let numbers = settings(fields, Shadows::SETTINGS, base)?;
        Ok(Shadows {
            on: fields.boolean("on", base.on)?,
            color: fields.color("color", base.color)?,
            rays: fields.get("rays").map_or(Ok(base.rays), |node| node.whole(Shadows::RAYS))?,
            ..numbers
        })
    })
}

pub fn write_shadows(shadows: &Shadows, base: &Shadows) -> JsonObject {
    let mut out = JsonObject::default();
    out.flag("on", shadows.on, base.on);
    write_settings(&mut out, Shadows::SETTINGS, shadows, base);
    out.color("color", shadows.color, base.color);
    out.number("rays", shadows.rays as f32, base.rays as f32);
    out
}

/// Strokes that are given are on unless they say otherwise.
pub fn ball_strokes(node: &JsonNode) -> Result<BallStrokes> {
    let base = BallStrokes { on: true, ..BallStrokes::DEFAULT };
    if node.value().is_boolean() {
        return Ok(BallStrokes { on: node.boolean()?, ..base });
    }
    of_object(node, |fields| {
        let numbers = settings(fields, BallStrokes::SETTINGS, base)?;
        Ok(BallStrokes { on: fields.boolean("on", base.on)?, ..numbers })
    })
}

pub fn write_ball_strokes(strokes: &BallStrokes) -> Value {
    let mut out = JsonObject::default();
    write_settings(&mut out, BallStrokes::SETTINGS, strokes, &BallStrokes::DEFAULT);
    if out.is_empty() {
        return strokes.on.into();
    }
    out.flag("on", strokes.on, true);
    out.into_value()
}

/// Glass that is given is solid unless it says otherwise.
pub fn solid_glass(node: &JsonNode) -> Result<SolidGlass> {
    let base = SolidGlass { on: true, ..SolidGlass::DEFAULT };
    if node.value().is_boolean() {
        return Ok(SolidGlass { on: node.boolean()?, ..base });
    }
    of_object(node, |fields| {
        let numbers = settings(fields, SolidGlass::SETTINGS, base)?;
        Ok(SolidGlass { on: fields.boolean("on", base.on)?, ..numbers })
    })
}

pub fn write_solid_glass(solid: &SolidGlass) -> Value {
    let mut out = JsonObject::default();
    write_settings(&mut out, SolidGlass::SETTINGS, solid, &SolidGlass::DEFAULT);
    if out.is_empty() {
        return solid.on.into();
    }
    out.flag("on", solid.on, true);
    out.into_value()
}

/// Fields that are not given are those of `base`.
pub fn painter(node: &JsonNode, base: Painter) -> Result<Painter> {
    of_object(node, |fields| {
        let numbers = settings(fields, Painter::SETTINGS, base)?;
        Ok(Painter {
            beneath: fields.boolean("beneath", base.beneath)?,
            fill_color: fields.color("fill_color", base.fill_color)?,
            bounce_color: fields.color("bounce_color", base.bounce_color)?,
            rim_color: fields.color("rim_color", base.rim_color)?,
            ..numbers
        })
    })
}

pub fn write_painter(painter: &Painter, base: &Painter) -> JsonObject {
    let mut out = JsonObject::default();
    out.flag("beneath", painter.beneath, base.beneath);
    write_settings(&mut out, Painter::SETTINGS, painter, base);
    out.color("fill_color", painter.fill_color, base.fill_color);
    out.color("bounce_color", painter.bounce_color, base.bounce_color);
    out.color("rim_color", painter.rim_color, base.rim_color);
    out
}

pub fn write_pixel(pixel: &PixelShading) -> JsonObject {
    let mut out = JsonObject::default();
    out.number("bands", pixel.bands as f32, 0.0);
    out.number("dither", pixel.dither, 0.0);
    if !pixel.colors.is_empty() {
        out.set("colors", pixel.colors.iter().map(|color| object::color(*color)).collect());
    }
    out
}

/// A direction of any length but 0.
pub fn direction(node: &JsonNode) -> Result<Vec3> {
    let v = node.vector(-1e6..=1e6)?;
    if node.is_ranged() && !Light::has_direction(v) {
        return Err(node.refusal("has no length, so it has no direction"));
    }
    Ok(v)
}

pub fn write_scaling(out: &mut JsonObject, scaling: &Scaling, base: &Scaling) {
    out.number("alpha", scaling.alpha, base.alpha);
    if scaling.gamma_convex == scaling.gamma_concave && base.gamma_convex == base.gamma_concave {
        out.number("gamma", scaling.gamma_convex, base.gamma_convex);
    } else {
        out.set("gamma_convex", object::number(scaling.gamma_convex));
        out.set("gamma_concave", object::number(scaling.gamma_concave));
    }
}

pub fn write_features(out: &mut JsonObject, features: &Features) {
    out.number("lambda", features.lambda, 0.0);
    let base = FeatureScale::default();
    let write_scale = |out: &mut JsonObject, scale: &FeatureScale| {
        out.number("curvature_scale", scale.curvature_scale_px, base.curvature_scale_px);
        out.number("blur", scale.blur_px, base.blur_px);
    };
    match &features.scales[..] {
        // The weight of a single scale has no effect; it is written only if it is unusual.
        [scale] if scale.weight == base.weight => write_scale(out, scale),
        scales => {
            let one = |scale: &FeatureScale| {
                let mut out = JsonObject::default();
                write_scale(&mut out, scale);
                out.number("weight", scale.weight, base.weight);
                out.into_value()
            };
            out.set("scales", scales.iter().map(one).collect());
        }
    }
}

pub fn write_reference(out: &mut JsonObject, reference: Reference) {
    if reference != Reference::Auto {
        out.set("reference", reference.to_json());
    }
}

pub fn write_term(term: &Term, base: &Term) -> JsonObject {
    let mut out = JsonObject::default();
    out.color("color", term.color, base.color);
    out.number("weight", term.weight, base.weight);
    let mut scaling = JsonObject::default();
    write_scaling(&mut scaling, &term.scaling, &base.scaling);
    out.object("scaling", scaling);
    out
}
