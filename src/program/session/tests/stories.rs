//! Stories that nobody thought of: any actions and tools in any order, drawn from the tables of the
//! program, and what holds after each of them. Not here: stories that somebody thought of (the
//! other files of `tests`).
//!
//! An action, a property, a tool or a kind of part that is new is drawn at once, or the compiler
//! leads to the table where it is missing. A story is played by its seed; one that fails is made
//! short and printed as a replay.

mod brushes;
mod dice;
mod facts;
mod gestures;
mod known;
mod names;
mod parts;
mod paths;
mod play;
mod promises;
mod shading_values;
mod shrink;
mod starts;
mod values;
mod weights;

pub use dice::{Dice, Roll};

use super::*;
use crate::session::actions::{Action, PartAction, StrokeAction};
use crate::session::script;
use play::story;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Stories of the ordinary test run.
const FEW: u64 = 200;
/// Stories of a night.
const MANY: u64 = 10_000;

/// Stories that failed in one way.
struct Fault {
    count: usize,
    /// The first of them, and what was wrong.
    seed: u64,
    what: String,
}

/// Plays so many stories; each fault by its kind.
fn play_all(first: u64, count: u64) -> BTreeMap<String, Fault> {
    let mut faults: BTreeMap<String, Fault> = BTreeMap::new();
    let folder = starts::StoryFolder::new();
    for seed in first..first + count {
        let outcome = story(seed, &folder);
        if let Some(broken) = outcome.broken {
            let fault =
                faults.entry(broken.kind).or_insert(Fault { count: 0, seed, what: broken.what });
            fault.count += 1;
        }
    }
    faults
}

/// The number that the environment gives, as for property tests.
fn number_from_environment(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

/// A story made short, as a replay next to its files: `rilievo replay --force` takes it.
fn replay_of(seed: u64) -> PathBuf {
    let folder = starts::StoryFolder::new();
    let outcome = story(seed, &folder);
    let target = std::env::temp_dir().join(format!("rilievo-story-{seed}"));
    starts::write_assets(&target);
    let Some(broken) = outcome.broken else { return target };
    let (actions, broken) = shrink::shrink(outcome.actions, broken, &folder);
    let lines: Vec<String> = actions.iter().map(|action| action.to_value().to_string()).collect();
    let there =
        |text: &str| text.replace(&*folder.path().to_string_lossy(), &target.to_string_lossy());
    let text = format!(
        "# {}: {}\n{}\n",
        broken.kind,
        broken.what.replace('\n', " "),
        there(&lines.join("\n"))
    );
    let file = target.join("story.jsonl");
    std::fs::write(&file, &text).unwrap();
    eprintln!("{}:\n{text}", file.display());
    file
}

fn assert_no_faults(first: u64, count: u64) {
    let faults = play_all(first, count);
    let mut list: Vec<(&String, &Fault)> = faults.iter().collect();
    list.sort_by_key(|(_, fault)| std::cmp::Reverse(fault.count));
    let (mut failed, mut ways) = (0, 0);
    for (kind, Fault { count, seed, what }) in &list {
        let is_known = known::is_known(kind);
        let about = if is_known { "known: " } else { "" };
        eprintln!("{about}{count} stories, the first is {seed}: {kind}\n    {what}");
        if !is_known {
            (failed, ways) = (failed + count, ways + 1);
            replay_of(*seed);
        }
    }
    assert!(ways == 0, "{failed} of {count} stories failed, in {ways} ways");
}

#[test]
fn whatever_happens_documents_are_kept_undone_and_drawn_the_same() {
    assert_no_faults(0, FEW);
}

/// `PROPTEST_CASES`: how many; `PROPTEST_RNG_SEED`: where they begin, or from a million on the number
/// of a story that was printed.
#[test]
#[ignore = "takes a night"]
fn whatever_happens_in_a_night_documents_are_kept_undone_and_drawn_the_same() {
    let first = match number_from_environment("PROPTEST_RNG_SEED").unwrap_or_default() {
        night @ 0..1_000_000 => night * 1_000_000,
        story => story,
    };
    assert_no_faults(first, number_from_environment("PROPTEST_CASES").unwrap_or(MANY));
}

/// Stories as scripts with their pictures, for a program that is tried from outside
/// (`dist/web/test.mjs`). `RILIEVO_STORIES`: the folder they are written to; `PROPTEST_CASES`: how
/// many.
#[test]
#[ignore = "writes files"]
fn stories_are_written_with_their_pictures() {
    let target = std::env::var_os("RILIEVO_STORIES").map(PathBuf::from).expect("RILIEVO_STORIES");
    starts::write_assets(&target);
    let count = number_from_environment("PROPTEST_CASES").unwrap_or(12) as usize;
    let written = (0..).filter(|seed| try_write(*seed, &target)).take(count);
    assert_eq!(written.count(), count);
}

/// Writes the story of a seed, and the picture that it ends with; not where it leaves no document,
/// or opens a file that it wrote.
fn try_write(seed: u64, target: &Path) -> bool {
    let folder = starts::StoryFolder::new();
    let played = story(seed, &folder);
    let here = format!("{}/", folder.path().display());
    let lines = played.actions.iter().map(|action| action.to_value().to_string() + "\n");
    let text = lines.collect::<String>().replace(&here, "");
    let script = target.join(format!("story-{seed}.jsonl"));
    std::fs::write(&script, text).unwrap();
    let left = script::play(&script, &Progress::default()).ok().flatten();
    let shown = left.and_then(|mut left| left.open_documents.pop());
    let is_written = shown.is_some_and(|open| {
        let (file, terms) = (script.with_extension("png"), Overwrite::Anything.into());
        let settings = ExportSettings::default();
        actions::files::export(open.document(), &file, &settings, terms, &Progress::default())
            .is_ok()
    });
    if !is_written {
        std::fs::remove_file(script).unwrap();
    }
    is_written
}

/// A word that is spelled wrongly would weigh nothing.
#[test]
fn the_tables_of_stories_name_words_of_the_program() {
    let words: [(&str, &[&str]); 9] = [
        ("Action", Action::ROOMS),
        ("LayerAction", LayerAction::WORDS),
        ("PartAction", PartAction::WORDS),
        ("FileAction", actions::FileAction::WORDS),
        ("CanvasAction", actions::CanvasAction::WORDS),
        ("EditAction", actions::EditAction::WORDS),
        ("HandAction", actions::HandAction::WORDS),
        ("SelectionAction", actions::SelectionAction::WORDS),
        ("Property", Property::WORDS),
    ];
    let is_known = |(of, word): &(&str, &str)| {
        words.iter().any(|(known, words)| known == of && words.contains(word))
    };
    let unknown: Vec<_> = weights::words().filter(|row| !is_known(row)).collect();
    assert!(unknown.is_empty(), "{unknown:?}");
    assert!(!StrokeAction::WORDS.is_empty());
}
