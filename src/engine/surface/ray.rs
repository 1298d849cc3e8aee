//! Rays that leave the surface and meet it again: marched through the depth, as far as the picture
//! shows it (MATH 5). Floor 2. Here: where a ray meets the surface. Not here: what is seen there
//! (`shading`).
//!
//! A ray is a straight line of the picture, and how near it is changes linearly along it. It goes
//! pixel by pixel, and jumps over blocks of pixels that it passes in front of.

pub mod body;
mod line;

#[cfg(test)]
mod tests;

use super::cache::HeapSize;
use super::occlusion::CLIFF;
use super::unwrap::PerspectiveView;
use super::{Surface, links};
use crate::math::{Rect, Size, Vec2, Vec3, vec2};
use crate::raster::Plane;
use line::RayLine;
use std::sync::Arc;

/// What is met beyond a cliff is so thick, as a share of the longer side: rays deeper behind it
/// pass.
const THICKNESS: f32 = 0.02;
/// A ray meets only what faces it: −n·r is at least this. Along a smooth surface it does not meet
/// its own start.
const FACING: f32 = 0.02;
/// Nearness where there is no surface.
const NOWHERE: f32 = -1e30;
/// Sides of the blocks that rays jump over, px.
const BLOCKS: [usize; 3] = [64, 16, 4];

/// What rays are marched through.
///
/// *Nearness* grows toward the eye, px: seen from afar −z Z, minus the depth; seen from near f
/// Z̄/Z, which changes linearly along straight lines of the picture.
pub struct RayMap {
    nearness: Plane<f32>,
    /// The greatest nearness in each block and within a pixel of it.
    blocks: [Plane<f32>; 3],
    nearest: f32,
    farthest: f32,
    thickness: f32,
    depth_range_px: f32,
    near: Option<PerspectiveView>,
}

/// A ray that leaves the surface.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceRay {
    /// Where it leaves: canvas px, and the nearness there.
    pub at: Vec2,
    /// How near its start is.
    pub nearness: f32,
    /// Unit, camera space (y up).
    pub direction: Vec3,
    /// It leaves behind the surface, as a refracted ray does.
    pub inward: bool,
}

/// Where a ray meets the surface.
#[derive(Clone, Copy, Debug)]
pub struct RayHit {
    /// Canvas px, and the nearness there.
    pub at: Vec2,
    /// How near the point is.
    pub nearness: f32,
    /// Unit, camera space; it faces the ray.
    pub normal: Vec3,
    /// How the normal changes from pixel to pixel along a row and a column.
    pub changes: [Vec3; 2],
    /// The way from the start of the ray, in space, px.
    pub length_px: f32,
}

/// Where a ray is.
#[derive(Clone, Copy, PartialEq)]
enum RayPlace {
    /// It has not left its start yet.
    Start,
    /// Before the surface.
    Before,
    /// Behind it: what it meets from there is not seen.
    Behind,
}

/// What happens where a ray comes behind a pixel's surface.
enum Crossing {
    /// It meets the surface after that many steps.
    Met(f32),
    /// It goes along the surface, right from its start.
    Grazed,
    /// It passes behind the surface.
    Passed,
}

impl RayMap {
    fn of(surface: &Surface) -> Self {
        let size = surface.size();
        let mut map = Self {
            nearness: Plane::full(size, NOWHERE),
            blocks: BLOCKS.map(|side| Plane::full(blocks_of(size, side), NOWHERE)),
            nearest: NOWHERE,
            farthest: -NOWHERE,
            thickness: THICKNESS * size.longer_side(),
            depth_range_px: surface.depth_range_px(),
            near: surface.perspective_view(),
        };
        map.nearness = Plane::from_fn(size, |x, y| match surface.coverage(x, y) {
            0 => NOWHERE,
            _ => map.nearness_of(surface.depth(x, y)),
        });
        map.blocks = BLOCKS.map(|side| map.highest(side));
        let known = map.nearness.values().iter().filter(|v| **v > NOWHERE);
        (map.nearest, map.farthest) =
            known.fold((NOWHERE, -NOWHERE), |(a, b), v| (a.max(*v), b.min(*v)));
        map
    }

    /// The nearness of a depth, 0 near … 1 far.
    pub fn nearness_of(&self, depth: f32) -> f32 {
        match self.near {
            None => -depth * self.depth_range_px,
            Some(near) => near.focal_px() / near.farness(depth).max(1e-3),
        }
    }

    /// How a step in space moves what is seen in the picture, px, at a point of a nearness. The
    /// inverse of `px_per_pixel`.
    pub fn seen_step(&self, at: Vec2, nearness: f32, step: Vec3) -> Vec2 {
        let flat = vec2(step.x, -step.y);
        match self.near {
            None => flat,
            Some(near) => (flat + near.offset_at(at) * step.z) * (nearness / near.focal_px()),
        }
    }

    /// How a point that goes along a direction moves in the picture, and how its nearness grows, as
    /// it sets out; the line is straight in both.
    #[inline(always)]
    fn seen_motion(&self, at: Vec2, nearness: f32, r: Vec3) -> (Vec2, f32) {
        match self.near {
            None => (vec2(r.x, -r.y), r.z),
            // q = c + f b with b = P/Z: db/dt = (r + b r_z) / Z, and of f Z̄/Z the change is r_z f
            // Z̄/Z².
            Some(near) => {
                (vec2(r.x, -r.y) + near.offset_at(at) * r.z, r.z * nearness / near.focal_px())
            }
        }
    }

    /// The px of space that a pixel spans at a nearness, across the view.
    pub fn px_per_pixel(&self, nearness: f32) -> f32 {
        self.near.map_or(1.0, |near| near.focal_px() / nearness.max(1e-3))
    }

    fn highest(&self, side: usize) -> Plane<f32> {
        let size = self.nearness.size();
        Plane::from_fn(blocks_of(size, side), |col, row| {
            let (x0, y0, n) = ((col * side) as i32, (row * side) as i32, side as i32);
            let block = Rect::new(x0 - 1, y0 - 1, x0 + n + 1, y0 + n + 1).intersect(size.rect());
            let columns = block.x0 as usize..block.x1 as usize;
            let of_row = |y: i32| {
                self.nearness.row(y as usize)[columns.clone()]
                    .iter()
                    .copied()
                    .fold(NOWHERE, f32::max)
            };
            (block.y0..block.y1).map(of_row).fold(NOWHERE, f32::max)
        })
    }

    /// The nearness of the surface at a point of a line: between two pixels across it; across a
    /// cliff that of the one it lies in.
    #[inline(always)]
    fn surface_at(&self, line: &RayLine, at: Vec2) -> f32 {
        let [a, b] = line.pixels(at, self.nearness.size()).map(|(x, y)| self.nearness.at(x, y));
        let is_cliff = (a - b).abs() > CLIFF.0 + CLIFF.1;
        let share = line.share(at);
        // Of nothing and something no mean is right.
        match is_cliff {
            true if share < 0.5 => a,
            true => b,
            false => a + (b - a) * share,
        }
    }

    /// The step from which on a line has left the block that it is in after `i` steps, and whether
    /// it passes in front of all of that block.
    #[inline(always)]
    fn step_out_of_block(&self, line: &RayLine, i: usize) -> (usize, bool) {
        let at = line.at(i as f32);
        let mut next = i + 1;
        for (side, blocks) in BLOCKS.into_iter().zip(&self.blocks) {
            next = line.leaves_block(i, side);
            let block = |v: f32, n: usize| (v as usize / side).min(n - 1);
            let highest = blocks.at(block(at.x, blocks.width()), block(at.y, blocks.height()));
            if line.nearness(i as f32).min(line.nearness(next as f32)) > highest {
                return (next, true);
            }
        }
        (next, false)
    }

    /// Where a ray meets the surface: steps along its line.
    fn first_hit(
        &self,
        line: &RayLine,
        ray: &SurfaceRay,
        faces: impl Fn(f32) -> bool,
    ) -> Option<f32> {
        let mut place = if ray.inward { RayPlace::Behind } else { RayPlace::Start };
        let (mut i, mut checked) = (1, 0);
        while i <= line.steps {
            if i >= checked {
                let (next, is_clear) = self.step_out_of_block(line, i);
                if is_clear {
                    (place, i) = (RayPlace::Before, next);
                    continue;
                }
                checked = next;
            }
            if line.nearness(i as f32) > self.surface_at(line, line.at(i as f32)) {
                place = RayPlace::Before;
            } else if place != RayPlace::Behind {
                match self.crossing(line, i, place, &faces) {
                    Crossing::Met(steps) => return Some(steps),
                    Crossing::Grazed => (),
                    Crossing::Passed => place = RayPlace::Behind,
                }
            }
            i += 1;
        }
        None
    }

    /// What happens in the `i`th step, at whose end a line is behind the surface and at whose start
    /// it was not, or it had not left its start.
    fn crossing(
        &self,
        line: &RayLine,
        i: usize,
        place: RayPlace,
        faces: impl Fn(f32) -> bool,
    ) -> Crossing {
        let (before, after) = ((i - 1) as f32, i as f32);
        let surface = |steps: f32| self.surface_at(line, line.at(steps));
        let from = if i == 1 { line.nearness(0.0) } else { surface(before) };
        let to = surface(after);
        let is_cliff = (to - from).abs() > CLIFF.0 * line.step_px() + CLIFF.1;
        if is_cliff && to - line.nearness(after) > self.thickness {
            return Crossing::Passed;
        }
        let (above, below) = (line.nearness(before) - from, to - line.nearness(after));
        // Across a cliff it is met where it begins; at the start of the ray nothing is crossed
        // cleanly.
        let part = above / (above + below).max(f32::MIN_POSITIVE);
        let part = if is_cliff || place == RayPlace::Start { 1.0 } else { part.max(0.0).min(1.0) };
        match faces(before + part) {
            true => Crossing::Met(before + part),
            false if place == RayPlace::Start && below <= CLIFF.1 => Crossing::Grazed,
            false => Crossing::Passed,
        }
    }
}

impl HeapSize for RayMap {
    fn heap_bytes(&self) -> u64 {
        self.blocks.iter().chain([&self.nearness]).map(Plane::heap_bytes).sum()
    }
}

fn blocks_of(size: Size, side: usize) -> Size {
    Size::new(size.width.div_ceil(side as u32), size.height.div_ceil(side as u32))
}

impl Surface {
    /// What rays are marched through; detail combined onto the surface is not part of it. Cached;
    /// call it once before going parallel.
    pub fn ray_map(&self) -> Arc<RayMap> {
        let base = self.base();
        base.derived.ray_maps.get_or_compute((), 1, |_| RayMap::of(base))
    }

    /// Where a ray meets the surface again, as far as the picture shows it; `None` where it leaves
    /// the picture, passes behind an object or meets nothing.
    ///
    /// It meets a surface that continues from step to step where it crosses it, and what stands up
    /// behind a cliff where it is not deeper behind that than a fiftieth of the longer side. What
    /// it meets must face it.
    ///
    /// * `map`: this surface's [`Surface::ray_map`].
    pub fn trace(&self, map: &RayMap, ray: &SurfaceRay) -> Option<RayHit> {
        let line = RayLine::of(map, ray)?;
        let faces = |normal: Vec3| normal.dot(ray.direction) < -FACING;
        let base = self.base();
        let normal_of = |surface: &Surface, steps: f32| {
            let at = line.at(steps.round());
            let [a, b] = line.pixels(at, surface.size());
            let is_cliff =
                (map.nearness.at(a.0, a.1) - map.nearness.at(b.0, b.1)).abs() > CLIFF.0 + CLIFF.1;
            let share = if is_cliff { line.share(at).round() } else { line.share(at) };
            surface.normal(a.0, a.1).lerp(surface.normal(b.0, b.1), share).normalize_or(Vec3::Z)
        };
        let steps = map.first_hit(&line, ray, |steps| faces(normal_of(base, steps)))?;
        // Detail may turn a normal away from the ray.
        let normal = Some(normal_of(self, steps))
            .filter(|n| faces(*n))
            .unwrap_or_else(|| normal_of(base, steps));
        let (at, nearness) = (line.at(steps), line.nearness(steps));
        let (x, y) = self.pixel_of(at);
        Some(RayHit {
            at,
            nearness,
            normal,
            changes: self.normal_changes(x, y),
            length_px: line.length_px(map, steps),
        })
    }

    /// How the normal changes from pixel to pixel along x and y (down); differences do not cross
    /// depth jumps, creases or the mask's edge.
    fn normal_changes(&self, x: usize, y: usize) -> [Vec3; 2] {
        let joined = self.smooth_links_plane().at(x, y);
        let here = self.normal(x, y);
        let change = |back: u8, forth: u8, dx: usize, dy: usize| {
            let before = (joined & back != 0).then(|| self.normal(x - dx, y - dy));
            let after = (joined & forth != 0).then(|| self.normal(x + dx, y + dy));
            let steps = [before, after].iter().flatten().count().max(1) as f32;
            (after.unwrap_or(here) - before.unwrap_or(here)) / steps
        };
        [change(links::LEFT, links::RIGHT, 1, 0), change(links::UP, links::DOWN, 0, 1)]
    }
}
