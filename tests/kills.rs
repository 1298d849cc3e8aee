//! The real program, killed while it saves: the file is the old one or the new one, and opens.
#![cfg(target_os = "linux")]

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

const PROGRAM: &str = env!("CARGO_BIN_EXE_rilievo");
/// What saving asks of the system.
const CALLS: &str =
    "openat,read,write,pwrite64,statx,fsync,close,rename,renameat2,link,linkat,unlink,unlinkat,fchmodat,chmod";

fn convert(folder: &Path, from: &str, to: &str) {
    let done = Command::new(PROGRAM).args(["convert", from, to]).current_dir(folder).output().unwrap();
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
    let info = Command::new(PROGRAM).args(["info", "--json", target]).current_dir(folder).output().unwrap();
    let json: serde_json::Value = serde_json::from_slice(&info.stdout).unwrap();
    assert_eq!(json["documents"][0]["whole"], true, "{what}");
}
/// Runs a conversion of the new recipe that is killed at the `n`th call of each kind; whether it lived.
fn killed_at(folder: &Path, target: &str, n: usize) -> Option<bool> {
    let inject = format!("inject={CALLS}:signal=KILL:when={n}");
    let run = Command::new("strace")
        .args(["-f", "-o", "/dev/null", "-e", &format!("trace={CALLS}"), "-e", &inject, PROGRAM])
        .args(["convert", "new.json", target, "--threads", "1"])
        .current_dir(folder)
        .stderr(Stdio::piped())
        .output()
        .ok()?;
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    let is_refused = said.contains("ptrace") || said.contains("PTRACE");
    (!is_refused).then_some(run.status.success())
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
    // A new file; over an old one; over one with an older version kept; through a link.
    for scenario in 0..4 {
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
            let Some(lived) = killed_at(folder.path(), target, n) else {
                return eprintln!("skipped: strace is not installed, or may not trace here");
            };
            let before = if scenario == 0 { "" } else { "old.ora" };
            let may_be: &[&str] = if lived { &["new.ora"] } else { &[before, "new.ora"] };
            check(folder.path(), "t.ora", may_be, &format!("scenario {scenario}, killed at call {n}"));
            if lived {
                break;
            }
            n += 1;
        }
        assert!(n > 10, "scenario {scenario}: only {n} calls");
    }
}
#[test]
fn killed_at_any_time_it_leaves_the_old_file_or_the_new_one() {
    let folder = folder();
    let rounds = std::env::var("RILIEVO_KILLS").ok().and_then(|n| n.parse().ok()).unwrap_or(60);
    for round in 0..rounds {
        std::fs::copy(folder.path().join("old.ora"), folder.path().join("t.ora")).unwrap();
        let mut child = Command::new(PROGRAM)
            .args(["convert", "new.json", "t.ora"])
            .current_dir(folder.path())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_micros(u64::from(rilievo::math::hash::mix(round)) % 60_000));
        child.kill().unwrap();
        child.wait().unwrap();
        check(folder.path(), "t.ora", &["old.ora", "new.ora"], &format!("round {round}"));
    }
}
