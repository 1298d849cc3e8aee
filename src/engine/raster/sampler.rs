//! Reading a texture at a point.
//! Floor 1. Here: the reference that reads like its definition. Rows at a time, fast:
//! `rows`, `antialias`. Without rounding to bytes: `floats`.

mod antialias;
mod floats;
mod rows;
mod taps;

pub use antialias::{Antialias, PatchRow, TapRule};
pub use floats::bilinear_row as float_bilinear_row;
pub use rows::Bilinear;

use super::texture::{MipLevel, Outside, Texel, Texture};
use crate::math::Vec2;

/// Positions beyond this, in texels, are clamped: an index must fit an i32.
const FARTHEST: f32 = 1e9;

/// One bilinear tap: the premultiplied color, in `[0, 1]`, at `p` in texels (texel (i, j) has its
/// center at (i+½, j+½)).
pub fn bilinear(texture: &Texture, p: Vec2, outside: Outside) -> [f32; 4] {
    bilinear_in(&texture.levels()[0], p, outside).map(|v| v / 255.0)
}

/// A bilinear tap in one level, at `p` in that level's texels; in the unit of its texels.
fn bilinear_in<T: Texel>(level: &MipLevel<T>, p: Vec2, outside: Outside) -> [f32; 4] {
    let (w, h) = (level.size.width as i32, level.size.height as i32);
    let p = p.clamp(Vec2::splat(-FARTHEST), Vec2::splat(FARTHEST)) - 0.5;
    let floor = p.floor();
    let t = p - floor;
    let (i, j) = (floor.x as i32, floor.y as i32);
    let texel = |i, j| match (outside.index(i, w), outside.index(j, h)) {
        (Some(i), Some(j)) => level.texels[(j * w + i) as usize],
        _ => T::default(),
    };
    mix([texel(i, j), texel(i + 1, j)], [texel(i, j + 1), texel(i + 1, j + 1)], t.x, t.y)
}

/// Four texels mixed: `top` and `bottom` pairs, `tx` of the way right, `ty` of the way down.
#[inline(always)]
fn mix<T: Texel>(top: [T; 2], bottom: [T; 2], tx: f32, ty: f32) -> [f32; 4] {
    let [a, b] = top.map(T::value);
    let [c, d] = bottom.map(T::value);
    std::array::from_fn(|k| {
        let left = a[k] + (c[k] - a[k]) * ty;
        let right = b[k] + (d[k] - b[k]) * ty;
        left + (right - left) * tx
    })
}
