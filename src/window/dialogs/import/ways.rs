//! The possible meanings of maps, seen under a light. Floor 7.

use crate::math::{Size, srgb::quantize, vec3};
use crate::raster::Picture;
use crate::surface::Surface;

/// A way to read maps: its name, and which axes of the normals it flips, x and y.
pub type ReadingWay = (&'static str, [bool; 2]);
/// For normals, each axis may point either way.
pub const FLIPS: [ReadingWay; 4] = [
    ("As it is", [false, false]),
    ("Flip red", [true, false]),
    ("Flip green", [false, true]),
    ("Flip both", [true, true]),
];
/// For depth alone, near may be dark or bright: bumps become dents.
pub const SIDES: [ReadingWay; 2] = [("As it is", [false, false]), ("Inside out", [true, true])];

pub fn xor(a: [bool; 2], b: [bool; 2]) -> [bool; 2] {
    [a[0] != b[0], a[1] != b[1]]
}

/// The surface under one light from above left, its normals flipped.
pub fn light_surface(surface: &Surface, [flip_x, flip_y]: [bool; 2]) -> Option<Picture> {
    const SIDE: u32 = 160;
    let size = surface.size();
    let step = size.width.max(size.height).div_ceil(SIDE).max(1);
    let small = Size::new(size.width.div_ceil(step), size.height.div_ceil(step));
    let light = vec3(-0.5, 0.6, 0.62).normalize();
    let texel = |i: usize| {
        let (x, y) =
            (i % small.width as usize * step as usize, i / small.width as usize * step as usize);
        let mut n = surface.normal(x, y);
        n.x = if flip_x { -n.x } else { n.x };
        n.y = if flip_y { -n.y } else { n.y };
        let shade = quantize(0.1 + 0.85 * n.dot(light).max(0.0).sqrt());
        [shade, shade, shade, surface.coverage(x, y)]
    };
    Picture::srgb8(small, (0..small.area()).map(texel).collect())
}
