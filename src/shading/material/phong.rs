//! Phong, and the sub-Lambertian material that is Phong with a flatter matt term (RS sec. 5.1, MATH 5).
//! Floor 3.

use super::{Shading, Term, lobes};
use crate::raster::TILE;
use crate::shading::ground::{Ground, Light3, Pixels, Toward};

/// Adds every light's terms, and the ambient one once: `L′ = Σ_j Σ_lights σ_j(κ, δ_j) ρ_j L` with δ_j = ρ_j.
///
/// `exponent`: ζ of the matt term (n·ℓ)₊^ζ; `None` is Phong's own, ζ = 1.
pub fn shade(shading: &Shading, ground: &Ground, exponent: Option<f32>, light: &mut Light3) {
    ambient(&shading.ambient, ground, light);
    for lit in &shading.lights {
        let lit = lit.on(ground);
        let is_scaled = shading.diffuse.is_scaled() || shading.specular.is_scaled();
        let kappa = if is_scaled { ground.kappa(lit.toward()) } else { [0.0; TILE] };
        if shading.diffuse.weight > 0.0 {
            let lambert = lobes::lambert(&ground.normal, &lit.direction);
            let rho = exponent.map_or(lambert, |zeta| lobes::flattened(&lambert, zeta));
            add(light, &shading.diffuse, lit.radiance, &rho, &kappa);
        }
        if shading.specular.weight > 0.0 {
            let rho = lobes::glossy(&ground.normal, &lit.direction, shading.shininess);
            add(light, &shading.specular, lit.radiance, &rho, &kappa);
        }
    }
}

/// ρ_a = 1, no light's: scaled alone it is mean-curvature shading, e^(γκ).
pub fn ambient(term: &Term, ground: &Ground, light: &mut Light3) {
    if term.weight > 0.0 {
        let kappa = if term.is_scaled() { ground.kappa(Toward::VIEWER) } else { [0.0; TILE] };
        add(light, term, [1.0; 3], &[1.0; TILE], &kappa);
    }
}

/// A term whose reflectance is its own ρ.
fn add(light: &mut Light3, term: &Term, radiance: [f32; 3], rho: &Pixels, kappa: &Pixels) {
    let scale = term.is_scaled().then_some((term.scaling, kappa, rho));
    lobes::add(light, lobes::tint(term.linear(), radiance), rho, scale);
}
