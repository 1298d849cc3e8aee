//! Phong, and the sub-Lambertian material that is Phong with a flatter matt term (RS sec. 5.1, MATH 5).
//! Floor 3.

use super::{Shading, Term, lobes};
use crate::raster::TILE;
use crate::shading::ground::{Ground, Light3, Pixels, Toward};
use crate::shading::light::Light;

/// Adds every light's terms, and the ambient one once: `L′ = Σ_j Σ_lights σ_j(κ, δ_j) ρ_j L` with δ_j = ρ_j.
///
/// `exponent`: ζ of the matt term (n·ℓ)₊^ζ; `None` is Phong's own, ζ = 1.
pub fn shade(shading: &Shading, ground: &Ground, exponent: Option<f32>, light: &mut Light3) {
    if let Some(scaled) = ambient(&shading.ambient, ground) {
        lobes::add(light, shading.ambient.linear(), &scaled, None);
    }
    for lit in &shading.lights {
        under_light(shading, lit, ground, exponent, |_, tint, scaled| lobes::add(light, tint, scaled, None));
    }
}

/// σ_a ρ_a with ρ_a = 1 and no light's: scaled it is mean-curvature shading, e^(γκ). `None` where the term is left out.
pub fn ambient(term: &Term, ground: &Ground) -> Option<Pixels> {
    const RHO: Pixels = [1.0; TILE];
    let scaled = || lobes::scaled(&RHO, term.scaling, &ground.kappa(Toward::VIEWER), &RHO);
    (term.weight > 0.0).then(|| if term.is_scaled() { scaled() } else { RHO })
}

/// The two terms that a light makes, where they are not left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lobe {
    Matt,
    Glossy,
}

/// Hands out each term under one light: its colour times the light's, and σρ.
pub fn under_light(
    shading: &Shading,
    light: &Light,
    ground: &Ground,
    exponent: Option<f32>,
    mut with: impl FnMut(Lobe, [f32; 3], &Pixels),
) {
    let lit = light.on(ground);
    let is_scaled = shading.diffuse.is_scaled() || shading.specular.is_scaled();
    let kappa = if is_scaled { ground.kappa(lit.toward()) } else { [0.0; TILE] };
    let mut hand_out = |lobe: Lobe, term: &Term, rho: Pixels| {
        let tint = lobes::tint(term.linear(), lit.radiance);
        match term.is_scaled() {
            true => with(lobe, tint, &lobes::scaled(&rho, term.scaling, &kappa, &rho)),
            false => with(lobe, tint, &rho),
        }
    };
    if shading.diffuse.weight > 0.0 {
        let lambert = lobes::lambert(&ground.normal, &lit.direction);
        let rho = exponent.map_or(lambert, |zeta| lobes::flattened(&lambert, zeta));
        hand_out(Lobe::Matt, &shading.diffuse, rho);
    }
    if shading.specular.weight > 0.0 {
        let rho = lobes::glossy(&ground.normal, &lit.direction, shading.shininess);
        hand_out(Lobe::Glossy, &shading.specular, rho);
    }
}
