//! The 7 × 7 pixels around one, as sets of bits: which are covered, which continue each other, and
//! which belong to the same piece of surface. Floor 2.

use super::maps::ContourMaps;
use crate::math::{Vec2, vec2};
use crate::surface::links;

/// From the middle to the border of a window, and its side, px.
pub const REACH: i32 = 3;
pub const SIDE: i32 = 2 * REACH + 1;
/// Its pixels.
pub const PIXELS: usize = (SIDE * SIDE) as usize;
/// The bit of the middle pixel. Bits count row by row.
pub const CENTER: u32 = (SIDE * SIDE / 2) as u32;
/// Every pixel of a window.
pub const ALL: u64 = (1 << (SIDE * SIDE)) - 1;

/// A neighbor of the middle pixel.
#[derive(Clone, Copy)]
pub struct Beside {
    /// Of the pixel, if the neighbor continues it.
    pub link: u8,
    pub step: (i32, i32),
    /// The neighbor's own bit.
    pub bit: u32,
}

pub const BESIDE: [Beside; 4] = [
    Beside { link: links::LEFT, step: (-1, 0), bit: CENTER - 1 },
    Beside { link: links::RIGHT, step: (1, 0), bit: CENTER + 1 },
    Beside { link: links::UP, step: (0, -1), bit: CENTER - SIDE as u32 },
    Beside { link: links::DOWN, step: (0, 1), bit: CENTER + SIDE as u32 },
];

/// From the middle pixel to one of the window, px.
#[inline(always)]
pub fn offset_of(i: u32) -> Vec2 {
    let (x, y) = steps_of(i);
    vec2(x as f32, y as f32)
}

/// The same in whole pixels.
#[inline(always)]
pub fn steps_of(i: u32) -> (i32, i32) {
    (i as i32 % SIDE - REACH, i as i32 / SIDE - REACH)
}

/// What surrounds a pixel.
pub struct PixelWindow<'m> {
    maps: &'m ContourMaps<'m>,
    x: i32,
    y: i32,
    /// On the canvas, and of those covered by any surface.
    pub inside: u64,
    pub covered: u64,
    /// Of those, the ones that are covered wholly.
    pub whole: u64,
    /// Continued by the pixel at the right, or below.
    rightward: u64,
    downward: u64,
}

impl<'m> PixelWindow<'m> {
    pub fn around(maps: &'m ContourMaps, x: i32, y: i32) -> Self {
        let mut window =
            Self { maps, x, y, inside: 0, covered: 0, whole: 0, rightward: 0, downward: 0 };
        let size = maps.size;
        for dy in -REACH..=REACH {
            let row = y + dy;
            if row < 0 || row >= size.height as i32 {
                continue;
            }
            let (coverage, links) = (maps.coverage.row(row as usize), maps.links.row(row as usize));
            for dx in (-REACH).max(-x)..=REACH.min(size.width as i32 - 1 - x) {
                let bit = 1u64 << ((dy + REACH) * SIDE + dx + REACH);
                let linked = links[(x + dx) as usize];
                window.inside |= bit;
                let shade = coverage[(x + dx) as usize];
                if shade > 0 {
                    window.covered |= bit;
                }
                if shade == u8::MAX {
                    window.whole |= bit;
                }
                if linked & links::RIGHT != 0 && dx < REACH {
                    window.rightward |= bit;
                }
                if linked & links::DOWN != 0 && dy < REACH {
                    window.downward |= bit;
                }
            }
        }
        window
    }

    /// The surface of the middle pixel goes on across one of its sides, if at a crease.
    pub fn is_linked_across(&self, link: u8) -> bool {
        self.maps.all_links.at(self.x as usize, self.y as usize) & link != 0
    }

    /// The canvas pixel of a bit that is inside.
    pub fn pixel(&self, i: u32) -> (usize, usize) {
        let (dx, dy) = steps_of(i);
        ((self.x + dx) as usize, (self.y + dy) as usize)
    }

    /// The canvas pixels without surface.
    pub fn nothing(&self) -> u64 {
        self.inside & !self.covered
    }

    /// A set and the neighbors that continue it.
    fn continue_set(&self, set: u64) -> u64 {
        let along = (set & self.rightward) << 1 | (set >> 1) & self.rightward;
        let across = (set & self.downward) << SIDE | (set >> SIDE) & self.downward;
        set | along | across
    }

    /// The pieces of surface that two sets of pixels belong to, neither holding a pixel of the
    /// other: where they are continued by each other further on, each takes what it reaches first.
    pub fn pieces(&self, mut first: u64, mut second: u64) -> (u64, u64) {
        loop {
            let next = self.continue_set(first) & !second;
            let other = self.continue_set(second) & !next;
            if (next, other) == (first, second) {
                return (first, second);
            }
            (first, second) = (next, other);
        }
    }

    /// The piece of the middle pixel; of one that continues no other, that of its neighbor nearest
    /// in depth.
    pub fn piece_of_center(&self) -> u64 {
        let center = 1 << CENTER;
        let piece = self.pieces(center, 0).0;
        if piece != center {
            return piece;
        }
        let away = |i: u32| (self.depth(i) - self.depth(CENTER)).abs();
        let beside = BESIDE.iter().map(|beside| beside.bit).filter(|&i| self.covered >> i & 1 == 1);
        beside
            .min_by(|&a, &b| away(a).total_cmp(&away(b)))
            .map_or(center, |i| self.pieces(1 << i, 0).0)
    }

    pub fn nz_squared(&self, i: u32) -> f32 {
        let n = self.nbar(i);
        (1.0 - n.length_squared()).max(0.0)
    }

    pub fn nbar(&self, i: u32) -> Vec2 {
        let (x, y) = self.pixel(i);
        vec2(self.maps.nbar[0].at(x, y), self.maps.nbar[1].at(x, y))
    }

    /// z, 0 near … 1 far.
    pub fn depth(&self, i: u32) -> f32 {
        let (x, y) = self.pixel(i);
        self.maps.depth.at(x, y)
    }
}
