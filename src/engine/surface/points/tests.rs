//! Points between pixels against a reading of the definition pixel by pixel.

use super::*;
use crate::math::{Vec3, hash, vec3};
use crate::raster::Plane;
use crate::surface::Maps;

const SIZE: Size = Size::new(40, 30);

/// A plate whose normals have bumps as fine as its pixels, before a wall, with nothing on the
/// right.
fn bumpy() -> Arc<Surface> {
    let lean = |x: usize, y: usize, k: u32| hash::unit(x as u32, y as u32, k) - 0.5;
    let is_near = |x: usize, y: usize| (8..22).contains(&x) && (6..21).contains(&y);
    let normals =
        Plane::from_fn(SIZE, |x, y| vec3(lean(x, y, 1), lean(x, y, 2), 1.0).normalize_or(Vec3::Z));
    let depth =
        Plane::from_fn(
            SIZE,
            |x, y| if is_near(x, y) { 0.001 * x as f32 } else { 0.9 + 0.002 * y as f32 },
        );
    let coverage = Plane::from_fn(SIZE, |x, _| if x < 33 { 255 } else { 0 });
    let made = Surface::with_depth_range(Maps { normals, depth, coverage }, Some(40.0));
    Arc::new(made.unwrap())
}

/// What a point reads by the definition: of the pixels less than one away along both axes those
/// that steps along links among them reach from the one that holds it, weighed by the tent.
fn read_by_definition(surface: &Surface, q: Vec2) -> Option<MapValues> {
    let held = (q.x.floor() as i32, q.y.floor() as i32);
    let tent = |(x, y): (i32, i32)| {
        let away = (vec2(x as f32, y as f32) + 0.5 - q).abs();
        (1.0 - away.x).max(0.0) * (1.0 - away.y).max(0.0)
    };
    surface.coverage_plane().get(held.0, held.1).filter(|c| *c > 0)?;
    let mut reached = vec![held];
    let mut next = 0;
    while let Some(&(x, y)) = reached.get(next) {
        next += 1;
        let bits = surface.smooth_links_plane().get(x, y).unwrap_or(0);
        for (bit, to) in [
            (links::LEFT, (x - 1, y)),
            (links::RIGHT, (x + 1, y)),
            (links::UP, (x, y - 1)),
            (links::DOWN, (x, y + 1)),
        ] {
            if bits & bit != 0 && tent(to) > 0.0 && !reached.contains(&to) {
                reached.push(to);
            }
        }
    }
    let sum: f32 = reached.iter().map(|at| tent(*at)).sum();
    let (mut normal, mut depth) = (Vec3::ZERO, 0.0);
    for at in reached {
        let (x, y) = (at.0 as usize, at.1 as usize);
        normal += tent(at) / sum * surface.normal(x, y);
        depth += tent(at) / sum * surface.depth(x, y);
    }
    let normal = normal.normalize_or(Vec3::Z);
    Some(MapValues { depth, nbar: vec2(normal.x, -normal.y), nz: normal.z })
}

#[test]
fn the_middle_of_a_pixel_reads_what_the_pixel_holds() {
    let surface = bumpy();
    for (x, y) in (0..30).flat_map(|y| (0..40).map(move |x| (x, y))) {
        let q = vec2(x as f32, y as f32) + 0.5;
        let held = MapValues {
            depth: surface.depth(x, y),
            nbar: surface.nbar(x, y),
            nz: surface.normal(x, y).z,
        };
        assert_eq!(surface.values_near(q), held, "{q}");
        assert_eq!(surface.values_at(q), (x < 33).then_some(held), "{q}");
    }
}

#[test]
fn points_read_what_the_definition_says() {
    let surface = bumpy();
    let mut parted = 0;
    for i in 0..4000 {
        let q = vec2(40.0 * hash::unit(i, 0, 7), 30.0 * hash::unit(i, 1, 7));
        let (found, told) = (surface.values_at(q), read_by_definition(&surface, q));
        match (found, told) {
            (Some(a), Some(b)) => {
                assert!(
                    (a.depth - b.depth).abs() < 1e-5 && a.nbar.distance(b.nbar) < 1e-5,
                    "{q}: {a:?} {b:?}"
                );
                assert!((a.nbar.length_squared() + a.nz * a.nz - 1.0).abs() < 1e-5, "{q}: {a:?}");
                parted += usize::from((0.05..0.89).contains(&a.depth));
            }
            (None, None) => {}
            _ => panic!("{q}: {found:?} {told:?}"),
        }
    }
    assert_eq!(parted, 0, "between the plate and the wall there is nothing");
}

#[test]
fn a_point_that_is_nowhere_reads_something_finite() {
    let surface = bumpy();
    for q in [Vec2::NAN, Vec2::INFINITY, vec2(-1e7, 4.0), vec2(12.5, f32::NAN), vec2(1e7, 1e7)] {
        assert_eq!(surface.values_at(q), None, "{q}");
        let MapValues { depth, nbar, nz } = surface.values_near(q);
        assert!(depth.is_finite() && nbar.is_finite() && nz.is_finite(), "{q}");
    }
}

#[test]
fn a_surface_of_another_size_reads_points_as_the_document_does() {
    let surface = bumpy();
    for factor in [0.5, 2.0, 3.0, 4.0] {
        let scaled = surface.scaled(SIZE.scaled(factor)).unwrap();
        for i in 0..500 {
            let q = vec2(40.0 * hash::unit(i, 0, 8), 30.0 * hash::unit(i, 1, 8));
            let (here, there) = (surface.values_near(q), scaled.values_near(q * factor));
            let apart = here.nbar.distance(there.nbar) + (here.depth - there.depth).abs();
            assert!(apart < 1e-4, "{q} times {factor}: {here:?} {there:?}");
        }
        let own =
            scaled.interpolate_maps(vec2(12.5, 10.5) * factor).nbar.distance(surface.nbar(12, 10));
        assert!(
            factor == 3.0 || own > 1e-3,
            "times {factor} it would read something else on itself: {own}"
        );
    }
}
