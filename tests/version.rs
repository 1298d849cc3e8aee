//! The commit that a build is told of.

#[path = "../build.rs"]
#[allow(dead_code)]
mod build;

use build::{checked_out_commit, packaged_commit};
use std::fs;
use std::path::Path;

const COMMIT: &str = "1a2b3c4d5e6f708192a3b4c5d6e7f8091a2b3c4d";
const OTHER: &str = "ffffffffffffffffffffffffffffffffffffffff";

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let file = folder.path().join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, text).unwrap();
    }
    folder
}

#[test]
fn the_commit_of_a_checkout_is_found_where_git_keeps_it() {
    let packed =
        format!("# pack-refs with: peeled\n{OTHER} refs/heads/old\n{COMMIT} refs/heads/main\n");
    let branch = ("HEAD", "ref: refs/heads/main\n");
    let line = format!("{COMMIT}\n");
    for files in [
        &[("HEAD", line.as_str())][..],
        &[branch, ("refs/heads/main", &line)],
        &[branch, ("packed-refs", &packed)],
        &[branch, ("refs/heads/main", &line), ("packed-refs", &packed.replace(COMMIT, OTHER))],
    ] {
        let git = folder(files);
        assert_eq!(checked_out_commit(git.path()).as_deref(), Some(COMMIT), "{files:?}");
    }
}

#[test]
fn a_checkout_that_says_no_commit_has_none() {
    for files in [
        &[][..],
        &[("HEAD", "")],
        &[("HEAD", "ref: refs/heads/main\n")],
        &[("HEAD", "ref: refs/heads/main\n"), ("refs/heads/main", "words")],
    ] {
        assert_eq!(checked_out_commit(folder(files).path()), None, "{files:?}");
    }
    assert_eq!(checked_out_commit(Path::new("nowhere")), None);
}

#[test]
fn a_published_package_says_its_commit() {
    let info = format!(
        "{{\n  \"git\": {{\n    \"sha1\": \"{COMMIT}\"\n  }},\n  \"path_in_vcs\": \"\"\n}}"
    );
    let package = folder(&[(".cargo_vcs_info.json", &info)]);
    assert_eq!(packaged_commit(package.path()).as_deref(), Some(COMMIT));
    assert_eq!(packaged_commit(Path::new("nowhere")), None);
}
