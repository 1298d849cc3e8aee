//! Points of the lines that were placed, found again by where they are. Floor 2. Not here: lines
//! (`streamlines`).

use crate::math::{Mat2, Vec2, vec2};
use std::ops::ControlFlow;

/// The side of a cell, px.
const CELL_PX: usize = 4;
/// Points that lie together in memory.
const LANES: usize = 8;
/// What lies more than this ahead of a point, of how far aside it is, is not beside it.
const AHEAD: f32 = 0.3;
/// The radius of the circle around the middle of that wedge, of its length: √(0.5² + 0.3²).
const WEDGE: f32 = 0.584;
/// No block.
const NONE: u32 = u32::MAX;

/// A point of a line.
#[derive(Clone, Copy, Debug)]
pub struct PlacedPoint {
    pub at: Vec2,
    /// Which way its line goes, in the tangent plane.
    pub way: Vec2,
    pub line: u32,
    /// Its position along its line, px.
    pub along: i32,
    /// The object that it lies on.
    pub object: u32,
}

/// What is near to a point counts if its line is of the same family, on the same object, and
/// another; or the same line that comes back.
#[derive(Clone, Copy, Debug)]
pub struct Nearness {
    /// S at the point.
    pub root: Mat2,
    /// How near, px on the surface.
    pub px: f32,
    /// The cosine of the angle up to which lines are of one family.
    pub same_family: f32,
    /// Points of the same line count that are farther along it, px.
    pub own_px: i32,
}

/// All of them, in cells.
pub struct PlacedPoints {
    columns: usize,
    rows: usize,
    /// The last block of each cell.
    cells: Vec<u32>,
    blocks: Vec<PointBlock>,
    /// Blocks without a point.
    free: Vec<u32>,
}

/// A few points of one cell.
#[derive(Clone)]
struct PointBlock {
    /// Infinitely far where there is none.
    x: [f32; LANES],
    y: [f32; LANES],
    way: [Vec2; LANES],
    line: [u32; LANES],
    along: [i32; LANES],
    object: [u32; LANES],
    count: usize,
    before: u32,
}

impl PointBlock {
    fn new(before: u32) -> Self {
        Self {
            x: [f32::INFINITY; LANES],
            y: [f32::INFINITY; LANES],
            way: [Vec2::ZERO; LANES],
            line: [0; LANES],
            along: [0; LANES],
            object: [0; LANES],
            count: 0,
            before,
        }
    }

    /// Which of its points are nearer than a distance on the surface, a bit each.
    #[inline(always)]
    fn find_near(&self, at: Vec2, root: Mat2, px: f32) -> u32 {
        let (mut near, limit) = (0, px * px);
        for i in 0..LANES {
            let (x, y) = (self.x[i] - at.x, self.y[i] - at.y);
            let on_surface =
                vec2(root.x_axis.x * x + root.y_axis.x * y, root.x_axis.y * x + root.y_axis.y * y);
            near |= u32::from(on_surface.length_squared() < limit) << i;
        }
        near
    }
}

impl PointBlock {
    /// Whether one of its points counts for another.
    #[inline(always)]
    fn is_counted(&self, i: usize, point: &PlacedPoint, near: &Nearness) -> bool {
        (self.line[i] != point.line || (self.along[i] - point.along).abs() > near.own_px)
            && self.way[i].dot(point.way).abs() > near.same_family
            && self.object[i] == point.object
    }
}

impl PlacedPoints {
    /// None yet, on a map of this size.
    pub fn new((width, height): (usize, usize)) -> Self {
        let (columns, rows) = (width.div_ceil(CELL_PX).max(1), height.div_ceil(CELL_PX).max(1));
        let cells = vec![NONE; columns * rows];
        Self { columns, rows, cells, blocks: Vec::new(), free: Vec::new() }
    }

    fn cell(v: f32, count: usize) -> usize {
        (v.max(0.0) as usize / CELL_PX).min(count - 1)
    }

    fn cell_of(&self, at: Vec2) -> usize {
        Self::cell(at.y, self.rows) * self.columns + Self::cell(at.x, self.columns)
    }

    /// Adds a point.
    pub fn push(&mut self, point: PlacedPoint) {
        let cell = self.cell_of(point.at);
        let last = self.cells[cell];
        if last == NONE || self.blocks[last as usize].count == LANES {
            let next = self.free.pop().unwrap_or(self.blocks.len() as u32);
            if next as usize == self.blocks.len() {
                self.blocks.push(PointBlock::new(last));
            } else {
                self.blocks[next as usize] = PointBlock::new(last);
            }
            self.cells[cell] = next;
        }
        let block = &mut self.blocks[self.cells[cell] as usize];
        let i = block.count;
        (block.x[i], block.y[i]) = (point.at.x, point.at.y);
        (block.way[i], block.line[i]) = (point.way, point.line);
        (block.along[i], block.object[i]) = (point.along, point.object);
        block.count += 1;
    }

    /// Takes the point back that was added last of those in the same cell as a place.
    pub fn pop(&mut self, at: Vec2) {
        let cell = self.cell_of(at);
        let last = self.cells[cell];
        if last == NONE {
            return;
        }
        let block = &mut self.blocks[last as usize];
        block.count -= 1;
        (block.x[block.count], block.y[block.count]) = (f32::INFINITY, f32::INFINITY);
        if block.count == 0 {
            self.cells[cell] = block.before;
            self.free.push(last);
        }
    }

    /// How far the nearest line of the family is on one side of a point, px on the surface, if it is
    /// nearer than `near.px`.
    ///
    /// * `across`: to that side, unit, in the tangent plane.
    /// * `px_across`: a pixel of the surface to that side, in the picture: no longer than one there.
    pub fn gap_beside(
        &self,
        point: &PlacedPoint,
        [across, px_across]: [Vec2; 2],
        near: &Nearness,
    ) -> Option<f32> {
        let mut least = near.px;
        // What counts lies in a wedge, and that in a circle around its middle.
        let (middle, around) = (point.at + 0.5 * near.px * px_across, WEDGE * near.px + 1.0);
        let _ = self.visit_around(middle, around, |block| {
            let mut left = block.find_near(point.at, near.root, least);
            while left != 0 {
                let i = left.trailing_zeros() as usize;
                left &= left - 1;
                if block.is_counted(i, point, near) {
                    let off = near.root * (vec2(block.x[i], block.y[i]) - point.at);
                    let (aside, along) = (off.dot(across), off.dot(across.perp()).abs());
                    if aside > 0.0 && along < (AHEAD * aside).max(1.0) {
                        least = least.min(aside);
                    }
                }
            }
            ControlFlow::Continue(())
        });
        (least < near.px).then_some(least)
    }

    /// Calls `visit` with the blocks around a place until it breaks.
    fn visit_around(
        &self,
        at: Vec2,
        px: f32,
        mut visit: impl FnMut(&PointBlock) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let columns = Self::cell(at.x - px, self.columns)..=Self::cell(at.x + px, self.columns);
        for row in Self::cell(at.y - px, self.rows)..=Self::cell(at.y + px, self.rows) {
            let row = row * self.columns;
            for first in &self.cells[row + columns.start()..=row + columns.end()] {
                let mut next = *first;
                while next != NONE {
                    let block = &self.blocks[next as usize];
                    visit(block)?;
                    next = block.before;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Whether a point that counts is near to another.
    pub fn has_near(&self, point: &PlacedPoint, near: &Nearness) -> bool {
        let visited = self.visit_around(point.at, near.px, |block| {
            let mut left = block.find_near(point.at, near.root, near.px);
            while left != 0 {
                if block.is_counted(left.trailing_zeros() as usize, point, near) {
                    return ControlFlow::Break(());
                }
                left &= left - 1;
            }
            ControlFlow::Continue(())
        });
        visited.is_break()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash;

    fn point(i: u32) -> PlacedPoint {
        let [x, y] = hash::unit_pair(3, i, 0);
        let turn = hash::unit(4, i, 0) * std::f32::consts::TAU;
        PlacedPoint {
            at: vec2(x, y) * 60.0,
            way: vec2(turn.cos(), turn.sin()),
            line: i % 7,
            along: (i / 7) as i32,
            object: i % 2,
        }
    }

    #[test]
    fn points_in_cells_are_near_where_they_are_among_all() {
        let mut placed = PlacedPoints::new((60, 60));
        let all: Vec<PlacedPoint> = (0..400).map(point).collect();
        all.iter().for_each(|point| placed.push(*point));
        // Taken back, others in their stead.
        all[200..].iter().rev().for_each(|point| placed.pop(point.at));
        let all: Vec<PlacedPoint> =
            all[..200].iter().copied().chain((400..700).map(point)).collect();
        all[200..].iter().for_each(|point| placed.push(*point));
        let root = Mat2::from_cols(vec2(1.5, 0.3), vec2(0.3, 1.1));
        let (mut found, mut none) = (0, 0);
        for (i, px) in (1000..1400).zip([1.0, 2.0, 4.5].into_iter().cycle()) {
            let (point, near) = (point(i), Nearness { root, px, same_family: 0.8, own_px: 9 });
            let expected = all.iter().any(|other| {
                (root * (other.at - point.at)).length_squared() < px * px
                    && (other.line != point.line || (other.along - point.along).abs() > 9)
                    && other.way.dot(point.way).abs() > 0.8
                    && other.object == point.object
            });
            assert_eq!(placed.has_near(&point, &near), expected, "{point:?} {px}");
            found += usize::from(expected);
            none += usize::from(!expected);
        }
        assert!(found > 50 && none > 50, "{found} {none}");
    }
}
