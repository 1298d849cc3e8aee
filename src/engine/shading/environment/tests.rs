use super::*;
use crate::math::{Size, hash};
use projection::lat_long_direction;

fn lat_long(width: u32, height: u32, light: impl Fn(Vec3) -> Vec3) -> Environment {
    let texel = |i: u32| {
        let e = lat_long_direction(
            ((i % width) as f32 + 0.5) / width as f32,
            ((i / width) as f32 + 0.5) / height as f32,
        );
        light(e).extend(1.0).to_array()
    };
    let texels = (0..width * height).map(texel).collect();
    Environment::new(String::new(), Picture::linear(Size::new(width, height), texels).unwrap())
}

/// Smooth, and different everywhere.
fn sky(e: Vec3) -> Vec3 {
    vec3(1.0 + e.y, 1.0 + 0.7 * e.x, 1.0 - 0.4 * e.z + 0.3 * e.x * e.y)
}

fn directions() -> impl Iterator<Item = Vec3> {
    (0..400).map(|i| projection::spread(i, 400))
}

/// Spread so that many fall near the poles and the wrap.
fn random_direction(i: u32) -> Vec3 {
    lat_long_direction(hash::unit(1, i, 0), hash::unit(2, i, 0))
}

#[test]
fn light_comes_from_where_it_stands_turned_and_exposed() {
    let mut environment = lat_long(256, 128, sky);
    for d in directions() {
        assert!(
            (environment.environment_light().radiance(d) - sky(d)).abs().max_element() < 0.02,
            "{d}"
        );
    }
    environment.rotation = 90.0;
    environment.exposure = 1.0;
    // R_y(90°) takes +z to +x.
    let found = environment.environment_light().radiance(Vec3::Z);
    assert!((found - 2.0 * sky(Vec3::X)).abs().max_element() < 0.02, "{found}");
}

#[test]
fn the_same_light_is_found_whatever_the_projection() {
    for projection in [Projection::Angular, Projection::MirrorBall] {
        let side = 257;
        let texel = |i: u32| {
            let p = vec3((i % side) as f32, (i / side) as f32, 0.0) + 0.5;
            let (x, y) = (2.0 * p.x / side as f32 - 1.0, 1.0 - 2.0 * p.y / side as f32);
            let r = x.hypot(y);
            let e = match projection {
                // Beyond the disc is a color that must never show.
                _ if r > 1.0 => return [9e3, 9e3, 9e3, 1.0],
                Projection::Angular => {
                    let (sin, cos) = (r * std::f32::consts::PI).sin_cos();
                    vec3(x / r.max(1e-9) * sin, y / r.max(1e-9) * sin, cos)
                }
                _ => {
                    let n = vec3(x, y, (1.0 - r * r).sqrt());
                    2.0 * n.z * n - Vec3::Z
                }
            };
            sky(e).extend(1.0).to_array()
        };
        let picture =
            Picture::linear(Size::new(side, side), (0..side * side).map(texel).collect()).unwrap();
        let environment = Environment { projection, ..Environment::new(String::new(), picture) };
        let seen = environment.environment_light();
        assert!(seen.brightest() < 3.0);
        for d in directions().chain([Vec3::NEG_Z]) {
            let tolerance = if d.z < -0.97 { 0.2 } else { 0.04 };
            assert!(
                (seen.radiance(d) - sky(d)).abs().max_element() < tolerance,
                "{projection:?} {d} {}",
                seen.radiance(d)
            );
            let blurred = seen.mean_over_cone(d, 0.1);
            assert!(
                (blurred - sky(d)).abs().max_element() < tolerance,
                "{projection:?} {d} {blurred}"
            );
        }
    }
}

#[test]
fn wide_footprints_see_the_mean() {
    let checks = |e: Vec3| {
        let place = Projection::LatLong.place(e) * 64.0;
        Vec3::splat(((place.x as i32 + place.y as i32) % 2) as f32)
    };
    let seen = lat_long(512, 256, checks).environment_light();
    for i in 0..300 {
        let d = random_direction(i);
        let (a, b) = d.any_orthonormal_pair();
        let found = seen.mean_over_pixel(d, a * 0.6, b * 0.6).x;
        assert!((found - 0.5).abs() < 0.1, "{d}: {found}");
    }
    assert_eq!(seen.mean_over_pixel(Vec3::X, Vec3::ZERO, Vec3::ZERO), seen.radiance(Vec3::X));
    assert_eq!(seen.brightest(), 1.0);
}

#[test]
fn neither_the_wrap_nor_the_poles_can_be_seen() {
    // Noise, so that any irregularity shows.
    let texels = (0..256 * 128).map(|i| [hash::unit(5, i, 0), 0.0, 0.0, 1.0]).collect();
    let seen =
        Environment::new(String::new(), Picture::linear(Size::new(256, 128), texels).unwrap())
            .environment_light();
    let step = 1e-3;
    for width in [0.05, 0.15, 0.4] {
        // The steepest change of the blurred light, in units of the blur: the same everywhere.
        let steepest = |at: &dyn Fn(f32) -> Vec3| {
            (0..2000).map(|i| i as f32 * step).fold(0.0f32, |most, t| {
                let change = seen.mean_over_cone(at(t), width).x
                    - seen.mean_over_cone(at(t + step), width).x;
                most.max(change.abs() * width / step)
            })
        };
        let elsewhere = steepest(&|t| vec3((1.0 + t).sin(), 0.2, (1.0 + t).cos()).normalize());
        let over_the_wrap = steepest(&|t| vec3((t - 1.0).sin(), 0.2, -(t - 1.0).cos()).normalize());
        let over_the_pole = steepest(&|t| vec3((t - 1.0).sin(), (t - 1.0).cos(), 0.01).normalize());
        let beside_the_pole =
            steepest(&|t| vec3(0.03 * (t * 3.0).sin(), 1.0, 0.03 * (t * 3.0).cos()).normalize());
        for found in [over_the_wrap, over_the_pole, beside_the_pole] {
            assert!(found < 2.0 * elsewhere + 0.01, "{width}: {found} {elsewhere}");
        }
    }
}

#[test]
fn the_small_map_is_the_sum_over_every_texel() {
    // A sun, 3° across and 400 times as bright, in a sky over dark ground.
    let sun = vec3(0.5, 0.6, 0.62).normalize();
    let light = |e: Vec3| {
        let sun = if e.dot(sun) > 0.9986 { 400.0 } else { 0.0 };
        sky(e) * if e.y > 0.0 { 1.0 } else { 0.2 } + sun
    };
    let (w, h) = (512, 256);
    let environment = lat_long(w, h, light);
    let seen = environment.environment_light();
    let mut worst = 0.0f32;
    for i in 0..40 {
        let n = random_direction(i);
        let (mut sum, mut weights) = (Vec3::ZERO, 0.0);
        for row in 0..h {
            let edge = |row: u32| (row as f32 / h as f32 * std::f32::consts::PI).cos();
            for column in 0..w {
                let e = lat_long_direction(
                    (column as f32 + 0.5) / w as f32,
                    (row as f32 + 0.5) / h as f32,
                );
                let weight = e.dot(n).max(0.0) * (edge(row) - edge(row + 1));
                let [r, g, b, _] = environment.picture.linear_at(column as usize, row as usize);
                sum += vec3(r, g, b) * weight;
                weights += weight;
            }
        }
        worst =
            worst.max((seen.matt(n) - sum / weights).abs().max_element() / seen.brightest_matt());
    }
    assert!(worst < 2e-3, "{worst}");
}

#[test]
fn rows_read_the_same_bits_as_single_pixels() {
    for (projection, _) in Projection::ALL {
        let texels =
            (0..200 * 100).map(|i| [hash::unit(5, i, 0), hash::unit(6, i, 0), 0.1, 1.0]).collect();
        let picture = Picture::linear(Size::new(200, 100), texels).unwrap();
        let environment = Environment {
            projection,
            rotation: 40.0,
            exposure: 0.7,
            ..Environment::new(String::new(), picture)
        };
        let seen = environment.environment_light();
        let row = |of: &dyn Fn(u32) -> Vec3| -> Directions {
            std::array::from_fn(|c| std::array::from_fn(|x| of(x as u32).to_array()[c]))
        };
        // Footprints from a thousandth of a texel to a hemisphere, round and stretched.
        let size = |x: u32, way: u32| 4f32.powf(hash::unit(way, x, 7) * 9.0 - 8.0);
        let e = |x| random_direction(x);
        let dx = |x: u32| random_direction(x + 100) * size(x, 1);
        let dy = |x: u32| {
            if x.is_multiple_of(9) { Vec3::ZERO } else { random_direction(x + 200) * size(x, 2) }
        };
        let covered: Vec<u8> = (0..60).map(|x| if x == 20 { 0 } else { 255 }).collect();
        let [mut over, mut around, mut matt] = [[[1.0; TILE]; 3]; 3];
        seen.mean_over_pixel_row(&row(&e), &row(&dx), &row(&dy), &covered, &mut over);
        let widths = std::array::from_fn(|x| size(x as u32, 3));
        seen.mean_over_cone_row(
            &row(&e),
            &widths,
            &std::array::from_fn(|x| (x % 5) as f32),
            &mut around,
        );
        seen.matt_row(&row(&e), &mut matt);
        for x in 0..TILE {
            let at = |light: &Light3| vec3(light[0][x], light[1][x], light[2][x]);
            let (d, is_covered) = (e(x as u32), covered.get(x).is_some_and(|c| *c > 0));
            let expected = if is_covered {
                seen.mean_over_pixel(d, dx(x as u32), dy(x as u32))
            } else {
                Vec3::ZERO
            };
            assert_eq!(at(&over), expected, "{projection:?} {x}");
            let expected = if x % 5 > 0 { seen.mean_over_cone(d, widths[x]) } else { Vec3::ZERO };
            assert_eq!(at(&around), expected, "{projection:?} {x}");
            assert_eq!(at(&matt), seen.matt(d), "{x}");
        }
    }
}

#[test]
fn half_a_sky_lights_by_the_cosine() {
    // A sky of light 1 over black ground: (1 + cos θ) / 2, θ from the zenith.
    let seen =
        lat_long(256, 128, |e| Vec3::splat(if e.y > 0.0 { 1.0 } else { 0.0 })).environment_light();
    for n in [Vec3::Y, Vec3::X, vec3(0.6, 0.8, 0.0), vec3(0.0, -0.6, 0.8), Vec3::NEG_Y] {
        let found = seen.matt(n).x;
        assert!((found - 0.5 * (1.0 + n.y)).abs() < 0.003, "{n}: {found}");
    }
    assert!((seen.brightest_matt() - 1.0).abs() < 0.001);
}

#[test]
fn samples_hold_all_the_light() {
    let seen = lat_long(256, 128, sky).environment_light();
    let samples = seen.samples(300);
    let sum: Vec3 = samples.iter().map(|p| p.radiance * p.solid_angle).sum();
    assert!((sum / (4.0 * std::f32::consts::PI) - Vec3::ONE).abs().max_element() < 0.01, "{sum}");
}

#[test]
fn senseless_directions_and_tiny_pictures_find_some_light() {
    for (width, height) in [(3, 1), (1, 1), (2, 5)] {
        for (projection, _) in Projection::ALL {
            let texels = vec![[0.5; 4]; (width * height) as usize];
            let picture = Picture::linear(Size::new(width, height), texels).unwrap();
            let seen = Environment { projection, ..Environment::new(String::new(), picture) }
                .environment_light();
            for d in [Vec3::ZERO, Vec3::NAN, Vec3::NEG_Z, Vec3::Y] {
                for found in [
                    seen.mean_over_pixel(d, Vec3::NAN, Vec3::X),
                    seen.mean_over_pixel(d, Vec3::X, Vec3::Y),
                    seen.matt(d),
                ] {
                    assert!((found - 0.5).abs().max_element() < 1e-4, "{projection:?} {d} {found}");
                }
            }
        }
    }
}

#[test]
fn copies_share_what_was_prepared_whatever_their_rotation() {
    let environment = lat_long(64, 32, sky);
    let turned = Environment { rotation: 30.0, ..environment.clone() };
    assert!(Arc::ptr_eq(
        &environment.environment_light().prepared,
        &turned.environment_light().prepared
    ));
    let other = Environment { projection: Projection::Angular, ..environment.clone() };
    assert!(!Arc::ptr_eq(
        &environment.environment_light().prepared,
        &other.environment_light().prepared
    ));
}
