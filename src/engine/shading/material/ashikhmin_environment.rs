//! The material of Ashikhmin and Shirley under an environment: sampled in the directions it reflects, with the same
//! samples at every pixel (RS sec. 5.2, MATH 5). Floor 3. Not here: the lobes (`ashikhmin`).
//!
//! Each sample represents a part of the lobe and reads the mean of the environment over that part, so that a small sun
//! makes no fireflies and single samples are invisible.

use super::{Shading, ashikhmin};
use crate::math::{Vec3, vec3};
use crate::shading::environment::EnvironmentLight;
use crate::shading::light::RowLight;
use crate::shading::surface_row::{Light3, LightDirection, RowRelief, SurfaceRow};
use crate::surface::view::{from_view, in_view};
use std::f32::consts::PI;

/// Directions that the matt term is lit from.
const PARCELS: usize = 128;
/// Half vectors of the glossy term.
const HALVES: usize = 32;

/// What the rows of a tile share.
pub struct EnvironmentSamples {
    environment_light: EnvironmentLight,
    /// For the matt term: the environment as lights.
    lights: Vec<RowLight>,
    halves: Vec<HalfVector>,
}

/// A half vector that the glossy lobe is sampled at.
struct HalfVector {
    /// Unit, in the frame of the surface (`ashikhmin::in_frame`).
    uvn: Vec3,
    /// The probability density of half vectors there, per steradian.
    density: f32,
}

impl EnvironmentSamples {
    /// `None` without an environment.
    pub fn new(shading: &Shading) -> Option<Self> {
        let environment_light = shading.environment.as_ref()?.environment_light();
        // Light from a solid angle Ω counts Ω / π: matt white is as bright as an even environment around it.
        let light = |p: &crate::shading::environment::Parcel| {
            RowLight::directional(p.direction, (p.radiance * (p.solid_angle / PI)).to_array())
        };
        let lights = environment_light.parcels(PARCELS).iter().map(light).collect();
        let halves = (0..HALVES).map(|i| half(i, shading.nu, shading.nv)).collect();
        Some(Self { environment_light, lights, halves })
    }
    /// Adds both terms along a row.
    pub fn shade(&self, shading: &Shading, surface_row: &SurfaceRow, relief: &mut RowRelief, light: &mut Light3) {
        if shading.diffuse.weight > 0.0 {
            self.lights.iter().for_each(|lit| ashikhmin::add_matt(shading, surface_row, lit, relief, light));
        }
        if shading.specular.weight > 0.0 {
            relief.turn(surface_row, LightDirection::VIEWER);
            let kappa = relief.kappa();
            for x in (0..surface_row.width).filter(|&x| surface_row.coverage()[x] > 0) {
                let glossy = self.glossy(shading, surface_row, x, kappa[x]);
                (0..3).for_each(|c| light[c][x] += glossy[c]);
            }
        }
    }
    /// The glossy term at a pixel; `kappa`: isotropic κ.
    ///
    /// With half vectors drawn in proportion to the lobe, light arrives weighted by F (n·ℓ)₊ / max(n·ℓ, n·e), never
    /// above 1.
    fn glossy(&self, shading: &Shading, surface_row: &SurfaceRow, x: usize, kappa: f32) -> Vec3 {
        let (term, view) = (&shading.specular, surface_row.view_at(x));
        // In the frame of the pixel's view, where that is (0, 0, 1).
        let n = in_view(view, surface_row.normal_at(x));
        let rs = Vec3::from(term.linear()).min(Vec3::ONE);
        let u = (Vec3::X - n.x * n).normalize_or(Vec3::Y);
        let v = n.cross(u);
        let mut sum = Vec3::ZERO;
        for half in &self.halves {
            let h = half.uvn.x * u + half.uvn.y * v + half.uvn.z * n;
            let l = 2.0 * h.z * h - Vec3::Z;
            let n_l = n.dot(l);
            if n_l <= 0.0 || h.z <= 0.0 {
                continue;
            }
            let l = from_view(view, l);
            let fresnel = rs + (Vec3::ONE - rs) * ashikhmin::whiteness(h.z);
            // For ℓ: dω_h / dω_ℓ = 1 / (4 h·e). Slightly more than its share, so that neighbours overlap.
            let solid_angle = 4.0 * h.z / (half.density * HALVES as f32);
            let radiance = self.environment_light.around(l, 1.5 * solid_angle.sqrt());
            let kappa = if surface_row.features.is_directional() {
                surface_row.features.at(surface_row.x0 + x, surface_row.y, l)
            } else {
                kappa
            };
            let sigma = term.scaling.sigma(kappa, half.uvn.z);
            sum += fresnel * radiance * (sigma * n_l / n_l.max(n.z).max(1e-3));
        }
        sum / HALVES as f32
    }
}

/// The `i`th of [`HALVES`] half vectors in proportion to the lobe (Ashikhmin and Shirley 2000, eq. 9 and 10).
///
/// tan φ = √((ν_u + 1)/(ν_v + 1)) tan(2π ξ₁) and cos θ = (1 − ξ₂)^(1/(ν_u cos²φ + ν_v sin²φ + 1)).
fn half(i: usize, nu: f32, nv: f32) -> HalfVector {
    // Hammersley's points: even in both numbers, none of them random.
    let first = (i as f32 + 0.5) / HALVES as f32;
    let second = (i as u32).reverse_bits() as f32 / 4_294_967_296.0 + 0.5 / HALVES as f32;
    let (sin, cos) = (2.0 * PI * first).sin_cos();
    // The same quadrant as the angle itself.
    let phi = (sin * (nu + 1.0).sqrt()).atan2(cos * (nv + 1.0).sqrt());
    let (sin_phi, cos_phi) = phi.sin_cos();
    let exponent = nu * cos_phi * cos_phi + nv * sin_phi * sin_phi;
    let cos_theta = (1.0 - second).max(1e-6).powf(1.0 / (exponent + 1.0));
    let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
    let density = ((nu + 1.0) * (nv + 1.0)).sqrt() / (2.0 * PI) * cos_theta.powf(exponent);
    HalfVector { uvn: vec3(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta), density: density.max(1e-6) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, srgb::Color};
    use crate::raster::{Picture, TILE, TileAt};
    use crate::shading::material::tests::{assert_shows, ball, term};
    use crate::shading::{Environment, Model, Scaling, Term};

    fn environment(light: impl Fn(usize, usize) -> f32) -> Environment {
        let texels = (0..128 * 64).map(|i| [light(i % 128, i / 128); 3]).map(|[r, g, b]| [r, g, b, 1.0]).collect();
        Environment::new("sky.hdr".into(), Picture::linear(Size::new(128, 64), texels).unwrap())
    }
    fn material(environment: Environment) -> Shading {
        Shading {
            environment: Some(environment),
            lights: Vec::new(),
            diffuse: Term::NONE,
            specular: Term::plain(Color::WHITE, 1.0),
            ..Shading::new(Model::Ashikhmin)
        }
    }
    #[test]
    fn half_vectors_have_the_mean_that_their_lobe_has() {
        for (nu, nv) in [(10.0f32, 10.0f32), (5.0, 200.0), (1000.0, 1000.0)] {
            let halves: Vec<HalfVector> = (0..HALVES).map(|i| half(i, nu, nv)).collect();
            let mean = |of: &dyn Fn(&HalfVector) -> f32| halves.iter().map(of).sum::<f32>() / HALVES as f32;
            assert!(mean(&|h| h.uvn.x).abs() < 0.03 && mean(&|h| h.uvn.y).abs() < 0.03);
            if nu == nv {
                // E[cos θ] = (ν + 1)/(ν + 2).
                assert!((mean(&|h| h.uvn.z) - (nu + 1.0) / (nu + 2.0)).abs() < 0.02);
            } else {
                assert!(mean(&|h| h.uvn.x.abs()) > 2.0 * mean(&|h| h.uvn.y.abs()));
            }
        }
    }
    #[test]
    fn under_even_light_a_perfect_mirror_is_as_bright_as_the_light() {
        let mut sharp = material(environment(|_, _| 0.5));
        (sharp.nu, sharp.nv) = (5000.0, 5000.0);
        let scene = ball();
        let tile = sharp.render_tile(&scene, TileAt::new(0, 0)).unwrap();
        // Where the surface faces the viewer, well inside the ball.
        let red = f32::from(tile.bytes()[(60 * TILE + 60) * 4]) / 255.0;
        assert!((crate::math::srgb::decode(red) - 0.5).abs() < 0.01, "{red}");
    }
    #[test]
    fn a_matt_material_sees_what_a_hemisphere_gathers() {
        let mut matt = material(environment(|_, y| if y < 32 { 0.9 } else { 0.1 }));
        (matt.diffuse, matt.specular) = (term(Color::WHITE, 0.6, 0.2, 0.0), Term::NONE);
        // The sum over two thousand directions instead of the usual number.
        let all: Vec<Vec3> = (0..2000).map(|i| crate::shading::environment::projection::spread(i, 2000)).collect();
        assert_shows(&matt, 3.0, |surface, x, y| {
            let n = surface.normal(x, y);
            let from = |l: &Vec3| if l.y > 0.0 { 0.9 } else { 0.1 } * ashikhmin::matt(n.dot(*l), surface.facing(x, y));
            Vec3::splat(0.6 * 4.0 * all.iter().map(from).sum::<f32>() / 2000.0)
        });
    }
    #[test]
    fn a_small_sun_makes_no_fireflies() {
        let mut glossy = material(environment(|x, y| if (x, y) == (40, 12) { 4000.0 } else { 0.02 }));
        (glossy.nu, glossy.nv, glossy.specular.weight) = (30.0, 30.0, 0.05);
        glossy.specular.scaling = Scaling::new(0.5, 1.0);
        let scene = ball();
        let surface = scene.surface.clone().unwrap();
        let tile = glossy.render_tile(&scene, TileAt::new(0, 0)).unwrap();
        let red = |x: usize, y: usize| i32::from(tile.bytes()[(y * TILE + x) * 4]);
        for y in 30..62 {
            for x in 30..62 {
                let turned = (surface.normal(x, y) - surface.normal(x + 1, y)).length();
                let step = (red(x, y) - red(x + 1, y)).abs();
                // The lobe is about 0.2 wide: brightness may not jump where the surface hardly turns.
                assert!(step < 12 + (700.0 * turned) as i32, "({x}, {y}): {step} over {turned}");
            }
        }
    }
}
