//! Where chunks meet: which neighbors' places are averaged with a pixel's own. Floor 2.

use super::{BallPlace, BallPlaces, ChunkMaps};
use crate::math::vec2;
use crate::raster::Plane;
use rayon::prelude::*;

/// The directions in which neighbors are looked for.
pub const SEAM_STEPS: [(i32, i32); 8] =
    [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];

/// Finds the seams of places.
pub(super) fn find_seams(maps: &ChunkMaps, places: Plane<BallPlace>) -> BallPlaces {
    let at = Plane::from_fn(places.size(), |x, y| places.at(x, y).at);
    let mut joined = BallPlaces::without_seams(at, &maps.settings);
    let seam_px = maps.settings.seam_px.round();
    if seam_px < 1.0 {
        return joined;
    }
    joined.seam_px = seam_px as usize;
    let (mut seams, chunks) = (Plane::full(places.size(), 0u8), places.map(|place| place.chunk));
    let width = places.width().max(1);
    seams.values_mut().par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        find_borders(&chunks, y, joined.seam_px, row);
        for (x, out) in row.iter_mut().enumerate().filter(|(_, bits)| **bits > 0) {
            *out = average(maps, &joined, (x, y), *out);
        }
    });
    joined.seams = Some(seams);
    joined
}

crate::widest! {
    /// The bits of the neighbors that lie in other chunks.
    fn find_borders(chunks: &Plane<u8>, y: usize, step: usize, bits: &mut [u8]) {
        let (own, width) = (chunks.row(y), bits.len());
        for (bit, (dx, dy)) in SEAM_STEPS.iter().enumerate() {
            let other = y as i64 + i64::from(*dy) * step as i64;
            if other < 0 || other >= chunks.height() as i64 || step >= width {
                continue;
            }
            let other = chunks.row(other as usize);
            let (from, to) = (if *dx > 0 { step } else { 0 }, if *dx < 0 { step } else { 0 });
            let count = width - from.max(to);
            let pixels = bits[to..to + count].iter_mut().zip(&own[to..to + count]);
            for ((bits, own), other) in pixels.zip(&other[from..from + count]) {
                let is_border = (own != other) & (*own != 0) & (*other != 0);
                *bits |= u8::from(is_border) << bit;
            }
        }
    }
}

/// Those of some neighbors that are joined to the pixel, and whose places suit it.
fn average(maps: &ChunkMaps, joined: &BallPlaces, (x, y): (usize, usize), bits: u8) -> u8 {
    let step = joined.seam_px as i32;
    let (nbar, nz) = (maps.nbar(x, y), maps.seen[2].at(x, y));
    let is_averaged = |bit: usize| {
        let (dx, dy) = SEAM_STEPS[bit];
        let other = ((x as i32 + dx * step) as usize, (y as i32 + dy * step) as usize);
        let [px, py] = joined.place_beside(x, y, bit).map(|step| step / joined.steps);
        maps.settings.is_near(vec2(px, py), nbar, nz) && maps.ways.is_reached((x, y), other)
    };
    let is_kept = |bit: &usize| bits >> bit & 1 != 0 && is_averaged(*bit);
    (0..SEAM_STEPS.len()).filter(is_kept).fold(0, |kept, bit| kept | 1 << bit)
}
