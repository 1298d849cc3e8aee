//! Numbers that are typed or dragged, written as the language of the window writes them. Floor 7.

use crate::language::tr_number;
use eframe::egui::DragValue;
use eframe::emath::{self, Numeric};
use std::ops::RangeInclusive;

/// A field of a number.
pub fn number<N: Numeric>(value: &mut N) -> DragValue<'_> {
    DragValue::new(value).custom_formatter(format_number).custom_parser(parse_number)
}

/// A number as the language of the window writes it.
fn format_number(value: f64, decimals: RangeInclusive<usize>) -> String {
    tr_number(&emath::format_with_decimals_in_range(value, decimals)).into_owned()
}

/// A typed number, with a point or a comma.
pub(super) fn parse_number(text: &str) -> Option<f64> {
    let letters = text.chars().filter(|letter| !letter.is_whitespace());
    let plain = letters.map(|letter| match letter {
        '−' => '-',
        ',' => '.',
        other => other,
    });
    plain.collect::<String>().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::{Language, set_language};

    #[test]
    fn a_number_is_read_back_as_each_language_writes_it() {
        for (language, written) in [(Language::English, "-12.5"), (Language::German, "-12,5")] {
            set_language(language);
            assert_eq!(format_number(-12.5, 0..=2), written);
            assert_eq!(parse_number(written), Some(-12.5));
        }
        set_language(Language::English);
        assert_eq!(parse_number(" 1 000.25 "), Some(1000.25));
        assert_eq!(parse_number("−3"), Some(-3.0));
        assert_eq!(parse_number("wide"), None);
    }
}
