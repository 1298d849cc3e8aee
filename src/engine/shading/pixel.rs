//! Pixel shading: the painter's light in a few tones of each color, without soft edges, as small
//! pictures are drawn by hand. Floor 3. Not here: the light itself (`material::painter`).

use crate::math::oklab;
use crate::math::srgb::{self, Color};
use crate::math::{Range, UNIT};

/// How the painter's light is divided into tones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PixelShading {
    /// Tones of each color; 0: light is smooth.
    pub bands: u32,
    /// How far two tones mix, pixel by pixel, where one becomes the other, `[0, 1]`.
    pub dither: f32,
    /// The picture's colors: tones are taken from them where one is near. None: all are made.
    pub colors: Vec<Color>,
}

/// A step of light: tones lighter than the color, or darker.
type Step = i32;

/// Where light, as a share of that on a level part, goes from one step to the next.
const STEPS: [&[(f32, Step)]; 4] = [
    &[(0.0, -1), (0.72, 0)],
    &[(0.0, -1), (0.72, 0), (1.2, 1)],
    &[(0.0, -2), (0.46, -1), (0.78, 0), (1.2, 1)],
    &[(0.0, -2), (0.46, -1), (0.78, 0), (1.13, 1), (1.28, 2)],
];
/// A step darker leaves this share of the lightness; one lighter takes this share of what is
/// missing to white.
const DARKER: f32 = 0.8;
const LIGHTER: f32 = 0.38;
/// What a step adds to a and b: shadows are cooler, light is warmer.
const COOLER: [f32; 2] = [0.006, -0.026];
const WARMER: [f32; 2] = [0.0, 0.014];
/// What a step lighter leaves of the chroma.
const PALER: f32 = 0.86;
/// Colors darker than this are lines: they stay, OKLab's lightness.
const LINE: f32 = 0.3;
/// A color of the picture this far from the made tone takes its place.
const NEAR: f32 = 0.15;
/// Tones differ in lightness by this at least.
const LEAST_STEP: f32 = 0.025;
/// Pixels on one side of a checkerboard are as much darker as this share of a step of light.
const CHECKER: f32 = 0.12;

impl PixelShading {
    /// What `bands` may be, if light is not smooth.
    pub const BANDS: std::ops::RangeInclusive<u32> = 2..=5;
    /// Tones of a drawing that was not shaded yet.
    pub const USUAL_BANDS: u32 = 3;
    /// What `dither` may be.
    pub const DITHER: Range = UNIT;
    /// The most colors of a picture.
    pub const MOST_COLORS: usize = 256;

    /// Whether light is divided.
    pub fn is_on(&self) -> bool {
        Self::BANDS.contains(&self.bands)
    }

    /// The step of light at a pixel.
    ///
    /// * `light`: as a share of that on a level part.
    /// * `is_odd`: of which color of a checkerboard the pixel is.
    pub fn step(&self, light: f32, is_odd: bool) -> Step {
        let table = STEPS[(self.bands.clamp(2, 5) - 2) as usize];
        let moved = light + self.dither * if is_odd { CHECKER } else { -CHECKER };
        let reached = table.iter().rev().find(|(from, _)| moved >= *from);
        reached.map_or(table[0].1, |(_, step)| *step)
    }

    /// The tone of a color at a step: of the picture's colors, or made.
    ///
    /// Colors that the picture lacks, as soft marks leave them, get tones as far from those of the
    /// nearest color of the picture as they are from it, so that marks have no rings.
    pub fn tone(&self, of: [u8; 3], step: Step) -> [u8; 3] {
        let own = lab(of);
        if step == 0 || own[0] < LINE {
            return of;
        }
        let made = shift_tone(own, step);
        let Some((base, off)) = self.nearest(own, |_| true).filter(|(_, off)| *off < NEAR) else {
            return bytes(made);
        };
        let of_base = self.tone_of_picture(base, step);
        if base == of {
            return of_base;
        }
        let (found, made_of_base) = (lab(of_base), shift_tone(lab(base), step));
        let share = 1.0 - off / NEAR;
        bytes(std::array::from_fn(|i| made[i] + share * (found[i] - made_of_base[i])))
    }

    /// The tone of one of the picture's colors.
    fn tone_of_picture(&self, color: [u8; 3], step: Step) -> [u8; 3] {
        let own = lab(color);
        let made = shift_tone(own, step);
        let is_further = |lightness: f32| {
            let by = LEAST_STEP * step as f32;
            if step < 0 { lightness < own[0] + by } else { lightness > own[0] + by }
        };
        match self.nearest(made, is_further) {
            Some((tone, off)) if off < NEAR => tone,
            _ => bytes(made),
        }
    }

    /// The nearest of the picture's colors of some lightness, lines left out, and how far it is.
    fn nearest(&self, to: [f32; 3], is_meant: impl Fn(f32) -> bool) -> Option<([u8; 3], f32)> {
        self.colors
            .iter()
            .map(|color| [color.r, color.g, color.b])
            .map(|color| (color, lab(color)))
            .filter(|(_, found)| is_meant(found[0]) && found[0] >= LINE)
            .map(|(color, found)| (color, distance(found, to)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

fn bytes(color: [f32; 3]) -> [u8; 3] {
    oklab::to_linear(color).map(|v| srgb::quantize(srgb::encode(v.clamp(0.0, 1.0))))
}

fn lab(color: [u8; 3]) -> [f32; 3] {
    oklab::from_linear(color.map(srgb::decode_u8))
}

/// Other hues are farther away than other lightness: a red cap does not shine like skin.
fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    const HUE: f32 = 2.0;
    let off = |i: usize, by: f32| (by * (a[i] - b[i])).powi(2);
    (off(0, 1.0) + off(1, HUE) + off(2, HUE)).sqrt()
}

/// A color some steps lighter and warmer, or darker and cooler.
fn shift_tone([mut lightness, mut a, mut b]: [f32; 3], step: Step) -> [f32; 3] {
    for _ in 0..step.unsigned_abs().min(4) {
        if step < 0 {
            lightness *= DARKER;
            (a, b) = (a + COOLER[0], b + COOLER[1]);
        } else {
            lightness += (1.0 - lightness) * LIGHTER;
            (a, b) = (a * PALER + WARMER[0], b * PALER + WARMER[1]);
        }
    }
    [lightness, a, b]
}

/// Tones that were found, so that each is looked for once.
#[derive(Default)]
pub struct KnownTones(Vec<([u8; 3], Step, [u8; 3])>);

impl KnownTones {
    /// Tones that are remembered.
    const MOST: usize = 64;

    /// [`PixelShading::tone`].
    pub fn tone(&mut self, pixel: &PixelShading, of: [u8; 3], step: Step) -> [u8; 3] {
        if let Some(known) = self.0.iter().find(|known| (known.0, known.1) == (of, step)) {
            return known.2;
        }
        let tone = pixel.tone(of, step);
        if self.0.len() == Self::MOST {
            self.0.clear();
        }
        self.0.push((of, step, tone));
        tone
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SKIN: [u8; 3] = [0xe8, 0xb0, 0x90];

    fn pixel(bands: u32) -> PixelShading {
        PixelShading { bands, ..PixelShading::default() }
    }

    #[test]
    fn shade_is_darker_and_cooler_and_light_is_lighter() {
        let tones = [-2, -1, 0, 1, 2].map(|step| pixel(5).tone(SKIN, step));
        for pair in tones.windows(2) {
            assert!(lab(pair[0])[0] < lab(pair[1])[0] - 0.02, "{tones:?}");
        }
        let blueness = |tone: [u8; 3]| f32::from(tone[2]) / f32::from(tone[0]);
        assert!(blueness(tones[1]) > blueness(SKIN), "{tones:?}");
    }

    #[test]
    fn a_near_color_of_the_picture_is_taken_and_a_far_one_is_not() {
        let near = Color::rgb(0xb8, 0x80, 0x78);
        let skin = Color::rgb(SKIN[0], SKIN[1], SKIN[2]);
        let with = |other: Color| PixelShading { colors: vec![skin, other], ..pixel(3) };
        assert_eq!(with(near).tone(SKIN, -1), [near.r, near.g, near.b]);
        let far = with(Color::rgb(0x20, 0xa0, 0x30));
        assert_eq!(far.tone(SKIN, -1), pixel(3).tone(SKIN, -1));
    }

    #[test]
    fn a_soft_mark_has_no_ring_where_it_leaves_a_color_of_the_picture() {
        let colors = vec![Color::rgb(0xc8, 0x50, 0x3c), Color::rgb(0xe6, 0xd2, 0x5a)];
        let lit = PixelShading { colors, ..pixel(3) };
        let mark = [0x20u8, 0x30, 0x50].map(f32::from);
        let mixed = |share: f32| -> [u8; 3] {
            let red = [0xc8u8, 0x50, 0x3c].map(f32::from);
            std::array::from_fn(|i| (red[i] + share * (mark[i] - red[i])).round() as u8)
        };
        let tones: Vec<[u8; 3]> = (0..60).map(|i| lit.tone(mixed(i as f32 * 0.01), 1)).collect();
        for pair in tones.windows(2) {
            let off = (0..3).map(|i| pair[0][i].abs_diff(pair[1][i])).max().unwrap();
            assert!(off <= 8, "{pair:?}");
        }
    }

    #[test]
    fn red_does_not_become_skin_in_the_light() {
        let with_skin = PixelShading { colors: vec![Color::rgb(240, 190, 150)], ..pixel(3) };
        let red = [200, 60, 60];
        assert_eq!(with_skin.tone(red, 1), pixel(3).tone(red, 1));
    }

    #[test]
    fn lines_stay() {
        for step in [-2, -1, 1, 2] {
            assert_eq!(pixel(5).tone([0x18, 0x10, 0x20], step), [0x18, 0x10, 0x20]);
        }
    }

    #[test]
    fn there_are_as_many_steps_as_bands_and_level_parts_keep_their_color() {
        for bands in PixelShading::BANDS {
            let mut steps: Vec<i32> =
                (0..200).map(|i| pixel(bands).step(i as f32 * 0.01, false)).collect();
            assert_eq!(pixel(bands).step(1.0, true), 0);
            assert!(steps.is_sorted());
            steps.dedup();
            assert_eq!(steps.len(), bands as usize);
        }
    }

    #[test]
    fn dither_mixes_where_tones_meet() {
        let mixed = PixelShading { dither: 1.0, ..pixel(2) };
        assert!(mixed.step(0.72, true) != mixed.step(0.719, false));
        assert_eq!(mixed.step(1.0, true), mixed.step(1.0, false));
    }
}
