//! The program's door: hands the arguments to [`rilievo::cli`] and returns its exit code.

use std::process::ExitCode;

fn main() -> ExitCode {
    rilievo::cli::run(std::env::args_os())
}
