//! Floor 7: the command line. Each subcommand is one file; this one parses, dispatches and turns
//! errors into exit codes.
//!
//! Exit code 0; 1 with one sentence on standard error, `rilievo: FILE: field: reason`; 2 for wrong
//! usage of the command line.

mod brush;
mod convert;
mod crash;
mod force;
mod info;
pub mod limits;
mod lines;
mod manual;
mod messages;
mod object;
mod open;
mod painted;
mod progress;
mod refusals;
mod render;
mod replay;
mod shape;
mod thumbnail;
mod translation;
mod values;
mod view;

pub use limits::LimitArgs;

use crate::language;
use crate::{Error, Remedy, Result};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::{ffi::OsString, process::ExitCode};

/// Opens the window on some files and returns when it is closed, or once a running one has taken the
/// files; true: opens a new one even if one is running. It is passed in because the window is on the
/// same floor.
pub type OpenWindow = fn(Vec<PathBuf>, bool) -> Result<()>;

/// Paint over normal and depth maps: brushes, gradients and photos that bend over the shape they
/// are put on.
#[derive(Parser)]
#[command(name = "rilievo", version = crate::io::version(), max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Option<CliCommand>,
}

#[derive(Subcommand)]
enum CliCommand {
    Brush(brush::BrushArgs),
    Convert(convert::ConvertArgs),
    Info(info::InfoArgs),
    Lines(lines::LinesArgs),
    Manual(manual::ManualArgs),
    Open(open::OpenArgs),
    Render(render::RenderArgs),
    Replay(replay::ReplayArgs),
    Shape(shape::ShapeArgs),
    Thumbnail(thumbnail::ThumbnailArgs),
    View(view::ViewArgs),
}

/// The grammar of the command line, for those who check or describe it.
pub fn command() -> clap::Command {
    Arguments::command()
}

/// Runs the program on its arguments. Exit code 0; 1 with a sentence on standard error; 2 for wrong
/// usage.
///
/// `window` opens the window on these files, if the build has one.
pub fn run(arguments: impl IntoIterator<Item = OsString>, window: Option<OpenWindow>) -> ExitCode {
    language::set_language(language::system_language());
    let parsed = match parse(with_command(arguments.into_iter().collect(), window.is_some())) {
        Ok(parsed) => parsed,
        Err(refusal) => {
            // A closed pipe while printing help is no failure.
            let _ = refusals::print(&refusal);
            return ExitCode::from(u8::try_from(refusal.exit_code()).unwrap_or(2));
        }
    };
    crate::memory::ask_for_free_bytes(crate::io::machine::free_bytes);
    crate::memory::DABS.set_limit(crate::io::machine::kept_bytes());
    // A document that is read once is made once.
    let is_edited = matches!(parsed.command, Some(CliCommand::Open(_) | CliCommand::Replay(_)));
    crate::memory::FORMS.set_limit(if is_edited {
        crate::io::machine::whole_bytes() / 8
    } else {
        0
    });
    let done = crash::catch_panic(|| force::naming_the_flag(dispatch(parsed.command, window)));
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(sentence) => {
            messages::print_line(&format!("rilievo: {sentence}"));
            ExitCode::FAILURE
        }
    }
}

/// The arguments, with help in the user's language.
fn parse(arguments: Vec<OsString>) -> std::result::Result<Arguments, clap::Error> {
    let mut command = translation::translate_help(command());
    let matches = command.try_get_matches_from_mut(arguments)?;
    Arguments::from_arg_matches(&matches).map_err(|refusal| refusal.format(&mut command))
}

fn dispatch(command: Option<CliCommand>, window: Option<OpenWindow>) -> Result<()> {
    match command {
        Some(CliCommand::Brush(args)) => brush::run(&args),
        Some(CliCommand::Convert(args)) => convert::run(&args),
        Some(CliCommand::Info(args)) => info::run(&args),
        Some(CliCommand::Lines(args)) => lines::run(&args),
        Some(CliCommand::Manual(args)) => manual::run(&args),
        Some(CliCommand::Open(args)) => open::run(args, window),
        Some(CliCommand::Render(args)) => render::run(&args),
        Some(CliCommand::Replay(args)) => replay::run(&args),
        Some(CliCommand::Shape(args)) => shape::run(&args),
        Some(CliCommand::Thumbnail(args)) => thumbnail::run(&args),
        Some(CliCommand::View(args)) => view::run(&args),
        None => {
            let mut help = translation::translate_help(Arguments::command());
            print(&help.render_help().to_string())
        }
    }
}

/// Files alone, or no arguments at all, open the window: `open` may be left out. A name with an
/// ending or in a folder is meant as a file, even if there is none.
fn with_command(mut arguments: Vec<OsString>, has_window: bool) -> Vec<OsString> {
    let is_file = |word: &OsString| {
        let is_command =
            Arguments::command().get_subcommands().any(|command| *word == *command.get_name());
        let path = Path::new(word);
        let is_option = word.as_encoded_bytes().starts_with(b"-");
        let is_path = path.extension().is_some() || path.components().nth(1).is_some();
        !is_command && (path.is_file() || (is_path && !is_option))
    };
    if has_window && arguments.get(1).is_none_or(is_file) {
        arguments.insert(1.min(arguments.len()), "open".into());
    }
    arguments
}

/// Writes to standard output. A reader that closed it has read enough: this is no failure.
pub fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::io("standard output", e)),
        _ => Ok(()),
    }
}

/// The sentence of an error, with the option that would help.
pub fn with_advice(error: &Error) -> String {
    match error.remedy() {
        Some(Remedy::LongerSides) => format!("{error} (raise the limit with --max-side)"),
        Some(Remedy::MorePixels) => format!("{error} (raise the limit with --max-pixels)"),
        Some(Remedy::MoreMemory) => {
            format!("{error} (close other programs, or raise the limit with --max-memory)")
        }
        Some(Remedy::Background) => format!("{error} (choose a background with --background)"),
        None => error.to_string(),
    }
}

/// Writes lines to standard output, without terminal control sequences.
pub fn print_lines(text: &str) -> Result<()> {
    print(&text.split('\n').map(printable).collect::<Vec<_>>().join("\n"))
}

/// One line without control characters and without those that reverse the direction of text: the
/// name of a file or a layer must not control the terminal.
fn printable(sentence: &str) -> String {
    let steers = |c: char| {
        c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    sentence.chars().map(|c| if steers(c) { '\u{fffd}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn files_alone_open_the_window_and_commands_stay_commands() {
        let said = |words: &[&str]| -> Vec<OsString> {
            with_command(words.iter().map(Into::into).collect(), true)
        };
        assert_eq!(said(&["rilievo"]), ["rilievo", "open"]);
        assert_eq!(said(&["rilievo", "Cargo.toml"]), ["rilievo", "open", "Cargo.toml"]);
        assert_eq!(said(&["rilievo", "render", "Cargo.toml"]), ["rilievo", "render", "Cargo.toml"]);
        assert_eq!(said(&["rilievo", "missing.ora"]), ["rilievo", "open", "missing.ora"]);
        assert_eq!(said(&["rilievo", "art/missing"]), ["rilievo", "open", "art/missing"]);
        assert_eq!(said(&["rilievo", "--help"]), ["rilievo", "--help"]);
        assert_eq!(said(&["rilievo", "--max.side"]), ["rilievo", "--max.side"]);
        assert_eq!(said(&["rilievo", "no such file"]), ["rilievo", "no such file"]);
    }

    #[test]
    fn control_characters_are_not_printed() {
        assert_eq!(printable("a\u{1b}[31m\nb"), "a\u{fffd}[31m\u{fffd}b");
        assert_eq!(printable("gnp.\u{202e}exe \u{9b}1m"), "gnp.\u{fffd}exe \u{fffd}1m");
    }
}
