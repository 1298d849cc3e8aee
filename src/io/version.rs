//! Which build of the program this is. Floor 5.

use std::sync::LazyLock;

/// The version, and the commit that it was built from if the environment variable `RILIEVO_COMMIT`
/// named it while it was built, as in “0.2.0 (1a2b3c4d5)”.
pub fn version() -> &'static str {
    static VERSION: LazyLock<String> =
        LazyLock::new(|| with_commit(env!("CARGO_PKG_VERSION"), option_env!("RILIEVO_COMMIT")));
    &VERSION
}

fn with_commit(version: &str, commit: Option<&str>) -> String {
    match commit.map(str::trim).filter(|commit| !commit.is_empty()) {
        Some(commit) => format!("{version} ({commit})"),
        None => version.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_build_without_a_commit_has_its_version_alone() {
        assert_eq!(with_commit("0.2.0", None), "0.2.0");
        assert_eq!(with_commit("0.2.0", Some("")), "0.2.0");
        assert_eq!(with_commit("0.2.0", Some("1a2b3c4d5\n")), "0.2.0 (1a2b3c4d5)");
    }
}
