//! Parts of a layer of flat colours: one for each colour, ordered by who interrupts whose outline.
//! Floor 4.

use super::outlines::is_near;
use super::shares::Flats;
use super::{Inflation, OutlineSource, Part, PartKind};
use crate::math::Rect;
use crate::math::srgb::Color;
use crate::raster::{Plane, TileGrid};
use std::collections::BTreeMap;

/// Colours of one layer that become parts; the largest.
const MOST_COLOURS: usize = 64;
/// A colour that covers less than this part of the picture is no part: leftovers of edges.
const LEAST_SHARE: f32 = 2e-4;
/// How far around a common border areas are compared, a part of the longer side.
const LOOKED_AROUND: f32 = 0.02;

/// The parts of the flats in a layer called `layer`, the farthest first.
pub fn parts_of_flats(tiles: &TileGrid, layer: &str, inflation: Inflation) -> Vec<Part> {
    let rect = tiles.bounds();
    let colors = colors_of(tiles, rect);
    let flats = Flats::of(tiles, rect);
    let areas: Vec<Plane<u8>> = colors.iter().map(|color| flats.share_of(*color, &[])).collect();
    let order = farthest_first(&areas);
    let part = |(place, index): (usize, usize)| {
        let outline = OutlineSource::Layer { layer: layer.into(), color: Some(colors[index]) };
        let id = format!("part-{}", place + 1);
        Part { name: format!("Part {}", place + 1), ..Part::new(id, PartKind::Inflate { outline, inflation }) }
    };
    order.into_iter().enumerate().map(part).collect()
}

/// The opaque flat colours of a picture, the most frequent first.
pub fn colors_of(tiles: &TileGrid, rect: Rect) -> Vec<Color> {
    let mut counts: BTreeMap<[u8; 4], usize> = BTreeMap::new();
    // Straight edges hold long rows of one mixed colour.
    for pixel in Flats::of(tiles, rect).flat_pixels().filter(|pixel| pixel[3] == 255) {
        *counts.entry(pixel).or_default() += 1;
    }
    let mut by_count: Vec<([u8; 4], usize)> = counts.into_iter().collect();
    by_count.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    let mut groups: Vec<([u8; 4], usize)> = Vec::new();
    for (color, count) in by_count {
        match groups.iter().position(|(known, _)| is_near(*known, color)) {
            Some(known) => groups[known].1 += count,
            None if groups.len() < 4 * MOST_COLOURS => groups.push((color, count)),
            None => {}
        }
    }
    let least = ((rect.width() * rect.height()) as f32 * LEAST_SHARE).max(16.0) as usize;
    groups.retain(|(_, count)| *count >= least);
    groups.truncate(MOST_COLOURS);
    groups.into_iter().filter_map(|([r, g, b, _], _)| Color::parse(&format!("#{r:02x}{g:02x}{b:02x}"))).collect()
}

/// The places of areas in a list, those in front last.
///
/// Of two that share a border the one whose side of it bulges interrupts the outline of the other: around the border it
/// has the smaller part of the neighbourhood. The clearest decisions count most: the farthest is always the one that
/// least stands in front of what is left.
pub fn farthest_first(areas: &[Plane<u8>]) -> Vec<usize> {
    let n = areas.len();
    let Some(size) = areas.first().map(|area| area.size()) else { return Vec::new() };
    let radius = (LOOKED_AROUND * size.longer_side()).max(2.0) as usize;
    let shares: Vec<Plane<f32>> = areas.iter().map(|area| share_around(area, radius)).collect();
    let owner =
        Plane::from_fn(size, |x, y| areas.iter().position(|area| area.at(x, y) >= 128).map_or(u32::MAX, |i| i as u32));
    // in_front[a][b]: how clearly a lies in front of b.
    let mut in_front = vec![vec![0.0f64; n]; n];
    for (x, y) in (0..owner.height()).flat_map(|y| (0..owner.width()).map(move |x| (x, y))) {
        for (dx, dy) in [(1, 0), (0, 1), (2, 0), (0, 2)] {
            let (a, Some(b)) = (owner.at(x, y), owner.get((x + dx) as i32, (y + dy) as i32)) else { continue };
            if a != b && a != u32::MAX && b != u32::MAX {
                let (a, b) = (a as usize, b as usize);
                let bulge = f64::from(shares[b].at(x, y) - shares[a].at(x, y));
                in_front[a][b] += bulge;
                in_front[b][a] -= bulge;
            }
        }
    }
    let mut left: Vec<usize> = (0..n).collect();
    let mut order = Vec::with_capacity(n);
    while !left.is_empty() {
        let score = |a: usize| left.iter().map(|b| in_front[a][*b]).sum::<f64>();
        let first = (0..left.len()).min_by(|a, b| score(left[*a]).total_cmp(&score(left[*b]))).unwrap_or(0);
        order.push(left.remove(first));
    }
    order
}

/// The share of an area in a square around each pixel, `[0, 1]`: running sums along rows, then columns.
fn share_around(area: &Plane<u8>, radius: usize) -> Plane<f32> {
    let (w, h) = (area.width(), area.height());
    let window = |values: &dyn Fn(usize) -> f32, n: usize| -> Vec<f32> {
        let mut sums = vec![0.0f64; n + 1];
        (0..n).for_each(|i| sums[i + 1] = sums[i] + f64::from(values(i)));
        let side = (2 * radius + 1) as f64;
        (0..n).map(|i| ((sums[(i + radius + 1).min(n)] - sums[i.saturating_sub(radius)]) / side) as f32).collect()
    };
    let mut rows = Plane::filled(area.size(), 0.0f32);
    for y in 0..h {
        rows.row_mut(y).copy_from_slice(&window(&|x| f32::from(area.at(x, y)) / 255.0, w));
    }
    let mut out = Plane::filled(area.size(), 0.0f32);
    for x in 0..w {
        window(&|y| rows.at(x, y), h).into_iter().enumerate().for_each(|(y, v)| out.set(x, y, v));
    }
    out
}
