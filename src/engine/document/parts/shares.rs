//! Which share of each pixel a flat colour takes: all of a pixel in a flat area, and a part of those that were mixed at
//! edges between two areas. Shares add up to the whole pixel, so that areas that touch leave no rim between them.
//! Floor 4. Not here: which colours are parts (`flats`).

use super::near::{NEAR, is_near, share_on_the_way};
use crate::math::srgb::Color;
use crate::math::{Rect, Size};
use crate::raster::{Plane, TileGrid};

/// A pixel is mostly of a colour that takes this share of it.
pub const MOSTLY: u8 = 128;

/// Premultiplied.
pub type Pixel = [u8; 4];

/// How far from a mixed pixel the areas that it lies between are sought, px: edges are rarely blurred more.
pub const REACH: i32 = 3;
/// A pixel in a flat area has its colour in this many of its eight neighbours; along a straight edge two have it.
const LEAST_ALIKE: usize = 3;
/// A pixel farther than this from the line between two colours is no mixture of them, a sum of squares over the
/// channels.
const FARTHEST: i32 = (4 * NEAR) * (4 * NEAR);

/// The pixels of a flat picture.
pub struct Flats {
    pixels: Plane<Pixel>,
    /// Those in flat areas.
    is_flat: Plane<bool>,
}

impl Flats {
    /// The pixels of a rectangle.
    pub fn of(tiles: &TileGrid, rect: Rect) -> Self {
        let size = Size::new(rect.width() as u32, rect.height() as u32);
        let mut pixels = Plane::filled(size, [0u8; 4]);
        for y in 0..pixels.height() {
            for (x, pixel) in pixels.row_mut(y).iter_mut().enumerate() {
                *pixel = tiles.pixel(rect.x0 + x as i32, rect.y0 + y as i32);
            }
        }
        let is_flat = Plane::from_fn(size, |x, y| {
            let here = pixels.at(x, y);
            let alike =
                |&(dx, dy): &(i32, i32)| is_near(pixels.get(x as i32 + dx, y as i32 + dy).unwrap_or_default(), here);
            AROUND.iter().filter(|step| alike(step)).count() >= LEAST_ALIKE
        });
        let mut flats = Self { pixels, is_flat };
        flats.close_seams();
        flats
    }
    /// Whether a pixel lies in a flat area.
    pub fn is_flat(&self, x: usize, y: usize) -> bool {
        self.is_flat.at(x, y)
    }
    pub fn pixel(&self, x: usize, y: usize) -> Pixel {
        self.pixels.at(x, y)
    }
    /// Those in flat areas, row by row.
    pub fn flat_pixels(&self) -> impl Iterator<Item = Pixel> + '_ {
        let both = self.pixels.values().iter().zip(self.is_flat.values());
        both.filter(|(_, is_flat)| **is_flat).map(|(pixel, _)| *pixel)
    }
    /// The share of each pixel that a colour takes together with others, 255 the whole. A pixel that is not between any
    /// two areas, as in the thinnest lines, counts where it has the colour.
    pub fn share_of(&self, color: Color, with: &[Color]) -> Plane<u8> {
        let own = bytes(color);
        let all: Vec<Pixel> = std::iter::once(own).chain(with.iter().copied().map(bytes)).collect();
        let counts = |pixel: Pixel| all.iter().any(|color| is_near(pixel, *color));
        Plane::from_fn(self.pixels.size(), |x, y| {
            let here = self.pixels.at(x, y);
            if self.is_flat(x, y) {
                // Areas of the other colours are not its own.
                return if is_near(here, own) { 255 } else { 0 };
            }
            let Some((from, to, share)) = self.between(x, y) else {
                return if is_near(here, own) { 255 } else { 0 };
            };
            // The others lie over it only where it has a share itself.
            match is_near(from, own) || is_near(to, own) {
                true => u8::from(counts(from)) * (255 - share) + u8::from(counts(to)) * share,
                false => 0,
            }
        })
    }
    /// The two areas that a mixed pixel lies between, and the share of the second; `None` where it lies between none.
    fn between(&self, x: usize, y: usize) -> Option<(Pixel, Pixel, u8)> {
        let mut beside: Vec<Pixel> = Vec::new();
        for reach in 1..=REACH {
            for (dx, dy) in ring(reach) {
                let (x, y) = (x as i32 + dx, y as i32 + dy);
                // There is nothing beyond the picture.
                let (pixel, is_flat) = match self.pixels.get(x, y) {
                    Some(pixel) => (pixel, self.is_flat(x as usize, y as usize)),
                    None => ([0; 4], true),
                };
                if is_flat && !beside.iter().any(|known| is_near(*known, pixel)) {
                    beside.push(pixel);
                }
            }
            if let Some(found) = nearest_way(self.pixels.at(x, y), &beside) {
                return Some(found);
            }
        }
        None
    }
    /// Gives the pixels of a seam that two areas left open between them to the nearer one.
    fn close_seams(&mut self) {
        let (w, h) = (self.pixels.width() as i32, self.pixels.height() as i32);
        let mut closed: Vec<(usize, usize, Pixel)> = Vec::new();
        let side = |x: i32, y: i32, (dx, dy): (i32, i32)| {
            (1..=REACH).find_map(|k| {
                let (x, y) = (x + k * dx, y + k * dy);
                let pixel = self.pixels.get(x, y)?;
                (pixel[3] == 255 && self.is_flat(x as usize, y as usize)).then_some((k, pixel))
            })
        };
        for (x, y) in (0..h).flat_map(|y| (0..w).map(move |x| (x, y))) {
            if self.pixels.at(x as usize, y as usize)[3] == 255 {
                continue;
            }
            let across = |(dx, dy): (i32, i32)| {
                let ((a, one), (b, other)) = (side(x, y, (dx, dy))?, side(x, y, (-dx, -dy))?);
                // A gap within one area is intended.
                let is_seam = a + b <= REACH + 1 && !is_near(one, other);
                is_seam.then_some(if a <= b { one } else { other })
            };
            if let Some(pixel) = across((1, 0)).or_else(|| across((0, 1))) {
                closed.push((x as usize, y as usize, pixel));
            }
        }
        for (x, y, pixel) in closed {
            self.pixels.set(x, y, pixel);
            self.is_flat.set(x, y, true);
        }
    }
}

pub fn bytes(color: Color) -> Pixel {
    color.premultiplied().map(|v| (v * 255.0).round() as u8)
}

const AROUND: [(i32, i32); 8] = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];

/// The steps to the pixels of a square's border.
fn ring(reach: i32) -> impl Iterator<Item = (i32, i32)> {
    let all = (-reach..=reach).flat_map(move |dy| (-reach..=reach).map(move |dx| (dx, dy)));
    all.filter(move |(dx, dy): &(i32, i32)| dx.abs().max(dy.abs()) == reach)
}

/// The pair of colours whose mixture a pixel is, and the share of the second.
fn nearest_way(pixel: Pixel, colors: &[Pixel]) -> Option<(Pixel, Pixel, u8)> {
    let pairs = colors.iter().enumerate().flat_map(|(i, a)| colors[i + 1..].iter().map(move |b| (*a, *b)));
    let off = |(a, b): (Pixel, Pixel)| {
        let share = share_on_the_way(pixel, a, b);
        let mixed =
            |c: usize| (i32::from(a[c]) * (255 - i32::from(share)) + i32::from(b[c]) * i32::from(share) + 127) / 255;
        let off = (0..4).map(|c| (i32::from(pixel[c]) - mixed(c)).pow(2)).sum::<i32>();
        (off, a, b, share)
    };
    let (off, a, b, share) = pairs.map(off).min_by_key(|(off, ..)| *off)?;
    (off <= FARTHEST).then_some((a, b, share))
}

#[cfg(test)]
pub mod tests;
