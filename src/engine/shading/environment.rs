//! An environment: the light that arrives from every direction, as a picture fixed to the camera.
//! Floor 3. Here: its parameters, and light by camera direction. Not here: how directions lie in a
//! picture (`projection`), reading it over a footprint (`map`, `rows`), gathering it over a
//! hemisphere (`irradiance`).

pub mod irradiance;
pub mod level;
pub mod map;
pub mod projection;
mod rows;

use crate::math::{Vec3, vec3};
use crate::raster::{Picture, TILE, picture::Texels};
use crate::shading::surface_row::{Light3, RowValues};
use irradiance::Irradiance;
use map::EnvironmentMap;
pub use projection::Projection;
pub use rows::Directions;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A picture of the surroundings.
#[derive(Clone)]
pub struct Environment {
    /// Its name in the document.
    pub file: String,
    /// The light from every direction.
    pub picture: Picture,
    /// How its pixels are directions.
    pub projection: Projection,
    /// About the vertical axis, degrees: direction d is looked up at R_y(rotation) d.
    pub rotation: f32,
    /// Stops: light is multiplied by 2^exposure.
    pub exposure: f32,
    cache: Arc<Mutex<Option<PreparedCache>>>,
}

impl PartialEq for Environment {
    /// The same picture in the same place, whatever its name.
    fn eq(&self, other: &Self) -> bool {
        let lies = |e: &Self| (e.projection, e.rotation, e.exposure);
        lies(self) == lies(other) && self.picture == other.picture
    }
}

/// The cached preparation of a picture in a projection.
struct PreparedCache {
    picture: Picture,
    projection: Projection,
    prepared: Arc<PreparedEnvironment>,
}

/// A picture prepared for lookups. It does not depend on rotation and exposure, which may be
/// dragged.
struct PreparedEnvironment {
    map: EnvironmentMap,
    irradiance: OnceLock<Irradiance>,
}

/// The light of an environment as the surface receives it: all lookups go through this. Directions
/// are camera space (y up), light is linear; rotation and exposure are applied.
#[derive(Clone)]
pub struct EnvironmentLight {
    prepared: Arc<PreparedEnvironment>,
    turn: YRotation,
    gain: f32,
}

/// One of the directions that represent a whole environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentSample {
    /// Toward the light, unit, camera space.
    pub direction: Vec3,
    /// Steradians; those of all samples add up to 4π.
    pub solid_angle: f32,
    /// Mean linear light over that solid angle.
    pub radiance: Vec3,
}

impl Environment {
    /// A panorama as it is, under its name in the document.
    pub fn new(file: String, picture: Picture) -> Self {
        let projection = Projection::default();
        Self { file, picture, projection, rotation: 0.0, exposure: 0.0, cache: Arc::default() }
    }

    /// The light, prepared for lookups. The costly part is cached and shared by copies of this
    /// environment, whatever their rotation and exposure. Call it before going parallel.
    pub fn environment_light(&self) -> EnvironmentLight {
        let (sin, cos) = self.rotation.to_radians().sin_cos();
        EnvironmentLight {
            prepared: self.prepare(),
            turn: YRotation { sin, cos },
            gain: self.exposure.exp2(),
        }
    }

    /// It never computes while holding the lock: a thread that waits for work in its own pool would
    /// deadlock.
    fn prepare(&self) -> Arc<PreparedEnvironment> {
        let lock = || self.cache.lock().unwrap_or_else(PoisonError::into_inner);
        let holds = |k: &PreparedCache| {
            k.projection == self.projection && is_same(&k.picture, &self.picture)
        };
        if let Some(kept) = lock().as_ref().filter(|k| holds(k)) {
            return kept.prepared.clone();
        }
        let map = EnvironmentMap::new(self.picture.clone(), self.projection);
        let prepared = Arc::new(PreparedEnvironment { map, irradiance: OnceLock::new() });
        let (picture, projection) = (self.picture.clone(), self.projection);
        *lock() = Some(PreparedCache { picture, projection, prepared: prepared.clone() });
        prepared
    }
}

fn is_same(a: &Picture, b: &Picture) -> bool {
    match (&a.texels, &b.texels) {
        (Texels::Srgb8(a), Texels::Srgb8(b)) => Arc::ptr_eq(a, b),
        (Texels::Linear(a), Texels::Linear(b)) => Arc::ptr_eq(a, b),
        _ => false,
    }
}

impl EnvironmentLight {
    /// L_env(d): light from a unit direction, read as finely as the picture is.
    pub fn radiance(&self, d: Vec3) -> Vec3 {
        self.prepared.map.at(self.turn.apply(d)) * self.gain
    }

    /// The mean light over a cone of about `width_rad` across.
    pub fn mean_over_cone(&self, d: Vec3, width_rad: f32) -> Vec3 {
        self.prepared.map.mean_over_cone(self.turn.apply(d), width_rad) * self.gain
    }

    /// The mean light over the footprint of a pixel from which the direction changes by `dx` to the
    /// next in its row and by `dy` to the next in its column.
    pub fn mean_over_pixel(&self, d: Vec3, dx: Vec3, dy: Vec3) -> Vec3 {
        let turn = self.turn;
        self.prepared.map.mean_over_pixel(turn.apply(d), turn.apply(dx), turn.apply(dy)) * self.gain
    }

    /// [`EnvironmentLight::mean_over_pixel`] at the covered pixels of a row; elsewhere it is black.
    pub fn mean_over_pixel_row(
        &self,
        d: &Directions,
        dx: &Directions,
        dy: &Directions,
        covered: &[u8],
        light: &mut Light3,
    ) {
        let [d, dx, dy] = [d, dx, dy].map(|directions| self.turn_directions(directions));
        self.prepared.map.mean_over_pixel_row(&d, &dx, &dy, covered, light);
        self.expose(light);
    }

    /// [`EnvironmentLight::mean_over_cone`] at the pixels of a row that `wanted` is not 0 at; elsewhere it
    /// is black.
    pub fn mean_over_cone_row(
        &self,
        d: &Directions,
        width_rad: &RowValues,
        wanted: &RowValues,
        light: &mut Light3,
    ) {
        self.prepared.map.mean_over_cone_row(&self.turn_directions(d), width_rad, wanted, light);
        self.expose(light);
    }

    /// [`EnvironmentLight::matt`] at every pixel of a row.
    pub fn matt_row(&self, n: &Directions, light: &mut Light3) {
        rows::read_level(self.irradiance().level(), &self.turn_directions(n), light);
        self.expose(light);
    }

    fn turn_directions(&self, d: &Directions) -> Directions {
        let mut turned = [[0.0; TILE]; 3];
        turn_row(self.turn, d, &mut turned);
        turned
    }

    fn expose(&self, light: &mut Light3) {
        light.iter_mut().flatten().for_each(|light| *light *= self.gain);
    }

    /// L̄(n): the cosine-weighted mean of the light over the hemisphere around a unit normal (RS
    /// sec. 5.3.1).
    pub fn matt(&self, n: Vec3) -> Vec3 {
        self.irradiance().at(self.turn.apply(n)) * self.gain
    }

    /// max L_env: the greatest luminance of any texel.
    pub fn brightest(&self) -> f32 {
        self.prepared.map.brightest() * self.gain
    }

    /// max L̄.
    pub fn brightest_matt(&self) -> f32 {
        self.irradiance().brightest() * self.gain
    }

    /// `count` directions spread evenly over the sphere (a Fibonacci spiral), each with the light
    /// around it.
    pub fn samples(&self, count: usize) -> Vec<EnvironmentSample> {
        let solid_angle = 4.0 * std::f32::consts::PI / count.max(1) as f32;
        let sample = |i: usize| {
            let direction = projection::spread(i, count);
            EnvironmentSample {
                direction,
                solid_angle,
                radiance: self.mean_over_cone(direction, solid_angle.sqrt()),
            }
        };
        (0..count).map(sample).collect()
    }

    /// Cached; the first caller computes it.
    fn irradiance(&self) -> &Irradiance {
        crate::memory::once(&self.prepared.irradiance, || Irradiance::of(&self.prepared.map))
    }
}

/// R_y(a) = [[c, 0, s], [0, 1, 0], [−s, 0, c]]: from camera space into the picture's own.
#[derive(Clone, Copy)]
struct YRotation {
    sin: f32,
    cos: f32,
}

impl YRotation {
    #[inline(always)]
    fn apply(self, d: Vec3) -> Vec3 {
        vec3(self.cos * d.x + self.sin * d.z, d.y, self.cos * d.z - self.sin * d.x)
    }
}

crate::widest! {
    fn turn_row(turn: YRotation, d: &Directions, turned: &mut Directions) {
        for x in 0..TILE {
            let e = turn.apply(vec3(d[0][x], d[1][x], d[2][x]));
            (turned[0][x], turned[1][x], turned[2][x]) = (e.x, e.y, e.z);
        }
    }
}

#[cfg(test)]
mod tests;
