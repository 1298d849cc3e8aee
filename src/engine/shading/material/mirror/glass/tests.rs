use super::*;
use crate::math::{Size, srgb::Color, vec3};
use crate::raster::{Picture, Plane, TileAt};
use crate::shading::environment::projection::lat_long_direction;
use crate::shading::material::tests::{assert_shows, ball, term};
use crate::shading::{Environment, Model};
use crate::surface::{Maps, Scene};
use std::sync::Arc;

fn sky(light: impl Fn(Vec3) -> Vec3) -> Option<Environment> {
    let texel = |i: u32| {
        let (u, v) = (((i % 256) as f32 + 0.5) / 256.0, ((i / 256) as f32 + 0.5) / 128.0);
        light(lat_long_direction(u, v)).extend(1.0).to_array()
    };
    let texels = (0..256 * 128).map(texel).collect();
    Some(Environment::new("sky.hdr".into(), Picture::linear(Size::new(256, 128), texels).unwrap()))
}

fn glass(environment: Option<Environment>, color: Color) -> Shading {
    let mut shading = Shading::new(Model::Refraction);
    shading.solid.on = true;
    Shading { environment, specular: term(color, 0.5, 0.4, 0.0), ..shading }
}

#[test]
fn what_is_mirrored_is_what_fresnel_says() {
    assert!((mirrored_share(1.0, 1.5) - 0.04).abs() < 1e-6);
    assert!((mirrored_share(0.0, 1.5) - 1.0).abs() < 1e-6);
    // At Brewster's angle, tan θ = 1.5, one polarization goes through whole.
    let brewster = 1.0 / (1.0f32 + 1.5 * 1.5).sqrt();
    let across = (1.0 - 1.5 * 1.5) / (1.0 + 1.5f32 * 1.5);
    assert!((mirrored_share(brewster, 1.5) - 0.5 * across * across).abs() < 1e-6);
    assert_eq!(mirrored_share(0.5, 1.0 / 1.5), 1.0, "past the critical angle");
    assert!(mirrored_share(0.3, 1.0) < 1e-6, "nothing is mirrored without another matter");
}

#[test]
fn under_even_light_clear_glass_is_as_bright_as_the_light() {
    let shading = glass(sky(|_| Vec3::ONE), Color::WHITE);
    assert_shows(&shading, 1.0, |_, _, _| Vec3::splat(0.5));
}

/// A wedge whose front rises toward the right, all over the picture.
fn wedge(rise: f32) -> Scene {
    let size = Size::new(128, 64);
    let highest = rise * 127.5;
    let maps = Maps {
        normals: Plane::full(size, vec3(-rise, 0.0, 1.0).normalize()),
        depth: Plane::from_fn(size, |x, _| 1.0 - rise * (x as f32 + 0.5) / highest),
        coverage: Plane::full(size, 255),
    };
    let surface = Surface::new(maps).unwrap();
    Scene { size, surface: Some(Arc::new(surface)) }
}

#[test]
fn a_prism_bends_light_twice() {
    let light = |e: Vec3| vec3(0.5 + 0.45 * e.x, 0.5 + 0.45 * e.y, 0.5 - 0.45 * e.z);
    let mut shading = glass(sky(light), Color::WHITE);
    shading.solid.back = 0.0;
    let scene = wedge(0.4);
    let n = vec3(-0.4, 0.0, 1.0).normalize();
    let within = refract(n, Vec3::Z, 1.5);
    let leaving = refract(Vec3::Z, -within, 1.0 / 1.5);
    let share = mirrored_share(n.z, 1.5);
    let seen = light(super::super::mirrored(n, Vec3::Z)) * share + light(leaving) * (1.0 - share);
    let once = light(within);
    let tile = shading.render_tile(&scene, TileAt::new(0, 0)).unwrap();
    let pixel = &tile.bytes()[(30 * TILE + 40) * 4..][..3];
    for (c, byte) in pixel.iter().enumerate() {
        let expected = crate::math::srgb::encode(0.5 * seen.to_array()[c]) * 255.0;
        assert!((f32::from(*byte) - expected).abs() < 2.0, "{c}: {byte}, {expected}");
    }
    assert!((seen - once).length() > 0.02, "else one interface would do");
}

#[test]
fn thick_glass_takes_more_of_its_color() {
    let red = Color { r: 255, g: 90, b: 90, a: 255 };
    let shading = glass(sky(|_| Vec3::ONE), red);
    let tile = shading.render_tile(&ball(), TileAt::new(0, 0)).unwrap();
    let at = |x: usize, y: usize| &tile.bytes()[(y * TILE + x) * 4..][..3];
    // The ball's middle is at (60, 66), its radius 50.
    let (middle, rim) = (at(58, 60), at(22, 40));
    assert!(middle[0].abs_diff(rim[0]) < 6, "{middle:?} {rim:?}");
    assert!(middle[1] + 20 < rim[1], "{middle:?} {rim:?}");
}

#[test]
fn bounces_have_no_effect_on_solid_glass() {
    let shading = glass(sky(|e| Vec3::splat(0.5 + 0.4 * e.y)), Color::WHITE);
    let bouncing = Shading { bounces: 3, ..shading.clone() };
    let [one, other] = [shading, bouncing]
        .map(|shading| shading.render_tile(&ball(), TileAt::new(0, 1)).unwrap().bytes().to_vec());
    assert_eq!(one, other);
}
