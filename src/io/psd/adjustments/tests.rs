//! Tests of blocks of adjustments: what is written is read, and what Photoshop means is understood.

use super::*;
use crate::paint::GradientStop;
use crate::psd::colors::Mode;

fn colors() -> Colors<'static> {
    Colors::of_mode(Mode::Rgb)
}

fn back(adjustment: &ColorAdjustment) -> Option<ColorAdjustment> {
    let mut found = None;
    for (key, data) in blocks(adjustment) {
        let mut data = ByteCursor::new(&data);
        found = match key {
            NEWER => newer_brightness(&mut data),
            key => read(key, &mut data, &colors()),
        };
    }
    found
}

#[test]
fn whole_numbers_come_back_as_they_were() {
    for adjustment in ColorAdjustment::all() {
        match back(&adjustment) {
            Some(ColorAdjustment::GradientMap(map)) => {
                let ends = [map.stops[0].color, map.stops[map.stops.len() - 1].color];
                assert_eq!(ends, [Color::BLACK, Color::WHITE]);
            }
            found => {
                let is_said = adjustment.is_said_by_photoshop();
                assert_eq!(found, Some(adjustment).filter(|_| is_said));
            }
        }
    }
    let mut levels = Levels::default();
    levels.master.black = 12.0;
    levels.channels[2].gamma = 1.25;
    let curve = ToneCurve::new(vec![[0.0, 9.0], [80.0, 140.0], [255.0, 201.0]]);
    let mut curves = Curves::default();
    curves.channels[1] = curve;
    let newer = BrightnessContrast { brightness: -95.0, contrast: 50.0, legacy: false };
    let mut hues = HueSaturation { colorize: true, ..HueSaturation::default() };
    hues.tint.hue = 233.0;
    hues.ranges[3].shift.saturation = -40.0;
    for adjustment in [
        ColorAdjustment::Levels(levels),
        ColorAdjustment::Curves(curves),
        ColorAdjustment::BrightnessContrast(newer),
        ColorAdjustment::BrightnessContrast(BrightnessContrast { legacy: true, ..newer }),
        ColorAdjustment::HueSaturation(hues),
    ] {
        assert_eq!(back(&adjustment).as_ref(), Some(&adjustment));
    }
}

#[test]
fn stops_of_a_gradient_map_come_back_where_they_were() {
    let stop = |t, r, a| GradientStop { t, color: Color { r, g: 7, b: 200, a } };
    for stops in [
        vec![stop(0.0, 9, 255), stop(0.25, 250, 255), stop(1.0, 90, 255)],
        // Neither begins at 0, two at one place, not opaque.
        vec![stop(0.453125, 109, 255), stop(1.0, 45, 90), stop(1.0, 90, 255)],
    ] {
        let map = ColorAdjustment::GradientMap(GradientMap { stops, reverse: true });
        assert_eq!(back(&map), Some(map));
    }
}

#[test]
fn points_of_curves_hold_the_tone_after_first_and_the_second_list_counts() {
    let mut data = vec![0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 10, 0, 0, 0, 90, 0, 255];
    let first = read(*b"curv", &mut ByteCursor::new(&data), &colors());
    let straight = ToneCurve::new(vec![[0.0, 10.0], [255.0, 90.0]]);
    let master = |curve: &ToneCurve| Curves { master: curve.clone(), ..Curves::default() };
    assert_eq!(first, Some(ColorAdjustment::Curves(master(&straight))));
    data.extend(b"Crv ");
    data.extend([0, 4, 0, 0, 0, 1, 0, 2, 0, 2, 0, 1, 0, 0, 0, 2, 0, 255]);
    let both = read(*b"curv", &mut ByteCursor::new(&data), &colors());
    let mut meant = master(&straight);
    meant.channels[1] = ToneCurve::new(vec![[0.0, 1.0], [255.0, 2.0]]);
    assert_eq!(both, Some(ColorAdjustment::Curves(meant)));
}

#[test]
fn levels_of_which_the_end_is_missing_are_read() {
    // Clip Studio cuts the last range short and signs what follows otherwise.
    let whole = &blocks(&ColorAdjustment::all()[1])[0].1;
    let found = read(*b"levl", &mut ByteCursor::new(&whole[..whole.len() - 8]), &colors());
    assert_eq!(found, Some(ColorAdjustment::Levels(Levels::default())));
}

#[test]
fn blocks_that_are_cut_short_are_not_understood_and_never_panic() {
    for adjustment in ColorAdjustment::all() {
        for (key, data) in blocks(&adjustment) {
            for length in 0..data.len() {
                let _ = read(key, &mut ByteCursor::new(&data[..length]), &colors());
                let _ = newer_brightness(&mut ByteCursor::new(&data[..length]));
            }
        }
    }
    assert_eq!(read(*b"levl", &mut ByteCursor::new(&[0, 2, 0]), &colors()), None);
}
