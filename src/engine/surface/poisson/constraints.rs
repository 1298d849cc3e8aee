//! Unknowns that are held: each by one more coupling to a value of its own, on every level of a
//! solver. Floor 2. They are few, so that loops over rows ignore them, and what they change is
//! corrected afterwards.

use super::{PoissonSolver, graph};
use std::ops::Range;

/// What holds some unknowns: the stiffness at their index, of the grid first, then of each coarser
/// level.
#[derive(Default)]
pub struct SoftConstraints {
    grid: Vec<(u32, f32)>,
    coarser: Vec<Vec<(u32, f32)>>,
}

impl SoftConstraints {
    /// Those of a run of the grid's unknowns, in order.
    #[inline(always)]
    pub(super) fn each_in(&self, run: Range<usize>, mut visit: impl FnMut(usize, f32)) {
        if self.grid.is_empty() {
            return;
        }
        let from = self.grid.partition_point(|pin| (pin.0 as usize) < run.start);
        for &(i, stiffness) in self.grid[from..].iter().take_while(|pin| (pin.0 as usize) < run.end)
        {
            visit(i as usize, stiffness);
        }
    }

    /// Those of the coarser levels, the finest first.
    pub(super) fn coarser(&self) -> &[Vec<(u32, f32)>] {
        &self.coarser
    }
}

impl PoissonSolver {
    /// What holds the grid's unknowns: their index, ascending, and a stiffness `> 0`. One that no
    /// coupling joins to another is left out.
    pub fn constraints(&self, mut grid: Vec<(u32, f32)>) -> SoftConstraints {
        grid.retain(|(i, _)| self.parent[*i as usize] != graph::NONE);
        let mut coarser: Vec<Vec<(u32, f32)>> = Vec::with_capacity(self.graphs.len());
        let mut parents = &self.parent[..];
        for graph in &self.graphs {
            let finer = coarser.last().unwrap_or(&grid);
            let mut sums: Vec<(u32, f32)> =
                finer.iter().map(|(i, s)| (parents[*i as usize], *s)).collect();
            sums.sort_by_key(|pin| pin.0);
            sums.dedup_by(|next, pin| {
                let is_same = next.0 == pin.0;
                pin.1 += if is_same { next.1 } else { 0.0 };
                is_same
            });
            coarser.push(sums);
            parents = graph.parents();
        }
        SoftConstraints { grid, coarser }
    }
}
