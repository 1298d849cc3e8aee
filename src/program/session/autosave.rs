//! Recovery of the open documents: each has a log that follows its edits and is deleted when it is
//! closed. After an accident, lost documents are recovered. Floor 6. Not here: the logs and their
//! workers (`io::recovery`, docs/PROJECTS.md).

use super::replay::ReplayValue;
use super::{OpenDocument, is_same};
use crate::Result;
use crate::document::{Document, Progress};
use crate::io::Budget;
use crate::io::fs::{Disk, Fs};
use crate::io::recovery::{self, DrawingVersion, RecoveryLog};
use crate::io::replace::FileStamp;
use crate::tools::ToolKind;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// The longest wait until an edit is written. The record of a stroke takes a fraction of this; that
/// of a large drawing continues in the background.
const PATIENCE: Duration = Duration::from_millis(8);
/// How long a killed program may take to end: on a busy computer it may still hold its logs when it
/// is started again.
const DYING: Duration = Duration::from_secs(5);
const LOOK_AGAIN: Duration = Duration::from_millis(200);

/// The logs of the open documents.
pub struct Autosave {
    fs: Arc<dyn Fs>,
    folder: PathBuf,
    followed: BTreeMap<usize, FollowedDocument>,
    /// The last error that was reported.
    reported: Option<String>,
}

/// The log of a document, and the last recorded state.
struct FollowedDocument {
    /// Absent if none could be created.
    recovery: Option<RecoveryLog>,
    document: Document,
    /// Set if the file has the same content.
    held: Option<(String, Option<PathBuf>, Option<FileStamp>)>,
}

impl FollowedDocument {
    /// The first record is the whole document; `saved` follows separately.
    fn begin(
        fs: &Arc<dyn Fs>,
        folder: &Path,
        open: &OpenDocument,
        tool: ToolKind,
    ) -> (Self, Option<String>) {
        let document = open.document().clone();
        let begun = RecoveryLog::start(
            fs.clone(),
            folder,
            version(open, tool),
            &open.title(),
            open.file.as_deref(),
        );
        let (recovery, trouble) = match begun {
            Ok(recovery) => (Some(recovery), None),
            Err(error) => (None, Some(error.to_string())),
        };
        (Self { recovery, document, held: None }, trouble)
    }

    /// Records changes of the document in the log; returns whether there were any.
    fn follow(&mut self, open: &OpenDocument, tool: ToolKind) -> bool {
        let Some(recovery) = &self.recovery else { return false };
        let is_edited = !is_same(&self.document, open.document());
        if is_edited {
            self.document = open.document().clone();
            recovery.record(version(open, tool));
        }
        let held = (!open.is_dirty()).then(|| (open.title(), open.file.clone(), open.stamp));
        if let Some((title, file, stamp)) = held.as_ref().filter(|_| is_edited || held != self.held)
        {
            recovery.mark_saved(title, file.as_deref(), *stamp);
        }
        self.held = held;
        is_edited
    }
}

impl Autosave {
    /// * `folder`: as [`recovery::folder`] names it; created when needed.
    pub fn new(folder: PathBuf) -> Self {
        Self { fs: Arc::new(Disk), folder, followed: BTreeMap::new(), reported: None }
    }

    /// Updates the logs to the open documents; called after every change. Returns a new error as a
    /// sentence.
    ///
    /// * `tool`: the one in hand, which a recovered drawing brings back.
    ///
    /// It waits a few milliseconds for an edit to be written, so that what the user sees is safe
    /// from `kill -9`.
    pub fn follow(&mut self, open_documents: &[OpenDocument], tool: ToolKind) -> Option<String> {
        let mut trouble = None;
        for open in open_documents {
            let is_edited = match self.followed.get_mut(&open.key) {
                Some(followed)
                    if followed.recovery.is_some()
                        || is_same(&followed.document, open.document()) =>
                {
                    followed.follow(open, tool)
                }
                // Not known yet, or edited since its log could not be created: try again.
                _ => {
                    let (mut followed, why) =
                        FollowedDocument::begin(&self.fs, &self.folder, open, tool);
                    trouble = trouble.or(why);
                    followed.follow(open, tool);
                    self.followed.insert(open.key, followed);
                    false
                }
            };
            let recovery =
                self.followed.get(&open.key).and_then(|followed| followed.recovery.as_ref());
            if let Some(recovery) = recovery {
                if is_edited {
                    recovery.wait_until_written(PATIENCE);
                }
                trouble = trouble.or_else(|| recovery.trouble());
            }
        }
        let is_open = |key: &usize| open_documents.iter().any(|open| open.key == *key);
        let closed: Vec<usize> =
            self.followed.keys().copied().filter(|key| !is_open(key)).collect();
        for key in closed {
            trouble = self.end(key).err().map(|error| error.to_string()).or(trouble);
        }
        let is_new = trouble != self.reported;
        self.reported.clone_from(&trouble);
        let sentence = |why| format!("Not protected from a crash until it is saved: {why}");
        trouble.filter(|_| is_new).map(sentence)
    }

    /// Takes over a document that already has a log, such as a recovered one.
    pub fn adopt(&mut self, open: &OpenDocument, recovery: RecoveryLog) {
        let document = open.document().clone();
        self.followed
            .insert(open.key, FollowedDocument { recovery: Some(recovery), document, held: None });
    }

    /// Waits until all edits are written.
    pub fn wait_until_written(&self) {
        for recovery in self.followed.values().filter_map(|followed| followed.recovery.as_ref()) {
            while !recovery.wait_until_written(Duration::from_secs(1)) {}
        }
    }

    /// The program ends normally: saved or untouched documents need no log. Other logs stay, to be
    /// offered.
    pub fn close(&mut self, open_documents: &[OpenDocument], tool: ToolKind) {
        self.follow(open_documents, tool);
        for open in open_documents.iter().filter(|open| !open.is_dirty()) {
            // A log that cannot be deleted is recognized as safe the next time.
            let _ = self.end(open.key);
        }
    }

    fn end(&mut self, key: usize) -> Result<()> {
        let recovery = self.followed.remove(&key).and_then(|followed| followed.recovery);
        recovery.map_or(Ok(()), RecoveryLog::close)
    }

    /// For a thread that finds or recovers lost sessions.
    pub fn find_lost_sessions(&self) -> LostSessions {
        LostSessions { fs: self.fs.clone(), folder: self.folder.clone() }
    }
}

/// The sessions that accidents left.
pub struct LostSessions {
    fs: Arc<dyn Fs>,
    folder: PathBuf,
}

/// A recovered document, and its new log.
pub struct RestoredDocument {
    /// The document, open again.
    pub open: OpenDocument,
    /// Its own recovery log, if one could be made.
    pub recovery: Option<RecoveryLog>,
    /// What the user had in hand.
    pub tool: Option<ToolKind>,
}

/// What a log holds of an open document.
fn version(open: &OpenDocument, tool: ToolKind) -> DrawingVersion {
    let aside = json!({ "target": open.stored_target(), "tool": tool.to_value() });
    DrawingVersion { document: open.document().clone(), aside }
}

impl LostSessions {
    /// The drawings to offer, oldest first. Logs whose last version is saved in a file are deleted.
    ///
    /// If there are none, it retries for some seconds while other processes hold logs: one may be
    /// just ending.
    pub fn list(&self) -> Vec<recovery::LostSession> {
        for _ in 0..DYING.as_millis() / LOOK_AGAIN.as_millis() {
            let lost = self.list_now();
            if !lost.is_empty() || recovery::count_held_by_others(&self.fs, &self.folder) == 0 {
                return lost;
            }
            self.fs.pause(LOOK_AGAIN);
        }
        self.list_now()
    }

    fn list_now(&self) -> Vec<recovery::LostSession> {
        let mut lost = Vec::new();
        for mut session in recovery::sessions(&self.fs, &self.folder) {
            // One that failed before is not even read without asking.
            if !session.has_failed && session.is_safe() {
                // If it cannot be deleted, it is still safe the next time.
                let _ = session.discard();
            } else {
                lost.push(session);
            }
        }
        lost
    }

    /// Recovers a drawing: untitled and unsaved. Its old log is deleted once a new one holds it.
    /// `None` if canceled: it is offered again.
    pub fn bring_back(
        &self,
        mut session: recovery::LostSession,
        progress: &Progress,
    ) -> Result<Option<RestoredDocument>> {
        let Some(recovered) = session.recover(&Budget::of_this_machine(), progress)? else {
            return Ok(None);
        };
        let name = Path::new(&recovered.title).file_stem().unwrap_or_default().to_string_lossy();
        let DrawingVersion { document, aside } = recovered.version;
        let mut open = OpenDocument::new(recovered_name(&name), document, None);
        open.mark_unsaved();
        open.aim_as_stored(&aside["target"]);
        let tool = ToolKind::read(&aside["tool"]).ok();
        let again = version(&open, tool.unwrap_or_default());
        let begun = RecoveryLog::start(self.fs.clone(), &self.folder, again, &open.title(), None);
        let recovery = begun.ok().filter(|recovery| {
            recovery.flush();
            recovery.trouble().is_none()
        });
        if recovery.is_some() {
            // A log that stays is offered again; nothing is lost.
            let _ = session.discard();
        }
        Ok(Some(RestoredDocument { open, recovery, tool }))
    }
}

/// The name of what was recovered, and of what is recovered of that again.
fn recovered_name(name: &str) -> String {
    const SUFFIX: &str = " (recovered)";
    format!("{} (recovered)", name.strip_suffix(SUFFIX).unwrap_or(name))
}

#[cfg(test)]
mod tests;
