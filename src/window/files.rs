//! File dialogs: the system's own, or the window's if the system has none.
//! Floor 7.

use super::file_purpose::FilePurpose;
use super::jobs::{JobKind, JobResult, JobWindow, Jobs};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// A dialog that returns this soon without a result was never shown, because there is no portal.
/// Nobody cancels that fast.
const NEVER_SHOWN: Duration = Duration::from_millis(500);

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
    jobs.start(purpose.title().into(), JobKind::Asking, move |_| {
        let answer = if by_itself { FileAnswer::Nowhere } else { system_dialog(purpose, &name) };
        JobResult::then(|window, _| then(window, answer))
    });
}

fn system_dialog(purpose: FilePurpose, name: &str) -> FileAnswer {
    // Except on Windows and macOS, the dialog is another program's, reached over the session bus.
    let is_own = cfg!(any(target_os = "windows", target_os = "macos"));
    if !is_own && std::env::var_os("DBUS_SESSION_BUS_ADDRESS").is_none() {
        return FileAnswer::Nowhere;
    }
    let mut dialog = rfd::FileDialog::new().set_title(purpose.title());
    for (label, extensions) in purpose.filters() {
        dialog = dialog.add_filter(label, &extensions);
    }
    let asked = Instant::now();
    let file = if purpose.is_saving() {
        dialog.set_file_name(name).save_file()
    } else {
        dialog.pick_file()
    };
    match file {
        Some(file) => FileAnswer::File(file),
        None if asked.elapsed() < NEVER_SHOWN => FileAnswer::Nowhere,
        None => FileAnswer::Canceled,
    }
}
