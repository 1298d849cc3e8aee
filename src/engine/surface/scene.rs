//! What a mark or a light falls on: the canvas and, where there is one, the surface.
//! Floor 2, below both `paint` and `shading`.

use super::Surface;
use super::contours::SheetOf;
use crate::math::{Rect, Size};
use crate::raster::TileAt;
use std::sync::Arc;

/// The canvas that a layer sees. `surface`, where present, has the size of the canvas, or is a
/// sheet: then the pixels are those of the sheet, and what is rendered is what the other
/// populations of contour pixels see.
#[derive(Clone)]
pub struct Scene {
    /// The canvas, px.
    pub size: Size,
    /// What is painted on; absent: a flat canvas.
    pub surface: Option<Arc<Surface>>,
}

impl Scene {
    /// Whether both have the same canvas and the identical surface: tiles rendered for one are
    /// valid for the other.
    pub fn is_same(&self, other: &Scene) -> bool {
        let same_surface = match (&self.surface, &other.surface) {
            (None, None) => true,
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            _ => false,
        };
        self.size == other.size && same_surface
    }

    /// What the other populations of contour pixels see; `None` where no pixel has another one on a
    /// surface.
    pub fn behind(&self) -> Option<Scene> {
        let sheet = self.surface.as_ref()?.sheet()?;
        Some(Scene { size: self.size, surface: Some(sheet) })
    }

    /// The scene of the canvas itself: where strokes are laid.
    pub fn front(&self) -> Scene {
        match self.sheet() {
            Some(sheet) => Scene { size: self.size, surface: sheet.surface() },
            None => self.clone(),
        }
    }

    /// What it is the sheet of, if it is one.
    pub fn sheet(&self) -> Option<&SheetOf> {
        self.surface.as_deref()?.sheet_of()
    }

    /// All its pixels: of the canvas, or of the sheet.
    pub fn pixels(&self) -> Rect {
        match (self.sheet(), &self.surface) {
            (Some(_), Some(sheet)) => sheet.size().rect(),
            _ => self.size.rect(),
        }
    }

    /// The pixels that represent a tile of the canvas; of a sheet at most as many, from some row of
    /// it on.
    pub fn area(&self, at: TileAt) -> Rect {
        match self.sheet() {
            Some(sheet) => sheet.contours().on(at).map_or(Rect::EMPTY, |contours| contours.sheet),
            None => at.rect().intersect(self.size.rect()),
        }
    }

    /// The rows of an area that are rendered: in a sheet, every other row serves only for
    /// differences.
    pub fn rows(&self, area: Rect) -> impl Iterator<Item = i32> + use<> {
        (area.y0..area.y1).step_by(if self.sheet().is_some() { 2 } else { 1 })
    }
}
