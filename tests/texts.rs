//! The languages of the window and of the command line: every text that can be shown is a row of
//! every catalog (`src/program/language`), and no row is of a text that is gone.
//!
//! What looks like a text in the sources is one, so that a new one cannot be forgotten; what looks
//! like a text and is none stands in `exceptions`, with the reason.

mod catalogs;
mod collect;
mod command_line;
mod exceptions;
mod presets;
mod tokens;
mod wrapped;

use collect::shown_texts;
use exceptions::{EXCEPT_FILES, EXCEPT_TEXTS, LOWER_IS_NONE, NAMES_NOT_SHOWN};
use tokens::Token;

/// Writes the English texts to the file that `RILIEVO_TEXTS` names, as a list of JSON in the order of
/// the sources: what a translator begins with.
#[test]
#[ignore = "writes a file: run it with RILIEVO_TEXTS=FILE"]
fn texts_are_listed() {
    let file = std::env::var("RILIEVO_TEXTS").expect("RILIEVO_TEXTS names the file to write");
    let texts: Vec<String> = shown_texts().iter().map(|shown| shown.text.clone()).collect();
    std::fs::write(file, serde_json::to_string_pretty(&texts).unwrap()).unwrap();
}

#[test]
fn texts_of_every_floor_are_found() {
    let shown = shown_texts();
    for (floor, least) in [("window", 1500), ("program", 500), ("engine", 700), ("io", 500)] {
        let folder = format!("src/{floor}/");
        let count = shown.iter().filter(|shown| shown.file.starts_with(&folder)).count();
        assert!(count >= least, "only {count} texts of {folder}");
    }
    let has = |text: &str| shown.iter().any(|shown| shown.text == text);
    let known = [
        "Save as…",
        "Nothing is selected.",
        "Soft light",
        "Cut",
        "Slow pace",
        "{1}: cannot be read: {reason}",
        "{name} on “{layer}”",
        "Replace existing files, also read-only ones; files that the command reads are never overwritten",
        "Usage:",
    ];
    for text in known {
        assert!(has(text), "{text} is not found");
    }
}

/// An exception that is gone is removed from the list.
#[test]
fn every_exception_is_still_needed() {
    let sources = collect::sources();
    let mut unused: Vec<String> = Vec::new();
    for (end, text, _) in EXCEPT_TEXTS {
        let is_there = sources.iter().filter(|source| source.file.ends_with(end)).any(|source| {
            source.tokens.iter().any(|token| matches!(token, Token::Text(own) if own == text))
        });
        if !is_there {
            unused.push(format!("{end}: {text}"));
        }
    }
    for (path, _) in EXCEPT_FILES.iter().chain(LOWER_IS_NONE) {
        if !sources.iter().any(|source| source.file.contains(path)) {
            unused.push((*path).to_owned());
        }
    }
    for name in NAMES_NOT_SHOWN {
        let is_name = |token: &Token| token.word() == Some(name);
        if !sources.iter().any(|source| source.tokens.iter().any(is_name)) {
            unused.push((*name).to_owned());
        }
    }
    assert!(unused.is_empty(), "remove these exceptions: {unused:#?}");
}
