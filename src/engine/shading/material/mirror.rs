//! Mirror and refraction: the environment seen along one ray (RS sec. 5.3.2, MATH 5). Floor 3. A
//! refracted ray does not leave its object by a second side, unless the glass is solid (`glass`).
//! Not here: what a ray meets on its way (`second_look`).

mod followed;
mod glass;
mod rays;

use super::{Model, Shading, lobes};
use crate::math::{Vec3, srgb};
use crate::raster::TILE;
use crate::shading::surface_row::{Light3, LightDirection, RowValues, SurfaceRow};
pub use followed::FollowedTile;
use rays::RayRow;

/// The mirrored view r = 2(n·v)n − v, v toward the eye (MATH 5).
#[inline(always)]
pub fn mirrored(n: Vec3, v: Vec3) -> Vec3 {
    2.0 * n.dot(v) * n - v
}

/// The refracted view: Snell's law for the view ray −v entering a medium of refractive index
/// `index` > 0 (MATH 5).
///
/// Total internal reflection (`index` < 1 at a grazing angle) mirrors it.
#[inline(always)]
pub fn refract(n: Vec3, v: Vec3, index: f32) -> Vec3 {
    let eta = 1.0 / index;
    let cos = n.dot(v).max(0.0);
    let under_root = 1.0 - eta * eta * (1.0 - cos * cos);
    let through = (eta * cos - under_root.max(0.0).sqrt()) * n - eta * v;
    if under_root < 0.0 { mirrored(n, v) } else { through }
}

/// Adds L_env(r), scaled with δ = L_env(r) / max L_env, as the specular term.
///
/// * `followed`: what the rays of the row's tile see, where they are followed over the surface.
pub fn shade(
    shading: &Shading,
    surface_row: &SurfaceRow,
    followed: Option<&FollowedTile>,
    light: &mut Light3,
) {
    let (Some(environment), term) = (&shading.environment, &shading.specular) else { return };
    let environment_light = environment.environment_light();
    let per_brightest = 1.0 / shading.reference.resolve(environment_light.brightest());
    let rays = RayRow::new(surface_row, refractive_index(shading));
    let toward = [rays.ray[0], rays.ray[1]];
    let mut incoming: Light3 = [[0.0; TILE]; 3];
    // Light takes the color of solid glass on its way through it.
    let color = match followed {
        _ if shading.is_solid_glass() => {
            glass::see(shading, surface_row, &rays, &environment_light, &mut incoming);
            [term.weight; 3]
        }
        Some(followed) => {
            followed.read(surface_row, &mut incoming);
            term.linear()
        }
        None => {
            rays.see(shading, surface_row, &environment_light, &mut incoming);
            term.linear()
        }
    };
    let mut delta = [0.0; TILE];
    tint(&mut incoming, color, per_brightest, &mut delta);
    if !term.is_scaled() {
        return lobes::add_incoming(light, &incoming, None);
    }
    let kappa = surface_row.kappa(LightDirection::Each(&toward[0], &toward[1]));
    lobes::add_incoming(light, &incoming, Some((term.scaling, &kappa, &delta)));
}

/// The index by which a model refracts rays; `None` mirrors them.
fn refractive_index(shading: &Shading) -> Option<f32> {
    (shading.model == Model::Refraction).then_some(shading.index)
}

crate::widest! {
    /// Tints light, after δ of each pixel was computed from it.
    fn tint(light: &mut Light3, by: [f32; 3], per_brightest: f32, delta: &mut RowValues) {
        let [red, green, blue] = light;
        for x in 0..TILE {
            delta[x] = srgb::luminance(red[x], green[x], blue[x]) * per_brightest;
            (red[x], green[x], blue[x]) = (red[x] * by[0], green[x] * by[1], blue[x] * by[2]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec3};
    use crate::raster::Picture;
    use crate::shading::material::tests::{assert_shows, term};
    use crate::shading::{Environment, Shading};

    #[test]
    fn mirrored_rays_leave_as_steeply_as_they_came() {
        assert_eq!(mirrored(Vec3::Z, Vec3::Z), Vec3::Z);
        // Half-way up: the sky's zenith.
        let up = mirrored(vec3(0.0, 0.5f32.sqrt(), 0.5f32.sqrt()), Vec3::Z);
        assert!((up - Vec3::Y).length() < 1e-6, "{up}");
        let n = vec3(0.3, -0.5, 0.7).normalize();
        for v in [Vec3::Z, vec3(0.4, 0.1, 0.8).normalize()] {
            let r = mirrored(n, v);
            assert!((r.dot(n) - n.dot(v)).abs() < 1e-6 && n.cross(v).dot(r).abs() < 1e-6, "{v}");
        }
    }

    #[test]
    fn refracted_rays_obey_snell() {
        assert_eq!(refract(Vec3::Z, Vec3::Z, 1.5), Vec3::NEG_Z);
        for (n, index) in
            [(vec3(0.3, -0.5, 0.7), 1.5), (vec3(-0.2, 0.1, 0.9), 0.8), (vec3(0.9, 0.0, 0.1), 2.4)]
        {
            let n = n.normalize();
            for v in [Vec3::Z, vec3(0.1, -0.2, 0.9).normalize()] {
                let r = refract(n, v, index);
                assert!((r.length() - 1.0).abs() < 1e-5);
                // sin θ = index · sin θ′, both on the same plane, on the far side.
                assert!((n.cross(r).length() * index - n.cross(v).length()).abs() < 1e-5);
                assert!(n.cross(r).dot(n.cross(-v)) >= 0.0 && r.dot(n) < 0.0);
            }
        }
        let n = vec3(0.6, 0.0, 0.8);
        assert!(
            (refract(n, Vec3::Z, 1.0) - Vec3::NEG_Z).length() < 1e-6,
            "nothing bends without another matter"
        );
        assert_eq!(
            refract(n, Vec3::Z, 0.5),
            mirrored(n, Vec3::Z),
            "past the critical angle it is a mirror"
        );
        assert!(refract(vec3(0.999, 0.0, -0.04), Vec3::Z, 1.5).is_finite());
    }

    /// Bright above, dim below, and red at the right.
    fn environment_light() -> Environment {
        let texel = |i: u32| {
            let e = crate::shading::environment::projection::lat_long_direction(
                ((i % 128) as f32 + 0.5) / 128.0,
                ((i / 128) as f32 + 0.5) / 64.0,
            );
            [0.5 + 0.4 * e.y + 0.1 * e.x, 0.5 + 0.4 * e.y, 0.5 + 0.3 * e.y - 0.1 * e.z, 1.0]
        };
        let picture =
            Picture::linear(Size::new(128, 64), (0..128 * 64).map(texel).collect()).unwrap();
        let mut environment = Environment::new("sky.hdr".into(), picture);
        (environment.rotation, environment.exposure) = (30.0, -0.5);
        environment
    }

    #[test]
    fn what_is_seen_is_the_scaled_environment_along_the_ray() {
        for model in [Model::Mirror, Model::Refraction] {
            let shading = Shading {
                environment: Some(environment_light()),
                specular: term(
                    crate::math::srgb::Color { r: 250, g: 230, b: 200, a: 255 },
                    0.9,
                    0.4,
                    1.5,
                ),
                features: crate::shading::Features { lambda: 0.6, ..Default::default() },
                ..Shading::new(model)
            };
            assert_shows(&shading, 2.0, |surface, x, y| {
                let (n, v) = (surface.normal(x, y), surface.view(x, y));
                let r = if model == Model::Mirror { mirrored(n, v) } else { refract(n, v, 1.5) };
                let incoming = environment_light().environment_light();
                let radiance = incoming.radiance(r);
                let delta =
                    srgb::luminance(radiance.x, radiance.y, radiance.z) / incoming.brightest();
                let sigma =
                    shading.specular.scaling.sigma(shading.features.on(surface).at(x, y, r), delta);
                Vec3::from(shading.specular.linear()) * radiance * sigma
            });
        }
    }

    #[test]
    fn a_mirror_that_faces_up_shows_the_sky() {
        let shading =
            Shading { environment: Some(environment_light()), ..Shading::new(Model::Mirror) };
        let scene = crate::shading::material::tests::ball();
        let column = |at| shading.render_tile(&scene, crate::raster::TileAt::new(0, at)).unwrap();
        // The ball's middle is at (60, 66): row 30 faces up, row 100 down.
        let (above, below) = (
            column(0).bytes()[(30 * TILE + 60) * 4 + 1],
            column(1).bytes()[(36 * TILE + 60) * 4 + 1],
        );
        assert!(above > below + 40, "{above} {below}");
    }

    #[test]
    fn without_an_environment_a_mirror_is_black() {
        assert_shows(&Shading::new(Model::Mirror), 0.0, |_, _, _| Vec3::ZERO);
    }
}
