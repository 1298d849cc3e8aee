//! What the surface adds where glossy rays meet it again: followed from an eighth of the half
//! vectors at each pixel, others at its neighbors, and shared among these (MATH 5). Floor 3. Not
//! here: the light that rays see where they meet nothing, which every half vector reads at every
//! pixel.

use super::{EnvironmentSamples, HALVES, frame, width_rad};
use crate::math::{Rect, Vec3, vec3};
use crate::raster::TILE;
use crate::shading::Shading;
use crate::shading::environment::Directions;
use crate::shading::material::second_look::{PixelRay, RayStart, SecondLook};
use crate::shading::material::{ashikhmin, mirror};
use crate::shading::surface_row::{Light3, RowValues, SurfaceRow};
use crate::surface::view::{from_view, in_view};
use crate::surface::{Surface, links};

/// Each of two by two pixels has another quarter of the half vectors; from one such square to the
/// next it follows the one half of them, then the other.
const PHASES: usize = 4;
/// Rays that are followed at a pixel.
const FOLLOWED: usize = HALVES / PHASES / 2;

/// By how much the linear light of a tile's pixels changes where rays meet the surface.
pub struct BouncedLight {
    /// The pixels that are known: the tile's, and those around it.
    rect: Rect,
    /// Each by its own half vectors, row by row.
    changes: Vec<Vec3>,
}

impl EnvironmentSamples {
    /// Follows the glossy rays of the pixels of a tile and around it; of a far side, whose pixels are
    /// no neighbors, none.
    pub fn follow_tile(&mut self, shading: &Shading, surface: &Surface, area: Rect) {
        self.bounced = None;
        let Some(surface) = surface.on_canvas().filter(|_| shading.specular.weight > 0.0) else {
            return;
        };
        let Some(second) = SecondLook::on(surface, shading.bounces_made()) else { return };
        let rect = area.grown(1).intersect(surface.size().rect());
        let pixels = (rect.y0..rect.y1)
            .flat_map(|y| (rect.x0..rect.x1).map(move |x| (x as usize, y as usize)));
        let change = |(x, y)| match surface.coverage(x, y) {
            0 => Vec3::ZERO,
            _ => self.change_at(shading, &second, surface, (x, y)),
        };
        self.bounced = Some(BouncedLight { rect, changes: pixels.map(change).collect() });
    }

    /// What the rays of one half vector see along a row: the environment, or the surface where they
    /// meet it, with both terms under the environment alone. Of the surface's own lobe one ray
    /// represents all.
    ///
    /// * `rays`: directions, widths in radians, and weights: those of 0 are not wanted.
    pub fn follow(
        &self,
        shading: &Shading,
        surface_row: &SurfaceRow,
        second: &SecondLook,
        rays: (&Directions, &RowValues, &RowValues),
        incoming: &mut Light3,
    ) {
        let (toward, width_rad, weight) = rays;
        let (mut last, mut width_rad) = (*toward, *width_rad);
        let [mut matt, mut kept] = [[[0.0; TILE]; 3]; 2];
        for x in (0..surface_row.width).filter(|&x| weight[x] > 0.0) {
            let (n, v) = (surface_row.normal_at(x), surface_row.view_at(x));
            let start = second.start(surface_row.x0 + x, surface_row.y, n, v);
            let mut sample = BouncedSample { width_rad: width_rad[x], ..BouncedSample::default() };
            let l = vec3(toward[0][x], toward[1][x], toward[2][x]);
            let direction = self.bounce(shading, (second, start), l, &mut sample);
            width_rad[x] = sample.width_rad;
            for c in 0..3 {
                (last[c][x], matt[c][x], kept[c][x]) =
                    (direction[c], sample.matt[c], sample.kept[c]);
            }
        }
        self.environment_light.mean_over_cone_row(&last, &width_rad, weight, incoming);
        for c in 0..3 {
            for x in 0..TILE {
                incoming[c][x] = matt[c][x] + kept[c][x] * incoming[c][x];
            }
        }
    }

    /// Follows one ray to the last.
    fn bounce(
        &self,
        shading: &Shading,
        (second, start): (&SecondLook, RayStart),
        l: Vec3,
        sample: &mut BouncedSample,
    ) -> Vec3 {
        let [rd, rs] = [&shading.diffuse, &shading.specular].map(|term| Vec3::from(term.linear()));
        let rs = rs.min(Vec3::ONE);
        let ray = PixelRay { direction: l, changes: [Vec3::ZERO; 2] };
        let last = second.follow(start, ray, mirror::mirrored, |hit, r| {
            let facing = -hit.normal.dot(r);
            if shading.diffuse.weight > 0.0 {
                let light = self.environment_light.matt(hit.normal);
                sample.matt +=
                    sample.kept * rd * (Vec3::ONE - rs) * light * ashikhmin::matt_share(facing);
            }
            sample.kept *= rs + (Vec3::ONE - rs) * ashikhmin::whiteness(facing);
            sample.width_rad = sample.width_rad.hypot(self.lobe_rad);
            sample.is_met = true;
        });
        last.direction
    }

    /// By how much the light of a pixel's own half vectors changes, as if they were all.
    fn change_at(
        &self,
        shading: &Shading,
        second: &SecondLook,
        surface: &Surface,
        (x, y): (usize, usize),
    ) -> Vec3 {
        let rs = Vec3::from(shading.specular.linear()).min(Vec3::ONE);
        let (normal, view) = (surface.normal(x, y), surface.view(x, y));
        let start = second.start(x, y, normal, view);
        // In the frame of the view, where it is (0, 0, 1).
        let n = in_view(view, normal);
        let (u, v) = frame(n);
        let mut change = Vec3::ZERO;
        for j in 0..FOLLOWED {
            let k = 2 * j + (x / 2 + y / 2 + j / 2) % 2;
            // One of four in turn: both numbers of the points stay even at every pixel.
            let half = &self.halves[PHASES * k + (phase(x, y) + k) % PHASES];
            let h = u * half.uvn.x + v * half.uvn.y + n * half.uvn.z;
            let l = 2.0 * h.z * h - Vec3::Z;
            let n_l = n.dot(l);
            if n_l <= 0.0 || h.z <= 0.0 {
                continue;
            }
            let (l, width_rad) = (from_view(view, l), width_rad(h.z, half.density));
            let mut sample = BouncedSample { width_rad, ..BouncedSample::default() };
            let last = self.bounce(shading, (second, start), l, &mut sample);
            if sample.is_met {
                let arrives = n_l / n_l.max(n.z).max(1e-3);
                let seen = sample.matt
                    + sample.kept * self.environment_light.mean_over_cone(last, sample.width_rad);
                let fresnel = rs + (Vec3::ONE - rs) * ashikhmin::whiteness(h.z);
                change += fresnel
                    * arrives
                    * (seen - self.environment_light.mean_over_cone(l, width_rad));
            }
        }
        change / FOLLOWED as f32
    }
}

/// What a ray has gathered where it met the surface, and how it goes on.
struct BouncedSample {
    /// Light of the matt term.
    matt: Vec3,
    /// What is kept of the light that it still sees.
    kept: Vec3,
    width_rad: f32,
    is_met: bool,
}

impl Default for BouncedSample {
    fn default() -> Self {
        Self { matt: Vec3::ZERO, kept: Vec3::ONE, width_rad: 0.0, is_met: false }
    }
}

/// Which quarter of the half vectors a pixel follows.
fn phase(x: usize, y: usize) -> usize {
    (x & 1) + 2 * (y & 1)
}

impl BouncedLight {
    /// The change at a pixel: the mean over the quarters of the half vectors, each as the pixels
    /// around it on the same piece of surface have it, nearer ones counting twice along either
    /// axis.
    pub fn at(&self, surface: &Surface, (x, y): (usize, usize)) -> Vec3 {
        let mut quarters = [(Vec3::ZERO, 0.0f32); PHASES];
        let joined = links::joined_neighbors(surface.smooth_links_plane(), (x, y));
        for (i, _) in joined.into_iter().enumerate().filter(|(_, joined)| *joined) {
            let (dx, dy) = (i as i32 % 3 - 1, i as i32 / 3 - 1);
            let share = ((2 - dx.abs()) * (2 - dy.abs())) as f32;
            let (column, row) = (x as i32 + dx, y as i32 + dy);
            let place = (row - self.rect.y0) as usize * self.rect.width()
                + (column - self.rect.x0) as usize;
            let (sum, weight) = &mut quarters[phase(column as usize, row as usize)];
            *sum += share * self.changes.get(place).copied().unwrap_or_default();
            *weight += share;
        }
        let known = quarters.into_iter().filter(|(_, weight)| *weight > 0.0);
        let (sum, count) = known
            .fold((Vec3::ZERO, 0.0), |(all, n), (sum, weight)| (all + sum / weight, n + 1.0f32));
        sum / count.max(1.0)
    }
}
