//! The standard library's files and threads, and the folders that the system names. Floor 5.

use etcetera::BaseStrategy;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::Duration;

/// Files of the disk.
pub mod files {
    pub use std::fs::{
        File, Metadata, create_dir_all, metadata, read, read_dir, remove_file, symlink_metadata,
    };
}

/// A thread that was started.
#[derive(Debug)]
pub struct Thread(std::thread::JoinHandle<()>);

impl Thread {
    /// Waits until it ends; whether it did so without a panic.
    pub fn has_finished_well(self) -> bool {
        self.0.join().is_ok()
    }
}

/// Starts a thread. Fails if the system cannot start one.
pub fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> io::Result<Thread> {
    std::thread::Builder::new().name(name.into()).spawn(work).map(Thread)
}

/// Lets this thread rest.
pub fn sleep(time: Duration) {
    std::thread::sleep(time);
}

/// What a channel receives within some time.
pub fn recv_timeout<T>(from: &Receiver<T>, patience: Duration) -> Result<T, RecvTimeoutError> {
    from.recv_timeout(patience)
}

/// A number that no other running program has.
pub fn process_id() -> u32 {
    std::process::id()
}

/// The locale that the user chose for the system, such as `de-AT`.
pub fn locale() -> Option<String> {
    sys_locale::get_locale()
}

/// A variable of the environment, if it is set to a text.
pub fn environment_variable(name: &str) -> Option<String> {
    std::env::var(name).ok().filter(|value| !value.is_empty())
}

/// The user's own folder.
pub fn home_folder() -> Option<PathBuf> {
    etcetera::home_dir().ok()
}

/// The user's folder for settings.
pub fn config_folder() -> Option<PathBuf> {
    Some(etcetera::choose_base_strategy().ok()?.config_dir())
}

/// The user's folder for data of programs.
pub fn data_folder() -> Option<PathBuf> {
    Some(etcetera::choose_base_strategy().ok()?.data_dir())
}

/// The user's folder for what programs keep between two starts.
pub fn state_folder() -> Option<PathBuf> {
    let base = etcetera::choose_base_strategy().ok()?;
    Some(base.state_dir().unwrap_or_else(|| base.data_dir()))
}

/// Writes a file that nobody but this user may read, where the system makes a difference: on Windows
/// the user's folders are closed to others.
pub fn write_private(file: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut options = std::fs::OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    match std::fs::remove_file(file) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => io::Write::write_all(&mut options.open(file)?, bytes),
    }
}

/// The folder that relative paths begin in.
pub fn current_folder() -> io::Result<PathBuf> {
    std::env::current_dir()
}
