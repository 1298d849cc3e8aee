//! Positions of a grid's taps in a patch, as tables: computing them with divisions would cost as
//! much as the taps. Floor 1.

use super::grid::{MAX_TAPS, TapGrid};

/// As many taps as a patch may have.
pub const LANES: usize = MAX_TAPS as usize;

/// The lattice of a grid.
#[inline(always)]
pub fn of(grid: TapGrid) -> &'static TapLattice {
    &LATTICES[grid.across as usize % (LANES + 1)][grid.along as usize % (LANES + 1)]
}

/// How far each tap of a grid goes along the left, right, upper and lower half-edge, 0 … 1; row by
/// row.
pub type TapLattice = [[f32; LANES]; 4];

/// The lattice of every grid, by taps across and along.
static LATTICES: [[TapLattice; LANES + 1]; LANES + 1] = {
    let mut lattices = [[[[0.0; LANES]; 4]; LANES + 1]; LANES + 1];
    let mut across = 1;
    while across <= LANES {
        let mut along = 1;
        while across * along <= LANES {
            let mut i = 0;
            while i < across * along {
                let (u, v) = (i % across, i / across);
                let steps =
                    [BEFORE[across][u], AFTER[across][u], BEFORE[along][v], AFTER[along][v]];
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

/// For a row of n taps, how far each goes along the half-edge before the middle, 0 … 1. A single
/// tap is at the middle of both half-edges, the mean of a patch whose two sides differ.
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
