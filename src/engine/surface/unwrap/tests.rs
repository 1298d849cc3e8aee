use super::*;
use crate::math::{Mat2, Vec3, hash, vec3};
use crate::surface::Maps;

const WHOLE: UnwrapSettings = UnwrapSettings { amount: 1.0, smooth_px: 0.0 };

/// A surface whose normal and depth follow from a height in px toward the viewer; `None` is no
/// surface.
pub fn of_height(size: Size, height: impl Fn(f32, f32) -> Option<f32> + Sync) -> Surface {
    let at = |x: usize, y: usize| height(x as f32 + 0.5, y as f32 + 0.5);
    let slope = |x: f32, y: f32, dx: f32, dy: f32| {
        let step = 0.01;
        let (a, b) = (height(x - dx * step, y - dy * step)?, height(x + dx * step, y + dy * step)?);
        Some((b - a) / (2.0 * step))
    };
    let normals = Plane::from_fn(size, |x, y| {
        let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
        let slopes = slope(x, y, 1.0, 0.0).zip(slope(x, y, 0.0, 1.0));
        slopes.map_or(Vec3::ZERO, |(dx, dy)| vec3(-dx, dy, 1.0).normalize_or(Vec3::Z))
    });
    let far = (0..size.area()).filter_map(|i| at(i % size.width as usize, i / size.width as usize));
    let (low, high) =
        far.fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), z| (a.min(z), b.max(z)));
    let range = (high - low).max(1e-3);
    let depth = Plane::from_fn(size, |x, y| at(x, y).map_or(f32::NAN, |z| (high - z) / range));
    let coverage = Plane::from_fn(size, |x, y| if at(x, y).is_some() { 255u8 } else { 0 });
    Surface::new(Maps { normals, depth, coverage }).unwrap()
}

/// The worst of a matrix's two singular values as a factor: 1 is an isometry.
fn distortion(m: Mat2) -> f32 {
    let (a, b) = (
        (m.x_axis.x + m.y_axis.y).hypot(m.x_axis.y - m.y_axis.x),
        (m.x_axis.x - m.y_axis.y).hypot(m.x_axis.y + m.y_axis.x),
    );
    let (most, least) = (0.5 * (a + b), 0.5 * (a - b).abs());
    most.max(1.0 / least.max(1e-6))
}

/// Distortions of D against the surface's metric over pixels with all their neighbors, in order.
fn distortions(surface: &Surface, d: &Unwrapping) -> Vec<f32> {
    let size = surface.size();
    let inside = (0..size.area()).map(|i| (i % size.width as usize, i / size.width as usize));
    let mut all: Vec<f32> = inside
        .filter(|&(x, y)| surface.links_plane().at(x, y) == 15)
        .map(|(x, y)| {
            let s = metric::stretch(surface.nbar(x, y), surface.normal(x, y).z, 1.0);
            distortion(d.jacobian(surface, x, y) * s.inverse())
        })
        .collect();
    all.sort_by(f32::total_cmp);
    all
}

fn sphere(size: Size, radius: f32, nz: f32) -> Surface {
    let (cx, cy) = (size.width as f32 / 2.0, size.height as f32 / 2.0);
    of_height(size, |x, y| {
        let rest = 1.0 - ((x - cx).powi(2) + (y - cy).powi(2)) / (radius * radius);
        (rest > nz * nz).then(|| radius * rest.sqrt())
    })
}

#[test]
fn a_tilted_plane_is_isometric() {
    let surface = of_height(Size::new(90, 70), |x, y| Some(0.8 * x - 0.5 * y));
    let all = distortions(&surface, &Unwrapping::new(&surface, WHOLE));
    assert!(all[all.len() - 1] < 1.005, "{}", all[all.len() - 1]);
}

#[test]
fn a_plane_seen_from_near_is_isometric_in_space() {
    let (size, n) = (Size::new(120, 90), vec3(0.5, -0.35, 0.8).normalize_or(Vec3::Z));
    let eye = crate::surface::view::Eye::of_fov(Some(55.0), size);
    let focal = 60.0 / 27.5f32.to_radians().tan();
    // Where the pixel's ray meets the plane; y down, z away from the eye.
    let point = |x: usize, y: usize| {
        let b = (vec2(x as f32 + 0.5, y as f32 + 0.5) - size.center()) / focal;
        vec3(b.x, b.y, 1.0) * (n.z / (n.z - n.x * b.x + n.y * b.y))
    };
    let all = || (0..90).flat_map(|y| (0..120).map(move |x| (x, y)));
    let far = |pick: fn(f32, f32) -> f32| all().map(|(x, y)| point(x, y).z).reduce(pick).unwrap();
    let (low, high) = (far(f32::min), far(f32::max));
    let depth = Plane::from_fn(size, |x, y| (point(x, y).z - low) / (high - low));
    let maps = Maps { normals: Plane::full(size, n), depth, coverage: Plane::full(size, 255) };
    let surface = Surface::new(maps).unwrap().with_eye(eye);
    let d = Unwrapping::new(&surface, WHOLE);
    let ratio = |a: (usize, usize), b: (usize, usize)| {
        d.at(a.0, a.1).distance(d.at(b.0, b.1)) / point(a.0, a.1).distance(point(b.0, b.1))
    };
    let one = ratio((20, 20), (100, 70));
    for (a, b) in
        [((5, 5), (30, 10)), ((90, 10), (110, 80)), ((10, 80), (60, 45)), ((60, 45), (64, 41))]
    {
        assert!(
            (ratio(a, b) / one - 1.0).abs() < 0.01,
            "{a:?} to {b:?}: {} and {one}",
            ratio(a, b)
        );
    }
    let mean = all().map(|(x, y)| point(x, y).z).sum::<f32>() / 10_800.0;
    assert!(
        (one * mean / focal - 1.0).abs() < 0.03,
        "lengths at the mean depth are as they are seen"
    );
}

#[test]
fn a_cylinder_unrolls_to_its_arc_length() {
    let radius = 60.0f32;
    let surface = of_height(Size::new(140, 50), |x, _| {
        let rest = radius * radius - (x - 70.0) * (x - 70.0);
        (rest > (0.25 * radius).powi(2)).then(|| rest.sqrt())
    });
    let d = Unwrapping::new(&surface, WHOLE);
    let arc = |x: f32| radius * ((x - 70.0) / radius).asin();
    for (a, b) in [(14, 126), (40, 100), (60, 61), (14, 40)] {
        let told = d.at(b, 25).distance(d.at(a, 25));
        let truth = arc(b as f32 + 0.5) - arc(a as f32 + 0.5);
        assert!((told / truth - 1.0).abs() < 0.005, "{a} to {b}: {told} for {truth}");
    }
    assert!((d.at(70, 45).distance(d.at(70, 5)) - 40.0).abs() < 0.1, "along it nothing changes");
}

#[test]
fn a_half_sphere_is_as_near_to_isometric_as_can_be() {
    let surface = sphere(Size::new(240, 240), 110.0, 0.1);
    let all = distortions(&surface, &Unwrapping::new(&surface, WHOLE));
    let at = |share: f32| all[(share * (all.len() - 1) as f32) as usize];
    assert!(at(0.5) < 1.075 && at(0.9) < 1.26, "median {}, nine tenths {}", at(0.5), at(0.9));
    // What the pixels themselves measure, unsolved, is far worse.
    let flat = Unwrapping::new(&surface, UnwrapSettings { amount: 0.0, ..WHOLE });
    assert!(distortions(&surface, &flat)[all.len() / 2] > 1.3);
}

#[test]
fn amount_nothing_is_the_identity_and_more_stretches_more() {
    let surface = sphere(Size::new(80, 80), 35.0, 0.1);
    let flat = Unwrapping::new(&surface, UnwrapSettings { amount: 0.0, ..WHOLE });
    assert!(
        (0..80).all(|y| (0..80).all(|x| flat.at(x, y) == vec2(x as f32 + 0.5, y as f32 + 0.5)))
    );
    let width = |amount| {
        let d = Unwrapping::new(&surface, UnwrapSettings { amount, ..WHOLE });
        d.at(70, 40).x - d.at(10, 40).x
    };
    let widths = [0.0, 0.5, 1.0, 2.0].map(width);
    assert!(widths.is_sorted() && widths[3] > widths[2] + 1.0, "{widths:?}");
}

#[test]
fn maps_that_are_shifted_by_pixels_shift_their_deformation() {
    let hill = |x: f32, y: f32| 25.0 * (-((x - 40.0).powi(2) + (y - 30.0).powi(2)) / 400.0).exp();
    let held = |x: f32, y: f32| (x - 40.0).hypot(y - 30.0) < 25.0;
    let size = Size::new(120, 100);
    let [still, shifted] = [(0.0, 0.0), (17.0, 23.0)].map(|(dx, dy)| {
        let surface = of_height(size, |x, y| held(x - dx, y - dy).then(|| hill(x - dx, y - dy)));
        Unwrapping::new(&surface, WHOLE)
    });
    for (x, y) in [(40, 30), (20, 30), (52, 44), (33, 12)] {
        let (a, b) = (still.at(x, y), shifted.at(x + 17, y + 23) - vec2(17.0, 23.0));
        assert!(a.distance(b) < 0.02, "{a} and {b}");
    }
}

#[test]
fn pieces_have_planes_of_their_own() {
    // A ball before a tilted plate: moving the ball moves its part of D and nothing else's.
    let size = Size::new(160, 100);
    let scene = |cx: f32| {
        of_height(size, |x, y| {
            let rest = 20.0f32.powi(2) - (x - cx).powi(2) - (y - 50.0).powi(2);
            Some(if rest > 4.0 { 300.0 + rest.sqrt() } else { 0.5 * x })
        })
    };
    let d = [60.0, 75.0].map(|cx| Unwrapping::new(&scene(cx), WHOLE));
    let ball = |d: &Unwrapping, cx: usize| d.at(cx + 8, 45) - vec2(cx as f32, 0.0);
    assert!(ball(&d[0], 60).distance(ball(&d[1], 75)) < 0.05);
    let plate = |d: &Unwrapping| d.at(150, 50).x - d.at(10, 50).x;
    for d in &d {
        let truth = 140.0 * 1.25f32.sqrt();
        assert!((plate(d) / truth - 1.0).abs() < 0.01, "the plate, {} of {truth}", plate(d));
    }
}

#[test]
fn the_same_bytes_come_from_any_number_of_threads() {
    let surface = sphere(Size::new(150, 130), 60.0, 0.05);
    let solved = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let d = pool.install(|| Unwrapping::new(&surface, WHOLE));
        d.planes().map(|plane| plane.values().iter().map(|v| v.to_bits()).collect::<Vec<u32>>())
    };
    assert!(solved(1) == solved(2));
}

#[test]
fn what_is_given_up_ends_at_once_and_what_is_told_of_is_all_of_it() {
    let surface = sphere(Size::new(80, 80), 35.0, 0.1);
    let told = std::cell::Cell::new(0);
    let count = || {
        told.set(told.get() + 1);
        told.get() < 3
    };
    assert!(
        surface.unwrapping_with_progress(WHOLE, &count).is_none() && !surface.is_unwrapped(WHOLE)
    );
    assert_eq!(told.get(), 3);
    told.set(-100);
    assert!(
        surface.unwrapping_with_progress(WHOLE, &count).is_some() && surface.is_unwrapped(WHOLE)
    );
    assert_eq!(told.get(), SOLVES as i32 - 100);
    assert!(surface.unwrapping_with_progress(WHOLE, &|| false).is_some(), "it is there");
}

#[test]
fn normals_of_eight_bits_and_no_depth_unwrap_a_sphere_as_well() {
    let (size, whole) = (Size::new(160, 160), sphere(Size::new(160, 160), 70.0, 0.2));
    let coarse = |v: f32| ((v * 0.5 + 0.5) * 255.0).round() / 255.0 * 2.0 - 1.0;
    let normal =
        |x: usize, y: usize| vec3(whole.nbar(x, y).x, -whole.nbar(x, y).y, whole.normal(x, y).z);
    let normals = Plane::from_fn(size, |x, y| normal(x, y).to_array().map(coarse).into());
    let normals = Plane::from_fn(size, |x, y| Vec3::normalize_or(normals.at(x, y), Vec3::Z));
    let inside = Plane::from_fn(size, |x, y| whole.coverage(x, y) > 0);
    let depth = crate::surface::integrate::depth_from_normals(&normals, &inside).unwrap().depth;
    let surface =
        Surface::new(Maps { normals, depth, coverage: whole.coverage_plane().clone() }).unwrap();
    let [a, b] = [&whole, &surface].map(|surface| Unwrapping::new(surface, WHOLE));
    let covered =
        (0..size.area()).map(|i| (i % 160, i / 160)).filter(|&(x, y)| whole.coverage(x, y) > 0);
    let far = covered.map(|(x, y)| a.at(x, y).distance(b.at(x, y))).fold(0.0, f32::max);
    assert!(far < 1.0, "{far} px from that of exact normals");
}

#[test]
fn a_thousand_holes_and_fragments_leave_it_finite_and_whole() {
    let size = Size::new(200, 160);
    let hole = |x: f32, y: f32| hash::unit(7, x as u32, y as u32) < 0.1;
    let surface = of_height(size, |x, y| {
        let rest = 1.0 - ((x - 100.0).powi(2) + (y - 80.0).powi(2)) / 4900.0;
        (rest > 0.04 && !hole(x, y)).then(|| 70.0 * rest.max(0.0).sqrt())
    });
    let whole = sphere(size, 70.0, 0.2);
    let (d, plain) = (Unwrapping::new(&surface, WHOLE), Unwrapping::new(&whole, WHOLE));
    let mut farthest = 0.0f32;
    for (x, y) in (0..160).flat_map(|y| (0..200).map(move |x| (x, y))) {
        assert!(d.at(x, y).is_finite());
        if surface.coverage(x, y) > 0 && whole.coverage(x, y) > 0 {
            farthest = farthest.max(d.at(x, y).distance(plain.at(x, y)));
        }
    }
    assert!(farthest < 12.0, "{farthest} px from the whole sphere's");
}

#[test]
fn smoothing_takes_fine_relief_out_of_the_metric() {
    let size = Size::new(200, 100);
    let bumpy = |x: f32, y: f32| Some(0.3 * x + 1.2 * (x * 0.9).sin() * (y * 0.9).cos());
    let (surface, plain) = (of_height(size, bumpy), of_height(size, |x, _| Some(0.3 * x)));
    let truth = Unwrapping::new(&plain, WHOLE);
    let off = |smooth_px| {
        let d = Unwrapping::new(&surface, UnwrapSettings { smooth_px, ..WHOLE });
        let span = |d: &Unwrapping| d.at(180, 50).x - d.at(20, 50).x;
        (span(&d) / span(&truth) - 1.0).abs()
    };
    assert!(off(8.0) < 0.02 && off(0.0) > 0.05, "{} and {}", off(8.0), off(0.0));
}

#[test]
fn rows_do_as_the_equations_say() {
    let surface = sphere(Size::new(70, 60), 28.0, 0.1);
    let rect = covered_rect(&surface);
    let normals = smooth::normals(&surface, rect, 0.0);
    let (metric, grid) =
        (Metric::of(&surface, rect, &normals, 1.0), couplings(&surface, rect, &normals));
    let (w, h) = (rect.width(), rect.height());
    let moved: [Vec<f32>; 2] = [0, 1]
        .map(|k| (0..w * h).map(|i| (i % w) as f32 * 0.3 * hash::unit(3, i as u32, k)).collect());
    let (mut bx, mut by) = (vec![0.0; w * h], vec![0.0; w * h]);
    steps::sources(&grid, &metric, Some(moved.each_ref().map(|v| &v[..])), [&mut bx, &mut by]);
    let [right, down] = grid.couplings();
    // R S − 1 at a pixel, J from the means of the one-sided differences.
    let turned = |x: usize, y: usize| {
        let i = y * w + x;
        let d = |i: usize| vec2(moved[0][i] + (i % w) as f32, moved[1][i] + (i / w) as f32);
        let mean = |sides: [Option<Vec2>; 2]| {
            let there: Vec<Vec2> = sides.into_iter().flatten().collect();
            there.iter().sum::<Vec2>() / there.len().max(1) as f32
        };
        let along = |coupling: f32, a: usize, b: usize| (coupling > 0.0).then(|| d(b) - d(a));
        let dx = mean([
            if x > 0 { along(right[i - 1], i - 1, i) } else { None },
            along(right[i], i, i + 1),
        ]);
        let dy = mean([
            if y > 0 { along(down[i - w], i - w, i) } else { None },
            along(down[i], i, i + w),
        ]);
        let (px, py) = (x + rect.x0 as usize, y + rect.y0 as usize);
        let s = metric::stretch(surface.nbar(px, py), surface.normal(px, py).z, 1.0);
        metric::turn(Mat2::from_cols(dx, dy), s) * s - Mat2::IDENTITY
    };
    for (x, y) in (1..h - 1).flat_map(|y| (1..w - 1).map(move |x| (x, y))) {
        let i = y * w + x;
        let across = |a: (usize, usize), b: (usize, usize)| {
            0.5 * (turned(a.0, a.1).x_axis + turned(b.0, b.1).x_axis)
        };
        let upright = |a: (usize, usize), b: (usize, usize)| {
            0.5 * (turned(a.0, a.1).y_axis + turned(b.0, b.1).y_axis)
        };
        let told = right[i - 1] * across((x - 1, y), (x, y))
            - right[i] * across((x, y), (x + 1, y))
            + down[i - w] * upright((x, y - 1), (x, y))
            - down[i] * upright((x, y), (x, y + 1));
        let found = vec2(bx[i], by[i]);
        assert!(
            told.distance(found) < 2e-3 * (1.0 + told.length()),
            "({x}, {y}): {told} and {found}"
        );
    }
}
