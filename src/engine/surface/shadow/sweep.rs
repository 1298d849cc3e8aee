//! Parallel rays of a whole map, line after line along the rays: every pixel looks at all that
//! stands between it and the lamp, and costs the same however far that is. Floor 2. The equation
//! is in `super`.
//!
//! A ray that goes farther along y than along x meets every row, so the lines of a strip are read
//! side by side, row by row from the lamp's side on, each between the two pixels that it passes. A
//! line's height above the ray is h + rise · distance from the lamp's side: what stands highest
//! above a pixel's ray is the greatest of these within reach, a sliding maximum. It is that since
//! the last whole block of rows began, or that of the end of the block before (van Herk 1992).
//! Rays that go farther along x sweep the turned map.

use super::{Aim, HeightMaps, LampRay, fade, hidden, seen, width_at};
use crate::math::{Size, fast, simd::prefetch, vec2};
use crate::raster::Plane;
use crate::surface::shadow::ShareMap;
use rayon::prelude::*;

/// Lines of a strip, side by side.
pub(super) const LANES: usize = 72;
/// Pixels between them in a row that are looked at: whole vectors of both.
pub(super) const BETWEEN: usize = 64;
pub(super) type LineValues = [f32; LANES];
/// What a ray counts where it is hidden wholly.
pub(super) const WHOLE: f32 = 1000.0;
/// Lower than every height above a ray.
pub(super) const NOTHING: f32 = -1e9;

/// How much rays are hidden, added up in whole numbers.
pub(super) struct HiddenCounts {
    size: Size,
    upright: Option<Plane<u16>>,
    turned: Option<Plane<u16>>,
}

impl HiddenCounts {
    pub fn new(size: Size) -> Self {
        Self { size, upright: None, turned: None }
    }

    /// The sums of rays that sweep the map as it lies or turned.
    pub fn of(&mut self, is_turned: bool) -> &mut Plane<u16> {
        let Size { width, height } = self.size;
        match is_turned {
            false => self.upright.get_or_insert_with(|| Plane::filled(self.size, 0)),
            true => self.turned.get_or_insert_with(|| Plane::filled(Size::new(height, width), 0)),
        }
    }

    pub fn plus(self, other: Self) -> Self {
        let sum = |a: Option<Plane<u16>>, b: Option<Plane<u16>>| match (a, b) {
            (Some(mut a), Some(b)) => {
                a.values_mut().iter_mut().zip(b.values()).for_each(|(a, b)| *a += b);
                Some(a)
            }
            (a, b) => a.or(b),
        };
        let (upright, turned) = (sum(self.upright, other.upright), sum(self.turned, other.turned));
        Self { size: self.size, upright, turned }
    }

    /// What each pixel sees of the lamp that so many rays go to.
    pub fn visible_shares(self, rays: u32) -> ShareMap {
        let per_count = 1.0 / (WHOLE * rays as f32);
        let turned = self.turned.map(|plane| turned(&plane));
        let mut counts = match (self.upright, turned) {
            (Some(a), Some(b)) => a.updated(|x, y, v| v + b.at(x, y)),
            (a, b) => a.or(b).unwrap_or_else(|| Plane::filled(self.size, 0)),
        };
        let steps: Vec<u16> = (0..=(WHOLE * rays as f32) as u32)
            .map(|count| (seen(count as f32 * per_count) * f32::from(u16::MAX) + 0.5) as u16)
            .collect();
        counts = counts.updated(|_, _, v| steps.get(usize::from(v)).copied().unwrap_or(0));
        ShareMap::from_steps(counts, 1.0)
    }
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

/// Whole rows of a window, in a map of so many.
pub(super) fn rows_of(window: f32, height: usize) -> usize {
    (window.max(1.0) as usize).clamp(1, height.max(1))
}

/// Lines of one direction over a map.
struct ParallelLines<'a> {
    heights: &'a Plane<f32>,
    /// Rows are counted from the lamp's side: from the last one up.
    is_reversed: bool,
    /// From row to row away from the lamp, px along it.
    slope: f32,
    /// px along a line from row to row.
    length: f32,
    rise: f32,
    spread: f32,
    reach_px: f32,
    /// What stands lower than this above a ray hides nothing of it, px.
    least_above: f32,
}

/// Adds how much a ray is hidden from every pixel.
pub(super) fn add(heights: &HeightMaps, ray: &LampRay, counts: &mut HiddenCounts) {
    let Aim::Along { way, rise } = ray.aim else { return };
    let is_turned = way.x.abs() > way.y.abs();
    let (map, way) = match is_turned {
        false => (&heights.upright, way),
        true => (&heights.turned, vec2(way.y, way.x)),
    };
    let length = 1.0 / way.y.abs().max(1e-3);
    let reach = rows_of(0.5 * ray.reach_px / length, map.height());
    let lines = ParallelLines {
        heights: map,
        is_reversed: way.y > 0.0,
        slope: -way.x * length,
        length,
        rise,
        spread: ray.spread,
        reach_px: ray.reach_px,
        least_above: -0.5 * width_at(ray.reach_px + length, rise, ray.spread),
    };
    let counts = counts.of(is_turned);
    let mut kept = SlidingHighest::of(reach);
    // The lines of the first and of the last row.
    let ends = [0.0, lines.slope * map.height() as f32];
    let first = (ends[0].min(-ends[1]) - 2.0).floor() as i64;
    let last = (ends[0].max(-ends[1]) + map.width() as f32 + 2.0) as i64;
    for line in (first..last).step_by(BETWEEN) {
        add_strip(&lines, line, &mut kept, counts);
    }
}

/// What strips keep of their rows: the greatest of those that a row looks back at, however many
/// these are.
pub(super) struct SlidingHighest {
    /// Of this block, the heights of its rows, and the highest since it began.
    block: Vec<LineValues>,
    since: Highest,
    in_block: usize,
    /// The highest of a row of the block before or of those after it.
    before: Vec<Highest>,
    /// The highest that the last rows looked back at, and that this one does.
    last: Vec<Highest>,
    near: Highest,
}

impl SlidingHighest {
    /// For rows that look back at `reach` others, `≥ 1`.
    pub fn of(reach: usize) -> Self {
        Self {
            block: vec![[NOTHING; LANES]; reach],
            since: Highest::NONE,
            in_block: 0,
            before: vec![Highest::NONE; reach],
            last: vec![Highest::NONE; reach],
            near: Highest::NONE,
        }
    }

    /// Forgets the rows of another strip.
    #[inline(always)]
    pub fn leave(&mut self) {
        (self.since, self.in_block) = (Highest::NONE, 0);
        self.before.fill(Highest::NONE);
        self.last.fill(Highest::NONE);
    }

    /// The highest of the rows that the next one looks back at, and of as many before these.
    #[inline(always)]
    pub fn highest(&mut self) -> [&Highest; 2] {
        let (since, before) = (&self.since, &self.before[self.in_block]);
        for i in 0..LANES {
            // Values, not places: the compiler would choose between addresses.
            let (a, b) = (before.height[i], since.height[i]);
            let (row_a, row_b) = (before.row[i], since.row[i]);
            self.near.height[i] = if a > b { a } else { b };
            self.near.row[i] = if a > b { row_a } else { row_b };
        }
        // Rows are as many as a block's: this one's place holds the row a block before.
        [&self.near, &self.last[self.in_block]]
    }

    /// Goes on to the next row, after [`SlidingHighest::highest`]: `heights` of row number `turn`.
    #[inline(always)]
    pub fn take(&mut self, heights: &LineValues, turn: usize) {
        let reach = self.block.len();
        self.last[self.in_block] = self.near;
        self.since.take(heights, turn as f32);
        self.block[self.in_block] = *heights;
        self.in_block += 1;
        if self.in_block == reach {
            let (mut after, first) = (Highest::NONE, turn + 1 - reach);
            for k in (0..reach).rev() {
                after.take(&self.block[k], (first + k) as f32);
                self.before[k] = after;
            }
            (self.since, self.in_block) = (Highest::NONE, 0);
        }
    }
}

/// What stands highest on each line, and in which row.
#[derive(Clone, Copy)]
pub(super) struct Highest {
    pub height: LineValues,
    pub row: LineValues,
}

impl Highest {
    const NONE: Self = Self { height: [NOTHING; LANES], row: [0.0; LANES] };

    #[inline(always)]
    fn take(&mut self, heights: &LineValues, row: f32) {
        for ((height, at), new) in self.height.iter_mut().zip(&mut self.row).zip(heights) {
            let higher = *new > *height;
            *height = if higher { *new } else { *height };
            *at = if higher { row } else { *at };
        }
    }
}

/// The rows of a strip that lie in the picture.
fn rows_inside(lines: &ParallelLines, line: i64) -> std::ops::Range<usize> {
    let (width, height) = (lines.heights.width() as f32, lines.heights.height());
    let inside = |r: usize| {
        let x = line as f32 + lines.slope * r as f32;
        x > -(LANES as f32) - 1.0 && x < width + 1.0
    };
    let Some(first) = (0..height).find(|r| inside(*r)) else { return 0..0 };
    let last = (first..height).rfind(|r| inside(*r)).unwrap_or(first);
    first..last + 1
}

/// Rows that are fetched ahead: each lies pages away from the one before.
const AHEAD: usize = 3;

impl ParallelLines<'_> {
    #[inline(always)]
    fn prefetch(&self, x0: i64, r: usize, counts: &Plane<u16>) {
        let (width, height) = (self.heights.width(), self.heights.height());
        if r < height {
            let y = if self.is_reversed { height - 1 - r } else { r };
            let first = (x0.max(0) as usize).min(width);
            let columns = first..(first + LANES).min(width);
            prefetch(&self.heights.row(y)[columns.clone()]);
            prefetch(&counts.row(y)[columns]);
        }
    }
}

crate::widest! {
    /// Adds how much the ray is hidden from the pixels between the lines of a strip.
    fn add_strip(lines: &ParallelLines, line: i64, kept: &mut SlidingHighest, counts: &mut Plane<u16>) {
        let (width, height) = (lines.heights.width() as i64, lines.heights.height());
        let rows = rows_inside(lines, line);
        let per_row = lines.rise * lines.length;
        kept.leave();
        for (i, r) in rows.enumerate() {
            let x = line as f32 + lines.slope * r as f32;
            let whole = x.floor();
            let (x0, between) = (whole as i64, x - whole);
            let y = if lines.is_reversed { height - 1 - r } else { r };
            let row = lines.heights.row(y);
            lines.prefetch(x0, r + AHEAD, counts);
            let mut h = [0.0; LANES + 1];
            if x0 >= 0 && x0 + (LANES as i64) < width {
                h.copy_from_slice(&row[x0 as usize..x0 as usize + LANES + 1]);
            } else {
                for (k, h) in h.iter_mut().enumerate() {
                    *h = if (0..width).contains(&(x0 + k as i64)) { row[(x0 + k as i64) as usize] } else { 0.0 };
                }
            }
            // Counted from where the strip begins, so that numbers stay small.
            let (turn, gain) = (i as f32, i as f32 * per_row);
            add_row(lines, &h, kept.highest(), (turn, gain, between), x0, counts.row_mut(y));
            let mut heights = [0.0; LANES];
            for k in 0..LANES {
                heights[k] = h[k] + between * (h[k + 1] - h[k]) + gain;
            }
            kept.take(&heights, i);
        }
    }
}

/// Adds how much the ray is hidden from the pixels of one row.
///
/// * `highest`: near and far.
/// * `at`: rows since the strip's first one, the gain of a line's height over them, and how far
///   each line lies to the right of its pixel.
#[inline(always)]
fn add_row(
    lines: &ParallelLines,
    h: &[f32; LANES + 1],
    highest: [&Highest; 2],
    at: (f32, f32, f32),
    x0: i64,
    row: &mut [u16],
) {
    let (turn, gain, between) = at;
    let mut own = [0.0; BETWEEN];
    for (own, h) in own.iter_mut().zip(&h[1..]) {
        *own = h + gain;
    }
    // Most rows lie in the light.
    let mut counts = [0; 2];
    for (count, highest) in counts.iter_mut().zip(highest) {
        for (i, own) in own.iter().enumerate() {
            let over = fast::max(highest.height[i], highest.height[i + 1]) - own;
            *count += u32::from(over > lines.least_above);
        }
    }
    if counts == [0, 0] {
        return;
    }
    // The pixel lies 1 − between right of its left line.
    let (mut added, mut share) = ([0u16; BETWEEN], [[0.0; BETWEEN]; 2]);
    if counts[0] > 0 {
        for (k, share) in share.iter_mut().enumerate() {
            for i in 0..BETWEEN {
                let distance = (turn - highest[0].row[i + k]) * lines.length;
                let above = highest[0].height[i + k] - own[i];
                share[i] = hidden(above, distance, lines.rise, lines.spread);
            }
        }
    }
    if counts[1] > 0 {
        for (k, share) in share.iter_mut().enumerate() {
            for i in 0..BETWEEN {
                let distance = (turn - highest[1].row[i + k]) * lines.length;
                let above = highest[1].height[i + k] - own[i];
                let far = hidden(above, distance, lines.rise, lines.spread);
                share[i] = fast::max(share[i], far * fade(distance, lines.reach_px));
            }
        }
    }
    let [left, right] = &share;
    for i in 0..BETWEEN {
        added[i] = fast::whole((right[i] + (left[i] - right[i]) * between) * WHOLE) as u16;
    }
    let first = (x0 + 1).max(0);
    let skipped = (first - x0 - 1) as usize;
    let start = (first as usize).min(row.len());
    let row = &mut row[start..];
    if skipped < BETWEEN {
        row.iter_mut().zip(&added[skipped..BETWEEN]).for_each(|(sum, added)| *sum += added);
    }
}
