//! Points of lines in a grid, to find those near a place. Floor 2.

use super::{ENDS, directions};
use crate::math::Vec2;
use crate::surface::form_lines::{LineKind, LinePoint};
use std::collections::HashMap;

/// The side of a cell, px.
const CELL_PX: f32 = 4.0;

/// A point of a line that was added.
#[derive(Clone, Copy)]
pub struct NearPoint {
    pub at: Vec2,
    /// Unit.
    pub along: Vec2,
    pub line: u32,
    pub kind: LineKind,
    /// It is one of the last points of its line.
    pub is_end: bool,
}

/// Points by their cells.
#[derive(Default)]
pub struct NearPoints(HashMap<(i32, i32), Vec<NearPoint>>);

impl NearPoints {
    pub fn add(&mut self, line: u32, kind: LineKind, points: &[LinePoint]) {
        let along = directions(points, false);
        for (i, (point, along)) in points.iter().zip(along).enumerate() {
            let cell = (point.at / CELL_PX).floor().as_ivec2();
            let is_end = i < ENDS || i + ENDS >= points.len();
            let near = NearPoint { at: point.at, along, line, kind, is_end };
            self.0.entry((cell.x, cell.y)).or_default().push(near);
        }
    }

    fn points_near(&self, at: Vec2, reach_px: f32) -> impl Iterator<Item = &NearPoint> {
        let [low, high] = [-reach_px, reach_px].map(|by| ((at + by) / CELL_PX).floor().as_ivec2());
        let cells = (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| (x, y)));
        cells.filter_map(|cell| self.0.get(&cell)).flatten()
    }

    /// Whether one of those within a distance is as asked.
    pub fn has_within(&self, at: Vec2, px: f32, is_asked: impl Fn(&NearPoint) -> bool) -> bool {
        self.points_near(at, px).any(|point| point.at.distance(at) < px && is_asked(point))
    }

    /// The nearest within a distance, of those that count.
    pub fn nearest(
        &self,
        at: Vec2,
        px: f32,
        counts: impl Fn(&NearPoint) -> bool,
    ) -> Option<&NearPoint> {
        let near = self.points_near(at, px).filter(|point| counts(point));
        let by = |point: &&NearPoint| point.at.distance_squared(at);
        near.filter(|point| by(point) < px * px).min_by(|a, b| by(a).total_cmp(&by(b)))
    }
}
