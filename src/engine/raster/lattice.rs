//! Displacements on a lattice: each point shows what would be seen a little away from it. Floor 1.
//! Sparse, in blocks of a tile's size; a block in which nothing is displaced is not held, so that
//! pixels there stay untouched.
//!
//! There is a node at every eighth pixel's upper left corner. A Catmull–Rom cubic passes through
//! the nodes; it is smooth, and 0 where all surrounding nodes are.

use super::grid::Grid;
use super::tile::{TILE, TILE_AREA, TileAt};
use super::warp::TilePoints;
use crate::math::{Mat2, PlaneMap, Rect, Vec2, vec2};
use std::sync::Arc;

/// From one node to the next, px.
pub const CELL: usize = 8;
/// Nodes along a block's side.
pub const SIDE: usize = TILE / CELL;
/// Nodes along a side of the area that a tile's pixels are interpolated from.
const AROUND: usize = SIDE + 3;

/// The nodes of one tile, row by row: displacements, px.
#[derive(Clone, Debug, PartialEq)]
pub struct LatticeBlock(pub [Vec2; SIDE * SIDE]);

/// A displacement u of every point of a plane: q shows what would be at q + u(q).
#[derive(Clone, Default)]
pub struct Lattice {
    blocks: Grid<LatticeBlock>,
}

/// A displacement, and how it changes with the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displaced {
    /// How far a point is displaced, px.
    pub by: Vec2,
    /// How that changes from point to point.
    pub jacobian: Mat2,
}

impl PartialEq for Lattice {
    fn eq(&self, other: &Self) -> bool {
        let holds = |a: &Self, b: &Self| {
            a.blocks.iter().all(|(at, block)| {
                b.blocks.tile(at).is_some_and(|o| Arc::ptr_eq(block, o) || block == o)
            })
        };
        self.blocks.ptr_eq(&other.blocks) || holds(self, other) && holds(other, self)
    }
}

impl std::fmt::Debug for Lattice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Lattice of {} blocks", self.blocks.iter().count())
    }
}

impl Lattice {
    /// Displacements are held in this fraction of a pixel, so that files keep every bit of them.
    pub const PER_PX: f32 = 64.0;
    /// The longest displacement along an axis, px.
    pub const FARTHEST_PX: f32 = 16_384.0;
    /// The farthest that blocks may be from the canvas's corner.
    pub const FARTHEST_BLOCK: i32 = 16_000;

    /// Nothing is displaced.
    pub fn is_empty(&self) -> bool {
        self.blocks.iter().next().is_none()
    }

    /// The blocks that displace something, row by row.
    pub fn blocks(&self) -> impl Iterator<Item = (TileAt, &Arc<LatticeBlock>)> {
        self.blocks.iter()
    }

    /// Puts a block in place, rounded; one that displaces nothing is not held.
    pub fn set(&mut self, at: TileAt, mut block: LatticeBlock) {
        block.0.iter_mut().for_each(|u| *u = quantize_displacement(*u));
        let is_none = block.0.iter().all(|u| *u == Vec2::ZERO);
        match self.blocks.tile(at) {
            Some(old) if **old == block => {}
            _ => self.blocks.set(at, (!is_none).then(|| Arc::new(block))),
        }
    }

    /// At the node `(i, j)`, whose position is `8 (i, j)`.
    pub fn node(&self, i: i32, j: i32) -> Vec2 {
        let side = SIDE as i32;
        let at = TileAt::new(i.div_euclid(side), j.div_euclid(side));
        let place = (j.rem_euclid(side) * side + i.rem_euclid(side)) as usize;
        self.blocks.tile(at).map_or(Vec2::ZERO, |block| block.0[place])
    }

    /// Changes every node of a rectangle of pixels: its new displacement is a function of its
    /// position and its old one.
    pub fn change(&mut self, rect: Rect, new: impl Fn(&Lattice, Vec2, Vec2) -> Vec2) {
        let old = self.clone();
        let cell = CELL as i32;
        for at in TileAt::covering(rect) {
            let corner = at.rect();
            let place = |k: usize| {
                ((corner.x0 + (k % SIDE) as i32 * cell), (corner.y0 + (k / SIDE) as i32 * cell))
            };
            let block = std::array::from_fn(|k| {
                let (x, y) = place(k);
                let was = old.blocks.tile(at).map_or(Vec2::ZERO, |block| block.0[k]);
                if rect.contains(x, y) { new(&old, vec2(x as f32, y as f32), was) } else { was }
            });
            self.set(at, LatticeBlock(block));
        }
    }

    /// At any point.
    pub fn at(&self, q: Vec2) -> Displaced {
        let cell = q / CELL as f32;
        let first = cell.floor();
        let (x, y) = (NodeWeights::at(cell.x - first.x), NodeWeights::at(cell.y - first.y));
        let (i, j) = (first.x as i32, first.y as i32);
        let (mut by, mut right, mut down) = (Vec2::ZERO, Vec2::ZERO, Vec2::ZERO);
        for (k, row) in (j.saturating_sub(1)..).take(4).enumerate() {
            for (l, column) in (i.saturating_sub(1)..).take(4).enumerate() {
                let u = self.node(column, row);
                by += u * (x.value[l] * y.value[k]);
                right += u * (x.slope[l] * y.value[k]);
                down += u * (x.value[l] * y.slope[k]);
            }
        }
        Displaced { by, jacobian: Mat2::from_cols(right, down) }
    }

    /// All nodes that a tile's pixels are interpolated from, row by row; `None` if none displaces.
    fn nodes_of_tile(&self, at: TileAt) -> Option<[[Vec2; AROUND]; AROUND]> {
        let near = |d: i32| (-1..=1).map(move |c| TileAt::new(at.col + c, at.row + d));
        if (-1..=1).flat_map(near).all(|at| self.blocks.tile(at).is_none()) {
            return None;
        }
        let side = SIDE as i32;
        let (i, j) = (at.col * side - 1, at.row * side - 1);
        let mut nodes = [[Vec2::ZERO; AROUND]; AROUND];
        for (row, j) in nodes.iter_mut().zip(j..) {
            for (node, i) in row.iter_mut().zip(i..) {
                *node = self.node(i, j);
            }
        }
        nodes.as_flattened().iter().any(|u| *u != Vec2::ZERO).then_some(nodes)
    }

    /// Whether the pixels of a tile show themselves.
    pub fn is_none_on(&self, at: TileAt) -> bool {
        self.nodes_of_tile(at).is_none()
    }

    /// At the middle of every pixel of a tile: which point it shows, and how that moves with the
    /// pixel; `None` if the tile shows itself. The same as [`Lattice::at`], along rows.
    pub fn on_tile(&self, at: TileAt) -> Option<TilePoints> {
        let nodes = self.nodes_of_tile(at)?;
        let phases: [NodeWeights; CELL] =
            std::array::from_fn(|k| NodeWeights::at((k as f32 + 0.5) / CELL as f32));
        // Transposed: for each weight its values in all phases, contiguous.
        let value: [[f32; CELL]; 4] =
            std::array::from_fn(|i| std::array::from_fn(|k| phases[k].value[i]));
        let slope: [[f32; CELL]; 4] =
            std::array::from_fn(|i| std::array::from_fn(|k| phases[k].slope[i]));
        let mut out = TilePoints::new(TILE_AREA);
        let corner = at.rect();
        for y in 0..TILE {
            let (first, phase) = (y / CELL, &phases[y % CELL]);
            let column = |weights: &[f32; 4], i: usize| {
                (0..4).map(|k| nodes[first + k][i] * weights[k]).sum::<Vec2>()
            };
            let row: [Vec2; AROUND] = std::array::from_fn(|i| column(&phase.value, i));
            let steep: [Vec2; AROUND] = std::array::from_fn(|i| column(&phase.slope, i));
            let place = y * TILE..(y + 1) * TILE;
            let TilePoints { x: xs, y: ys, jacobian: [a, b, c, d] } = &mut out;
            interpolate_row(&row.map(|v| v.x), &value, &mut xs[place.clone()]);
            interpolate_row(&row.map(|v| v.y), &value, &mut ys[place.clone()]);
            interpolate_row(&row.map(|v| v.x), &slope, &mut a[place.clone()]);
            interpolate_row(&row.map(|v| v.y), &slope, &mut b[place.clone()]);
            interpolate_row(&steep.map(|v| v.x), &value, &mut c[place.clone()]);
            interpolate_row(&steep.map(|v| v.y), &value, &mut d[place.clone()]);
            let (x0, y0) = (corner.x0 as f32 + 0.5, (corner.y0 + y as i32) as f32 + 0.5);
            xs[place.clone()].iter_mut().enumerate().for_each(|(k, x)| *x += x0 + k as f32);
            ys[place.clone()].iter_mut().for_each(|y| *y += y0);
            a[place.clone()].iter_mut().chain(&mut d[place]).for_each(|v| *v += 1.0);
        }
        Some(out)
    }

    /// The tiles in which two displacements may differ.
    pub fn changed_tiles(&self, other: &Lattice) -> Vec<TileAt> {
        let mut near: Vec<TileAt> = Vec::new();
        for at in self.blocks.changed_tiles(&other.blocks) {
            near.extend(
                (-1..=1).flat_map(|r| (-1..=1).map(move |c| TileAt::new(at.col + c, at.row + r))),
            );
        }
        near.sort_unstable_by_key(|at| (at.row, at.col));
        near.dedup();
        near.retain(|at| self.nodes_of_tile(*at) != other.nodes_of_tile(*at));
        near
    }

    /// The same displacement after a map of the plane: what was displaced is displaced in the same
    /// way in its new place.
    /// * `within`: nodes beyond it are dropped.
    pub fn transformed(&self, map: &PlaneMap, within: Rect) -> Lattice {
        let held = self.blocks.bounds().grown(2 * CELL as i32);
        let corner = |x: i32, y: i32| map.to_canvas(vec2(x as f32, y as f32));
        let Rect { x0, y0, x1, y1 } = held;
        let corners: Option<Vec<Vec2>> = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
            .map(|(x, y)| corner(x, y))
            .into_iter()
            .collect();
        let Some(corners) = corners.filter(|_| !self.is_empty()) else { return Lattice::default() };
        let low = corners.iter().copied().fold(Vec2::INFINITY, Vec2::min).floor();
        let high = corners.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max).ceil();
        let area =
            Rect::new(low.x as i32, low.y as i32, high.x as i32, high.y as i32).intersect(within);
        let mut out = Lattice::default();
        out.change(area, |_, q, _| {
            let Some((p, _)) = map.from_canvas(q) else { return Vec2::ZERO };
            let by = self.at(p).by;
            if by == Vec2::ZERO {
                by
            } else {
                map.to_canvas(p + by).map_or(Vec2::ZERO, |to| to - q)
            }
        });
        out
    }
}

crate::widest! {
    /// A row between its nodes: eight pixels a cell, with the weights of four nodes around.
    fn interpolate_row(nodes: &[f32; AROUND], weights: &[[f32; CELL]; 4], out: &mut [f32]) {
        for (first, cell) in out.as_chunks_mut::<CELL>().0.iter_mut().enumerate() {
            let around = &nodes[first..first + 4];
            for k in 0..CELL {
                cell[k] = around[0] * weights[0][k]
                    + around[1] * weights[1][k]
                    + around[2] * weights[2][k]
                    + around[3] * weights[3][k];
            }
        }
    }
}

/// A displacement as it is held: in range, a multiple of the smallest part of a pixel; 0 for NaN.
fn quantize_displacement(u: Vec2) -> Vec2 {
    let side = |v: f32| {
        let v = if v.is_finite() { v } else { 0.0 };
        let far = Lattice::FARTHEST_PX;
        // −0 becomes 0.
        (v.max(-far).min(far) * Lattice::PER_PX).round() / Lattice::PER_PX + 0.0
    };
    vec2(side(u.x), side(u.y))
}

/// The weights of four nodes at a ratio of the way from the second to the third, and their slopes,
/// per px.
struct NodeWeights {
    value: [f32; 4],
    slope: [f32; 4],
}

impl NodeWeights {
    fn at(t: f32) -> Self {
        let (t2, t3) = (t * t, t * t * t);
        let value = [
            0.5 * (-t + 2.0 * t2 - t3),
            0.5 * (2.0 - 5.0 * t2 + 3.0 * t3),
            0.5 * (t + 4.0 * t2 - 3.0 * t3),
            0.5 * (t3 - t2),
        ];
        let per = 0.5 / CELL as f32;
        let slope = [
            per * (-1.0 + 4.0 * t - 3.0 * t2),
            per * (-10.0 * t + 9.0 * t2),
            per * (1.0 + 8.0 * t - 9.0 * t2),
            per * (3.0 * t2 - 2.0 * t),
        ];
        Self { value, slope }
    }
}

#[cfg(test)]
mod tests;
