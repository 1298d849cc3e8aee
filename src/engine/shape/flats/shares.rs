//! Which share of each pixel a flat color takes: all of a pixel in a flat area, and a part of
//! those that were mixed at edges between two areas. Shares add up to the whole pixel, so that
//! areas that touch leave no rim between them. Floor 3. Not here: which colors are parts
//! (`flats`).

use super::areas::{LEAST_SEEN, least_area, pixels, side_neighbors, walk};
use super::color_distance::is_near;
use super::complete::{Given, complete};
use super::ink::{color_pixels, lines};
use super::palette::{NONE, NOTHING, Palette, PaletteColor, nearest};
use super::picture::{Between, FlatPicture, FlatReading, MixedPixel};
use crate::math::Rect;
use crate::math::srgb::Color;
use crate::raster::{Plane, TileGrid};
use std::sync::Arc;

pub use super::picture::{MOSTLY, Pixel, REACH};

/// The most colors of one layer that become parts, besides those that are asked for; the largest
/// are chosen.
pub const MOST_COLORS: usize = 64;
/// Areas that are joined by nothing wider than this are separate places, px: the gap closing of the
/// fill.
const GAP_PX: f32 = 2.0;

/// What each pixel of a flat picture is of.
pub struct Flats {
    /// Those that were asked for, then the most frequent first.
    colors: Vec<PaletteColor>,
    /// The number of the color of each pixel; [`NOTHING`], or [`NONE`] where several share it or
    /// none is known.
    owner: Plane<u16>,
    /// The pixels that two areas share, row by row.
    mixed: Vec<MixedPixel>,
    /// Those of lines and specks, that are given to the areas beside them.
    is_given: Plane<bool>,
    gap_px: f32,
    /// Colors that are seen, but too small to be parts.
    left_out: usize,
    /// The share of what is painted that lies in flat areas of its colors.
    flat_share: f32,
}

/// What a pixel is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FlatOwner {
    /// A color, by its number.
    Color(u16),
    /// Nothing is painted there.
    Nothing,
    /// Several share it, or no flat color is known.
    Unknown,
}

impl Flats {
    /// The pixels of a rectangle, `None` if it holds none; `asked`: colors that are looked for
    /// however small their areas are.
    pub fn of(tiles: &TileGrid, rect: Rect, asked: &[Color]) -> Option<Self> {
        (!rect.is_empty()).then(|| Self::of_reading(&FlatReading::of(tiles, rect), asked))
    }

    /// The same of pixels that were read.
    pub fn of_reading(reading: &FlatReading, asked: &[Color]) -> Self {
        let WithoutLines { picture, mut colors, mut owner, between, is_line, lines } =
            WithoutLines::of(reading, asked);
        let in_areas =
            |owner: &Plane<u16>| owner.values().iter().filter(|of| **of < NOTHING).count();
        let of_lines = lines.values().iter().zip(owner.values());
        let of_lines = of_lines.filter(|(line, of)| **line < NOTHING && **of == NONE).count();
        if !picture.is_pixel_art {
            take_out_specks(&mut owner, &mut colors);
        }
        let is_kept = choose_flats(&colors, least_area(owner.size()));
        let is_seen = |i: usize| colors[i].pixels >= LEAST_SEEN && !is_line[i];
        let left_out = (0..colors.len()).filter(|i| !is_kept[*i] && is_seen(*i)).count();
        owner = renumber(owner, &is_kept);
        colors = (0..colors.len()).filter(|i| is_kept[*i]).map(|i| colors[i]).collect();
        let flat = in_areas(&owner) + of_lines;
        let painted = picture.pixels.values().iter().filter(|pixel| pixel[3] >= MOSTLY).count();
        let Given { is_given, mixed, nearest } = complete(&mut owner, &picture, &between);
        let gap_px = if picture.is_pixel_art { 0.0 } else { GAP_PX };
        let flat_share = flat as f32 / painted.max(1) as f32;
        let mut flats = Self { colors, owner, mixed, is_given, gap_px, left_out, flat_share };
        flats.add_mixed(&between, &nearest);
        flats
    }

    /// Adds the pixels between areas; `nearest`: the number of the nearest area of each pixel, one
    /// more.
    fn add_mixed(&mut self, between: &[Between], nearest: &Plane<u32>) {
        for &Between { index, sides, share } in between {
            let is_of_line = |side: &usize| self.is_given.values()[*side];
            let is_beside_line = sides.iter().flatten().any(is_of_line);
            let sides = sides.map(|side| match side {
                // A line is of the area that is nearest here; farther along it may be of another.
                Some(side) if is_of_line(&side) => {
                    nearest.values()[index].checked_sub(1).map_or(NONE, |of| of as u16)
                }
                Some(side) => self.owner.values()[side],
                None => NOTHING,
            });
            self.is_given.values_mut()[index] = is_beside_line;
            match sides[0] == sides[1] && sides[0] < NOTHING {
                true => self.owner.values_mut()[index] = sides[0],
                false => self.mixed.push(MixedPixel { index, sides, share }),
            }
        }
        self.mixed.sort_unstable_by_key(|mixed| mixed.index);
    }

    /// Its colors, by their numbers.
    pub fn colors(&self) -> Vec<Color> {
        self.colors
            .iter()
            .map(|PaletteColor { color: [r, g, b, a], .. }| Color { r: *r, g: *g, b: *b, a: *a })
            .collect()
    }

    /// The number of a color.
    pub fn number_of(&self, color: Color) -> Option<u16> {
        nearest(self.colors.iter().map(|color| color.color), bytes(color))
            .map(|number| number as u16)
    }

    /// How many colors are seen that are too small, or too many, to be parts.
    pub fn omitted_colors(&self) -> usize {
        self.left_out
    }

    /// The share of what is painted that lies in flat areas of its colors, `[0, 1]`.
    pub fn flat_share(&self) -> f32 {
        self.flat_share
    }

    /// Areas that are joined by nothing wider than this are separate places, px.
    pub fn gap_px(&self) -> f32 {
        self.gap_px
    }

    /// Whether a pixel is of a line or a speck that is given to the areas beside it.
    pub fn is_given(&self, x: usize, y: usize) -> bool {
        self.is_given.at(x, y)
    }

    /// What a pixel belongs to.
    pub fn owner(&self, x: usize, y: usize) -> FlatOwner {
        match self.owner.at(x, y) {
            NONE => FlatOwner::Unknown,
            NOTHING => FlatOwner::Nothing,
            number => FlatOwner::Color(number),
        }
    }

    /// The number of the color that takes the most of each pixel; [`NOTHING`] or [`NONE`].
    pub fn mostly(&self) -> Plane<u16> {
        let mut mostly = self.owner.clone();
        for MixedPixel { index, sides, share } in &self.mixed {
            mostly.values_mut()[*index] = sides[usize::from(*share >= MOSTLY)];
        }
        mostly
    }

    /// The share of each pixel that a color takes together with others, 255 the whole.
    pub fn share_of(&self, color: Color, with: &[Color]) -> Plane<u8> {
        let Some(own) = self.number_of(color) else { return Plane::full(self.owner.size(), 0) };
        let all: Vec<u16> = std::iter::once(own)
            .chain(with.iter().filter_map(|color| self.number_of(*color)))
            .collect();
        let mut shares = self.owner.map(|of| if of == own { 255 } else { 0 });
        // The others lie over it only where it has a share itself.
        for MixedPixel { index, sides: [from, to], share } in &self.mixed {
            if [from, to].contains(&&own) {
                let of = |side: &u16, share: u8| if all.contains(side) { share } else { 0 };
                shares.values_mut()[*index] = of(from, 255 - share) + of(to, *share);
            }
        }
        // In a line, areas need not share any pixel where they meet.
        let is_beneath = |x: usize, y: usize| {
            let is_others = self.is_given.at(x, y)
                && self.owner.at(x, y) != own
                && all.contains(&self.owner.at(x, y));
            let is_own = |x: usize, y: usize| self.owner.at(x, y) == own && self.is_given.at(x, y);
            is_others
                && side_neighbors((x, y), (shares.width(), shares.height()))
                    .any(|(x, y)| is_own(x, y))
        };
        match all.len() {
            1 => shares,
            _ => {
                Plane::from_fn(
                    shares.size(),
                    |x, y| if is_beneath(x, y) { 255 } else { shares.at(x, y) },
                )
            }
        }
    }
}

/// A picture of flats whose lines are told from its areas.
pub struct WithoutLines {
    /// Its pixels.
    pub picture: Arc<FlatPicture>,
    /// Those that were asked for, then the most frequent first.
    pub colors: Vec<PaletteColor>,
    /// The number of the color of each pixel in a flat area, as in [`Palette`]; [`NONE`] in lines.
    pub owner: Plane<u16>,
    /// Its mixed pixels, each with what it lies between.
    pub between: Arc<[Between]>,
    /// Which colors are mostly lines.
    pub is_line: Vec<bool>,
    /// The number of the color of each pixel that is mostly of a line; else [`NONE`].
    pub lines: Plane<u16>,
}

impl WithoutLines {
    /// Of pixels that were read; `asked`: as for [`Flats::of`].
    pub fn of(reading: &FlatReading, asked: &[Color]) -> Self {
        let FlatReading { picture, between } = reading.clone();
        let asked: Vec<Pixel> = asked.iter().copied().map(bytes).collect();
        let Palette { colors, of: mut owner } = Palette::of(&picture, &asked);
        for index in picture.of_thin_lines(&between) {
            let here = picture.pixels.values()[index];
            if let Some(number) = nearest(colors.iter().map(|color| color.color), here) {
                owner.values_mut()[index] = number as u16;
            }
        }
        let lines = Plane::full(owner.size(), NONE);
        let mut read = Self { picture, colors, owner, between, is_line: Vec::new(), lines };
        read.take_out_lines();
        read
    }

    /// The color of a pixel in a flat area: without the little of others that it may hold.
    pub fn flat_color(&self, index: usize) -> Pixel {
        let pixel = self.picture.pixels.values()[index];
        let color = self.colors.get(usize::from(self.owner.values()[index]));
        color.map(|color| color.color).filter(|color| is_near(pixel, *color)).unwrap_or(pixel)
    }

    /// Takes lines out of each color. One that was asked for keeps them if it is nothing else.
    fn take_out_lines(&mut self) {
        let mut mostly = self.owner.clone();
        for Between { index, sides, share } in self.between.iter() {
            let side = sides[usize::from(*share >= MOSTLY)];
            mostly.values_mut()[*index] = side.map_or(NOTHING, |side| self.owner.values()[side]);
        }
        let least = least_area(self.owner.size());
        let counts = color_pixels(&mostly, self.colors.len());
        let (owner, all_lines) = (&mut self.owner, &mut self.lines);
        let take_out = |(i, color): (usize, &mut PaletteColor)| {
            let Some(lines) = lines(&mostly, i as u16, counts[i]) else { return false };
            let is_own = |(x, y): &(usize, usize)| owner.at(*x, *y) == i as u16;
            let left = color.pixels.saturating_sub(lines.iter().filter(|at| is_own(at)).count());
            if color.is_asked && left < least {
                return false;
            }
            color.pixels = left;
            for (x, y) in lines {
                all_lines.set(x, y, i as u16);
                if owner.at(x, y) == i as u16 {
                    owner.set(x, y, NONE);
                }
            }
            true
        };
        self.is_line = self.colors.iter_mut().enumerate().map(take_out).collect();
    }
}

/// Takes out areas too small to be seen: compression leaves such specks. The pixels of each color
/// are counted again.
fn take_out_specks(owner: &mut Plane<u16>, colors: &mut [PaletteColor]) {
    let size = (owner.width(), owner.height());
    let mut seen = Plane::full(owner.size(), false);
    colors.iter_mut().for_each(|color| color.pixels = 0);
    for start in pixels(size) {
        let color = owner.at(start.0, start.1);
        if color >= NOTHING || seen.at(start.0, start.1) {
            continue;
        }
        let mut area = Vec::new();
        walk(start, size, |x, y| {
            let enters = owner.at(x, y) == color && !seen.at(x, y);
            if enters {
                seen.set(x, y, true);
                area.push((x, y));
            }
            enters
        });
        match area.len() < LEAST_SEEN {
            true => area.into_iter().for_each(|(x, y)| owner.set(x, y, NONE)),
            false => colors[usize::from(color)].pixels += area.len(),
        }
    }
}

/// Which colors are asked for, or large enough to be parts.
fn choose_flats(colors: &[PaletteColor], least: usize) -> Vec<bool> {
    let mut found: Vec<usize> =
        (0..colors.len()).filter(|i| !colors[*i].is_asked && colors[*i].pixels >= least).collect();
    found.sort_by_key(|i| (std::cmp::Reverse(colors[*i].pixels), *i));
    found.truncate(MOST_COLORS);
    (0..colors.len()).map(|i| colors[i].is_asked || found.contains(&i)).collect()
}

/// Without the colors that are not kept.
fn renumber(owner: Plane<u16>, is_kept: &[bool]) -> Plane<u16> {
    let mut next = 0;
    let number = is_kept.iter().map(|is_kept| {
        next += u16::from(*is_kept);
        if *is_kept { next - 1 } else { NONE }
    });
    let numbers: Vec<u16> = number.collect();
    owner.map(|of| if of < NOTHING { numbers[usize::from(of)] } else { of })
}

/// An opaque pixel of a color.
pub fn bytes(color: Color) -> Pixel {
    color.premultiplied().map(|v| (v * 255.0).round() as u8)
}
