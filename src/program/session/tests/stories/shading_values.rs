//! Draws what shading, and lines and hatching along the form, are set to.

use super::dice::{Dice, Roll};
use crate::paint::DrawingHand;
use crate::shading::{
    BallStrokes, FeatureScale, Features, Light, LightKind, NumberSetting, Painter, PixelShading,
    Reference, Scaling, Shadows, SolidGlass, Term,
};
use crate::surface::form_lines::{LineKind, LineKinds, LineSettings};
use crate::surface::hatching::{HatchSettings, HatchStyle, HatchTone, HatchWay};

impl Roll for Light {
    fn roll(dice: &mut Dice) -> Self {
        let position = dice.place().extend(dice.within(1.0, 80.0));
        let kind = match Light::default().kind {
            LightKind::Directional { .. } if dice.is(50) => LightKind::Point { position },
            LightKind::Directional { .. } => {
                LightKind::Directional { direction: dice.value(dice.word, "direction") }
            }
            LightKind::Point { .. } => LightKind::Point { position },
        };
        Light {
            kind,
            color: dice.value(dice.word, "color"),
            intensity: dice.in_range(0.0..=3.0, Light::INTENSITY),
        }
    }
}

impl Roll for Term {
    fn roll(dice: &mut Dice) -> Self {
        let (color, weight) =
            (dice.value(dice.word, "color"), dice.in_range(0.0..=2.0, Term::WEIGHT));
        Term { color, weight, scaling: Scaling::roll(dice) }
    }
}

/// Every number of a table, somewhere in its range.
fn settings<T>(dice: &mut Dice, table: &'static [NumberSetting<T>], mut all: T) -> T {
    for setting in table.iter().filter(|_| dice.is(40)).collect::<Vec<_>>() {
        let (low, high) = (*setting.range.start(), setting.range.end().min(60.0));
        (setting.set)(&mut all, dice.within(low, high));
    }
    all
}

impl Roll for Shadows {
    fn roll(dice: &mut Dice) -> Self {
        let numbers = settings(dice, Shadows::SETTINGS, Shadows::DEFAULT);
        let rays = 1 + dice.below(8) as u32;
        Shadows { on: dice.is(80), color: dice.value(dice.word, "color"), rays, ..numbers }
    }
}

impl Roll for SolidGlass {
    fn roll(dice: &mut Dice) -> Self {
        let numbers = settings(dice, SolidGlass::SETTINGS, SolidGlass::DEFAULT);
        SolidGlass { on: dice.is(80), ..numbers }
    }
}

impl Roll for BallStrokes {
    fn roll(dice: &mut Dice) -> Self {
        let numbers = settings(dice, BallStrokes::SETTINGS, BallStrokes::DEFAULT);
        BallStrokes { on: dice.is(80), ..numbers }
    }
}

impl Roll for LineSettings {
    fn roll(dice: &mut Dice) -> Self {
        let numbers = settings(dice, LineSettings::SETTINGS, LineSettings::DEFAULT);
        let with = |kinds: LineKinds, (kind, is_in)| kinds.with(kind, is_in);
        let kinds = LineKind::ALL.map(|(kind, _)| (kind, dice.is(50)));
        let kinds = kinds.into_iter().fold(LineKinds::NONE, with);
        let light = dice.value(dice.word, "light");
        LineSettings { kinds, light, skip_ink: dice.is(50), ..numbers }
    }
}

impl Roll for HatchSettings {
    fn roll(dice: &mut Dice) -> Self {
        let numbers = settings(dice, HatchSettings::SETTINGS, HatchSettings::DEFAULT);
        let style = dice.one_of(&HatchStyle::ALL.map(|(style, _)| style));
        let way = dice.one_of(&HatchWay::ALL.map(|(way, _)| way));
        let tone = dice.one_of(&HatchTone::ALL.map(|(tone, _)| tone));
        HatchSettings { style, way, tone, light: dice.value(dice.word, "light"), ..numbers }
    }
}

impl Roll for DrawingHand {
    fn roll(dice: &mut Dice) -> Self {
        settings(dice, DrawingHand::SETTINGS, DrawingHand::DEFAULT)
    }
}

impl Roll for Painter {
    fn roll(dice: &mut Dice) -> Self {
        let numbers = settings(dice, Painter::SETTINGS, Painter::DEFAULT);
        Painter { beneath: dice.is(50), fill_color: dice.value(dice.word, "color"), ..numbers }
    }
}

impl Roll for PixelShading {
    fn roll(dice: &mut Dice) -> Self {
        let bands = [0, 2, 3, 4, 5][dice.below(5)];
        let colors = (0..dice.below(4)).map(|_| dice.value(dice.word, "color")).collect();
        Self { bands, dither: dice.within(0.0, 1.0), colors }
    }
}

impl Roll for Scaling {
    fn roll(dice: &mut Dice) -> Self {
        let alpha = dice.in_range(0.05..=0.95, Scaling::INVARIANT);
        let mut gamma = || dice.in_range(0.0..=4.0, Scaling::GAMMA);
        Scaling { alpha, gamma_convex: gamma(), gamma_concave: gamma() }
    }
}

impl Roll for Features {
    fn roll(dice: &mut Dice) -> Self {
        let scale = |dice: &mut Dice| FeatureScale {
            curvature_scale_px: dice.in_range(1.0..=12.0, FeatureScale::CURVATURE_PX).min(100.0),
            blur_px: dice.within(0.0, 4.0),
            weight: dice.in_range(0.0..=2.0, FeatureScale::WEIGHT),
        };
        let scales = (0..1 + dice.below(3)).map(|_| scale(dice)).collect();
        Features { scales, lambda: dice.in_range(-1.0..=1.0, Features::LAMBDA) }
    }
}

impl Roll for Reference {
    fn roll(dice: &mut Dice) -> Self {
        if dice.is(30) {
            Reference::Auto
        } else {
            Reference::Value(dice.in_range(0.1..=4.0, Reference::VALUE))
        }
    }
}
