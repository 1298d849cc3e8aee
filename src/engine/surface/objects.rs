//! Objects: the pieces into which silhouette and depth jumps split a surface, and the limits they
//! set to marks. Floor 2. Which neighboring pixels belong together is found by `links`.

use super::cache::HeapSize;
use super::pyramid::BLOCK;
use super::{ContourPixel, Surface, links};
use crate::math::{Rect, Size, Vec2, union_find};
use crate::memory::once;
use crate::raster::Plane;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// Pieces smaller than this are fragments of a ragged edge, not objects: they join the neighbor
/// nearest in depth. The area is relative to the longer side squared, so that a picture splits the
/// same way at any size.
const FRAGMENT_SIDE: (f32, f32) = (0.006, 4.0);

/// Which object each pixel of a surface belongs to.
pub struct Objects {
    /// 0 where there is no surface, else one more than the object's place in `rects`.
    labels: Plane<u32>,
    rects: Vec<Rect>,
    /// As [`Objects::objects_of_blocks`] gives them.
    blocks: OnceLock<Plane<u32>>,
}

/// One object of a surface: 1 is the one whose first pixel comes first, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ObjectId(u32);

impl Objects {
    /// Splits a surface: pixels belong to one object if they show the same part, or, where no parts
    /// are known, if a path of linked neighbors joins them.
    fn new(surface: &Surface) -> Self {
        surface.on_either_side(
            || Self::in_front(surface),
            |far, front| {
                // Those of the other sides: nobody needs to know where they lie.
                let whole = front.map(Surface::objects);
                let label =
                    |x: usize, y: usize| whole.as_ref().map_or(0, |whole| whole.labels.at(x, y));
                let of = |pixel: &ContourPixel| {
                    pixel.nearest_other().map_or(0, |(x, y)| label(x as usize, y as usize))
                };
                Self::of_labels(far.map(surface.size(), of), Vec::new())
            },
        )
    }

    fn in_front(surface: &Surface) -> Self {
        if let Some(parts) = surface.parts_plane() {
            return Self::of_parts(surface, parts);
        }
        let mut pieces = PieceForest::of(surface);
        pieces.join_fragments(surface);
        pieces.number_objects(surface)
    }

    /// One object for each part that is seen.
    fn of_parts(surface: &Surface, parts: &Plane<u32>) -> Self {
        let mut numbers = BTreeMap::new();
        let (mut labels, mut rects) = (Plane::full(surface.size(), 0), Vec::new());
        let width = parts.width();
        let seen = parts.values().iter().zip(surface.coverage_plane().values()).enumerate();
        for (i, (part, _)) in seen.filter(|(_, (part, covered))| **part > 0 && **covered > 0) {
            let label = *numbers.entry(*part).or_insert_with(|| {
                rects.push(Rect::EMPTY);
                rects.len() as u32
            });
            labels.values_mut()[i] = label;
            let (x, y) = ((i % width) as i32, (i / width) as i32);
            let rect = &mut rects[label as usize - 1];
            *rect = rect.union(Rect::new(x, y, x + 1, y + 1));
        }
        Self::of_labels(labels, rects)
    }

    fn of_labels(labels: Plane<u32>, rects: Vec<Rect>) -> Self {
        Self { labels, rects, blocks: OnceLock::new() }
    }

    /// The object that covers a pixel; `None` off the surface and off the canvas.
    pub fn at(&self, x: i32, y: i32) -> Option<ObjectId> {
        self.labels.get(x, y).filter(|label| *label > 0).map(ObjectId)
    }

    /// The object that covers all pixels of each block of the canvas and the ring around it; 0
    /// where there is none.
    pub(in crate::surface) fn objects_of_blocks(&self) -> &Plane<u32> {
        once(&self.blocks, || {
            let (w, h) = (self.labels.width(), self.labels.height());
            let size = Size::new(w.div_ceil(BLOCK) as u32, h.div_ceil(BLOCK) as u32);
            Plane::from_fn(size, |x, y| {
                let (x, y) = (x * BLOCK, y * BLOCK);
                if x == 0 || y == 0 || x + BLOCK >= w || y + BLOCK >= h {
                    return 0;
                }
                let object = self.labels.at(x, y);
                let is_own = |y: usize| {
                    self.labels.row(y)[x - 1..=x + BLOCK].iter().all(|label| *label == object)
                };
                if (y - 1..=y + BLOCK).all(is_own) { object } else { 0 }
            })
        })
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.rects.len()
    }

    /// The smallest rectangle that holds an object; empty for one of another surface.
    pub fn rect(&self, object: ObjectId) -> Rect {
        self.rects.get(object.0 as usize - 1).copied().unwrap_or(Rect::EMPTY)
    }

    /// For each pixel the number of its object, from 1 on; 0 where there is no surface.
    pub fn labels(&self) -> &Plane<u32> {
        &self.labels
    }
}

/// A union-find forest: each pixel points to an earlier pixel of its piece, the first to itself.
struct PieceForest {
    parent: Vec<u32>,
    /// Of the piece, at its first pixel.
    area: Vec<u32>,
    width: usize,
}

impl PieceForest {
    fn of(surface: &Surface) -> Self {
        let size = surface.size();
        let mut pieces = Self {
            parent: (0..size.area() as u32).collect(),
            area: vec![1; size.area()],
            width: size.width as usize,
        };
        for (i, &linked) in surface.links_plane().values().iter().enumerate() {
            if linked & links::LEFT != 0 {
                pieces.join(i - 1, i);
            }
            if linked & links::UP != 0 {
                pieces.join(i - pieces.width, i);
            }
        }
        pieces
    }

    /// The first pixel of a pixel's piece.
    fn first(&mut self, i: usize) -> usize {
        union_find::first_of(&mut self.parent, i as u32) as usize
    }

    fn join(&mut self, a: usize, b: usize) {
        if let (first, Some(later)) = union_find::join(&mut self.parent, a as u32, b as u32) {
            self.area[first as usize] += self.area[later as usize];
        }
    }

    /// Merges pieces that are too small into their neighbors, across the smallest depth steps
    /// first.
    fn join_fragments(&mut self, surface: &Surface) {
        let side = (FRAGMENT_SIDE.0 * surface.size().longer_side()).max(FRAGMENT_SIDE.1);
        let fragment_px = (side * side) as u32;
        let covered = |i: usize| surface.coverage_plane().values()[i] > 0;
        let depth = surface.depth_plane().values();
        let mut torn = Vec::new();
        for (i, &linked) in surface.links_plane().values().iter().enumerate() {
            let (has_left, has_above) = (i % self.width > 0, i >= self.width);
            for (bit, has, step) in [(links::LEFT, has_left, 1), (links::UP, has_above, self.width)]
            {
                if has && linked & bit == 0 && covered(i) && covered(i - step) {
                    let (a, b) = (self.first(i), self.first(i - step));
                    if self.area[a].min(self.area[b]) < fragment_px {
                        torn.push(((depth[i] - depth[i - step]).abs(), i, i - step));
                    }
                }
            }
        }
        torn.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        for (_, i, j) in torn {
            let (a, b) = (self.first(i), self.first(j));
            if self.area[a].min(self.area[b]) < fragment_px {
                self.join(a, b);
            }
        }
    }

    fn number_objects(mut self, surface: &Surface) -> Objects {
        let mut labels = Plane::full(surface.size(), 0);
        let mut rects: Vec<Rect> = Vec::new();
        for i in 0..self.parent.len() {
            if surface.coverage_plane().values()[i] == 0 {
                continue;
            }
            let first = self.first(i);
            // A piece's first pixel comes first, so it has been numbered.
            let label = if first == i { rects.len() as u32 + 1 } else { labels.values()[first] };
            labels.values_mut()[i] = label;
            let (x, y) = ((i % self.width) as i32, (i / self.width) as i32);
            let pixel = Rect::new(x, y, x + 1, y + 1);
            match rects.get_mut(label as usize - 1) {
                Some(rect) => *rect = rect.union(pixel),
                None => rects.push(pixel),
            }
        }
        Objects::of_labels(labels, rects)
    }
}

impl HeapSize for Objects {
    fn heap_bytes(&self) -> u64 {
        let rects = (self.rects.len() * size_of::<Rect>()) as u64;
        self.labels.heap_bytes() + rects + self.blocks.get().map_or(0, Plane::heap_bytes)
    }
}

impl Surface {
    /// The objects of the surface, cached. Normal layers do not change them: jumps depend on depth
    /// alone.
    pub fn objects(&self) -> Arc<Objects> {
        let base = self.base();
        base.derived.objects.get_or_compute((), 1, |_| Objects::new(base))
    }
}

crate::named! {
    /// Where a mark may paint.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum PaintLimit {
        /// Everywhere.
        #[default]
        Free = "free",
        /// Where the surface is.
        Surface = "surface",
        /// Only on the object on which the mark begins; a mark that begins off the surface stays
        /// off it.
        Object = "object",
    }
}

impl PaintLimit {
    /// The part of the canvas that a mark beginning at `start` (canvas px) may touch: all of it
    /// without a surface.
    pub fn from(self, surface: Option<&Arc<Surface>>, start: Vec2) -> CanvasPart {
        let Some(surface) = surface else { return CanvasPart::Whole };
        match self {
            PaintLimit::Free => CanvasPart::Whole,
            PaintLimit::Surface => CanvasPart::Surface(surface.clone()),
            PaintLimit::Object => {
                // There is no surface off the canvas, nor at a point that is not a number.
                let pixel = start.floor().as_ivec2();
                let objects = surface.objects();
                let surface = surface.clone();
                match objects.at(pixel.x, pixel.y).filter(|_| start.is_finite()) {
                    Some(object) => CanvasPart::Object { surface, objects, object },
                    None => CanvasPart::Backdrop(surface),
                }
            }
        }
    }
}

/// A part of the canvas.
#[derive(Clone)]
pub enum CanvasPart {
    /// All of it.
    Whole,
    /// What a surface covers.
    Surface(Arc<Surface>),
    /// One object of a surface.
    Object {
        /// The surface that it is part of.
        surface: Arc<Surface>,
        /// The objects of that surface.
        objects: Arc<Objects>,
        /// Which of them.
        object: ObjectId,
    },
    /// All that the surface does not cover.
    Backdrop(Arc<Surface>),
}

impl CanvasPart {
    /// The share of a pixel that is in the part, `[0, 1]`; off the canvas there is no surface.
    pub fn coverage(&self, x: i32, y: i32) -> f32 {
        let covered = |surface: &Surface| {
            surface.coverage_plane().get(x, y).map_or(0.0, |c| f32::from(c) / 255.0)
        };
        match self {
            CanvasPart::Whole => 1.0,
            CanvasPart::Surface(surface) => covered(surface),
            CanvasPart::Backdrop(surface) => 1.0 - covered(surface),
            CanvasPart::Object { surface, objects, object } => {
                if objects.at(x, y) == Some(*object) { covered(surface) } else { 0.0 }
            }
        }
    }

    /// Whether it is all of the canvas.
    pub fn is_whole(&self) -> bool {
        matches!(self, CanvasPart::Whole)
    }
}

#[cfg(test)]
mod tests;
