//! Patterns that repeat without a seam: knitting and painted tiles.

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};
use image::RgbaImage;

use crate::noise::hash;
use crate::painting::{painted, srgb};
use crate::sdf::{segment2, smooth_step};

/// Sides of the pictures, in pixels.
const SIDE: u32 = 448;

/// Stitches from side to side and from row to row.
const ACROSS: i64 = 16;
const ROWS: i64 = 20;

/// What is knitted, stitch by stitch: the ground, `#` and `+` in two other wools.
const MOTIF: [&[u8; 8]; 10] = [
    b"........",
    b"...#....",
    b"..###...",
    b".##+##..",
    b"##+++##.",
    b".##+##..",
    b"..###...",
    b"...#....",
    b"........",
    b"+.+.+.+.",
];

/// Stocking stitch in three wools: each stitch is two legs that meet below. Seamless.
pub fn knit() -> RgbaImage {
    painted((SIDE, SIDE), 3, |p| {
        let q = p / f64::from(SIDE) * DVec2::new(ACROSS as f64, ROWS as f64);
        let column = q.x.floor() as i64;
        // The leg that lies highest here, of this row and those that reach into it.
        let legs = (-1..=1).map(|step| {
            let row = q.y.floor() as i64 + step;
            let at = DVec2::new((q.x - column as f64 - 0.5).abs(), q.y - row as f64 - 0.5);
            let away = segment2(at, DVec2::new(0.12, 0.62), DVec2::new(0.36, -0.52)) / 0.25;
            let along = at.y + 0.5;
            let bow = 0.12 * (1.0 - (along * 1.6 - 0.8).powi(2));
            ((1.0 - away * away).max(0.0).sqrt() + bow, row, at)
        });
        let (height, row, at) =
            legs.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, 0, DVec2::ZERO));
        let row = row.rem_euclid(ROWS);
        let wool = match MOTIF[(row % 10) as usize][column.rem_euclid(8) as usize] {
            b'#' => srgb(0x9c2f2a),
            b'+' => srgb(0x27486b),
            _ => srgb(0xe9dcc0),
        };
        // The yarn is twisted.
        let twist = 0.86 + 0.14 * ((at.y * 3.0 - at.x * 2.2) * 9.0).sin();
        let worn = 0.94 + 0.12 * hash(column.rem_euclid(ACROSS), row, 5);
        (wool * (0.16 + 0.84 * height.clamp(0.0, 1.0)) * twist * worn).extend(1.0)
    })
}

/// Tiles from side to side.
const TILES: f64 = 4.0;

/// Blue flowers on white tiles, four of whose corners make a ring. Seamless.
pub fn tiles() -> RgbaImage {
    let (white, blue, pale) = (srgb(0xf0efe6), srgb(0x1d3f86), srgb(0x86a4cf));
    painted((SIDE, SIDE), 3, |p| {
        let q = (p / f64::from(SIDE) * TILES).fract_gl() * 2.0 - 1.0;
        let (far, angle) = (q.length(), q.y.atan2(q.x));
        let corner = (DVec2::ONE - q.abs()).length();
        let over = |under: DVec3, color: DVec3, edge: f64| {
            under.lerp(color, 1.0 - smooth_step(-0.012, 0.012, edge))
        };
        let petals = 0.42 + 0.16 * (4.0 * angle).cos().abs();
        let leaves =
            far * (1.0 + 0.9 * ((2.0 * (angle + 0.5 * FRAC_PI_2)).cos().abs() - 1.0).abs()) - 0.9;
        let mut color = over(white, pale, leaves);
        color = over(color, white, far - petals - 0.06);
        color = over(color, blue, far - petals);
        color = over(color, pale, far - petals * 0.62);
        color = over(color, white, far - 0.14);
        color = over(color, blue, far - 0.08);
        for (ring, width) in [(0.52, 0.07), (0.36, 0.03)] {
            color = over(color, blue, (corner - ring).abs() - width);
        }
        color = over(color, pale, corner - 0.2);
        let joint = 1.0 - q.abs().max_element();
        (color * (0.72 + 0.28 * smooth_step(0.0, 0.035, joint))).extend(1.0)
    })
}
