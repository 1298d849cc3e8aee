//! How pictures are computed: colors in linear light, averaged over points of each pixel and encoded
//! at the end. Not here: the pictures (`pictures`, `landscape`, `textures`, `patterns`, `decals`).

use glam::{DVec2, DVec3, DVec4};
use image::{Rgba, RgbaImage};
use rayon::prelude::*;

use crate::sdf::v;

/// Side of the square textures, in pixels.
pub const TEXTURE: u32 = 512;

/// Linear light in `[0, 1]` as an sRGB byte.
pub fn encoded(linear: f64) -> u8 {
    let c = linear.clamp(0.0, 1.0);
    let srgb = if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    (srgb * 255.0).round() as u8
}

/// The linear color of an sRGB one written as `0xRRGGBB`.
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

/// A picture from straight (not premultiplied) linear color and alpha, averaged over `fine` ×
/// `fine` points per pixel.
pub fn painted(
    (width, height): (u32, u32),
    fine: u32,
    color: impl Fn(DVec2) -> DVec4 + Sync,
) -> RgbaImage {
    let pixel = |i: usize| {
        let corner = DVec2::new((i % width as usize) as f64, (i / width as usize) as f64);
        let mut sum = DVec4::ZERO;
        for k in 0..fine * fine {
            let c = color(
                corner
                    + DVec2::new(f64::from(k % fine) + 0.5, f64::from(k / fine) + 0.5)
                        / f64::from(fine),
            );
            sum += (c.truncate() * c.w).extend(c.w);
        }
        let rgb = sum.truncate() / sum.w.max(1e-9);
        [
            encoded(rgb.x),
            encoded(rgb.y),
            encoded(rgb.z),
            (sum.w / f64::from(fine * fine) * 255.0).round() as u8,
        ]
    };
    let pixels: Vec<[u8; 4]> =
        (0..(width * height) as usize).into_par_iter().with_min_len(256).map(pixel).collect();
    RgbaImage::from_fn(width, height, |x, y| Rgba(pixels[(y * width + x) as usize]))
}
