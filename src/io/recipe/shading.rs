//! Reads and writes shading layers and radiance scaling.
//! Floor 5. Not here: lights, terms and scalings (`light`).

use super::LayerReader;
use super::light::{
    self, direction, features, reference, scaling, write_features, write_reference, write_scaling,
    write_term,
};
use super::value::RecipeValue;
use crate::Result;
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::math::TURNS;
use crate::math::range::STOPS;
use crate::shading::{
    Environment, Light, LitSphere, Model, PixelShading, Projection, RadianceScaling, Shading, Term,
};
use serde_json::{Value, json};

impl LayerReader<'_> {
    /// Missing fields have the defaults of the model ([`Shading::new`]).
    pub fn shading(&mut self, fields: &mut Fields) -> Result<Shading> {
        let base = Shading::new(fields.one_of("model", &Model::ALL, Model::Phong)?);
        let environment =
            fields.get("environment").map(|node| self.environment(&node)).transpose()?;
        let lights = match fields.get("lights") {
            Some(node) => node
                .list(Shading::MOST_LIGHTS)?
                .iter()
                .map(Light::from_json)
                .collect::<Result<_>>()?,
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
            strokes: match fields.get("strokes") {
                Some(node) => light::ball_strokes(&node)?,
                None => base.strokes,
            },
            index: fields.number("index", base.index, Shading::INDEX)?,
            solid: match fields.get("solid") {
                Some(node) => light::solid_glass(&node)?,
                None => base.solid,
            },
            occlusion_radius_px: fields.number(
                "occlusion_radius",
                base.occlusion_radius_px,
                Shading::OCCLUSION_RADIUS_PX,
            )?,
            bounces: fields
                .get("bounces")
                .map_or(Ok(base.bounces), |node| node.whole(Shading::BOUNCES))?,
            shadows: match fields.get("shadows") {
                Some(node) => light::shadows(&node, base.shadows)?,
                None => base.shadows,
            },
            painter: match fields.get("painter") {
                Some(node) => light::painter(&node, base.painter)?,
                None => base.painter,
            },
            pixel: match fields.get("pixel") {
                Some(node) => PixelShading::from_json(&node)?,
                None => PixelShading::default(),
            },
        })
    }

    fn environment(&mut self, node: &JsonNode) -> Result<Environment> {
        let mut fields = node.fields()?;
        let file = fields.require("file")?;
        let mut environment =
            Environment::new(file.text()?.to_owned(), self.pictures.picture(self.source, &file)?);
        environment.projection =
            fields.one_of("projection", &Projection::ALL, environment.projection)?;
        environment.rotation = fields.number("rotation", environment.rotation, TURNS)?;
        environment.exposure = fields.number("exposure", environment.exposure, STOPS)?;
        fields.finish()?;
        Ok(environment)
    }

    fn sphere(&mut self, fields: &mut Fields, name: &'static str) -> Result<Option<LitSphere>> {
        let Some(node) = fields.get(name) else { return Ok(None) };
        let mut fields = node.fields()?;
        let file = fields.require("file")?;
        let sphere =
            LitSphere::new(file.text()?.to_owned(), self.pictures.picture(self.source, &file)?);
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

/// The object of one term, if present; `more` reads its own fields.
fn term_and<T>(
    fields: &mut Fields,
    name: &'static str,
    base: Term,
    more: impl FnOnce(&mut Fields) -> Result<T>,
) -> Result<Option<(Term, T)>> {
    let Some(node) = fields.get(name) else { return Ok(None) };
    let mut fields = node.fields()?;
    let read = (light::term(&mut fields, base)?, more(&mut fields)?);
    fields.finish()?;
    Ok(Some(read))
}

fn term(fields: &mut Fields, name: &'static str, base: Term) -> Result<Term> {
    Ok(term_and(fields, name, base, |_| Ok(()))?.map_or(base, |(term, ())| term))
}

/// The glossy term and its shininess.
fn specular(fields: &mut Fields, base: &Shading) -> Result<(Term, f32)> {
    let shininess =
        |fields: &mut Fields| fields.number("shininess", base.shininess, Shading::SHININESS);
    Ok(term_and(fields, "specular", base.specular, shininess)?
        .unwrap_or((base.specular, base.shininess)))
}

/// The lights where none are named. Lit by its environment, such a material needs none; those that
/// are named are added.
fn lights_unsaid(base: &Shading, environment: Option<&Environment>) -> Vec<Light> {
    if base.model == Model::Ashikhmin && environment.is_some() {
        Vec::new()
    } else {
        base.lights.clone()
    }
}

pub fn write(out: &mut JsonObject, shading: &Shading) {
    let base = Shading::new(shading.model);
    out.set("model", shading.model.name().into());
    if shading.lights != lights_unsaid(&base, shading.environment.as_ref()) {
        out.set("lights", shading.lights.iter().map(Light::to_json).collect());
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
    for (name, sphere) in [("sphere", &shading.sphere), ("sphere_concave", &shading.sphere_concave)]
    {
        if let Some(sphere) = sphere {
            out.set(name, json!({ "file": sphere.file }));
        }
    }
    if shading.strokes != base.strokes {
        out.set("strokes", light::write_ball_strokes(&shading.strokes));
    }
    out.number("index", shading.index, base.index);
    if shading.solid != base.solid {
        out.set("solid", light::write_solid_glass(&shading.solid));
    }
    out.number("occlusion_radius", shading.occlusion_radius_px, base.occlusion_radius_px);
    out.number("bounces", shading.bounces as f32, base.bounces as f32);
    out.object("shadows", light::write_shadows(&shading.shadows, &base.shadows));
    out.object("painter", light::write_painter(&shading.painter, &base.painter));
    out.object("pixel", light::write_pixel(&shading.pixel));
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

fn write_environment(environment: &Environment) -> Value {
    let mut out = JsonObject::default();
    out.set("file", environment.file.as_str().into());
    out.word("projection", &Projection::ALL, environment.projection, Projection::LatLong);
    out.number("rotation", environment.rotation, 0.0);
    out.number("exposure", environment.exposure, 0.0);
    out.into_value()
}
