//! The sample pictures that are not landscapes: all of them listed, and a studio, a weave and lit
//! spheres. Not here: textures (`textures`, `patterns`), decals (`decals`), how pixels are computed
//! (`painting`). Textures whose doc says seamless repeat without a seam.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use image::{Rgb, Rgba, RgbaImage};
use rayon::prelude::*;

use crate::painting::{TEXTURE, painted, rolled_off, srgb};
use crate::sdf::{smooth_step, v};
use crate::{decals, patterns, textures};

/// A picture and the file name it goes by.
pub type Picture = (&'static str, fn() -> RgbaImage);

/// Every picture of this module.
pub const PICTURES: [Picture; 14] = [
    ("studio.jpg", studio),
    ("tartan.jpg", textures::tartan),
    ("scales.jpg", textures::scales),
    ("marble.jpg", textures::marble),
    ("bricks.jpg", textures::bricks),
    ("knit.jpg", patterns::knit),
    ("tiles.jpg", patterns::tiles),
    ("soft_noise.jpg", textures::soft_noise),
    ("star.png", decals::star),
    ("leaf.png", decals::leaf),
    ("window.png", decals::window),
    ("weave_normal.png", weave_normal),
    ("sphere_wax.png", sphere_wax),
    ("sphere_ink.png", sphere_ink),
];

/// A rectangular light with soft edges, seen from the origin.
struct SoftBox {
    toward: DVec3,
    half: DVec2,
    /// Degrees around its own axis.
    roll: f64,
    light: DVec3,
}

impl SoftBox {
    fn seen(&self, d: DVec3) -> DVec3 {
        let axis = self.toward.normalize_or(DVec3::Z);
        let facing = d.dot(axis);
        if facing < 0.05 {
            return DVec3::ZERO;
        }
        let right = DVec3::Y.cross(axis).normalize_or(DVec3::X);
        let up = axis.cross(right);
        let flat = DVec2::new(d.dot(right), d.dot(up)) / facing;
        let q = DVec2::from_angle(self.roll.to_radians()).rotate(flat).abs() / self.half;
        let inside = smooth_step(1.0, 0.93, q.x) * smooth_step(1.0, 0.93, q.y);
        let hot = 0.62 + 0.38 * (-1.6 * q.length_squared()).exp();
        // Around the fabric, the glow it throws on dust and lens.
        let glow = 0.035 * (-2.0 * (q - DVec2::ONE).max(DVec2::ZERO).length()).exp();
        self.light * (inside * hot + glow)
    }
}

/// An angular map of the studio. The center is straight behind the viewer, the circle that touches
/// the sides straight ahead.
fn studio() -> RgbaImage {
    let side = f64::from(TEXTURE);
    let lights = soft_boxes();
    painted((TEXTURE, TEXTURE), 3, |p| {
        let q = (p / side * 2.0 - DVec2::ONE) * DVec2::new(1.0, -1.0);
        let r = q.length();
        let around = if r > 1e-9 { q / r } else { DVec2::X };
        let turn = PI * r.min(1.0);
        let d = (around * turn.sin()).extend(turn.cos());
        rolled_off(studio_light(&lights, d) * 1.15).extend(1.0)
    })
}

/// The light of the studio itself, not rolled off: a latitude-longitude map of 256 × 128 pixels,
/// its lamps far above white.
pub fn studio_lat_long() -> (usize, usize, Vec<Rgb<f32>>) {
    const SIZE: (usize, usize) = (256, 128);
    const FINE: usize = 4;
    let lights = soft_boxes();
    let pixel = |i: usize| {
        let mut sum = DVec3::ZERO;
        for k in 0..FINE * FINE {
            let part = |k: usize| (k as f64 + 0.5) / FINE as f64;
            let u = ((i % SIZE.0) as f64 + part(k % FINE)) / SIZE.0 as f64 * TAU;
            let w = ((i / SIZE.0) as f64 + part(k / FINE)) / SIZE.1 as f64 * PI;
            sum += studio_light(&lights, v(u.sin() * w.sin(), w.cos(), -u.cos() * w.sin()));
        }
        let mean = (sum / (FINE * FINE) as f64).as_vec3();
        Rgb(mean.to_array())
    };
    (SIZE.0, SIZE.1, (0..SIZE.0 * SIZE.1).into_par_iter().map(pixel).collect())
}

/// Linear light from a direction: soft boxes before a graded wall.
fn studio_light(lights: &[SoftBox], d: DVec3) -> DVec3 {
    lights.iter().fold(studio_room(d), |light, soft_box| light + soft_box.seen(d))
}

fn soft_boxes() -> [SoftBox; 5] {
    [
        SoftBox {
            toward: v(-0.95, 0.5, 0.85),
            half: DVec2::new(0.4, 0.52),
            roll: 8.0,
            light: v(3.2, 3.1, 2.95),
        },
        SoftBox {
            toward: v(1.2, 0.22, 0.35),
            half: DVec2::new(0.14, 0.95),
            roll: -4.0,
            light: v(2.0, 2.2, 2.5),
        },
        SoftBox {
            toward: v(0.35, 1.3, 0.1),
            half: DVec2::new(0.6, 0.2),
            roll: 12.0,
            light: v(2.3, 2.25, 2.2),
        },
        SoftBox {
            toward: v(-1.0, 0.1, -0.9),
            half: DVec2::new(0.12, 0.8),
            roll: 0.0,
            light: v(2.6, 2.0, 1.4),
        },
        SoftBox {
            toward: v(0.55, -0.62, 0.8),
            half: DVec2::new(0.36, 0.13),
            roll: 20.0,
            light: v(0.55, 0.42, 0.3),
        },
    ]
}

/// Normals of a plain weave, eight threads each way: tangent space, green up. Seamless.
fn weave_normal() -> RgbaImage {
    const THREADS: f64 = 8.0;
    const SIDE: u32 = 192;
    let height = |p: DVec2| {
        let q = p / f64::from(SIDE) * THREADS;
        let (x, y) = (q.x.rem_euclid(THREADS), q.y.rem_euclid(THREADS));
        // A thread is round across and rises over every second one it meets.
        let thread = |across: f64, along: f64, parity: i64| {
            let round = (1.0 - (2.0 * across.fract() - 1.0).powi(2)).max(0.0).sqrt();
            let over = (PI * (along + (across.floor() as i64 + parity).rem_euclid(2) as f64)).sin();
            (0.55 + 0.45 * over) * round
        };
        thread(x, y, 0).max(thread(y, x, 1)) * 0.5 / THREADS * f64::from(SIDE)
    };
    let pixel = |x: u32, y: u32| {
        let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let slope = |d: DVec2| (height(p + d) - height(p - d)) / 2.0;
        let n = v(-slope(DVec2::X), slope(DVec2::Y), 1.0).normalize();
        let byte = |c: f64| ((c * 0.5 + 0.5) * 255.0).round() as u8;
        Rgba([byte(n.x), byte(n.y), byte(n.z), 255])
    };
    RgbaImage::from_fn(SIDE, SIDE, pixel)
}

/// Floor, cove and wall, without the lights.
fn studio_room(d: DVec3) -> DVec3 {
    let wall = srgb(0x1b2430).lerp(srgb(0x76808c), smooth_step(-0.15, 0.55, d.y - 0.25 * d.x));
    let ceiling = srgb(0x0c0f14);
    let floor =
        srgb(0x2a2623).lerp(srgb(0x6e6258), smooth_step(-1.0, -0.1, d.y) * (0.55 + 0.45 * d.z));
    let room = floor.lerp(wall, smooth_step(-0.22, 0.02, d.y));
    let room = room.lerp(ceiling, smooth_step(0.62, 0.95, d.y));
    // A black card on the right gives edges something dark to mirror.
    let card = smooth_step(0.12, 0.06, (d.x - 0.62).abs())
        * smooth_step(0.66, 0.6, d.y.abs())
        * smooth_step(0.0, 0.1, d.z);
    room * (1.0 - 0.92 * card)
}

/// A lit sphere of pale wax: warm light from the upper left, a cool sky, red where little light
/// comes through.
fn sphere_wax() -> RgbaImage {
    lit_sphere(|n| {
        let (key, sky) = (n.dot(v(-0.5, 0.6, 0.62)), 0.5 + 0.5 * n.y);
        let matt = srgb(0x6a2a20).lerp(srgb(0xf0c898), smooth_step(-0.35, 0.95, key));
        let sheen = smooth_step(0.55, 0.9, key) * 0.25
            + smooth_step(0.93, 0.985, n.dot(v(-0.28, 0.34, 0.9))) * 0.45;
        matt + srgb(0x27405f) * 0.35 * sky * (1.0 - n.z) + DVec3::splat(sheen)
    })
}

/// A lit sphere of ink wash: blue shade that closes toward the contour.
fn sphere_ink() -> RgbaImage {
    lit_sphere(|n| {
        let light = smooth_step(-0.5, 1.0, n.dot(v(-0.5, 0.6, 0.62)));
        srgb(0x101c3c).lerp(srgb(0x7f8fae), light) * (0.25 + 0.75 * smooth_step(0.0, 0.6, n.z))
    })
}

/// A sphere seen from the front, its color from its normal (y up).
fn lit_sphere(color: impl Fn(DVec3) -> DVec3 + Sync) -> RgbaImage {
    const SIDE: f64 = 192.0;
    painted((SIDE as u32, SIDE as u32), 3, |q| {
        let (x, y) = (q.x / SIDE * 2.0 - 1.0, 1.0 - q.y / SIDE * 2.0);
        let r = x.hypot(y);
        // The contour's color continues beyond it, under a soft edge.
        let (x, y) = if r > 0.999 { (x / r * 0.999, y / r * 0.999) } else { (x, y) };
        let n = v(x, y, (1.0 - x * x - y * y).max(0.0).sqrt());
        color(n).extend(1.0 - smooth_step(1.0, 1.01, r))
    })
}
