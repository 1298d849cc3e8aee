//! Lines between two parts of a drawing go with the nearer one, whose outline they draw: an eye that is moved takes all
//! of its ring along. Floor 4.

use super::super::areas::pixels;
use super::super::ink::half_width;
use super::super::near::{away, share_on_the_way};
use super::super::picture::Pixel;
use super::owners::{Cut, NO_PART};
use crate::raster::{Plane, distance};
use std::collections::VecDeque;

/// A pixel that differs more from the flat colour of its part, in any channel of 8 bits, is of a line or a mark on it.
const LINE: u8 = 48;
/// How far beyond such pixels a line fades, px.
const SOFT: i32 = 2;

/// A channel of the piece in front may be off by this much from what it must add to the one behind, of 255.
const ROUNDING: i32 = 1;

/// The lines of a drawing that are drawn on one part and go with another.
pub struct CutLines {
    /// The part that takes a pixel that a farther one has; or [`NO_PART`].
    taker: Plane<u16>,
    /// Those of them that are more than a soft border.
    is_ink: Plane<bool>,
    /// The square of how far the nearest line on any part is, px, up to a little more than [`SOFT`].
    away: Plane<u16>,
}

impl CutLines {
    pub fn of(cut: &Cut) -> Self {
        let size = cut.drawn.size();
        let is_marked = |x: usize, y: usize| {
            cut.owner.at(x, y).checked_sub(1).is_some_and(|part| is_off_color(cut, part as u16, (x, y)))
        };
        let marks = Plane::from_fn(size, |x, y| u8::from(is_marked(x, y)));
        let away = distance::squared(&marks, SOFT as u16 + 1);
        let mut taker = taken(cut, &marks);
        let is_ink = taker.map(|part| part != NO_PART);
        for _ in 0..SOFT {
            let grown: Vec<(usize, usize, u16)> = soft_border(cut, &taker);
            grown.into_iter().for_each(|(x, y, part)| taker.set(x, y, part));
        }
        Self { taker, is_ink, away }
    }
    /// The part that takes a pixel of a line that is drawn on a farther one.
    pub fn taker(&self, x: usize, y: usize) -> Option<u16> {
        Some(self.taker.at(x, y)).filter(|part| *part != NO_PART)
    }
    /// Whether no line is near enough to shade a pixel.
    pub fn is_far(&self, x: usize, y: usize) -> bool {
        i32::from(self.away.at(x, y)) > SOFT * SOFT
    }
    /// What the taker of a pixel adds to the colour behind it: the ink, as much of it as is seen.
    pub fn over(&self, cut: &Cut, (x, y): (usize, usize), behind: Pixel) -> Pixel {
        let drawn = cut.drawn.at(x, y);
        if behind[3] < 255 {
            return drawn;
        }
        let ink = around(x, y, SOFT).filter(|(x, y)| self.is_ink.get(*x, *y) == Some(true));
        let ink = ink.filter_map(|(x, y)| cut.drawn.get(x, y)).max_by_key(|ink| away(*ink, behind));
        let share = ink.map_or(0, |ink| share_on_the_way(drawn, behind, ink));
        let least = share.max(cut.coverage(self.taker.at(x, y), x, y));
        (least..=255).find_map(|alpha| added(drawn, alpha, behind)).unwrap_or(drawn)
    }
}

impl Cut {
    /// Whether a part is nearer than the one that a whole pixel belongs to.
    fn may_take(&self, part: u16, x: usize, y: usize) -> bool {
        let owner = self.owner.at(x, y);
        part != NO_PART && owner > 0 && u32::from(part) + 1 > owner && self.drawn.at(x, y)[3] == 255
    }
    /// Whether a pixel of a part is of a line between it and a nearer one: of a colour that neither has, and that they
    /// do not make where they meet.
    fn is_ink_between(&self, part: u16, (x, y): (usize, usize)) -> bool {
        let color = |of: u32| self.outlines.get(of as usize).and_then(|outline| outline.color);
        let own = self.owner.at(x, y).checked_sub(1).and_then(color);
        let drawn = self.drawn.at(x, y);
        own.zip(color(u32::from(part))).is_some_and(|(own, other)| {
            away(drawn, own) > LINE && away(drawn, other) > LINE && share_on_the_way(drawn, own, other) == 0
        })
    }
}

/// Whether the drawing shows something else on a part than its flat colour.
fn is_off_color(cut: &Cut, part: u16, (x, y): (usize, usize)) -> bool {
    let color = cut.outlines[usize::from(part)].color;
    color.is_some_and(|color| away(cut.drawn.at(x, y), color) > LINE)
}

/// The ink on farther parts along each part, walked from its outline as far as a line is wide.
fn taken(cut: &Cut, marks: &Plane<u8>) -> Plane<u16> {
    let most_steps = 2 * half_width(cut.drawn.size());
    let mut taker = Plane::filled(cut.drawn.size(), NO_PART);
    let enters = |taker: &Plane<u16>, part: u16, x: i32, y: i32| {
        taker.get(x, y) == Some(NO_PART) && {
            let at = (x as usize, y as usize);
            marks.at(at.0, at.1) > 0 && cut.may_take(part, at.0, at.1) && cut.is_ink_between(part, at)
        }
    };
    let mut ahead: VecDeque<(usize, usize, usize)> = VecDeque::new();
    for (x, y) in pixels((taker.width(), taker.height())).filter(|(x, y)| marks.at(*x, *y) > 0) {
        let beside = around(x, y, 1).filter_map(|(x, y)| cut.nearest.get(x, y)).map(|[first, _]| first);
        let Some(part) = beside.filter(|part| *part != NO_PART).max() else { continue };
        if enters(&taker, part, x as i32, y as i32) {
            taker.set(x, y, part);
            ahead.push_back((x, y, 1));
        }
    }
    while let Some((x, y, steps)) = ahead.pop_front() {
        let part = taker.at(x, y);
        for (x, y) in around(x, y, 1) {
            if steps < most_steps && enters(&taker, part, x, y) {
                taker.set(x as usize, y as usize, part);
                ahead.push_back((x as usize, y as usize, steps + 1));
            }
        }
    }
    taker
}

/// The pixels beside what is taken that may be taken as well, and by which part.
fn soft_border(cut: &Cut, taker: &Plane<u16>) -> Vec<(usize, usize, u16)> {
    let mut border = Vec::new();
    for (x, y) in pixels((taker.width(), taker.height())).filter(|(x, y)| taker.at(*x, *y) != NO_PART) {
        let part = taker.at(x, y);
        let free = around(x, y, 1).filter(|(x, y)| taker.get(*x, *y) == Some(NO_PART));
        let free = free.map(|(x, y)| (x as usize, y as usize)).filter(|(x, y)| cut.may_take(part, *x, *y));
        border.extend(free.map(|(x, y)| (x, y, part)));
    }
    border
}

/// The pixels in a square, row by row.
fn around(x: usize, y: usize, reach: i32) -> impl Iterator<Item = (i32, i32)> {
    let (x, y) = (x as i32, y as i32);
    (-reach..=reach).flat_map(move |dy| (-reach..=reach).map(move |dx| (x + dx, y + dy)))
}

/// What has to lie with some alpha over an opaque colour, so that a given one is seen. `None` if nothing can.
pub fn added(seen: Pixel, alpha: u8, over: Pixel) -> Option<Pixel> {
    let left = |c: usize| (i32::from(over[c]) * (255 - i32::from(alpha)) + 127) / 255;
    let own = |c: usize| i32::from(seen[c]) - left(c);
    let alpha_range = -ROUNDING..=i32::from(alpha) + ROUNDING;
    (0..3).all(|c| alpha_range.contains(&own(c))).then(|| {
        let channel = |c: usize| if c == 3 { alpha } else { own(c).clamp(0, i32::from(alpha)) as u8 };
        std::array::from_fn(channel)
    })
}
