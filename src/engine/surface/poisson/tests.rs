use super::*;
use crate::math::hash;

/// A ragged disc and a band that touches it along a row of slack couplings.
fn ragged_grid(w: usize, h: usize) -> PoissonGrid {
    let held = |x: usize, y: usize| {
        let (dx, dy) = (x as f32 / w as f32 - 0.5, y as f32 / h as f32 - 0.5);
        dx.hypot(dy) < 0.45 && !(x * 7 + y * 13).is_multiple_of(41) || y < 4
    };
    let coupling = |x: usize, y: usize, dx: usize, dy: usize| {
        let there = x + dx < w && y + dy < h && held(x, y) && held(x + dx, y + dy);
        let slack = if dx == 1 && x == w / 2 || dy == 1 && y == h / 3 { 1e-3 } else { 1.0 };
        if there { slack * (0.2 + 0.8 * hash::unit(5, x as u32, y as u32)) } else { 0.0 }
    };
    let plane = |dx, dy| (0..w * h).map(|i| coupling(i % w, i / w, dx, dy)).collect();
    PoissonGrid::new(w, plane(1, 0), plane(0, 1))
}

fn apply(grid: &PoissonGrid, v: &[f32]) -> Vec<f32> {
    let force = |i: usize| {
        let (sum, pull) = grid.pull(v, i);
        sum * v[i] - pull
    };
    (0..v.len()).map(force).collect()
}

fn length(v: &[f32]) -> f64 {
    v.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn a_known_solution_is_found_on_a_ragged_grid_in_few_steps() {
    for (w, h) in [(53, 38), (200, 131), (1, 40), (40, 1), (1, 1)] {
        let truth: Vec<f32> =
            (0..w * h).map(|i| ((i % w) as f32 * 0.2).sin() * 5.0 + (i / w) as f32 * 0.3).collect();
        let b = apply(&ragged_grid(w, h), &truth);
        let solver = PoissonSolver::new(ragged_grid(w, h));
        let mut found = vec![0.0; w * h];
        let steps = solver.solve(&b, &mut found, Effort::EXACT, &mut SolveScratch::default());
        let off: Vec<f32> =
            apply(solver.grid(), &found).iter().zip(&b).map(|(a, b)| a - b).collect();
        assert!(length(&off) <= 3e-5 * length(&b), "{w} × {h}: {} of {}", length(&off), length(&b));
        assert!(steps <= 16, "{w} × {h}: {steps} steps");
    }
}

#[test]
fn a_good_beginning_saves_steps() {
    let (w, h) = (120, 90);
    let truth: Vec<f32> =
        (0..w * h).map(|i| (i % w) as f32 * 0.3 + ((i / w) as f32 * 0.1).cos()).collect();
    let b = apply(&ragged_grid(w, h), &truth);
    let solver = PoissonSolver::new(ragged_grid(w, h));
    let mut scratch = SolveScratch::default();
    let cold = solver.solve(&b, &mut vec![0.0; w * h], Effort::EXACT, &mut scratch);
    let warm = solver.solve(&b, &mut truth.clone(), Effort::EXACT, &mut scratch);
    assert!(warm == 0 && cold > 3, "{warm} and {cold} steps");
}

#[test]
fn rows_do_as_the_equation_says() {
    let grid = ragged_grid(70, 40);
    let v: Vec<f32> = (0..70 * 40).map(|i| hash::unit(9, i, 0)).collect();
    let b: Vec<f32> = (0..70 * 40).map(|i| hash::unit(9, i, 1)).collect();
    let (mut out, force) = (vec![0.0; 70], apply(&grid, &v));
    for y in 0..40 {
        let at = y * 70..(y + 1) * 70;
        rows::residual_row(grid.row(y), neighboring_rows(&v, 70, y), &b[at.clone()], &mut out);
        for (x, (i, out)) in at.clone().zip(&out).enumerate() {
            assert!((b[i] - force[i] - out).abs() < 1e-5, "residual at {x}, {y}");
        }
        rows::relax_row(grid.row(y), neighboring_rows(&v, 70, y), &b[at.clone()], 0.7, &mut out);
        for (i, out) in at.clone().zip(&out) {
            let (sum, pull) = grid.pull(&v, i);
            let told = if sum > 0.0 { v[i] + 0.7 * ((b[i] + pull) / sum - v[i]) } else { *out };
            assert!((told - out).abs() < 1e-5);
        }
    }
}

#[test]
fn pieces_are_what_springs_hold_together() {
    // Two islands of 3 × 3 in a sea, and a lone pixel.
    let held = |x: usize, y: usize| y < 3 && (x < 3 || (5..8).contains(&x)) || (x, y) == (4, 8);
    let plane = |dx: usize, dy: usize| {
        let coupling = |i: usize| {
            let (x, y) = (i % 12, i / 12);
            if x + dx < 12 && held(x, y) && held(x + dx, y + dy) { 1.0 } else { 0.0 }
        };
        (0..120).map(coupling).collect::<Vec<f32>>()
    };
    let (labels, count) =
        PoissonSolver::new(PoissonGrid::new(12, plane(1, 0), plane(0, 1))).pieces();
    assert_eq!(count, 2);
    for (i, label) in labels.iter().enumerate() {
        let (x, y) = (i % 12, i / 12);
        let expected = if y < 3 && x < 3 {
            0
        } else if y < 3 && (5..8).contains(&x) {
            1
        } else {
            u32::MAX
        };
        assert_eq!(*label, expected, "({x}, {y})");
    }
}
