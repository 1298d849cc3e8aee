//! Phong, and the sub-Lambertian material that is Phong with a flatter matt term (RS sec. 5.1, MATH
//! 5). Floor 3. Toon quantises the same terms into bands.

use super::{Model, Shading, lobes};
use crate::raster::TILE;
use crate::shading::light::RowLight;
use crate::shading::surface_row::{Light3, LightDirection, RowRelief, RowValues, SurfaceRow};

/// A material's terms along a row: the ambient one, and two for every light; those of weight 0 are
/// left out.
///
/// `L′ = Σ_j Σ_lights σ_j(κ, δ_j) ρ_j L` with δ_j = ρ_j; ρ_a = 1 has no light of its own: scaled,
/// it is mean-curvature shading, e^(γκ).
pub struct PhongTerms {
    lobes: Vec<Lobe>,
    /// Colour × weight of each, times its light's, linear.
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
}

impl PhongTerms {
    /// `lights`: those of the material.
    pub fn new(shading: &Shading, lights: &[RowLight]) -> Self {
        let ambient = [(Lobe::Ambient, &shading.ambient, [1.0; 3])];
        let lit = lights.iter().enumerate().flat_map(|(i, light)| {
            [
                (Lobe::Matt(i), &shading.diffuse, light.radiance),
                (Lobe::Glossy(i), &shading.specular, light.radiance),
            ]
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
        for (lobe, rho) in self.lobes.iter().zip(&mut self.scaled) {
            let (term, toward) = match *lobe {
                Lobe::Ambient => {
                    rho.fill(1.0);
                    (&shading.ambient, LightDirection::VIEWER)
                }
                Lobe::Matt(i) => {
                    lobes::lambert(&surface_row.normal, &lights[i].direction, rho);
                    if let Some(zeta) = self.exponent {
                        lobes::flatten(rho, zeta);
                    }
                    (&shading.diffuse, lights[i].toward())
                }
                Lobe::Glossy(i) => {
                    let direction = surface_row.seen(&lights[i].direction);
                    lobes::glossy(surface_row.seen_normal(), &direction, shading.shininess, rho);
                    (&shading.specular, lights[i].toward())
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
