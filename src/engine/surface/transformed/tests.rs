use super::*;
use crate::surface::view::from_view;

const SIZE: Size = Size::new(160, 120);

/// Half of an ellipsoid with half axes along the columns of `turn` (image axes, y down), px.
fn ellipsoid(size: Size, middle: Vec2, halves: Vec2, turn: Mat2) -> Surface {
    let depth_px = 50.0;
    let local = |x: usize, y: usize| {
        turn.transpose() * (vec2(x as f32 + 0.5, y as f32 + 0.5) - middle) / halves
    };
    let height = |x: usize, y: usize| (1.0 - local(x, y).length_squared()).max(0.0).sqrt();
    Surface::new(Maps {
        normals: Plane::from_fn(size, |x, y| {
            let nbar = turn * (local(x, y) / halves);
            vec3(nbar.x, -nbar.y, height(x, y) / depth_px).normalize_or_zero()
        }),
        depth: Plane::from_fn(size, |x, y| 1.0 - height(x, y)),
        coverage: Plane::from_fn(
            size,
            |x, y| if local(x, y).length_squared() < 1.0 { 255 } else { 0 },
        ),
    })
    .unwrap()
}

fn egg() -> Arc<Surface> {
    Arc::new(ellipsoid(SIZE, vec2(70.0, 55.0), vec2(60.0, 40.0), Mat2::IDENTITY))
}

/// The same surface, made of nothing.
fn bare(surface: Arc<Surface>) -> Arc<Surface> {
    let mut surface = Arc::try_unwrap(surface).ok().unwrap();
    surface.origin = None;
    Arc::new(surface)
}

/// Degrees between the normals where both are covered and `counts` says so, the largest.
fn farthest(a: &Surface, b: &Surface, counts: impl Fn(usize, usize) -> bool) -> f32 {
    let (w, h) = (a.size().width as usize, a.size().height as usize);
    let both = (0..h).flat_map(|y| (0..w).map(move |x| (x, y)));
    let both =
        both.filter(|&(x, y)| a.coverage(x, y) == 255 && b.coverage(x, y) == 255 && counts(x, y));
    both.map(|(x, y)| a.normal(x, y).angle_between(b.normal(x, y)).to_degrees()).fold(0.0, f32::max)
}

fn values(surface: &Surface) -> Vec<Vec<u32>> {
    let bits = |plane: &Plane<f32>| plane.values().iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    let bytes =
        |plane: &Plane<u8>| plane.values().iter().map(|v| u32::from(*v)).collect::<Vec<_>>();
    let mut all: Vec<_> =
        surface.normal_planes().into_iter().chain([surface.depth_plane()]).map(bits).collect();
    all.extend([surface.coverage_plane(), surface.links_plane()].map(bytes));
    let pixel = |p: &crate::surface::ContourPixel| {
        [p.x as u32, p.y as u32, p.share.to_bits(), p.is_other_on_surface().into()]
    };
    all.push(surface.contours().pixels().iter().flat_map(pixel).collect());
    all
}

#[test]
fn a_turned_map_s_normals_are_those_of_the_turned_object() {
    for (degrees, mirror) in [(30.0, false), (77.0, false), (20.0, true)] {
        let egg = egg();
        let turn = PlaneMap::rotation(degrees, vec2(70.0, 55.0));
        let flip =
            PlaneMap::affine([if mirror { -1.0 } else { 1.0 }, 0.0, 0.0, 1.0, 0.0, 0.0]).unwrap();
        let shift = PlaneMap::translation(vec2(if mirror { 160.0 } else { 20.0 }, 30.0));
        let map = flip.then(&turn).then(&shift);
        let canvas = Size::new(200, 180);
        let found = egg.transformed(canvas, &map).unwrap();
        let affine = map.as_affine().unwrap();
        let expected = ellipsoid(
            canvas,
            affine.transform_point2(vec2(70.0, 55.0)),
            vec2(60.0, 40.0),
            affine.matrix2,
        );
        // At the very rim normals turn by more than that within a pixel.
        let off = farthest(&found, &expected, |x, y| expected.normal(x, y).z > 0.35);
        assert!(off < 0.5, "{degrees}°: {off}° off");
        // The measure can fail: an image of normals that lies as it lay.
        assert!(farthest(&found, &egg.fitted(canvas).unwrap(), |_, _| true) > 10.0);
    }
}

#[test]
fn a_stretched_object_leans_as_its_slopes_say() {
    let stretch = PlaneMap::affine([1.5, 0.0, 0.0, 0.8, 0.0, 0.0]).unwrap();
    let found = egg().transformed(Size::new(240, 96), &stretch).unwrap();
    let k = (1.5f32 * 0.8).sqrt();
    for (x, y) in [(30, 50), (85, 50), (70, 30), (40, 70)] {
        let before = egg().normal(x, y);
        let slope = vec2(before.x, before.y) / before.z;
        let (x, y) = ((x as f32 + 0.5) * 1.5, (y as f32 + 0.5) * 0.8);
        let after = found.normal(x as usize, y as usize);
        let expected = k * slope / vec2(1.5, 0.8);
        assert!(
            (vec2(after.x, after.y) / after.z - expected).length() < 0.03,
            "{after} for {expected}"
        );
    }
    assert!((found.depth_range_px() - egg().depth_range_px() * k).abs() < 0.01);
}

#[test]
fn four_quarter_turns_and_two_mirrors_give_every_value_back() {
    let turn = |canvas: Size| {
        PlaneMap::affine([0.0, -1.0, 1.0, 0.0, 0.0, f64::from(canvas.width)]).unwrap()
    };
    let start = egg();
    let mut here = start.clone();
    for _ in 0..4 {
        let size = here.size();
        here = bare(here.transformed(Size::new(size.height, size.width), &turn(size)).unwrap());
    }
    assert!(values(&here) == values(&start));
    let mirror = PlaneMap::affine([-1.0, 0.0, 0.0, 1.0, 160.0, 0.0]).unwrap();
    let once = bare(start.transformed(SIZE, &mirror).unwrap());
    assert!(values(&once) != values(&start));
    assert_eq!(once.normal(20, 30), start.normal(139, 30) * vec3(-1.0, 1.0, 1.0));
    assert!(values(&bare(once.transformed(SIZE, &mirror).unwrap())) == values(&start));
    let shift = |x: f32, y: f32| PlaneMap::translation(vec2(x, y));
    let there = bare(start.transformed(Size::new(180, 140), &shift(7.0, 9.0)).unwrap());
    assert!(values(&there.transformed(SIZE, &shift(-7.0, -9.0)).unwrap()) == values(&start));
}

#[test]
fn a_surface_that_comes_round_is_the_very_one_it_was() {
    let start = egg();
    let turn = PlaneMap::rotation(10.0, SIZE.center());
    let round = (0..36).fold(start.clone(), |surface, _| surface.transformed(SIZE, &turn).unwrap());
    assert!(Arc::ptr_eq(&round, &start));
    let small =
        start.transformed(Size::new(40, 40), &PlaneMap::translation(vec2(-40.0, -30.0))).unwrap();
    let whole = small.transformed(SIZE, &PlaneMap::translation(vec2(40.0, 30.0))).unwrap();
    assert!(Arc::ptr_eq(&whole, &start), "what a crop took away is there again");
}

#[test]
fn fitted_maps_lie_where_their_map_says() {
    let egg = egg();
    for canvas in [Size::new(80, 80), Size::new(333, 200)] {
        let (fitted, map) = (egg.onto(canvas, None).unwrap(), Surface::fit_map(SIZE, canvas));
        assert!(values(&fitted) == values(&egg.fitted(canvas).unwrap()));
        assert!(values(&egg.onto(canvas, Some(&map)).unwrap()) == values(&fitted));
        let off = farthest(&fitted, &egg.sampled(canvas, &map).unwrap(), |x, y| {
            fitted.normal(x, y).z > 0.3
        });
        assert!(off < 0.2, "{off}°");
    }
}

#[test]
fn the_eye_stays_before_what_it_was_before() {
    let seen =
        Arc::new(Arc::try_unwrap(egg()).ok().unwrap().with_eye(Eye::of_fov(Some(60.0), SIZE)));
    let cut =
        seen.transformed(Size::new(50, 60), &PlaneMap::translation(vec2(-20.0, -10.0))).unwrap();
    assert!((cut.view(10, 10) - seen.view(30, 20)).length() < 1e-6);
    let turn = PlaneMap::affine([0.0, -1.0, 1.0, 0.0, 0.0, 160.0]).unwrap();
    let turned = seen.transformed(Size::new(120, 160), &turn).unwrap();
    let (before, after) = (seen.view(100, 20), turned.view(20, 59));
    assert!((after - vec3(-before.y, before.x, before.z)).length() < 1e-6, "{before} {after}");
    assert!((turned.facing(20, 59) - seen.facing(100, 20)).abs() < 1e-6);
    assert!((from_view(after, Vec3::Z) - after).length() < 1e-5);
}

#[test]
fn nothing_left_and_a_perspective_are_refused() {
    let away = egg().transformed(SIZE, &PlaneMap::translation(vec2(500.0, 0.0)));
    assert_eq!(away.err(), Some(SurfaceError::Empty));
    let corners =
        [(0.0, 0.0), (160.0, 20.0), (150.0, 100.0), (0.0, 120.0)].map(|(x, y)| glam::dvec2(x, y));
    let quad = PlaneMap::quad(SIZE, corners).unwrap();
    assert_eq!(egg().transformed(SIZE, &quad).err(), Some(SurfaceError::Perspective));
}
