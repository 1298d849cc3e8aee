use super::*;
use crate::math::vec3;

/// A plate tilted to the right over the left half, before a far wall over the right half.
fn plate_and_wall(size: Size) -> Surface {
    let left = |x: usize| x < size.width as usize / 2;
    Surface::new(Maps {
        normals: Plane::from_fn(size, |x, _| if left(x) { vec3(0.0, 0.6, 0.8) } else { Vec3::Z }),
        depth: Plane::from_fn(size, |x, _| if left(x) { 0.0 } else { 1.0 }),
        coverage: Plane::full(size, 255),
    })
    .unwrap()
}

#[test]
fn the_same_size_keeps_every_value() {
    let a = plate_and_wall(Size::new(8, 6));
    let b = a.fitted(a.size()).unwrap();
    assert_eq!(a.depth_plane(), b.depth_plane());
    assert_eq!(a.coverage_plane(), b.coverage_plane());
    for y in 0..6 {
        for x in 0..8 {
            assert!((a.normal(x, y) - b.normal(x, y)).length() < 1e-6);
        }
    }
}

#[test]
fn a_wide_map_on_a_square_canvas_stands_centerd_with_its_aspect() {
    let s = plate_and_wall(Size::new(8, 4)).fitted(Size::new(16, 16)).unwrap();
    assert_eq!(
        (s.coverage(8, 3), s.coverage(8, 4), s.coverage(8, 11), s.coverage(8, 12)),
        (0, 255, 255, 0)
    );
}

#[test]
fn no_new_pixel_mixes_the_two_sides_of_a_depth_jump() {
    for size in [Size::new(7, 5), Size::new(30, 20)] {
        let s = plate_and_wall(Size::new(10, 8)).stretched(size).unwrap();
        for &z in s.depth_plane().values() {
            assert!(z.min(1.0 - z) < 1e-6, "{z}");
        }
    }
}

/// A ball with a hard mask, or one of shades (64 samples a pixel).
fn ball(side: usize, is_shaded: bool) -> Surface {
    let (middle, radius) = (vec2(0.503, 0.497) * side as f32, 0.37 * side as f32);
    let size = Size::new(side as u32, side as u32);
    let off = |x: f32, y: f32| (vec2(x, y) - middle) / radius;
    let height = |p: Vec2| (1.0 - p.length_squared()).max(0.0).sqrt();
    let at = |x: usize, y: usize| off(x as f32 + 0.5, y as f32 + 0.5);
    let shade = |x: usize, y: usize| {
        let sample = |k: i32| ((k % 8) as f32 / 8.0 + 0.0625, (k / 8) as f32 / 8.0 + 0.0625);
        let inside = |k: &i32| off(x as f32 + sample(*k).0, y as f32 + sample(*k).1).length() < 1.0;
        ((0..64).filter(inside).count() as f32 * 255.0 / 64.0).round() as u8
    };
    let hard = |x: usize, y: usize| if at(x, y).length() < 1.0 { 255 } else { 0 };
    Surface::new(Maps {
        normals: Plane::from_fn(size, |x, y| {
            vec3(at(x, y).x, -at(x, y).y, height(at(x, y)).max(0.01))
        }),
        depth: Plane::from_fn(size, |x, y| 1.0 - height(at(x, y))),
        coverage: Plane::from_fn(size, |x, y| if is_shaded { shade(x, y) } else { hard(x, y) }),
    })
    .unwrap()
}

#[test]
fn a_rim_of_shades_covers_as_much_at_any_larger_size() {
    let small = ball(60, true);
    for factor in [2u32, 3, 4] {
        let large = small.stretched(Size::new(60 * factor, 60 * factor)).unwrap();
        for (x, y) in (0..3600).map(|i| (i % 60, i / 60)) {
            let of = |k: u32| {
                (
                    x * factor as usize + (k % factor) as usize,
                    y * factor as usize + (k / factor) as usize,
                )
            };
            let sum: f32 =
                (0..factor * factor).map(of).map(|(x, y)| f32::from(large.coverage(x, y))).sum();
            let (mean, told) = (sum / (factor * factor) as f32, f32::from(small.coverage(x, y)));
            assert!((mean - told).abs() < 1.25, "{factor} times, {x}, {y}: {mean} of {told}");
        }
    }
}

#[test]
fn a_larger_outline_is_as_smooth_as_one_drawn_at_that_size() {
    for is_shaded in [false, true] {
        for factor in [1.5f32, 2.0, 4.0] {
            let small = ball(60, is_shaded);
            let large = small.stretched(small.size().scaled(factor)).unwrap();
            let exact = ball((60.0 * factor) as usize, true);
            let [found, exact] = [&large, &exact].map(|surface| surface.coverage_plane().values());
            let pairs =
                found.iter().zip(exact).filter(|(a, b)| !(**a == **b && (**a == 0 || **a == 255)));
            let off: Vec<f32> = pairs.map(|(a, b)| f32::from(a.abs_diff(*b)) / 255.0).collect();
            let mean = off.iter().sum::<f32>() / off.len() as f32;
            assert!(mean < 0.06, "{factor} times, shades {is_shaded}: {mean}");
        }
    }
}

#[test]
fn beside_the_surface_a_larger_map_reads_what_the_smaller_one_does() {
    for is_shaded in [false, true] {
        let small = ball(60, is_shaded);
        let large = small.stretched(Size::new(120, 120)).unwrap();
        let bare =
            (0..14400).map(|i| (i % 120, i / 120)).filter(|&(x, y)| large.coverage(x, y) == 0);
        for (x, y) in bare {
            assert_eq!(large.normal(x, y), small.normal(x / 2, y / 2), "{x}, {y}");
            assert_eq!(large.depth(x, y), small.depth(x / 2, y / 2), "{x}, {y}");
        }
    }
}

#[test]
fn a_crease_stays_one_between_two_planes() {
    let size = Size::new(40, 30);
    let left = |x: usize, y: usize| (x as f32) < 19.3 + 0.31 * y as f32;
    let slope = 0.6 / 0.8;
    let roof = Surface::new(Maps {
        normals: Plane::from_fn(size, |x, y| {
            if left(x, y) { vec3(-0.6, 0.0, 0.8) } else { vec3(0.6, 0.186, 0.8).normalize() }
        }),
        depth: Plane::from_fn(size, |x, y| {
            0.5 + slope * (x as f32 - 19.8 - 0.31 * y as f32).abs() / 60.0
        }),
        coverage: Plane::full(size, 255),
    })
    .unwrap();
    let large = roof.stretched(Size::new(80, 60)).unwrap();
    let mixed = (0..4800).filter(|i| {
        let n = large.normal(i % 80, i / 80);
        (n - vec3(-0.6, 0.0, 0.8)).length() > 0.02
            && (n - vec3(0.6, 0.186, 0.8).normalize()).length() > 0.02
    });
    let mixed = mixed.count();
    assert!(mixed < 6, "{mixed} normals lie between both planes'");
}

#[test]
fn bumps_keep_most_of_their_slope_in_a_larger_map() {
    let size = Size::new(48, 48);
    // Along one axis, 6 px long; depth as the normals say.
    let slope = |x: usize| 0.2 * (1.047 * (x as f32 + 0.5)).sin();
    let height = |x: usize| -0.2 / 1.047 * (1.047 * (x as f32 + 0.5)).cos();
    let bumpy = Surface::new(Maps {
        normals: Plane::from_fn(size, |x, _| vec3(slope(x), 0.0, 1.0).normalize()),
        depth: Plane::from_fn(size, |x, _| 0.5 + height(x) / 48.0),
        coverage: Plane::full(size, 255),
    })
    .unwrap();
    assert_eq!(bumpy.contours().pixels().len(), 0);
    for factor in [2usize, 3, 4] {
        let side = 48 * factor as u32;
        let large = bumpy.stretched(Size::new(side, side)).unwrap();
        let (mut lost, mut all) = (0.0, 0.0);
        for x in 4..44 {
            let parts = (0..factor).map(|i| large.nbar(x * factor + i, 24 * factor).x);
            let own = bumpy.nbar(x, 24).x;
            lost += (own - parts.sum::<f32>() / factor as f32).abs();
            all += own.abs();
        }
        // Interpolated between two pixels, an eighth would be lost.
        assert!(lost < 0.06 * all, "{factor} times: {}", lost / all);
    }
}
