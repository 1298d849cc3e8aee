//! Paths measured on the surface, compared with its own lengths.

use super::*;
use crate::math::{Size, Vec3, vec2, vec3};
use crate::paint::DistanceMetric;
use crate::raster::Plane;
use crate::surface::{Maps, Surface};
use std::sync::Arc;

/// A scene whose normals lean along x by `slope`: −∂z/∂x toward the viewer.
fn leaning(slope: impl Fn(f32) -> f32 + Sync) -> Scene {
    let size = Size::new(300, 100);
    let normals =
        Plane::from_fn(size, |x, _| vec3(-slope(x as f32 + 0.5), 0.0, 1.0).normalize_or(Vec3::Z));
    let maps = Maps { normals, depth: Plane::full(size, 0.5), coverage: Plane::full(size, 255) };
    Scene { size, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
}

fn dabs_of(scene: &Scene, spacing_on: DistanceMetric, ends: [Vec2; 2]) -> Vec<Dab> {
    let brush = Brush { size: 20.0, spacing: 0.25, spacing_on, ..Brush::default() };
    dabs(&brush, Operator::None, Color::BLACK, &ends.map(Sample::at), scene)
}

/// The least and the greatest path length between two successive dabs.
fn ways(dabs: &[Dab], length: impl Fn(Vec2, Vec2) -> f32) -> (f32, f32) {
    let ways = dabs.windows(2).map(|pair| length(pair[0].at, pair[1].at));
    ways.fold((f32::MAX, 0.0), |(least, most), way| (least.min(way), most.max(way)))
}

#[test]
fn on_a_tilted_plane_dabs_stand_as_far_apart_as_their_spacing_is_on_it() {
    let scene = leaning(|_| 1.5);
    for to in [vec2(280.0, 20.0), vec2(20.0, 90.0), vec2(200.0, 90.0)] {
        let dabs = dabs_of(&scene, DistanceMetric::Surface, [vec2(20.0, 20.0), to]);
        let (least, most) =
            ways(&dabs, |a, b| ((b - a) * vec2((1.0f32 + 2.25).sqrt(), 1.0)).length());
        assert!(least > 4.9 && most < 5.1, "to {to}: {least} to {most} px of 5");
    }
    let (least, most) = ways(
        &dabs_of(&scene, DistanceMetric::Canvas, [vec2(20.0, 20.0), vec2(280.0, 20.0)]),
        Vec2::distance,
    );
    assert!((least - 5.0).abs() < 1e-2 && (most - 5.0).abs() < 1e-2, "as seen: {least} to {most}");
}

#[test]
fn round_a_cylinder_dabs_stand_evenly_along_its_arc() {
    let lean = |x: f32| ((x - 150.0) / 140.0).clamp(-0.95, 0.95);
    let scene = leaning(|x| -lean(x) / (1.0 - lean(x) * lean(x)).sqrt());
    let dabs = dabs_of(&scene, DistanceMetric::Surface, [vec2(25.0, 50.0), vec2(275.0, 50.0)]);
    let arc = |p: Vec2| 140.0 * lean(p.x).asin();
    let (least, most) = ways(&dabs, |a, b| arc(b) - arc(a));
    assert!(least > 4.9 && most < 5.1, "{least} to {most} px of 5");
    let seen = dabs_of(&scene, DistanceMetric::Canvas, [vec2(25.0, 50.0), vec2(275.0, 50.0)]);
    assert!(dabs.len() > seen.len() + 10, "{} and {}", dabs.len(), seen.len());
}

#[test]
fn how_densely_a_line_is_sampled_changes_nothing_on_the_surface_either() {
    let scene = leaning(|x| 1.5 * (x * 0.05).sin());
    let brush = Brush {
        size: 20.0,
        spacing: 0.25,
        spacing_on: DistanceMetric::Surface,
        ..Brush::default()
    };
    let line = |n: usize| -> Vec<Sample> {
        (0..n)
            .map(|i| {
                Sample::at(vec2(10.0, 20.0).lerp(vec2(290.0, 80.0), i as f32 / (n - 1) as f32))
            })
            .collect()
    };
    let [few, many] =
        [2, 301].map(|n| dabs(&brush, Operator::None, Color::BLACK, &line(n), &scene));
    assert!(few.len().abs_diff(many.len()) <= 1, "{} and {}", few.len(), many.len());
    for (a, b) in few.iter().zip(&many) {
        assert!(a.at.distance(b.at) < 0.25, "{} and {}", a.at, b.at);
    }
}

#[test]
fn a_pen_from_beyond_all_canvases_ends() {
    let scene = leaning(|_| 1.0);
    let far = dabs_of(&scene, DistanceMetric::Surface, [vec2(-9e5, 50.0), vec2(9e5, 50.0)]);
    assert!(
        far.len() <= (super::walk::MAX_STEPS + 2) as usize && far.len() > 1000,
        "{}",
        far.len()
    );
}
