//! The real program, killed while it saves: the file is the old one or the new one, and opens.
//! Killed while it paints: no finished stroke is lost.

use super::program::{in_english, program};
use rilievo::files::recipe;
use rilievo::{Budget, Document, Progress, flatten};
use rilievo_engine::math::hash::mix;
use rilievo_io::fs::{Disk, Fs};
use rilievo_io::recovery;
use rilievo_program::session::{Session, is_same};
use std::fmt::Write;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};

const PROGRAM: &str = env!("CARGO_BIN_EXE_rilievo");
/// The system calls of saving.
const CALLS: &str = "openat,read,write,pwrite64,statx,fsync,close,rename,renameat2,\
                     link,linkat,unlink,unlinkat,fchmodat,chmod";

fn convert(folder: &Path, from: &str, to: &str) {
    let done =
        program().args(["convert", from, to, "--force"]).current_dir(folder).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

/// Two recipes, and what each becomes.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, color) in [("old", "#102030"), ("new", "#fedcba")] {
        let text = format!(
            r##"{{ "canvas": {{ "width": 200, "height": 150 }}, "layers": [
                {{ "name": "{name}", "kind": "fill", "color": "{color}" }},
                {{ "name": "ramp", "kind": "gradient", "blend": "screen" }} ] }}"##
        );
        std::fs::write(folder.path().join(format!("{name}.json")), text).unwrap();
        convert(folder.path(), &format!("{name}.json"), &format!("{name}.ora"));
    }
    folder
}

/// The target is one of those it may be, and opens without a note.
fn check(folder: &Path, target: &str, may_be: &[&str], what: &str) {
    let Ok(bytes) = std::fs::read(folder.join(target)) else {
        return assert!(may_be.contains(&""), "{what}: there is no file");
    };
    let is = |name: &&&str| std::fs::read(folder.join(name)).is_ok_and(|known| known == bytes);
    assert!(may_be.iter().filter(is).count() > 0, "{what}: {} bytes that are neither", bytes.len());
    let opened = rilievo::open(&folder.join(target), &Budget::default())
        .unwrap_or_else(|e| panic!("{what}: {e}"));
    assert!(opened.is_whole && opened.notes.is_empty(), "{what}: {:?}", opened.notes);
}

/// Runs a conversion of the new recipe in which the `n`th call of each of these kinds is killed
/// (`signal=KILL`) or fails (`error=ENOSPC`); what it said and whether it succeeded. `None` if
/// tracing is impossible.
fn injected(
    folder: &Path,
    target: &str,
    calls: &str,
    what: &str,
    n: usize,
) -> Option<(String, bool)> {
    let inject = format!("inject={calls}:{what}:when={n}");
    let run = in_english(Command::new("strace"))
        .args(["-f", "-o", "/dev/null", "-e", &format!("trace={calls}"), "-e", &inject, PROGRAM])
        // One of the files is set read-only.
        .args(["convert", "new.json", target, "--threads", "1", "--force"])
        .current_dir(folder)
        .stderr(Stdio::piped())
        .output()
        .ok()?;
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    let is_refused = said.contains("ptrace") || said.contains("PTRACE");
    (!is_refused).then_some((said, run.status.success()))
}

#[test]
fn killed_at_every_system_call_it_leaves_the_old_file_or_the_new_one() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let clean = || {
        for entry in std::fs::read_dir(folder.path()).unwrap().flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            if name.starts_with(".rilievo-") || name.starts_with("t.ora") || name == "link.ora" {
                std::fs::remove_file(entry.path()).unwrap();
            }
        }
    };
    // A new file; over an old one; over one with an older version kept; through a link; next to the
    // remains of a killed save; where the old file is read-only.
    for scenario in 0..6 {
        let mut n = 1;
        loop {
            clean();
            let mut target = "t.ora";
            if scenario > 0 {
                std::fs::copy(at("old.ora"), at("t.ora")).unwrap();
            }
            if scenario == 2 {
                std::fs::write(at("t.ora~"), "older").unwrap();
            }
            if scenario == 3 {
                std::os::unix::fs::symlink("t.ora", at("link.ora")).unwrap();
                target = "link.ora";
            }
            if scenario == 5 {
                let mut permissions = std::fs::metadata(at("t.ora")).unwrap().permissions();
                permissions.set_readonly(true);
                std::fs::set_permissions(at("t.ora"), permissions).unwrap();
            }
            if scenario == 4 {
                std::fs::write(at(".rilievo-1-1.part"), "left").unwrap();
                std::fs::write(at(".rilievo-1-1.old"), "left").unwrap();
            }
            let Some((_, lived)) = injected(folder.path(), target, CALLS, "signal=KILL", n) else {
                return eprintln!("skipped: strace is not installed, or may not trace here");
            };
            let before = if scenario == 0 { "" } else { "old.ora" };
            let may_be: &[&str] = if lived { &["new.ora"] } else { &[before, "new.ora"] };
            check(
                folder.path(),
                "t.ora",
                may_be,
                &format!("scenario {scenario}, killed at call {n}"),
            );
            if lived {
                break;
            }
            n += 1;
        }
        assert!(n > 8, "scenario {scenario}: only {n} calls");
    }
}

#[test]
fn a_full_or_failing_disk_costs_a_sentence_and_not_the_old_file() {
    let folder = folder();
    let target = folder.path().join("t.ora");
    let mut failed = 0;
    for calls in ["write", "fsync", "rename,renameat2", "link,linkat"] {
        for error in ["error=ENOSPC", "error=EIO"] {
            for n in 1..8 {
                std::fs::copy(folder.path().join("old.ora"), &target).unwrap();
                let Some((said, well)) = injected(folder.path(), "t.ora", calls, error, n) else {
                    return eprintln!("skipped: strace is not installed, or may not trace here");
                };
                let what = format!("{calls}, {error}, the {n}th: {said}");
                // The folder is flushed after the new file is in its place.
                let may_be: &[&str] = if well { &["new.ora"] } else { &["old.ora", "new.ora"] };
                check(folder.path(), "t.ora", may_be, &what);
                assert!(well || calls == "write" || said.contains("t.ora"), "{what}");
                failed += u32::from(!well);
            }
        }
    }
    assert!(failed >= 8, "only {failed} failed");
}

fn kill_while_saving(rounds: u32) {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let begun = Instant::now();
    convert(folder.path(), "new.json", "t.ora");
    // Kills are spread evenly over a span that grows where one came before the renaming and shrinks
    // where one came after: so about as many come before as after, however long a save takes here
    // at the time.
    let mut span_secs = begun.elapsed().as_secs_f64() * 1.5;
    let mut new = 0;
    for round in 0..rounds {
        std::fs::copy(at("old.ora"), at("t.ora")).unwrap();
        let mut child = program()
            .args(["convert", "new.json", "t.ora", "--force"])
            .current_dir(folder.path())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_secs_f64(
            f64::from(mix(round)) / f64::from(u32::MAX) * span_secs,
        ));
        child.kill().unwrap();
        child.wait().unwrap();
        check(folder.path(), "t.ora", &["old.ora", "new.ora"], &format!("round {round}"));
        let is_new = std::fs::read(at("t.ora")).unwrap() == std::fs::read(at("new.ora")).unwrap();
        span_secs *= if is_new { 0.95 } else { 1.0 / 0.95 };
        new += u32::from(is_new);
    }
    eprintln!("{rounds} kills: {} times the old file, {new} times the new one", rounds - new);
    assert!(
        (rounds / 20..rounds - rounds / 20).contains(&new),
        "the kills came too early or too late: {new} of {rounds}"
    );
    // The next save removes what the last one left.
    convert(folder.path(), "new.json", "t.ora");
    let parts = std::fs::read_dir(folder.path()).unwrap().flatten();
    assert_eq!(
        parts.filter(|entry| entry.file_name().to_string_lossy().starts_with(".rilievo-")).count(),
        0
    );
}

#[test]
fn killed_at_any_time_it_leaves_the_old_file_or_the_new_one() {
    kill_while_saving(200);
}

/// *Long*: see docs/PROJECTS.md.
#[test]
#[ignore = "half an hour; run by name"]
fn long_ten_thousand_kills_while_it_saves() {
    kill_while_saving(10_000);
}

const STROKES: u32 = 70;

/// Strokes on a stroke layer and on a paint layer by turns, now and then one of them undone.
fn story() -> String {
    let mut story = String::from(
        r##"{"in":"file","do":"new","width":180,"height":140,"background":"#ffffff"}"##,
    );
    for kind in ["strokes", "paint"] {
        story.push_str(&format!("\n{{\"in\":\"layer\",\"do\":\"add\",\"kind\":\"{kind}\"}}"));
    }
    for i in 0..STROKES {
        let [x, y, z] = [1, 2, 3].map(|k| mix(i * 3 + k) % 140);
        write!(
            story,
            r#"
{{"in":"layer","do":"select","layer":"{}"}}
{{"in":"pointer","do":"press","tool":"brush","pen":[{x},{y}],"px_per_pt":1}}
{{"in":"pointer","do":"drag","pens":[[{y},{z}],[{z},{x}]]}}
{{"in":"pointer","do":"release"}}"#,
            1 + i % 2
        )
        .unwrap();
        if i % 7 == 6 {
            story.push_str("\n{\"in\":\"edit\",\"do\":\"undo\"}");
        }
    }
    story
}

/// A blot with a shape and a lit base above it: by turns it is painted on, which changes its
/// outline, and bent, and now and then that is undone.
fn shaped_story() -> String {
    let size = r#"{"in":"hand","do":"size","to":24}"#;
    let mut story = format!("{}\n{size}", crate::shape::SHAPED_BLOT);
    for i in 0..STROKES / 2 {
        let [x, y, z] = [1, 2, 3].map(|k| 20 + mix(i * 3 + k) % 110);
        let tool = if i % 3 == 1 { "liquify" } else { "brush" };
        write!(
            story,
            r#"
{{"in":"layer","do":"select","layer":"1"}}
{{"in":"pointer","do":"press","tool":"{tool}","pen":[{x},{y}],"px_per_pt":1}}
{{"in":"pointer","do":"drag","pens":[[{y},{z}]]}}
{{"in":"pointer","do":"release"}}"#
        )
        .unwrap();
        if i % 3 == 1 {
            story.push_str("\n{\"in\":\"edit\",\"do\":\"undo\"}");
        }
    }
    story
}

/// A document's parameters and its picture.
fn fingerprint(document: &Document) -> (String, u32) {
    let picture =
        flatten(document, &Progress::default()).unwrap().to_straight_rgba(document.size.rect());
    (recipe::write(document).to_string(), crc32fast::hash(&picture))
}

/// The drawing after each step of the story, the first being the empty canvas.
fn steps(story: &str) -> Vec<(String, u32)> {
    let (mut steps, mut last): (Vec<_>, Option<Document>) = (Vec::new(), None);
    let tell = |session: &mut Session| {
        let now = session.active().unwrap().document().clone();
        if !last.as_ref().is_some_and(|last| is_same(last, &now)) {
            steps.push(fingerprint(&now));
        }
        last = Some(now);
        Ok(())
    };
    Session::default().replay_with_progress(Path::new("story"), story, tell).unwrap();
    steps
}

/// Paints in a process of its own until it is killed. Every step that it reported is recovered
/// unchanged.
fn kill_while_painting(rounds: u32, story: &str) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("story"), story).unwrap();
    let steps = steps(story);
    let disk: Arc<dyn Fs> = Arc::new(Disk);
    for round in 0..rounds {
        let logs = folder.path().join(format!("logs-{round}"));
        let mut child = program()
            .arg("replay")
            .arg(folder.path().join("story"))
            .arg("--recover-in")
            .arg(&logs)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let wanted = 1 + mix(round) as usize % (steps.len() - 12);
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let mut next = || lines.next().and_then(Result::ok);
        let number = |line: String| line.split(' ').next().unwrap().parse::<usize>().unwrap();
        let mut told = (0..wanted).map_while(|_| next()).last().map_or(0, number);
        std::thread::sleep(Duration::from_micros(u64::from(mix(round + 7)) % 3_000));
        child.kill().unwrap();
        child.wait().unwrap();
        // What it reported before it died counts too.
        told = std::iter::from_fn(next).last().map_or(told, number);
        let mut left = recovery::sessions(&disk, &logs);
        let recovered = left[0].recover(&Budget::default(), &Progress::default());
        let recovered = recovered.unwrap_or_else(|e| panic!("round {round}: {e}")).unwrap();
        let found = fingerprint(&recovered.version.document);
        assert!(
            (told..steps.len().min(told + 3)).any(|n| steps[n] == found),
            "round {round}: {told} steps were finished; what came back is step {:?}",
            steps.iter().position(|step| *step == found)
        );
        std::fs::remove_dir_all(&logs).unwrap();
    }
}

#[test]
fn killed_while_painting_it_loses_no_finished_stroke() {
    kill_while_painting(20, &story());
}

#[test]
fn killed_while_a_shape_is_painted_it_brings_back_the_shape() {
    kill_while_painting(8, &shaped_story());
}

/// *Long*: see docs/PROJECTS.md.
#[test]
#[ignore = "ten minutes; run by name"]
fn long_a_thousand_kills_while_it_paints() {
    kill_while_painting(1_000, &story());
    kill_while_painting(200, &shaped_story());
}
