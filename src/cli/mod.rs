//! Floor 7: the command line. Each subcommand is one file; this one parses, dispatches and turns errors into exit codes.
//!
//! Exit code 0; 1 with one sentence on standard error, `rilievo: FILE: field: reason`; 2 for a misuse of the command line.

mod crash;
mod info;
pub mod limits;
mod progress;
mod render;
mod view;

pub use limits::Limits;

use crate::{Error, Result};
use clap::{CommandFactory, Parser, Subcommand};
use std::io::{ErrorKind, Write};
use std::{ffi::OsString, process::ExitCode};

/// Paint over normal and depth maps: brushes, gradients and photos that bend over the shape they are put on.
#[derive(Parser)]
#[command(name = "rilievo", version, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    Info(info::InfoArgs),
    Render(render::RenderArgs),
    View(view::ViewArgs),
}

/// Runs the program on its arguments. Exit code 0; 1 with a sentence on standard error; 2 for a misuse.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let parsed = match Arguments::try_parse_from(arguments) {
        Ok(parsed) => parsed,
        Err(refusal) => {
            // A closed pipe is no reason to complain about a help page.
            let _ = refusal.print();
            return ExitCode::from(u8::try_from(refusal.exit_code()).unwrap_or(2));
        }
    };
    let done = crash::caught(|| match parsed.command {
        Some(Command::Info(args)) => info::run(&args),
        Some(Command::Render(args)) => render::run(&args),
        Some(Command::View(args)) => view::run(&args),
        None => print(&Arguments::command().render_help().to_string()),
    });
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(sentence) => {
            let _ = writeln!(std::io::stderr(), "rilievo: {}", printable(&sentence));
            ExitCode::FAILURE
        }
    }
}

/// Writes to standard output. Whoever closed it has read enough: that is no failure.
pub fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::io("standard output", e)),
        _ => Ok(()),
    }
}

/// One line without control characters: a file's name must not steer the terminal.
fn printable(sentence: &str) -> String {
    sentence.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }
    #[test]
    fn control_characters_are_not_printed() {
        assert_eq!(printable("a\u{1b}[31m\nb"), "a\u{fffd}[31m\u{fffd}b");
    }
}
