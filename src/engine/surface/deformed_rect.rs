//! D over a rectangle of the canvas: what `deformation` fills, and pictures of the plane read
//! (`unwrap`). Floor 2.

use crate::math::Rect;

/// D at every pixel center of a rectangle, row by row.
#[derive(Default)]
pub struct DeformedRect {
    /// The pixels whose D is held; `None` before anything is.
    pub rect: Option<Rect>,
    /// D's first coordinates, row by row.
    pub x: Vec<f32>,
    /// D's second coordinates, row by row.
    pub y: Vec<f32>,
}
