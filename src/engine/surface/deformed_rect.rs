//! D over a rectangle of the canvas: what `deformation` fills, and pictures of the plane read
//! (`unwrap`). Floor 2.

use crate::math::Rect;

/// D at every pixel center of a rectangle, row by row.
#[derive(Default)]
pub struct DeformedRect {
    pub rect: Option<Rect>,
    pub x: Vec<f32>,
    pub y: Vec<f32>,
}
