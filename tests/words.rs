//! Words that name nothing: functions are verbs and modules are nouns of the field (docs/STYLE.md).
//! Names that were replaced are listed here, so that they do not come back. The list only grows.

use super::lines::files;
use std::fs;
use std::path::Path;

/// What a name can be of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Named {
    Function,
    Module,
}

/// Names that say nothing about what they name, what they are of, and what to write instead.
const REPLACED: &[(&str, Named, &str)] = &[
    ("adopted", Named::Function, "adopt"),
    ("apart", Named::Function, "split_…, or what differs: …_difference"),
    ("borne", Named::Function, "a verb"),
    ("brought", Named::Function, "a verb"),
    ("came", Named::Function, "resume"),
    ("caught", Named::Function, "catch_…"),
    ("chosen", Named::Function, "selected_…"),
    ("copied", Named::Function, "copy_…"),
    ("deep", Named::Function, "rows16, …_floats"),
    ("dress", Named::Function, "apply_…"),
    ("duplicated", Named::Function, "duplicate"),
    ("emit", Named::Function, "write, encode"),
    ("forgotten", Named::Function, "without_…"),
    ("give_up", Named::Function, "cancel"),
    ("goes", Named::Function, "moves_with_…"),
    ("hear", Named::Function, "read_event"),
    ("heard", Named::Function, "a verb"),
    ("home", Named::Function, "attachment"),
    ("homed", Named::Function, "attach"),
    ("homes", Named::Function, "attachments"),
    ("kept", Named::Function, "what is kept: …_after, load_…"),
    ("known", Named::Function, "get, or what is cached"),
    ("laid", Named::Function, "place_…, with_…"),
    ("left", Named::Function, "remaining_…"),
    ("lent", Named::Function, "a verb"),
    ("let_go", Named::Function, "clear"),
    ("lifted", Named::Function, "unproject_…, or what it is"),
    ("locked", Named::Function, "is_locked, why_locked"),
    ("made", Named::Function, "a verb: build, solve_…, of_…"),
    ("met", Named::Function, "first_hit, or what is met"),
    ("own", Named::Function, "what is owned"),
    ("pictured", Named::Function, "add_picture_…"),
    ("proposed", Named::Function, "propose_…"),
    ("said", Named::Function, "the text that it returns: …_text"),
    ("sculpted", Named::Function, "sculpt_…"),
    ("sought", Named::Function, "find_…"),
    ("take_up", Named::Function, "begin"),
    ("told", Named::Function, "the text that it returns, or how it is written"),
    ("ungrouped", Named::Function, "ungroup"),
    ("upon", Named::Function, "modifiers_of"),
    ("alone", Named::Module, "isolation"),
    ("came", Named::Module, "resume point"),
    ("chosen", Named::Module, "selected_layers"),
    ("deep", Named::Module, "sixteen_bit, floats, high_depth"),
    ("dress", Named::Module, "what it does"),
    ("emit", Named::Module, "write"),
    ("grow", Named::Module, "nearest_feature"),
    ("habits", Named::Module, "brush_options"),
    ("hear", Named::Module, "what it does"),
    ("home", Named::Module, "attachment"),
    ("homes", Named::Module, "attachments"),
    ("judge", Named::Module, "compare"),
    ("laid", Named::Module, "what lies there"),
    ("look", Named::Module, "layer_preview"),
    ("lower", Named::Module, "export"),
    ("near", Named::Module, "perspective, color_distance"),
    ("readings", Named::Module, "accessors"),
    ("springs", Named::Module, "poisson"),
    ("standing", Named::Module, "placed_outlines"),
    ("sway", Named::Module, "wobble"),
    ("told", Named::Module, "messages, notes"),
    ("through", Named::Module, "transformed"),
    ("upon", Named::Module, "modifiers"),
    ("yields", Named::Module, "constrained"),
];

/// What predicates begin with.
const PREDICATES: &[&str] = &["is_", "has_", "are_", "can_"];

/// Functions that do something and return whether they did, or whose name the standard library gave.
/// The list only shrinks: a function that can fail is a `try_…`, and all others are predicates.
const RETURN_BOOL: &[&str] = &[
    "add_image",
    "advance",
    "affine_row_from_canvas",
    "always",
    "apply",
    "begin_edit",
    "begin_shape",
    "commit",
    "compare_layers",
    "compare_stacks",
    "contains",
    "drop_rest",
    "eq",
    "find",
    "find_depth_polarity",
    "follow",
    "hold_action",
    "leave_out_damaged",
    "leave_out_selections",
    "lower_to_alpha",
    "march",
    "prepare",
    "ptr_eq",
    "push",
    "put",
    "report_both",
    "report_displaced",
    "report_rect",
    "report_tiles",
    "report_whole",
    "say",
    "skip",
    "to_bytes",
    "wait_until_written",
];

/// What a suffix of functions was replaced by.
const SUFFIXES: &[(&str, &str)] = &[
    ("_telling", "_with_progress"),
    ("_deep", "…16, …_floats"),
    ("_chosen", "…_selected"),
    ("_homes", "…_attachments"),
];

/// Roots of words that are spelled otherwise in American English.
const BRITISH: &[&str] = &[
    "behaviour",
    "cancelled",
    "cancelling",
    "catalogue",
    "centre",
    "colour",
    "equalis",
    "favour",
    "grey",
    "initialis",
    "labelled",
    "millimetre",
    "neighbour",
    "normalis",
    "optimis",
    "organis",
    "posteris",
    "quantis",
    "rasteris",
    "recognis",
    "serialis",
    "stabilis",
    "travelled",
    "vectoris",
];

/// Where such a word is not ours: the end of the file's path, and the text around the word.
const SPELLED_BY_OTHERS: &[(&str, &str)] = &[
    // The toolkit's function.
    (".rs", ".labelled_by("),
    // A layer of an OpenEXR file.
    ("src/io/picture/light.rs", "\"colour\""),
    // Names that documents of version 0.1 hold.
    ("src/engine/math/named.rs", "\"grey\""),
    ("src/engine/math/named.rs", "\"posterise\""),
    ("src/engine/math/named.rs", "\"curvature-grey\""),
    ("src/engine/math/named.rs", "\"watercolour-"),
    ("src/window/theme.rs", "from_name(\"grey\")"),
    ("tests/recipe/former.rs", ""),
    // What Blender's operators return.
    ("dist/blender/rilievo.py", "{\"CANCELLED\"}"),
    // What people type who look for a command.
    ("src/window/dialogs/palette/find.rs", "(\"colour\""),
    ("src/window/dialogs/palette/find.rs", "(\"grey\""),
    ("src/window/dialogs/palette/find.rs", "\"rasterise\""),
    ("src/window/dialogs/palette/find.rs", "\"stabilis"),
    // This list.
    ("tests/words.rs", ""),
];

/// Words of a line that are not spelled as in American English.
fn british(place: &str, line: &str) -> Vec<&'static str> {
    let mut line = line.to_owned();
    for (_, around) in SPELLED_BY_OTHERS.iter().filter(|(end, _)| place.ends_with(end)) {
        if around.is_empty() {
            return Vec::new();
        }
        line = line.replace(around, "");
    }
    line.make_ascii_lowercase();
    BRITISH.iter().copied().filter(|root| line.contains(root)).collect()
}

/// The functions and modules that a text defines.
fn defined(text: &str) -> Vec<(Named, &str)> {
    text.lines().filter_map(definition).collect()
}

/// What a line defines.
fn definition(line: &str) -> Option<(Named, &str)> {
    let words: Vec<&str> = line.split("//").next()?.split_whitespace().collect();
    let (at, what) = words.iter().enumerate().find_map(|(i, word)| match *word {
        "fn" => Some((i, Named::Function)),
        "mod" => Some((i, Named::Module)),
        _ => None,
    })?;
    let is_front = |word: &&str| {
        word.starts_with("pub")
            || ["const", "unsafe", "in", "extern"].contains(word)
            || word.ends_with(')')
    };
    if !words[..at].iter().all(is_front) {
        return None;
    }
    let name = words.get(at + 1)?.split(|c: char| !(c.is_alphanumeric() || c == '_')).next()?;
    Some((what, name))
}

/// The function that a line defines.
pub fn function(line: &str) -> Option<&str> {
    definition(line).filter(|(what, _)| *what == Named::Function).map(|(_, name)| name)
}

/// The functions of a text, without its tests, that return `bool`.
fn returning_bool(text: &str) -> Vec<&str> {
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let mut found = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let rest = &text[start..];
        start += line.len();
        let Some(name) = function(line) else { continue };
        let signature = rest.split(['{', ';']).next().unwrap_or_default();
        let words = signature.split_whitespace().collect::<Vec<_>>().join(" ");
        let words = words.split(" where ").next().unwrap_or_default();
        // `-> impl Fn(…) -> bool` returns something that returns it.
        let returns_function = words.matches(" -> impl ").count() > 0;
        if words.ends_with("-> bool") && !returns_function {
            found.push(name);
        }
    }
    found
}

/// What a name is to be replaced by, if it is one of those.
fn replacement(what: Named, name: &str) -> Option<&'static str> {
    let whole = REPLACED.iter().find(|row| (row.0, row.1) == (name, what)).map(|row| row.2);
    let ends = |row: &&(&str, &str)| what == Named::Function && name.ends_with(row.0);
    whole.or_else(|| SUFFIXES.iter().find(ends).map(|row| row.1))
}

#[test]
fn names_that_were_replaced_do_not_come_back() {
    let mut wrong = Vec::new();
    let mut count = 0;
    for path in files("src", "rs") {
        let text = fs::read_to_string(&path).unwrap();
        let place =
            path.strip_prefix(Path::new(env!("CARGO_MANIFEST_DIR"))).unwrap().display().to_string();
        for (what, name) in defined(&text) {
            count += 1;
            if let Some(instead) = replacement(what, name) {
                wrong.push(format!("{place}: {what:?} {name}: write {instead}"));
            }
        }
    }
    assert!(count > 6000, "only {count} names were found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn names_are_found_however_they_are_written() {
    let text = "mod a;\npub(in crate::b) mod c {\n    pub const fn d() {}\n    // fn e() {}\n    fn f<T>() {}\n}\n\
                let g = \"fn h\";\nfn drawn_telling() {}\n";
    let names: Vec<&str> = defined(text).into_iter().map(|(_, name)| name).collect();
    assert_eq!(names, ["a", "c", "d", "f", "drawn_telling"]);
    assert_eq!(replacement(Named::Function, "drawn_telling"), Some("_with_progress"));
    assert_eq!(replacement(Named::Module, "sway"), Some("wobble"));
    assert_eq!(replacement(Named::Function, "sway"), None);
}

#[test]
fn predicates_are_named_as_such() {
    let is_test = |path: &Path| {
        path.components().any(|part| part.as_os_str() == "tests") || path.ends_with("tests.rs")
    };
    let (mut wrong, mut unused, mut count) = (Vec::new(), RETURN_BOOL.to_vec(), 0);
    for path in files("src", "rs").into_iter().filter(|path| !is_test(path)) {
        let text = fs::read_to_string(&path).unwrap();
        for name in returning_bool(&text) {
            count += 1;
            unused.retain(|listed| *listed != name);
            let is_predicate = PREDICATES.iter().any(|begin| name.starts_with(begin));
            if !is_predicate && !name.starts_with("try_") && !RETURN_BOOL.contains(&name) {
                wrong.push(format!("{}: {name}", path.display()));
            }
        }
    }
    assert!(count > 380, "only {count} functions that return bool were found");
    assert!(wrong.is_empty(), "begin these with {PREDICATES:?} or try_: {wrong:#?}");
    assert!(unused.is_empty(), "remove from RETURN_BOOL: {unused:?}");
}

#[test]
fn functions_that_return_bool_are_found_however_they_are_written() {
    let text = "fn is_a(x: u8) -> bool {\n}\n    pub(super) fn b<T>(\n        x: impl Fn() -> bool,\n    ) \
                -> bool\n    where\n        T: D,\n    {\n}\nfn c(x: impl Fn() -> bool) {}\nfn f() -> impl Fn() \
                -> bool {\n}\n// fn e() -> bool {\n#[cfg(test)]\nmod tests {\n    fn d() -> bool {}\n";
    assert_eq!(returning_bool(text), ["is_a", "b"]);
}

#[test]
fn every_word_is_spelled_as_in_american_english() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    let folders = [
        "src",
        "tests",
        "benches",
        "examples",
        "sample_normals",
        "brushes",
        "fuzz",
        "docs",
        "dist",
    ];
    let kinds = ["rs", "md", "py", "toml"];
    for path in kinds
        .into_iter()
        .flat_map(|kind| folders.iter().flat_map(move |folder| files(folder, kind)))
    {
        count += 1;
        let place = path.display().to_string();
        for (line, number) in fs::read_to_string(&path).unwrap().lines().zip(1..) {
            wrong.extend(
                british(&place, line).into_iter().map(|root| format!("{place}:{number}: {root}")),
            );
        }
    }
    assert!(count > 1000, "only {count} files were found");
    assert!(wrong.is_empty(), "spell these otherwise: {}", wrong.join("\n"));
}

#[test]
fn a_british_spelling_is_found_in_any_name() {
    assert_eq!(british("src/a.rs", "fn is_grey(Colours: u8) {}"), ["colour", "grey"]);
    assert_eq!(british("src/a.rs", "ui.add(px).labelled_by(label.id)"), [""; 0]);
    assert_eq!(british("src/io/picture/light.rs", "[\"color\", \"colour\"]"), [""; 0]);
}
