//! Fades curvature out near the ends of a surface, where it would show false outlines.
//! Floor 2.

use super::tiles::{TileRect, all_linked};
use crate::surface::{Surface, links};

/// Distance from the nearest break, in pixels, from which curvature counts in full.
pub(super) const FADE_PX: usize = 3;

/// Whether the surface ends between the pixel and a neighbour: a depth jump or the mask's edge.
///
/// The canvas border does not count as an end. Nor does an isolated pixel without links, which would show as a dot.
#[inline(always)]
pub(super) fn is_break(surface: &Surface, x: usize, y: usize) -> bool {
    let links = surface.links_plane().at(x, y);
    links != 15 && ends_beside(surface, links, x as i32, y as i32)
}

fn ends_beside(surface: &Surface, links: u8, x: i32, y: i32) -> bool {
    let stray =
        |x: i32, y: i32| surface.links_plane().get(x, y) == Some(0) && surface.coverage_plane().get(x, y) > Some(0);
    let on_canvas = |x: i32, y: i32| surface.size().rect().contains(x, y);
    let beside = [(links::LEFT, x - 1, y), (links::RIGHT, x + 1, y), (links::UP, x, y - 1), (links::DOWN, x, y + 1)];
    !stray(x, y) && beside.iter().any(|&(bit, x, y)| links & bit == 0 && on_canvas(x, y) && !stray(x, y))
}

/// 0 at a break, rising smoothly to 255 at [`FADE_PX`] from it. `squared`: squared distance, px².
pub(super) fn fade_at(squared: u32) -> u8 {
    let t = ((squared as f32).sqrt() / FADE_PX as f32).min(1.0);
    crate::math::srgb::quantise(t * t * (3.0 - 2.0 * t))
}

/// Fills the tile's part of a band of rows.
pub(super) fn fill(surface: &Surface, tile: TileRect, band: &mut [u8]) {
    let (width, height) = (surface.size().width as usize, surface.size().height as usize);
    let fades: [u8; FADE_PX * FADE_PX + 1] = std::array::from_fn(|d| fade_at(d as u32));
    let top = tile.y0.saturating_sub(FADE_PX);
    let rows = top..(tile.y0 + tile.rows + FADE_PX).min(height);
    let along: Vec<Option<Vec<u8>>> = rows.clone().map(|y| along_row(surface, tile, y)).collect();
    let mut squared = vec![0u8; tile.cols];
    for y in 0..tile.rows {
        let out = &mut band[y * width + tile.x0..][..tile.cols];
        let here = tile.y0 + y;
        let near = here.saturating_sub(FADE_PX)..(here + FADE_PX + 1).min(rows.end);
        if near.clone().all(|r| along[r - top].is_none()) {
            out.fill(255);
            continue;
        }
        squared.fill((FADE_PX * FADE_PX) as u8);
        for r in near {
            if let Some(along) = &along[r - top] {
                nearer(along, (r.abs_diff(here).pow(2)) as u8, &mut squared);
            }
        }
        for (out, &d) in out.iter_mut().zip(&squared) {
            *out = fades[usize::from(d)];
        }
    }
}

crate::widest! {
    /// Distances along a row from 0 at breaks, at most [`FADE_PX`]; `breaks` is [`FADE_PX`] longer at both ends.
    fn spread(breaks: &[u8], distance: &mut [u8]) {
        let n = distance.len();
        distance.copy_from_slice(&breaks[FADE_PX..FADE_PX + n]);
        for k in 1..FADE_PX {
            let (back, forth) = (&breaks[FADE_PX - k..][..n], &breaks[FADE_PX + k..][..n]);
            for i in 0..n {
                distance[i] = distance[i].min(k as u8 + back[i].min(forth[i]));
            }
        }
    }

    /// Lowers squared distances to those through a row `dy_squared` away.
    fn nearer(along: &[u8], dy_squared: u8, squared: &mut [u8]) {
        for (s, &d) in squared.iter_mut().zip(along) {
            *s = (*s).min(d * d + dy_squared);
        }
    }
}

/// For each pixel of a tile's row the distance along the row to the nearest break, at most [`FADE_PX`]; `None` where
/// there is no break that near.
fn along_row(surface: &Surface, tile: TileRect, y: usize) -> Option<Vec<u8>> {
    let from = tile.x0.saturating_sub(FADE_PX);
    let to = (tile.x0 + tile.cols + FADE_PX).min(surface.size().width as usize);
    if all_linked(&surface.links_plane().row(y)[from..to]) {
        return None;
    }
    // Both ends are padded with three pixels without a break, so that every pixel is handled alike.
    let mut breaks = vec![FADE_PX as u8; tile.cols + 2 * FADE_PX];
    for x in (from..to).filter(|&x| is_break(surface, x, y)) {
        breaks[x + FADE_PX - tile.x0] = 0;
    }
    let mut distance = vec![0; tile.cols];
    spread(&breaks, &mut distance);
    Some(distance)
}
