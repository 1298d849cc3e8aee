//! Every row of `docs/EQUATIONS.md` points at a function and a test that exist.

use std::{fs, path::Path};

/// The texts between backticks of a table cell.
fn quoted(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

/// What is wrong with one row, as a sentence; `None` where both of its names are found.
fn fault(root: &Path, row: &str) -> Option<String> {
    let cells: Vec<&str> = row.trim().trim_matches('|').split('|').map(str::trim).collect();
    let [equation, function, test] = cells[..] else {
        return Some(format!("“{row}” has not three cells"));
    };
    let [file, name] = quoted(function)[..] else {
        return Some(format!("“{equation}” does not name a `file` and a `function`"));
    };
    // A test is in the function's file unless the row names another.
    let (test_file, test_name) = match quoted(test)[..] {
        [name] => (file, name),
        [file, name] => (file, name),
        _ => return Some(format!("“{equation}” does not name a test")),
    };
    let holds = |file: &str, name: &str| {
        let text = fs::read_to_string(root.join(file)).unwrap_or_default();
        text.contains(&format!("fn {name}(")) || text.contains(&format!("fn {name}<"))
    };
    if !holds(file, name) {
        return Some(format!("“{equation}”: there is no fn {name} in {file}"));
    }
    (!holds(test_file, test_name))
        .then(|| format!("“{equation}”: there is no test {test_name} in {test_file}"))
}

#[test]
fn every_equation_points_at_a_function_and_a_test() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("docs/EQUATIONS.md")).unwrap();
    let rows: Vec<&str> = text.lines().filter(|l| l.starts_with('|')).skip(2).collect();
    assert!(rows.len() >= 16, "only {} rows were found", rows.len());
    let faults: Vec<String> = rows.iter().filter_map(|row| fault(root, row)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_row_that_points_nowhere_is_found() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let row = "| eq. 0 | `src/engine/math/srgb.rs` `there_is_no_such_function` | \
               `every_byte_survives_decode_and_encode` |";
    assert!(fault(root, row).is_some_and(|f| f.contains("there_is_no_such_function")));
    let row =
        "| eq. 0 | `src/engine/math/srgb.rs` `decode` | `every_byte_survives_decode_and_encode` |";
    assert_eq!(fault(root, row), None);
}
