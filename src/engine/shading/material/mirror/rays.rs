//! The rays of a row's pixels, mirrored or refracted, and what they see (RS sec. 5.3.2, MATH 5).
//! Floor 3.

use super::{mirrored, refract, refractive_index};
use crate::math::{Vec2, Vec3, vec2, vec3};
use crate::raster::TILE;
use crate::shading::Shading;
use crate::shading::environment::{Directions, EnvironmentLight};
use crate::shading::material::second_look::{PixelRay, SecondLook};
use crate::shading::surface_row::{Light3, RowValues, SurfaceRow};
use crate::surface::{links, view::Eye};

/// The rays of a row's pixels, and how they change from pixel to pixel.
pub struct RayRow {
    pub ray: Directions,
    /// To the neighbor at the left, right, above and below; differences do not cross depth jumps or
    /// the mask's edge: there they are the opposite of that on the other side, if there is one.
    sides: [Directions; 4],
}

/// A row of a tile with a neighbor at each end.
const SPAN: usize = TILE + 2;
type Span = [[f32; SPAN]; 3];

impl RayRow {
    /// Mirrored rays, or with a refractive index refracted ones.
    pub fn new(surface_row: &SurfaceRow, index: Option<f32>) -> Self {
        let height = surface_row.surface.size().height as usize;
        let y = surface_row.y;
        // A row beyond the picture is linked to none.
        let [above, here, below] =
            [y.saturating_sub(1), y, (y + 1).min(height - 1)].map(|y| rays(surface_row, y, index));
        let mut row = Self { ray: [[0.0; TILE]; 3], sides: [[[0.0; TILE]; 3]; 4] };
        let mut joined = [0; TILE];
        joined[..surface_row.width].copy_from_slice(surface_row.links());
        let Self { ray, sides: [left, right, up, down] } = &mut row;
        for c in 0..3 {
            ray[c].copy_from_slice(&here[c][1..=TILE]);
            let across = [&here[c][..TILE], &here[c][2..]];
            differences(
                &joined,
                (links::LEFT, links::RIGHT),
                &ray[c],
                across,
                [&mut left[c], &mut right[c]],
            );
            let along = [&above[c][1..=TILE], &below[c][1..=TILE]];
            differences(
                &joined,
                (links::UP, links::DOWN),
                &ray[c],
                along,
                [&mut up[c], &mut down[c]],
            );
        }
        row
    }

    /// How the ray changes along x and y, over the whole pixel.
    fn changes(&self) -> [Directions; 2] {
        let [left, right, up, down] = &self.sides;
        let mean = |back: &Directions, forth: &Directions| {
            std::array::from_fn(|c| std::array::from_fn(|x| 0.5 * (forth[c][x] - back[c][x])))
        };
        [mean(left, right), mean(up, down)]
    }

    /// The light that the rays see of the environment.
    pub fn see_environment(
        &self,
        surface_row: &SurfaceRow,
        environment_light: &EnvironmentLight,
        incoming: &mut Light3,
    ) {
        let [dx, dy] = self.changes();
        let covered = surface_row.coverage();
        environment_light.mean_over_pixel_row(&self.ray, &dx, &dy, covered, incoming);
    }

    /// The light that the rays see, of the environment and over the surface.
    ///
    /// Returns the pixels whose rays meet the surface, as bits.
    pub fn see(
        &self,
        shading: &Shading,
        surface_row: &SurfaceRow,
        environment_light: &EnvironmentLight,
        incoming: &mut Light3,
    ) -> u64 {
        self.see_environment(surface_row, environment_light, incoming);
        let Some(second) = SecondLook::on(surface_row.surface, shading.bounces_made()) else {
            return 0;
        };
        let index = refractive_index(shading);
        // No surface returns more than it receives.
        let once = Vec3::from(shading.specular.linear()).min(Vec3::ONE);
        self.follow(&second, surface_row, (index, once), environment_light, incoming)
    }
}

/// Where the rays of a pixel that is followed lie in it, px from its middle: even along both axes.
pub(super) const PARTS: [Vec2; 4] =
    [vec2(-0.125, -0.375), vec2(0.375, -0.125), vec2(0.125, 0.375), vec2(-0.375, 0.125)];
/// The sides of what each of them stands for, px.
pub(super) const PART_PX: f32 = 0.5;

impl RayRow {
    /// The ray of a part of a pixel: between its own and those of the neighbors on that side.
    pub fn of_part(&self, x: usize, part: Vec2) -> PixelRay {
        let of = |row: &Directions| vec3(row[0][x], row[1][x], row[2][x]);
        let [left, right, up, down] = &self.sides;
        let across = if part.x < 0.0 { -of(left) } else { of(right) };
        let along = if part.y < 0.0 { -of(up) } else { of(down) };
        let ray = of(&self.ray);
        PixelRay {
            direction: (ray + across * part.x + along * part.y).normalize_or(ray),
            changes: [across * PART_PX, along * PART_PX],
        }
    }

    /// Follows the rays over the surface, and replaces the light of pixels where they meet it: by
    /// the mean over several rays, since what curved surfaces mirror of each other changes within a
    /// pixel.
    ///
    /// * `index`, `once`: how a ray is bent, as [`RayRow::new`], and what one bounce keeps.
    ///
    /// Returns these pixels, as bits.
    fn follow(
        &self,
        second: &SecondLook,
        surface_row: &SurfaceRow,
        (index, once): (Option<f32>, Vec3),
        environment_light: &EnvironmentLight,
        incoming: &mut Light3,
    ) -> u64 {
        let bend =
            |n: Vec3, v: Vec3| index.map_or_else(|| mirrored(n, v), |index| refract(n, v, index));
        let mut met = 0;
        for x in (0..surface_row.width).filter(|&x| surface_row.coverage()[x] > 0) {
            let start = second.start(
                surface_row.x0 + x,
                surface_row.y,
                surface_row.normal_at(x),
                surface_row.view_at(x),
            );
            let follow = |at: Vec2| {
                let (mut kept, mut is_met) = (Vec3::ONE, false);
                let part = self.of_part(x, at);
                let last = second.follow(start.of_part(PART_PX), part, bend, |_, _| {
                    (kept, is_met) = (kept * once, true);
                });
                (last, kept, is_met)
            };
            // Where two on opposite sides of the pixel meet nothing, the others hardly do.
            let first = [follow(PARTS[0]), follow(PARTS[2])];
            if first.iter().all(|(_, _, is_met)| !is_met) {
                continue;
            }
            met |= 1 << x;
            let seen =
                |(PixelRay { direction, changes: [dx, dy] }, kept, _): (PixelRay, Vec3, bool)| {
                    kept * environment_light.mean_over_pixel(direction, dx, dy)
                };
            let mean = (first.into_iter().chain([follow(PARTS[1]), follow(PARTS[3])]))
                .map(seen)
                .sum::<Vec3>()
                / PARTS.len() as f32;
            (incoming[0][x], incoming[1][x], incoming[2][x]) = mean.into();
        }
        met
    }
}

/// The rays of another row of the same columns, and of one more at each end.
fn rays(surface_row: &SurfaceRow, y: usize, index: Option<f32>) -> Span {
    let SurfaceRow { surface, x0, width, .. } = *surface_row;
    let (first, end) = (x0.saturating_sub(1), (x0 + width + 1).min(surface.size().width as usize));
    let held = first + 1 - x0..end + 1 - x0;
    let facing = [[0.0; SPAN], [0.0; SPAN], [1.0; SPAN]];
    let (mut normal, mut view) = (facing, facing);
    for (row, plane) in normal.iter_mut().zip(surface.normal_planes()) {
        row[held.clone()].copy_from_slice(&plane.row(y)[first..end]);
    }
    // Camera space has y up.
    normal[1].iter_mut().for_each(|y| *y = -*y);
    if y == surface_row.y {
        normal
            .iter_mut()
            .zip(&surface_row.normal)
            .for_each(|(to, own)| to[1..=width].copy_from_slice(&own[..width]));
    }
    if surface.eye() != Eye::Afar {
        for (i, x) in held.zip(first..end) {
            (view[0][i], view[1][i], view[2][i]) = surface.view(x, y).into();
        }
    }
    let mut rays = [[0.0; SPAN]; 3];
    match index {
        Some(index) => refract_span(&normal, &view, index, &mut rays),
        None => mirror_span(&normal, &view, &mut rays),
    }
    rays
}

crate::widest! {
    fn mirror_span(normal: &Span, view: &Span, rays: &mut Span) {
        for i in 0..SPAN {
            let r = mirrored(at(normal, i), at(view, i));
            put(rays, i, r);
        }
    }

    fn refract_span(normal: &Span, view: &Span, index: f32, rays: &mut Span) {
        for i in 0..SPAN {
            let r = refract(at(normal, i), at(view, i), index);
            put(rays, i, r);
        }
    }

    /// How a value changes to the pixels before and after; only linked ones count.
    fn differences(
        joined: &[u8; TILE],
        sides: (u8, u8),
        here: &RowValues,
        beside: [&[f32]; 2],
        to: [&mut RowValues; 2],
    ) {
        let ([before, after], [to_before, to_after]) = (beside.map(|row| &row[..TILE]), to);
        for x in 0..TILE {
            let (is_back, is_forth) = (joined[x] & sides.0 != 0, joined[x] & sides.1 != 0);
            let (a, b) = (before[x] - here[x], after[x] - here[x]);
            to_before[x] = if is_back { a } else if is_forth { -b } else { 0.0 };
            to_after[x] = if is_forth { b } else if is_back { -a } else { 0.0 };
        }
    }
}

#[inline(always)]
fn put(span: &mut Span, i: usize, v: Vec3) {
    (span[0][i], span[1][i], span[2][i]) = (v.x, v.y, v.z);
}

#[inline(always)]
fn at(span: &Span, i: usize) -> Vec3 {
    vec3(span[0][i], span[1][i], span[2][i])
}
