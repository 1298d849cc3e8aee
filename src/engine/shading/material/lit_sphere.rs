//! Lit sphere: each pixel gets the color of a painted sphere at the same normal; or of two
//! spheres, one for convex and one for concave features, blended by κ (RS sec. 5.3.1, MATH 5). With
//! strokes the sphere is read where whole brush marks stay (`surface::chunks`). Floor 3.

use super::{Shading, lobes};
use crate::math::srgb;
use crate::raster::TILE;
use crate::shading::LitSphere;
use crate::shading::sphere::SphereLight;
use crate::shading::surface_row::{Light3, LightDirection, RowRelief, RowValues, SurfaceRow};
use crate::surface::chunks::BallPlaces;

/// Adds the sphere's light, the `specular` term: δ is its luminance over the greatest on the
/// spheres.
///
/// Of two spheres, the convex one has the weight (1 + κ) / 2, so that flat parts show half of each.
pub fn shade(
    shading: &Shading,
    surface_row: &SurfaceRow,
    places: Option<&BallPlaces>,
    relief: &mut RowRelief,
    light: &mut Light3,
) {
    let term = &shading.specular;
    if term.weight <= 0.0 {
        return;
    }
    let [convex, concave] = lights(shading);
    let Some(convex) = convex else { return };
    if term.is_scaled() || concave.is_some() {
        // A painted sphere has no single direction of light, so κ is isotropic.
        relief.turn(surface_row, LightDirection::VIEWER);
    }
    let shown = look_up_row(surface_row, places, [Some(convex), concave], relief.kappa());
    let mut sigma = [1.0; TILE];
    if term.is_scaled() {
        let brightest = concave.map_or(0.0, SphereLight::brightest).max(convex.brightest());
        let delta = reflectances(&shown, 1.0 / shading.reference.resolve(brightest));
        lobes::scale(&mut sigma, term.scaling, relief.exponentials(term.scaling), &delta);
    }
    lobes::add_shown(light, term.linear(), &shown, &sigma);
}

/// The sphere for convex features, or for all.
fn convex(shading: &Shading) -> &LitSphere {
    shading.sphere.as_ref().unwrap_or_else(|| LitSphere::clay())
}

/// The light of the convex sphere and of the concave one, as fine as it is shown.
fn lights(shading: &Shading) -> [Option<&SphereLight>; 2] {
    let spheres = [Some(convex(shading)), shading.sphere_concave.as_ref()];
    spheres.map(|sphere| {
        sphere.map(|sphere| match shading.has_strokes() {
            true => sphere.light_at(shading.strokes.size),
            false => sphere.light(),
        })
    })
}

/// Fills the caches that many tiles would otherwise wait for.
pub fn warm_caches(shading: &Shading) {
    lights(shading);
}

fn look_up_row(
    surface_row: &SurfaceRow,
    places: Option<&BallPlaces>,
    [convex, concave]: [Option<&SphereLight>; 2],
    kappa: &RowValues,
) -> Light3 {
    let on_ball = places.map(|places| on_ball(surface_row, places));
    let read = |sphere: &SphereLight, shown: &mut Light3| match (places, &on_ball) {
        (Some(places), Some(on_ball)) => {
            sphere.at_row(on_ball, shown);
            average_seams(sphere, surface_row, places, shown);
        }
        _ => sphere.at_row(surface_row.seen_normal(), shown),
    };
    let mut shown = [[0.0; TILE]; 3];
    if let Some(convex) = convex {
        read(convex, &mut shown);
    }
    if let Some(concave) = concave {
        let mut other = [[0.0; TILE]; 3];
        read(concave, &mut other);
        for (shown, other) in shown.iter_mut().zip(&other) {
            for (x, (shown, other)) in shown.iter_mut().zip(other).enumerate() {
                *shown = other + (0.5 + 0.5 * kappa[x]) * (*shown - other);
            }
        }
    }
    shown
}

/// The places of a row, as n̄ of the ball (y up).
fn on_ball(surface_row: &SurfaceRow, places: &BallPlaces) -> [RowValues; 3] {
    let mut nbar = [[0.0; TILE]; 3];
    let row = &places.row(surface_row.y)[surface_row.x0..surface_row.x0 + surface_row.width];
    let per_step = places.nbar_per_step();
    for (x, [across, down]) in row.iter().enumerate() {
        nbar[0][x] = f32::from(*across) * per_step - 1.0;
        nbar[1][x] = 1.0 - f32::from(*down) * per_step;
    }
    nbar
}

/// Averages what pixels show on seams with what their neighbors' chunks show there.
fn average_seams(
    sphere: &SphereLight,
    surface_row: &SurfaceRow,
    places: &BallPlaces,
    shown: &mut Light3,
) {
    let Some(seams) = places.seams(surface_row.y) else { return };
    let row = &seams[surface_row.x0..surface_row.x0 + surface_row.width];
    let per_step = places.nbar_per_step();
    let mut batch = SeamBatch::default();
    for (x, bits) in row.iter().enumerate().filter(|(_, bits)| **bits > 0) {
        let mut left = *bits;
        while left != 0 {
            let bit = left.trailing_zeros() as usize;
            left &= left - 1;
            let [across, down] = places.place_beside(surface_row.x0 + x, surface_row.y, bit);
            batch.push(x, [across * per_step - 1.0, 1.0 - down * per_step]);
            if batch.count == TILE {
                batch.add_to(sphere, shown);
            }
        }
    }
    batch.add_to(sphere, shown);
    for (x, bits) in row.iter().enumerate().filter(|(_, bits)| **bits > 0) {
        let mean = 1.0 / (1 + bits.count_ones()) as f32;
        shown.iter_mut().for_each(|shown| shown[x] *= mean);
    }
}

/// Places of neighbors that are looked up at once.
struct SeamBatch {
    count: usize,
    /// The pixels that they are added to.
    pixels: [u8; TILE],
    /// n̄ of the ball (y up).
    nbar: [RowValues; 3],
}

impl Default for SeamBatch {
    fn default() -> Self {
        Self { count: 0, pixels: [0; TILE], nbar: [[0.0; TILE]; 3] }
    }
}

impl SeamBatch {
    fn push(&mut self, pixel: usize, [x, y]: [f32; 2]) {
        self.pixels[self.count] = pixel as u8;
        (self.nbar[0][self.count], self.nbar[1][self.count]) = (x, y);
        self.count += 1;
    }

    /// Adds what they show, and begins anew.
    fn add_to(&mut self, sphere: &SphereLight, shown: &mut Light3) {
        if self.count == 0 {
            return;
        }
        let mut light = [[0.0; TILE]; 3];
        sphere.at_row(&self.nbar, &mut light);
        for (shown, light) in shown.iter_mut().zip(&light) {
            for (pixel, light) in self.pixels[..self.count].iter().zip(light) {
                shown[usize::from(*pixel)] += light;
            }
        }
        self.count = 0;
    }
}

/// δ = luminance / Y*, clamped by σ itself.
fn reflectances(shown: &Light3, per_reference: f32) -> RowValues {
    std::array::from_fn(|x| srgb::luminance(shown[0][x], shown[1][x], shown[2][x]) * per_reference)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, hash, vec2, vec3};
    use crate::raster::{Picture, Plane, TileAt};
    use crate::shading::{BallStrokes, Model};
    use crate::surface::{Maps, Scene, Surface};
    use std::sync::Arc;

    const SIDE: u32 = 128;

    /// A ball in stripes that wander, and the surface of the ball itself, `times` as large.
    fn striped(times: u32) -> (Shading, Scene) {
        let at = |v: usize, side: u32| (v as f32 + 0.5) / side as f32 * 2.0 - 1.0;
        let tone = |i: u32| {
            let (x, y) = (i % SIDE, i / SIDE);
            let stripe = (y as f32 * 0.9 + (x as f32 * 0.11).sin() * 4.0).sin();
            let speck = hash::unit(3, x / 3, y / 2) - 0.5;
            (110.0 + 70.0 * stripe + 60.0 * speck - 40.0 * at(y as usize, SIDE)) as u8
        };
        let texels = (0..SIDE * SIDE).map(|i| [tone(i), tone(i) / 2, 255 - tone(i), 255]).collect();
        let mut shading = Shading::new(Model::LitSphere);
        let picture = Picture::srgb8(Size::new(SIDE, SIDE), texels).unwrap();
        shading.sphere = Some(LitSphere::new("ball.png".into(), picture));
        shading.strokes = BallStrokes { on: true, size: SIDE as f32, ..BallStrokes::DEFAULT };
        let size = Size::new(times * SIDE, times * SIDE);
        let normals = Plane::from_fn(size, |x, y| {
            let (u, v) = (at(x, times * SIDE), at(y, times * SIDE));
            vec3(u, -v, (1.0 - u * u - v * v).max(0.0).sqrt())
        });
        let coverage = normals.map(|n| if n.z > 0.0 { 255 } else { 0 });
        let depth = normals.map(|n| 0.5 - 0.5 * n.z);
        let surface = Surface::new(Maps { normals, depth, coverage }).unwrap();
        (shading, Scene { size, surface: Some(Arc::new(surface)) })
    }

    fn bytes(shading: &Shading, scene: &Scene) -> Vec<[u8; 4]> {
        let tile = |at: TileAt| shading.render_tile(scene, at).unwrap().bytes().to_vec();
        TileAt::covering(scene.size.rect())
            .flat_map(tile)
            .collect::<Vec<u8>>()
            .as_chunks::<4>()
            .0
            .to_vec()
    }

    #[test]
    fn the_ball_on_its_own_normals_is_the_ball() {
        let (shading, scene) = striped(1);
        let picture = &shading.sphere.as_ref().unwrap().picture;
        let (mut same, mut all) = (0, 0);
        for at in TileAt::covering(scene.size.rect()) {
            let tile = shading.render_tile(&scene, at).unwrap();
            let (inside, pixels) = (scene.area(at), tile.bytes().as_chunks::<4>().0);
            for (y, x) in (0..TILE).flat_map(|y| (0..TILE).map(move |x| (y, x))) {
                let (px, py) = (inside.x0 as usize + x, inside.y0 as usize + y);
                let middle = 0.5 * SIDE as f32 - 0.5;
                // The rim takes the paint next to it, not the ground around the ball.
                if (px as f32 - middle).hypot(py as f32 - middle) < middle - 1.5 {
                    let [r, g, b, _] = picture.linear_at(px, py);
                    let expected = [r, g, b].map(|light| srgb::quantize(srgb::encode(light)));
                    same += usize::from(pixels[y * TILE + x][..3] == expected);
                    all += 1;
                }
            }
        }
        assert!(same * 1000 >= all * 999, "{same} of {all}");
    }

    #[test]
    fn strokes_stay_as_fine_as_the_ball_where_a_lit_sphere_smears_them() {
        let (mut shading, scene) = striped(3);
        // Changes from pixel to pixel, in the middle of the ball.
        let changes = |bytes: &[[u8; 4]]| {
            let changed = |pair: &[[u8; 4]]| f32::from(pair[0][0].abs_diff(pair[1][0]));
            bytes.windows(2).map(changed).sum::<f32>() / bytes.len() as f32
        };
        let (ball_shading, ball) = striped(1);
        let own = changes(&bytes(&ball_shading, &ball));
        let whole = changes(&bytes(&shading, &scene));
        shading.strokes.on = false;
        let smeared = changes(&bytes(&shading, &scene));
        assert!((whole - own).abs() < 0.5 * (smeared - own).abs(), "{own} {whole} {smeared}");
    }

    #[test]
    fn a_finer_ball_than_is_seen_is_averaged() {
        let (shading, _) = striped(1);
        let sphere = shading.sphere.unwrap();
        let nbar = vec2(0.1, -0.2);
        assert_eq!(sphere.light_at(128.0).at(nbar), sphere.light().at(nbar));
        let spread = |light: &SphereLight| {
            let row = (0..64).map(|i| light.at(vec2(0.0, i as f32 / 64.0 - 0.5))[0]);
            let row: Vec<f32> = row.collect();
            row.windows(2).map(|w| (w[0] - w[1]).abs()).sum::<f32>()
        };
        assert!(spread(sphere.light_at(16.0)) < 0.5 * spread(sphere.light()));
        assert_eq!(sphere.light_at(0.0).brightest(), sphere.light().brightest());
    }
}
