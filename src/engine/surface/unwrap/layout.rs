//! The planes of all objects of a surface, laid out next to each other on one sheet: what is seen
//! and painted flat. Floor 2. Not here: the picture of it (`document::view`), strokes on it
//! (`tools`).

use super::{PlaneView, UnwrapSettings, Unwrapping};
use crate::math::{Mat2, Rect, Size, Vec2, vec2};
use crate::surface::cache::HeapSize;
use crate::surface::{Anchor, Bend, Operator, Surface};
use std::sync::Arc;

/// The planes of a surface's objects side by side, and the canvas point at each pixel of the sheet.
pub struct PlaneLayout {
    settings: UnwrapSettings,
    unwrapping: Arc<Unwrapping>,
    /// The largest first.
    pieces: Vec<LaidPiece>,
    sheet: PlaneView,
}

impl HeapSize for PlaneLayout {
    /// Without the unwrapping, which is cached by itself.
    fn heap_bytes(&self) -> u64 {
        (self.pieces.len() * size_of::<LaidPiece>() + self.sheet.points.len() * size_of::<Vec2>())
            as u64
    }
}

/// One object's plane on the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaidPiece {
    /// The number of its object: see [`crate::surface::Objects::labels`].
    pub object: u32,
    /// The center of one of its pixels, canvas px.
    pub at: Vec2,
    /// From its plane to the sheet, whole px.
    pub shift: Vec2,
    /// On the sheet.
    pub rect: Rect,
}

/// What lies under a point of the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CanvasPlace {
    /// Canvas px.
    pub at: Vec2,
    /// The number of its object.
    pub object: u32,
    /// R: how the sheet lies turned against the picture there.
    pub turn: Mat2,
}

/// Between two pieces, and around them, px: room for what is painted over their rims.
const GAP_PX: i32 = 16;
/// A pen this far from a piece still paints on it, px of the sheet.
const BESIDE_PX: i32 = GAP_PX / 2;

impl PlaneLayout {
    /// `None` where no two neighboring pixels of the surface lie in a plane.
    pub fn new(surface: &Surface, settings: UnwrapSettings) -> Option<Self> {
        let unwrapping = surface.unwrapping(settings);
        let mut pieces = extents(surface, &unwrapping);
        let size = shelve(&mut pieces)?;
        let (w, objects) = (surface.size().width as usize, surface.objects());
        let labels = objects.labels();
        let most = pieces.iter().map(|piece| piece.object as usize + 1).max().unwrap_or(0);
        let mut shifts = vec![Vec2::NAN; most];
        pieces.iter().for_each(|piece| shifts[piece.object as usize] = piece.shift);
        let at = |i: usize| {
            let shift = shifts.get(labels.values()[i] as usize).copied().unwrap_or(Vec2::NAN);
            unwrapping.at(i % w, i / w) + shift
        };
        let sheet = PlaneView::rasterize(surface, size.rect(), at);
        Some(Self { settings, unwrapping, pieces, sheet })
    }

    /// Of the sheet.
    pub fn size(&self) -> Size {
        Size::new(self.sheet.rect.width() as u32, self.sheet.rect.height() as u32)
    }

    /// The pieces, as they are laid out.
    pub fn pieces(&self) -> &[LaidPiece] {
        &self.pieces
    }

    /// The canvas point at each pixel of the sheet.
    pub fn sheet(&self) -> &PlaneView {
        &self.sheet
    }

    /// What lays a picture of the sheet, placed pixel for pixel over it, onto the surface.
    pub fn bend(&self) -> Bend {
        let UnwrapSettings { amount, smooth_px } = self.settings;
        let pinned = |piece: &LaidPiece| {
            let (x, y) = (piece.at.x as usize, piece.at.y as usize);
            Anchor { at: piece.at, source: self.unwrapping.at(x, y) + piece.shift }
        };
        Bend {
            operator: Operator::Surface { amount, smooth: smooth_px },
            anchors: self.pieces.iter().take(Bend::MOST_ANCHORS).map(pinned).collect(),
            ..Bend::default()
        }
    }

    /// What lies under a point of the sheet. Next to a piece its plane goes on flat; `None` where
    /// that would be on another object, or is too far away.
    pub fn canvas_at(&self, surface: &Surface, p: Vec2) -> Option<CanvasPlace> {
        let piece = self.piece_at(p)?;
        if let Some(at) = self.sheet.sample(p) {
            return Some(CanvasPlace {
                at,
                object: piece.object,
                turn: self.unwrapping.place(surface, at).turn,
            });
        }
        let (x, y) = self.nearest(p)?;
        let rim = self.sheet.at(x, y)?;
        let place = self.unwrapping.place(surface, rim);
        let at = rim + place.turn.transpose() * (p - piece.shift - place.at);
        // On the canvas that point must belong to the same object, or to none.
        let is_its_own =
            at.is_finite() && self.unwrapping.place(surface, at).object == piece.object;
        is_its_own.then_some(CanvasPlace { at, object: piece.object, turn: place.turn })
    }

    /// Where a canvas point lies on the sheet.
    pub fn sheet_at(&self, surface: &Surface, q: Vec2) -> Option<Vec2> {
        let place = self.unwrapping.place(surface, q);
        let piece = self.pieces.iter().find(|piece| piece.object == place.object)?;
        Some(place.at + piece.shift)
    }

    /// The number of the object whose plane a canvas point lies in.
    pub fn object_at(&self, surface: &Surface, q: Vec2) -> u32 {
        self.unwrapping.place(surface, q).object
    }

    /// ∂U/∂q at a pixel of the canvas: the sheet's own shifts leave it as it is.
    pub fn jacobian(&self, surface: &Surface, x: usize, y: usize) -> Mat2 {
        self.unwrapping.jacobian(surface, x, y)
    }

    /// The canvas point in the middle of a piece; of one with a hole there, some point of it.
    pub fn middle_of(&self, surface: &Surface, piece: &LaidPiece) -> Vec2 {
        let Rect { x0, y0, x1, y1 } = piece.rect;
        let middle = vec2(0.5 * (x0 + x1) as f32, 0.5 * (y0 + y1) as f32);
        let shown =
            self.sheet.sample(middle).filter(|at| self.object_at(surface, *at) == piece.object);
        shown.unwrap_or(piece.at)
    }

    fn piece_at(&self, p: Vec2) -> Option<&LaidPiece> {
        let (x, y) = (p.x.floor() as i32, p.y.floor() as i32);
        self.pieces.iter().find(|piece| piece.rect.grown(BESIDE_PX).contains(x, y))
    }

    /// The nearest pixel of the sheet that shows the surface, within [`BESIDE_PX`].
    fn nearest(&self, p: Vec2) -> Option<(i32, i32)> {
        let (x, y) = (p.x.floor() as i32, p.y.floor() as i32);
        let around = (-BESIDE_PX..=BESIDE_PX)
            .flat_map(|dy| (-BESIDE_PX..=BESIDE_PX).map(move |dx| (x + dx, y + dy)));
        let shown = around.filter(|&(x, y)| self.sheet.at(x, y).is_some());
        shown.min_by(|a, b| {
            let distance =
                |&(x, y): &(i32, i32)| p.distance_squared(vec2(x as f32, y as f32) + 0.5);
            distance(a).total_cmp(&distance(b))
        })
    }
}

/// Each object whose plane shows something, with its extent there; not yet laid out.
fn extents(surface: &Surface, unwrapping: &Unwrapping) -> Vec<LaidPiece> {
    let objects = surface.objects();
    let labels = objects.labels();
    let mut found: Vec<Option<ObjectExtent>> = vec![None; objects.count() + 1];
    for (y, row) in (0..labels.height()).map(|y| (y, labels.row(y))) {
        for (x, &label) in row.iter().enumerate().filter(|(_, label)| **label > 0) {
            let (at, links) = (unwrapping.at(x, y), surface.links_plane().at(x, y));
            let Some(found) = found.get_mut(label as usize).filter(|_| at.is_finite()) else {
                continue;
            };
            let extent =
                found.get_or_insert(ObjectExtent { low: at, high: at, at: (x, y), links: 0 });
            (extent.low, extent.high) = (extent.low.min(at), extent.high.max(at));
            // At an anchor its own piece must be the one that is seen.
            if links.count_ones() > extent.links {
                (extent.at, extent.links) = ((x, y), links.count_ones());
            }
        }
    }
    let piece = |(object, extent): (usize, ObjectExtent)| {
        let (low, high) = (extent.low.floor(), extent.high.ceil());
        let rect = Rect::new(low.x as i32, low.y as i32, high.x as i32, high.y as i32);
        let at = vec2(extent.at.0 as f32, extent.at.1 as f32) + 0.5;
        (extent.links >= 2).then_some(LaidPiece {
            object: object as u32,
            at,
            shift: Vec2::ZERO,
            rect,
        })
    };
    let seen = found.into_iter().enumerate().filter_map(|(object, extent)| Some((object, extent?)));
    seen.filter_map(piece).filter(|piece| !piece.rect.is_empty()).collect()
}

/// What is known of an object's plane.
#[derive(Clone, Copy)]
struct ObjectExtent {
    low: Vec2,
    high: Vec2,
    /// Its pixel with the most links, the first of those, and how many they are.
    at: (usize, usize),
    links: u32,
}

/// Lays pieces out on shelves, the highest first, on a sheet about as high as wide; its size.
/// `None` without pieces.
fn shelve(pieces: &mut [LaidPiece]) -> Option<Size> {
    let room = |rect: &Rect| (rect.width() as i32 + GAP_PX, rect.height() as i32 + GAP_PX);
    pieces.sort_by_key(|piece| (std::cmp::Reverse(piece.rect.height()), piece.object));
    let area: f64 =
        pieces.iter().map(|p| room(&p.rect)).map(|(w, h)| f64::from(w) * f64::from(h)).sum();
    let widest = pieces.iter().map(|piece| room(&piece.rect).0).max()?;
    let width = widest.max((area.sqrt() * 1.1) as i32);
    let (mut left, mut top, mut shelf, mut right) = (0, 0, 0, 0);
    for piece in pieces.iter_mut() {
        let (w, h) = room(&piece.rect);
        if left > 0 && left + w > width {
            (left, top, shelf) = (0, top + shelf, 0);
        }
        let (x, y) = (left + GAP_PX, top + GAP_PX);
        piece.shift = vec2((x - piece.rect.x0) as f32, (y - piece.rect.y0) as f32);
        piece.rect = Rect::new(x, y, x + w - GAP_PX, y + h - GAP_PX);
        (left, shelf) = (left + w, shelf.max(h));
        right = right.max(left);
    }
    pieces.sort_by_key(|piece| {
        (std::cmp::Reverse(piece.rect.width() * piece.rect.height()), piece.object)
    });
    Some(Size::new((right + GAP_PX) as u32, (top + shelf + GAP_PX) as u32))
}

impl Surface {
    /// The sheet of its unwrapped planes, cached like them; `None` where it has none.
    pub fn plane_layout(&self, settings: UnwrapSettings) -> Option<Arc<PlaneLayout>> {
        let settings = settings.clamp_to_ranges(self.size());
        let laid = self
            .derived
            .plane_layouts
            .get_or_compute(settings.key(), 1, |_| PlaneLayout::new(self, settings).map(Arc::new));
        Option::clone(&laid)
    }

    /// The same if it is there already.
    pub fn cached_plane_layout(&self, settings: UnwrapSettings) -> Option<Arc<PlaneLayout>> {
        self.derived
            .plane_layouts
            .get(&settings.clamp_to_ranges(self.size()).key())
            .and_then(|laid| Option::clone(&laid))
    }
}

#[cfg(test)]
mod tests;
