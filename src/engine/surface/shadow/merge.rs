//! Near and far shadows of groups of rays become one. Floor 2. Far ones may be at half the size:
//! a pixel takes those of the four pixels around it, by their distance and by how near their
//! heights are to its own, so that nothing leaks over an edge.

use super::counts::WHOLE;
use super::heights::HeightMap;
use super::sweep::NearBand;
use crate::math::{Size, fast, parallel};
use crate::raster::Plane;

/// Pixels of a row at a time, and at half the size.
const CHUNK: usize = 64;
const HALF: usize = CHUNK / 2;
/// A difference in height that halves the weight of a pixel, px.
const STEP_PX: f32 = 6.0;
/// The least weight, so that a pixel whose neighbors are all far off takes the nearest.
const LEAST: f32 = 1e-6;

/// The far rays of groups.
pub(super) struct FarCounts {
    /// The sum of each group's.
    pub groups: Vec<Plane<u16>>,
    /// Whether the planes are half the size.
    pub is_half: bool,
}

impl FarCounts {
    /// The sum of all groups.
    pub fn total(&self) -> Plane<u16> {
        let Some((first, others)) = self.groups.split_first() else {
            return Plane::full(Size::new(0, 0), 0);
        };
        let (mut total, width) = (first.clone(), first.width().max(1));
        parallel::for_each_row(total.values_mut(), width, 1, |y, row| {
            for other in others {
                row.iter_mut().zip(other.row(y)).for_each(|(sum, v)| *sum += v);
            }
        });
        total
    }
}

/// Adds max(near, far) of each group to the counts of a row. `far`: and the sum of all groups;
/// `near`: of each group, and how many rays it stands for.
pub(super) fn add_row(
    heights: &HeightMap,
    far: (&FarCounts, &Plane<u16>),
    near: &[(NearBand, u32)],
    y: usize,
    counts: &mut [u16],
) {
    for (chunk, counts) in counts.chunks_mut(CHUNK).enumerate() {
        let whole = Merge { heights, far: far.0, total: far.1, near, y, chunk };
        add_chunk(&whole, counts);
    }
}

/// A chunk of a row.
struct Merge<'a> {
    heights: &'a HeightMap,
    far: &'a FarCounts,
    total: &'a Plane<u16>,
    near: &'a [(NearBand, u32)],
    y: usize,
    chunk: usize,
}

/// `HALF` pixels of a row of half the size, one to the left of `x` on, and one more; those of the
/// border again beyond it. `+ 7` fills vectors.
#[inline(always)]
fn window_of_row<T: Copy + Default>(row: &[T], x: usize) -> [T; HALF + 8] {
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
    fn add_chunk(merge: &Merge, counts: &mut [u16]) {
        let (x0, width) = (merge.chunk * CHUNK, counts.len());
        let has_near = merge.near.iter().any(|near| near.0.chunk(merge.y, merge.chunk).is_some());
        let bounds = merge.bounds(width);
        // Most pixels lie in the light.
        if !has_near && bounds.1 == 0 {
            return;
        }
        let is_even = bounds.0 == bounds.1 && (!has_near || bounds.1 == 0);
        let mut shares = [[[0.0; HALF]; 4]; 2];
        if merge.far.is_half && !is_even {
            weigh(merge.heights, (x0, merge.y), width, &mut shares);
        }
        let mut sums = [[f32::from(bounds.0); HALF]; 2];
        if !is_even {
            sums = merge.enlarge(merge.total, &shares, width);
        }
        for (i, (near, rays)) in merge.near.iter().enumerate() {
            let Some(near) = near.chunk(merge.y, merge.chunk) else { continue };
            let far = match merge.far.groups.get(i) {
                Some(far) if !is_even => merge.enlarge(far, &shares, width),
                _ => [[0.0; HALF]; 2],
            };
            let (near, each) = (split_by_parity(near, 0, width), *rays as f32 * (WHOLE / NearBand::WHOLE));
            for odd in 0..2 {
                for x in 0..HALF {
                    let more = f32::from(near[odd][x]) * each - far[odd][x];
                    sums[odd][x] += fast::max(more, 0.0);
                }
            }
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

impl Merge<'_> {
    /// The least and the most of all far counts around the chunk.
    #[inline(always)]
    fn bounds(&self, width: usize) -> (u16, u16) {
        let (x0, mut least, mut most) = (self.chunk * CHUNK, u16::MAX, 0);
        let mut take = |row: &[u16]| {
            for v in row {
                least = least.min(*v);
                most = most.max(*v);
            }
        };
        if self.far.is_half {
            let (above, below, _) = rows_around(self.y, self.total.height());
            for y in [above, below] {
                take(&window_of_row(self.total.row(y), x0 / 2)[..HALF + 2]);
            }
        } else {
            take(&self.total.row(self.y)[x0..x0 + width]);
        }
        (least, most)
    }

    /// Far counts of every pixel of the chunk, even and odd ones.
    #[inline(always)]
    fn enlarge(
        &self,
        counts: &Plane<u16>,
        shares: &NeighborShares,
        width: usize,
    ) -> [[f32; HALF]; 2] {
        let x0 = self.chunk * CHUNK;
        if !self.far.is_half {
            let [even, odd] = split_by_parity(counts.row(self.y), x0, width);
            return [to_floats(&even), to_floats(&odd)];
        }
        let (above, below, _) = rows_around(self.y, counts.height());
        let of = |y: usize| window_of_row(counts.row(y), x0 / 2);
        let rows = [of(above), of(below)];
        let mut far = [[0.0; HALF]; 2];
        for (odd, far) in far.iter_mut().enumerate() {
            for (c, (is_below, is_right)) in SIDES.into_iter().enumerate() {
                let (row, shares) = (&rows[usize::from(is_below)], &shares[odd][c]);
                for i in 0..HALF {
                    far[i] += shares[i] * f32::from(row[i + odd + usize::from(is_right)]);
                }
            }
        }
        far
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
    let (mut even, mut odd) = ([T::default(); HALF], [T::default(); HALF]);
    for i in 0..HALF {
        (even[i], odd[i]) = (chunk[2 * i], chunk[2 * i + 1]);
    }
    [even, odd]
}

#[inline(always)]
fn to_floats(counts: &[u16; HALF]) -> [f32; HALF] {
    let mut floats = [0.0; HALF];
    for i in 0..HALF {
        floats[i] = f32::from(counts[i]);
    }
    floats
}

#[inline(always)]
fn weigh(heights: &HeightMap, (x0, y): (usize, usize), width: usize, weights: &mut NeighborShares) {
    let (above, below, down) = rows_around(y, heights.half.height());
    let of = |y: usize| window_of_row(heights.half.row(y), x0 / 2);
    let rows = [of(above), of(below)];
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
