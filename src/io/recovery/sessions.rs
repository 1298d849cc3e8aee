//! Lost sessions: what sessions that ended without being closed left, and how it is recovered.
//! Floor 5. Nothing is deleted without asking, and nothing here can keep the program from starting.

use super::DrawingVersion;
use super::log::{self, RecordKind};
use super::state::LastState;
use crate::Budget;
use crate::document::Progress;
use crate::fs::{FileLock, Fs};
use crate::platform::{self, SystemTime, UNIX_EPOCH};
use crate::project::Cancelable;
use crate::replace::FileStamp;
use crate::{Error, Result};
use serde_json::Value;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// A session that no process holds any more. While this value lives, no other window takes it.
pub struct LostSession {
    fs: Arc<dyn Fs>,
    path: PathBuf,
    /// The title of the drawing.
    pub title: String,
    /// Where it was last saved, if it was. The recovered drawing is untitled all the same.
    pub file: Option<PathBuf>,
    /// Recovery was started once and did not finish: it is tried again only if the user chooses
    /// this one.
    pub has_failed: bool,
    _lock: Box<dyn FileLock>,
}

/// A drawing brought back. It has no name: saving asks for one.
pub struct RecoveredDocument {
    /// Its last version.
    pub version: DrawingVersion,
    /// Its name for the user.
    pub title: String,
    /// Versions in the log, the first being the drawing as it was opened.
    pub versions: usize,
}

/// The sessions below a folder that are not alive, oldest first. Unreadable ones are left where
/// they are.
pub fn sessions(fs: &Arc<dyn Fs>, folder: &Path) -> Vec<LostSession> {
    let paths = fs.list(folder).unwrap_or_default();
    let logs = paths
        .into_iter()
        .filter(|path| path.extension().is_some_and(|extension| extension == "log"));
    logs.filter_map(|path| session(fs, path)).collect()
}

/// How many sessions below a folder other processes hold: open windows, and for a moment a killed
/// one, whose locks the system releases only when its last thread has ended.
pub fn count_held_by_others(fs: &Arc<dyn Fs>, folder: &Path) -> usize {
    let ours = format!("-{}-", platform::process_id());
    let is_log = |path: &&PathBuf| path.extension().is_some_and(|extension| extension == "log");
    let is_theirs = |path: &&PathBuf| {
        path.file_name().is_some_and(|name| !name.to_string_lossy().contains(&ours))
    };
    let is_held = |path: &&PathBuf| matches!(fs.lock(&path.with_extension("lock")), Ok(None));
    fs.list(folder)
        .unwrap_or_default()
        .iter()
        .filter(is_log)
        .filter(is_theirs)
        .filter(is_held)
        .count()
}

/// `None` while its own process, or another window, holds it.
fn session(fs: &Arc<dyn Fs>, path: PathBuf) -> Option<LostSession> {
    let lock = fs.lock(&path.with_extension("lock")).ok()??;
    let has_failed = !matches!(fs.find(&path.with_extension("trying")), Ok(None));
    // Only the beginning: a broken log may be long.
    let mut start = Vec::new();
    if let Ok(handle) = fs.open(&path) {
        let _ = handle.take(1 << 16).read_to_end(&mut start);
    }
    let head = LastState::of(&start).head.unwrap_or_default();
    let (title, file) = name_and_file(&head);
    Some(LostSession { fs: fs.clone(), path, title, file, has_failed, _lock: lock })
}

/// The title and the file of a drawing.
fn name_and_file(head: &Value) -> (String, Option<PathBuf>) {
    let title = head["title"].as_str().unwrap_or_default().chars().take(200).collect();
    (title, head["file"].as_str().map(PathBuf::from))
}

/// The last whole version in the bytes of a log, with the surface that its parts make; `None` if
/// canceled.
pub fn read(
    file: &Path,
    log: &[u8],
    budget: &Budget,
    progress: &Progress,
) -> Cancelable<RecoveredDocument> {
    let last = LastState::of(log);
    let version = last.version(file, budget)?;
    let version = version
        .ok_or_else(|| Error::decode(file, "it holds no complete version of the drawing"))?;
    let Some(document) = version.document.reshaped_with_progress(progress) else { return Ok(None) };
    let (title, _) = name_and_file(&last.head.unwrap_or_default());
    Ok(Some(RecoveredDocument {
        version: DrawingVersion { document, ..version },
        title,
        versions: last.states,
    }))
}

impl LostSession {
    /// When the session began, from its name.
    pub fn start_time(&self) -> Option<SystemTime> {
        let name = self.path.file_stem()?.to_str()?;
        let micros = u64::from_str_radix(name.split('-').next()?, 16).ok()?;
        UNIX_EPOCH.checked_add(Duration::from_micros(micros))
    }

    /// The last whole version in the log; `None` if canceled.
    ///
    /// It leaves a mark file while it works: if it crashes the program, `has_failed` is true the
    /// next time.
    pub fn recover(
        &mut self,
        budget: &Budget,
        progress: &Progress,
    ) -> Cancelable<RecoveredDocument> {
        let mark = self.path.with_extension("trying");
        // Without the mark nothing would be lost but the warning.
        let _ = self.fs.create_new(&mark).and_then(|mut mark| mark.sync());
        self.has_failed = true;
        let recovered = self.read(budget, progress)?;
        let _ = self.fs.remove(&mark);
        self.has_failed = false;
        Ok(recovered)
    }

    /// Whether the last version equals its file, or the drawing as created: then nothing was lost.
    /// Reads the whole log, piece by piece, and with it the last name of the drawing.
    pub fn is_safe(&mut self) -> bool {
        let end = self.fs.open(&self.path).ok().and_then(|mut handle| log::end(&mut handle));
        let Some((last, Some(saved))) = end else { return false };
        let Ok(saved) = serde_json::from_slice::<Value>(&saved) else { return false };
        (self.title, self.file) = name_and_file(&saved);
        let Some(file) = &self.file else { return last == RecordKind::Saved };
        let number = |i: usize| saved["stamp"][i].as_u64();
        let held = number(0).zip(number(1).and_then(|crc| u32::try_from(crc).ok()));
        let found = self.fs.open(file).and_then(|mut handle| FileStamp::read(&mut *handle));
        let is_held = |found| held.is_none_or(|(bytes, crc)| found == FileStamp { bytes, crc });
        last == RecordKind::Saved && found.is_ok_and(is_held)
    }

    fn read(&self, budget: &Budget, progress: &Progress) -> Cancelable<RecoveredDocument> {
        let io = |e| Error::io(&self.path, e);
        let mut log = Vec::new();
        let handle = self.fs.open(&self.path).map_err(io)?;
        handle.take(budget.unpacked_bytes).read_to_end(&mut log).map_err(io)?;
        read(&self.path, &log, budget, progress)
    }

    /// Deletes what the session left: only if the user says so, or once the drawing is safe in
    /// another session.
    pub fn discard(self) -> Result<()> {
        super::remove_files(&*self.fs, &self.path, &["trying", "new", "log", "lock"])
    }
}
