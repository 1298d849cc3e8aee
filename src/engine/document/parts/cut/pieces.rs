//! What each part carries of a drawing. Floor 4.

use super::lines::CutLines;
use super::owners::{Cut, NO_PART, PieceOutline};
use crate::math::Rect;
use crate::raster::{Plane, Tile, TileAt, TileGrid};
use crate::shape::flats::areas::{plane_over, spread};
use crate::shape::flats::color_distance::uncomposite;
use crate::shape::flats::picture::Pixel;
use std::sync::Arc;

/// Nothing of a pixel.
const OUT: Pixel = [0; 4];

/// The color of the nearest part so far.
#[derive(Clone, Copy, Default)]
struct ColorBeneath {
    color: Pixel,
    part: u16,
}

impl Cut {
    /// What each part carries, and what belongs to none.
    pub fn pieces(&self) -> (Vec<TileGrid>, TileGrid) {
        let lines = CutLines::of(self);
        let mut beneath = Plane::full(self.drawn.size(), ColorBeneath::default());
        let mut pieces = Vec::with_capacity(self.outlines.len());
        for (part, area) in (0..).zip(self.find_reached(&lines)) {
            let own = self.own_colors(part, area, &lines);
            let piece = plane_over(area, |x, y, i| {
                let own = own.values()[i];
                match lines.taker(x, y) {
                    Some(taker) if taker == part => {
                        lines.ink_over(self, (x, y), beneath.at(x, y).color)
                    }
                    Some(taker) if taker < part => OUT,
                    Some(_) => own,
                    None => self.pixel(part, (x, y), own, beneath.at(x, y)),
                }
            });
            for ((x, y), color) in
                pixels_of(area).zip(own.values()).filter(|(_, color)| color[3] > 0)
            {
                beneath.set(x, y, ColorBeneath { color: *color, part });
            }
            pieces.push(self.tiles_of(&piece, area));
        }
        let rest = self.drawn.size().rect();
        let left =
            plane_over(
                rest,
                |x, y, _| if self.owner.at(x, y) == 0 { self.drawn.at(x, y) } else { OUT },
            );
        (pieces, self.tiles_of(&left, rest))
    }

    /// Where each part covers something, or has a pixel.
    fn find_reached(&self, lines: &CutLines) -> Vec<Rect> {
        let all = self.drawn.size().rect();
        let covered = |of: &PieceOutline| {
            of.outline.rect().moved(-self.rect.x0, -self.rect.y0).intersect(all)
        };
        let mut areas: Vec<Rect> = self.outlines.iter().map(covered).collect();
        for (x, y) in pixels_of(all) {
            let own = self.owner.at(x, y).checked_sub(1).map(|part| part as u16);
            for part in [own, lines.taker(x, y)].into_iter().flatten() {
                let area = &mut areas[usize::from(part)];
                let (x, y) = (x as i32, y as i32);
                if !area.contains(x, y) {
                    *area = area.union(Rect::new(x, y, x + 1, y + 1));
                }
            }
        }
        areas
    }

    /// A pixel of a part's piece; `own`: the part's color there.
    fn pixel(&self, part: u16, (x, y): (usize, usize), own: Pixel, beneath: ColorBeneath) -> Pixel {
        let (drawn, is_own) = (self.drawn.at(x, y), self.owner.at(x, y) == u32::from(part) + 1);
        let [first, second] = self.nearest.at(x, y);
        // At the figure's own edge, and where no part is, there is nothing to share.
        if drawn[3] < 255 || first == NO_PART || second == NO_PART {
            return if is_own { drawn } else { OUT };
        }
        let covered = self.coverage(first, x, y);
        let behind = if part == first {
            Some(beneath.color).filter(|_| beneath.part == second)
        } else {
            Some(own)
        };
        let over = behind
            .filter(|behind| behind[3] == 255)
            .and_then(|behind| uncomposite(drawn, covered, behind));
        match over {
            _ if part != first && part != second => own,
            Some(over) if part == first => over,
            Some(_) => own,
            None if is_own => drawn,
            None if part == first || self.owner.at(x, y) != u32::from(first) + 1 => OUT,
            None => own,
        }
    }

    /// The color of a part wherever it covers something: at its edges that of its nearest pixel
    /// that shows nothing else, and beneath others that of its nearest one without lines.
    fn own_colors(&self, part: u16, area: Rect, lines: &CutLines) -> Plane<Pixel> {
        let is_pure = |x: usize, y: usize| {
            let is_seen = self.nearest.at(x, y)[0] == part && self.coverage(part, x, y) == 255;
            is_seen && self.drawn.at(x, y)[3] == 255 && lines.taker(x, y).is_none()
        };
        let pure = self.nearest_where(part, area, is_pure);
        let plain = self.nearest_where(part, area, |x, y| is_pure(x, y) && lines.is_far(x, y));
        plane_over(area, |x, y, i| {
            let (pure, plain, first) =
                (pure.values()[i], plain.values()[i], self.nearest.at(x, y)[0]);
            let is_beneath = first != part && first != NO_PART && self.coverage(first, x, y) == 255;
            if plain[3] > 0 && (is_beneath || lines.taker(x, y).is_some()) { plain } else { pure }
        })
    }

    /// The color of the nearest pixel that counts, wherever a part covers something.
    fn nearest_where(
        &self,
        part: u16,
        area: Rect,
        counts: impl Fn(usize, usize) -> bool + Sync,
    ) -> Plane<Pixel> {
        let width = self.drawn.width();
        let mut nearest =
            plane_over(area, |x, y, _| if counts(x, y) { (y * width + x) as u32 + 1 } else { 0 });
        let (x0, y0) = (area.x0 as usize, area.y0 as usize);
        spread(&mut nearest, |x, y| self.coverage(part, x + x0, y + y0) > 0);
        nearest.map(|index| {
            index.checked_sub(1).map_or(OUT, |index| self.drawn.values()[index as usize])
        })
    }

    /// Premultiplied pixels of an area as tiles of the canvas.
    fn tiles_of(&self, piece: &Plane<Pixel>, area: Rect) -> TileGrid {
        let area = area.moved(self.rect.x0, self.rect.y0);
        let mut tiles = TileGrid::default();
        for at in TileAt::covering(area) {
            let own = at.rect();
            let pixel = |x: i32, y: i32| piece.get(x - area.x0, y - area.y0).unwrap_or(OUT);
            let bytes = (own.y0..own.y1)
                .flat_map(|y| (own.x0..own.x1).flat_map(move |x| pixel(x, y)))
                .collect();
            tiles.set(at, Tile::from_pixels(bytes).map(Arc::new));
        }
        tiles
    }
}

/// The pixels of an area, row by row.
fn pixels_of(area: Rect) -> impl Iterator<Item = (usize, usize)> {
    (area.y0..area.y1).flat_map(move |y| (area.x0..area.x1).map(move |x| (x as usize, y as usize)))
}
