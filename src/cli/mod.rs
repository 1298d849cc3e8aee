//! Floor 7: the command line. Each subcommand is one file; this one parses, dispatches and turns errors into exit codes.

use std::{ffi::OsString, process::ExitCode};

/// Runs the program on its arguments. Exit code 0; 1 with a sentence on standard error; 2 for a misuse.
pub fn run(_args: impl IntoIterator<Item = OsString>) -> ExitCode {
    ExitCode::SUCCESS
}
