//! Isotropic κ of a whole map, cached because every redraw needs it (MATH 4).
//! Floor 2.

use super::{Curvature, Surface};
use crate::math::{Size, fast, parallel};
use crate::raster::Plane;
use crate::surface::cache::HeapSize;
use std::sync::Arc;

/// One scale of curvature of several that are weighed at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KappaScale {
    /// Standard deviation of the Gaussian that the normals are blurred with first, px, `≥ 0`.
    pub blur_px: f32,
    /// s: curvature is multiplied by it before it saturates, px, `≥ 0`.
    pub curvature_scale_px: f32,
    /// Of the sum; shares add up to 1.
    pub share: f32,
}

/// Isotropic κ of every pixel in steps of 1 / 32,767: a sixth of what its tensor takes, and within
/// 1.6e-5 of it.
pub struct Kappa {
    steps: Plane<i16>,
}

const STEPS: f32 = i16::MAX as f32;
/// Pixels that are worked on at a time.
const CHUNK: usize = 4096;
/// Pixels of all maps of κ kept, 2 bytes each.
const KEPT_PX: usize = 64 << 20;

impl HeapSize for Kappa {
    fn heap_bytes(&self) -> u64 {
        self.steps.heap_bytes()
    }
}

impl Kappa {
    /// κ of one pixel, in `[−1, 1]`.
    pub fn at(&self, x: usize, y: usize) -> f32 {
        f32::from(self.steps.at(x, y)) / STEPS
    }

    /// κ along row `y` from column `x0` on, as many as `kappa` holds.
    pub fn row(&self, x0: usize, y: usize, kappa: &mut [f32]) {
        from_steps(self.steps(x0, y, kappa.len()), kappa);
    }

    /// A part of a row as it is stored.
    pub fn steps(&self, x0: usize, y: usize, width: usize) -> &[i16] {
        &self.steps.row(y)[x0..x0 + width]
    }

    fn compute(
        size: Size,
        parts: &[(Arc<Curvature>, KappaScale)],
        recycled: Option<Kappa>,
    ) -> Kappa {
        let mut steps =
            recycled.map_or_else(|| vec![0; size.area()], |kappa| kappa.steps.into_values());
        parallel::for_each_row(&mut steps, CHUNK, 1, |i, steps| {
            let mut kappa = [0.0; CHUNK];
            let kappa = &mut kappa[..steps.len()];
            for (curvature, scale) in parts {
                let pixels = i * CHUNK..i * CHUNK + steps.len();
                let [hxx, hyy] =
                    [&curvature.hxx, &curvature.hyy].map(|plane| &plane.values()[pixels.clone()]);
                add(hxx, hyy, *scale, kappa);
            }
            to_steps(kappa, steps);
        });
        Kappa { steps: Plane::from_values(size, steps).unwrap_or_else(|| Plane::full(size, 0)) }
    }
}

impl Surface {
    /// Isotropic κ: Σ share · tanh(s (k_u + k_v)) (MATH 4). Cached. Call it once before going
    /// parallel: threads that call it at the same time may each compute it.
    pub fn kappa(&self, scales: &[KappaScale]) -> Arc<Kappa> {
        let key = scales
            .iter()
            .map(|s| [s.blur_px, s.curvature_scale_px, s.share].map(f32::to_bits))
            .collect();
        let keep = (KEPT_PX / self.size().area().max(1)).clamp(2, 8);
        self.derived.kappas.get_or_compute(key, keep, |recycled| {
            let parts: Vec<_> =
                scales.iter().map(|&scale| (self.curvature(scale.blur_px), scale)).collect();
            Kappa::compute(self.size(), &parts, recycled)
        })
    }
}

crate::widest! {
    fn add(hxx: &[f32], hyy: &[f32], scale: KappaScale, kappa: &mut [f32]) {
        let KappaScale { curvature_scale_px, share, .. } = scale;
        for ((&hxx, &hyy), kappa) in hxx.iter().zip(hyy).zip(kappa) {
            *kappa += share * fast::tanh(curvature_scale_px * (hxx + hyy));
        }
    }

    fn to_steps(kappa: &[f32], steps: &mut [i16]) {
        for (step, &kappa) in steps.iter_mut().zip(kappa) {
            // Adding 1.5 · 2²³ leaves the nearest whole number in the low bits; NaN becomes −1.
            let whole = fast::min(fast::max(kappa, -1.0), 1.0) * STEPS + 12_582_912.0;
            *step = whole.to_bits() as i16;
        }
    }

    fn from_steps(steps: &[i16], kappa: &mut [f32]) {
        for (kappa, &step) in kappa.iter_mut().zip(steps) {
            *kappa = i32::from(step) as f32 * (1.0 / STEPS);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;
    use crate::surface::Maps;

    #[test]
    fn it_is_the_weighted_mean_of_the_scales_within_a_step() {
        let size = Size::new(90, 70);
        let normals =
            Plane::from_fn(size, |x, y| vec3((x as f32 * 0.2).sin(), (y as f32 * 0.3).cos(), 1.2));
        let coverage = Plane::from_fn(size, |x, _| if x < 80 { 255 } else { 0 });
        let surface =
            Surface::new(Maps { normals, depth: Plane::full(size, 0.5), coverage }).unwrap();
        let scales =
            [(0.0, 9.0, 0.75), (1.5, 30.0, 0.25)].map(|(blur_px, curvature_scale_px, share)| {
                KappaScale { blur_px, curvature_scale_px, share }
            });
        let kappa = surface.kappa(&scales);
        let mut row = [0.0; 90];
        for y in [0, 1, 35, 69] {
            kappa.row(0, y, &mut row);
            for (x, in_row) in row.into_iter().enumerate() {
                let one = |s: &KappaScale| {
                    s.share * surface.curvature(s.blur_px).kappa(x, y, s.curvature_scale_px)
                };
                let expected: f32 = scales.iter().map(one).sum();
                assert!(
                    (kappa.at(x, y) - expected).abs() < 1.6e-5
                        && (in_row - kappa.at(x, y)).abs() < 1e-6,
                    "{x} {y}"
                );
            }
        }
        assert!(kappa.at(20, 30).abs() > 0.1 && kappa.at(85, 30) == 0.0);
    }
}
