use super::*;
use crate::math::{Size, Vec3, srgb, vec3};
use crate::raster::{Plane, TILE, TileAt};
use crate::shading::{FeatureScale, Features, LightKind};
use crate::surface::{Maps, Scene, Surface};
use std::sync::Arc;

pub(super) const SIZE: Size = Size::new(128, 128);

/// A ball with a dimpled skin, off the canvas's middle, on nothing.
pub(super) fn ball() -> Scene {
    let normals = Plane::from_fn(SIZE, |x, y| {
        let (u, v) = ((x as f32 + 0.5 - 60.0) / 50.0, (66.0 - y as f32 - 0.5) / 50.0);
        let z2 = 1.0 - u * u - v * v;
        let dimple = 0.15 * vec3((x as f32 * 0.6).sin(), (y as f32 * 0.5).cos(), 0.0);
        if z2 > 0.0 { vec3(u, v, z2.sqrt()) + dimple } else { Vec3::ZERO }
    });
    let depth = normals.map(|n| 1.0 - n.z.max(0.0).min(1.0));
    let coverage = normals.map(|n| if n == Vec3::ZERO { 0 } else { 255 });
    Scene { size: SIZE, surface: Some(Arc::new(Surface::new(Maps { normals, depth, coverage }).unwrap())) }
}

/// Every fifth pixel of the ball, as the layer shows it and as `expected` says (linear light), within `bytes`.
pub(super) fn assert_shows(shading: &Shading, bytes: f32, expected: impl Fn(&Surface, usize, usize) -> Vec3) {
    let scene = ball();
    let surface = scene.surface.as_deref().unwrap();
    let mut seen = 0;
    for at in TileAt::covering(SIZE.rect()) {
        let Some(tile) = shading.render_tile(&scene, at) else { continue };
        for i in (0..TILE * TILE).step_by(5) {
            let (x, y) = ((at.col * 64) as usize + i % TILE, (at.row * 64) as usize + i / TILE);
            let found = &tile.bytes()[i * 4..i * 4 + 4];
            if surface.coverage(x, y) == 0 {
                assert_eq!(found, [0; 4]);
                continue;
            }
            seen += 1;
            for (c, light) in expected(surface, x, y).to_array().into_iter().enumerate() {
                let expected = srgb::encode(light.max(0.0)).min(1.0) * 255.0;
                let found = f32::from(found[c]);
                assert!((found - expected).abs() <= bytes, "({x}, {y}) channel {c}: {found}, not {expected}");
            }
        }
    }
    assert!(seen > 1000);
}

pub(super) fn term(color: Color, weight: f32, alpha: f32, gamma: f32) -> Term {
    Term { color, weight, scaling: Scaling::new(alpha, gamma) }
}

const GREEN: Color = Color { r: 60, g: 200, b: 90, a: 255 };

fn lamp(kind: LightKind, intensity: f32) -> Light {
    Light { kind, color: Color { r: 255, g: 220, b: 200, a: 255 }, intensity }
}

/// ℓ at a pixel, as MATH and the documents say it.
fn direction_at(surface: &Surface, light: &Light, x: usize, y: usize) -> Vec3 {
    match light.kind {
        LightKind::Directional { direction } => direction.normalize(),
        LightKind::Point { position } => {
            let here = vec3(x as f32 + 0.5, y as f32 + 0.5, -surface.depth(x, y) * surface.depth_range_px());
            let to = position - here;
            vec3(to.x, -to.y, to.z).normalize()
        }
    }
}

fn phong() -> Shading {
    Shading {
        lights: vec![
            lamp(LightKind::Directional { direction: vec3(-0.5, 0.6, 0.62) }, 0.8),
            lamp(LightKind::Point { position: vec3(100.0, 90.0, 40.0) }, 0.5),
        ],
        ambient: term(GREEN, 0.1, 0.3, 0.7),
        diffuse: term(GREEN, 0.7, 0.2, 1.0),
        specular: term(Color::WHITE, 0.4, 0.6, 2.0),
        shininess: 25.0,
        features: Features {
            scales: vec![FeatureScale { curvature_scale_px: 6.0, ..FeatureScale::default() }],
            lambda: 0.7,
        },
        ..Shading::new(Model::Phong)
    }
}

/// MATH 5, term by term, pixel by pixel.
fn phong_at(shading: &Shading, surface: &Surface, x: usize, y: usize, zeta: f32) -> Vec3 {
    let n = surface.normal(x, y);
    let features = shading.features.on(surface);
    let part = |term: &Term, kappa: f32, rho: f32, radiance: Vec3| {
        Vec3::from(term.linear()) * radiance * rho * term.scaling.sigma(kappa, rho)
    };
    let mut sum = part(&shading.ambient, features.at(x, y, Vec3::Z), 1.0, Vec3::ONE);
    for light in &shading.lights {
        let l = direction_at(surface, light, x, y);
        let kappa = features.at(x, y, l);
        let radiance = Vec3::from(light.color.linear()) * light.intensity;
        let r = 2.0 * n.z * n - Vec3::Z;
        sum += part(&shading.diffuse, kappa, n.dot(l).max(0.0).powf(zeta), radiance);
        sum += part(&shading.specular, kappa, r.dot(l).max(0.0).powf(shading.shininess), radiance);
    }
    sum
}

#[test]
fn every_model_goes_by_its_own_name() {
    for (model, name) in Model::ALL {
        assert_eq!(model.name(), name);
    }
}
#[test]
fn phong_is_the_sum_of_its_scaled_terms_over_all_lights() {
    let shading = phong();
    assert_shows(&shading, 1.0, |surface, x, y| phong_at(&shading, surface, x, y, 1.0));
}
#[test]
fn the_sub_lambertian_term_is_a_power_of_the_matt_one() {
    let shading = Shading { model: Model::SubLambertian, exponent: 0.4, ..phong() };
    assert_shows(&shading, 1.0, |surface, x, y| phong_at(&shading, surface, x, y, 0.4));
}
#[test]
fn without_a_surface_there_is_nothing_to_light() {
    let scene = Scene { size: SIZE, surface: None };
    assert!(phong().render_tile(&scene, TileAt::new(0, 0)).is_none());
    assert!(phong().render_tile(&ball(), TileAt::new(5, 0)).is_none(), "nor beyond the canvas");
    assert!(phong().render_tile(&ball(), TileAt::new(-1, -1)).is_none());
}
#[test]
fn scaling_brightens_ridges_and_darkens_valleys_in_the_light() {
    let scene = ball();
    let plain = Shading {
        ambient: Term::NONE,
        specular: Term::NONE,
        diffuse: Term::plain(Color::WHITE, 0.6),
        ..Shading::new(Model::Phong)
    };
    let scaled = Shading { diffuse: term(Color::WHITE, 0.6, 0.2, 1.0), ..plain.clone() };
    let kappa = plain.features.on(scene.surface.as_deref().unwrap());
    let at = TileAt::new(0, 0);
    let (plain, scaled) = (plain.render_tile(&scene, at).unwrap(), scaled.render_tile(&scene, at).unwrap());
    let mut told = 0;
    for i in 0..TILE * TILE {
        let kappa = kappa.at(i % TILE, i / TILE, Vec3::Z);
        let (before, after) = (plain.bytes()[i * 4], scaled.bytes()[i * 4]);
        // Well above the invariant point: δ = 0.2 is 0.12 of light here, 97 of 255.
        if before > 130 && kappa.abs() > 0.2 {
            assert!((after > before) == (kappa > 0.0), "{before} {after} {kappa}");
            told += 1;
        }
    }
    assert!(told > 100);
}
