//! Meshes: a grid of points over a frame, and where each goes. Floor 4.
//!
//! Catmull and Rom's cubic runs between the points in both directions. It passes through the
//! points, so that what is dragged lies under the pen, and each point moves only what is within two
//! points of it; a B-spline would be calmer, but would not pass through them. Beyond the frame the
//! border is continued straight. The mesh is inverted once for a canvas, on a lattice; where it
//! folds over itself, what is later in the order of the points lies on top.

mod backward;

use crate::math::{COORDINATE, Mat2, PlaneMap, Size, Vec2, range, vec2};
use crate::raster::Lattice;
use backward::Backward;
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

/// The rectangle over which the points are evenly spread before they move, px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshFrame {
    /// Its upper left corner, px.
    pub corner: Vec2,
    /// Its sides, px.
    pub size: Vec2,
}

impl PartialEq for Mesh {
    fn eq(&self, other: &Self) -> bool {
        (self.columns, self.rows, self.frame) == (other.columns, other.rows, other.frame)
            && self.points == other.points
    }
}

impl MeshFrame {
    /// Sides of a frame.
    pub const SIDE_PX: range::Range = 1.0..=1e6;

    /// The whole canvas.
    pub fn of(canvas: Size) -> Self {
        Self { corner: Vec2::ZERO, size: vec2(canvas.width as f32, canvas.height as f32) }
    }
}

impl Mesh {
    /// Points along a side: two are a frame's corners; among more than 33 the user could not move
    /// single points.
    pub const SIDE: RangeInclusive<usize> = 2..=33;

    /// `None` for a grid with too few or too many points, or numbers that files cannot hold.
    pub fn new(columns: usize, rows: usize, frame: MeshFrame, points: Vec<Vec2>) -> Option<Self> {
        let mesh = Self { columns, rows, frame, points, backward: Arc::default() };
        mesh.fits().ok().map(|()| mesh)
    }

    /// A mesh that leaves everything in place.
    pub fn even(columns: usize, rows: usize, frame: MeshFrame) -> Option<Self> {
        let bare = Self { columns, rows, frame, points: Vec::new(), backward: Arc::default() };
        (Self::SIDE.contains(&columns) && Self::SIDE.contains(&rows)).then_some(())?;
        let places = (0..columns * rows).map(|k| bare.place(k)).collect();
        Self::new(columns, rows, frame, places)
    }

    /// Points from left to right.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Points from top to bottom.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The rectangle over which its points were spread.
    pub fn frame(&self) -> MeshFrame {
        self.frame
    }

    /// Row by row.
    pub fn points(&self) -> &[Vec2] {
        &self.points
    }

    /// The place of a point in the frame, by its number.
    fn place(&self, k: usize) -> Vec2 {
        self.frame.corner + vec2((k % self.columns) as f32, (k / self.columns) as f32) * self.cell()
    }

    /// The step from one point to the next in the frame.
    fn cell(&self) -> Vec2 {
        self.frame.size / vec2((self.columns - 1) as f32, (self.rows - 1) as f32)
    }

    /// Refuses what files cannot hold.
    pub fn fits(&self) -> Result<(), String> {
        for (what, count) in [("columns", self.columns), ("rows", self.rows)] {
            if !Self::SIDE.contains(&count) {
                let (least, most) = (Self::SIDE.start(), Self::SIDE.end());
                return Err(format!("the mesh has {count} {what}; it must have {least} to {most}"));
            }
        }
        let (found, wanted) = (self.points.len(), self.columns * self.rows);
        if found != wanted {
            return Err(format!(
                "the mesh has {found} points; {} × {} make {wanted}",
                self.columns, self.rows
            ));
        }
        for v in self.frame.size.to_array() {
            range::check_range("a side of the mesh's frame", v, &MeshFrame::SIDE_PX)?;
        }
        let places =
            self.points.iter().flat_map(|p| p.to_array()).chain(self.frame.corner.to_array());
        places
            .into_iter()
            .try_for_each(|v| range::check_range("a place of the mesh", v, &COORDINATE))
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
        let frame =
            MeshFrame { corner: self.frame.corner * per_axis, size: self.frame.size * per_axis };
        let points = self.points.iter().map(|p| *p * per_axis).collect();
        Self { frame, points, backward: Arc::default(), ..self.clone() }
    }

    /// The same on a plane moved by a map that keeps its frame a rectangle: moves, mirrors, quarter
    /// turns. `None` for other maps.
    pub(in crate::document) fn transformed(&self, map: &PlaneMap) -> Option<Self> {
        let [a, b, c, d, _, _] = map.coefficients()?;
        let (is_upright, is_turned) = (b == 0.0 && c == 0.0, a == 0.0 && d == 0.0);
        if !(is_upright || is_turned) {
            return None;
        }
        let (low, high) = (self.frame.corner, self.frame.corner + self.frame.size);
        let (p, q) = (map.to_canvas(low)?, map.to_canvas(high)?);
        let frame = MeshFrame { corner: p.min(q), size: (q - p).abs() };
        let (columns, rows) =
            if is_turned { (self.rows, self.columns) } else { (self.columns, self.rows) };
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
        let [o, x, y] = [0, self.columns - 1, (self.rows - 1) * self.columns]
            .map(|k| self.points[k].as_dvec2());
        let (along, down) =
            ((x - o) / f64::from(self.frame.size.x), (y - o) / f64::from(self.frame.size.y));
        let from = self.frame.corner.as_dvec2();
        let origin = o - along * from.x - down * from.y;
        let map = PlaneMap::affine([along.x, along.y, down.x, down.y, origin.x, origin.y])?;
        let is_there = |(k, p): (usize, &Vec2)| {
            map.to_canvas(self.place(k)).is_some_and(|q| q.distance(*p) < 1e-3)
        };
        self.points.iter().enumerate().all(is_there).then_some(map)
    }

    /// Where a point of the frame goes, and the derivative of that place.
    pub fn at(&self, p: Vec2) -> (Vec2, Mat2) {
        let s = (p - self.frame.corner) / self.cell();
        let (x, y) = (SplineWeights::at(s.x, self.columns), SplineWeights::at(s.y, self.rows));
        let (mut q, mut right, mut down) = (Vec2::ZERO, Vec2::ZERO, Vec2::ZERO);
        for (j, row) in y.around.into_iter().enumerate() {
            for (i, column) in x.around.into_iter().enumerate() {
                let point = self.point_or_extension(column, row);
                q += point * (x.value[i] * y.value[j]);
                right += point * (x.slope[i] * y.value[j]);
                down += point * (x.value[i] * y.slope[j]);
            }
        }
        (q, Mat2::from_cols(right / self.cell().x, down / self.cell().y))
    }

    /// A point, or its straight continuation where the grid ends.
    fn point_or_extension(&self, column: i32, row: i32) -> Vec2 {
        let along =
            |row: usize| extrapolate(column, self.columns, |i| self.points[row * self.columns + i]);
        extrapolate(row, self.rows, along)
    }

    /// Backward: the displacement from a point near the canvas to the point of the frame that shows
    /// there.
    pub(in crate::document) fn backward(&self, canvas: Size) -> Arc<Lattice> {
        let (size, known) =
            self.backward.get_or_init(|| (canvas, Arc::new(Backward::of(self, canvas).lattice())));
        if *size == canvas { known.clone() } else { Arc::new(Backward::of(self, canvas).lattice()) }
    }
}

/// The value at a place of a row, which is continued straight at both ends.
fn extrapolate(i: i32, count: usize, value: impl Fn(usize) -> Vec2) -> Vec2 {
    let last = count as i32 - 1;
    match i {
        _ if i < 0 => value(0) * (1 - i) as f32 + value(1) * i as f32,
        _ if i > last => {
            value(last as usize) * (1 + i - last) as f32
                - value(last as usize - 1) * (i - last) as f32
        }
        _ => value(i as usize),
    }
}

/// The weights of the four points around a place along one axis, and their derivatives.
struct SplineWeights {
    around: [i32; 4],
    value: [f32; 4],
    slope: [f32; 4],
}

impl SplineWeights {
    /// * `s`: in cells; beyond the grid the border is continued straight.
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

#[cfg(test)]
mod tests;
