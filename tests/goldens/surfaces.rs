//! Shapes for the reference pictures. Sums, products, quotients and roots only, which IEEE 754
//! rounds alike everywhere.

use rilievo::math::{Vec3, vec3};
use rilievo::raster::Plane;
use rilievo::{Maps, Size, Surface};
use std::sync::Arc;

/// Beyond one tile each way, so that borders of tiles are seen.
pub const SIZE: Size = Size::new(80, 72);
/// Samples a side that a pixel's coverage is counted from.
const SAMPLES: i32 = 8;

/// What is painted on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Half a ball in front of nothing.
    Ball,
    /// The front of a ring in front of nothing.
    Torus,
    /// Waves along both axes, without an end.
    Waves,
    /// A ball before a slanted wall: a contour within the surface.
    BallAndWall,
}

/// Height toward the viewer in pixels, and the normal, y up.
type Point = (f32, Vec3);

impl Shape {
    pub fn surface(self) -> Arc<Surface> {
        let center = |x: usize, y: usize| self.at(x as f32 + 0.5, y as f32 + 0.5);
        let heights: Vec<f32> =
            all().filter_map(|(x, y)| center(x, y)).map(|(height, _)| height).collect();
        let (low, high) =
            heights.iter().fold((f32::MAX, f32::MIN), |(a, b), &h| (a.min(h), b.max(h)));
        let depth =
            |x, y| center(x, y).map_or(f32::NAN, |(height, _)| (high - height) / (high - low));
        let maps = Maps {
            normals: Plane::from_fn(SIZE, |x, y| {
                center(x, y).map_or(Vec3::ZERO, |(_, normal)| normal)
            }),
            depth: Plane::from_fn(SIZE, depth),
            coverage: Plane::from_fn(SIZE, |x, y| self.coverage(x, y)),
        };
        Arc::new(Surface::new(maps).unwrap())
    }

    fn coverage(self, x: usize, y: usize) -> u8 {
        let along = |i: i32| (i as f32 + 0.5) / SAMPLES as f32;
        let samples = (0..SAMPLES * SAMPLES)
            .map(|i| (x as f32 + along(i % SAMPLES), y as f32 + along(i / SAMPLES)));
        let inside = samples.filter(|&(x, y)| self.at(x, y).is_some()).count() as i32;
        (inside * 255 / (SAMPLES * SAMPLES)) as u8
    }

    /// The nearest surface at a point of the canvas, y down.
    fn at(self, x: f32, y: f32) -> Option<Point> {
        match self {
            Shape::Ball => ball(x - 40.5, y - 35.0, 32.0),
            Shape::Torus => torus(x - 39.5, y - 36.5, 22.0, 12.0),
            Shape::Waves => {
                let (a, slope_a) = wave(x / 26.0 + 0.2);
                let (b, slope_b) = wave(y / 34.0);
                Some((6.0 * a + 5.0 * b, facing(6.0 * slope_a / 26.0, 5.0 * slope_b / 34.0)))
            }
            Shape::BallAndWall => {
                let wall = (0.15 * x - 0.1 * y - 24.0, facing(0.15, -0.1));
                Some(ball(x - 34.0, y - 38.5, 24.0).unwrap_or(wall))
            }
        }
    }
}

fn all() -> impl Iterator<Item = (usize, usize)> {
    (0..SIZE.area()).map(|i| (i % SIZE.width as usize, i / SIZE.width as usize))
}

fn ball(dx: f32, dy: f32, radius: f32) -> Option<Point> {
    let rest = radius * radius - dx * dx - dy * dy;
    (rest > 0.0).then(|| (rest.sqrt(), vec3(dx, -dy, rest.sqrt()) / radius))
}

fn torus(dx: f32, dy: f32, ring: f32, tube: f32) -> Option<Point> {
    let distance = (dx * dx + dy * dy).sqrt();
    let across = distance - ring;
    let rest = tube * tube - across * across;
    let out = if distance > 0.0 { across / distance } else { 0.0 };
    (rest > 0.0).then(|| (rest.sqrt(), vec3(dx * out, -dy * out, rest.sqrt()) / tube))
}

/// A wave of period 1 and height 1 made of parabolas, and its slope.
fn wave(t: f32) -> (f32, f32) {
    let t = t - t.floor();
    let (sign, t) = if t < 0.5 { (1.0, t) } else { (-1.0, t - 0.5) };
    (sign * 16.0 * t * (0.5 - t), sign * (8.0 - 32.0 * t))
}

/// The normal of a height that rises by `right` and `down` a pixel.
fn facing(right: f32, down: f32) -> Vec3 {
    let length = (right * right + down * down + 1.0).sqrt();
    vec3(-right, down, 1.0) / length
}
