//! Halftone screens: tone as dots or lines of ink, as print has it. Floor 3. A pure function of the
//! place in the document and of the tone there.
//!
//! What a tone of t covers is t of the area, by encoded values: 50 % gray covers half. A screen is a
//! periodic height, and the ink lies where it is above a level. For dots it is (cos x + cos y) / 2:
//! round dots in light tones, a checkerboard at one half, round holes in dark ones.
//!
//! A pixel is printed as `printed` reads; `rows` computes the same along rows.

mod rows;

use super::window::FilterSource;
use super::{FilterKernel, FilterPlace};
use crate::math::srgb::Color;
use crate::math::{Rect, Vec2, vec2};
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};
use crate::surface::operator::UnwrapSettings;
use crate::surface::{Scene, unwrap::Unwrapping};
use rows::{PrintedRow, ScreenRow};
use std::sync::{Arc, OnceLock};

/// Tone as dots or lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Halftone {
    /// From dot to dot, or from line to line, px.
    pub size: f32,
    /// Of the rows of dots, or of the lines; degrees, counter-clockwise from the right.
    pub angle: f32,
    /// How wide their edges are, percent of a quarter of the size; 0: a pixel.
    pub softness: f32,
    /// Lines, and not dots.
    pub lines: bool,
    /// Four screens of cyan, magenta, yellow and black, and not one of a single ink.
    pub four_inks: bool,
    /// Of a single one.
    pub ink: Color,
    /// What is between it.
    pub paper: Color,
    /// Nothing is between it.
    pub transparent: bool,
    /// It lies on the shape, and not on the canvas.
    pub on_surface: bool,
}

impl Halftone {
    const DEFAULT: Self = Self {
        size: 8.0,
        angle: 45.0,
        softness: 0.0,
        lines: false,
        four_inks: false,
        ink: Color::BLACK,
        paper: Color::WHITE,
        transparent: false,
        on_surface: false,
    };

    /// The screens of cyan, magenta, yellow and black are turned by so much more, degrees.
    const TURNS: [f32; 4] = [15.0, 75.0, 0.0, 45.0];

    /// The frame of a screen: x along its rows or lines.
    fn axes(&self, turn_deg: f32) -> Vec2 {
        Vec2::from_angle((self.angle + turn_deg).to_radians()) / self.size.max(0.01)
    }

    fn unwrapping(&self, scene: &Scene) -> Option<Arc<Unwrapping>> {
        let surface = scene.surface.as_ref().filter(|_| self.on_surface)?;
        Some(surface.unwrapping(UnwrapSettings { amount: 1.0, smooth_px: 0.0 }))
    }
}

impl Default for Halftone {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Parameters for Halftone {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        let plain = Self::DEFAULT;
        let size = parameter_name("size", "Size", "From dot to dot, or from line to line");
        v.number(
            NumberParameter::whole(size, 2.0, 500.0, plain.size).decimals(1).px(),
            &mut self.size,
        );
        let angle =
            parameter_name("angle", "Angle", "Of the rows of dots or of the lines, degrees");
        let angle = NumberParameter::around(angle, 180.0).decimals(1);
        v.number(NumberParameter { default: plain.angle, ..angle }, &mut self.angle);
        let soft =
            parameter_name("softness", "Softness", "Of the edges of dots and lines, percent");
        v.number(NumberParameter::whole(soft, 0.0, 100.0, plain.softness), &mut self.softness);
        v.flag(
            parameter_name("lines", "Lines", "Lines, and not dots"),
            plain.lines,
            &mut self.lines,
        );
        let hint = "Screens of cyan, magenta, yellow and black, each at its own angle";
        v.flag(
            parameter_name("four_inks", "Four inks", hint),
            plain.four_inks,
            &mut self.four_inks,
        );
        v.color(parameter_name("ink", "Ink", "Of a single screen"), plain.ink, &mut self.ink);
        let paper =
            parameter_name("paper", "Paper", "Between the dots or lines of a single screen");
        v.color(paper, plain.paper, &mut self.paper);
        let hint = "Nothing is between the ink: what lies beneath is seen";
        v.flag(
            parameter_name("transparent", "No paper", hint),
            plain.transparent,
            &mut self.transparent,
        );
        let hint = "The screen lies on the shape and is bent and foreshortened with it";
        v.flag(
            parameter_name("on_surface", "On the surface", hint),
            plain.on_surface,
            &mut self.on_surface,
        );
    }
}

impl FilterKernel for Halftone {
    fn reach(&self, _: Rect, _: Rect) -> f32 {
        0.0
    }

    fn warm(&self, scene: &Scene) {
        let _ = self.unwrapping(scene);
    }

    fn apply(&self, place: &FilterPlace, source: &dyn FilterSource) -> Vec<[f32; 4]> {
        let (out, unwrapped) = (place.out, self.unwrapping(place.scene));
        let mut all = source.window(out).cropped(out);
        let (mut at, mut printed) = (ScreenRow::default(), PrintedRow::default());
        at.x.extend((out.x0..out.x1).map(|x| x as f32 + 0.5));
        at.wide.resize(out.width(), 1.0);
        for (y, row) in (out.y0..out.y1).zip(all.chunks_exact_mut(out.width().max(1))) {
            at.y.clear();
            at.y.resize(out.width(), y as f32 + 0.5);
            if let Some(sheet) = &unwrapped {
                for (i, x) in (out.x0..out.x1).enumerate() {
                    let plain = (vec2(x as f32 + 0.5, y as f32 + 0.5), 1.0);
                    let (own, wide) = sheet_at(place, sheet, x, y).unwrap_or(plain);
                    (at.x[i], at.y[i], at.wide[i]) = (own.x, own.y, wide);
                }
            }
            self.print_row(&at, &mut printed, row);
        }
        all
    }
}

/// Where a pixel of the surface lies on the unwrapped one, and how wide it is there, px.
fn sheet_at(place: &FilterPlace, sheet: &Unwrapping, x: i32, y: i32) -> Option<(Vec2, f32)> {
    /// A pixel at a contour is no wider, px.
    const WIDEST: f32 = 16.0;
    let at = |x: i32, y: i32| place.on_surface(x, y).map(|(x, y)| sheet.at(x, y));
    let own = at(x, y)?;
    let steps = [(1, 0), (0, 1)].map(|(dx, dy)| at(x + dx, y + dy));
    let widths = steps.into_iter().flatten().map(|next| next.distance(own));
    let wide = widths.filter(|wide| *wide <= WIDEST).fold(1.0, f32::max);
    Some((own, wide))
}

/// A lighter tone is paper, and one as near to black is ink: less than a quarter of a level.
const LEAST_TONE: f32 = 1.0 / 1024.0;

/// Tones whose levels are kept.
const TONE_LEVELS: usize = 512;

/// The level above which a share of the area of (cos x + cos y) / 2 lies, for shares from 0 to 1.
fn levels() -> &'static [f32] {
    static LEVELS: OnceLock<Vec<f32>> = OnceLock::new();
    LEVELS.get_or_init(make_levels)
}

fn make_levels() -> Vec<f32> {
    /// Columns in which areas are summed.
    const COLUMNS: usize = 256;
    let share_above = |level: f64| {
        let column = |i: usize| {
            let x = std::f64::consts::PI * (i as f64 + 0.5) / COLUMNS as f64;
            (2.0 * level - x.cos()).max(-1.0).min(1.0).acos() / std::f64::consts::PI
        };
        (0..COLUMNS).map(column).sum::<f64>() / COLUMNS as f64
    };
    let level = |i: usize| {
        let wanted = i as f64 / TONE_LEVELS as f64;
        // The share falls as the level rises.
        let (mut low, mut high) = (-1.0, 1.0);
        for _ in 0..24 {
            let middle = 0.5 * (low + high);
            match share_above(middle) > wanted {
                true => low = middle,
                false => high = middle,
            }
        }
        (0.5 * (low + high)) as f32
    };
    (0..=TONE_LEVELS).map(level).collect()
}

#[cfg(test)]
mod tests;
