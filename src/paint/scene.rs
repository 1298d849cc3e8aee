//! What a mark is painted on: the canvas and, where there is one, the surface.
//! Floor 3.

use crate::{math::Size, surface::Surface};
use std::sync::Arc;

/// The canvas that a mark sees. `surface`, where present, has the size of the canvas.
#[derive(Clone)]
pub struct Scene {
    pub size: Size,
    pub surface: Option<Arc<Surface>>,
}

impl Scene {
    /// Both see the same canvas and the very same surface: what was rendered for one holds for the other.
    pub fn is_same(&self, other: &Scene) -> bool {
        let same_surface = match (&self.surface, &other.surface) {
            (None, None) => true,
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            _ => false,
        };
        self.size == other.size && same_surface
    }
}

/// How an image is read through its deformation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Filter {
    /// Filtered over the pixel's footprint in the image plane.
    #[default]
    Antialias,
    /// One bilinear tap at D(q): the exact, unfiltered result.
    Bilinear,
}
