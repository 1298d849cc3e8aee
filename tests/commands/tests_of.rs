//! The names of the tests and benchmarks that a target holds, read from its sources.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// A test, as a filter sees it.
#[derive(Debug, PartialEq)]
pub struct TestName {
    /// `module::within::name`.
    pub path: String,
    pub is_ignored: bool,
}

/// Every test of a target whose root is this file, built with these features.
pub fn test_names(root: &Path, features: &BTreeSet<String>) -> Vec<TestName> {
    let mut found = Vec::new();
    let folder = root.parent().unwrap();
    read_module(root, folder, "", features, &mut found);
    found
}

/// Every function of a benchmark's file.
pub fn bench_names(source: &Path) -> Vec<String> {
    fs::read_to_string(source).unwrap_or_default().lines().filter_map(function).collect()
}

/// Adds the tests of a file and of its modules, which lie in `folder`. rustfmt's indentation tells
/// what is within what.
fn read_module(
    file: &Path,
    folder: &Path,
    prefix: &str,
    features: &BTreeSet<String>,
    found: &mut Vec<TestName>,
) {
    let text = fs::read_to_string(file).unwrap_or_default();
    // Modules written in this file that are open, each with its indentation.
    let mut open: Vec<(usize, &str)> = Vec::new();
    let (mut is_test, mut is_ignored, mut is_left_out) = (false, false, false);
    for line in text.lines() {
        let (trimmed, indent) = (line.trim(), line.len() - line.trim_start().len());
        if trimmed == "}" {
            open.retain(|(depth, _)| *depth != indent);
        } else if trimmed.starts_with("#[test]") {
            is_test = true;
        } else if trimmed.starts_with("#[ignore") {
            is_ignored = true;
        } else if let Some(feature) =
            trimmed.strip_prefix("#[cfg(feature = \"").and_then(|s| s.strip_suffix("\")]"))
        {
            is_left_out = !features.contains(feature);
        } else if let Some(name) = module(trimmed) {
            match name.strip_suffix(" {") {
                Some(name) => open.push((indent, name)),
                None if is_left_out => {}
                None => read_submodule(name, folder, prefix, features, found),
            }
            is_left_out = false;
        } else if let Some(name) = function(line).filter(|_| is_test) {
            let within: String = open.iter().map(|(_, name)| format!("{name}::")).collect();
            found.push(TestName { path: format!("{prefix}{within}{name}"), is_ignored });
            (is_test, is_ignored) = (false, false);
        }
    }
}

/// The file `NAME.rs` or `NAME/mod.rs`.
fn read_submodule(
    name: &str,
    folder: &Path,
    prefix: &str,
    features: &BTreeSet<String>,
    found: &mut Vec<TestName>,
) {
    let (below, beside) = (folder.join(name), folder.join(format!("{name}.rs")));
    let file = if beside.is_file() { beside } else { below.join("mod.rs") };
    read_module(&file, &below, &format!("{prefix}{name}::"), features, found);
}

/// What a line declares as a module: `name`, or `name {` where it is written there.
fn module(line: &str) -> Option<&str> {
    let (before, rest) = line.split_once("mod ")?;
    let is_declared = before.is_empty() || before.starts_with("pub");
    let is_name =
        |name: &str| name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
    let found = rest.strip_suffix(';').or(rest.ends_with(" {").then_some(rest))?;
    (is_declared && is_name(found.trim_end_matches(" {"))).then_some(found)
}

/// The function that a line begins.
fn function(line: &str) -> Option<String> {
    let rest = line.trim_start().trim_start_matches("pub ").strip_prefix("fn ")?;
    Some(rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect())
}

#[test]
fn tests_are_found_in_files_modules_and_features() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/main.rs");
    let bare = test_names(&root, &BTreeSet::new());
    let has = |names: &[TestName], path: &str, is_ignored| {
        names.iter().any(|test| test.path == path && test.is_ignored == is_ignored)
    };
    assert!(has(&bare, "commands::tests_of::tests_are_found_in_files_modules_and_features", false));
    assert!(has(&bare, "kills::long_ten_thousand_kills_while_it_saves", true), "{bare:?}");
    assert!(bare.iter().all(|test| !test.path.starts_with("window::")));
    let whole = test_names(&root, &BTreeSet::from(["window-tests".to_owned()]));
    assert!(whole.iter().any(|test| test.path.starts_with("window::")));
}
