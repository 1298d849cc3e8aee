//! Functions are verbs (docs/STYLE.md). A participle names a changed copy alone, as `scaled` does, or says of which
//! things a noun is meant, as `selected_layers` does.

use super::lines::files;
use super::words::function;
use std::fs;

/// Participles that do not end in “ed”.
const IRREGULAR: &[&str] = &[
    "begun",
    "bent",
    "borne",
    "bought",
    "broken",
    "brought",
    "built",
    "caught",
    "chosen",
    "done",
    "drawn",
    "driven",
    "forgotten",
    "found",
    "given",
    "gone",
    "grown",
    "heard",
    "held",
    "hidden",
    "kept",
    "known",
    "laid",
    "led",
    "left",
    "lent",
    "lit",
    "lost",
    "made",
    "met",
    "remade",
    "rebuilt",
    "said",
    "seen",
    "sent",
    "shown",
    "shrunk",
    "sought",
    "spoken",
    "spun",
    "stood",
    "struck",
    "stuck",
    "sunk",
    "swept",
    "swung",
    "taken",
    "taught",
    "thrown",
    "told",
    "torn",
    "undone",
    "understood",
    "unwound",
    "wound",
    "woven",
    "worn",
    "written",
];

/// Words that end so and are none.
const NO_PARTICIPLES: &[&str] =
    &["bleed", "embed", "feed", "need", "proceed", "red", "seed", "shed", "speed"];

/// Words that no noun phrase ends with: `moved_by` is not a kind of “by”.
const PARTICLES: &[&str] = &[
    "about", "again", "ahead", "alone", "along", "anew", "apart", "around", "as", "aside", "at",
    "away", "back", "beyond", "by", "down", "for", "from", "in", "into", "of", "off", "on", "onto",
    "out", "over", "since", "through", "to", "under", "up", "with", "within",
];

/// Changed copies whose type has another name than what they are copies of, and names that a library gave.
const ALLOWED: &[&str] = &[
    // Of a layer's kind, as `Content`.
    "scaled",
    "stretched",
    "moved",
    // The same pixels, as another alias of the grid or bare values.
    "cropped",
    "premultiplied",
    "rounded",
    "translated",
    // Of winit's `ApplicationHandler`.
    "resumed",
    "suspended",
];

fn is_participle(word: &str) -> bool {
    IRREGULAR.contains(&word) || word.ends_with("ed") && !NO_PARTICIPLES.contains(&word)
}

/// A function as it is declared.
struct Signature<'a> {
    name: &'a str,
    parameters: &'a str,
    /// Empty if it returns nothing.
    returned: &'a str,
    /// The type that it is a method of, if it is one.
    owner: Option<String>,
}

/// How long the text within the bracket is that a text begins with.
fn bracketed(text: &str) -> usize {
    let (mut depth, mut before) = (0, ' ');
    for (at, c) in text.char_indices() {
        match c {
            '(' | '[' | '<' => depth += 1,
            ')' | ']' => depth -= 1,
            '>' if before != '-' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at;
        }
        before = c;
    }
    text.len()
}

/// The function that a text declares from `fn` on.
fn signature(text: &str, owner: Option<String>) -> Option<Signature<'_>> {
    let end = text.find(" {\n").into_iter().chain(text.find(";\n")).min().unwrap_or(text.len());
    let text = text[..end].strip_prefix("fn ")?;
    let (name, mut rest) = text.split_at(text.find(['(', '<'])?);
    if rest.starts_with('<') {
        rest = rest.get(bracketed(rest) + 1..)?;
    }
    let close = bracketed(rest);
    let parameters = rest.get(1..close)?;
    let returned = rest.get(close + 1..)?.trim().strip_prefix("-> ").unwrap_or_default();
    Some(Signature { name, parameters, returned, owner })
}

/// The type of an `impl` or the name of a trait, from the line that begins it.
fn owner(line: &str) -> Option<String> {
    let rest =
        line.strip_prefix("impl").or_else(|| line.split_once("trait ").map(|(_, name)| name))?;
    let rest = if rest.starts_with('<') { rest.get(bracketed(rest) + 1..)? } else { rest };
    Some(named_type(rest.split(" for ").last()?).to_owned())
}

/// The innermost type that a type is about: `Layer` of `Option<Arc<Layer>>`.
fn named_type(ty: &str) -> &str {
    let mut ty = ty.trim_start_matches(['&', '(', '[', ' ']);
    for wrapper in ["Option<", "Result<", "Vec<", "Arc<", "&", "["] {
        ty = ty.strip_prefix(wrapper).unwrap_or(ty);
    }
    let path = ty
        .split(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':'))
        .next()
        .unwrap_or_default();
    path.rsplit("::").next().unwrap_or_default()
}

/// The functions of a text that are no tests.
fn functions(text: &str) -> Vec<Signature<'_>> {
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let (mut found, mut start, mut within, mut is_test) = (Vec::new(), 0, None, false);
    for line in text.split_inclusive('\n') {
        is_test |= line.trim() == "#[test]";
        if !line.starts_with([' ', '/', '#', '\n']) {
            within = owner(line);
        }
        if let Some(at) = function(line).and_then(|_| line.find("fn ")) {
            let owner = within.clone().filter(|_| line.starts_with(' '));
            let declared = signature(&text[start + at..], owner);
            found.extend(declared.filter(|_| !std::mem::take(&mut is_test)));
        }
        start += line.len();
    }
    found
}

/// Whether a function is named by a participle that is neither a changed copy nor part of a noun.
fn is_misnamed(function: &Signature) -> bool {
    let mut words = function.name.split('_');
    let (first, last) = (words.next().unwrap_or_default(), words.next_back());
    if !is_participle(first) || ALLOWED.contains(&function.name) {
        return false;
    }
    let is_noun = last.is_some_and(|last| !PARTICLES.contains(&last));
    let result = named_type(function.returned);
    let (own, changes) =
        (function.parameters.trim_start(), function.parameters.contains("&mut self"));
    let is_of_self = own.split(',').next().is_some_and(|first| first.contains("self")) && !changes;
    let is_own_type = result == "Self" || function.owner.as_deref() == Some(result);
    let of_parameter =
        || own.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(|word| word == result);
    let is_copy = is_of_self && is_own_type || of_parameter();
    function.returned.is_empty() || !is_noun && !is_copy
}

#[test]
fn functions_are_verbs_and_participles_name_changed_copies() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    for path in ["src", "brushes"].into_iter().flat_map(|folder| files(folder, "rs")) {
        let text = fs::read_to_string(&path).unwrap();
        for function in functions(&text) {
            count += 1;
            if is_misnamed(&function) {
                wrong.push(format!("{}: {}", path.display(), function.name));
            }
        }
    }
    assert!(count > 8000, "only {count} functions were found");
    assert!(
        wrong.is_empty(),
        "name these by a verb for what they do or a noun for what they return: a participle names a changed copy of \
         what it is given: {wrong:#?}"
    );
}

#[test]
fn functions_are_found_however_they_are_declared() {
    let text = "impl<T> Grid<T> {\n    pub(super) fn moved(&self, by: [f32; 2]) -> Self {\n    }\n    \
                const fn dragged(&mut self) -> Self {\n    }\n    fn selected_tiles(&self) -> Vec<At> {\n    \
                }\n    fn moved_by(&self) -> Vec2 {\n    }\n    fn saved(self) {\n    }\n}\nfn sorted<F: \
                Fn(u8) -> u8>(\n    all: Vec<Stop>,\n    by: F,\n) -> Vec<Stop>\nwhere\n    F: Copy,\n{\n}\n\
                fn lit(size: Size) -> Layer {\n}\nfn seed(n: u8) {\n}\n// fn told() {\nimpl Roll for Brush \
                {\n    fn drawn(dice: &mut Dice) -> Self {\n    }\n}\n#[test]\nfn kept_is_kept() {\n}\n";
    let found = functions(text);
    let names: Vec<_> = found.iter().map(|function| function.name).collect();
    assert_eq!(
        names,
        [
            "moved",
            "dragged",
            "selected_tiles",
            "moved_by",
            "saved",
            "sorted",
            "lit",
            "seed",
            "drawn"
        ]
    );
    let wrong: Vec<_> = found.iter().filter(|f| is_misnamed(f)).map(|f| f.name).collect();
    assert_eq!(wrong, ["dragged", "moved_by", "saved", "lit", "drawn"]);
    assert_eq!(found[4].owner.as_deref(), Some("Grid"));
    assert_eq!(found[8].owner.as_deref(), Some("Brush"));
}
