use super::*;
use crate::math::{Size, Vec3, vec3};
use crate::surface::Maps;

const SIZE: Size = Size::new(161, 161);

/// A surface with a given height toward the viewer, px, its normals from the height; `None` is no
/// surface.
fn relief(height: impl Fn(f32, f32) -> Option<f32> + Sync) -> Surface {
    let at = |x: usize, y: usize| height(x as f32 - 80.0, y as f32 - 80.0);
    let normals = Plane::from_fn(SIZE, |x, y| {
        let Some(here) = at(x, y) else { return Vec3::ZERO };
        let (x, y) = (x as f32 - 80.0, y as f32 - 80.0);
        let beside = |dx: f32, dy: f32| height(x + dx, y + dy).unwrap_or(here);
        let step = |dx: f32, dy: f32| (beside(dx, dy) - beside(-dx, -dy)) / 0.02;
        vec3(-step(0.01, 0.0), step(0.0, 0.01), 1.0)
    });
    let values = || (0..161 * 161).filter_map(|i| at(i % 161, i / 161));
    let (low, high) = values().fold((f32::MAX, f32::MIN), |(l, h), v| (l.min(v), h.max(v)));
    let range = (high - low).max(1.0);
    let depth = Plane::from_fn(SIZE, |x, y| at(x, y).map_or(f32::NAN, |h| (high - h) / range));
    let coverage = Plane::from_fn(SIZE, |x, y| if at(x, y).is_some() { 255 } else { 0 });
    Surface::new(Maps { normals, depth, coverage }).unwrap()
}

#[test]
fn open_ground_is_wholly_open_however_it_leans() {
    for (a, b) in [(0.0, 0.0), (0.3, -0.2), (-1.7, 1.1)] {
        let open = relief(|x, y| Some(a * x + b * y)).occlusion(40.0);
        assert!(open.values().iter().all(|&a| a > 0.999), "{a} {b}");
    }
}

#[test]
fn convex_ground_is_open_to_its_silhouette() {
    let ball = |x: f32, y: f32| {
        let rest = 60.0f32.powi(2) - x * x - y * y;
        (rest > 0.0).then(|| rest.sqrt())
    };
    let surface = relief(ball);
    let open = surface.occlusion(40.0);
    for (i, &a) in open.values().iter().enumerate() {
        assert!(a > 0.97, "{a} at {}, {}", i % 161, i / 161);
    }
}

#[test]
fn the_bottom_of_a_valley_sees_what_its_walls_leave() {
    // Walls at 45°: the horizon in direction φ has tan e = |cos φ|; the mean of cos² e over all
    // directions is 1/√2.
    let open = rows::compute(&relief(|x, _| Some(x.abs())), &HorizonSlices::new(1000.0));
    assert!((open.at(80, 80) - 0.5f32.sqrt()).abs() < 0.02, "{}", open.at(80, 80));
}

#[test]
fn a_pit_is_darkest_in_its_middle() {
    // A cone of tan e = 1 all around: cos² e = ½.
    let open =
        rows::compute(&relief(|x, y| Some(x.hypot(y).min(60.0))), &HorizonSlices::new(1000.0));
    assert!((open.at(80, 80) - 0.5).abs() < 0.03, "{}", open.at(80, 80));
}

#[test]
fn what_floats_far_in_front_throws_no_shade() {
    let high = |x: f32, y: f32| if x.hypot(y) < 25.0 { 100.0 } else { 0.0 };
    let open = relief(move |x, y| Some(high(x, y))).occlusion(40.0);
    assert!(
        open.values().iter().all(|&a| a > 0.999),
        "{:?}",
        open.values().iter().copied().fold(1.0, f32::min)
    );
}

#[test]
fn rows_hold_what_a_pixel_alone_sees() {
    let height = |x: f32, y: f32| {
        Some(14.0 * (x * 0.11).sin() * (y * 0.07).cos() + if x > 30.0 { 8.0 } else { 0.0 })
    };
    let surface = relief(height);
    let ways = HorizonSlices::new(24.0);
    let fast = rows::compute(&surface, &ways);
    let range = surface.depth_range_px();
    for (x, y) in [(3, 4), (80, 80), (111, 60), (108, 23), (160, 160), (64, 127)] {
        let slope = slope(&surface, x, y);
        let (mut open, mut whole) = (0.0, 0.0);
        for slice in &ways.slices {
            let toward = slice[0].toward;
            let tangent = tangents(
                slope.dot(toward),
                surface.nbar(x, y).dot(toward),
                surface.normal(x, y).z.max(0.0),
            );
            let mut horizons = tangent;
            for (side, way) in slice.iter().enumerate() {
                let (mut before, mut cliffs, mut hidden) = (0.0, 0.0, 0.0f32);
                for step in &way.steps {
                    let height = |(dx, dy): (i32, i32)| {
                        surface
                            .depth_plane()
                            .get(x as i32 + dx, y as i32 + dy)
                            .map_or(-1e6, |z| -z * range)
                    };
                    let (near, far) = (height(step.near), height(step.far));
                    let there = height_between(near, far, step.between);
                    let rise = there + surface.depth(x, y) * range;
                    cliffs += (rise - before - step.cliff_px).max(0.0);
                    before = rise;
                    let space = step.distance_px.hypot(rise);
                    let away = (space / 24.0).powi(2);
                    hidden =
                        hidden.max(excess(rise / space - tangent[side], away, cliffs, 1.0 / 12.0));
                }
                horizons[side] += hidden;
            }
            whole += open_part(-slope.dot(toward), 1.0, tangent);
            open += open_part(-slope.dot(toward), 1.0, horizons);
        }
        assert!(
            (fast.at(x, y) - open / whole).abs() < 1e-3,
            "{x} {y}: {} {}",
            fast.at(x, y),
            open / whole
        );
    }
}

#[test]
fn slopes_side_by_side_are_those_of_each_pixel() {
    let surface = relief(|x, y| {
        (x.hypot(y - 40.0) > 9.0).then(|| 14.0 * (x * 0.11).sin() * (y * 0.07).cos())
    });
    let ways = HorizonSlices::new(24.0);
    for y in 0..161 {
        for (x0, width) in [(0, 64), (64, 64), (128, 33)] {
            let found = rows::slopes(&surface, &ways, (x0, y), width);
            for (i, found) in found.into_iter().enumerate() {
                let expected = slope(&surface, x0 + i, y);
                assert_eq!(
                    found.to_array().map(f32::to_bits),
                    expected.to_array().map(f32::to_bits),
                    "{} {y}",
                    x0 + i
                );
            }
        }
    }
}

#[test]
fn a_place_that_its_rise_rules_out_hides_nothing() {
    for i in 0..4000u32 {
        let tangent = 2.0 * crate::math::hash::unit(1, i, 0) - 1.0;
        let distance = 1.0 + 60.0 * crate::math::hash::unit(1, i, 1);
        let exact = tangent / (1.0 - tangent * tangent).max(1e-9).sqrt() * distance;
        for rise in [exact * 0.9999, exact, exact * 1.00001, exact + 1e-3, exact - 1e-3] {
            if rise <= distance * rows::steepness(tangent) {
                let above = rise / (distance * distance + rise * rise).sqrt() - tangent;
                assert!(above <= 0.0, "tangent {tangent}, rise {rise} at {distance}: {above}");
            }
        }
    }
}

#[test]
fn smoothing_evens_steps_out_but_stops_at_a_depth_jump() {
    let surface = relief(|x, _| Some(if x < 0.0 { 0.0 } else { 60.0 }));
    let stripes =
        Plane::from_fn(SIZE, |x, y| if x < 80 { 0.2 } else { 0.8 + 0.1 * (y % 2) as f32 });
    let even = rows::smooth(&surface, &stripes);
    assert!((even.at(79, 80) - 0.2).abs() < 1e-6, "{}", even.at(79, 80));
    assert!((even.at(80, 80) - 0.85).abs() < 1e-6, "{}", even.at(80, 80));
}

#[test]
fn senseless_radii_are_bounded_and_asking_again_costs_nothing() {
    let surface = relief(|x, _| Some(x.abs()));
    for radius in [f32::NAN, -3.0, 0.0] {
        assert!(surface.occlusion(radius).values().iter().all(|a| (0.0..=1.0).contains(a)));
    }
    assert!(Arc::ptr_eq(&surface.occlusion(9.0), &surface.occlusion(9.0)));
}
