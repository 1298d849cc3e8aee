//! Tests of what all adjustments have in common, and of values computed by hand.

use super::*;
use crate::math::hash;
use crate::math::srgb::Color;
use crate::paint::GradientStop;
use crate::raster::{PlanarTile, TILE};

/// Every kind as it begins, and with other numbers.
fn samples() -> Vec<ColorAdjustment> {
    let mut all: Vec<ColorAdjustment> = ColorAdjustment::all().to_vec();
    for seed in 0..2 {
        for mut adjustment in ColorAdjustment::all() {
            adjustment.visit(&mut Turner(seed * 977));
            all.push(adjustment.clamp_to_ranges());
        }
    }
    all
}

/// Sets every parameter to something else.
struct Turner(u32);

impl Turner {
    fn share(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(1);
        (hash::mix(self.0) % 1000) as f32 / 999.0
    }
}

impl ParameterVisitor for Turner {
    fn number(&mut self, parameter: NumberParameter, value: &mut f32) {
        *value = parameter.least + (parameter.most - parameter.least) * self.share();
    }

    fn flag(&mut self, _: ParameterName, _: bool, value: &mut bool) {
        *value = self.share() > 0.5;
    }

    fn color(&mut self, _: ParameterName, _: Color, value: &mut Color) {
        value.r = (255.0 * self.share()) as u8;
    }

    fn curve(&mut self, _: ParameterName, value: &mut ToneCurve) {
        let mut point = |x| [x, 255.0 * self.share()];
        *value = ToneCurve::new(vec![point(0.0), point(90.0), point(140.0), point(255.0)]);
    }

    fn stops(&mut self, _: ParameterName, value: &mut Vec<GradientStop>) {
        value.push(GradientStop { t: self.share(), color: Color { r: 9, g: 200, b: 90, a: 128 } });
    }

    fn table(&mut self, _: ParameterName, value: &mut Option<ColorTable>) {
        let values = (0..81).map(|_| (65535.0 * self.share()) as u16).collect();
        *value = ColorTable::new("turned", 3, false, values);
    }

    fn group(&mut self, _: ParameterName, inside: &mut dyn FnMut(&mut dyn ParameterVisitor)) {
        inside(self);
    }
}

fn bytes(rgb: [f32; 3]) -> [i32; 3] {
    rgb.map(|v| (255.0 * v).round() as i32)
}

#[test]
fn rows_are_what_the_formula_says_and_keep_alpha() {
    for adjustment in samples() {
        let live = LiveAdjustment::new(adjustment.clone());
        let mut tile = PlanarTile::transparent();
        let value = |x: usize, y: usize, c: u32| {
            f32::from((hash::mix(x as u32 * 7919 + y as u32 * 131 + c) % 256) as u8) / 255.0
        };
        for (y, row) in tile.rows_mut().iter_mut().enumerate() {
            for x in 0..TILE {
                let a = if y % 3 == 0 { 1.0 } else { value(x, y, 3) };
                row.set(x, [value(x, y, 0) * a, value(x, y, 1) * a, value(x, y, 2) * a, a]);
            }
        }
        let before = tile.clone();
        live.apply(&mut tile);
        for (y, (row, was)) in tile.rows().iter().zip(before.rows()).enumerate().step_by(3) {
            for x in 0..TILE {
                let ([r, g, b, a], [r0, g0, b0, a0]) = (row.pixel(x), was.pixel(x));
                assert_eq!(a, a0);
                let meant = adjustment.color([r0, g0, b0]);
                let near = (0..3).all(|c| ([r, g, b][c] - meant[c]).abs() < 2e-4);
                assert!(near, "{adjustment:?} at {x}, {y}: {r} {g} {b}, not {meant:?}");
            }
        }
        for row in tile.rows() {
            let is_sane = |x| row.pixel(x)[..3].iter().all(|v| *v >= 0.0 && *v <= row.a[x]);
            assert!((0..TILE).all(is_sane), "{adjustment:?}");
        }
    }
}

#[test]
fn adjustments_begin_by_changing_little_where_that_is_possible() {
    for adjustment in ColorAdjustment::all() {
        let begins_neutral = !matches!(
            adjustment.name(),
            "black-white" | "photo-filter" | "invert" | "posterize" | "threshold" | "gradient-map"
        );
        for i in 0..64 {
            let rgb = [i % 4, i / 4 % 4, i / 16].map(|v| v as f32 / 3.0);
            let out = adjustment.color(rgb);
            if begins_neutral {
                assert_eq!(bytes(out), bytes(rgb), "{}", adjustment.name());
            }
        }
    }
}

#[test]
fn hostile_numbers_are_brought_into_range() {
    struct Hostile(f32);
    impl ParameterVisitor for Hostile {
        fn number(&mut self, _: NumberParameter, value: &mut f32) {
            *value = self.0;
        }

        fn flag(&mut self, _: ParameterName, _: bool, value: &mut bool) {
            *value = true;
        }

        fn color(&mut self, _: ParameterName, _: Color, _: &mut Color) {}

        fn curve(&mut self, _: ParameterName, _: &mut ToneCurve) {}

        fn stops(&mut self, _: ParameterName, value: &mut Vec<GradientStop>) {
            value.iter_mut().for_each(|stop| stop.t = self.0);
        }

        fn table(&mut self, _: ParameterName, _: &mut Option<ColorTable>) {}

        fn group(&mut self, _: ParameterName, inside: &mut dyn FnMut(&mut dyn ParameterVisitor)) {
            inside(self);
        }
    }
    for v in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30] {
        for mut adjustment in ColorAdjustment::all() {
            adjustment.visit(&mut Hostile(v));
            let held = adjustment.clamp_to_ranges();
            assert_eq!(held.clone().clamp_to_ranges(), held);
            for i in 0..64 {
                let rgb = [i % 4, i / 4 % 4, i / 16].map(|v| v as f32 / 3.0);
                assert!(held.color(rgb).iter().all(|v| (0.0..=1.0).contains(v)), "{held:?}");
            }
        }
    }
}

#[test]
fn every_kind_is_found_by_its_name() {
    for adjustment in ColorAdjustment::all() {
        assert_eq!(ColorAdjustment::from_name(adjustment.name()), Some(adjustment));
    }
}

#[test]
fn levels_stretch_between_black_and_white() {
    let range = LevelsRange { black: 51.0, white: 204.0, gamma: 2.0, ..LevelsRange::default() };
    // (89.25 − 51) / 153 = 1/4, and its root is 1/2.
    assert!((range.tone(0.35) - 0.5).abs() < 1e-5);
    assert_eq!((range.tone(0.1), range.tone(0.9)), (0.0, 1.0));
    let narrow = LevelsRange { out_black: 255.0, out_white: 0.0, ..LevelsRange::default() };
    assert_eq!(narrow.tone(1.0), 0.0);
}

#[test]
fn posterized_bytes_on_a_step_are_not_rounded_below_it() {
    let posterize = Posterize { levels: 4.0, ..Posterize::default() };
    for (byte, step) in
        [(0, 0.0), (63, 0.0), (64, 1.0), (127, 1.0), (128, 2.0), (192, 3.0), (255, 3.0)]
    {
        assert_eq!(posterize.tone(byte as f32 / 255.0), step / 3.0, "{byte}");
    }
}

#[test]
fn values_between_bytes_are_posterized_in_equal_parts() {
    let halves = Posterize { levels: 2.0, ..Posterize::default() };
    assert_eq!([32_767.0, 32_768.0].map(|v| halves.tone(v / 65535.0)), [0.0, 1.0]);
    // A third is a byte, which stays below, and not a value a little above it.
    let thirds = Posterize { levels: 3.0, ..Posterize::default() };
    assert_eq!([21_845.0, 21_846.0].map(|v| thirds.tone(v / 65535.0)), [0.0, 0.5]);
    let fine = Posterize { of_16_bits: true, ..thirds };
    assert_eq!([21_844.0, 21_845.0].map(|v| fine.tone(v / 65535.0)), [0.0, 0.5]);
}

/// Tones of a picture that Photoshop made, brightness −23 and contrast −26.
#[test]
fn old_contrast_below_zero_draws_tones_together_before_they_are_shifted() {
    let own = BrightnessContrast { brightness: -23.0, contrast: -26.0, legacy: true };
    let tone = own.tone();
    for (before, after) in
        [(3.0, 12.0), (43.0, 42.0), (103.0, 86.0), (143.0, 116.0), (225.0, 177.0)]
    {
        let found = 255.0 * tone(before / 255.0);
        assert!((found - after).abs() < 0.8, "{before}: {found} instead of {after}");
    }
}

#[test]
fn a_stop_of_exposure_doubles_the_light() {
    let tone = Exposure { exposure: 1.0, ..Exposure::default() }.tone(0.5);
    assert!((tone - 0.5 * 2f32.powf(1.0 / 2.2)).abs() < 1e-6);
}

#[test]
fn hues_turn_and_grays_stay() {
    let turned = HueSaturation {
        master: HslShift { hue: 120.0, ..HslShift::default() },
        ..HueSaturation::default()
    };
    assert_eq!(bytes(turned.color()([1.0, 0.0, 0.0])), [0, 255, 0]);
    assert_eq!(bytes(turned.color()([0.4; 3])), [102; 3]);
    let mut reds = HueSaturation::default();
    reds.ranges[0].shift.saturation = -100.0;
    assert_eq!(bytes(reds.color()([0.8, 0.2, 0.2])), [128; 3], "a red becomes gray");
    assert_eq!(bytes(reds.color()([0.2, 0.8, 0.2])), [51, 204, 51], "a green stays");
    assert!((reds.ranges[0].weight(330.0) - 0.5).abs() < 1e-6);
    // Two ranges with the same hues: their factors, 2 and 1/2, add up to 3/2.
    let mut twice = HueSaturation::default();
    twice.ranges[0].shift.saturation = 50.0;
    twice.ranges[1] = twice.ranges[0];
    twice.ranges[1].shift.saturation = -50.0;
    assert_eq!(bytes(twice.color()([0.6, 0.4, 0.4])), [166, 89, 89]);
}

#[test]
fn black_and_white_weighs_hues() {
    let own = BlackWhite::default();
    // Orange: 0.2 is gray, from there to 0.5 yellow (60 %), from 0.5 to 1 red (40 %).
    assert!((own.gray([1.0, 0.5, 0.2]) - (0.2 + 0.3 * 0.6 + 0.5 * 0.4)).abs() < 1e-6);
    assert_eq!(own.gray([0.5; 3]), 0.5);
}

#[test]
fn inks_are_added_to_their_range_alone() {
    let mut own = SelectiveColor { absolute: true, ..SelectiveColor::default() };
    own.ranges[0] = [50.0, 0.0, 0.0, 0.0];
    // A pure red loses half of it; a green does not change.
    assert_eq!(bytes(own.color([1.0, 0.0, 0.0])), [128, 0, 0]);
    assert_eq!(bytes(own.color([0.0, 1.0, 0.0])), [0, 255, 0]);
    // Negative values count as well.
    own.ranges[0] = [0.0, -50.0, 0.0, 0.0];
    assert_eq!(bytes(own.color([1.0, 0.0, 0.0])), [255, 128, 0]);
}
