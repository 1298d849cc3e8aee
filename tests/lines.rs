//! No line of the sources is longer than 120 columns, and no file longer than 350 lines. rustfmt breaks code; comments,
//! macros and texts it leaves alone.

use std::fs;
use std::path::{Path, PathBuf};

const COLUMNS: usize = 120;

/// A file is read in one sitting; one that grows longer is split by its subjects.
const LINES: usize = 350;

/// Every file below a folder of the project whose name ends so.
pub fn files(folder: &str, extension: &str) -> Vec<PathBuf> {
    fn visit(folder: &Path, extension: &str, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                visit(&path, extension, found);
            } else if path.extension().is_some_and(|e| e == extension) {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    visit(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), extension, &mut found);
    found
}

/// The numbers of the lines that are too long.
fn long_lines(text: &str) -> Vec<usize> {
    let is_long = |line: &str| line.chars().count() > COLUMNS;
    text.lines().zip(1..).filter(|(line, _)| is_long(line)).map(|(_, number)| number).collect()
}

#[test]
fn no_line_of_code_or_comment_is_longer_than_120_columns() {
    let folders = ["src", "tests", "benches", "examples", "sample_normals", "fuzz/fuzz_targets", "brushes"];
    let files: Vec<PathBuf> = folders.iter().flat_map(|folder| files(folder, "rs")).collect();
    assert!(files.len() > 300, "only {} files were found", files.len());
    for path in files {
        let long = long_lines(&fs::read_to_string(&path).unwrap());
        assert!(long.is_empty(), "{}: longer than {COLUMNS} columns: lines {long:?}", path.display());
    }
}

#[test]
fn no_file_is_as_long_as_350_lines() {
    let folders = ["src", "tests", "benches", "examples", "sample_normals", "fuzz/fuzz_targets", "brushes"];
    let lines = |path: &PathBuf| fs::read_to_string(path).unwrap().lines().count();
    let files = folders.iter().flat_map(|folder| files(folder, "rs")).map(|path| (lines(&path), path));
    let long: Vec<(usize, PathBuf)> = files.filter(|(count, _)| *count >= LINES).collect();
    assert!(long.is_empty(), "split these by their subjects: {long:#?}");
}

#[test]
fn a_line_is_measured_in_characters() {
    let (whole, long) = ("é".repeat(COLUMNS), "é".repeat(COLUMNS + 1));
    assert_eq!(long_lines(&format!("{whole}\n{long}\n")), [2]);
}
