//! Screens by their values, and rows against the pixels that read like the text.

use super::*;
use crate::math::Size;
use crate::paint::filter::FilterWindow;
use crate::paint::filter::sharpen::{color_under_alpha, straight};
use std::f32::consts::{PI, TAU};

const RECT: Rect = Rect::new(0, 0, 128, 128);

fn print(halftone: Halftone, color: [f32; 4]) -> Vec<[f32; 4]> {
    let scene = Scene { size: Size::new(128, 128), surface: None };
    let source = FilterWindow::new(RECT, vec![color; RECT.width() * RECT.height()]);
    halftone.apply(&FilterPlace::new(&scene, RECT, 1.0), &source)
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
        assert!(print(halftone, [0.0, 0.0, 0.0, 1.0]).iter().all(|p| *p == [0.0, 0.0, 0.0, 1.0]));
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

/// A pixel by itself, as the text above says.
impl Halftone {
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

fn level_of(tone: f32) -> f32 {
    let place = tone.max(0.0).min(1.0) * TONE_LEVELS as f32;
    let i = (place as usize).min(TONE_LEVELS - 1);
    levels()[i] + (levels()[i + 1] - levels()[i]) * (place - i as f32)
}

#[test]
fn rows_print_what_each_pixel_prints() {
    use crate::math::hash;
    let scene = Scene { size: Size::new(128, 128), surface: None };
    let pixel = |i: usize| {
        let byte = |c: u32| hash::unit(5, i as u32, c);
        // Some black, some white, some bare.
        let tone = |c: u32| match i % 11 {
            0 => 0.0,
            1 => 1.0,
            _ => byte(c),
        };
        let a = if i.is_multiple_of(7) { 0.0 } else { byte(3) };
        [tone(0) * a, tone(1) * a, tone(2) * a, a]
    };
    let pixels: Vec<[f32; 4]> = (0..128 * 128).map(pixel).collect();
    let source = FilterWindow::new(RECT, pixels.clone());
    for flags in 0..8 {
        let [lines, four_inks, transparent] = [1, 2, 4].map(|bit| flags & bit != 0);
        for (size, angle, softness) in [(1.0, 20.0, 0.0), (4.3, -71.0, 0.0), (19.0, 33.0, 60.0)] {
            let plain = Halftone { lines, four_inks, transparent, ..Halftone::default() };
            let halftone = Halftone {
                size,
                angle,
                softness,
                ink: Color::rgb(20, 40, 160),
                paper: Color::rgb(250, 240, 200),
                ..plain
            };
            let place = FilterPlace::new(&scene, RECT, 1.0);
            for (i, (found, own)) in halftone.apply(&place, &source).iter().zip(&pixels).enumerate()
            {
                let at = vec2((i % 128) as f32 + 0.5, (i / 128) as f32 + 0.5);
                let wanted = halftone.printed(straight(*own), own[3], at, 1.0);
                for k in 0..4 {
                    let off = (found[k] - wanted[k]).abs();
                    assert!(off < 2e-3, "{halftone:?} at {at}: {found:?}, {wanted:?}");
                }
            }
        }
    }
}
