//! Gap closing: removes what a fill reached only through a narrow passage, up to the narrowest
//! point of the passage. Floor 1.
//!
//! Every pixel inside has a distance to the border. Rooms are hills of that distance, passages
//! between them are saddles; a watershed (Vincent and Soille 1991, by a union of pixels in falling
//! order) assigns each pixel to the hill it lies on. Two hills are one room unless the saddle
//! between them is a gap: low enough, and clearly lower than both tops.

use super::{Plane, distance};
use crate::math::{Rect, Size, parallel};

/// The widest gap that can be closed, px.
pub const WIDEST_GAP_PX: f32 = 64.0;
/// How much lower than both tops a saddle must be to be a gap, px: more than the roughness of a
/// straight corridor drawn in pixels.
const CLEARLY_PX: f32 = 1.0;
/// Levels of distance to a pixel.
const LEVELS_PER_PX: f32 = 4.0;

/// Some pixels of the canvas: 1 in a plane that covers a rectangle of it.
pub struct PixelSet {
    /// Where they lie.
    pub rect: Rect,
    /// Of that rectangle: 1 where a pixel belongs to the set.
    pub pixels: Plane<u8>,
}

impl PixelSet {
    /// The same pixels in another rectangle.
    pub fn within(self, rect: Rect) -> PixelSet {
        if rect == self.rect {
            return self;
        }
        let mut pixels = Plane::full(Size::new(rect.width() as u32, rect.height() as u32), 0u8);
        let both = rect.intersect(self.rect);
        for y in both.y0..both.y1 {
            let from =
                &self.pixels.row((y - self.rect.y0) as usize)[(both.x0 - self.rect.x0) as usize..];
            let to = &mut pixels.row_mut((y - rect.y0) as usize)[(both.x0 - rect.x0) as usize..];
            to[..both.width()].copy_from_slice(&from[..both.width()]);
        }
        PixelSet { rect, pixels }
    }
}

/// The room that contains `start`, of what was joined to it.
pub fn close_gaps(inside: PixelSet, start: (i32, i32), canvas: Size, gap_px: f32) -> PixelSet {
    // From the middle of a gap w px wide to the center of the border's nearest pixel: at most (w +
    // 1)/2. Tops are capped at the height that makes a saddle of that distance a gap.
    let top_px = 0.5 * (gap_px + 1.0) + CLEARLY_PX;
    let limit = top_px.ceil() as u16;
    // The surroundings of the rectangle count as border; the edge of the canvas does not.
    let rect = inside.rect.grown(i32::from(limit)).intersect(canvas.rect());
    let PixelSet { rect, mut pixels } = inside.within(rect);
    let levels = levels(&pixels, limit, top_px);
    let mut rooms = DistanceHills::new(&pixels, &levels, (top_px * LEVELS_PER_PX) as u8);
    rooms.rise();
    let width = pixels.width().max(1);
    let first = (start.1 - rect.y0) as usize * width + (start.0 - rect.x0) as usize;
    let (room, parents) = (rooms.top_of(first), rooms.parent);
    // Runs of a row mostly share their hill: each is looked up once.
    let rows = pixels.values_mut().chunks_mut(width).zip(parents.chunks(width));
    parallel::for_each(rows, 1, |(row, ups)| {
        let mut last = (NONE, false);
        for (pixel, &up) in row.iter_mut().zip(ups).filter(|(pixel, _)| **pixel != 0) {
            if up != last.0 {
                last = (up, root_of(&parents, up) == room);
            }
            *pixel = u8::from(last.1);
        }
    });
    PixelSet { rect, pixels }
}

/// The rooms of some pixels, numbered from 1 in the order of their first pixels; 0 outside.
/// Passages up to `gap_px` wide divide them; the border of the plane is a wall.
pub fn rooms(inside: &Plane<bool>, gap_px: f32) -> Plane<u32> {
    let top_px = 0.5 * (gap_px.max(0.0).min(WIDEST_GAP_PX) + 1.0) + CLEARLY_PX;
    let limit = top_px.ceil() as u16;
    let size = inside.size();
    // One pixel around it is the wall.
    let walled = Size::new(size.width.saturating_add(2), size.height.saturating_add(2));
    let at = |x: usize, y: usize| inside.get(x as i32 - 1, y as i32 - 1).unwrap_or(false);
    let pixels = Plane::from_fn(walled, |x, y| u8::from(at(x, y)));
    let levels = levels(&pixels, limit, top_px);
    let mut hills = DistanceHills::new(&pixels, &levels, (top_px * LEVELS_PER_PX) as u8);
    hills.rise();
    let width = pixels.width();
    let mut numbers = vec![0u32; pixels.values().len()];
    let (mut count, mut rooms) = (0, Plane::full(size, 0u32));
    for y in 0..rooms.height() {
        for (x, room) in rooms.row_mut(y).iter_mut().enumerate().filter(|(x, _)| inside.at(*x, y)) {
            let number = &mut numbers[hills.top_of((y + 1) * width + x + 1)];
            if *number == 0 {
                count += 1;
                *number = count;
            }
            *room = *number;
        }
    }
    rooms
}

/// Levels of distance to the border, capped at the tops.
fn levels(pixels: &Plane<u8>, limit: u16, top_px: f32) -> Plane<u8> {
    let top = (top_px * LEVELS_PER_PX) as u8;
    let farthest = (usize::from(limit) + 1).pow(2);
    let level = |squared: usize| (((squared as f32).sqrt() * LEVELS_PER_PX) as u8).min(top);
    let levels: Vec<u8> = (0..=farthest).map(level).collect();
    distance::squared_distances(&pixels.map(|p| u8::from(p == 0)), limit)
        .map(|d| levels[usize::from(d).min(farthest)])
}

/// The top of the hill that a pixel with this parent lies on.
fn root_of(parents: &[u32], mut up: u32) -> usize {
    while let Some(&next) = parents.get(up as usize).filter(|&&next| next != up && next != NONE) {
        up = next;
    }
    up as usize
}

/// Hills of distance: a forest over the pixels, each tree one hill, its root a pixel of its top.
struct DistanceHills<'a> {
    pixels: &'a Plane<u8>,
    levels: &'a Plane<u8>,
    /// The level from which tops are equal.
    top: u8,
    /// `NONE` before its turn.
    parent: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl<'a> DistanceHills<'a> {
    fn new(pixels: &'a Plane<u8>, levels: &'a Plane<u8>, top: u8) -> Self {
        Self { pixels, levels, top, parent: vec![NONE; pixels.values().len()] }
    }

    fn top_of(&mut self, mut i: usize) -> usize {
        while let Some(&up) = self.parent.get(i).filter(|&&up| up != NONE && up as usize != i) {
            self.parent[i] = self.parent[up as usize];
            i = self.parent[i] as usize;
        }
        i
    }

    fn level(&self, i: usize) -> u8 {
        self.levels.values()[i]
    }

    /// The pixels from the tops downward, those of one level in their order.
    fn rise(&mut self) {
        let width = self.pixels.width().max(1);
        // The tops come first and need no sorting.
        self.stand_tops(width);
        let mut of_level: Vec<Vec<u32>> = vec![Vec::new(); usize::from(self.top) + 1];
        for (i, (&p, &level)) in self.pixels.values().iter().zip(self.levels.values()).enumerate() {
            if p != 0 && level < self.top {
                of_level[usize::from(level)].push(i as u32);
            }
        }
        for i in of_level.into_iter().rev().flatten() {
            self.stand(i as usize, width);
        }
    }

    fn is_top(&self, i: usize) -> bool {
        self.pixels.values()[i] != 0 && self.level(i) >= self.top
    }

    /// Joins the tops, a run of a row at a time: most inside pixels are at the capped distance.
    /// Tops that touch form one hill, whose root is its first pixel.
    fn stand_tops(&mut self, width: usize) {
        let count = self.parent.len();
        let mut i = 0;
        while i < count {
            if !self.is_top(i) {
                i += 1;
                continue;
            }
            let (first, row_end) = (i, i - i % width + width);
            while i < row_end && self.is_top(i) {
                self.parent[i] = first as u32;
                i += 1;
            }
            // In the row above, once for each of its runs.
            let mut was_top = false;
            for above in first.saturating_sub(width)..i.saturating_sub(width) {
                let is_top = self.parent[above] != NONE;
                if is_top && !was_top {
                    let (a, b) = (self.top_of(above), self.top_of(first));
                    self.parent[a.max(b)] = a.min(b) as u32;
                }
                was_top = is_top;
            }
        }
    }

    /// A pixel joins the highest adjacent hill, and merges hills that are one room.
    fn stand(&mut self, i: usize, width: usize) {
        self.parent[i] = i as u32;
        let beside = [
            i.checked_sub(width),
            Some(i).filter(|i| i % width > 0).map(|i| i - 1),
            Some(i + 1).filter(|i| i % width > 0),
            Some(i + width),
        ];
        let mut tops = [None; 4];
        for (top, j) in tops.iter_mut().zip(beside) {
            let stands = j.filter(|&j| self.parent.get(j).is_some_and(|&up| up != NONE));
            *top = stands.map(|j| self.top_of(j));
        }
        let rank = |rooms: &Self, top: usize| (rooms.level(top), std::cmp::Reverse(top));
        let Some(highest) = tops.into_iter().flatten().max_by_key(|&top| rank(self, top)) else {
            return;
        };
        self.parent[i] = highest as u32;
        let clearly = (CLEARLY_PX * LEVELS_PER_PX) as u8;
        let mut room = highest;
        for top in tops.into_iter().flatten() {
            let (top, one) = (self.top_of(top), self.top_of(room));
            let lower = self.level(top).min(self.level(one));
            if top != one && lower - self.level(i).min(lower) < clearly {
                let (above, below) =
                    if rank(self, top) > rank(self, one) { (top, one) } else { (one, top) };
                self.parent[below] = above as u32;
                room = above;
            }
        }
    }
}
