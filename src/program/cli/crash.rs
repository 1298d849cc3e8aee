//! A panic ends the program with a sentence like any other failure, not with a backtrace: that is in
//! a report, which the user may send. Floor 7.

use crate::Result;
use crate::io::crash_report;
use crate::memory::OutOfMemory;
use crate::session::last_actions;
use std::backtrace::Backtrace;
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind, set_hook};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// A panic: what was wrong, and where.
struct Panic {
    what: String,
    calls: Backtrace,
}

/// The last panic; those of decoders are caught and do not count.
static LAST: Mutex<Option<Panic>> = Mutex::new(None);

/// The message of any failure, including a panic, of which a report is written into the user's folder.
pub fn catch_panic(work: impl FnOnce() -> Result<()>) -> std::result::Result<(), String> {
    report_panic(crash_report::folder().as_deref(), work)
}

/// * `reports`: the folder of reports; without one none is written.
fn report_panic(
    reports: Option<&Path>,
    work: impl FnOnce() -> Result<()>,
) -> std::result::Result<(), String> {
    set_hook(Box::new(remember));
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(done) => done.map_err(|error| super::with_advice(&error)),
        Err(payload) if payload.is::<OutOfMemory>() => {
            let refused = payload.downcast_ref().map_or_else(String::new, OutOfMemory::to_string);
            Err(format!("{refused}; close other programs, or make the picture smaller"))
        }
        Err(_) => {
            let panic = LAST.lock().unwrap_or_else(PoisonError::into_inner).take();
            let what = panic.as_ref().map_or("unknown", |panic| &panic.what);
            let file = panic.as_ref().zip(reports);
            let file =
                file.and_then(|(panic, folder)| crash_report::write(folder, &panic.report()).ok());
            let send = match &file {
                Some(file) => format!("please send the report {}", file.display()),
                None => "please report it".to_owned(),
            };
            Err(format!("internal error: {what}; this is a bug in Rilievo, {send}"))
        }
    }
}

fn remember(panic: &PanicHookInfo) {
    // What finds no memory is no bug, and has none left for a list of calls.
    if panic.payload().is::<OutOfMemory>() {
        return;
    }
    let place =
        panic.location().map_or_else(String::new, |l| format!(" ({}:{})", l.file(), l.line()));
    let what = format!("{}{place}", panic.payload_as_str().unwrap_or("unknown"));
    let calls = Backtrace::force_capture();
    *LAST.lock().unwrap_or_else(PoisonError::into_inner) = Some(Panic { what, calls });
}

impl Panic {
    /// What is sent: the program, the machine, the last actions and the calls, no files and no
    /// picture.
    fn report(&self) -> String {
        let Self { what, calls } = self;
        let threads = std::thread::available_parallelism().map_or(0, usize::from);
        let actions = last_actions().join("\n  ");
        // Without symbols the calls are addresses only, and the address of a known function tells
        // where the program was loaded (dist/linux/calls).
        let here = remember as *const () as usize;
        format!(
            "Rilievo {}\n{} {}, {threads} threads\n\ninternal error: {what}\n\n\
             the last actions:\n  {actions}\n\nremember is at {here:#x}\n\nthe calls:\n{calls:#}",
            crate::io::version(),
            std::env::consts::OS,
            std::env::consts::ARCH,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// There is only one panic hook: the tests that set it take turns.
    fn turn() -> std::sync::MutexGuard<'static, ()> {
        static TURN: Mutex<()> = Mutex::new(());
        TURN.lock().unwrap_or_else(PoisonError::into_inner)
    }

    #[test]
    fn what_finds_no_memory_becomes_a_sentence_that_helps() {
        let _turn = turn();
        let home = tempfile::tempdir().unwrap();
        let refused = || std::panic::panic_any(OutOfMemory { bytes: 4_000_000_000 });
        let said = report_panic(Some(home.path()), refused).unwrap_err();
        let _ = std::panic::take_hook();
        assert!(
            said.starts_with("there is no memory for 4.0 GB more; close other programs"),
            "{said}"
        );
        let asked =
            || crate::io::Budget::default().within(1).room(std::path::Path::new("a.png"), "it", 2);
        let said = report_panic(Some(home.path()), asked).unwrap_err();
        let _ = std::panic::take_hook();
        assert!(said.contains("--max-memory"), "{said}");
        assert_eq!(crash_report::take_unread(home.path()), None, "neither is a bug");
    }

    #[test]
    fn a_panic_becomes_a_sentence_and_a_report() {
        let _turn = turn();
        let home = tempfile::tempdir().unwrap();
        let wrong = || panic!("a {} went missing", "tile");
        let said = report_panic(Some(home.path()), wrong).unwrap_err();
        // A compiler on Windows names its files by backslashes.
        let plain = said.replace('\\', "/");
        assert!(
            plain.starts_with("internal error: a tile went missing (src/program/cli/crash.rs:"),
            "{said}"
        );
        let file = crash_report::take_unread(home.path()).unwrap();
        assert!(said.ends_with(&format!("please send the report {}", file.display())), "{said}");
        let text = std::fs::read_to_string(&file).unwrap();
        let words = [crate::io::version(), "a tile went missing", "the last actions", "the calls:"];
        assert!(words.iter().all(|word| text.contains(word)), "{text}");
        assert!(text.contains("a_panic_becomes"), "the calls name functions: {text}");
        let said = report_panic(None, wrong).unwrap_err();
        let _ = std::panic::take_hook();
        assert!(said.ends_with("please report it"), "{said}");
    }
}
