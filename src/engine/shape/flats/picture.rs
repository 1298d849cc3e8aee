//! A picture of flats as it was painted: its flat areas, and between which of them each mixed pixel
//! lies. Floor 3.

use super::color_distance::{NEAR, is_near, share_on_the_way};
use crate::math::{Rect, Size, parallel};
use crate::raster::{Plane, TileGrid};
use std::sync::Arc;

/// Premultiplied.
pub type Pixel = [u8; 4];

/// A pixel is mostly of a color that takes this share of it.
pub const MOSTLY: u8 = 128;
/// How far from a mixed pixel the areas that it lies between are sought, px: edges are rarely
/// blurred more.
pub const REACH: i32 = 3;
/// A pixel in a flat area has its color in this many of its eight neighbors; along a straight
/// edge two have it.
const LEAST_ALIKE: usize = 3;
/// One in the thinnest line has it in so many.
const LEAST_ALIKE_ALONG: usize = 2;
/// A pixel farther than this from the line between two colors is no mixture of them, a sum of
/// squares over the channels.
const FARTHEST: i32 = (4 * NEAR) * (4 * NEAR);
/// The longest side of pixel art, px, in which every pixel is meant.
const PIXEL_ART_PX: u32 = 256;

/// The pixels of a flat picture.
pub struct FlatPicture {
    /// Its pixels, straight.
    pub pixels: Plane<Pixel>,
    /// Those in flat areas.
    pub is_flat: Plane<bool>,
    /// A small picture without soft edges: no gap in it is an accident.
    pub is_pixel_art: bool,
}

/// What is found in a picture of flats, whatever colors are asked for.
#[derive(Clone)]
pub struct FlatReading {
    /// Its pixels.
    pub picture: Arc<FlatPicture>,
    /// The mixed pixels that lie between two areas, row by row.
    pub between: Arc<[Between]>,
}

impl FlatReading {
    /// The pixels of a rectangle.
    pub fn of(tiles: &TileGrid, rect: Rect) -> Self {
        let picture = FlatPicture::of(tiles, rect);
        let between = picture.mixed_pixels().into();
        Self { picture: Arc::new(picture), between }
    }
}

/// The two areas that a mixed pixel lies between.
pub struct Between {
    /// Which color it is.
    pub index: usize,
    /// A pixel of each; `None` beyond the picture.
    pub sides: [Option<usize>; 2],
    /// The share of the second, 255 the whole.
    pub share: u8,
}

/// A pixel that two areas share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MixedPixel {
    /// In the plane.
    pub index: usize,
    /// The numbers of their colors, or what a palette has for none.
    pub sides: [u16; 2],
    /// The share of the second, 255 the whole.
    pub share: u8,
}

impl FlatPicture {
    /// The pixels of a rectangle.
    pub fn of(tiles: &TileGrid, rect: Rect) -> Self {
        let size = Size::new(rect.width() as u32, rect.height() as u32);
        let pixels: Plane<Pixel> =
            Plane::from_fn(size, |x, y| tiles.pixel(rect.x0 + x as i32, rect.y0 + y as i32));
        let is_flat = Plane::from_fn(size, |x, y| alike(&pixels, x, y) >= LEAST_ALIKE);
        let is_hard = || pixels.values().iter().all(|pixel| [0, 255].contains(&pixel[3]));
        let is_pixel_art = size.width.max(size.height) <= PIXEL_ART_PX && is_hard();
        let mut picture = Self { pixels, is_flat, is_pixel_art };
        if !is_pixel_art {
            picture.close_seams();
        }
        picture
    }

    /// Whether nothing is painted at a pixel.
    pub fn is_nothing(&self, x: usize, y: usize) -> bool {
        let here = self.pixels.at(x, y);
        here[3] == 0 || (self.is_flat.at(x, y) && is_near(here, [0; 4]))
    }

    /// The mixed pixels that lie between two areas, row by row.
    pub fn mixed_pixels(&self) -> Vec<Between> {
        let row = |y: usize| {
            let mixed = (0..self.pixels.width()).filter(move |x| !self.is_flat.at(*x, y));
            mixed.filter_map(move |x| self.mixed_pixel(x, y)).collect::<Vec<_>>()
        };
        let rows: Vec<Vec<Between>> = parallel::collect(self.pixels.height(), 1, row);
        rows.into_iter().flatten().collect()
    }

    /// The pixels of the thinnest lines: opaque, in no flat area, and between none.
    pub fn of_thin_lines(&self, between: &[Between]) -> Vec<usize> {
        let mut known = between.iter().map(|between| between.index).peekable();
        let width = self.pixels.width();
        let is_line = |i: &usize| {
            let (x, y) = (i % width, i / width);
            self.pixels.at(x, y)[3] == 255 && alike(&self.pixels, x, y) >= LEAST_ALIKE_ALONG
        };
        let mixed = self
            .is_flat
            .values()
            .iter()
            .enumerate()
            .filter(|(_, is_flat)| !**is_flat)
            .map(|(i, _)| i);
        mixed.filter(|i| known.next_if_eq(i).is_none()).filter(is_line).collect()
    }

    fn mixed_pixel(&self, x: usize, y: usize) -> Option<Between> {
        let width = self.pixels.width();
        let mut beside: Vec<(Pixel, Option<usize>)> = Vec::new();
        for reach in 1..=REACH {
            for (dx, dy) in ring(reach) {
                let (x, y) = (x as i32 + dx, y as i32 + dy);
                // There is nothing beyond the picture.
                let (pixel, index) = match self.pixels.get(x, y) {
                    Some(_) if !self.is_flat.at(x as usize, y as usize) => continue,
                    Some(pixel) => (pixel, Some(y as usize * width + x as usize)),
                    None => ([0; 4], None),
                };
                if !beside.iter().any(|(known, _)| is_near(*known, pixel)) {
                    beside.push((pixel, index));
                }
            }
            if let Some((one, other, share)) = nearest_way(self.pixels.at(x, y), &beside) {
                let sides = [beside[one].1, beside[other].1];
                return Some(Between { index: y * width + x, sides, share });
            }
        }
        None
    }

    /// Gives the pixels of a seam that two areas left open between them to the nearer one.
    fn close_seams(&mut self) {
        let side = |x: i32, y: i32, (dx, dy): (i32, i32)| {
            (1..=REACH).find_map(|k| {
                let (x, y) = (x + k * dx, y + k * dy);
                let pixel = self.pixels.get(x, y)?;
                (pixel[3] == 255 && self.is_flat.at(x as usize, y as usize)).then_some((k, pixel))
            })
        };
        let closed = |x: i32, y: i32| {
            let across = |(dx, dy): (i32, i32)| {
                let ((a, one), (b, other)) = (side(x, y, (dx, dy))?, side(x, y, (-dx, -dy))?);
                // A gap within one area is intended.
                let is_seam = a + b <= REACH + 1 && !is_near(one, other);
                is_seam.then_some(if a <= b { one } else { other })
            };
            across((1, 0)).or_else(|| across((0, 1)))
        };
        let pixels = &self.pixels;
        let row = |y: usize| {
            let open = (0..pixels.width()).filter(|x| pixels.at(*x, y)[3] < 255);
            open.filter_map(|x| Some((x, y, closed(x as i32, y as i32)?))).collect::<Vec<_>>()
        };
        let closed: Vec<Vec<(usize, usize, Pixel)>> = parallel::collect(pixels.height(), 1, row);
        for (x, y, pixel) in closed.into_iter().flatten() {
            self.pixels.set(x, y, pixel);
            self.is_flat.set(x, y, true);
        }
    }
}

const AROUND: [(i32, i32); 8] =
    [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];

/// How many of a pixel's neighbors have its color.
fn alike(pixels: &Plane<Pixel>, x: usize, y: usize) -> usize {
    let here = pixels.at(x, y);
    let beside =
        |&(dx, dy): &(i32, i32)| pixels.get(x as i32 + dx, y as i32 + dy).unwrap_or_default();
    AROUND.iter().filter(|step| is_near(beside(step), here)).count()
}

/// The steps to the pixels of a square's border, the nearest first.
fn ring(reach: i32) -> impl Iterator<Item = (i32, i32)> {
    let along = (0..=reach).flat_map(move |k| [-k, k].into_iter().take(if k == 0 { 1 } else { 2 }));
    along.flat_map(move |k| {
        let sides = [(-reach, k), (reach, k), (k, -reach), (k, reach)];
        sides.into_iter().take(if k.abs() == reach { 2 } else { 4 })
    })
}

/// The pair of colors whose mixture a pixel is, and the share of the second.
fn nearest_way(pixel: Pixel, colors: &[(Pixel, Option<usize>)]) -> Option<(usize, usize, u8)> {
    let pairs = (0..colors.len()).flat_map(|i| (i + 1..colors.len()).map(move |j| (i, j)));
    let off = |(i, j): (usize, usize)| {
        let (a, b) = (colors[i].0, colors[j].0);
        let share = share_on_the_way(pixel, a, b);
        let mixed = |c: usize| {
            (i32::from(a[c]) * (255 - i32::from(share)) + i32::from(b[c]) * i32::from(share) + 127)
                / 255
        };
        let off = (0..4).map(|c| (i32::from(pixel[c]) - mixed(c)).pow(2)).sum::<i32>();
        (off, i, j, share)
    };
    let (off, i, j, share) = pairs.map(off).min_by_key(|(off, ..)| *off)?;
    (off <= FARTHEST).then_some((i, j, share))
}
