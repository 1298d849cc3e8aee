//! Selections: which pixels marks may change, softly. Coverage, with what it was made of, so that a
//! selection by surface is computed again when the surface changes. Floor 3. Coverage itself is
//! `raster::coverage`, regions of a surface are `surface::region`. Not here: which selection a
//! document has (`document`), how it is made (`tools`).

use super::scene::Scene;
use crate::math::{Range, Rect, Size, Vec2, vec2};
use crate::raster::coverage::{blank, product};
use crate::raster::tile::TILE_AREA;
use crate::raster::{CoverageGrid, CoverageTile, TILE, TileAt};
use crate::surface::Surface;
use crate::surface::region::SurfaceRegion;
use std::sync::{Arc, Weak};

/// A selection. It is never changed, so strokes and documents share it.
#[derive(Clone, Default)]
pub struct Selection {
    /// How much of each pixel is selected.
    pub coverage: CoverageGrid,
    /// The region of the surface that the coverage was found by; absent once the coverage was
    /// changed by hand.
    pub made: Option<SurfaceRegion>,
    /// Where the region was found last; absent: the coverage was carried from elsewhere.
    found: Option<FoundOn>,
}

/// A canvas and its surface, which is not held by this.
#[derive(Clone)]
struct FoundOn {
    size: Size,
    surface: Option<Weak<Surface>>,
}

impl FoundOn {
    fn new(scene: &Scene) -> Self {
        Self { size: scene.size, surface: scene.surface.as_ref().map(Arc::downgrade) }
    }

    fn is_on(&self, scene: &Scene) -> bool {
        let same =
            self.surface.as_ref().map(Weak::as_ptr) == scene.surface.as_ref().map(Arc::as_ptr);
        self.size == scene.size && same
    }
}

impl Selection {
    /// Coverage that belongs to no region of the surface.
    pub fn new(coverage: CoverageGrid) -> Self {
        Self { coverage, made: None, found: None }
    }

    /// Coverage that a region of the surface has for now, until it is found where it belongs.
    pub fn provisional(coverage: CoverageGrid, made: Option<SurfaceRegion>) -> Self {
        Self { coverage, made, found: None }
    }

    /// Everything that a region covers of a scene's surface; the whole canvas without a surface, as
    /// with masks that are derived from a surface.
    pub fn of_region(region: SurfaceRegion, scene: &Scene) -> Self {
        let coverage = match &scene.surface {
            Some(surface) => CoverageGrid::clone(&surface.region(&region)),
            None => CoverageGrid::full(scene.size.rect()),
        };
        Self { coverage, made: Some(region), found: Some(FoundOn::new(scene)) }
    }

    /// The same on another surface; `None` if it follows no surface or was found on this one.
    pub fn found_on(&self, scene: &Scene) -> Option<Self> {
        let is_known = self.found.as_ref().is_some_and(|found| found.is_on(scene));
        self.made.filter(|_| !is_known).map(|region| Self::of_region(region, scene))
    }

    /// What of it lies in a rectangle.
    pub fn within(self, rect: Rect) -> Self {
        Self { coverage: self.coverage.within(rect), ..self }
    }

    /// Nothing is selected.
    pub fn is_empty(&self) -> bool {
        self.coverage.is_empty()
    }

    /// With the same region, or with the same coverage.
    pub fn is_same(&self, other: &Selection) -> bool {
        match (&self.made, &other.made) {
            (Some(a), Some(b)) => a == b,
            (None, None) => self.coverage.is_same(&other.coverage),
            _ => false,
        }
    }
}

/// The selection that a stroke was painted in. It moves with the stroke.
#[derive(Clone)]
pub struct StrokeSelection {
    /// What is selected.
    pub selection: Arc<Selection>,
    /// How far the stroke was moved since, canvas px.
    pub moved: Vec2,
}

impl StrokeSelection {
    /// How far a stroke can have been moved along each axis, px.
    pub const MOVED_PX: Range = -1e6..=1e6;

    /// The selection where it was made.
    pub fn new(selection: Arc<Selection>) -> Self {
        Self { selection, moved: Vec2::ZERO }
    }

    /// The same, moved by so many pixels.
    pub fn moved(&self, by: Vec2) -> Self {
        Self { selection: self.selection.clone(), moved: self.moved + by }
    }

    /// The coverage of a tile; `None` where nothing of it is selected. Between pixels it is
    /// interpolated.
    pub fn tile(&self, at: TileAt) -> Option<Arc<CoverageTile>> {
        let grid = &self.selection.coverage;
        if self.moved == Vec2::ZERO {
            return grid.tile(at).cloned();
        }
        let (least, most) = (*Self::MOVED_PX.start(), *Self::MOVED_PX.end());
        let whole = self.moved.floor().max(Vec2::splat(least)).min(Vec2::splat(most));
        let (dx, dy, part) = (whole.x as i32, whole.y as i32, self.moved - whole);
        let mut sums = [0.0f32; TILE_AREA];
        let weights = [
            (0, 0, (1.0 - part.x) * (1.0 - part.y)),
            (1, 0, part.x * (1.0 - part.y)),
            (0, 1, (1.0 - part.x) * part.y),
            (1, 1, part.x * part.y),
        ];
        for (ox, oy, weight) in weights.into_iter().filter(|weight| weight.2 > 0.0) {
            for (y, sums) in (at.rect().y0..).zip(sums.as_chunks_mut::<TILE>().0) {
                let mut row = [0; TILE];
                let from = |v: i32, d: i32, o: i32| v.saturating_sub(d).saturating_sub(o);
                grid.copy_row(from(at.rect().x0, dx, ox), from(y, dy, oy), &mut row);
                sums.iter_mut().zip(row).for_each(|(sum, c)| *sum += weight * f32::from(c));
            }
        }
        let mut bytes = blank(0);
        bytes.iter_mut().zip(sums).for_each(|(b, sum)| *b = (sum + 0.5) as u8);
        CoverageTile::new(bytes)
    }

    /// The coverage where the stroke is now.
    pub fn coverage(&self) -> CoverageGrid {
        if self.moved == Vec2::ZERO {
            return self.selection.coverage.clone();
        }
        let bounds = self.selection.coverage.bounds();
        let (low, high) = (self.moved.floor(), self.moved.ceil());
        let side = |v: i32, by: f32| v.saturating_add(by as i32);
        let to = crate::math::Rect::new(
            side(bounds.x0, low.x),
            side(bounds.y0, low.y),
            side(bounds.x1, high.x),
            side(bounds.y1, high.y),
        );
        CoverageGrid::gather(to, |at| self.tile(at))
    }

    /// The same stroke, limited to this selection too.
    pub fn narrowed(&self, to: &CoverageGrid) -> Self {
        Self::new(Arc::new(Selection::new(self.coverage().combined(to, product))))
    }

    /// Both select the same.
    pub fn is_same(&self, other: &Self) -> bool {
        let same_place = self.moved == other.moved;
        same_place
            && (Arc::ptr_eq(&self.selection, &other.selection)
                || self.selection.is_same(&other.selection))
    }

    /// On a canvas of another size, with the selection scaled.
    pub fn scaled(&self, selection: Arc<Selection>, per_axis: Vec2) -> Self {
        Self { selection, moved: vec2(self.moved.x * per_axis.x, self.moved.y * per_axis.y) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash;
    use crate::raster::Plane;

    fn blot() -> Arc<Selection> {
        let plane = Plane::from_fn(Size::new(90, 70), |x, y| hash::mix((x * 91 + y) as u32) as u8);
        Arc::new(Selection::new(CoverageGrid::from_plane(&plane, 20, 30)))
    }

    #[test]
    fn a_moved_selection_is_the_same_elsewhere_and_between_pixels_their_mean() {
        let (own, selection) = (StrokeSelection::new(blot()), blot());
        let whole = own.moved(vec2(-37.0, 101.0)).coverage();
        assert!(whole.is_same(&selection.coverage.shifted(-37, 101)));
        let back = own.moved(vec2(12.0, -5.0)).moved(vec2(-12.0, 5.0));
        assert!(back.coverage().is_same(&selection.coverage));
        let half = own.moved(vec2(0.5, 0.0)).coverage();
        let mean = |x, y| {
            (f32::from(own.selection.coverage.at(x, y))
                + f32::from(own.selection.coverage.at(x - 1, y)))
                / 2.0
        };
        for (x, y) in (18..115).flat_map(|x| (28..104).map(move |y| (x, y))) {
            assert!((f32::from(half.at(x, y)) - mean(x, y)).abs() <= 0.51, "{x}, {y}");
        }
    }

    #[test]
    fn a_region_without_a_surface_is_the_whole_canvas() {
        let scene = Scene { size: Size::new(100, 70), surface: None };
        let region = SurfaceRegion::new(Default::default(), vec2(5.0, 5.0));
        let selection = Selection::of_region(region, &scene);
        assert!(selection.coverage.is_same(&CoverageGrid::full(Rect::new(0, 0, 100, 70))));
        assert!(selection.found_on(&scene).is_none(), "it was found there");
        let wide = Scene { size: Size::new(120, 70), surface: None };
        assert_eq!(
            selection.found_on(&wide).unwrap().coverage.covered_rect(),
            Rect::new(0, 0, 120, 70)
        );
        assert!(blot().found_on(&scene).is_none());
    }
}
