//! Lines on paper without the paper: where it is bare it becomes transparent, and what is drawn
//! covers as much as it darkens the paper. Floor 1. Not here: lines between flat colors
//! (`shape::flats`).
//!
//! A pixel d on paper p is p (1 − a) + L: a is the least share that a color must cover, as dark as
//! that color may be, a = max (p − d) / p over the channels.

use super::{Plane, Tile, TileAt, TileGrid};
use crate::math::{Rect, Size, parallel};
use std::sync::Arc;

/// The paper's color is found in squares of this side, px: larger than most of what is drawn,
/// smaller than shadows of folds and of a lamp.
const BLOCK: usize = 32;
/// A square darker than this share of the lightest around it is drawn on all over.
const DRAWN_ON: f32 = 0.85;
/// Squares around one that are compared with it.
const AROUND: i32 = 2;
/// Paper is no darker than this, of 1, in most places.
const LEAST_LIGHT: f32 = 0.3;
/// Darker than the paper by so many times its median noise is drawn; and the least and the most
/// that this may be.
const NOISE: f32 = 4.0;
const NOISE_RANGE: (f32, f32) = (0.03, 0.15);
/// Bare paper is compared with what was found on about so many pixels.
const COMPARED: usize = 1 << 16;

type PaperColor = [f32; 3];

/// What is drawn on paper. `None` if nothing is painted, or no paper is found: all of it is dark.
pub fn without_paper(tiles: &TileGrid) -> Option<TileGrid> {
    let rect = tiles.bounds();
    let paper = PaperLight::of(tiles, rect)?;
    let all: Vec<(TileAt, Option<Arc<Tile>>)> = parallel::map(TileAt::covering(rect), |at| {
        let own = at.rect();
        let places = (own.y0..own.y1).flat_map(|y| (own.x0..own.x1).map(move |x| (x, y)));
        let drawn = places.flat_map(|(x, y)| paper.remove_paper(tiles.pixel(x, y), x, y)).collect();
        (at, Tile::from_pixels(drawn).map(Arc::new))
    });
    let mut drawn = TileGrid::default();
    all.into_iter().for_each(|(at, tile)| drawn.set(at, tile));
    Some(drawn)
}

/// What the paper looks like.
struct PaperLight {
    rect: Rect,
    /// In squares.
    light: Plane<PaperColor>,
    /// What is darker by less, as a share of the paper, is bare.
    noise: f32,
}

impl PaperLight {
    fn of(tiles: &TileGrid, rect: Rect) -> Option<Self> {
        let squares = |px: usize| px.div_ceil(BLOCK) as u32;
        let size = Size::new(squares(rect.width()), squares(rect.height()));
        if rect.is_empty() {
            return None;
        }
        let seen = Plane::from_fn(size, |i, j| lightest(tiles, rect, i, j));
        let known = seen.map(|seen| seen.unwrap_or([0.0; 3]));
        let mut light =
            Plane::from_fn(size, |i, j| fill_from_neighbors(&known, i as i32, j as i32));
        light = Plane::from_fn(size, |i, j| smooth(&light, i as i32, j as i32));
        let lightness = median(light.values().iter().map(|light| luma(*light)).collect())?;
        if lightness < LEAST_LIGHT {
            return None;
        }
        let mut paper = Self { rect, light, noise: 0.0 };
        let step = (rect.width() * rect.height()).div_ceil(COMPARED).max(1);
        let off = (0..rect.width() * rect.height()).step_by(step).filter_map(|i| {
            let x = rect.x0 + (i % rect.width()) as i32;
            let y = rect.y0 + (i / rect.width()) as i32;
            let (color, _) = straight(tiles.pixel(x, y))?;
            Some(darker(color, paper.at(x, y)).abs())
        });
        let noise = NOISE * median(off.collect())?;
        paper.noise = noise.max(NOISE_RANGE.0).min(NOISE_RANGE.1);
        Some(paper)
    }

    /// Between the middles of squares.
    fn at(&self, x: i32, y: i32) -> PaperColor {
        let at = |v: i32, from: i32, n: usize| {
            let t = ((v - from) as f32 + 0.5) / BLOCK as f32 - 0.5;
            let t = t.max(0.0).min(n as f32 - 1.0);
            (t as usize, (t as usize + 1).min(n - 1), t.fract())
        };
        let (i0, i1, u) = at(x, self.rect.x0, self.light.width());
        let (j0, j1, v) = at(y, self.rect.y0, self.light.height());
        std::array::from_fn(|c| {
            let row = |j: usize| {
                let (a, b) = (self.light.at(i0, j)[c], self.light.at(i1, j)[c]);
                a + (b - a) * u
            };
            row(j0) + (row(j1) - row(j0)) * v
        })
    }

    /// What is drawn at a pixel, premultiplied.
    fn remove_paper(&self, pixel: [u8; 4], x: i32, y: i32) -> [u8; 4] {
        let Some((color, alpha)) = straight(pixel) else { return [0; 4] };
        let paper = self.at(x, y);
        let share = darker(color, paper).max(0.0).min(1.0);
        // Whole from twice the noise on.
        let t = (share / self.noise - 1.0).max(0.0).min(1.0);
        let kept = t * t * (3.0 - 2.0 * t) * alpha;
        let byte = |v: f32| (v * kept * 255.0).round() as u8;
        let ink: PaperColor =
            std::array::from_fn(|c| (color[c] - paper[c] * (1.0 - share)).max(0.0).min(share));
        [byte(ink[0]), byte(ink[1]), byte(ink[2]), byte(share)]
    }
}

/// The color of a pixel, and its alpha; `None` if nothing is painted there.
fn straight([r, g, b, a]: [u8; 4]) -> Option<(PaperColor, f32)> {
    let per = 1.0 / f32::from(a);
    (a > 0).then(|| ([r, g, b].map(|v| f32::from(v) * per), f32::from(a) / 255.0))
}

/// How much darker than the paper a color is, as a share of the paper; the largest of its channels.
fn darker(color: PaperColor, paper: PaperColor) -> f32 {
    let channel = |c: usize| (paper[c] - color[c]) / paper[c].max(1.0 / 255.0);
    (1..3).map(channel).fold(channel(0), f32::max)
}

fn luma([r, g, b]: PaperColor) -> f32 {
    0.299 * r + 0.587 * g + 0.114 * b
}

fn median(mut values: Vec<f32>) -> Option<f32> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f32::total_cmp).1)
}

/// The color of a square that is lighter than three quarters of it; `None` if nothing is painted
/// there.
fn lightest(tiles: &TileGrid, rect: Rect, i: usize, j: usize) -> Option<PaperColor> {
    let (x0, y0) = (rect.x0 + (i * BLOCK) as i32, rect.y0 + (j * BLOCK) as i32);
    let square = Rect::new(x0, y0, x0 + BLOCK as i32, y0 + BLOCK as i32).intersect(rect);
    let places = (square.y0..square.y1).flat_map(|y| (square.x0..square.x1).map(move |x| (x, y)));
    let mut colors: Vec<PaperColor> =
        places.filter_map(|(x, y)| Some(straight(tiles.pixel(x, y))?.0)).collect();
    let at = colors.len() * 3 / 4;
    let order = |a: &PaperColor, b: &PaperColor| luma(*a).total_cmp(&luma(*b));
    (!colors.is_empty()).then(|| *colors.select_nth_unstable_by(at, order).1)
}

/// A square's color, or that of the lightest around it if it is drawn on all over.
fn fill_from_neighbors(light: &Plane<PaperColor>, i: i32, j: i32) -> PaperColor {
    let own = light.get(i, j).unwrap_or_default();
    let around = (-AROUND..=AROUND).flat_map(|dj| (-AROUND..=AROUND).map(move |di| (di, dj)));
    let best = around
        .filter_map(|(di, dj)| light.get(i + di, j + dj))
        .max_by(|a, b| luma(*a).total_cmp(&luma(*b)))
        .unwrap_or(own);
    if luma(own) < DRAWN_ON * luma(best) { best } else { own }
}

/// The mean of a square and those beside it.
fn smooth(light: &Plane<PaperColor>, i: i32, j: i32) -> PaperColor {
    let around = (-1..=1).flat_map(|dj| (-1..=1).map(move |di| (di, dj)));
    let all: Vec<PaperColor> = around.filter_map(|(di, dj)| light.get(i + di, j + dj)).collect();
    std::array::from_fn(|c| all.iter().map(|light| light[c]).sum::<f32>() / all.len() as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A gray paper that darkens to the right, with grain, a pencil line and a red one.
    fn scan() -> (TileGrid, impl Fn(i32) -> f32) {
        let paper = |x: i32| 225.0 - 0.12 * x as f32;
        let pixel = move |i: usize| {
            let (x, y) = (i % 300, i / 300);
            let grain = ((x * 7919 + y * 104_729) % 9) as f32 - 4.0;
            let gray = paper(x as i32) + grain;
            match y {
                60..64 => [40, 42, 45, 255],
                120..123 => [190, 30, 35, 255],
                _ => [gray as u8, (gray * 0.98) as u8, (gray * 0.95) as u8, 255],
            }
        };
        let rgba: Vec<u8> = (0..300 * 200).flat_map(pixel).collect();
        (TileGrid::from_straight_rgba(&rgba, 300, 200, 0, 0), paper)
    }

    #[test]
    fn bare_paper_becomes_transparent_and_lines_on_it_are_seen_as_they_were() {
        let (scan, paper) = scan();
        let drawn = without_paper(&scan).unwrap();
        for (x, y) in (0..200).flat_map(|y| (0..300).map(move |x| (x, y))) {
            let (was, is) = (scan.pixel(x, y), drawn.pixel(x, y));
            if !(60..64).contains(&y) && !(120..123).contains(&y) {
                assert!(is[3] <= 2, "{x} {y}: {is:?}");
                continue;
            }
            let own = [1.0, 0.98, 0.95].map(|tint| paper(x) * tint);
            for c in 0..3 {
                let over = f32::from(is[c]) + own[c] * (1.0 - f32::from(is[3]) / 255.0);
                assert!((over - f32::from(was[c])).abs() < 8.0, "{x} {y} {c}: {over} for {was:?}");
            }
        }
        let red = drawn.pixel(150, 121);
        assert!(red[3] > 200 && red[0] > 3 * red[1], "{red:?}");
    }

    #[test]
    fn a_dark_picture_has_no_paper_and_nothing_has_none() {
        let night = TileGrid::from_straight_rgba(&[20, 22, 40, 255].repeat(64 * 64), 64, 64, 0, 0);
        assert!(without_paper(&night).is_none());
        assert!(without_paper(&TileGrid::default()).is_none());
    }
}
