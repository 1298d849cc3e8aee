//! The round tip's loops over rows of pixels. Floor 3. Not here: how a pixel is classified and
//! covered (`round`).

use super::{AT_CENTER, BEYOND, CHUNK, RoundTip, RowPaint, RowZones, WITHIN, add_within, zone_of};
use crate::paint::dab::{DeformationField, PixelSpan, SpanNeighbors};
use crate::raster::TILE;
use crate::raster::tile::TILE_AREA;
use crate::surface::links;
use crate::surface::support::{BLOCK, TILE_BLOCKS};
use std::ops::Range;

/// A pixel all of whose neighbors continue its surface.
const INSIDE: u8 = links::LEFT | links::RIGHT | links::UP | links::DOWN;

/// The greatest length of a pixel in each block of a tile, px; row by row.
pub(in crate::paint::dab) type BlockPixels = [f32; TILE_BLOCKS * TILE_BLOCKS];

/// A part of a tile that a bent dab may touch.
#[derive(Clone, Copy)]
pub(in crate::paint::dab) struct BentPart<'p> {
    /// The tile's first pixel.
    pub corner: (i32, i32),
    pub spans: &'p [PixelSpan],
    pub pixel: &'p BlockPixels,
}

/// The coverage and reach of all pixels of a tile.
pub(in crate::paint::dab) type TilePlanes<'t> =
    (&'t mut [f32; TILE_AREA], &'t mut [f32; TILE_AREA]);

crate::widest! {
    /// If D is the identity; (x, y) is the center of the first pixel.
    pub(in crate::paint::dab) fn flat_row(x: f32, y: f32, tip: &RoundTip, row: &mut RowZones, paint: RowPaint) {
        flat_span(x, y, tip, row, paint);
    }

    /// The same over all rows of a part of a tile, whose first pixel is `corner`: rows of small
    /// dabs are short.
    pub(in crate::paint::dab) fn flat_rows(
        corner: (i32, i32),
        spans: &[PixelSpan],
        tip: &RoundTip,
        row: &mut RowZones,
        tile: TilePlanes,
    ) {
        for span in spans {
            let Some(paint) = of_span(corner, span, (&mut *tile.0, &mut *tile.1)) else { continue };
            flat_span(span.x as f32 + 0.5, span.y as f32 + 0.5, tip, row, paint);
        }
    }

    /// Bent: J by differences within each pixel's piece of surface.
    pub(in crate::paint::dab) fn fill_bent_row(d: SpanNeighbors, tip: &RoundTip, row: &mut RowZones, paint: RowPaint) {
        let n = paint.coverage.len().min(TILE);
        judge(d, 0..n, tip, row);
        tip.add(row, 0..n, paint);
    }

    /// The same over all rows of a part of a tile, to the same bits. Chunks that lie beyond the dab
    /// or within its hardness by their distance alone are not classified.
    pub(in crate::paint::dab) fn fill_bent_rows(
        d: &DeformationField,
        part: BentPart,
        tip: &RoundTip,
        row: &mut RowZones,
        tile: TilePlanes,
    ) {
        let mut sure = SureZones::default();
        for span in part.spans {
            let Some(paint) = of_span(part.corner, span, (&mut *tile.0, &mut *tile.1)) else { continue };
            d.prefetch(*span);
            sure.enter((span.y - part.corner.1) as usize / BLOCK, part.pixel, tip);
            fill_bent_span(d.span_neighbors(*span), sure.from((span.x - part.corner.0) as usize), tip, row, paint);
        }
    }
}

/// The squared distances, px, that are surely beyond a dab and within its hardness in each column
/// of a row of blocks.
struct SureZones {
    row: Option<usize>,
    beyond: [f32; TILE],
    within: [f32; TILE],
}

impl Default for SureZones {
    fn default() -> Self {
        Self { row: None, beyond: [f32::INFINITY; TILE], within: [0.0; TILE] }
    }
}

impl SureZones {
    #[inline(always)]
    fn enter(&mut self, row: usize, pixel: &BlockPixels, tip: &RoundTip) {
        if self.row == Some(row) {
            return;
        }
        self.row = Some(row);
        let blocks = self
            .beyond
            .as_chunks_mut::<BLOCK>()
            .0
            .iter_mut()
            .zip(self.within.as_chunks_mut::<BLOCK>().0);
        for ((beyond, within), pixel) in blocks.zip(pixel.iter().skip(row * TILE_BLOCKS)) {
            let (far, near) = tip.sure(*pixel);
            (*beyond, *within) = ([far; BLOCK], [near; BLOCK]);
        }
    }

    #[inline(always)]
    fn from(&self, column: usize) -> (&[f32], &[f32]) {
        (&self.beyond[column.min(TILE)..], &self.within[column.min(TILE)..])
    }
}

/// The pixels of a span among those of its tile.
#[inline(always)]
fn of_span<'t>(corner: (i32, i32), span: &PixelSpan, tile: TilePlanes<'t>) -> Option<RowPaint<'t>> {
    let start = (span.y - corner.1) as usize * TILE + (span.x - corner.0) as usize;
    let coverage = tile.0.get_mut(start..start + span.n)?;
    Some(RowPaint { coverage, reach: tile.1.get_mut(start..start + span.n)? })
}

#[inline(always)]
fn flat_span(x: f32, y: f32, tip: &RoundTip, row: &mut RowZones, paint: RowPaint) {
    let n = paint.coverage.len().min(TILE);
    let dy = y - tip.at.y;
    let pixel = tip.per_radius * tip.per_radius;
    let softness = tip.softness(2.0 * pixel);
    let (r, toward, zones) = (&mut row.r[..n], &mut row.toward[..n], &mut row.zones[..n]);
    row.wide[..n].fill(2.0 * pixel);
    for i in 0..n {
        // Through i32: AVX2 converts no 64-bit integers.
        let dx = x + i as i32 as f32 - tip.at.x;
        let r_squared = (dx * dx + dy * dy + AT_CENTER) * pixel;
        (r[i], toward[i]) = (r_squared.sqrt(), pixel * r_squared);
        zones[i] = tip.zone(r[i], pixel) | softness;
    }
    tip.add(row, 0..n, paint);
}

#[inline(always)]
fn fill_bent_span(
    d: SpanNeighbors,
    sure: (&[f32], &[f32]),
    tip: &RoundTip,
    row: &mut RowZones,
    paint: RowPaint,
) {
    let RowPaint { coverage, reach } = paint;
    let n = coverage.len().min(reach.len()).min(sure.0.len());
    sort(&d.row.0[1..n + 1], &d.row.1[1..n + 1], sure, tip, &mut row.near[..n]);
    let mut start = 0;
    while start < n {
        let near = zone_of(&row.near, start, n);
        let mut end = start + CHUNK;
        while end < n && zone_of(&row.near, end, n) == near {
            end += CHUNK;
        }
        let pixels = start..end.min(n);
        start = end;
        match near {
            BEYOND => {}
            WITHIN => {
                add_within(*tip, &mut coverage[pixels.clone()]);
                reach[pixels].fill(1.0);
            }
            _ => {
                judge(d, pixels.clone(), tip, row);
                tip.add(row, pixels, RowPaint { coverage: &mut *coverage, reach: &mut *reach });
            }
        }
    }
}

/// What the distances of pixels say about their zones.
#[inline(always)]
fn sort(x: &[f32], y: &[f32], sure: (&[f32], &[f32]), tip: &RoundTip, near: &mut [u32]) {
    let n = near.len();
    let (x, y, beyond, within) = (&x[..n], &y[..n], &sure.0[..n], &sure.1[..n]);
    for i in 0..n {
        let (dx, dy) = (x[i] - tip.at.x, y[i] - tip.at.y);
        let squared = dx * dx + dy * dy;
        // NaN is neither.
        near[i] = if squared > beyond[i] { BEYOND } else { 0 }
            | if squared < within[i] { WITHIN } else { 0 };
    }
}

/// What pixels of a row are classified by: D at them and at their neighbors.
#[inline(always)]
fn judge(d: SpanNeighbors, pixels: Range<usize>, tip: &RoundTip, row: &mut RowZones) {
    if are_inside(&d.linked[pixels.clone()]) {
        judge_inside(d, pixels, tip, row);
    } else {
        judge_rim(d, pixels, tip, row);
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
fn judge_inside<'d>(
    d: SpanNeighbors<'d>,
    pixels: Range<usize>,
    tip: &RoundTip,
    row: &mut RowZones,
) {
    let n = pixels.len();
    let around = |row: &'d [f32]| &row[pixels.start..pixels.end + 2];
    let (cx, cy) = (around(d.row.0), around(d.row.1));
    let (ax, ay) = (around(d.above.0), around(d.above.1));
    let (bx, by) = (around(d.below.0), around(d.below.1));
    let (cx, cy, ax, ay, bx, by) =
        (&cx[..n + 2], &cy[..n + 2], &ax[..n + 2], &ay[..n + 2], &bx[..n + 2], &by[..n + 2]);
    let (r, toward) = (&mut row.r[pixels.clone()][..n], &mut row.toward[pixels.clone()][..n]);
    let (wide, zones) = (&mut row.wide[pixels.clone()][..n], &mut row.zones[pixels.clone()][..n]);
    for i in 0..n {
        let p = (cx[i + 1] - tip.at.x, cy[i + 1] - tip.at.y);
        let across = (0.5 * (cx[i + 2] - cx[i]), 0.5 * (cy[i + 2] - cy[i]));
        let along = (0.5 * (bx[i + 1] - ax[i + 1]), 0.5 * (by[i + 1] - ay[i + 1]));
        (r[i], toward[i], wide[i], zones[i]) = tip.judge(p, across, along);
    }
}

/// Along a silhouette, a depth jump or outside: J from linked neighbors only.
#[inline(always)]
fn judge_rim<'d>(d: SpanNeighbors<'d>, pixels: Range<usize>, tip: &RoundTip, row: &mut RowZones) {
    let n = pixels.len();
    let around = |row: &'d [f32]| &row[pixels.start..pixels.end + 2];
    let (cx, cy) = (around(d.row.0), around(d.row.1));
    let (ax, ay) = (around(d.above.0), around(d.above.1));
    let (bx, by) = (around(d.below.0), around(d.below.1));
    let (cx, cy, ax, ay, bx, by) =
        (&cx[..n + 2], &cy[..n + 2], &ax[..n + 2], &ay[..n + 2], &bx[..n + 2], &by[..n + 2]);
    let linked = &d.linked[pixels.clone()][..n];
    let (r, toward) = (&mut row.r[pixels.clone()][..n], &mut row.toward[pixels.clone()][..n]);
    let (wide, zones) = (&mut row.wide[pixels.clone()][..n], &mut row.zones[pixels.clone()][..n]);
    for i in 0..n {
        let (x, y) = (cx[i + 1], cy[i + 1]);
        let has = |bit: u8| linked[i] & bit != 0;
        let (left, right, up, down) =
            (has(links::LEFT), has(links::RIGHT), has(links::UP), has(links::DOWN));
        let across = (
            slope(left, right, cx[i], x, cx[i + 2], 1.0),
            slope(left, right, cy[i], y, cy[i + 2], 0.0),
        );
        let along = (
            slope(up, down, ax[i + 1], x, bx[i + 1], 0.0),
            slope(up, down, ay[i + 1], y, by[i + 1], 1.0),
        );
        (r[i], toward[i], wide[i], zones[i]) =
            tip.judge((x - tip.at.x, y - tip.at.y), across, along);
    }
}

/// The derivative at `here` from its linked neighbors, of two; `flat`, the identity's, without
/// any.
#[inline(always)]
pub fn slope(
    has_before: bool,
    has_after: bool,
    before: f32,
    here: f32,
    after: f32,
    flat: f32,
) -> f32 {
    let low = if has_before { before } else { here };
    let high = if has_after { after } else { here };
    let mean = if has_before & has_after { 0.5 * (high - low) } else { high - low };
    if has_before | has_after { mean } else { flat }
}
