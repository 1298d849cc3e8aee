//! Cast shadows of lamps: settings that every model with lamps has. Floor 3. Not here: where
//! shadows fall (`surface::shadow`).

use super::{Light, LightKind};
use crate::math::number_settings::number_settings;
use crate::math::srgb::Color;
use crate::surface::Surface;
use crate::surface::shadow::{LampPlace, ShadowLamp, ShareMap};
use std::sync::Arc;

number_settings! {
    /// How lamps cast shadows.
    pub struct Shadows {
        /// The share of a lamp's light that its shadow takes away.
        strength: "Shadow", "How dark shadows are", 0.0..=1.0, 0.88;
        /// The radius of a lamp as a share of its distance.
        softness: "Shadow softness", "How large the lamp is: shadows become softer with distance", 0.0..=1.0, 0.13;
        /// How far shadows are thrown in the picture, px; they fade from half of that on.
        reach: "Shadow length", "How far shadows reach, px; they fade in the second half", 1.0..=2000.0, 220.0, px;
        /// Opacity of the shadow on the page beneath the surface.
        ground: "Ground shadow", "Shadow on the page around the figure", 0.0..=1.0, 0.0;
        and
        /// Whether lamps cast shadows at all.
        on: bool = false;
        /// The light that is left in a shadow takes this color; black lets none in.
        color: Color = Color::BLACK;
        /// Rays to each lamp.
        rays: u32 = 32;
        /// Whether shadows are computed at half the size, for a moment; documents never say so.
        is_coarse: bool = false;
    }
}

impl Shadows {
    /// What `rays` may be.
    pub const RAYS: std::ops::RangeInclusive<u32> = 1..=crate::surface::shadow::MOST_RAYS;
    /// Rays while a lamp is dragged.
    const FEW_RAYS: u32 = 4;
    /// The lamps of one layer that cast shadows: the first ones.
    pub const MOST_LAMPS: usize = 8;

    /// Whether something is to be computed.
    pub fn has_effect(&self) -> bool {
        self.on && (self.strength > 0.0 || self.ground > 0.0)
    }

    /// Whether the page around the figure is shaded.
    pub fn has_ground(&self) -> bool {
        self.on && self.ground > 0.0
    }

    /// The same for a moment while the user drags, cheaper.
    pub fn drafted(&self) -> Self {
        Self { rays: self.rays.min(Self::FEW_RAYS), is_coarse: true, ..*self }
    }

    /// The same on a canvas `factor` times as large.
    pub fn scaled(&self, factor: f32) -> Self {
        let mut next = *self;
        Self::lengths().for_each(|setting| setting.scale(&mut next, factor));
        next
    }

    /// The light that is left where a lamp is hidden, linear, as a share of its own.
    pub fn remaining_light(&self) -> [f32; 3] {
        self.color.linear().map(|c| 1.0 - self.strength * (1.0 - c))
    }

    /// What every pixel sees of each lamp; none for those that cast no shadow.
    pub fn maps(&self, surface: &Surface, lights: &[Light]) -> Vec<Arc<ShareMap>> {
        if !self.has_effect() {
            return Vec::new();
        }
        // Those at rest and those that are dragged.
        let keep = 2 * lights.len().clamp(2, Self::MOST_LAMPS);
        let lamps = lights.iter().take(Self::MOST_LAMPS);
        lamps.map(|light| surface.shadow(&self.lamp(light), keep)).collect()
    }

    fn lamp(&self, light: &Light) -> ShadowLamp {
        let place = match light.kind {
            LightKind::Directional { direction } => LampPlace::Afar(direction),
            LightKind::Point { position } => LampPlace::At(position),
        };
        let Self { softness: radius, reach: reach_px, rays, is_coarse, .. } = *self;
        ShadowLamp { place, radius, reach_px, rays, is_coarse }
    }

    /// The opacity of the shadow on the page at a pixel off the surface: the mean of what is hidden
    /// of the lamps, by their light.
    pub fn ground_at(
        &self,
        maps: &[Arc<ShareMap>],
        lights: &[Light],
        (x, y): (usize, usize),
    ) -> f32 {
        let lamps = lights.iter().zip(maps);
        let (hidden, all) = lamps.fold((0.0, 0.0), |(hidden, all), (light, map)| {
            (hidden + light.intensity * (1.0 - map.at(x, y)), all + light.intensity)
        });
        if all > 0.0 { self.ground * hidden / all } else { 0.0 }
    }
}
