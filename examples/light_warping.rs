//! Light Warping, the forerunner of radiance scaling, as a shading model of one's own (Vergne et al.
//! 2009, *Light Warping for Enhanced Surface Depiction*; λ as in its shader in Frapper). A light ℓ,
//! projected along the principal directions of curvature to s = (ℓ·u, ℓ·v)/(1 + ℓ_z), is shown at
//! (s_u/λ_u, s_v/λ_v), λ = tan(π/4 + atan(c k)/6): closer to the viewer where the surface is convex.
//! `cargo run --release --example light_warping -- RECIPE LAYER PICTURE`; c is its curvature scale.

use rilievo::math::{Vec2, Vec3};
use rilievo::paint::{PlacedImage, Placement};
use rilievo::raster::{Picture, Plane};
use rilievo::{Budget, Content, Document, Layer, Overwrite, open, shading::Model, write_picture};
use std::{error::Error, path::Path};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [recipe, layer, file] = &arguments[..] else { return Err("three arguments".into()) };
    draw(&open(recipe.as_ref(), &Budget::default())?.document, layer, file.as_ref())
}

/// By how much lights are drawn to the viewer where the curvature is k (convex above 0).
pub fn lambda(c: f32, k: f32) -> f32 {
    (std::f32::consts::FRAC_PI_4 + (c * k).atan() / 6.0).tan()
}

/// Where a light is shown, and by how much its solid angle grows: the Jacobian of the warp.
pub fn warp(l: Vec3, u: Vec2, [lambda_u, lambda_v]: [f32; 2]) -> (Vec3, f32) {
    let (s, v) = (l.truncate() / (1.0 + l.z).max(1e-3), u.perp());
    let shown = u * s.dot(u) / lambda_u + v * s.dot(v) / lambda_v;
    let (before, after) = (1.0 + s.length_squared(), 1.0 + shown.length_squared());
    ((2.0 * shown).extend(2.0 - after) / after, (before / after).powi(2) / (lambda_u * lambda_v))
}

/// Writes the picture of a shading layer under an environment: a mirror, or else matt.
pub fn draw(document: &Document, layer: &str, file: &Path) -> Result<(), Box<dyn Error>> {
    let (size, surface) = (document.size, document.surface.as_ref().ok_or("no maps")?);
    let layer = document.layers.iter().find(|l| l.name == layer).ok_or("no such layer")?;
    let Content::Shading(live) = &layer.content else { return Err("not a shading layer".into()) };
    let (shading, scale) = (live.params(), &live.params().features.scales[0]);
    let (c, curvature) = (scale.curvature_scale_px, surface.curvature(scale.blur_px));
    let sky = shading.environment.as_ref().ok_or("no environment")?.environment_light();
    let lights = sky.samples(256);
    let pixel = |x: usize, y: usize| {
        let (n, (k_u, k_v, u)) = (surface.normal(x, y), curvature.principal(x, y));
        let bend = [k_u, k_v].map(|k| lambda(c, k));
        let unwarp = |l: Vec3| warp(l, u, bend.map(f32::recip)).0;
        let cone = 2.0 * n.z.powi(3) * k_u.abs().max(k_v.abs()); // that a pixel mirrors, radians
        let matt = lights.iter().map(|light| {
            let (l, growth) = warp(light.direction, u, bend);
            light.radiance * (4.0 / 256.0 * growth * n.dot(l).max(0.0))
        });
        let light: Vec3 = match shading.model {
            Model::Mirror => sky.mean_over_cone(unwarp(n * (2.0 * n.z) - Vec3::Z), cone),
            _ => matt.sum(),
        };
        light.extend(f32::from(surface.coverage(x, y)) / 255.0).to_array()
    };
    let picture = Picture::linear(size, Plane::from_fn(size, pixel).into_values()).ok_or("size")?;
    let image = PlacedImage::new(picture, Placement::covering(size));
    let alone = Document::empty(size).with_top(Layer::new("Warped", image));
    Ok(write_picture(&alone, file, Overwrite::Anything)?)
}
