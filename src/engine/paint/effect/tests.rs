use super::*;
use crate::math::{Rect, Size};
use crate::raster::{Matte, TileAt};
use std::collections::BTreeSet;

/// A square of ten by ten pixels in the middle of a tile.
fn square(rect: Rect) -> Matte {
    let mut matte = Matte::full(rect, 0.0);
    for y in 27.max(rect.y0)..37.min(rect.y1) {
        let row = matte.row_mut(y).iter_mut().zip(rect.x0..);
        row.filter(|(_, x)| (27..37).contains(x)).for_each(|(v, _)| *v = 1.0);
    }
    matte
}

fn amount(effect: &LayerEffect, x: usize, y: usize) -> f32 {
    let tile = effect.tile(TileAt { col: 0, row: 0 }, EffectLight::default(), None, &square);
    tile.at(y * 64 + x)
}

fn of(kind: EffectKind, change: impl FnOnce(&mut EffectSettings)) -> LayerEffect {
    let mut effect = LayerEffect::new(kind);
    change(&mut effect.settings);
    effect
}

#[test]
fn every_setting_of_a_kind_is_known_and_in_range_and_each_name_is_once() {
    for (kind, name) in EffectKind::ALL {
        let effect = LayerEffect::new(kind);
        assert_eq!(effect.clone().clamp_to_ranges(), effect, "{name}");
        let names: Vec<&str> = kind
            .fields()
            .iter()
            .map(|field| match field {
                EffectField::Number(number) => number.name,
                EffectField::Flag(flag) => flag.name,
                EffectField::Color(color) => color.name,
                EffectField::Choice(choice) => choice.name,
                EffectField::Stops => "stops",
                EffectField::Contour => "contour",
                EffectField::Pattern => "pattern",
            })
            .collect();
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "{name}: {names:?}");
        assert!(names.len() > 2, "{name}: {names:?}");
    }
}

#[test]
fn a_shadow_falls_away_from_its_light() {
    let shadow = of(EffectKind::DropShadow, |s| {
        (s.document_light, s.angle, s.distance, s.size) = (false, 90.0, 6.0, 0.0);
    });
    assert_eq!([amount(&shadow, 32, 42), amount(&shadow, 32, 43)], [1.0, 0.0]);
    assert_eq!([amount(&shadow, 32, 33), amount(&shadow, 32, 32)], [1.0, 0.0]);
    let soft = of(EffectKind::DropShadow, |s| {
        (s.document_light, s.angle, s.distance, s.size) = (false, 180.0, 4.0, 4.0);
    });
    // The edge of the moved square is where half of it is left.
    let edge = (amount(&soft, 40, 32) + amount(&soft, 41, 32)) / 2.0;
    assert!((edge - 0.5).abs() < 0.01, "{edge}");
}

#[test]
fn a_line_is_as_wide_as_its_size() {
    let line = |position| of(EffectKind::Stroke, |s| (s.size, s.position) = (4.0, position));
    let row = |effect: &LayerEffect| [36, 37, 38, 39, 40, 41].map(|x| amount(effect, x, 32));
    // Beneath what the layer covers too, and from there outward.
    assert_eq!(row(&line(StrokePosition::Outside)), [1.0, 1.0, 1.0, 1.0, 1.0, 0.0]);
    let inside = line(StrokePosition::Inside);
    assert_eq!([amount(&inside, 33, 32), amount(&inside, 32, 32)], [1.0, 0.0]);
    let halves = line(StrokePosition::Center).parts();
    assert!(halves.len() == 2 && halves[0].is_other_half(&halves[1]));
    assert_eq!(row(&halves[0]), [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    assert_eq!([34, 35].map(|x| amount(&halves[1], x, 32)), [0.0, 1.0]);
}

#[test]
fn the_ramp_of_a_line_reaches_to_its_outer_rim() {
    let line = |position, fill| {
        of(EffectKind::Stroke, |s| (s.size, s.position, s.fill) = (4.0, position, fill))
    };
    let covered = Rect::new(10, 10, 20, 30);
    let outside = line(StrokePosition::Outside, EffectFill::Gradient);
    assert_eq!(outside.ramp_rect(covered), Rect::new(6, 6, 24, 34));
    for other in [
        line(StrokePosition::Inside, EffectFill::Gradient),
        line(StrokePosition::Outside, EffectFill::Pattern),
        LayerEffect::new(EffectKind::GradientOverlay),
    ] {
        assert_eq!(other.ramp_rect(covered), covered);
    }
}

/// As in a picture of Photoshop: half of five pixels are three that are solid.
#[test]
fn whole_pixels_of_a_shadow_are_solid() {
    let shadow = of(EffectKind::DropShadow, |s| {
        (s.distance, s.size, s.spread) = (0.0, 5.0, 0.5);
    });
    let found = [37, 38, 39, 40, 41, 42].map(|x| amount(&shadow, x, 32));
    let far = found.iter().zip([1.0, 0.9375, 0.6875, 0.3125, 0.0625, 0.0]);
    assert!(far.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) < 1e-3, "{found:?}");
}

#[test]
fn a_bevel_is_light_toward_its_light_and_dark_away_from_it() {
    let bevel = of(EffectKind::Bevel, |s| {
        (s.document_light, s.angle, s.altitude, s.size) = (false, 90.0, 30.0, 6.0);
    });
    let (above, below) = (amount(&bevel, 32, 28), amount(&bevel, 32, 35));
    assert!(above > 0.3 && below < -0.3, "{above} {below}");
    // It leans as little to the light as away from it, across the light's direction.
    let (left, right) = (amount(&bevel, 28, 32), amount(&bevel, 35, 32));
    assert!((left - right).abs() < 1e-3, "{left} {right}");
    let sunken = LayerEffect {
        settings: EffectSettings { sunken: true, ..bevel.settings },
        ..bevel.clone()
    };
    assert!(amount(&sunken, 32, 28) < -0.3);
}

/// As in a picture of Photoshop: what leans neither to the light nor away from it gets less of it than
/// a flat place, around the layer too.
#[test]
fn a_pillow_is_sunken_around_its_layer() {
    let pillow = of(EffectKind::Bevel, |s| {
        (s.document_light, s.angle, s.altitude, s.size) = (false, 180.0, 30.0, 6.0);
        s.bevel = BevelStyle::Pillow;
    });
    let emboss = of(EffectKind::Bevel, |s| {
        *s = EffectSettings { bevel: BevelStyle::Emboss, ..pillow.settings };
    });
    let sunken = of(EffectKind::Bevel, |s| {
        *s = EffectSettings { sunken: true, ..emboss.settings };
    });
    for (x, y) in [(32, 25), (25, 32), (38, 32)] {
        assert_eq!(amount(&pillow, x, y), amount(&sunken, x, y), "{x}, {y}");
    }
    for (x, y) in [(32, 28), (28, 32), (35, 32)] {
        assert_eq!(amount(&pillow, x, y), amount(&emboss, x, y), "{x}, {y}");
    }
    assert!(amount(&pillow, 32, 25) < -0.01 && amount(&pillow, 25, 32) < -0.1);
}

#[test]
fn lengths_are_scaled_and_amounts_are_not() {
    let shadow = of(EffectKind::DropShadow, |s| (s.size, s.distance) = (7.0, 9.0)).scaled(2.0);
    let EffectSettings { size, distance, opacity, .. } = shadow.settings;
    assert_eq!((size, distance, opacity), (14.0, 18.0, 0.75));
}

#[test]
fn a_ramp_fills_what_the_layer_covers() {
    let overlay = of(EffectKind::GradientOverlay, |s| s.angle = 0.0);
    let at = TileAt { col: 0, row: 0 };
    let filled = Rect::new(0, 0, 64, 10);
    let paint = overlay.paint(at, filled, &EffectTile::Even(1.0)).unwrap();
    let EffectPaint::Tile(tile) = paint else { panic!() };
    let tones = [0, 31, 63].map(|x| tile.rows()[5].pixel(x)[0]);
    assert!(tones[0] < 0.02 && (tones[1] - 0.5).abs() < 0.02 && tones[2] > 0.98, "{tones:?}");
}

#[test]
fn a_picture_is_repeated() {
    let rgba = vec![255, 0, 0, 255, 0, 0, 255, 255];
    let pattern = EffectPattern::new("two", Size::new(2, 1), rgba).unwrap();
    let mut overlay = LayerEffect::new(EffectKind::PatternOverlay);
    let at = TileAt { col: 0, row: 0 };
    assert!(overlay.paint(at, at.rect(), &EffectTile::Even(1.0)).is_none());
    overlay.pattern = Some(Arc::new(pattern));
    let paint = overlay.paint(at, Rect::new(1, 0, 9, 9), &EffectTile::Even(1.0)).unwrap();
    let EffectPaint::Tile(tile) = paint else { panic!() };
    let red = |x: usize| tile.rows()[7].pixel(x)[0];
    assert_eq!([red(0), red(1), red(2), red(3)], [0.0, 1.0, 0.0, 1.0]);
    assert!(EffectPattern::new("none", Size::new(2, 2), vec![0; 4]).is_none());
}

/// As in a picture of Photoshop, of a line each four pixels at 200 %.
#[test]
fn an_enlarged_picture_begins_with_the_color_of_its_first_pixel() {
    let rgba = [[0, 0, 0, 255], [255; 4], [255; 4], [255; 4]].concat();
    let pattern = EffectPattern::new("lines", Size::new(4, 1), rgba).unwrap();
    let mut overlay = LayerEffect::new(EffectKind::PatternOverlay);
    overlay.pattern = Some(Arc::new(pattern));
    overlay.settings.scale = 2.0;
    let at = TileAt { col: 0, row: 0 };
    let paint = overlay.paint(at, at.rect(), &EffectTile::Even(1.0)).unwrap();
    let EffectPaint::Tile(tile) = paint else { panic!() };
    let tones = [0, 1, 2, 5, 7, 8, 9].map(|x| tile.rows()[3].pixel(x)[0]);
    assert_eq!(tones, [0.0, 0.5, 1.0, 1.0, 0.5, 0.0, 0.5]);
}

#[test]
fn a_larger_effect_has_larger_lengths_and_what_its_kind_does_not_use_as_it_begins() {
    for (kind, name) in EffectKind::ALL {
        for factor in [0.4, 1.7] {
            let scaled = LayerEffect::new(kind).scaled(factor);
            assert_eq!(scaled.clone().with_own_settings(), scaled, "{name}");
        }
    }
    let (glow, larger) = (LayerEffect::new(EffectKind::OuterGlow), |by| {
        LayerEffect::new(EffectKind::OuterGlow).scaled(by)
    });
    assert_eq!(larger(2.0).settings.size, 2.0 * glow.settings.size);
    assert_eq!(larger(2.0).settings.distance, glow.settings.distance);
}
