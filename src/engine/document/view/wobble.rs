//! A picture seen from slightly to the right or to the left of where it was painted, by its depth:
//! the relief shows. Floor 4. What is hidden from the front is not known; what lies behind is drawn
//! over it.

use crate::math::{Size, parallel};
use crate::raster::{Plane, TileGrid};
use crate::surface::Surface;

/// A picture with its heights, as large as a screen needs.
pub struct WobbleScene {
    size: Size,
    /// Premultiplied.
    pixels: Plane<[u8; 4]>,
    /// Heights above the middle of the depth toward the viewer, px of `size`.
    heights: Plane<f32>,
}

/// Pixels next to each other that differ less in height than this, times their distance, are one
/// piece.
const JUMP: f32 = 3.0;

impl WobbleScene {
    /// * `flat`: the finished picture of the canvas, of the surface's size.
    /// * `longest`: the most px that a side may have.
    pub fn new(flat: &TileGrid, surface: &Surface, longest: u32) -> Self {
        let whole = surface.size();
        let step = whole.width.max(whole.height).div_ceil(longest.max(1)).max(1);
        let size = Size::new(whole.width.div_ceil(step), whole.height.div_ceil(step));
        let at = |v: usize, n: u32| (v as u32 * step + step / 2).min(n - 1);
        let place = |x: usize, y: usize| (at(x, whole.width), at(y, whole.height));
        let range = surface.depth_range_px() / step as f32;
        let pixels = Plane::from_fn(size, |x, y| {
            let (x, y) = place(x, y);
            flat.pixel(x as i32, y as i32)
        });
        let heights = Plane::from_fn(size, |x, y| {
            let (x, y) = place(x, y);
            let (x, y) = (x as usize, y as usize);
            // The background lies next to the surface.
            let depth = if surface.coverage(x, y) >= 128 { surface.depth(x, y) } else { 1.0 };
            if depth.is_finite() { (0.5 - depth) * range } else { -0.5 * range }
        });
        Self { size, pixels, heights }
    }

    /// The size of its pictures, px.
    pub fn size(&self) -> Size {
        self.size
    }

    /// Premultiplied pixels, row by row, as seen from an angle to the right (positive) or to the
    /// left, radians.
    pub fn render_from(&self, angle_rad: f32) -> Vec<[u8; 4]> {
        let lean = -angle_rad.max(-1.0).min(1.0).tan();
        let width = self.size.width as usize;
        let mut out = vec![[0u8; 4]; self.size.area()];
        parallel::for_each_row(&mut out, width, 1, |y, row| self.row(y, lean, row));
        out
    }

    /// One row: every pixel drawn where it is seen, the nearest on top; holes get what lies behind
    /// next to them.
    fn row(&self, y: usize, lean: f32, row: &mut [[u8; 4]]) {
        let n = row.len();
        let mut near = vec![f32::NEG_INFINITY; n];
        let seen = |x: usize| x as f32 + lean * self.heights.at(x, y);
        for x in 0..n {
            let (height, from) = (self.heights.at(x, y), seen(x));
            // As far as the next pixel of its piece, so that a stretched slope has no gaps.
            let is_joined = x + 1 < n && (self.heights.at(x + 1, y) - height).abs() < JUMP;
            let to = if is_joined { seen(x + 1) } else { from + 1.0 };
            let (first, last) =
                (from.min(to).round().max(0.0), from.max(to).round().max(from.round() + 1.0));
            for i in first as usize..(last.max(0.0) as usize).min(n) {
                if height > near[i] {
                    (near[i], row[i]) = (height, self.pixels.at(x, y));
                }
            }
        }
        let mut i = 0;
        while i < n {
            if near[i] > f32::NEG_INFINITY {
                i += 1;
                continue;
            }
            let end = (i..n).find(|&j| near[j] > f32::NEG_INFINITY).unwrap_or(n);
            let left = i.checked_sub(1);
            let behind = match (left, (end < n).then_some(end)) {
                (Some(a), Some(b)) => Some(if near[a] <= near[b] { a } else { b }),
                (a, b) => a.or(b),
            };
            let color = behind.map_or([0; 4], |from| row[from]);
            row[i..end].fill(color);
            i = end;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use crate::shape::{Body, Combine, Primitive, Relief};

    /// A red ball on a blue ground.
    fn scene() -> WobbleScene {
        let size = Size::new(96, 80);
        let mut relief = Relief::empty(size);
        let form = Primitive::new(Body::Sphere, vec2(48.0, 40.0), 24.0).form(1 << 16).unwrap();
        relief.add(&form, Combine::Over, 1);
        let surface = relief.into_surface(&mut crate::surface::NearestCache::default()).unwrap();
        let pixel = |i: usize| {
            let (x, y) = ((i % 96) as f32 - 47.5, (i / 96) as f32 - 39.5);
            if x.hypot(y) < 24.0 {
                [255, if x.hypot(y) < 4.0 { 255 } else { 0 }, 0, 255]
            } else {
                [0, 0, 255, 255]
            }
        };
        let rgba: Vec<u8> = (0..size.area()).flat_map(pixel).collect();
        WobbleScene::new(&TileGrid::from_straight_rgba(&rgba, 96, 80, 0, 0), &surface, 96)
    }

    #[test]
    fn from_the_front_the_picture_is_what_it_is_and_without_gaps_from_aside() {
        let scene = scene();
        assert_eq!(scene.render_from(0.0), scene.pixels.values());
        for angle in [-0.17f32, 0.17, f32::NAN] {
            assert!(scene.render_from(angle).iter().all(|pixel| pixel[3] == 255), "{angle}");
        }
    }

    #[test]
    fn from_the_right_what_is_near_goes_to_the_left() {
        let scene = scene();
        let pole = |angle: f32| {
            let row = &scene.render_from(angle)[40 * 96..41 * 96];
            let lit: Vec<usize> = (0..96).filter(|&x| row[x][1] > 100).collect();
            lit.iter().sum::<usize>() as f32 / lit.len().max(1) as f32
        };
        let shift = 12.0 * 0.17f32.tan();
        assert!((pole(0.0) - pole(0.17) - shift).abs() < 1.0, "{} {}", pole(0.0), pole(0.17));
        assert!(pole(-0.17) > pole(0.0) + 1.0);
    }
}
