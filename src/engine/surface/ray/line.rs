//! The straight line of the picture that a ray is seen as, in steps of a pixel along the axis it
//! runs along most. Floor 2.

use super::{RayMap, SurfaceRay};
use crate::math::{Size, Vec2};

/// Rays that move less in the picture, per length, go straight toward the eye or away from it.
const LEAST_SEEN: f32 = 1e-4;

/// A ray as the picture shows it.
pub(super) struct RayLine {
    from: Vec2,
    /// Canvas px a step; one of both is 1 or −1.
    step: Vec2,
    /// Nearness at the start, and how much it grows a step.
    start: f32,
    rise: f32,
    is_across: bool,
    /// px of the picture per px of the ray at the start.
    seen: f32,
    /// Steps to where it leaves the picture, or what the surface holds.
    pub steps: usize,
}

impl RayLine {
    /// `None` for a ray that does not move in the picture.
    pub fn of(map: &RayMap, ray: &SurfaceRay) -> Option<Self> {
        let (toward, rise) = map.seen_motion(ray.at, ray.nearness, ray.direction);
        let seen = toward.length();
        if seen.is_nan() || seen < LEAST_SEEN {
            return None;
        }
        let is_across = toward.x.abs() >= toward.y.abs();
        let per_step = 1.0 / toward.abs().max_element();
        let mut line = Self {
            from: ray.at,
            step: toward * per_step,
            start: ray.nearness,
            rise: rise * per_step,
            is_across,
            seen,
            steps: 0,
        };
        line.steps = line.steps_within(map);
        Some(line)
    }

    fn steps_within(&self, map: &RayMap) -> usize {
        let size = map.nearness.size();
        let side = |at: f32, step: f32, n: u32| match step {
            step if step > 0.0 => (n as f32 - at) / step,
            step if step < 0.0 => at / -step,
            _ => f32::MAX,
        };
        let in_picture = side(self.from.x, self.step.x, size.width).min(side(
            self.from.y,
            self.step.y,
            size.height,
        ));
        let in_depth = match self.rise {
            rise if rise > 0.0 => (map.nearest - self.start) / rise,
            rise if rise < 0.0 => (self.start - map.farthest + map.thickness) / -rise,
            _ => f32::MAX,
        };
        // NaN and less than 0 become 0.
        in_picture.min(in_depth + 1.0).max(0.0).min(2.0 * size.longer_side()) as usize
    }

    /// Canvas px after some steps.
    #[inline(always)]
    pub fn at(&self, steps: f32) -> Vec2 {
        self.from + self.step * steps
    }

    #[inline(always)]
    pub fn nearness(&self, steps: f32) -> f32 {
        self.start + self.rise * steps
    }

    /// The length of a step in the picture, px.
    pub fn step_px(&self) -> f32 {
        self.step.length()
    }

    /// The way in space of some steps, px.
    pub fn length_px(&self, map: &RayMap, steps: f32) -> f32 {
        let seen = steps * self.step_px() / self.seen;
        map.near.map_or(seen, |near| seen * near.focal_px() / self.nearness(steps).max(1e-3))
    }

    /// The two pixels across the line between whose centers a point lies.
    #[inline(always)]
    pub fn pixels(&self, at: Vec2, size: Size) -> [(usize, usize); 2] {
        let clamp = |v: f32, n: u32| (v.max(0.0) as usize).min(n as usize - 1);
        let pixel = |x: f32, y: f32| (clamp(x, size.width), clamp(y, size.height));
        match self.is_across {
            true => [pixel(at.x, at.y - 0.5), pixel(at.x, at.y + 0.5)],
            false => [pixel(at.x - 0.5, at.y), pixel(at.x + 0.5, at.y)],
        }
    }

    /// How far a point lies from the first of its two pixels to the second, `[0, 1)`.
    #[inline(always)]
    pub fn share(&self, at: Vec2) -> f32 {
        let across = if self.is_across { at.y } else { at.x } - 0.5;
        across - across.floor()
    }

    /// The first step after the `i`th that may lie beyond the block of so many px that the `i`th
    /// lies in.
    #[inline(always)]
    pub fn leaves_block(&self, i: usize, side: usize) -> usize {
        let side = side as f32;
        let left = |at: f32, step: f32| {
            let inside = at - (at / side).floor() * side;
            match step {
                step if step > 0.0 => (side - inside) / step,
                step if step < 0.0 => inside / -step,
                _ => f32::MAX,
            }
        };
        let at = self.at(i as f32);
        let steps = left(at.x, self.step.x).min(left(at.y, self.step.y));
        i + 1 + steps.min(4.0 * side) as usize
    }
}
