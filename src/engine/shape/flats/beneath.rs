//! What a flat color covers unseen: its area goes on beneath nearer colors, as a face does
//! beneath its eyes. Floor 3. Not here: which share of a visible pixel a color takes (`shares`).

use super::areas::{self, bound_all, least_area, pixels, plane_over, side_neighbors, walk};
use super::shares::{FlatOwner, Flats, MOSTLY, REACH};
use crate::math::Rect;
use crate::math::srgb::Color;
use crate::raster::Plane;
use std::collections::BTreeMap;

/// A glint in a pupil is painted on it and no hole through which the white of the eye is seen: a
/// flat area of a farther color that is at most so many times as large as the smallest part, and
/// at most this share of what the color around it covers.
const LARGEST_GLINT: usize = 10;
const GLINT_SHARE: f32 = 0.125;

/// An area that goes on beyond the color by more than this share of the color's longer side is
/// open.
const LOOKED_BEYOND: f32 = 0.5;

/// What is seen at a pixel, from far to near: this, the nearer colors in their order, glints, and
/// the color itself.
const OPEN: u16 = 0;
/// Of a farther color: open, or a glint.
const FARTHER: u16 = u16::MAX - 3;
const GLINT: u16 = u16::MAX - 2;
/// No flat area, and no color of a part.
const UNKNOWN: u16 = u16::MAX - 1;
const OWN: u16 = u16::MAX;

/// Gives a color the areas that nearer colors cover inside of it; `nearer`: the farthest of them
/// first.
///
/// A nearer area is inside of the color if it meets nothing but the color itself, areas nearer
/// than itself, which may hide how it goes on, and other areas inside of it. A hole, through which
/// nothing or a farther color is seen, stays.
pub fn fill_beneath(share: &mut Plane<u8>, flats: &Flats, nearer: &[Color], farther: &[Color]) {
    let own = bound_all(share, |share| share >= MOSTLY);
    let beyond = (LOOKED_BEYOND * own.width().max(own.height()) as f32) as i32 + 1;
    let around = own.grown(beyond).intersect(share.size().rect());
    let mut seen = what_is_seen(share, around, flats, nearer, farther);
    turn_small_areas_to_glints(&mut seen, least_area(share.size()));
    spread(&mut seen);
    let open = what_is_open(&seen);
    let size = (seen.width(), seen.height());
    let (x0, y0) = (around.x0 as usize, around.y0 as usize);
    let is_inside = |x: usize, y: usize| seen.at(x, y) != OWN && !open.at(x, y);
    for start in pixels(size) {
        let touches = || side_neighbors(start, size).any(|(x, y)| seen.at(x, y) == OWN);
        if is_inside(start.0, start.1) && share.at(start.0 + x0, start.1 + y0) < MOSTLY && touches()
        {
            walk(start, size, |x, y| {
                let at = (x + x0, y + y0);
                if seen.at(x, y) == OWN {
                    fill_mixed_around(share, at.0, at.1);
                }
                let enters = is_inside(x, y) && share.at(at.0, at.1) < 255;
                if enters {
                    share.set(at.0, at.1, 255);
                }
                enters
            });
        }
    }
}

/// In an area of the flats.
fn what_is_seen(
    share: &Plane<u8>,
    area: Rect,
    flats: &Flats,
    nearer: &[Color],
    farther: &[Color],
) -> Plane<u16> {
    let [nearer, farther] = [nearer, farther]
        .map(|colors| colors.iter().map(|color| flats.number_of(*color)).collect::<Vec<_>>());
    let of = |number: u16| match nearer.iter().position(|color| *color == Some(number)) {
        Some(place) => (place as u16).saturating_add(1).min(FARTHER - 1),
        None if farther.contains(&Some(number)) => FARTHER,
        None => UNKNOWN,
    };
    let of: Vec<u16> = (0..flats.colors().len() as u16).map(of).collect();
    plane_over(area, |x, y, _| match flats.owner(x, y) {
        _ if share.at(x, y) >= MOSTLY => OWN,
        FlatOwner::Color(number) => of.get(usize::from(number)).copied().unwrap_or(UNKNOWN),
        FlatOwner::Nothing => OPEN,
        FlatOwner::Unknown => UNKNOWN,
    })
}

/// Decides for areas of farther colors whether they are glints or open; `least`: the pixels of the
/// smallest part.
fn turn_small_areas_to_glints(seen: &mut Plane<u16>, least: usize) {
    let own = seen.values().iter().filter(|seen| **seen == OWN).count();
    let largest = (LARGEST_GLINT * least).min((GLINT_SHARE * own as f32) as usize);
    let size = (seen.width(), seen.height());
    for start in pixels(size) {
        if seen.at(start.0, start.1) != FARTHER {
            continue;
        }
        let mut area = Vec::new();
        walk(start, size, |x, y| {
            let enters = seen.at(x, y) == FARTHER;
            if enters {
                seen.set(x, y, OPEN);
                area.push((x, y));
            }
            enters
        });
        let goes_on = area.iter().any(|at| is_border(*at, size));
        if area.len() <= largest && !goes_on {
            area.into_iter().for_each(|(x, y)| seen.set(x, y, GLINT));
        }
    }
}

/// Gives pixels between areas what is seen at the nearest one, by steps over such pixels.
fn spread(seen: &mut Plane<u16>) {
    let size = (seen.width(), seen.height());
    let is_known =
        |x: i32, y: i32| seen.get(x, y).is_some_and(|seen| seen != UNKNOWN && seen != OWN);
    let unknown = pixels(size).filter(|(x, y)| seen.at(*x, *y) == UNKNOWN);
    let mut rim = areas::rim(unknown, [(-1, 0), (1, 0), (0, -1), (0, 1)], is_known);
    while !rim.is_empty() {
        let mut next = Vec::new();
        for at in rim {
            for (x, y) in side_neighbors(at, size)
                .filter(|(x, y)| seen.at(*x, *y) == UNKNOWN)
                .collect::<Vec<_>>()
            {
                seen.set(x, y, seen.at(at.0, at.1));
                next.push((x, y));
            }
        }
        rim = next;
    }
    // What nothing is known about, in the middle of the color itself.
    seen.values_mut().iter_mut().filter(|seen| **seen == UNKNOWN).for_each(|seen| *seen = OPEN);
}

/// Which pixels meet the outside: over areas that lie as near, or nearer, step by step.
fn what_is_open(seen: &Plane<u16>) -> Plane<bool> {
    let size = (seen.width(), seen.height());
    let mut open = seen.map(|seen| seen == OPEN);
    let mut ahead: BTreeMap<u16, Vec<(usize, usize)>> = BTreeMap::new();
    for at in pixels(size).filter(|at| ![OPEN, OWN].contains(&seen.at(at.0, at.1))) {
        if is_border(at, size) || side_neighbors(at, size).any(|(x, y)| seen.at(x, y) == OPEN) {
            ahead.entry(seen.at(at.0, at.1)).or_default().push(at);
        }
    }
    while let Some((here, starts)) = ahead.pop_first() {
        for start in starts {
            walk(start, size, |x, y| {
                let there = seen.at(x, y);
                if there == OWN || there < here || open.at(x, y) {
                    return false;
                }
                if there > here {
                    ahead.entry(there).or_default().push((x, y));
                    return false;
                }
                open.set(x, y, true);
                true
            });
        }
    }
    open
}

/// Whether a pixel is at the border of a plane.
fn is_border((x, y): (usize, usize), (w, h): (usize, usize)) -> bool {
    x == 0 || y == 0 || x + 1 == w || y + 1 == h
}

/// Gives a color all of the mixed pixels at its rim.
fn fill_mixed_around(share: &mut Plane<u8>, x: usize, y: usize) {
    let reach = REACH - 1;
    let (x, y) = (x as i32, y as i32);
    for (x, y) in (y - reach..=y + reach).flat_map(|y| (x - reach..=x + reach).map(move |x| (x, y)))
    {
        if share.get(x, y).is_some_and(|share| share >= MOSTLY) {
            share.set(x as usize, y as usize, 255);
        }
    }
}
