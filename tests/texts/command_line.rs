//! The texts of the command line's help.

use super::collect::Shown;
use clap::Command;

/// The texts of every command and option, in the order of the help.
pub fn texts() -> Vec<Shown> {
    let mut found = Vec::new();
    let mut command = rilievo_program::cli::command();
    // With the options and the command that clap adds.
    command.build();
    collect(&command, &mut found);
    let file = || "src/program/cli".to_owned();
    found.into_iter().map(|text| Shown { text, file: file(), room: None }).collect()
}

fn collect(command: &Command, found: &mut Vec<String>) {
    let of_command = [
        command.get_about(),
        command.get_long_about(),
        command.get_before_help(),
        command.get_before_long_help(),
        command.get_after_help(),
        command.get_after_long_help(),
    ];
    found.extend(of_command.into_iter().flatten().map(ToString::to_string));
    for option in command.get_arguments() {
        found.extend(option.get_help_heading().map(str::to_owned));
        let of_option = [option.get_help(), option.get_long_help()];
        found.extend(of_option.into_iter().flatten().map(ToString::to_string));
        let values = option.get_possible_values();
        found.extend(values.iter().filter_map(|value| value.get_help()).map(ToString::to_string));
    }
    command.get_subcommands().for_each(|command| collect(command, found));
}
