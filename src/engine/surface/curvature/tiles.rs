//! The curvature tensor of a whole map, tile by tile: blur, slopes and differences while the tile
//! is in the cache. Floor 2. The plain version that reads like the paper is `reference`.

use super::ends::{EndBlur, FlowRegion};
use super::tile_rect::{BAND_ROWS, LANES, STRIDE, TileRect};
use super::{Curvature, slope, tensor};
use crate::math::parallel;
use crate::math::simd::prefetch;
use crate::raster::{Plane, blur::half_kernel};
use crate::surface::{Surface, links};

/// Chunks of a row of scratch.
const CHUNKS: usize = STRIDE / LANES;
/// From a row of what is blurred down the columns to the next: a power of two would put all rows of
/// a chunk into a few sets of the first-level cache.
const PITCH: usize = STRIDE + 16;

/// Computes H for every pixel. `blur_px`: standard deviation, finite, `≥ 0`.
///
/// `recycled`: planes of the same size that are no longer wanted. At 3840 × 2160, allocating costs
/// as much as the work itself.
pub(super) fn compute(surface: &Surface, blur_px: f32, recycled: Option<Curvature>) -> Curvature {
    let size = surface.size();
    let taps = half_kernel(blur_px);
    let mut planes = match recycled {
        Some(Curvature { hxx, hxy, hyy }) => [hxx, hxy, hyy].map(Plane::into_values),
        None => std::array::from_fn(|_| vec![0.0; size.area()]),
    };
    let rims = surface.rims();
    let ends = EndBlur::new(surface, &rims, blur_px);
    let band = BAND_ROWS * size.width as usize;
    let [hxx, hxy, hyy] = planes.each_mut().map(|p| p.chunks_mut(band));
    parallel::for_each_with(
        hxx.zip(hxy).zip(hyy).enumerate(),
        1,
        || (TileScratch::new(taps.len() - 1), FlowRegion::default()),
        |(scratch, region), (i, ((hxx, hxy), hyy))| {
            for tile in TileRect::of_band(size, i * BAND_ROWS) {
                if tile.is_empty(surface) {
                    [&mut *hxx, hxy, hyy]
                        .into_iter()
                        .for_each(|plane| tile.clear(plane, size, 0.0));
                } else {
                    scratch.tensor_tile(surface, &taps, tile, [&mut *hxx, hxy, hyy]);
                    if let Some(ends) = &ends {
                        ends.fill(tile, region, [&mut *hxx, hxy, hyy]);
                    }
                }
            }
        },
    );
    let [hxx, hxy, hyy] = planes.map(|values| {
        let mut plane = Plane::from_values(size, values).expect("one value per pixel");
        rims.continue_in(&mut plane);
        plane
    });
    Curvature { hxx, hxy, hyy }
}

/// What one thread reuses from tile to tile. Rows of it hold `STRIDE` pixels and begin one pixel
/// left of the tile.
struct TileScratch {
    /// One row of one channel with the kernel's reach at both sides.
    line: Vec<f32>,
    /// 1 where a pixel of the row is joined to the next; beyond the canvas, where values are 0, it
    /// does not matter: 1.
    joined: Vec<f32>,
    /// Blurred along rows: n̄_x, n̄_y, n_z with the kernel's reach above and below, a row every
    /// `PITCH`.
    across: [Vec<f32>; 3],
    /// 1 where a pixel is joined to the one below; rows as `across`.
    down: Vec<f32>,
    /// For each chunk of `down`, over how many rows up to and with this one all its pixels are
    /// joined downward.
    joined_rows: Vec<[usize; CHUNKS]>,
    /// Slopes, one pixel around the tile.
    slopes: [Vec<f32>; 2],
}

impl TileScratch {
    fn new(reach: usize) -> Self {
        let rows = BAND_ROWS + 2;
        Self {
            line: vec![0.0; STRIDE + 2 * reach],
            joined: vec![0.0; STRIDE + 2 * reach],
            across: std::array::from_fn(|_| vec![0.0; (rows + 2 * reach) * PITCH]),
            down: vec![0.0; (rows + 2 * reach) * PITCH],
            joined_rows: vec![[0; CHUNKS]; rows + 2 * reach],
            slopes: std::array::from_fn(|_| vec![0.0; rows * STRIDE]),
        }
    }

    fn tensor_tile(
        &mut self,
        surface: &Surface,
        taps: &[f32],
        tile: TileRect,
        mut out: [&mut [f32]; 3],
    ) {
        let reach = taps.len() - 1;
        for row in 0..tile.rows + 2 + 2 * reach {
            self.blur_row(surface, taps, tile, row);
        }
        let [sx, sy] = &mut self.slopes;
        for chunk in 0..tile.chunks() {
            // Taps step over the links of the rows from the topmost to the one above the lowest.
            let joined: Vec<bool> = (0..tile.rows + 2)
                .map(|row| {
                    self.joined_rows[(row + 2 * reach).saturating_sub(1)][chunk] >= 2 * reach
                })
                .collect();
            let columns =
                ColumnTaps { taps, across: &self.across, down: &self.down, joined: &joined };
            blur_down_to_slopes(columns, chunk * LANES, sx, sy);
        }
        let width = surface.size().width as usize;
        for y in 0..tile.rows {
            let links = &surface.links_plane().row(tile.y0 + y)[tile.columns()];
            let from = y * width + tile.x0;
            // The next row lies a map's width away.
            out.iter().for_each(|plane| {
                prefetch(plane.get(from + width..from + width + tile.cols).unwrap_or_default())
            });
            let [hxx, hxy, hyy] = out.each_mut().map(|plane| &mut plane[from..from + tile.cols]);
            let slopes = [&sx[y * STRIDE..(y + 3) * STRIDE], &sy[y * STRIDE..(y + 3) * STRIDE]];
            if are_all_linked(links) {
                difference_joined_row(slopes, hxx, hxy, hyy);
            } else {
                difference_row(slopes, links, hxx, hxy, hyy);
            }
        }
    }

    /// Blurs one row of the three channels along x; `row` counts from the top of `across`.
    fn blur_row(&mut self, surface: &Surface, taps: &[f32], tile: TileRect, row: usize) {
        let reach = taps.len() - 1;
        let at = row * PITCH..row * PITCH + STRIDE;
        let above = if row == 0 { [0; CHUNKS] } else { self.joined_rows[row - 1] };
        let y =
            (tile.y0 + row).checked_sub(1 + reach).filter(|&y| y < surface.size().height as usize);
        let Some(y) = y else {
            self.across.iter_mut().for_each(|c| c[at.clone()].fill(0.0));
            self.down[at].fill(1.0);
            self.joined_rows[row] = above.map(|rows| rows + 1);
            return;
        };
        let links = surface.links_plane().row(y);
        let first = tile.x0 as isize - 1 - reach as isize;
        let reached = first.max(0) as usize..(tile.x0 + tile.cols + 1 + reach).min(links.len());
        let mut joined_chunks = [true; CHUNKS];
        let mut joined_down = [true; CHUNKS];
        if are_all_linked(&links[reached]) {
            self.down[at.clone()].fill(1.0);
        } else {
            let last_row = y + 1 == surface.size().height as usize;
            let bit = |l: u8, bit: u8| f32::from(u8::from(l & bit != 0));
            copy_row(links, first, 1.0, &mut self.joined, |l| bit(l, links::RIGHT));
            // The canvas's border is no end of the surface: what lies beyond is left out, not
            // repeated.
            let last = (links.len() as isize - 1 - first) as usize;
            self.joined.get_mut(last).into_iter().for_each(|joined| *joined = 1.0);
            let down = |l: u8| if last_row { 1.0 } else { bit(l, links::DOWN) };
            copy_row(links, first + reach as isize, 1.0, &mut self.down[at.clone()], down);
            joined_chunks = std::array::from_fn(|i| {
                are_all_set(&self.joined[i * LANES..(i + 1) * LANES + 2 * reach])
            });
            joined_down =
                std::array::from_fn(|i| are_all_set(lanes(&self.down, at.start + i * LANES)));
        }
        self.joined_rows[row] =
            std::array::from_fn(|i| if joined_down[i] { above[i] + 1 } else { 0 });
        let reaching = STRIDE + 2 * reach;
        let ahead =
            |y: usize| usize::try_from(first).ok().filter(|_| y < surface.size().height as usize);
        for (plane, across) in surface.normal_planes().into_iter().zip(&mut self.across) {
            if let Some(first) = ahead(y + 2) {
                prefetch(plane.row(y + 2).get(first..first + reaching).unwrap_or_default());
            }
            let inside = usize::try_from(first)
                .ok()
                .and_then(|first| plane.row(y).get(first..first + reaching));
            let line = inside.unwrap_or_else(|| {
                copy_row(plane.row(y), first, 0.0, &mut self.line, |v| v);
                &self.line
            });
            let across = &mut across[at.clone()][..tile.chunks() * LANES];
            blur_line(line, &self.joined, joined_chunks, taps, across);
        }
    }
}

/// Copies `row[first..]` into `out`; what lies beyond the row's ends is `beyond`.
fn copy_row<T: Copy>(
    row: &[T],
    first: isize,
    beyond: f32,
    out: &mut [f32],
    value: impl Fn(T) -> f32,
) {
    let from = first.clamp(0, row.len() as isize);
    let to = (first + out.len() as isize).clamp(from, row.len() as isize);
    let before = ((from - first) as usize).min(out.len());
    out[..before].fill(beyond);
    let held = (to - from) as usize;
    for (o, &v) in out[before..before + held].iter_mut().zip(&row[from as usize..to as usize]) {
        *o = value(v);
    }
    out[before + held..].fill(beyond);
}

/// The `LANES` values that start at `i`.
#[inline(always)]
fn lanes(values: &[f32], i: usize) -> &[f32; LANES] {
    values[i..i + LANES].try_into().expect("a slice of LANES values")
}

/// Σ_k w_k value(± k steps) for the `LANES` pixels from `center` on, all joined.
#[inline(always)]
fn sum_joined(values: &[f32], center: usize, step: usize, taps: &[f32]) -> [f32; LANES] {
    let mut sum = *lanes(values, center);
    for v in &mut sum {
        *v *= taps[0];
    }
    for (k, &w) in taps.iter().enumerate().skip(1) {
        let (a, b) = (lanes(values, center - k * step), lanes(values, center + k * step));
        for l in 0..LANES {
            sum[l] += w * (a[l] + b[l]);
        }
    }
    sum
}

/// As [`sum_joined`]; beyond a broken link the last value before it is repeated.
#[inline(always)]
fn sum_broken(
    values: &[f32],
    joined: &[f32],
    center: usize,
    step: usize,
    taps: &[f32],
) -> [f32; LANES] {
    let mut sum = *lanes(values, center);
    for v in &mut sum {
        *v *= taps[0];
    }
    let (mut back, mut forth) = ([1.0f32; LANES], [1.0f32; LANES]);
    let (mut last_a, mut last_b) = (*lanes(values, center), *lanes(values, center));
    for (k, &w) in taps.iter().enumerate().skip(1) {
        let (a, b) = (center - k * step, center + k * step);
        let (to_a, to_b) = (lanes(joined, a), lanes(joined, b - step));
        let (a, b) = (lanes(values, a), lanes(values, b));
        for l in 0..LANES {
            back[l] *= to_a[l];
            forth[l] *= to_b[l];
            last_a[l] = if back[l] > 0.0 { a[l] } else { last_a[l] };
            last_b[l] = if forth[l] > 0.0 { b[l] } else { last_b[l] };
            sum[l] += w * (last_a[l] + last_b[l]);
        }
    }
    sum
}

/// What the blur down the columns of a chunk reads.
#[derive(Clone, Copy)]
struct ColumnTaps<'a> {
    taps: &'a [f32],
    across: &'a [Vec<f32>; 3],
    down: &'a [f32],
    /// Of each row: no link is missing where its taps reach.
    joined: &'a [bool],
}

crate::widest! {
    /// Every pixel continues into its four neighbors.
    pub(super) fn are_all_linked(links: &[u8]) -> bool {
        links.iter().fold(15, |all, &l| all & l) == 15
    }

    /// No joint is missing.
    fn are_all_set(joined: &[f32]) -> bool {
        joined.iter().fold(true, |all, &j| all & (j != 0.0))
    }

    /// Blurs a row; `line` and `joined` reach beyond it at both sides, `joined_chunks` says where
    /// nothing is broken.
    fn blur_line(line: &[f32], joined: &[f32], joined_chunks: [bool; CHUNKS], taps: &[f32], out: &mut [f32]) {
        let reach = taps.len() - 1;
        for (chunk, out) in out.chunks_exact_mut(LANES).enumerate() {
            let start = chunk * LANES;
            let sum = if joined_chunks[chunk] {
                sum_joined(line, start + reach, 1, taps)
            } else {
                sum_broken(line, joined, start + reach, 1, taps)
            };
            out.copy_from_slice(&sum);
        }
    }

    /// Blurs a chunk of all rows down the columns and takes their slopes. A chunk at a time, so
    /// that the rows that each pixel's taps read are still in the first-level cache from the row
    /// above.
    fn blur_down_to_slopes(columns: ColumnTaps, chunk: usize, sx: &mut [f32], sy: &mut [f32]) {
        let ColumnTaps { taps, across, down, joined } = columns;
        let reach = taps.len() - 1;
        let slopes = sx.chunks_exact_mut(STRIDE).zip(sy.chunks_exact_mut(STRIDE));
        for (row, ((sx, sy), &joined)) in slopes.zip(joined).enumerate() {
            let center = (row + reach) * PITCH + chunk;
            let mut normal = [[0.0f32; LANES]; 3];
            for (sum, across) in normal.iter_mut().zip(across) {
                *sum = if joined {
                    sum_joined(across, center, PITCH, taps)
                } else {
                    sum_broken(across, down, center, PITCH, taps)
                };
            }
            let (sx, sy) = (&mut sx[chunk..chunk + LANES], &mut sy[chunk..chunk + LANES]);
            for l in 0..LANES {
                (sx[l], sy[l]) = slope(normal[0][l], normal[1][l], normal[2][l]);
            }
        }
    }

    /// H of one row from the slopes of it and of its neighbors, every pixel having all its links.
    fn difference_joined_row(slopes: [&[f32]; 2], hxx: &mut [f32], hxy: &mut [f32], hyy: &mut [f32]) {
        let n = hxx.len();
        let (hxy, hyy) = (&mut hxy[..n], &mut hyy[..n]);
        let [up, here, down] = rows(slopes, n);
        for i in 0..n {
            let half = |s: &[&[f32]; 2], i: usize, t: &[&[f32]; 2], j: usize| {
                (0.5 * (t[0][j] - s[0][i]), 0.5 * (t[1][j] - s[1][i]))
            };
            [hxx[i], hxy[i], hyy[i]] = tensor(half(&here, i, &here, i + 2), half(&up, i + 1, &down, i + 1));
        }
    }

    /// As [`difference_joined_row`]: central where both neighbors are linked, one-sided where one
    /// is.
    fn difference_row(slopes: [&[f32]; 2], links: &[u8], hxx: &mut [f32], hxy: &mut [f32], hyy: &mut [f32]) {
        let n = links.len();
        let (hxx, hxy, hyy) = (&mut hxx[..n], &mut hxy[..n], &mut hyy[..n]);
        let [above, here, below] = rows(slopes, n);
        for i in 0..n {
            let linked = |bit: u8| f32::from(u8::from(links[i] & bit != 0));
            let (left, right) = (linked(links::LEFT), linked(links::RIGHT));
            let (up, down) = (linked(links::UP), linked(links::DOWN));
            // 1 over the number of links, where there are any.
            let (across, along) = (1.0 - 0.5 * left * right, 1.0 - 0.5 * up * down);
            let dx = |c: usize| {
                let [a, b, e] = [here[c][i], here[c][i + 1], here[c][i + 2]];
                across * (left * (b - a) + right * (e - b))
            };
            let dy = |c: usize| {
                let [a, b, e] = [above[c][i + 1], here[c][i + 1], below[c][i + 1]];
                along * (up * (b - a) + down * (e - b))
            };
            [hxx[i], hxy[i], hyy[i]] = tensor((dx(0), dx(1)), (dy(0), dy(1)));
        }
    }
}

/// The row above, the row itself and the row below of both slopes, each `n + 2` pixels from one
/// left of the tile.
#[inline(always)]
fn rows(slopes: [&[f32]; 2], n: usize) -> [[&[f32]; 2]; 3] {
    [0, STRIDE, 2 * STRIDE].map(|r| slopes.map(|s| &s[r..r + n + 2]))
}
