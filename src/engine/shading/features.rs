//! Which features of the surface are enhanced: the scales of curvature, their weights and their
//! direction (RS sec. 4). Floor 3. Not here: curvature itself (`surface`), applying κ (`scaling`).

use crate::math::{Range, Vec3, fast, simd::prefetch};
use crate::surface::{
    Surface,
    curvature::{Curvature, Kappa, KappaScale},
};
use std::sync::Arc;

/// The mapping from the curvature tensor to κ.
#[derive(Clone, Debug, PartialEq)]
pub struct Features {
    /// At least one; κ is their weighted mean.
    pub scales: Vec<FeatureScale>,
    /// λ in `[−1, 1]`: 0 is isotropic, 1 the curvature along the light, −1 across it.
    pub lambda: f32,
}

/// One scale of curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeatureScale {
    /// s: curvature is multiplied by it before it saturates, px, `≥ 0`.
    pub curvature_scale_px: f32,
    /// Standard deviation of the Gaussian that the normals are blurred with first, px, `≥ 0`.
    pub blur_px: f32,
    /// `≥ 0`; only the ratio between scales counts.
    pub weight: f32,
}

impl FeatureScale {
    /// For curvature, also of a mask.
    pub const CURVATURE_PX: Range = 0.0..=1000.0;
    /// What a blur may be, px.
    pub const BLUR_PX: Range = 0.0..=256.0;
    /// The range of the weight of a scale.
    pub const WEIGHT: Range = 0.0..=1000.0;
}

impl Default for FeatureScale {
    fn default() -> Self {
        Self { curvature_scale_px: 4.0, blur_px: 0.0, weight: 1.0 }
    }
}

impl Default for Features {
    fn default() -> Self {
        Self { scales: vec![FeatureScale::default()], lambda: 0.0 }
    }
}

impl Features {
    /// The scales of one layer.
    pub const MOST_SCALES: usize = 16;
    /// The range of λ.
    pub const LAMBDA: Range = -1.0..=1.0;

    /// The features of a surface. Its curvature is computed here unless it is cached: call this
    /// before going parallel.
    pub fn on(&self, surface: &Surface) -> FeatureMap {
        let total: f32 = self.scales.iter().map(|s| s.weight).sum();
        let share = |s: &FeatureScale| if total > 0.0 { s.weight / total } else { 0.0 };
        if self.lambda == 0.0 {
            let scale = |s: &FeatureScale| {
                let FeatureScale { curvature_scale_px, blur_px, .. } = *s;
                KappaScale { blur_px, curvature_scale_px, share: share(s) }
            };
            return FeatureMap::Isotropic(
                surface.kappa(&self.scales.iter().map(scale).collect::<Vec<_>>()),
            );
        }
        let part = |s: &FeatureScale| ScalePart {
            curvature: surface.curvature(s.blur_px),
            curvature_scale_px: s.curvature_scale_px,
            share: share(s),
        };
        FeatureMap::Directional {
            parts: self.scales.iter().map(part).collect(),
            lambda: self.lambda,
        }
    }
}

/// κ of every pixel of one surface, in `[−1, 1]`: convex > 0, 0 off the surface.
pub enum FeatureMap {
    /// λ = 0: the same toward every light.
    Isotropic(Arc<Kappa>),
    /// The curvature along a direction.
    Directional {
        /// The scales that it is summed of.
        parts: Vec<ScalePart>,
        /// How far it depends on the direction.
        lambda: f32,
    },
}

/// One scale of several.
pub struct ScalePart {
    curvature: Arc<Curvature>,
    curvature_scale_px: f32,
    /// Shares add up to 1.
    share: f32,
}

impl FeatureMap {
    /// κ(ℓ) of one pixel (MATH 4): the reference of the rows below. `light`: ℓ, camera space, any
    /// length.
    pub fn at(&self, x: usize, y: usize, light: Vec3) -> f32 {
        match self {
            Self::Isotropic(kappa) => kappa.at(x, y),
            Self::Directional { parts, lambda } => {
                let kappa = |p: &ScalePart| {
                    p.share * p.curvature.kappa_along(x, y, p.curvature_scale_px, *lambda, light)
                };
                parts.iter().map(kappa).sum()
            }
        }
    }

    /// Whether κ depends on the direction of the light.
    pub fn is_directional(&self) -> bool {
        matches!(self, Self::Directional { .. })
    }

    /// Prefetches a row for the functions below.
    pub fn prefetch(&self, x0: usize, y: usize, width: usize) {
        match self {
            Self::Isotropic(kappa) => prefetch(kappa.steps(x0, y, width)),
            Self::Directional { parts, .. } => {
                for TensorRow { hxx, hxy, hyy } in parts.iter().map(|p| p.row(x0, y, width)) {
                    [hxx, hxy, hyy].into_iter().for_each(prefetch);
                }
            }
        }
    }

    /// κ toward one direction, for the `kappa.len()` pixels of row `y` from column `x0` on.
    pub fn row_toward(&self, x0: usize, y: usize, light: Vec3, kappa: &mut [f32]) {
        match self {
            Self::Isotropic(map) => map.row(x0, y, kappa),
            Self::Directional { parts, lambda } => {
                let l = light.normalize_or(Vec3::Z);
                // A (ℓ_u² − ℓ_v²) = (h_xx − h_yy)(ℓ_x² − ℓ_y²) + 4 h_xy ℓ_x ℓ_y: no eigenvectors,
                // see `Curvature::kappa_along`.
                let (along, across) = (lambda * (l.x * l.x - l.y * l.y), lambda * 4.0 * l.x * l.y);
                kappa.fill(0.0);
                for p in parts {
                    let s = p.curvature_scale_px;
                    let factors = [s * (1.0 + along), s * across, s * (1.0 - along)];
                    add_toward(p.row(x0, y, kappa.len()), factors, p.share, kappa);
                }
            }
        }
    }

    /// κ toward each pixel's own direction: `light_x`, `light_y` are ℓ of unit length, as long as
    /// `kappa`.
    pub fn row_along(&self, x0: usize, y: usize, light: [&[f32]; 2], kappa: &mut [f32]) {
        match self {
            Self::Isotropic(map) => map.row(x0, y, kappa),
            Self::Directional { parts, lambda } => {
                kappa.fill(0.0);
                for p in parts {
                    add_along(
                        p.row(x0, y, kappa.len()),
                        light,
                        [p.curvature_scale_px, *lambda, p.share],
                        kappa,
                    );
                }
            }
        }
    }
}

/// The tensor along a part of a row.
struct TensorRow<'a> {
    hxx: &'a [f32],
    hxy: &'a [f32],
    hyy: &'a [f32],
}

impl ScalePart {
    fn row(&self, x0: usize, y: usize, width: usize) -> TensorRow<'_> {
        let Curvature { hxx, hxy, hyy } = &*self.curvature;
        let [hxx, hxy, hyy] = [hxx, hxy, hyy].map(|plane| &plane.row(y)[x0..x0 + width]);
        TensorRow { hxx, hxy, hyy }
    }
}

crate::widest! {
    /// Adds share · tanh(f · h) to each pixel.
    fn add_toward(tensor: TensorRow, factors: [f32; 3], share: f32, kappa: &mut [f32]) {
        let [fxx, fxy, fyy] = factors;
        let pixels = tensor.hxx.iter().zip(tensor.hxy).zip(tensor.hyy).zip(kappa);
        for (((&hxx, &hxy), &hyy), kappa) in pixels {
            *kappa += share * fast::tanh(fxx * hxx + fxy * hxy + fyy * hyy);
        }
    }

    /// As `add_toward`, with a direction for each pixel; `factors`: s, λ, share.
    fn add_along(tensor: TensorRow, light: [&[f32]; 2], factors: [f32; 3], kappa: &mut [f32]) {
        let [s, lambda, share] = factors;
        let tensors = tensor.hxx.iter().zip(tensor.hxy).zip(tensor.hyy);
        let toward = light[0].iter().zip(light[1]);
        for ((((&hxx, &hxy), &hyy), (&lx, &ly)), kappa) in tensors.zip(toward).zip(kappa) {
            let aniso = (hxx - hyy) * (lx * lx - ly * ly) + 4.0 * hxy * lx * ly;
            *kappa += share * fast::tanh(s * (hxx + hyy + lambda * aniso));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec3};
    use crate::raster::Plane;
    use crate::surface::Maps;

    /// An egg: convex everywhere, more across than along.
    fn egg() -> Surface {
        let size = Size::new(70, 40);
        let normals = Plane::from_fn(size, |x, y| {
            vec3((x as f32 - 35.0) / 90.0, (20.0 - y as f32) / 30.0, 1.0)
        });
        Surface::new(Maps {
            normals,
            depth: Plane::full(size, 0.5),
            coverage: Plane::full(size, 255),
        })
        .unwrap()
    }

    fn features(lambda: f32) -> Features {
        let scale = |curvature_scale_px, blur_px, weight| FeatureScale {
            curvature_scale_px,
            blur_px,
            weight,
        };
        Features { scales: vec![scale(8.0, 0.0, 1.0), scale(20.0, 2.0, 3.0)], lambda }
    }

    #[test]
    fn rows_hold_what_the_single_pixel_does() {
        let (surface, light) = (egg(), vec3(0.5, -0.3, 0.7));
        for lambda in [0.0, 1.0, -0.6] {
            let map = features(lambda).on(&surface);
            let (mut toward, mut along) = ([9.0; 33], [9.0; 33]);
            let Features { scales, .. } = features(lambda);
            let exact = |x: usize| -> f32 {
                let kappa = |s: &FeatureScale| {
                    let curvature = surface.curvature(s.blur_px);
                    s.weight / 4.0
                        * curvature.kappa_along(x, 11, s.curvature_scale_px, lambda, light)
                };
                scales.iter().map(kappa).sum()
            };
            map.row_toward(20, 11, light, &mut toward);
            let l = light.normalize();
            map.row_along(20, 11, [&[l.x; 33], &[l.y; 33]], &mut along);
            for i in 0..33 {
                let expected = exact(20 + i);
                let is_near = |kappa: f32| (kappa - expected).abs() < 1.6e-5;
                assert!(
                    is_near(toward[i]) && is_near(along[i]) && is_near(map.at(20 + i, 11, light)),
                    "{lambda} {i}"
                );
            }
        }
    }

    #[test]
    fn the_weights_of_scales_are_a_mean() {
        let surface = egg();
        let one = |i: usize| {
            Features { scales: vec![features(0.0).scales[i]], lambda: 0.0 }.on(&surface).at(
                35,
                20,
                Vec3::Z,
            )
        };
        let both = features(0.0).on(&surface).at(35, 20, Vec3::Z);
        assert!((both - (one(0) + 3.0 * one(1)) / 4.0).abs() < 4e-5);
    }

    #[test]
    fn anisotropy_follows_the_light() {
        let surface = egg();
        let kappa = |lambda, light| features(lambda).on(&surface).at(35, 20, light);
        let iso = kappa(0.0, Vec3::X);
        assert!(kappa(1.0, Vec3::Y) > iso && kappa(1.0, Vec3::X) < iso, "it curves more along y");
        assert_eq!(kappa(-1.0, Vec3::X), kappa(1.0, Vec3::Y));
        assert!(
            (kappa(1.0, Vec3::Z) - iso).abs() < 1.6e-5,
            "toward the viewer only the mean is left"
        );
    }
}
