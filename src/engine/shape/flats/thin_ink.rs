//! Lines so thin that hardly a pixel of them has their own tone: no flat area shows it, so it is
//! sought in the pixels that no mixture of flats explains. Floor 3. Not here: lines whose tone is a
//! color of the flats (`ink`).

use super::areas::{LEAST_SEEN, pixels, spread};
use super::color_distance::share_on_the_way;
use super::ink::{color_pixels, lines};
use super::palette::{NONE, NOTHING, PaletteColor, nearest};
use super::picture::{MOSTLY, Pixel};
use super::shares::WithoutLines;
use crate::raster::Plane;
use std::collections::{BTreeMap, VecDeque};

/// The most tones of thin lines in one drawing, and of how many shades they are chosen.
const MOST_TONES: usize = 16;
const MOST_SHADES: usize = 64;
/// A tone must be seen pure in so many pixels.
const LEAST_PURE: usize = 4;
/// Tones are compared on about so many pixels: a line shows its tone all along.
const COMPARED: usize = 8192;
/// A line goes on where its tone takes this share of a pixel, of 255.
const GOES_ON: u8 = 32;

impl WithoutLines {
    /// With thin lines among its lines, and what is left of others where they become thin.
    pub fn with_thin_lines(mut self) -> Self {
        let unknown = Unknown::of(&self);
        if unknown.indices.is_empty() {
            return self;
        }
        self.go_on(&unknown);
        let mut left: Vec<usize> =
            unknown.indices.iter().copied().filter(|i| self.lines.values()[*i] == NONE).collect();
        for _ in 0..MOST_TONES {
            let Some(tone) = unknown.tone(&self, &left) else { break };
            self.add_lines_of(&unknown, &left, tone);
            left.retain(|i| unknown.share(&self, *i, tone) == 0);
        }
        self.go_on(&unknown);
        self
    }

    /// Adds what is a line in a tone, of some pixels.
    fn add_lines_of(&mut self, unknown: &Unknown, left: &[usize], tone: Pixel) {
        let own: Vec<usize> =
            left.iter().copied().filter(|i| unknown.share(self, *i, tone) >= MOSTLY).collect();
        let lines_of = |number: usize| {
            let mut of = unknown.mostly.clone();
            own.iter().for_each(|i| of.values_mut()[*i] = number as u16);
            let count = color_pixels(&of, number + 1).pop().unwrap_or_default();
            Some((number, lines(&of, number as u16, count)?))
        };
        // Some of them may show it all the same; but where it is also the color of areas, those
        // would hide that it is a line here.
        let known = nearest(self.colors.iter().map(|color| color.color), tone);
        let found = known.and_then(lines_of).or_else(|| lines_of(self.colors.len()));
        let Some((number, found)) = found else { return };
        if number == self.colors.len() {
            self.colors.push(PaletteColor { color: tone, pixels: 0, is_asked: false });
            self.is_line.push(true);
        }
        for (x, y) in found {
            self.lines.set(x, y, number as u16);
            if self.owner.at(x, y) == number as u16 {
                self.owner.set(x, y, NONE);
            }
        }
    }

    /// Lets lines go on into pixels beside them that hold their tone.
    fn go_on(&mut self, unknown: &Unknown) {
        let (width, height) = (self.lines.width(), self.lines.height());
        let mut ahead: VecDeque<(usize, usize)> =
            pixels((width, height)).filter(|(x, y)| self.lines.at(*x, *y) != NONE).collect();
        while let Some((x, y)) = ahead.pop_front() {
            let line = self.lines.at(x, y);
            let tone = self.colors[usize::from(line)].color;
            for (x, y) in neighbors((x, y), (width, height)) {
                let index = y * width + x;
                let goes_on = unknown.is_unknown.at(x, y)
                    && self.lines.at(x, y) == NONE
                    && unknown.share(self, index, tone) >= GOES_ON;
                if goes_on {
                    self.lines.set(x, y, line);
                    ahead.push_back((x, y));
                }
            }
        }
    }
}

/// The pixels next to one, side by side before corner to corner.
fn neighbors(
    (x, y): (usize, usize),
    (width, height): (usize, usize),
) -> impl Iterator<Item = (usize, usize)> {
    const STEPS: [(isize, isize); 8] =
        [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1)];
    let to = STEPS
        .into_iter()
        .map(move |(dx, dy)| (x.wrapping_add_signed(dx), y.wrapping_add_signed(dy)));
    to.filter(move |(x, y)| *x < width && *y < height)
}

/// The pixels that are painted for the most part, in no flat area and between none.
struct Unknown {
    is_unknown: Plane<bool>,
    /// Row by row.
    indices: Vec<usize>,
    /// The nearest pixel of a flat area, by its index, one more.
    flat: Plane<u32>,
    /// The number of the color that takes the most of each pixel.
    mostly: Plane<u16>,
}

impl Unknown {
    fn of(read: &WithoutLines) -> Self {
        let WithoutLines { picture, owner, lines, .. } = read;
        let mut is_unknown = Plane::from_fn(owner.size(), |x, y| {
            picture.pixels.at(x, y)[3] >= MOSTLY && owner.at(x, y) == NONE
        });
        read.between.iter().for_each(|between| is_unknown.values_mut()[between.index] = false);
        let width = owner.width();
        let is_area = |x: usize, y: usize| lines.at(x, y) == NONE && owner.at(x, y) != NONE;
        let mut flat = Plane::from_fn(owner.size(), |x, y| {
            if is_area(x, y) { (y * width + x) as u32 + 1 } else { 0 }
        });
        spread(&mut flat, |_, _| true);
        let indices: Vec<usize> =
            (0..owner.values().len()).filter(|i| is_unknown.values()[*i]).collect();
        let mostly = Plane::from_fn(owner.size(), |x, y| match lines.at(x, y) {
            NONE => flat.at(x, y).checked_sub(1).map_or(NOTHING, |i| owner.values()[i as usize]),
            line => line,
        });
        Self { is_unknown, indices, flat, mostly }
    }

    /// How much of a pixel a tone takes over the areas around it, of 255; 0 if it is no mixture of
    /// them.
    fn share(&self, read: &WithoutLines, index: usize, tone: Pixel) -> u8 {
        let (x, y) = ((index % self.flat.width()) as i32, (index / self.flat.width()) as i32);
        let flats =
            [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)].into_iter().filter_map(|(dx, dy)| {
                let flat = self.flat.get(x + dx, y + dy)?.checked_sub(1)?;
                Some(read.flat_color(flat as usize))
            });
        let here = read.picture.pixels.values()[index];
        flats.map(|flat| share_on_the_way(here, flat, tone)).max().unwrap_or(0)
    }

    /// The tone of which most of some pixels are mixtures with what is around them.
    fn tone(&self, read: &WithoutLines, left: &[usize]) -> Option<Pixel> {
        let mut counts: BTreeMap<Pixel, usize> = BTreeMap::new();
        for index in left {
            *counts.entry(read.picture.pixels.values()[*index]).or_default() += 1;
        }
        let mut by_count: Vec<(Pixel, usize)> = counts.into_iter().collect();
        by_count.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
        let mut shades: Vec<(Pixel, usize)> = Vec::new();
        for (color, count) in by_count {
            match nearest(shades.iter().map(|(shade, _)| *shade), color) {
                Some(known) => shades[known].1 += count,
                None if shades.len() < MOST_SHADES => shades.push((color, count)),
                None => {}
            }
        }
        let step = left.len().div_ceil(COMPARED).max(1);
        let explained = |tone: Pixel| {
            left.iter().step_by(step).filter(|i| self.share(read, **i, tone) > 0).count() * step
        };
        let tones = shades.iter().filter(|(_, count)| *count >= LEAST_PURE);
        let (most, _, tone) = tones
            .map(|(tone, count)| (explained(*tone), *count, *tone))
            .max_by_key(|(explained, count, tone)| (*explained, *count, *tone))?;
        (most >= LEAST_SEEN).then_some(tone)
    }
}
