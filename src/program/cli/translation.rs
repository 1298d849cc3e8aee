//! The help of the command line in the user's language. Floor 7. Not here: the names of commands,
//! options and values, which scripts use, and man pages (`manual`), which stay English.

use crate::language::{Language, find_translation, language, tr};
use crate::tr;
use clap::builder::{PossibleValue, StyledStr};
use clap::{Arg, Command};

/// The same command with its help in the current language.
pub fn translate_help(mut command: Command) -> Command {
    if language() == Language::English {
        return command;
    }
    // With the options and the command that clap adds.
    command.build();
    translate_command(command)
}

fn translate_command(mut command: Command) -> Command {
    if let Some(text) = command.get_about().and_then(translate_text) {
        command = command.about(text);
    }
    if let Some(text) = command.get_long_about().and_then(translate_text) {
        command = command.long_about(text);
    }
    if let Some(text) = command.get_after_help().and_then(translate_text) {
        command = command.after_help(text);
    }
    if let Some(text) = command.get_after_long_help().and_then(translate_text) {
        command = command.after_long_help(text);
    }
    let usage = tr("Usage:");
    command = say_usage(command);
    command
        .help_template(format!(
            "{{about-with-newline}}\n{usage} {{usage}}\n\n{{all-args}}{{after-help}}"
        ))
        .subcommand_help_heading(tr("Commands"))
        .mut_args(translate_option)
        .mut_subcommands(translate_command)
}

/// What stands for all options and commands in the line of a command's usage.
fn say_usage(mut command: Command) -> Command {
    let usage = command.render_usage().to_string();
    let usage = usage.trim_start_matches("Usage:").trim();
    let translated =
        usage.replace("[OPTIONS]", tr("[OPTIONS]")).replace("[COMMAND]", tr("[COMMAND]"));
    if translated == usage { command } else { command.override_usage(translated) }
}

fn translate_option(mut option: Arg) -> Arg {
    if let Some(text) = option.get_help().and_then(translate_text) {
        option = option.help(text);
    }
    if let Some(text) = option.get_long_help().and_then(translate_text) {
        option = option.long_help(text);
    }
    let option = say_values(option);
    let heading = match option.get_help_heading() {
        Some(heading) => find_translation(heading),
        None if option.is_positional() => Some(tr("Arguments")),
        None => Some(tr("Options")),
    };
    match heading {
        Some(heading) => option.help_heading(heading),
        None => option,
    }
}

/// The value that an option has without being given, and those that it can have, as `clap` says them.
fn say_values(option: Arg) -> Arg {
    let join = |values: Vec<&str>| values.join(", ");
    let default: Vec<&str> = match option.is_hide_default_value_set() {
        true => Vec::new(),
        false => option.get_default_values().iter().filter_map(|value| value.to_str()).collect(),
    };
    let choices = option.get_possible_values();
    let choices: Vec<&str> = match option.is_hide_possible_values_set() {
        true => Vec::new(),
        false => choices.iter().filter(|v| !v.is_hide_set()).map(PossibleValue::get_name).collect(),
    };
    let takes_value = option.get_action().takes_values();
    let mut said: Vec<String> = Vec::new();
    if takes_value && !default.is_empty() {
        said.push(tr!("[default: {value}]", value = join(default)));
    }
    if takes_value && !choices.is_empty() {
        said.push(tr!("[possible values: {values}]", values = join(choices)));
    }
    if said.is_empty() {
        return option;
    }
    let with = |help: &StyledStr| format!("{help} {}", said.join(" "));
    let (short, long) = (option.get_help().map(with), option.get_long_help().map(with));
    let option = option
        .hide_default_value(true)
        .hide_possible_values(true)
        .help(short.unwrap_or_else(|| said.join(" ")));
    match long {
        Some(long) => option.long_help(long),
        None => option,
    }
}

fn translate_text(text: &StyledStr) -> Option<&'static str> {
    find_translation(&text.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::set_language;

    #[test]
    fn help_has_the_same_commands_and_options_in_every_language() {
        let options = |text: &str| -> Vec<String> {
            let is_option = |word: &&str| word.starts_with("--") && word.len() > 2;
            let words =
                text.split(|c: char| c.is_whitespace() || ",.;:()[]<>'“”。、，：".contains(c));
            let mut found: Vec<String> = words.filter(is_option).map(str::to_owned).collect();
            found.sort();
            found.dedup();
            found
        };
        let render = |language: Language| {
            set_language(language);
            let mut command = translate_help(crate::cli::command());
            command.build();
            let inner = command.find_subcommand_mut("render").unwrap();
            let help = inner.render_help().to_string();
            set_language(Language::English);
            help
        };
        let english = render(Language::English);
        for (language, name) in Language::ALL {
            let help = render(language);
            assert_eq!(options(&help), options(&english), "{name}: {help}");
            set_language(language);
            let usage = tr("Usage:");
            set_language(Language::English);
            assert!(help.contains(usage), "{name}: {help}");
        }
    }

    #[test]
    fn a_translated_command_reads_the_same_arguments() {
        set_language(Language::German);
        let mut command = translate_help(crate::cli::command());
        command.clone().debug_assert();
        let words = ["rilievo", "render", "a.json", "-o", "a.png"];
        let matches = command.try_get_matches_from_mut(words).unwrap();
        let asked = command.try_get_matches_from_mut(["rilievo", "help", "render"]).unwrap_err();
        set_language(Language::English);
        assert_eq!(matches.subcommand_name(), Some("render"));
        assert_eq!(asked.kind(), clap::error::ErrorKind::DisplayHelp);
    }
}
