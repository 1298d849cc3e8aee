//! The snail: a body, its stalks, and a shell that winds up.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3, DVec4};

use crate::noise::fbm3;
use crate::sdf::{capsule, carve, ellipsoid, object_from_camera, smooth_min, sphere, v};
use crate::shapes::{Sample, framed, points, traced};
use crate::tube::Tube;

/// A snail, its shell a logarithmic spiral.
pub fn snail() -> Sample {
    let turn = object_from_camera(-20.0, 12.0, 0.0);
    let shell = Tube::open(&shell_spiral());
    let body = Tube::through(&points(&[
        [-1.25, -0.7, 0.0, 0.05],
        [-0.95, -0.66, 0.0, 0.11],
        [-0.5, -0.58, 0.0, 0.2],
        [0.0, -0.54, 0.0, 0.25],
        [0.45, -0.52, 0.02, 0.23],
        [0.78, -0.36, 0.06, 0.2],
        [0.98, -0.08, 0.1, 0.19],
        [1.08, 0.06, 0.13, 0.19],
    ]));
    let stalk = Tube::through(&points(&[
        [1.06, 0.12, 0.18, 0.06],
        [1.12, 0.34, 0.2, 0.042],
        [1.24, 0.54, 0.22, 0.036],
        [1.34, 0.68, 0.24, 0.04],
    ]));
    let mouth = snail_mouth();
    let distance = move |camera: DVec3| {
        let p = turn * camera;
        let coil = shell_distance(&shell, p);
        smooth_min(coil, snail_body(&body, &stalk, &mouth, p), 0.035)
    };
    framed("snail", traced(distance, 0.75), (600, 400), DVec2::new(0.14, 0.02), 1.6)
}

fn snail_body(body: &Tube, stalk: &Tube, mouth: &Tube, p: DVec3) -> f64 {
    // The sole is flat and its hem ripples.
    let hem = ellipsoid(p - v(-0.24, -0.76, 0.0), v(1.02, 0.07, 0.3 + 0.012 * (22.0 * p.x).sin()));
    let flesh = body.distance(p);
    // The skin is worth its price only near the surface.
    let skin = if flesh < 0.1 { 0.004 * fbm3(p * v(9.0, 13.0, 9.0), 1, 5) } else { 0.0 };
    let trunk = smooth_min(flesh + skin, hem * 0.8, 0.14);
    let mirrored = v(p.x, p.y, (p.z - 0.12).abs() + 0.12);
    let eye = sphere(mirrored - v(1.34, 0.7, 0.24), 0.07);
    let feeler = capsule(mirrored, v(1.2, -0.04, 0.2), v(1.37, -0.13, 0.25), 0.03, 0.038);
    let cheek = ellipsoid(p - v(1.11, 0.03, 0.12), v(0.2, 0.175, 0.18));
    let head = smooth_min(smooth_min(trunk, cheek, 0.1), feeler, 0.05);
    let eyes = smooth_min(stalk.distance(mirrored), eye, 0.03);
    carve(smooth_min(head, eyes, 0.06), mouth.distance(p), 0.03)
}

/// The groove of the snail's smile, around the front of its head.
fn snail_mouth() -> Tube {
    let spot = |i: i32| {
        let turn = f64::from(i) * 0.24;
        v(1.11 + 0.21 * turn.cos(), 0.005 + 0.05 * turn * turn, 0.12 + 0.19 * turn.sin())
            .extend(0.016 - 0.0015 * f64::from(i.abs()))
    };
    Tube::through(&(-6..=6).map(spot).collect::<Vec<_>>())
}

/// Control points of the shell's coil: three and a half turns, each 2.1 times as wide as the one
/// before.
fn shell_spiral() -> Vec<DVec4> {
    const TURNS: f64 = 3.4;
    const GROWTH: f64 = 2.15;
    (0..=68)
        .map(|i| {
            let turn = f64::from(i) / 68.0 * TURNS;
            let size = GROWTH.powf(turn - TURNS);
            let angle = -TAU * (turn - TURNS) - 0.9;
            let reach = 0.62 * size;
            // The apex rises out of the coil's plane, on the viewer's side.
            v(-0.16 + reach * angle.cos(), 0.16 + reach * angle.sin(), 0.34 * (1.0 - size) - 0.04)
                .extend(0.37 * size + 0.012)
        })
        .collect()
}

fn shell_distance(shell: &Tube, p: DVec3) -> f64 {
    let (d, along) = shell.nearest(p);
    if d > 0.2 {
        return d - 0.05;
    }
    // Growth lines: fine, closer together toward the apex as the spiral itself is.
    let lines = (along * 6.0).sin() + 0.3 * (along * 17.0 + 2.0).sin();
    let size = 2.15_f64.powf((along - 68.0) / 20.0);
    d + 0.007 * size * lines
}
