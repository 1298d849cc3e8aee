//! A cloth let fall over a ball: a small simulation by extended position-based dynamics.
//! Not here: the smooth sheet through its points and how it is seen (`sheet`).

use glam::{DVec2, DVec3};

use crate::noise::fbm2;
use crate::render::View;
use crate::sdf::{object_from_camera, v};
use crate::shapes::Sample;
use crate::sheet::Sheet;

/// Points along a side of the cloth.
const SIDE: usize = 96;
/// Length of the side, in model units.
const LENGTH: f64 = 2.5;
const BALL_RADIUS: f64 = 0.52;
/// Steps of the simulation, and the duration of one in seconds. Many short steps with one pass each
/// stretch less than few long ones with many passes.
const STEPS: usize = 2600;
const STEP_SECS: f64 = 1.0 / 700.0;

/// One spring: two points, the rest length, and its compliance (0 is rigid).
struct Spring {
    a: usize,
    b: usize,
    rest: f64,
    compliance: f64,
}

/// A cloth over a ball, seen from a little above.
pub fn drapery() -> Sample {
    let turn = object_from_camera(24.0, 20.0, 0.0).transpose();
    let points: Vec<DVec3> = fallen().into_iter().map(|p| turn * p).collect();
    let view = View { width: 496, height: 496, center: DVec2::new(0.0, -0.22), half_width: 0.86 };
    let surface = Sheet::new(&points, SIDE, &view);
    Sample { name: "drapery", surface: Box::new(surface), view }
}

/// The cloth's points at rest, row by row.
fn fallen() -> Vec<DVec3> {
    let mut now: Vec<DVec3> = (0..SIDE * SIDE).map(laid_out).collect();
    let mut before = now.clone();
    let springs = springs();
    for step in 0..STEPS {
        // Air slows the fall; toward the end it settles the last swinging.
        let drag = if step * 4 < STEPS * 3 { 0.9985 } else { 0.985 };
        for (p, q) in now.iter_mut().zip(&mut before) {
            let moved = (*p - *q) * drag;
            *q = *p;
            *p += moved + v(0.0, -9.8 * STEP_SECS * STEP_SECS, 0.0);
        }
        for spring in &springs {
            relax(spring, &mut now);
        }
        for (p, q) in now.iter_mut().zip(&mut before) {
            rest_on_ball(p, q);
        }
    }
    now
}

/// Where point `i` starts: a level sheet, turned in its plane, with slight dents that seed the
/// folds.
fn laid_out(i: usize) -> DVec3 {
    let at =
        DVec2::new((i % SIDE) as f64, (i / SIDE) as f64) / (SIDE - 1) as f64 - DVec2::splat(0.5);
    let dent = 0.02 * fbm2(at * 7.0, 2, 0, 31);
    let flat = DVec2::from_angle(0.35).rotate(at * LENGTH);
    v(flat.x + 0.05, BALL_RADIUS + 0.03 + dent, flat.y - 0.03)
}

/// Springs along the threads, across the diagonals, and over two cells against bending.
fn springs() -> Vec<Spring> {
    let mut list = Vec::new();
    let cell = LENGTH / (SIDE - 1) as f64;
    for y in 0..SIDE as i64 {
        for x in 0..SIDE as i64 {
            for (dx, dy, compliance) in [
                (1, 0, 0.0),
                (0, 1, 0.0),
                (1, 1, 3e-6),
                (-1, 1, 3e-6),
                (2, 0, 4e-5),
                (0, 2, 4e-5),
                (4, 0, 6e-4),
                (0, 4, 6e-4),
            ] {
                let (u, w) = (x + dx, y + dy);
                if u < 0 || u >= SIDE as i64 || w >= SIDE as i64 {
                    continue;
                }
                let rest = cell * ((dx * dx + dy * dy) as f64).sqrt();
                list.push(Spring {
                    a: (y as usize) * SIDE + x as usize,
                    b: w as usize * SIDE + u as usize,
                    rest,
                    compliance,
                });
            }
        }
    }
    list
}

fn relax(spring: &Spring, points: &mut [DVec3]) {
    let between = points[spring.b] - points[spring.a];
    let length = between.length().max(1e-9);
    // Unit masses: w_a + w_b = 2.
    let pull = (length - spring.rest) / (2.0 + spring.compliance / (STEP_SECS * STEP_SECS));
    let shift = between * (pull / length);
    points[spring.a] += shift;
    points[spring.b] -= shift;
}

/// Keeps a point off the ball; friction takes most of its slide.
fn rest_on_ball(p: &mut DVec3, before: &mut DVec3) {
    let r = p.length();
    if r < BALL_RADIUS {
        *p *= BALL_RADIUS / r;
        *before += (*p - *before) * 0.3;
    }
}
