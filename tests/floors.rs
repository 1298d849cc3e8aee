//! The floors hold: arrows between modules point down only, neighbors do not import each other,
//! and the lower floors touch neither files nor clocks nor threads. Reads the sources, so that the
//! table below cannot be forgotten.

use std::{fs, path::Path};

/// `docs/ARCHITECTURE.md` shows the same table.
const FLOORS: [(&str, u32); 16] = [
    ("error", 0),
    ("math", 0),
    ("memory", 0),
    ("raster", 1),
    ("surface", 2),
    ("paint", 3),
    ("shading", 3),
    ("shape", 3),
    ("document", 4),
    ("tools", 5),
    ("io", 5),
    ("language", 6),
    ("session", 6),
    ("window", 7),
    ("cli", 7),
    ("web", 8),
];

/// The modules of `std` that floors 0–4 may not name. Rayon is allowed there: it gets its threads from outside.
const OUTSIDE_WORLD: [&str; 7] = ["fs", "net", "env", "process", "thread", "time", "io"];

fn floor(module: &str) -> Option<u32> {
    FLOORS.iter().find(|(name, _)| *name == module).map(|(_, floor)| *floor)
}

/// Every source file below `src` with its text, comments taken out.
fn sources() -> Vec<(String, String)> {
    fn visit(folder: &Path, out: &mut Vec<(String, String)>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                visit(&path, out);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                let code: String = text
                    .lines()
                    .filter(|l| !l.trim_start().starts_with("//"))
                    .fold(String::new(), |code, line| {
                        code + line.split(" // ").next().unwrap_or("") + "\n"
                    });
                let name = path
                    .strip_prefix(env!("CARGO_MANIFEST_DIR"))
                    .unwrap()
                    .to_string_lossy()
                    .into_owned();
                out.push((name, code));
            }
        }
    }
    let mut out = Vec::new();
    visit(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut out);
    out
}

/// The crates that hold several floors; the others are one floor each.
const CRATES_OF_FLOORS: [&str; 2] = ["engine", "program"];

/// The module on a floor that a file belongs to: `src/io/json/text.rs` belongs to `io`,
/// `src/engine/math/rect.rs` to `math`.
fn module_of(file: &str) -> &str {
    let mut parts = file.split('/').skip(1).map(|part| part.trim_end_matches(".rs"));
    let first = parts.next().unwrap();
    if CRATES_OF_FLOORS.contains(&first) { parts.next().unwrap() } else { first }
}

/// Whether a module is the root of a crate, which names all of its floors.
fn is_root(file: &str) -> bool {
    file.ends_with("/lib.rs") || file == "src/main.rs"
}

/// What code names beneath a root such as `crate::`, alone or in braces, in `use` lines and in
/// paths.
fn named_beneath<'c>(code: &'c str, root: &str) -> Vec<&'c str> {
    let mut named = Vec::new();
    for (at, _) in code.match_indices(root) {
        let rest = code[at + root.len()..].trim_start();
        match rest.strip_prefix('{') {
            Some(list) => named.extend(first_words(list)),
            None => named.push(word(rest)),
        }
    }
    named
}

/// The modules of its own crate that code names.
fn named_modules(code: &str) -> Vec<&str> {
    let mut named = named_beneath(code, "crate::");
    // What is re-exported at the top (types, macros) is on floor 0.
    named.retain(|name| {
        name.starts_with(|c: char| c.is_lowercase()) && !["widest", "named", "tr"].contains(name)
    });
    named
}

/// The first word of each item of a brace list.
fn first_words(list: &str) -> Vec<&str> {
    let (mut words, mut depth, mut start) = (Vec::new(), 0, 0);
    for (i, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            ',' | '}' if depth == 0 => {
                words.push(word(list[start..i].trim_start()));
                start = i + 1;
                if c == '}' {
                    break;
                }
            }
            '}' => depth -= 1,
            _ => {}
        }
    }
    words
}

fn word(text: &str) -> &str {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or("")
}

#[test]
fn arrows_between_floors_point_down_only() {
    let mut wrong = Vec::new();
    for (file, code) in sources() {
        if is_root(&file) {
            continue;
        }
        let here = module_of(&file);
        let Some(at) = floor(here) else {
            wrong.push(format!("{file}: the module {here} stands on no floor"));
            continue;
        };
        for named in named_modules(&code).into_iter().filter(|named| *named != here) {
            match floor(named) {
                Some(below) if below < at => {}
                // An error may wrap what memory refused.
                Some(_) if (here, named) == ("error", "memory") => {}
                Some(other) => {
                    wrong.push(format!("{file}: {here} (floor {at}) names {named} (floor {other})"))
                }
                // A crate of one floor names its own modules.
                None if ["io", "window", "web"].contains(&here) => {}
                None => wrong.push(format!("{file}: names {named}, which stands on no floor")),
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_chain_of_supers_climbs_out_of_its_module() {
    for (file, code) in sources().into_iter().filter(|(file, _)| !is_root(file)) {
        // src/io/json/text.rs is three deep: a third `super` would leave its floor. Inside `mod
        // tests` one more is fine.
        let in_floors =
            CRATES_OF_FLOORS.iter().any(|name| file.starts_with(&format!("src/{name}/")));
        let depth = file.split('/').count() - 1 - usize::from(in_floors);
        assert!(!code.contains(&"super::".repeat(depth + 1)), "{file} climbs to the root by super");
        let own = code.split("#[cfg(test)]").next().unwrap_or("");
        assert!(!own.contains(&"super::".repeat(depth)), "{file} climbs to the root by super");
    }
}

#[test]
fn the_lower_floors_touch_neither_files_nor_clocks_nor_threads() {
    for (file, code) in sources().into_iter().filter(|(file, _)| !is_root(file)) {
        if floor(module_of(&file)).is_none_or(|floor| floor > 4) {
            continue;
        }
        for word in named_beneath(&code, "std::") {
            // An error may wrap what the operating system said.
            let is_wrapped = file == "src/engine/error.rs" && word == "io";
            assert!(is_wrapped || !OUTSIDE_WORLD.contains(&word), "{file} names std::{word}");
        }
    }
}

/// What names the standard library where a browser has something else: `io::platform` itself, the
/// disk, what one system alone knows, and the command line.
const ON_DESKTOPS: [&str; 10] = [
    "src/io/platform",
    "src/engine",
    "src/io/fs/",
    "src/io/machine/",
    "src/program/cli",
    "src/web",
    "src/window/clipboard/x11.rs",
    "src/window/event_loop.rs",
    "src/window/files/system.rs",
    "src/window/running.rs",
];

#[test]
fn what_a_browser_does_in_its_own_way_is_asked_of_the_platform() {
    for (file, code) in sources() {
        let is_test = file.contains("tests") || file.ends_with("memory.rs");
        if is_test || is_root(&file) || ON_DESKTOPS.iter().any(|part| file.starts_with(part)) {
            continue;
        }
        let own = code.split("#[cfg(test)]\nmod tests {").next().unwrap_or("");
        for name in named_beneath(own, "std::") {
            assert!(
                !["fs", "env", "process", "thread"].contains(&name),
                "{file} names std::{name}: ask io::platform"
            );
        }
        for name in named_beneath(own, "std::time::") {
            assert!(
                !["Instant", "SystemTime"].contains(&name),
                "{file} names std::time::{name}: ask io::platform"
            );
        }
        for method in [".exists()", ".recv_timeout(", "ThreadPoolBuilder"] {
            assert!(!own.contains(method), "{file} names {method}: ask io::platform");
        }
    }
}

#[test]
fn imports_are_found_however_they_are_written() {
    let code = "use crate::math::Size;\nuse crate::{Error, io::{Files, json}, paint};\nfn f() { crate::cli::run() }";
    assert_eq!(named_modules(code), ["math", "io", "paint", "cli"]);
    let code = "use std::{fs, io::{self, Read}};\nfn f() { std::thread::sleep(D) }";
    assert_eq!(named_beneath(code, "std::"), ["fs", "io", "thread"]);
}
