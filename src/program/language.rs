//! The language of the window and of the command line. Texts stand in English where they are shown,
//! and are looked up in the catalog of the chosen language as they are shown. Floor 6. Not here: the
//! texts of documents, files and scripts, which have no language.
//!
//! [`tr`] translates a text, [`tr!`](crate::tr) one with values in it, and [`tr_message`] what the
//! lower floors have put together in English: notes, refusals, steps of the history.

mod catalog;
mod template;

use crate::io::platform;
use catalog::Catalog;
use std::borrow::Cow;
use std::cell::Cell;
use std::fmt::Display;

rilievo_engine::named! {
    /// A language of the window, by its code and with the name that it has for itself.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Language {
        #[default]
        English = "en" => "English",
        German = "de" => "Deutsch",
        French = "fr" => "Français",
        Spanish = "es" => "Español",
        Japanese = "ja" => "日本語",
        Chinese = "zh" => "简体中文",
    }
}

impl Language {
    /// The language of a locale such as `de_AT.UTF-8` or `zh-Hans-CN`, if the window speaks it.
    pub fn from_locale(locale: &str) -> Option<Self> {
        let code = locale.split(['_', '-', '.', '@']).next()?.to_ascii_lowercase();
        Self::ALL.into_iter().map(|(language, _)| language).find(|of| of.name() == code)
    }

    /// What stands between the whole and the fraction of a number.
    pub fn decimal_mark(self) -> char {
        match self {
            Self::German | Self::French | Self::Spanish => ',',
            Self::English | Self::Japanese | Self::Chinese => '.',
        }
    }

    /// What stands between a place and what is said of it.
    fn colon(self) -> &'static str {
        match self {
            Self::English | Self::German | Self::Spanish => ": ",
            Self::French => "\u{a0}: ",
            Self::Japanese | Self::Chinese => "：",
        }
    }

    /// An amount of bytes such as `1.4 GB`, as the language writes it; nothing if it is none.
    fn amount_text(self, amount: &str) -> Option<String> {
        let (number, unit) = amount.split_once(' ')?;
        let is_amount = matches!(unit, "kB" | "MB" | "GB") && number.parse::<f64>().is_ok();
        let number = number.replace('.', self.decimal_mark().encode_utf8(&mut [0; 4]));
        let unit = match self {
            Self::French => unit.replace('B', "o"),
            _ => unit.to_owned(),
        };
        is_amount.then(|| format!("{number} {unit}"))
    }

    /// Whether its letters are not among those of the window's own font.
    pub fn is_written_in_han(self) -> bool {
        matches!(self, Self::Japanese | Self::Chinese)
    }

    fn catalog(self) -> Option<&'static Catalog> {
        catalog::find_catalog(self)
    }

    /// The English texts that this language has a translation of.
    pub fn translated_texts(self) -> impl Iterator<Item = (&'static str, &'static str)> {
        self.catalog().into_iter().flat_map(Catalog::rows)
    }
}

thread_local! {
    /// The language of what this thread shows. Only one thread shows texts.
    static CURRENT: Cell<Language> = const { Cell::new(Language::English) };
}

/// The language that the user has chosen for all programs: that of the locale, or English. The
/// variables of a shell are stronger than what the system says, and `RILIEVO_LANGUAGE`, a code such
/// as `de`, is stronger than both.
pub fn system_language() -> Language {
    ["RILIEVO_LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG"]
        .into_iter()
        .find_map(platform::environment_variable)
        .or_else(platform::locale)
        .and_then(|locale| Language::from_locale(&locale))
        .unwrap_or_default()
}

/// What this thread shows is in this language from now on.
pub fn set_language(language: Language) {
    CURRENT.set(language);
}

/// The language of what this thread shows.
pub fn language() -> Language {
    CURRENT.get()
}

/// A text in the current language; the English one where the catalog has none.
pub fn tr(text: &str) -> &str {
    match language().catalog() {
        Some(catalog) => catalog.find_text(text).unwrap_or(text),
        None => text,
    }
}

/// The row of a text in the current language's catalog.
pub fn find_translation(text: &str) -> Option<&'static str> {
    language().catalog()?.find_text(text)
}

/// A text that was put together in English, in the current language: the catalog's row of which it
/// is an instance gives the words, and the text the values. Values are translated as well, if they
/// are rows or messages themselves, but for what stands in quotes: those are names that users gave.
pub fn tr_message(message: &str) -> Cow<'_, str> {
    match language().catalog() {
        Some(catalog) => catalog.translate_message(message),
        None => Cow::Borrowed(message),
    }
}

/// A text with values in braces, in the current language. Use [`tr!`](crate::tr).
pub fn tr_with(template: &str, values: &[(&str, &dyn Display)]) -> String {
    template::fill_in(tr(template), values)
}

/// A number as the current language writes it.
pub fn tr_number(number: &str) -> Cow<'_, str> {
    match language().decimal_mark() {
        '.' => Cow::Borrowed(number),
        mark => Cow::Owned(number.replace('.', mark.encode_utf8(&mut [0; 4]))),
    }
}

/// An amount of bytes such as `1.4 GB`, as the current language writes it.
pub fn tr_amount(amount: &str) -> Cow<'_, str> {
    language().amount_text(amount).map_or(Cow::Borrowed(amount), Cow::Owned)
}

/// A text in the current language, with values: `tr!("Close {title}", title = name)`. A value that is
/// a variable of the same name needs no second word.
#[macro_export]
macro_rules! tr {
    ($text:literal) => { $crate::language::tr($text) };
    ($text:literal, $($name:ident $(= $value:expr)?),+ $(,)?) => {
        $crate::language::tr_with(
            $text,
            &[$((stringify!($name), &$crate::tr!(@value $name $($value)?) as &dyn std::fmt::Display)),+],
        )
    };
    (@value $name:ident) => { $name };
    (@value $name:ident $value:expr) => { $value };
}

#[cfg(test)]
mod tests;
