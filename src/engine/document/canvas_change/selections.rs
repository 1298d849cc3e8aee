//! Selections on another canvas, each carried once however many strokes share it.
//! Floor 4.

use super::CanvasChange;
use crate::document::LayerMap;
use crate::math::plane_map::PixelMove;
use crate::math::{PlaneMap, Rect, Size, Vec2, vec2};
use crate::paint::{Selection, StrokeSelection};
use crate::raster::warp::warp_plane_onto;
use crate::raster::{CoverageGrid, Resampling, TILE};
use crate::surface::region::SurfaceRegion;
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

/// Selections and what became of them.
pub struct CarriedSelections<'c> {
    change: &'c CanvasChange,
    /// By the addresses of the old ones.
    known: RefCell<HashMap<*const Selection, CarriedSelection>>,
}

/// A selection with what became of it: the old one is kept so that no other gets its address.
type CarriedSelection = (Arc<Selection>, Arc<Selection>);

impl<'c> CarriedSelections<'c> {
    pub fn new(change: &'c CanvasChange) -> Self {
        Self { change, known: RefCell::default() }
    }

    pub fn of(&self, selection: &Arc<Selection>) -> Arc<Selection> {
        let mut known = self.known.borrow_mut();
        let (_, carried) = known.entry(Arc::as_ptr(selection)).or_insert_with(|| {
            let made = selection
                .made
                .map(|region| SurfaceRegion { at: self.change.point(region.at), ..region });
            (
                selection.clone(),
                Arc::new(Selection::provisional(self.coverage(&selection.coverage), made)),
            )
        });
        carried.clone()
    }

    pub fn of_stroke(&self, own: &StrokeSelection) -> StrokeSelection {
        StrokeSelection {
            selection: self.of(&own.selection),
            moved: self.change.matrix() * own.moved,
        }
    }

    fn coverage(&self, grid: &CoverageGrid) -> CoverageGrid {
        let rect = grid.covered_rect();
        if rect.is_empty() {
            return CoverageGrid::default();
        }
        match self.change.pixel_move() {
            Some(by) if self.change.is_shift() => grid.shifted(by.origin.0, by.origin.1),
            Some(by) => CoverageGrid::from_tiles(moved_rect(rect, by), |at, bytes| {
                for (y, row) in (at.rect().y0..).zip(bytes.as_chunks_mut::<TILE>().0) {
                    for (x, byte) in (at.rect().x0..).zip(row) {
                        let (sx, sy) = by.source(x, y);
                        *byte = grid.at(sx, sy);
                    }
                }
            }),
            None => self.sample_turned(grid, rect.grown(2)),
        }
    }

    /// Coverage of a rectangle, sampled once.
    fn sample_turned(&self, grid: &CoverageGrid, rect: Rect) -> CoverageGrid {
        let bounds = turned_rect(rect, &self.change.map);
        let shift = |x: i32, y: i32| PlaneMap::translation(vec2(x as f32, y as f32));
        let plane =
            shift(rect.x0, rect.y0).then(&self.change.map).then(&shift(-bounds.x0, -bounds.y0));
        let size = Size::new(bounds.width() as u32, bounds.height() as u32);
        let filter = Resampling::Smooth;
        let map = LayerMap::of_plane(plane, filter, size);
        let turned = warp_plane_onto(&grid.to_plane(rect), &map, filter, size);
        CoverageGrid::from_plane(&turned, bounds.x0, bounds.y0)
    }
}

/// Where a move takes a rectangle of pixels.
pub fn moved_rect(rect: Rect, by: PixelMove) -> Rect {
    let (a, b) = (by.target(rect.x0, rect.y0), by.target(rect.x1 - 1, rect.y1 - 1));
    Rect::new(a.0.min(b.0), a.1.min(b.1), a.0.max(b.0) + 1, a.1.max(b.1) + 1)
}

/// The pixels that a map takes a rectangle to, or a few more.
pub fn turned_rect(rect: Rect, map: &PlaneMap) -> Rect {
    let corners = [(rect.x0, rect.y0), (rect.x1, rect.y0), (rect.x1, rect.y1), (rect.x0, rect.y1)];
    let corners =
        corners.map(|(x, y)| map.to_canvas(vec2(x as f32, y as f32)).unwrap_or(Vec2::ZERO));
    let low = corners.into_iter().fold(Vec2::INFINITY, Vec2::min).floor() - 1.0;
    let high = corners.into_iter().fold(Vec2::NEG_INFINITY, Vec2::max).ceil() + 1.0;
    Rect::new(low.x as i32, low.y as i32, high.x as i32, high.y as i32)
}
