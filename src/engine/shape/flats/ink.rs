//! Lines of a drawing that separate its areas, such as ink: they belong to what they run along.
//! Floor 3. Not here: which of two areas takes a pixel of a line (`complete`).

use super::areas::{least_area, pixels, plane_over, side_neighbors, walk};
use super::palette::{NONE, NOTHING};
use crate::math::{Rect, Size};
use crate::raster::{Plane, distance};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Half of the widest line, as a share of the longer side of a picture; and the share that it may
/// be up to 2 px wide.
const HALF_WIDTH: f32 = 0.005;
const HALF_WIDTH_SMALL: f32 = 0.01;
const SMALL_PX: f32 = 2.0;
/// The share of a color that must be in lines, and the share of these that must have two areas on
/// their sides.
const LEAST_THIN: f32 = 0.3;
const LEAST_BETWEEN: f32 = 0.4;
/// A line is long for its width: the least square of its rim, px, for each of its pixels; 13 for a
/// disc.
const LEAST_LONG: usize = 32;
/// An area is no corner in which lines meet: the least of it, in squares of half of the widest
/// line.
const LEAST_THICK: usize = 24;
/// Bold lines are so many times as wide, and run along so many colors, of which nothing is one.
const BOLD: usize = 2;
const LEAST_BESIDE: usize = 4;
/// Some of a drawing's lines are bolder than others, and where they run into each other they are
/// wider for a short way: up to so many times as wide, with the most of such an area in squares of
/// half of the width of the drawing's own lines.
const MOST_WIDENED: f32 = 2.25;
const MOST_JOINED: f32 = 128.0;
/// How far beyond a line's border an area begins, px: the border is soft.
const SOFT: usize = 4;

/// Half of the widest line in a picture, px; at least 1.
pub fn half_width(size: Size) -> usize {
    let side = size.longer_side();
    (HALF_WIDTH * side).max(SMALL_PX.min(HALF_WIDTH_SMALL * side)).max(1.0) as usize
}

/// How many pixels a color takes, and how many of them are beside others.
#[derive(Clone, Copy, Default)]
pub struct ColorPixels {
    all: usize,
    rim: usize,
    area: Rect,
}

/// Those of the first `n` colors.
pub fn color_pixels(of: &Plane<u16>, n: usize) -> Vec<ColorPixels> {
    let count = |mut counts: Vec<ColorPixels>, y: usize| {
        for (x, color) in of.row(y).iter().enumerate() {
            if let Some(count) = counts.get_mut(usize::from(*color)) {
                count.all += 1;
                count.rim += usize::from(is_rim(of, (x, y)));
                let (x, y) = (x as i32, y as i32);
                if !count.area.contains(x, y) {
                    count.area = count.area.union(Rect::new(x, y, x + 1, y + 1));
                }
            }
        }
        counts
    };
    let both = |a: Vec<ColorPixels>, b: Vec<ColorPixels>| {
        let sum = |(a, b): (ColorPixels, ColorPixels)| ColorPixels {
            all: a.all + b.all,
            rim: a.rim + b.rim,
            area: a.area.union(b.area),
        };
        a.into_iter().zip(b).map(sum).collect()
    };
    let none = || vec![ColorPixels::default(); n];
    (0..of.height()).into_par_iter().fold(none, count).reduce(none, both)
}

/// Whether a pixel is beside one of another color.
fn is_rim(of: &Plane<u16>, (x, y): (usize, usize)) -> bool {
    side_neighbors((x, y), (of.width(), of.height())).any(|(x1, y1)| of.at(x1, y1) != of.at(x, y))
}

/// The pixels of lines between areas in one color, if that is mostly such lines.
///
/// * `of`: the number of the color that takes the most of each pixel.
/// * `count`: of the color.
pub fn lines(of: &Plane<u16>, color: u16, count: ColorPixels) -> Option<Vec<(usize, usize)>> {
    let half = half_width(of.size());
    let bold = || lines_up_to(of, color, count, BOLD * half);
    lines_up_to(of, color, count, half).map(|found| found.pixels).or_else(|| {
        // A strap is as wide, but it runs along few areas.
        Some(bold()?).filter(|found| found.beside >= LEAST_BESIDE).map(|found| found.pixels)
    })
}

/// The lines of a color.
struct FoundLines {
    pixels: Vec<(usize, usize)>,
    /// Along how many colors they run; nothing counts as one.
    beside: usize,
}

/// Lines up to twice as wide as `half`.
fn lines_up_to(of: &Plane<u16>, color: u16, count: ColorPixels, half: usize) -> Option<FoundLines> {
    let ColorPixels { all, rim, area } = count;
    // A line of that width has a pixel of rim for each pixel of half its width.
    if all == 0 || (rim * half) as f32 <= LEAST_THIN * all as f32 {
        return None;
    }
    let reach = 2 * half + SOFT;
    let area = area.grown(reach as i32 + 1).intersect(of.size().rect());
    let least = least_area(of.size()).max(LEAST_THICK * half * half);
    let of = &plane_over(area, |x, y, _| of.at(x, y));
    let mut thin = thin_pixels(of, color, half, least);
    let mut lines: Vec<(usize, usize)> = Vec::new();
    for start in pixels((of.width(), of.height())) {
        let area = take_area(&mut thin, start);
        if is_long(of, &area) {
            lines.extend(area);
        }
    }
    let mut beside = BTreeSet::new();
    let mut between = 0;
    for at in &lines {
        let sides = areas_beside(of, *at, reach);
        between += usize::from(sides.is_some());
        beside.extend(sides.into_iter().flatten());
    }
    let is_ink = lines.len() as f32 >= LEAST_THIN * all as f32
        && between as f32 >= LEAST_BETWEEN * lines.len() as f32;
    let (x0, y0) = (area.x0 as usize, area.y0 as usize);
    let pixels = lines.into_iter().map(|(x, y)| (x + x0, y + y0)).collect();
    is_ink.then_some(FoundLines { pixels, beside: beside.len() })
}

/// Whether pixels that are joined are long for their width.
fn is_long(of: &Plane<u16>, area: &[(usize, usize)]) -> bool {
    let rim = area.iter().filter(|at| is_rim(of, **at)).count();
    !area.is_empty() && rim * rim >= LEAST_LONG * area.len()
}

/// The pixels of a color that are in none of its areas that are wider than lines and large enough
/// to be parts.
///
/// `least`: the pixels of the smallest of these.
fn thin_pixels(of: &Plane<u16>, color: u16, half: usize, least: usize) -> Plane<bool> {
    let reach = half.min(usize::from(distance::FARTHEST) - 1);
    let within = (reach * reach + reach) as u16;
    let widest = (MOST_WIDENED * half as f32) as u16;
    let outside = distance::squared_distances(&of.map(|of| u8::from(of != color)), widest + 1);
    let core =
        distance::squared_distances(&outside.map(|away| u8::from(away > within)), reach as u16 + 1);
    let is_thick = |x: usize, y: usize| of.at(x, y) == color && core.at(x, y) <= within;
    let mut thick = Plane::from_fn(of.size(), is_thick);
    let mut thin = Plane::from_fn(of.size(), |x, y| of.at(x, y) == color && !is_thick(x, y));
    let own_half = own_half_width(of, &thin);
    let is_joint = |area: &[(usize, usize)]| {
        let widened = MOST_WIDENED * own_half;
        ((area.len() as f32) < MOST_JOINED * own_half * own_half || is_long(of, area))
            && area.iter().all(|(x, y)| f32::from(outside.at(*x, *y)) <= widened * widened)
    };
    for start in pixels((of.width(), of.height())) {
        let area = take_area(&mut thick, start);
        if area.len() < least || is_joint(&area) {
            area.into_iter().for_each(|(x, y)| thin.set(x, y, true));
        }
    }
    thin
}

/// Half of the width of a drawing's lines, px: each has a pixel of rim for so many of its own.
fn own_half_width(of: &Plane<u16>, thin: &Plane<bool>) -> f32 {
    let lines = || pixels((of.width(), of.height())).filter(|(x, y)| thin.at(*x, *y));
    let rim = lines().filter(|at| is_rim(of, *at)).count();
    lines().count() as f32 / rim.max(1) as f32
}

/// The pixels of a set that are joined to one of it; they are taken out.
fn take_area(set: &mut Plane<bool>, start: (usize, usize)) -> Vec<(usize, usize)> {
    let mut area = Vec::new();
    if !set.at(start.0, start.1) {
        return area;
    }
    walk(start, (set.width(), set.height()), |x, y| {
        let enters = set.at(x, y);
        if enters {
            set.set(x, y, false);
            area.push((x, y));
        }
        enters
    });
    area
}

/// The different colors, or a color and nothing, that lie on the two sides of a pixel of a line.
fn areas_beside(of: &Plane<u16>, (x, y): (usize, usize), reach: usize) -> Option<[u16; 2]> {
    let own = of.at(x, y);
    let side = |dx: i32, dy: i32| {
        (1..=reach as i32).find_map(|k| match of.get(x as i32 + k * dx, y as i32 + k * dy) {
            None => Some(NOTHING),
            Some(other) => (other != own && other != NONE).then_some(other),
        })
    };
    let differ = |a: Option<u16>, b: Option<u16>| Some([a?, b?]).filter(|[a, b]| a != b);
    differ(side(-1, 0), side(1, 0)).or_else(|| differ(side(0, -1), side(0, 1)))
}
