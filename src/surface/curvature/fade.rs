//! Where curvature fades: no outline of false curvature may show where a surface ends.
//! Floor 2.

use super::tiles::{TileRect, Whole};
use crate::surface::{Surface, links};

/// Distance from the nearest break, in pixels, from which curvature counts in full.
pub(super) const FADE_PX: usize = 3;

/// Whether the surface ends between the pixel and a neighbour: a depth jump or the mask's edge. The canvas's border is none.
#[inline(always)]
pub(super) fn is_break(surface: &Surface, x: usize, y: usize) -> bool {
    let (w, h) = (surface.size().width as usize, surface.size().height as usize);
    let border = |at: bool, bit: u8| if at { bit } else { 0 };
    let beyond = border(x == 0, links::LEFT)
        | border(x + 1 == w, links::RIGHT)
        | border(y == 0, links::UP)
        | border(y + 1 == h, links::DOWN);
    surface.coverage(x, y) == 0 || (surface.links_plane().at(x, y) | beyond) != 15
}

/// 0 at a break, rising smoothly to 1 at [`FADE_PX`] from it. `squared`: squared distance, px².
pub(super) fn fade_at(squared: u32) -> f32 {
    let t = ((squared as f32).sqrt() / FADE_PX as f32).min(1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Fills the tile's part of a band of rows.
pub(super) fn fill(surface: &Surface, tile: TileRect, whole: Whole, band: &mut [f32]) {
    let width = surface.size().width as usize;
    let row_of = |y: usize| y * width + tile.x0..y * width + tile.x0 + tile.cols;
    if whole == Whole::Yes {
        (0..tile.rows).for_each(|y| band[row_of(y)].fill(1.0));
        return;
    }
    let fades: [f32; FADE_PX * FADE_PX + 1] = std::array::from_fn(|d| fade_at(d as u32));
    let top = tile.y0.saturating_sub(FADE_PX);
    let bottom = (tile.y0 + tile.rows + FADE_PX).min(surface.size().height as usize);
    let along: Vec<Vec<u8>> = (top..bottom).map(|y| along_row(surface, tile, y)).collect();
    for y in 0..tile.rows {
        let here = tile.y0 + y;
        let rows = here.saturating_sub(FADE_PX)..(here + FADE_PX + 1).min(bottom);
        for (x, out) in band[row_of(y)].iter_mut().enumerate() {
            let squared = rows.clone().map(|r| {
                let (dx, dy) = (usize::from(along[r - top][x]), r.abs_diff(here));
                dx * dx + dy * dy
            });
            *out = fades[squared.min().unwrap_or(0).min(FADE_PX * FADE_PX)];
        }
    }
}

/// For each pixel of a tile's row the distance along the row to the nearest break, at most [`FADE_PX`].
fn along_row(surface: &Surface, tile: TileRect, y: usize) -> Vec<u8> {
    let from = tile.x0.saturating_sub(FADE_PX);
    let to = (tile.x0 + tile.cols + FADE_PX).min(surface.size().width as usize);
    let mut distance: Vec<u8> = (from..to).map(|x| if is_break(surface, x, y) { 0 } else { FADE_PX as u8 }).collect();
    for i in 1..distance.len() {
        distance[i] = distance[i].min(distance[i - 1] + 1);
    }
    for i in (1..distance.len()).rev() {
        distance[i - 1] = distance[i - 1].min(distance[i] + 1);
    }
    distance[tile.x0 - from..tile.x0 - from + tile.cols].to_vec()
}
