//! How the surface is stretched where it is seen at a slant. Floor 2.

use crate::math::{Mat2, Vec2, vec2};
use crate::surface::form_lines::SmoothNormals;
use crate::surface::unwrap::metric::STEEPEST_NZ;

/// S at a pixel of smooth normals: `stretch` to the power 1, without its power.
pub fn root(normals: &SmoothNormals, x: usize, y: usize) -> Mat2 {
    PixelStretch::of(normals, x, y).root()
}

/// The stretch at a pixel, from which S and its inverse follow without a root.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelStretch {
    /// a_x², a_x a_y and a_y² of the unit direction a of n̄.
    along: [f32; 3],
    /// n_z, held where it is steep.
    nz: f32,
}

impl PixelStretch {
    pub fn of(normals: &SmoothNormals, x: usize, y: usize) -> Self {
        let along: Vec2 = normals.nbar(x, y).normalize_or_zero();
        let along = [along.x * along.x, along.x * along.y, along.y * along.y];
        Self { along, nz: normals.nz(x, y).max(STEEPEST_NZ).min(1.0) }
    }

    /// S.
    pub fn root(&self) -> Mat2 {
        self.scale_along(1.0 / self.nz)
    }

    /// S⁻¹.
    pub fn inverse_root(&self) -> Mat2 {
        self.scale_along(self.nz)
    }

    /// Scales by a factor along n̄.
    fn scale_along(&self, factor: f32) -> Mat2 {
        let [xx, xy, yy] = self.along.map(|v| (factor - 1.0) * v);
        Mat2::from_cols(vec2(1.0 + xx, xy), vec2(xy, 1.0 + yy))
    }
}
