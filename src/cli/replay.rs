//! `rilievo replay`: what was done in the window, done again without it.
//! Floor 7.

use crate::Result;
use crate::io::Budget;
use crate::io::files::read_file;
use crate::session::Session;
use std::path::PathBuf;

/// Do what a replay file says, line by line: actions as the window does them, files named as the file names them
#[derive(clap::Args)]
pub struct ReplayArgs {
    /// The replay: one JSON object a line
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

pub fn run(args: &ReplayArgs) -> Result<()> {
    let text = read_file(&args.file, Budget::default().json_bytes)?;
    Session::default().replay(&args.file, &String::from_utf8_lossy(&text))
}
