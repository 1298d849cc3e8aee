//! File dialogs: the system's own, or the window's if the system has none. Floor 7. `system` asks the
//! desktop, `page` the browser.

#[cfg(target_family = "wasm")]
mod page;
#[cfg(not(target_family = "wasm"))]
mod system;

use super::file_purpose::FilePurpose;
use super::jobs::{JobKind, JobResult, JobWindow, Jobs};
use crate::language::{language, set_language, tr};
#[cfg(target_family = "wasm")]
use page::system_dialog;
use std::path::PathBuf;
#[cfg(not(target_family = "wasm"))]
use system::system_dialog;

/// The result of the system's dialog.
pub enum FileAnswer {
    File(PathBuf),
    Canceled,
    /// The system has no such dialog.
    Nowhere,
}

/// Asks with the system's dialog, on another thread, and does something with the answer.
/// [`FileAnswer::Nowhere`] means that there is none, or that the window should show its own
/// (`by_itself`).
pub fn request<W: JobWindow>(
    jobs: &mut Jobs<W>,
    purpose: FilePurpose,
    name: &str,
    by_itself: bool,
    then: impl FnOnce(&mut W, FileAnswer) + Send + 'static,
) {
    let name = name.to_owned();
    // The dialog's thread has a language of its own.
    let spoken = language();
    jobs.start(tr(purpose.title()).into(), JobKind::Asking, move |_| {
        set_language(spoken);
        let answer = if by_itself { FileAnswer::Nowhere } else { system_dialog(purpose, &name) };
        JobResult::then(|window, _| then(window, answer))
    });
}
