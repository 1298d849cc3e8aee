//! The round tip over rows of pixels. Pixels are sorted into zones, and each zone is computed no
//! more precisely than necessary. Floor 3. The loops over rows are in `rows`, the profile is in
//! `profile`, D in `surface`.

mod rows;

pub use rows::slope;
pub(super) use rows::{BentPart, BlockPixels, fill_bent_row, fill_bent_rows, flat_row, flat_rows};

use crate::math::Vec2;
use crate::paint::dab_walker::Dab;
use crate::paint::profile::RoundProfile;
use crate::paint::rim::Rim;
use crate::paint::stroke_tile::raise;
use crate::raster::TILE;
use std::ops::Range;

/// Pixels that are classified together. Rows of blocks are whole multiples of them.
const CHUNK: usize = 8;

/// A round dab with everything precomputed that its rows share.
#[derive(Clone, Copy)]
pub(super) struct RoundTip {
    at: Vec2,
    per_radius: f32,
    profile: RoundProfile,
    /// The radii between which coverage falls off, and the bound of half the width of the profile's
    /// box.
    falloff: (f32, f32),
    half_width: (f32, f32),
    rim: Rim,
    /// Nothing within this distance is on the stroke's edge.
    inner: f32,
    /// Pixels whose squared widths add up to less, in radii, count whole: the stroke's edge does
    /// not affect them, and the tip fills them.
    soft: f32,
    pub(super) flow: f32,
    thin: f32,
    pub(super) ceiling: f32,
}

/// What a dab is added to: the coverage of a row's pixels, and the share of each that was reached.
pub(super) struct RowPaint<'r> {
    pub coverage: &'r mut [f32],
    pub reach: &'r mut [f32],
}

/// What is known of a row's pixels before their coverage.
pub(super) struct RowZones {
    /// Distance from the dab's center in the image plane, in radii.
    r: [f32; TILE],
    /// |Jᵀ p|², p from the center to the pixel: the pixel's width toward the center times r, squared; in radii to the
    /// fourth.
    toward: [f32; TILE],
    /// |J|²: the sum of both squared widths of the pixel, in radii.
    wide: [f32; TILE],
    zones: [u32; TILE],
    /// The zone by distance alone, before the pixel's widths are known: `BEYOND`, `WITHIN` or
    /// nothing.
    near: [u32; TILE],
}

/// The zone that contains a pixel's box, as bits; none if the box lies in several zones or is NaN.
const BEYOND: u32 = 1;
const WITHIN: u32 = 2;
const FALLOFF: u32 = 4;
/// In addition to the zone: the pixel counts whole.
const SOFT: u32 = 8;

/// Sum of a pixel's squared widths, in radii, below which its second dimension does not matter in
/// the falloff.
const NARROW_SQUARED: f32 = 2.0 / (12.0 * 12.0);

/// Added to squared distances, px²: the center itself has no direction toward it.
const AT_CENTER: f32 = 1e-12;

impl Default for RowZones {
    fn default() -> Self {
        Self {
            r: [0.0; TILE],
            toward: [0.0; TILE],
            wide: [0.0; TILE],
            zones: [0; TILE],
            near: [0; TILE],
        }
    }
}

impl RoundTip {
    pub(super) fn new(dab: &Dab) -> Self {
        let profile = RoundProfile::new(dab.hardness, dab.softness);
        let per_radius = 1.0 / dab.radius;
        // Widths are rounded.
        const SURELY: f32 = 0.999;
        let (edge, chord) = (dab.rim.soft_below(), profile.chord());
        let narrow = SURELY * if edge < chord { edge } else { chord };
        Self {
            at: dab.at,
            per_radius,
            profile,
            falloff: profile.falloff(),
            half_width: profile.half_width_bound(per_radius),
            rim: dab.rim,
            inner: dab.rim.inner(per_radius),
            soft: if dab.thin < 1.0 { 0.0 } else { narrow * narrow },
            flow: dab.flow,
            thin: dab.thin,
            ceiling: dab.ceiling,
        }
    }

    /// The same footprint elsewhere.
    pub(super) fn with_center(self, at: Vec2) -> Self {
        Self { at, ..self }
    }

    /// The same footprint with full flow and ceiling: gives plain coverage.
    pub(super) fn plain(dab: &Dab) -> Self {
        Self { flow: 1.0, ceiling: 1.0, ..Self::new(dab) }
    }

    /// The chunks of a row of `n` pixels from the pixel at (x, y) on that an unbent dab may reach:
    /// all others lie beyond it according to [`RoundTip::zone`]. Small dabs touch few rows of their
    /// blocks.
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
        // NaN gives the whole row.
        let place = |v: f32, otherwise: usize| {
            if v.is_nan() { otherwise } else { (v.max(0.0) as usize).min(n) }
        };
        let (first, last) =
            (place((middle - chord).floor(), 0), place((middle + chord).ceil() + 1.0, n));
        first / CHUNK * CHUNK..last.next_multiple_of(CHUNK).min(n)
    }

    /// The zone of a pixel at distance r whose width's square is at most `widest`, both in radii.
    #[inline(always)]
    fn zone(&self, r: f32, widest: f32) -> u32 {
        let (start, end) = self.falloff;
        let half = self.half_width.0 + self.half_width.1 * widest;
        let (inner, outer) = (r - half, r + half);
        let end = if end < self.inner { end } else { self.inner };
        // The profile's even continuation through the center is no part of the falloff.
        let first = if start > 0.0 { start } else { 0.0 };
        let beyond = if inner > self.falloff.1 { BEYOND } else { 0 };
        let within = if outer < start { WITHIN } else { 0 };
        // In the falloff a pixel counts as narrow across the radius: for a wider one that is off by
        // more than a third of a byte.
        let is_narrow = widest < NARROW_SQUARED;
        let falls = if (inner > first) & (outer < end) & is_narrow { FALLOFF } else { 0 };
        // A dab thinner than a pixel reaches only a part of it anywhere.
        if self.thin < 1.0 { beyond } else { beyond | within | falls }
    }

    /// Whether pixels whose squared widths add up to `wide` count whole, as a bit in addition to
    /// the zone.
    #[inline(always)]
    fn softness(&self, wide: f32) -> u32 {
        if wide < self.soft { SOFT } else { 0 }
    }

    /// For pixels at most this long, px: the squared distances beyond which and within which all
    /// are in that zone.
    #[inline(always)]
    fn sure(&self, pixel: f32) -> (f32, f32) {
        // Distances are rounded.
        const ROUNDING: (f32, f32) = (1.0005, 0.05);
        let square = pixel * pixel * (self.per_radius * self.per_radius);
        let beyond = (self.falloff.1 + self.profile.half_width(square)) / self.per_radius
            * ROUNDING.0
            + ROUNDING.1;
        // Both widths of a pixel are at most this long.
        let half = self.half_width.0 + self.half_width.1 * 2.0 * square;
        let within = (self.falloff.0 - half) / self.per_radius / ROUNDING.0 - ROUNDING.1;
        let is_sure = self.thin >= 1.0 && within > 0.0;
        // NaN excludes nothing.
        (beyond * beyond, if is_sure { within * within } else { 0.0 })
    }

    /// A pixel at p from the center, J's columns `across` and `along`; canvas px. Gives r, |Jᵀ p|²,
    /// |J|² and the zone.
    #[inline(always)]
    fn judge(&self, p: (f32, f32), across: (f32, f32), along: (f32, f32)) -> (f32, f32, f32, u32) {
        let square = self.per_radius * self.per_radius;
        let r = (p.0 * p.0 + p.1 * p.1 + AT_CENTER).sqrt() * self.per_radius;
        let (a, b) = (across.0 * p.0 + across.1 * p.1, along.0 * p.0 + along.1 * p.1);
        // J's norm bounds the width in any direction.
        let across = across.0 * across.0 + across.1 * across.1;
        let widest = (across + (along.0 * along.0 + along.1 * along.1)) * square;
        (r, (a * a + b * b) * square * square, widest, self.zone(r, widest) | self.softness(widest))
    }

    /// a ← a + f (c − a), f = flow · F, up to the ceiling c, for dabs that reach whole pixels.
    #[inline(always)]
    fn raise(&self, coverage: &mut f32, mean: f32) {
        let f = self.flow * mean;
        // Comparisons turn NaN into 0, and rounding must not leave the range.
        let f = if f > 0.0 { f } else { 0.0 };
        let f = if f < 1.0 { f } else { 1.0 };
        let room = self.ceiling - *coverage;
        *coverage += f * if room > 0.0 { room } else { 0.0 };
    }

    /// On the rim: [`raise`] with the share that the stroke may reach. The squares are the pixel's
    /// widths along the radius and across it.
    #[inline(always)]
    fn raise_share(
        &self,
        coverage: &mut f32,
        reach: &mut f32,
        r: f32,
        width_squared: f32,
        across_squared: f32,
    ) {
        let mean = self.profile.mean_over(r, width_squared, across_squared);
        let share = self.rim.share(r, width_squared.sqrt());
        // Comparisons turn NaN into 0.
        let mean = if mean > 0.0 { mean } else { 0.0 };
        let covered = if mean < share { mean } else { share };
        raise(coverage, reach, self.flow * self.thin * covered, self.thin * share, self.ceiling);
    }

    /// The same, to the bit, for a pixel that counts whole: its share is 1, and the tip fills it.
    #[inline(always)]
    fn raise_whole(
        &self,
        coverage: &mut f32,
        reach: &mut f32,
        r: f32,
        width_squared: f32,
        across_squared: f32,
    ) {
        let mean = self.profile.mean_over_narrow(r, width_squared, across_squared);
        let mean = if mean > 0.0 { mean } else { 0.0 };
        let g = self.flow * if mean < 1.0 { mean } else { 1.0 };
        let room = self.ceiling - *coverage;
        *coverage += g * if room > 0.0 { room } else { 0.0 };
        *reach = if g > 0.0 { 1.0 } else { *reach };
    }

    /// Adds to classified pixels of a row, chunks of one zone at a time: the mean takes an extra
    /// root and division only if a pixel's box crosses a zone's border, and beyond the rim it costs
    /// nothing.
    #[inline(always)]
    fn add(&self, row: &RowZones, pixels: Range<usize>, paint: RowPaint) {
        let RowPaint { coverage, reach } = paint;
        let n = coverage.len().min(reach.len()).min(TILE).min(pixels.end);
        let mut start = pixels.start;
        while start < n {
            let zone = zone_of(&row.zones, start, n);
            let mut end = start + CHUNK;
            while end < n && zone_of(&row.zones, end, n) == zone {
                end += CHUNK;
            }
            let end = end.min(n);
            let (r, toward, wide) =
                (&row.r[start..end], &row.toward[start..end], &row.wide[start..end]);
            let (part, reached) = (&mut coverage[start..end], &mut reach[start..end]);
            match zone & !SOFT {
                BEYOND => {}
                WITHIN => add_within(*self, part),
                FALLOFF => add_falloff(*self, r, toward, part),
                _ if zone & SOFT != 0 => add_soft_rim(*self, (r, toward, wide), part, reached),
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
fn add_rim(
    tip: RoundTip,
    (r, toward, wide): (&[f32], &[f32], &[f32]),
    coverage: &mut [f32],
    reach: &mut [f32],
) {
    for ((((a, m), r), toward), wide) in coverage.iter_mut().zip(reach).zip(r).zip(toward).zip(wide)
    {
        let width_squared = toward / (r * r);
        tip.raise_share(a, m, *r, width_squared, wide - width_squared);
    }
}

#[inline(always)]
fn add_soft_rim(
    tip: RoundTip,
    (r, toward, wide): (&[f32], &[f32], &[f32]),
    coverage: &mut [f32],
    reach: &mut [f32],
) {
    for ((((a, m), r), toward), wide) in coverage.iter_mut().zip(reach).zip(r).zip(toward).zip(wide)
    {
        let width_squared = toward / (r * r);
        tip.raise_whole(a, m, *r, width_squared, wide - width_squared);
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

#[cfg(test)]
mod tests;
