//! Where chunks meet: which neighbors' places are averaged with a pixel's own. Floor 2.

use super::ways::{WayLanes, WayPairs};
use super::{BallPlaces, ChunkMaps, ChunkSettings};
use crate::math::{parallel, vec2};
use crate::raster::Plane;
use std::ops::Range;

/// The directions in which neighbors are looked for.
pub const SEAM_STEPS: [(i32, i32); 8] =
    [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];

/// Finds the seams of places.
///
/// * `chunks`: which chunk each pixel shows; 0 off the surface.
pub(super) fn find_seams(
    maps: &ChunkMaps,
    mut places: BallPlaces,
    chunks: &Plane<u8>,
) -> BallPlaces {
    let seam_px = maps.settings.seam_px.round();
    if seam_px < 1.0 {
        return places;
    }
    places.seam_px = seam_px as usize;
    let mut seams = Plane::full(chunks.size(), 0u8);
    let width = chunks.width().max(1);
    parallel::for_each_row(seams.values_mut(), width, 1, |y, row| {
        for (bit, step) in SEAM_STEPS.into_iter().enumerate() {
            if let Some(pairs) = SeamPairs::of(maps, (&places, chunks), y, step) {
                mark_seams(&pairs, 1 << bit, &mut row[pairs.own.columns.clone()]);
            }
        }
    });
    places.seams = Some(seams);
    places
}

/// What pixels of a row show.
struct SeamRow<'r> {
    columns: Range<usize>,
    places: &'r [[u16; 2]],
    chunks: &'r [u8],
}

/// Pixels of a row, and those that lie a step away.
struct SeamPairs<'r> {
    own: SeamRow<'r>,
    other: SeamRow<'r>,
    ways: WayPairs<'r>,
    normals: [&'r [f32]; 3],
    /// From a place to where it was before the step, in steps of places.
    back: [f32; 2],
    settings: ChunkSettings,
    /// Of a step of places, px.
    per_step: f32,
}

impl<'r> SeamPairs<'r> {
    /// Those within the canvas, if there are any.
    fn of(
        maps: &'r ChunkMaps,
        (places, chunks): (&'r BallPlaces, &'r Plane<u8>),
        y: usize,
        (dx, dy): (i32, i32),
    ) -> Option<Self> {
        let (width, reach) = (chunks.width(), places.seam_px);
        let other = y.checked_add_signed(dy as isize * reach as isize)?;
        if other >= chunks.height() || reach >= width {
            return None;
        }
        let [left, right] = [dx < 0, dx > 0].map(|is_there| reach * usize::from(is_there));
        let own = left..width - right;
        let row = |y: usize, columns: Range<usize>| SeamRow {
            places: &places.row(y)[columns.clone()],
            chunks: &chunks.row(y)[columns.clone()],
            columns,
        };
        let (steps, far) = (reach as f32 * places.steps, right..width - left);
        Some(Self {
            ways: maps.ways.pairs([y, other], [own.clone(), far.clone()]),
            normals: maps.seen.each_ref().map(|plane| &plane.row(y)[own.clone()]),
            own: row(y, own),
            other: row(other, far),
            back: [dx as f32 * steps, dy as f32 * steps],
            settings: maps.settings,
            // Steps are a power of two, so that this is exact.
            per_step: 1.0 / places.steps,
        })
    }

    /// `N` pixels from one on, if there are so many.
    #[inline(always)]
    fn lanes<const N: usize>(&self, first: usize) -> Option<SeamLanes<'r, N>> {
        let Self { own, other, ways, normals: [nx, ny, nz], .. } = self;
        Some(SeamLanes {
            chunks: [own.chunks[first..].first_chunk()?, other.chunks[first..].first_chunk()?],
            places: other.places[first..].first_chunk()?,
            normals: [
                nx[first..].first_chunk()?,
                ny[first..].first_chunk()?,
                nz[first..].first_chunk()?,
            ],
            ways: ways.lanes(first)?,
        })
    }

    /// Adds a bit to pixels that are averaged with the other: its place suits, in another chunk,
    /// and it is joined to the pixel.
    #[inline(always)]
    fn mark<const N: usize>(&self, lanes: &SeamLanes<N>, bit: u8, bits: &mut [u8; N]) {
        let SeamLanes { chunks: [own, other], places, normals: [nx, ny, nz], ways } = lanes;
        for i in 0..N {
            let is_border = (own[i] != other[i]) & (own[i] != 0) & (other[i] != 0);
            let [x, y] = places[i];
            let at = vec2(f32::from(x) - self.back[0], f32::from(y) - self.back[1]) * self.per_step;
            let is_near = self.settings.is_near(at, vec2(nx[i], ny[i]), nz[i]);
            bits[i] |= if is_border & is_near & ways.are_joined(i) { bit } else { 0 };
        }
    }
}

/// Pairs that are worked on at once: chunks of both, the other's place, the own normal, and the
/// ways between them.
struct SeamLanes<'r, const N: usize> {
    chunks: [&'r [u8; N]; 2],
    places: &'r [[u16; 2]; N],
    normals: [&'r [f32; N]; 3],
    ways: WayLanes<'r, N>,
}

crate::widest! {
    /// Adds a bit to the pixels that are averaged with the other.
    fn mark_seams(pairs: &SeamPairs, bit: u8, bits: &mut [u8]) {
        let (groups, rest) = bits.as_chunks_mut::<8>();
        let count = groups.len() * 8;
        for (group, bits) in groups.iter_mut().enumerate() {
            if let Some(lanes) = pairs.lanes::<8>(group * 8)
                && lanes.chunks[0] != lanes.chunks[1]
            {
                pairs.mark(&lanes, bit, bits);
            }
        }
        for (i, bits) in rest.iter_mut().enumerate() {
            if let Some(lanes) = pairs.lanes::<1>(count + i) {
                pairs.mark(&lanes, bit, std::array::from_mut(bits));
            }
        }
    }
}
