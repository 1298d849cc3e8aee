//! Both sides of contours as one: what surfaces and scenes answer alike, whether their pixels are
//! those of the canvas or readings of the far side. Floor 2. Five operations hold the difference:
//! where a pixel lies on the canvas, which pixels of a row are neighbors there, how rows step,
//! which surface is in front, and a map that is computed in front and read on the far side. Not
//! here: the readings themselves (`far_side`).

use super::FarSide;
use crate::math::{Rect, Size};
use crate::raster::TileAt;
use crate::surface::Surface;
use crate::surface::scene::Scene;
use std::ops::{Deref, Range};
use std::sync::Arc;

/// The surface of the canvas.
pub enum FrontSurface<'s> {
    /// The surface that was asked.
    Itself(&'s Surface),
    /// The one whose far side was asked.
    Of(Arc<Surface>),
}

impl Deref for FrontSurface<'_> {
    type Target = Surface;

    fn deref(&self) -> &Surface {
        match self {
            Self::Itself(surface) => surface,
            Self::Of(surface) => surface,
        }
    }
}

impl Surface {
    /// The canvas pixel whose readings a pixel holds; any where it holds none.
    #[inline(always)]
    pub fn canvas_pixel(&self, x: i32, y: i32) -> (i32, i32) {
        match self.as_far_side() {
            Some(far) => far.canvas_pixel(x, y),
            None => (x, y),
        }
    }

    /// A row's pixels, in runs that are neighbors on the canvas: the columns of each, and the canvas
    /// pixel of its first. In front the row is one run; on a far side each pixel is one.
    #[inline(always)]
    pub fn canvas_runs(
        &self,
        columns: Range<usize>,
        y: i32,
    ) -> impl Iterator<Item = (Range<usize>, (i32, i32))> {
        let step = match self.as_far_side() {
            Some(_) => 1,
            None => columns.len().max(1),
        };
        columns
            .clone()
            .step_by(step)
            .map(move |x| (x..(x + step).min(columns.end), self.canvas_pixel(x as i32, y)))
    }

    /// The same surface where its pixels are those of the canvas, so that pixels side by side see
    /// neighboring places; `None` for a far side.
    pub fn on_canvas(&self) -> Option<&Self> {
        self.as_far_side().is_none().then_some(self)
    }

    /// The size of the canvas, px.
    #[inline(always)]
    pub fn canvas_size(&self) -> Size {
        self.as_far_side().map_or(self.size(), FarSide::canvas)
    }

    /// The surface of the canvas: itself, or the one whose far side it is; `None` once nobody holds
    /// that any more.
    pub fn front(&self) -> Option<FrontSurface<'_>> {
        match self.as_far_side() {
            Some(far) => far.surface().map(FrontSurface::Of),
            None => Some(FrontSurface::Itself(self)),
        }
    }

    /// What is derived from a surface on either side.
    ///
    /// * `in_front`: computes it.
    /// * `on_far_side`: reads it from that of the surface in front, if there still is one.
    pub(in crate::surface) fn on_either_side<T>(
        &self,
        in_front: impl FnOnce() -> T,
        on_far_side: impl FnOnce(&FarSide, Option<&Surface>) -> T,
    ) -> T {
        match self.as_far_side() {
            Some(far) => on_far_side(far, far.surface().as_deref()),
            None => in_front(),
        }
    }
}

impl Scene {
    /// What the other sides of contour pixels see; `None` where no pixel has another one on a
    /// surface.
    pub fn far_side(&self) -> Option<Scene> {
        let far = self.surface.as_ref()?.far_side()?;
        Some(Scene { size: self.size, surface: Some(far) })
    }

    /// The scene of the canvas itself: where strokes are laid.
    pub fn front(&self) -> Scene {
        match self.as_far_side() {
            Some(far) => Scene { size: self.size, surface: far.surface() },
            None => self.clone(),
        }
    }

    /// What it is the far side of, if it is one.
    pub fn as_far_side(&self) -> Option<&FarSide> {
        self.surface.as_deref()?.as_far_side()
    }

    /// All its pixels: of the canvas, or of the far side.
    pub fn pixels(&self) -> Rect {
        match (self.as_far_side(), &self.surface) {
            (Some(_), Some(far)) => far.size().rect(),
            _ => self.size.rect(),
        }
    }

    /// The pixels that represent a tile of the canvas; of a far side at most as many, from some row
    /// of it on.
    pub fn area(&self, at: TileAt) -> Rect {
        match self.as_far_side() {
            Some(far) => far.contours().on(at).map_or(Rect::EMPTY, |contours| contours.far),
            None => at.rect().intersect(self.size.rect()),
        }
    }

    /// From a row that is rendered to the next: on a far side, every other row serves only for
    /// differences.
    pub fn row_step(&self) -> usize {
        if self.as_far_side().is_some() { 2 } else { 1 }
    }

    /// The rows of an area that are rendered.
    pub fn rows(&self, area: Rect) -> impl Iterator<Item = i32> + use<> {
        (area.y0..area.y1).step_by(self.row_step())
    }
}
