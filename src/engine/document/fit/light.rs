//! Shading and radiance scaling that a file can hold.
//! Floor 4.

use super::Fit;
use crate::math::range::{STOPS, at_most, check_range};
use crate::math::{COORDINATE, TURNS};
use crate::shading::{
    BallStrokes, Environment, FeatureScale, Features, Light, LightKind, NumberSetting, Painter,
    PixelShading, RadianceScaling, Reference, Scaling, Shading, Shadows, SolidGlass, Term,
};

/// The most values that things take in a description.
pub const A_LIGHT: usize = 18;
pub const A_SCALE: usize = 12;

pub fn shading(shading: &Shading) -> Fit {
    at_most("lights", shading.lights.len(), Shading::MOST_LIGHTS)?;
    shading.lights.iter().try_for_each(light)?;
    [shading.ambient, shading.diffuse, shading.specular].iter().try_for_each(term)?;
    check_range("the shininess", shading.shininess, &Shading::SHININESS)?;
    features(&shading.features)?;
    reference(shading.reference)?;
    if !Shading::BANDS.contains(&shading.bands) {
        return Err(format!(
            "the tones are {}; there may be 2 to {}",
            shading.bands,
            Shading::BANDS.end()
        ));
    }
    check_range("the flatness", shading.exponent, &Shading::EXPONENT)?;
    check_range("the highlight along x", shading.nu, &Shading::SHININESS)?;
    check_range("the highlight along y", shading.nv, &Shading::SHININESS)?;
    check_range("the refractive index", shading.index, &Shading::INDEX)?;
    settings(&shading.painter, Painter::SETTINGS)?;
    settings(&shading.shadows, Shadows::SETTINGS)?;
    settings(&shading.strokes, BallStrokes::SETTINGS)?;
    settings(&shading.solid, SolidGlass::SETTINGS)?;
    if !Shadows::RAYS.contains(&shading.shadows.rays) {
        let (rays, most) = (shading.shadows.rays, Shadows::RAYS.end());
        return Err(format!("the rays to a lamp are {rays}; there may be 1 to {most}"));
    }
    pixel(&shading.pixel)?;
    check_range(
        "the reach of occlusion",
        shading.occlusion_radius_px,
        &Shading::OCCLUSION_RADIUS_PX,
    )?;
    if !Shading::BOUNCES.contains(&shading.bounces) {
        return Err(format!(
            "the bounces are {}; there may be 0 to {}",
            shading.bounces,
            Shading::BOUNCES.end()
        ));
    }
    shading.environment.as_ref().map_or(Ok(()), environment)
}

fn pixel(pixel: &PixelShading) -> Fit {
    let (bands, most) = (pixel.bands, PixelShading::BANDS.end());
    if bands != 0 && !pixel.is_on() {
        return Err(format!("the tones of each color are {bands}; there may be 2 to {most}, or 0"));
    }
    if pixel.colors.len() > PixelShading::MOST_COLORS {
        let (colors, most) = (pixel.colors.len(), PixelShading::MOST_COLORS);
        return Err(format!("the colors of pixel shading are {colors}; there may be {most}"));
    }
    check_range("the dither", pixel.dither, &PixelShading::DITHER)
}

fn settings<T>(all: &T, table: &'static [NumberSetting<T>]) -> Fit {
    table
        .iter()
        .try_for_each(|setting| check_range(setting.label, (setting.get)(all), &setting.range))
}

fn environment(environment: &Environment) -> Fit {
    check_range("the turn of the environment", environment.rotation, &TURNS)?;
    check_range("the exposure of the environment", environment.exposure, &STOPS)
}

pub fn radiance_scaling(radiance: &RadianceScaling) -> Fit {
    scaling(&radiance.scaling)?;
    features(&radiance.features)?;
    reference(radiance.reference)?;
    if Light::has_direction(radiance.light) {
        Ok(())
    } else {
        Err("the direction of the light has no length".into())
    }
}

fn scaling(scaling: &Scaling) -> Fit {
    check_range("the still tone", scaling.alpha, &Scaling::INVARIANT)?;
    check_range("the strength", scaling.gamma_convex, &Scaling::GAMMA)?;
    check_range("the strength in hollows", scaling.gamma_concave, &Scaling::GAMMA)
}

fn features(features: &Features) -> Fit {
    check_range("λ", features.lambda, &Features::LAMBDA)?;
    at_most("scales", features.scales.len(), Features::MOST_SCALES)?;
    if features.scales.is_empty() {
        return Err("at least one scale is needed".into());
    }
    features.scales.iter().try_for_each(|scale| {
        check_range(
            "the width of features",
            scale.curvature_scale_px,
            &FeatureScale::CURVATURE_PX,
        )?;
        check_range("the blur of features", scale.blur_px, &FeatureScale::BLUR_PX)?;
        check_range("the weight of a scale", scale.weight, &FeatureScale::WEIGHT)
    })
}

fn reference(reference: Reference) -> Fit {
    match reference {
        Reference::Auto => Ok(()),
        Reference::Value(value) => check_range("the full reflectance", value, &Reference::VALUE),
    }
}

fn term(term: &Term) -> Fit {
    check_range("the weight of a term", term.weight, &Term::WEIGHT)?;
    scaling(&term.scaling)
}

fn light(light: &Light) -> Fit {
    check_range("the intensity of a light", light.intensity, &Light::INTENSITY)?;
    match light.kind {
        LightKind::Directional { direction } if Light::has_direction(direction) => Ok(()),
        LightKind::Directional { .. } => Err("the direction of a light has no length".into()),
        LightKind::Point { position } => position
            .to_array()
            .iter()
            .try_for_each(|v| check_range("the place of a light", *v, &COORDINATE)),
    }
}
