//! A panic ends the program with a sentence like any other failure, not with a backtrace.
//! Floor 7.

use crate::Result;
use crate::memory::OutOfMemory;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook};
use std::sync::{Mutex, PoisonError};

/// Where the first panic happened; panics of decoders are caught and do not count.
static LAST: Mutex<Option<String>> = Mutex::new(None);

/// The message of any failure, including a panic.
pub fn catch_panic(work: impl FnOnce() -> Result<()>) -> std::result::Result<(), String> {
    set_hook(Box::new(|panic| {
        let place =
            panic.location().map_or_else(String::new, |l| format!(" ({}:{})", l.file(), l.line()));
        let what = panic.payload_as_str().unwrap_or("unknown");
        *LAST.lock().unwrap_or_else(PoisonError::into_inner) = Some(format!("{what}{place}"));
    }));
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(done) => done.map_err(|error| super::with_advice(&error)),
        Err(payload) if payload.is::<OutOfMemory>() => {
            let refused = payload.downcast_ref().map_or_else(String::new, OutOfMemory::to_string);
            Err(format!("{refused}; close other programs, or make the picture smaller"))
        }
        Err(_) => {
            let what =
                LAST.lock().unwrap_or_else(PoisonError::into_inner).take().unwrap_or_default();
            Err(format!("internal error: {what}; this is a bug in Rilievo, please report it"))
        }
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
        let said = catch_panic(|| std::panic::panic_any(OutOfMemory { bytes: 4_000_000_000 }))
            .unwrap_err();
        let _ = std::panic::take_hook();
        assert!(
            said.starts_with("there is no memory for 4.0 GB more; close other programs"),
            "{said}"
        );
        let asked =
            || crate::io::Budget::default().within(1).room(std::path::Path::new("a.png"), "it", 2);
        let said = catch_panic(asked).unwrap_err();
        let _ = std::panic::take_hook();
        assert!(said.contains("--max-memory"), "{said}");
    }

    #[test]
    fn a_panic_becomes_a_sentence() {
        let _turn = turn();
        let said = catch_panic(|| panic!("a {} went missing", "tile")).unwrap_err();
        let _ = std::panic::take_hook();
        assert!(
            said.starts_with("internal error: a tile went missing (src/program/cli/crash.rs:"),
            "{said}"
        );
    }
}
