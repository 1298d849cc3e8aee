//! Halftone screens: tone as dots or lines of ink, as print has it. Floor 3. A pure function of the
//! place in the document and of the tone there.
//!
//! What a tone of t covers is t of the area, by encoded values: 50 % gray covers half. A screen is a
//! periodic height, and the ink lies where it is above a level. For dots it is (cos x + cos y) / 2:
//! round dots in light tones, a checkerboard at one half, round holes in dark ones.

use super::sharpen::{color_under_alpha, straight};
use super::window::FilterSource;
use super::{FilterKernel, FilterPlace};
use crate::math::srgb::Color;
use crate::math::{Rect, Vec2, vec2};
use crate::paint::adjustment::parameters::{
    NumberParameter, ParameterVisitor, Parameters, parameter_name,
};
use crate::surface::operator::UnwrapSettings;
use crate::surface::{Scene, unwrap::Unwrapping};
use std::f32::consts::{PI, TAU};
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

    /// How much of a pixel is inked, `[0, 1]`.
    ///
    /// * `at`: where it is, px. `axes`: of the screen. `wide`: how much of the screen it is wide, px.
    fn ink_at(&self, at: Vec2, axes: Vec2, tone: f32, wide: f32) -> f32 {
        if tone < LEAST_TONE {
            return 0.0;
        }
        if tone > 1.0 - LEAST_TONE {
            return 1.0;
        }
        if self.size <= 1.0 {
            // Finer than the pixels, as in a small preview: only its mean is seen.
            return tone;
        }
        // Counter-clockwise as seen is clockwise in y-down coordinates.
        let in_cells = vec2(at.x * axes.x - at.y * axes.y, at.x * axes.y + at.y * axes.x);
        let inside_px = match self.lines {
            true => {
                let from_middle = (in_cells.y - in_cells.y.floor() - 0.5).abs();
                (0.5 * tone - from_middle) * self.size
            }
            false => self.inside_dot_px(in_cells, tone),
        };
        let edge_px = wide.max(0.25 * self.size * self.softness / 100.0);
        let ink = (0.5 + inside_px / edge_px).max(0.0).min(1.0);
        // A dot, a line or a gap that is smaller than a pixel covers no more of it than it has.
        let cell = if self.lines { self.size } else { self.size * self.size };
        ink.min(tone * cell).max(1.0 - (1.0 - tone) * cell)
    }

    /// How far within the ink of a dot a point lies, px; negative outside.
    fn inside_dot_px(&self, at: Vec2, tone: f32) -> f32 {
        let [x, y] = [at.x, at.y].map(|v| TAU * (v - v.floor()));
        let ((sin_x, cos_x), (sin_y, cos_y)) = (x.sin_cos(), y.sin_cos());
        let level = level_of(tone);
        let above = 0.5 * (cos_x + cos_y) - level;
        // About a dot of radius r the height is 1 − π² r²: its slope at the edge, and less of it
        // where neighbors meet and the height is level.
        let usual = TAU * (1.0 - level.abs()).max(1e-4).sqrt();
        let slope = (PI * (sin_x * sin_x + sin_y * sin_y).sqrt()).max(0.4 * usual);
        above / slope * self.size
    }

    fn unwrapping(&self, scene: &Scene) -> Option<Arc<Unwrapping>> {
        let surface = scene.surface.as_ref().filter(|_| self.on_surface)?;
        Some(surface.unwrapping(UnwrapSettings { amount: 1.0, smooth_px: 0.0 }))
    }

    /// A straight color in ink.
    fn printed(&self, color: [f32; 3], a: f32, at: Vec2, wide: f32) -> [f32; 4] {
        let limit = |v: f32| v.max(0.0).min(1.0);
        let [r, g, b] = color.map(limit);
        if self.four_inks {
            let black = 1.0 - r.max(g).max(b);
            let of = |v: f32| if black < 1.0 { (1.0 - v - black) / (1.0 - black) } else { 0.0 };
            let tones = [of(r), of(g), of(b), black];
            let mut inks = [0.0; 4];
            for (ink, (tone, turn)) in inks.iter_mut().zip(tones.into_iter().zip(Self::TURNS)) {
                *ink = self.ink_at(at, self.axes(turn - Self::TURNS[3]), limit(tone), wide);
            }
            let [cyan, magenta, yellow, black] = inks;
            let light = [cyan, magenta, yellow].map(|ink| (1.0 - ink) * (1.0 - black));
            if self.transparent {
                // The least opaque color that looks so on white.
                let covered = 1.0 - light[0].min(light[1]).min(light[2]);
                let own = |v: f32| if covered > 0.0 { 1.0 - (1.0 - v) / covered } else { 0.0 };
                return color_under_alpha(light.map(own), a * covered);
            }
            return color_under_alpha(light, a);
        }
        let tone = limit(1.0 - (0.3 * r + 0.59 * g + 0.11 * b));
        let share = self.ink_at(at, self.axes(0.0), tone, wide);
        let [ink, paper] =
            [self.ink, self.paper].map(|c| [c.r, c.g, c.b].map(|v| f32::from(v) / 255.0));
        if self.transparent {
            return color_under_alpha(ink, a * share);
        }
        let mut mixed = paper;
        for k in 0..3 {
            mixed[k] += (ink[k] - paper[k]) * share;
        }
        color_under_alpha(mixed, a)
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
        for (y, row) in (out.y0..out.y1).zip(all.chunks_exact_mut(out.width().max(1))) {
            for (x, pixel) in (out.x0..out.x1).zip(row) {
                if pixel[3] <= 0.0 {
                    continue;
                }
                let plain = (vec2(x as f32 + 0.5, y as f32 + 0.5), 1.0);
                let on_sheet = unwrapped.as_ref().and_then(|sheet| sheet_at(place, sheet, x, y));
                let (at, wide) = on_sheet.unwrap_or(plain);
                *pixel = self.printed(straight(*pixel), pixel[3], at, wide);
            }
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
const LEVELS: usize = 512;

/// The level above which a share of the area of (cos x + cos y) / 2 lies.
fn level_of(tone: f32) -> f32 {
    static LEVEL: OnceLock<Vec<f32>> = OnceLock::new();
    let levels = LEVEL.get_or_init(make_levels);
    let place = tone.max(0.0).min(1.0) * LEVELS as f32;
    let i = (place as usize).min(LEVELS - 1);
    levels[i] + (levels[i + 1] - levels[i]) * (place - i as f32)
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
        let wanted = i as f64 / LEVELS as f64;
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
    (0..=LEVELS).map(level).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;
    use crate::paint::filter::FilterWindow;

    const RECT: Rect = Rect::new(0, 0, 128, 128);

    fn print(halftone: Halftone, color: [f32; 4]) -> Vec<[f32; 4]> {
        let scene = Scene { size: Size::new(128, 128), surface: None };
        let source = FilterWindow::new(RECT, vec![color; RECT.width() * RECT.height()]);
        halftone.apply(&FilterPlace { scene: &scene, out: RECT, brightest: 1.0 }, &source)
    }

    fn mean(pixels: &[[f32; 4]], channel: usize) -> f32 {
        pixels.iter().map(|p| p[channel]).sum::<f32>() / pixels.len() as f32
    }

    #[test]
    fn a_tone_covers_its_share_of_the_area() {
        for lines in [false, true] {
            for (size, angle) in [(16.0, 0.0), (8.0, 45.0), (11.0, 30.0)] {
                for tone in [0.1, 0.25, 0.5, 0.75, 0.9] {
                    let halftone = Halftone { size, angle, lines, ..Halftone::default() };
                    let found =
                        1.0 - mean(&print(halftone, [1.0 - tone, 1.0 - tone, 1.0 - tone, 1.0]), 0);
                    assert!((found - tone).abs() < 0.03, "{lines} {size} {angle} {tone}: {found}");
                }
            }
        }
    }

    #[test]
    fn black_white_and_nothing_stay() {
        for four_inks in [false, true] {
            let halftone = Halftone { four_inks, ..Halftone::default() };
            assert!(print(halftone, [1.0; 4]).iter().all(|p| *p == [1.0; 4]));
            assert!(
                print(halftone, [0.0, 0.0, 0.0, 1.0]).iter().all(|p| *p == [0.0, 0.0, 0.0, 1.0])
            );
            assert!(print(halftone, [0.0; 4]).iter().all(|p| *p == [0.0; 4]));
        }
    }

    #[test]
    fn lines_run_along_their_angle_and_dots_lie_in_cells() {
        let level = Halftone { size: 8.0, angle: 0.0, lines: true, ..Halftone::default() };
        let pixels = print(level, [0.5, 0.5, 0.5, 1.0]);
        let at = |x: usize, y: usize| pixels[y * 128 + x][0];
        // Half of each cell of 8 px: rows 2 to 5.
        for x in [0, 40, 101] {
            let rows: Vec<f32> = (0..8).map(|y| (at(x, y) * 1e3).round()).collect();
            assert_eq!(rows, [1e3, 1e3, 0.0, 0.0, 0.0, 0.0, 1e3, 1e3]);
        }
        let dots = Halftone { size: 16.0, angle: 0.0, ..Halftone::default() };
        let pixels = print(dots, [0.8, 0.8, 0.8, 1.0]);
        let at = |x: usize, y: usize| pixels[y * 128 + x][0];
        assert_eq!([at(0, 0), at(15, 15), at(16, 31)], [0.0; 3]);
        assert_eq!([at(8, 8), at(24, 8)], [1.0; 2]);
    }

    #[test]
    fn the_inks_of_colors_and_paper_are_what_they_are_said_to_be() {
        let red = Color::rgb(255, 0, 0);
        let single = Halftone { ink: red, transparent: true, ..Halftone::default() };
        let pixels = print(single, [0.5, 0.5, 0.5, 1.0]);
        assert!(pixels.iter().all(|p| p[0] == p[3] && p[1] == 0.0));
        assert!((mean(&pixels, 3) - 0.5).abs() < 0.03);
        let four = Halftone { four_inks: true, size: 7.0, ..Halftone::default() };
        let color = [0.8, 0.5, 0.3, 1.0];
        let pixels = print(four, color);
        for (k, wanted) in color.iter().enumerate().take(3) {
            assert!((mean(&pixels, k) - wanted).abs() < 0.04, "{k}: {}", mean(&pixels, k));
        }
        let bare = print(Halftone { transparent: true, ..four }, color);
        for (a, b) in pixels.iter().zip(&bare) {
            (0..3).for_each(|k| assert!((b[k] + 1.0 - b[3] - a[k]).abs() < 1e-5, "{a:?} {b:?}"));
        }
    }
}
