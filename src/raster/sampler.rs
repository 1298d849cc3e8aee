//! Reading a texture at a point.
//! Floor 1.

use super::texture::{Outside, Texture};
use crate::math::Vec2;

/// One bilinear tap: the premultiplied colour, in `[0, 1]`, at `p` in texels (texel (i, j) has its centre at (i+½, j+½)).
pub fn bilinear(texture: &Texture, p: Vec2, outside: Outside) -> [f32; 4] {
    let level = &texture.levels()[0];
    let (w, h) = (level.size.width as i32, level.size.height as i32);
    let (p, floor) = (p - 0.5, (p - 0.5).floor());
    let t = p - floor;
    let (i, j) = (floor.x as i32, floor.y as i32);
    let texel = |i, j| match (outside.index(i, w), outside.index(j, h)) {
        (Some(i), Some(j)) => level.texels[(j * w + i) as usize].map(f32::from),
        _ => [0.0; 4],
    };
    let (a, b, c, d) = (texel(i, j), texel(i + 1, j), texel(i, j + 1), texel(i + 1, j + 1));
    std::array::from_fn(|k| {
        let top = a[k] + (b[k] - a[k]) * t.x;
        let bottom = c[k] + (d[k] - c[k]) * t.x;
        (top + (bottom - top) * t.y) / 255.0
    })
}
