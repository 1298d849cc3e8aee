//! The heights that shadows are computed from. Floor 2.

use crate::math::{Size, Vec2, fast, parallel};
use crate::raster::Plane;
use crate::surface::Surface;
use crate::surface::cache::HeapSize;
use std::sync::OnceLock;

/// Heights toward the viewer, px: 0 at the surface's farthest point, and off it, where the page is.
pub(in crate::surface) struct HeightMaps {
    /// As the picture lies.
    pub upright: HeightMap,
    /// Columns as rows, once a ray goes along them.
    turned: OnceLock<HeightMap>,
    pub highest: f32,
}

/// Heights of every pixel, and at half the size.
pub(in crate::surface) struct HeightMap {
    pub whole: Plane<f32>,
    /// The mean of each two by two pixels.
    pub half: Plane<f32>,
    pub slopes: BlockSlopes,
}

impl HeightMap {
    fn of(whole: Plane<f32>) -> Self {
        Self { half: halve(&whole), slopes: BlockSlopes::of(&whole), whole }
    }
}

impl HeightMaps {
    pub fn of(surface: &Surface) -> Self {
        let range = surface.depth_range_px();
        let mut whole = Plane::full(surface.size(), 0.0);
        let width = whole.width().max(1);
        parallel::for_each_row(whole.values_mut(), width, 1, |y, row| {
            let (depth, coverage) = (surface.depth_plane().row(y), surface.coverage_plane().row(y));
            for ((height, depth), coverage) in row.iter_mut().zip(depth).zip(coverage) {
                *height = if *coverage == 0 { 0.0 } else { (1.0 - depth) * range };
            }
        });
        Self { upright: HeightMap::of(whole), turned: OnceLock::new(), highest: range }
    }

    /// The map whose rows rays meet; ask for the turned one before going parallel.
    pub fn way(&self, is_turned: bool) -> &HeightMap {
        match is_turned {
            true => self.turned.get_or_init(|| HeightMap::of(turned(&self.upright.whole))),
            false => &self.upright,
        }
    }

    /// h between pixels, `x` and `y` between their centers; 0 beyond the picture. Along a row or a
    /// column it is linear.
    #[cfg(test)]
    pub fn interpolate(&self, x: f32, y: f32) -> f32 {
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
        let of = |map: &HeightMap| {
            map.whole.heap_bytes() + map.half.heap_bytes() + map.slopes.0.heap_bytes()
        };
        of(&self.upright) + self.turned.get().map_or(0, of)
    }
}

/// The steepest way up to a neighbor in blocks of pixels, px a px: to the right, to the left, down
/// and up.
pub(in crate::surface) struct BlockSlopes(Plane<[f32; 4]>);

impl BlockSlopes {
    /// The side of a block, px.
    pub const SIDE: usize = 32;

    fn of(map: &Plane<f32>) -> Self {
        let blocks = |n: usize| n.div_ceil(Self::SIDE).max(1);
        let (across, down) = (blocks(map.width()), blocks(map.height()));
        let mut slopes = Plane::full(Size::new(across as u32, down as u32), [0.0; 4]);
        parallel::for_each_row(slopes.values_mut(), across, 1, |block, steepest| {
            let rows = block * Self::SIDE..((block + 1) * Self::SIDE).min(map.height());
            let mut values = vec![[0.0; Self::SIDE]; 4 * across];
            for y in rows {
                let below = if y + 1 < map.height() { y + 1 } else { y };
                take_slopes(map.row(y), map.row(below), &mut values);
            }
            for (steepest, values) in steepest.iter_mut().zip(values.chunks_exact(4)) {
                *steepest =
                    std::array::from_fn(|way| values[way].iter().copied().fold(0.0, f32::max));
            }
        });
        Self(slopes)
    }

    /// Which blocks have something on the way to the lamp that rises more than `steepest` px a px,
    /// up to `reach_px` away.
    pub fn rising(&self, way: Vec2, reach_px: f32, steepest: f32) -> Plane<bool> {
        let rises = |[right, left, down, up]: [f32; 4]| {
            let along =
                |v: f32, forth: f32, back: f32| v.abs() * if v > 0.0 { forth } else { back };
            along(way.x, right, left) + along(way.y, down, up) > steepest
        };
        let (width, height) = (self.0.width() as i32, self.0.height() as i32);
        let blocks = |v: f32| {
            // A pixel more: lines pass between pixels.
            let far = ((v.abs() * reach_px + 2.0) / Self::SIDE as f32).ceil() as i32;
            if v > 0.0 { (1, far) } else { (far, 1) }
        };
        let ((left, right), (up, down)) = (blocks(way.x), blocks(way.y));
        Plane::from_fn(self.0.size(), |x, y| {
            let (x, y) = (x as i32, y as i32);
            let rows = (y - up).max(0)..=(y + down).min(height - 1);
            let mut columns = rows.flat_map(|y| {
                let columns = (x - left).max(0)..=(x + right).min(width - 1);
                columns.map(move |x| (x as usize, y as usize))
            });
            columns.any(|(x, y)| rises(self.0.at(x, y)))
        })
    }
}

crate::widest! {
    /// Takes the slopes of a row to its neighbors right and below into those of its blocks, four
    /// rows of values each.
    fn take_slopes(row: &[f32], below: &[f32], blocks: &mut [[f32; BlockSlopes::SIDE]]) {
        for (block, slopes) in blocks.chunks_exact_mut(4).enumerate() {
            let first = block * BlockSlopes::SIDE;
            let width = BlockSlopes::SIDE.min(row.len() - first);
            let right = width.min(row.len() - first - 1);
            let [to_right, to_left, down, up] = slopes else { continue };
            let (own, beside) = (&row[first..first + width], &row[first + 1..first + 1 + right]);
            for i in 0..right {
                let step = beside[i] - own[i];
                to_right[i] = fast::max(to_right[i], step);
                to_left[i] = fast::max(to_left[i], -step);
            }
            let under = &below[first..first + width];
            for i in 0..width {
                let step = under[i] - own[i];
                down[i] = fast::max(down[i], step);
                up[i] = fast::max(up[i], -step);
            }
        }
    }
}

/// The mean of each two by two pixels; the last ones count twice where there is only one.
pub(super) fn halve(map: &Plane<f32>) -> Plane<f32> {
    let side = |n: usize| n.div_ceil(2).max(1);
    let (width, height) = (side(map.width()), side(map.height()));
    let mut half = Plane::full(Size::new(width as u32, height as u32), 0.0);
    if map.width() == 0 || map.height() == 0 {
        return half;
    }
    parallel::for_each_row(half.values_mut(), width, 1, |y, row| {
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
    let mut values = Plane::full(Size::new(h as u32, w as u32), T::default());
    parallel::for_each_row(values.values_mut(), (h * SIDE).max(1), 1, |band, rows| {
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
