//! What adjustments and filters are set by: each visits its parameters with their names, ranges and
//! defaults, so that readers, writers, panels, checks and stories need no list of their own. Floor 3.

use super::curve::ToneCurve;
use super::table::ColorTable;
use crate::math::srgb::Color;
use crate::math::{Range, range::clamp_to_range};
use crate::paint::GradientStop;

/// What a parameter is called.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterName {
    /// In documents.
    pub key: &'static str,
    /// In the window.
    pub label: &'static str,
    /// What it does; empty where the label says it.
    pub hint: &'static str,
}

/// The name of a parameter.
pub(in crate::paint) const fn parameter_name(
    key: &'static str,
    label: &'static str,
    hint: &'static str,
) -> ParameterName {
    ParameterName { key, label, hint }
}

/// A number and what it may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NumberParameter {
    /// What it is called.
    pub name: ParameterName,
    /// The least that it may be.
    pub least: f32,
    /// The most that it may be.
    pub most: f32,
    /// What it is where nothing is said.
    pub default: f32,
    /// Decimals that matter.
    pub decimals: usize,
    /// It is a length on the canvas, px, and scales with it.
    pub is_length: bool,
}

impl NumberParameter {
    /// A whole number around 0.
    pub(in crate::paint) const fn around(name: ParameterName, most: f32) -> Self {
        Self { name, least: -most, most, default: 0.0, decimals: 0, is_length: false }
    }

    /// A whole number from `least` to `most`.
    pub(in crate::paint) const fn whole(
        name: ParameterName,
        least: f32,
        most: f32,
        default: f32,
    ) -> Self {
        Self { name, least, most, default, decimals: 0, is_length: false }
    }

    /// The same with decimals.
    pub(in crate::paint) const fn decimals(self, decimals: usize) -> Self {
        Self { decimals, ..self }
    }

    /// The same as a length on the canvas, px.
    pub(in crate::paint) const fn px(self) -> Self {
        Self { is_length: true, ..self }
    }

    /// What it may be.
    pub fn range(&self) -> Range {
        self.least..=self.most
    }
}

/// The ramp where nothing is said.
pub(super) fn black_to_white() -> Vec<GradientStop> {
    [(0.0, Color::BLACK), (1.0, Color::WHITE)].map(|(t, color)| GradientStop { t, color }).to_vec()
}

/// Reads or changes the parameters of an adjustment, in the order in which they are shown.
pub trait ParameterVisitor {
    /// A number.
    fn number(&mut self, parameter: NumberParameter, value: &mut f32);
    /// Something that is on or off.
    fn flag(&mut self, name: ParameterName, default: bool, value: &mut bool);
    /// A color.
    fn color(&mut self, name: ParameterName, default: Color, value: &mut Color);
    /// Points of a curve through (0, 0) and (255, 255), where nothing is said.
    fn curve(&mut self, name: ParameterName, value: &mut ToneCurve);
    /// From black to white where nothing is said.
    fn stops(&mut self, name: ParameterName, value: &mut Vec<GradientStop>);
    /// None where nothing is said.
    fn table(&mut self, name: ParameterName, value: &mut Option<ColorTable>);
    /// Parameters that belong together.
    fn group(&mut self, name: ParameterName, inside: &mut dyn FnMut(&mut dyn ParameterVisitor));
}

/// An adjustment, by its parameters and what it does to colors.
pub(in crate::paint) trait Parameters {
    /// Shows its parameters to a visitor, which may change them.
    fn visit(&mut self, visitor: &mut dyn ParameterVisitor);
}

/// Declares an enum of kinds that have parameters, with the table of their names: the variant and
/// its type, its name in documents, its name in the window and what it does.
macro_rules! parameter_kinds {
    (
        $(#[$meta:meta])* pub enum $Kinds:ident;
        $($kind:ident = $name:literal => ($label:literal, $hint:literal),)+
    ) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        pub enum $Kinds {
            $(
                #[doc = concat!($hint, ".")]
                $kind($kind),
            )+
        }

        impl $Kinds {
            /// How many kinds there are.
            pub const COUNT: usize = [$($name),+].len();

            /// One of each kind as it begins, in the order in which they are offered.
            pub fn all() -> [Self; Self::COUNT] {
                [$(Self::$kind($kind::default())),+]
            }

            /// As it begins, by its name in documents.
            pub fn from_name(name: &str) -> Option<Self> {
                let name = $crate::math::named::current_name(name);
                Self::all().into_iter().find(|kind| kind.name() == name)
            }

            /// Its name in documents.
            pub fn name(&self) -> &'static str {
                match self { $(Self::$kind(_) => $name),+ }
            }

            /// Its name in the window.
            pub fn label(&self) -> &'static str {
                match self { $(Self::$kind(_) => $label),+ }
            }

            /// What it does, for tooltips.
            pub fn hint(&self) -> &'static str {
                match self { $(Self::$kind(_) => $hint),+ }
            }

            /// Shows its parameters to a visitor, which may change them.
            pub fn visit(&mut self, visitor: &mut dyn ParameterVisitor) {
                let parameters: &mut dyn Parameters = match self { $(Self::$kind(own) => own),+ };
                parameters.visit(visitor);
            }

            /// With the nearest numbers that a document may hold.
            pub fn clamp_to_ranges(mut self) -> Self {
                self.visit(&mut Holder);
                self
            }
        }
    };
    // The same; an accessor returns the kind's own value by a trait.
    (
        $(#[$meta:meta])* pub enum $Kinds:ident, fn $accessor:ident -> $Trait:ident;
        $($kind:ident = $name:literal => ($label:literal, $hint:literal),)+
    ) => {
        parameter_kinds! {
            $(#[$meta])* pub enum $Kinds;
            $($kind = $name => ($label, $hint),)+
        }

        impl $Kinds {
            fn $accessor(&self) -> &dyn $Trait {
                match self { $(Self::$kind(own) => own),+ }
            }
        }
    };
}
pub(in crate::paint) use parameter_kinds;

/// Brings every number into its range.
pub(in crate::paint) struct Holder;

impl ParameterVisitor for Holder {
    fn number(&mut self, parameter: NumberParameter, value: &mut f32) {
        *value = clamp_to_range(*value, &parameter.range());
    }

    fn flag(&mut self, _: ParameterName, _: bool, _: &mut bool) {}

    fn color(&mut self, _: ParameterName, _: Color, _: &mut Color) {}

    fn curve(&mut self, _: ParameterName, value: &mut ToneCurve) {
        *value = ToneCurve::new(value.points().to_vec());
    }

    fn stops(&mut self, _: ParameterName, value: &mut Vec<GradientStop>) {
        value.iter_mut().for_each(|stop| stop.t = clamp_to_range(stop.t, &crate::math::UNIT));
        value.sort_by(|a, b| a.t.total_cmp(&b.t));
        value.truncate(crate::paint::Gradient::MOST_STOPS);
        if value.is_empty() {
            *value = black_to_white();
        }
    }

    fn table(&mut self, _: ParameterName, _: &mut Option<ColorTable>) {}

    fn group(&mut self, _: ParameterName, inside: &mut dyn FnMut(&mut dyn ParameterVisitor)) {
        inside(self);
    }
}

/// Makes every length so many times as large. It may become larger than documents hold: a picture
/// that is only rendered larger looks as it did.
pub(in crate::paint) struct LengthScaler(pub f32);

impl ParameterVisitor for LengthScaler {
    fn number(&mut self, parameter: NumberParameter, value: &mut f32) {
        if parameter.is_length {
            *value *= self.0;
        }
    }

    fn flag(&mut self, _: ParameterName, _: bool, _: &mut bool) {}

    fn color(&mut self, _: ParameterName, _: Color, _: &mut Color) {}

    fn curve(&mut self, _: ParameterName, _: &mut ToneCurve) {}

    fn stops(&mut self, _: ParameterName, _: &mut Vec<GradientStop>) {}

    fn table(&mut self, _: ParameterName, _: &mut Option<ColorTable>) {}

    fn group(&mut self, _: ParameterName, inside: &mut dyn FnMut(&mut dyn ParameterVisitor)) {
        inside(self);
    }
}
