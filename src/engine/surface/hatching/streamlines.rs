//! Streamlines of a field, equally far apart on the surface (Jobard and Lefer 1997, with the
//! surface's own metric). Floor 2. Placed one after the other in a fixed order.

use super::bridges::{Bridge, Bridges};
use super::directions::DirectionField;
use super::placed::{Nearness, PlacedPoint, PlacedPoints};
use crate::math::{Mat2, Vec2, hash, vec2};
use crate::surface::line_ends::LineEnd;
use crate::surface::{Objects, Surface};
use rayon::prelude::*;
use std::collections::VecDeque;
use std::sync::Arc;

/// A line starts where others are this far away, and ends where one comes nearer than the second, of
/// the distance that was asked.
const START: f32 = 0.76;
const STOP: f32 = 0.75;
/// Lines are placed at this share of the distance: none comes nearer than `STOP`, but where they
/// part some are farther, so that the mean is what was asked.
const PLACED_AT: f32 = 0.94;
/// Between a line and one that is nearer, a new one lies in the middle, of the distance.
const MIDDLE: f32 = 2.5;
/// A side is taken if a line is this near to where a new one would lie, of the distance: it is then
/// no farther than `2 START` away.
const TAKEN: f32 = 2.0 * START - 1.0;
/// Lines of one family are those whose directions differ by less than 37°.
const SAME_FAMILY: f32 = 0.8;
/// The length of the shortest line, in distances, and px.
const SHORTEST: (f32, f32) = (1.5, 7.0);
/// A step that turns by more ends a line, cos.
const SHARPEST: f32 = 0.7;
/// How near others are to a bridge at most, and how far from its ends that is asked, in distances.
const BRIDGE_STOP: f32 = 0.4;
const CLEAR_OF_ENDS: f32 = 0.5;
/// The shortest line that may go on in itself, points.
const RING_POINTS: usize = 40;
/// From one place where a neighbor begins to the next along a line, in distances.
const SEED_EVERY: f32 = 1.2;

/// Lines of one family as they are placed.
pub struct Streamlines<'f> {
    field: &'f DirectionField<'f>,
    size: (usize, usize),
    objects: Arc<Objects>,
    family: u8,
    placed: PlacedPoints,
    lines: Vec<(u8, Vec<Vec2>)>,
    /// Which point of each line was its first.
    firsts: Vec<u32>,
    bridges: Bridges,
}

impl<'f> Streamlines<'f> {
    /// None yet.
    pub fn new(surface: &'f Surface, field: &'f DirectionField<'f>, family: u8) -> Self {
        let size = (surface.size().width as usize, surface.size().height as usize);
        let (objects, placed) = (surface.objects(), PlacedPoints::new(size));
        let (lines, firsts, bridges) = (Vec::new(), Vec::new(), Bridges::default());
        Self { field, size, objects, family, placed, lines, firsts, bridges }
    }

    /// The lines, each with its level.
    pub fn into_lines(self) -> Vec<(u8, Vec<Vec2>)> {
        self.bridges.string_lines(self.lines)
    }

    /// Fills the surface with lines of a level, so far apart, between those that are there.
    pub fn fill(&mut self, level: u8, apart: f32) {
        let apart = PLACED_AT * apart;
        let mut queue: VecDeque<u32> = (0..self.lines.len() as u32).collect();
        let grid = (0.7 * apart).max(2.0);
        let (columns, rows) =
            ((self.size.0 as f32 / grid) as u32 + 1, (self.size.1 as f32 / grid) as u32 + 1);
        self.follow(&mut queue, level, apart);
        let place = |i: u32| {
            let [jx, jy] = hash::unit_pair(0x9e37, i % columns, i / columns);
            vec2((i % columns) as f32 + jx, (i / columns) as f32 + jy) * grid
        };
        // What is crowded already stays so: most places are sorted out row by row.
        let all = (0..rows).into_par_iter().flat_map_iter(|row| row * columns..(row + 1) * columns);
        let mut places: Vec<u32> = all.filter(|i| self.has_room(place(*i), apart)).collect();
        // In an order that has nothing to do with rows: no seams between scan lines.
        places.sort_by_key(|&i| hash::mix(i ^ 0x51ed_270b));
        for at in places.into_iter().map(place) {
            if self.try_line(at, level, apart) {
                queue.push_back(self.lines.len() as u32 - 1);
                self.follow(&mut queue, level, apart);
            }
        }
        self.bridge_gaps(level, apart);
    }

    /// Lets lines of a level that end where others crowd them go on beyond, in lines that they face.
    fn bridge_gaps(&mut self, level: u8, apart: f32) {
        let own = self.lines.iter().enumerate().filter(|(_, (of, _))| *of == level);
        let ends = own.flat_map(|(i, (_, points))| LineEnd::both_of(i, points.iter().copied()));
        let ends: Vec<LineEnd> = ends.collect();
        let mut bridges = std::mem::take(&mut self.bridges);
        bridges.join(&ends, apart, |bridge| self.try_bridge(bridge, apart));
        self.bridges = bridges;
    }

    /// Places a bridge if it lies on one piece, and no other line is in its way.
    fn try_bridge(&mut self, bridge: &Bridge, apart: f32) -> bool {
        let line = bridge.from.line;
        let is_short_ring = line == bridge.to.line
            && self.lines[line].1.len() < RING_POINTS.max(4 * bridge.points.len());
        let whole = [bridge.from.at].into_iter().chain(bridge.points.iter().copied());
        let whole: Vec<Vec2> = whole.chain([bridge.to.at]).collect();
        let is_on = |pair: &[Vec2]| {
            let pixels = [self.pixel(pair[0]), self.pixel(pair[1])];
            matches!(pixels, [Some(a), Some(b)] if a == b || self.field.is_joined(a, b))
        };
        let way = |at: Vec2, next: Vec2| {
            let root = self.pixel(at).map_or(Mat2::IDENTITY, |(x, y)| self.field.root(x, y));
            (root * (next - at)).normalize_or_zero()
        };
        let placed: Vec<(Vec2, Vec2)> =
            whole.windows(2).skip(1).map(|pair| (pair[0], way(pair[0], pair[1]))).collect();
        let is_free = |(at, way): &(Vec2, Vec2)| {
            let ends = [bridge.from.at, bridge.to.at].map(|end| end.distance(*at));
            ends[0].min(ends[1]) < CLEAR_OF_ENDS * apart
                || !self.is_crowded(*at, *way, BRIDGE_STOP * apart, (line as u32, 0))
        };
        let is_possible =
            !is_short_ring && whole.windows(2).all(is_on) && placed.iter().all(is_free);
        if is_possible {
            let end = if bridge.from.is_last {
                self.lines[line].1.len() as i32 - 1 - self.firsts[line] as i32
            } else {
                -(self.firsts[line] as i32)
            };
            for (i, (at, way)) in placed.into_iter().enumerate() {
                let beyond = i as i32 + 1;
                let along = end + if bridge.from.is_last { beyond } else { -beyond };
                self.put(at, way, (line as u32, along));
            }
        }
        is_possible
    }

    /// Places the neighbors of lines, and theirs.
    fn follow(&mut self, queue: &mut VecDeque<u32>, level: u8, apart: f32) {
        let every = ((SEED_EVERY * apart) as usize).max(1);
        while let Some(line) = queue.pop_front() {
            let points = std::mem::take(&mut self.lines[line as usize].1);
            for i in (0..points.len().saturating_sub(1)).step_by(every) {
                for side in [1.0, -1.0] {
                    let next = points[i + 1];
                    let Some(at) = self.place_beside(points[i], next, side, (line, i), apart)
                    else {
                        continue;
                    };
                    if self.try_line(at, level, apart) {
                        queue.push_back(self.lines.len() as u32 - 1);
                    }
                }
            }
            self.lines[line as usize].1 = points;
        }
    }

    /// Where a neighbor of a line begins on one side: as far away as was asked, or in the middle
    /// between it and the next line; `None` where that is too near.
    fn place_beside(
        &self,
        at: Vec2,
        next: Vec2,
        side: f32,
        (line, along): (u32, usize),
        apart: f32,
    ) -> Option<Vec2> {
        let (x, y) = self.pixel(at)?;
        let root = self.field.root(x, y);
        let way = (root * (next - at)).normalize_or_zero();
        let across = side * way.perp();
        let px = MIDDLE * apart;
        let near = Nearness { root, px, same_family: SAME_FAMILY, own_px: (3.0 * px) as i32 + 3 };
        let object = self.objects.labels().at(x, y);
        let along = along as i32 - self.firsts[line as usize] as i32;
        let point = PlacedPoint { at, way, line, along, object };
        let px_across = self.field.inverse_root(x, y) * across;
        // Most sides have their line: it is about as far away as was asked.
        let beside = PlacedPoint { at: at + apart * px_across, ..point };
        if self.placed.has_near(&beside, &Nearness { px: TAKEN * apart, ..near }) {
            return None;
        }
        let far = match self.placed.gap_beside(&point, [across, px_across], &near) {
            Some(gap) if gap < 2.0 * START * apart => return None,
            Some(gap) => 0.5 * gap,
            None => apart,
        };
        Some(at + far * px_across)
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

    /// Whether a line could begin at a place.
    fn has_room(&self, at: Vec2, apart: f32) -> bool {
        let is_free = |way| !self.is_crowded(at, way, START * apart, (u32::MAX, 0));
        self.pixel(at).is_some() && is_free(self.field.direction(at, self.family, Vec2::X))
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
                self.placed.pop(*at);
            }
            return false;
        }
        self.firsts.push(back.len() as u32);
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

    fn put(&mut self, at: Vec2, way: Vec2, (line, along): (u32, i32)) {
        let object = self.objects.labels().at(at.x as usize, at.y as usize);
        self.placed.push(PlacedPoint { at, way, line, along, object });
    }

    /// Whether a line of the family is nearer than a distance on the surface: another one, or the
    /// line itself where it comes back.
    fn is_crowded(&self, at: Vec2, way: Vec2, px: f32, (line, along): (u32, i32)) -> bool {
        let Some((x, y)) = self.pixel(at) else { return true };
        let object = self.objects.labels().at(x, y);
        let (root, own_px) = (self.field.root(x, y), (3.0 * px) as i32 + 3);
        let near = Nearness { root, px, same_family: SAME_FAMILY, own_px };
        self.placed.has_near(&PlacedPoint { at, way, line, along, object }, &near)
    }
}
