//! The body behind a surface, and where a ray within it leaves (MATH 5). Floor 2. A picture shows
//! the front of a body only; its back is made up. Here: the back, and where rays meet it, the front
//! or the rim. Not here: how a ray is bent there (`shading`).
//!
//! The *middle* of a body is a membrane stretched between its outlines. The back bulges behind it
//! as the front does before it, without its detail.

use super::{NOWHERE, RayMap};
use crate::math::{Range, Vec2, Vec3, vec2, vec3};
use crate::raster::Plane;
use crate::surface::cache::HeapSize;
use crate::surface::form_lines::blur_copy;
use crate::surface::occlusion::CLIFF;
use crate::surface::poisson::{Effort, PoissonGrid, PoissonSolver, SolveScratch};
use crate::surface::{Surface, links};
use std::sync::Arc;

/// Stiffness of what holds the membrane at outlines; 1 between neighbors.
const HELD: f32 = 1e3;
/// Detail of the front that the back lacks: σ, as a share of the canvas's longer side.
const DETAIL: f32 = 0.04;
/// No body is thinner, px.
const THINNEST_PX: f32 = 1.0;
/// A step of a ray goes so far toward the nearer of front and back, and these px at least and at
/// most.
const STRIDE: f32 = 0.5;
const STEPS_PX: Range = 1.0..=16.0;
/// A ray does not meet what it leaves within so many px.
const LEAVES_PX: f32 = 1.5;
/// A ray meets a side no flatter than this: the cosine to the side's normal.
const FACING: f32 = 0.02;

/// How far the front of a surface stands before the middle of its body.
pub struct Thickness {
    /// px; below 0 where the front is hollow.
    half: Plane<f32>,
    /// The same without detail, ≥ 0.
    smooth: Plane<f32>,
}

/// The body behind a surface: what is between its front and its back.
pub struct SolidBody {
    rays: Arc<RayMap>,
    /// The nearness of the back.
    back: Plane<f32>,
    thickest_px: f32,
}

/// A side of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodySide {
    /// What the picture shows.
    Front,
    /// What is made up behind it.
    Back,
    /// Where the front and the back meet.
    Rim,
}

/// A ray within a body.
#[derive(Clone, Copy, Debug)]
pub struct InnerRay {
    /// Canvas px.
    pub at: Vec2,
    /// As a [`RayMap`] has it.
    pub nearness: f32,
    /// Unit, camera space (y up).
    pub direction: Vec3,
    /// The side that it sets out from.
    pub from: BodySide,
}

/// Where a ray within a body meets one of its sides.
#[derive(Clone, Copy, Debug)]
pub struct BodyHit {
    /// Canvas px.
    pub at: Vec2,
    /// As a [`RayMap`] has it.
    pub nearness: f32,
    /// Unit, camera space; it points out of the body, and n·r > 0.
    pub normal: Vec3,
    /// The side that is met.
    pub side: BodySide,
    /// The way from the start of the ray, in space, px.
    pub length_px: f32,
}

/// What a point of the picture shows of a body.
struct BodyColumn {
    pixel: (usize, usize),
    front: f32,
    back: f32,
    /// How the nearness of the back changes along x and y (down).
    back_slope: Vec2,
}

/// A point within a body.
struct BodyPlace {
    column: BodyColumn,
    /// From the front to the point, and from the point to the back, px; below 0 beyond them.
    before: f32,
    behind: f32,
}

impl BodyPlace {
    fn of(column: BodyColumn, nearness: f32) -> Self {
        let (before, behind) = (column.front - nearness, nearness - column.back);
        Self { column, before, behind }
    }
}

impl Thickness {
    /// With u the distance from the middle to the front: Δu = Δfront, and u = 0 at outlines, where
    /// the front ends and nothing nearer begins. A piece without one has its lowest point as its
    /// middle.
    fn of(surface: &Surface, rays: &RayMap) -> Self {
        let size = surface.size();
        let (joined, front) = (surface.links_plane(), &rays.nearness);
        let coupling = |bit: u8| {
            Plane::from_fn(size, |x, y| if joined.at(x, y) & bit != 0 { 1.0 } else { 0.0 })
        };
        let [right, down] = [links::RIGHT, links::DOWN].map(|bit| coupling(bit).into_values());
        let solver = PoissonSolver::new(PoissonGrid::new(size.width as usize, right, down));
        let steps = Plane::from_fn(size, |x, y| {
            let here = front.at(x, y);
            let beside = neighbors(joined, (x, y)).map(|(x, y)| here - front.at(x, y));
            beside.sum::<f32>()
        });
        let width = size.width as usize;
        let outline: Vec<(u32, f32)> = (0..size.area())
            .filter(|i| is_outline(front, joined, (i % width, i / width)))
            .map(|i| (i as u32, HELD))
            .collect();
        let (pieces, count) = solver.pieces();
        let mut is_held = vec![false; count];
        for &(i, _) in &outline {
            if let Some(held) = is_held.get_mut(pieces[i as usize] as usize) {
                *held = true;
            }
        }
        let constraints = solver.constraints(outline);
        let mut half = crate::memory::fill_or_unwind(size.area(), 0.0);
        solver.solve_constrained(
            &constraints,
            steps.values(),
            &mut half,
            Effort::EXACT,
            &mut SolveScratch::default(),
        );
        let mut lowest = vec![f32::MAX; count];
        let free = |i: usize| Some(pieces[i] as usize).filter(|p| is_held.get(*p) == Some(&false));
        for (i, front) in front.values().iter().enumerate() {
            if let Some(piece) = free(i) {
                lowest[piece] = lowest[piece].min(*front);
            }
        }
        for (i, half) in half.iter_mut().enumerate() {
            if let Some(piece) = free(i) {
                *half = front.values()[i] - lowest[piece];
            }
        }
        let half = Plane::from_fn(size, |x, y| half[y * width + x]);
        // Squares keep the rims round.
        let squares = half.map(|half| half.max(0.0) * half.max(0.0));
        let smooth = blur_copy(&squares, surface, DETAIL * size.longer_side());
        Self { half, smooth: smooth.map(|square| square.max(0.0).sqrt()) }
    }
}

/// The neighbors that links join a pixel to.
fn neighbors(
    joined: &Plane<u8>,
    (x, y): (usize, usize),
) -> impl Iterator<Item = (usize, usize)> + use<> {
    let here = joined.at(x, y);
    let beside = [
        (links::LEFT, (x.wrapping_sub(1), y)),
        (links::RIGHT, (x + 1, y)),
        (links::UP, (x, y.wrapping_sub(1))),
        (links::DOWN, (x, y + 1)),
    ];
    beside.into_iter().filter(move |(bit, _)| here & bit != 0).map(|(_, at)| at)
}

/// Whether a surface ends at a pixel: beside it is nothing, or something that it is not joined to
/// beyond a cliff. A link that is missing elsewhere is no outline, nor is the picture's border:
/// surfaces go on beyond it.
fn is_outline(front: &Plane<f32>, joined: &Plane<u8>, (x, y): (usize, usize)) -> bool {
    let here = front.at(x, y);
    let ends_at = |bit: u8, at: Option<(usize, usize)>| {
        let is_beyond = |(x, y)| front.at(x, y) < here - CLIFF.0 - CLIFF.1;
        joined.at(x, y) & bit == 0 && at.is_some_and(is_beyond)
    };
    here > NOWHERE
        && (ends_at(links::LEFT, x.checked_sub(1).map(|x| (x, y)))
            || ends_at(links::RIGHT, Some((x + 1, y)).filter(|at| at.0 < front.width()))
            || ends_at(links::UP, y.checked_sub(1).map(|y| (x, y)))
            || ends_at(links::DOWN, Some((x, y + 1)).filter(|at| at.1 < front.height())))
}

impl SolidBody {
    fn of(surface: &Surface, bulge: f32) -> Self {
        let rays = surface.ray_map();
        let thickness = surface.thickness(&rays);
        let back = Plane::from_fn(surface.size(), |x, y| {
            let front = rays.nearness.at(x, y);
            let behind = thickness.half.at(x, y) + bulge * thickness.smooth.at(x, y);
            if front > NOWHERE { front - behind.max(THINNEST_PX) } else { NOWHERE }
        });
        let thickest_px = rays.nearness.values().iter().zip(back.values());
        let thickest_px =
            thickest_px.fold(THINNEST_PX, |most, (front, back)| most.max(front - back));
        Self { rays, back, thickest_px }
    }

    /// How thick it is where it is thickest, px.
    pub fn thickest_px(&self) -> f32 {
        self.thickest_px
    }

    /// The nearness of a depth, 0 near … 1 far.
    pub fn nearness_of(&self, depth: f32) -> f32 {
        self.rays.nearness_of(depth)
    }

    /// What is at a point of the picture; `None` beside the body. Between pixels that one piece
    /// covers it is their mean.
    #[inline(always)]
    fn column(&self, at: Vec2) -> Option<BodyColumn> {
        let front = &self.rays.nearness;
        let (w, h) = (front.width(), front.height());
        if !(at.x >= 0.0 && at.y >= 0.0 && at.x < w as f32 && at.y < h as f32) {
            return None;
        }
        let pixel = (at.x as usize, at.y as usize);
        let here = front.at(pixel.0, pixel.1);
        if here <= NOWHERE {
            return None;
        }
        let corner = at - 0.5;
        let low = corner.floor();
        let share = corner - low;
        let clamped = |v: f32, n: usize| (v.max(0.0) as usize).min(n - 1);
        let (x, y) =
            ([0.0, 1.0].map(|d| clamped(low.x + d, w)), [0.0, 1.0].map(|d| clamped(low.y + d, h)));
        let mut fronts = [[here; 2]; 2];
        let mut backs = [[self.back.at(pixel.0, pixel.1); 2]; 2];
        for (j, &y) in y.iter().enumerate() {
            for (i, &x) in x.iter().enumerate() {
                let there = front.at(x, y);
                if (there - here).abs() <= CLIFF.0 + CLIFF.1 {
                    (fronts[j][i], backs[j][i]) = (there, self.back.at(x, y));
                }
            }
        }
        let along = |v: [f32; 2], t: f32| v[0] + (v[1] - v[0]) * t;
        let mean = |v: [[f32; 2]; 2]| along(v.map(|row| along(row, share.x)), share.y);
        let slope = |v: [[f32; 2]; 2]| {
            let across = along(v.map(|row| row[1] - row[0]), share.y);
            vec2(across, along([v[1][0] - v[0][0], v[1][1] - v[0][1]], share.x))
        };
        Some(BodyColumn { pixel, front: mean(fronts), back: mean(backs), back_slope: slope(backs) })
    }

    /// Where a ray within the body meets one of its sides.
    ///
    /// * `surface`: whose body it is; its normals are those of the front.
    pub fn trace(&self, surface: &Surface, ray: &InnerRay) -> BodyHit {
        let (toward, rise) = self.rays.seen_motion(ray.at, ray.nearness, ray.direction);
        let speed = (toward.length_squared() + rise * rise).sqrt().max(1e-6);
        let step = vec3(toward.x, toward.y, rise) / speed;
        let start = vec3(ray.at.x, ray.at.y, ray.nearness);
        let most = 4.0 * surface.size().longer_side();
        let (mut gone, mut stride) = (0.0, *STEPS_PX.start());
        let mut last = self.column(ray.at).map(|column| BodyPlace::of(column, start.z));
        // The other side of a contour pixel is behind what is in front there.
        let is_elsewhere = |last: &BodyPlace| last.before.min(last.behind) < -CLIFF.0 - CLIFF.1;
        if last.as_ref().is_some_and(is_elsewhere) {
            return self.hit(surface, ray, (0.0, step, speed), BodySide::Rim, None);
        }
        while gone < most {
            let next = gone + stride;
            let place = start + step * next;
            let found = self.column(vec2(place.x, place.y));
            let found = found.filter(|column| !is_torn(last.as_ref(), column, stride));
            let Some(found) = found.map(|column| BodyPlace::of(column, place.z)) else { break };
            let was = last.as_ref().unwrap_or(&found);
            let sides = [
                (BodySide::Back, was.behind, found.behind),
                (BodySide::Front, was.before, found.before),
            ];
            for (side, was, is) in sides {
                let is_leaving = ray.from == side && next <= LEAVES_PX;
                if is < 0.0 && !is_leaving {
                    let way = gone + stride * was.max(0.0) / (was.max(0.0) - is);
                    return self.hit(surface, ray, (way, step, speed), side, Some(found.column));
                }
            }
            let (least, longest) = (*STEPS_PX.start(), *STEPS_PX.end());
            stride = (STRIDE * found.before.min(found.behind)).max(least).min(longest);
            (gone, last) = (next, Some(found));
        }
        let column = last.map(|last| last.column);
        self.hit(surface, ray, (gone, step, speed), BodySide::Rim, column)
    }

    /// The end of a way.
    ///
    /// * `gone`, `step`, `speed`: how far it is in the picture and in nearness, px, in which
    ///   direction, and how fast a point of the ray sets out on it.
    /// * `column`: what is there.
    fn hit(
        &self,
        surface: &Surface,
        ray: &InnerRay,
        (gone, step, speed): (f32, Vec3, f32),
        side: BodySide,
        column: Option<BodyColumn>,
    ) -> BodyHit {
        let place = vec3(ray.at.x, ray.at.y, ray.nearness) + step * gone;
        let (at, nearness) = (vec2(place.x, place.y), place.z);
        let r = ray.direction;
        let normal = match (side, column) {
            (_, None) => r,
            (BodySide::Front, Some(column)) => surface.normal(column.pixel.0, column.pixel.1),
            (BodySide::Back, Some(column)) => self.back_normal(at, nearness, column.back_slope),
            (BodySide::Rim, Some(column)) => {
                let n = surface.normal(column.pixel.0, column.pixel.1);
                vec3(n.x, n.y, 0.0).normalize_or(r)
            }
        };
        // What a coarse map turns away from the ray lies along it.
        let facing = normal.dot(r);
        let normal = match facing < FACING {
            true => (normal + r * (FACING - facing)).normalize_or(r),
            false => normal,
        };
        let length_px = match self.rays.near {
            None => gone / speed,
            Some(near) => gone / speed * near.focal_px() / nearness.max(1e-3),
        };
        BodyHit { at, nearness, normal, side, length_px }
    }

    /// The normal of the back, out of the body: of s(x, y), the nearness, (s_x, −s_y, −1) seen from
    /// afar.
    fn back_normal(&self, at: Vec2, nearness: f32, slope: Vec2) -> Vec3 {
        let toward = match self.rays.near {
            None => 1.0,
            Some(near) => nearness / near.focal_px() - slope.dot(near.offset_at(at)),
        };
        vec3(slope.x, -slope.y, -toward).normalize_or(Vec3::NEG_Z)
    }
}

/// Whether a ray has come to another piece of surface, before or behind the one that it is in.
fn is_torn(last: Option<&BodyPlace>, next: &BodyColumn, stride: f32) -> bool {
    last.is_some_and(|last| (next.front - last.column.front).abs() > CLIFF.0 * stride + CLIFF.1)
}

impl HeapSize for Thickness {
    fn heap_bytes(&self) -> u64 {
        self.half.heap_bytes() + self.smooth.heap_bytes()
    }
}

impl HeapSize for SolidBody {
    fn heap_bytes(&self) -> u64 {
        self.back.heap_bytes()
    }
}

impl Surface {
    /// What [`Surface::body`] keeps of each pixel, bytes: how far the front stands before the middle
    /// of the body, with detail and without, and the back.
    pub const BODY_BYTES: usize = 3 * size_of::<f32>();

    fn thickness(&self, rays: &RayMap) -> Arc<Thickness> {
        let base = self.base();
        base.derived.thicknesses.get_or_compute((), 1, |_| Thickness::of(base, rays))
    }

    /// The body behind the surface; detail combined onto it is not part of it. Cached; call it once
    /// before going parallel.
    ///
    /// * `bulge`: how far the back bulges, as a share of the front, in `[0, 1]`; 0 is flat.
    pub fn body(&self, bulge: f32) -> Arc<SolidBody> {
        let base = self.base();
        let bulge = bulge.max(0.0).min(1.0);
        base.derived.bodies.get_or_compute(bulge.to_bits(), 1, |_| SolidBody::of(base, bulge))
    }
}

#[cfg(test)]
mod tests;
