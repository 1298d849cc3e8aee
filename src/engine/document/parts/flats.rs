//! Parts of a layer of flat colours: one for each colour, or for each place of one, ordered by who interrupts whose
//! outline. Floor 4.

use super::near::is_near;
use super::places::{ColorPlaces, LEAST_SEEN, LEAST_SHARE, least_area, spread};
use super::shares::{Flats, MOSTLY};
use super::{FlatColor, Inflation, OutlineSource, Part, PartKind};
use crate::math::srgb::Color;
use crate::math::{Rect, Size, vec2};
use crate::raster::{Plane, TileGrid};
use std::collections::BTreeMap;

/// The most colours or places of one layer that become parts; the largest are chosen.
pub const MOST_COLOURS: usize = 64;
/// How far around a common border areas are compared, as a share of the longer side.
const LOOKED_AROUND: f32 = 0.02;

/// What becomes a part of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PartFor {
    /// All that a layer covers.
    #[default]
    Layer,
    /// Each flat colour of it.
    Color,
    /// Each area of a flat colour that is apart from the others of that colour.
    Place,
}

/// The parts of flats.
#[derive(Default)]
pub struct FlatParts {
    /// The farthest first.
    pub parts: Vec<Part>,
    /// Colours, or places of them, that are seen but too small or too many to be parts.
    pub left_out: usize,
}

impl FlatParts {
    /// What the user is told about colours without a part.
    pub fn note(&self) -> Option<String> {
        let areas = match self.left_out {
            0 => return None,
            1 => "One area is".into(),
            n => format!("{n} areas are"),
        };
        let least = LEAST_SHARE * 100.0;
        Some(format!(
            "{areas} left without a part: a part covers at least {least} % of the picture, and at most {MOST_COLOURS} \
             are made."
        ))
    }
}

/// The parts of the flats in a layer called `layer`, a part for each colour or each place.
///
/// `tiles`: what the layer shows on the canvas.
pub fn parts_of_flats(tiles: &TileGrid, layer: &str, inflation: Inflation, each: PartFor) -> FlatParts {
    let rect = tiles.bounds();
    let flats = Flats::of(tiles, rect);
    let Palette { colors, mut left_out } = palette_of(tiles, rect);
    let (found, mut areas): (Vec<FlatColor>, Vec<Plane<u8>>) = match each {
        PartFor::Place => places(&flats, &colors, rect, &mut left_out).into_iter().unzip(),
        _ => colors.iter().map(|color| (FlatColor::from(*color), flats.share_of(*color, &[]))).unzip(),
    };
    complete(&mut areas, &flats);
    let order = farthest_first(&areas);
    let part = |(place, index): (usize, usize)| {
        let outline = OutlineSource::Layer { layer: layer.into(), color: Some(found[index]) };
        let id = format!("part-{}", place + 1);
        Part { name: format!("Part {}", place + 1), ..Part::new(id, PartKind::Inflate { outline, inflation }) }
    };
    FlatParts { parts: order.into_iter().enumerate().map(part).collect(), left_out }
}

/// Gives areas what is painted beside them and makes no part, such as a glint in a pupil: it does not keep two areas
/// from meeting.
fn complete(areas: &mut [Plane<u8>], flats: &Flats) {
    let Some(size) = areas.first().map(Plane::size) else { return };
    let owner = |x: usize, y: usize| areas.iter().position(|area| area.at(x, y) >= MOSTLY);
    let mut labels = Plane::from_fn(size, |x, y| owner(x, y).map_or(0, |i| i as u32 + 1));
    let is_painted = |x: usize, y: usize| flats.pixel(x, y)[3] == 255;
    spread(&mut labels, is_painted);
    for (x, y) in (0..labels.height()).flat_map(|y| (0..labels.width()).map(move |x| (x, y))) {
        let Some(nearest) = (labels.at(x, y) as usize).checked_sub(1).filter(|_| is_painted(x, y)) else { continue };
        let others = areas.iter().map(|area| u32::from(area.at(x, y))).sum::<u32>();
        let rest = 255u32.saturating_sub(others) as u8;
        areas[nearest].set(x, y, areas[nearest].at(x, y).saturating_add(rest));
    }
}

/// The places of some colours, a colour that has only one without its point, and the share of each in each pixel.
fn places(flats: &Flats, colors: &[Color], rect: Rect, left_out: &mut usize) -> Vec<(FlatColor, Plane<u8>)> {
    let found: Vec<ColorPlaces> = colors.iter().map(|color| ColorPlaces::of(flats, *color)).collect();
    let of_color = |(i, places): (usize, &ColorPlaces)| -> Vec<_> {
        places.large().into_iter().map(|place| (std::cmp::Reverse(places.pixels(place)), i, place)).collect()
    };
    let mut all: Vec<_> = found.iter().enumerate().flat_map(of_color).collect();
    all.sort();
    *left_out += found.iter().map(ColorPlaces::small).sum::<usize>() + all.len().saturating_sub(MOST_COLOURS);
    all.truncate(MOST_COLOURS);
    let corner = vec2(rect.x0 as f32, rect.y0 as f32);
    let mut out = Vec::with_capacity(all.len());
    for (i, color) in colors.iter().enumerate() {
        let own: Vec<u32> = all.iter().filter(|(_, of, _)| *of == i).map(|(_, _, place)| *place).collect();
        let share = flats.share_of(*color, &[]);
        if found[i].large().len() == 1 && own.len() == 1 {
            out.push((FlatColor::from(*color), share));
            continue;
        }
        let at = own.iter().map(|place| FlatColor { color: *color, at: Some(corner + found[i].middle(*place)) });
        out.extend(at.zip(found[i].shares(&own, &share)));
    }
    out
}

/// The opaque flat colours of a picture, the most frequent first.
pub fn colors_of(tiles: &TileGrid, rect: Rect) -> Vec<Color> {
    palette_of(tiles, rect).colors
}

struct Palette {
    colors: Vec<Color>,
    /// Others that are seen.
    left_out: usize,
}

fn palette_of(tiles: &TileGrid, rect: Rect) -> Palette {
    let mut counts: BTreeMap<[u8; 4], usize> = BTreeMap::new();
    // Straight edges contain long rows of one mixed colour.
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
    let least = least_area(Size::new(rect.width() as u32, rect.height() as u32));
    let seen = groups.iter().filter(|(_, count)| *count >= LEAST_SEEN).count();
    groups.retain(|(_, count)| *count >= least);
    groups.truncate(MOST_COLOURS);
    let left_out = seen.saturating_sub(groups.len());
    let colors = groups.into_iter().map(|([r, g, b, a], _)| Color { r, g, b, a });
    Palette { colors: colors.collect(), left_out }
}

/// The places of areas in a list, those in front last.
///
/// An area that meets nothing but one other lies in front of it, and is as much as a mark on it to all others. What
/// each pixel of another common border says about the two areas is added up (`in_front_by`). The clearest decisions
/// count most: the next farthest is always the area that is least in front of the remaining ones.
pub fn farthest_first(areas: &[Plane<u8>]) -> Vec<usize> {
    let n = areas.len();
    let Some(size) = areas.first().map(|area| area.size()) else { return Vec::new() };
    let radius = (LOOKED_AROUND * size.longer_side()).max(2.0) as usize;
    let mut shares: Vec<Plane<f32>> = areas.iter().map(|area| share_around(area, radius)).collect();
    let mostly = |x: usize, y: usize| areas.iter().position(|area| area.at(x, y) >= MOSTLY);
    let owner = Plane::from_fn(size, |x, y| mostly(x, y).map_or(u32::MAX, |i| i as u32));
    // in_front[a][b]: how clearly a lies in front of b.
    let mut in_front = vec![vec![0.0f64; n]; n];
    let islands = islands(&owner, n);
    for &Island { area, within, border_px } in &islands {
        in_front[area][within] = border_px as f64;
        in_front[within][area] = -(border_px as f64);
        shares[within] = Plane::from_fn(size, |x, y| shares[within].at(x, y) + shares[area].at(x, y));
    }
    let is_known =
        |a: usize, b: usize| islands.iter().any(|island| [(a, b), (b, a)].contains(&(island.area, island.within)));
    for (x, y) in (0..owner.height()).flat_map(|y| (0..owner.width()).map(move |x| (x, y))) {
        for (dx, dy) in [(1, 0), (0, 1), (2, 0), (0, 2)] {
            let (a, beside) = (owner.at(x, y), (x + dx, y + dy));
            let Some(b) = owner.get(beside.0 as i32, beside.1 as i32) else { continue };
            let is_border = a != b && a != u32::MAX && b != u32::MAX;
            if is_border && !is_known(a as usize, b as usize) {
                let (a, b) = (a as usize, b as usize);
                // Measured on the border itself: each of the two pixels lies on one side of it.
                let share = |of: usize| 0.5 * (shares[of].at(x, y) + shares[of].at(beside.0, beside.1));
                let clearly = f64::from(in_front_by(share(a), share(b)));
                in_front[a][b] += clearly;
                in_front[b][a] -= clearly;
            }
        }
    }
    let mut left: Vec<usize> = (0..n).collect();
    let mut order = Vec::with_capacity(n);
    while !left.is_empty() {
        // What lies over an area says nothing about what the area lies over.
        let over = |a: usize| left.iter().map(|b| in_front[a][*b].max(0.0)).sum::<f64>();
        let first = (0..left.len()).min_by(|a, b| over(left[*a]).total_cmp(&over(left[*b]))).unwrap_or(0);
        order.push(left.remove(first));
    }
    order
}

/// An area all around which is another.
struct Island {
    area: usize,
    within: usize,
    border_px: usize,
}

/// The areas that meet only one other, islands in them aside; what is in an island comes before it.
fn islands(owner: &Plane<u32>, n: usize) -> Vec<Island> {
    /// A mixed pixel may belong to a third, or to none.
    const ALL: f32 = 0.95;
    // px that each area has in common with each other, and with none.
    let mut borders = vec![vec![0usize; n + 1]; n];
    let of = |x: i32, y: i32| owner.get(x, y).map_or(n, |owner| (owner as usize).min(n));
    for (x, y) in (0..owner.height() as i32).flat_map(|y| (0..owner.width() as i32).map(move |x| (x, y))) {
        for (x1, y1) in [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)] {
            let (a, b) = (of(x, y), of(x1, y1));
            if a != b && a < n {
                borders[a][b] += 1;
            }
        }
    }
    let mut found: Vec<Island> = Vec::new();
    loop {
        let island = |area: usize| {
            if found.iter().any(|island| island.area == area) {
                return None;
            }
            let is_left = |other: usize| !found.iter().any(|island| island.area == other && island.within == area);
            let left = || (0..=n).filter(|other| is_left(*other));
            let within = left().max_by_key(|other| borders[area][*other]).filter(|other| *other < n)?;
            let (border_px, all) = (borders[area][within], left().map(|other| borders[area][other]).sum::<usize>());
            (border_px as f32 >= ALL * all as f32 && border_px > 0).then_some(Island { area, within, border_px })
        };
        match (0..n).find_map(island) {
            Some(next) => found.push(next),
            None => return found,
        }
    }
}

/// How clearly an area lies in front of another at a pixel of their border, from their shares of the neighbourhood;
/// below 0 it lies behind.
///
/// * With only the two, the one whose side bulges lies in front: it has the smaller share.
/// * Where a third meets them, the outline of the one in front continues, so that it has half of the neighbourhood; the
///   others end at it. If that is the third, nothing is known about the two.
fn in_front_by(own: f32, other: f32) -> f32 {
    const ALONE: f32 = 0.98;
    const HALF: std::ops::RangeInclusive<f32> = 0.4..=0.6;
    if own + other >= ALONE {
        other - own
    } else if HALF.contains(&own.max(other)) {
        own - other
    } else {
        0.0
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Discs (middle and radius), the last in front of the others, as the visible area of each.
    fn seen(discs: &[([f32; 2], f32)], scale: f32) -> Vec<Plane<u8>> {
        let size = Size::new((320.0 * scale) as u32, (400.0 * scale) as u32);
        let holds = |disc: &([f32; 2], f32), x: usize, y: usize| {
            vec2(x as f32 + 0.5, y as f32 + 0.5).distance(vec2(disc.0[0], disc.0[1]) * scale) < disc.1 * scale
        };
        let front = |x, y| discs.iter().rposition(|disc| holds(disc, x, y));
        (0..discs.len()).map(|i| Plane::from_fn(size, |x, y| if front(x, y) == Some(i) { 255 } else { 0 })).collect()
    }

    #[test]
    fn who_interrupts_the_outline_of_another_lies_in_front() {
        let (head, body, hand) = (([160.0, 120.0], 80.0), ([160.0, 260.0], 110.0), ([250.0, 200.0], 30.0));
        for scale in [0.5, 1.0, 2.0] {
            assert_eq!(farthest_first(&seen(&[body, head], scale)), [0, 1], "the head over the body, {scale}");
            assert_eq!(farthest_first(&seen(&[head, body], scale)), [0, 1], "the body over the head, {scale}");
            assert_eq!(farthest_first(&seen(&[body, head, hand], scale)), [0, 1, 2], "a hand over both, {scale}");
            assert_eq!(farthest_first(&seen(&[head, body, hand], scale)), [0, 1, 2], "and the other way, {scale}");
        }
    }
}
