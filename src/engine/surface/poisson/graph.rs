//! The coarser levels of couplings: unknowns that represent blocks of finer ones, joined by couplings
//! in any shape. Floor 2. Their couplings, and the V-cycle below the grid. Not here: which unknowns
//! become one (`merge`), the grid itself (`poisson`).

use super::PoissonGrid;
use super::merge::{children, couplings_at, in_series, is_strong, number_rows, number_trees};
use crate::math::{parallel, union_find};
use crate::memory::fill_or_unwind;

/// No unknown of a coarser level.
pub(super) const NONE: u32 = u32::MAX;

/// Unknowns and their couplings, those of unknown i at `starts[i]..starts[i + 1]`.
pub(super) struct PoissonGraph {
    starts: Vec<u32>,
    ends: Vec<u32>,
    stiffness: Vec<f32>,
    /// 1 / Σ w; 0 without couplings.
    inverse: Vec<f32>,
    /// The block of the grid that each unknown lies in.
    blocks: Vec<[u32; 2]>,
    /// For each unknown, its unknown on the next level; empty on the last.
    parent: Vec<u32>,
    /// For each unknown of the last level the number of its piece, and the number of pieces.
    pieces: (Vec<u32>, usize),
}

/// Right-hand side and solution of a level.
#[derive(Default)]
pub(super) struct GraphScratch {
    b: Vec<f32>,
    v: Vec<f32>,
    twin: Vec<f32>,
}

/// Unknowns that one task works on; fewer are not worth a task.
const CHUNK: usize = 8192;

impl PoissonGraph {
    /// The first level below a grid, and for each of the grid's unknowns the one that represents
    /// it.
    pub fn of_grid(grid: &PoissonGrid) -> (Vec<u32>, Self) {
        let (w, h) = (grid.width(), grid.height());
        let mut parent = fill_or_unwind(w * h, NONE);
        let mut blocks: Vec<[u32; 2]> = Vec::new();
        if w == 0 || h == 0 {
            return (parent, Self::from_blocks(blocks, |_, _| {}));
        }
        // Each two rows number their unknowns from 0; what precedes them is added afterwards.
        let counts: Vec<Vec<u32>> =
            parallel::map(parent.chunks_mut(2 * w).enumerate(), |(y, rows)| {
                number_rows(grid, y, rows)
            });
        let mut before = Vec::with_capacity(counts.len());
        for (y, columns) in counts.iter().enumerate() {
            before.push(blocks.len() as u32);
            blocks.extend(columns.iter().map(|&x| [x, y as u32]));
        }
        parallel::for_each(parent.chunks_mut(2 * w).zip(&before), 1, |(rows, before)| {
            rows.iter_mut().filter(|p| **p != NONE).for_each(|p| *p += before);
        });
        let of_block = |[x, y]: [u32; 2]| {
            let (x, y) = (2 * x as usize, 2 * y as usize);
            [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)]
                .into_iter()
                .filter(|&(x, y)| x < w && y < h)
        };
        let graph = Self::from_blocks(blocks.clone(), |unknown, add| {
            for (x, y) in
                of_block(blocks[unknown]).filter(|&(x, y)| parent[y * w + x] == unknown as u32)
            {
                let i = y * w + x;
                couplings_at(grid, i)
                    .into_iter()
                    .filter(|s| s.1 > 0.0)
                    .for_each(|(j, s)| add(parent[j], s));
            }
        });
        (parent, graph)
    }

    /// A graph of unknowns in given blocks; `couplings` gives each unknown's finer couplings with the
    /// unknown at their end.
    fn from_blocks(
        blocks: Vec<[u32; 2]>,
        couplings: impl Fn(usize, &mut dyn FnMut(u32, f32)) + Sync,
    ) -> Self {
        let chunk = |start: usize| {
            let mut rows: Vec<(u32, f32)> = Vec::new();
            let (mut counts, mut inner) = (Vec::new(), Vec::new());
            for unknown in start..(start + CHUNK).min(blocks.len()) {
                let (first, mut within) = (rows.len(), 0.0);
                couplings(unknown, &mut |end, stiffness| {
                    if end == unknown as u32 {
                        within += stiffness;
                        return;
                    }
                    match rows[first..].iter_mut().find(|(known, _)| *known == end) {
                        Some((_, sum)) => *sum += stiffness,
                        None => rows.push((end, stiffness)),
                    }
                });
                counts.push((rows.len() - first) as u32);
                // Each was met at both of its ends, and half of them lie along any one way.
                inner.push(0.25 * within);
            }
            (rows, counts, inner)
        };
        let chunks = parallel::map((0..blocks.len()).step_by(CHUNK), chunk);
        let inner: Vec<f32> =
            chunks.iter().flat_map(|(_, _, inner)| inner.iter().copied()).collect();
        let mut graph = Self {
            starts: Vec::with_capacity(blocks.len() + 1),
            ends: Vec::new(),
            stiffness: Vec::new(),
            inverse: Vec::with_capacity(blocks.len()),
            blocks,
            parent: Vec::new(),
            pieces: (Vec::new(), 0),
        };
        graph.starts.push(0);
        for (mut rows, counts, _) in chunks {
            let mut first = 0;
            for count in counts {
                let unknown = graph.inverse.len();
                let row = &mut rows[first..first + count as usize];
                row.iter_mut()
                    .for_each(|(end, s)| *s = in_series(*s, inner[unknown], inner[*end as usize]));
                let sum: f32 = row.iter().map(|(_, s)| s).sum();
                graph.inverse.push(if sum > 0.0 { 1.0 / sum } else { 0.0 });
                graph.ends.extend(row.iter().map(|(end, _)| end));
                graph.stiffness.extend(row.iter().map(|(_, s)| s));
                graph.starts.push(graph.ends.len() as u32);
                first += count as usize;
            }
        }
        graph
    }

    pub fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> usize {
        let couplings = size_of_val(&self.starts[..])
            + size_of_val(&self.ends[..])
            + size_of_val(&self.stiffness[..]);
        let unknowns = size_of_val(&self.inverse[..])
            + size_of_val(&self.blocks[..])
            + size_of_val(&self.parent[..]);
        couplings + unknowns + size_of_val(&self.pieces.0[..])
    }

    pub fn parents(&self) -> &[u32] {
        &self.parent
    }

    fn couplings(&self, i: usize) -> impl Iterator<Item = (u32, f32)> {
        let row = self.starts[i] as usize..self.starts[i + 1] as usize;
        self.ends[row.clone()].iter().copied().zip(self.stiffness[row].iter().copied())
    }

    /// The next level; `None` where nothing is left to merge: this one is the last.
    pub fn coarser(&mut self) -> Option<Self> {
        let coarser = if self.len() <= 16 { None } else { self.merge() };
        if coarser.is_none() {
            self.pieces = self.find_pieces();
        }
        coarser
    }

    fn merge(&mut self) -> Option<Self> {
        let stiffest: Vec<f32> =
            (0..self.len()).map(|i| self.couplings(i).fold(0.0, |m: f32, s| m.max(s.1))).collect();
        let block = |i: usize| self.blocks[i].map(|v| v / 2);
        let mut first: Vec<u32> = (0..self.len() as u32).collect();
        for i in 0..self.len() {
            for (j, stiffness) in self.couplings(i) {
                let j = j as usize;
                if j > i && block(i) == block(j) && is_strong(stiffness, stiffest[i], stiffest[j]) {
                    union_find::join(&mut first, i as u32, j as u32);
                }
            }
        }
        let (parent, roots) = number_trees(&mut first);
        // Merging ends when only pieces of one unknown each are left.
        if roots.len() * 10 > self.len() * 9 {
            return None;
        }
        let children = children(&parent, roots.len());
        let blocks = roots.iter().map(|&root| block(root as usize)).collect();
        let graph = Self::from_blocks(blocks, |unknown, add| {
            for &child in children.of(unknown) {
                self.couplings(child as usize).for_each(|(end, s)| add(parent[end as usize], s));
            }
        });
        self.parent = parent;
        Some(graph)
    }

    /// The number of each unknown's piece on the last level, and the number of pieces that couplings
    /// join.
    pub fn pieces(&self) -> &(Vec<u32>, usize) {
        &self.pieces
    }

    fn find_pieces(&self) -> (Vec<u32>, usize) {
        let mut first: Vec<u32> = (0..self.len() as u32).collect();
        for i in 0..self.len() {
            self.couplings(i).for_each(|(j, _)| {
                union_find::join(&mut first, i as u32, j);
            });
        }
        let (labels, roots) = number_trees(&mut first);
        (labels, roots.len())
    }

    /// Subtracts the mean of every piece without a constrained unknown: no coupling opposes what rounding
    /// leaves there, and it would grow.
    fn center(&self, values: &mut [f32], constraints: &[(u32, f32)]) {
        let (labels, count) = &self.pieces;
        let mut sums = vec![(0.0f32, 0.0f32); *count];
        let mut is_free = vec![true; *count];
        constraints.iter().for_each(|(i, _)| is_free[labels[*i as usize] as usize] = false);
        for (v, &label) in values.iter().zip(labels) {
            let sum = &mut sums[label as usize];
            *sum = (sum.0 + v, sum.1 + 1.0);
        }
        for (v, &label) in
            values.iter_mut().zip(labels).filter(|(_, label)| is_free[**label as usize])
        {
            *v -= sums[label as usize].0 / sums[label as usize].1;
        }
    }

    /// One sweep of Jacobi: `v + step ((b + Σ w v) / Σ w − v)`.
    fn relax(&self, constraints: &[(u32, f32)], b: &[f32], v: &[f32], step: f32, out: &mut [f32]) {
        let one = |(i, out): (usize, &mut f32)| {
            let pull: f32 = self.couplings(i).map(|(j, s)| s * v[j as usize]).sum();
            *out = v[i] + step * ((b[i] + pull) * self.inverse[i] - v[i]);
        };
        self.each(out, one);
        for &(i, stiffness) in constraints {
            let i = i as usize;
            let (sum, pull) = self
                .couplings(i)
                .fold((0.0, 0.0), |(sum, pull), (j, s)| (sum + s, pull + s * v[j as usize]));
            out[i] = v[i] + step * ((b[i] + pull) / (sum + stiffness) - v[i]);
        }
    }

    /// b − A v.
    fn residual(&self, constraints: &[(u32, f32)], b: &[f32], v: &[f32], out: &mut [f32]) {
        let one = |(i, out): (usize, &mut f32)| {
            *out = b[i] - self.couplings(i).map(|(j, s)| s * (v[i] - v[j as usize])).sum::<f32>();
        };
        self.each(out, one);
        constraints.iter().for_each(|&(i, stiffness)| out[i as usize] -= stiffness * v[i as usize]);
    }

    fn each(&self, out: &mut [f32], one: impl Fn((usize, &mut f32)) + Sync) {
        if self.len() <= CHUNK {
            return out.iter_mut().enumerate().for_each(one);
        }
        parallel::for_each_row(out, CHUNK, 1, |chunk, out| {
            (chunk * CHUNK..).zip(out).for_each(&one);
        });
    }
}

/// Adds up what is left of a finer level as the right-hand side of the first graph.
pub(super) fn gather(
    parent: &[u32],
    left: &[f32],
    levels: &mut [GraphScratch],
    graphs: &[PoissonGraph],
) {
    let Some((level, graph)) = levels.first_mut().zip(graphs.first()) else { return };
    level.b.clear();
    level.b.resize(graph.len(), 0.0);
    for (&p, v) in parent.iter().zip(left).filter(|(p, _)| **p != NONE) {
        level.b[p as usize] += v;
    }
}

/// Adds a coarser solution to a finer one.
pub(super) fn spread(parents: &[u32], coarse: &GraphScratch, fine: &mut [f32]) {
    for (v, &p) in fine.iter_mut().zip(parents) {
        if p != NONE {
            *v += coarse.v[p as usize];
        }
    }
}

/// One symmetric V-cycle from the first graph down: solves each level's `b` for its `v`.
pub(super) fn cycle(
    graphs: &[PoissonGraph],
    levels: &mut [GraphScratch],
    constraints: &[Vec<(u32, f32)>],
) {
    let (Some((graph, below)), Some((level, levels))) =
        (graphs.split_first(), levels.split_first_mut())
    else {
        return;
    };
    let GraphScratch { b, v, twin } = level;
    let (constraints, held_below) = constraints
        .split_first()
        .map_or((&[][..], constraints), |(here, below)| (&here[..], below));
    v.resize(graph.len(), 0.0);
    twin.resize(graph.len(), 0.0);
    if below.is_empty() {
        graph.center(b, constraints);
    }
    graph.each(twin, |(i, out)| *out = super::STEPS[0] * b[i] * graph.inverse[i]);
    for &(i, stiffness) in constraints {
        let sum: f32 = graph.couplings(i as usize).map(|coupling| coupling.1).sum();
        twin[i as usize] = super::STEPS[0] * b[i as usize] / (sum + stiffness);
    }
    graph.relax(constraints, b, twin, super::STEPS[1], v);
    if below.is_empty() {
        // Few unknowns, or many that hardly any coupling joins.
        for _ in 0..20 {
            graph.relax(constraints, b, v, super::STEPS[0], twin);
            graph.relax(constraints, b, twin, super::STEPS[1], v);
        }
        graph.center(v, constraints);
        return;
    }
    graph.residual(constraints, b, v, twin);
    gather(&graph.parent, twin, levels, below);
    cycle(below, levels, held_below);
    spread(&graph.parent, &levels[0], v);
    graph.relax(constraints, b, v, super::STEPS[0], twin);
    graph.relax(constraints, b, twin, super::STEPS[1], v);
}
