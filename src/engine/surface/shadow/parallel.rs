//! Shadows of lamps that are infinitely far. Floor 2. Rays to a lamp's disc are close together near
//! the pixel that they come from: there, one ray stands for a group of them, and looks at every
//! pixel. Farther away, where their shadows are soft, they look at a map of half the size.

use super::counts::HiddenCounts;
use super::heights::{HeightMap, HeightMaps};
use super::merge::{self, FarCounts, GroupCounts};
use super::sweep::Sweep;
use super::{Aim, LampPlace, LampRay, MOST_RAYS, ShadowLamp};
use crate::math::vec2;
use crate::raster::Plane;
use rayon::prelude::*;

/// Groups of a disc's rays.
const GROUPS: u32 = 8;
/// Where the disc's shadows are this soft, the near part ends, px.
const SOFT_PX: f32 = 3.0;
/// The near part is this share of the reach at most.
const NEAR_SHARE: f32 = 0.25;
/// Shadows from half the size are this soft at least, px.
const HALF_SOFT_PX: f32 = 2.5;
/// Rays that lie closer together than this where they end are the same, px.
const SAME_PX: f32 = 1.0;
/// But so many have reaches of their own.
const LEAST_RAYS: u32 = 8;
/// The pixels of maps that are held at a time, at most, unless there are more threads.
const HELD_PX: usize = 1 << 25;

/// Rays that are one where they are close together.
pub(super) struct RayGroup {
    /// Whether they go farther along x.
    pub is_turned: bool,
    pub near: LampRay,
    pub far: Vec<LampRay>,
}

/// The rays to a lamp.
pub(super) struct RayGroups {
    pub groups: Vec<RayGroup>,
    /// Where the near part ends.
    pub near_px: f32,
    /// How many rays there are, with those that meet nothing.
    pub count: u32,
    /// Whether the far part is seen at half the size.
    is_half: bool,
}

fn is_turned(ray: &LampRay) -> bool {
    matches!(ray.aim, Aim::Along { way, .. } if way.x.abs() > way.y.abs())
}

impl RayGroups {
    /// Of a lamp that is infinitely far.
    ///
    /// * `highest`: the surface's range of heights, px.
    pub fn of(lamp: &ShadowLamp, highest: f32) -> Self {
        let LampPlace::Afar(_) = lamp.place else {
            return Self { groups: Vec::new(), near_px: 0.0, count: 1, is_half: false };
        };
        // More rays than this would end less than a pixel from each other.
        let wide = super::BETWEEN_RAYS * lamp.radius * lamp.reach_px / SAME_PX;
        let count = lamp.rays.clamp(1, MOST_RAYS).min(((wide * wide) as u32).max(LEAST_RAYS));
        let near_px = (SOFT_PX / lamp.radius.max(1e-6)).min(NEAR_SHARE * lamp.reach_px).max(1.0);
        let rays = ShadowLamp { rays: count, ..*lamp }.rays(highest);
        let few = ShadowLamp { rays: count.min(GROUPS), reach_px: near_px, ..*lamp };
        let near = few.rays(highest);
        let mut groups: Vec<RayGroup> = near
            .into_iter()
            .map(|ray| LampRay { reach_px: near_px, ..ray })
            .map(|near| RayGroup { is_turned: is_turned(&near), near, far: Vec::new() })
            .collect();
        for ray in rays {
            let is_turned = is_turned(&ray);
            let off = |group: &RayGroup| (group.near.out - ray.out).length_squared();
            let nearest = groups
                .iter_mut()
                .filter(|group| group.is_turned == is_turned)
                .min_by(|a, b| off(a).total_cmp(&off(b)));
            match nearest {
                Some(group) => group.far.push(ray),
                None => {
                    let near = LampRay { reach_px: near_px, ..ray };
                    groups.push(RayGroup { is_turned, near, far: vec![ray] });
                }
            }
        }
        groups.retain(|group| !group.far.is_empty());
        let is_half = lamp.radius * near_px >= HALF_SOFT_PX;
        Self { groups, near_px, count, is_half }
    }

    /// How much of the lamp is hidden from every pixel.
    pub fn counts(&self, heights: &HeightMaps) -> HiddenCounts {
        let size = heights.upright.whole.size();
        let mut counts = HiddenCounts::new(size);
        let held = (HELD_PX / size.area().max(1)).max(rayon::current_num_threads());
        for turned in [false, true] {
            let groups: Vec<&RayGroup> =
                self.groups.iter().filter(|group| group.is_turned == turned).collect();
            for groups in groups.chunks(held) {
                let map = heights.way(turned);
                let counted: Vec<GroupCounts> = groups
                    .par_iter()
                    .map(|group| self.count(map, heights.highest, group))
                    .collect();
                merge::add(map, &counted, counts.of(turned));
            }
        }
        counts
    }

    /// What is hidden from a group.
    fn count(&self, map: &HeightMap, highest: f32, group: &RayGroup) -> GroupCounts {
        let (near, far) = rayon::join(
            || {
                let mut near = Plane::filled(map.whole.size(), 0);
                sweep(&map.whole, highest, &group.near, 1.0, 0.0).add(&mut near);
                near
            },
            || {
                let (heights, px) = if self.is_half { (&map.half, 2.0) } else { (&map.whole, 1.0) };
                let mut sum = Plane::filled(heights.size(), 0);
                for ray in &group.far {
                    let sweep = sweep(heights, highest, ray, px, self.near_px);
                    Sweep { is_fading: true, ..sweep }.add(&mut sum);
                }
                FarCounts { sum, is_half: self.is_half }
            },
        );
        GroupCounts { near, far: Some(far), rays: group.far.len() as u32 }
    }
}

fn sweep<'a>(
    heights: &'a Plane<f32>,
    highest: f32,
    ray: &LampRay,
    px: f32,
    from_px: f32,
) -> Sweep<'a> {
    let (way, rise) = match ray.aim {
        Aim::Along { way, rise } if way.x.abs() > way.y.abs() => (vec2(way.y, way.x), rise),
        Aim::Along { way, rise } => (way, rise),
        Aim::To(_) => (vec2(0.0, 1.0), super::RISE.1),
    };
    let to_px = ray.reach_px;
    Sweep { heights, highest, px, way, rise, spread: ray.spread, from_px, to_px, is_fading: false }
}
