use super::*;
use crate::math::vec3;
use crate::surface::Maps;
use crate::surface::view::Eye;

pub(super) const SIZE: Size = Size::new(161, 141);
/// A ball: middle, camera space from the middle of the picture plane, px; radius.
pub(super) type Ball = (Vec3, f32);
/// Two side by side.
pub(super) const PAIR: [Ball; 2] = [(vec3(-41.0, 3.0, 0.0), 37.0), (vec3(40.0, -2.0, 6.0), 36.0)];
/// The pair before an eye.
pub(super) const NEAR_PAIR: [Ball; 2] =
    [(vec3(-50.0, 3.0, -250.0), 46.0), (vec3(49.0, -2.0, -242.0), 45.0)];
pub(super) const FOV: f32 = 50.0;

/// How far along a ray the nearest ball is, and its normal there.
fn cast(balls: &[Ball], from: Vec3, toward: Vec3) -> Option<(f32, Vec3)> {
    let meets = balls.iter().filter_map(|&(middle, radius)| {
        let to = from - middle;
        let b = to.dot(toward);
        let under_root = b * b - to.length_squared() + radius * radius;
        let t = -b - under_root.max(0.0).sqrt();
        (under_root > 0.0 && t > 0.01).then(|| (t, (from + toward * t - middle) / radius))
    });
    meets.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Where the view of a point of the picture begins, and where it goes.
fn view(eye: Eye, at: Vec2) -> (Vec3, Vec3) {
    let flat = at - SIZE.center();
    match eye {
        Eye::Afar => (vec3(flat.x, -flat.y, 500.0), Vec3::NEG_Z),
        Eye::At { .. } => (Vec3::ZERO, -eye.direction_to_eye(flat)),
    }
}

/// What a pixel's center shows: the place and the normal.
fn hit_at(balls: &[Ball], eye: Eye, at: Vec2) -> Option<(Vec3, Vec3)> {
    let (from, toward) = view(eye, at);
    cast(balls, from, toward).map(|(t, n)| (from + toward * t, n))
}

pub(super) fn surface(balls: &[Ball], eye: Eye) -> Surface {
    let at = |x: usize, y: usize| hit_at(balls, eye, vec2(x as f32 + 0.5, y as f32 + 0.5));
    let heights = (0..SIZE.area()).filter_map(|i| at(i % 161, i / 161)).map(|(p, _)| p.z);
    let (low, high) = heights.fold((f32::MAX, f32::MIN), |(a, b), z| (a.min(z), b.max(z)));
    let maps = Maps {
        normals: Plane::from_fn(SIZE, |x, y| at(x, y).map_or(Vec3::ZERO, |s| s.1)),
        depth: Plane::from_fn(SIZE, |x, y| {
            at(x, y).map_or(f32::NAN, |s| (high - s.0.z) / (high - low))
        }),
        coverage: Plane::from_fn(SIZE, |x, y| if at(x, y).is_some() { 255 } else { 0 }),
    };
    Surface::new(maps).unwrap().with_eye(eye)
}

/// The ray that a pixel mirrors.
fn mirror_ray(surface: &Surface, map: &RayMap, x: usize, y: usize) -> SurfaceRay {
    let (n, v) = (surface.normal(x, y), surface.view(x, y));
    let (at, nearness) =
        (vec2(x as f32 + 0.5, y as f32 + 0.5), map.nearness_of(surface.depth(x, y)));
    SurfaceRay { at, nearness, direction: 2.0 * n.dot(v) * n - v, inward: false }
}

pub(super) fn covered_pixels(surface: &Surface) -> impl Iterator<Item = (usize, usize)> {
    let at = (0..SIZE.area()).map(|i| (i % 161, i / 161));
    at.filter(|&(x, y)| surface.coverage(x, y) > 0)
}

#[test]
fn rays_between_balls_meet_where_geometry_says() {
    for (balls, eye) in [(PAIR, Eye::Afar), (NEAR_PAIR, Eye::of_fov(Some(FOV), SIZE))] {
        let surface = surface(&balls, eye);
        let map = surface.ray_map();
        let (mut met, mut missed) = (0, 0);
        for (x, y) in covered_pixels(&surface) {
            let ray = mirror_ray(&surface, &map, x, y);
            let (from, n) = hit_at(&balls, eye, ray.at).unwrap();
            let exact = cast(&balls, from + n * 0.05, ray.direction);
            let Some((t, n)) = exact else {
                // Only beside a rim, where a picture of pixels cannot tell.
                missed += usize::from(surface.trace(&map, &ray).is_some());
                continue;
            };
            let place = from + ray.direction * t;
            let (view_from, toward) = view(eye, ray.at);
            // Where the eye sees the place that is met, if nothing hides it.
            let faces_eye =
                -n.dot(if eye == Eye::Afar { toward } else { (place - view_from).normalize() });
            if faces_eye < 0.3 || n.dot(ray.direction) > -0.15 {
                continue;
            }
            let hit = surface
                .trace(&map, &ray)
                .unwrap_or_else(|| panic!("{eye:?} ({x}, {y}) meets nothing"));
            let seen = match eye {
                Eye::Afar => place.truncate(),
                Eye::At { focal_px, .. } => place.truncate() * (focal_px / -place.z),
            };
            let seen = vec2(seen.x, -seen.y) + SIZE.center();
            assert!((hit.at - seen).length() < 1.5, "{eye:?} ({x}, {y}): {}, not {seen}", hit.at);
            assert!(
                (hit.normal - n).length() < 0.06,
                "{eye:?} ({x}, {y}): {}, not {n}",
                hit.normal
            );
            // Seen from near, lengths are those of the mean distance.
            let of_mean = if eye == Eye::Afar { 1.0 } else { hit.length_px / t };
            assert!(
                (0.5..1.5).contains(&of_mean) && (hit.length_px / of_mean - t).abs() < 2.5,
                "{} {t}",
                hit.length_px
            );
            met += 1;
        }
        assert!(met > 150 && missed < 40, "{eye:?}: {met} met, {missed} should not have");
    }
}

#[test]
fn jumping_over_blocks_changes_no_ray() {
    let bumps = |x: f32, y: f32| 9.0 * (x * 0.21).sin() + 11.0 * (y * 0.17 + x * 0.05).cos();
    let normals = Plane::from_fn(SIZE, |x, y| {
        let (x, y) = (x as f32, y as f32);
        let slope = |dx: f32, dy: f32| (bumps(x + dx, y + dy) - bumps(x - dx, y - dy)) / 0.2;
        vec3(-slope(0.1, 0.0), slope(0.0, 0.1), 1.0)
    });
    let depth = Plane::from_fn(SIZE, |x, y| (20.0 - bumps(x as f32, y as f32)) / 40.0);
    let coverage = Plane::from_fn(SIZE, |x, y| if (x / 30 + y / 40) % 4 == 0 { 0 } else { 255 });
    for eye in [Eye::Afar, Eye::of_fov(Some(FOV), SIZE)] {
        let (normals, depth, coverage) = (normals.clone(), depth.clone(), coverage.clone());
        let surface = Surface::new(Maps { normals, depth, coverage }).unwrap().with_eye(eye);
        let map = surface.ray_map();
        let mut every_pixel = RayMap::of(&surface);
        every_pixel.blocks = BLOCKS.map(|side| Plane::full(blocks_of(SIZE, side), -NOWHERE));
        let (mut met, mut jumped) = (0, 0);
        for (x, y) in covered_pixels(&surface) {
            for turn in 0..3 {
                let mut ray = mirror_ray(&surface, &map, x, y);
                let (sin, cos) = (2.1 * turn as f32).sin_cos();
                let r = ray.direction;
                ray.direction = vec3(
                    r.x * cos - r.y * sin,
                    r.x * sin + r.y * cos,
                    r.z * (1.0 - 0.4 * turn as f32),
                );
                ray.direction = ray.direction.normalize_or(Vec3::Z);
                ray.inward = turn == 2;
                let [a, b] = [&*map, &every_pixel]
                    .map(|map| surface.trace(map, &ray).map(|hit| (hit.at, hit.normal)));
                assert_eq!(a, b, "({x}, {y}) turn {turn}");
                met += usize::from(a.is_some());
                let line = RayLine::of(&map, &ray);
                jumped += usize::from(
                    line.is_some_and(|line| line.steps > 0 && map.step_out_of_block(&line, 1).1),
                );
            }
        }
        assert!(met > 2000 && jumped > 300, "{met} {jumped}");
    }
}

#[test]
fn planes_and_single_balls_are_never_met() {
    let ball = surface(&PAIR[..1], Eye::Afar);
    let plane = |slope: Vec2| {
        let depth =
            Plane::from_fn(SIZE, |x, y| 0.5 + (x as f32 * slope.x + y as f32 * slope.y) / 2000.0);
        // As coarse as a file of bytes has it.
        let depth = depth.map(|z| (z * 255.0).round() / 255.0);
        let normals = Plane::full(SIZE, vec3(slope.x, -slope.y, 1.0));
        Surface::new(Maps { normals, depth, coverage: Plane::full(SIZE, 255) }).unwrap()
    };
    for surface in [ball, plane(vec2(0.0, 0.0)), plane(vec2(1.2, 0.0)), plane(vec2(-0.6, 2.0))] {
        let map = surface.ray_map();
        for (x, y) in covered_pixels(&surface) {
            let ray = mirror_ray(&surface, &map, x, y);
            assert!(surface.trace(&map, &ray).is_none(), "({x}, {y})");
        }
    }
}

#[test]
fn a_ray_passes_behind_what_floats_in_front_and_meets_what_lies_beyond() {
    // Ground, a slab that floats in front of it, and a slope.
    let height = |x: usize| match x {
        60..100 => 90.0,
        120.. => x as f32 - 120.0,
        _ => 0.0,
    };
    let depth = Plane::from_fn(SIZE, |x, _| (90.0 - height(x)) / 90.0);
    let normals =
        Plane::from_fn(SIZE, |x, _| if x >= 120 { vec3(-1.0, 0.0, 1.0) } else { Vec3::Z });
    let surface = Surface::new(Maps { normals, depth, coverage: Plane::full(SIZE, 255) }).unwrap();
    let map = surface.ray_map();
    let nearness = map.nearness_of(surface.depth(20, 70));
    let leaving = |direction: Vec3, inward: bool| {
        let ray =
            SurfaceRay { at: vec2(20.5, 70.5), nearness, direction: direction.normalize(), inward };
        surface.trace(&map, &ray)
    };
    let hit = leaving(vec3(1.0, 0.0, 0.1), false).unwrap();
    // ¹⁄₁₀ (x − 20.5) = x − 120.5.
    assert!((hit.at - vec2(131.6, 70.5)).length() < 1.0, "{hit:?}");
    assert!(hit.normal.distance(vec3(-1.0, 0.0, 1.0).normalize()) < 1e-3);
    assert!((hit.length_px - 111.1 * 1.01f32.sqrt()).abs() < 1.5, "{hit:?}");
    assert!(leaving(vec3(1.0, 0.0, -0.1), true).is_none(), "below the ground nothing is seen");
    assert!(leaving(vec3(-1.0, 0.0, 0.3), false).is_none(), "it leaves the picture");
    assert!(leaving(Vec3::Z, false).is_none() && leaving(Vec3::NEG_Z, true).is_none());
    assert!(leaving(vec3(f32::NAN, 0.0, 1.0), false).is_none());
}
