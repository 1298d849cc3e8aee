//! The curvature tensor of a whole map, tile by tile: blur, slopes and differences while the tile is in the cache.
//! Floor 2. The plain version that reads like the paper is `reference`.

use super::{Curvature, fade, slope, tensor};
use crate::raster::Plane;
use crate::surface::{Surface, links};
use rayon::prelude::*;

/// Columns of a tile's scratch: the tile and one pixel around it for the differences.
const STRIDE: usize = 256;
const TILE_COLS: usize = STRIDE - 2;
/// Rows of a band: enough that the rows blurred twice, for two bands, are few.
const BAND_ROWS: usize = 64;
/// Pixels summed side by side in registers.
const LANES: usize = 32;

/// Computes H and its fade for every pixel. `blur_px`: standard deviation, finite, `≥ 0`.
pub(super) fn compute(surface: &Surface, blur_px: f32) -> Curvature {
    let size = surface.size();
    let width = size.width as usize;
    let taps = half_kernel(blur_px);
    let mut planes: [Vec<f32>; 4] = std::array::from_fn(|_| vec![0.0; size.area()]);
    let [hxx, hxy, hyy, fading] = &mut planes;
    let band = BAND_ROWS * width;
    let bands =
        (hxx.par_chunks_mut(band), hxy.par_chunks_mut(band), hyy.par_chunks_mut(band), fading.par_chunks_mut(band));
    bands.into_par_iter().enumerate().for_each_init(
        || Scratch::new(taps.len() - 1),
        |scratch, (i, (hxx, hxy, hyy, fading))| {
            let y0 = i * BAND_ROWS;
            let rows = fading.len() / width;
            for x0 in (0..width).step_by(TILE_COLS) {
                let tile = TileRect { x0, y0, cols: TILE_COLS.min(width - x0), rows };
                let Some(whole) = tile.wholeness(surface.links_plane(), taps.len() + 1) else { continue };
                let mut out = TileOut { width, x0, planes: [&mut *hxx, &mut *hxy, &mut *hyy] };
                scratch.tensor_tile(surface, &taps, tile, whole, &mut out);
                fade::fill(surface, tile, whole, &mut fading[..]);
            }
        },
    );
    let [hxx, hxy, hyy, fade] = planes.map(|v| Plane::from_values(size, v).expect("one value per pixel"));
    Curvature { hxx, hxy, hyy, fade }
}

/// The weights of a Gaussian at distances 0, 1, …; with their mirror image they add up to 1.
///
/// Cut at four standard deviations (6e-5 of the weight lies beyond).
pub(super) fn half_kernel(sigma_px: f32) -> Vec<f32> {
    let radius = (4.0 * sigma_px).ceil() as usize;
    let weight = |k: usize| if k == 0 { 1.0 } else { (-0.5 * (k as f64 / f64::from(sigma_px)).powi(2)).exp() };
    let sum: f64 = 1.0 + 2.0 * (1..=radius).map(weight).sum::<f64>();
    (0..=radius).map(|k| (weight(k) / sum) as f32).collect()
}

/// Whether some surface of a tile ends in or near it.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Whole {
    Yes,
    Broken,
}

/// The pixels of one tile.
#[derive(Clone, Copy)]
pub(super) struct TileRect {
    pub x0: usize,
    pub y0: usize,
    pub cols: usize,
    pub rows: usize,
}

impl TileRect {
    /// `None` where the tile holds no linked pixel; `Whole::Yes` where every pixel in it and `reach` around it has all links.
    fn wholeness(&self, links: &Plane<u8>, reach: usize) -> Option<Whole> {
        let columns = |reach: usize| self.x0.saturating_sub(reach)..(self.x0 + self.cols + reach).min(links.width());
        let mut any = 0;
        for y in self.y0..self.y0 + self.rows {
            any |= links.row(y)[columns(0)].iter().fold(0, |a, &b| a | b);
        }
        if any == 0 {
            return None;
        }
        let mut all = 15;
        for y in self.y0.saturating_sub(reach)..(self.y0 + self.rows + reach).min(links.height()) {
            all &= links.row(y)[columns(reach)].iter().fold(15, |a, &b| a & b);
        }
        Some(if all == 15 { Whole::Yes } else { Whole::Broken })
    }
}

/// Where a tile's tensor goes: a band's rows of `[h_xx, h_xy, h_yy]`.
struct TileOut<'a> {
    width: usize,
    x0: usize,
    planes: [&'a mut [f32]; 3],
}

/// What one thread reuses from tile to tile.
struct Scratch {
    /// One row of one channel with the kernel's reach at both sides.
    line: Vec<f32>,
    /// 1 where a pixel of the row is linked to the next.
    joined: Vec<f32>,
    /// Blurred along rows: n̄_x, n̄_y, n_z with the kernel's reach above and below.
    across: [Vec<f32>; 3],
    /// 1 where a pixel is linked to the one below; rows as `across`.
    down: Vec<f32>,
    /// Slopes, one pixel around the tile.
    slopes: [Vec<f32>; 2],
}

impl Scratch {
    fn new(reach: usize) -> Self {
        let rows = BAND_ROWS + 2;
        Self {
            line: vec![0.0; STRIDE + 2 * reach],
            joined: vec![0.0; STRIDE + 2 * reach],
            across: std::array::from_fn(|_| vec![0.0; (rows + 2 * reach) * STRIDE]),
            down: vec![0.0; (rows + 2 * reach) * STRIDE],
            slopes: std::array::from_fn(|_| vec![0.0; rows * STRIDE]),
        }
    }

    fn tensor_tile(&mut self, surface: &Surface, taps: &[f32], tile: TileRect, whole: Whole, out: &mut TileOut) {
        let reach = taps.len() - 1;
        for row in 0..tile.rows + 2 + 2 * reach {
            self.blur_row(surface, taps, tile, whole, row);
        }
        let [sx, sy] = &mut self.slopes;
        let columns = Columns { taps, across: &self.across, down: &self.down };
        match whole {
            Whole::Yes => slopes_whole(&columns, tile.rows + 2, sx, sy),
            Whole::Broken => slopes_broken(&columns, tile.rows + 2, sx, sy),
        }
        for y in 0..tile.rows {
            let from = y * out.width + out.x0;
            let [hxx, hxy, hyy] = &mut out.planes;
            difference_row(
                DifferenceRow {
                    sx: &sx[y * STRIDE..],
                    sy: &sy[y * STRIDE..],
                    links: &surface.links_plane().row(tile.y0 + y)[tile.x0..tile.x0 + tile.cols],
                },
                &mut hxx[from..from + tile.cols],
                &mut hxy[from..from + tile.cols],
                &mut hyy[from..from + tile.cols],
            );
        }
    }

    /// Blurs one row of the three channels along x; `row` counts from the top of `across`.
    fn blur_row(&mut self, surface: &Surface, taps: &[f32], tile: TileRect, whole: Whole, row: usize) {
        let reach = taps.len() - 1;
        let y = (tile.y0 + row) as isize - 1 - reach as isize;
        let at = row * STRIDE..(row + 1) * STRIDE;
        if y < 0 || y >= surface.size().height as isize {
            self.across.iter_mut().for_each(|c| c[at.clone()].fill(0.0));
            self.down[at].fill(0.0);
            return;
        }
        let y = y as usize;
        let first = tile.x0 as isize - 1 - reach as isize;
        if whole == Whole::Broken {
            let links = surface.links_plane().row(y);
            copy_row(links, first, &mut self.joined, |l| f32::from(u8::from(l & links::RIGHT != 0)));
            copy_row(links, first + reach as isize, &mut self.down[at.clone()], |l| {
                f32::from(u8::from(l & links::DOWN != 0))
            });
        }
        for (plane, across) in surface.normal_planes().into_iter().zip(&mut self.across) {
            copy_row(plane.row(y), first, &mut self.line, |v| v);
            match whole {
                Whole::Yes => blur_line_whole(&self.line, taps, &mut across[at.clone()]),
                Whole::Broken => blur_line_broken(&self.line, &self.joined, taps, &mut across[at.clone()]),
            }
        }
    }
}

/// Copies `row[first..]` into `out`, 0 beyond the row's ends.
fn copy_row<T: Copy>(row: &[T], first: isize, out: &mut [f32], value: impl Fn(T) -> f32) {
    let from = first.clamp(0, row.len() as isize);
    let to = (first + out.len() as isize).clamp(from, row.len() as isize);
    let before = ((from - first) as usize).min(out.len());
    out[..before].fill(0.0);
    let held = (to - from) as usize;
    for (o, &v) in out[before..before + held].iter_mut().zip(&row[from as usize..to as usize]) {
        *o = value(v);
    }
    out[before + held..].fill(0.0);
}

/// The `LANES` values that start at `i`.
#[inline(always)]
fn lanes(values: &[f32], i: usize) -> &[f32; LANES] {
    values[i..i + LANES].try_into().expect("a slice of LANES values")
}

crate::widest! {
    /// Σ_k w_k line[x ± k], every pixel linked.
    fn blur_line_whole(line: &[f32], taps: &[f32], out: &mut [f32]) {
        let reach = taps.len() - 1;
        for (chunk, out) in out.chunks_exact_mut(LANES).enumerate() {
            let center = chunk * LANES + reach;
            let mut sum = lanes(line, center).map(|v| taps[0] * v);
            for (k, &w) in taps.iter().enumerate().skip(1) {
                let (a, b) = (lanes(line, center - k), lanes(line, center + k));
                for i in 0..LANES {
                    sum[i] += w * (a[i] + b[i]);
                }
            }
            out.copy_from_slice(&sum);
        }
    }

    /// As [`blur_line_whole`]; a weight dies at the first link that is broken on the way.
    fn blur_line_broken(line: &[f32], joined: &[f32], taps: &[f32], out: &mut [f32]) {
        let reach = taps.len() - 1;
        for (chunk, out) in out.chunks_exact_mut(LANES).enumerate() {
            let center = chunk * LANES + reach;
            let mut sum = lanes(line, center).map(|v| taps[0] * v);
            let (mut left, mut right) = ([1.0f32; LANES], [1.0f32; LANES]);
            for (k, &w) in taps.iter().enumerate().skip(1) {
                let (a, b) = (lanes(line, center - k), lanes(line, center + k));
                let (to_a, to_b) = (lanes(joined, center - k), lanes(joined, center + k - 1));
                for i in 0..LANES {
                    left[i] *= to_a[i];
                    right[i] *= to_b[i];
                    sum[i] += w * (left[i] * a[i] + right[i] * b[i]);
                }
            }
            out.copy_from_slice(&sum);
        }
    }

    /// Blurs down the columns and takes the slopes, every pixel linked.
    fn slopes_whole(columns: &Columns, rows: usize, sx: &mut [f32], sy: &mut [f32]) {
        let reach = columns.taps.len() - 1;
        for i in (0..rows * STRIDE).step_by(LANES) {
            let center = i + reach * STRIDE;
            let sum = std::array::from_fn(|c| {
                let across = &columns.across[c];
                let mut sum = lanes(across, center).map(|v| columns.taps[0] * v);
                for (k, &w) in columns.taps.iter().enumerate().skip(1) {
                    let (a, b) = (lanes(across, center - k * STRIDE), lanes(across, center + k * STRIDE));
                    for l in 0..LANES {
                        sum[l] += w * (a[l] + b[l]);
                    }
                }
                sum
            });
            store_slopes(&sum, &mut sx[i..i + LANES], &mut sy[i..i + LANES]);
        }
    }

    /// As [`slopes_whole`]; a weight dies at the first link that is broken on the way.
    fn slopes_broken(columns: &Columns, rows: usize, sx: &mut [f32], sy: &mut [f32]) {
        let reach = columns.taps.len() - 1;
        for i in (0..rows * STRIDE).step_by(LANES) {
            let center = i + reach * STRIDE;
            let mut sum: [[f32; LANES]; 3] =
                std::array::from_fn(|c| lanes(&columns.across[c], center).map(|v| columns.taps[0] * v));
            let (mut up, mut down) = ([1.0f32; LANES], [1.0f32; LANES]);
            for (k, &w) in columns.taps.iter().enumerate().skip(1) {
                let (a, b) = (center - k * STRIDE, center + k * STRIDE);
                let (to_a, to_b) = (lanes(columns.down, a), lanes(columns.down, b - STRIDE));
                for l in 0..LANES {
                    up[l] *= to_a[l];
                    down[l] *= to_b[l];
                }
                for (sum, across) in sum.iter_mut().zip(columns.across) {
                    let (a, b) = (lanes(across, a), lanes(across, b));
                    for l in 0..LANES {
                        sum[l] += w * (up[l] * a[l] + down[l] * b[l]);
                    }
                }
            }
            store_slopes(&sum, &mut sx[i..i + LANES], &mut sy[i..i + LANES]);
        }
    }

    /// H of one row of the tile from the slopes around it.
    fn difference_row(row: DifferenceRow, hxx: &mut [f32], hxy: &mut [f32], hyy: &mut [f32]) {
        let DifferenceRow { sx, sy, links } = row;
        let n = links.len();
        let (sx, sy) = (&sx[..2 * STRIDE + n + 2], &sy[..2 * STRIDE + n + 2]);
        let (hxx, hxy, hyy) = (&mut hxx[..n], &mut hxy[..n], &mut hyy[..n]);
        for i in 0..n {
            let linked = |bit: u8| f32::from(u8::from(links[i] & bit != 0));
            let (left, right) = (linked(links::LEFT), linked(links::RIGHT));
            let (up, down) = (linked(links::UP), linked(links::DOWN));
            let (across, along) = (1.0 / (left + right).max(1.0), 1.0 / (up + down).max(1.0));
            let c = STRIDE + 1 + i;
            let dx = |s: &[f32]| across * (left * (s[c] - s[c - 1]) + right * (s[c + 1] - s[c]));
            let dy = |s: &[f32]| along * (up * (s[c] - s[c - STRIDE]) + down * (s[c + STRIDE] - s[c]));
            let h = tensor((dx(sx), dx(sy)), (dy(sx), dy(sy)));
            hxx[i] = h[0];
            hxy[i] = h[1];
            hyy[i] = h[2];
        }
    }
}

/// What the blur down the columns reads.
struct Columns<'a> {
    taps: &'a [f32],
    across: &'a [Vec<f32>; 3],
    down: &'a [f32],
}

/// What the differences of one row read: slopes from the row above on, and the links of its pixels.
#[derive(Clone, Copy)]
struct DifferenceRow<'a> {
    sx: &'a [f32],
    sy: &'a [f32],
    links: &'a [u8],
}

#[inline(always)]
fn store_slopes(normal: &[[f32; LANES]; 3], sx: &mut [f32], sy: &mut [f32]) {
    for l in 0..LANES {
        (sx[l], sy[l]) = slope(normal[0][l], normal[1][l], normal[2][l]);
    }
}
