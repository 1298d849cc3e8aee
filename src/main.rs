//! The program's door: hands the arguments to [`rilievo::cli`], and the window where there is one, and returns its exit code.

use rilievo::cli::{self, OpenWindow};
use std::process::ExitCode;

#[cfg(feature = "gui")]
const WINDOW: Option<OpenWindow> = Some(rilievo::app::run);
#[cfg(not(feature = "gui"))]
const WINDOW: Option<OpenWindow> = None;

fn main() -> ExitCode {
    cli::run(std::env::args_os(), WINDOW)
}
