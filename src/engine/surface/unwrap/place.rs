//! Points of an unwrapped surface between pixels, and beyond its edge.
//! Floor 2.

use super::Unwrapping;
use crate::math::{Mat2, Rect, Vec2, vec2};
use crate::surface::Surface;
use crate::surface::differentiate::DifferencePairs;
use crate::surface::pyramid::{PyramidBlock, TILE_LEVEL, block_rect};

/// Where a canvas point lies in the plane of the piece of surface under it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanePlace {
    /// The number of its object: see [`crate::surface::Objects::labels`].
    pub object: u32,
    /// D(q), canvas px.
    pub at: Vec2,
    /// R(q): how the plane lies turned against the picture there.
    pub turn: Mat2,
}

impl Unwrapping {
    /// Where a point lies, blended between the pixels around it; off the surface the plane of the
    /// nearest piece goes on flat, so that strokes cross the silhouette evenly.
    pub fn place(&self, surface: &Surface, q: Vec2) -> PlanePlace {
        let (x, y) = nearest_covered(surface, q);
        let object = surface.objects().labels().at(x, y);
        let from = |x: usize, y: usize| q - (vec2(x as f32, y as f32) + 0.5);
        if from(x, y).abs().max_element() <= 0.5 {
            let jacobian = surface.interpolate(q, |x, y| self.jacobian(surface, x, y));
            let at = surface
                .interpolate(q, |x, y| self.at(x, y) + self.jacobian(surface, x, y) * from(x, y));
            return PlanePlace { object, at, turn: turn_of(jacobian) };
        }
        let turn = turn_of(self.jacobian(surface, x, y));
        PlanePlace { object, at: self.at(x, y) + turn * from(x, y), turn }
    }

    /// ∂D/∂q at a pixel, differenced within its piece; where a pixel has no neighbor along an
    /// axis, 1.
    pub fn jacobian(&self, surface: &Surface, x: usize, y: usize) -> Mat2 {
        let near = DifferencePairs::between_links(surface, x, y);
        let rows = [near.slope(|x, y| self.at(x, y).x), near.slope(|x, y| self.at(x, y).y)];
        let mut jacobian = Mat2::from_cols(rows[0], rows[1]).transpose();
        if jacobian.x_axis == Vec2::ZERO {
            jacobian.x_axis = Vec2::X;
        }
        if jacobian.y_axis == Vec2::ZERO {
            jacobian.y_axis = Vec2::Y;
        }
        jacobian
    }
}

/// The rotation in J: of J = R S, S symmetric, it is R itself.
fn turn_of(jacobian: Mat2) -> Mat2 {
    super::metric::turn(jacobian, Mat2::IDENTITY)
}

/// The pixel that holds a point, or the nearest on the surface. Of several as near, the one in the
/// smallest square around the held pixel, along its sides.
pub(super) fn nearest_covered(surface: &Surface, q: Vec2) -> (usize, usize) {
    let held = surface.pixel_of(q);
    if surface.coverage(held.0, held.1) > 0 || !q.is_finite() {
        return held;
    }
    let mut nearest =
        NearestCovered { surface, q, held: (held.0 as i32, held.1 as i32), best: None };
    nearest.descend(PyramidBlock::whole(surface.size()));
    nearest.best.map_or(held, |best| best.at)
}

/// A search down the blocks that hold any of the surface, the nearest first.
struct NearestCovered<'s> {
    surface: &'s Surface,
    q: Vec2,
    /// The pixel that holds q, or the nearest of the canvas.
    held: (i32, i32),
    best: Option<CoveredPixel>,
}

struct CoveredPixel {
    at: (usize, usize),
    distance: f32,
    place: (i32, i32),
}

impl NearestCovered<'_> {
    fn descend(&mut self, block: PyramidBlock) {
        let is_covered =
            self.surface.bounds().cover(self.surface).at(block).is_some_and(|cover| cover.some);
        let rect = block_rect(self.surface.size(), block.level, block.col, block.row);
        if !is_covered || self.best.as_ref().is_some_and(|best| self.least(rect) > best.distance) {
            return;
        }
        if block.level == TILE_LEVEL {
            return self.look_at(rect);
        }
        let mut quarters = block.quarters().map(|quarter| {
            let rect = block_rect(self.surface.size(), quarter.level, quarter.col, quarter.row);
            (self.least(rect), quarter)
        });
        quarters.sort_by(|a, b| a.0.total_cmp(&b.0));
        quarters.into_iter().for_each(|(_, quarter)| self.descend(quarter));
    }

    /// A little less than the distance of the nearest pixel of a rectangle.
    fn least(&self, rect: Rect) -> f32 {
        let (low, high) = (
            vec2(rect.x0 as f32, rect.y0 as f32) + 0.5,
            vec2(rect.x1 as f32, rect.y1 as f32) - 0.5,
        );
        self.q.distance(self.q.max(low).min(high)) * (1.0 - 1e-5)
    }

    fn look_at(&mut self, rect: Rect) {
        for y in rect.y0..rect.y1 {
            let row =
                &self.surface.coverage_plane().row(y as usize)[rect.x0 as usize..rect.x1 as usize];
            for (x, _) in (rect.x0..).zip(row).filter(|(_, covered)| **covered > 0) {
                let distance = vec2(x as f32 + 0.5, y as f32 + 0.5).distance(self.q);
                if self.best.as_ref().is_some_and(|best| distance > best.distance) {
                    continue;
                }
                let place = place_around(x - self.held.0, y - self.held.1);
                if self
                    .best
                    .as_ref()
                    .is_none_or(|best| (distance, place) < (best.distance, best.place))
                {
                    self.best =
                        Some(CoveredPixel { at: (x as usize, y as usize), distance, place });
                }
            }
        }
    }
}

/// Which square around a pixel another one lies on, and where on it: along all four sides at once,
/// above, below, left and right.
fn place_around(dx: i32, dy: i32) -> (i32, i32) {
    let r = dx.abs().max(dy.abs());
    let sides = [(dy == -r, dx), (dy == r, dx), (dx == -r, dy), (dx == r, dy)];
    let along = (0..)
        .zip(sides)
        .filter(|(_, (is_on, _))| *is_on)
        .map(|(side, (_, along))| 4 * (along + r) + side);
    (r, along.min().unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, Vec3, hash};
    use crate::raster::Plane;
    use crate::surface::Maps;

    /// In growing squares around the point.
    fn searched(surface: &Surface, q: Vec2) -> (usize, usize) {
        let coverage = surface.coverage_plane();
        let held = surface.pixel_of(q);
        if coverage.at(held.0, held.1) > 0 {
            return held;
        }
        let (x, y) = (held.0 as i32, held.1 as i32);
        let mut best: Option<(f32, (usize, usize))> = None;
        for r in 1..coverage.width().max(coverage.height()) as i32 {
            let sides = (-r..=r).flat_map(|k| [(k, -r), (k, r), (-r, k), (r, k)]);
            for (x, y) in sides.map(|(dx, dy)| (x + dx, y + dy)) {
                if coverage.get(x, y).is_some_and(|c| c > 0) {
                    let distance = vec2(x as f32 + 0.5, y as f32 + 0.5).distance(q);
                    if best.is_none_or(|(least, _)| distance < least) {
                        best = Some((distance, (x as usize, y as usize)));
                    }
                }
            }
        }
        best.map_or(held, |(_, at)| at)
    }

    #[test]
    fn the_nearest_pixel_of_the_surface_is_the_one_that_squares_find_near_and_far() {
        let size = Size::new(150, 90);
        for seed in 0..6u32 {
            let share = [0.3, 0.02, 0.001][seed as usize % 3];
            let is_covered = |x: usize, y: usize| {
                hash::unit(seed, x as u32, y as u32) < share
                    || (seed > 2 && x > 90 && y > 40 && x + y < 180)
            };
            let coverage = Plane::from_fn(size, |x, y| if is_covered(x, y) { 255 } else { 0 });
            let normals = Plane::full(size, Vec3::Z);
            let surface =
                Surface::new(Maps { normals, depth: Plane::full(size, 0.5), coverage }).unwrap();
            for i in 0..200u32 {
                let reach = [1.0, 3.0, 1000.0][i as usize % 3];
                let at = |k: u32, side: f32| {
                    (hash::unit(seed + 40, i, k) - 0.5) * reach * side + 0.5 * side
                };
                let q = vec2(at(0, 150.0), at(1, 90.0));
                // Whole pixels and their middles are as near to several.
                let q = if i % 5 == 0 { q.round() + 0.5 * (i % 2) as f32 } else { q };
                assert_eq!(nearest_covered(&surface, q), searched(&surface, q), "{seed}: from {q}");
            }
        }
    }
}
