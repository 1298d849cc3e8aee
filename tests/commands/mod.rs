//! Every command that a page, a comment, a workflow or `.ci/run` gives can be run as it is written: its
//! packages, targets, features, filters, subcommands, options and samples exist. Nothing is run.

mod cargo;
mod shell;
mod tests_of;

use super::lines::files;
use cargo::Workspace;
use clap::error::ErrorKind;
use shell::{CommandLine, commands};
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Every text that gives commands, with what a Markdown reader sees of it.
fn pages() -> Vec<(PathBuf, String)> {
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).unwrap();
        (path, text)
    };
    let top = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|name| root().join(name));
    let mut pages: Vec<(PathBuf, String)> =
        top.into_iter().chain(files("docs", "md")).map(read).collect();
    let (path, script) = read(root().join(".ci/run"));
    pages.push((path, format!("```sh\n{script}\n```\n")));
    let workflows = files(".github", "yml").into_iter().map(read);
    pages.extend(workflows.map(|(path, text)| (path, commands_of_workflow(&text))));
    let folders = ["src", "tests", "benches", "examples", "sample_normals", "brushes"];
    let sources = folders
        .iter()
        .flat_map(|folder| files(folder, "rs"))
        .filter(|path| !path.starts_with(own_folder()));
    pages.extend(sources.map(read).map(|(path, text)| (path, comments(&text))));
    pages
}

/// The commands that a workflow runs, one a step.
fn commands_of_workflow(workflow: &str) -> String {
    let command = |line: &str| {
        let run = line.trim_start().trim_start_matches("- ").strip_prefix("run: ");
        format!("{}\n", run.unwrap_or_default())
    };
    format!("```sh\n{}```\n", workflow.lines().map(command).collect::<String>())
}

/// These files speak of commands that are wrong.
fn own_folder() -> PathBuf {
    root().join("tests/commands")
}

/// The documentation that a source holds.
fn comments(source: &str) -> String {
    let comment = |line: &'_ str| -> Option<String> {
        let rest =
            line.trim_start().strip_prefix("//!").or(line.trim_start().strip_prefix("///"))?;
        Some(format!("{}\n", rest.strip_prefix(' ').unwrap_or(rest)))
    };
    source.lines().map(|line| comment(line).unwrap_or_else(|| "\n".to_owned())).collect()
}

/// What is wrong with a command, as a sentence.
fn fault(workspace: &Workspace, line: &CommandLine) -> Option<String> {
    if line.words[0] == "cargo" {
        return match workspace.resolve(&line.words[1..]) {
            Ok(Some(ours)) => fault_of_ours(&ours, line.is_whole),
            Ok(None) => None,
            Err(sentence) => Some(sentence),
        };
    }
    fault_of_ours(&line.words[1..], line.is_whole)
}

/// What is wrong with the arguments of this program.
fn fault_of_ours(arguments: &[String], is_whole: bool) -> Option<String> {
    let is_sample = |word: &&String| word.starts_with("sample_normals/") && !word.contains('*');
    if let Some(lost) = arguments.iter().filter(is_sample).find(|word| !root().join(word).exists())
    {
        return Some(format!("there is no file {lost}"));
    }
    let mut words = vec!["rilievo".to_owned()];
    // Files alone open the window.
    let is_file = |word: &String| word.starts_with("FILE") || root().join(word).is_file();
    if arguments.first().is_none_or(is_file) {
        words.push("open".to_owned());
    }
    words.extend(arguments.iter().filter(|word| *word != "…").cloned());
    // A sentence may name an option without its value.
    if !is_whole && words.last().is_some_and(|word| word.starts_with("--")) {
        let with_value = words.iter().chain([&"VALUE".to_owned()]).cloned().collect::<Vec<_>>();
        return refusal(&words, is_whole).and_then(|_| refusal(&with_value, is_whole));
    }
    refusal(&words, is_whole)
}

/// What the command line answers to these words, if it is not satisfied.
fn refusal(words: &[String], is_whole: bool) -> Option<String> {
    let refused = rilievo_program::cli::command().try_get_matches_from(words).err()?;
    let lacks = matches!(
        refused.kind(),
        ErrorKind::MissingRequiredArgument | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
    );
    let is_help = matches!(refused.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion);
    (!is_help && (is_whole || !lacks))
        .then(|| refused.to_string().lines().next().unwrap_or_default().to_owned())
}

#[test]
fn every_command_that_is_given_can_be_run() {
    let workspace = Workspace::read(root());
    let (mut faults, mut count) = (Vec::new(), 0);
    for (path, text) in pages() {
        let path = path.strip_prefix(root()).unwrap().display().to_string();
        for line in commands(&text) {
            count += 1;
            if let Some(sentence) = fault(&workspace, &line) {
                faults.push(format!("{path}: {}: {sentence}", line.words.join(" ")));
            }
        }
    }
    assert!(count > 150, "only {count} commands were found");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn commands_that_cannot_be_run_are_found() {
    let workspace = Workspace::read(root());
    let faulty = [
        ("cargo run --release --no-default-features --", "needs the features"),
        ("cargo test --features window-tests --test window", "no test window"),
        ("cargo test --release --no-default-features -- --ignored long", "needs the features"),
        ("cargo bench --no-default-features", "needs the features"),
        ("cargo bench --bench nothing", "no bench nothing"),
        ("cargo bench --bench shading nothing", "no benchmark's name"),
        ("cargo test -p rilievo-paint", "no package"),
        ("cargo test -p rilievo-engine there_is_no_such_test", "no test's name"),
        ("cargo test --test program window::", "no test's name"),
        ("cargo test --test program -- --ignored goldens", "no test's name"),
        ("cargo test --features windows", "no package that is built has a feature"),
        ("cargo test --relaese", "has no option --relaese"),
        ("cargo tset", "has no command"),
        ("cargo +nightly fuzz run nothing", "no fuzz target"),
        ("cargo run -- sample_normals/nothing.json", "no file sample_normals/nothing.json"),
        ("cargo run -- rendre a.json", "rendre"),
        ("rilievo render a.json --scales 2 -o a.png", "--scales"),
        ("rilievo render a.json", "required"),
        ("rilievo view a.json --show everything -o a.png", "everything"),
    ];
    for (text, part) in faulty {
        let [line] = &commands(&format!("```sh\n{text}\n```\n"))[..] else {
            panic!("{text}: not one command")
        };
        let found = fault(&workspace, line).unwrap_or_default();
        assert!(found.contains(part), "{text}: “{found}” should say “{part}”");
    }
    let sound = [
        "`rilievo render`",
        "`rilievo FILE…`",
        "`rilievo replay --recover-in`",
        "`cargo test --features window-tests --test program window::`",
    ];
    for text in sound {
        assert_eq!(fault(&workspace, &commands(text)[0]), None, "{text}");
    }
}
