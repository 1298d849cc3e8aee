//! The sample pictures that are not landscapes: a studio, textures, decals, a window's shadow.
//! Colours are linear light until [`encoded`]; textures whose doc says seamless repeat without a seam.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, DVec4};
use image::{Rgb, Rgba, RgbaImage};
use rayon::prelude::*;

use crate::noise::{fbm2, hash, noise2};
use crate::patterns;
use crate::sdf::{segment2, smooth_step, v};

/// Side of the square textures, in pixels.
const TEXTURE: u32 = 512;

/// A picture and the file name it goes by.
pub type Picture = (&'static str, fn() -> RgbaImage);

/// Every picture of this module.
pub const PICTURES: [Picture; 14] = [
    ("studio.jpg", studio),
    ("tartan.jpg", tartan),
    ("scales.jpg", scales),
    ("marble.jpg", marble),
    ("bricks.jpg", bricks),
    ("knit.jpg", patterns::knit),
    ("tiles.jpg", patterns::tiles),
    ("soft_noise.jpg", soft_noise),
    ("star.png", star),
    ("leaf.png", leaf),
    ("window.png", window),
    ("weave_normal.png", weave_normal),
    ("sphere_wax.png", sphere_wax),
    ("sphere_ink.png", sphere_ink),
];

/// Linear light in `[0, 1]` as an sRGB byte.
fn encoded(linear: f64) -> u8 {
    let c = linear.clamp(0.0, 1.0);
    let srgb = if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    (srgb * 255.0).round() as u8
}

/// The linear colour of an sRGB one written as `0xRRGGBB`.
pub fn srgb(hex: u32) -> DVec3 {
    let channel = |shift: u32| {
        let c = f64::from(hex >> shift & 255) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    v(channel(16), channel(8), channel(0))
}

/// Highlights roll off to white instead of clipping.
pub fn rolled_off(c: DVec3) -> DVec3 {
    DVec3::ONE - (-c).exp()
}

/// A picture from straight (not premultiplied) linear colour and alpha, averaged over `fine` × `fine` points per pixel.
pub fn painted((width, height): (u32, u32), fine: u32, colour: impl Fn(DVec2) -> DVec4 + Sync) -> RgbaImage {
    let pixel = |i: usize| {
        let corner = DVec2::new((i % width as usize) as f64, (i / width as usize) as f64);
        let mut sum = DVec4::ZERO;
        for k in 0..fine * fine {
            let c = colour(corner + DVec2::new(f64::from(k % fine) + 0.5, f64::from(k / fine) + 0.5) / f64::from(fine));
            sum += (c.truncate() * c.w).extend(c.w);
        }
        let rgb = sum.truncate() / sum.w.max(1e-9);
        [encoded(rgb.x), encoded(rgb.y), encoded(rgb.z), (sum.w / f64::from(fine * fine) * 255.0).round() as u8]
    };
    let pixels: Vec<[u8; 4]> = (0..(width * height) as usize).into_par_iter().with_min_len(256).map(pixel).collect();
    RgbaImage::from_fn(width, height, |x, y| Rgba(pixels[(y * width + x) as usize]))
}

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

/// An angular map of the studio. The centre is straight behind the viewer, the circle that touches the sides straight
/// ahead.
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

/// The light of the studio itself, not rolled off: a latitude-longitude map of 256 × 128 pixels, its lamps far above
/// white.
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
        SoftBox { toward: v(-0.95, 0.5, 0.85), half: DVec2::new(0.4, 0.52), roll: 8.0, light: v(3.2, 3.1, 2.95) },
        SoftBox { toward: v(1.2, 0.22, 0.35), half: DVec2::new(0.14, 0.95), roll: -4.0, light: v(2.0, 2.2, 2.5) },
        SoftBox { toward: v(0.35, 1.3, 0.1), half: DVec2::new(0.6, 0.2), roll: 12.0, light: v(2.3, 2.25, 2.2) },
        SoftBox { toward: v(-1.0, 0.1, -0.9), half: DVec2::new(0.12, 0.8), roll: 0.0, light: v(2.6, 2.0, 1.4) },
        SoftBox { toward: v(0.55, -0.62, 0.8), half: DVec2::new(0.36, 0.13), roll: 20.0, light: v(0.55, 0.42, 0.3) },
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
    let floor = srgb(0x2a2623).lerp(srgb(0x6e6258), smooth_step(-1.0, -0.1, d.y) * (0.55 + 0.45 * d.z));
    let room = floor.lerp(wall, smooth_step(-0.22, 0.02, d.y));
    let room = room.lerp(ceiling, smooth_step(0.62, 0.95, d.y));
    // A black card on the right gives edges something dark to mirror.
    let card =
        smooth_step(0.12, 0.06, (d.x - 0.62).abs()) * smooth_step(0.66, 0.6, d.y.abs()) * smooth_step(0.0, 0.1, d.z);
    room * (1.0 - 0.92 * card)
}

/// A 2/2 twill in a tartan sett. Seamless.
fn tartan() -> RgbaImage {
    const THREADS: i64 = 64;
    let (navy, green, red, cream) = (srgb(0x1c2b4a), srgb(0x24503f), srgb(0xa3242c), srgb(0xe8dcc0));
    let sett = move |thread: i64| match thread.rem_euclid(THREADS / 2) {
        0..=9 => navy,
        10 | 11 => red,
        12..=20 => green,
        21 | 22 => cream,
        23..=27 => navy,
        _ => green,
    };
    painted((TEXTURE, TEXTURE), 3, move |p| {
        let q = p / f64::from(TEXTURE) * THREADS as f64;
        let wobble = 0.1 * noise2(q / 8.0, 8, 5);
        let at = q + DVec2::splat(wobble);
        let (x, y) = (at.x.floor() as i64, at.y.floor() as i64);
        let warp_on_top = (x + y).rem_euclid(4) < 2;
        // Position across the visible thread, and along its float of two.
        let (thread, across, along) = if warp_on_top {
            (x, at.x - x as f64, (at.y + x as f64).rem_euclid(4.0) / 2.0)
        } else {
            (y, at.y - y as f64, (at.x + y as f64 - 2.0).rem_euclid(4.0) / 2.0)
        };
        let round = 1.0 - (2.0 * across - 1.0).powi(2) * 0.62;
        let dip = 1.0 - (2.0 * along.clamp(0.0, 1.0) - 1.0).powi(4) * 0.45;
        let stretch = if warp_on_top { DVec2::new(4.0, 1.0) } else { DVec2::new(1.0, 4.0) };
        let fibre = 1.0 + 0.3 * noise2(at * stretch, 0, 8 + (thread & 7) as u64);
        let worn = 1.0 + 0.2 * fbm2(q / 16.0, 4, 4, 77);
        (sett(thread) * round * dip * fibre * worn * 1.25).extend(1.0)
    })
}

/// Overlapping scales, each shaded from its root to its rim. Seamless.
fn scales() -> RgbaImage {
    const ACROSS: f64 = 10.0;
    painted((TEXTURE, TEXTURE), 3, |p| {
        let q = p / f64::from(TEXTURE) * DVec2::new(ACROSS, ACROSS * 2.0);
        // Rows overlap downward: the first scale found, from the lowest row that can reach here, is on top.
        let base = q.y.floor() as i64;
        for row in (base - 4..=base).map(|r| r + 1) {
            let shift = if row.rem_euclid(2) == 0 { 0.0 } else { 0.5 };
            let column = (q.x - shift).floor() as i64;
            let local = DVec2::new(q.x - shift - column as f64 - 0.5, (q.y - row as f64) * 0.5 + 0.12);
            let rim = scale_outline(local);
            if rim < 0.0 && local.y > -0.5 {
                return scale_colour(local, rim, column.rem_euclid(ACROSS as i64), row.rem_euclid(20), p).extend(1.0);
            }
        }
        srgb(0x0b1510).extend(1.0)
    })
}

/// Negative inside a scale that hangs from (0, −0.5) and ends in a blunt point below.
fn scale_outline(q: DVec2) -> f64 {
    let width = 0.53 * (1.0 - smooth_step(0.0, 0.62, q.y) * (q.y / 0.62).clamp(0.0, 1.0).powf(1.5)).max(0.0).sqrt();
    if q.y > 0.62 { 1.0 } else { (q.x.abs() - width).max(-1.0) }
}

fn scale_colour(q: DVec2, rim: f64, column: i64, row: i64, p: DVec2) -> DVec3 {
    let tag = hash(column, row, 3);
    let ground = srgb(0x1f5a4c).lerp(srgb(0x6f8a3c), tag * 0.7);
    let gold = srgb(0xd8b45a);
    let edge = smooth_step(-0.09, -0.015, rim).max(smooth_step(0.5, 0.6, q.y));
    let light = 0.35 + 0.75 * smooth_step(-0.35, 0.45, q.y) - 0.5 * q.x;
    let keel = 0.35 * (-(q.x / 0.04).powi(2)).exp() * smooth_step(0.55, 0.1, q.y);
    let ribs = 1.0 + 0.1 * (q.x * 55.0).sin() * smooth_step(0.5, 0.0, q.y);
    let grain = 1.0 + 0.18 * fbm2(p / 8.0, 3, 64, 21);
    let rim_dark = 1.0 - 0.75 * smooth_step(-0.02, 0.0, rim);
    (ground.lerp(gold, 0.55 * edge) * ribs + gold * keel * 0.5) * light.max(0.1) * grain * rim_dark
}

/// Veined marble by domain warping. Seamless.
fn marble() -> RgbaImage {
    painted((TEXTURE, TEXTURE), 3, |p| {
        let q = p / f64::from(TEXTURE) * 4.0;
        let warp = DVec2::new(fbm2(q, 5, 4, 1), fbm2(q, 5, 4, 40));
        let again = DVec2::new(fbm2(q + warp * 1.4, 5, 4, 90), fbm2(q + warp * 1.4, 5, 4, 140));
        let cloud = fbm2(q + again * 1.1, 6, 4, 200);
        let vein = |k: f64, width: f64| (-((cloud - k).abs() / width)).exp();
        let fine = (-(fbm2(q * 2.0 + again * 1.6, 5, 8, 300).abs() / 0.035)).exp();
        let stone = srgb(0xf1ece4).lerp(srgb(0xc9c3bd), smooth_step(-0.5, 0.6, cloud));
        let stone = stone.lerp(srgb(0x56595f), (0.8 * vein(0.1, 0.045) + 0.4 * vein(-0.25, 0.03)).min(0.9));
        stone.lerp(srgb(0xa98a5e), 0.4 * fine * smooth_step(-0.1, 0.4, warp.x)).extend(1.0)
    })
}

/// A running bond of old bricks. Seamless.
fn bricks() -> RgbaImage {
    const ROWS: i64 = 10;
    const COLUMNS: i64 = 4;
    painted((TEXTURE, TEXTURE), 3, |p| {
        let unit = p / f64::from(TEXTURE);
        let wear = DVec2::new(fbm2(unit * 16.0, 4, 16, 4), fbm2(unit * 16.0, 4, 16, 60)) * 0.045;
        let y = unit.y * ROWS as f64 + wear.y;
        let row = y.floor() as i64;
        let x = unit.x * COLUMNS as f64 + 0.5 * (row.rem_euclid(2)) as f64 + wear.x * 0.6;
        let column = x.floor() as i64;
        let (fx, fy) = (x - column as f64, y - row as f64);
        // Distance from the joint, in row heights; a brick is 2.5 rows long.
        let inset = (fx.min(1.0 - fx) * 2.5).min(fy.min(1.0 - fy)) - 0.06;
        let tag = hash(column.rem_euclid(COLUMNS), row.rem_euclid(ROWS), 8);
        let grain = fbm2(unit * 64.0, 4, 64, 11);
        let stain = fbm2(unit * 8.0, 5, 8, 31);
        let clay = srgb(0xa4523a)
            .lerp(srgb(0x6f3a30), tag)
            .lerp(srgb(0xc98a5c), smooth_step(0.75, 1.0, hash(column.rem_euclid(COLUMNS), row.rem_euclid(ROWS), 9)));
        let clay = clay * (1.0 + 0.45 * grain + 0.5 * stain);
        let mortar = srgb(0xb3a898) * (0.85 + 0.35 * grain);
        // Light from above left: lit upper edges, shade below.
        let bevel = smooth_step(0.1, 0.0, inset) * (if fy < 0.5 { 0.28 } else { -0.35 });
        let shade = 1.0 - 0.5 * smooth_step(-0.01, -0.05, inset) * smooth_step(0.12, 0.0, fy);
        (mortar.lerp(clay * (1.0 + bevel), smooth_step(-0.012, 0.02, inset)).max(DVec3::ZERO) * shade).extend(1.0)
    })
}

/// Soft grey noise for deforming. Seamless.
fn soft_noise() -> RgbaImage {
    painted((TEXTURE, TEXTURE), 3, |p| {
        let q = p / f64::from(TEXTURE) * 16.0;
        let value = smooth_step(-0.55, 0.55, fbm2(q, 4, 16, 2));
        DVec3::splat((0.03 + 0.94 * value).powf(2.0)).extend(1.0)
    })
}

/// An enamelled star in a gold ring, on nothing.
fn star() -> RgbaImage {
    const SIDE: u32 = 384;
    painted((SIDE, SIDE), 3, |p| {
        let q = (p / f64::from(SIDE) * 2.0 - DVec2::ONE) * DVec2::new(1.0, -1.0);
        let r = q.length();
        let sector = TAU / 5.0;
        let angle = q.x.atan2(q.y);
        let nearest = angle - (angle / sector).round() * sector;
        let folded = DVec2::new((nearest.sin() * r).abs(), nearest.cos() * r);
        // The edge runs from the tip to the inner corner.
        let (tip, notch) = (DVec2::new(0.0, 0.7), DVec2::from_angle(PI / 2.0 - sector / 2.0) * 0.3);
        let edge = notch - tip;
        let inside = -edge.perp_dot(folded - tip) / edge.length();
        let lit = 0.65 + 0.5 * (q.dot(DVec2::new(-0.5, 0.8)));
        let facet = if nearest > 0.0 { 0.72 } else { 1.12 };
        let gold = srgb(0xf2c14e) * lit;
        let enamel = srgb(0x1d3f8a) * (0.75 + 0.5 * smooth_step(0.9, 0.1, r));
        let ring = (r - 0.88).abs();
        let rays = 1.0 + 0.1 * (40.0 * angle).sin() * smooth_step(0.1, 0.8, r);
        let mut colour = enamel * rays;
        colour =
            colour.lerp(srgb(0xfff3cf) * 0.95, smooth_step(-0.03, -0.02, -inside.abs()) * smooth_step(0.8, 0.7, r));
        colour = if inside > 0.0 { gold * facet } else { colour };
        colour =
            colour.lerp(srgb(0xf6d27a) * (1.15 - 60.0 * (ring - 0.02).powi(2)) * lit, smooth_step(0.062, 0.055, ring));
        colour.extend(smooth_step(0.945, 0.935, r))
    })
}

/// A maple-like leaf in autumn colours, on nothing.
fn leaf() -> RgbaImage {
    const SIDE: u32 = 352;
    const LOBES: [[f64; 3]; 5] =
        [[90.0, 0.86, 0.2], [40.0, 0.72, 0.17], [140.0, 0.72, 0.17], [-8.0, 0.5, 0.13], [188.0, 0.5, 0.13]];
    let foot = DVec2::new(0.0, -0.28);
    painted((SIDE, SIDE), 3, move |p| {
        let q = (p / f64::from(SIDE) * 2.0 - DVec2::new(1.0, 1.06)) * DVec2::new(0.78, -0.78) - foot;
        let mut blade = q.length() - 0.2;
        let mut vein = f64::INFINITY;
        for [degrees, reach, width] in LOBES {
            let axis = DVec2::from_angle(degrees.to_radians());
            let (along, across) = (q.dot(axis) / reach, axis.perp_dot(q).abs());
            let teeth = 0.028
                * ((along * 26.0 - 5.0 * across).sin() + 0.6 * (along * 61.0).sin())
                * smooth_step(0.3, 0.6, along);
            let profile = width * (1.9 * along.clamp(0.0, 1.0).powf(0.7) * (1.0 - along.clamp(0.0, 1.0)).powf(0.55))
                + teeth * (1.0 - along).max(0.0);
            blade = blade.min(if (0.0..1.0).contains(&along) { across - profile } else { 1.0 });
            vein = vein.min(segment2(q, DVec2::ZERO, axis * reach * 0.93) + 0.012 * along.max(0.0));
            let side = (along - 0.75 * across) * 11.0;
            let rib = ((side - side.round()).abs() / 11.0 * reach) + 0.008 + 0.05 * across;
            vein = if across < profile { vein.min(rib) } else { vein };
        }
        let stalk = segment2(q, DVec2::ZERO, DVec2::new(0.06, -0.55)) - 0.016;
        let cloud = fbm2(q * 3.0 + DVec2::splat(9.0), 5, 0, 3);
        let colour = srgb(0xb8331f)
            .lerp(srgb(0xe8962e), smooth_step(-0.4, 0.5, cloud))
            .lerp(srgb(0x8c9a34), 0.6 * smooth_step(0.5, 0.0, q.length()));
        let colour = colour * (1.0 + 0.25 * fbm2(q * 24.0, 3, 0, 9));
        let colour = colour.lerp(srgb(0xf7dc98), 0.75 * smooth_step(0.017, 0.006, vein));
        let colour = if stalk < 0.0 && blade > 0.0 { srgb(0x8a4a2a) } else { colour };
        colour.extend(smooth_step(0.004, -0.004, blade.min(stalk)))
    })
}

/// The light a window throws, with the shadow of a branch: white where it is lit.
fn window() -> RgbaImage {
    const SIDE: u32 = 448;
    painted((SIDE, SIDE), 3, |p| {
        let q = p / f64::from(SIDE) * 2.0 - DVec2::ONE;
        // Slanted like afternoon light, and softer the farther the shadow's edge is thrown.
        let slanted = DVec2::new(q.x + 0.22 * q.y, q.y);
        let soft = 0.014 + 0.014 * (q.y + 1.0);
        let panes = pane(slanted, soft);
        let branch = smooth_step(-soft, soft * 1.6, twig_shadow(slanted));
        DVec3::splat(panes * (0.12 + 0.88 * branch)).extend(1.0)
    })
}

/// Two columns of three panes with an arched top, their edges blurred over `soft`.
fn pane(q: DVec2, soft: f64) -> f64 {
    let arch = if q.y < -0.2 { 0.74 - (DVec2::new(q.x, (q.y + 0.2) * 1.1)).length() } else { 0.74 - q.x.abs() };
    let frame = arch.min(0.86 - q.y);
    let post = q.x.abs() - 0.035;
    let bars = [-0.2, 0.34].iter().map(|y| (q.y - y).abs() - 0.028).fold(f64::INFINITY, f64::min);
    smooth_step(-soft, soft, frame.min(post).min(bars))
}

/// Positive outside the shadow of a twig with leaves.
fn twig_shadow(q: DVec2) -> f64 {
    let curve = |t: f64| DVec2::new(0.95 - 1.25 * t, -0.85 + 0.9 * t + 0.35 * t * t);
    let mut best = f64::INFINITY;
    for i in 0..16 {
        let t = f64::from(i) / 16.0;
        let (a, b) = (curve(t), curve(t + 1.0 / 16.0));
        best = best.min(segment2(q, a, b) - 0.016 * (1.1 - t));
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        let heading = (b - a).to_angle() + side * (0.75 + 0.25 * hash(i.into(), 1, 4));
        let d = DVec2::from_angle(-heading).rotate(q - a);
        let length = 0.15 + 0.08 * hash(i.into(), 2, 4);
        let along = (d.x / length).clamp(0.0, 1.0);
        let width = 0.3 * length * (PI * along.powf(0.8)).sin();
        let leaf = if (0.0..length).contains(&d.x) { d.y.abs() - width } else { 1.0 };
        best = best.min(leaf);
    }
    best
}

/// A lit sphere of pale wax: warm light from the upper left, a cool sky, red where little light comes through.
fn sphere_wax() -> RgbaImage {
    lit_sphere(|n| {
        let (key, sky) = (n.dot(v(-0.5, 0.6, 0.62)), 0.5 + 0.5 * n.y);
        let matt = srgb(0x6a2a20).lerp(srgb(0xf0c898), smooth_step(-0.35, 0.95, key));
        let sheen = smooth_step(0.55, 0.9, key) * 0.25 + smooth_step(0.93, 0.985, n.dot(v(-0.28, 0.34, 0.9))) * 0.45;
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

/// A sphere seen from the front, its colour from its normal (y up).
fn lit_sphere(colour: impl Fn(DVec3) -> DVec3 + Sync) -> RgbaImage {
    const SIDE: f64 = 192.0;
    painted((SIDE as u32, SIDE as u32), 3, |q| {
        let (x, y) = (q.x / SIDE * 2.0 - 1.0, 1.0 - q.y / SIDE * 2.0);
        let r = x.hypot(y);
        // The contour's colour continues beyond it, under a soft edge.
        let (x, y) = if r > 0.999 { (x / r * 0.999, y / r * 0.999) } else { (x, y) };
        let n = v(x, y, (1.0 - x * x - y * y).max(0.0).sqrt());
        colour(n).extend(1.0 - smooth_step(1.0, 1.01, r))
    })
}
