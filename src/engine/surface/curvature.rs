//! View-centered curvature: how the surface bends as seen by the viewer (MATH 4; RS sec. 4, after
//! Vergne et al. 2009). Floor 2. Here: what curvature is and its equations. Not here: the fast way
//! to compute it over a whole map (`tiles`), or its uses (`shading::radiance`, the detail of D_n).

mod ends;
mod kappa;
mod rims;
mod tile_rect;
mod tiles;

#[cfg(test)]
mod reference;

pub use kappa::{Kappa, KappaScale};
pub use rims::CurvatureRims;

use super::Surface;
use super::cache::HeapSize;
use super::contours::FarSide;
use crate::math::{Vec2, Vec3, vec2};
use crate::raster::Plane;
use std::sync::Arc;

/// Below this n_z a slope is not followed further: the surface is seen edge-on.
pub const GRAZING_NZ: f32 = 0.05;

/// The curvature tensor H of every pixel: axes x right, y **up**; convex > 0; per pixel, before the
/// curvature scale *s*. At the ends of the surface it is continued from neighbors; off the surface
/// it is 0.
pub struct Curvature {
    /// H's first entry.
    pub hxx: Plane<f32>,
    /// H's entries off the diagonal.
    pub hxy: Plane<f32>,
    /// H's last entry.
    pub hyy: Plane<f32>,
}

/// The slope of the surface as seen: minus g of MATH 4, in image axes (y **down**).
///
/// g = (−n_x / n_z, −n_y / n_z) with n_z ≥ 0.05; with n̄ = (n_x, −n_y) the slope is n̄ / n_z.
/// `nbar` and `nz` may be a normal of any length, such as a weighted sum of normals; the bound then
/// holds for its direction.
#[inline(always)]
pub fn slope(nbar_x: f32, nbar_y: f32, nz: f32) -> (f32, f32) {
    let length = (nbar_x * nbar_x + nbar_y * nbar_y + nz * nz).sqrt();
    // The smallest normal float avoids 0 / 0.
    let upright = 1.0 / nz.max(GRAZING_NZ * length).max(f32::MIN_POSITIVE);
    (nbar_x * upright, nbar_y * upright)
}

/// H = −½ (∇g + ∇gᵀ) from the derivatives of the slope in image axes (y **down**): `[h_xx, h_xy,
/// h_yy]`, y **up** (MATH 4).
///
/// Flipping y negates the slope's second component and the derivative along y: the diagonal stays,
/// h_xy changes sign.
#[inline(always)]
pub fn tensor(dx_slope: (f32, f32), dy_slope: (f32, f32)) -> [f32; 3] {
    [dx_slope.0, -0.5 * (dy_slope.0 + dx_slope.1), dy_slope.1]
}

impl Curvature {
    /// κ = tanh(s (k_u + k_v)): in (−1, 1), convex > 0 (MATH 4). `scale_px`: *s*.
    #[inline(always)]
    pub fn kappa(&self, x: usize, y: usize, scale_px: f32) -> f32 {
        (scale_px * (self.hxx.at(x, y) + self.hyy.at(x, y))).tanh()
    }

    /// κ(ℓ) = tanh(s [(H + λA) ℓ_u² + (H − λA) ℓ_v² + H ℓ_z²]) (MATH 4).
    ///
    /// * `lambda`: in `[−1, 1]`; 0 is isotropic.
    /// * `light`: ℓ, toward the light, camera space (y up), any length; zero counts as the view
    ///   direction.
    ///
    /// Needs no eigenvectors: A (ℓ_u² − ℓ_v²) is twice the trace-free part of the tensor along ℓ.
    #[inline(always)]
    pub fn kappa_along(&self, x: usize, y: usize, scale_px: f32, lambda: f32, light: Vec3) -> f32 {
        let l = light.normalize_or(Vec3::Z);
        let [hxx, hxy, hyy] = self.tensor(x, y);
        let aniso = (hxx - hyy) * (l.x * l.x - l.y * l.y) + 4.0 * hxy * l.x * l.y;
        (scale_px * (hxx + hyy + lambda * aniso)).tanh()
    }

    /// Principal curvatures k_u ≥ k_v, per pixel, and the unit direction u (y up, sign arbitrary);
    /// v is u turned by 90°.
    pub fn principal(&self, x: usize, y: usize) -> (f32, f32, Vec2) {
        let [hxx, hxy, hyy] = self.tensor(x, y);
        let (mean, half) = (0.5 * (hxx + hyy), 0.5 * (hxx - hyy));
        let radius = half.hypot(hxy);
        let angle = 0.5 * hxy.atan2(half);
        (mean + radius, mean - radius, vec2(angle.cos(), angle.sin()))
    }

    /// `[h_xx, h_xy, h_yy]` of a pixel.
    #[inline(always)]
    pub fn tensor(&self, x: usize, y: usize) -> [f32; 3] {
        [self.hxx.at(x, y), self.hxy.at(x, y), self.hyy.at(x, y)]
    }
}

/// Pixels of all curvatures kept, 12 bytes each: a few scales weighed at once, or two on a large
/// canvas.
const KEPT_PX: usize = 16 << 20;

impl HeapSize for Curvature {
    fn heap_bytes(&self) -> u64 {
        [&self.hxx, &self.hxy, &self.hyy].map(Plane::heap_bytes).iter().sum()
    }
}

impl Surface {
    /// The curvature of the surface, its normals blurred first by a Gaussian of standard deviation
    /// `blur_px` (0: not at all).
    ///
    /// Neither the blur nor the differences cross the mask's edge or a depth jump. For a far side it
    /// is that of the other sides' pixels nearby. Cached. Call it once before going parallel:
    /// threads that call it at the same time may each compute it.
    pub fn curvature(&self, blur_px: f32) -> Arc<Curvature> {
        // `max` first: NaN.max(0) is 0. Half the canvas flattens whatever is on it.
        let blur_px = blur_px.max(0.0).min(0.5 * self.size().longer_side());
        let keep = (KEPT_PX / self.size().area().max(1)).clamp(2, 8);
        let compute = |recycled| {
            self.on_either_side(
                || tiles::compute(self, blur_px, recycled),
                |far, front| self.on_far_side(far, front, blur_px),
            )
        };
        self.derived.curvatures.get_or_compute(blur_px.to_bits(), keep, compute)
    }

    fn on_far_side(&self, far: &FarSide, front: Option<&Surface>, blur_px: f32) -> Curvature {
        let whole = front.map(|front| front.curvature(blur_px));
        let [hxx, hxy, hyy] = [0, 1, 2].map(|i| {
            let of = |x: usize, y: usize| whole.as_ref().map_or(0.0, |whole| whole.tensor(x, y)[i]);
            far.map(self.size(), |pixel| pixel.other_mean(of))
        });
        Curvature { hxx, hxy, hyy }
    }
}

#[cfg(test)]
mod tests;
