//! rustfmt breaks code at 100 columns. Macros, texts and tables, which it leaves alone, have 120. A file holds
//! fewer than 500 lines of code; blank lines and comments are not counted, so that air and reasons cost nothing. The
//! length of functions is clippy's to check (`clippy.toml`).

use std::fs;
use std::path::{Path, PathBuf};

const COLUMNS: usize = 120;

/// A file is read in one sitting. It may be whole: one is split by its subjects, not for a number.
const LINES: usize = 500;

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
    let folders =
        ["src", "tests", "benches", "examples", "sample_normals", "fuzz/fuzz_targets", "brushes"];
    let files: Vec<PathBuf> = folders.iter().flat_map(|folder| files(folder, "rs")).collect();
    assert!(files.len() > 300, "only {} files were found", files.len());
    for path in files {
        let long = long_lines(&fs::read_to_string(&path).unwrap());
        assert!(
            long.is_empty(),
            "{}: longer than {COLUMNS} columns: lines {long:?}",
            path.display()
        );
    }
}

/// Lines that hold code: neither blank nor only a comment.
fn code_lines(text: &str) -> usize {
    let is_code = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with("//");
    text.lines().filter(is_code).count()
}

#[test]
fn no_file_has_500_lines_of_code() {
    let folders =
        ["src", "tests", "benches", "examples", "sample_normals", "fuzz/fuzz_targets", "brushes"];
    let lines = |path: &PathBuf| code_lines(&fs::read_to_string(path).unwrap());
    let files =
        folders.iter().flat_map(|folder| files(folder, "rs")).map(|path| (lines(&path), path));
    let long: Vec<(usize, PathBuf)> = files.filter(|(count, _)| *count >= LINES).collect();
    assert!(long.is_empty(), "split these by their subjects: {long:#?}");
}

#[test]
fn blank_lines_and_comments_are_not_counted_as_code() {
    assert_eq!(code_lines("//! A page.\n\nfn one() {\n    // Why.\n    two(); // so\n}\n"), 3);
}

#[test]
fn a_line_is_measured_in_characters() {
    let (whole, long) = ("é".repeat(COLUMNS), "é".repeat(COLUMNS + 1));
    assert_eq!(long_lines(&format!("{whole}\n{long}\n")), [2]);
}
