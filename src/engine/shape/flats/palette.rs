//! The colors of flats: one is all that an area shows, also where it is shaded, as long as nothing
//! in it is an edge. Floor 3. Not here: which share of a pixel a color takes (`shares`).

use super::areas::LEAST_SEEN;
use super::color_distance::{color_distance, is_near};
use super::picture::{FlatPicture, Pixel};
use crate::math::parallel;
use crate::raster::Plane;
use rayon::prelude::*;
use std::collections::{BTreeMap, HashMap};

/// The most shades of which colors are made.
const MOST_SHADES: usize = 256;
/// Neighboring pixels that differ by no more, in any channel of 8 bits, are shaded; others are an
/// edge.
const SOFT_STEP: u8 = 4;
/// Two shades lie on the two sides of so many pixels, or of one edge, px.
const ACROSS: usize = 3;
/// The share of a common border without an edge, from which two shades are one color.
const LEAST_SOFT: f32 = 0.3;
/// Shades no farther apart than this, in any channel of 8 bits, are one color if they lie mingled:
/// noise.
const MINGLED: u8 = 32;
/// The least length of their border, px for each pixel of the rarer one, from which two shades lie
/// mingled.
const LEAST_MINGLED: f32 = 0.5;
/// The share of a shade's pixels that have it all around, from which it covers areas and is no
/// noise.
const LEAST_SOLID: f32 = 0.05;

/// In a plane of colors: none is known.
pub const NONE: u16 = u16::MAX;
/// Nothing is painted.
pub const NOTHING: u16 = NONE - 1;

/// A color of flats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaletteColor {
    /// Its most frequent shade.
    pub color: Pixel,
    /// How many pixels of flat areas have it.
    pub pixels: usize,
    /// Whether it was asked for.
    pub is_asked: bool,
}

/// The colors of flats.
pub struct Palette {
    /// Those that were asked for, then the most frequent first.
    pub colors: Vec<PaletteColor>,
    /// The number of the color of each pixel in a flat area; [`NOTHING`], or [`NONE`] elsewhere.
    pub of: Plane<u16>,
}

impl Palette {
    /// `asked`: colors that are looked for however small their areas are, and never joined with
    /// each other.
    pub fn of(picture: &FlatPicture, asked: &[Pixel]) -> Self {
        let FlatPicture { pixels, is_flat, .. } = picture;
        let shades = shades(pixels, is_flat, asked);
        let of = shade_of_each(pixels, is_flat, &shades);
        let solid = solid(&of, shades.len());
        let joined = join_shades(&borders(pixels, &of), &shades, &solid, asked.len());
        // Shades of one color have the number of the first of them: it was asked for, or is the
        // most frequent.
        let mut firsts: Vec<usize> = joined.clone();
        firsts.sort_unstable();
        firsts.dedup();
        let color = |first: usize| {
            let own = || (0..shades.len()).filter(|shade| joined[*shade] == first);
            let pixels = own().map(|shade| shades[shade].1).sum();
            PaletteColor { color: shades[first].0, pixels, is_asked: first < asked.len() }
        };
        let all: Vec<PaletteColor> = firsts.iter().map(|first| color(*first)).collect();
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by_key(|i| {
            (!all[*i].is_asked, if all[*i].is_asked { 0 } else { usize::MAX - all[*i].pixels }, *i)
        });
        let mut number = vec![NONE; shades.len()];
        for (place, i) in order.iter().enumerate() {
            let own = (0..shades.len()).filter(|shade| joined[*shade] == firsts[*i]);
            own.for_each(|shade| number[shade] = place as u16);
        }
        let of = of.updated(|x, y, shade| match number.get(usize::from(shade)) {
            _ if picture.is_nothing(x, y) => NOTHING,
            number => number.copied().unwrap_or(NONE),
        });
        Self { colors: order.into_iter().map(|i| all[i]).collect(), of }
    }
}

/// The shades of flat areas with their pixels: those asked for, then the most frequent. Near ones
/// are one.
fn shades(pixels: &Plane<Pixel>, is_flat: &Plane<bool>, asked: &[Pixel]) -> Vec<(Pixel, usize)> {
    let width = pixels.width().max(1);
    let rows = pixels.values().par_chunks(width).zip(is_flat.values().par_chunks(width));
    let count = |mut counts: HashMap<Pixel, usize>, (row, is_flat): (&[Pixel], &[bool])| {
        let flat = row.iter().zip(is_flat).filter(|(pixel, is_flat)| **is_flat && pixel[3] == 255);
        flat.for_each(|(pixel, _)| *counts.entry(*pixel).or_default() += 1);
        counts
    };
    let both = |mut a: HashMap<Pixel, usize>, b: HashMap<Pixel, usize>| {
        b.into_iter().for_each(|(pixel, n)| *a.entry(pixel).or_default() += n);
        a
    };
    let counts: BTreeMap<Pixel, usize> =
        rows.fold(HashMap::new, count).reduce(HashMap::new, both).into_iter().collect();
    let mut by_count: Vec<(Pixel, usize)> = counts.into_iter().collect();
    by_count.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    let mut shades: Vec<(Pixel, usize)> = asked.iter().map(|color| (*color, 0)).collect();
    for (color, count) in by_count {
        match nearest(shades.iter().map(|(shade, _)| *shade), color) {
            Some(known) => shades[known].1 += count,
            None if shades.len() < asked.len() + MOST_SHADES => shades.push((color, count)),
            None => {}
        }
    }
    shades
}

/// The color nearest to a pixel of those that are near at all.
pub fn nearest(colors: impl Iterator<Item = Pixel>, pixel: Pixel) -> Option<usize> {
    let near = colors.enumerate().filter(|(_, color)| is_near(*color, pixel));
    near.min_by_key(|(i, color)| (color_distance(*color, pixel), *i)).map(|(i, _)| i)
}

fn shade_of_each(
    pixels: &Plane<Pixel>,
    is_flat: &Plane<bool>,
    shades: &[(Pixel, usize)],
) -> Plane<u16> {
    let mut of = Plane::full(pixels.size(), NONE);
    let width = pixels.width().max(1);
    parallel::for_each_row(of.values_mut(), width, 1, |y, row| {
        let mut last = ([0u8; 4], NONE);
        for ((of, pixel), is_flat) in row.iter_mut().zip(pixels.row(y)).zip(is_flat.row(y)) {
            if *is_flat {
                if last.0 != *pixel {
                    let shade = nearest(shades.iter().map(|(shade, _)| *shade), *pixel);
                    last = (*pixel, shade.map_or(NONE, |shade| shade as u16));
                }
                *of = last.1;
            }
        }
    });
    of
}

/// For each shade the first one that is the same color: shading leads from one to the other, and
/// no edge parts them, or it lies mingled with it.
///
/// * `solid`: how many pixels of each shade have it all around.
/// * `asked`: how many shades were asked for; they are never joined with each other.
fn join_shades(
    borders: &ShadeBorders,
    shades: &[(Pixel, usize)],
    solid: &[usize],
    asked: usize,
) -> Vec<usize> {
    let soft = borders.iter().filter(|(_, border)| {
        border.soft >= LEAST_SEEN && border.soft as f32 >= LEAST_SOFT * border.across as f32
    });
    let mut joins: Vec<(usize, usize, usize)> =
        soft.map(|((a, b), border)| (border.soft, usize::from(*a), usize::from(*b))).collect();
    // Noise has one color only; two areas are not joined by what lies between them.
    for shade in (asked..shades.len()).filter(|shade| !is_solid(solid[*shade], shades[*shade].1)) {
        let beside = borders.iter().filter_map(|((a, b), border)| {
            let (a, b) = (usize::from(*a), usize::from(*b));
            let other = if a == shade { b } else { a };
            let is_mingled = color_distance(shades[a].0, shades[b].0) <= MINGLED
                && border.beside as f32 >= LEAST_MINGLED * shades[shade].1 as f32;
            ((a == shade || b == shade) && other < shade && is_mingled)
                .then_some((border.beside, other))
        });
        joins.extend(
            beside
                .max_by_key(|(px, other)| (*px, usize::MAX - other))
                .map(|(px, other)| (px, other, shade)),
        );
    }
    joins.sort_by(|x, y| y.0.cmp(&x.0).then((x.1, x.2).cmp(&(y.1, y.2))));
    let mut first: Vec<usize> = (0..shades.len()).collect();
    for (_, a, b) in joins {
        let (a, b) = (first[a].min(first[b]), first[a].max(first[b]));
        // The lower number of two is the one that was asked for, if one was.
        if b >= asked {
            first.iter_mut().filter(|shade| **shade == b).for_each(|shade| *shade = a);
        }
    }
    first
}

fn is_solid(solid: usize, px: usize) -> bool {
    solid as f32 > LEAST_SOLID * px as f32
}

/// The border of two shades, px.
#[derive(Clone, Copy, Default)]
struct ShadeBorder {
    /// Where a few pixels lead from one to the other, and how much of that is without an edge.
    across: usize,
    soft: usize,
    /// Where they touch.
    beside: usize,
}

type ShadeBorders = BTreeMap<(u16, u16), ShadeBorder>;

fn borders(pixels: &Plane<Pixel>, of: &Plane<u16>) -> ShadeBorders {
    let add = |mut borders: ShadeBorders, y: usize| {
        for (x, (dx, dy)) in (0..of.width()).flat_map(|x| [(x, (1, 0)), (x, (0, 1))]) {
            let shade = |k: usize| {
                of.get((x + k * dx) as i32, (y + k * dy) as i32).filter(|shade| *shade != NONE)
            };
            let shades = |k: usize| {
                shade(0).zip(shade(k)).filter(|(a, b)| a != b).map(|(a, b)| (a.min(b), a.max(b)))
            };
            if let Some(pair) = shades(1) {
                borders.entry(pair).or_default().beside += 1;
            }
            if let Some(pair) = shades(ACROSS) {
                let at = |k: usize| pixels.at(x + k * dx, y + k * dy);
                let border = borders.entry(pair).or_default();
                border.across += 1;
                border.soft +=
                    usize::from((0..ACROSS).all(|k| color_distance(at(k), at(k + 1)) <= SOFT_STEP));
            }
        }
        borders
    };
    let both = |mut a: ShadeBorders, b: ShadeBorders| {
        for (pair, border) in b {
            let sum = a.entry(pair).or_default();
            *sum = ShadeBorder {
                across: sum.across + border.across,
                soft: sum.soft + border.soft,
                beside: sum.beside + border.beside,
            };
        }
        a
    };
    (0..of.height()).into_par_iter().fold(ShadeBorders::new, add).reduce(ShadeBorders::new, both)
}

/// How many pixels of each shade have it all around, px.
fn solid(of: &Plane<u16>, n: usize) -> Vec<usize> {
    let count = |mut counts: Vec<usize>, y: usize| {
        for x in 0..of.width() {
            let here = of.at(x, y);
            let like = |dx: i32, dy: i32| {
                of.get(x as i32 + dx, y as i32 + dy).is_none_or(|other| other == here)
            };
            if here != NONE && (-1..=1).all(|dy| (-1..=1).all(|dx| like(dx, dy))) {
                counts[usize::from(here)] += 1;
            }
        }
        counts
    };
    let both = |a: Vec<usize>, b: Vec<usize>| a.into_iter().zip(b).map(|(a, b)| a + b).collect();
    (0..of.height()).into_par_iter().fold(|| vec![0; n], count).reduce(|| vec![0; n], both)
}
