//! Which build of the program this is. Floor 5.

use std::sync::OnceLock;

static VERSION: OnceLock<String> = OnceLock::new();

/// The version, and the commit that it was built from if the program knows it, as in
/// “0.2.0 (1a2b3c4d5e6f)”.
pub fn version() -> &'static str {
    VERSION.get_or_init(|| with_commit(None))
}

/// Names the commit that the program was built from, before anything asks for the version.
pub fn set_commit(commit: Option<&str>) {
    VERSION.get_or_init(|| with_commit(commit));
}

fn with_commit(commit: Option<&str>) -> String {
    /// As many digits name a commit of any repository.
    const DIGITS: usize = 12;
    let version = env!("CARGO_PKG_VERSION");
    let commit: String = commit.unwrap_or_default().trim().chars().take(DIGITS).collect();
    if commit.is_empty() { version.to_owned() } else { format!("{version} ({commit})") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_build_without_a_commit_has_its_version_alone() {
        let version = env!("CARGO_PKG_VERSION");
        assert_eq!(with_commit(None), version);
        assert_eq!(with_commit(Some(" ")), version);
        let named = with_commit(Some("1a2b3c4d5e6f708192a3b4c5d6e7f8091a2b3c4d\n"));
        assert_eq!(named, format!("{version} (1a2b3c4d5e6f)"));
    }
}
