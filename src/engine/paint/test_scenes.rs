//! Scenes that several tests of painting share. Floor 3.

use super::Scene;
use crate::math::{Size, vec2, vec3};
use crate::raster::Plane;
use crate::surface::{Maps, Surface};
use std::sync::Arc;

/// A ball in the middle of its own canvas, with matching depth and normals.
pub fn ball(size: Size, radius_px: f32) -> Scene {
    let at = |x: usize, y: usize| (vec2(x as f32, y as f32) + 0.5 - size.center()) / radius_px;
    let height = |x: usize, y: usize| (1.0 - at(x, y).length_squared()).max(0.0).sqrt();
    let normals =
        Plane::from_fn(size, |x, y| vec3(at(x, y).x, -at(x, y).y, height(x, y).max(0.02)));
    let depth = Plane::from_fn(size, |x, y| 1.0 - height(x, y));
    let coverage = Plane::from_fn(size, |x, y| if at(x, y).length() < 1.0 { 255 } else { 0 });
    let surface = Surface::new(Maps { normals, depth, coverage }).unwrap();
    Scene { size, surface: Some(Arc::new(surface)) }
}
