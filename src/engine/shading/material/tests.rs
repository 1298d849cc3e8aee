use super::*;
use crate::math::{Size, Vec3, srgb, vec3};
use crate::raster::{Plane, TILE, TileAt};
use crate::shading::{FeatureScale, Features, LightKind};
use crate::surface::view::{Eye, in_view};
use crate::surface::{Maps, Scene, Surface};
use std::sync::Arc;

pub(super) const SIZE: Size = Size::new(128, 128);

/// A ball with a dimpled skin, off the canvas's middle, without background.
pub(super) fn ball() -> Scene {
    let normals = Plane::from_fn(SIZE, |x, y| {
        let (u, v) = ((x as f32 + 0.5 - 60.0) / 50.0, (66.0 - y as f32 - 0.5) / 50.0);
        let z2 = 1.0 - u * u - v * v;
        let dimple = 0.15 * vec3((x as f32 * 0.6).sin(), (y as f32 * 0.5).cos(), 0.0);
        if z2 > 0.0 { vec3(u, v, z2.sqrt()) + dimple } else { Vec3::ZERO }
    });
    let depth = normals.map(|n| 1.0 - n.z.max(0.0).min(1.0));
    let coverage = normals.map(|n| if n == Vec3::ZERO { 0 } else { 255 });
    Scene {
        size: SIZE,
        surface: Some(Arc::new(Surface::new(Maps { normals, depth, coverage }).unwrap())),
    }
}

/// The same ball seen from nearby, through a lens of 60°.
pub(super) fn near_ball() -> Scene {
    let surface = ball().surface.and_then(Arc::into_inner).unwrap();
    Scene { size: SIZE, surface: Some(Arc::new(surface.with_eye(Eye::of_fov(Some(60.0), SIZE)))) }
}

/// Every fifth pixel of the ball, from afar and from nearby, as the layer shows it and as
/// `expected` says (linear light), within `bytes`.
pub(super) fn assert_shows(
    shading: &Shading,
    bytes: f32,
    expected: impl Fn(&Surface, usize, usize) -> Vec3,
) {
    [ball(), near_ball()]
        .iter()
        .for_each(|scene| assert_shows_on(scene, shading, bytes, &expected));
}

fn assert_shows_on(
    scene: &Scene,
    shading: &Shading,
    bytes: f32,
    expected: impl Fn(&Surface, usize, usize) -> Vec3,
) {
    let surface = scene.surface.as_deref().unwrap();
    let mut seen = 0;
    // Normals of contour pixels are those in the middle of their own share.
    let contours: Vec<_> = surface
        .contours()
        .pixels()
        .iter()
        .map(|pixel| (pixel.x as usize, pixel.y as usize))
        .collect();
    for at in TileAt::covering(SIZE.rect()) {
        let Some(tile) = shading.render_tile(scene, at) else { continue };
        for i in (0..TILE * TILE).step_by(5) {
            let (x, y) = ((at.col * 64) as usize + i % TILE, (at.row * 64) as usize + i / TILE);
            let found = &tile.bytes()[i * 4..i * 4 + 4];
            if surface.coverage(x, y) == 0 {
                assert_eq!(found, [0; 4]);
                continue;
            }
            // What faces away from a near eye is not seen.
            if contours.contains(&(x, y))
                || (surface.facing(x, y) < 0.1 && surface.eye() != Eye::Afar)
            {
                continue;
            }
            seen += 1;
            for (c, light) in expected(surface, x, y).to_array().into_iter().enumerate() {
                let expected = srgb::encode(light.max(0.0)).min(1.0) * 255.0;
                let found = f32::from(found[c]);
                assert!(
                    (found - expected).abs() <= bytes,
                    "({x}, {y}) channel {c}: {found}, not {expected}"
                );
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

/// ℓ at a pixel, as `docs/RECIPES.md` says it.
fn direction_at(surface: &Surface, light: &Light, x: usize, y: usize) -> Vec3 {
    match light.kind {
        LightKind::Directional { direction } => direction.normalize(),
        LightKind::Point { position } => {
            let here = vec3(
                x as f32 + 0.5,
                y as f32 + 0.5,
                -surface.depth(x, y) * surface.depth_range_px(),
            );
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
        let v = surface.view(x, y);
        let r = 2.0 * n.dot(v) * n - v;
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

/// Ashikhmin and Shirley (2000) at a pixel, in vectors.
fn ashikhmin_at(shading: &Shading, surface: &Surface, x: usize, y: usize) -> Vec3 {
    // In the frame of the pixel's own view.
    let view = surface.view(x, y);
    let (n, e) = (in_view(view, surface.normal(x, y)), Vec3::Z);
    let features = shading.features.on(surface);
    let (rd, rs) = (
        Vec3::from(shading.diffuse.linear()),
        Vec3::from(shading.specular.linear()).min(Vec3::ONE),
    );
    let u = (Vec3::X - n.x * n).normalize();
    let v = n.cross(u);
    let mut sum = Vec3::ZERO;
    for light in &shading.lights {
        let toward = direction_at(surface, light, x, y);
        let l = in_view(view, toward);
        let h = (l + e).normalize();
        let (n_l, n_h) = (n.dot(l).max(0.0), n.dot(h));
        let lifted = |cosine: f32| 1.0 - (1.0 - cosine / 2.0).powi(5);
        let matt = 28.0 / 23.0 * rd * (1.0 - rs) * lifted(n_l) * lifted(n.z) * n_l;
        let exponent = (shading.nu * h.dot(u).powi(2) + shading.nv * h.dot(v).powi(2))
            / (1.0 - n_h * n_h).max(1e-6);
        let lobe =
            ((shading.nu + 1.0) * (shading.nv + 1.0)).sqrt() / 8.0 * n_h.max(0.0).powf(exponent);
        let fresnel = rs + (1.0 - rs) * (1.0 - h.dot(e)).powi(5);
        let glossy = lobe * n_l / (h.dot(e) * n_l.max(n.z)) * fresnel;
        let kappa = features.at(x, y, toward);
        let scaled = shading.diffuse.scaling.sigma(kappa, n_l) * matt
            + shading.specular.scaling.sigma(kappa, n_h) * glossy;
        sum += scaled * Vec3::from(light.color.linear()) * light.intensity;
    }
    sum
}

#[test]
fn ashikhmin_is_the_paper_s_two_lobes_each_scaled_by_its_own_reflectance() {
    let shading = Shading {
        model: Model::Ashikhmin,
        ambient: Term::NONE,
        specular: term(Color { r: 250, g: 200, b: 90, a: 255 }, 0.3, 0.9, 2.0),
        nu: 12.0,
        nv: 90.0,
        ..phong()
    };
    assert_shows(&shading, 1.0, |surface, x, y| ashikhmin_at(&shading, surface, x, y));
}

#[test]
fn a_highlight_stretches_along_the_direction_of_the_smaller_exponent() {
    let light = vec3(0.0, 0.0, 1.0);
    let seen = |nu: f32, nv: f32, h: Vec3| {
        let h = h.normalize();
        ashikhmin::glossy([h.x, h.y, h.z], h.z, light.z, 1.0, nu, nv)
    };
    let (beside, above) = (vec3(0.3, 0.0, 1.0), vec3(0.0, 0.3, 1.0));
    assert!(seen(10.0, 500.0, beside) > 10.0 * seen(10.0, 500.0, above));
    assert!((seen(50.0, 50.0, beside) - seen(50.0, 50.0, above)).abs() < 1e-5);
}

/// n̄ of a pixel in the frame of its view.
fn nbar_of_view(surface: &Surface, x: usize, y: usize) -> crate::math::Vec2 {
    let n = in_view(surface.view(x, y), surface.normal(x, y));
    crate::math::vec2(n.x, -n.y)
}

/// A sphere that shows red by x and green by y.
fn painted_sphere(blue: f32) -> LitSphere {
    let color = |i: u32| [(i % 64) as f32 / 64.0, (i / 64) as f32 / 64.0, blue, 1.0];
    LitSphere::new(
        "s".into(),
        crate::raster::Picture::linear(Size::new(64, 64), (0..4096).map(color).collect()).unwrap(),
    )
}

#[test]
fn two_lit_spheres_are_blended_by_curvature_and_scaled_by_their_luminance() {
    let shading = Shading {
        model: Model::LitSphere,
        specular: term(Color::WHITE, 0.8, 0.4, 1.5),
        sphere: Some(painted_sphere(0.9)),
        sphere_concave: Some(painted_sphere(0.0)),
        ..phong()
    };
    let [convex, concave] =
        [&shading.sphere, &shading.sphere_concave].map(|s| s.as_ref().unwrap().light());
    let most = convex.brightest();
    assert!(most > concave.brightest());
    assert_shows(&shading, 1.0, |surface, x, y| {
        let kappa = shading.features.on(surface).at(x, y, Vec3::Z);
        let at = |sphere: &crate::shading::sphere::SphereLight| {
            Vec3::from(sphere.at(nbar_of_view(surface, x, y)))
        };
        let shown = at(concave).lerp(at(convex), 0.5 + 0.5 * kappa);
        let delta = srgb::luminance(shown.x, shown.y, shown.z) / most;
        0.8 * shown * shading.specular.scaling.sigma(kappa, delta)
    });
}

#[test]
fn a_lit_sphere_that_names_no_picture_is_clay() {
    let shading = Shading::new(Model::LitSphere);
    assert_shows(&shading, 1.0, |surface, x, y| {
        Vec3::from(LitSphere::clay().light().at(nbar_of_view(surface, x, y)))
    });
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
    let (plain, scaled) =
        (plain.render_tile(&scene, at).unwrap(), scaled.render_tile(&scene, at).unwrap());
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

#[test]
fn the_body_of_solid_glass_counts_as_what_it_keeps() {
    let open = Shading::new(Model::Refraction);
    let mut solid = open.clone();
    solid.solid.on = true;
    assert_eq!(solid.kept_bytes() - open.kept_bytes(), Surface::BODY_BYTES as u64);
}
