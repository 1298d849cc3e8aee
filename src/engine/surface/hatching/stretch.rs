//! How the surface is stretched where it is seen at a slant. Floor 2.

use crate::math::{Mat2, Vec2, vec2};
use crate::surface::form_lines::SmoothNormals;
use crate::surface::unwrap::metric::STEEPEST_NZ;

/// S at a pixel of smooth normals: `stretch` to the power 1, without its power.
pub fn root(normals: &SmoothNormals, x: usize, y: usize) -> Mat2 {
    scale_along(normals.nbar(x, y), 1.0 / normals.nz(x, y).max(STEEPEST_NZ).min(1.0))
}

/// Scales by a factor along n̄.
pub fn scale_along(nbar: Vec2, factor: f32) -> Mat2 {
    let (along, grown) = (nbar.normalize_or_zero(), factor - 1.0);
    let across = grown * along.x * along.y;
    Mat2::from_cols(
        vec2(1.0 + grown * along.x * along.x, across),
        vec2(across, 1.0 + grown * along.y * along.y),
    )
}
