//! Layer effects: shadows, glows, lines, overlays and bevels that are computed from what a layer
//! covers. Floor 3. Not here: composing them with layers (`document`), blurs (`raster::matte`).
//!
//! | file | |
//! |---|---|
//! | `settings` | what each kind can be set to, which readers, writers, panels and stories ask |
//! | `matte` | how much of an effect each pixel gets |
//! | `color` | which color it gets |

mod color;
mod matte;
mod settings;

pub use color::{EffectPaint, EffectPattern};
pub use matte::EffectTile;
pub use settings::{
    BevelStyle, BevelTechnique, ChoiceField, ColorField, EffectField, EffectFill, EffectSettings,
    FlagField, GlowSource, GlowTechnique, StrokePosition,
};

use crate::math::range::clamp_to_range;
use crate::math::srgb::Color;
use crate::math::{NumberSetting, Range, Rect};
use crate::paint::adjustment::ToneCurve;
use crate::paint::{Gradient, GradientStop};
use crate::raster::BlendMode;
use std::sync::Arc;

crate::named! {
    /// A kind of effect.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum EffectKind {
        /// Beneath the layer.
        DropShadow = "drop-shadow" => ("Drop shadow", "The layer darkens what lies beneath it"),
        /// Beneath the layer.
        OuterGlow = "outer-glow" => ("Outer glow", "Light around the layer"),
        /// On the layer.
        PatternOverlay = "pattern-overlay" => ("Pattern overlay", "A repeated picture on the layer"),
        /// On the layer.
        GradientOverlay = "gradient-overlay" => ("Gradient overlay", "A ramp of colors on the layer"),
        /// On the layer.
        ColorOverlay = "color-overlay" => ("Color overlay", "One color on the layer"),
        /// On the layer.
        Satin = "satin" => ("Satin", "The layer's own shape, blurred and folded, as on silk"),
        /// On the layer.
        InnerGlow = "inner-glow" => ("Inner glow", "Light along the layer's edge or from its middle"),
        /// On the layer.
        InnerShadow = "inner-shadow" => ("Inner shadow", "The layer looks cut out of what is around it"),
        /// Over the layer.
        Stroke = "stroke" => ("Stroke", "A line along the layer's edge"),
        /// Over the layer.
        Bevel = "bevel" => ("Bevel", "Light and shade on slanted edges"),
    }
}

/// Where an effect is composed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffectPlace {
    /// Before the layer, on what lies beneath.
    Beneath,
    /// On what is beneath the layer, in place of the layer and of effects beneath it.
    Line,
    /// Within what the layer covers.
    Within,
    /// After the layer, also around it.
    Over,
}

/// One effect of a layer.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerEffect {
    /// Which it is.
    pub kind: EffectKind,
    /// It is shown.
    pub on: bool,
    /// Its numbers, choices and colors; those that its kind does not use are as they begin.
    pub settings: EffectSettings,
    /// The ramp of what is filled with one.
    pub stops: Vec<GradientStop>,
    /// How much of it each tone gets.
    pub contour: ToneCurve,
    /// The picture of what is filled with one.
    pub pattern: Option<Arc<EffectPattern>>,
}

/// The light of all effects of a document that have none of their own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectLight {
    /// The direction it comes from, degrees, counter-clockwise from the right.
    pub angle: f32,
    /// Its height over the canvas, degrees.
    pub altitude: f32,
}

impl Default for EffectLight {
    fn default() -> Self {
        Self { angle: 120.0, altitude: 30.0 }
    }
}

impl EffectLight {
    /// What its direction may be, degrees.
    pub const ANGLE: Range = -360.0..=360.0;
    /// What its height may be, degrees.
    pub const ALTITUDE: Range = 0.0..=90.0;

    /// With the nearest numbers that a document may hold.
    pub fn clamp_to_ranges(self) -> Self {
        Self {
            angle: clamp_to_range(self.angle, &Self::ANGLE),
            altitude: clamp_to_range(self.altitude, &Self::ALTITUDE),
        }
    }
}

impl LayerEffect {
    /// How many effects a layer may have.
    pub const MOST: usize = 40;

    /// An effect as it begins.
    pub fn new(kind: EffectKind) -> Self {
        let plain = EffectSettings::DEFAULT;
        let white = Color::WHITE;
        let glow = EffectSettings {
            blend: BlendMode::Screen,
            color: Color { r: 255, g: 255, b: 190, a: 255 },
            opacity: 0.75,
            ..plain
        };
        let shadow = EffectSettings { blend: BlendMode::Multiply, opacity: 0.75, ..plain };
        let settings = match kind {
            EffectKind::DropShadow | EffectKind::InnerShadow => shadow,
            EffectKind::OuterGlow | EffectKind::InnerGlow => glow,
            EffectKind::Satin => EffectSettings {
                opacity: 0.5,
                distance: 11.0,
                size: 14.0,
                angle: 19.0,
                invert: true,
                ..shadow
            },
            EffectKind::Bevel => {
                EffectSettings { blend: BlendMode::Screen, color: white, opacity: 0.75, ..plain }
            }
            EffectKind::Stroke => EffectSettings { size: 3.0, ..plain },
            EffectKind::GradientOverlay => {
                EffectSettings { fill: EffectFill::Gradient, angle: 90.0, ..plain }
            }
            EffectKind::PatternOverlay => EffectSettings { fill: EffectFill::Pattern, ..plain },
            EffectKind::ColorOverlay => {
                EffectSettings { color: Color { r: 255, g: 0, b: 0, a: 255 }, ..plain }
            }
        };
        Self {
            kind,
            on: true,
            settings,
            stops: Self::first_stops(),
            contour: ToneCurve::default(),
            pattern: None,
        }
    }

    /// From black to white.
    pub fn first_stops() -> Vec<GradientStop> {
        [(0.0, Color::BLACK), (1.0, Color::WHITE)]
            .map(|(t, color)| GradientStop { t, color })
            .to_vec()
    }

    /// Where it is composed.
    pub fn place(&self) -> EffectPlace {
        use EffectKind::*;
        match self.kind {
            DropShadow | OuterGlow => EffectPlace::Beneath,
            Stroke => EffectPlace::Line,
            Bevel => match self.settings.bevel {
                BevelStyle::Inner => EffectPlace::Within,
                _ => EffectPlace::Over,
            },
            _ => EffectPlace::Within,
        }
    }

    /// What is composed of it: of a line on the edge the half within and that around the layer.
    pub fn parts(&self) -> Vec<Self> {
        let s = self.settings;
        if self.kind != EffectKind::Stroke || s.position != StrokePosition::Center {
            return vec![self.clone()];
        }
        let half = |position| {
            let settings = EffectSettings { size: s.size / 2.0, position, ..s };
            Self { settings, ..self.clone() }
        };
        [StrokePosition::Outside, StrokePosition::Inside].map(half).to_vec()
    }

    /// Whether another line is the half within the layer of what this is the half around it.
    pub fn is_other_half(&self, other: &Self) -> bool {
        let within = EffectSettings { position: StrokePosition::Inside, ..self.settings };
        self.settings.position == StrokePosition::Outside
            && *other == Self { settings: within, ..self.clone() }
    }

    /// What a ramp lies on, of what the layer covers: that of a line reaches to its outer rim.
    pub fn ramp_rect(&self, covered: Rect) -> Rect {
        let is_around = self.kind == EffectKind::Stroke
            && self.fill() == EffectFill::Gradient
            && self.settings.position == StrokePosition::Outside;
        let by = if is_around && self.is_aligned() { self.settings.size.ceil() } else { 0.0 };
        covered.grown(by as i32)
    }

    /// How it is filled.
    pub fn fill(&self) -> EffectFill {
        match self.kind {
            EffectKind::GradientOverlay => EffectFill::Gradient,
            EffectKind::PatternOverlay => EffectFill::Pattern,
            EffectKind::Stroke | EffectKind::OuterGlow | EffectKind::InnerGlow => {
                self.settings.fill
            }
            _ => EffectFill::Color,
        }
    }

    /// Whether Photoshop's format has a word for everything of it; patterns are not written.
    pub fn is_said_by_photoshop(&self) -> bool {
        let s = &self.settings;
        let falls_on_surface = self.kind == EffectKind::DropShadow && s.on_surface;
        s.blend != BlendMode::Plus
            && s.shade_blend != BlendMode::Plus
            && self.fill() != EffectFill::Pattern
            && !falls_on_surface
    }

    /// It fills what the layer covers, so that it must be known how far that reaches.
    pub fn is_aligned(&self) -> bool {
        let along_edge = matches!(self.kind, EffectKind::OuterGlow | EffectKind::InnerGlow);
        self.fill() != EffectFill::Color && self.settings.aligned && !along_edge
    }

    /// Its own light, or that of the document.
    pub fn light(&self, document: EffectLight) -> EffectLight {
        let has_light = matches!(
            self.kind,
            EffectKind::DropShadow | EffectKind::InnerShadow | EffectKind::Bevel
        );
        if has_light && self.settings.document_light {
            return document;
        }
        EffectLight { angle: self.settings.angle, altitude: self.settings.altitude }
    }

    /// With lengths `factor` times as large; what its kind does not use stays as it begins.
    pub fn scaled(&self, factor: f32) -> Self {
        let mut next = self.clone();
        EffectSettings::lengths().for_each(|setting| setting.scale(&mut next.settings, factor));
        if self.fill() == EffectFill::Pattern {
            next.settings.scale *= factor;
        }
        next.with_own_settings()
    }

    /// With what its kind does not use as it begins.
    pub fn with_own_settings(self) -> Self {
        let mut next = Self { on: self.on, ..Self::new(self.kind) };
        let (from, to) = (&self.settings, &mut next.settings);
        for field in self.kind.fields() {
            match field {
                EffectField::Number(number) => (number.set)(to, (number.get)(from)),
                EffectField::Flag(flag) => (flag.set)(to, (flag.get)(from)),
                EffectField::Color(color) => (color.set)(to, (color.get)(from)),
                EffectField::Choice(choice) => (choice.set)(to, (choice.get)(from)),
                EffectField::Stops => next.stops.clone_from(&self.stops),
                EffectField::Contour => next.contour = self.contour.clone(),
                EffectField::Pattern => next.pattern.clone_from(&self.pattern),
            }
        }
        next
    }

    /// With the nearest numbers that a document may hold, and stops in order.
    pub fn clamp_to_ranges(mut self) -> Self {
        let numbers: &[NumberSetting<EffectSettings>] = EffectSettings::SETTINGS;
        for setting in numbers {
            let to = clamp_to_range((setting.get)(&self.settings), &setting.range);
            (setting.set)(&mut self.settings, to);
        }
        self.stops.iter_mut().for_each(|stop| stop.t = clamp_to_range(stop.t, &crate::math::UNIT));
        self.stops.sort_by(|a, b| a.t.total_cmp(&b.t));
        self.stops.truncate(Gradient::MOST_STOPS);
        if self.stops.is_empty() {
            self.stops = Self::first_stops();
        }
        self
    }
}

#[cfg(test)]
mod tests;
