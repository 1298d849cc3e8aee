//! Solid glass: rays are refracted into the body behind the surface, go through it, and leave it at
//! its back or its rim; the front mirrors its share (MATH 5). Floor 3. Not here: where a ray meets a
//! side of the body (`surface::ray::body`).

use super::rays::{PART_PX, PARTS, RayRow};
use super::refract;
use crate::math::{Vec2, Vec3, vec2};
use crate::raster::TILE;
use crate::shading::Shading;
use crate::shading::environment::EnvironmentLight;
use crate::shading::surface_row::{Light3, SurfaceRow};
use crate::surface::Surface;
use crate::surface::ray::body::{BodySide, InnerRay, SolidBody};

/// A ray that has not left the body after so many sides goes on straight.
const MOST_SIDES: u32 = 8;
/// Σ x² of [`PARTS`], and as much of y; Σ x y is 0.
const PARTS_SQUARED: f32 = 0.3125;

/// The share of light that a smooth surface mirrors (Fresnel's equations, unpolarized).
///
/// * `cos`: n·v, toward where the light comes from.
/// * `index`: the refractive index of what is behind the surface, as a ratio of that before it.
pub fn mirrored_share(cos: f32, index: f32) -> f32 {
    let cos = cos.max(0.0).min(1.0);
    let behind = 1.0 - (1.0 - cos * cos) / (index * index);
    if behind <= 0.0 {
        return 1.0;
    }
    let behind = behind.sqrt();
    let across = (cos - index * behind) / (cos + index * behind);
    let along = (index * cos - behind) / (index * cos + behind);
    0.5 * (across * across + along * along)
}

/// The light that a row's pixels see: L = F L_env(mirrored view) + (1 − F) c^(ℓ/ℓ₀) L_env(r), r the
/// ray that leaves the body, ℓ its way through it, ℓ₀ the body's greatest thickness and c the
/// term's color.
///
/// * `entering`: the views refracted into the glass.
pub fn see(
    shading: &Shading,
    surface_row: &SurfaceRow,
    entering: &RayRow,
    environment_light: &EnvironmentLight,
    incoming: &mut Light3,
) {
    RayRow::new(surface_row, None).see_environment(surface_row, environment_light, incoming);
    let Some(front) = surface_row.surface.front() else { return };
    let body = front.body(shading.solid.back);
    let through = GlassPath { front: &front, body: &body, index: shading.index };
    let color = Vec3::from(shading.specular.color.linear());
    for x in (0..surface_row.width.min(TILE)).filter(|&x| surface_row.coverage()[x] > 0) {
        let (normal, view) = (surface_row.normal_at(x), surface_row.view_at(x));
        let share = mirrored_share(normal.dot(view), shading.index);
        let (px, py) =
            surface_row.surface.canvas_pixel((surface_row.x0 + x) as i32, surface_row.y as i32);
        let middle = vec2(px as f32 + 0.5, py as f32 + 0.5);
        let nearness =
            body.nearness_of(surface_row.surface.depth(surface_row.x0 + x, surface_row.y));
        let leaving = PARTS.map(|part| {
            through.leave(middle + part, nearness, entering.of_part(x, part).direction)
        });
        let [dx, dy] = changes(&leaving.map(|(direction, _)| direction));
        let seen = leaving.map(|(direction, length_px)| {
            let light = environment_light.mean_over_pixel(direction, dx * PART_PX, dy * PART_PX);
            light * color.powf(length_px / body.thickest_px())
        });
        let seen = seen.into_iter().sum::<Vec3>() / PARTS.len() as f32;
        for (incoming, seen) in incoming.iter_mut().zip(seen.to_array()) {
            incoming[x] = share * incoming[x] + (1.0 - share) * seen;
        }
    }
}

/// How the rays of a pixel's parts change along x and y, over the whole pixel: the plane that fits
/// them best.
fn changes(directions: &[Vec3; 4]) -> [Vec3; 2] {
    let weighed = |of: fn(Vec2) -> f32| {
        directions.iter().zip(PARTS).map(|(d, part)| *d * of(part)).sum::<Vec3>() / PARTS_SQUARED
    };
    [weighed(|part| part.x), weighed(|part| part.y)]
}

/// What a ray goes through.
struct GlassPath<'a> {
    front: &'a Surface,
    body: &'a SolidBody,
    index: f32,
}

impl GlassPath<'_> {
    /// The ray that leaves the glass, and the way within it, px.
    fn leave(&self, at: Vec2, nearness: f32, direction: Vec3) -> (Vec3, f32) {
        let mut ray = InnerRay { at, nearness, direction, from: BodySide::Front };
        let mut length_px = 0.0;
        for _ in 0..MOST_SIDES {
            let hit = self.body.trace(self.front, &ray);
            length_px += hit.length_px;
            let next = refract(-hit.normal, -ray.direction, 1.0 / self.index);
            if next.dot(hit.normal) >= 0.0 {
                return (next, length_px);
            }
            ray = InnerRay { at: hit.at, nearness: hit.nearness, direction: next, from: hit.side };
        }
        (ray.direction, length_px)
    }
}

#[cfg(test)]
mod tests;
