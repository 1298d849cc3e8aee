use super::*;

/// −∇²v + held v at a pixel, as the equation reads.
fn apply_at(inside: &Plane<bool>, held: &Plane<f32>, v: &[f32], x: usize, y: usize) -> f32 {
    let w = inside.width();
    let beside = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
    let inner = beside.iter().filter(|p| inside.at(p.0, p.1));
    let here = v[y * w + x];
    inner.map(|p| here - v[p.1 * w + p.0]).sum::<f32>() + held.at(x, y) * here
}

#[test]
fn the_equation_holds_on_a_ragged_grid_from_any_start() {
    let size = Size::new(97, 61);
    let is_inner = |x: usize, y: usize| x > 0 && y > 0 && x < 96 && y < 60;
    let inside = Plane::from_fn(size, |x, y| {
        is_inner(x, y) && (x * 7 + y * 3) % 11 != 0 && (x / 9 + y / 8) % 4 != 3
    });
    let held =
        Plane::from_fn(
            size,
            |x, y| if inside.at(x, y) { ((x + y) % 5) as f32 * 0.3 + 0.01 } else { 0.0 },
        );
    let b: Vec<f32> = inside
        .values()
        .iter()
        .enumerate()
        .map(|(i, is)| if *is { (i % 7) as f32 } else { 0.0 })
        .collect();
    let solver = Solver::new(&inside, held.clone());
    for start in [None, Some(vec![0.0; size.area()])] {
        let v = solver.solve(&b, start, 1e-11);
        for (x, y) in
            (1..60).flat_map(|y| (1..96).map(move |x| (x, y))).filter(|p| inside.at(p.0, p.1))
        {
            let left = b[y * 97 + x] - apply_at(&inside, &held, &v, x, y);
            assert!(left.abs() < 2e-3, "{left} left at ({x}, {y})");
        }
    }
}

/// v = 0 outside a disc and −∇²v = 4 inside: v = R² − r², off by the stairs of the rim.
#[test]
fn few_steps_from_nothing_solve_a_large_disc() {
    let (n, radius) = (301usize, 140.0f32);
    let size = Size::new(n as u32, n as u32);
    let inside = Plane::from_fn(size, |x, y| (x as f32 - 150.0).hypot(y as f32 - 150.0) < radius);
    let held = Plane::from_fn(size, |x, y| {
        let out = |x: usize, y: usize| if inside.at(x, y) { 0.0 } else { 1.0 };
        if !inside.at(x, y) {
            0.0
        } else {
            out(x - 1, y) + out(x + 1, y) + out(x, y - 1) + out(x, y + 1)
        }
    });
    let b: Vec<f32> = inside.values().iter().map(|is| if *is { 4.0 } else { 0.0 }).collect();
    let v = Solver::new(&inside, held).solve(&b, None, 1e-9);
    let top = v[150 * n + 150];
    assert!((top / (radius * radius) - 1.0).abs() < 0.01, "{top}");
}

/// A ragged square whose rim is held.
fn ragged_square(n: usize) -> (Plane<bool>, Plane<f32>) {
    let is_inner = |x: usize, y: usize| x > 0 && y > 0 && x + 1 < n && y + 1 < n;
    let inside = Plane::from_fn(Size::new(n as u32, n as u32), |x, y| {
        is_inner(x, y) && (x / 19 + y / 23) % 5 != 4
    });
    let held = Plane::from_fn(inside.size(), |x, y| {
        let out = |x: usize, y: usize| if inside.at(x, y) { 0.0 } else { 1.0 };
        if !inside.at(x, y) {
            0.0
        } else {
            out(x - 1, y) + out(x + 1, y) + out(x, y - 1) + out(x, y + 1)
        }
    });
    (inside, held)
}

#[test]
fn pixels_that_are_held_later_are_held_as_if_they_always_had_been() {
    let (inside, held) = ragged_square(97);
    let pixels: Vec<(usize, usize)> =
        (30..41).flat_map(|y| (24..31).map(move |x| (x, y))).collect();
    let more = Plane::from_fn(inside.size(), |x, y| {
        held.at(x, y) + if inside.at(x, y) && pixels.contains(&(x, y)) { 50.0 } else { 0.0 }
    });
    let b: Vec<f32> = inside.values().iter().map(|is| if *is { 1.0 } else { 0.0 }).collect();
    let mut later = Solver::new(&inside, held.clone());
    later.hold(&pixels, |x, y| more.at(x, y));
    let always = Solver::new(&inside, more);
    assert!(later.solve(&b, None, 1e-8) == always.solve(&b, None, 1e-8));
    later.hold(&pixels, |x, y| held.at(x, y));
    assert!(later.solve(&b, None, 1e-8) == Solver::new(&inside, held).solve(&b, None, 1e-8));
}

#[test]
fn a_field_that_is_nearly_right_comes_ten_times_nearer() {
    let (inside, held) = ragged_square(97);
    let (here, radius) = ((47.0f32, 34.0f32), 3.0);
    let is_near = |x: usize, y: usize| (x as f32 - here.0).hypot(y as f32 - here.1) < radius;
    let more = Plane::from_fn(inside.size(), |x, y| {
        held.at(x, y) + if inside.at(x, y) && is_near(x, y) { 1000.0 } else { 0.0 }
    });
    let b =
        Plane::from_fn(
            inside.size(),
            |x, y| if inside.at(x, y) && is_near(x, y) { 1000.0 } else { 0.0 },
        );
    let solver = Solver::new(&inside, more);
    let right = solver.solve(b.values(), None, 1e-14);
    let start = b.map(|b| if b > 0.0 { 1.0f32 } else { 0.0 }).into_values();
    let found = solver.approach(b.values(), start.clone(), Rect::new(32, 19, 63, 50));
    let off = |v: &[f32]| v.iter().zip(&right).map(|(a, b)| (a - b).abs()).fold(0.0f32, f32::max);
    assert!(
        off(&start) > 0.4 && off(&found) < 0.1 * off(&start),
        "{} of {}",
        off(&found),
        off(&start)
    );
}
