//! The second look of a ray: where it meets the surface again it is reflected, or refracted, once
//! more, and what it sees in the end is the environment (MATH 5). Floor 3. Not here: where it meets
//! the surface (`surface::ray`), the environment.

use crate::math::{Vec2, Vec3, vec2, vec3};
use crate::surface::Surface;
use crate::surface::contours::FrontSurface;
use crate::surface::ray::{RayHit, RayMap, SurfaceRay};
use std::sync::Arc;

/// A grazing view stretches a pixel on the surface at most so much.
const GRAZING: f32 = 0.05;

/// The ray of a pixel, and how it changes to the next pixel in its row and in its column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelRay {
    /// Unit, camera space (y up).
    pub direction: Vec3,
    pub changes: [Vec3; 2],
}

/// Where a pixel's rays begin.
#[derive(Clone, Copy)]
pub struct RayStart {
    pub normal: Vec3,
    /// Toward the eye.
    pub view: Vec3,
    at: Vec2,
    nearness: f32,
    /// The sides of what the ray stands for, px of the picture.
    side_px: f32,
}

impl RayStart {
    /// The same for one of several rays of a pixel, by the sides of its part.
    pub fn of_part(self, side_px: f32) -> Self {
        Self { side_px, ..self }
    }
}

/// Follows rays over the surface that they leave.
pub struct SecondLook<'s> {
    /// Whose pixels are shaded: the surface of the canvas, or its far side.
    shaded: &'s Surface,
    front: FrontSurface<'s>,
    map: Arc<RayMap>,
    bounces: u32,
}

impl<'s> SecondLook<'s> {
    /// `None` without bounces.
    pub fn on(shaded: &'s Surface, bounces: u32) -> Option<Self> {
        if bounces == 0 {
            return None;
        }
        let front = shaded.front()?;
        let map = front.ray_map();
        Some(Self { shaded, front, map, bounces })
    }

    /// Where the rays of a pixel begin, with its normal and view.
    pub fn start(&self, x: usize, y: usize, normal: Vec3, view: Vec3) -> RayStart {
        let (px, py) = self.shaded.canvas_pixel(x as i32, y as i32);
        let at = vec2(px as f32 + 0.5, py as f32 + 0.5);
        RayStart {
            normal,
            view,
            at,
            nearness: self.map.nearness_of(self.shaded.depth(x, y)),
            side_px: 1.0,
        }
    }

    /// The last ray of the way that a ray takes: the one that looks at the environment.
    ///
    /// * `bend`: the ray that leaves where the surface has a normal and is seen from a direction.
    /// * `meet`: told of every place where the surface is met, with the direction of the ray that
    ///   meets it.
    pub fn follow(
        &self,
        start: RayStart,
        ray: PixelRay,
        bend: impl Fn(Vec3, Vec3) -> Vec3,
        mut meet: impl FnMut(&RayHit, Vec3),
    ) -> PixelRay {
        let RayStart { normal, view, at, nearness, side_px } = start;
        let inward = ray.direction.dot(normal) < 0.0;
        let mut leaving = SurfaceRay { at, nearness, direction: ray.direction, inward };
        let mut changes = ray.changes;
        // What a pixel shows of the surface, along the view.
        let pixel = side_px * self.map.px_per_pixel(nearness);
        let mut moved = [vec3(pixel, 0.0, 0.0), vec3(0.0, -pixel, 0.0)]
            .map(|step| project_onto_plane(step, normal, view, GRAZING));
        for _ in 0..self.bounces {
            let Some(hit) = self.front.trace(&self.map, &leaving) else { break };
            let r = leaving.direction;
            meet(&hit, r);
            let next = bend(hit.normal, -r);
            for (moved, change) in moved.iter_mut().zip(&mut changes) {
                // Ray differentials (Igehy 1999), the last one by the difference itself.
                *moved = project_onto_plane(*moved + *change * hit.length_px, hit.normal, r, 0.0);
                let seen = self.map.seen_step(hit.at, hit.nearness, *moved);
                let turned = hit.normal + hit.changes[0] * seen.x + hit.changes[1] * seen.y;
                let beside = (r + *change).normalize_or(r);
                *change = bend(turned.normalize_or(hit.normal), -beside) - next;
            }
            let inward = next.dot(hit.normal) < 0.0;
            leaving = SurfaceRay { at: hit.at, nearness: hit.nearness, direction: next, inward };
        }
        PixelRay { direction: leaving.direction, changes }
    }
}

/// A step moved along a ray onto the plane with a normal; `grazing`: the least |n·r| that counts.
fn project_onto_plane(step: Vec3, n: Vec3, r: Vec3, grazing: f32) -> Vec3 {
    let facing = n.dot(r);
    let held = facing.abs().max(grazing).max(1e-3);
    step - r * (n.dot(step) / if facing < 0.0 { -held } else { held })
}

#[cfg(test)]
pub(super) mod tests;
