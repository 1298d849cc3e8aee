use super::*;
use crate::math::{Size, vec3};
use crate::surface::Maps;

/// A surface over the whole canvas from its slope (∂height/∂x, ∂height/∂y up), the origin at the
/// canvas's center.
fn from_height_slope(side: u32, slope: impl Fn(f32, f32) -> (f32, f32) + Sync) -> Surface {
    let half = side as f32 * 0.5;
    let size = Size::new(side, side);
    let normals = Plane::from_fn(size, |x, y| {
        let (dx, dy) = slope(x as f32 + 0.5 - half, half - y as f32 - 0.5);
        vec3(-dx, -dy, 1.0)
    });
    Surface::new(Maps { normals, depth: Plane::full(size, 0.5), coverage: Plane::full(size, 255) })
        .unwrap()
}

/// A sphere on an empty ground.
fn sphere(side: u32, radius_px: f32) -> Surface {
    let half = side as f32 * 0.5;
    let size = Size::new(side, side);
    let normals = Plane::from_fn(size, |x, y| {
        let (x, y) = ((x as f32 + 0.5 - half) / radius_px, (half - y as f32 - 0.5) / radius_px);
        let z2 = 1.0 - x * x - y * y;
        if z2 > 0.0 { vec3(x, y, z2.sqrt()) } else { Vec3::ZERO }
    });
    let depth = normals.map(|n| 1.0 - n.z);
    let coverage = normals.map(|n| if n == Vec3::ZERO { 0 } else { 255 });
    Surface::new(Maps { normals, depth, coverage }).unwrap()
}

/// A sphere before a slanted wall: silhouettes, depth jumps and the canvas's border in one picture.
fn sphere_before_a_wall(width: u32, height: u32, radius_px: f32) -> Surface {
    let size = Size::new(width, height);
    let at = |x: usize, y: usize| {
        let (x, y) = (x as f32 + 0.5 - width as f32 * 0.5, height as f32 * 0.5 - y as f32 - 0.5);
        let z2 = 1.0 - (x * x + y * y) / (radius_px * radius_px);
        match z2 > 0.0 {
            true => (vec3(x, y, radius_px * z2.sqrt()), 0.4 - 0.3 * z2.sqrt()),
            false if y.abs() < radius_px * 1.5 => (vec3(0.3, 0.02 * y, 1.0), 0.9),
            false => (Vec3::ZERO, 1.0),
        }
    };
    let coverage = Plane::from_fn(size, |x, y| if at(x, y).0 == Vec3::ZERO { 0 } else { 255 });
    let normals = Plane::from_fn(size, |x, y| at(x, y).0);
    Surface::new(Maps { normals, depth: Plane::from_fn(size, |x, y| at(x, y).1), coverage })
        .unwrap()
}

fn assert_near(found: f32, expected: f32, within: f32) {
    assert!((found - expected).abs() <= within, "{found} is not {expected} ± {within}");
}

#[test]
fn a_sphere_curves_by_its_radius_in_every_direction_where_it_faces_the_viewer() {
    let c = sphere(201, 90.0).curvature(0.0);
    let (ku, kv, _) = c.principal(100, 100);
    assert_near(ku, 1.0 / 90.0, 1e-5);
    assert_near(kv, 1.0 / 90.0, 1e-5);
    assert_near(c.kappa(100, 100, 20.0), (40.0f32 / 90.0).tanh(), 1e-4);
}

#[test]
fn a_sphere_seen_aslant_curves_as_its_height_does() {
    // z = √(R² − x²): −z″ = R²/z³ along x and 1/z across, both convex.
    let c = sphere(201, 90.0).curvature(0.0);
    let z = (90.0f32 * 90.0 - 54.0 * 54.0).sqrt();
    let (ku, kv, u) = c.principal(154, 100);
    assert_near(ku, 90.0 * 90.0 / z.powi(3), 2e-5);
    assert_near(kv, 1.0 / z, 2e-5);
    assert_near(u.x.abs(), 1.0, 1e-3);
}

#[test]
fn a_cylinder_along_a_diagonal_curves_across_it() {
    // height = −a t²/2 with t across the direction (1, 1)/√2, y up: u must point along (1, −1)/√2.
    let a = 0.01;
    let surface = from_height_slope(64, |x, y| {
        let t = (x - y) * std::f32::consts::FRAC_1_SQRT_2;
        (-a * t * std::f32::consts::FRAC_1_SQRT_2, a * t * std::f32::consts::FRAC_1_SQRT_2)
    });
    let (ku, kv, u) = surface.curvature(0.0).principal(20, 40);
    assert_near(ku, a, 1e-6);
    assert_near(kv, 0.0, 1e-6);
    assert_near(u.x * u.y, -0.5, 1e-4);
}

#[test]
fn a_pit_is_concave_and_a_saddle_cancels() {
    let pit = from_height_slope(64, |x, y| (0.01 * x, 0.01 * y)).curvature(0.0);
    assert_near(pit.kappa(30, 30, 10.0), (-0.2f32).tanh(), 1e-5);
    let saddle = from_height_slope(64, |x, y| (0.02 * x, -0.02 * y)).curvature(0.0);
    assert_near(saddle.kappa(30, 30, 10.0), 0.0, 1e-5);
    let (ku, kv, u) = saddle.principal(30, 30);
    assert_near(ku, 0.02, 1e-5);
    assert_near(kv, -0.02, 1e-5);
    assert_near(u.y.abs(), 1.0, 1e-4);
}

#[test]
fn anisotropic_curvature_is_the_formula_in_the_frame_of_the_principal_directions() {
    let c =
        from_height_slope(64, |x, y| (-0.03 * x + 0.01 * y, 0.01 * x + 0.005 * y)).curvature(0.0);
    let (ku, kv, u) = c.principal(40, 20);
    for (lambda, light) in
        [(0.7, vec3(0.2, 0.9, 0.4)), (-1.0, vec3(-0.5, 0.1, 0.7)), (0.0, Vec3::X)]
    {
        let l = light.normalize();
        let (lu, lv) = (l.x * u.x + l.y * u.y, l.y * u.x - l.x * u.y);
        let (h, a) = (ku + kv, ku - kv);
        let expected = (9.0
            * ((h + lambda * a) * lu * lu + (h - lambda * a) * lv * lv + h * l.z * l.z))
            .tanh();
        assert_near(c.kappa_along(40, 20, 9.0, lambda, light), expected, 1e-5);
    }
    let along_u = c.kappa_along(40, 20, 9.0, 1.0, vec3(u.x, u.y, 0.0));
    assert_near(along_u, (18.0 * ku).tanh(), 1e-5);
}

#[test]
fn the_fast_tensor_is_the_reference_everywhere() {
    for (surface, blur_px) in [
        (sphere_before_a_wall(300, 150, 60.0), 0.0),
        (sphere_before_a_wall(300, 150, 60.0), 1.7),
        (sphere_before_a_wall(520, 90, 30.0), 5.0),
        (sphere_before_a_wall(40, 33, 12.0), 15.0),
    ] {
        let c = surface.curvature(blur_px);
        // Nearer to an end blurred normals flow instead (`ends`).
        let size = surface.size();
        let (width, height) = (size.width as usize, size.height as usize);
        let mut distances = Vec::new();
        surface.rims().distances([0, 0, width, height], &mut distances);
        for y in 0..height {
            for x in (y % 3..width).step_by(3) {
                if blur_px > 0.0 && f32::from(distances[y * width + x]) < 9.0 * blur_px {
                    continue;
                }
                let h = reference::tensor_at(&surface, x, y, blur_px);
                let found = c.tensor(x, y);
                for i in 0..3 {
                    assert!(
                        (found[i] - h[i]).abs() < 2e-4,
                        "blur {blur_px}, ({x}, {y}): {found:?}, {h:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn no_outline_shows_where_a_ball_hides_a_wall() {
    // The wall is all but flat: κ beside the ball must stay so, and the ball's own must be convex
    // up to its rim.
    let surface = sphere_before_a_wall(300, 200, 60.0);
    for blur_px in [0.0, 2.0, 6.0] {
        let c = surface.curvature(blur_px);
        for x in 0..300 {
            let kappa = c.kappa(x, 100, 4.0);
            let on_ball = (x as f32 + 0.5 - 150.0).abs() < 60.0;
            let expected = if on_ball { -1e-3..=1.0 } else { -0.01..=0.1 };
            assert!(expected.contains(&kappa), "blur {blur_px}, x = {x}: {kappa}");
        }
    }
}

#[test]
fn a_balls_curvature_goes_on_to_its_rim() {
    // Away from the middle the height bends the more: κ must not sink toward the rim, as it did
    // when it was faded.
    let ball = sphere(201, 90.0).curvature(0.0);
    let along: Vec<f32> = (11..100).rev().map(|x| ball.kappa(x, 100, 4.0)).collect();
    assert!(along.windows(2).all(|pair| pair[1] >= pair[0] - 1e-3), "{along:?}");
    assert!(along.last().is_some_and(|&rim| rim > 0.9), "{along:?}");
}

#[test]
fn a_blur_sees_no_stairs_of_the_contour() {
    // A slanted edge of a bent sheet: with a blur κ varies along its stairs no more than the sheet
    // itself.
    let size = Size::new(120, 120);
    let inside = |x: usize, y: usize| (y as f32) < 90.0 - 0.13 * x as f32;
    let normals = Plane::from_fn(size, |_, y| vec3(0.0, 0.006 * (y as f32 - 60.0), 1.0));
    let coverage = Plane::from_fn(size, |x, y| if inside(x, y) { 255 } else { 0 });
    let surface = Surface::new(Maps { normals, depth: Plane::full(size, 0.5), coverage }).unwrap();
    let c = surface.curvature(4.0);
    let edge = |x: usize| (0..120).rfind(|&y| inside(x, y)).unwrap();
    let along: Vec<f32> = (30..90).map(|x| c.kappa(x, edge(x), 40.0)).collect();
    let steps = along.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    assert!(steps < 0.04, "{steps}: {along:?}");
}

#[test]
fn a_blur_removes_the_noise_of_eight_bits_and_keeps_the_shape() {
    let smooth = sphere(201, 90.0);
    let [nx, ny, nz] = smooth.normal_planes();
    let coarse = |v: f32| ((v * 0.5 + 0.5) * 255.0).round() / 255.0 * 2.0 - 1.0;
    let normals = Plane::from_fn(smooth.size(), |x, y| {
        vec3(coarse(nx.at(x, y)), -coarse(ny.at(x, y)), coarse(nz.at(x, y)))
    });
    let coarse = Surface::new(Maps {
        normals,
        depth: smooth.depth_plane().clone(),
        coverage: smooth.coverage_plane().clone(),
    })
    .unwrap();
    let worst = |blur_px: f32| {
        let (a, b) = (smooth.curvature(blur_px), coarse.curvature(blur_px));
        (60..140).map(|x| (a.kappa(x, 95, 4.0) - b.kappa(x, 95, 4.0)).abs()).fold(0.0, f32::max)
    };
    assert!(worst(2.0) < 0.2 * worst(0.0), "{} {}", worst(2.0), worst(0.0));
}

#[test]
fn a_blur_that_is_no_number_is_none_and_a_huge_one_ends() {
    let surface = sphere(40, 15.0);
    assert!(Arc::ptr_eq(&surface.curvature(f32::NAN), &surface.curvature(0.0)));
    let c = surface.curvature(f32::INFINITY);
    assert!(c.hxx.values().iter().all(|v| v.is_finite()));
}

#[test]
fn the_same_curvature_is_computed_once() {
    let surface = sphere(40, 15.0);
    assert!(Arc::ptr_eq(&surface.curvature(1.5), &surface.curvature(1.5)));
    assert!(!Arc::ptr_eq(&surface.curvature(1.5), &surface.curvature(1.6)));
}

#[test]
fn a_stray_pixel_leaves_no_dot() {
    let ball = sphere(201, 90.0);
    let mut depth = ball.depth_plane().clone();
    depth.set(120, 100, 1.0);
    let normals = Plane::from_fn(ball.size(), |x, y| ball.normal(x, y));
    let strayed =
        Surface::new(Maps { normals, depth, coverage: ball.coverage_plane().clone() }).unwrap();
    let (clean, strayed) = (ball.curvature(0.0), strayed.curvature(0.0));
    for (x, y) in [(120, 100), (119, 100), (121, 100), (120, 99), (122, 101)] {
        assert_near(strayed.kappa(x, y, 4.0), clean.kappa(x, y, 4.0), 2e-3);
    }
}
