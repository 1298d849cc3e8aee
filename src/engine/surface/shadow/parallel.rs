//! Shadows of lamps that are infinitely far. Floor 2. Rays to a lamp's disc are close together near
//! the pixel that they come from: there, one ray stands for a group of them, and looks at every
//! pixel. Farther away, where their shadows are soft, they look at a map of half the size.

use super::counts::HiddenCounts;
use super::heights::{HeightMap, HeightMaps};
use super::merge::{self, FarCounts};
use super::sweep::{NearBand, Sweep};
use super::{Aim, LampPlace, LampRay, MOST_RAYS, ShadowLamp};
use crate::math::{parallel, vec2};
use crate::raster::Plane;

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
/// Rows whose near parts are computed at a time.
const BAND: usize = 128;

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
    /// Where the near part ends, px; 0 if there is none.
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
        let rays = ShadowLamp { rays: count, ..*lamp }.rays(highest);
        if lamp.is_coarse {
            let alone =
                |ray: LampRay| RayGroup { is_turned: is_turned(&ray), near: ray, far: vec![ray] };
            let groups = rays.into_iter().map(alone).collect();
            return Self { groups, near_px: 0.0, count, is_half: true };
        }
        let near_px = (SOFT_PX / lamp.radius.max(1e-6)).min(NEAR_SHARE * lamp.reach_px).max(1.0);
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
        let mut counts = HiddenCounts::new(heights.upright.whole.size());
        for turned in [false, true] {
            let groups: Vec<&RayGroup> =
                self.groups.iter().filter(|group| group.is_turned == turned).collect();
            if !groups.is_empty() {
                self.add(heights.way(turned), heights.highest, &groups, counts.of(turned));
            }
        }
        counts
    }

    /// Adds what is hidden from groups of rays that sweep one map, a band of rows after another.
    fn add(&self, map: &HeightMap, highest: f32, groups: &[&RayGroup], counts: &mut Plane<u16>) {
        let far = FarCounts {
            groups: parallel::map(groups, |group| self.far(map, highest, group)),
            is_half: self.is_half,
        };
        let near: Vec<(Sweep, Plane<bool>, u32)> = groups
            .iter()
            .filter(|_| self.near_px > 0.0)
            .map(|group| {
                let sweep = sweep(&map.whole, highest, &group.near, 1.0, 0.0);
                let rising = map.slopes.rising(sweep.way, self.near_px, sweep.least_slope());
                (sweep, rising, group.far.len() as u32)
            })
            .collect();
        let (width, total) = (map.whole.width(), far.total());
        let bands = counts.values_mut().chunks_mut((width * BAND).max(1)).enumerate();
        parallel::for_each_with(
            bands,
            1,
            || near.iter().map(|near| (NearBand::new(width), near.2)).collect::<Vec<_>>(),
            |bands, (band, counts)| {
                let rows = band * BAND..band * BAND + counts.len() / width.max(1);
                for ((near, _), (sweep, rising, _)) in bands.iter_mut().zip(&near) {
                    near.clear(rows.clone());
                    sweep.add_near(rising, near);
                }
                for (y, row) in rows.zip(counts.chunks_mut(width.max(1))) {
                    merge::add_row(map, (&far, &total), bands, y, row);
                }
            },
        );
    }

    /// What is hidden from the far rays of a group.
    fn far(&self, map: &HeightMap, highest: f32, group: &RayGroup) -> Plane<u16> {
        let (heights, px) = if self.is_half { (&map.half, 2.0) } else { (&map.whole, 1.0) };
        let mut sum = Plane::full(heights.size(), 0);
        for ray in &group.far {
            let sweep = sweep(heights, highest, ray, px, self.near_px);
            Sweep { is_fading: true, ..sweep }.add(&mut sum);
        }
        sum
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
