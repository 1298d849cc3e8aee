//! The round tip over rows of pixels. Pixels are sorted into zones, and each zone is computed no more precisely than it
//! needs. Floor 3. The profile is in `profile`, D in `surface`.

use super::SpanNeighbours;
use crate::math::Vec2;
use crate::paint::dab_walker::Dab;
use crate::paint::profile::RoundProfile;
use crate::paint::rim::Rim;
use crate::paint::stroke_tile::raise;
use crate::raster::TILE;
use crate::surface::links;
use std::ops::Range;

/// Pixels that are judged together. Rows of blocks are whole multiples of them.
const CHUNK: usize = 8;

/// A round dab with everything precomputed that its rows share.
#[derive(Clone, Copy)]
pub(super) struct RoundTip {
    at: Vec2,
    per_radius: f32,
    profile: RoundProfile,
    /// Between which radii coverage falls off, and what bounds half the width of the profile's box.
    falloff: (f32, f32),
    half_width: (f32, f32),
    rim: Rim,
    /// Nothing within this distance is on the stroke's edge.
    inner: f32,
    pub(super) flow: f32,
    thin: f32,
    pub(super) ceiling: f32,
}

/// What a dab is added to: the coverage of a row's pixels, and which share of each was reached.
pub(super) struct RowPaint<'r> {
    pub coverage: &'r mut [f32],
    pub reach: &'r mut [f32],
}

/// What is known of a row's pixels before their coverage.
pub(super) struct RowZones {
    /// Distance from the dab's centre in the image plane, in radii.
    r: [f32; TILE],
    /// |Jᵀ p|², p from the centre to the pixel: the pixel's width toward the centre times r, squared; in radii to the
    /// fourth.
    toward: [f32; TILE],
    /// |J|²: the sum of both squared widths of the pixel, in radii.
    wide: [f32; TILE],
    zones: [u32; TILE],
}

/// The zone that holds a pixel's box wholly, as bits; none where the box lies in several zones or is not a number.
const BEYOND: u32 = 1;
const WITHIN: u32 = 2;
const FALLOFF: u32 = 4;

/// Sum of the squares of a pixel's widths, in radii, below which its second dimension does not show in the falloff.
const NARROW_SQUARED: f32 = 2.0 / (12.0 * 12.0);

/// Added to squared distances, px²: the centre itself has no direction toward it.
const AT_CENTER: f32 = 1e-12;

impl Default for RowZones {
    fn default() -> Self {
        Self { r: [0.0; TILE], toward: [0.0; TILE], wide: [0.0; TILE], zones: [0; TILE] }
    }
}

impl RoundTip {
    pub(super) fn new(dab: &Dab) -> Self {
        let profile = RoundProfile::new(dab.hardness, dab.softness);
        let per_radius = 1.0 / dab.radius;
        Self {
            at: dab.at,
            per_radius,
            profile,
            falloff: profile.falloff(),
            half_width: profile.half_width_bound(per_radius),
            rim: dab.rim,
            inner: dab.rim.inner(per_radius),
            flow: dab.flow,
            thin: dab.thin,
            ceiling: dab.ceiling,
        }
    }
    /// The same footprint, of which coverage itself is asked.
    pub(super) fn plain(dab: &Dab) -> Self {
        Self { flow: 1.0, ceiling: 1.0, ..Self::new(dab) }
    }
    /// Of a row of `n` pixels from the pixel at (x, y) on, the chunks that an unbent dab may reach: all others lie
    /// beyond it as [`RoundTip::zone`] tells. Small dabs touch few rows of their blocks.
    pub(super) fn flat_chunks(&self, x: i32, y: i32, n: usize) -> Range<usize> {
        // Distances are rounded.
        const ROUNDING: (f32, f32) = (1.0005, 0.05);
        let half = self.half_width.0 + self.half_width.1 * self.per_radius * self.per_radius;
        let limit = (self.falloff.1 + half) / self.per_radius * ROUNDING.0 + ROUNDING.1;
        let dy = y as f32 + 0.5 - self.at.y;
        if dy.abs() > limit {
            return 0..0;
        }
        let chord = (limit * limit - dy * dy).sqrt();
        let middle = self.at.x - (x as f32 + 0.5);
        // What is no number is the whole row.
        let place = |v: f32, otherwise: usize| if v.is_nan() { otherwise } else { (v.max(0.0) as usize).min(n) };
        let (first, last) = (place((middle - chord).floor(), 0), place((middle + chord).ceil() + 1.0, n));
        first / CHUNK * CHUNK..last.next_multiple_of(CHUNK).min(n)
    }
    /// The zone of a pixel at distance r whose width's square is at most `widest`, both in radii.
    #[inline(always)]
    fn zone(&self, r: f32, widest: f32) -> u32 {
        let (start, end) = self.falloff;
        let half = self.half_width.0 + self.half_width.1 * widest;
        let (inner, outer) = (r - half, r + half);
        let end = if end < self.inner { end } else { self.inner };
        // The profile's even continuation through the centre is no part of the falloff.
        let first = if start > 0.0 { start } else { 0.0 };
        let beyond = if inner > self.falloff.1 { BEYOND } else { 0 };
        let within = if outer < start { WITHIN } else { 0 };
        // There a pixel counts as narrow across the radius: of a wider one that is more than a third of a byte.
        let is_narrow = widest < NARROW_SQUARED;
        let falls = if (inner > first) & (outer < end) & is_narrow { FALLOFF } else { 0 };
        // What is thinner than a pixel reaches a part of it wherever it lies.
        if self.thin < 1.0 { beyond } else { beyond | within | falls }
    }
    /// A pixel at p from the centre, J's columns `across` and `along`; canvas px. Gives r, |Jᵀ p|², |J|² and the zone.
    #[inline(always)]
    fn judge(&self, p: (f32, f32), across: (f32, f32), along: (f32, f32)) -> (f32, f32, f32, u32) {
        let square = self.per_radius * self.per_radius;
        let r = (p.0 * p.0 + p.1 * p.1 + AT_CENTER).sqrt() * self.per_radius;
        let (a, b) = (across.0 * p.0 + across.1 * p.1, along.0 * p.0 + along.1 * p.1);
        // J's norm bounds the width in any direction.
        let across = across.0 * across.0 + across.1 * across.1;
        let widest = (across + (along.0 * along.0 + along.1 * along.1)) * square;
        (r, (a * a + b * b) * square * square, widest, self.zone(r, widest))
    }
    /// a ← a + f (c − a), f = flow · F, up to the ceiling c, where the dab reaches whole pixels.
    #[inline(always)]
    fn raise(&self, coverage: &mut f32, mean: f32) {
        let f = self.flow * mean;
        // Comparisons turn NaN into nothing, and rounding must not leave the range.
        let f = if f > 0.0 { f } else { 0.0 };
        let f = if f < 1.0 { f } else { 1.0 };
        let room = self.ceiling - *coverage;
        *coverage += f * if room > 0.0 { room } else { 0.0 };
    }
    /// On the rim: [`raise`] of the share that the stroke may reach. The squares are the pixel's widths along the
    /// radius and across it.
    #[inline(always)]
    fn raise_share(&self, coverage: &mut f32, reach: &mut f32, r: f32, width_squared: f32, across_squared: f32) {
        let mean = self.profile.mean_over(r, width_squared, across_squared);
        let share = self.rim.share(r, width_squared.sqrt());
        // Comparisons turn NaN into nothing.
        let mean = if mean > 0.0 { mean } else { 0.0 };
        let covered = if mean < share { mean } else { share };
        raise(coverage, reach, self.flow * self.thin * covered, self.thin * share, self.ceiling);
    }
    /// Adds to a judged row, chunks of one zone at a time: only where a pixel's box lies across a zone's border does
    /// its mean take a root and a division more, beyond the rim it takes nothing.
    #[inline(always)]
    fn add(&self, row: &RowZones, paint: RowPaint) {
        let RowPaint { coverage, reach } = paint;
        let n = coverage.len().min(reach.len()).min(TILE);
        let mut start = 0;
        while start < n {
            let zone = zone_of(&row.zones, start, n);
            let mut end = start + CHUNK;
            while end < n && zone_of(&row.zones, end, n) == zone {
                end += CHUNK;
            }
            let end = end.min(n);
            let (r, toward, wide) = (&row.r[start..end], &row.toward[start..end], &row.wide[start..end]);
            let (part, reached) = (&mut coverage[start..end], &mut reach[start..end]);
            match zone {
                BEYOND => {}
                WITHIN => add_within(*self, part),
                FALLOFF => add_falloff(*self, r, toward, part),
                _ => add_rim(*self, (r, toward, wide), part, reached),
            }
            if zone & (WITHIN | FALLOFF) != 0 {
                reached.fill(1.0);
            }
            start = end;
        }
    }
}

#[inline(always)]
fn add_within(tip: RoundTip, coverage: &mut [f32]) {
    for a in coverage {
        tip.raise(a, 1.0);
    }
}

#[inline(always)]
fn add_falloff(tip: RoundTip, r: &[f32], toward: &[f32], coverage: &mut [f32]) {
    for ((a, r), toward) in coverage.iter_mut().zip(r).zip(toward) {
        tip.raise(a, tip.profile.mean_in_falloff(*r, toward / (r * r)));
    }
}

#[inline(always)]
fn add_rim(tip: RoundTip, (r, toward, wide): (&[f32], &[f32], &[f32]), coverage: &mut [f32], reach: &mut [f32]) {
    for ((((a, m), r), toward), wide) in coverage.iter_mut().zip(reach).zip(r).zip(toward).zip(wide) {
        let width_squared = toward / (r * r);
        tip.raise_share(a, m, *r, width_squared, wide - width_squared);
    }
}

/// The zone that a chunk's pixels share.
#[inline(always)]
fn zone_of(zones: &[u32; TILE], start: usize, end: usize) -> u32 {
    match zones[start..].first_chunk::<CHUNK>() {
        Some(chunk) if start + CHUNK <= end => chunk.iter().fold(u32::MAX, |all, zone| all & zone),
        _ => zones[start..end].iter().fold(u32::MAX, |all, zone| all & zone),
    }
}

/// A pixel all of whose neighbours continue its surface.
const INSIDE: u8 = links::LEFT | links::RIGHT | links::UP | links::DOWN;

crate::widest! {
    /// Where D is the identity; (x, y) is the centre of the first pixel.
    pub(super) fn flat_row(x: f32, y: f32, tip: &RoundTip, row: &mut RowZones, paint: RowPaint) {
        let n = paint.coverage.len().min(TILE);
        let dy = y - tip.at.y;
        let pixel = tip.per_radius * tip.per_radius;
        let (r, toward, zones) = (&mut row.r[..n], &mut row.toward[..n], &mut row.zones[..n]);
        row.wide[..n].fill(2.0 * pixel);
        for i in 0..n {
            // Through i32: AVX2 converts no 64-bit integers.
            let dx = x + i as i32 as f32 - tip.at.x;
            let r_squared = (dx * dx + dy * dy + AT_CENTER) * pixel;
            (r[i], toward[i]) = (r_squared.sqrt(), pixel * r_squared);
            zones[i] = tip.zone(r[i], pixel);
        }
        tip.add(row, paint);
    }
    /// Bent: J by differences within each pixel's piece of surface.
    pub(super) fn bent_row(d: SpanNeighbours, tip: &RoundTip, row: &mut RowZones, paint: RowPaint) {
        let n = paint.coverage.len().min(TILE);
        if are_inside(&d.linked[..n]) {
            judge_inside(d, n, tip, row);
        } else {
            judge_rim(d, n, tip, row);
        }
        tip.add(row, paint);
    }
}

/// Eight pixels a word: rows are short.
#[inline(always)]
fn are_inside(linked: &[u8]) -> bool {
    let (words, rest) = linked.as_chunks::<8>();
    let all = words.iter().fold(u64::MAX, |all, word| all & u64::from_ne_bytes(*word));
    let inside = u64::from_ne_bytes([INSIDE; 8]);
    all & inside == inside && rest.iter().all(|bits| bits & INSIDE == INSIDE)
}

/// Within one piece of surface: J by central differences.
#[inline(always)]
fn judge_inside(d: SpanNeighbours, n: usize, tip: &RoundTip, row: &mut RowZones) {
    let (cx, cy) = (&d.row.0[..n + 2], &d.row.1[..n + 2]);
    let (ax, ay) = (&d.above.0[..n + 2], &d.above.1[..n + 2]);
    let (bx, by) = (&d.below.0[..n + 2], &d.below.1[..n + 2]);
    let (r, toward) = (&mut row.r[..n], &mut row.toward[..n]);
    let (wide, zones) = (&mut row.wide[..n], &mut row.zones[..n]);
    for i in 0..n {
        let p = (cx[i + 1] - tip.at.x, cy[i + 1] - tip.at.y);
        let across = (0.5 * (cx[i + 2] - cx[i]), 0.5 * (cy[i + 2] - cy[i]));
        let along = (0.5 * (bx[i + 1] - ax[i + 1]), 0.5 * (by[i + 1] - ay[i + 1]));
        (r[i], toward[i], wide[i], zones[i]) = tip.judge(p, across, along);
    }
}

/// Along a silhouette, a depth jump or outside: J from linked neighbours only.
#[inline(always)]
fn judge_rim(d: SpanNeighbours, n: usize, tip: &RoundTip, row: &mut RowZones) {
    let (cx, cy) = (&d.row.0[..n + 2], &d.row.1[..n + 2]);
    let (ax, ay) = (&d.above.0[..n + 2], &d.above.1[..n + 2]);
    let (bx, by) = (&d.below.0[..n + 2], &d.below.1[..n + 2]);
    let linked = &d.linked[..n];
    let (r, toward) = (&mut row.r[..n], &mut row.toward[..n]);
    let (wide, zones) = (&mut row.wide[..n], &mut row.zones[..n]);
    for i in 0..n {
        let (x, y) = (cx[i + 1], cy[i + 1]);
        let has = |bit: u8| linked[i] & bit != 0;
        let (left, right, up, down) = (has(links::LEFT), has(links::RIGHT), has(links::UP), has(links::DOWN));
        let across = (slope(left, right, cx[i], x, cx[i + 2], 1.0), slope(left, right, cy[i], y, cy[i + 2], 0.0));
        let along = (slope(up, down, ax[i + 1], x, bx[i + 1], 0.0), slope(up, down, ay[i + 1], y, by[i + 1], 1.0));
        (r[i], toward[i], wide[i], zones[i]) = tip.judge((x - tip.at.x, y - tip.at.y), across, along);
    }
}

/// The derivative at `here` from those of its two neighbours that are linked; `flat`, the identity's, without any.
#[inline(always)]
pub fn slope(has_before: bool, has_after: bool, before: f32, here: f32, after: f32, flat: f32) -> f32 {
    let low = if has_before { before } else { here };
    let high = if has_after { after } else { here };
    let mean = if has_before & has_after { 0.5 * (high - low) } else { high - low };
    if has_before | has_after { mean } else { flat }
}
