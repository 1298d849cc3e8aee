//! Parts of a layer of flat colors: one for each color, or for each area of one, ordered by who
//! interrupts whose outline. Floor 4. Not here: what the colors are (`palette`, `shares`), and
//! their order (`order`).

use super::order::farthest_first;
use super::{FlatColor, Inflation, OutlineSource, Part, PartKind};
use crate::math::srgb::Color;
use crate::math::{Rect, vec2};
use crate::raster::{Plane, TileGrid};
use crate::shape::flats::area_names::area_names;
use crate::shape::flats::areas::{LEAST_SHARE, spread};
use crate::shape::flats::color_areas::ColorAreas;
use crate::shape::flats::palette::NOTHING;
use crate::shape::flats::shares::Flats;

pub use crate::shape::flats::shares::MOST_COLORS;

/// From this share of a figure in flat areas on, its colors are worth a part each: shaded paint
/// has few pixels of any one color.
pub const LEAST_FLAT: f32 = 0.7;

/// What becomes a part of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PartFor {
    /// All that a layer covers.
    #[default]
    Layer,
    /// Each flat color of it.
    Color,
    /// Each area of a flat color that is apart from the others of that color.
    Area,
}

/// The parts of flats.
#[derive(Default)]
pub struct FlatParts {
    /// The farthest first.
    pub parts: Vec<Part>,
    /// Colors, or areas of them, that are seen but too small or too many to be parts.
    pub left_out: usize,
    /// The share of what is painted that lies in flat areas, `[0, 1]`.
    pub flat_share: f32,
}

impl FlatParts {
    /// One part that is made of no colors.
    pub fn of_one(part: Part) -> Self {
        Self { parts: vec![part], left_out: 0, flat_share: 1.0 }
    }

    /// What the user is told about colors without a part.
    pub fn note(&self) -> Option<String> {
        if self.flat_share < LEAST_FLAT {
            let share = (self.flat_share * 100.0).floor();
            return Some(format!(
                "Only {share} % of it is in flat colors, so the parts follow these alone: one part for all of it may \
                 be better."
            ));
        }
        let areas = match self.left_out {
            0 => return None,
            1 => "One area is".into(),
            n => format!("{n} areas are"),
        };
        let least = LEAST_SHARE * 100.0;
        Some(format!(
            "{areas} left without a part: a part covers at least {least} % of the picture, and \
             there are at most {MOST_COLORS} parts."
        ))
    }
}

/// The parts of the flats in a layer called `layer`, a part for each color or each area.
///
/// `tiles`: what the layer shows on the canvas. Nothing makes no parts.
pub fn parts_of_flats(
    tiles: &TileGrid,
    layer: &str,
    inflation: Inflation,
    each: PartFor,
) -> FlatParts {
    let rect = tiles.bounds();
    let Some(flats) = Flats::of(tiles, rect, &[]) else { return FlatParts::default() };
    let FlatAreas { of, labels, left_out } = match each {
        PartFor::Area => areas(&flats, rect),
        _ => {
            let of = flats.colors().into_iter().map(FlatColor::from).collect();
            FlatAreas { of, labels: flats.mostly(), left_out: flats.omitted_colors() }
        }
    };
    let order = farthest_first(&labels, of.len());
    let colors: Vec<Color> = of.iter().map(|flat| flat.color).collect();
    let names = area_names(&colors, &labels);
    let part = |(position, index): (usize, usize)| {
        let outline = OutlineSource::Layer { layer: layer.into(), color: Some(of[index]) };
        let id = format!("part-{}", position + 1);
        Part {
            name: names[index].clone(),
            ..Part::new(id, PartKind::Inflate { outline, inflation })
        }
    };
    let parts = order.into_iter().enumerate().map(part).collect();
    FlatParts { parts, left_out, flat_share: flats.flat_share() }
}

/// The areas that become parts.
struct FlatAreas {
    of: Vec<FlatColor>,
    /// The number of the area of each pixel.
    labels: Plane<u16>,
    left_out: usize,
}

/// The areas of all colors, a color that has only one without its point.
fn areas(flats: &Flats, rect: Rect) -> FlatAreas {
    let corner = vec2(rect.x0 as f32, rect.y0 as f32);
    let mut left_out = flats.omitted_colors();
    let mut all = Vec::new();
    let mostly = flats.mostly();
    let mut labels = Plane::full(mostly.size(), 0u32);
    for color in flats.colors() {
        let found = ColorAreas::of(flats, color);
        let large = found.large();
        left_out += found.small();
        for area in &large {
            all.push((
                found.pixels(*area),
                FlatColor { color, at: Some(corner + found.middle(*area)) },
            ));
            found.mark(*area, &mut labels, all.len() as u32);
        }
    }
    let mut largest: Vec<usize> = (0..all.len()).collect();
    largest.sort_by_key(|i| (std::cmp::Reverse(all[*i].0), *i));
    left_out += largest.len().saturating_sub(MOST_COLORS);
    largest.truncate(MOST_COLORS);
    largest.sort_unstable();
    // What is too small for a part does not keep two areas from meeting.
    let mut number = vec![0u32; all.len() + 1];
    largest.iter().zip(1..).for_each(|(i, new)| number[*i + 1] = new);
    labels = labels.map(|label| number[label as usize]);
    spread(&mut labels, |x, y| mostly.at(x, y) != NOTHING);
    let is_alone =
        |i: usize| all.iter().filter(|(_, other)| other.color == all[i].1.color).count() == 1;
    let of = largest
        .into_iter()
        .map(|i| if is_alone(i) { all[i].1.color.into() } else { all[i].1 })
        .collect();
    FlatAreas {
        of,
        labels: labels.map(|label| (label as u16).wrapping_sub(1).min(NOTHING)),
        left_out,
    }
}

#[cfg(test)]
pub mod tests;
