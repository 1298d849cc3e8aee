//! The heights that shadows are computed from. Floor 2.

use crate::math::Size;
use crate::raster::Plane;
use crate::surface::Surface;
use crate::surface::cache::HeapSize;
use rayon::prelude::*;

/// Heights toward the viewer, px: 0 at the surface's farthest point, and off it, where the page is.
pub(in crate::surface) struct HeightMaps {
    /// As the picture lies.
    pub upright: HeightMap,
    /// Columns as rows.
    pub turned: HeightMap,
    pub highest: f32,
}

/// Heights of every pixel, and at half the size.
pub(in crate::surface) struct HeightMap {
    pub whole: Plane<f32>,
    /// The mean of each two by two pixels.
    pub half: Plane<f32>,
}

impl HeightMap {
    fn of(whole: Plane<f32>) -> Self {
        Self { half: halve(&whole), whole }
    }
}

impl HeightMaps {
    pub fn of(surface: &Surface) -> Self {
        let range = surface.depth_range_px();
        let height = |x: usize, y: usize| match surface.coverage(x, y) {
            0 => 0.0,
            _ => (1.0 - surface.depth(x, y)) * range,
        };
        let upright = HeightMap::of(Plane::from_fn(surface.size(), height));
        let turned = HeightMap::of(turned(&upright.whole));
        Self { upright, turned, highest: range }
    }

    pub fn way(&self, is_turned: bool) -> &HeightMap {
        if is_turned { &self.turned } else { &self.upright }
    }

    /// h between pixels, `x` and `y` between their centers; 0 beyond the picture. Along a row or a
    /// column it is linear.
    #[cfg(test)]
    pub fn between(&self, x: f32, y: f32) -> f32 {
        let at = |x: i32, y: i32| self.upright.whole.get(x, y).unwrap_or(0.0);
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (x - x0, y - y0);
        let (x0, y0) = (x0 as i32, y0 as i32);
        let row = |y: i32| at(x0, y) + (at(x0 + 1, y) - at(x0, y)) * fx;
        row(y0) + (row(y0 + 1) - row(y0)) * fy
    }
}

impl HeapSize for HeightMaps {
    fn heap_bytes(&self) -> u64 {
        let of = |map: &HeightMap| map.whole.heap_bytes() + map.half.heap_bytes();
        of(&self.upright) + of(&self.turned)
    }
}

/// The mean of each two by two pixels; the last ones count twice where there is only one.
fn halve(map: &Plane<f32>) -> Plane<f32> {
    let side = |n: usize| n.div_ceil(2).max(1);
    let (width, height) = (side(map.width()), side(map.height()));
    let mut half = Plane::filled(Size::new(width as u32, height as u32), 0.0);
    if map.width() == 0 || map.height() == 0 {
        return half;
    }
    half.values_mut().par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        let (above, below) = (map.row(2 * y), map.row((2 * y + 1).min(map.height() - 1)));
        let pairs = above.as_chunks::<2>().0.iter().zip(below.as_chunks::<2>().0);
        for (value, (a, b)) in row.iter_mut().zip(pairs) {
            *value = 0.25 * (a[0] + a[1] + b[0] + b[1]);
        }
        if let (1, [.., a], [.., b]) = (map.width() % 2, above, below) {
            row[width - 1] = 0.5 * (a + b);
        }
    });
    half
}

/// A plane with its columns as rows.
pub(super) fn turned<T: Copy + Send + Sync + Default>(plane: &Plane<T>) -> Plane<T> {
    const SIDE: usize = 32;
    let (w, h) = (plane.width(), plane.height());
    let mut values = Plane::filled(Size::new(h as u32, w as u32), T::default());
    values.values_mut().par_chunks_mut((h * SIDE).max(1)).enumerate().for_each(|(band, rows)| {
        let x0 = band * SIDE;
        for y0 in (0..h).step_by(SIDE) {
            for (x, row) in rows.chunks_exact_mut(h).enumerate() {
                for (y, value) in (y0..).zip(&mut row[y0..(y0 + SIDE).min(h)]) {
                    *value = plane.at(x0 + x, y);
                }
            }
        }
    });
    values
}
