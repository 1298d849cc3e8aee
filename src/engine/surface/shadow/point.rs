//! Rays to a point of a whole map: as parallel ones, but the lines of a strip run together at the
//! lamp. Floor 2. The equation is in `super`.
//!
//! Each quarter of the picture that the lamp looks at is swept from it outward. A pixel at height h
//! and ρ rows away sees the lamp, at height H, under the slope (H − h)/ρ; what stands on its line
//! under the least slope is what stands highest above its ray.

use super::counts::{HiddenCounts, WHOLE};
use super::heights::HeightMaps;
use super::{Aim, LampRay, RISE, fade, hidden_share};
use crate::math::{Vec3, fast, vec3};
use crate::raster::Plane;

/// Lines of a strip, side by side.
const LANES: usize = 72;
/// Pixels between them in a row that are looked at: whole vectors of both.
const BETWEEN: usize = 64;
type LineValues = [f32; LANES];
/// Lower than every height above a ray.
const NOTHING: f32 = -1e9;
/// Rows closer than this to the lamp lie under it.
const UNDER: f32 = 0.5;

/// One of the quarters.
struct Quarter<'a> {
    heights: &'a Plane<f32>,
    lamp: Vec3,
    /// Toward row 0.
    is_up: bool,
    /// Whether pixels on the diagonal belong to it.
    has_diagonal: bool,
    /// Rows from the lamp to the last one.
    farthest: f32,
    ray: LampRay,
}

/// Adds how much a ray is hidden from every pixel.
pub(super) fn add(heights: &HeightMaps, ray: &LampRay, counts: &mut HiddenCounts) {
    let Aim::To(lamp) = ray.aim else { return };
    for (is_turned, is_up) in [(false, false), (false, true), (true, false), (true, true)] {
        let (map, lamp) = match is_turned {
            false => (&heights.way(false).whole, lamp),
            true => (&heights.way(true).whole, vec3(lamp.y, lamp.x, lamp.z)),
        };
        let farthest = if is_up { lamp.y } else { map.height() as f32 - 1.0 - lamp.y };
        if farthest > UNDER {
            let has_diagonal = !is_turned;
            let quarter = Quarter { heights: map, lamp, is_up, has_diagonal, farthest, ray: *ray };
            quarter.add(counts.of(is_turned));
        }
    }
}

impl Quarter<'_> {
    /// Lines are a pixel apart in the last row; line 0 is the diagonal to the left.
    fn add(&self, counts: &mut Plane<u16>) {
        let most = (2.0 * self.farthest) as i64 + 3;
        for line in (-1..most).step_by(BETWEEN) {
            self.add_strip(line, counts);
        }
    }

    /// The slope of a line: px along x for each row away from the lamp.
    fn slope(&self, line: f32) -> f32 {
        line / self.farthest - 1.0
    }

    fn add_strip(&self, line: i64, counts: &mut Plane<u16>) {
        let (width, height) = (self.heights.width(), self.heights.height());
        let slopes: [f32; LANES] = std::array::from_fn(|i| self.slope((line + i as i64) as f32));
        let lengths = slopes.map(|slope| (1.0 + slope * slope).sqrt());
        let mut kept =
            SlidingHighest::of(rows_of(0.5 * self.ray.reach_px / lengths[LANES / 2], height));
        let first = if self.is_up { (height as f32 - 1.0).min(self.lamp.y) } else { self.lamp.y };
        let mut turn = 0;
        let mut y = if self.is_up { first.floor() as i64 } else { first.ceil().max(0.0) as i64 };
        let step = if self.is_up { -1 } else { 1 };
        while (0..height as i64).contains(&y) {
            let away = (y as f32 - self.lamp.y).abs();
            let ends = [0, LANES - 1].map(|i| self.lamp.x + slopes[i] * away);
            if away > UNDER && ends[1] >= -1.0 && ends[0] <= width as f32 {
                let row = self.heights.row(y as usize);
                self.add_row(
                    (line, away, turn),
                    &slopes,
                    &lengths,
                    kept.highest(),
                    row,
                    counts.row_mut(y as usize),
                );
                kept.take(&self.heights_of(&slopes, away, row), turn);
                turn += 1;
            } else if turn > 0 {
                // Lines spread out and do not come back.
                break;
            }
            y += step;
        }
    }

    /// (h − H)/ρ of every line.
    fn heights_of(&self, slopes: &[f32; LANES], away: f32, row: &[f32]) -> [f32; LANES] {
        slopes.map(|slope| {
            let x = self.lamp.x + slope * away;
            let (x0, at) = (x.floor(), |x: i64| {
                usize::try_from(x).ok().and_then(|x| row.get(x)).copied().unwrap_or(0.0)
            });
            let (left, right) = (at(x0 as i64), at(x0 as i64 + 1));
            (left + (right - left) * (x - x0) - self.lamp.z) / away
        })
    }

    /// `at`: the first line, rows from the lamp, and rows since the strip's first one.
    fn add_row(
        &self,
        (line, away, turn): (i64, f32, usize),
        slopes: &[f32; LANES],
        lengths: &[f32; LANES],
        highest: [&Highest; 2],
        row: &[f32],
        counts: &mut [u16],
    ) {
        let from = (self.lamp.x + slopes[0] * away).ceil().max(0.0) as usize;
        let to = (self.lamp.x + slopes[BETWEEN] * away).ceil().clamp(0.0, row.len() as f32);
        for x in from..to as usize {
            let aside = x as f32 - self.lamp.x;
            let is_inside = aside.abs() < away || (self.has_diagonal && aside.abs() == away);
            let along = (aside / away + 1.0) * self.farthest - line as f32;
            if !is_inside || !(0.0..BETWEEN as f32).contains(&along) {
                continue;
            }
            let (left, between) = (along as usize, along.fract());
            let own = (row[x] - self.lamp.z) / away;
            let of_line = |i: usize| {
                let rise = fast::max(-own / lengths[i], RISE.0);
                let [near, far] = highest.map(|highest| {
                    if highest.height[i] <= NOTHING {
                        return (0.0, 0.0);
                    }
                    let above = (highest.height[i] - own) * away;
                    let distance = (turn as f32 - highest.row[i]) * lengths[i];
                    (hidden_share(above, distance, rise, self.ray.spread), distance)
                });
                fast::max(near.0, far.0 * fade(far.1, 0.5 * self.ray.reach_px, self.ray.reach_px))
            };
            let (a, b) = (of_line(left), of_line(left + 1));
            counts[x] += fast::whole((a + (b - a) * between) * WHOLE) as u16;
        }
    }
}

/// Whole rows of a window, in a map of so many.
fn rows_of(window: f32, height: usize) -> usize {
    (window.max(1.0) as usize).clamp(1, height.max(1))
}

/// What strips keep of their rows: the greatest of those that a row looks back at, however many
/// these are.
struct SlidingHighest {
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
    fn of(reach: usize) -> Self {
        Self {
            block: vec![[NOTHING; LANES]; reach],
            since: Highest::NONE,
            in_block: 0,
            before: vec![Highest::NONE; reach],
            last: vec![Highest::NONE; reach],
            near: Highest::NONE,
        }
    }

    /// The highest of the rows that the next one looks back at, and of as many before these.
    #[inline(always)]
    fn highest(&mut self) -> [&Highest; 2] {
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
    fn take(&mut self, heights: &LineValues, turn: usize) {
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
struct Highest {
    height: LineValues,
    row: LineValues,
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
