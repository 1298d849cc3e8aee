//! Lit sphere: each pixel gets the colour of a painted sphere at the same normal; or of two
//! spheres, one for convex and one for concave features, blended by κ (RS sec. 5.3.1, MATH 5).
//! Floor 3.

use super::{Shading, lobes};
use crate::math::srgb;
use crate::raster::TILE;
use crate::shading::LitSphere;
use crate::shading::sphere::SphereLight;
use crate::shading::surface_row::{Light3, LightDirection, RowRelief, RowValues, SurfaceRow};

/// Adds the sphere's light, the `specular` term: δ is its luminance over the greatest on the
/// spheres.
///
/// Of two spheres, the convex one has the weight (1 + κ) / 2, so that flat parts show half of each.
pub fn shade(
    shading: &Shading,
    surface_row: &SurfaceRow,
    relief: &mut RowRelief,
    light: &mut Light3,
) {
    let term = &shading.specular;
    if term.weight <= 0.0 {
        return;
    }
    let convex = convex(shading).light();
    let concave = shading.sphere_concave.as_ref().map(LitSphere::light);
    if term.is_scaled() || concave.is_some() {
        // A painted sphere has no single direction of light, so κ is isotropic.
        relief.turn(surface_row, LightDirection::VIEWER);
    }
    let shown = looked_up(surface_row, convex, concave, relief.kappa());
    let brightest = concave.map_or(0.0, SphereLight::brightest).max(convex.brightest());
    let delta = reflectances(&shown, 1.0 / shading.reference.resolve(brightest));
    let mut sigma = [1.0; TILE];
    if term.is_scaled() {
        lobes::scale(&mut sigma, term.scaling, relief.exponentials(term.scaling), &delta);
    }
    lobes::add_shown(light, term.linear(), &shown, &sigma);
}

/// The sphere for convex features, or for all.
fn convex(shading: &Shading) -> &LitSphere {
    shading.sphere.as_ref().unwrap_or_else(|| LitSphere::clay())
}

/// Fills the caches that many tiles would otherwise wait for.
pub fn warm_caches(shading: &Shading) {
    convex(shading).light();
    let _ = shading.sphere_concave.as_ref().map(LitSphere::light);
}

fn looked_up(
    surface_row: &SurfaceRow,
    convex: &SphereLight,
    concave: Option<&SphereLight>,
    kappa: &RowValues,
) -> Light3 {
    let mut shown = [[0.0; TILE]; 3];
    convex.at_row(surface_row.seen_normal(), &mut shown);
    if let Some(concave) = concave {
        let mut other = [[0.0; TILE]; 3];
        concave.at_row(surface_row.seen_normal(), &mut other);
        for (shown, other) in shown.iter_mut().zip(&other) {
            for (x, (shown, other)) in shown.iter_mut().zip(other).enumerate() {
                *shown = other + (0.5 + 0.5 * kappa[x]) * (*shown - other);
            }
        }
    }
    shown
}

/// δ = luminance / Y*, clamped by σ itself.
fn reflectances(shown: &Light3, per_reference: f32) -> RowValues {
    std::array::from_fn(|x| srgb::luminance(shown[0][x], shown[1][x], shown[2][x]) * per_reference)
}
