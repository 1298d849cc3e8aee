//! Irradiance: an environment integrated over the hemisphere around every direction, which lights
//! matt surfaces (RS sec. 5.3.1). Floor 3. It is a small prefiltered map instead of spherical
//! harmonics: nine of those ring around a sun, a map does not.

use super::level::SphereLevel;
use super::map::EnvironmentMap;
use super::projection::lat_long_direction;
use crate::math::{Vec3, Vec3A, srgb};
use rayon::prelude::*;
use std::f32::consts::PI;

/// Rows of the samples of light that are summed (2.8° each) and of the resulting map: a cosine lobe
/// is so wide that a bilinear lookup stays close to the sum over every texel
/// (`the_small_map_is_the_sum_over_every_texel`).
const ROWS: usize = 64;

/// L̄(n): the cosine-weighted mean of the light around n. An environment of light 1 has the mean 1.
pub struct Irradiance {
    level: SphereLevel,
    brightest: f32,
}

/// The light of one part of the sphere.
struct LightSample {
    /// Its mean direction, unit: a small sun in a large sample keeps its position.
    toward: Vec3,
    /// Radiance × solid angle.
    light: Vec3,
}

impl Irradiance {
    /// That of a map.
    pub fn of(map: &EnvironmentMap) -> Self {
        let samples = samples(map.level(8 * ROWS));
        let gather = |i: usize| {
            let n = center(i, ROWS);
            let sum: Vec3 = samples.iter().map(|p| p.light * n.dot(p.toward).max(0.0)).sum();
            Vec3A::from(sum / PI)
        };
        let texels: Vec<Vec3A> = (0..2 * ROWS * ROWS).into_par_iter().map(gather).collect();
        let brightest = texels.iter().map(|t| srgb::luminance(t.x, t.y, t.z)).fold(0.0, f32::max);
        Self { level: SphereLevel::new(ROWS, texels), brightest }
    }

    /// max L̄.
    pub fn brightest(&self) -> f32 {
        self.brightest
    }

    /// The map, in the picture's own space.
    pub fn level(&self) -> &SphereLevel {
        &self.level
    }

    /// L̄ around a unit direction of the picture's own space.
    pub fn at(&self, n: Vec3) -> Vec3 {
        self.level.at(n)
    }
}

/// The direction of a texel's middle.
fn center(i: usize, rows: usize) -> Vec3 {
    let (column, row) = (i % (2 * rows), i / (2 * rows));
    lat_long_direction((column as f32 + 0.5) / (2 * rows) as f32, (row as f32 + 0.5) / rows as f32)
}

/// The level's light in at most `ROWS` rows of samples.
fn samples(fine: &SphereLevel) -> Vec<LightSample> {
    let rows = fine.rows().min(ROWS);
    let per_side = fine.rows() / rows;
    let gathered = |i: usize| {
        let (column, row) = (i % (2 * rows) * per_side, i / (2 * rows) * per_side);
        let (mut toward, mut light) = (Vec3::ZERO, Vec3::ZERO);
        for y in row..row + per_side {
            let solid_angle = fine.solid_angle(y);
            for j in (column..column + per_side).map(|x| y * fine.columns() + x) {
                let here = Vec3::from(fine.texels()[j]) * solid_angle;
                toward += center(j, fine.rows()) * srgb::luminance(here.x, here.y, here.z);
                light += here;
            }
        }
        LightSample { toward: toward.normalize_or(Vec3::Y), light }
    };
    (0..2 * rows * rows).into_par_iter().map(gathered).collect()
}
