use super::deviation::{angle, angle_between_lines, mirrored};
use super::*;
use crate::math::{Size, Vec3, vec2, vec3};
use crate::surface::Maps;
use std::collections::BTreeSet;

const RADIUS_PX: f32 = 90.0;
const SIZE: Size = Size::new(220, 200);
const CENTER: Vec2 = vec2(110.5, 100.5);

/// A ball before a plate that faces the viewer; a depth jump parts them.
fn ball() -> Arc<Surface> {
    let height = |x: usize, y: usize| {
        let p = (vec2(x as f32 + 0.5, y as f32 + 0.5) - CENTER) / RADIUS_PX;
        let z2 = 1.0 - p.length_squared();
        (z2 > 0.0).then(|| vec3(p.x, -p.y, z2.sqrt()))
    };
    let normals = Plane::from_fn(SIZE, |x, y| height(x, y).unwrap_or(Vec3::Z));
    let depth = Plane::from_fn(SIZE, |x, y| height(x, y).map_or(1.0, |n| 0.5 * (1.0 - n.z)));
    Arc::new(Surface::new(Maps { normals, depth, coverage: Plane::full(SIZE, 255) }).unwrap())
}

fn near(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within, "{found} is not {expected} ± {within}");
}

fn region(kind: RegionKind, at: Vec2, tolerance: f32) -> SurfaceRegion {
    SurfaceRegion { tolerance, ..SurfaceRegion::new(kind, at) }
}

#[test]
fn the_direction_wand_on_a_ball_selects_a_disc_of_radius_r_sin_t() {
    let ball = ball();
    for t in [5.0f32, 15.0, 30.0, 45.0, 60.0] {
        for softness in [0.0, 0.3] {
            let disc =
                SurfaceRegion { softness, ..region(RegionKind::Direction, CENTER, t) }.on(&ball);
            let expected = f64::from(RADIUS_PX * t.to_radians().sin());
            // Softness bends the mean outward or inward as the sphere does; the contour of one half
            // stays.
            let along = |dx: i32, dy: i32| {
                let step = (1..200).find(|&i| disc.at(110 + i * dx, 100 + i * dy) < 128).unwrap();
                let at = |i: i32| f64::from(disc.at(110 + i * dx, 100 + i * dy));
                let crossing =
                    f64::from(step) - (127.5 - at(step)) / (at(step - 1) - at(step)).max(1.0);
                crossing * f64::from(dx * dx + dy * dy).sqrt()
            };
            for way in [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1)] {
                near(along(way.0, way.1), expected, 0.5);
            }
            if softness == 0.0 {
                near((disc.area_px() / std::f64::consts::PI).sqrt(), expected, 0.1);
            }
        }
    }
}

#[test]
fn what_shines_with_the_middle_of_a_ball_is_the_disc_of_half_the_angle() {
    let disc = region(RegionKind::Shine, CENTER, 40.0).on(&ball());
    near(
        (disc.area_px() / std::f64::consts::PI).sqrt(),
        f64::from(RADIUS_PX * 20.0f32.to_radians().sin()),
        0.1,
    );
}

#[test]
fn a_depth_is_selected_on_its_own_side_of_a_jump_or_everywhere() {
    let ball = ball();
    // z = ½ (1 − cos): the cap down to 0.15 ends at sin(acos 0.7) R.
    let cap = region(RegionKind::Depth, CENTER, 0.15).on(&ball);
    near(
        (cap.area_px() / std::f64::consts::PI).sqrt(),
        f64::from(RADIUS_PX) * (1.0f64 - 0.49).sqrt(),
        0.1,
    );
    let plate = region(RegionKind::Direction, vec2(5.0, 5.0), 10.0);
    let there = plate.on(&ball);
    assert_eq!(
        (there.at(3, 3), there.at(110, 100)),
        (255, 0),
        "the ball's middle faces the same way behind a jump"
    );
    let everywhere = SurfaceRegion { contiguous: false, ..plate }.on(&ball);
    assert_eq!((everywhere.at(3, 3), everywhere.at(110, 100)), (255, 255));
}

#[test]
fn an_object_is_all_of_it_and_nothing_else() {
    let ball = ball();
    let found = region(RegionKind::Object, CENTER, 0.0).on(&ball);
    let objects = ball.objects();
    for (x, y) in (0..220).flat_map(|x| (0..200).map(move |y| (x, y))) {
        let expected = if objects.at(x, y) == objects.at(110, 100) { 255 } else { 0 };
        assert_eq!(found.at(x, y), expected, "{x}, {y}");
    }
}

#[test]
fn flows_are_lines_and_a_cylinders_is_its_own_everywhere() {
    let bent = |x: usize| {
        let s = ((x as f32 + 0.5) / 110.0 - 1.0) * 0.9;
        vec3(s, 0.0, (1.0 - s * s).sqrt())
    };
    let normals = Plane::from_fn(SIZE, |x, _| bent(x));
    let depth = normals.map(|n| 1.0 - n.z);
    let cylinder =
        Arc::new(Surface::new(Maps { normals, depth, coverage: Plane::full(SIZE, 255) }).unwrap());
    let all = region(RegionKind::Flow, vec2(60.5, 60.5), 5.0).on(&cylinder);
    near(all.area_px(), 220.0 * 200.0, 0.0);
    near(f64::from(angle_between_lines(Vec2::X, -Vec2::X)), 0.0, 1e-6);
    near(f64::from(angle_between_lines(Vec2::X, Vec2::Y)), 90.0, 1e-6);
}

#[test]
fn the_curvature_of_a_dent_is_not_that_of_a_bump() {
    let wave = |x: usize| vec3(0.6 * (x as f32 * 0.06).cos(), 0.0, 1.0).normalize();
    let normals = Plane::from_fn(SIZE, |x, _| wave(x));
    let maps = Maps { normals, depth: Plane::full(SIZE, 0.5), coverage: Plane::full(SIZE, 255) };
    let waves = Arc::new(Surface::new(maps).unwrap());
    let told = SurfaceRegion {
        contiguous: false,
        ..region(RegionKind::Curvature, vec2(26.5, 100.5), 0.05)
    };
    let found = told.on(&waves);
    assert_eq!((found.at(26, 50), found.at(130, 150)), (255, 255), "the troughs");
    assert_eq!(found.at(78, 100), 0, "a crest");
}

#[test]
fn equations_have_the_values_that_a_hand_computes() {
    near(f64::from(angle(Vec3::Z, Vec3::X)), 90.0, 1e-4);
    near(f64::from(angle(Vec3::Z, -Vec3::Z)), 180.0, 1e-4);
    let tilted = vec3(30.0f32.to_radians().sin(), 0.0, 30.0f32.to_radians().cos());
    near(f64::from(angle(mirrored(tilted), Vec3::Z)), 60.0, 1e-4);
    assert_eq!([share(0.9, 1.0, 0.0), share(1.1, 1.0, 0.0)], [1.0, 0.0]);
    assert_eq!([share(0.5, 1.0, 0.5), share(1.0, 1.0, 0.5), share(1.5, 1.0, 0.5)], [1.0, 0.5, 0.0]);
    assert_eq!([share(f32::NAN, 1.0, 0.5), share(f32::INFINITY, 1.0, 0.5)], [0.0, 0.0]);
}

#[test]
fn a_contiguous_region_is_what_a_walk_over_links_reaches() {
    let ball = ball();
    let told = region(RegionKind::Direction, vec2(60.5, 60.5), 25.0);
    let (found, everywhere) =
        (told.on(&ball), SurfaceRegion { contiguous: false, ..told }.on(&ball));
    let (mut reached, mut ends) = (BTreeSet::new(), vec![(60, 60)]);
    while let Some((x, y)) = ends.pop() {
        if everywhere.at(x, y) == 0 || !reached.insert((x, y)) {
            continue;
        }
        let linked = ball.links_plane().get(x, y).unwrap_or(0);
        let sides =
            [(links::LEFT, -1, 0), (links::RIGHT, 1, 0), (links::UP, 0, -1), (links::DOWN, 0, 1)];
        ends.extend(
            sides.iter().filter(|(bit, ..)| linked & bit != 0).map(|(_, dx, dy)| (x + dx, y + dy)),
        );
    }
    for (x, y) in (0..220).flat_map(|x| (0..200).map(move |y| (x, y))) {
        let expected = if reached.contains(&(x, y)) { everywhere.at(x, y) } else { 0 };
        // Of the faintest pixels bytes say nothing where the walk still goes on.
        assert!(
            found.at(x, y).abs_diff(expected) <= 1,
            "{x}, {y}: {} is not {expected}",
            found.at(x, y)
        );
    }
}

#[test]
fn off_the_surface_there_is_no_region() {
    for at in [vec2(-3.0, 4.0), vec2(f32::NAN, 4.0), vec2(1e30, f32::INFINITY)] {
        assert!(region(RegionKind::Direction, at, 30.0).on(&ball()).is_empty(), "{at}");
    }
}
