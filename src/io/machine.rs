//! How much memory this machine has left for the program, according to the system. Floor 5. Only the
//! files here ask the system; floors beneath are passed figures.

#[cfg(not(any(windows, target_family = "wasm")))]
mod linux;
#[cfg(target_family = "wasm")]
mod web;
#[cfg(windows)]
mod windows;

#[cfg(not(any(windows, target_family = "wasm")))]
use linux as system;
use std::sync::atomic::{AtomicU64, Ordering};
#[cfg(target_family = "wasm")]
use web as system;
#[cfg(windows)]
use windows as system;

/// What is assumed to be free if the system gives no figure.
pub const UNKNOWN_BYTES: u64 = 4 << 30;

/// Bytes that the program may take in all, if the user said so.
static CEILING: AtomicU64 = AtomicU64::new(u64::MAX);

/// The program may take so many bytes in all from now on, whatever is free.
pub fn set_limit(bytes: u64) {
    CEILING.store(bytes, Ordering::Relaxed);
}

/// Bytes that may be allocated now without evicting anything, minus an eighth that is left to other
/// programs.
pub fn free_bytes() -> u64 {
    let free = system::available_bytes().unwrap_or(UNKNOWN_BYTES);
    (free - free / 8).min(remaining_below(CEILING.load(Ordering::Relaxed)))
}

/// Bytes of memory that the program takes now; `None` where the system does not say.
pub fn resident_bytes() -> Option<u64> {
    system::resident_bytes()
}

/// What is left of a limit for the whole program; all of it where the system does not say what
/// the program takes.
fn remaining_below(limit: u64) -> u64 {
    if limit == u64::MAX {
        return limit;
    }
    limit.saturating_sub(resident_bytes().unwrap_or(0))
}

/// Bytes that may be kept for speed alone (`memory::DABS`): a small share, so that old machines
/// keep less.
pub fn kept_bytes() -> u64 {
    const MOST: u64 = 64 << 20;
    MOST.min(system::available_bytes().unwrap_or(UNKNOWN_BYTES) / 32)
}

/// Bytes that the machine has for the program at most: its memory, or the lowest limit around the
/// process.
pub fn whole_bytes() -> u64 {
    system::whole_bytes().unwrap_or(UNKNOWN_BYTES)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_program_takes_counts_below_its_own_limit() {
        assert_eq!(remaining_below(u64::MAX), u64::MAX);
        assert_eq!(remaining_below(1000), 0, "the test alone takes more");
        let most = 1 << 50;
        assert!((most / 2..=most).contains(&remaining_below(most)));
    }

    #[test]
    fn the_system_says_what_is_free_and_what_is_taken() {
        assert!(free_bytes() > 0 && kept_bytes() > 0);
        if cfg!(any(windows, target_os = "linux")) {
            let (free, whole) = (system::available_bytes(), system::whole_bytes());
            assert!(free > Some(0) && free <= whole, "{free:?} of {whole:?}");
            let taken = resident_bytes();
            assert!(taken > Some(100_000) && taken < whole, "{taken:?} of {whole:?}");
        }
    }
}
