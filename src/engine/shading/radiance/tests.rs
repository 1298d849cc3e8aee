use super::*;
use crate::math::Size;
use crate::raster::{Plane, tile::transparent_f32};
use crate::surface::{Maps, Surface};
use std::sync::Arc;

const SIZE: Size = Size::new(100, 80);

/// Waves: ridges and valleys along y.
fn scene() -> Scene {
    let normals = Plane::from_fn(SIZE, |x, _| vec3((x as f32 * 0.3).sin(), 0.0, 1.0));
    let maps = Maps { normals, depth: Plane::full(SIZE, 0.5), coverage: Plane::full(SIZE, 255) };
    Scene { size: SIZE, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
}

/// Every pixel the same color.
fn flat(r: f32, g: f32, b: f32, a: f32) -> PlanarTile {
    let mut pixels = transparent_f32();
    pixels.fill([r * a, g * a, b * a, a]);
    PlanarTile::from_pixels(&pixels)
}

const BENEATH: BackdropStats = BackdropStats { brightest: 0.8, gain: 1.0 };

#[test]
fn every_pixel_is_scaled_as_the_equation_says() {
    let scene = scene();
    for (lambda, gamma) in [(0.0, 1.0), (1.0, 2.0), (-0.5, 5.0)] {
        let (scaling, features) =
            (Scaling::new(0.2, gamma), Features { lambda, ..Features::default() });
        let light = vec3(1.0, 0.2, 0.4);
        let layer = RadianceScaling { scaling, features, light, ..RadianceScaling::default() };
        let features = layer.features.on(scene.surface.as_ref().unwrap());
        for color in [[0.8, 0.5, 0.2], [0.03, 0.01, 0.05], [1.0, 1.0, 1.0], [0.0, 0.3, 0.0]] {
            let mut tile = flat(color[0], color[1], color[2], 0.5);
            layer.apply_tile(&scene, TileAt::new(0, 0), BENEATH, &mut tile);
            for x in [1usize, 5, 9, 20, 33, 63] {
                let light = color.map(srgb::decode);
                let y = srgb::luminance(light[0], light[1], light[2]);
                let sigma = layer.scaling.sigma(features.at(x, 7, layer.light), y / 0.8);
                let found = tile.rows()[7].pixel(x);
                for c in 0..3 {
                    let expected = srgb::encode(light[c] * sigma).min(1.0) * 0.5;
                    assert!(
                        (found[c] - expected).abs() < 0.2 / 255.0,
                        "γ {gamma} {x} {c}: {} not {expected}",
                        found[c]
                    );
                }
                assert_eq!(found[3], 0.5, "alpha stays");
            }
        }
    }
}

#[test]
fn ridges_brighten_and_valleys_darken() {
    let scene = scene();
    let mut tile = flat(0.7, 0.7, 0.7, 1.0);
    RadianceScaling::default().apply_tile(&scene, TileAt::new(0, 0), BENEATH, &mut tile);
    // n_x rises with x through 0 on a ridge (x = 21: 0.3 x = 2π) and falls through 0 in a valley (x
    // = 10.5: π).
    let (ridge, valley) = (tile.rows()[9].pixel(21)[0], tile.rows()[9].pixel(10)[0]);
    assert!(ridge > 0.75 && valley < 0.65, "{ridge} {valley}");
}

#[test]
fn no_magnitude_changes_no_byte() {
    let layer = RadianceScaling { scaling: Scaling::new(0.2, 0.0), ..RadianceScaling::default() };
    let mut pixels = transparent_f32();
    for (i, p) in pixels.iter_mut().enumerate() {
        let a = (i % 256) as f32 / 255.0;
        *p = [a * 0.3, a * (i % 7) as f32 / 7.0, 0.0, a];
    }
    let mut tile = PlanarTile::from_pixels(&pixels);
    layer.apply_tile(&scene(), TileAt::new(0, 0), BENEATH, &mut tile);
    let mut after = transparent_f32();
    tile.to_pixels(&mut after);
    assert_eq!(after[..], pixels[..]);
}

#[test]
fn flat_ground_keeps_its_bytes() {
    let maps = Maps {
        normals: Plane::full(SIZE, Vec3::Z),
        depth: Plane::full(SIZE, 0.5),
        coverage: Plane::full(SIZE, 255),
    };
    let scene = Scene { size: SIZE, surface: Some(Arc::new(Surface::new(maps).unwrap())) };
    let mut pixels = transparent_f32();
    for (i, p) in pixels.iter_mut().enumerate() {
        let (v, a) = (i % 256, i / 256 * 17);
        *p = [v.min(a), (v / 3).min(a), 0, a].map(|byte| byte as f32 / 255.0);
    }
    let mut tile = PlanarTile::from_pixels(&pixels);
    let before = tile.quantize().unwrap();
    RadianceScaling::default().apply_tile(&scene, TileAt::new(0, 0), BENEATH, &mut tile);
    assert!(before.bytes() == tile.quantize().unwrap().bytes());
}

#[test]
fn what_is_beyond_the_surface_or_transparent_stays() {
    let mut tile = flat(0.5, 0.5, 0.5, 1.0);
    RadianceScaling::default().apply_tile(&scene(), TileAt::new(1, 0), BENEATH, &mut tile);
    assert_eq!(tile.rows()[3].pixel(36), [0.5, 0.5, 0.5, 1.0], "column 100 is beyond the canvas");
    assert_ne!(tile.rows()[3].pixel(10), [0.5, 0.5, 0.5, 1.0]);
    let mut clear = PlanarTile::transparent();
    RadianceScaling::default().apply_tile(&scene(), TileAt::new(0, 0), BENEATH, &mut clear);
    assert!(clear.quantize().is_none());
    let mut alone = flat(0.5, 0.5, 0.5, 1.0);
    let nothing = Scene { size: SIZE, surface: None };
    RadianceScaling::default().apply_tile(&nothing, TileAt::new(0, 0), BENEATH, &mut alone);
    assert_eq!(alone.rows()[0].pixel(0), [0.5, 0.5, 0.5, 1.0]);
}

/// Of one opaque pixel.
fn luminance(row: &crate::raster::planar::PixelRow, x: usize) -> f32 {
    let [r, g, b, _] = row.pixel(x).map(srgb::decode);
    srgb::luminance(r, g, b)
}

#[test]
fn the_mean_luminance_can_be_kept() {
    let scene = scene();
    let scaling = Scaling::new(0.2, 3.0);
    let layer = RadianceScaling { scaling, keep_mean: true, ..RadianceScaling::default() };
    let at = TileAt::new(0, 0);
    let mean = |tile: &PlanarTile| {
        tile.rows().iter().map(|r| (0..TILE).map(|x| luminance(r, x)).sum::<f32>()).sum::<f32>()
    };
    // The bright one is clipped at its ridges.
    for [r, g, b] in [[0.7, 0.6, 0.5], [0.97, 0.95, 0.9]] {
        let before = flat(r, g, b, 1.0);
        let sums = |tried| layer.means_tile(&scene, at, 0.8, &before, tried);
        let finer = sums(GainLadder::whole()).finer(GainLadder::whole()).unwrap();
        let gain = sums(finer).gain(finer);
        let mut after = before.clone();
        layer.apply_tile(&scene, at, BackdropStats { brightest: 0.8, gain }, &mut after);
        let (before, after) = (mean(&before), mean(&after));
        assert!((after / before - 1.0).abs() < 0.003, "{before} {after}");
        assert!((gain - 1.0).abs() > 0.02, "or else the test says nothing: {gain}");
    }
}

#[test]
fn senseless_measures_do_no_harm() {
    for beneath in
        [f32::NAN, 0.0, f32::INFINITY, 1e-40].map(|v| BackdropStats { brightest: v, gain: 1.0 })
    {
        let mut tile = flat(0.9, 0.1, 0.0, 0.7);
        RadianceScaling::default().apply_tile(&scene(), TileAt::new(0, 0), beneath, &mut tile);
        assert!(
            tile.rows().iter().all(|r| r.rgb.iter().flatten().all(|v| (0.0..=0.7001).contains(v)))
        );
    }
    assert_eq!(LightSums::default().gain(GainLadder::whole()), 1.0);
    assert!(LightSums::default().finer(GainLadder::whole()).is_none());
}
