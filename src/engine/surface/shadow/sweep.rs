//! One direction of rays over a whole map, line after line along the rays: every pixel looks at all
//! that stands between it and the lamp, and costs the same however far that is. Floor 2. The
//! equation is in `super`.
//!
//! A ray that goes farther along y than along x meets every row, so the lines of a strip are read
//! side by side, row by row from the lamp's side on, each between the two pixels that it passes. A
//! line's height above the ray is h + rise · distance from the lamp's side: what stands highest
//! above a pixel's ray is the greatest of these within reach, a sliding maximum (`sliding`). Rays
//! that go farther along x sweep the turned map.

use super::counts::WHOLE;
use super::sliding::{Keys, LANES, LIMIT, MOST_ROWS, ROW_BITS, SlidingKeys, higher, key};
use super::{fade, hidden, width_at};
use crate::math::{Vec2, fast, simd::prefetch};
use crate::raster::Plane;

/// Pixels between the lines of a strip in a row that are looked at, a group at a time.
const BETWEEN: usize = 112;
const GROUP: usize = 16;
/// Steps of height a px, at most.
const STEPS_PER_PX: f32 = 64.0;
/// Rows that are fetched ahead: each lies pages away from the one before.
const AHEAD: usize = 3;

/// What rays meet between two distances.
pub(super) struct Sweep<'a> {
    pub heights: &'a Plane<f32>,
    /// The highest of them, px.
    pub highest: f32,
    /// The side of the map's pixels, px.
    pub px: f32,
    /// Way in the map, unit; px of rise for each px, and half-width, as those of a ray.
    pub way: Vec2,
    pub rise: f32,
    pub spread: f32,
    pub from_px: f32,
    pub to_px: f32,
    /// Whether what is beyond half of `to_px` fades out. Then near, low things hide as well as far,
    /// high ones.
    pub is_fading: bool,
}

/// Lines of one direction over a map.
struct ParallelLines<'a> {
    heights: &'a Plane<f32>,
    /// Rows are counted from the lamp's side: from the last one up.
    is_reversed: bool,
    /// From row to row away from the lamp, pixels along it.
    slope: f32,
    /// px along a line from row to row.
    length: f32,
    rise: f32,
    spread: f32,
    /// Rows next to a pixel that it does not look at, and those up to where what is met fades.
    skipped: usize,
    unfaded: usize,
    /// Where what is met begins to fade, and where it is gone, px.
    fading_px: (f32, f32),
    steps_per_px: f32,
    /// What stands lower than this above a ray hides nothing of it, as a key.
    least_above: i32,
}

/// What is kept from row to row of a strip.
struct Kept {
    near: SlidingKeys,
    /// Where it fades, if that is looked at.
    far: Option<SlidingKeys>,
    /// The rows that are not looked at yet.
    waiting: Vec<Keys>,
}

impl Sweep<'_> {
    /// Adds how much a ray is hidden from every pixel.
    pub fn add(&self, counts: &mut Plane<u16>) {
        let (lines, all) = self.lines();
        let is_far = all > lines.unfaded;
        let waiting = if is_far { lines.unfaded } else { lines.skipped };
        let mut kept = Kept {
            near: SlidingKeys::of(lines.unfaded - lines.skipped),
            far: is_far.then(|| SlidingKeys::of(all - lines.unfaded)),
            waiting: vec![[0; LANES]; waiting.max(1)],
        };
        let (width, height) = (self.heights.width() as f32, self.heights.height() as f32);
        // The lines of the first and of the last row.
        let end = lines.slope * height;
        let first = ((-end).min(0.0) - 2.0).floor() as i64;
        let last = ((-end).max(0.0) + width + 2.0) as i64;
        for line in (first..last).step_by(BETWEEN) {
            match is_far {
                true => add_far_strip(&lines, line, &mut kept, counts),
                false => add_near_strip(&lines, line, &mut kept, counts),
            }
        }
    }

    /// And how many rows there are up to the last one that is looked at.
    fn lines(&self) -> (ParallelLines<'_>, usize) {
        let length = self.px / self.way.y.abs().max(1e-3);
        let skipped = ((self.from_px / length) as usize).min(MOST_ROWS / 2);
        // Nothing is higher than the highest.
        let needed = (self.highest + 8.0) / (self.rise * length) + 1.0;
        let most = (MOST_ROWS - 1).min(self.heights.height() + skipped).max(skipped + 1);
        let rows_to = |px: f32| (fast::min(px / length, needed) as usize).clamp(skipped + 1, most);
        let all = rows_to(self.to_px);
        let unfaded = if self.is_fading { rows_to(0.5 * self.to_px) } else { all };
        let top = self.highest + self.heights.height() as f32 * self.rise * length;
        let steps_per_px = fast::min(STEPS_PER_PX, ((LIMIT >> (ROW_BITS + 1)) - 2) as f32 / top);
        let least = -0.5 * width_at(self.to_px + length, self.rise, self.spread);
        let lines = ParallelLines {
            heights: self.heights,
            is_reversed: self.way.y > 0.0,
            slope: -self.way.x / self.way.y.abs().max(1e-3),
            length,
            rise: self.rise,
            spread: self.spread,
            skipped,
            unfaded,
            fading_px: (0.5 * self.to_px, self.to_px),
            steps_per_px,
            least_above: key(fast::max(least * steps_per_px, -1e5) as i32 - 1, 0),
        };
        (lines, all)
    }
}

/// A row of a strip.
struct StripRow<'a> {
    /// Its number, from the strip's first one on.
    turn: usize,
    /// The heights of its pixels, px.
    h: &'a [f32; LANES + 1],
    /// What its distance from the first row adds to a height, steps.
    gain: i32,
    /// How far each line lies to the right of the pixel before it.
    between: f32,
    /// The column of the pixel between the first two lines.
    x0: i64,
}

impl ParallelLines<'_> {
    /// The rows of a strip that lie in the picture.
    fn rows_inside(&self, line: i64) -> std::ops::Range<usize> {
        let (width, height) = (self.heights.width() as f32, self.heights.height());
        let inside = |r: usize| {
            let x = line as f32 + self.slope * r as f32;
            x > -(LANES as f32) - 1.0 && x < width + 1.0
        };
        let Some(first) = (0..height).find(|r| inside(*r)) else { return 0..0 };
        let last = (first..height).rfind(|r| inside(*r)).unwrap_or(first);
        first..last + 1
    }

    /// The number of a row, counted from the lamp's side, in the map.
    #[inline(always)]
    fn row(&self, r: usize) -> usize {
        if self.is_reversed { self.heights.height() - 1 - r } else { r }
    }

    #[inline(always)]
    fn prefetch(&self, x0: i64, r: usize, counts: &Plane<u16>) {
        let (width, height) = (self.heights.width(), self.heights.height());
        if r < height {
            let first = (x0.max(0) as usize).min(width);
            let columns = first..(first + LANES).min(width);
            prefetch(&self.heights.row(self.row(r))[columns.clone()]);
            prefetch(&counts.row(self.row(r))[columns]);
        }
    }

    #[inline(always)]
    fn steps(&self, px: f32) -> i32 {
        fast::whole(px * self.steps_per_px)
    }

    /// `FAR`: looks at a second window, which fades.
    #[inline(always)]
    fn add_strip<const FAR: bool>(&self, line: i64, kept: &mut Kept, counts: &mut Plane<u16>) {
        let width = self.heights.width() as i64;
        kept.near.leave();
        kept.far.iter_mut().for_each(SlidingKeys::leave);
        for (turn, r) in self.rows_inside(line).enumerate() {
            let x = line as f32 + self.slope * r as f32;
            let (x0, between) = (x.floor() as i64, x - x.floor());
            let (y, mut edge) = (self.row(r), [0.0; LANES + 1]);
            let row = self.heights.row(y);
            self.prefetch(x0, r + AHEAD, counts);
            let inside = usize::try_from(x0).ok().and_then(|x| row.get(x..)?.first_chunk());
            let h = inside.unwrap_or_else(|| {
                for (x, h) in (x0..).zip(&mut edge) {
                    *h = if (0..width).contains(&x) { row[x as usize] } else { 0.0 };
                }
                &edge
            });
            let gain = self.steps(turn as f32 * self.rise * self.length);
            let strip_row = StripRow { turn, h, gain, between, x0: x0 + 1 };
            if turn > self.skipped {
                let near = kept.near.highest();
                let far = if FAR { kept.far.as_mut().map(SlidingKeys::highest) } else { None };
                self.add_row::<FAR>(&strip_row, [near, far.unwrap_or(near)], counts.row_mut(y));
            }
            self.keep(&strip_row, kept);
        }
    }

    /// Takes the heights on the lines of a row, once it is to be looked at.
    #[inline(always)]
    fn keep(&self, row: &StripRow, kept: &mut Kept) {
        let mut keys = [0; LANES];
        for (key_of, pair) in keys.iter_mut().zip(row.h.windows(2)) {
            let h = pair[0] + row.between * (pair[1] - pair[0]);
            *key_of = key(self.steps(h) + row.gain, row.turn);
        }
        let waiting = kept.waiting.len();
        if self.skipped == 0 {
            kept.near.take(&keys);
        } else if row.turn >= self.skipped {
            kept.near.take(&kept.waiting[(row.turn - self.skipped) % waiting]);
        }
        let place = &mut kept.waiting[row.turn % waiting];
        if let (true, Some(far)) = (row.turn >= self.unfaded, &mut kept.far) {
            far.take(place);
        }
        *place = keys;
    }

    /// Adds how much the ray is hidden from the pixels of a row.
    #[inline(always)]
    fn add_row<const FAR: bool>(
        &self,
        row: &StripRow,
        [near, far]: [&Keys; 2],
        counts: &mut [u16],
    ) {
        for first in (0..BETWEEN).step_by(GROUP) {
            let (mut own, mut above) = ([0; GROUP], 0);
            for (own, h) in own.iter_mut().zip(&row.h[first + 1..]) {
                *own = key(self.steps(*h) + row.gain, 0);
            }
            for (i, own) in own.iter().enumerate() {
                let at = first + i;
                let mut highest = higher(near[at], near[at + 1]);
                if FAR {
                    highest = higher(highest, higher(far[at], far[at + 1]));
                }
                above |= i32::from(highest.wrapping_sub(*own) > self.least_above);
            }
            // Most pixels lie in the light.
            if above == 0 {
                continue;
            }
            let mut shares = [[0.0; GROUP]; 2];
            let (from, to) = self.fading_px;
            for (side, shares) in shares.iter_mut().enumerate() {
                let at = first + side;
                for i in 0..GROUP {
                    shares[i] = self.hidden(near[at + i], own[i], row.turn).0;
                }
                if FAR {
                    for i in 0..GROUP {
                        let (hidden, distance) = self.hidden(far[at + i], own[i], row.turn);
                        shares[i] = fast::max(shares[i], hidden * fade(distance, from, to));
                    }
                }
            }
            // The pixel lies 1 − between right of its left line.
            let ([left, right], mut added) = (&shares, [0; GROUP]);
            for i in 0..GROUP {
                let share = right[i] + (left[i] - right[i]) * row.between;
                added[i] = fast::whole(share * WHOLE) as u16;
            }
            add_counts(&added, row.x0 + first as i64, counts);
        }
    }

    /// How much of a pixel's ray what stands highest hides, and how far away that is.
    #[inline(always)]
    fn hidden(&self, highest: i32, own: i32, turn: usize) -> (f32, f32) {
        let above = (highest.wrapping_sub(own) >> ROW_BITS) as f32 / self.steps_per_px;
        let rows = (turn as i32).wrapping_sub(highest) & MOST_ROWS as i32;
        let distance = rows as f32 * self.length;
        (hidden(above, distance, self.rise, self.spread), distance)
    }
}

/// Adds counts to those from column `x` on that lie in the picture.
#[inline(always)]
fn add_counts(added: &[u16; GROUP], x: i64, counts: &mut [u16]) {
    let inside = usize::try_from(x).ok().and_then(|x| counts.get_mut(x..)?.first_chunk_mut());
    if let Some(sums) = inside {
        let sums: &mut [u16; GROUP] = sums;
        for i in 0..GROUP {
            sums[i] += added[i];
        }
        return;
    }
    for (x, added) in (x..).zip(added) {
        let sum = usize::try_from(x).ok().and_then(|x| counts.get_mut(x));
        sum.into_iter().for_each(|sum| *sum += added);
    }
}

crate::widest! {
    /// Adds how much the ray is hidden from the pixels between the lines of a strip.
    fn add_near_strip(lines: &ParallelLines, line: i64, kept: &mut Kept, counts: &mut Plane<u16>) {
        lines.add_strip::<false>(line, kept, counts);
    }

    /// The same with a second window, which fades.
    fn add_far_strip(lines: &ParallelLines, line: i64, kept: &mut Kept, counts: &mut Plane<u16>) {
        lines.add_strip::<true>(line, kept, counts);
    }
}
