//! Drawings of nothing but paths in plain colors, such as the outlines of letters. They are painted
//! in cells, rectangles between which no path lies, side by side; where a drawing was painted before,
//! only its cells that are new. Floor 5. Not here: drawings with ramps, pictures, masks or filters,
//! which the renderer paints as a whole (`svg`).

use super::straight;
use crate::math::{Rect, Size};
use rayon::prelude::*;
use resvg::tiny_skia::{self, Pixmap};
use resvg::usvg::{Group, Node, Paint, PaintOrder, Path, Transform};
use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// A path in plain colors, in its place.
#[derive(Clone, Debug)]
pub(crate) struct PlainPath {
    path: Arc<Path>,
    /// From its own px to those of the drawing, the outermost first.
    transforms: Vec<Transform>,
}

impl PartialEq for PlainPath {
    /// The same path in the same place.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.path, &other.path) && self.transforms == other.transforms
    }
}

impl PlainPath {
    /// The same path within further transforms, the outermost first.
    pub fn within(&self, outer: &[Transform]) -> Self {
        let transforms = [outer, self.transforms.as_slice()].concat();
        Self { path: self.path.clone(), transforms }
    }

    /// From its own px to those of a picture.
    fn transform(&self, to_picture: Transform) -> Transform {
        self.transforms.iter().fold(to_picture, |all, inner| all.pre_concat(*inner))
    }

    /// The pixels that it may touch.
    fn rect(&self, scale: f32, size: Size) -> Rect {
        let to_picture = self.transform(Transform::from_scale(scale, scale));
        let bounds = self.path.stroke_bounding_box().transform(to_picture);
        // What has no bounds may be anywhere.
        let Some(bounds) = bounds else { return size.rect() };
        let (x0, y0) = (bounds.left().floor() as i32, bounds.top().floor() as i32);
        let (x1, y1) = (bounds.right().ceil() as i32, bounds.bottom().ceil() as i32);
        let touched = Rect {
            x0: x0.saturating_sub(1),
            y0: y0.saturating_sub(1),
            x1: x1.saturating_add(2),
            y1: y1.saturating_add(2),
        };
        touched.intersect(size.rect())
    }

    /// Paints it as the renderer of drawings does.
    fn paint(&self, to_picture: Transform, pixmap: &mut Pixmap) {
        let transform = self.transform(to_picture);
        let fills_first = self.path.paint_order() == PaintOrder::FillAndStroke;
        for is_fill in [fills_first, !fills_first] {
            match is_fill {
                true => self.fill(transform, pixmap),
                false => self.stroke(transform, pixmap),
            }
        }
    }

    fn fill(&self, transform: Transform, pixmap: &mut Pixmap) {
        let Some(fill) = self.path.fill() else { return };
        let bounds = self.path.data().bounds();
        if bounds.width() == 0.0 || bounds.height() == 0.0 {
            return;
        }
        let rule = match fill.rule() {
            resvg::usvg::FillRule::NonZero => tiny_skia::FillRule::Winding,
            resvg::usvg::FillRule::EvenOdd => tiny_skia::FillRule::EvenOdd,
        };
        if let Some(paint) = self.ink(fill.paint(), fill.opacity().to_u8()) {
            pixmap.fill_path(self.path.data(), &paint, rule, transform, None);
        }
    }

    fn stroke(&self, transform: Transform, pixmap: &mut Pixmap) {
        let Some(stroke) = self.path.stroke() else { return };
        if let Some(paint) = self.ink(stroke.paint(), stroke.opacity().to_u8()) {
            let line = stroke.to_tiny_skia();
            pixmap.stroke_path(self.path.data(), &paint, &line, transform, None);
        }
    }

    fn ink(&self, paint: &Paint, opacity: u8) -> Option<tiny_skia::Paint<'static>> {
        let Paint::Color(color) = paint else { return None };
        let mut ink = tiny_skia::Paint::default();
        ink.set_color_rgba8(color.red, color.green, color.blue, opacity);
        ink.anti_alias = self.path.rendering_mode().use_shape_antialiasing();
        Some(ink)
    }
}

/// The paths of a drawing, the lowest first; `None` if it holds anything else.
pub(crate) fn plain_paths(root: &Group) -> Option<Vec<PlainPath>> {
    let mut found = Vec::new();
    try_collect(root, &[], &mut found).then_some(found)
}

/// Adds the paths of a group; whether there is nothing else in it.
fn try_collect(group: &Group, outer: &[Transform], found: &mut Vec<PlainPath>) -> bool {
    let is_bare = group.filters().is_empty()
        && group.mask().is_none()
        && group.clip_path().is_none()
        && !group.should_isolate();
    let mut transforms = outer.to_vec();
    if !group.transform().is_identity() {
        transforms.push(group.transform());
    }
    is_bare
        && group.children().iter().all(|node| match node {
            Node::Group(group) => try_collect(group, &transforms, found),
            Node::Text(text) => try_collect(text.flattened(), &transforms, found),
            Node::Image(_) => false,
            Node::Path(path) => {
                let paints = [path.fill().map(|f| f.paint()), path.stroke().map(|s| s.paint())];
                if path.is_visible() {
                    let path = Arc::new(Path::clone(path));
                    found.push(PlainPath { path, transforms: transforms.clone() });
                }
                paints.into_iter().flatten().all(|paint| matches!(paint, Paint::Color(_)))
            }
        })
}

/// A rectangle of a picture that paths touch which touch no other one.
#[derive(Clone, Debug, PartialEq)]
struct PathCell {
    rect: Rect,
    /// The lowest first.
    paths: Vec<PlainPath>,
}

/// A picture of paths, and how it was painted.
#[derive(Clone, Debug)]
pub(crate) struct PaintedPaths {
    size: Size,
    scale: f32,
    cells: Vec<PathCell>,
    /// Straight bytes, one texel for each pixel.
    pub texels: Arc<[[u8; 4]]>,
}

impl PaintedPaths {
    /// Paints paths in a picture of a size, enlarged. `None` where that panics, or there is no room.
    pub fn paint(paths: &[PlainPath], size: Size, scale: f32) -> Option<Self> {
        let cells = cells(paths, size, scale);
        let painted = paint_cells(&cells.iter().collect::<Vec<_>>(), scale)?;
        let mut texels: Arc<[[u8; 4]]> = std::iter::repeat_n([0; 4], size.area()).collect();
        put_cells(&painted, size, Arc::get_mut(&mut texels)?);
        Some(Self { size, scale, cells, texels })
    }

    /// The same as [`Self::paint`], with the cells of this picture that are as they were; and the
    /// rectangle in which it is another. `None` for the rectangle if all of it may be.
    pub fn repaint(
        &self,
        paths: &[PlainPath],
        size: Size,
        scale: f32,
    ) -> Option<(Self, Option<Rect>)> {
        if size != self.size || scale != self.scale {
            return Some((Self::paint(paths, size, scale)?, None));
        }
        let cells = cells(paths, size, scale);
        let places = |cells: &[PathCell]| -> HashMap<(i32, i32), usize> {
            cells.iter().enumerate().map(|(i, cell)| ((cell.rect.x0, cell.rect.y0), i)).collect()
        };
        let (old, new) = (places(&self.cells), places(&cells));
        let is_in = |cell: &PathCell, all: &[PathCell], places: &HashMap<(i32, i32), usize>| {
            places.get(&(cell.rect.x0, cell.rect.y0)).is_some_and(|i| all[*i] == *cell)
        };
        let gone = self.cells.iter().filter(|cell| !is_in(cell, &cells, &new));
        let gone: Vec<Rect> = gone.map(|cell| cell.rect).collect();
        let made: Vec<&PathCell> =
            cells.iter().filter(|cell| !is_in(cell, &self.cells, &old)).collect();
        let mut texels = self.texels.clone();
        let rects = gone.iter().copied().chain(made.iter().map(|cell| cell.rect));
        let changed = rects.fold(Rect::EMPTY, |all, rect| all.union(rect));
        if !changed.is_empty() {
            let painted = paint_cells(&made, scale)?;
            let all = Arc::make_mut(&mut texels);
            let width = size.width as usize;
            for rect in gone {
                for y in rect.y0..rect.y1 {
                    let row = y as usize * width;
                    all[row + rect.x0 as usize..row + rect.x1 as usize].fill([0; 4]);
                }
            }
            put_cells(&painted, size, all);
        }
        Some((Self { size, scale, cells, texels }, Some(changed)))
    }
}

/// Paths in cells that have no pixel in common: first by rows, then by columns.
fn cells(paths: &[PlainPath], size: Size, scale: f32) -> Vec<PathCell> {
    let rects: Vec<Rect> = paths.iter().map(|path| path.rect(scale, size)).collect();
    let touching = (0..paths.len()).filter(|i| !rects[*i].is_empty()).collect();
    let bands = split(touching, |i| (rects[i].y0, rects[i].y1));
    let cells = bands.into_iter().flat_map(|band| split(band, |i| (rects[i].x0, rects[i].x1)));
    let cell = |mut members: Vec<usize>| {
        members.sort_unstable();
        let rect = members.iter().fold(Rect::EMPTY, |all, i| all.union(rects[*i]));
        PathCell { rect, paths: members.into_iter().map(|i| paths[i].clone()).collect() }
    };
    cells.map(cell).collect()
}

/// Things in groups whose spans have nothing in common, the first one first.
fn split(mut things: Vec<usize>, span: impl Fn(usize) -> (i32, i32)) -> Vec<Vec<usize>> {
    things.sort_by_key(|i| span(*i));
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut end = i32::MIN;
    for i in things {
        let (from, to) = span(i);
        match groups.last_mut().filter(|_| from < end) {
            Some(group) => group.push(i),
            None => groups.push(vec![i]),
        }
        end = end.max(to);
    }
    groups
}

fn paint_cells(cells: &[&PathCell], scale: f32) -> Option<Vec<(Rect, Pixmap)>> {
    let paint = |cell: &&PathCell| {
        let rect = cell.rect;
        let mut pixmap = Pixmap::new(rect.width() as u32, rect.height() as u32)?;
        let (left, top) = (rect.x0 as f32, rect.y0 as f32);
        let to_cell = Transform::from_row(scale, 0.0, 0.0, scale, -left, -top);
        // The painter is third-party code: a panic counts as a damaged file.
        let paint = || cell.paths.iter().for_each(|path| path.paint(to_cell, &mut pixmap));
        catch_unwind(AssertUnwindSafe(paint)).ok()?;
        Some((rect, pixmap))
    };
    cells.par_iter().map(paint).collect()
}

/// Puts painted cells into a picture.
fn put_cells(painted: &[(Rect, Pixmap)], size: Size, texels: &mut [[u8; 4]]) {
    /// Rows that a thread fills at a time.
    const ROWS: usize = 64;
    let width = size.width as usize;
    let bands = texels.par_chunks_mut((ROWS * width).max(1)).enumerate();
    bands.for_each(|(band, texels)| {
        let top = (band * ROWS) as i32;
        let rows =
            Rect { x0: 0, y0: top, x1: width as i32, y1: top + (texels.len() / width) as i32 };
        for (rect, pixmap) in painted {
            let part = rect.intersect(rows);
            let (from, _) = pixmap.data().as_chunks::<4>();
            for y in part.y0..part.y1 {
                let first = (y - rect.y0) as usize * rect.width();
                let to = (y - top) as usize * width + rect.x0 as usize;
                let row = &from[first..first + rect.width()];
                for (texel, painted) in texels[to..to + rect.width()].iter_mut().zip(row) {
                    *texel = straight(*painted);
                }
            }
        }
    });
}
