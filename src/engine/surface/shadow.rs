//! Cast shadows: how much of a lamp's disc each point of the surface sees. Floor 2. It is computed
//! from depth, in pixels (MATH 5). Here: lamps, their rays, the equation and the cache; `parallel`
//! and `point` are the fast ways over a map, `contact` is the shade of what stands higher nearby.
//! Not here: what shadows look like (`shading::shadow`).

mod contact;
mod counts;
mod heights;
mod merge;
mod parallel;
mod point;
mod share;
mod sliding;
mod sweep;

#[cfg(test)]
mod tests;

pub use contact::ContactShade;
pub(in crate::surface) use heights::HeightMaps;
pub use share::ShareMap;

use super::Surface;
use super::contours::FarSide;
use crate::math::{Size, Vec2, Vec3, fast, vec2, vec3};
use counts::HiddenCounts;
use rayon::prelude::*;
use std::sync::Arc;

/// A lamp that shadows are cast by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowLamp {
    /// Where it is.
    pub place: LampPlace,
    /// The radius of its disc as a share of its distance, `≥ 0`: how soft its shadows are.
    pub radius: f32,
    /// How far away what throws a shadow may be, px in the picture; it fades from half of that on.
    pub reach_px: f32,
    /// How many rays go to its disc.
    pub rays: u32,
    /// Whether they look at a map of half the size all the way, for a moment.
    pub is_coarse: bool,
}

/// The position of a lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LampPlace {
    /// Infinitely far: toward it, camera space (y up).
    Afar(Vec3),
    /// At a point of the canvas (px, y down) and a height above the surface's nearest point, px.
    At(Vec3),
}

/// The lamp of drawings by the form: its radius, how far its shadows reach, in longer sides of the
/// canvas, and its rays.
const OF_DRAWING: (f32, f32, u32) = (0.08, 0.35, 12);
/// The most rays of one lamp.
pub const MOST_RAYS: u32 = 64;
/// The golden angle, rad: the turn from one ray of the spiral to the next.
const TURN_RAD: f32 = 2.399_963;
/// Of rays that rise less a px, and of those that rise more, px: nothing is low, and nothing high
/// enough.
const RISE: (f32, f32) = (0.02, 20.0);
/// Bumps up to this height throw no shadow close by, px: the steps of coarse depth do not.
const BUMP_PX: f32 = 1.0;
/// Up to this distance, px.
const BUMP_REACH_PX: f32 = 24.0;
/// The radius of the part of a disc that one of n rays stands for is the disc's times this / √n.
const BETWEEN_RAYS: f32 = 0.9;

/// One ray from the surface to a point of a lamp's disc.
#[derive(Clone, Copy, Debug)]
struct LampRay {
    aim: Aim,
    /// Where it ends, from the middle of the disc, as a share of the distance.
    out: Vec2,
    /// How far away what it meets may be, px.
    reach_px: f32,
    /// The half-width of the part of the disc that it stands for, as a share of the distance.
    spread: f32,
}

/// Where a ray goes.
#[derive(Clone, Copy, Debug)]
enum Aim {
    /// The way in the picture, unit, image axes, and the px that it rises for each of it.
    Along { way: Vec2, rise: f32 },
    /// Place in the picture, px between pixel centers, and height, px.
    To(Vec3),
}

impl ShadowLamp {
    /// Its rays: a fixed spiral over its disc. Each has a reach of its own, from half the lamp's
    /// on, in an order that has nothing to do with the spiral, so that shadows fade with distance.
    ///
    /// * `heights`: the surface's range of heights, px.
    fn rays(&self, heights: f32) -> Vec<LampRay> {
        let count = self.rays.clamp(1, MOST_RAYS);
        let ray = |k: u32| {
            let out = self.radius * ((k as f32 + 0.5) / count as f32).sqrt();
            let (sin, cos) = (k as f32 * TURN_RAD).sin_cos();
            let share = 0.5 + 0.5 * ((k as f32 + 0.5) * 0.618_034).fract();
            let spread = BETWEEN_RAYS * self.radius / (count as f32).sqrt();
            let out = vec2(cos, sin) * out;
            let aim = self.aim(out, heights)?;
            Some(LampRay { aim, out, reach_px: share * self.reach_px, spread })
        };
        (0..count).filter_map(ray).collect()
    }

    /// The aim of the ray to a point of the disc; `None` for one that meets nothing.
    ///
    /// * `out`: from the middle of the disc, as a share of the distance.
    fn aim(&self, out: Vec2, heights: f32) -> Option<Aim> {
        match self.place {
            LampPlace::Afar(direction) => {
                let l = direction.normalize_or(Vec3::Z);
                // A basis across ℓ that turns smoothly with it (Frisvad 2012), but for lamps right
                // behind the picture.
                let below = 1.0 / (1.0 + l.z).max(1e-3);
                let u = vec3(1.0 - l.x * l.x * below, -l.x * l.y * below, -l.x);
                let v = vec3(-l.x * l.y * below, 1.0 - l.y * l.y * below, -l.y);
                let d = (l + u * out.x + v * out.y).normalize_or(Vec3::Z);
                let (way, flat) = (vec2(d.x, -d.y), vec2(d.x, d.y).length());
                let rise = (d.z / flat.max(1e-6)).max(RISE.0);
                (rise < RISE.1).then(|| Aim::Along { way: way / flat, rise })
            }
            LampPlace::At(at) => {
                // The disc lies level, as large as it is seen from the middle of the heights.
                let size = (at.z + 0.5 * heights).max(0.0);
                let at = vec3(at.x - 0.5, at.y - 0.5, at.z + heights);
                Some(Aim::To(at + (out * size).extend(0.0)))
            }
        }
    }

    /// The lamp whose shadows drawings by the form show.
    ///
    /// * `toward`: toward it, camera space (y up).
    pub fn of_drawing(toward: Vec3, canvas: Size) -> Self {
        let (radius, reach, rays) = OF_DRAWING;
        let (place, reach_px) = (LampPlace::Afar(toward), reach * canvas.longer_side());
        Self { place, radius, reach_px, rays, is_coarse: false }
    }

    /// What tells it from others.
    fn key(&self) -> ShadowKey {
        let (kind, v) = match self.place {
            LampPlace::Afar(v) => (0, v),
            LampPlace::At(v) => (1, v),
        };
        let bits = [v.x, v.y, v.z, self.radius, self.reach_px].map(f32::to_bits);
        ShadowKey { kind, bits, rays: self.rays, is_coarse: self.is_coarse }
    }
}

/// What tells a lamp from others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::surface) struct ShadowKey {
    kind: u8,
    bits: [u32; 5],
    rays: u32,
    is_coarse: bool,
}

/// How much of a ray is hidden, `[0, 1]`, by what stands highest above it.
///
/// * `above_px`: by how much, px.
/// * `distance_px`: its distance in the picture.
/// * `rise`: of the ray, px a px.
/// * `spread`: of the ray.
#[inline(always)]
fn hidden_share(above_px: f32, distance_px: f32, rise: f32, spread: f32) -> f32 {
    let width = width_at(distance_px, rise, spread);
    // A level surface does not hide itself, however low the lamp stands.
    let bump = BUMP_PX * fast::max(1.0 - distance_px * (1.0 / BUMP_REACH_PX), 0.0);
    let bias = fast::max(bump, 0.5 * width - rise * distance_px);
    fast::min(fast::max((above_px - bias) / width + 0.5, 0.0), 1.0)
}

/// How much of what stands so far away counts: all up to `from_px`, nothing from `to_px` on.
#[inline(always)]
fn fade(distance_px: f32, from_px: f32, to_px: f32) -> f32 {
    let per_px = 1.0 / fast::max(to_px - from_px, 1e-3);
    fast::min(fast::max((to_px - distance_px) * per_px, 0.0), 1.0)
}

/// How high a ray is, px: as the part of the disc that it stands for, and a pixel at least.
#[inline(always)]
fn width_at(distance_px: f32, rise: f32, spread: f32) -> f32 {
    1.0 + 2.0 * spread * (1.0 + rise * rise) * distance_px
}

/// The share of a lamp that is seen where `hidden` of it is, `[0, 1]`: smoothly from the one to the
/// other.
#[inline(always)]
fn seen_share(hidden: f32) -> f32 {
    let t = 1.0 - hidden;
    t * t * (3.0 - 2.0 * t)
}

impl Surface {
    /// What [`Surface::shadow`] and [`Surface::contact`] keep of each pixel, bytes; of a shadow for
    /// each lamp.
    pub const SHADOW_BYTES: usize = 2 * size_of::<f32>();

    fn heights(&self) -> Arc<HeightMaps> {
        self.derived.heights.get_or_compute((), 1, |_| HeightMaps::of(self))
    }

    /// The share of a lamp that every pixel sees, off the surface every pixel of the page. It
    /// depends on depth alone: normal layers do not change it. For a far side it is that of the other
    /// sides' pixels nearby. Cached; call it once before going parallel.
    ///
    /// * `keep`: how many shadows are held, the last ones.
    pub fn shadow(&self, lamp: &ShadowLamp, keep: usize) -> Arc<ShareMap> {
        let base = self.base();
        let on_far_side = |far: &FarSide, front: Option<&Surface>| {
            let seen = front.map(|front| front.shadow(lamp, keep));
            let of = |x: usize, y: usize| seen.as_ref().map_or(1.0, |seen| seen.at(x, y));
            ShareMap::from_plane(far.map(self.size(), |pixel| pixel.other_mean(of)), 1.0)
        };
        base.derived.shadows.get_or_compute(lamp.key(), keep, |_| {
            self.on_either_side(|| ShareMap::of_lamp(&base.heights(), lamp), on_far_side)
        })
    }
}

impl ShareMap {
    /// Of every pixel under a lamp: rays are counted in whole numbers, so that their order does not
    /// matter.
    fn of_lamp(heights: &HeightMaps, lamp: &ShadowLamp) -> Self {
        if let LampPlace::Afar(_) = lamp.place {
            let groups = parallel::RayGroups::of(lamp, heights.highest);
            return groups.counts(heights).visible_shares(groups.count);
        }
        let rays = lamp.rays(heights.highest);
        let each = rays.len().div_ceil(rayon::current_num_threads()).max(1);
        let counted = rays
            .par_chunks(each)
            .map(|rays| {
                let mut counts = HiddenCounts::new(heights.upright.whole.size());
                rays.iter().for_each(|ray| point::add(heights, ray, &mut counts));
                counts
            })
            .reduce_with(HiddenCounts::plus);
        match counted {
            Some(counts) => counts.visible_shares(lamp.rays.clamp(1, MOST_RAYS)),
            None => Self::full(heights.upright.whole.size()),
        }
    }
}
