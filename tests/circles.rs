//! No circles: sibling modules of one folder, submodules included, do not import each other in a
//! circle. A module and its own submodules may name each other: they are one subject. Reads the
//! sources.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::{fs, iter};

/// The crates, by the names that they are imported by.
const CRATES: [(&str, &str); 4] = [
    ("engine", "rilievo_engine"),
    ("io", "rilievo_io"),
    ("program", "rilievo_program"),
    ("window", "rilievo_window"),
];

/// A module by the names that lead to it: `["io", "maps", "stored"]`.
type ModulePath = Vec<String>;

/// A name that is imported, or named by its path, from the root of its crate.
type ItemPath = Vec<String>;

struct Module {
    /// What it names.
    named: Vec<ItemPath>,
    /// What it re-exports, by the name it has here.
    handed_on: BTreeMap<String, ItemPath>,
}

struct Modules(BTreeMap<ModulePath, Module>);

impl Modules {
    fn read() -> Self {
        let mut texts = BTreeMap::new();
        for (name, _) in CRATES {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(name);
            visit(&folder, &vec![name.to_owned()], &mut texts);
        }
        let known: BTreeSet<ModulePath> = texts.keys().cloned().collect();
        Self(texts.iter().map(|(path, text)| (path.clone(), module(path, text, &known))).collect())
    }

    /// The module that defines an item, also where others re-export it.
    fn home(&self, item: &[String], depth: usize) -> Option<ModulePath> {
        let (module, rest) = (1..=item.len())
            .rev()
            .map(|n| item.split_at(n))
            .find(|(m, _)| self.0.contains_key(*m))?;
        let on = rest
            .first()
            .and_then(|name| self.0[module].handed_on.get(name))
            .filter(|on| on[..] != *item);
        on.filter(|_| depth < 8).and_then(|on| self.home(on, depth + 1)).or(Some(module.to_vec()))
    }

    /// What the modules of a folder import from each other, with an example of each.
    fn arrows(&self, folder: &[String]) -> BTreeMap<(String, String), String> {
        let mut arrows = BTreeMap::new();
        let within = |path: &ModulePath| {
            (path.starts_with(folder) && path.len() > folder.len())
                .then(|| path[folder.len()].clone())
        };
        for (path, module) in &self.0 {
            let Some(from) = within(path) else { continue };
            for item in &module.named {
                if let Some(to) =
                    self.home(item, 0).and_then(|home| within(&home)).filter(|to| *to != from)
                {
                    arrows.entry((from.clone(), to)).or_insert(format!(
                        "{} names {}",
                        path.join("/"),
                        item.join("::")
                    ));
                }
            }
        }
        arrows
    }
}

/// The sources below a folder, without tests, comments and strings.
fn visit(folder: &Path, path: &ModulePath, out: &mut BTreeMap<ModulePath, String>) {
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let name = entry.file_stem().unwrap().to_string_lossy().into_owned();
        if name == "tests" || name.ends_with("_tests") {
            continue;
        }
        let inner = |name: &str| {
            path.iter().cloned().chain(iter::once(name.to_owned())).collect::<ModulePath>()
        };
        if entry.is_dir() {
            visit(&entry, &inner(&name), out);
        } else if entry.extension().is_some_and(|e| e == "rs") {
            let text = fs::read_to_string(&entry).unwrap();
            let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
            let is_root = name == "mod" || name == "lib";
            out.insert(if is_root { path.clone() } else { inner(&name) }, bare(code));
        }
    }
}

/// Code without comments and strings.
fn bare(code: &str) -> String {
    let lines = code.lines().map(|line| line.split("//").next().unwrap_or_default());
    let mut out = String::new();
    for line in lines {
        out.extend(line.split('"').step_by(2));
        out.push('\n');
    }
    out
}

fn module(path: &ModulePath, code: &str, known: &BTreeSet<ModulePath>) -> Module {
    let mut module = Module { named: Vec::new(), handed_on: BTreeMap::new() };
    let mut rest = String::new();
    for statement in code.split_inclusive(';') {
        let Some(at) = find_use(statement) else {
            rest.push_str(statement);
            continue;
        };
        rest.push_str(&statement[..at]);
        let is_public = statement[..at].trim_end().ends_with("pub")
            || statement[..at].trim_end().ends_with(')');
        let tree = statement[at + "use ".len()..].trim_end_matches(';');
        for (item, name) in leaves(tree) {
            let Some(item) = absolute(path, &item, known) else { continue };
            if is_public {
                module.handed_on.insert(name, item);
            } else {
                module.handed_on.insert(name, item.clone());
                module.named.push(item);
            }
        }
    }
    // Paths in the code itself.
    for word in rest.split(|c: char| !(c.is_alphanumeric() || "_:".contains(c))) {
        let parts: Vec<String> = word.split("::").map(str::to_owned).collect();
        if parts.len() > 1 && !parts.iter().any(String::is_empty) {
            module.named.extend(absolute(path, &parts, known));
        }
    }
    module
}

/// Where a `use` statement begins.
fn find_use(statement: &str) -> Option<usize> {
    let at = statement.rfind("use ")?;
    let before = statement[..at].trim_end_matches(' ');
    let begins = before.is_empty()
        || before.ends_with('\n')
        || before.ends_with("pub")
        || before.ends_with(')');
    begins.then_some(at)
}

/// The items of a `use`, each with the name that it has here.
fn leaves(tree: &str) -> Vec<(Vec<String>, String)> {
    let tree = tree.trim();
    let words = |text: &str| -> Vec<String> {
        text.split("::")
            .map(|word| word.trim().to_owned())
            .filter(|word| !word.is_empty())
            .collect()
    };
    let Some(open) = tree.find('{') else {
        let (item, name) =
            tree.split_once(" as ").map_or((tree, None), |(item, name)| (item, Some(name.trim())));
        let mut item = words(item);
        if item.last().is_some_and(|last| last == "self") {
            item.pop();
        }
        let name = name.map(str::to_owned).or(item.last().cloned()).unwrap_or_default();
        return vec![(item, name)];
    };
    let head = words(&tree[..open]);
    let inner = &tree[open + 1..tree.rfind('}').unwrap_or(tree.len())];
    let (mut parts, mut depth, mut start) = (Vec::new(), 0, 0);
    for (i, c) in inner.char_indices().chain(iter::once((inner.len(), ','))) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&inner[start..i]);
                start = i + 1;
            }
            _ => {}
        }
    }
    let parts = parts.into_iter().filter(|part| !part.trim().is_empty()).flat_map(leaves);
    parts.map(|(item, name)| (head.iter().cloned().chain(item).collect(), name)).collect()
}

/// A path from the root of its crate; `None` where it leads to no crate of ours.
fn absolute(here: &ModulePath, item: &[String], known: &BTreeSet<ModulePath>) -> Option<ItemPath> {
    let (first, rest) = item.split_first()?;
    let below =
        |base: &[String], rest: &[String]| base.iter().chain(rest).cloned().collect::<ItemPath>();
    if let Some((name, _)) = CRATES.iter().find(|(_, import)| import == first) {
        return Some(below(&[(*name).to_owned()], rest));
    }
    match first.as_str() {
        "crate" => Some(below(&here[..1], rest)),
        "self" => Some(below(here, rest)),
        "super" => {
            let ups = item.iter().take_while(|word| *word == "super").count();
            Some(below(&here[..here.len().checked_sub(ups)?], &item[ups..]))
        }
        _ => Some(below(here, item)).filter(|path| known.contains(&path[..=here.len()])),
    }
}

/// Groups of modules in which the arrows lead from each to every other.
fn circles(arrows: &BTreeMap<(String, String), String>) -> Vec<Vec<String>> {
    let names: BTreeSet<&String> = arrows.keys().flat_map(|(from, to)| [from, to]).collect();
    let reached = |start: &String| {
        let (mut seen, mut open) = (BTreeSet::new(), vec![start.clone()]);
        while let Some(at) = open.pop() {
            for (_, to) in arrows.keys().filter(|(from, _)| *from == at) {
                if seen.insert(to.clone()) {
                    open.push(to.clone());
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&String, BTreeSet<String>> =
        names.iter().map(|name| (*name, reached(name))).collect();
    let group = |name: &&String| -> Vec<String> {
        reached[*name].iter().filter(|other| reached[other].contains(*name)).cloned().collect()
    };
    let groups: BTreeSet<Vec<String>> =
        names.iter().map(group).filter(|group| group.len() > 1).collect();
    groups.into_iter().collect()
}

#[test]
fn modules_beside_each_other_import_each_other_in_no_circles() {
    let modules = Modules::read();
    let folders: BTreeSet<&[String]> = modules
        .0
        .keys()
        .filter(|path| path.len() > 1)
        .map(|path| &path[..path.len() - 1])
        .collect();
    let mut wrong = Vec::new();
    for folder in folders {
        let arrows = modules.arrows(folder);
        let found = circles(&arrows);
        for circle in &found {
            wrong.push(format!("{}: {} import each other:", folder.join("/"), circle.join(", ")));
            let within =
                |(from, to): &(String, String)| circle.contains(from) && circle.contains(to);
            wrong.extend(
                arrows
                    .iter()
                    .filter(|(arrow, _)| within(arrow))
                    .map(|(_, example)| format!("    {example}")),
            );
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_circle_is_found_however_its_imports_are_written() {
    let texts = [
        (vec!["io"], "mod a;\nmod b;\nmod c;\npub use a::{Thing as Other, inner::Deep};\n"),
        (vec!["io", "a"], "use super::b;\nfn f() { b::run() }\n"),
        (vec!["io", "b"], "use crate::{Error, c::{self, Kind}};\nfn run() {}\n"),
        (vec!["io", "c"], "fn f() -> crate::Other { todo() }\n"),
        (vec!["io", "c", "room"], "use super::Kind;\n"),
    ];
    let owned = |path: &[&str]| path.iter().map(|name| (*name).to_owned()).collect::<ModulePath>();
    let known: BTreeSet<ModulePath> = texts.iter().map(|(path, _)| owned(path)).collect();
    let read =
        texts.iter().map(|(path, text)| (owned(path), module(&owned(path), &bare(text), &known)));
    let arrows = Modules(read.collect()).arrows(&owned(&["io"]));
    let named: Vec<String> = arrows.keys().map(|(from, to)| format!("{from} {to}")).collect();
    assert_eq!(named, ["a b", "b c", "c a"]);
    assert_eq!(circles(&arrows), [["a", "b", "c"]]);
}
