//! A mesh inverted: which point of its frame shows at each place of the canvas. Floor 4.

use super::Mesh;
use crate::math::{Rect, Size, Vec2, parallel, vec2};
use crate::raster::{Lattice, lattice};
use rayon::prelude::*;

/// A mesh being inverted: the nodes near the canvas, and which point of the frame shows at each.
pub(super) struct Backward<'m> {
    mesh: &'m Mesh,
    /// Px, whole cells.
    area: Rect,
    across: usize,
    found: Vec<Option<Vec2>>,
}

impl<'m> Backward<'m> {
    /// The most pieces that a mesh is cut into.
    const MOST_PIECES: f32 = 250_000.0;
    /// The intended side of pieces, px.
    const PIECE_PX: f32 = 12.0;
    /// How far the border is continued beyond the frame, px of the frame.
    const BORDER_PX: f32 = 48.0;

    pub(super) fn of(mesh: &'m Mesh, canvas: Size) -> Self {
        let cell = lattice::CELL as i32;
        let up = |v: u32| (v as i32 / cell + 1) * cell;
        let area = Rect::new(0, 0, up(canvas.width), up(canvas.height)).grown(4 * cell);
        let (across, down) = (area.width() / cell as usize + 1, area.height() / cell as usize + 1);
        let mut out = Self { mesh, area, across, found: vec![None; across * down] };
        out.lay_pieces();
        out
    }

    fn node(&self, k: usize) -> Vec2 {
        let cell = lattice::CELL as i32;
        let (i, j) = ((k % self.across) as i32, (k / self.across) as i32);
        vec2((self.area.x0 + i * cell) as f32, (self.area.y0 + j * cell) as f32)
    }

    /// Cuts the frame, with a border, into pieces and lays each where it goes.
    fn lay_pieces(&mut self) {
        let mesh = self.mesh;
        let longest = mesh
            .points
            .chunks(mesh.columns)
            .flat_map(|row| row.windows(2).map(|p| p[0].distance(p[1])));
        let down = mesh
            .points
            .iter()
            .zip(mesh.points.iter().skip(mesh.columns))
            .map(|(a, b)| a.distance(*b));
        let longest = longest.chain(down).fold(1.0, f32::max);
        let patches = ((mesh.columns + 1) * (mesh.rows + 1)) as f32;
        let most = (Self::MOST_PIECES / patches).sqrt();
        let per_cell = (longest / Self::PIECE_PX).ceil().max(2.0).min(most.max(2.0));
        let step = mesh.cell() / per_cell.floor();
        let border = (Vec2::splat(Self::BORDER_PX) / step).ceil();
        let border = border.min(Vec2::splat(64.0));
        let start = mesh.frame.corner - border * step;
        let count = (mesh.frame.size / step).round() + border * 2.0;
        let (columns, rows) = (count.x as usize, count.y as usize);
        let place = |i: usize, j: usize| start + vec2(i as f32, j as f32) * step;
        let line =
            |j: usize| -> Vec<Vec2> { (0..=columns).map(|i| mesh.at(place(i, j)).0).collect() };
        let lines: Vec<Vec<Vec2>> = parallel::collect(1 + rows, 1, line);
        for j in 0..rows {
            for i in 0..columns {
                let [a, b, c, d] =
                    [lines[j][i], lines[j][i + 1], lines[j + 1][i + 1], lines[j + 1][i]];
                let [p, q, r, s] =
                    [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
                self.lay([(a, p), (b, q), (c, r)]);
                self.lay([(a, p), (c, r), (d, s)]);
            }
        }
    }

    /// Lays a triangle over the nodes: its corners and their places in the frame.
    fn lay(&mut self, corners: [(Vec2, Vec2); 3]) {
        let [(a, p), (b, q), (c, r)] = corners;
        let area = (b - a).perp_dot(c - a);
        if area.is_nan() || area.abs() <= 1e-6 {
            return;
        }
        let cell = lattice::CELL as f32;
        let corner = vec2(self.area.x0 as f32, self.area.y0 as f32);
        let (low, high) = ((a.min(b).min(c) - corner) / cell, (a.max(b).max(c) - corner) / cell);
        let rows = self.found.len() / self.across;
        let last = vec2(self.across as f32 - 1.0, rows as f32 - 1.0);
        let (low, high) = (low.ceil().max(Vec2::ZERO), high.floor().min(last));
        // Beyond the nodes these are empty.
        for j in low.y as i64..=high.y as i64 {
            for i in low.x as i64..=high.x as i64 {
                let at = corner + vec2(i as f32, j as f32) * cell;
                let (v, w) = ((at - a).perp_dot(c - a) / area, (b - a).perp_dot(at - a) / area);
                if v >= -1e-5 && w >= -1e-5 && v + w <= 1.0 + 1e-5 {
                    self.found[j as usize * self.across + i as usize] =
                        Some(p + (q - p) * v + (r - p) * w);
                }
            }
        }
    }

    /// A place in the frame, refined by Newton's method.
    fn closer(&self, node: Vec2, p: Vec2) -> Vec2 {
        let (mut best, mut off) = (p, f32::INFINITY);
        let mut now = p;
        for _ in 0..4 {
            let (q, jacobian) = self.mesh.at(now);
            let miss = node - q;
            // A result that diverges or is NaN is no better.
            if miss.is_nan() || miss.length() >= off {
                break;
            }
            (best, off) = (now, miss.length());
            if off < 1e-3 || jacobian.determinant().abs() < 1e-6 {
                break;
            }
            now += jacobian.inverse() * miss;
        }
        // On another sheet of a fold the result would be far from the pieces.
        if best.distance(p) < self.mesh.cell().length() { best } else { p }
    }

    pub(super) fn lattice(&self) -> Lattice {
        let by = |k: usize| self.found[k].map(|p| self.closer(self.node(k), p) - self.node(k));
        let mut by: Vec<Option<Vec2>> = (0..self.found.len()).into_par_iter().map(by).collect();
        self.continue_from_neighbors(&mut by);
        // Where nothing is known at all, nothing shows.
        let nowhere = Vec2::splat(Lattice::FARTHEST_PX);
        let mut out = Lattice::default();
        let cell = lattice::CELL as i32;
        out.change(Rect { x1: self.area.x1 + 1, y1: self.area.y1 + 1, ..self.area }, |_, q, _| {
            let (i, j) = ((q.x as i32 - self.area.x0) / cell, (q.y as i32 - self.area.y0) / cell);
            by[j as usize * self.across + i as usize].unwrap_or(nowhere)
        });
        out
    }

    /// Nodes that the mesh does not reach have the displacement of those next to them.
    fn continue_from_neighbors(&self, by: &mut [Option<Vec2>]) {
        let rows = by.len() / self.across;
        let mut edge: Vec<usize> = (0..by.len()).filter(|&k| by[k].is_some()).collect();
        while !edge.is_empty() {
            let mut next = Vec::new();
            for k in edge {
                let (i, j) = (k % self.across, k / self.across);
                let near = [(i > 0, k.wrapping_sub(1)), (i + 1 < self.across, k + 1)];
                let far = [(j > 0, k.wrapping_sub(self.across)), (j + 1 < rows, k + self.across)];
                for (_, other) in near.into_iter().chain(far).filter(|(is_there, _)| *is_there) {
                    if by[other].is_none() {
                        by[other] = by[k];
                        next.push(other);
                    }
                }
            }
            edge = next;
        }
    }
}
