//! The material of Ashikhmin and Shirley under an environment: sampled in the directions it
//! reflects, with the same samples at every pixel (RS sec. 5.2, MATH 5). Floor 3. Not here: the
//! lobes (`ashikhmin`).
//!
//! Each sample represents a part of the lobe and reads the mean of the environment over that part,
//! so that a small sun makes no fireflies and single samples are invisible.

mod bounced;

use super::ashikhmin::{self, DirectedLight};
use super::second_look::SecondLook;
use super::{Shading, lobes};
use crate::math::{Vec3, fast, vec3};
use crate::raster::TILE;
use crate::shading::environment::{Directions, EnvironmentLight};
use crate::shading::surface_row::{Light3, LightDirection, RowRelief, RowValues, SurfaceRow};
use bounced::BouncedLight;
use std::f32::consts::PI;

/// Directions that the matt term is lit from.
const SAMPLES: usize = 128;
/// Half vectors of the glossy term.
const HALVES: usize = 32;

/// What the rows of a tile share.
pub struct EnvironmentSamples {
    environment_light: EnvironmentLight,
    /// For the matt term: the environment as lights.
    lights: Vec<DirectedLight>,
    halves: Vec<HalfVector>,
    /// About as far as the lobe spreads the light of one direction, radians.
    lobe_rad: f32,
    /// What the surface adds on the tile that is shaded.
    bounced: Option<BouncedLight>,
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
        // Light from a solid angle Ω counts Ω / π: matt white is as bright as an even environment
        // around it.
        let light = |p: &crate::shading::environment::EnvironmentSample| DirectedLight {
            direction: p.direction,
            radiance: (p.radiance * (p.solid_angle / PI)).to_array(),
        };
        let lights = environment_light.samples(SAMPLES).iter().map(light).collect();
        let halves = (0..HALVES).map(|i| half(i, shading.nu, shading.nv)).collect();
        // The solid angle of the half vectors' lobe, 2π / (ν + 1), is four times as large in ℓ.
        let lobe_rad = (8.0 * PI / ((shading.nu + 1.0) * (shading.nv + 1.0)).sqrt()).sqrt();
        Some(Self { environment_light, lights, halves, lobe_rad, bounced: None })
    }

    /// Adds both terms along a row.
    pub fn shade(
        &self,
        shading: &Shading,
        surface_row: &SurfaceRow,
        relief: &mut RowRelief,
        light: &mut Light3,
    ) {
        if shading.diffuse.weight > 0.0 {
            ashikhmin::add_matt_of(shading, surface_row, &self.lights, relief, light);
        }
        if shading.specular.weight > 0.0 {
            self.add_glossy(shading, surface_row, relief, light);
        }
    }

    /// Adds the glossy term along a row.
    ///
    /// With half vectors drawn in proportion to the lobe, light arrives weighted by F (n·ℓ)₊ /
    /// max(n·ℓ, n·e), never above 1.
    fn add_glossy(
        &self,
        shading: &Shading,
        surface_row: &SurfaceRow,
        relief: &mut RowRelief,
        light: &mut Light3,
    ) {
        let scaling = shading.specular.scaling;
        let rs = shading.specular.linear().map(|c| c.min(1.0));
        // In the frame of each pixel's view, where that is (0, 0, 1).
        let normal = surface_row.seen_normal();
        let [mut u, mut v, mut toward, mut incoming] = [[[0.0; TILE]; 3]; 4];
        let [mut h_e, mut weight, mut width_rad] = [[0.0; TILE]; 3];
        find_frames(normal, &mut u, &mut v);
        relief.turn(surface_row, LightDirection::VIEWER);
        // Pixels of a far side follow all of their rays themselves.
        let bounces = if self.bounced.is_some() { 0 } else { shading.bounces_made() };
        let second = SecondLook::on(surface_row.surface, bounces);
        let [mut weights, mut scaled] = [[0.0; TILE]; 2];
        for half in &self.halves {
            mirror_at([&u, &v, normal], half, &mut toward, &mut h_e);
            weigh(normal, &toward, &h_e, surface_row.coverage(), &mut weight);
            if weight.iter().all(|w| *w == 0.0) {
                continue;
            }
            find_widths(&h_e, half.density, &mut width_rad);
            let toward = surface_row.from_seen(&toward);
            match &second {
                Some(second) => self.follow(
                    shading,
                    surface_row,
                    second,
                    (&toward, &width_rad, &weight),
                    &mut incoming,
                ),
                None => self.environment_light.mean_over_cone_row(
                    &toward,
                    &width_rad,
                    &weight,
                    &mut incoming,
                ),
            }
            add_row(&weight, &mut weights);
            if shading.specular.is_scaled() {
                if surface_row.features.is_directional() {
                    relief.turn(surface_row, LightDirection::Each(&toward[0], &toward[1]));
                }
                lobes::scale(
                    &mut weight,
                    scaling,
                    relief.exponentials(scaling),
                    &[half.uvn.z; TILE],
                );
            }
            add_row(&weight, &mut scaled);
            add_weighed(&incoming, &weight, &h_e, rs, light);
        }
        let Some(bounced) = &self.bounced else { return };
        // Scaled as the light of all half vectors is in the mean.
        for x in (0..surface_row.width).filter(|&x| weights[x] > 0.0) {
            let change = bounced.at(surface_row.surface, (surface_row.x0 + x, surface_row.y));
            let change = change * (scaled[x] / weights[x]);
            (0..3).for_each(|c| light[c][x] += change[c]);
        }
    }
}

/// u and v of a normal: u runs along the picture's x, v along its y.
#[inline(always)]
fn frame(n: Vec3) -> (Vec3, Vec3) {
    // (x − n_x n) / |…|; where the normal is ±x, any u is valid.
    let squared = n.y * n.y + n.z * n.z;
    let per_length = 1.0 / fast::max(squared.sqrt(), 1e-6);
    let along = vec3(1.0 - n.x * n.x, -n.x * n.y, -n.x * n.z) * per_length;
    let u = if squared < 1e-12 { Vec3::Y } else { along };
    (u, n.cross(u))
}

/// How wide a part of the lobe a half vector represents, radians. For ℓ: dω_h / dω_ℓ = 1 / (4 h·e).
/// Slightly more than its share, so that neighbors overlap.
#[inline(always)]
fn width_rad(h_e: f32, density: f32) -> f32 {
    1.5 * (4.0 * fast::max(h_e, 0.0) / (density * HALVES as f32)).sqrt()
}

crate::widest! {
    /// The frame of each pixel.
    fn find_frames(normal: &Directions, u: &mut Directions, v: &mut Directions) {
        for x in 0..TILE {
            let (a, b) = frame(vec3(normal[0][x], normal[1][x], normal[2][x]));
            (u[0][x], u[1][x], u[2][x]) = (a.x, a.y, a.z);
            (v[0][x], v[1][x], v[2][x]) = (b.x, b.y, b.z);
        }
    }

    /// The viewer mirrored at a half vector, and h·e.
    fn mirror_at(frame: [&Directions; 3], half: &HalfVector, toward: &mut Directions, h_e: &mut RowValues) {
        let [u, v, n] = frame;
        for x in 0..TILE {
            let h = |c: usize| half.uvn.x * u[c][x] + half.uvn.y * v[c][x] + half.uvn.z * n[c][x];
            let twice = 2.0 * h(2);
            (toward[0][x], toward[1][x], toward[2][x]) = (twice * h(0), twice * h(1), twice * h(2) - 1.0);
            h_e[x] = h(2);
        }
    }

    /// (n·ℓ)₊ / max(n·ℓ, n·e) of the covered pixels.
    fn weigh(n: &Directions, toward: &Directions, h_e: &RowValues, covered: &[u8], weight: &mut RowValues) {
        let mut is_covered = [0; TILE];
        is_covered[..covered.len()].copy_from_slice(covered);
        for x in 0..TILE {
            let n_l = n[0][x] * toward[0][x] + n[1][x] * toward[1][x] + n[2][x] * toward[2][x];
            let share = n_l / fast::max(fast::max(n_l, n[2][x]), 1e-3);
            let arrives = (n_l > 0.0) & (h_e[x] > 0.0) & (is_covered[x] > 0);
            weight[x] = if arrives { share } else { 0.0 };
        }
    }

    /// How wide a part of the lobe each sample represents, radians.
    fn find_widths(h_e: &RowValues, density: f32, widths_rad: &mut RowValues) {
        for x in 0..TILE {
            widths_rad[x] = width_rad(h_e[x], density);
        }
    }

    fn add_row(row: &RowValues, sums: &mut RowValues) {
        for x in 0..TILE {
            sums[x] += row[x];
        }
    }

    /// Adds a sample: F times its light and weight.
    fn add_weighed(incoming: &Light3, weight: &RowValues, h_e: &RowValues, rs: [f32; 3], light: &mut Light3) {
        for c in 0..3 {
            for x in 0..TILE {
                let fresnel = rs[c] + (1.0 - rs[c]) * ashikhmin::whiteness(h_e[x]);
                light[c][x] += fresnel * incoming[c][x] * weight[x] * (1.0 / HALVES as f32);
            }
        }
    }
}

/// The `i`th of [`HALVES`] half vectors in proportion to the lobe (Ashikhmin and Shirley 2000, eq.
/// 9 and 10).
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
    HalfVector {
        uvn: vec3(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta),
        density: density.max(1e-6),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, srgb::Color};
    use crate::raster::{Picture, TILE, TileAt};
    use crate::shading::material::tests::{assert_shows, ball, term};
    use crate::shading::{Environment, Model, Scaling, Term};

    fn environment(light: impl Fn(usize, usize) -> f32) -> Environment {
        let texels = (0..128 * 64)
            .map(|i| [light(i % 128, i / 128); 3])
            .map(|[r, g, b]| [r, g, b, 1.0])
            .collect();
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
            let mean = |of: &dyn Fn(&HalfVector) -> f32| {
                halves.iter().map(of).sum::<f32>() / HALVES as f32
            };
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
        let all: Vec<Vec3> =
            (0..2000).map(|i| crate::shading::environment::projection::spread(i, 2000)).collect();
        assert_shows(&matt, 3.0, |surface, x, y| {
            let n = surface.normal(x, y);
            let from = |l: &Vec3| if l.y > 0.0 { 0.9 } else { 0.1 } * ashikhmin::matt(n.dot(*l), surface.facing(x, y));
            Vec3::splat(0.6 * 4.0 * all.iter().map(from).sum::<f32>() / 2000.0)
        });
    }

    #[test]
    fn a_small_sun_makes_no_fireflies() {
        let mut glossy =
            material(environment(|x, y| if (x, y) == (40, 12) { 4000.0 } else { 0.02 }));
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
                // The lobe is about 0.2 wide: brightness may not jump where the surface hardly
                // turns.
                assert!(step < 12 + (700.0 * turned) as i32, "({x}, {y}): {step} over {turned}");
            }
        }
    }
}
