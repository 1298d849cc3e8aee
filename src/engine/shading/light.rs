//! Lights: plain data that can be dragged on the canvas, and their directions from a row of pixels.
//! Floor 3.

use super::surface_row::{LightDirection, RowValues, SurfaceRow};
use crate::math::{Range, Vec3, fast, srgb::Color, vec3};
use crate::raster::TILE;
use crate::surface::shadow::ShareMap;
use std::sync::Arc;

/// One light. It does not weaken with distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it is.
    pub kind: LightKind,
    /// Its color; alpha is ignored.
    pub color: Color,
    /// Factor of the color in linear light, `≥ 0`.
    pub intensity: f32,
}

/// The position of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Infinitely far. `direction` points toward the light, camera space (y up), any length but 0.
    Directional {
        /// Toward the light, of any length but 0.
        direction: Vec3,
    },
    /// At a point of the canvas (px, y down) and a height above the surface's nearest point (px,
    /// toward the viewer).
    Point {
        /// Canvas px; the height is toward the viewer.
        position: Vec3,
    },
}

impl Light {
    /// What an intensity may be.
    pub const INTENSITY: Range = 0.0..=10_000.0;
    /// Whether a vector has a direction: its length is representable.
    pub fn has_direction(direction: Vec3) -> bool {
        let longest = direction.abs().max_element();
        direction.is_finite() && (1e-6..=1e6).contains(&longest)
    }
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
    pub direction: [RowValues; 3],
    /// Color × intensity, linear.
    pub radiance: [f32; 3],
    stands: RowLightPosition,
    /// What is seen of it, if it casts shadows.
    pub shadow: Option<RowShadow>,
}

/// A light's shadow along a row.
pub struct RowShadow {
    map: Arc<ShareMap>,
    /// The share of the light that is seen, `[0, 1]`.
    pub seen: RowValues,
    /// The light that is left where none is seen, a channel each.
    pub left: [f32; 3],
}

enum RowLightPosition {
    /// ℓ, the same at every pixel.
    Afar(Vec3),
    /// As [`LightKind::Point`].
    At(Vec3),
}

impl RowLight {
    /// From one direction, of any length; `radiance` linear.
    pub fn directional(direction: Vec3, radiance: [f32; 3]) -> Self {
        let l = direction.normalize_or(Vec3::Z);
        Self {
            direction: l.to_array().map(|v| [v; TILE]),
            radiance,
            stands: RowLightPosition::Afar(l),
            shadow: None,
        }
    }

    fn point(position: Vec3, radiance: [f32; 3]) -> Self {
        Self {
            direction: [[0.0; TILE], [0.0; TILE], [1.0; TILE]],
            radiance,
            stands: RowLightPosition::At(position),
            shadow: None,
        }
    }

    /// Moves on to a row.
    pub fn turn(&mut self, surface_row: &SurfaceRow) {
        if let Some(RowShadow { map, seen, .. }) = &mut self.shadow {
            map.read(surface_row.x0, surface_row.y, &mut seen[..surface_row.width]);
        }
        let RowLightPosition::At(position) = self.stands else { return };
        let SurfaceRow { surface, x0, y, width, .. } = *surface_row;
        let (depth, range) = (surface.depth_plane().row(y), surface.depth_range_px());
        for (columns, (px, py)) in surface.canvas_runs(x0..x0 + width, y as i32) {
            // The first pixel from the light, x right, y up; heights are counted from the surface's
            // nearest point.
            let first =
                vec3(position.x - (px as f32 + 0.5), py as f32 + 0.5 - position.y, position.z);
            let direction = self.direction.each_mut().map(|d| &mut d[columns.start - x0..]);
            turn_to_point(first, range, &depth[columns], direction);
        }
    }

    /// Whether ℓ is the same at every pixel.
    pub fn is_afar(&self) -> bool {
        matches!(self.stands, RowLightPosition::Afar(_))
    }

    /// The direction for κ(ℓ).
    pub fn direction(&self) -> LightDirection<'_> {
        match self.stands {
            RowLightPosition::Afar(l) => LightDirection::One(l),
            RowLightPosition::At(_) => LightDirection::Each(&self.direction[0], &self.direction[1]),
        }
    }
}

impl RowLight {
    /// The same, casting a shadow.
    pub fn with_shadow(mut self, map: Arc<ShareMap>, left: [f32; 3]) -> Self {
        self.shadow = Some(RowShadow { map, seen: [1.0; TILE], left });
        self
    }
}

impl Light {
    /// The light as seen from the rows of a tile; it is updated for each row.
    pub fn row_light(&self) -> RowLight {
        let radiance = self.color.linear().map(|c| c * self.intensity);
        match self.kind {
            LightKind::Directional { direction } => RowLight::directional(direction, radiance),
            LightKind::Point { position } => RowLight::point(position, radiance),
        }
    }
}

crate::widest! {
    /// ℓ of each pixel of a row: toward a point at `from_first` from the first pixel as if that
    /// were at height 0; the surface recedes from there by its depth.
    fn turn_to_point(from_first: Vec3, depth_range_px: f32, depth: &[f32], direction: [&mut [f32]; 3]) {
        let [lx, ly, lz] = direction;
        for (x, (&depth, ((lx, ly), lz))) in depth.iter().zip(lx.iter_mut().zip(ly).zip(lz)).enumerate() {
            let (right, up) = (from_first.x - x as i32 as f32, from_first.y);
            let toward = from_first.z + depth * depth_range_px;
            let squared = right * right + up * up + toward * toward;
            // A light at the pixel itself shines straight at it.
            let per_length = 1.0 / fast::max(squared, f32::MIN_POSITIVE).sqrt();
            (*lx, *ly, *lz) = (right * per_length, up * per_length, toward * per_length);
            *lz = if squared > 0.0 { *lz } else { 1.0 };
        }
    }
}
