//! Phong, and the sub-Lambertian material that is Phong with a flatter matt term (RS sec. 5.1, MATH
//! 5). Floor 3. Toon quantizes the same terms into bands.

use super::{Model, Shading, lobes};
use crate::raster::TILE;
use crate::shading::light::RowLight;
use crate::shading::surface_row::{Light3, LightDirection, RowRelief, RowValues, SurfaceRow};

/// A material's terms along a row: the ambient one, and two for every light; those of weight 0 are
/// left out. A term of a light that casts a shadow is followed by what the shadow leaves of it.
///
/// `L′ = Σ_j Σ_lights σ_j(κ, δ_j) ρ_j L` with δ_j = ρ_j; ρ_a = 1 has no light of its own: scaled,
/// it is mean-curvature shading, e^(γκ).
pub struct PhongTerms {
    lobes: Vec<Lobe>,
    /// Color × weight of each, times its light's, linear.
    pub tints: Vec<[f32; 3]>,
    /// σρ of each along the row.
    pub scaled: Vec<RowValues>,
    /// ζ of the matt terms (n·ℓ)₊^ζ; `None` is Phong's own, ζ = 1.
    exponent: Option<f32>,
}

/// The term, and the number of its light.
#[derive(Clone, Copy)]
enum Lobe {
    Ambient,
    Matt(usize),
    Glossy(usize),
    /// What the shadow of the light of the term before leaves of it.
    Shadowed(usize),
}

impl PhongTerms {
    /// `lights`: those of the material.
    pub fn new(shading: &Shading, lights: &[RowLight]) -> Self {
        let ambient = [(Lobe::Ambient, &shading.ambient, [1.0; 3])];
        let lit = lights.iter().enumerate().flat_map(|(i, light)| {
            let left = light.shadow.as_ref().map(|shadow| lobes::tint(light.radiance, shadow.left));
            let terms = [(Lobe::Matt(i), &shading.diffuse), (Lobe::Glossy(i), &shading.specular)];
            terms.into_iter().flat_map(move |(lobe, term)| {
                let shadowed = left.map(|left| (Lobe::Shadowed(i), term, left));
                [Some((lobe, term, light.radiance)), shadowed].into_iter().flatten()
            })
        });
        let (lobes, tints): (Vec<_>, Vec<_>) = ambient
            .into_iter()
            .chain(lit)
            .filter(|(_, term, _)| term.weight > 0.0)
            .map(|(lobe, term, radiance)| (lobe, lobes::tint(term.linear(), radiance)))
            .unzip();
        let scaled = vec![[0.0; TILE]; lobes.len()];
        let exponent = (shading.model == Model::SubLambertian).then_some(shading.exponent);
        Self { lobes, tints, scaled, exponent }
    }

    /// Finds σρ of every term. `lights`: turned to the row; `relief`: left the row before.
    pub fn find(
        &mut self,
        shading: &Shading,
        surface_row: &SurfaceRow,
        lights: &[RowLight],
        relief: &mut RowRelief,
    ) {
        let exponent = self.exponent;
        for at in 0..self.lobes.len() {
            if let Lobe::Shadowed(i) = self.lobes[at] {
                let (before, after) = self.scaled.split_at_mut(at);
                if let (Some(rho), Some(left), Some(shadow)) =
                    (before.last_mut(), after.first_mut(), &lights[i].shadow)
                {
                    left.copy_from_slice(rho);
                    lobes::part(rho, left, &shadow.seen);
                }
                continue;
            }
            let rho = &mut self.scaled[at];
            let (term, toward) = match self.lobes[at] {
                Lobe::Shadowed(_) => continue,
                Lobe::Ambient => {
                    rho.fill(1.0);
                    (&shading.ambient, LightDirection::VIEWER)
                }
                Lobe::Matt(i) => {
                    lobes::lambert(&surface_row.normal, &lights[i].direction, rho);
                    if let Some(zeta) = exponent {
                        lobes::flatten(rho, zeta);
                    }
                    (&shading.diffuse, lights[i].direction())
                }
                Lobe::Glossy(i) => {
                    let direction = surface_row.in_pixel_frames(&lights[i].direction);
                    lobes::glossy(surface_row.seen_normal(), &direction, shading.shininess, rho);
                    (&shading.specular, lights[i].direction())
                }
            };
            if term.is_scaled() {
                relief.turn(surface_row, toward);
                lobes::scale_by_itself(rho, term.scaling, relief.exponentials(term.scaling));
            }
        }
    }

    /// The light of the row: the terms added up.
    pub fn sum(&self, light: &mut Light3) {
        lobes::sum(light, &self.tints, &self.scaled);
    }
}
