//! A type's name means one thing: the sources never define two types of one name. Types in tests do
//! not count.

use super::lines::files;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The types that a text defines: structs, enums, traits and aliases, not those within traits and
/// `impl`s.
fn defined(text: &str) -> Vec<String> {
    let without_tests = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let name = |line: &str| {
        let line =
            line.strip_prefix("    ").filter(|rest| rest.starts_with("pub enum ")).unwrap_or(line);
        let line = match line.strip_prefix("pub") {
            Some(rest) if rest.starts_with('(') => {
                rest.split_once(") ").map_or("", |(_, rest)| rest)
            }
            Some(rest) => rest.trim_start(),
            None => line,
        };
        let rest = ["struct ", "enum ", "trait ", "type ", "union "]
            .iter()
            .find_map(|word| line.strip_prefix(word))?;
        let name = rest.split(|c: char| !(c.is_alphanumeric() || c == '_')).next()?;
        (!name.is_empty()).then(|| name.to_owned())
    };
    without_tests.lines().filter_map(name).collect()
}

#[test]
fn no_two_types_have_one_name() {
    let mut homes: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let is_test = |path: &Path| {
        path.components().any(|part| part.as_os_str() == "tests") || path.ends_with("tests.rs")
    };
    for path in ["src", "brushes"]
        .into_iter()
        .flat_map(|folder| files(folder, "rs"))
        .filter(|path| !is_test(path))
    {
        for name in defined(&fs::read_to_string(&path).unwrap()) {
            homes.entry(name).or_default().push(path.display().to_string());
        }
    }
    assert!(homes.len() > 900, "only {} types were found", homes.len());
    homes.retain(|_, homes| homes.len() > 1);
    assert!(homes.is_empty(), "names of more than one type: {homes:#?}");
}

/// A module has one style: its file is named as it is, beside the folder of its submodules.
#[test]
fn no_module_of_the_sources_is_called_mod() {
    let wrong: Vec<_> =
        files("src", "rs").into_iter().filter(|path| path.ends_with("mod.rs")).collect();
    assert!(wrong.is_empty(), "name these as their folders, and put them beside them: {wrong:#?}");
}

#[test]
fn types_are_found_however_they_are_written() {
    let text = "pub(super) struct A<'a> {\n}\nnamed! {\n    pub enum B {\n    }\n}\ntype C = u8;\npub trait D {\n    \
                type Within;\n}\nfn f() {\n    enum Inner {}\n}\n#[cfg(test)]\nmod tests {\n    struct Test;\n}\n";
    assert_eq!(defined(text), ["A", "B", "C", "D"]);
}
