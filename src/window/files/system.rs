//! The file dialogs of a desktop.
//! Floor 7.

use super::FileAnswer;
use crate::file_purpose::FilePurpose;
use crate::io::platform::Instant;
use crate::language::tr;
use std::time::Duration;

/// A dialog that returns this soon without a result was never shown, because there is no portal.
/// Nobody cancels that fast.
const NEVER_SHOWN: Duration = Duration::from_millis(500);

/// Asks with the system's dialog, which may take as long as it likes.
pub fn system_dialog(purpose: FilePurpose, name: &str) -> FileAnswer {
    // Except on Windows and macOS, the dialog is another program's, reached over the session bus.
    let is_own = cfg!(any(target_os = "windows", target_os = "macos"));
    if !is_own && std::env::var_os("DBUS_SESSION_BUS_ADDRESS").is_none() {
        return FileAnswer::Nowhere;
    }
    let mut dialog = rfd::FileDialog::new().set_title(tr(purpose.title()));
    for (label, extensions) in purpose.filters() {
        dialog = dialog.add_filter(tr(label), &extensions);
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
