//! Recovery: after every edit the drawing is written to a log next to the settings, so that a crash
//! or a power cut loses only the last moments (docs/PROJECTS.md). Floor 5. Saving is `io::save`;
//! the log is for accidents only, and is gone once the drawing is closed.
//!
//! | file | |
//! |---|---|
//! | `log` | records of bytes, and their longest valid prefix |
//! | `state` | a document as records |
//! | `journal` | one drawing's log on a disk |
//! | `sessions` | recovery after an accident |

mod journal;
mod log;
mod sessions;
mod state;
#[cfg(test)]
mod tests;

pub use sessions::{LostSession, RecoveredDocument, count_held_by_others, read, sessions};

use super::fs::{FileLock, Fs};
use super::platform::{self, Instant, SystemTime, Thread, UNIX_EPOCH};
use super::replace::FileStamp;
use crate::document::Document;
use crate::{Error, Result};
use journal::Journal;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Appended edits are flushed after this time at the latest; with the flush itself it stays below
/// five seconds.
const FLUSH_AFTER: Duration = Duration::from_secs(3);

/// The recovery log of one open drawing: a worker that writes it, and a lock that marks the session
/// as alive.
///
/// Dropped without [`RecoveryLog::close`], it leaves the log, as a crash does.
pub struct RecoveryLog {
    tasks: Option<Sender<RecoveryTask>>,
    given_up: Arc<AtomicBool>,
    worker: Option<Thread>,
    trouble: Arc<Mutex<Option<String>>>,
    fs: Arc<dyn Fs>,
    path: PathBuf,
    lock: Option<Box<dyn FileLock>>,
}

/// A version of a drawing for its log.
#[derive(Clone)]
pub struct DrawingVersion {
    /// The drawing.
    pub document: Document,
    /// What the program wants to know of this version besides the document; small.
    pub aside: Value,
}

impl From<&Document> for DrawingVersion {
    fn from(document: &Document) -> Self {
        Self { document: document.clone(), aside: Value::Null }
    }
}

enum RecoveryTask {
    Record(DrawingVersion),
    Saved(String, Option<PathBuf>, Option<FileStamp>),
    /// Signals when everything before it is written; `true`: flushed to the disk.
    Tell(Sender<()>, bool),
}

impl RecoveryLog {
    /// Begins a session for a drawing, in a folder that [`folder`] names.
    ///
    /// * `file`: where it was opened from or saved to; `None` for an untitled one.
    ///
    /// Fails where the folder cannot be made or no lock can be had: then the drawing goes on
    /// without recovery.
    pub fn start(
        fs: Arc<dyn Fs>,
        folder: &Path,
        version: impl Into<DrawingVersion>,
        title: &str,
        file: Option<&Path>,
    ) -> Result<Self> {
        fs.create_folder(folder).map_err(|e| Error::io(folder, e))?;
        let (path, lock) = fresh_session(&*fs, folder)?;
        let journal = Journal::new(fs.clone(), path.clone(), title, file);
        let given_up = journal.given_up.clone();
        let (tasks, received) = channel();
        let trouble = Arc::default();
        let shared_trouble = Arc::clone(&trouble);
        let work = move || work(journal, &received, &shared_trouble);
        let worker = platform::spawn("recovery", work).map_err(|e| Error::io(folder, e))?;
        let recovery = Self {
            tasks: Some(tasks),
            given_up,
            worker: Some(worker),
            trouble,
            fs,
            path,
            lock: Some(lock),
        };
        recovery.record(version);
        Ok(recovery)
    }

    /// Writes a version of the drawing; called after every edit, undo and redo. Returns at once.
    pub fn record(&self, version: impl Into<DrawingVersion>) {
        self.send(RecoveryTask::Record(version.into()));
    }

    /// The version recorded last equals the file; without a file, the drawing as created. Nothing
    /// would be lost.
    pub fn mark_saved(&self, title: &str, file: Option<&Path>, stamp: Option<FileStamp>) {
        self.send(RecoveryTask::Saved(title.into(), file.map(Path::to_owned), stamp));
    }

    /// Waits until everything recorded has reached the system, where a crash or `kill -9` cannot
    /// lose it; no longer than `patience`. Returns whether it has.
    pub fn wait_until_written(&self, patience: Duration) -> bool {
        let (done, is_done) = channel();
        self.send(RecoveryTask::Tell(done, false));
        // The worker signals by dropping the sender, which also happens if it ends.
        !matches!(platform::recv_timeout(&is_done, patience), Err(RecvTimeoutError::Timeout))
    }

    /// Waits until everything recorded is on the disk, where a power cut cannot lose it.
    pub fn flush(&self) {
        let (done, is_done) = channel();
        self.send(RecoveryTask::Tell(done, true));
        let _ = is_done.recv();
    }

    /// Why the last version could not be written, until one can.
    pub fn trouble(&self) -> Option<String> {
        self.trouble.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Ends the session and deletes its log: the drawing is saved, or the user discarded it.
    pub fn close(mut self) -> Result<()> {
        self.given_up.store(true, Ordering::Relaxed);
        self.stop();
        remove_files(&*self.fs, &self.path, &["new", "log", "lock"])
    }

    fn send(&self, task: RecoveryTask) {
        if let Some(tasks) = &self.tasks {
            // A worker that has ended has reported its error.
            let _ = tasks.send(task);
        }
    }

    /// The worker writes everything recorded, and ends.
    fn stop(&mut self) {
        self.tasks = None;
        if let Some(worker) = self.worker.take() {
            let _ = worker.has_finished_well();
        }
    }
}

/// Deletes what there is of a session, by the extensions.
fn remove_files(fs: &dyn Fs, path: &Path, extensions: &[&str]) -> Result<()> {
    for extension in extensions {
        let path = path.with_extension(extension);
        match fs.remove(&path) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(Error::io(path, e)),
            _ => {}
        }
    }
    Ok(())
}

impl Drop for RecoveryLog {
    fn drop(&mut self) {
        self.stop();
        self.lock = None;
    }
}

/// The folder of sessions: `rilievo/recovery` in the user's folder for state; `None` if the system
/// has none.
pub fn folder() -> Option<PathBuf> {
    Some(platform::state_folder()?.join("rilievo").join("recovery"))
}

/// A name that no session has, and the lock that makes it ours. The name begins with the time, so
/// that sessions sort.
fn fresh_session(fs: &dyn Fs, folder: &Path) -> Result<(PathBuf, Box<dyn FileLock>)> {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_micros();
    for attempt in 0..1000 {
        let path = folder.join(format!("{now:016x}-{}-{attempt}.log", platform::process_id()));
        let is_free = fs.find(&path).map_err(|e| Error::io(&path, e))?.is_none();
        if let Some(lock) =
            fs.lock(&path.with_extension("lock")).map_err(|e| Error::io(&path, e))?
            && is_free
        {
            return Ok((path, lock));
        }
    }
    Err(Error::io(folder, std::io::Error::other("no name for a recovery log is free")))
}

/// Writes versions as they come, and flushes them in time. Of versions that came while one was
/// written only the last counts.
fn work(mut journal: Journal, tasks: &Receiver<RecoveryTask>, trouble: &Mutex<Option<String>>) {
    let mut waiting_since: Option<Instant> = None;
    let mut next = None;
    let say = |what: Option<Error>| {
        *trouble.lock().unwrap_or_else(PoisonError::into_inner) =
            what.map(|error| error.to_string());
    };
    // Only a successfully written version clears an error.
    let tell = |result: Result<()>| {
        if let Err(error) = result {
            say(Some(error));
        }
    };
    loop {
        let patience = waiting_since
            .map_or(Duration::MAX, |since| FLUSH_AFTER.saturating_sub(since.elapsed()));
        match next.take().map_or_else(|| platform::recv_timeout(tasks, patience), Ok) {
            Ok(RecoveryTask::Record(version)) => {
                next = tasks.try_recv().ok();
                if matches!(next, Some(RecoveryTask::Record(_))) {
                    continue;
                }
                say(journal.record(version).err());
                waiting_since.get_or_insert_with(Instant::now);
            }
            Ok(RecoveryTask::Saved(title, file, stamp)) => {
                tell(journal.mark_saved(&title, file.as_deref(), stamp))
            }
            Ok(RecoveryTask::Tell(done, flushed)) => {
                if flushed {
                    tell(journal.sync());
                    waiting_since = None;
                }
                drop(done);
            }
            Err(RecvTimeoutError::Timeout) => {
                tell(journal.sync());
                waiting_since = None;
            }
            Err(RecvTimeoutError::Disconnected) => return tell(journal.sync()),
        }
        if waiting_since.is_some_and(|since| since.elapsed() >= FLUSH_AFTER) {
            tell(journal.sync());
            waiting_since = None;
        }
    }
}
