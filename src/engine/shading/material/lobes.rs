//! Adds up the terms of a material along a row: σ(κ, δ) ρ times a color (RS sec. 5). Floor 3. Not
//! here: ρ and δ (each model's own file).

use crate::math::fast;
use crate::raster::TILE;
use crate::shading::light::RowLight;
use crate::shading::scaling::Scaling;
use crate::shading::surface_row::{Light3, RowValues};

/// Pixels whose sums are kept in registers.
const CHUNK: usize = 16;

/// A term's color × weight, linear, times a light's.
pub fn tint(color: [f32; 3], radiance: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|c| color[c] * radiance[c])
}

/// Adds σ times light that was looked up, one color per pixel.
pub fn add_incoming(
    light: &mut Light3,
    incoming: &Light3,
    scale: Option<(Scaling, &RowValues, &RowValues)>,
) {
    for (light, incoming) in light.iter_mut().zip(incoming) {
        for (x, (light, &incoming)) in light.iter_mut().zip(incoming).enumerate() {
            *light += scale.map_or(incoming, |(scaling, kappa, delta)| {
                incoming * scaling.sigma_fast(kappa[x], delta[x])
            });
        }
    }
}

/// Adds ρ tint to the light of a row, where a light is seen, and what its shadow leaves of it where
/// it is not.
pub fn add_lit(light: &mut Light3, tint: [f32; 3], rho: &RowValues, lit: &RowLight) {
    let Some(shadow) = &lit.shadow else { return add(light, tint, rho) };
    let (mut seen, mut hidden) = (*rho, *rho);
    part(&mut seen, &mut hidden, &shadow.seen);
    add(light, tint, &seen);
    if shadow.left != [0.0; 3] {
        add(light, self::tint(tint, shadow.left), &hidden);
    }
}

crate::widest! {
    /// Parts ρ, which both hold, by a share.
    pub fn part(seen: &mut RowValues, hidden: &mut RowValues, share: &RowValues) {
        for ((seen, hidden), share) in seen.iter_mut().zip(hidden).zip(share) {
            let whole = *seen;
            *seen = whole * share;
            *hidden = whole - *seen;
        }
    }

    /// ρ ← σ(κ, δ) ρ of each pixel; `exponentials`: E of κ.
    pub fn scale(rho: &mut RowValues, scaling: Scaling, exponentials: &RowValues, delta: &RowValues) {
        for (x, rho) in rho.iter_mut().enumerate() {
            *rho *= scaling.sigma_of(exponentials[x], delta[x]);
        }
    }

    /// As [`scale`] with δ = ρ.
    pub fn scale_by_itself(rho: &mut RowValues, scaling: Scaling, exponentials: &RowValues) {
        for (x, rho) in rho.iter_mut().enumerate() {
            *rho *= scaling.sigma_of(exponentials[x], *rho);
        }
    }

    /// Σ ρ tint of several terms, a tint and a row for each.
    pub fn sum(light: &mut Light3, tints: &[[f32; 3]], terms: &[RowValues]) {
        let [red, green, blue] = light;
        let chunks = red.as_chunks_mut::<CHUNK>().0.iter_mut();
        let chunks = chunks.zip(green.as_chunks_mut::<CHUNK>().0).zip(blue.as_chunks_mut::<CHUNK>().0);
        for (i, ((red, green), blue)) in chunks.enumerate() {
            // The three sums stay in registers.
            let [mut r, mut g, mut b] = [[0.0; CHUNK]; 3];
            for (tint, rho) in tints.iter().zip(terms) {
                let rho = &rho[i * CHUNK..(i + 1) * CHUNK];
                for x in 0..CHUNK {
                    r[x] += tint[0] * rho[x];
                    g[x] += tint[1] * rho[x];
                    b[x] += tint[2] * rho[x];
                }
            }
            (*red, *green, *blue) = (r, g, b);
        }
    }

    /// Adds ρ tint to the light of a row.
    pub fn add(light: &mut Light3, tint: [f32; 3], rho: &RowValues) {
        for (light, tint) in light.iter_mut().zip(tint) {
            for (light, &rho) in light.iter_mut().zip(rho) {
                *light += tint * rho;
            }
        }
    }

    /// Adds light of a different color at each pixel: tint · σ · shown.
    pub fn add_shown(light: &mut Light3, tint: [f32; 3], shown: &Light3, sigma: &RowValues) {
        for c in 0..3 {
            for x in 0..TILE {
                light[c][x] += tint[c] * sigma[x] * shown[c][x];
            }
        }
    }

    /// (n·ℓ)₊ of each pixel.
    pub fn lambert(normal: &[RowValues; 3], direction: &[RowValues; 3], rho: &mut RowValues) {
        for (x, rho) in rho.iter_mut().enumerate() {
            *rho = fast::max(dot(normal, direction, x), 0.0);
        }
    }

    /// Phong's ρ_s = (r·ℓ)₊^η with r = 2(n·e)n − e the mirrored view, e = (0, 0, 1) (RS sec. 5.1).
    /// Normals and directions are those of each pixel's view.
    pub fn glossy(normal: &[RowValues; 3], direction: &[RowValues; 3], shininess: f32, rho: &mut RowValues) {
        for (x, rho) in rho.iter_mut().enumerate() {
            // r·ℓ = 2 n_z (n·ℓ) − ℓ_z.
            let mirrored = 2.0 * normal[2][x] * dot(normal, direction, x) - direction[2][x];
            // A unit vector's rounding must not raise a high power above 1.
            *rho = fast::min(mirrored, 1.0);
        }
        raise(rho, shininess);
    }

    /// ρ ← ρ^ζ, 0 where ρ is (RS sec. 5.1: sub-Lambertian).
    pub fn flatten(rho: &mut RowValues, exponent: f32) {
        raise(rho, exponent);
    }
}

/// v^p, 0 where v is not above 0: `fast::pow` in two short loops, so that no pixel waits for
/// another's logarithm.
#[inline(always)]
fn raise(values: &mut RowValues, p: f32) {
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
fn dot(a: &[RowValues; 3], b: &[RowValues; 3], x: usize) -> f32 {
    a[0][x] * b[0][x] + a[1][x] * b[1][x] + a[2][x] * b[2][x]
}
