//! The program as tests start it: in English, whatever the language of the machine.

use std::process::Command;

/// The program, to be given its arguments.
pub fn program() -> Command {
    in_english(Command::new(env!("CARGO_BIN_EXE_rilievo")))
}

/// The same for a program that starts it.
pub fn in_english(mut command: Command) -> Command {
    command.env("RILIEVO_LANGUAGE", "en");
    command
}
