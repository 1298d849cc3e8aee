//! Draws the values that documents hold: operators, anchors, masks, transforms, brushes. Each is
//! mostly one that a file may hold, at times one that it may not, which must then be refused. Not
//! here: light and lines (`shading_values`), parts (`parts`), paths (`paths`).

use super::dice::{Dice, Roll};
use crate::document::Symmetry;
use crate::document::parts::from_flats::PartFor;
use crate::document::{DerivedMask, Inflation, LayerTransform, TransformShape};
use crate::math::srgb::Color;
use crate::math::{DVec2, Range, Size};
use crate::paint::adjustment::{
    ColorTable, NumberParameter, ParameterName, ParameterVisitor, ToneCurve,
};
use crate::paint::effect::{EffectField, EffectPattern};
use crate::paint::{
    Adjust, BrushMode, ColorAdjustment, ColorPalette, EffectKind, EffectLight, GradientStop,
    LayerEffect, NamedColor, PictureFilter, Placement, Subpath, Text, TextAlign, TextPath,
    TextStyle,
};
use crate::raster::{Picture, Resampling};
use crate::session::ExportSize;
use crate::session::actions::clipboard::PastedPicture;
use crate::session::actions::parts::InflationPreset;
use crate::surface::plane_piece::PlanePiece;
use crate::surface::region::{RegionKind, SurfaceRegion};
use crate::surface::{Anchor, NoiseRelief, Operator};
use serde_json::Value;
use std::sync::Arc;

impl Dice {
    /// A number of a range, or of the useful part of it.
    pub fn in_range(&mut self, useful: Range, all: Range) -> f32 {
        match self.below(30) {
            0 => *all.start(),
            1 => *all.end(),
            _ => self.within(*useful.start(), *useful.end()),
        }
    }
}

impl Roll for Operator {
    fn roll(dice: &mut Dice) -> Self {
        let kind = dice.one_of(&Operator::KINDS).0;
        kind.map(|number, _| dice.in_range(number.useful.clone(), number.range.clone()))
    }
}

impl Roll for Anchor {
    fn roll(dice: &mut Dice) -> Self {
        let at = dice.place();
        if dice.is(50) { Anchor::pin(at) } else { Anchor { at, source: dice.place() } }
    }
}

impl Roll for PlanePiece {
    fn roll(dice: &mut Dice) -> Self {
        let (at, moved) = (dice.place(), dice.place() * 0.2);
        let scale = dice.in_range(0.5..=2.0, PlanePiece::SCALE);
        PlanePiece { at, moved, scale, rotation: dice.within(-180.0, 180.0) }
    }
}

impl Roll for Placement {
    fn roll(dice: &mut Dice) -> Self {
        let scale = dice.in_range(0.2..=3.0, 0.01..=40.0);
        Placement { center: dice.place(), scale, rotation: dice.within(-180.0, 180.0) }
    }
}

impl Roll for Adjust {
    fn roll(dice: &mut Dice) -> Self {
        let blur = dice.within(0.0, 3.0);
        let mut factor = || dice.in_range(0.0..=2.0, Adjust::FACTOR);
        let [saturation, brightness, contrast] = [factor(), factor(), factor()];
        Adjust {
            blur,
            exposure: dice.within(-2.0, 2.0),
            hue: dice.within(-180.0, 180.0),
            saturation,
            brightness,
            contrast,
        }
    }
}

/// Mostly in a font that comes with the program, at times in one that no machine has.
impl Roll for Text {
    fn roll(dice: &mut Dice) -> Self {
        let words = ["", "Rel", "a b\nc", "Ink & <gold>", "日本語。", "\n\n", "ﬁ שלום"];
        let family = if dice.is(80) { "Hack" } else { "No Such Font" };
        let style = TextStyle {
            family: family.into(),
            size: dice.in_range(6.0..=40.0, 1.0..=200.0),
            weight: if dice.is(50) { 400 } else { 700 },
            italic: dice.is(20),
            color: dice.value(dice.word, "color"),
            tracking: dice.in_range(-50.0..=200.0, -200.0..=1000.0),
            kerning: dice.is(80),
            outline: if dice.is(30) { dice.within(0.0, 4.0) } else { 0.0 },
            outline_color: dice.value(dice.word, "color"),
        };
        let text = Text::new(dice.one_of(&words), style);
        let end = text.string().chars().next().map_or(0, char::len_utf8);
        let text = if dice.is(40) { text.styled(0, end, |style| style.size *= 1.5) } else { text };
        Text {
            align: dice.one_of(&TextAlign::ALL).0,
            leading: dice.in_range(0.8..=2.0, 0.1..=5.0),
            width: if dice.is(30) { dice.within(10.0, 90.0) } else { 0.0 },
            vertical: dice.is(20),
            arc: if dice.is(20) { dice.in_range(-180.0..=180.0, Text::ARC) } else { 0.0 },
            path: dice.is(20).then(|| TextPath {
                line: Subpath::roll(dice),
                shift: dice.in_range(-20.0..=20.0, Text::SHIFT),
            }),
            ..text
        }
    }
}

impl Roll for GradientStop {
    fn roll(dice: &mut Dice) -> Self {
        GradientStop {
            t: dice.in_range(0.0..=1.0, 0.0..=1.0),
            color: dice.value(dice.word, "color"),
        }
    }
}

/// Each parameter with a chance, mostly near where it begins.
impl Roll for ColorAdjustment {
    fn roll(dice: &mut Dice) -> Self {
        let mut adjustment = dice.one_of(&ColorAdjustment::all());
        adjustment.visit(&mut ParameterDice(dice));
        adjustment
    }
}

impl Roll for PictureFilter {
    fn roll(dice: &mut Dice) -> Self {
        let mut filter = dice.one_of(&PictureFilter::all());
        filter.visit(&mut ParameterDice(dice));
        filter
    }
}

impl Roll for ExportSize {
    fn roll(dice: &mut Dice) -> Self {
        match dice.is(70) {
            true => Self::Scale(dice.one_of(&[1.0, 0.5, 2.0, 0.3])),
            false => Self::Width(1 + dice.below(120) as u32),
        }
    }
}

/// Mostly a few colors, at times with a name that is not tidy.
impl Roll for ColorPalette {
    fn roll(dice: &mut Dice) -> Self {
        let name = String::roll(dice);
        let count = dice.below(5);
        let mut color = || NamedColor::new(Color::roll(dice), "é");
        let mut palette = ColorPalette { columns: 3, ..Self::of_colors(&name, &[]) };
        palette.colors.extend((0..count).map(|_| color()));
        palette
    }
}

/// Each setting with a chance, mostly near where it begins.
impl Roll for LayerEffect {
    fn roll(dice: &mut Dice) -> Self {
        let mut effect = LayerEffect::new(dice.one_of(&EffectKind::ALL).0);
        effect.on = dice.is(85);
        for field in effect.kind.fields() {
            if dice.is(60) {
                continue;
            }
            let all = &mut effect.settings;
            match field {
                EffectField::Number(number) => {
                    let (low, high) = (*number.range.start(), number.range.end().min(40.0));
                    (number.set)(all, dice.in_range(low..=high, low..=high));
                }
                EffectField::Flag(flag) => (flag.set)(all, dice.is(50)),
                EffectField::Color(color) => {
                    (color.set)(all, dice.value(dice.word, "color"));
                }
                EffectField::Choice(choice) => {
                    (choice.set)(all, dice.below((choice.choices)().len()));
                }
                EffectField::Stops => {
                    let mut drawn = ParameterDice(dice);
                    drawn.stops(ParameterName { key: "", label: "", hint: "" }, &mut effect.stops);
                }
                EffectField::Contour => {
                    let mut drawn = ParameterDice(dice);
                    drawn
                        .curve(ParameterName { key: "", label: "", hint: "" }, &mut effect.contour);
                }
                EffectField::Pattern => {
                    let size = Size::new(1 + dice.below(5) as u32, 1 + dice.below(5) as u32);
                    let rgba = (0..size.area() * 4).map(|_| dice.number() as u8).collect();
                    effect.pattern = EffectPattern::new("drawn", size, rgba).map(Arc::new);
                }
            }
        }
        effect
    }
}

impl Roll for EffectLight {
    fn roll(dice: &mut Dice) -> Self {
        let angle = dice.in_range(-180.0..=180.0, EffectLight::ANGLE);
        EffectLight { angle, altitude: dice.in_range(0.0..=90.0, EffectLight::ALTITUDE) }
    }
}

struct ParameterDice<'a>(&'a mut Dice);

impl ParameterVisitor for ParameterDice<'_> {
    fn number(&mut self, parameter: NumberParameter, value: &mut f32) {
        let NumberParameter { least, most, default, .. } = parameter;
        if self.0.is(30) {
            let span = 0.3 * (most - least);
            let useful = (default - span).max(least)..=(default + span).min(most);
            *value = self.0.in_range(useful, least..=most);
        }
    }

    fn flag(&mut self, _: ParameterName, _: bool, value: &mut bool) {
        *value = self.0.is(50);
    }

    fn color(&mut self, _: ParameterName, _: Color, value: &mut Color) {
        *value = self.0.value(self.0.word, "color");
    }

    fn curve(&mut self, _: ParameterName, value: &mut ToneCurve) {
        let mut point = || [self.0.within(0.0, 255.0), self.0.within(0.0, 255.0)];
        let points = (0..4).map(|_| point()).collect();
        if self.0.is(50) {
            *value = ToneCurve::new(points);
        }
    }

    fn stops(&mut self, _: ParameterName, value: &mut Vec<GradientStop>) {
        *value = (0..1 + self.0.below(4)).map(|_| GradientStop::roll(self.0)).collect();
        value.sort_by(|a, b| a.t.total_cmp(&b.t));
    }

    fn table(&mut self, _: ParameterName, value: &mut Option<ColorTable>) {
        let (side, is_separate) = (2 + self.0.below(3), self.0.is(30));
        let entries = ColorTable::entries(side, is_separate).unwrap_or_default();
        let values = (0..3 * entries).map(|_| self.0.number() as u16).collect();
        *value = ColorTable::new("drawn", side, is_separate, values);
    }

    fn group(&mut self, _: ParameterName, inside: &mut dyn FnMut(&mut dyn ParameterVisitor)) {
        inside(self);
    }
}

impl Roll for NoiseRelief {
    fn roll(dice: &mut Dice) -> Self {
        let size_px = dice.in_range(1.0..=40.0, NoiseRelief::SIZE_PX);
        let (octaves, seed) = (1 + dice.below(6) as u32, dice.below(1000) as u32);
        let roughness = dice.in_range(0.0..=1.0, NoiseRelief::ROUGHNESS);
        NoiseRelief {
            size_px,
            octaves,
            roughness,
            stretch: dice.in_range(0.2..=5.0, NoiseRelief::STRETCH),
            seed,
        }
    }
}

impl Roll for SurfaceRegion {
    fn roll(dice: &mut Dice) -> Self {
        let kind = dice.one_of(&RegionKind::ALL).0;
        let tolerance = dice.in_range(0.0..=2.0 * kind.tolerance(), kind.tolerances());
        let (at, softness) = (dice.place(), dice.in_range(0.0..=1.0, SurfaceRegion::SOFTNESS));
        SurfaceRegion { kind, at, tolerance, softness, contiguous: dice.is(50) }
    }
}

impl Roll for DerivedMask {
    fn roll(dice: &mut Dice) -> Self {
        // As many kinds as there are: a new one is told by the compiler.
        let (a, b) = (dice.within(0.0, 1.0), dice.within(0.0, 1.0));
        match dice.one_of(&[
            DerivedMask::FRESNEL,
            DerivedMask::CURVATURE,
            DerivedMask::RAMP_OF_DEPTH,
        ]) {
            _ if dice.is(35) => DerivedMask::Region(SurfaceRegion::roll(dice)),
            DerivedMask::Fresnel { .. } => DerivedMask::Fresnel { f0: a, power: 8.0 * b },
            DerivedMask::Curvature { .. } => {
                DerivedMask::Curvature { scale: 1.0 + 6.0 * a, blur: b, from: -b, to: a }
            }
            DerivedMask::Depth { .. } => DerivedMask::Depth { from: a, to: b },
            DerivedMask::Region(region) => DerivedMask::Region(region),
        }
    }
}

impl Roll for LayerTransform {
    fn roll(dice: &mut Dice) -> Self {
        let size = dice.facts.size.as_dvec2();
        let near = |dice: &mut Dice, x: f64, y: f64| -> DVec2 {
            let off = [dice.within(-12.0, 12.0), dice.within(-9.0, 9.0)].map(f64::from);
            DVec2::new(x, y) * size + DVec2::from_array(off)
        };
        let shape = match dice.is(60) {
            true => TransformShape::Matrix(<[f64; 6]>::roll(dice)),
            false => TransformShape::Quad(
                [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| near(dice, x, y)),
            ),
        };
        let drawn = LayerTransform { shape, filter: Resampling::roll(dice) };
        // On a tiny canvas its corners may pass each other.
        match drawn.fits() {
            Ok(()) => drawn,
            Err(_) => LayerTransform {
                shape: TransformShape::Matrix([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
                ..drawn
            },
        }
    }
}

impl Roll for BrushMode {
    fn roll(dice: &mut Dice) -> Self {
        let (aligned, picture) = (dice.is(50), dice.is(50));
        let kinds = [
            BrushMode::Paint,
            BrushMode::Smudge { length: dice.within(0.0, 1.0) },
            BrushMode::Blur { width: dice.within(0.0, 1.0) },
            BrushMode::Clone { aligned, picture },
        ];
        match dice.one_of(&kinds) {
            // A new kind of mark belongs in the list above.
            mode @ (BrushMode::Paint
            | BrushMode::Smudge { .. }
            | BrushMode::Blur { .. }
            | BrushMode::Clone { .. }) => mode,
        }
    }
}

impl Roll for Symmetry {
    fn roll(dice: &mut Dice) -> Self {
        let round = Symmetry::Radial(2 + dice.below(5) as u32);
        match dice.one_of(&[
            Symmetry::None,
            Symmetry::Vertical,
            Symmetry::Horizontal,
            Symmetry::Both,
            round,
        ]) {
            _ if dice.is(50) => Symmetry::None,
            symmetry @ (Symmetry::None | Symmetry::Vertical | Symmetry::Horizontal) => symmetry,
            symmetry @ (Symmetry::Both | Symmetry::Radial(_)) => symmetry,
        }
    }
}

impl Roll for PartFor {
    fn roll(dice: &mut Dice) -> Self {
        match dice.one_of(&[PartFor::Layer, PartFor::Color, PartFor::Area]) {
            each @ (PartFor::Layer | PartFor::Color | PartFor::Area) => each,
        }
    }
}

impl Roll for InflationPreset {
    fn roll(dice: &mut Dice) -> Self {
        InflationPreset(dice.one_of(&Inflation::PRESETS).0)
    }
}

/// One of another program, somewhat transparent.
impl Roll for PastedPicture {
    fn roll(dice: &mut Dice) -> Self {
        let size = Size::new(1 + dice.below(60) as u32, 1 + dice.below(50) as u32);
        let texels = (0..size.area())
            .map(|_| dice.number().to_le_bytes())
            .map(|[r, g, b, a, ..]| [r, g, b, a]);
        let picture = Picture::srgb8(size, texels.collect());
        PastedPicture { name: "picture.png".into(), picture: picture.unwrap() }
    }
}

/// Values with a form of their own in files: a brush, or a part in a new version.
impl Roll for Value {
    fn roll(dice: &mut Dice) -> Self {
        match dice.field {
            "part" => super::parts::change_part(dice),
            _ => super::brushes::brush(dice),
        }
    }
}
