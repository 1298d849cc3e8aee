//! The sculpted head: a sleeping muse with combed hair, on a neck and a plinth.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3, DVec4};

use crate::render::Traced;
use crate::sdf::{
    capsule, carve, cylinder, ellipsoid, object_from_camera, smooth_max, smooth_min, smooth_step,
    sphere, torus, v,
};
use crate::shapes::{Sample, framed};
use crate::tube::Tube;

/// The curves of the face; the right half, the left is its mirror.
struct Lines {
    brow: Tube,
    lash: Tube,
    lid_fold: Tube,
    upper_lip: Tube,
    lower_lip: Tube,
    mouth: Tube,
}

/// The head, seen from a little to one side.
pub fn muse() -> Sample {
    let turn = object_from_camera(-24.0, 4.0, -5.0);
    let lines = Lines::new();
    let distance = move |camera: DVec3| {
        let p = turn * camera;
        let bound = p.distance(v(0.0, -0.1, -0.1)) - 1.45;
        if bound > 0.2 {
            return bound;
        }
        let right = v(p.x.abs(), p.y, p.z);
        let head = smooth_min(face(&lines, right), neck(p), 0.12);
        smooth_min(smooth_min(head, hair(p, right), 0.02), plinth(p), 0.01)
    };
    framed(
        "muse",
        Traced { distance, reach: 2.5, stride: 0.75 },
        (448, 576),
        DVec2::new(-0.03, -0.1),
        0.98,
    )
}

fn tube(list: &[[f64; 4]]) -> Tube {
    Tube::through(&list.iter().map(|p| DVec4::from_array(*p)).collect::<Vec<_>>())
}

impl Lines {
    fn new() -> Self {
        Self {
            brow: tube(&[
                [0.07, 0.09, 0.56, 0.02],
                [0.15, 0.165, 0.545, 0.034],
                [0.27, 0.19, 0.49, 0.034],
                [0.38, 0.15, 0.4, 0.026],
                [0.46, 0.06, 0.3, 0.012],
            ]),
            lash: tube(&[
                [0.1, -0.03, 0.51, 0.007],
                [0.15, -0.056, 0.538, 0.011],
                [0.215, -0.067, 0.547, 0.012],
                [0.29, -0.054, 0.52, 0.012],
                [0.355, -0.022, 0.44, 0.008],
            ]),
            lid_fold: tube(&[
                [0.1, 0.012, 0.52, 0.006],
                [0.15, 0.07, 0.54, 0.006],
                [0.225, 0.095, 0.53, 0.007],
                [0.3, 0.072, 0.5, 0.006],
                [0.355, 0.015, 0.44, 0.006],
            ]),
            upper_lip: tube(&[
                [-0.06, -0.468, 0.594, 0.028],
                [0.0, -0.482, 0.604, 0.026],
                [0.06, -0.468, 0.594, 0.028],
                [0.115, -0.482, 0.56, 0.02],
                [0.165, -0.488, 0.51, 0.008],
            ]),
            lower_lip: tube(&[
                [-0.06, -0.549, 0.58, 0.038],
                [0.0, -0.552, 0.586, 0.037],
                [0.06, -0.549, 0.58, 0.038],
                [0.11, -0.526, 0.55, 0.024],
                [0.155, -0.498, 0.515, 0.008],
            ]),
            mouth: tube(&[
                [-0.06, -0.502, 0.628, 0.009],
                [0.0, -0.51, 0.634, 0.009],
                [0.06, -0.502, 0.624, 0.009],
                [0.12, -0.502, 0.575, 0.01],
                [0.17, -0.487, 0.522, 0.008],
                [0.188, -0.478, 0.498, 0.004],
            ]),
        }
    }
}

fn face(lines: &Lines, p: DVec3) -> f64 {
    let skull = ellipsoid(p - v(0.0, 0.22, -0.12), v(0.57, 0.6, 0.66));
    let mass = ellipsoid(p - v(0.0, -0.2, 0.08), v(0.47, 0.63, 0.5));
    let jaw = ellipsoid(p - v(0.0, -0.56, 0.16), v(0.34, 0.26, 0.34));
    let chin = ellipsoid(p - v(0.0, -0.735, 0.37), v(0.13, 0.1, 0.12));
    let cheek = ellipsoid(p - v(0.235, -0.235, 0.37), v(0.16, 0.13, 0.14));
    let muzzle = ellipsoid(p - v(0.0, -0.485, 0.4), v(0.19, 0.14, 0.19));
    let mut d = smooth_min(skull, mass, 0.25);
    d = smooth_min(d, jaw, 0.22);
    d = smooth_min(d, chin, 0.16);
    d = smooth_min(d, cheek, 0.22);
    d = smooth_min(d, muzzle, 0.14);
    // Features are finer than this and all in front.
    if d > 0.25 {
        return d - 0.05;
    }
    d = eye(lines, d, p);
    d = smooth_min(d, nose(p), 0.07);
    d = nostrils(d, p);
    mouth(lines, ear(d, p), p)
}

fn eye(lines: &Lines, face: f64, p: DVec3) -> f64 {
    let socket = ellipsoid(p - v(0.215, 0.015, 0.63), v(0.16, 0.1, 0.13));
    let inner = sphere(p - v(0.085, 0.02, 0.6), 0.05);
    let ball = ellipsoid(p - v(0.22, -0.022, 0.4), v(0.155, 0.155, 0.152));
    let mut d = carve(face, socket, 0.14);
    d = carve(d, inner, 0.1);
    d = smooth_min(d, lines.brow.distance(p), 0.11);
    d = smooth_min(d, ball, 0.06);
    // The lashes' line is a groove with a lip above it: the upper lid lies over the lower.
    let lash = lines.lash.distance(p - v(0.0, 0.0, 0.008));
    d = smooth_min(d, lines.lash.distance(p - v(0.0, 0.02, -0.004)), 0.03);
    d = carve(d, lash, 0.016);
    carve(d, lines.lid_fold.distance(p), 0.03)
}

fn nose(p: DVec3) -> f64 {
    let bridge = capsule(p, v(0.0, 0.13, 0.53), v(0.0, -0.12, 0.625), 0.05, 0.05);
    let ridge = capsule(p, v(0.0, -0.1, 0.62), v(0.0, -0.275, 0.7), 0.05, 0.066);
    let tip = ellipsoid(p - v(0.0, -0.285, 0.705), v(0.07, 0.062, 0.07));
    let wing = ellipsoid(p - v(0.078, -0.305, 0.615), v(0.052, 0.052, 0.075));
    let column = capsule(p, v(0.0, -0.32, 0.7), v(0.0, -0.365, 0.6), 0.032, 0.03);
    let top = smooth_min(smooth_min(bridge, ridge, 0.06), tip, 0.05);
    smooth_min(smooth_min(top, column, 0.04), wing, 0.045)
}

fn nostrils(d: f64, p: DVec3) -> f64 {
    let opening = ellipsoid(p - v(0.044, -0.352, 0.66), v(0.022, 0.022, 0.045));
    let philtrum = capsule(p, v(0.0, -0.385, 0.618), v(0.0, -0.445, 0.63), 0.014, 0.022);
    let crease = capsule(p, v(0.125, -0.27, 0.6), v(0.225, -0.42, 0.56), 0.012, 0.006);
    carve(carve(carve(d, opening, 0.025), philtrum, 0.035), crease, 0.07)
}

fn mouth(lines: &Lines, face: f64, p: DVec3) -> f64 {
    let upper = lines.upper_lip.distance(p);
    let lower = lines.lower_lip.distance(p);
    let under = ellipsoid(p - v(0.0, -0.632, 0.58), v(0.11, 0.028, 0.05));
    let corner = sphere(p - v(0.2, -0.478, 0.53), 0.03);
    let mut d = carve(face, under, 0.09);
    d = carve(d, corner, 0.06);
    d = smooth_min(d, upper, 0.028);
    d = smooth_min(d, lower, 0.03);
    carve(d, lines.mouth.distance(p), 0.022)
}

fn ear(d: f64, p: DVec3) -> f64 {
    let lobe = ellipsoid(p - v(0.535, -0.2, -0.02), v(0.045, 0.09, 0.07));
    smooth_min(d, lobe, 0.05)
}

fn neck(p: DVec3) -> f64 {
    let throat = capsule(p, v(0.0, -0.5, -0.12), v(0.0, -1.12, -0.14), 0.27, 0.25);
    let flare = ellipsoid(p - v(0.0, -1.2, -0.14), v(0.36, 0.12, 0.33));
    smooth_min(throat, flare, 0.16)
}

fn plinth(p: DVec3) -> f64 {
    let q = p - v(0.0, -1.27, -0.14);
    let base = cylinder(q, 0.42, 0.075, 0.03);
    carve(base, torus(q - v(0.0, 0.01, 0.0), 0.43, 0.02), 0.02)
}

/// Hair parted in the middle, combed back in waves to a knot, held by a band.
fn hair(p: DVec3, right: DVec3) -> f64 {
    let q = right - v(0.0, 0.24, -0.15);
    let bun = smooth_min(knot_of_hair(p), flower(right), 0.015);
    let cap = ellipsoid(q, v(0.655, 0.66, 0.71));
    if cap > 0.25 {
        return smooth_min(cap - 0.03, bun, 0.06);
    }
    let opening = ellipsoid(right - v(0.0, -0.2, 0.85), v(0.535, 0.72, 0.79));
    let below = right.y + 0.42 + 0.35 * right.z;
    // Locks start along the parting and turn about the x axis; waves bend them as they go down.
    let down = q.x / 0.65;
    let around = (q.y + 0.15 * down).atan2(q.z) + 0.34 * (down * 7.5).sin() * 0.35;
    let locks = (around * 11.0).sin();
    let strands = (around * 43.0 + 1.2 * (down * 5.0).sin()).sin();
    let parting = -0.05 * (-(q.x / 0.035).powi(2)).exp() * smooth_step(-0.2, 0.3, q.y);
    let relief = 0.024 * locks + 0.0065 * strands;
    let grown = cap - (relief * smooth_step(0.0, 0.12, q.x) + parting);
    let cut = smooth_max(carve(grown, opening, 0.07), -below, 0.1);
    smooth_min(cut * 0.85, bun, 0.06)
}

/// A flower over the ear, where the locks meet.
fn flower(right: DVec3) -> f64 {
    let q = object_from_camera(66.0, 0.0, 0.0) * (right - v(0.635, 0.1, -0.13));
    if q.length() > 0.4 {
        return q.length() - 0.25;
    }
    let sector = TAU / 6.0;
    let turn = (q.y.atan2(q.x) / sector).round() * sector;
    let (s, c) = turn.sin_cos();
    let petal = v(q.x * c + q.y * s, -q.x * s + q.y * c, q.z);
    let radial = DVec2::new(q.x, q.y).length();
    // Petals rise outward and have a crease along the middle.
    let crease = 0.012 * (-(petal.y / 0.014).powi(2)).exp() * smooth_step(0.05, 0.09, radial);
    let bowl = v(petal.x - 0.115, petal.y, petal.z - 0.05 - 1.6 * radial * radial);
    let blade = (ellipsoid(bowl, v(0.088, 0.07, 0.026)) + crease) * 0.75;
    smooth_min(blade, sphere(q - v(0.0, 0.0, 0.055), 0.048), 0.02)
}

/// A bun with a spiral of strands.
fn knot_of_hair(p: DVec3) -> f64 {
    let q = p - v(0.0, 0.88, -0.36);
    if q.length() > 0.6 {
        return q.length() - 0.4;
    }
    let spiral = (q.z.atan2(q.x) * 2.0 + q.y * 26.0).sin();
    let fine = (q.z.atan2(q.x) * 6.0 + q.y * 78.0).sin();
    (ellipsoid(q, v(0.27, 0.22, 0.27)) - 0.014 * spiral - 0.004 * fine) * 0.85
}
