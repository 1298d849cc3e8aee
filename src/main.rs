//! The program's entry point: passes the arguments to the command line, with the window if there is
//! one, and returns its exit code.

use rilievo_program::cli::{self, OpenWindow};
use std::process::ExitCode;

#[cfg(feature = "gui")]
const WINDOW: Option<OpenWindow> = Some(rilievo_window::run);
#[cfg(not(feature = "gui"))]
const WINDOW: Option<OpenWindow> = None;

fn main() -> ExitCode {
    cli::run(std::env::args_os(), WINDOW)
}
