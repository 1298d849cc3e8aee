//! The curvature tensor pixel by pixel, as MATH 4 writes it: what the fast version is tested
//! against.

use super::{rims, slope, tensor};
use crate::math::Vec3;
use crate::raster::blur::half_kernel;
use crate::surface::contours::mean_of;
use crate::surface::{Surface, links};

/// The neighbor of a pixel in a direction, if it continues its surface.
fn step(surface: &Surface, (x, y): (usize, usize), bit: u8) -> Option<(usize, usize)> {
    (surface.links_plane().at(x, y) & bit != 0).then(|| match bit {
        links::LEFT => (x - 1, y),
        links::RIGHT => (x + 1, y),
        links::UP => (x, y - 1),
        _ => (x, y + 1),
    })
}

fn is_at_border(surface: &Surface, (x, y): (usize, usize), bit: u8) -> bool {
    let size = surface.size();
    match bit {
        links::LEFT => x == 0,
        links::RIGHT => x + 1 == size.width as usize,
        links::UP => y == 0,
        _ => y + 1 == size.height as usize,
    }
}

/// Σ_k w_k value(k steps away) in two opposite directions, as far as the links go and the last
/// value on.
fn weigh_along_links(
    surface: &Surface,
    at: (usize, usize),
    bits: [u8; 2],
    taps: &[f32],
    value: &dyn Fn((usize, usize)) -> Vec3,
) -> Vec3 {
    let mut sum = taps[0] * value(at);
    for bit in bits {
        let mut here = at;
        for &w in &taps[1..] {
            // Beyond an end the last value is repeated, beyond the canvas's border there is none.
            here = match step(surface, here, bit) {
                Some(next) => next,
                None if is_at_border(surface, here, bit) => break,
                None => here,
            };
            sum += w * value(here);
        }
    }
    sum
}

/// The slope of the blurred normals at a pixel.
fn slope_at(surface: &Surface, at: (usize, usize), taps: &[f32]) -> (f32, f32) {
    let [nx, ny, nz] = surface.normal_planes();
    let normal = |(x, y): (usize, usize)| Vec3::new(nx.at(x, y), ny.at(x, y), nz.at(x, y));
    let across = |at| weigh_along_links(surface, at, [links::LEFT, links::RIGHT], taps, &normal);
    let n = weigh_along_links(surface, at, [links::UP, links::DOWN], taps, &across);
    slope(n.x, n.y, n.z)
}

/// `[h_xx, h_xy, h_yy]` of a pixel; at an end of the surface the mean of nearby ones that have all
/// their neighbors.
pub fn tensor_at(surface: &Surface, x: usize, y: usize, blur_px: f32) -> [f32; 3] {
    match rims::members(surface, x as i32, y as i32) {
        Some(members) if members != 0 => [0, 1, 2].map(|i| {
            mean_of(members, (x as i32, y as i32), |x, y| differentiate(surface, x, y, blur_px)[i])
        }),
        _ => differentiate(surface, x, y, blur_px),
    }
}

fn differentiate(surface: &Surface, x: usize, y: usize, blur_px: f32) -> [f32; 3] {
    let taps = half_kernel(blur_px);
    // Central where both neighbors continue the surface, one-sided where one does, none where
    // neither.
    let difference = |back: u8, forth: u8| {
        let ends = [back, forth].map(|bit| step(surface, (x, y), bit));
        let steps = ends.iter().flatten().count().max(1) as f32;
        let [a, b] = ends.map(|end| slope_at(surface, end.unwrap_or((x, y)), &taps));
        ((b.0 - a.0) / steps, (b.1 - a.1) / steps)
    };
    tensor(difference(links::LEFT, links::RIGHT), difference(links::UP, links::DOWN))
}
