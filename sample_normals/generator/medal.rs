//! The medal: a blank with a rim, letters and a wreath.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::sdf::{cylinder, ellipsoid, object_from_camera, smooth_min, sphere, torus, v};
use crate::shapes::{Sample, framed, points, traced};
use crate::tube::Tube;

/// A struck medal: the initial in a wreath, with a beaded rim.
pub fn medal() -> Sample {
    let turn = object_from_camera(-16.0, 10.0, 0.0);
    let stem = Tube::through(&points(&[
        [-0.2, 0.4, 0.0, 0.085],
        [-0.2, 0.0, 0.0, 0.085],
        [-0.2, -0.4, 0.0, 0.085],
    ]));
    let bowl = Tube::through(&points(&[
        [-0.3, 0.4, 0.0, 0.05],
        [0.02, 0.41, 0.0, 0.06],
        [0.24, 0.31, 0.0, 0.085],
        [0.26, 0.11, 0.0, 0.09],
        [0.06, -0.01, 0.0, 0.06],
        [-0.16, -0.03, 0.0, 0.05],
    ]));
    let leg = Tube::through(&points(&[
        [0.0, -0.03, 0.0, 0.06],
        [0.13, -0.2, 0.0, 0.085],
        [0.27, -0.39, 0.0, 0.08],
        [0.4, -0.4, 0.0, 0.045],
    ]));
    let serif = Tube::through(&points(&[
        [-0.34, -0.41, 0.0, 0.04],
        [-0.2, -0.4, 0.0, 0.06],
        [-0.06, -0.41, 0.0, 0.04],
    ]));
    let distance = move |camera: DVec3| {
        let p = turn * camera;
        if p.length() > 1.3 {
            return p.length() - 1.15;
        }
        let q = p - v(0.0, 0.0, 0.08);
        let letter = [&bowl, &leg, &serif]
            .iter()
            .fold(stem.distance(q), |d, t| smooth_min(d, t.distance(q), 0.03));
        let relief = smooth_min(medal_blank(p), letter, 0.035);
        smooth_min(relief, wreath(p), 0.02)
    };
    framed("medal", traced(distance, 0.85), (480, 480), DVec2::ZERO, 1.08)
}

fn medal_blank(p: DVec3) -> f64 {
    let upright = v(p.x, p.z, -p.y);
    let radial = DVec2::new(p.x, p.y).length();
    // The field is slightly dished, so that it never reflects a single flat tone.
    let dish = 0.05 * (1.0 - (radial / 0.9).powi(2)).max(0.0);
    let plate = cylinder(upright, 1.0, 0.08 - 0.5 * dish, 0.05);
    let rim = torus(upright - v(0.0, 0.06, 0.0), 0.95, 0.06);
    let sector = TAU / 72.0;
    let turn = (p.y.atan2(p.x) / sector).round() * sector;
    let bead = v(0.845 * turn.cos(), 0.845 * turn.sin(), 0.065);
    smooth_min(smooth_min(plate, rim, 0.04), sphere(p - bead, 0.029), 0.012)
}

/// Two branches of leaves, open at the top.
fn wreath(p: DVec3) -> f64 {
    let q = v(p.x.abs(), p.y, p.z - 0.075);
    let radial = DVec2::new(q.x, q.y).length();
    if (radial - 0.67).abs() > 0.3 || q.z.abs() > 0.3 {
        return (radial - 0.67).abs().max(q.z.abs()) - 0.15;
    }
    let mut best = torus(v(p.x, p.z - 0.075, p.y), 0.67, 0.012).max(p.y - 0.52);
    for i in 0..11 {
        let angle = (-83.0 + 12.2 * f64::from(i)).to_radians();
        let foot = v(0.67 * angle.cos(), 0.67 * angle.sin(), 0.0);
        for side in [-1.0, 1.0] {
            let heading = angle + TAU / 4.0 - side * 0.52;
            let size = 1.0 - 0.025 * f64::from(i);
            let (s, c) = heading.sin_cos();
            let d = q - foot;
            // A leaf reaches 0.185 from its foot; farther ones blend with nothing.
            if d.length_squared() > 0.3 * 0.3 {
                best = best.min(d.length() - 0.2);
                continue;
            }
            let local = v(d.x * c + d.y * s, -d.x * s + d.y * c, d.z) / size;
            let ridge = 0.012 * (-(local.y / 0.012).powi(2)).exp();
            let tip = 0.036 * (1.0 - 3.2 * (local.x - 0.085));
            let blade = ellipsoid(local - v(0.085, 0.0, 0.004), v(0.098, tip.max(0.012), 0.032))
                + 0.5 * ridge;
            best = smooth_min(best, blade * size * 0.8, 0.006);
        }
    }
    best
}
