//! What each part carries of a drawing. Floor 4.

use super::super::areas::spread;
use super::super::picture::Pixel;
use super::lines::{CutLines, added};
use super::owners::{Cut, NO_PART};
use crate::math::Rect;
use crate::raster::{Plane, Tile, TileAt, TileGrid};
use std::sync::Arc;

/// Nothing of a pixel.
const OUT: Pixel = [0; 4];

/// The colour of the nearest part so far.
#[derive(Clone, Copy, Default)]
struct ColorBeneath {
    color: Pixel,
    part: u16,
}

impl Cut {
    /// What each part carries, and what belongs to none.
    pub fn pieces(&self) -> (Vec<TileGrid>, TileGrid) {
        let size = self.drawn.size();
        let lines = CutLines::of(self);
        let mut beneath = Plane::filled(size, ColorBeneath::default());
        let mut pieces = Vec::with_capacity(self.outlines.len());
        for part in 0..self.outlines.len() as u16 {
            let own = self.own_colors(part, &lines);
            let piece = Plane::from_fn(size, |x, y| match lines.taker(x, y) {
                Some(taker) if taker == part => lines.over(self, (x, y), beneath.at(x, y).color),
                Some(taker) if taker < part => OUT,
                Some(_) => own.at(x, y),
                None => self.pixel(part, (x, y), own.at(x, y), beneath.at(x, y)),
            });
            beneath = beneath.updated(|x, y, under| match own.at(x, y) {
                [.., 0] => under,
                color => ColorBeneath { color, part },
            });
            pieces.push(tiles_of(&piece, self.rect));
        }
        let rest = Plane::from_fn(size, |x, y| if self.owner.at(x, y) == 0 { self.drawn.at(x, y) } else { OUT });
        (pieces, tiles_of(&rest, self.rect))
    }
    /// A pixel of a part's piece; `own`: the part's colour there.
    fn pixel(&self, part: u16, (x, y): (usize, usize), own: Pixel, beneath: ColorBeneath) -> Pixel {
        let (drawn, is_own) = (self.drawn.at(x, y), self.owner.at(x, y) == u32::from(part) + 1);
        let [first, second] = self.nearest.at(x, y);
        // At the figure's own edge, and where no part is, there is nothing to share.
        if drawn[3] < 255 || first == NO_PART || second == NO_PART {
            return if is_own { drawn } else { OUT };
        }
        let covered = self.coverage(first, x, y);
        let behind = if part == first { Some(beneath.color).filter(|_| beneath.part == second) } else { Some(own) };
        let over = behind.filter(|behind| behind[3] == 255).and_then(|behind| added(drawn, covered, behind));
        match over {
            _ if part != first && part != second => own,
            Some(over) if part == first => over,
            Some(_) => own,
            None if is_own => drawn,
            None if part == first || self.owner.at(x, y) != u32::from(first) + 1 => OUT,
            None => own,
        }
    }
    /// The colour of a part wherever it covers something: at its edges that of its nearest pixel that shows nothing
    /// else, and beneath others that of its nearest one without lines.
    fn own_colors(&self, part: u16, lines: &CutLines) -> Plane<Pixel> {
        let is_pure = |x: usize, y: usize| {
            let is_seen = self.nearest.at(x, y)[0] == part && self.coverage(part, x, y) == 255;
            is_seen && self.drawn.at(x, y)[3] == 255 && lines.taker(x, y).is_none()
        };
        let pure = self.nearest_where(part, is_pure);
        let plain = self.nearest_where(part, |x, y| is_pure(x, y) && lines.is_far(x, y));
        pure.updated(|x, y, pure| {
            let first = self.nearest.at(x, y)[0];
            let is_beneath = first != part && first != NO_PART && self.coverage(first, x, y) == 255;
            let is_plain = is_beneath || lines.taker(x, y).is_some();
            if is_plain && plain.at(x, y)[3] > 0 { plain.at(x, y) } else { pure }
        })
    }
    /// The colour of the nearest pixel that counts, wherever a part covers something.
    fn nearest_where(&self, part: u16, counts: impl Fn(usize, usize) -> bool + Sync) -> Plane<Pixel> {
        let width = self.drawn.width();
        let index = |x: usize, y: usize| (y * width + x) as u32 + 1;
        let mut nearest = Plane::from_fn(self.drawn.size(), |x, y| if counts(x, y) { index(x, y) } else { 0 });
        spread(&mut nearest, |x, y| self.coverage(part, x, y) > 0);
        nearest.map(|index| index.checked_sub(1).map_or(OUT, |index| self.drawn.values()[index as usize]))
    }
}

/// Premultiplied pixels as tiles.
fn tiles_of(piece: &Plane<Pixel>, rect: Rect) -> TileGrid {
    let mut tiles = TileGrid::default();
    for at in TileAt::covering(rect) {
        let own = at.rect();
        let pixel = |x: i32, y: i32| piece.get(x - rect.x0, y - rect.y0).unwrap_or(OUT);
        let bytes = (own.y0..own.y1).flat_map(|y| (own.x0..own.x1).flat_map(move |x| pixel(x, y))).collect();
        tiles.set(at, Tile::from_pixels(bytes).map(Arc::new));
    }
    tiles
}
