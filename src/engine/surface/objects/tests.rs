use super::*;
use crate::math::{Size, Vec3, vec2};
use crate::surface::Maps;

const SIZE: Size = Size::new(120, 80);

/// A plate from column 10 on, a disc of 20 px that floats before its middle, and a fragment of 2 × 2
/// px behind both.
fn plate_and_disc() -> Arc<Surface> {
    plate_and_disc_of(SIZE)
}

fn plate_and_disc_of(size: Size) -> Arc<Surface> {
    let disc =
        |x: usize, y: usize| vec2(x as f32 + 0.5, y as f32 + 0.5).distance(vec2(60.0, 40.0)) < 20.0;
    let fragment = |x: usize, y: usize| (100..102).contains(&x) && (60..62).contains(&y);
    let depth = Plane::from_fn(size, |x, y| match (disc(x, y), fragment(x, y)) {
        (true, _) => 0.2,
        (_, true) => 1.0,
        _ => 0.6,
    });
    let coverage = Plane::from_fn(size, |x, _| if x < 10 { 0 } else { 255 });
    Arc::new(Surface::new(Maps { normals: Plane::full(size, Vec3::Z), depth, coverage }).unwrap())
}

/// While objects are found a worker helps others, whose work may need the same objects.
#[test]
fn workers_that_need_the_objects_at_once_never_wait_for_themselves() {
    use rayon::prelude::*;
    let surface = plate_and_disc_of(Size::new(960, 640));
    let look = || {
        for _ in 0..40 {
            let objects = Objects::new(&surface);
            let count = |_: usize| {
                objects.objects_of_blocks().values().iter().filter(|label| **label > 0).count()
            };
            let counts: Vec<usize> = (0..64).into_par_iter().map(count).collect();
            assert!(counts.iter().all(|count| *count == counts[0]));
        }
    };
    rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap().install(look);
}

#[test]
fn a_disc_before_a_plate_is_an_object_of_its_own_and_a_fragment_is_none() {
    let surface = plate_and_disc();
    let objects = surface.objects();
    assert_eq!(objects.count(), 2);
    let (plate, disc) = (objects.at(15, 5).unwrap(), objects.at(60, 40).unwrap());
    for (x, y) in (0..80).flat_map(|y| (0..120).map(move |x| (x, y))) {
        let in_disc = vec2(x as f32 + 0.5, y as f32 + 0.5).distance(vec2(60.0, 40.0)) < 20.0;
        let expected = if x < 10 { None } else { Some(if in_disc { disc } else { plate }) };
        assert_eq!(objects.at(x, y), expected, "({x}, {y})");
    }
    assert_eq!(objects.rect(disc), Rect::new(40, 20, 80, 60));
    assert_eq!(objects.at(-1, 5), None);
}

#[test]
fn a_ramp_as_high_as_a_cliff_tears_nothing() {
    let depth = Plane::from_fn(SIZE, |x, _| x as f32 / 119.0);
    let normal = Vec3::new(-0.6, 0.0, 0.8);
    let maps = Maps { normals: Plane::full(SIZE, normal), depth, coverage: Plane::full(SIZE, 255) };
    assert_eq!(Surface::new(maps).unwrap().objects().count(), 1);
}

#[test]
fn a_mark_is_bounded_to_what_it_begins_on() {
    let surface = plate_and_disc();
    // On the disc, on the plate, off the surface, off the canvas.
    let points = [(60, 40), (30, 70), (3, 3), (-4, 200)];
    let covered = |bounded: PaintLimit, start: Vec2| {
        let part = bounded.from(Some(&surface), start);
        points.map(|(x, y)| part.coverage(x, y))
    };
    let disc = vec2(60.5, 40.5);
    assert_eq!(covered(PaintLimit::Free, disc), [1.0, 1.0, 1.0, 1.0]);
    assert_eq!(covered(PaintLimit::Surface, disc), [1.0, 1.0, 0.0, 0.0]);
    assert_eq!(covered(PaintLimit::Object, disc), [1.0, 0.0, 0.0, 0.0]);
    assert_eq!(covered(PaintLimit::Object, vec2(30.0, 70.0)), [0.0, 1.0, 0.0, 0.0]);
    for off in [vec2(3.0, 3.0), vec2(f32::NAN, 3.0), vec2(-1e30, f32::INFINITY)] {
        assert_eq!(covered(PaintLimit::Object, off), [0.0, 0.0, 1.0, 1.0], "{off}");
    }
    assert!(PaintLimit::Object.from(None, disc).is_whole());
}
