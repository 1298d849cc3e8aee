//! The program's entry point: passes the arguments to the command line, with the window if there is
//! one, and returns its exit code. `build.rs` names the commit it was built from.

use rilievo_program::cli::{self, OpenWindow};
use std::process::ExitCode;

#[cfg(feature = "gui")]
const WINDOW: Option<OpenWindow> = Some(rilievo_window::run);
#[cfg(not(feature = "gui"))]
const WINDOW: Option<OpenWindow> = None;

fn main() -> ExitCode {
    rilievo_io::set_commit(option_env!("RILIEVO_COMMIT"));
    cli::run(std::env::args_os(), WINDOW)
}
