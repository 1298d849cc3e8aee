//! Lights: plain data, so that they can be dragged on the canvas.
//! Floor 3.

use crate::math::{Vec3, srgb::Color, vec3};

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
