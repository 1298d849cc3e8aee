//! Normals measured by photometric stereo: a surface is photographed under one lamp after another,
//! and what the pictures say is solved for its normals, as capturing rigs do. What disturbs those is
//! in the photographs: shadows, gloss, light from the stone itself, lamps that are not far away, and
//! the camera's noise. Not here: what is photographed (`fossil`).

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3};
use image::{Rgba, RgbaImage};
use rayon::prelude::*;

use crate::fossil::{Place, fossil};
use crate::noise::hash;
use crate::painting::{encoded, srgb};

/// Pixels of a side, and samples of a pixel's side.
const SIDE: usize = 416;
const SUB: usize = 2;
const FINE: usize = SIDE * SUB;
/// The picture shows the model from −`HALF` to `HALF`.
const HALF: f64 = 1.04;
/// How far the lamps are from the middle; solved as if they were infinitely far.
const LAMPS_FAR: f64 = 8.0;
/// Photographs of a pixel that are not trusted: the darkest (shadow) and the brightest (gloss).
const DARKEST: usize = 5;
const BRIGHTEST: usize = 2;

/// What was measured, row by row from the top.
pub struct Captured {
    /// Unit normals, camera space, +y up.
    pub normals: RgbaImage,
    /// Share of each pixel that the surface covers.
    pub mask: Vec<u8>,
    /// One of the photographs.
    pub photograph: RgbaImage,
    /// The mean angle between measured and true normals, degrees.
    pub error: f64,
}

/// A sample of the true surface.
#[derive(Clone, Copy)]
struct Truth {
    place: Place,
    normal: DVec3,
}

/// Directions of the lamps: eight low ones and five high ones.
fn lamps() -> Vec<DVec3> {
    let ring = |count: usize, height: f64, from: f64| {
        (0..count).map(move |i| {
            let angle = TAU * (i as f64 / count as f64) + from;
            let (sin, cos) = height.to_radians().sin_cos();
            DVec3::new(cos * angle.cos(), cos * angle.sin(), sin)
        })
    };
    ring(8, 44.0, 0.3).chain(ring(5, 63.0, 0.0)).collect()
}

fn model_from_fine(x: f64, y: f64) -> DVec2 {
    DVec2::new(x - 0.5 * FINE as f64, 0.5 * FINE as f64 - y) * (2.0 * HALF / FINE as f64)
}

fn truth() -> Vec<Truth> {
    const REACH: f64 = 4e-4;
    let sample = |i: usize| {
        let p = model_from_fine((i % FINE) as f64 + 0.5, (i / FINE) as f64 + 0.5);
        let place = fossil(p);
        let height = |dx: f64, dy: f64| fossil(p + DVec2::new(dx, dy)).height;
        let slope = |ahead: Option<f64>, behind: Option<f64>| match (ahead, behind) {
            (Some(a), Some(b)) => (a - b) / (2.0 * REACH),
            _ => 0.0,
        };
        let along = slope(height(REACH, 0.0), height(-REACH, 0.0));
        let up = slope(height(0.0, REACH), height(0.0, -REACH));
        Truth { place, normal: DVec3::new(-along, -up, 1.0).normalize_or(DVec3::Z) }
    };
    (0..FINE * FINE).into_par_iter().with_min_len(FINE).map(sample).collect()
}

/// What reaches a fine pixel from a lamp, 0 … 1: marched over the heights, a little soft.
fn light_seen(truth: &[Truth], i: usize, toward: DVec3) -> f64 {
    let step = 2.0 * HALF / FINE as f64;
    let Some(start) = truth[i].place.height else { return 0.0 };
    let run = toward.truncate().length();
    let (across, rise) = (toward.truncate() / run, toward.z / run);
    let mut seen: f64 = 1.0;
    let mut far = 1.5;
    while far < 0.4 * FINE as f64 && seen > 0.0 {
        let (x, y) = ((i % FINE) as f64 + across.x * far, (i / FINE) as f64 - across.y * far);
        if x < 0.0 || y < 0.0 || x >= FINE as f64 || y >= FINE as f64 {
            break;
        }
        let blocker = truth[y as usize * FINE + x as usize].place.height.unwrap_or(f64::MIN);
        let over = start + rise * far * step - blocker;
        // The lamp is a disc, a twelfth as wide as it is far.
        seen = seen.min(0.5 + over / (far * step * 0.085).max(step));
        far += 1.0 + 0.02 * far;
    }
    seen.clamp(0.0, 1.0)
}

/// The photograph under one lamp: linear light per pixel, before the camera.
fn photograph(truth: &[Truth], lamp: DVec3) -> Vec<DVec3> {
    let fine = |i: usize| -> DVec3 {
        let Truth { place, normal } = truth[i];
        let Some(height) = place.height else { return DVec3::ZERO };
        let p = model_from_fine((i % FINE) as f64 + 0.5, (i / FINE) as f64 + 0.5);
        let to_lamp = lamp * LAMPS_FAR - p.extend(height);
        let toward = to_lamp.normalize_or(lamp);
        let falloff = LAMPS_FAR * LAMPS_FAR / to_lamp.length_squared();
        let direct = normal.dot(toward).max(0.0) * light_seen(truth, i, toward) * falloff;
        let half = (toward + DVec3::Z).normalize_or(DVec3::Z);
        let shine = 0.5 * place.gloss * normal.dot(half).max(0.0).powf(34.0) * direct;
        // Walls and stone send some light back, mostly to what lies open.
        let around = 0.035 + 0.045 * normal.z;
        place.albedo * (1.5 * direct + around) + DVec3::splat(0.22 * shine)
    };
    let pixel = |i: usize| {
        let corner = (i / SIDE) * SUB * FINE + (i % SIDE) * SUB;
        let subs = (0..SUB * SUB).map(|s| fine(corner + s / SUB * FINE + s % SUB));
        subs.sum::<DVec3>() / (SUB * SUB) as f64
    };
    (0..SIDE * SIDE).into_par_iter().with_min_len(SIDE).map(pixel).collect()
}

/// What the camera makes of it: grain by the number of photons, then eight bits.
fn exposed(light: f64, pixel: usize, seed: u64) -> u8 {
    let (a, b) = (hash(pixel as i64, 0, seed), hash(pixel as i64, 1, seed));
    let normal = (-2.0 * (1.0 - a).ln()).sqrt() * (TAU * b).cos();
    encoded(light + normal * (light.max(0.0) / 4000.0 + 2e-6).sqrt())
}

/// The normal that explains the brightness under each lamp best, by least squares over the
/// photographs that are trusted.
fn solved(lamps: &[DVec3], brightness: &[f64]) -> DVec3 {
    let mut order: Vec<usize> = (0..lamps.len()).collect();
    order.sort_by(|a, b| brightness[*a].total_cmp(&brightness[*b]));
    let (mut matrix, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for &k in &order[DARKEST..lamps.len() - BRIGHTEST] {
        let l = lamps[k];
        matrix += DMat3::from_cols(l * l.x, l * l.y, l * l.z);
        right += l * brightness[k];
    }
    if matrix.determinant().abs() < 1e-9 {
        return DVec3::Z;
    }
    let n = matrix.inverse() * right;
    DVec3::new(n.x, n.y, n.z.max(0.02 * n.length())).normalize_or(DVec3::Z)
}

/// Photographs the fossil under every lamp and solves for its normals.
pub fn capture() -> Captured {
    let (truth, lamps) = (truth(), lamps());
    let photographs: Vec<Vec<[u8; 3]>> = lamps
        .iter()
        .enumerate()
        .map(|(k, lamp)| {
            let taken = photograph(&truth, *lamp);
            let seed = |c: usize| 1000 + 3 * k as u64 + c as u64;
            let camera = |(i, light): (usize, &DVec3)| {
                std::array::from_fn(|c| exposed(light[c], i, seed(c)))
            };
            taken.iter().enumerate().map(camera).collect()
        })
        .collect();
    let linear: Vec<f64> = (0..=255).map(|byte: u32| srgb(byte * 0x01_01_01).x).collect();
    let fine_of = |i: usize| {
        let corner = (i / SIDE) * SUB * FINE + (i % SIDE) * SUB;
        (0..SUB * SUB).map(move |s| corner + s / SUB * FINE + s % SUB)
    };
    let mask: Vec<u8> = (0..SIDE * SIDE)
        .map(|i| {
            let covered = fine_of(i).filter(|f| truth[*f].place.height.is_some()).count();
            (covered * 255 / (SUB * SUB)) as u8
        })
        .collect();
    let normals: Vec<DVec3> = (0..SIDE * SIDE)
        .into_par_iter()
        .map(|i| {
            let brightness: Vec<f64> = photographs
                .iter()
                .map(|photo| photo[i].iter().map(|c| linear[usize::from(*c)]).sum())
                .collect();
            if mask[i] == 0 { DVec3::Z } else { solved(&lamps, &brightness) }
        })
        .collect();
    let inside: Vec<usize> = (0..SIDE * SIDE).filter(|i| mask[*i] == 255).collect();
    let off = |i: &usize| {
        let true_normal: DVec3 = fine_of(*i).map(|f| truth[f].normal).sum();
        normals[*i].angle_between(true_normal).to_degrees()
    };
    let error = inside.iter().map(off).sum::<f64>() / inside.len() as f64;
    let picture = |pixel: &dyn Fn(usize) -> [u8; 3]| {
        RgbaImage::from_fn(SIDE as u32, SIDE as u32, |x, y| {
            let [r, g, b] = pixel(y as usize * SIDE + x as usize);
            Rgba([r, g, b, 255])
        })
    };
    let as_color = |i: usize| normals[i].to_array().map(|c| (c * 127.5 + 127.5).round() as u8);
    Captured {
        normals: picture(&as_color),
        mask,
        photograph: picture(&|i| photographs[10][i]),
        error,
    }
}
