//! Tables of numbers: name, words, range and default of each in one place, next to its type, which
//! readers, writers, checks, sliders and replays ask. Floor 0.

use super::Range;

/// One number of a group of settings.
pub struct NumberSetting<T> {
    /// Its name in documents.
    pub name: &'static str,
    /// Its name in the window.
    pub label: &'static str,
    /// What it does.
    pub hint: &'static str,
    /// Its range.
    pub range: Range,
    /// Whether it is a length on the canvas, px, which is scaled with it.
    pub is_length: bool,
    /// Reads it.
    pub get: fn(&T) -> f32,
    /// Sets it; the caller keeps to the range.
    pub set: fn(&mut T, f32),
}

impl<T> NumberSetting<T> {
    /// Sets it to the nearest number that it may be; what is not finite leaves it as it is.
    pub fn put(&self, settings: &mut T, to: f32) {
        if to.is_finite() {
            (self.set)(settings, to.max(*self.range.start()).min(*self.range.end()));
        }
    }

    /// Makes a length `factor` times as large, or the least that it may be. It may become larger
    /// than documents hold: a picture that is only rendered larger looks as it did.
    pub fn scale(&self, settings: &mut T, factor: f32) {
        let to = (self.get)(settings) * factor;
        (self.set)(settings, to.max(*self.range.start()));
    }
}

/// Declares a struct of numbers with their table, `SETTINGS`, and their defaults; after `and`,
/// fields of other types. A default followed by `px` is that of a length on the canvas.
macro_rules! number_settings {
    (
        $(#[$meta:meta])*
        $vis:vis struct $type:ident {
            $(
                $(#[doc = $doc:literal])+
                $name:ident: $label:literal, $hint:literal, $range:expr, $default:expr $(, $px:ident)?;
            )+
            and $($(#[doc = $other_doc:literal])+ $other:ident: $other_type:ty = $other_default:expr;)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        $vis struct $type {
            $($(#[doc = $doc])+ pub $name: f32,)+
            $($(#[doc = $other_doc])+ pub $other: $other_type,)*
        }

        impl $type {
            /// Its numbers.
            pub const SETTINGS: &[$crate::math::NumberSetting<$type>] = &[$($crate::math::NumberSetting {
                name: stringify!($name),
                label: $label,
                hint: $hint,
                range: $range,
                is_length: [false $(, stringify!($px).is_empty())?].len() == 2,
                get: |all| all.$name,
                set: |all, to| all.$name = to,
            },)+];
            /// Those of its numbers that are lengths on the canvas.
            pub fn lengths() -> impl Iterator<Item = &'static $crate::math::NumberSetting<$type>> {
                Self::SETTINGS.iter().filter(|setting| setting.is_length)
            }

            /// As it begins.
            pub const DEFAULT: Self = Self { $($name: $default,)+ $($other: $other_default,)* };
        }

        impl Default for $type {
            fn default() -> Self {
                Self::DEFAULT
            }
        }
    };
}
pub(crate) use number_settings;
