//! How many taps a patch takes, and in which mip level.
//! Floor 1.

use super::{PatchRow, SPAN};
use crate::math::fast::max;
use crate::raster::sampler::taps::GROUP;

/// How closely patches are covered: depends on what a picture is drawn for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TapRule {
    /// Side of the cell of one tap, in texels of level 0. A picture drawn pixel for pixel (1 texel)
    /// does not change.
    fine_cell: f32,
    /// Most taps a pixel may take, in all.
    most_taps: u32,
}

impl TapRule {
    /// For pictures that stay.
    pub const AT_REST: Self = Self { fine_cell: 1.5, most_taps: MAX_TAPS };
    /// For pictures that are seen only for a moment, during a drag.
    pub const MOVING: Self = Self { fine_cell: 2.0, most_taps: 8 };

    /// The square of half a cell: a half-edge that is no longer belongs to a side of one cell.
    fn half_cell_squared(self) -> f32 {
        0.25 * self.fine_cell * self.fine_cell
    }
}

impl Default for TapRule {
    fn default() -> Self {
        Self::AT_REST
    }
}

/// The same in the other levels, whose texels are means already: there a bilinear tap's variance
/// s²/4 − 1/12 is that of a box of 1.7 texels.
pub const COARSE_CELL: f32 = 2.0;
/// Most taps a pixel may take by any rule.
pub const MAX_TAPS: u32 = 16;

/// How a patch is covered: so many taps across and along, in a mip level.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct TapGrid {
    pub across: u32,
    pub along: u32,
    pub level: u32,
}

impl TapGrid {
    /// One tap in level 0.
    pub const SINGLE: Self = Self { across: 1, along: 1, level: 0 };

    /// For a patch that takes this many fine or coarse cells across and along in level 0.
    #[inline(always)]
    pub fn of_cells(fine: [u32; 2], coarse: [u32; 2], last_level: u32, most_taps: u32) -> Self {
        let [across, along] = fine;
        if across * along <= most_taps || last_level == 0 {
            return Self { across, along, level: 0 }.capped(most_taps);
        }
        let mut grid = Self { across: coarse[0], along: coarse[1], level: 0 };
        while grid.across * grid.along > most_taps && grid.level < last_level {
            grid = Self {
                across: grid.across.div_ceil(2),
                along: grid.along.div_ceil(2),
                level: grid.level + 1,
            };
        }
        grid.capped(most_taps)
    }

    #[inline(always)]
    pub fn taps(self) -> usize {
        (self.across * self.along) as usize
    }

    #[inline(always)]
    fn capped(self, most_taps: u32) -> Self {
        let across = self.across.min(most_taps);
        Self { across, along: self.along.min(most_taps / across), ..self }
    }
}

/// Sides longer than this many cells are cut: the product of two must fit.
const MAX_CELLS: f32 = 32768.0;

/// How many cells of a size a side takes, at least 1.
#[inline(always)]
pub fn cells(side: f32, cell: f32) -> u32 {
    // Adding 2²³ rounds to the nearest integer and leaves it in the low bits; half a cell less than
    // that rounds up.
    let nearest = (side * (1.0 / cell) + 0.4999).max(1.0).min(MAX_CELLS) + 8_388_608.0;
    nearest.to_bits() - 8_388_608.0f32.to_bits()
}

/// How many cells the sides of every patch of a span take in level 0.
#[derive(Clone)]
pub struct CellCounts {
    rule: TapRule,
    /// The sides of every patch across and along, in texels.
    sides: [[f32; SPAN]; 2],
    /// The sides in fine cells of the rule.
    fine: [[u32; SPAN]; 2],
    /// In cells of [`COARSE_CELL`]; only if fine ones would be too many.
    coarse: [[u32; SPAN]; 2],
    /// The most cells of a group's patches: fine ones, coarse ones.
    most: [[[u32; SPAN / GROUP]; 2]; 2],
    /// How many fine cells the patches of a group take, one by one.
    in_all: [u32; SPAN / GROUP],
    /// The most fine cells of any patch.
    largest: [u32; 2],
}

impl Default for CellCounts {
    fn default() -> Self {
        let (ones, most) = ([[1; SPAN]; 2], [[[1; SPAN / GROUP]; 2]; 2]);
        let (rule, sides, in_all) = (TapRule::default(), [[0.0; SPAN]; 2], [0; SPAN / GROUP]);
        Self { rule, sides, fine: ones, coarse: ones, most, in_all, largest: [1; 2] }
    }
}

impl CellCounts {
    /// For the first `n` patches of a row.
    pub fn count(&mut self, patches: PatchRow, n: usize, rule: TapRule) {
        let n = n.min(SPAN);
        (self.rule, self.largest) = (rule, [1; 2]);
        if are_within(patches, n, rule.half_cell_squared()) {
            return;
        }
        count_fine(patches, n, self);
        if self.are_single() {
            return;
        }
        let [across, along] = self.largest;
        most_of_groups(&self.fine, n / GROUP, &mut self.most[0]);
        add_up_groups(&self.fine, n / GROUP, &mut self.in_all);
        if across.saturating_mul(along) > self.rule.most_taps {
            count_coarse(&self.sides, n, &mut self.coarse);
            most_of_groups(&self.coarse, n / GROUP, &mut self.most[1]);
        }
    }

    /// No patch takes more than one tap.
    pub fn are_single(&self) -> bool {
        self.largest == [1; 2]
    }

    /// The grid of one patch.
    pub fn grid(&self, k: usize, last_level: u32) -> TapGrid {
        let [fine, coarse] = [&self.fine, &self.coarse].map(|cells| [cells[0][k], cells[1][k]]);
        TapGrid::of_cells(fine, coarse, last_level, self.rule.most_taps)
    }

    /// The grid that holds the largest sides of a group's patches; `None` if it does not suit them
    /// all.
    #[inline(always)]
    pub fn shared_grid(&self, group: usize, last_level: u32) -> Option<TapGrid> {
        let [fine, coarse] =
            [0, 1].map(|kind| [self.most[kind][0][group], self.most[kind][1][group]]);
        let shared = TapGrid::of_cells(fine, coarse, last_level, self.rule.most_taps);
        let alone = if fine[0] * fine[1] <= self.rule.most_taps {
            // All read level 0.
            self.in_all[group] as usize
        } else {
            let mut grids = (GROUP * group..GROUP * (group + 1)).map(|k| self.grid(k, last_level));
            grids.try_fold(0, |taps, grid| {
                (grid.level == shared.level).then(|| taps + grid.taps())
            })?
        };
        // Half as many taps again cost less than reading the pixels one by one.
        (2 * shared.taps() * GROUP <= 3 * alone).then_some(shared)
    }
}

crate::widest! {
    /// Whether no squared half-edge of a patch is above a limit: undistorted ground, which needs no
    /// roots. NaN is above it.
    fn are_within(patches: PatchRow, n: usize, limit: f32) -> bool {
        let mut within = 1;
        for [x, y] in patches.edges {
            let (x, y) = (&x[..n], &y[..n]);
            for k in 0..n {
                within &= u32::from(x[k] * x[k] + y[k] * y[k] <= limit);
            }
        }
        within == 1
    }

    /// A side is twice the longer of its two half-edges.
    fn count_fine(patches: PatchRow, n: usize, cells_of: &mut CellCounts) {
        let fine_cell = cells_of.rule.fine_cell;
        for side in 0..2 {
            let ([ax, ay], [bx, by]) = (patches.edges[2 * side], patches.edges[2 * side + 1]);
            let (ax, ay, bx, by) = (&ax[..n], &ay[..n], &bx[..n], &by[..n]);
            let (sides, fine) = (&mut cells_of.sides[side][..n], &mut cells_of.fine[side][..n]);
            let mut largest = 1;
            for k in 0..n {
                let (a, b) = (ax[k] * ax[k] + ay[k] * ay[k], bx[k] * bx[k] + by[k] * by[k]);
                sides[k] = 2.0 * max(a, b).sqrt();
                fine[k] = cells(sides[k], fine_cell);
                largest = largest.max(fine[k]);
            }
            cells_of.largest[side] = largest;
        }
    }

    fn count_coarse(sides: &[[f32; SPAN]; 2], n: usize, coarse: &mut [[u32; SPAN]; 2]) {
        for (sides, coarse) in sides.iter().zip(coarse) {
            for (length, cells_of) in sides[..n].iter().zip(&mut coarse[..n]) {
                *cells_of = cells(*length, COARSE_CELL);
            }
        }
    }

    /// The most cells of each of the first `n` groups.
    fn most_of_groups(counts: &[[u32; SPAN]; 2], n: usize, most: &mut [[u32; SPAN / GROUP]; 2]) {
        for (counts, most) in counts.iter().zip(most) {
            for (group, most) in counts.as_chunks::<GROUP>().0.iter().zip(&mut most[..n]) {
                *most = group.iter().fold(1, |most, &n| most.max(n));
            }
        }
    }

    fn add_up_groups(fine: &[[u32; SPAN]; 2], n: usize, in_all: &mut [u32; SPAN / GROUP]) {
        let groups = fine[0].as_chunks::<GROUP>().0.iter().zip(fine[1].as_chunks::<GROUP>().0);
        for ((across, along), in_all) in groups.zip(&mut in_all[..n]) {
            *in_all = across.iter().zip(along).map(|(a, b)| (a * b).min(1 << 16)).sum();
        }
    }
}
