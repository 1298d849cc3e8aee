//! Near and far shadows of groups of rays become one. Floor 2. Far ones may be at half the size:
//! a pixel takes those of the four pixels around it, by their distance and by how near their
//! heights are to its own, so that nothing leaks over an edge.

use super::heights::HeightMap;
use crate::math::fast;
use crate::raster::Plane;
use rayon::prelude::*;

/// Pixels of a row at a time, and at half the size.
const CHUNK: usize = 64;
const HALF: usize = CHUNK / 2;
/// A difference in height that halves the weight of a pixel, px.
const STEP_PX: f32 = 6.0;
/// The least weight, so that a pixel whose neighbors are all far off takes the nearest.
const LEAST: f32 = 1e-6;

/// What is counted of a group of rays.
pub(super) struct GroupCounts {
    /// Of its near ray.
    pub near: Plane<u16>,
    /// The sum of its far rays; empty if they are part of `near`.
    pub far: Option<FarCounts>,
    /// How many rays it stands for.
    pub rays: u32,
}

/// The far rays of a group.
pub(super) struct FarCounts {
    pub sum: Plane<u16>,
    /// Whether the plane is half the size.
    pub is_half: bool,
}

/// Adds max(near, far) of each group to the counts, a row after another.
pub(super) fn add(heights: &HeightMap, groups: &[GroupCounts], counts: &mut Plane<u16>) {
    let width = counts.width().max(1);
    counts.values_mut().par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (chunk, counts) in row.chunks_mut(CHUNK).enumerate() {
            add_chunk(heights, groups, (chunk * CHUNK, y), counts);
        }
    });
}

/// `HALF` pixels of a row of half the size, one to the left of `x` on, and one more; those of the
/// border again beyond it. `+ 7` fills vectors.
#[inline(always)]
fn around<T: Copy + Default>(row: &[T], x: usize) -> [T; HALF + 8] {
    let inside = x.checked_sub(1).and_then(|x| row.get(x..)?.first_chunk());
    inside.copied().unwrap_or_else(|| {
        let mut values = [T::default(); HALF + 8];
        for (k, value) in values.iter_mut().enumerate() {
            *value = row[(x + k).max(1).min(row.len()) - 1];
        }
        values
    })
}

/// The rows of half the size above and below a row, and the share of the lower one.
fn rows_around(y: usize, height: usize) -> (usize, usize, f32) {
    let above = y.div_ceil(2);
    let down = if y.is_multiple_of(2) { 0.75 } else { 0.25 };
    (above.max(1).min(height) - 1, above.min(height - 1), down)
}

/// The weights of the pixels left and right, above and below, of even and of odd pixels.
type NeighborShares = [[[f32; HALF]; 4]; 2];

/// Neighbor `c` of four: whether it is below, and right.
const SIDES: [(bool, bool); 4] = [(false, false), (false, true), (true, false), (true, true)];

crate::widest! {
    fn add_chunk(heights: &HeightMap, groups: &[GroupCounts], at: (usize, usize), counts: &mut [u16]) {
        let mut weights = [[[0.0; HALF]; 4]; 2];
        if groups.iter().any(|group| group.far.as_ref().is_some_and(|far| far.is_half)) {
            weigh(heights, at, counts.len(), &mut weights);
        }
        let mut sums = [[0.0; HALF]; 2];
        for group in groups {
            add_group(group, &weights, at, counts.len(), &mut sums);
        }
        let mut added = [0; CHUNK];
        for i in 0..HALF {
            for odd in 0..2 {
                added[2 * i + odd] = fast::whole(sums[odd][i]) as u16;
            }
        }
        counts.iter_mut().zip(&added).for_each(|(sum, added)| *sum += added);
    }
}

/// A chunk of a row, even and odd pixels apart; 0 beyond `width`.
#[inline(always)]
fn split_by_parity<T: Copy + Default>(row: &[T], x0: usize, width: usize) -> [[T; HALF]; 2] {
    let mut chunk = [T::default(); CHUNK];
    match row[x0..].first_chunk() {
        Some(whole) => chunk = *whole,
        None => chunk.iter_mut().zip(&row[x0..x0 + width]).for_each(|(to, from)| *to = *from),
    }
    [0, 1].map(|odd| std::array::from_fn(|i| chunk[2 * i + odd]))
}

#[inline(always)]
fn weigh(heights: &HeightMap, (x0, y): (usize, usize), width: usize, weights: &mut NeighborShares) {
    let (above, below, down) = rows_around(y, heights.half.height());
    let rows = [above, below].map(|y| around(heights.half.row(y), x0 / 2));
    let own = split_by_parity(heights.whole.row(y), x0, width);
    for (odd, weights) in weights.iter_mut().enumerate() {
        let mut all = [0.0; HALF];
        for (c, (is_below, is_right)) in SIDES.into_iter().enumerate() {
            let vertical = if is_below { down } else { 1.0 - down };
            let horizontal = if is_right == (odd == 1) { 0.25 } else { 0.75 };
            let (row, share) = (&rows[usize::from(is_below)], vertical * horizontal);
            for i in 0..HALF {
                let off = (row[i + odd + usize::from(is_right)] - own[odd][i]) * (1.0 / STEP_PX);
                let square = off * off;
                let weight = (share + LEAST + LEAST * square) / (1.0 + square * square);
                weights[c][i] = weight;
                all[i] += weight;
            }
        }
        for weights in weights {
            for i in 0..HALF {
                weights[i] /= all[i];
            }
        }
    }
}

/// Adds what a group counts to a chunk.
#[inline(always)]
fn add_group(
    group: &GroupCounts,
    weights: &NeighborShares,
    (x0, y): (usize, usize),
    width: usize,
    sums: &mut [[f32; HALF]; 2],
) {
    let (near, rays) = (split_by_parity(group.near.row(y), x0, width), group.rays as f32);
    let mut far = [[0.0; HALF]; 2];
    match &group.far {
        Some(FarCounts { sum, is_half: true }) => {
            let (above, below, _) = rows_around(y, sum.height());
            let rows = [above, below].map(|y| around(sum.row(y), x0 / 2));
            let mut lit = 0;
            for (even, odd) in near[0].iter().zip(&near[1]) {
                lit |= even | odd;
            }
            for (above, below) in rows[0].iter().zip(&rows[1]) {
                lit |= above | below;
            }
            // Most pixels lie in the light.
            if lit == 0 {
                return;
            }
            for (odd, far) in far.iter_mut().enumerate() {
                for (c, (is_below, is_right)) in SIDES.into_iter().enumerate() {
                    let (row, weights) = (&rows[usize::from(is_below)], &weights[odd][c]);
                    for i in 0..HALF {
                        far[i] += weights[i] * f32::from(row[i + odd + usize::from(is_right)]);
                    }
                }
            }
        }
        Some(FarCounts { sum, is_half: false }) => {
            let whole = split_by_parity(sum.row(y), x0, width);
            far = whole.map(|half| half.map(f32::from));
        }
        None => {}
    }
    for (odd, sums) in sums.iter_mut().enumerate() {
        for i in 0..HALF {
            sums[i] += fast::max(f32::from(near[odd][i]) * rays, far[odd][i]);
        }
    }
}
