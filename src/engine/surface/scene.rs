//! What a mark or a light falls on: the canvas and, where there is one, the surface.
//! Floor 2, below both `paint` and `shading`.

use super::Surface;
use crate::math::Size;
use std::sync::Arc;

/// The canvas that a layer sees. `surface`, where present, has the size of the canvas, or is the far
/// side of one: then the pixels are its readings, and what is rendered is what the other sides
/// of contour pixels see (`contours`).
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
}
