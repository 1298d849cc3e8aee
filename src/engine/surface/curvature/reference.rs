//! The curvature tensor pixel by pixel, as MATH 4 writes it: what the fast version is tested against.

use super::{fade, slope, tensor};
use crate::math::Vec3;
use crate::raster::blur::half_kernel;
use crate::surface::{Surface, links};

/// The neighbour of a pixel in a direction, if it continues its surface.
fn step(surface: &Surface, (x, y): (usize, usize), bit: u8) -> Option<(usize, usize)> {
    (surface.links_plane().at(x, y) & bit != 0).then(|| match bit {
        links::LEFT => (x - 1, y),
        links::RIGHT => (x + 1, y),
        links::UP => (x, y - 1),
        _ => (x, y + 1),
    })
}

/// Σ_k w_k value(k steps away) in two opposite directions, as far as the links go.
fn along(
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
            let Some(next) = step(surface, here, bit) else { break };
            here = next;
            sum += w * value(here);
        }
    }
    sum
}

/// The slope of the blurred normals at a pixel.
fn slope_at(surface: &Surface, at: (usize, usize), taps: &[f32]) -> (f32, f32) {
    let [nx, ny, nz] = surface.normal_planes();
    let normal = |(x, y): (usize, usize)| Vec3::new(nx.at(x, y), ny.at(x, y), nz.at(x, y));
    let across = |at| along(surface, at, [links::LEFT, links::RIGHT], taps, &normal);
    let n = along(surface, at, [links::UP, links::DOWN], taps, &across);
    slope(n.x, n.y, n.z)
}

/// `[h_xx, h_xy, h_yy]` and the fade of a pixel.
pub fn tensor_at(surface: &Surface, x: usize, y: usize, blur_px: f32) -> ([f32; 3], u8) {
    let taps = half_kernel(blur_px);
    // Central where both neighbours continue the surface, one-sided where one does, none where neither.
    let difference = |back: u8, forth: u8| {
        let ends = [back, forth].map(|bit| step(surface, (x, y), bit));
        let steps = ends.iter().flatten().count().max(1) as f32;
        let [a, b] = ends.map(|end| slope_at(surface, end.unwrap_or((x, y)), &taps));
        ((b.0 - a.0) / steps, (b.1 - a.1) / steps)
    };
    let h = tensor(difference(links::LEFT, links::RIGHT), difference(links::UP, links::DOWN));
    (h, fade_at(surface, x, y))
}

fn fade_at(surface: &Surface, x: usize, y: usize) -> u8 {
    let (w, h) = (surface.size().width as usize, surface.size().height as usize);
    let squared = |i: usize, j: usize| (i.abs_diff(x).pow(2) + j.abs_diff(y).pow(2)) as u32;
    let near = |c: usize, n: usize| c.saturating_sub(fade::FADE_PX)..(c + fade::FADE_PX + 1).min(n);
    let breaks =
        near(y, h).flat_map(|j| near(x, w).map(move |i| (i, j))).filter(|&(i, j)| fade::is_break(surface, i, j));
    fade::fade_at(breaks.map(|(i, j)| squared(i, j)).min().unwrap_or(u32::MAX))
}
