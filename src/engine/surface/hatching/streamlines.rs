//! Streamlines of a field, equally far apart on the surface (Jobard and Lefer 1997, with the
//! surface's own metric). Floor 2. Placed one after the other in a fixed order.

use super::directions::DirectionField;
use crate::math::{Vec2, hash, vec2};
use crate::surface::{Objects, Surface};
use std::collections::VecDeque;
use std::sync::Arc;

/// The side of a cell of the grid of points, px.
const CELL_PX: usize = 4;
/// A line starts where others are this far away, and ends where one comes nearer than the second, of
/// the distance that was asked.
const START: f32 = 0.8;
const STOP: f32 = 0.62;
/// Lines of one family are those whose directions differ by less than 37°.
const SAME_FAMILY: f32 = 0.8;
/// The length of the shortest line, in distances, and px.
const SHORTEST: (f32, f32) = (1.5, 7.0);
/// A step that turns by more ends a line, cos.
const SHARPEST: f32 = 0.7;
/// From one place where a neighbor begins to the next along a line, in distances.
const SEED_EVERY: f32 = 0.6;

/// A point of a line that was placed.
#[derive(Clone, Copy)]
struct PlacedPoint {
    at: Vec2,
    /// In the tangent plane.
    way: Vec2,
    line: u32,
    /// Its position along its line, px.
    along: i32,
    /// The object that it lies on.
    object: u32,
}

/// Lines of one family as they are placed.
pub struct Streamlines<'f> {
    field: &'f DirectionField<'f>,
    size: (usize, usize),
    objects: Arc<Objects>,
    family: u8,
    columns: usize,
    cells: Vec<Vec<PlacedPoint>>,
    lines: Vec<(u8, Vec<Vec2>)>,
}

impl<'f> Streamlines<'f> {
    /// None yet.
    pub fn new(surface: &'f Surface, field: &'f DirectionField<'f>, family: u8) -> Self {
        let size = (surface.size().width as usize, surface.size().height as usize);
        let columns = size.0.div_ceil(CELL_PX);
        let cells = vec![Vec::new(); columns * size.1.div_ceil(CELL_PX)];
        let objects = surface.objects();
        Self { field, size, objects, family, columns, cells, lines: Vec::new() }
    }

    /// The lines, each with its level.
    pub fn into_lines(self) -> Vec<(u8, Vec<Vec2>)> {
        self.lines
    }

    /// Fills the surface with lines of a level, so far apart, between those that are there.
    pub fn fill(&mut self, level: u8, apart: f32) {
        let mut queue: VecDeque<u32> = (0..self.lines.len() as u32).collect();
        let grid = (0.7 * apart).max(2.0);
        let (columns, rows) =
            ((self.size.0 as f32 / grid) as u32 + 1, (self.size.1 as f32 / grid) as u32 + 1);
        // In an order that has nothing to do with rows: no seams between scan lines.
        let mut places: Vec<u32> = (0..columns * rows).collect();
        places.sort_by_key(|&i| hash::mix(i ^ 0x51ed_270b));
        self.follow(&mut queue, level, apart);
        for i in places {
            let [jx, jy] = hash::unit_pair(0x9e37, i % columns, i / columns);
            let at = vec2((i % columns) as f32 + jx, (i / columns) as f32 + jy) * grid;
            if self.try_line(at, level, apart) {
                queue.push_back(self.lines.len() as u32 - 1);
                self.follow(&mut queue, level, apart);
            }
        }
    }

    /// Places the neighbors of lines, and theirs.
    fn follow(&mut self, queue: &mut VecDeque<u32>, level: u8, apart: f32) {
        let every = ((SEED_EVERY * apart) as usize).max(1);
        while let Some(line) = queue.pop_front() {
            let points = std::mem::take(&mut self.lines[line as usize].1);
            let starts = points.windows(2).step_by(every);
            let sides = starts.flat_map(|pair| [(pair[0], pair[1], 1.0), (pair[0], pair[1], -1.0)]);
            for (at, next, side) in sides {
                let Some((x, y)) = self.pixel(at) else { continue };
                let along = (self.field.root(x, y) * (next - at)).normalize_or_zero();
                let beside = at + side * apart * (self.field.inverse_root(x, y) * along.perp());
                if self.try_line(beside, level, apart) {
                    queue.push_back(self.lines.len() as u32 - 1);
                }
            }
            self.lines[line as usize].1 = points;
        }
    }

    /// The pixel of the surface at a place.
    fn pixel(&self, at: Vec2) -> Option<(usize, usize)> {
        let is_inside = at.x >= 1.0
            && at.y >= 1.0
            && at.x < self.size.0 as f32 - 1.0
            && at.y < self.size.1 as f32 - 1.0;
        let (x, y) = (at.x as usize, at.y as usize);
        (is_inside && self.field.is_on(x, y)).then_some((x, y))
    }

    /// A line through a place, if there is room for one of some length.
    fn try_line(&mut self, at: Vec2, level: u8, apart: f32) -> bool {
        if self.pixel(at).is_none() {
            return false;
        }
        let line = self.lines.len() as u32;
        let way = self.field.direction(at, self.family, Vec2::X);
        if self.is_crowded(at, way, START * apart, (line, 0)) {
            return false;
        }
        self.put(at, way, (line, 0));
        let forth = self.trace(at, way, 1, line, apart);
        let back = self.trace(at, -way, -1, line, apart);
        let length = (forth.len() + back.len()) as f32;
        if length < (SHORTEST.0 * apart).max(SHORTEST.1) {
            for at in back.iter().rev().chain(forth.iter().rev()).chain([&at]) {
                let cell = self.cell(*at);
                self.cells[cell].pop();
            }
            return false;
        }
        let points = back.into_iter().rev().chain([at]).chain(forth).collect();
        self.lines.push((level, points));
        true
    }

    /// The points after a place, a pixel apart, up to where a line ends.
    fn trace(&mut self, start: Vec2, way: Vec2, sign: i32, line: u32, apart: f32) -> Vec<Vec2> {
        let most = 4 * (self.size.0 + self.size.1);
        let (mut at, mut way, mut points) = (start, way, Vec::new());
        let Some(mut pixel) = self.pixel(at) else { return points };
        while points.len() < most {
            // The midpoint's direction.
            let half = at + 0.5 * self.step(pixel, way);
            let Some(middle) = self.pixel(half) else { break };
            if !self.field.is_joined(pixel, middle) {
                break;
            }
            let turned = self.field.direction(half, self.family, way);
            let next = at + self.step(middle, turned);
            let Some(there) = self.pixel(next) else { break };
            let is_sharp = turned.dot(way) < SHARPEST;
            let along = sign * (points.len() as i32 + 1);
            if is_sharp
                || !self.field.is_joined(pixel, there)
                || self.is_crowded(next, turned, STOP * apart, (line, along))
            {
                break;
            }
            self.put(next, turned, (line, along));
            points.push(next);
            (at, way, pixel) = (next, turned, there);
        }
        points
    }

    /// A pixel in the picture along a direction of the tangent plane.
    fn step(&self, (x, y): (usize, usize), way: Vec2) -> Vec2 {
        (self.field.inverse_root(x, y) * way).normalize_or_zero()
    }

    fn cell(&self, at: Vec2) -> usize {
        let (x, y) = (at.x as usize / CELL_PX, at.y as usize / CELL_PX);
        (y * self.columns + x).min(self.cells.len() - 1)
    }

    fn put(&mut self, at: Vec2, way: Vec2, (line, along): (u32, i32)) {
        let cell = self.cell(at);
        let object = self.objects.labels().at(at.x as usize, at.y as usize);
        self.cells[cell].push(PlacedPoint { at, way, line, along, object });
    }

    /// Whether a line of the family is nearer than a distance on the surface: another one, or the
    /// line itself where it comes back.
    fn is_crowded(&self, at: Vec2, way: Vec2, px: f32, (line, along): (u32, i32)) -> bool {
        let Some((x, y)) = self.pixel(at) else { return true };
        let root = self.field.root(x, y);
        let object = self.objects.labels().at(x, y);
        let [low, high] = [-px, px].map(|by| {
            let cell =
                |v: f32, n: usize| (v.max(0.0) as usize / CELL_PX).min(n.div_ceil(CELL_PX) - 1);
            (cell(at.x + by, self.size.0), cell(at.y + by, self.size.1))
        });
        let own = (3.0 * px) as i32 + 3;
        let is_near = |point: &PlacedPoint| {
            (root * (point.at - at)).length_squared() < px * px
                && (point.line != line || (point.along - along).abs() > own)
                && point.way.dot(way).abs() > SAME_FAMILY
                && point.object == object
        };
        (low.1..=high.1).any(|row| {
            self.cells[row * self.columns + low.0..=row * self.columns + high.0]
                .iter()
                .any(|cell| cell.iter().any(is_near))
        })
    }
}
