//! Reads and writes light: shading layers and radiance scaling.
//! Floor 5.

use super::LayerReader;
use crate::Result;
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::math::range::STOPS;
use crate::math::{COORDINATE, TURNS, Vec3};
use crate::shading::{
    Environment, FeatureScale, Features, Light, LightKind, LitSphere, Model, Projection, RadianceScaling, Reference,
    Scaling, Shading, Term,
};
use serde_json::{Value, json};

impl LayerReader<'_> {
    /// Missing fields have the defaults of the model ([`Shading::new`]).
    pub fn shading(&mut self, fields: &mut Fields) -> Result<Shading> {
        let base = Shading::new(fields.one_of("model", &Model::ALL, Model::Phong)?);
        let environment = fields.get("environment").map(|node| self.environment(&node)).transpose()?;
        let lights = match fields.get("lights") {
            Some(node) => node.list(Shading::MOST_LIGHTS)?.iter().map(light).collect::<Result<_>>()?,
            None => lights_unsaid(&base, environment.as_ref()),
        };
        let (specular, shininess) = specular(fields, &base)?;
        Ok(Shading {
            model: base.model,
            lights,
            ambient: term(fields, "ambient", base.ambient)?,
            diffuse: term(fields, "diffuse", base.diffuse)?,
            specular,
            shininess,
            features: features(fields)?,
            reference: reference(fields)?,
            bands: fields.get("bands").map_or(Ok(base.bands), |node| node.whole(Shading::BANDS))?,
            exponent: fields.number("exponent", base.exponent, Shading::EXPONENT)?,
            nu: fields.number("nu", base.nu, Shading::SHININESS)?,
            nv: fields.number("nv", base.nv, Shading::SHININESS)?,
            environment,
            sphere: self.sphere(fields, "sphere")?,
            sphere_concave: self.sphere(fields, "sphere_concave")?,
            index: fields.number("index", base.index, Shading::INDEX)?,
            occlusion_radius_px: fields.number(
                "occlusion_radius",
                base.occlusion_radius_px,
                Shading::OCCLUSION_RADIUS_PX,
            )?,
        })
    }
    fn environment(&mut self, node: &JsonNode) -> Result<Environment> {
        let mut fields = node.fields()?;
        let file = fields.required("file")?;
        let mut environment = Environment::new(file.text()?.to_owned(), self.pictures.picture(self.source, &file)?);
        environment.projection = fields.one_of("projection", &Projection::ALL, environment.projection)?;
        environment.rotation = fields.number("rotation", environment.rotation, TURNS)?;
        environment.exposure = fields.number("exposure", environment.exposure, STOPS)?;
        fields.finish()?;
        Ok(environment)
    }
    fn sphere(&mut self, fields: &mut Fields, name: &'static str) -> Result<Option<LitSphere>> {
        let Some(node) = fields.get(name) else { return Ok(None) };
        let mut fields = node.fields()?;
        let file = fields.required("file")?;
        let sphere = LitSphere::new(file.text()?.to_owned(), self.pictures.picture(self.source, &file)?);
        fields.finish()?;
        Ok(Some(sphere))
    }
}

pub fn radiance_scaling(fields: &mut Fields) -> Result<RadianceScaling> {
    let base = RadianceScaling::default();
    let scaling = scaling(fields, base.scaling)?;
    fields.one_of("space", &[((), "linear")], ())?;
    Ok(RadianceScaling {
        scaling,
        features: features(fields)?,
        light: fields.get("light").map_or(Ok(base.light), |node| direction(&node))?,
        reference: reference(fields)?,
        keep_mean: fields.boolean("keep_mean", base.keep_mean)?,
    })
}

/// `alpha` and `gamma`, or `gamma_convex` and `gamma_concave` where the two differ.
fn scaling(fields: &mut Fields, base: Scaling) -> Result<Scaling> {
    let alpha = fields.number("alpha", base.alpha, Scaling::INVARIANT)?;
    let gamma = fields.get("gamma").map(|node| node.number(Scaling::GAMMA)).transpose()?;
    Ok(Scaling {
        alpha,
        gamma_convex: fields.number("gamma_convex", gamma.unwrap_or(base.gamma_convex), Scaling::GAMMA)?,
        gamma_concave: fields.number("gamma_concave", gamma.unwrap_or(base.gamma_concave), Scaling::GAMMA)?,
    })
}

/// `curvature_scale`, `blur` and `lambda`; or `lambda` and a list of `scales`, each with its `weight`.
fn features(fields: &mut Fields) -> Result<Features> {
    let lambda = fields.number("lambda", 0.0, Features::LAMBDA)?;
    let Some(node) = fields.get("scales") else {
        return Ok(Features { scales: vec![feature_scale(fields)?], lambda });
    };
    let items = node.list(Features::MOST_SCALES)?;
    if items.is_empty() {
        return Err(node.refused("is empty; at least one scale is needed"));
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
        curvature_scale_px: fields.number("curvature_scale", base.curvature_scale_px, FeatureScale::CURVATURE_PX)?,
        blur_px: fields.number("blur", base.blur_px, FeatureScale::BLUR_PX)?,
        weight: base.weight,
    })
}

/// `"auto"` or a luminance.
fn reference(fields: &mut Fields) -> Result<Reference> {
    let Some(node) = fields.get("reference") else { return Ok(Reference::Auto) };
    if node.value().is_string() {
        return node.one_of(&[(Reference::Auto, "auto")]);
    }
    Ok(Reference::Value(node.number(Reference::VALUE)?))
}

/// The object of one term, if present; `more` reads its own fields.
fn term_and<T>(
    fields: &mut Fields,
    name: &'static str,
    base: Term,
    more: impl FnOnce(&mut Fields) -> Result<T>,
) -> Result<Option<(Term, T)>> {
    let Some(node) = fields.get(name) else { return Ok(None) };
    let mut fields = node.fields()?;
    let color = fields.color("color", base.color)?;
    let weight = fields.number("weight", base.weight, Term::WEIGHT)?;
    let scaling = match fields.get("scaling") {
        Some(node) => {
            let mut fields = node.fields()?;
            let read = scaling(&mut fields, base.scaling)?;
            fields.finish()?;
            read
        }
        None => base.scaling,
    };
    let more = more(&mut fields)?;
    fields.finish()?;
    Ok(Some((Term { color, weight, scaling }, more)))
}

fn term(fields: &mut Fields, name: &'static str, base: Term) -> Result<Term> {
    Ok(term_and(fields, name, base, |_| Ok(()))?.map_or(base, |(term, ())| term))
}

/// The glossy term and its shininess.
fn specular(fields: &mut Fields, base: &Shading) -> Result<(Term, f32)> {
    let shininess = |fields: &mut Fields| fields.number("shininess", base.shininess, Shading::SHININESS);
    Ok(term_and(fields, "specular", base.specular, shininess)?.unwrap_or((base.specular, base.shininess)))
}

/// The lights where none are named. Lit by its environment, such a material needs none; those that are named are added.
fn lights_unsaid(base: &Shading, environment: Option<&Environment>) -> Vec<Light> {
    if base.model == Model::Ashikhmin && environment.is_some() { Vec::new() } else { base.lights.clone() }
}

#[derive(Clone, Copy)]
enum RecipeLightKind {
    FarAway,
    Here,
}

fn light(node: &JsonNode) -> Result<Light> {
    let mut fields = node.fields()?;
    let base = Light::default();
    let kinds = [(RecipeLightKind::FarAway, "directional"), (RecipeLightKind::Here, "point")];
    let kind = match fields.one_of("kind", &kinds, RecipeLightKind::FarAway)? {
        RecipeLightKind::FarAway => match fields.get("direction") {
            Some(node) => LightKind::Directional { direction: direction(&node)? },
            None => base.kind,
        },
        RecipeLightKind::Here => LightKind::Point { position: fields.required("position")?.vector(COORDINATE)? },
    };
    let color = fields.color("color", base.color)?;
    let intensity = fields.number("intensity", base.intensity, Light::INTENSITY)?;
    fields.finish()?;
    Ok(Light { kind, color, intensity })
}

/// A direction of any length but 0.
fn direction(node: &JsonNode) -> Result<Vec3> {
    let v = node.vector(-1e6..=1e6)?;
    if !Light::points(v) {
        return Err(node.refused("has no length, so it points nowhere"));
    }
    Ok(v)
}

pub fn write(out: &mut JsonObject, shading: &Shading) {
    let base = Shading::new(shading.model);
    out.set("model", shading.model.name().into());
    if shading.lights != lights_unsaid(&base, shading.environment.as_ref()) {
        out.set("lights", shading.lights.iter().map(write_light).collect());
    }
    out.object("ambient", write_term(&shading.ambient, &base.ambient));
    out.object("diffuse", write_term(&shading.diffuse, &base.diffuse));
    let mut specular = write_term(&shading.specular, &base.specular);
    specular.number("shininess", shading.shininess, base.shininess);
    out.object("specular", specular);
    write_features(out, &shading.features);
    write_reference(out, shading.reference);
    out.number("bands", shading.bands as f32, base.bands as f32);
    out.number("exponent", shading.exponent, base.exponent);
    out.number("nu", shading.nu, base.nu);
    out.number("nv", shading.nv, base.nv);
    if let Some(environment) = &shading.environment {
        out.set("environment", write_environment(environment));
    }
    for (name, sphere) in [("sphere", &shading.sphere), ("sphere_concave", &shading.sphere_concave)] {
        if let Some(sphere) = sphere {
            out.set(name, json!({ "file": sphere.file }));
        }
    }
    out.number("index", shading.index, base.index);
    out.number("occlusion_radius", shading.occlusion_radius_px, base.occlusion_radius_px);
}

pub fn write_radiance_scaling(out: &mut JsonObject, scaling: &RadianceScaling) {
    let base = RadianceScaling::default();
    write_scaling(out, &scaling.scaling, &base.scaling);
    write_features(out, &scaling.features);
    if scaling.light != base.light {
        out.set("light", object::vector(scaling.light));
    }
    write_reference(out, scaling.reference);
    out.flag("keep_mean", scaling.keep_mean, base.keep_mean);
}

fn write_scaling(out: &mut JsonObject, scaling: &Scaling, base: &Scaling) {
    out.number("alpha", scaling.alpha, base.alpha);
    if scaling.gamma_convex == scaling.gamma_concave && base.gamma_convex == base.gamma_concave {
        out.number("gamma", scaling.gamma_convex, base.gamma_convex);
    } else {
        out.set("gamma_convex", object::number(scaling.gamma_convex));
        out.set("gamma_concave", object::number(scaling.gamma_concave));
    }
}

fn write_features(out: &mut JsonObject, features: &Features) {
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
                out.done()
            };
            out.set("scales", scales.iter().map(one).collect());
        }
    }
}

fn write_reference(out: &mut JsonObject, reference: Reference) {
    if let Reference::Value(value) = reference {
        out.set("reference", object::number(value));
    }
}

fn write_term(term: &Term, base: &Term) -> JsonObject {
    let mut out = JsonObject::default();
    out.color("color", term.color, base.color);
    out.number("weight", term.weight, base.weight);
    let mut scaling = JsonObject::default();
    write_scaling(&mut scaling, &term.scaling, &base.scaling);
    out.object("scaling", scaling);
    out
}

fn write_light(light: &Light) -> Value {
    let base = Light::default();
    let mut out = JsonObject::default();
    match light.kind {
        LightKind::Directional { direction } => {
            out.set("kind", "directional".into());
            out.set("direction", object::vector(direction));
        }
        LightKind::Point { position } => {
            out.set("kind", "point".into());
            out.set("position", object::vector(position));
        }
    }
    out.color("color", light.color, base.color);
    out.number("intensity", light.intensity, base.intensity);
    out.done()
}

fn write_environment(environment: &Environment) -> Value {
    let mut out = JsonObject::default();
    out.set("file", environment.file.as_str().into());
    out.word("projection", &Projection::ALL, environment.projection, Projection::LatLong);
    out.number("rotation", environment.rotation, 0.0);
    out.number("exposure", environment.exposure, 0.0);
    out.done()
}
