//! Terms of a material added up along a row: σ(κ, δ) ρ times a colour (RS sec. 5).
//! Floor 3. What ρ and δ are is each model's own file.

use crate::math::fast;
use crate::raster::TILE;
use crate::shading::ground::{Light3, Pixels};
use crate::shading::scaling::Scaling;

/// A term's colour × weight, linear, times a light's.
pub fn tint(color: [f32; 3], radiance: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|c| color[c] * radiance[c])
}

/// Adds σ ρ tint to the light of a row. Without scaling κ and δ are not looked at.
pub fn add(light: &mut Light3, tint: [f32; 3], rho: &Pixels, scale: Option<(Scaling, &Pixels, &Pixels)>) {
    match scale {
        Some((scaling, kappa, delta)) => add_plain(light, tint, &scaled(rho, scaling, kappa, delta)),
        None => add_plain(light, tint, rho),
    }
}

/// Adds σ times light that was looked up, one colour a pixel.
pub fn add_seen(light: &mut Light3, seen: &Light3, scale: Option<(Scaling, &Pixels, &Pixels)>) {
    for (light, seen) in light.iter_mut().zip(seen) {
        for (x, (light, &seen)) in light.iter_mut().zip(seen).enumerate() {
            *light += scale.map_or(seen, |(scaling, kappa, delta)| seen * scaling.sigma_fast(kappa[x], delta[x]));
        }
    }
}

crate::widest! {
    /// σ(κ, δ) ρ of each pixel.
    pub fn scaled(rho: &Pixels, scaling: Scaling, kappa: &Pixels, delta: &Pixels) -> Pixels {
        let mut scaled = [0.0; TILE];
        // Two short loops: in one, each pixel would wait for its exponential.
        for (x, e) in scaled.iter_mut().enumerate() {
            *e = scaling.exponential(kappa[x]);
        }
        for (x, scaled) in scaled.iter_mut().enumerate() {
            *scaled = rho[x] * scaling.sigma_of(*scaled, delta[x]);
        }
        scaled
    }
    fn add_plain(light: &mut Light3, tint: [f32; 3], rho: &Pixels) {
        for x in 0..TILE {
            for c in 0..3 {
                light[c][x] += tint[c] * rho[x];
            }
        }
    }
    /// Adds light that each pixel has a colour of its own for: tint · σ · shown.
    pub fn add_shown(light: &mut Light3, tint: [f32; 3], shown: &Light3, sigma: &Pixels) {
        for c in 0..3 {
            for x in 0..TILE {
                light[c][x] += tint[c] * sigma[x] * shown[c][x];
            }
        }
    }
    /// (n·ℓ)₊ of each pixel.
    pub fn lambert(normal: &[Pixels; 3], direction: &[Pixels; 3]) -> Pixels {
        let mut rho = [0.0; TILE];
        for (x, rho) in rho.iter_mut().enumerate() {
            *rho = fast::max(dot(normal, direction, x), 0.0);
        }
        rho
    }
    /// Phong's ρ_s = (r·ℓ)₊^η with r = 2(n·e)n − e the mirrored view, e = (0, 0, 1) (RS sec. 5.1).
    pub fn glossy(normal: &[Pixels; 3], direction: &[Pixels; 3], shininess: f32) -> Pixels {
        let mut rho = [0.0; TILE];
        for (x, rho) in rho.iter_mut().enumerate() {
            // r·ℓ = 2 n_z (n·ℓ) − ℓ_z.
            let mirrored = 2.0 * normal[2][x] * dot(normal, direction, x) - direction[2][x];
            // A unit vector's rounding must not raise a high power above 1.
            *rho = fast::min(mirrored, 1.0);
        }
        raise(&mut rho, shininess);
        rho
    }
    /// ρ^ζ, 0 where ρ is (RS sec. 5.1: sub-Lambertian).
    pub fn flattened(rho: &Pixels, exponent: f32) -> Pixels {
        let mut flat = *rho;
        raise(&mut flat, exponent);
        flat
    }
}

/// v^p, 0 where v is not above 0: `fast::pow` in two short loops, so that no pixel waits for another's logarithm.
#[inline(always)]
fn raise(values: &mut Pixels, p: f32) {
    let mut exponents = [0.0; TILE];
    for (exponent, v) in exponents.iter_mut().zip(&*values) {
        *exponent = p * fast::log2(*v);
    }
    for (v, exponent) in values.iter_mut().zip(exponents) {
        let power = fast::exp2(exponent);
        *v = if *v > 0.0 { power } else { 0.0 };
    }
}

#[inline(always)]
fn dot(a: &[Pixels; 3], b: &[Pixels; 3], x: usize) -> f32 {
    a[0][x] * b[0][x] + a[1][x] * b[1][x] + a[2][x] * b[2][x]
}
