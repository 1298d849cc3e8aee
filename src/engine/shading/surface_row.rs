//! One row of a tile on the surface, for shading: normals, κ and position. Floor 3. Materials read
//! it. Not here: the maps themselves (`surface`).

use super::{features::FeatureMap, scaling::Scaling};
use crate::math::{Vec3, simd::prefetch, vec3};
use crate::raster::{TILE, TileAt};
use crate::surface::Surface;
use crate::surface::view::{Eye, from_view, in_view};
use std::borrow::Cow;

/// One value for each pixel of a tile's row.
pub type RowValues = [f32; TILE];

/// Linear light of a tile's row: red, green, blue.
pub type Light3 = [RowValues; 3];

/// A row of a tile on the surface. Beyond the canvas the normals face the viewer and κ is 0.
pub struct SurfaceRow<'a> {
    /// The surface that is shaded.
    pub surface: &'a Surface,
    /// Its features.
    pub features: &'a FeatureMap,
    /// Canvas px of the first pixel.
    pub x0: usize,
    /// The row.
    pub y: usize,
    /// How many pixels lie on the canvas.
    pub width: usize,
    /// Camera space: right, up, to the viewer. Those of contour pixels lie in the middle of what
    /// their own side sees.
    pub normal: [RowValues; 3],
    /// Present if the surface is seen from nearby.
    near: Option<Box<PerspectiveRow>>,
}

/// A row seen from a point: each pixel from its own direction.
struct PerspectiveRow {
    /// v, camera space.
    view: [RowValues; 3],
    /// n in the frame of v.
    normal: [RowValues; 3],
}

/// The direction for κ.
#[derive(Clone, Copy)]
pub enum LightDirection<'a> {
    /// The same for the whole row, any length.
    One(Vec3),
    /// Unit x and y for each pixel.
    Each(&'a RowValues, &'a RowValues),
}

impl LightDirection<'_> {
    /// Makes κ isotropic whatever λ is.
    pub const VIEWER: LightDirection<'static> = LightDirection::One(Vec3::Z);
}

impl<'a> SurfaceRow<'a> {
    /// The row of a tile that begins at canvas pixel (x0, y); `width` pixels of it lie on the
    /// canvas.
    pub fn new(
        surface: &'a Surface,
        features: &'a FeatureMap,
        x0: usize,
        y: usize,
        width: usize,
    ) -> Self {
        let normal = [[0.0; TILE], [0.0; TILE], [1.0; TILE]];
        let near =
            (surface.eye() != Eye::Afar).then(|| Box::new(PerspectiveRow { view: normal, normal }));
        let mut surface_row = Self { surface, features, x0, y, width, normal, near };
        surface_row.move_to(y);
        surface_row
    }

    /// Moves on to another row of the tile.
    pub fn move_to(&mut self, y: usize) {
        self.y = y;
        let columns = self.x0..self.x0 + self.width;
        let [nbar_x, nbar_y, nz] =
            self.surface.normal_planes().map(|plane| &plane.row(y)[columns.clone()]);
        self.normal[0][..self.width].copy_from_slice(nbar_x);
        self.normal[2][..self.width].copy_from_slice(nz);
        self.normal[1].iter_mut().zip(nbar_y).for_each(|(up, down)| *up = -down);
        self.turn_to_own_shares();
        if let Some(near) = &mut self.near {
            for x in 0..self.width {
                let (v, n) = (
                    self.surface.view(self.x0 + x, y),
                    vec3(self.normal[0][x], self.normal[1][x], self.normal[2][x]),
                );
                (near.view[0][x], near.view[1][x], near.view[2][x]) = v.into();
                (near.normal[0][x], near.normal[1][x], near.normal[2][x]) = in_view(v, n).into();
            }
        }
        self.prefetch(y + 2);
    }

    /// Moves on to a pixel of its own, anywhere: a row of one.
    pub fn move_to_pixel(&mut self, x: usize, y: usize) {
        (self.x0, self.width) = (x, 1);
        self.move_to(y);
    }

    /// Moves the normals of contour pixels to the middle of what their own side sees (MATH
    /// 10).
    fn turn_to_own_shares(&mut self) {
        let at = TileAt::new((self.x0 / TILE) as i32, (self.y / TILE) as i32);
        let Some(contours) = self.surface.contours().on(at) else { return };
        for pixel in contours.in_row(self.y as i32) {
            let x = (pixel.x as usize).wrapping_sub(self.x0);
            if x < self.width {
                let n = pixel.own_normal(self.normal_at(x));
                (self.normal[0][x], self.normal[1][x], self.normal[2][x]) = n.into();
            }
        }
    }

    /// v of a pixel of the row: the unit vector toward the eye, camera space.
    #[inline(always)]
    pub fn view_at(&self, x: usize) -> Vec3 {
        self.near
            .as_ref()
            .map_or(Vec3::Z, |near| vec3(near.view[0][x], near.view[1][x], near.view[2][x]))
    }

    /// The normals in each pixel's own frame, where its view is e = (0, 0, 1).
    pub fn seen_normal(&self) -> &[RowValues; 3] {
        self.near.as_ref().map_or(&self.normal, |near| &near.normal)
    }

    /// Directions in each pixel's own frame.
    pub fn in_pixel_frames<'d>(&self, direction: &'d [RowValues; 3]) -> Cow<'d, [RowValues; 3]> {
        let Some(near) = &self.near else { return Cow::Borrowed(direction) };
        let mut seen = *direction;
        for x in 0..self.width {
            let at = |rows: &[RowValues; 3]| vec3(rows[0][x], rows[1][x], rows[2][x]);
            (seen[0][x], seen[1][x], seen[2][x]) = in_view(at(&near.view), at(direction)).into();
        }
        Cow::Owned(seen)
    }

    /// The reverse of [`SurfaceRow::in_pixel_frames`].
    pub fn from_seen<'d>(&self, seen: &'d [RowValues; 3]) -> Cow<'d, [RowValues; 3]> {
        let Some(near) = &self.near else { return Cow::Borrowed(seen) };
        let mut direction = *seen;
        for x in 0..self.width {
            let at = |rows: &[RowValues; 3]| vec3(rows[0][x], rows[1][x], rows[2][x]);
            (direction[0][x], direction[1][x], direction[2][x]) =
                from_view(at(&near.view), at(seen)).into();
        }
        Cow::Owned(direction)
    }

    /// Prefetches a row farther down: it is a canvas's width away in memory.
    fn prefetch(&self, y: usize) {
        if y < self.surface.size().height as usize {
            let columns = self.x0..self.x0 + self.width;
            self.surface
                .normal_planes()
                .into_iter()
                .for_each(|plane| prefetch(&plane.row(y)[columns.clone()]));
            prefetch(&self.surface.coverage_plane().row(y)[columns]);
            self.features.prefetch(self.x0, y, self.width);
        }
    }

    /// The normal of a pixel, counted from the first.
    pub fn normal_at(&self, x: usize) -> Vec3 {
        vec3(self.normal[0][x], self.normal[1][x], self.normal[2][x])
    }

    /// κ(ℓ) along the row.
    pub fn kappa(&self, toward: LightDirection) -> RowValues {
        let mut kappa = [0.0; TILE];
        self.find_kappa(toward, &mut kappa);
        kappa
    }

    /// As [`SurfaceRow::kappa`], into an array.
    fn find_kappa(&self, toward: LightDirection, kappa: &mut RowValues) {
        let row = &mut kappa[..self.width];
        match toward {
            LightDirection::One(light) => self.features.row_toward(self.x0, self.y, light, row),
            LightDirection::Each(x, y) => {
                self.features.row_along(self.x0, self.y, [&x[..self.width], &y[..self.width]], row);
            }
        }
    }

    /// Which neighbors continue the surface, along the row: bits of [`crate::surface::links`].
    pub fn links(&self) -> &[u8] {
        &self.surface.smooth_links_plane().row(self.y)[self.x0..self.x0 + self.width]
    }

    /// Coverage by the surface, `[0, 1]`, along the row.
    pub fn coverage(&self) -> &[u8] {
        &self.surface.coverage_plane().row(self.y)[self.x0..self.x0 + self.width]
    }
}

/// How a row bends toward a light, and the exponentials E = e^(−γκ) (MATH 5) that its terms share:
/// terms are often scaled alike, and without λ κ is the same toward every light.
pub struct RowRelief {
    kappa: RowValues,
    /// The γ (convex, concave) of `exponentials`; `None` before the first.
    gammas: Option<(f32, f32)>,
    exponentials: RowValues,
    is_isotropic: bool,
}

impl Default for RowRelief {
    /// An empty one, to be moved from row to row.
    fn default() -> Self {
        Self { kappa: [0.0; TILE], gammas: None, exponentials: [1.0; TILE], is_isotropic: false }
    }
}

impl RowRelief {
    /// Forgets the row it was on.
    pub fn leave_row(&mut self) {
        (self.is_isotropic, self.gammas) = (false, None);
    }

    /// Turns to a direction: κ(ℓ), unless it is the same for all.
    pub fn turn(&mut self, surface_row: &SurfaceRow, toward: LightDirection) {
        if !self.is_isotropic {
            surface_row.find_kappa(toward, &mut self.kappa);
            (self.is_isotropic, self.gammas) = (!surface_row.features.is_directional(), None);
        }
    }

    /// κ toward the direction last turned to.
    pub fn kappa(&self) -> &RowValues {
        &self.kappa
    }

    /// E for a scaling's γ.
    pub fn exponentials(&mut self, scaling: Scaling) -> &RowValues {
        let gammas = (scaling.gamma_convex, scaling.gamma_concave);
        if self.gammas != Some(gammas) {
            find_exponentials(scaling, &self.kappa, &mut self.exponentials);
            self.gammas = Some(gammas);
        }
        &self.exponentials
    }
}

crate::widest! {
    fn find_exponentials(scaling: Scaling, kappa: &RowValues, exponentials: &mut RowValues) {
        for (e, &kappa) in exponentials.iter_mut().zip(kappa) {
            *e = scaling.exponential(kappa);
        }
    }
}
