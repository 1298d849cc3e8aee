//! What the system does for the program: clock, files, threads, and the folders of the user. Floor 5.
//!
//! `native` is the standard library. A browser has no clock, files and threads of that kind: `web`
//! takes the page's clock, a tree of files in memory that the page stores, and workers that the page
//! starts. Both offer the same names, so nothing else asks which of them it runs on, except where a
//! crate or a dialog exists only on one of them.

#[cfg(not(target_family = "wasm"))]
mod native;
#[cfg(target_family = "wasm")]
mod web;

#[cfg(not(target_family = "wasm"))]
pub use native::*;
use std::path::Path;
#[cfg(target_family = "wasm")]
pub use web::PageThread as Thread;
#[cfg(target_family = "wasm")]
pub use web::*;

/// The clock: the system's, or the page's.
pub use web_time::{Instant, SystemTime, UNIX_EPOCH};

/// Whether there is a file.
pub fn is_file(path: &Path) -> bool {
    files::metadata(path).is_ok_and(|found| found.is_file())
}

/// Whether there is a folder.
pub fn is_folder(path: &Path) -> bool {
    files::metadata(path).is_ok_and(|found| found.is_dir())
}

/// Threads that work together and are nobody else's. Fails if the system cannot start them.
pub fn thread_pool(count: usize) -> Result<rayon::ThreadPool, rayon::ThreadPoolBuildError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count);
    pool.spawn_handler(|thread| spawn("pool", move || thread.run()).map(drop)).build()
}
