//! Meshes: a grid of points over a frame, and where each goes. Floor 4.
//!
//! Between the points runs Catmull and Rom's cubic in both directions. It passes through the points, so that what is
//! dragged lies under the pen, and each point moves only what is within two points of it; a B-spline would be calmer,
//! but would not go where it is told. Beyond the frame the border goes on straight. What the mesh takes where is turned
//! about once for a canvas, on a lattice; where it folds over itself, what is later in the order of the points lies
//! on top.

use crate::math::{COORDINATE, Mat2, PlaneMap, Rect, Size, Vec2, range, vec2};
use crate::raster::{Lattice, lattice};
use rayon::prelude::*;
use std::ops::RangeInclusive;
use std::sync::{Arc, OnceLock};

/// Where the points of a grid over a frame go.
#[derive(Clone, Debug)]
pub struct Mesh {
    columns: usize,
    rows: usize,
    frame: MeshFrame,
    /// Row by row.
    points: Vec<Vec2>,
    /// For one canvas.
    backward: Arc<OnceLock<(Size, Arc<Lattice>)>>,
}

/// The rectangle that the points stand evenly over before they go anywhere, px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshFrame {
    pub corner: Vec2,
    pub size: Vec2,
}

impl PartialEq for Mesh {
    fn eq(&self, other: &Self) -> bool {
        (self.columns, self.rows, self.frame) == (other.columns, other.rows, other.frame) && self.points == other.points
    }
}

impl MeshFrame {
    /// Sides of a frame.
    pub const SIDE_PX: range::Range = 1.0..=1e6;

    pub fn of(canvas: Size) -> Self {
        Self { corner: Vec2::ZERO, size: vec2(canvas.width as f32, canvas.height as f32) }
    }
}

impl Mesh {
    /// Points along a side: two are a frame's corners, and of more than 33 a hand moves none alone.
    pub const SIDE: RangeInclusive<usize> = 2..=33;

    /// `None` of a grid with too few or too many points, or of numbers that no file holds.
    pub fn new(columns: usize, rows: usize, frame: MeshFrame, points: Vec<Vec2>) -> Option<Self> {
        let mesh = Self { columns, rows, frame, points, backward: Arc::default() };
        mesh.fits().ok().map(|()| mesh)
    }
    /// That leaves everything in place.
    pub fn even(columns: usize, rows: usize, frame: MeshFrame) -> Option<Self> {
        let bare = Self { columns, rows, frame, points: Vec::new(), backward: Arc::default() };
        (Self::SIDE.contains(&columns) && Self::SIDE.contains(&rows)).then_some(())?;
        let places = (0..columns * rows).map(|k| bare.place(k)).collect();
        Self::new(columns, rows, frame, places)
    }
    pub fn columns(&self) -> usize {
        self.columns
    }
    pub fn rows(&self) -> usize {
        self.rows
    }
    pub fn frame(&self) -> MeshFrame {
        self.frame
    }
    /// Row by row.
    pub fn points(&self) -> &[Vec2] {
        &self.points
    }
    /// Where a point stands in the frame, by its number.
    fn place(&self, k: usize) -> Vec2 {
        self.frame.corner + vec2((k % self.columns) as f32, (k / self.columns) as f32) * self.cell()
    }
    /// From one point to the next in the frame.
    fn cell(&self) -> Vec2 {
        self.frame.size / vec2((self.columns - 1) as f32, (self.rows - 1) as f32)
    }
    /// Refuses what no file gives back.
    pub fn fits(&self) -> Result<(), String> {
        for (what, count) in [("columns", self.columns), ("rows", self.rows)] {
            if !Self::SIDE.contains(&count) {
                let (least, most) = (Self::SIDE.start(), Self::SIDE.end());
                return Err(format!("the mesh has {count} {what}; it must have {least} to {most}"));
            }
        }
        let (found, wanted) = (self.points.len(), self.columns * self.rows);
        if found != wanted {
            return Err(format!("the mesh has {found} points; {} × {} make {wanted}", self.columns, self.rows));
        }
        for v in self.frame.size.to_array() {
            range::within("a side of the mesh's frame", v, &MeshFrame::SIDE_PX)?;
        }
        let places = self.points.iter().flat_map(|p| p.to_array()).chain(self.frame.corner.to_array());
        places.into_iter().try_for_each(|v| range::within("a place of the mesh", v, &COORDINATE))
    }
    /// The same with the points elsewhere.
    pub fn with_points(&self, points: Vec<Vec2>) -> Option<Self> {
        Self::new(self.columns, self.rows, self.frame, points)
    }
    /// The same followed by a map of the plane.
    pub fn then(&self, map: &PlaneMap) -> Option<Self> {
        self.with_points(self.points.iter().map(|p| map.to_canvas(*p)).collect::<Option<_>>()?)
    }
    /// The same picture on a canvas `per_axis` times as large.
    pub(in crate::document) fn scaled(&self, per_axis: Vec2) -> Self {
        let frame = MeshFrame { corner: self.frame.corner * per_axis, size: self.frame.size * per_axis };
        let points = self.points.iter().map(|p| *p * per_axis).collect();
        Self { frame, points, backward: Arc::default(), ..self.clone() }
    }
    /// The same of a plane that was taken elsewhere, where its frame stays a rectangle: by moves, mirrors, quarter
    /// turns. `None` of other maps.
    pub(in crate::document) fn carried(&self, map: &PlaneMap) -> Option<Self> {
        let [a, b, c, d, _, _] = map.coefficients()?;
        let (is_upright, is_turned) = (b == 0.0 && c == 0.0, a == 0.0 && d == 0.0);
        if !(is_upright || is_turned) {
            return None;
        }
        let (low, high) = (self.frame.corner, self.frame.corner + self.frame.size);
        let (p, q) = (map.to_canvas(low)?, map.to_canvas(high)?);
        let frame = MeshFrame { corner: p.min(q), size: (q - p).abs() };
        let (columns, rows) = if is_turned { (self.rows, self.columns) } else { (self.columns, self.rows) };
        let mut points = vec![Vec2::ZERO; self.points.len()];
        let cell = frame.size / vec2((columns - 1) as f32, (rows - 1) as f32);
        for (k, point) in self.points.iter().enumerate() {
            let place = ((map.to_canvas(self.place(k))? - frame.corner) / cell).round();
            let place = place.y as usize * columns + place.x as usize;
            *points.get_mut(place)? = map.to_canvas(*point)?;
        }
        Self::new(columns, rows, frame, points)
    }
    /// The affine map that it is, if it is one.
    pub fn as_affine(&self) -> Option<PlaneMap> {
        let [o, x, y] = [0, self.columns - 1, (self.rows - 1) * self.columns].map(|k| self.points[k].as_dvec2());
        let (along, down) = ((x - o) / f64::from(self.frame.size.x), (y - o) / f64::from(self.frame.size.y));
        let from = self.frame.corner.as_dvec2();
        let origin = o - along * from.x - down * from.y;
        let map = PlaneMap::affine([along.x, along.y, down.x, down.y, origin.x, origin.y])?;
        let is_there = |(k, p): (usize, &Vec2)| map.to_canvas(self.place(k)).is_some_and(|q| q.distance(*p) < 1e-3);
        self.points.iter().enumerate().all(is_there).then_some(map)
    }
    /// Where a point of the frame goes, and how the place moves with it.
    pub fn at(&self, p: Vec2) -> (Vec2, Mat2) {
        let s = (p - self.frame.corner) / self.cell();
        let (x, y) = (Weights::at(s.x, self.columns), Weights::at(s.y, self.rows));
        let (mut q, mut right, mut down) = (Vec2::ZERO, Vec2::ZERO, Vec2::ZERO);
        for (j, row) in y.around.into_iter().enumerate() {
            for (i, column) in x.around.into_iter().enumerate() {
                let point = self.extended(column, row);
                q += point * (x.value[i] * y.value[j]);
                right += point * (x.slope[i] * y.value[j]);
                down += point * (x.value[i] * y.slope[j]);
            }
        }
        (q, Mat2::from_cols(right / self.cell().x, down / self.cell().y))
    }
    /// A point, or what goes on straight where the grid ends.
    fn extended(&self, column: i32, row: i32) -> Vec2 {
        let along = |row: usize| beyond(column, self.columns, |i| self.points[row * self.columns + i]);
        beyond(row, self.rows, along)
    }
    /// Backward: how far from a point of the canvas what shows there lies in the frame, near the canvas.
    pub(in crate::document) fn backward(&self, canvas: Size) -> Arc<Lattice> {
        let (size, known) = self.backward.get_or_init(|| (canvas, Arc::new(Backward::of(self, canvas).lattice())));
        if *size == canvas { known.clone() } else { Arc::new(Backward::of(self, canvas).lattice()) }
    }
}

/// The value at a place of a row of so many, which goes on straight at both ends.
fn beyond(i: i32, count: usize, value: impl Fn(usize) -> Vec2) -> Vec2 {
    let last = count as i32 - 1;
    match i {
        _ if i < 0 => value(0) * (1 - i) as f32 + value(1) * i as f32,
        _ if i > last => value(last as usize) * (1 + i - last) as f32 - value(last as usize - 1) * (i - last) as f32,
        _ => value(i as usize),
    }
}

/// What four points around a place along one axis weigh, and how that changes with it.
struct Weights {
    around: [i32; 4],
    value: [f32; 4],
    slope: [f32; 4],
}

impl Weights {
    /// * `s`: in cells; beyond the grid the border goes on straight.
    fn at(s: f32, count: usize) -> Self {
        let last = (count - 1) as f32;
        let inside = s.max(0.0).min(last);
        let first = inside.floor().min(last - 1.0);
        let (t, over) = (inside - first, s - inside);
        let (t2, t3) = (t * t, t * t * t);
        let mut value = [
            0.5 * (-t + 2.0 * t2 - t3),
            0.5 * (2.0 - 5.0 * t2 + 3.0 * t3),
            0.5 * (t + 4.0 * t2 - 3.0 * t3),
            0.5 * (t3 - t2),
        ];
        let slope = [
            0.5 * (-1.0 + 4.0 * t - 3.0 * t2),
            0.5 * (-10.0 * t + 9.0 * t2),
            0.5 * (1.0 + 8.0 * t - 9.0 * t2),
            0.5 * (3.0 * t2 - 2.0 * t),
        ];
        value.iter_mut().zip(slope).for_each(|(v, s)| *v += s * over);
        let i = first as i32;
        Self { around: [i - 1, i, i + 1, i + 2], value, slope }
    }
}

/// A mesh being turned about: the nodes near the canvas, and which point of the frame shows at each.
struct Backward<'m> {
    mesh: &'m Mesh,
    /// Px, whole cells.
    area: Rect,
    across: usize,
    found: Vec<Option<Vec2>>,
}

impl<'m> Backward<'m> {
    /// Pieces that a mesh is cut into at most.
    const MOST_PIECES: f32 = 250_000.0;
    /// Sides of pieces that are sought, px.
    const PIECE_PX: f32 = 12.0;
    /// So far beyond the frame the border goes on, px of the frame.
    const BORDER_PX: f32 = 48.0;

    fn of(mesh: &'m Mesh, canvas: Size) -> Self {
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
        let longest = mesh.points.chunks(mesh.columns).flat_map(|row| row.windows(2).map(|p| p[0].distance(p[1])));
        let down = mesh.points.iter().zip(mesh.points.iter().skip(mesh.columns)).map(|(a, b)| a.distance(*b));
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
        let line = |j: usize| -> Vec<Vec2> { (0..=columns).map(|i| mesh.at(place(i, j)).0).collect() };
        let lines: Vec<Vec<Vec2>> = (0..=rows).into_par_iter().map(line).collect();
        for j in 0..rows {
            for i in 0..columns {
                let [a, b, c, d] = [lines[j][i], lines[j][i + 1], lines[j + 1][i + 1], lines[j + 1][i]];
                let [p, q, r, s] = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
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
                    self.found[j as usize * self.across + i as usize] = Some(p + (q - p) * v + (r - p) * w);
                }
            }
        }
    }
    /// A place in the frame, sought more closely by Newton's method.
    fn closer(&self, node: Vec2, p: Vec2) -> Vec2 {
        let (mut best, mut off) = (p, f32::INFINITY);
        let mut now = p;
        for _ in 0..4 {
            let (q, jacobian) = self.mesh.at(now);
            let miss = node - q;
            // What diverges, and what is no number, is no better.
            if miss.is_nan() || miss.length() >= off {
                break;
            }
            (best, off) = (now, miss.length());
            if off < 1e-3 || jacobian.determinant().abs() < 1e-6 {
                break;
            }
            now += jacobian.inverse() * miss;
        }
        // On another sheet of a fold it would be far from where the pieces lie.
        if best.distance(p) < self.mesh.cell().length() { best } else { p }
    }
    fn lattice(&self) -> Lattice {
        let by = |k: usize| self.found[k].map(|p| self.closer(self.node(k), p) - self.node(k));
        let mut by: Vec<Option<Vec2>> = (0..self.found.len()).into_par_iter().map(by).collect();
        self.continue_from_neighbours(&mut by);
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
    /// Nodes that the mesh does not reach look as far aside as those next to them.
    fn continue_from_neighbours(&self, by: &mut [Option<Vec2>]) {
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

#[cfg(test)]
mod tests {
    use super::*;

    const CANVAS: Size = Size::new(256, 192);

    fn frame() -> MeshFrame {
        MeshFrame::of(CANVAS)
    }

    #[test]
    fn a_mesh_passes_through_its_points_and_an_even_one_moves_nothing() {
        let even = Mesh::even(4, 3, frame()).unwrap();
        assert_eq!(even.as_affine().map(|map| map.is_identity_on(CANVAS)), Some(true));
        let mut points = even.points().to_vec();
        points[5] += vec2(11.0, -7.0);
        let mesh = even.with_points(points.clone()).unwrap();
        assert!(mesh.as_affine().is_none());
        for (k, point) in points.iter().enumerate() {
            assert!(mesh.at(mesh.place(k)).0.distance(*point) < 1e-3, "{k}");
        }
        assert!(mesh.at(vec2(-50.0, 0.0)).0.distance(vec2(-50.0, 0.0)) < 1e-3, "the border goes on straight");
    }
    #[test]
    fn backward_finds_what_forward_took() {
        let even = Mesh::even(4, 4, frame()).unwrap();
        let mut points = even.points().to_vec();
        points[5] += vec2(14.0, -9.0);
        points[10] += vec2(-8.0, 12.0);
        let mesh = even.with_points(points).unwrap();
        let backward = mesh.backward(CANVAS);
        for (x, y) in [(20.0, 30.0), (85.0, 64.0), (130.5, 100.0), (200.0, 150.0), (240.0, 20.0)] {
            let p = vec2(x, y);
            let q = mesh.at(p).0;
            let found = q + backward.at(q).by;
            assert!(found.distance(p) < 0.1, "{p}: {found}");
        }
    }
    #[test]
    fn folded_and_collapsed_meshes_give_numbers() {
        let even = Mesh::even(5, 5, frame()).unwrap();
        let mut folded = even.points().to_vec();
        folded.swap(6, 18);
        folded[12] = vec2(900.0, -400.0);
        let one = vec![vec2(100.0, 90.0); 25];
        let far = even.points().iter().map(|p| *p * 3000.0).collect();
        for points in [folded, one, far] {
            let backward = even.with_points(points).unwrap().backward(CANVAS);
            assert!(backward.blocks().all(|(_, block)| block.0.iter().all(|u| u.is_finite())));
            assert!(!backward.is_empty());
        }
    }
    #[test]
    fn only_grids_that_files_hold_are_meshes() {
        assert!(Mesh::even(1, 4, frame()).is_none() && Mesh::even(34, 4, frame()).is_none());
        assert!(Mesh::even(33, 33, frame()).is_some());
        assert!(Mesh::new(2, 2, frame(), vec![Vec2::ZERO; 3]).is_none());
        assert!(Mesh::new(2, 2, frame(), vec![vec2(f32::NAN, 0.0); 4]).is_none());
        assert!(Mesh::even(2, 2, MeshFrame { size: vec2(0.0, 9.0), ..frame() }).is_none());
    }
    #[test]
    fn a_quarter_turn_takes_the_grid_along() {
        let even = Mesh::even(4, 3, frame()).unwrap();
        let mut points = even.points().to_vec();
        points[5] += vec2(11.0, -7.0);
        let mesh = even.with_points(points).unwrap();
        let turn = PlaneMap::rotation(90.0, vec2(96.0, 96.0));
        let turn = PlaneMap::affine(turn.coefficients().unwrap().map(f64::round)).unwrap();
        let turned = mesh.carried(&turn).unwrap();
        assert_eq!((turned.columns(), turned.rows()), (3, 4));
        let p = vec2(90.0, 80.0);
        let there = turn.to_canvas(mesh.at(p).0).unwrap();
        assert!(turned.at(turn.to_canvas(p).unwrap()).0.distance(there) < 1e-2);
    }
}
