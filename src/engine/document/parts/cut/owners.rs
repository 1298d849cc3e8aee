//! Which part each pixel of a drawing belongs to. Floor 4.

use crate::math::{Rect, Size};
use crate::raster::{Plane, TileGrid};
use crate::shape::Outline;
use crate::shape::flats::areas::spread;
use crate::shape::flats::picture::{MOSTLY, Pixel};
use std::sync::Arc;

/// No part.
pub const NO_PART: u16 = u16::MAX;

/// The outline of a part, and the flat color that it has in the drawing, if it is of one.
pub struct PieceOutline {
    pub outline: Arc<Outline>,
    pub color: Option<Pixel>,
}

/// The pixels of a drawing, and the parts at each, by their numbers: the farthest is 0.
pub struct Cut {
    pub rect: Rect,
    pub drawn: Plane<Pixel>,
    pub outlines: Vec<PieceOutline>,
    /// The nearest part that covers some of a pixel, and the next beneath it; or [`NO_PART`].
    pub nearest: Plane<[u16; 2]>,
    /// The part that a pixel belongs to, one more; 0 where there is none.
    pub owner: Plane<u32>,
}

impl Cut {
    pub fn of(tiles: &TileGrid, outlines: Vec<PieceOutline>) -> Self {
        let rect = tiles.bounds();
        let size = Size::new(rect.width() as u32, rect.height() as u32);
        let drawn =
            Plane::from_fn(size, |x, y| tiles.pixel(rect.x0 + x as i32, rect.y0 + y as i32));
        let (nearest, owner) = (Plane::full(size, [NO_PART; 2]), Plane::full(size, 0));
        let mut cut = Self { rect, drawn, outlines, nearest, owner };
        cut.nearest = Plane::from_fn(size, |x, y| {
            let mut covering =
                (0..cut.outlines.len() as u16).rev().filter(|part| cut.coverage(*part, x, y) > 0);
            std::array::from_fn(|_| covering.next().unwrap_or(NO_PART))
        });
        let mut owner = Plane::from_fn(size, |x, y| {
            let [first, second] = cut.nearest.at(x, y);
            let of = match first {
                _ if first == NO_PART || cut.drawn.at(x, y)[3] == 0 => return 0,
                _ if second == NO_PART || cut.coverage(first, x, y) >= MOSTLY => first,
                // Where three meet, neither takes most of it.
                _ if cut.coverage(second, x, y) > cut.coverage(first, x, y) => second,
                _ => first,
            };
            u32::from(of) + 1
        });
        spread(&mut owner, |x, y| cut.drawn.at(x, y)[3] > 0);
        cut.owner = owner;
        cut
    }

    /// The share of a pixel that a part covers.
    pub fn coverage(&self, part: u16, x: usize, y: usize) -> u8 {
        let outline = &self.outlines[usize::from(part)].outline;
        let (x0, y0) = outline.corner();
        outline
            .coverage()
            .get(x as i32 + self.rect.x0 - x0, y as i32 + self.rect.y0 - y0)
            .unwrap_or(0)
    }
}
