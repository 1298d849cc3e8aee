//! In a browser: files in memory that the page stores, and threads that are workers of the page.
//! Floor 5.
//!
//! The program itself runs in a worker, which may wait for other threads; the page's own thread
//! may not. Everything that only the page can do is a message to it (`host`), and what it answers
//! comes back by [`answer`].

pub mod files;
mod host;
mod questions;
mod tasks;

pub use questions::{Answer, answer, ask, tell};
pub use tasks::{run_tasks, set_thread_count, thread_count};

use std::io;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError, channel};
use std::time::Duration;

/// What is stored between two visits is below this folder.
pub const HOME: &str = "/home";
/// What is saved here goes to the user: as a download, or into the file that was chosen.
pub const DOCUMENTS: &str = "/documents";

/// A thread that was started.
#[derive(Debug)]
pub struct PageThread(Receiver<()>);

impl PageThread {
    /// Waits until it ends; whether it did so without a panic.
    pub fn has_finished_well(self) -> bool {
        self.0.recv().is_ok()
    }
}

/// Starts a thread: a worker that waits for work, or a new one that the page starts.
pub fn spawn(_name: &str, work: impl FnOnce() + Send + 'static) -> io::Result<PageThread> {
    let (done, is_done) = channel();
    tasks::run(Box::new(move || {
        work();
        let _ = done.send(());
    }));
    Ok(PageThread(is_done))
}

/// Lets this thread rest.
pub fn sleep(time: Duration) {
    std::thread::sleep(time);
}

/// The times between two looks at a channel: an eighth of what was waited, between these. What comes
/// soon is waited for by a frame.
const LOOK_AGAIN: (Duration, Duration) = (Duration::from_micros(50), Duration::from_millis(4));
/// Whoever is as patient as this waits without a limit.
const FOREVER: Duration = Duration::from_secs(1 << 30);

/// What a channel receives within some time. The standard library's own has no clock here.
pub fn recv_timeout<T>(from: &Receiver<T>, patience: Duration) -> Result<T, RecvTimeoutError> {
    if patience > FOREVER {
        return from.recv().map_err(|_| RecvTimeoutError::Disconnected);
    }
    let began = super::Instant::now();
    loop {
        let waited = began.elapsed();
        match from.try_recv() {
            Ok(received) => return Ok(received),
            Err(TryRecvError::Disconnected) => return Err(RecvTimeoutError::Disconnected),
            Err(TryRecvError::Empty) if waited >= patience => {
                return Err(RecvTimeoutError::Timeout);
            }
            Err(TryRecvError::Empty) => {
                let pause = (waited / 8).clamp(LOOK_AGAIN.0, LOOK_AGAIN.1);
                sleep(pause.min(patience - waited))
            }
        }
    }
}

/// Hands a finished file to the user: as a download, or into the file that was chosen.
pub fn hand_out(file: &std::path::Path, bytes: &[u8]) {
    host::hand_out(&file.to_string_lossy(), bytes);
}

/// The page's number: no other open page has it.
pub fn process_id() -> u32 {
    host::page_id()
}

/// The locale that the user chose for the browser, such as `de-AT`.
pub fn locale() -> Option<String> {
    Some(host::locale())
}

/// A page has no environment.
pub fn environment_variable(_name: &str) -> Option<String> {
    None
}

/// The user's own folder.
pub fn home_folder() -> Option<PathBuf> {
    Some(DOCUMENTS.into())
}

/// The folder for settings.
pub fn config_folder() -> Option<PathBuf> {
    Some([HOME, "settings"].iter().collect())
}

/// The folder for brushes and palettes.
pub fn data_folder() -> Option<PathBuf> {
    Some([HOME, "data"].iter().collect())
}

/// The folder for recovery.
pub fn state_folder() -> Option<PathBuf> {
    Some([HOME, "state"].iter().collect())
}

/// The folder that relative paths begin in.
pub fn current_folder() -> io::Result<PathBuf> {
    Ok(DOCUMENTS.into())
}
