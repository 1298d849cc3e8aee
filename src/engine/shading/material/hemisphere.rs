//! Light from the whole hemisphere: matt under an environment, and ambient occlusion alone (RS sec.
//! 5.3.1, MATH 5). Floor 3. Not here: occlusion itself (`surface`), the mean light of the
//! hemisphere (`environment::irradiance`).

use super::{Shading, lobes};
use crate::math::srgb;
use crate::raster::TILE;
use crate::shading::surface_row::{Light3, LightDirection, RowValues, SurfaceRow};

/// Adds ρ_d A(p) L̄(n) as the diffuse term, scaled with δ = L̄(n) / max L̄. The scaling of the
/// ambient term, if it has one, scales the occlusion A on its own, with δ = A.
pub fn diffuse(shading: &Shading, surface_row: &SurfaceRow, light: &mut Light3) {
    let (Some(environment), term) = (&shading.environment, &shading.diffuse) else { return };
    let environment_light = environment.environment_light();
    let per_brightest = 1.0 / shading.reference.resolve(environment_light.brightest_matt());
    let tint = term.linear();
    let open = scaled_occlusion(shading, surface_row);
    let mut incoming: Light3 = [[0.0; TILE]; 3];
    let mut delta = [0.0; TILE];
    environment_light.matt_row(&surface_row.normal, &mut incoming);
    for x in 0..TILE {
        delta[x] = srgb::luminance(incoming[0][x], incoming[1][x], incoming[2][x]) * per_brightest;
        (0..3).for_each(|c| incoming[c][x] *= tint[c] * open[x]);
    }
    if !term.is_scaled() {
        return lobes::add_incoming(light, &incoming, None);
    }
    // The normal is the direction that contributes most (RS sec. 5.3.1).
    let kappa =
        surface_row.kappa(LightDirection::Each(&surface_row.normal[0], &surface_row.normal[1]));
    lobes::add_incoming(light, &incoming, Some((term.scaling, &kappa, &delta)));
}

/// Adds A(p) as the ambient term, scaled with δ = A.
pub fn occlusion(shading: &Shading, surface_row: &SurfaceRow, light: &mut Light3) {
    let open = scaled_occlusion(shading, surface_row);
    lobes::add(light, shading.ambient.linear(), &open);
}

/// σ(κ, A) A along the row; A is 1 if no radius is given.
fn scaled_occlusion(shading: &Shading, surface_row: &SurfaceRow) -> RowValues {
    let mut open = [1.0; TILE];
    if shading.occlusion_radius_px > 0.0 {
        let map = surface_row.surface.occlusion(shading.occlusion_radius_px);
        open[..surface_row.width].copy_from_slice(
            &map.row(surface_row.y)[surface_row.x0..surface_row.x0 + surface_row.width],
        );
    }
    let term = &shading.ambient;
    if term.is_scaled() {
        let kappa = surface_row.kappa(LightDirection::VIEWER);
        open.iter_mut()
            .zip(&kappa)
            .for_each(|(a, &kappa)| *a *= term.scaling.sigma_fast(kappa, *a));
    }
    open
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, Vec3, srgb::Color, vec3};
    use crate::raster::Picture;
    use crate::shading::material::tests::{assert_shows, term};
    use crate::shading::{Environment, Features, Model, Term};

    /// Light that depends on the height alone: L̄ of 1 + e_y is 1 + ⅔ n_y.
    fn sky() -> Environment {
        let row = |y: u32| 1.0 + ((y as f32 + 0.5) / 64.0 * std::f32::consts::PI).cos();
        let texels = (0..128 * 64).map(|i| [row(i / 128), 0.5 * row(i / 128), 0.7, 1.0]).collect();
        Environment::new("sky.hdr".into(), Picture::linear(Size::new(128, 64), texels).unwrap())
    }
    const CLAY: Color = Color { r: 200, g: 180, b: 160, a: 255 };

    #[test]
    fn matt_light_is_the_hemispheres_mean_in_its_shade_each_scaled_on_its_own() {
        for (ambient, lambda) in [(Term::NONE, 0.0), (term(Color::WHITE, 0.0, 0.3, 0.8), 0.5)] {
            let shading = Shading {
                environment: Some(sky()),
                diffuse: term(CLAY, 0.5, 0.4, 1.2),
                ambient,
                features: Features { lambda, ..Features::default() },
                occlusion_radius_px: 12.0,
                ..Shading::new(Model::DiffuseEnvironment)
            };
            assert_shows(&shading, 1.5, |surface, x, y| {
                let n = surface.normal(x, y);
                let mean = vec3(1.0 + n.y / 1.5, 0.5 + n.y / 3.0, 0.7);
                let brightest = srgb::luminance(1.0 + 1.0 / 1.5, 0.5 + 1.0 / 3.0, 0.7);
                let features = shading.features.on(surface);
                let open = surface.occlusion(12.0).at(x, y);
                let open = open * ambient.scaling.sigma(features.at(x, y, Vec3::Z), open);
                let delta = srgb::luminance(mean.x, mean.y, mean.z) / brightest;
                Vec3::from(shading.diffuse.linear())
                    * mean
                    * open
                    * shading.diffuse.scaling.sigma(features.at(x, y, n), delta)
            });
        }
    }

    #[test]
    fn occlusion_alone_is_the_scaled_open_part() {
        let shading = Shading {
            ambient: term(CLAY, 0.9, 0.8, 1.5),
            occlusion_radius_px: 12.0,
            ..Shading::new(Model::AmbientOcclusion)
        };
        assert_shows(&shading, 1.0, |surface, x, y| {
            let open = surface.occlusion(12.0).at(x, y);
            let kappa = shading.features.on(surface).at(x, y, Vec3::Z);
            Vec3::from(shading.ambient.linear()) * open * shading.ambient.scaling.sigma(kappa, open)
        });
    }

    #[test]
    fn without_a_radius_nothing_is_hidden() {
        let shading = Shading { occlusion_radius_px: 0.0, ..Shading::new(Model::AmbientOcclusion) };
        assert_shows(&shading, 1e-3, |_, _, _| Vec3::ONE);
    }
}
