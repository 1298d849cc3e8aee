//! Mirror and refraction: the environment seen along one ray (RS sec. 5.3.2, MATH 5). Floor 3. One
//! interface: a refracted ray does not leave its object by a second one. Not here: what a ray meets
//! on its way (`second_look`).

use super::second_look::{PixelRay, SecondLook};
use super::{Model, Shading, lobes};
use crate::math::{Vec2, Vec3, srgb, vec2, vec3};
use crate::raster::TILE;
use crate::shading::environment::{Directions, EnvironmentLight};
use crate::shading::surface_row::{Light3, LightDirection, RowValues, SurfaceRow};
use crate::surface::{links, view::Eye};

/// The mirrored view r = 2(n·v)n − v, v toward the eye (MATH 5).
#[inline(always)]
pub fn mirrored(n: Vec3, v: Vec3) -> Vec3 {
    2.0 * n.dot(v) * n - v
}

/// The refracted view: Snell's law for the view ray −v entering a medium of refractive index
/// `index` > 0 (MATH 5).
///
/// Total internal reflection (`index` < 1 at a grazing angle) mirrors it.
#[inline(always)]
pub fn refract(n: Vec3, v: Vec3, index: f32) -> Vec3 {
    let eta = 1.0 / index;
    let cos = n.dot(v).max(0.0);
    let under_root = 1.0 - eta * eta * (1.0 - cos * cos);
    let through = (eta * cos - under_root.max(0.0).sqrt()) * n - eta * v;
    if under_root < 0.0 { mirrored(n, v) } else { through }
}

/// Adds L_env(r), scaled with δ = L_env(r) / max L_env, as the specular term.
pub fn shade(shading: &Shading, surface_row: &SurfaceRow, light: &mut Light3) {
    let (Some(environment), term) = (&shading.environment, &shading.specular) else { return };
    let environment_light = environment.environment_light();
    let per_brightest = 1.0 / shading.reference.resolve(environment_light.brightest());
    let index = match shading.model {
        Model::Refraction => Some(shading.index),
        _ => None,
    };
    let rays = RayRow::new(surface_row, index);
    let toward = [rays.ray[0], rays.ray[1]];
    let mut incoming: Light3 = [[0.0; TILE]; 3];
    environment_light.mean_over_pixel_row(
        &rays.ray,
        &rays.dx,
        &rays.dy,
        surface_row.coverage(),
        &mut incoming,
    );
    if let Some(second) = SecondLook::on(surface_row.surface, shading.bounces_made()) {
        // No surface returns more than it receives.
        let once = Vec3::from(term.linear()).min(Vec3::ONE);
        rays.follow(&second, surface_row, (index, once), &environment_light, &mut incoming);
    }
    let mut delta = [0.0; TILE];
    tint(&mut incoming, term.linear(), per_brightest, &mut delta);
    if !term.is_scaled() {
        return lobes::add_incoming(light, &incoming, None);
    }
    let kappa = surface_row.kappa(LightDirection::Each(&toward[0], &toward[1]));
    lobes::add_incoming(light, &incoming, Some((term.scaling, &kappa, &delta)));
}

/// The rays of a row's pixels, and how they change from pixel to pixel.
struct RayRow {
    ray: Directions,
    /// Along x and y; differences do not cross depth jumps or the mask's edge.
    dx: Directions,
    dy: Directions,
}

/// A row of a tile with a neighbor at each end.
const SPAN: usize = TILE + 2;
type Span = [[f32; SPAN]; 3];

impl RayRow {
    /// Mirrored rays, or with a refractive index refracted ones.
    fn new(surface_row: &SurfaceRow, index: Option<f32>) -> Self {
        let height = surface_row.surface.size().height as usize;
        let y = surface_row.y;
        // A row beyond the picture is linked to none.
        let [above, here, below] =
            [y.saturating_sub(1), y, (y + 1).min(height - 1)].map(|y| rays(surface_row, y, index));
        let [ray, dx, dy] = [[[0.0; TILE]; 3]; 3];
        let mut row = Self { ray, dx, dy };
        let mut joined = [0; TILE];
        joined[..surface_row.width].copy_from_slice(surface_row.links());
        for c in 0..3 {
            row.ray[c].copy_from_slice(&here[c][1..=TILE]);
            let (before, after) = (&here[c][..TILE], &here[c][2..]);
            differences(
                &joined,
                (links::LEFT, links::RIGHT),
                [before, &row.ray[c], after],
                &mut row.dx[c],
            );
            let (before, after) = (&above[c][1..=TILE], &below[c][1..=TILE]);
            differences(
                &joined,
                (links::UP, links::DOWN),
                [before, &row.ray[c], after],
                &mut row.dy[c],
            );
        }
        row
    }
}

/// Where the rays of a pixel that is followed lie in it, px from its middle: even along both axes.
const PARTS: [Vec2; 4] =
    [vec2(-0.125, -0.375), vec2(0.375, -0.125), vec2(0.125, 0.375), vec2(-0.375, 0.125)];
/// The sides of what each of them stands for, px.
const PART_PX: f32 = 0.5;

impl RayRow {
    /// Follows the rays over the surface, and replaces the light of pixels where they meet it: by
    /// the mean over several rays, since what curved surfaces mirror of each other changes within a
    /// pixel.
    ///
    /// * `index`, `once`: how a ray is bent, as [`RayRow::new`], and what one bounce keeps.
    fn follow(
        &self,
        second: &SecondLook,
        surface_row: &SurfaceRow,
        (index, once): (Option<f32>, Vec3),
        environment_light: &EnvironmentLight,
        incoming: &mut Light3,
    ) {
        let bend =
            |n: Vec3, v: Vec3| index.map_or_else(|| mirrored(n, v), |index| refract(n, v, index));
        let of = |row: &Directions, x: usize| vec3(row[0][x], row[1][x], row[2][x]);
        for x in (0..surface_row.width).filter(|&x| surface_row.coverage()[x] > 0) {
            let start = second.start(
                surface_row.x0 + x,
                surface_row.y,
                surface_row.normal_at(x),
                surface_row.view_at(x),
            );
            let (ray, dx, dy) = (of(&self.ray, x), of(&self.dx, x), of(&self.dy, x));
            let follow = |at: Vec2| {
                let direction = (ray + dx * at.x + dy * at.y).normalize_or(ray);
                let part = PixelRay { direction, changes: [dx * PART_PX, dy * PART_PX] };
                let (mut kept, mut is_met) = (Vec3::ONE, false);
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

    /// How a value changes from pixel to pixel, of those before, here and after; only linked ones
    /// count.
    fn differences(joined: &[u8; TILE], sides: (u8, u8), values: [&[f32]; 3], to: &mut RowValues) {
        let [before, here, after] = values.map(|row| &row[..TILE]);
        for x in 0..TILE {
            let (to_back, to_forth) = (joined[x] & sides.0 != 0, joined[x] & sides.1 != 0);
            let a = if to_back { before[x] } else { here[x] };
            let b = if to_forth { after[x] } else { here[x] };
            to[x] = (b - a) * if to_back & to_forth { 0.5 } else { 1.0 };
        }
    }

    /// Tints light, after δ of each pixel was computed from it.
    fn tint(light: &mut Light3, by: [f32; 3], per_brightest: f32, delta: &mut RowValues) {
        let [red, green, blue] = light;
        for x in 0..TILE {
            delta[x] = srgb::luminance(red[x], green[x], blue[x]) * per_brightest;
            (red[x], green[x], blue[x]) = (red[x] * by[0], green[x] * by[1], blue[x] * by[2]);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;
    use crate::raster::Picture;
    use crate::shading::material::tests::{assert_shows, term};
    use crate::shading::{Environment, Shading};

    #[test]
    fn mirrored_rays_leave_as_steeply_as_they_came() {
        assert_eq!(mirrored(Vec3::Z, Vec3::Z), Vec3::Z);
        // Half-way up: the sky's zenith.
        let up = mirrored(vec3(0.0, 0.5f32.sqrt(), 0.5f32.sqrt()), Vec3::Z);
        assert!((up - Vec3::Y).length() < 1e-6, "{up}");
        let n = vec3(0.3, -0.5, 0.7).normalize();
        for v in [Vec3::Z, vec3(0.4, 0.1, 0.8).normalize()] {
            let r = mirrored(n, v);
            assert!((r.dot(n) - n.dot(v)).abs() < 1e-6 && n.cross(v).dot(r).abs() < 1e-6, "{v}");
        }
    }

    #[test]
    fn refracted_rays_obey_snell() {
        assert_eq!(refract(Vec3::Z, Vec3::Z, 1.5), Vec3::NEG_Z);
        for (n, index) in
            [(vec3(0.3, -0.5, 0.7), 1.5), (vec3(-0.2, 0.1, 0.9), 0.8), (vec3(0.9, 0.0, 0.1), 2.4)]
        {
            let n = n.normalize();
            for v in [Vec3::Z, vec3(0.1, -0.2, 0.9).normalize()] {
                let r = refract(n, v, index);
                assert!((r.length() - 1.0).abs() < 1e-5);
                // sin θ = index · sin θ′, both on the same plane, on the far side.
                assert!((n.cross(r).length() * index - n.cross(v).length()).abs() < 1e-5);
                assert!(n.cross(r).dot(n.cross(-v)) >= 0.0 && r.dot(n) < 0.0);
            }
        }
        let n = vec3(0.6, 0.0, 0.8);
        assert!(
            (refract(n, Vec3::Z, 1.0) - Vec3::NEG_Z).length() < 1e-6,
            "nothing bends without another matter"
        );
        assert_eq!(
            refract(n, Vec3::Z, 0.5),
            mirrored(n, Vec3::Z),
            "past the critical angle it is a mirror"
        );
        assert!(refract(vec3(0.999, 0.0, -0.04), Vec3::Z, 1.5).is_finite());
    }

    /// Bright above, dim below, and red at the right.
    fn environment_light() -> Environment {
        let texel = |i: u32| {
            let e = crate::shading::environment::projection::lat_long_direction(
                ((i % 128) as f32 + 0.5) / 128.0,
                ((i / 128) as f32 + 0.5) / 64.0,
            );
            [0.5 + 0.4 * e.y + 0.1 * e.x, 0.5 + 0.4 * e.y, 0.5 + 0.3 * e.y - 0.1 * e.z, 1.0]
        };
        let picture =
            Picture::linear(Size::new(128, 64), (0..128 * 64).map(texel).collect()).unwrap();
        let mut environment = Environment::new("sky.hdr".into(), picture);
        (environment.rotation, environment.exposure) = (30.0, -0.5);
        environment
    }

    #[test]
    fn what_is_seen_is_the_scaled_environment_along_the_ray() {
        for model in [Model::Mirror, Model::Refraction] {
            let shading = Shading {
                environment: Some(environment_light()),
                specular: term(
                    crate::math::srgb::Color { r: 250, g: 230, b: 200, a: 255 },
                    0.9,
                    0.4,
                    1.5,
                ),
                features: crate::shading::Features { lambda: 0.6, ..Default::default() },
                ..Shading::new(model)
            };
            assert_shows(&shading, 2.0, |surface, x, y| {
                let (n, v) = (surface.normal(x, y), surface.view(x, y));
                let r = if model == Model::Mirror { mirrored(n, v) } else { refract(n, v, 1.5) };
                let incoming = environment_light().environment_light();
                let radiance = incoming.radiance(r);
                let delta =
                    srgb::luminance(radiance.x, radiance.y, radiance.z) / incoming.brightest();
                let sigma =
                    shading.specular.scaling.sigma(shading.features.on(surface).at(x, y, r), delta);
                Vec3::from(shading.specular.linear()) * radiance * sigma
            });
        }
    }

    #[test]
    fn a_mirror_that_faces_up_shows_the_sky() {
        let shading =
            Shading { environment: Some(environment_light()), ..Shading::new(Model::Mirror) };
        let scene = crate::shading::material::tests::ball();
        let column = |at| shading.render_tile(&scene, crate::raster::TileAt::new(0, at)).unwrap();
        // The ball's middle is at (60, 66): row 30 faces up, row 100 down.
        let (above, below) = (
            column(0).bytes()[(30 * TILE + 60) * 4 + 1],
            column(1).bytes()[(36 * TILE + 60) * 4 + 1],
        );
        assert!(above > below + 40, "{above} {below}");
    }

    #[test]
    fn without_an_environment_a_mirror_is_black() {
        assert_shows(&Shading::new(Model::Mirror), 0.0, |_, _, _| Vec3::ZERO);
    }
}
