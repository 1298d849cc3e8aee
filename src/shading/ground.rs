//! What one row of a tile offers to light: normals, κ, and where it lies.
//! Floor 3. Materials read it; the maps themselves are the surface's.

use super::features::FeatureMap;
use crate::math::{Vec3, vec3};
use crate::raster::TILE;
use crate::surface::Surface;
use std::cell::OnceCell;

/// One value for each pixel of a tile's row.
pub type Pixels = [f32; TILE];

/// Linear light of a tile's row: red, green, blue.
pub type Light3 = [Pixels; 3];

/// A row of a tile on the surface. Beyond the canvas the normals face the viewer and κ is 0.
pub struct Ground<'a> {
    pub surface: &'a Surface,
    pub features: &'a FeatureMap,
    /// Canvas px of the first pixel.
    pub x0: usize,
    pub y: usize,
    /// How many pixels lie on the canvas.
    pub width: usize,
    /// Camera space: right, up, to the viewer.
    pub normal: [Pixels; 3],
    /// κ where it does not depend on the direction, once it was asked for.
    isotropic: OnceCell<Pixels>,
}

/// The direction that κ is asked for.
#[derive(Clone, Copy)]
pub enum Toward<'a> {
    /// The same for the whole row, any length.
    One(Vec3),
    /// Unit x and y for each pixel.
    Each(&'a Pixels, &'a Pixels),
}

impl Toward<'_> {
    /// Leaves κ isotropic whatever λ is.
    pub const VIEWER: Toward<'static> = Toward::One(Vec3::Z);
}

impl<'a> Ground<'a> {
    /// The row of a tile that begins at canvas pixel (x0, y); `width` pixels of it lie on the canvas.
    pub fn new(surface: &'a Surface, features: &'a FeatureMap, x0: usize, y: usize, width: usize) -> Self {
        let [nbar_x, nbar_y, nz] = surface.normal_planes().map(|plane| &plane.row(y)[x0..x0 + width]);
        let mut normal = [[0.0; TILE], [0.0; TILE], [1.0; TILE]];
        normal[0][..width].copy_from_slice(nbar_x);
        normal[2][..width].copy_from_slice(nz);
        normal[1].iter_mut().zip(nbar_y).for_each(|(up, down)| *up = -down);
        Self { surface, features, x0, y, width, normal, isotropic: OnceCell::new() }
    }
    pub fn normal_at(&self, x: usize) -> Vec3 {
        vec3(self.normal[0][x], self.normal[1][x], self.normal[2][x])
    }
    /// κ(ℓ) along the row.
    pub fn kappa(&self, toward: Toward) -> Pixels {
        match self.features.is_directional() {
            true => self.kappa_toward(toward),
            false => *self.isotropic.get_or_init(|| self.kappa_toward(Toward::VIEWER)),
        }
    }
    fn kappa_toward(&self, toward: Toward) -> Pixels {
        let mut kappa = [0.0; TILE];
        let row = &mut kappa[..self.width];
        match toward {
            Toward::One(light) => self.features.row_toward(self.x0, self.y, light, row),
            Toward::Each(x, y) => {
                self.features.row_along(self.x0, self.y, [&x[..self.width], &y[..self.width]], row);
            }
        }
        kappa
    }
    /// Which neighbours continue the surface, along the row: bits of [`crate::surface::links`].
    pub fn links(&self) -> &[u8] {
        &self.surface.links_plane().row(self.y)[self.x0..self.x0 + self.width]
    }
    /// Coverage by the surface, `[0, 1]`, along the row.
    pub fn coverage(&self) -> &[u8] {
        &self.surface.coverage_plane().row(self.y)[self.x0..self.x0 + self.width]
    }
}
