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
use super::heights::BlockSlopes;
use super::sliding::{Keys, LANES, LIMIT, MOST_ROWS, ROW_BITS, SlidingKeys, higher, key};
use super::{BUMP_REACH_PX, fade, hidden_share, width_at};
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
    px_per_step: f32,
    /// What stands lower than this above a ray hides nothing of it, as a key.
    least_above: i32,
}

/// Counts of the near part of a few rows, a byte each, and where there are any.
pub(super) struct NearBand {
    rows: std::ops::Range<usize>,
    width: usize,
    values: Vec<u8>,
    /// Of each row, the chunks of `CHUNK` pixels that are not all 0.
    taken: Vec<bool>,
}

impl NearBand {
    /// What a ray counts where it is hidden wholly.
    pub const WHOLE: f32 = 250.0;
    pub const CHUNK: usize = 64;

    pub fn new(width: usize) -> Self {
        Self { rows: 0..0, width, values: Vec::new(), taken: Vec::new() }
    }

    fn chunks(&self) -> usize {
        self.width.div_ceil(Self::CHUNK)
    }

    /// Empties it for other rows.
    pub fn clear(&mut self, rows: std::ops::Range<usize>) {
        let chunks = self.chunks();
        for (values, taken) in
            self.values.chunks_mut(self.width.max(1)).zip(self.taken.chunks(chunks.max(1)))
        {
            for (values, taken) in values.chunks_mut(Self::CHUNK).zip(taken) {
                if *taken {
                    values.fill(0);
                }
            }
        }
        self.values.resize(rows.len() * self.width, 0);
        self.taken.clear();
        self.taken.resize(rows.len() * chunks, false);
        self.rows = rows;
    }

    /// A chunk of a row, if there is anything in it.
    #[inline(always)]
    pub fn chunk(&self, y: usize, chunk: usize) -> Option<&[u8]> {
        let row = y.checked_sub(self.rows.start)?;
        let first = chunk * Self::CHUNK;
        let taken = *self.taken.get(row * self.chunks() + chunk)?;
        taken.then(|| {
            &self.values
                [row * self.width + first..row * self.width + (first + Self::CHUNK).min(self.width)]
        })
    }
}

/// Where what is hidden is put.
trait Counts {
    /// Adds shares to those of row `y` from column `x` on that lie in the picture.
    fn add(&mut self, y: usize, x: i64, shares: &[f32; GROUP]);

    fn prefetch(&self, y: usize, columns: std::ops::Range<usize>);
}

impl Counts for Plane<u16> {
    #[inline(always)]
    fn add(&mut self, y: usize, x: i64, shares: &[f32; GROUP]) {
        let mut added = [0; GROUP];
        for i in 0..GROUP {
            added[i] = fast::whole(shares[i] * WHOLE) as u16;
        }
        add_counts(&added, x, self.row_mut(y));
    }

    #[inline(always)]
    fn prefetch(&self, y: usize, columns: std::ops::Range<usize>) {
        prefetch(&self.row(y)[columns]);
    }
}

impl Counts for NearBand {
    #[inline(always)]
    fn add(&mut self, y: usize, x: i64, shares: &[f32; GROUP]) {
        let (chunks, row) = (self.chunks(), y - self.rows.start);
        let mut added = [0; GROUP];
        for i in 0..GROUP {
            added[i] = fast::whole(shares[i] * Self::WHOLE) as u8;
        }
        let values = &mut self.values[row * self.width..(row + 1) * self.width];
        let taken = &mut self.taken[row * chunks..(row + 1) * chunks];
        for x in [x, x + GROUP as i64 - 1] {
            let chunk = usize::try_from(x).ok().and_then(|x| taken.get_mut(x / Self::CHUNK));
            chunk.into_iter().for_each(|taken| *taken = true);
        }
        let inside = usize::try_from(x).ok().and_then(|x| values.get_mut(x..)?.first_chunk_mut());
        if let Some(sums) = inside {
            let sums: &mut [u8; GROUP] = sums;
            *sums = added;
            return;
        }
        for (x, added) in (x..).zip(added) {
            let sum = usize::try_from(x).ok().and_then(|x| values.get_mut(x));
            sum.into_iter().for_each(|sum| *sum = added);
        }
    }

    #[inline(always)]
    fn prefetch(&self, _: usize, _: std::ops::Range<usize>) {}
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
        let (lines, all) = self.lines(self.heights.height());
        let is_far = all > lines.unfaded;
        let mut kept = Kept::of(&lines, all);
        for line in self.strips(&lines, 0..self.heights.height()) {
            let rows = lines.rows_inside(line, 0..self.heights.height());
            let run = StripRun { line, first: rows.start, rows };
            match is_far {
                true => add_far_strip(&lines, &run, &mut kept, counts),
                false => add_whole_strip(&lines, &run, &mut kept, counts),
            }
        }
    }

    /// The same for the rows of a band, where `rising` blocks say that there may be anything.
    pub fn add_near(&self, rising: &Plane<bool>, band: &mut NearBand) {
        let height = self.heights.height();
        let rows = match self.way.y > 0.0 {
            true => height - band.rows.end..height - band.rows.start,
            false => band.rows.clone(),
        };
        let (lines, reach) = self.lines(rows.len());
        let mut kept = Kept::of(&lines, reach);
        for line in self.strips(&lines, rows.clone()) {
            let mut inside = lines.rows_inside(line, rows.clone());
            while let Some(first) = inside.find(|r| lines.is_rising(line, *r, rising)) {
                // A few rows without anything are sooner passed over than begun again.
                let mut end = first + 1;
                for r in inside.clone() {
                    if r >= end + reach {
                        break;
                    }
                    if lines.is_rising(line, r, rising) {
                        end = r + 1;
                    }
                }
                inside.start = end;
                let run = StripRun { line, first, rows: first.saturating_sub(reach)..end };
                add_near_strip(&lines, &run, &mut kept, band);
            }
        }
    }

    /// What rises less steeply on all of the way hides nothing, px a px.
    pub fn least_slope(&self) -> f32 {
        // Of `hidden_share`: what stands above a ray, and half of its width less, exceeds the bias.
        let widened = self.spread * (1.0 + self.rise * self.rise);
        self.rise - widened - 0.5 / BUMP_REACH_PX - 0.01
    }

    /// The first lines of the strips that meet rows.
    fn strips(
        &self,
        lines: &ParallelLines,
        rows: std::ops::Range<usize>,
    ) -> impl Iterator<Item = i64> + use<> {
        // The lines of the first and of the last row.
        let ends = [rows.start, rows.end].map(|r| -lines.slope * r as f32);
        let first = (ends[0].min(ends[1]) - 2.0).floor() as i64;
        let last = (ends[0].max(ends[1]) + self.heights.width() as f32 + 2.0) as i64;
        // Strips of all bands lie alike.
        (first.div_euclid(BETWEEN as i64) * BETWEEN as i64..last).step_by(BETWEEN)
    }

    /// For so many rows; and how many there are up to the last one that is looked at.
    fn lines(&self, rows: usize) -> (ParallelLines<'_>, usize) {
        let length = self.px / self.way.y.abs().max(1e-3);
        let skipped = ((self.from_px / length) as usize).min(MOST_ROWS / 2);
        // Nothing is higher than the highest.
        let needed = (self.highest + 8.0) / (self.rise * length) + 1.0;
        let most = (MOST_ROWS - 1).min(self.heights.height() + skipped).max(skipped + 1);
        let rows_to = |px: f32| (fast::min(px / length, needed) as usize).clamp(skipped + 1, most);
        let all = rows_to(self.to_px);
        let unfaded = if self.is_fading { rows_to(0.5 * self.to_px) } else { all };
        let top = self.highest + (rows + all) as f32 * self.rise * length;
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
            px_per_step: 1.0 / steps_per_px,
            least_above: key(fast::max(least * steps_per_px, -1e5) as i32 - 1, 0),
        };
        (lines, all)
    }
}

impl Kept {
    fn of(lines: &ParallelLines, all: usize) -> Self {
        let is_far = all > lines.unfaded;
        let waiting = if is_far { lines.unfaded } else { lines.skipped };
        Self {
            near: SlidingKeys::of(lines.unfaded - lines.skipped),
            far: is_far.then(|| SlidingKeys::of(all - lines.unfaded)),
            waiting: vec![[0; LANES]; waiting.max(1)],
        }
    }
}

/// Rows of a strip.
struct StripRun {
    line: i64,
    rows: std::ops::Range<usize>,
    /// The first one whose pixels are counted; those before only hide.
    first: usize,
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
    /// Those of some rows where a strip lies in the picture.
    fn rows_inside(&self, line: i64, rows: std::ops::Range<usize>) -> std::ops::Range<usize> {
        let width = self.heights.width() as f32;
        let inside = |r: &usize| {
            let x = line as f32 + self.slope * *r as f32;
            x > -(LANES as f32) - 1.0 && x < width + 1.0
        };
        let Some(first) = rows.clone().find(inside) else { return 0..0 };
        let last = (first..rows.end).rfind(inside).unwrap_or(first);
        first..last + 1
    }

    /// Whether something may stand on the way to the lamp from a strip's pixels of a row.
    fn is_rising(&self, line: i64, r: usize, rising: &Plane<bool>) -> bool {
        let (x0, block) = ((line as f32 + self.slope * r as f32) as i64, BlockSlopes::SIDE as i64);
        let blocks = rising.row(self.row(r) / BlockSlopes::SIDE);
        let at = |x: i64| (x.max(0) / block) as usize;
        let last = (at(x0 + 2 + BETWEEN as i64) + 1).min(blocks.len());
        blocks[at(x0).min(last)..last].contains(&true)
    }

    /// The number of a row, counted from the lamp's side, in the map.
    #[inline(always)]
    fn row(&self, r: usize) -> usize {
        if self.is_reversed { self.heights.height() - 1 - r } else { r }
    }

    #[inline(always)]
    fn prefetch<C: Counts>(&self, x0: i64, r: usize, counts: &C) {
        let (width, height) = (self.heights.width(), self.heights.height());
        if r < height {
            let first = (x0.max(0) as usize).min(width);
            let columns = first..(first + LANES).min(width);
            prefetch(&self.heights.row(self.row(r))[columns.clone()]);
            counts.prefetch(self.row(r), columns);
        }
    }

    #[inline(always)]
    fn steps(&self, px: f32) -> i32 {
        fast::whole(px * self.steps_per_px)
    }

    /// `FAR`: looks at a second window, which fades.
    #[inline(always)]
    fn add_strip<const FAR: bool, C: Counts>(
        &self,
        run: &StripRun,
        kept: &mut Kept,
        counts: &mut C,
    ) {
        let width = self.heights.width() as i64;
        kept.near.leave();
        kept.far.iter_mut().for_each(SlidingKeys::leave);
        for (turn, r) in run.rows.clone().enumerate() {
            let x = run.line as f32 + self.slope * r as f32;
            let (x0, between) = (x.floor() as i64, x - x.floor());
            let (y, mut edge) = (self.row(r), [0.0; LANES + 1]);
            let row = self.heights.row(y);
            if r + AHEAD < run.rows.end {
                self.prefetch(x0, r + AHEAD, counts);
            }
            let inside = usize::try_from(x0).ok().and_then(|x| row.get(x..)?.first_chunk());
            let h = inside.unwrap_or_else(|| {
                for (x, h) in (x0..).zip(&mut edge) {
                    *h = if (0..width).contains(&x) { row[x as usize] } else { 0.0 };
                }
                &edge
            });
            let gain = self.steps(turn as f32 * self.rise * self.length);
            let strip_row = StripRow { turn, h, gain, between, x0: x0 + 1 };
            if turn > self.skipped && r >= run.first {
                let near = kept.near.highest();
                let far = if FAR { kept.far.as_mut().map(SlidingKeys::highest) } else { None };
                self.add_row::<FAR, C>(&strip_row, [near, far.unwrap_or(near)], (y, counts));
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
    fn add_row<const FAR: bool, C: Counts>(
        &self,
        row: &StripRow,
        [near, far]: [&Keys; 2],
        (y, counts): (usize, &mut C),
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
                    shares[i] = self.hidden_share(near[at + i], own[i], row.turn).0;
                }
                if FAR {
                    for i in 0..GROUP {
                        let (hidden, distance) = self.hidden_share(far[at + i], own[i], row.turn);
                        shares[i] = fast::max(shares[i], hidden * fade(distance, from, to));
                    }
                }
            }
            // The pixel lies 1 − between right of its left line.
            let ([left, right], mut between) = (&shares, [0.0; GROUP]);
            for i in 0..GROUP {
                between[i] = right[i] + (left[i] - right[i]) * row.between;
            }
            counts.add(y, row.x0 + first as i64, &between);
        }
    }

    /// How much of a pixel's ray what stands highest hides, and how far away that is.
    #[inline(always)]
    fn hidden_share(&self, highest: i32, own: i32, turn: usize) -> (f32, f32) {
        let above = (highest.wrapping_sub(own) >> ROW_BITS) as f32 * self.px_per_step;
        let rows = (turn as i32).wrapping_sub(highest) & MOST_ROWS as i32;
        let distance = rows as f32 * self.length;
        (hidden_share(above, distance, self.rise, self.spread), distance)
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
    /// Adds how much the near part hides from the pixels between the lines of a strip.
    fn add_near_strip(lines: &ParallelLines, run: &StripRun, kept: &mut Kept, band: &mut NearBand) {
        lines.add_strip::<false, NearBand>(run, kept, band);
    }

    /// The same of a ray that does not fade.
    fn add_whole_strip(lines: &ParallelLines, run: &StripRun, kept: &mut Kept, counts: &mut Plane<u16>) {
        lines.add_strip::<false, Plane<u16>>(run, kept, counts);
    }

    /// The same with a second window, which fades.
    fn add_far_strip(lines: &ParallelLines, run: &StripRun, kept: &mut Kept, counts: &mut Plane<u16>) {
        lines.add_strip::<true, Plane<u16>>(run, kept, counts);
    }
}
