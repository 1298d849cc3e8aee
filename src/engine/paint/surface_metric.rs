//! Paths measured along the surface, with their lengths there instead of as seen. Floor 3.

use crate::math::Vec2;
use crate::surface::{Operator, Scene, Surface};
use std::sync::Arc;

/// The surface that paths are measured on.
#[derive(Clone)]
pub struct SurfaceMetric {
    surface: Arc<Surface>,
    /// a of MATH 8: that of the unwrapping if marks are printed by one, else 1.
    amount: f32,
}

impl SurfaceMetric {
    /// `None` if there is no surface.
    pub fn of(scene: &Scene, operator: Operator) -> Option<Self> {
        let amount = operator.unwrapping().map_or(1.0, |settings| settings.amount);
        scene.surface.clone().map(|surface| Self { surface, amount })
    }

    /// The length of a px of a path on the surface: |S d| of MATH 8, between pixels; 1 off it.
    ///
    /// * `at`: canvas px. `way`: only its direction matters.
    pub fn stretch(&self, at: Vec2, way: Vec2) -> f32 {
        let (surface, at) = self.surface.read_at(at);
        if !surface.size().rect().contains(at.x.floor() as i32, at.y.floor() as i32) {
            return 1.0;
        }
        let along = way.normalize_or_zero();
        let on = |(x, y, share): (usize, usize, f32)| {
            share * (surface.stretch(x, y, self.amount) * along).length()
        };
        let length: f32 = surface.linked_pixels(at).map(on).sum();
        if length.is_finite() && length > 0.0 { length } else { 1.0 }
    }
}
