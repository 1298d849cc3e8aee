//! Documents point at what is there: links, files between backticks, and the sections that comments
//! cite.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The files below a folder that end so, sorted.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.is_dir() {
            found.extend(files(&entry, ending));
        } else if entry.to_string_lossy().ends_with(ending) {
            found.push(entry);
        }
    }
    found.sort();
    found
}

/// Every document of the repository.
fn documents() -> Vec<PathBuf> {
    let top = fs::read_dir(root()).unwrap().map(|entry| entry.unwrap().path());
    let top = top.filter(|path| path.extension().is_some_and(|e| e == "md"));
    let all: Vec<PathBuf> = top.chain(files(&root().join("docs"), ".md")).collect();
    assert!(all.len() >= 12, "only {} documents", all.len());
    all
}

/// A document without its blocks of code.
fn prose(text: &str) -> String {
    let parts = text.split("\n```");
    parts.step_by(2).collect::<Vec<_>>().join("\n")
}

/// The texts between `open` and `close`, each on one line.
fn between<'a>(text: &'a str, open: &str, close: &str) -> Vec<&'a str> {
    let rests = text.match_indices(open).map(|(at, _)| &text[at + open.len()..]);
    rests
        .filter_map(|rest| rest.split_once(close))
        .map(|(inside, _)| inside)
        .filter(|s| !s.contains('\n'))
        .collect()
}

/// The anchor of a heading, as GitHub makes it.
fn anchor(heading: &str) -> String {
    let kept = heading.trim_start_matches('#').trim().to_lowercase();
    kept.chars()
        .filter(|c| c.is_alphanumeric() || " -_".contains(*c))
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

fn has_anchor(document: &Path, wanted: &str) -> bool {
    prose(&text(document))
        .lines()
        .filter(|line| line.starts_with('#'))
        .any(|line| anchor(line) == wanted)
}

/// Links of a document that lead nowhere.
fn dead_links(document: &Path, text: &str) -> Vec<String> {
    let folder = document.parent().unwrap();
    let is_dead = |link: &&str| {
        let (path, section) = link.split_once('#').unwrap_or((link, ""));
        let target = if path.is_empty() { document.to_owned() } else { folder.join(path) };
        !target.exists() || (!section.is_empty() && !has_anchor(&target, section))
    };
    let links = between(text, "](", ")").into_iter().filter(|link| !link.contains("://"));
    links.filter(is_dead).map(|link| format!("{}: {link}", document.display())).collect()
}

/// Beginnings of paths that only this repository has.
const OWN: [&str; 10] = [
    "src/",
    "docs/",
    "tests/",
    "benches/",
    "brushes/",
    "sample_normals/",
    "examples/",
    "fuzz/",
    ".ci/",
    "../",
];

/// Files between backticks that do not exist. A path may mean several (`docs/*.md`) or be a
/// placeholder (`src/NAME.rs`); that of a source file may begin at any folder (`raster/tile.rs`).
fn dead_paths(document: &Path, text: &str) -> Vec<String> {
    let sources = files(&root().join("src"), ".rs");
    let is_dead = |path: &&str| {
        let is_own = OWN.iter().any(|start| path.starts_with(start));
        let is_source = path.ends_with(".rs") && path.contains('/');
        let stands_for_others = path.contains(['*', '{', '<', ' ', '…'])
            || path.split('/').any(|p| p.starts_with("NAME"));
        let exists = root().join(path).exists()
            || (!is_own && sources.iter().any(|source| source.ends_with(path)));
        (is_own || is_source) && !stands_for_others && !exists
    };
    let dead = between(text, "`", "`").into_iter().filter(is_dead);
    dead.map(|path| format!("{}: {path}", document.display())).collect()
}

#[test]
fn every_link_of_the_documents_leads_somewhere() {
    let dead: Vec<String> =
        documents().iter().flat_map(|path| dead_links(path, &prose(&text(path)))).collect();
    assert!(dead.is_empty(), "{}", dead.join("\n"));
}

#[test]
fn every_file_that_the_documents_name_is_there() {
    let dead: Vec<String> =
        documents().iter().flat_map(|path| dead_paths(path, &prose(&text(path)))).collect();
    assert!(dead.is_empty(), "{}", dead.join("\n"));
}

/// Documents that comments of the code name, and the sections of `docs/MATH.md`.
fn cited(code: &str) -> BTreeSet<String> {
    let documents = between(code, "docs/", ".md")
        .into_iter()
        .filter(|name| name.chars().all(|c| c.is_ascii_uppercase()));
    let mut cited: BTreeSet<String> = documents.map(|name| format!("docs/{name}.md")).collect();
    for (at, word) in code.match_indices("MATH ") {
        let number: String =
            code[at + word.len()..].chars().take_while(char::is_ascii_digit).collect();
        if !number.is_empty() {
            cited.insert(format!("MATH {number}"));
        }
    }
    cited
}

#[test]
fn what_comments_cite_is_there() {
    let math = text(&root().join("docs/MATH.md"));
    let sections: BTreeSet<String> = math
        .lines()
        .filter_map(|line| line.strip_prefix("## ")?.split_once('.'))
        .map(|(number, _)| format!("MATH {number}"))
        .collect();
    let mut seen = BTreeSet::new();
    for file in ["src", "tests", "benches", "fuzz"]
        .iter()
        .flat_map(|folder| files(&root().join(folder), ".rs"))
    {
        // This file names what is not there.
        for citation in
            cited(&text(&file)).into_iter().filter(|_| !file.ends_with("tests/documents.rs"))
        {
            let is_there = sections.contains(&citation) || root().join(&citation).is_file();
            assert!(is_there, "{}: {citation} is not there", file.display());
            seen.insert(citation);
        }
    }
    assert!(
        ["MATH 2", "MATH 4", "MATH 5"].iter().all(|section| seen.contains(*section)),
        "{seen:?}"
    );
}

#[test]
fn what_leads_nowhere_is_found() {
    let document = root().join("docs/MATH.md");
    let links = "[a](EQUATIONS.md), [b](NOWHERE.md#x) [c](#5-radiance-scaling-rs-eq-2) [d](#6-nothing) \
                 [e](https://example.org)";
    let dead = dead_links(&document, links);
    assert_eq!(dead.len(), 2, "{dead:?}");
    assert!(dead[0].ends_with("NOWHERE.md#x") && dead[1].ends_with("#6-nothing"));
    let paths = dead_paths(
        &document,
        "`src/main.rs`, `src/no.rs`, `docs/*.md`, `tests/NAME.rs`, `D_n`, `math/srgb.rs`, `math/no.rs`",
    );
    assert_eq!(paths.len(), 2, "{paths:?}");
    assert_eq!(
        cited("//! MATH 6, docs/NO.md; MATH"),
        BTreeSet::from(["MATH 6".into(), "docs/NO.md".into()])
    );
    assert_eq!(prose("a\n```sh\n[x](y)\n```\nb"), "a\n\nb");
}

/// The lines of a document's examples in Rust.
fn examples(text: &str) -> Vec<&str> {
    let blocks = text.split("\n```rust\n").skip(1).filter_map(|rest| rest.split_once("\n```"));
    blocks
        .flat_map(|(block, _)| block.lines())
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .collect()
}

#[test]
fn the_examples_of_good_style_are_taken_from_the_code() {
    let code: String = files(&root().join("src"), ".rs").iter().map(|file| text(file)).collect();
    let style = text(&root().join("docs/STYLE.md"));
    let examples = examples(&style);
    assert!(examples.len() >= 15, "only {} lines of examples", examples.len());
    let gone: Vec<_> = examples.into_iter().filter(|line| !code.contains(*line)).collect();
    assert!(
        gone.is_empty(),
        "docs/STYLE.md shows what is no longer in the code:\n{}",
        gone.join("\n")
    );
}
