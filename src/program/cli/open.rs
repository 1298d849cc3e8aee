//! `rilievo open`: the window.
//! Floor 7. The window itself is passed in.

use super::OpenWindow;
use crate::{Error, Result};
use std::path::PathBuf;

/// Open the window; files alone, or nothing, do the same
#[derive(clap::Args)]
pub struct OpenArgs {
    /// Projects, recipes, pictures, normal or depth maps
    #[arg(value_name = "FILES")]
    files: Vec<PathBuf>,
}

pub fn run(args: OpenArgs, window: Option<OpenWindow>) -> Result<()> {
    let none = || Error::unsupported("window", "this build has none; “rilievo render” paints without one");
    window.ok_or_else(none)?(args.files)
}
