//! The anisotropic Phong material of Ashikhmin and Shirley (2000) under lights (RS sec. 5.2, MATH
//! 5). Floor 3. The functions for one pixel come first and read like the paper; rows are computed
//! by the same functions.
//!
//! Light has no factor 1/π, as everywhere here: ρ is π times the paper's reflectance, times n·ℓ.
//! R_s is the color × weight of the `specular` term, R_d that of `diffuse`.

use super::{Shading, lobes};
use crate::math::{Vec3, fast};
use crate::raster::TILE;
use crate::shading::environment::Directions;
use crate::shading::light::RowLight;
use crate::shading::scaling::Scaling;
use crate::shading::surface_row::{Light3, LightDirection, RowRelief, RowValues, SurfaceRow};

/// Pixels whose sums are kept in registers.
const CHUNK: usize = 16;

/// Adds each light's matt and glossy term, with δ_d = n·ℓ and δ_s = n·h. `lights`: those of the
/// material, turned to the row.
pub fn shade(
    shading: &Shading,
    surface_row: &SurfaceRow,
    lights: &[RowLight],
    relief: &mut RowRelief,
    light: &mut Light3,
) {
    for lit in lights {
        if shading.diffuse.weight > 0.0 {
            add_matt(shading, surface_row, lit, relief, light);
        }
        if shading.specular.weight > 0.0 {
            add_glossy(shading, surface_row, lit, relief, light);
        }
    }
}

/// The matt term under one light.
pub fn add_matt(
    shading: &Shading,
    surface_row: &SurfaceRow,
    lit: &RowLight,
    relief: &mut RowRelief,
    light: &mut Light3,
) {
    let diffuse = &shading.diffuse;
    let (rd, rs) = (diffuse.linear(), mirrored_color(shading));
    let kept: [f32; 3] = std::array::from_fn(|c| rd[c] * (1.0 - rs[c]));
    let (mut rho, mut delta) = ([0.0; TILE], [0.0; TILE]);
    matt_row(
        surface_row.seen_normal(),
        &surface_row.in_pixel_frames(&lit.direction),
        &mut rho,
        &mut delta,
    );
    if diffuse.is_scaled() {
        relief.turn(surface_row, lit.direction());
        lobes::scale(&mut rho, diffuse.scaling, relief.exponentials(diffuse.scaling), &delta);
    }
    lobes::add_lit(light, lobes::tint(kept, lit.radiance), &rho, lit);
}

fn add_glossy(
    shading: &Shading,
    surface_row: &SurfaceRow,
    lit: &RowLight,
    relief: &mut RowRelief,
    light: &mut Light3,
) {
    let mut row = GlossyRow { rho: [0.0; TILE], white: [0.0; TILE], delta: [0.0; TILE] };
    let (normal, direction) =
        (surface_row.seen_normal(), surface_row.in_pixel_frames(&lit.direction));
    glossy_row(normal, &direction, shading.nu, shading.nv, &mut row);
    let specular = &shading.specular;
    if specular.is_scaled() {
        relief.turn(surface_row, lit.direction());
        lobes::scale(
            &mut row.rho,
            specular.scaling,
            relief.exponentials(specular.scaling),
            &row.delta,
        );
    }
    // R_s + (1 − R_s) f = R_s + f (1 − R_s): a colored part and a whiter one.
    let rs = mirrored_color(shading);
    lobes::add_lit(light, lobes::tint(rs, lit.radiance), &row.rho, lit);
    row.rho.iter_mut().zip(&row.white).for_each(|(rho, f)| *rho *= f);
    lobes::add_lit(light, lobes::tint(rs.map(|c| 1.0 - c), lit.radiance), &row.rho, lit);
}

/// Light from one direction.
#[derive(Clone, Copy)]
pub struct DirectedLight {
    /// ℓ, unit, camera space.
    pub direction: Vec3,
    /// Linear.
    pub radiance: [f32; 3],
}

/// The matt term under many lights; [`add_matt`] of each, read side by side.
pub fn add_matt_of(
    shading: &Shading,
    surface_row: &SurfaceRow,
    lights: &[DirectedLight],
    relief: &mut RowRelief,
    light: &mut Light3,
) {
    let (diffuse, normal) = (&shading.diffuse, &surface_row.normal);
    let mut sums = [[0.0; TILE]; 3];
    if !diffuse.is_scaled() {
        add_lit(normal, lights, None, &mut sums);
    } else if surface_row.features.is_directional() {
        for lit in lights {
            relief.turn(surface_row, LightDirection::One(lit.direction));
            add_lit(
                normal,
                &[*lit],
                Some((diffuse.scaling, relief.exponentials(diffuse.scaling))),
                &mut sums,
            );
        }
    } else {
        relief.turn(surface_row, LightDirection::VIEWER);
        add_lit(
            normal,
            lights,
            Some((diffuse.scaling, relief.exponentials(diffuse.scaling))),
            &mut sums,
        );
    }
    let (rd, rs) = (diffuse.linear(), mirrored_color(shading));
    let kept: [f32; 3] = std::array::from_fn(|c| rd[c] * (1.0 - rs[c]));
    add_seen(&surface_row.seen_normal()[2], kept, &sums, light);
}

/// R_s, at most 1; black where the glossy term is left out.
fn mirrored_color(shading: &Shading) -> [f32; 3] {
    shading.specular.linear().map(|c| c.min(1.0))
}

/// ρ_d / (R_d (1 − R_s)) = 28/23 (1 − (1 − n·ℓ/2)⁵) (1 − (1 − n·e/2)⁵) (n·ℓ)₊ (Ashikhmin and
/// Shirley 2000, eq. 5).
#[inline(always)]
pub fn matt(n_l: f32, n_e: f32) -> f32 {
    light_share(n_l) * matt_share(fast::max(n_e, 0.0))
}

/// The share of [`matt`] that depends on the light.
#[inline(always)]
fn light_share(n_l: f32) -> f32 {
    let n_l = fast::max(n_l, 0.0);
    28.0 / 23.0 * matt_share(n_l) * n_l
}

/// 1 − (1 − cos/2)⁵: the matt term's part of either direction. Under even light of 1 the whole term
/// is that of the view, times R_d (1 − R_s): the integral over the other one is 23/28.
#[inline(always)]
pub fn matt_share(cosine: f32) -> f32 {
    1.0 - power_5(1.0 - 0.5 * cosine)
}

/// ρ_s / F = √((ν_u + 1)(ν_v + 1)) / 8 · (n·h)^((ν_u (h·u)² + ν_v (h·v)²) / (1 − (n·h)²)) (n·ℓ)₊ /
/// ((h·e) max(n·ℓ, n·e)) (Ashikhmin and Shirley 2000, eq. 4).
///
/// * `h_uvn`: the half vector, unit, in the frame of the surface.
#[inline(always)]
pub fn glossy(h_uvn: [f32; 3], h_e: f32, n_l: f32, n_e: f32, nu: f32, nv: f32) -> f32 {
    let [hu, hv, hn] = h_uvn;
    let across = hu * hu + hv * hv;
    // If h is the normal itself, every exponent gives 1.
    let exponent = (nu * hu * hu + nv * hv * hv) / fast::max(across, 1e-12);
    let lobe = fast::pow(fast::min(fast::max(hn, 0.0), 1.0), exponent);
    let n_l = fast::max(n_l, 0.0);
    let below = fast::max(h_e, 1e-3) * fast::max(fast::max(n_l, n_e), 1e-3);
    (((nu + 1.0) * (nv + 1.0)).sqrt() * 0.125) * lobe * n_l / below
}

/// (1 − h·e)⁵: how white the mirrored light is (Schlick 1994; F = R_s + (1 − R_s) of it).
#[inline(always)]
pub fn whiteness(h_e: f32) -> f32 {
    power_5(1.0 - fast::min(h_e, 1.0))
}

#[inline(always)]
fn power_5(x: f32) -> f32 {
    let x2 = x * x;
    x2 * x2 * x
}

/// A unit vector in the frame of the surface: u runs along the picture's x, v along its y (up),
/// then the normal.
///
/// u = (x − (x·n) n) / |…|, v = n × u; where the normal is ±x, any u is valid.
#[inline(always)]
pub fn in_frame(n: [f32; 3], w: [f32; 3]) -> [f32; 3] {
    let dot = n[0] * w[0] + n[1] * w[1] + n[2] * w[2];
    let per_length = 1.0 / fast::max(n[1] * n[1] + n[2] * n[2], 1e-12).sqrt();
    // u·w = (w_x − n_x (n·w)) / |u|; v = (0, n_z, −n_y) / |u|.
    [(w[0] - n[0] * dot) * per_length, (n[2] * w[1] - n[1] * w[2]) * per_length, dot]
}

/// The glossy term along a row.
struct GlossyRow {
    /// ρ_s / F.
    rho: RowValues,
    /// (1 − h·e)⁵.
    white: RowValues,
    /// n·h.
    delta: RowValues,
}

crate::widest! {
    /// ρ_d without its colors, and n·ℓ.
    fn matt_row(normal: &[RowValues; 3], direction: &[RowValues; 3], rho: &mut RowValues, delta: &mut RowValues) {
        for x in 0..TILE {
            let n_l = normal[0][x] * direction[0][x] + normal[1][x] * direction[1][x] + normal[2][x] * direction[2][x];
            rho[x] = matt(n_l, normal[2][x]);
            delta[x] = fast::max(n_l, 0.0);
        }
    }

    /// Adds up the light of many directions, each by its share of [`matt`].
    fn add_lit(normal: &Directions, lights: &[DirectedLight], scale: Option<(Scaling, &RowValues)>, sums: &mut Light3) {
        match scale {
            None => add_lit_by(normal, lights, |_, _| 1.0, sums),
            Some((scaling, e)) => add_lit_by(normal, lights, |x, n_l| scaling.sigma_of(e[x], n_l), sums),
        }
    }

    /// Adds what a row shows of such sums, by its own share of [`matt`].
    fn add_seen(n_e: &RowValues, tint: [f32; 3], sums: &Light3, light: &mut Light3) {
        for c in 0..3 {
            for x in 0..TILE {
                light[c][x] += tint[c] * matt_share(fast::max(n_e[x], 0.0)) * sums[c][x];
            }
        }
    }

    fn glossy_row(normal: &[RowValues; 3], direction: &[RowValues; 3], nu: f32, nv: f32, row: &mut GlossyRow) {
        for x in 0..TILE {
            let n = [normal[0][x], normal[1][x], normal[2][x]];
            let l = [direction[0][x], direction[1][x], direction[2][x]];
            // h = (ℓ + e) / |ℓ + e| with e = (0, 0, 1); |ℓ + e|² = 2 + 2 ℓ_z, and h·e = |ℓ + e| /
            // 2.
            let length = fast::max(2.0 + 2.0 * l[2], 1e-12).sqrt();
            let half = [l[0] / length, l[1] / length, (l[2] + 1.0) / length];
            let h_uvn = in_frame(n, half);
            let n_l = n[0] * l[0] + n[1] * l[1] + n[2] * l[2];
            row.rho[x] = glossy(h_uvn, 0.5 * length, n_l, n[2], nu, nv);
            row.white[x] = whiteness(0.5 * length);
            row.delta[x] = h_uvn[2];
        }
    }
}

/// `sigma`: of a pixel and its n·ℓ.
#[inline(always)]
fn add_lit_by(
    normal: &Directions,
    lights: &[DirectedLight],
    sigma: impl Fn(usize, f32) -> f32,
    sums: &mut Light3,
) {
    for first in (0..TILE).step_by(CHUNK) {
        // The sums stay in registers.
        let [mut r, mut g, mut b] = [[0.0; CHUNK]; 3];
        for light in lights {
            let (l, radiance) = (light.direction, light.radiance);
            for i in 0..CHUNK {
                let x = first + i;
                let n_l = normal[0][x] * l.x + normal[1][x] * l.y + normal[2][x] * l.z;
                let rho = light_share(n_l) * sigma(x, n_l);
                r[i] += radiance[0] * rho;
                g[i] += radiance[1] * rho;
                b[i] += radiance[2] * rho;
            }
        }
        for i in 0..CHUNK {
            sums[0][first + i] += r[i];
            sums[1][first + i] += g[i];
            sums[2][first + i] += b[i];
        }
    }
}
