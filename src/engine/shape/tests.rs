//! What is known about inflated shapes: values on discs, ellipses and strips, and what must not
//! change them.

use super::inflate::inflate;
use super::path::ellipse;
use super::tube::tube;
use super::*;
use crate::math::{Size, Vec2, Vec3, hash, vec2, vec3};
use crate::raster::Plane;

const SILHOUETTE: Roundness = Roundness { puff: 1.0, rim_deg: 90.0 };

fn pillow(outline: &Outline) -> Form {
    Form::of_squares(
        outline,
        &inflate(outline, None, None),
        &OutlineRim::silhouette(outline),
        SILHOUETTE,
    )
}

/// Canvas px of the center of a pixel of a form.
fn place(form: &Form, x: usize, y: usize) -> Vec2 {
    vec2(form.corner.0 as f32 + x as f32 + 0.5, form.corner.1 as f32 + y as f32 + 0.5)
}

fn pixels(size: Size) -> impl Iterator<Item = (usize, usize)> {
    (0..size.height as usize).flat_map(move |y| (0..size.width as usize).map(move |x| (x, y)))
}

fn angle_deg(a: Vec3, b: Vec3) -> f32 {
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

/// Mean and 99th percentile.
fn mean_and_p99(mut values: Vec<f32>) -> (f32, f32) {
    values.sort_by(f32::total_cmp);
    let mean = values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len() as f64;
    (mean as f32, values[values.len() * 99 / 100])
}

#[test]
fn a_disc_becomes_a_half_sphere() {
    let (center, r) = (vec2(115.13, 116.4), 100.0f32);
    let outline = Outline::of_path(&ellipse(center, Vec2::splat(r), 0.0, 6000), 1 << 20).unwrap();
    let form = pillow(&outline);
    let (mut angles, mut worst) = (Vec::new(), 0.0f32);
    for (x, y) in pixels(outline.size()).filter(|&(x, y)| outline.inside_pixels().at(x, y)) {
        let from = place(&form, x, y) - center;
        let z = (r * r - from.length_squared()).max(0.0).sqrt();
        angles.push(angle_deg(form.normals.at(x, y), vec3(from.x, -from.y, z).normalize()));
        if from.length() < 0.95 * r {
            worst = worst.max((form.height.at(x, y) - z).abs());
        }
    }
    let (mean, p99) = mean_and_p99(angles);
    println!("disc: normals {mean:.4}° in the mean, {p99:.3}° at p99, heights {:.5} R", worst / r);
    assert!(mean < 0.05 && p99 < 0.5, "{mean}°, {p99}°");
    assert!(worst < 0.002 * r, "{worst} px");
}

#[test]
fn an_ellipse_rises_to_its_apex_and_a_strip_to_root_two_or_as_a_tube_to_its_half_width() {
    let (a, b) = (120.0f32, 50.0f32);
    let outline =
        Outline::of_path(&ellipse(vec2(130.0, 60.0), vec2(a, b), 0.0, 6000), 1 << 20).unwrap();
    let top = pillow(&outline).height.values().iter().fold(0.0f32, |m, z| m.max(*z));
    let apex = (2.0 / (1.0 / (a * a) + 1.0 / (b * b))).sqrt();
    assert!((top / apex - 1.0).abs() < 0.01, "{top} and not {apex}");
    let w = 30.3f32;
    let corners =
        [vec2(5.0, 5.0), vec2(805.0, 5.0), vec2(805.0, 5.0 + 2.0 * w), vec2(5.0, 5.0 + 2.0 * w)];
    let strip = Outline::of_path(&corners, 1 << 20).unwrap();
    let across = |form: &Form| {
        let x = form.height.width() / 2;
        (0..form.height.height()).map(|y| form.height.at(x, y)).fold(0.0f32, f32::max)
    };
    let fat = across(&pillow(&strip));
    assert!((fat / (2.0f32.sqrt() * w) - 1.0).abs() < 0.005, "{fat}");
    let limb = across(&Form::of_squares(
        &strip,
        &tube(&strip, None, None),
        &OutlineRim::silhouette(&strip),
        SILHOUETTE,
    ));
    println!("strip of half width {w}: pillow {fat}, tube {limb}");
    assert!((limb / w - 1.0).abs() < 0.015, "{limb} and not {w}");
}

/// A creature of limbs and a head, `size` px wide, turned and shifted.
fn creature(size: f32, turn_rad: f32, shift: Vec2) -> Outline {
    let at = |i: usize| {
        let angle = std::f32::consts::TAU * i as f32 / 3000.0;
        let reach = 0.26 + 0.09 * (5.0 * angle).sin() + 0.05 * (3.0 * angle + 1.0).cos();
        Vec2::from_angle(angle + turn_rad) * reach * size + size * 0.5 + shift
    };
    Outline::of_path(&(0..3000).map(at).collect::<Vec<_>>(), 1 << 24).unwrap()
}

/// The normal between pixels at a canvas point.
fn normal_at(form: &Form, p: Vec2) -> Vec3 {
    let q = p - 0.5 - vec2(form.corner.0 as f32, form.corner.1 as f32);
    let (x, y) = (q.x.floor(), q.y.floor());
    let at = |dx: i32, dy: i32| form.normals.at_clamped(x as i32 + dx, y as i32 + dy);
    let (fx, fy) = (q.x - x, q.y - y);
    let row = |dy: i32| at(0, dy) * (1.0 - fx) + at(1, dy) * fx;
    (row(0) * (1.0 - fy) + row(1) * fy).normalize_or(Vec3::Z)
}

/// How far the normals of one form are from those of another, seen through a map of the canvas and
/// a turn; mean, px within 2 px of the rim left out.
fn normal_difference_deg(
    a: &Form,
    b: &Form,
    b_from_a: impl Fn(Vec2) -> Vec2,
    turn_rad: f32,
) -> f32 {
    let deep = |x: i32, y: i32| {
        let r = 2;
        (-r..=r).all(|dy| (-r..=r).all(|dx| a.coverage.get(x + dx, y + dy) == Some(255)))
    };
    let turn = Vec2::from_angle(-turn_rad);
    let angles =
        pixels(a.coverage.size()).filter(|&(x, y)| deep(x as i32, y as i32)).map(|(x, y)| {
            let n = a.normals.at(x, y);
            let turned = turn.rotate(n.truncate()).extend(n.z);
            angle_deg(turned, normal_at(b, b_from_a(place(a, x, y))))
        });
    mean_and_p99(angles.collect()).0
}

#[test]
fn a_tube_over_the_outline_of_a_capsule_a_cone_or_a_ball_is_nearly_that_body() {
    let ball = |x: f32, y: f32, radius: f32| Ball { at: vec2(x, y), radius };
    let bodies = [
        ("capsule", [ball(60.3, 60.1, 30.0), ball(260.7, 140.2, 30.0)]),
        ("cone", [ball(80.3, 80.1, 50.0), ball(330.7, 180.2, 12.0)]),
        ("ball", [ball(80.3, 80.1, 60.0), ball(80.3, 80.1, 60.0)]),
    ];
    for (name, balls) in bodies {
        let (outline, squares) = sweep::sweep(&balls, 1 << 20).unwrap();
        let form = |h: &Plane<f32>| {
            Form::of_squares(&outline, h, &OutlineRim::silhouette(&outline), SILHOUETTE)
        };
        let off =
            normal_difference_deg(&form(&tube(&outline, None, None)), &form(&squares), |p| p, 0.0);
        println!("{name}: {off:.3}°");
        assert!(off < 0.45, "{name}: {off}°");
    }
}

#[test]
fn turning_shifting_and_scaling_an_outline_does_so_to_its_normals() {
    let turn = 37.0f32.to_radians();
    let shift = vec2(0.3, 0.3);
    let (still, turned) = (creature(300.0, 0.0, Vec2::ZERO), creature(300.0, turn, shift));
    let map = |p: Vec2| Vec2::from_angle(turn).rotate(p - 150.0) + 150.0 + shift;
    let (small, large) = (creature(256.0, 0.0, Vec2::ZERO), creature(1024.0, 0.0, Vec2::ZERO));
    let tubes = |o: &Outline| {
        Form::of_squares(o, &tube(o, None, None), &OutlineRim::silhouette(o), SILHOUETTE)
    };
    let by_turn = normal_difference_deg(&pillow(&still), &pillow(&turned), map, turn);
    let by_scale = normal_difference_deg(&pillow(&small), &pillow(&large), |p| p * 4.0, 0.0);
    let of_tubes = normal_difference_deg(&tubes(&still), &tubes(&turned), map, turn);
    println!(
        "turned and shifted {by_turn:.3}° (tubes {of_tubes:.3}°), four times as large {by_scale:.3}°"
    );
    assert!(by_turn < 0.3 && by_scale < 0.3, "{by_turn}° turned, {by_scale}° scaled");
    let tubes_by_scale = normal_difference_deg(&tubes(&small), &tubes(&large), |p| p * 4.0, 0.0);
    assert!(
        of_tubes < 0.3 && tubes_by_scale < 0.3,
        "tubes {of_tubes}° turned, {tubes_by_scale}° scaled"
    );
}

#[test]
fn normals_are_the_slopes_of_heights() {
    let outline = creature(300.0, 0.2, Vec2::ZERO);
    let u = inflate(&outline, None, None);
    for round in
        [SILHOUETTE, Roundness { puff: 0.5, rim_deg: 90.0 }, Roundness { puff: 1.3, rim_deg: 40.0 }]
    {
        let form = Form::of_squares(&outline, &u, &OutlineRim::silhouette(&outline), round)
            .tilted(vec2(5.0, -9.0));
        let mut angles = Vec::new();
        let (mut curl, mut count) = (0.0f64, 0);
        for (x, y) in pixels(outline.size()).filter(|&(x, y)| u.at(x, y) > 400.0) {
            let across = form.height.at(x + 1, y) - form.height.at(x - 1, y);
            let down = form.height.at(x, y + 1) - form.height.at(x, y - 1);
            angles.push(angle_deg(
                form.normals.at(x, y),
                vec3(-0.5 * across, 0.5 * down, 1.0).normalize(),
            ));
            // The curl of the slopes, around a pixel.
            let slope = |x: usize, y: usize| {
                let n = form.normals.at(x, y);
                vec2(-n.x, n.y) / n.z
            };
            let turning =
                (slope(x + 1, y).y - slope(x - 1, y).y) - (slope(x, y + 1).x - slope(x, y - 1).x);
            curl += f64::from(turning.abs() * 0.5);
            count += 1;
        }
        let (mean, p99) = mean_and_p99(angles);
        let curl = curl / f64::from(count);
        println!("{round:?}: {mean:.3}° in the mean, {p99:.3}° at p99, curl {curl:.6}");
        assert!(mean < 0.1 && p99 < 1.0, "{mean}°, {p99}° with {round:?}");
        assert!(curl < 1e-3, "{curl}");
    }
}

#[test]
fn a_low_rim_turns_by_its_angle_in_the_mean() {
    let outline =
        Outline::of_path(&ellipse(vec2(70.0, 70.0), Vec2::splat(60.0), 0.0, 4000), 1 << 20)
            .unwrap();
    let u = inflate(&outline, None, None);
    let form = Form::of_squares(
        &outline,
        &u,
        &OutlineRim::silhouette(&outline),
        Roundness { puff: 0.8, rim_deg: 35.0 },
    );
    let at_rim = pixels(outline.size()).filter(|&(x, y)| {
        outline.inside_pixels().at(x, y) && (place(&form, x, y) - 70.0).length() > 59.5
    });
    let (mean, _) =
        mean_and_p99(at_rim.map(|(x, y)| angle_deg(form.normals.at(x, y), Vec3::Z)).collect());
    assert!((mean - 35.0).abs() < 3.0, "{mean}°");
}

/// Any possible outline: one pixel, all, thin, ragged, holes.
fn random_mask(seed: u32) -> Plane<u8> {
    let pick = |i: u32, most: u32| (hash::unit(seed, i, 1) * most as f32) as u32;
    let size = Size::new(1 + pick(0, 40), 1 + pick(1, 40));
    let kind = pick(2, 6);
    let share = hash::unit(seed, 3, 1);
    Plane::from_fn(size, |x, y| {
        let noise = hash::unit(seed, x as u32, y as u32 + 7);
        match kind {
            0 => u8::from(x == 0 && y == 0) * 255,
            1 => 255,
            2 => u8::from(noise < share) * 255,
            3 => (noise * 255.0) as u8,
            4 => u8::from((x + y) % 5 != 0) * (noise * 255.0) as u8,
            _ => u8::from(x % 3 == 0) * 40,
        }
    })
}

#[test]
fn a_thousand_outlines_give_unit_normals_and_the_same_bytes_on_one_and_two_threads() {
    let threads = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
    let (one, two) = (threads(1), threads(2));
    let mut seen = 0;
    for seed in 0..1000 {
        let Some(outline) = Outline::new((3, -2), &random_mask(seed)) else { continue };
        let form = || {
            let squares =
                tube::blend(&inflate(&outline, None, None), &tube(&outline, None, None), 0.4);
            Form::of_squares(
                &outline,
                &squares,
                &OutlineRim::silhouette(&outline),
                Roundness { puff: 0.8, rim_deg: 70.0 },
            )
        };
        let (a, b) = (one.install(form), two.install(form));
        assert_eq!(a, b, "mask {seed}");
        assert!(a.height.values().iter().all(|z| z.is_finite() && *z >= 0.0), "mask {seed}");
        assert!(a.normals.values().iter().all(|n| (n.length() - 1.0).abs() < 1e-5), "mask {seed}");
        seen += 1;
    }
    assert!(seen > 900, "{seen}");
    // Large enough that rows are shared.
    let outline = creature(400.0, 0.0, Vec2::ZERO);
    assert_eq!(one.install(|| pillow(&outline)), two.install(|| pillow(&outline)));
}

#[test]
fn a_form_moves_with_its_outline_byte_for_byte() {
    let outline = creature(120.0, 0.0, Vec2::ZERO);
    assert_eq!(pillow(&outline).moved((31, -7)), pillow(&outline.moved((31, -7))));
}

#[test]
fn a_part_that_is_joined_runs_level_into_its_neighbor() {
    let w = 20.0f32;
    let corners =
        [vec2(2.0, 2.0), vec2(202.0, 2.0), vec2(202.0, 2.0 + 2.0 * w), vec2(2.0, 2.0 + 2.0 * w)];
    let strip = Outline::of_path(&corners, 1 << 20).unwrap();
    // Joined at its right end: there it is as high as in its middle.
    let joined = Plane::from_fn(strip.size(), |x, _| x + 1 == strip.size().width as usize);
    let u = inflate(&strip, Some(&joined), None);
    let row = strip.size().height as usize / 2;
    let (middle, end) = (u.at(100, row), u.at(strip.size().width as usize - 2, row));
    assert!((end / middle - 1.0).abs() < 0.01, "{end} at the end, {middle} in the middle");
    assert!(u.at(1, row) < 0.3 * middle);
    // Free all around: still finite.
    let everywhere = Plane::full(strip.size(), true);
    assert!(inflate(&strip, Some(&everywhere), None).values().iter().all(|v| v.is_finite()));
}

#[test]
fn thousands_of_holes_combs_and_specks_make_a_form_without_nan() {
    let size = Size::new(480, 420);
    let hole = |x: usize, y: usize, step: usize, side: usize| x % step < side && y % step < side;
    type Hostile = fn(usize, usize) -> bool;
    let drawings: [(&str, Hostile); 6] = [
        ("single pixels", |x, y| x % 4 == 1 && y % 5 == 2),
        ("one pixel", |x, y| (x, y) == (240, 7)),
        ("a comb of single columns", |x, y| x % 2 == 0 || y < 3),
        ("a chessboard", |x, y| (x + y) % 2 == 0),
        ("a line across", |_, y| y == 200),
        ("all of it", |_, _| true),
    ];
    let holes = [(5, 1), (5, 4), (9, 3)]
        .map(|(step, side)| (step, side, move |x, y| !hole(x, y, step, side)));
    let planes = drawings.iter().map(|(name, is)| {
        (name.to_string(), Plane::from_fn(size, |x, y| if is(x, y) { 255 } else { 0 }))
    });
    let holed = holes.iter().map(|(step, side, is)| {
        (
            format!("holes of {side} every {step}"),
            Plane::from_fn(size, |x, y| if is(x, y) { 255 } else { 0 }),
        )
    });
    for (name, plane) in planes.chain(holed) {
        let outline = Outline::new((0, 0), &plane).unwrap_or_else(|| panic!("{name}"));
        for profile in [0.0, 1.0] {
            let squares = if profile == 0.0 {
                inflate(&outline, None, None)
            } else {
                tube(&outline, None, None)
            };
            let form =
                Form::of_squares(&outline, &squares, &OutlineRim::silhouette(&outline), SILHOUETTE);
            assert!(form.height.values().iter().all(|z| z.is_finite()), "{name}, {profile}");
            assert!(
                form.normals.values().iter().all(|n| (n.length() - 1.0).abs() < 1e-5),
                "{name}, {profile}"
            );
            let mut relief = Relief::empty(size);
            relief.add(&form, Combine::Over, 1);
            let surface = relief
                .into_surface(&mut crate::surface::NearestCache::default())
                .unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(
                surface.depth_plane().values().iter().all(|z| (0.0..=1.0).contains(z)),
                "{name}, {profile}"
            );
        }
    }
}
