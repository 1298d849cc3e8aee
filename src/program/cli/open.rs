//! `rilievo open`: the window.
//! Floor 7. The window itself is passed in.

use super::OpenWindow;
use super::limits::MemoryLimit;
use crate::{Error, Result};
use std::path::PathBuf;

/// Open the window; the same as giving only files, or nothing
#[derive(clap::Args)]
pub struct OpenArgs {
    /// Projects, recipes, pictures, normal or depth maps
    #[arg(value_name = "FILES")]
    files: Vec<PathBuf>,
    /// Open a new window, even if one is running: files go to that one otherwise
    #[arg(long)]
    new_window: bool,
    #[command(flatten)]
    memory: MemoryLimit,
}

pub fn run(args: OpenArgs, window: Option<OpenWindow>) -> Result<()> {
    args.memory.set();
    let none = || {
        Error::unsupported_file(
            "window",
            "this build has none; “rilievo render” paints without one",
        )
    };
    let files = args.files.into_iter().map(whole).collect();
    window.ok_or_else(none)?(files, args.new_window)
}

/// An absolute name, so that a folder can give its name to what lies in it.
fn whole(file: PathBuf) -> PathBuf {
    std::path::absolute(&file).unwrap_or(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_is_given_names_from_the_root() {
        let window: OpenWindow = |files, is_new| {
            let folder = std::env::current_dir().map_err(|e| Error::io("here", e))?;
            // On Windows a name from the root is completed by the drive of the folder.
            let from_root = folder.join(PathBuf::from("/art/pot_n.png"));
            assert_eq!(files, [folder.join("normal.png"), from_root]);
            assert!(is_new);
            Ok(())
        };
        let files = ["normal.png", "/art/pot_n.png"].map(PathBuf::from).to_vec();
        let memory = MemoryLimit::default();
        run(OpenArgs { files, new_window: true, memory }, Some(window)).unwrap();
    }
}
