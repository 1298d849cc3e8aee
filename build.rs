//! Tells the program which commit it is built from: the one that `RILIEVO_COMMIT` names, that of the
//! checked-out repository, or that of the published package. Only in release builds, since each
//! commit links the program again.

use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-env-changed=RILIEVO_COMMIT");
    if env::var("PROFILE").as_deref() != Ok("release") {
        return;
    }
    let Some(root) = env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from) else { return };
    let git = root.join(".git");
    // The second one changes with each commit.
    for file in [git.join("HEAD"), git.join("logs/HEAD")].iter().filter(|file| file.exists()) {
        println!("cargo:rerun-if-changed={}", file.display());
    }
    let named = env::var("RILIEVO_COMMIT").ok();
    let commit = named.or_else(|| checked_out_commit(&git)).or_else(|| packaged_commit(&root));
    if let Some(commit) = commit {
        println!("cargo:rustc-env=RILIEVO_COMMIT={}", commit.trim());
    }
}

/// The commit that a folder `.git` has checked out.
pub fn checked_out_commit(git: &Path) -> Option<String> {
    let text = |name: &str| fs::read_to_string(git.join(name)).ok();
    let head = text("HEAD")?;
    let Some(branch) = head.trim().strip_prefix("ref: ") else { return commit_of(&head) };
    text(branch).as_deref().and_then(commit_of).or_else(|| {
        let packed = text("packed-refs")?;
        let line = packed.lines().find(|line| line.split(' ').nth(1) == Some(branch))?;
        commit_of(line.split(' ').next()?)
    })
}

/// The commit that Cargo wrote into a published package.
pub fn packaged_commit(root: &Path) -> Option<String> {
    let text = fs::read_to_string(root.join(".cargo_vcs_info.json")).ok()?;
    let (_, after) = text.split_once("\"sha1\"")?;
    after.split('"').find_map(commit_of)
}

fn commit_of(text: &str) -> Option<String> {
    let text = text.trim();
    let is_commit = text.len() >= 40 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
    is_commit.then(|| text.to_owned())
}
