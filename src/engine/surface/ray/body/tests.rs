use super::*;
use crate::math::Size;
use crate::surface::Maps;
use crate::surface::ray::tests::{FOV, PAIR, SIZE, covered_pixels, surface};
use crate::surface::view::Eye;

/// A slope that rises by `rise` px a px toward the right, all over a picture.
fn slope(rise: f32) -> Surface {
    let size = Size::new(96, 64);
    let height = |x: usize| rise * (x as f32 + 0.5);
    let highest = height(95);
    let maps = Maps {
        normals: Plane::full(size, vec3(-rise, 0.0, 1.0).normalize()),
        depth: Plane::from_fn(size, |x, _| (highest - height(x)) / highest),
        coverage: Plane::full(size, 255),
    };
    Surface::new(maps).unwrap()
}

fn ray_at(
    surface: &Surface,
    body: &SolidBody,
    (x, y): (usize, usize),
    direction: Vec3,
) -> InnerRay {
    InnerRay {
        at: vec2(x as f32 + 0.5, y as f32 + 0.5),
        nearness: body.nearness_of(surface.depth(x, y)),
        direction,
        from: BodySide::Front,
    }
}

#[test]
fn a_ball_is_as_thick_as_it_is_wide() {
    let surface = surface(&PAIR, Eye::Afar);
    for (bulge, share) in [(0.0, 1.0), (1.0, 2.0)] {
        let body = surface.body(bulge);
        for (middle, radius) in PAIR {
            let (x, y) =
                ((SIZE.center().x + middle.x) as usize, (SIZE.center().y - middle.y) as usize);
            let hit = body.trace(&surface, &ray_at(&surface, &body, (x, y), Vec3::NEG_Z));
            // The outline is at the height of the last pixel's center, √r px above the rim.
            assert!(
                (hit.length_px - share * radius).abs() < 0.2 * share * radius,
                "{bulge}: {hit:?}"
            );
            assert_eq!(hit.side, BodySide::Back);
            assert!((hit.normal - Vec3::NEG_Z).length() < 0.1, "{bulge}: {hit:?}");
        }
    }
}

#[test]
fn the_back_of_a_slope_is_flat_where_it_is_lowest() {
    let surface = slope(0.25);
    let body = surface.body(0.0);
    for r in [Vec3::NEG_Z, vec3(0.3, 0.2, -0.9).normalize()] {
        let hit = body.trace(&surface, &ray_at(&surface, &body, (40, 30), r));
        let deep = 0.25 * 40.0;
        assert!((hit.length_px - deep / -r.z).abs() < 0.1, "{r}: {hit:?}");
        assert!((hit.normal - Vec3::NEG_Z).length() < 1e-3, "{r}: {hit:?}");
        let aside = vec2(r.x, -r.y) * hit.length_px;
        assert!((hit.at - vec2(40.5, 30.5) - aside).length() < 1e-3, "{r}: {hit:?}");
    }
}

#[test]
fn rays_aside_leave_at_the_front_or_the_rim_and_never_get_lost() {
    for (balls, eye) in
        [(PAIR, Eye::Afar), (super::super::tests::NEAR_PAIR, Eye::of_fov(Some(FOV), SIZE))]
    {
        let surface = surface(&balls, eye);
        let body = surface.body(0.5);
        let mut sides = [0; 3];
        for at in covered_pixels(&surface) {
            for r in [vec3(1.0, 0.0, -0.1), vec3(-0.4, 0.8, -0.4), vec3(0.0, 0.1, -1.0)] {
                let r = r.normalize();
                let hit = body.trace(&surface, &ray_at(&surface, &body, at, r));
                assert!(
                    hit.normal.dot(r) > 0.0 && (hit.normal.length() - 1.0).abs() < 1e-4,
                    "{hit:?}"
                );
                assert!(
                    hit.length_px >= 0.0 && hit.length_px < 4.0 * SIZE.longer_side(),
                    "{hit:?}"
                );
                sides[hit.side as usize] += 1;
            }
        }
        assert!(sides.iter().all(|&n| n > 100), "{sides:?}");
    }
}

#[test]
fn a_body_seen_from_nearby_has_its_back_behind_it() {
    let balls = [(vec3(0.0, 0.0, -250.0), 60.0)];
    let surface = surface(&balls, Eye::of_fov(Some(FOV), SIZE));
    let body = surface.body(1.0);
    let (x, y) = (SIZE.width as usize / 2, SIZE.height as usize / 2);
    let hit = body.trace(&surface, &ray_at(&surface, &body, (x, y), Vec3::NEG_Z));
    assert_eq!(hit.side, BodySide::Back);
    assert!((hit.normal - Vec3::NEG_Z).length() < 0.1, "{hit:?}");
    assert!(hit.length_px > 60.0 && hit.length_px < 160.0, "{hit:?}");
}
