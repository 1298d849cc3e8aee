//! Screens along rows of pixels, eight side by side: what [`Halftone::printed`](super::Halftone)
//! reads like. Floor 3.

use super::{Halftone, LEAST_TONE, TONE_LEVELS, levels};
use crate::math::{Vec2, fast};
use crate::paint::filter::sharpen::{color_under_alpha, straight};
use std::f32::consts::{PI, TAU};

/// Where the pixels of a row lie on the screen, px, and how much of it each is wide.
#[derive(Default)]
pub struct ScreenRow {
    pub x: Vec<f32>,
    pub y: Vec<f32>,
    pub wide: Vec<f32>,
}

/// What is found of a row before it is printed.
#[derive(Default)]
pub struct PrintedRow {
    /// Of each ink.
    tones: [Vec<f32>; 4],
    inks: [Vec<f32>; 4],
    /// Above which the ink of a dot lies.
    level: Vec<f32>,
}

/// A screen of an ink.
struct InkScreen {
    /// Along its rows or lines, cells.
    axes: Vec2,
    size: f32,
    /// No edge is narrower, px.
    edge_px: f32,
    /// How much of a pixel a tone covers of it where its dot is small.
    cell: f32,
}

impl Halftone {
    /// Prints a row of pixels.
    pub fn print_row(&self, at: &ScreenRow, row: &mut PrintedRow, pixels: &mut [[f32; 4]]) {
        let PrintedRow { tones, inks, level } = row;
        let count = if self.four_inks { 4 } else { 1 };
        for tones in &mut tones[..count] {
            tones.resize(pixels.len(), 0.0);
        }
        match tones {
            [cyan, magenta, yellow, black] if self.four_inks => {
                part_inks(pixels, [cyan, magenta, yellow, black]);
            }
            [tone, ..] => find_tones(pixels, tone),
        }
        for (i, (tones, inks)) in tones.iter().zip(inks.iter_mut()).take(count).enumerate() {
            let turn = if self.four_inks { Self::TURNS[i] - Self::TURNS[3] } else { 0.0 };
            self.ink_row(turn, at, tones, level, inks);
        }
        let [ink, paper] =
            [self.ink, self.paper].map(|c| [c.r, c.g, c.b].map(|v| f32::from(v) / 255.0));
        let [a, b, c, d] = &*inks;
        match (self.four_inks, self.transparent) {
            (true, is_bare) => lay_inks(pixels, [a, b, c, d], is_bare),
            (false, true) => lay_ink(pixels, a, ink),
            (false, false) => mix_ink(pixels, a, ink, paper),
        }
    }

    /// How much of each pixel is inked.
    fn ink_row(
        &self,
        turn_deg: f32,
        at: &ScreenRow,
        tones: &[f32],
        level: &mut Vec<f32>,
        inks: &mut Vec<f32>,
    ) {
        inks.clear();
        inks.extend_from_slice(tones);
        if self.size <= 1.0 {
            // Finer than the pixels, as in a small preview: only its mean is seen.
            return;
        }
        let screen = InkScreen {
            axes: self.axes(turn_deg),
            size: self.size,
            edge_px: 0.25 * self.size * self.softness / 100.0,
            cell: if self.lines { self.size } else { self.size * self.size },
        };
        if self.lines {
            return ink_lines(&screen, (&at.x, &at.y, &at.wide), inks);
        }
        let known = levels();
        level.clear();
        level.extend(tones.iter().map(|tone| {
            let place = tone.max(0.0).min(1.0) * TONE_LEVELS as f32;
            let i = (place as usize).min(TONE_LEVELS - 1);
            known[i] + (known[i + 1] - known[i]) * (place - i as f32)
        }));
        ink_dots(&screen, (&at.x, &at.y, &at.wide), level, inks);
    }
}

/// How much of a pixel so far within the ink is inked.
#[inline(always)]
fn ink_of(screen: &InkScreen, inside_px: f32, wide: f32, tone: f32) -> f32 {
    let edge_px = fast::max(wide, screen.edge_px);
    let ink = fast::min(fast::max(0.5 + inside_px / edge_px, 0.0), 1.0);
    let ink = fast::min(ink, tone * screen.cell);
    let ink = fast::max(ink, 1.0 - (1.0 - tone) * screen.cell);
    let ink = if tone < LEAST_TONE { 0.0 } else { ink };
    if tone > 1.0 - LEAST_TONE { 1.0 } else { ink }
}

#[inline(always)]
fn within_unit(v: f32) -> f32 {
    v.max(0.0).min(1.0)
}

crate::widest! {
    /// `inks`: the tones at first.
    fn ink_lines(screen: &InkScreen, at: (&[f32], &[f32], &[f32]), inks: &mut [f32]) {
        let Vec2 { x: along, y: across } = screen.axes;
        for (((ink, x), y), wide) in inks.iter_mut().zip(at.0).zip(at.1).zip(at.2) {
            let v = x * across + y * along;
            let from_middle = (v - v.floor() - 0.5).abs();
            let inside_px = (0.5 * *ink - from_middle) * screen.size;
            *ink = ink_of(screen, inside_px, *wide, *ink);
        }
    }

    /// `inks`: the tones at first.
    fn ink_dots(screen: &InkScreen, at: (&[f32], &[f32], &[f32]), level: &[f32], inks: &mut [f32]) {
        let Vec2 { x: along, y: across } = screen.axes;
        let places = at.0.iter().zip(at.1).zip(at.2).zip(level);
        for (ink, (((x, y), wide), level)) in inks.iter_mut().zip(places) {
            let (sin_x, cos_x) = fast::sin_cos_of_turn(x * along - y * across);
            let (sin_y, cos_y) = fast::sin_cos_of_turn(x * across + y * along);
            let above = 0.5 * (cos_x + cos_y) - level;
            let usual = TAU * fast::max(1.0 - level.abs(), 1e-4).sqrt();
            let slope = fast::max(PI * (sin_x * sin_x + sin_y * sin_y).sqrt(), 0.4 * usual);
            let inside_px = above / slope * screen.size;
            *ink = ink_of(screen, inside_px, *wide, *ink);
        }
    }

    /// How dark each pixel is.
    fn find_tones(pixels: &[[f32; 4]], tones: &mut [f32]) {
        for (tone, pixel) in tones.iter_mut().zip(pixels) {
            let [r, g, b] = straight(*pixel);
            let (r, g, b) = (within_unit(r), within_unit(g), within_unit(b));
            *tone = (1.0 - (0.3 * r + 0.59 * g + 0.11 * b)).max(0.0).min(1.0);
        }
    }

    /// The tones of cyan, magenta, yellow and black.
    fn part_inks(pixels: &[[f32; 4]], tones: [&mut [f32]; 4]) {
        let [cyan, magenta, yellow, dark] = tones;
        for (i, pixel) in pixels.iter().enumerate() {
            let [r, g, b] = straight(*pixel);
            let (r, g, b) = (within_unit(r), within_unit(g), within_unit(b));
            let black = 1.0 - r.max(g).max(b);
            let left = 1.0 - black;
            let of = |v: f32| {
                let part = (1.0 - v - black) / fast::max(left, 1e-9);
                if black < 1.0 { part.max(0.0).min(1.0) } else { 0.0 }
            };
            (cyan[i], magenta[i], yellow[i], dark[i]) = (of(r), of(g), of(b), black);
        }
    }

    /// Pixels in an ink, and nothing else.
    fn lay_ink(pixels: &mut [[f32; 4]], shares: &[f32], ink: [f32; 3]) {
        for (pixel, share) in pixels.iter_mut().zip(shares) {
            *pixel = color_under_alpha(ink, pixel[3] * share);
        }
    }

    /// Pixels in an ink, on paper.
    fn mix_ink(pixels: &mut [[f32; 4]], shares: &[f32], ink: [f32; 3], paper: [f32; 3]) {
        for (pixel, share) in pixels.iter_mut().zip(shares) {
            let mut mixed = paper;
            for k in 0..3 {
                mixed[k] += (ink[k] - paper[k]) * share;
            }
            *pixel = color_under_alpha(mixed, pixel[3]);
        }
    }

    /// Pixels in four inks.
    fn lay_inks(pixels: &mut [[f32; 4]], inks: [&[f32]; 4], is_bare: bool) {
        for (i, pixel) in pixels.iter_mut().enumerate() {
            let left = 1.0 - inks[3][i];
            let light = [
                (1.0 - inks[0][i]) * left,
                (1.0 - inks[1][i]) * left,
                (1.0 - inks[2][i]) * left,
            ];
            // The least opaque color that looks so on white.
            let covered = 1.0 - light[0].min(light[1]).min(light[2]);
            let own = |v: f32| if covered > 0.0 { 1.0 - (1.0 - v) / covered } else { 0.0 };
            *pixel = match is_bare {
                true => color_under_alpha(
                    [own(light[0]), own(light[1]), own(light[2])],
                    pixel[3] * covered,
                ),
                false => color_under_alpha(light, pixel[3]),
            };
        }
    }
}
