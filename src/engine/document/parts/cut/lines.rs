//! Lines between two parts of a drawing go with the nearer one, whose outline they draw: an eye
//! that is moved takes all of its ring along. Floor 4.

use super::owners::{Cut, NO_PART};
use crate::raster::{Plane, distance};
use crate::shape::flats::areas::pixels;
use crate::shape::flats::color_distance::{color_distance, share_on_the_way, uncomposite};
use crate::shape::flats::ink::half_width;
use crate::shape::flats::picture::Pixel;
use std::collections::VecDeque;

/// A pixel that differs more from the flat color of its part, in any channel of 8 bits, is of a
/// line or a mark on it.
const LINE: u8 = 48;
/// How far beyond such pixels a line fades, px.
const SOFT: i32 = 2;

/// The lines of a drawing that are drawn on one part and go with another.
pub struct CutLines {
    /// The part that takes a pixel that a farther one has; or [`NO_PART`].
    taker: Plane<u16>,
    /// Those of them that are more than a soft border.
    is_ink: Plane<bool>,
    /// The square of how far the nearest line on any part is, px, up to a little more than
    /// [`SOFT`].
    away: Plane<u16>,
}

impl CutLines {
    pub fn of(cut: &Cut) -> Self {
        let size = cut.drawn.size();
        let is_marked = |x: usize, y: usize| {
            cut.owner
                .at(x, y)
                .checked_sub(1)
                .is_some_and(|part| is_off_color(cut, part as u16, (x, y)))
        };
        let marks = Plane::from_fn(size, |x, y| u8::from(is_marked(x, y)));
        let away = distance::squared_distances(&marks, SOFT as u16 + 1);
        let mut taker = assign_marks(cut, &marks);
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

    /// What the taker of a pixel adds to the color behind it: the ink, as much of it as is seen.
    pub fn ink_over(&self, cut: &Cut, (x, y): (usize, usize), behind: Pixel) -> Pixel {
        let drawn = cut.drawn.at(x, y);
        if behind[3] < 255 {
            return drawn;
        }
        let ink = square_around(x, y, SOFT).filter(|(x, y)| self.is_ink.get(*x, *y) == Some(true));
        let ink = ink
            .filter_map(|(x, y)| cut.drawn.get(x, y))
            .max_by_key(|ink| color_distance(*ink, behind));
        let share = ink.map_or(0, |ink| share_on_the_way(drawn, behind, ink));
        let least = share.max(cut.coverage(self.taker.at(x, y), x, y));
        (least..=255).find_map(|alpha| uncomposite(drawn, alpha, behind)).unwrap_or(drawn)
    }
}

impl Cut {
    /// Whether a part is nearer than the one that a whole pixel belongs to.
    fn can_take(&self, part: u16, x: usize, y: usize) -> bool {
        let owner = self.owner.at(x, y);
        part != NO_PART && owner > 0 && u32::from(part) + 1 > owner && self.drawn.at(x, y)[3] == 255
    }

    /// Whether a pixel of a part is of a line between it and a nearer one: of a color that neither
    /// has, and that they do not make where they meet.
    fn is_ink_between(&self, part: u16, (x, y): (usize, usize)) -> bool {
        let color = |of: u32| self.outlines.get(of as usize).and_then(|outline| outline.color);
        let own = self.owner.at(x, y).checked_sub(1).and_then(color);
        let drawn = self.drawn.at(x, y);
        own.zip(color(u32::from(part))).is_some_and(|(own, other)| {
            color_distance(drawn, own) > LINE
                && color_distance(drawn, other) > LINE
                && share_on_the_way(drawn, own, other) == 0
        })
    }
}

/// Whether the drawing shows something else on a part than its flat color.
fn is_off_color(cut: &Cut, part: u16, (x, y): (usize, usize)) -> bool {
    let color = cut.outlines[usize::from(part)].color;
    color.is_some_and(|color| color_distance(cut.drawn.at(x, y), color) > LINE)
}

/// The ink on farther parts along each part, as far from its outline as the part's own side of the
/// line is wide, and a quarter more.
fn assign_marks(cut: &Cut, marks: &Plane<u8>) -> Plane<u16> {
    let size = (cut.drawn.width(), cut.drawn.height());
    let is_marked = |x: usize, y: usize| marks.at(x, y) > 0;
    let can_take = |part: u16, x: usize, y: usize| {
        is_marked(x, y) && cut.can_take(part, x, y) && cut.is_ink_between(part, (x, y))
    };
    let seed = |(x, y): (usize, usize)| {
        let beside = square_around(x, y, 1)
            .filter_map(|(x, y)| cut.nearest.get(x, y))
            .map(|[first, _]| first);
        let part = beside.filter(|part| *part != NO_PART).max()?;
        can_take(part, x, y).then_some((x, y, part))
    };
    let seeds: Vec<(usize, usize, u16)> =
        pixels(size).filter(|(x, y)| is_marked(*x, *y)).filter_map(seed).collect();
    let widest = vec![2 * half_width(cut.drawn.size()); cut.outlines.len()];
    let is_own_ink = |part: u16, x: usize, y: usize| {
        is_marked(x, y) && cut.owner.at(x, y) == u32::from(part) + 1
    };
    let own_side = walk(cut, &seeds, &widest, is_own_ink);
    let count = |taken: &[(usize, usize, u16)]| {
        let mut counts = vec![0usize; cut.outlines.len()];
        taken.iter().for_each(|(.., part)| counts[usize::from(*part)] += 1);
        counts
    };
    // The border runs in the middle of a line: its other side is about as wide, and ends softly.
    let width = |(own, seeds): (usize, usize)| {
        (5 * own.saturating_sub(seeds)).div_ceil(4 * seeds.max(1)) + 1
    };
    let widths: Vec<usize> = count(&own_side).into_iter().zip(count(&seeds)).map(width).collect();
    let mut taker = Plane::full(cut.drawn.size(), NO_PART);
    let found = walk(cut, &seeds, &widths, can_take);
    found.into_iter().for_each(|(x, y, part)| taker.set(x, y, part));
    taker
}

/// The pixels that each part reaches from its seeds over those that it may enter, the seeds first;
/// each is reached by one part. `most_px`: how far each part goes from a seed.
fn walk(
    cut: &Cut,
    seeds: &[(usize, usize, u16)],
    most_px: &[usize],
    enters: impl Fn(u16, usize, usize) -> bool,
) -> Vec<(usize, usize, u16)> {
    let mut is_reached = Plane::full(cut.drawn.size(), false);
    seeds.iter().for_each(|(x, y, _)| is_reached.set(*x, *y, true));
    let mut reached = seeds.to_vec();
    let mut ahead: VecDeque<_> =
        seeds.iter().map(|(x, y, part)| ((*x, *y), (*x, *y), *part)).collect();
    while let Some((seed, (x, y), part)) = ahead.pop_front() {
        let most = most_px[usize::from(part)].pow(2);
        for (x, y) in square_around(x, y, 1) {
            let is_new = is_reached.get(x, y) == Some(false);
            let (x, y) = (x.max(0) as usize, y.max(0) as usize);
            let is_near = || seed.0.abs_diff(x).pow(2) + seed.1.abs_diff(y).pow(2) <= most;
            if is_new && is_near() && enters(part, x, y) {
                is_reached.set(x, y, true);
                reached.push((x, y, part));
                ahead.push_back((seed, (x, y), part));
            }
        }
    }
    reached
}

/// The pixels beside what is taken that may be taken as well, and by which part.
fn soft_border(cut: &Cut, taker: &Plane<u16>) -> Vec<(usize, usize, u16)> {
    let mut border = Vec::new();
    for (x, y) in
        pixels((taker.width(), taker.height())).filter(|(x, y)| taker.at(*x, *y) != NO_PART)
    {
        let part = taker.at(x, y);
        let free = square_around(x, y, 1).filter(|(x, y)| taker.get(*x, *y) == Some(NO_PART));
        let free =
            free.map(|(x, y)| (x as usize, y as usize)).filter(|(x, y)| cut.can_take(part, *x, *y));
        border.extend(free.map(|(x, y)| (x, y, part)));
    }
    border
}

/// The pixels in a square, row by row.
fn square_around(x: usize, y: usize, reach: i32) -> impl Iterator<Item = (i32, i32)> {
    let (x, y) = (x as i32, y as i32);
    (-reach..=reach).flat_map(move |dy| (-reach..=reach).map(move |dx| (x + dx, y + dy)))
}
