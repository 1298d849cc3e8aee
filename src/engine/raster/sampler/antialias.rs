//! Antialiasing: the mean of a texture over the piece of the image plane that a pixel covers.
//! Floor 1. Not here: where that piece lies (`surface`, `paint`).
//!
//! The piece is a curved quadrilateral: each of the pixel's four half-edges is differenced
//! separately, because on real maps (8 bits, fine detail) the two sides of a pixel often stretch
//! differently, and a single ellipse then misses a third of the error (docs/OPERATORS.md has the
//! figures). A grid of bilinear taps covers it, each for a cell of about two texels of the mip
//! level, which is the coarsest that the taps can still resolve.
//!
//! Eight neighbors whose patches are alike share a grid, and their taps are placed and read
//! together; a pixel unlike its neighbors (a crease, a silhouette) has its own grid and is read
//! alone.

mod grid;
mod lattice;

use super::taps::{GROUP, TapGroup, TapPositions, TapRun, Taps};
use crate::raster::{Outside, Texture};
pub use grid::TapRule;
use grid::{CellCounts, TapGrid};
use lattice::{LANES, TapLattice};

/// The piece of the image plane under each pixel of a row, in texels of level 0.
#[derive(Clone, Copy)]
pub struct PatchRow<'a> {
    /// The image of the pixel's center.
    pub x: &'a [f32],
    /// The second coordinates.
    pub y: &'a [f32],
    /// From there to the image of the middle of the left, right, upper and lower edge of the pixel:
    /// `[x, y]` each.
    pub edges: [[&'a [f32]; 2]; 4],
}

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
    cells: CellCounts,
    /// Neighbors that share a grid.
    groups: Vec<(TapGroup, TapGrid)>,
    /// Pixels that do not.
    lone: Vec<(u16, TapGrid)>,
    placed: Vec<TapGroup>,
    runs: Vec<TapRun>,
    taps: Taps,
}

impl Default for Antialias {
    fn default() -> Self {
        // As many taps as a patch may have are written at once; the surplus is overwritten by the
        // next.
        let room = vec![0.0; SPAN * LANES + LANES];
        Self {
            x: room.clone(),
            y: room,
            cells: CellCounts::default(),
            groups: Vec::with_capacity(SPAN / GROUP),
            lone: Vec::with_capacity(SPAN),
            placed: Vec::with_capacity(SPAN / GROUP),
            runs: Vec::with_capacity(SPAN),
            taps: Taps::default(),
        }
    }
}

impl Antialias {
    /// The picture's premultiplied bytes, averaged over each patch and rounded: one pixel of `out`
    /// for each.
    pub fn row(
        &mut self,
        texture: &Texture,
        patches: PatchRow,
        outside: Outside,
        out: &mut [[u8; 4]],
    ) {
        self.row_by(TapRule::AT_REST, texture, patches, outside, out);
    }

    /// The same, covered as closely as a rule demands.
    pub fn row_by(
        &mut self,
        rule: TapRule,
        texture: &Texture,
        patches: PatchRow,
        outside: Outside,
        out: &mut [[u8; 4]],
    ) {
        for from in (0..out.len()).step_by(SPAN) {
            let n = (out.len() - from).min(SPAN);
            self.cells.count(patches.part(from, n), n, rule);
            self.span(texture, patches.part(from, n), outside, &mut out[from..from + n]);
        }
    }

    /// A span whose cells are counted.
    fn span(
        &mut self,
        texture: &Texture,
        patches: PatchRow,
        outside: Outside,
        out: &mut [[u8; 4]],
    ) {
        if self.cells.are_single() {
            let (x, y) = (&mut self.x[..out.len()], &mut self.y[..out.len()]);
            place_singles(patches, x, y);
            let at = TapPositions { level: &texture.levels()[0], x, y, outside };
            self.taps.find(at);
            return self.taps.singles(at, out);
        }
        self.choose_grids(out.len(), texture.levels().len() as u32 - 1);
        let levels = self
            .groups
            .iter()
            .map(|(_, grid)| grid.level)
            .chain(self.lone.iter().map(|(_, grid)| grid.level));
        let (first, last) =
            levels.fold((u32::MAX, 0), |(a, b), level| (a.min(level), b.max(level)));
        for index in first..=last {
            let level = &texture.levels()[index as usize];
            let scale = [
                level.size.width as f32 / texture.size().width as f32,
                level.size.height as f32 / texture.size().height as f32,
            ];
            self.placed.clear();
            let len = place_groups(
                patches,
                &self.groups,
                index,
                scale,
                &mut self.x,
                &mut self.y,
                &mut self.placed,
            );
            if len > 0 {
                let at = TapPositions { level, x: &self.x[..len], y: &self.y[..len], outside };
                self.taps.find(at);
                self.taps.group_means(at, &self.placed, out);
            }
            self.runs.clear();
            let len = place_lone(
                patches,
                &self.lone,
                index,
                scale,
                &mut self.x,
                &mut self.y,
                &mut self.runs,
            );
            if len > 0 {
                let at = TapPositions { level, x: &self.x[..len], y: &self.y[..len], outside };
                self.taps.find(at);
                self.taps.means(at, &self.runs, out);
            }
        }
    }

    /// Reports each patch's number, its mip level and its taps, in texels of level 0; in any order.
    pub(super) fn for_each_grid(
        &mut self,
        patches: PatchRow,
        n: usize,
        last_level: u32,
        mut tell: impl FnMut(usize, u32, &[[f32; 2]]),
    ) {
        for from in (0..n).step_by(SPAN) {
            let len = (n - from).min(SPAN);
            let part = patches.part(from, len);
            self.cells.count(part, len, TapRule::AT_REST);
            self.choose_grids(len, last_level);
            let in_groups = self.groups.iter().flat_map(|(group, grid)| {
                let first = usize::from(group.first);
                (first..first + GROUP).map(|k| (k, *grid))
            });
            let lone = self.lone.iter().map(|(k, grid)| (usize::from(*k), *grid));
            for (k, grid) in in_groups.chain(lone) {
                let [left, right, up, down] = part.edges;
                let [a, b, c, d] = lattice::of(grid);
                let place = |axis: usize, center: f32, i: usize| {
                    center
                        + (a[i] * left[axis][k] + b[i] * right[axis][k])
                        + (c[i] * up[axis][k] + d[i] * down[axis][k])
                };
                let taps: [[f32; 2]; LANES] =
                    std::array::from_fn(|i| [place(0, part.x[k], i), place(1, part.y[k], i)]);
                tell(from + k, grid.level, &taps[..grid.taps().min(LANES)]);
            }
        }
    }

    /// Fills `groups` and `lone` by the cells that were counted: every pixel is in one of them.
    fn choose_grids(&mut self, n: usize, last_level: u32) {
        self.groups.clear();
        self.lone.clear();
        for first in (0..n).step_by(GROUP) {
            let pixels = first..(first + GROUP).min(n);
            let is_whole = pixels.len() == GROUP;
            match is_whole.then(|| self.cells.shared_grid(first / GROUP, last_level)).flatten() {
                Some(grid) => self
                    .groups
                    .push((TapGroup { first: first as u16, taps: grid.taps() as u16 }, grid)),
                None => {
                    self.lone.extend(pixels.map(|k| (k as u16, self.cells.grid(k, last_level))))
                }
            }
        }
    }
}

crate::widest! {
    /// Places the taps of patches of one tap each.
    fn place_singles(patches: PatchRow, x: &mut [f32], y: &mut [f32]) {
        let [left, right, up, down] = patches.edges;
        let [a, b, c, d] = lattice::of(TapGrid::SINGLE).each_ref().map(|steps| steps[0]);
        for (axis, (center, out)) in [(patches.x, x), (patches.y, y)].into_iter().enumerate() {
            let n = out.len();
            let (center, left, right) = (&center[..n], &left[axis][..n], &right[axis][..n]);
            let (up, down) = (&up[axis][..n], &down[axis][..n]);
            for k in 0..n {
                out[k] = center[k] + (a * left[k] + b * right[k]) + (c * up[k] + d * down[k]);
            }
        }
    }

    /// Places the taps of the groups that read level `index`, whose texels are `scale` of level
    /// 0's: group after group, tap after tap, the [`GROUP`] pixels side by side. Returns their
    /// number.
    fn place_groups(
        patches: PatchRow,
        groups: &[(TapGroup, TapGrid)],
        index: u32,
        scale: [f32; 2],
        x: &mut [f32],
        y: &mut [f32],
        placed: &mut Vec<TapGroup>,
    ) -> usize {
        let mut len = 0;
        let [left, right, up, down] = patches.edges;
        for (group, grid) in groups.iter().filter(|(_, grid)| grid.level == index) {
            let (first, taps) = (usize::from(group.first), grid.taps());
            let (lattice, room) = (lattice::of(*grid), len..len + GROUP * taps);
            let [edges_x, edges_y] = [0, 1].map(|axis| [left[axis], right[axis], up[axis], down[axis]]);
            spread_group(lattice, patches.x, edges_x, first, scale[0], &mut x[room.clone()]);
            spread_group(lattice, patches.y, edges_y, first, scale[1], &mut y[room]);
            len += GROUP * taps;
            placed.push(*group);
        }
        len
    }

    /// The same for lone pixels, one patch after the other. `x`, `y` have room for all taps and
    /// [`LANES`] more.
    fn place_lone(
        patches: PatchRow,
        lone: &[(u16, TapGrid)],
        index: u32,
        scale: [f32; 2],
        x: &mut [f32],
        y: &mut [f32],
        runs: &mut Vec<TapRun>,
    ) -> usize {
        let mut len = 0;
        let [left, right, up, down] = patches.edges;
        for &(pixel, grid) in lone.iter().filter(|(_, grid)| grid.level == index) {
            let (k, taps) = (usize::from(pixel), grid.taps());
            let lattice = lattice::of(grid);
            let [edges_x, edges_y] = [0, 1].map(|axis| [left[axis][k], right[axis][k], up[axis][k], down[axis][k]]);
            spread(lattice, patches.x[k], edges_x, scale[0], taps, &mut x[len..]);
            spread(lattice, patches.y[k], edges_y, scale[1], taps, &mut y[len..]);
            len += taps;
            runs.push(TapRun { pixel, count: taps as u16 });
        }
        len
    }
}

/// One coordinate of the taps of a group whose patches begin at `first`, pixel by pixel.
#[inline(always)]
fn spread_group(
    lattice: &TapLattice,
    center: &[f32],
    edges: [&[f32]; 4],
    first: usize,
    scale: f32,
    out: &mut [f32],
) {
    let part = first..first + GROUP;
    let center = &center[part.clone()];
    let (left, right) = (&edges[0][part.clone()], &edges[1][part.clone()]);
    let (up, down) = (&edges[2][part.clone()], &edges[3][part]);
    let [a, b, c, d] = lattice;
    for (out, tap) in out.as_chunks_mut::<GROUP>().0.iter_mut().zip(0..LANES) {
        for k in 0..GROUP {
            out[k] = (center[k]
                + (a[tap] * left[k] + b[tap] * right[k])
                + (c[tap] * up[k] + d[tap] * down[k]))
                * scale;
        }
    }
}

/// One coordinate of a patch's taps, eight at a time; `out` has room for [`LANES`].
#[inline(always)]
fn spread(
    lattice: &TapLattice,
    center: f32,
    [left, right, up, down]: [f32; 4],
    scale: f32,
    count: usize,
    out: &mut [f32],
) {
    let [a, b, c, d] = lattice;
    let out = &mut out[..LANES];
    for from in [0, 8] {
        if from < count {
            for i in from..from + 8 {
                out[i] =
                    (center + (a[i] * left + b[i] * right) + (c[i] * up + d[i] * down)) * scale;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::grid::{COARSE_CELL, MAX_TAPS, cells};
    use super::*;
    use crate::math::{Size, vec2};
    use crate::raster::{Picture, sampler};

    fn stripes(size: Size, period: usize) -> Texture {
        let texel = |i: usize| {
            if (i % size.width as usize) % period < period / 2 { [255; 4] } else { [0, 0, 0, 255] }
        };
        Texture::new(&Picture::srgb8(size, (0..size.area()).map(texel).collect()).unwrap())
    }

    /// One straight patch with the given sides.
    fn patch(texture: &Texture, at: [f32; 2], across: f32, along: f32) -> [u8; 4] {
        let [x, y] = at.map(|v| [v]);
        let half = |v: f32| [v / 2.0];
        let (a, b, zero) = (half(across), half(along), [0.0]);
        let (minus_a, minus_b) = (half(-across), half(-along));
        let edges = [[&minus_a[..], &zero], [&a, &zero], [&zero, &minus_b], [&zero, &b]];
        let mut out = [[0; 4]];
        Antialias::default().row(
            texture,
            PatchRow { x: &x, y: &y, edges },
            Outside::Repeat,
            &mut out,
        );
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
            assert!(
                (f32::from(patch(&texture, [x, 30.0], 1.0, 0.2)[0]) - tap[0] * 255.0).abs() <= 0.52
            );
        }
    }

    #[test]
    fn a_patch_stretched_along_the_stripes_keeps_them_sharp() {
        let texture = stripes(Size::new(256, 256), 16);
        assert_eq!(
            patch(&texture, [20.0, 100.0], 1.0, 60.0)[0],
            255,
            "the middle of a white stripe"
        );
        assert_eq!(patch(&texture, [28.0, 100.0], 1.0, 60.0)[0], 0, "the middle of a black one");
    }

    #[test]
    fn grids_spend_no_more_taps_than_allowed_and_hold_every_side() {
        let grid = |across: f32, along: f32| {
            TapGrid::of_cells(
                [across, along].map(|side| cells(side, 1.5)),
                [across, along].map(|side| cells(side, COARSE_CELL)),
                9,
                MAX_TAPS,
            )
        };
        for across in [0.0, 0.9, 2.0, 7.0, 33.0, 1e9, f32::INFINITY, f32::NAN] {
            for along in [0.0, 1.6, 5.0, 40.0, f32::INFINITY, f32::NAN] {
                let grid = grid(across, along);
                assert!(
                    (1..=MAX_TAPS).contains(&(grid.across * grid.along)),
                    "{across} × {along}: {grid:?}"
                );
                assert!(grid.level <= 9);
            }
        }
        assert_eq!(grid(6.0, 1.0), TapGrid { across: 4, along: 1, level: 0 });
        assert_eq!(grid(16.0, 16.0), TapGrid { across: 4, along: 4, level: 1 });
    }
}
