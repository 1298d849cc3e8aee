//! Points equally far apart on the surface, in nested levels: those of each level fill what the
//! levels before leave free, so that points of all levels up to any are even. Floor 2. Placed in a
//! fixed order that has nothing to do with rows.

use super::room::density_of;
use super::stretch::root;
use super::{HatchLine, HatchPoint, HatchSettings};
use crate::math::{Mat2, Vec2, hash, vec2};
use crate::raster::Plane;
use crate::surface::Surface;
use crate::surface::form_lines::SmoothNormals;
use rayon::prelude::*;

/// The side of a cell of the grid of points, px.
const CELL_PX: usize = 4;
/// From one place that is tried to the next, of the distance that is asked, and the least, px.
const TRIED_EVERY: (f32, f32) = (0.3, 1.0);
/// The least distance, px.
const LEAST_PX: f32 = 1.5;

/// A point that was placed.
#[derive(Clone, Copy)]
struct Stipple {
    at: Vec2,
    /// The object that it lies on.
    object: u32,
}

/// Points as they are placed.
struct Stipples<'s> {
    surface: &'s Surface,
    normals: &'s SmoothNormals,
    objects: &'s Plane<u32>,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<Stipple>>,
    placed: Vec<(u8, Vec2)>,
}

/// The points of all levels, the first level first.
pub(super) fn place_points(
    surface: &Surface,
    normals: &SmoothNormals,
    settings: &HatchSettings,
) -> Vec<HatchLine> {
    let size = surface.size();
    let objects = surface.objects();
    let [columns, rows] = [size.width, size.height].map(|n| (n as usize).div_ceil(CELL_PX));
    let cells = vec![Vec::new(); columns * rows];
    let objects = objects.labels();
    let mut all = Stipples { surface, normals, objects, columns, rows, cells, placed: Vec::new() };
    for (i, level) in settings.levels().iter().enumerate() {
        all.fill(i as u8, (level.apart * settings.spacing).max(LEAST_PX));
    }
    let last = settings.levels().last().map_or(1.0, |level| level.apart) * settings.spacing;
    let places: Vec<Vec2> = all.placed.iter().map(|(_, at)| *at).collect();
    let density = density_of(surface, places.iter().map(|at| (*at, 1.0)), last.max(LEAST_PX));
    let line = |(level, at): (u8, Vec2)| {
        let room_px = density.at(at).max(1.0 / (16.0 * last * last)).sqrt().recip();
        HatchLine { level, points: vec![HatchPoint { at, room_px }] }
    };
    all.placed.into_iter().map(line).collect()
}

impl Stipples<'_> {
    /// Places points wherever there is room for one.
    fn fill(&mut self, level: u8, apart: f32) {
        let size = self.surface.size();
        let step = (TRIED_EVERY.0 * apart).max(TRIED_EVERY.1);
        let [columns, rows] = [size.width, size.height].map(|n| (n as f32 / step) as u32 + 1);
        let place = |i: u32| {
            let [jx, jy] = hash::unit_pair(0x85eb + u32::from(level), i % columns, i / columns);
            vec2((i % columns) as f32 + jx, (i / columns) as f32 + jy) * step
        };
        // What is crowded already stays so: most places are sorted out row by row.
        let rows = (0..rows).into_par_iter();
        let mut order: Vec<u32> = rows
            .flat_map_iter(|row| row * columns..(row + 1) * columns)
            .filter(|i| self.free_object(place(*i), apart).is_some())
            .collect();
        order.sort_by_key(|&i| hash::mix(i ^ 0x2c1b_3c6d));
        for at in order.into_iter().map(place) {
            if let Some(object) = self.free_object(at, apart) {
                let cell = at.y as usize / CELL_PX * self.columns + at.x as usize / CELL_PX;
                self.cells[cell].push(Stipple { at, object });
                self.placed.push((level, at));
            }
        }
    }

    /// The object at a place with room for a point.
    fn free_object(&self, at: Vec2, apart: f32) -> Option<u32> {
        let (x, y) = (at.x as usize, at.y as usize);
        let size = self.surface.size();
        let is_inside = x < size.width as usize && y < size.height as usize;
        if !is_inside || self.surface.coverage(x, y) < 128 {
            return None;
        }
        let object = self.objects.at(x, y);
        let is_free = !self.is_crowded(at, object, root(self.normals, x, y), apart);
        is_free.then_some(object)
    }

    /// Whether a point of the same piece is nearer than a distance on the surface.
    fn is_crowded(&self, at: Vec2, object: u32, root: Mat2, apart: f32) -> bool {
        let near = |v: f32, n: usize| {
            let cell = |v: f32| (v.max(0.0) as usize / CELL_PX).min(n - 1);
            cell(v - apart)..=cell(v + apart)
        };
        let is_near = |other: &Stipple| {
            other.object == object && (root * (other.at - at)).length_squared() < apart * apart
        };
        let columns = near(at.x, self.columns);
        near(at.y, self.rows).any(|row| {
            let row = row * self.columns;
            self.cells[row + columns.start()..=row + columns.end()]
                .iter()
                .any(|cell| cell.iter().any(is_near))
        })
    }
}
