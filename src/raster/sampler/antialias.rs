//! Antialiasing: the mean of a texture over the piece of the image plane that a pixel covers.
//! Floor 1. Not here: where that piece lies (`surface`, `paint`).
//!
//! The piece is a curved quadrilateral: the pixel's four half-edges are differenced apart, because on real maps (8 bits,
//! fine detail) the two sides of a pixel often stretch differently, and a single ellipse then misses a third of the error
//! (docs/OPERATORS.md has the figures). A grid of bilinear taps covers it, each standing for a cell of about two texels of
//! the mip level, which is the coarsest that the taps can still resolve.

use super::taps::{Positions, Run, Taps};
use crate::raster::{Outside, Texture};

/// The piece of the image plane under each pixel of a row, in texels of level 0.
#[derive(Clone, Copy)]
pub struct PatchRow<'a> {
    /// The image of the pixel's centre.
    pub x: &'a [f32],
    pub y: &'a [f32],
    /// From there to the image of the middle of the left, right, upper and lower edge of the pixel: `[x, y]` each.
    pub edges: [[&'a [f32]; 2]; 4],
}

/// Side of the cell that one tap stands for, in texels of level 0. A picture drawn pixel for pixel (1 texel) stays as it is.
const FINE_CELL: f32 = 1.5;
/// The same in the other levels, whose texels are means already: there a bilinear tap's variance s²/4 − 1/12 is that of a
/// box of 1.7 texels.
const COARSE_CELL: f32 = 2.0;
/// Most taps a pixel may take, in all.
const MAX_TAPS: u32 = 16;
/// Pixels in flight.
const SPAN: usize = 64;

impl<'a> PatchRow<'a> {
    fn part(self, from: usize, n: usize) -> Self {
        let cut = |v: &'a [f32]| &v[from..from + n];
        Self { x: cut(self.x), y: cut(self.y), edges: self.edges.map(|edge| edge.map(cut)) }
    }
}

/// Scratch for antialiasing, kept from row to row.
pub struct Antialias {
    x: Vec<f32>,
    y: Vec<f32>,
    runs: Vec<Run>,
    taps: Taps,
}

/// As many taps as a patch may have are written at once; the surplus is written over by the next.
const LANES: usize = MAX_TAPS as usize;

impl Default for Antialias {
    fn default() -> Self {
        let room = vec![0.0; SPAN * LANES + LANES];
        Self { x: room.clone(), y: room, runs: Vec::with_capacity(SPAN), taps: Taps::default() }
    }
}

impl Antialias {
    /// The picture's premultiplied bytes, averaged over each patch and rounded: one pixel of `out` each.
    pub fn row(&mut self, texture: &Texture, patches: PatchRow, outside: Outside, out: &mut [[u8; 4]]) {
        for from in (0..out.len()).step_by(SPAN) {
            let n = (out.len() - from).min(SPAN);
            self.span(texture, patches.part(from, n), outside, &mut out[from..from + n]);
        }
    }
    fn span(&mut self, texture: &Texture, patches: PatchRow, outside: Outside, out: &mut [[u8; 4]]) {
        let n = out.len();
        let mut grids = [Grid::ONE; SPAN];
        let grids = &mut grids[..n];
        choose_grids(patches, texture.levels().len() as u32 - 1, grids);
        if grids.iter().all(|&grid| grid == Grid::ONE) {
            // The common case of a picture that is not shrunk, three times as fast.
            let (x, y) = (&mut self.x[..n], &mut self.y[..n]);
            middles(patches, x, y);
            let at = Positions { level: &texture.levels()[0], x, y, outside };
            self.taps.find(at);
            return self.taps.means(at, &Run::ONE_EACH[..n], out);
        }
        let levels = grids.iter().fold((u32::MAX, 0), |(a, b), g| (a.min(g.level), b.max(g.level)));
        for index in levels.0..=levels.1 {
            let level = &texture.levels()[index as usize];
            let scale = [
                level.size.width as f32 / texture.size().width as f32,
                level.size.height as f32 / texture.size().height as f32,
            ];
            self.runs.clear();
            let len = place_taps(patches, grids, index, scale, &mut self.x, &mut self.y, &mut self.runs);
            let at = Positions { level, x: &self.x[..len], y: &self.y[..len], outside };
            self.taps.find(at);
            self.taps.means(at, &self.runs, out);
        }
    }
}

/// How a patch is covered: so many taps across and along, in a mip level.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Grid {
    across: u32,
    along: u32,
    level: u32,
}

impl Grid {
    const ONE: Grid = Grid { across: 1, along: 1, level: 0 };

    /// For a patch that takes so many fine or coarse cells across and along in level 0.
    #[inline(always)]
    fn of_cells(fine: [u32; 2], coarse: [u32; 2], last_level: u32) -> Self {
        let [across, along] = fine;
        if across * along <= MAX_TAPS || last_level == 0 {
            return Self { across, along, level: 0 }.capped();
        }
        let mut grid = Self { across: coarse[0], along: coarse[1], level: 0 };
        while grid.across * grid.along > MAX_TAPS && grid.level < last_level {
            grid = Self { across: grid.across.div_ceil(2), along: grid.along.div_ceil(2), level: grid.level + 1 };
        }
        grid.capped()
    }
    #[inline(always)]
    fn taps(self) -> usize {
        (self.across * self.along) as usize
    }
    #[inline(always)]
    fn capped(self) -> Self {
        let across = self.across.min(MAX_TAPS);
        Self { across, along: self.along.min(MAX_TAPS / across), ..self }
    }
}

/// Sides longer than this many cells are cut: the product of two must fit.
const MAX_CELLS: f32 = 32768.0;

/// How many cells of a size a side takes, at least 1.
#[inline(always)]
fn cells(side: f32, cell: f32) -> u32 {
    // Adding 2²³ rounds to the nearest integer and leaves it in the low bits; half a cell less than that rounds up.
    let nearest = (side * (1.0 / cell) + 0.4999).max(1.0).min(MAX_CELLS) + 8_388_608.0;
    nearest.to_bits() - 8_388_608.0f32.to_bits()
}

crate::widest! {
    /// The grid of every patch. A side is twice the longer of its two half-edges.
    fn choose_grids(patches: PatchRow, last_level: u32, grids: &mut [Grid]) {
        let n = grids.len().min(SPAN);
        let mut fine = [[1u32; SPAN]; 2];
        let mut coarse = [[1u32; SPAN]; 2];
        for side in 0..2 {
            let [[ax, ay], [bx, by]] = [patches.edges[2 * side], patches.edges[2 * side + 1]].map(|e| e.map(|v| &v[..n]));
            for k in 0..n {
                let (a, b) = (ax[k] * ax[k] + ay[k] * ay[k], bx[k] * bx[k] + by[k] * by[k]);
                let length = 2.0 * a.max(b).sqrt();
                fine[side][k] = cells(length, FINE_CELL);
                coarse[side][k] = cells(length, COARSE_CELL);
            }
        }
        for (k, grid) in grids.iter_mut().enumerate() {
            *grid = Grid::of_cells([fine[0][k], fine[1][k]], [coarse[0][k], coarse[1][k]], last_level);
        }
    }
    /// The mean position of every patch: where its single tap stands.
    fn middles(patches: PatchRow, x: &mut [f32], y: &mut [f32]) {
        let n = x.len();
        let [left, right, up, down] = patches.edges;
        for (axis, (center, out)) in [(patches.x, x), (patches.y, y)].into_iter().enumerate() {
            let (center, out) = (&center[..n], &mut out[..n]);
            let (left, right, up, down) = (&left[axis][..n], &right[axis][..n], &up[axis][..n], &down[axis][..n]);
            for k in 0..n {
                out[k] = center[k] + ((left[k] + right[k]) * 0.25 + (up[k] + down[k]) * 0.25);
            }
        }
    }
    /// Places the taps of the patches that read level `index`, whose texels are `scale` of level 0's, one patch after the
    /// other; how many they are. `x`, `y` have room for all taps and [`LANES`] more.
    fn place_taps(
        patches: PatchRow,
        grids: &[Grid],
        index: u32,
        scale: [f32; 2],
        x: &mut [f32],
        y: &mut [f32],
        runs: &mut Vec<Run>,
    ) -> usize {
        let mut len = 0;
        let n = grids.len();
        let [left, right, up, down] = patches.edges;
        for (axis, out) in [x, y].into_iter().enumerate() {
            let (center, scale) = (&[patches.x, patches.y][axis][..n], scale[axis]);
            let (left, right, up, down) = (&left[axis][..n], &right[axis][..n], &up[axis][..n], &down[axis][..n]);
            len = 0;
            for (k, grid) in grids.iter().enumerate() {
                let Some(out) = out.get_mut(len..).and_then(|out| out.first_chunk_mut()) else { break };
                if grid.level == index {
                    let count = grid.taps();
                    let edges = [left[k], right[k], up[k], down[k]];
                    spread(&LATTICES[grid.across as usize][grid.along as usize], center[k], edges, scale, count, out);
                    len += count;
                }
            }
        }
        let of_level = grids.iter().enumerate().filter(|(_, grid)| grid.level == index);
        runs.extend(of_level.map(|(k, grid)| Run { pixel: k as u16, count: grid.taps() as u16 }));
        len
    }
}

/// One coordinate of a patch's taps, eight at a time.
#[inline(always)]
fn spread(
    lattice: &Lattice,
    center: f32,
    [left, right, up, down]: [f32; 4],
    scale: f32,
    count: usize,
    out: &mut [f32; LANES],
) {
    let [a, b, c, d] = lattice;
    for from in [0, 8] {
        if from < count {
            for i in from..from + 8 {
                out[i] = (center + (a[i] * left + b[i] * right) + (c[i] * up + d[i] * down)) * scale;
            }
        }
    }
}

/// How far each tap of a grid goes along the left, right, upper and lower half-edge, 0 … 1; row by row.
type Lattice = [[f32; LANES]; 4];

/// The lattice of every grid, by taps across and along.
static LATTICES: [[Lattice; LANES + 1]; LANES + 1] = {
    let mut lattices = [[[[0.0; LANES]; 4]; LANES + 1]; LANES + 1];
    let mut across = 1;
    while across <= LANES {
        let mut along = 1;
        while across * along <= LANES {
            let mut i = 0;
            while i < across * along {
                let (u, v) = (i % across, i / across);
                let steps = [BEFORE[across][u], AFTER[across][u], BEFORE[along][v], AFTER[along][v]];
                let mut side = 0;
                while side < 4 {
                    lattices[across][along][side][i] = steps[side];
                    side += 1;
                }
                i += 1;
            }
            along += 1;
        }
        across += 1;
    }
    lattices
};

/// For a row of n taps, how far each goes along the half-edge before the middle, 0 … 1. A single tap stands at the middle of
/// both half-edges, the mean of a patch whose two sides differ.
const BEFORE: [[f32; LANES]; LANES + 1] = steps(-1.0);
/// The same along the half-edge after the middle.
const AFTER: [[f32; LANES]; LANES + 1] = steps(1.0);

const fn steps(sign: f32) -> [[f32; LANES]; LANES + 1] {
    let mut steps = [[0.0; LANES]; LANES + 1];
    steps[1][0] = 0.25;
    let mut n = 2;
    while n <= LANES {
        let mut i = 0;
        while i < n {
            // −1 at the first edge, 1 at the second.
            let u = ((2 * i + 1) as f32 / n as f32 - 1.0) * sign;
            steps[n][i] = if u > 0.0 { u } else { 0.0 };
            i += 1;
        }
        n += 1;
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec2};
    use crate::raster::{Picture, sampler};

    fn stripes(size: Size, period: usize) -> Texture {
        let texel = |i: usize| if (i % size.width as usize) % period < period / 2 { [255; 4] } else { [0, 0, 0, 255] };
        Texture::new(&Picture::srgb8(size, (0..size.area()).map(texel).collect()).unwrap())
    }
    /// One patch of the sides given, straight.
    fn patch(texture: &Texture, at: [f32; 2], across: f32, along: f32) -> [u8; 4] {
        let [x, y] = at.map(|v| [v]);
        let half = |v: f32| [v / 2.0];
        let (a, b, zero) = (half(across), half(along), [0.0]);
        let (minus_a, minus_b) = (half(-across), half(-along));
        let edges = [[&minus_a[..], &zero], [&a, &zero], [&zero, &minus_b], [&zero, &b]];
        let mut out = [[0; 4]];
        Antialias::default().row(texture, PatchRow { x: &x, y: &y, edges }, Outside::Repeat, &mut out);
        out[0]
    }

    #[test]
    fn stripes_finer_than_a_pixel_become_their_mean() {
        let texture = stripes(Size::new(256, 256), 2);
        for across in [8.0, 20.0, 61.0, 300.0, 5000.0] {
            for x in [10.0, 11.3, 12.0] {
                let [r, ..] = patch(&texture, [x, 100.0], across, 3.0);
                assert!(r.abs_diff(128) < 20, "{across} texels across at {x}: {r}");
            }
        }
    }
    #[test]
    fn a_patch_within_a_texel_is_one_bilinear_tap() {
        let texture = stripes(Size::new(64, 64), 8);
        for x in [7.3, 8.0, 8.4, 20.5] {
            let tap = sampler::bilinear(&texture, vec2(x, 30.0), Outside::Repeat);
            assert!((f32::from(patch(&texture, [x, 30.0], 1.0, 0.2)[0]) - tap[0] * 255.0).abs() <= 0.501);
        }
    }
    #[test]
    fn a_patch_stretched_along_the_stripes_keeps_them_sharp() {
        let texture = stripes(Size::new(256, 256), 16);
        assert_eq!(patch(&texture, [20.0, 100.0], 1.0, 60.0)[0], 255, "the middle of a white stripe");
        assert_eq!(patch(&texture, [28.0, 100.0], 1.0, 60.0)[0], 0, "the middle of a black one");
    }
    #[test]
    fn grids_spend_no_more_taps_than_allowed_and_hold_every_side() {
        let grid = |across: f32, along: f32| {
            Grid::of_cells(
                [across, along].map(|side| cells(side, FINE_CELL)),
                [across, along].map(|side| cells(side, COARSE_CELL)),
                9,
            )
        };
        for across in [0.0, 0.9, 2.0, 7.0, 33.0, 1e9, f32::INFINITY, f32::NAN] {
            for along in [0.0, 1.6, 5.0, 40.0, f32::INFINITY, f32::NAN] {
                let grid = grid(across, along);
                assert!((1..=MAX_TAPS).contains(&(grid.across * grid.along)), "{across} × {along}: {grid:?}");
                assert!(grid.level <= 9);
            }
        }
        assert_eq!(grid(6.0, 1.0), Grid { across: 4, along: 1, level: 0 });
        assert_eq!(grid(16.0, 16.0), Grid { across: 4, along: 4, level: 1 });
    }
}
