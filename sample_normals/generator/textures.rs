//! Textures that repeat without a seam: cloth, scales, stone, bricks and soft noise.

use glam::{DVec2, DVec3};
use image::RgbaImage;

use crate::noise::{fbm2, hash, noise2};
use crate::painting::{TEXTURE, painted, srgb};
use crate::sdf::smooth_step;

/// A 2/2 twill in a tartan sett. Seamless.
pub fn tartan() -> RgbaImage {
    const THREADS: i64 = 64;
    let (navy, green, red, cream) =
        (srgb(0x1c2b4a), srgb(0x24503f), srgb(0xa3242c), srgb(0xe8dcc0));
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
pub fn scales() -> RgbaImage {
    const ACROSS: f64 = 10.0;
    painted((TEXTURE, TEXTURE), 3, |p| {
        let q = p / f64::from(TEXTURE) * DVec2::new(ACROSS, ACROSS * 2.0);
        // Rows overlap downward: the first scale found, from the lowest row that can reach here, is
        // on top.
        let base = q.y.floor() as i64;
        for row in (base - 4..=base).map(|r| r + 1) {
            let shift = if row.rem_euclid(2) == 0 { 0.0 } else { 0.5 };
            let column = (q.x - shift).floor() as i64;
            let local =
                DVec2::new(q.x - shift - column as f64 - 0.5, (q.y - row as f64) * 0.5 + 0.12);
            let rim = scale_outline(local);
            if rim < 0.0 && local.y > -0.5 {
                return scale_color(
                    local,
                    rim,
                    column.rem_euclid(ACROSS as i64),
                    row.rem_euclid(20),
                    p,
                )
                .extend(1.0);
            }
        }
        srgb(0x0b1510).extend(1.0)
    })
}

/// Negative inside a scale that hangs from (0, −0.5) and ends in a blunt point below.
fn scale_outline(q: DVec2) -> f64 {
    let width = 0.53
        * (1.0 - smooth_step(0.0, 0.62, q.y) * (q.y / 0.62).clamp(0.0, 1.0).powf(1.5))
            .max(0.0)
            .sqrt();
    if q.y > 0.62 { 1.0 } else { (q.x.abs() - width).max(-1.0) }
}

fn scale_color(q: DVec2, rim: f64, column: i64, row: i64, p: DVec2) -> DVec3 {
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
pub fn marble() -> RgbaImage {
    painted((TEXTURE, TEXTURE), 3, |p| {
        let q = p / f64::from(TEXTURE) * 4.0;
        let warp = DVec2::new(fbm2(q, 5, 4, 1), fbm2(q, 5, 4, 40));
        let again = DVec2::new(fbm2(q + warp * 1.4, 5, 4, 90), fbm2(q + warp * 1.4, 5, 4, 140));
        let cloud = fbm2(q + again * 1.1, 6, 4, 200);
        let vein = |k: f64, width: f64| (-((cloud - k).abs() / width)).exp();
        let fine = (-(fbm2(q * 2.0 + again * 1.6, 5, 8, 300).abs() / 0.035)).exp();
        let stone = srgb(0xf1ece4).lerp(srgb(0xc9c3bd), smooth_step(-0.5, 0.6, cloud));
        let stone =
            stone.lerp(srgb(0x56595f), (0.8 * vein(0.1, 0.045) + 0.4 * vein(-0.25, 0.03)).min(0.9));
        stone.lerp(srgb(0xa98a5e), 0.4 * fine * smooth_step(-0.1, 0.4, warp.x)).extend(1.0)
    })
}

/// A running bond of old bricks. Seamless.
pub fn bricks() -> RgbaImage {
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
        let clay = srgb(0xa4523a).lerp(srgb(0x6f3a30), tag).lerp(
            srgb(0xc98a5c),
            smooth_step(0.75, 1.0, hash(column.rem_euclid(COLUMNS), row.rem_euclid(ROWS), 9)),
        );
        let clay = clay * (1.0 + 0.45 * grain + 0.5 * stain);
        let mortar = srgb(0xb3a898) * (0.85 + 0.35 * grain);
        // Light from above left: lit upper edges, shade below.
        let bevel = smooth_step(0.1, 0.0, inset) * (if fy < 0.5 { 0.28 } else { -0.35 });
        let shade = 1.0 - 0.5 * smooth_step(-0.01, -0.05, inset) * smooth_step(0.12, 0.0, fy);
        (mortar.lerp(clay * (1.0 + bevel), smooth_step(-0.012, 0.02, inset)).max(DVec3::ZERO)
            * shade)
            .extend(1.0)
    })
}

/// Soft gray noise for deforming. Seamless.
pub fn soft_noise() -> RgbaImage {
    painted((TEXTURE, TEXTURE), 3, |p| {
        let q = p / f64::from(TEXTURE) * 16.0;
        let value = smooth_step(-0.55, 0.55, fbm2(q, 4, 16, 2));
        DVec3::splat((0.03 + 0.94 * value).powf(2.0)).extend(1.0)
    })
}
