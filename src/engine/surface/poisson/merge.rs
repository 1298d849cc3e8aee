//! Which unknowns of a level become one on the next: those of a block of 2 × 2 that strong couplings
//! join. Floor 2. Not here: the levels themselves (`graph`).

use super::PoissonGrid;
use crate::math::union_find::first_of;

/// A coupling joins its ends into one coarser unknown if it is at least this share of the stiffest at
/// the slacker end.
const STRONG: f32 = 0.1;

/// `a`, `b`: the stiffest couplings at the two ends.
pub(super) fn is_strong(stiffness: f32, a: f32, b: f32) -> bool {
    stiffness >= STRONG * a.min(b)
}

/// The stiffness between the middles of two blocks: that of the couplings between them in a row with
/// half of each block's own. For even couplings it is half of what lies between; for slack ones
/// between firm blocks all of it.
pub(super) fn in_series(between: f32, inner_a: f32, inner_b: f32) -> f32 {
    let slack = |inner: f32| if inner > 0.0 { 0.5 * between / inner } else { 0.0 };
    between / (1.0 + slack(inner_a) + slack(inner_b))
}

/// The couplings of one of a grid's unknowns with the index at their end; stiffness 0 where there is
/// none.
pub(super) fn couplings_at(grid: &PoissonGrid, i: usize) -> [(usize, f32); 4] {
    let w = grid.width();
    let [right, down] = grid.couplings();
    let left = if !i.is_multiple_of(w) { (i - 1, right[i - 1]) } else { (i, 0.0) };
    let up = if i >= w { (i - w, down[i - w]) } else { (i, 0.0) };
    [left, (i + 1, right[i]), up, (i + w, down[i])]
}

/// Numbers the coarser unknowns of two rows from 0 on, left to right, and returns the column of
/// blocks of each.
pub(super) fn number_rows(grid: &PoissonGrid, y: usize, rows: &mut [u32]) -> Vec<u32> {
    let w = grid.width();
    let [right, down] = grid.couplings();
    let stiffest = |i: usize| couplings_at(grid, i).into_iter().fold(0.0, |m: f32, s| m.max(s.1));
    let mut columns = Vec::new();
    for x in (0..w).step_by(2) {
        // The block's pixels: two of the upper row, two of the lower.
        let inside = |k: usize| {
            (x + k % 2 < w && k / 2 * w + x + k % 2 < rows.len()).then_some(k / 2 * w + x + k % 2)
        };
        let top: [Option<usize>; 4] = std::array::from_fn(inside);
        let most = top.map(|at| at.map_or(0.0, |at| stiffest(2 * y * w + at)));
        let mut first = [0, 1, 2, 3];
        for (a, b, couplings) in [(0, 1, right), (2, 3, right), (0, 2, down), (1, 3, down)] {
            let Some((at, _)) = top[a].zip(top[b]) else { continue };
            let stiffness = couplings[2 * y * w + at];
            if stiffness > 0.0 && is_strong(stiffness, most[a], most[b]) {
                let (from, to) = (first[a].max(first[b]), first[a].min(first[b]));
                first.iter_mut().filter(|f| **f == from).for_each(|f| *f = to);
            }
        }
        for k in 0..4 {
            let Some(at) = top[k].filter(|_| most[k] > 0.0) else { continue };
            rows[at] = match top[first[k]].filter(|_| first[k] < k) {
                Some(same) => rows[same],
                None => {
                    columns.push((x / 2) as u32);
                    columns.len() as u32 - 1
                }
            };
        }
    }
    columns
}

/// Numbers the trees of a forest in the order of their roots: the number of each node's tree, and
/// the roots.
pub(super) fn number_trees(first: &mut [u32]) -> (Vec<u32>, Vec<u32>) {
    let (mut labels, mut roots) = (vec![0; first.len()], Vec::new());
    for i in 0..first.len() as u32 {
        let root = first_of(first, i);
        if root == i {
            labels[i as usize] = roots.len() as u32;
            roots.push(i);
        } else {
            labels[i as usize] = labels[root as usize];
        }
    }
    (labels, roots)
}

/// The finer unknowns that each coarser one represents.
pub(super) struct Children {
    starts: Vec<u32>,
    nodes: Vec<u32>,
}

impl Children {
    pub(super) fn of(&self, unknown: usize) -> &[u32] {
        &self.nodes[self.starts[unknown] as usize..self.starts[unknown + 1] as usize]
    }
}

pub(super) fn children(parent: &[u32], count: usize) -> Children {
    let mut starts = vec![0u32; count + 1];
    parent.iter().for_each(|&p| starts[p as usize + 1] += 1);
    (0..count).for_each(|i| starts[i + 1] += starts[i]);
    let (mut next, mut nodes) = (starts.clone(), vec![0; parent.len()]);
    for (i, &p) in parent.iter().enumerate() {
        nodes[next[p as usize] as usize] = i as u32;
        next[p as usize] += 1;
    }
    Children { starts, nodes }
}
