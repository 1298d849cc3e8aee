//! The names of what comes with the program: brushes, painted balls, looks and materials.

use super::collect::{Shown, Source, texts_of};
use super::tokens::tokens;
use crate::lines::files;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The fields of their files that lists show.
const FIELDS: [&str; 3] = ["name", "about", "group"];

/// The names and descriptions in the files of `brushes`, then the names of balls.
pub fn texts() -> Vec<Shown> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = files("brushes", "json");
    paths.sort();
    let mut found = Vec::new();
    for path in paths {
        let value: Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
        let texts = FIELDS.iter().filter_map(|field| value.get(field)?.as_str());
        let file = path.strip_prefix(root).unwrap().display().to_string();
        let shown = |text: &str| Shown { text: text.to_owned(), file: file.clone(), room: None };
        found.extend(texts.map(shown));
    }
    let balls = fs::read_to_string(root.join("brushes/lib.rs")).unwrap();
    found.extend(texts_of(&Source { file: "brushes/lib.rs".into(), tokens: tokens(&balls) }));
    found
}
