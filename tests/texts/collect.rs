//! Finds the texts that the program can show, in the order of the sources. What looks like a text is
//! one, unless it stands where no text is shown: so a new one cannot be forgotten.

use super::exceptions::{
    EXCEPT_FILES, EXCEPT_TEXTS, LOWER_IS_NONE, NAMES_NOT_SHOWN, SHOWN_NAMES, SHOWN_TYPES,
};
use super::tokens::{Token, tokens, without_tests};
use crate::lines::files;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A text, and the file that it stands in.
#[derive(Clone, Debug)]
pub struct Shown {
    pub text: String,
    pub file: String,
    /// Where it has fixed room, if it has.
    pub room: Option<Room>,
}

/// Places of the window that do not grow with their texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Room {
    /// On a bar, in front of its number.
    Bar,
    /// The column of names in front of fields.
    Name,
}

/// The crates in the order of the list: what is seen most comes first.
const CRATES: [&str; 4] = ["window", "program", "engine", "io"];

/// Macros and functions whose texts are not shown to users, whatever stands between.
const NEVER_WITHIN: &[&str] = &[
    "assert!",
    "assert_eq!",
    "assert_ne!",
    "debug_assert!",
    "debug_assert_eq!",
    "panic!",
    "unreachable!",
    "expect",
    "include_str!",
    "include_bytes!",
    "matches!",
    "json!",
    "unique",
    "id_salt",
    "from_id_salt",
    "load_texture",
    "spawn",
];

/// Functions whose own arguments are no texts.
const NO_TEXT_OF: &[&str] = &[
    "contains",
    "debug_struct",
    "ends_with",
    "find",
    "is_over",
    "replace",
    "replacen",
    "split",
    "split_once",
    "starts_with",
    "strip_prefix",
    "strip_suffix",
    "with",
];

/// A source without what is only for tests.
pub struct Source {
    pub file: String,
    pub tokens: Vec<Token>,
}

/// The sources of the program without their tests, in order; they are read once.
pub fn sources() -> &'static [Source] {
    static READ: OnceLock<Vec<Source>> = OnceLock::new();
    READ.get_or_init(read_sources)
}

fn read_sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut found, mut of_tests) = (Vec::new(), BTreeSet::new());
    for name in CRATES {
        let mut paths = files(&format!("src/{name}"), "rs");
        paths.sort();
        for path in paths {
            let (tokens, modules) = without_tests(&tokens(&fs::read_to_string(&path).unwrap()));
            let folder = match path.file_name().is_some_and(|name| name == "lib.rs") {
                true => path.with_file_name(""),
                false => path.with_extension(""),
            };
            of_tests.extend(modules.iter().map(|module| folder.join(module)));
            found.push((path, tokens));
        }
    }
    let is_test = |path: &PathBuf| {
        let module = path.with_extension("");
        module.ancestors().any(|folder| of_tests.contains(folder))
    };
    let named = |path: PathBuf| path.strip_prefix(root).unwrap().display().to_string();
    found
        .into_iter()
        .filter(|(path, _)| !is_test(path))
        .map(|(path, tokens)| Source { file: named(path), tokens })
        .collect()
}

/// Every text that can be shown, once, with the file that it first stands in.
pub fn shown_texts() -> &'static [Shown] {
    static FOUND: OnceLock<Vec<Shown>> = OnceLock::new();
    FOUND.get_or_init(find_texts)
}

fn find_texts() -> Vec<Shown> {
    let sources = sources();
    let names = names_of_choices(sources);
    let mut found: Vec<Shown> = Vec::new();
    for source in sources {
        found.extend(texts_of(source));
        let shown = names.iter().filter(|(_, names)| names.file == source.file);
        found.extend(shown.flat_map(|(_, names)| {
            names.texts.iter().map(|name| Shown {
                text: sentence(name),
                file: source.file.clone(),
                room: None,
            })
        }));
    }
    found.extend(SHOWN_NAMES.iter().map(|name| Shown {
        text: (*name).to_owned(),
        file: "tests/texts/exceptions.rs".into(),
        room: None,
    }));
    found.extend(super::presets::texts());
    found.extend(super::command_line::texts());
    let mut firsts: BTreeMap<String, usize> = BTreeMap::new();
    let mut once: Vec<Shown> = Vec::new();
    for shown in found {
        match firsts.get(&shown.text) {
            Some(&first) => once[first].room = once[first].room.max(shown.room),
            None => {
                firsts.insert(shown.text.clone(), once.len());
                once.push(shown);
            }
        }
    }
    once
}

/// An opening mark that is not closed yet, and what it belongs to: `label(`, `format!(`.
struct Opening {
    at: usize,
    mark: char,
    callee: String,
}

/// The texts of one source.
pub fn texts_of(source: &Source) -> Vec<Shown> {
    let tokens = &source.tokens;
    let are_sentences = LOWER_IS_NONE.iter().any(|(end, _)| source.file.ends_with(end));
    let is_excepted = |text: &str| {
        let is_listed =
            |(end, except, _): &(&str, &str, &str)| source.file.ends_with(end) && *except == text;
        (are_sentences && text.starts_with(char::is_lowercase))
            || EXCEPT_TEXTS.iter().any(is_listed)
    };
    let mut found = Vec::new();
    if EXCEPT_FILES.iter().any(|(end, _)| source.file.contains(end)) {
        return found;
    }
    let mut open: Vec<Opening> = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        match token {
            Token::Mark(mark @ ('(' | '[' | '{')) => {
                open.push(Opening { at, mark: *mark, callee: callee(tokens, at) });
            }
            Token::Mark(')' | ']' | '}') => drop(open.pop()),
            Token::Text(text) if !is_excepted(text) => {
                let inner = open.last().map_or("", |opening| &opening.callee);
                let room = match inner {
                    "name" | "choice_row" => Some(Room::Name),
                    "new" if is_bar(tokens, at) => Some(Room::Bar),
                    _ => None,
                };
                let shown = shown_as(&source.file, text, tokens, at, &open);
                found.extend(shown.map(|text| Shown { text, file: source.file.clone(), room }));
            }
            _ => {}
        }
    }
    found
}

/// The first text of `NumberField::new(…)`.
fn is_bar(tokens: &[Token], at: usize) -> bool {
    let of = at.checked_sub(5).and_then(|at| tokens[at].word());
    of == Some("NumberField") && tokens[at - 1].is_mark('(')
}

/// The text that a literal is shown as, if it is shown.
fn shown_as(
    file: &str,
    text: &str,
    tokens: &[Token],
    at: usize,
    open: &[Opening],
) -> Option<String> {
    let inner = open.last().map_or("", |opening| opening.callee.as_str());
    if ["tr!", "tr"].contains(&inner) {
        return Some(template(text));
    }
    if open.iter().any(|opening| NEVER_WITHIN.contains(&opening.callee.as_str()))
        || NO_TEXT_OF.contains(&inner)
        || is_compared(tokens, at)
        || is_identity(text, tokens, at)
    {
        return None;
    }
    let is_of_files = file.starts_with("src/io");
    if !is_of_files && is_choice(text, tokens, at, open) {
        return Some(sentence(text));
    }
    if is_of_files && is_key(text, tokens, at, open) {
        return None;
    }
    let is_phrases_only = is_of_files && !is_label_of_choice(tokens, at);
    is_text(text, is_phrases_only).then(|| template(text))
}

/// The label in `Variant = "name" => ("Label", …)`.
fn is_label_of_choice(tokens: &[Token], at: usize) -> bool {
    let Some(from) = at.checked_sub(4) else { return false };
    matches!(
        tokens[from..at],
        [Token::Text(_), Token::Mark('='), Token::Mark('>'), Token::Mark('(')]
    )
}

/// What an opening mark belongs to: the name before it, with the mark of a macro.
pub fn callee(tokens: &[Token], at: usize) -> String {
    let before = |back: usize| at.checked_sub(back).and_then(|i| tokens.get(i));
    match (before(1), before(2)) {
        (Some(Token::Mark('!')), Some(Token::Word(name))) => format!("{name}!"),
        (Some(Token::Word(name)), _) => name.clone(),
        _ => String::new(),
    }
}

/// A pattern of `match`, or one side of a comparison.
fn is_compared(tokens: &[Token], at: usize) -> bool {
    let mark = |i: Option<usize>| match i.and_then(|i| tokens.get(i)) {
        Some(Token::Mark(mark)) => *mark,
        Some(Token::Word(word)) if word == "if" => '?',
        _ => ' ',
    };
    let after = (mark(Some(at + 1)), mark(Some(at + 2)));
    let before = (mark(at.checked_sub(2)), mark(at.checked_sub(1)));
    matches!(after, ('=', '>' | '=') | ('|' | '?', _) | ('!', '='))
        || matches!(before, ('=' | '!', '='))
}

/// The name of an action of scripts (`"add layer" AddLayer {}`), or of a choice in files
/// (`Variant = "name"`).
fn is_identity(text: &str, tokens: &[Token], at: usize) -> bool {
    let begins_upper = |token: Option<&Token>| {
        token.and_then(Token::word).is_some_and(|word| word.starts_with(char::is_uppercase))
    };
    let is_action = begins_upper(tokens.get(at + 1)) && text.starts_with(char::is_lowercase);
    let is_choice = at >= 2 && tokens[at - 1].is_mark('=') && begins_upper(Some(&tokens[at - 2]));
    is_action || is_choice
}

/// A name in lower-case letters in a table of choices: `[(Side::Left, "left"), …]`. Widgets show it
/// as the beginning of a sentence.
fn is_choice(text: &str, tokens: &[Token], at: usize, open: &[Opening]) -> bool {
    let [.., list, row] = open else { return false };
    let is_row = row.mark == '(' && row.callee.is_empty() && list.mark == '[';
    let is_last = tokens[at - 1].is_mark(',')
        && (tokens[at + 1].is_mark(')')
            || (tokens[at + 1].is_mark(',') && tokens[at + 2].is_mark(')')));
    let begins_with_text = matches!(tokens[row.at + 1], Token::Text(_));
    let is_name = text.starts_with(|c: char| c.is_ascii_lowercase())
        && text.chars().all(|c| c.is_ascii_lowercase() || " -".contains(c));
    is_row && is_last && !begins_with_text && is_name && text.len() > 1
}

/// A name of another program's files in a table: `("hard mix", Mode::HardMix)`.
fn is_key(text: &str, tokens: &[Token], at: usize, open: &[Opening]) -> bool {
    let is_first = open.last().is_some_and(|row| row.callee.is_empty() && row.at + 1 == at);
    let is_before_path = tokens[at + 1].is_mark(',') && tokens[at + 3].is_mark(':');
    text.starts_with(char::is_lowercase) && is_first && is_before_path
}

/// Whether a literal looks like a text: a phrase, or a label that begins like a sentence.
pub fn is_text(text: &str, is_phrases_only: bool) -> bool {
    let shown = template(text);
    let own = without_values(&shown);
    let is_markup = ["=\"", "::", "</", "/>", "\\", "_"].iter().any(|mark| own.contains(mark))
        || own.starts_with(['<', '#', '"', '.', '-']);
    let is_of_space = own.split(':').skip(1).any(|rest| rest.starts_with(char::is_alphabetic));
    if is_markup || is_of_space {
        return false;
    }
    let words = || own.split(|c: char| !(c.is_alphabetic() || c == '\'')).filter(|w| w.len() > 1);
    let mut letters = own.chars();
    let is_label = letters.next().is_some_and(char::is_uppercase)
        && letters.next().is_some_and(char::is_lowercase);
    if !shown.trim().contains(' ') {
        let is_camel = own.chars().skip(1).any(char::is_uppercase);
        let is_file = own.split('.').skip(1).any(|end| end.starts_with(char::is_alphabetic));
        let is_keys = own.contains('+') || own.contains(char::is_numeric) || own.ends_with(':');
        return is_label && !is_phrases_only && !is_camel && !is_file && !is_keys;
    }
    let is_keys = ["Ctrl+", "Alt+", "Shift+"].iter().any(|held| own.starts_with(held));
    if is_keys && words().count() < 3 {
        return false;
    }
    let has_value = own.len() < shown.len();
    // “{name} “{layer}””: what was done, and to what.
    let is_quote = own.contains('“') && values(&shown).len() > 1;
    is_quote
        || words().count() >= 2
        || (has_value && words().any(|word| word.len() > 2))
        || (is_label && !is_phrases_only)
}

/// A text as it is a key: values without how they are written, and those without a name numbered.
pub fn template(text: &str) -> String {
    let (mut key, mut rest, mut count) = (String::new(), text, 0);
    while let Some((words, after)) = rest.split_once('{') {
        key.push_str(words);
        if let Some(after) = after.strip_prefix('{') {
            key.push('{');
            rest = after;
            continue;
        }
        let Some((value, after)) = after.split_once('}') else {
            key.push('{');
            rest = after;
            break;
        };
        let name = value.split(':').next().unwrap_or_default().trim_matches('#');
        match name.parse::<usize>() {
            Ok(number) => key.push_str(&format!("{{{}}}", number + 1)),
            Err(_) if name.is_empty() => {
                count += 1;
                key.push_str(&format!("{{{count}}}"));
            }
            Err(_) => key.push_str(&format!("{{{name}}}")),
        }
        rest = after;
    }
    key + &rest.replace("}}", "}")
}

/// The names of the values of a text.
pub fn values(text: &str) -> Vec<&str> {
    let mut found: Vec<&str> = text
        .split('{')
        .skip(1)
        .filter_map(|part| part.split_once('}').map(|(name, _)| name))
        .collect();
    found.sort_unstable();
    found
}

pub fn without_values(text: &str) -> String {
    let mut own = String::new();
    for (i, part) in text.split('{').enumerate() {
        let kept = if i == 0 { part } else { part.split_once('}').map_or(part, |(_, rest)| rest) };
        own.push_str(kept);
    }
    own
}

/// As the window shows a name of files.
fn sentence(word: &str) -> String {
    let spaced = word.replace('-', " ");
    let mut letters = spaced.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The names of a type's choices, which the window shows for want of others.
struct Names {
    file: String,
    texts: Vec<String>,
}

/// Of each type whose `ALL` the window asks for: the names that it has in files, unless it has labels.
fn names_of_choices(sources: &[Source]) -> BTreeMap<String, Names> {
    let mut asked: BTreeSet<String> = SHOWN_TYPES.iter().map(|&name| name.to_owned()).collect();
    for source in sources.iter().filter(|source| source.file.starts_with("src/window")) {
        for four in source.tokens.windows(4) {
            if let [Token::Word(of), Token::Mark(':'), Token::Mark(':'), Token::Word(all)] = four
                && all == "ALL"
            {
                asked.insert(of.clone());
            }
        }
    }
    let mut found = BTreeMap::new();
    for source in sources {
        let tokens = &source.tokens;
        for at in 0..tokens.len().saturating_sub(8) {
            let Some((of, texts)) = declared(&tokens[at..]) else { continue };
            if asked.contains(of) && !texts.is_empty() && !NAMES_NOT_SHOWN.contains(&of) {
                found.insert(of.to_owned(), Names { file: source.file.clone(), texts });
            }
        }
    }
    found
}

/// The type and the names of `enum X { A = "name", … }` or `const ALL: [(X, …)] = [(…, "name"), …]`.
fn declared(tokens: &[Token]) -> Option<(&str, Vec<String>)> {
    let word = |at: usize| tokens.get(at).and_then(Token::word);
    if word(0) == Some("enum") {
        let body = body(tokens, 2)?;
        let has_labels = body
            .windows(3)
            .any(|three| matches!(three, [Token::Text(_), Token::Mark('='), Token::Mark('>')]));
        return (!has_labels).then(|| (word(1).unwrap_or_default(), texts_in(body)));
    }
    if word(0) == Some("const") && word(1) == Some("ALL") && tokens[4].is_mark('(') {
        let value = tokens.iter().position(|token| token.is_mark('='))?;
        return Some((word(5)?, texts_in(body(tokens, value + 1)?)));
    }
    None
}

/// The group that begins here.
fn body(tokens: &[Token], at: usize) -> Option<&[Token]> {
    let first = tokens.get(at)?;
    if !first.is_mark('{') && !first.is_mark('[') {
        return None;
    }
    let mut depth = 0;
    for (i, token) in tokens.iter().enumerate().skip(at) {
        match token {
            Token::Mark('(' | '[' | '{') => depth += 1,
            Token::Mark(')' | ']' | '}') => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(&tokens[at..i]);
        }
    }
    None
}

fn texts_in(tokens: &[Token]) -> Vec<String> {
    let text = |token: &Token| match token {
        Token::Text(text) => Some(text.clone()),
        _ => None,
    };
    let is_name = |text: &String| text.starts_with(char::is_alphabetic) && text.len() > 1;
    tokens.iter().filter_map(text).filter(is_name).collect()
}

#[test]
fn what_looks_like_a_text_is_one() {
    for text in
        ["Layer", "Brightness/contrast…", "3 of {count} layers", "the hue", "Along x", "{n} layers"]
    {
        assert!(is_text(text, false), "{text}");
    }
    for text in
        ["layer", "a.png", "PartMaps", "Ctrl+J", "<svg a=\"b\"", "{a}: {b}", "{a} · {b}", "Name:"]
    {
        assert!(!is_text(text, false), "{text}");
    }
    assert!(!is_text("Opacity", true) && is_text("the opacity", true));
}

#[test]
fn a_key_has_the_names_of_values_alone() {
    assert_eq!(template("{a:.2} of {} {} {{x}}"), "{a} of {1} {2} {x}");
    assert_eq!(values("{b} of {a}"), ["a", "b"]);
}

#[test]
fn texts_are_told_from_identities_by_where_they_stand() {
    let source = r#"fn a() { ui.label("Two words"); x == "Not this"; match y { "Nor this" => f("This one") }
        assert!(z, "not this {one}"); const T: [(A, &str); 1] = [(A::B, "a-choice")]; enum K { V = "No name" }
        actions! { "no action" Act {} } tr!("{a} is", a = 1); Id::unique("No id"); g(&format!("{} of two", 3)) }"#;
    let source = Source { file: "src/window/a.rs".into(), tokens: tokens(source) };
    let texts: Vec<String> = texts_of(&source).into_iter().map(|shown| shown.text).collect();
    assert_eq!(texts, ["Two words", "This one", "A choice", "{a} is", "{1} of two"]);
}
