use super::*;

fn impulse(size: Size) -> Plane<f32> {
    let mut plane = Plane::full(size, 0.0);
    plane.set(size.width as usize / 2, size.height as usize / 2, 1.0);
    plane
}

#[test]
fn what_is_spread_keeps_its_sum_and_has_the_variance_asked_for() {
    let size = Size::new(121, 121);
    for variance in [0.1f32, 0.5, 0.7, 4.0, 30.0, 200.0] {
        let mut point = vec![[0.0f32; 2]; size.area()];
        point[60 * 121 + 60] = [1.0, 2.0];
        let spread = spread_pixels(size, &point, variance);
        let sum: f32 = spread.iter().map(|p| p[0]).sum();
        let wide: f32 =
            spread.iter().enumerate().map(|(i, p)| p[1] * ((i % 121) as f32 - 60.0).powi(2)).sum();
        assert!((sum - 1.0).abs() < 5e-3, "{variance}: {sum}");
        assert!((0.5 * wide / variance - 1.0).abs() < 0.06, "{variance}: {}", 0.5 * wide);
    }
    let same = vec![[0.5f32]; size.area()];
    assert_eq!(spread_pixels(size, &same, f32::NAN), same);
}

#[test]
fn a_point_spreads_to_a_gaussian_of_either_kind() {
    for (side, sigma) in [(41, 0.7f32), (41, 3.9), (101, 4.1), (301, 25.0)] {
        let blurred = gaussian(&impulse(Size::new(side, side)), sigma);
        let peak = 1.0 / (2.0 * std::f32::consts::PI * sigma * sigma);
        let c = side as usize / 2;
        for d in 0..(3.0 * sigma) as usize {
            let expected = peak * (-0.5 * (d as f32 / sigma).powi(2)).exp();
            let tolerance = if sigma < 1.0 { 0.03 } else { 2e-3 };
            for found in [
                blurred.at(c + d, c),
                blurred.at(c - d, c),
                blurred.at(c, c + d),
                blurred.at(c, c - d),
            ] {
                assert!(
                    (found - expected).abs() < tolerance * peak,
                    "σ {sigma}, {d}: {found}, {expected}"
                );
            }
        }
    }
}

#[test]
fn a_step_blurs_to_the_normal_distribution_within_a_byte_step() {
    // Odd σ, so that half and one and a half deviations from the border of two pixels lie on pixel
    // centers.
    for sigma in [3usize, 5, 9, 61] {
        let step = Plane::from_fn(Size::new(600, 3), |x, _| if x < 300 { 0.0 } else { 1.0 });
        let blurred = gaussian(&step, sigma as f32);
        // Φ(½) and Φ(1½).
        for (beyond, expected) in [(sigma / 2, 0.691_462), (sigma * 3 / 2, 0.933_193)] {
            let found = blurred.at(300 + beyond, 1);
            assert!((found - expected).abs() < 2e-3, "σ {sigma}: {found}, {expected}");
        }
    }
}

#[test]
fn what_is_even_stays_even_up_to_the_border() {
    for sigma in [0.0, 1.5, 7.0, 900.0] {
        let even = vec![[0.25f32, 0.5, 0.75, 1.0]; 37 * 23];
        for pixel in gaussian_pixels(Size::new(37, 23), &even, sigma) {
            for (v, e) in pixel.iter().zip(even[0]) {
                assert!((v - e).abs() < 1e-4, "σ {sigma}: {v}");
            }
        }
    }
}

#[test]
fn interleaved_pixels_blur_as_their_planes_do() {
    let size = Size::new(53, 19);
    let value = |i: usize, c: u32| crate::math::hash::unit(9, i as u32, c);
    let pixels: Vec<[f32; 3]> =
        (0..size.area()).map(|i| [value(i, 0), value(i, 1), value(i, 2)]).collect();
    for sigma in [1.1, 6.0] {
        let together = gaussian_pixels(size, &pixels, sigma);
        let alone = gaussian(
            &Plane::from_values(size, pixels.iter().map(|p| p[2]).collect()).unwrap(),
            sigma,
        );
        assert!(together.iter().zip(alone.values()).all(|(p, &v)| p[2] == v), "σ {sigma}");
    }
}

#[test]
fn nothing_outside_the_mask_comes_in() {
    let size = Size::new(80, 40);
    let mask = Plane::from_fn(size, |x, _| if x < 40 { 1.0 } else { 0.0 });
    let plane = Plane::from_fn(size, |x, _| if x < 40 { 0.5 } else { 1e6 });
    for sigma in [2.0, 9.0] {
        let blurred = gaussian_masked(&plane, &mask, sigma);
        assert!((0..42).all(|x| (blurred.at(x, 20) - 0.5).abs() < 1e-3), "σ {sigma}");
    }
}
