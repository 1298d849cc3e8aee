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
    if let Some(part) = ambient(&shading.ambient, ground) {
        part.add_to(light);
    }
    for lit in &shading.lights {
        for part in of_light(shading, lit, ground, exponent).iter().flatten() {
            part.add_to(light);
        }
    }
}

/// One term under one light along a row.
pub struct Part {
    pub term: Term,
    /// Of the light, linear.
    radiance: [f32; 3],
    /// The term's reflectance, which is its δ too.
    pub rho: Pixels,
    /// κ(ℓ); left 0 where the term is not scaled.
    pub kappa: Pixels,
}

impl Part {
    /// What the scaled reflectance is multiplied by, linear.
    pub fn tint(&self) -> [f32; 3] {
        lobes::tint(self.term.linear(), self.radiance)
    }
    fn add_to(&self, light: &mut Light3) {
        let scale = self.term.is_scaled().then_some((self.term.scaling, &self.kappa, &self.rho));
        lobes::add(light, self.tint(), &self.rho, scale);
    }
}

/// ρ_a = 1, no light's: scaled alone it is mean-curvature shading, e^(γκ). `None` where the term is left out.
pub fn ambient(term: &Term, ground: &Ground) -> Option<Part> {
    let kappa = || if term.is_scaled() { ground.kappa(Toward::VIEWER) } else { [0.0; TILE] };
    (term.weight > 0.0).then(|| Part { term: *term, radiance: [1.0; 3], rho: [1.0; TILE], kappa: kappa() })
}

/// The matt and the glossy term under one light, each where it is not left out.
pub fn of_light(shading: &Shading, light: &Light, ground: &Ground, exponent: Option<f32>) -> [Option<Part>; 2] {
    let lit = light.on(ground);
    let is_scaled = shading.diffuse.is_scaled() || shading.specular.is_scaled();
    let kappa = if is_scaled { ground.kappa(lit.toward()) } else { [0.0; TILE] };
    let part = |term: &Term, rho: &dyn Fn() -> Pixels| {
        (term.weight > 0.0).then(|| Part { term: *term, radiance: lit.radiance, rho: rho(), kappa })
    };
    let matt = || {
        let lambert = lobes::lambert(&ground.normal, &lit.direction);
        exponent.map_or(lambert, |zeta| lobes::flattened(&lambert, zeta))
    };
    let glossy = || lobes::glossy(&ground.normal, &lit.direction, shading.shininess);
    [part(&shading.diffuse, &matt), part(&shading.specular, &glossy)]
}
