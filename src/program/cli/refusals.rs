//! What the command line says to arguments that it does not take, in the user's language. Floor 7. In
//! English these are the sentences of `clap`; here stand those that can be said.

use crate::language::{Language, language, tr, tr_message};
use std::io::Write;

/// What is refused, why, and what is possible instead: lines of `clap` with their values in braces, by
/// which catalogs know them.
#[cfg_attr(not(test), expect(dead_code, reason = "rows of the catalogs"))]
const SENTENCES: [&str; 18] = [
    "error: unexpected argument '{argument}' found",
    "error: unrecognized subcommand '{command}'",
    "error: the following required arguments were not provided:",
    "error: a value is required for '{argument}' but none was supplied",
    "error: invalid value '{value}' for '{argument}'",
    "error: invalid value '{value}' for '{argument}': {reason}",
    "error: the argument '{argument}' cannot be used with '{other}'",
    "error: the argument '{argument}' cannot be used with:",
    "error: the argument '{argument}' cannot be used multiple times",
    "error: unexpected value '{value}' for '{argument}' found; no more were expected",
    "{value} is not in {range}",
    "invalid digit found in string",
    "tip: a similar subcommand exists: '{command}'",
    "tip: a similar argument exists: '{argument}'",
    "tip: a similar value exists: '{value}'",
    "tip: to pass '{argument}' as a value, use '{usage}'",
    "[possible values: {values}]",
    "For more information, try '--help'.",
];

/// Prints why the arguments were refused, or the help that was asked for, which is translated already.
pub fn print(refusal: &clap::Error) -> std::io::Result<()> {
    if language() == Language::English || !refusal.use_stderr() {
        return refusal.print();
    }
    std::io::stderr().write_all(translate(&refusal.to_string()).as_bytes())
}

fn translate(refusal: &str) -> String {
    refusal.split_inclusive('\n').map(translate_line).collect()
}

fn translate_line(line: &str) -> String {
    let text = line.trim();
    let Some((indent, end)) = line.split_once(text).filter(|_| !text.is_empty()) else {
        return line.to_owned();
    };
    let text = match text.strip_prefix("Usage:") {
        Some(usage) => format!("{}{usage}", tr("Usage:")).into(),
        None => tr_message(text),
    };
    format!("{indent}{text}{end}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::command;
    use crate::language::set_language;

    const WRONG: [&[&str]; 14] = [
        &["render", "--foo"],
        &["rendr"],
        &["render"],
        &["render", "a.json", "-o", "a.png", "--scale"],
        &["render", "a.json", "-o", "a.png", "--convention", "up"],
        &["render", "a.json", "-o", "a.png", "--qualty", "9"],
        &["render", "a.json", "-o", "a.png", "--quality", "900"],
        &["render", "a.json", "-o", "a.png", "--quality", "much"],
        &["lines", "a.json", "-o", "a.svg", "--seam", "1"],
        &["render", "a.json", "-o", "a.png", "-o", "b.png"],
        &["shape", "a.png", "-o", "a", "--paths", "--flats", "b.png"],
        &["shape", "a.png", "-o", "a", "--paths", "--flats", "b.png", "--ink"],
        &["shape", "a.png", "-o", "a", "--format", "ping"],
        &["render", "a.json", "-o", "a.png", "--force=yes"],
    ];

    fn refusals() -> Vec<String> {
        let refusal = |words: &&[&str]| {
            let words = ["rilievo"].iter().chain(words.iter());
            command().try_get_matches_from(words).unwrap_err().to_string()
        };
        WRONG.iter().map(refusal).collect()
    }

    /// Its own words, in their order.
    fn is_said(sentence: &str, refusals: &str) -> bool {
        let words = sentence.split(['{', '}']).step_by(2);
        let line_has = |line: &str| {
            let mut rest = Some(line);
            for word in words.clone() {
                rest = rest.and_then(|rest| Some(&rest[rest.find(word)? + word.len()..]));
            }
            rest.is_some()
        };
        refusals.lines().any(line_has)
    }

    #[test]
    fn every_sentence_is_said_by_some_refusal() {
        let refusals = refusals().concat();
        for sentence in SENTENCES {
            assert!(is_said(sentence, &refusals), "{sentence}\n{refusals}");
        }
    }

    #[test]
    fn no_line_of_a_refusal_stays_english() {
        let english = refusals();
        for (language, name) in Language::ALL.into_iter().filter(|(l, _)| *l != Language::English) {
            set_language(language);
            let translated: Vec<String> = english.iter().map(|text| translate(text)).collect();
            set_language(Language::English);
            for (text, english) in translated.iter().zip(&english) {
                assert_eq!(text.lines().count(), english.lines().count());
                for (line, english) in text.lines().zip(english.lines()) {
                    let is_name =
                        english.trim().is_empty() || english.trim().starts_with(['-', '<']);
                    assert!(is_name || line != english, "{name}: {line}");
                }
            }
        }
    }
}
