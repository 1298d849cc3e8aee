//! Lights: plain data, so that they can be dragged on the canvas, and where they stand seen from a row of pixels.
//! Floor 3.

use super::ground::{Ground, Pixels, Toward};
use crate::math::{Vec3, srgb::Color, vec3};
use crate::raster::TILE;

/// One light. It casts no shadows and does not weaken with distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    pub kind: LightKind,
    pub color: Color,
    /// Factor of the colour in linear light, `≥ 0`.
    pub intensity: f32,
}

/// Where the light stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Infinitely far. `direction` points toward the light, camera space (y up), any length but 0.
    Directional { direction: Vec3 },
    /// At a point of the canvas (px, y down) and a height above the surface's nearest point (px, toward the viewer).
    Point { position: Vec3 },
}

impl Default for Light {
    fn default() -> Self {
        let kind = LightKind::Directional { direction: vec3(0.3, 0.5, 0.8) };
        Self { kind, color: Color::WHITE, intensity: 1.0 }
    }
}

/// A light seen from the pixels of a row.
pub struct RowLight {
    /// ℓ, unit, camera space.
    pub direction: [Pixels; 3],
    /// ℓ where it is the same for all.
    one: Option<Vec3>,
    /// Colour × intensity, linear.
    pub radiance: [f32; 3],
}

impl RowLight {
    /// From one direction, of any length; `radiance` linear.
    pub fn directional(direction: Vec3, radiance: [f32; 3]) -> Self {
        let l = direction.normalize_or(Vec3::Z);
        Self { direction: l.to_array().map(|v| [v; TILE]), one: Some(l), radiance }
    }
    fn point(position: Vec3, radiance: [f32; 3], ground: &Ground) -> Self {
        let [mut lx, mut ly, mut lz] = [[0.0; TILE], [0.0; TILE], [1.0; TILE]];
        let surface = ground.surface;
        for (x, ((lx, ly), lz)) in lx.iter_mut().zip(&mut ly).zip(&mut lz).enumerate().take(ground.width) {
            // The surface recedes from its nearest point, at height 0, by its depth.
            let depth_px = surface.depth(ground.x0 + x, ground.y) * surface.depth_range_px();
            let (right, down) = ((ground.x0 + x) as f32 + 0.5, ground.y as f32 + 0.5);
            let l = vec3(position.x - right, down - position.y, position.z + depth_px).normalize_or(Vec3::Z);
            (*lx, *ly, *lz) = (l.x, l.y, l.z);
        }
        Self { direction: [lx, ly, lz], one: None, radiance }
    }
    /// What κ(ℓ) is asked for.
    pub fn toward(&self) -> Toward<'_> {
        match self.one {
            Some(l) => Toward::One(l),
            None => Toward::Each(&self.direction[0], &self.direction[1]),
        }
    }
}

impl Light {
    pub fn on(&self, ground: &Ground) -> RowLight {
        let radiance = self.color.linear().map(|c| c * self.intensity);
        match self.kind {
            LightKind::Directional { direction } => RowLight::directional(direction, radiance),
            LightKind::Point { position } => RowLight::point(position, radiance, ground),
        }
    }
}
