//! Areas of pixels: the smallest that count, and walks over them, side by side. Floor 3.

use crate::math::{Rect, Size};
use crate::raster::Plane;
use std::collections::VecDeque;

/// An area that covers less than this share of a picture is left over from edges: it makes no part.
pub const LEAST_SHARE: f32 = 2e-4;

/// Fewer pixels, px, are not noticed to be an area.
pub const LEAST_SEEN: usize = 16;

/// The fewest pixels of an area that makes a part.
pub fn least_area(size: Size) -> usize {
    (size.area() as f32 * LEAST_SHARE).max(LEAST_SEEN as f32) as usize
}

/// Goes from a pixel to those beside it, and on from each that `enters`.
pub fn walk(
    start: (usize, usize),
    size: (usize, usize),
    mut enters: impl FnMut(usize, usize) -> bool,
) {
    let mut ahead = Vec::new();
    if enters(start.0, start.1) {
        ahead.push(start);
    }
    while let Some(at) = ahead.pop() {
        ahead.extend(side_neighbors(at, size).filter(|(x, y)| enters(*x, *y)));
    }
}

/// The pixels at the four sides of one.
pub fn side_neighbors(
    (x, y): (usize, usize),
    (w, h): (usize, usize),
) -> impl Iterator<Item = (usize, usize)> {
    let all = [(x.wrapping_sub(1), y), (x + 1, y), (x, y.wrapping_sub(1)), (x, y + 1)];
    all.into_iter().filter(move |(x, y)| *x < w && *y < h)
}

/// All of them, row by row.
pub fn pixels((w, h): (usize, usize)) -> impl Iterator<Item = (usize, usize)> {
    (0..h).flat_map(move |y| (0..w).map(move |x| (x, y)))
}

/// Around all values of a plane that count.
pub fn bound_all<T: Copy>(plane: &Plane<T>, counts: impl Fn(T) -> bool) -> Rect {
    let mut area = Rect::EMPTY;
    for y in 0..plane.height() {
        let (row, counts) = (plane.row(y), |value: &T| counts(*value));
        if let Some((first, last)) = row.iter().position(counts).zip(row.iter().rposition(counts)) {
            area = area.union(Rect::new(first as i32, y as i32, last as i32 + 1, y as i32 + 1));
        }
    }
    area
}

/// A plane over an area of a larger one, of each pixel's place there and its index in the plane.
pub fn plane_over<T: Copy + Send + Sync + Default>(
    area: Rect,
    value: impl Fn(usize, usize, usize) -> T + Sync,
) -> Plane<T> {
    let size = Size::new(area.width() as u32, area.height() as u32);
    let (x0, y0) = (area.x0 as usize, area.y0 as usize);
    Plane::from_fn(size, |x, y| value(x + x0, y + y0, y * area.width() + x))
}

/// The pixels that count beside some others, row by row.
pub fn rim(
    others: impl Iterator<Item = (usize, usize)>,
    steps: impl IntoIterator<Item = (i32, i32)> + Copy,
    counts: impl Fn(i32, i32) -> bool,
) -> Vec<(usize, usize)> {
    let mut rim: Vec<(usize, usize)> = Vec::new();
    for (x, y) in others {
        let beside = steps.into_iter().map(|(dx, dy)| (x as i32 + dx, y as i32 + dy));
        rim.extend(beside.filter(|(x, y)| counts(*x, *y)).map(|(x, y)| (y as usize, x as usize)));
    }
    rim.sort_unstable();
    rim.dedup();
    rim.into_iter().map(|(y, x)| (x, y)).collect()
}

/// Gives pixels without a label that of the nearest one, by steps over such pixels.
pub fn spread(labels: &mut Plane<u32>, may: impl Fn(usize, usize) -> bool) {
    // Side by side before corner to corner.
    const STEPS: [(i32, i32); 8] =
        [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1)];
    let can_take = |labels: &Plane<u32>, x: i32, y: i32| {
        labels.get(x, y) == Some(0) && may(x as usize, y as usize)
    };
    let size = (labels.width(), labels.height());
    let is_labeled = |x: i32, y: i32| labels.get(x, y).is_some_and(|label| label > 0);
    let mut ahead: VecDeque<(usize, usize)> =
        rim(pixels(size).filter(|(x, y)| labels.at(*x, *y) == 0 && may(*x, *y)), STEPS, is_labeled)
            .into();
    while let Some((x, y)) = ahead.pop_front() {
        let label = labels.at(x, y);
        for (dx, dy) in STEPS {
            let (x, y) = (x as i32 + dx, y as i32 + dy);
            if can_take(labels, x, y) {
                labels.set(x as usize, y as usize, label);
                ahead.push_back((x as usize, y as usize));
            }
        }
    }
}
