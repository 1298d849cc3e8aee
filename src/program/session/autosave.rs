//! Recovery of the open documents: each has a log that follows its edits and is gone once it is closed; and what an
//! accident left is brought back. Floor 6. Logs and their workers are `io::recovery`'s (docs/PROJECTS.md).

use super::{OpenDocument, is_same};
use crate::Result;
use crate::document::Document;
use crate::io::Budget;
use crate::io::fs::{Disk, Fs};
use crate::io::recovery::{self, RecoveryLog};
use crate::io::save::FileStamp;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// How long an edit waits for being written: so long a dab may take. The record of a stroke takes a fraction of it; one
/// of a large drawing goes on by itself.
const PATIENCE: Duration = Duration::from_millis(8);
/// How long a program that was killed may take to die: one with many threads on a busy computer still holds its logs
/// when it is started again.
const DYING: Duration = Duration::from_secs(5);
const LOOK_AGAIN: Duration = Duration::from_millis(200);

/// The logs of the open documents.
pub struct Autosave {
    fs: Arc<dyn Fs>,
    folder: PathBuf,
    followed: BTreeMap<usize, FollowedDocument>,
    /// The trouble that was told last.
    told: Option<String>,
}

/// The log of a document, and what it was told last.
struct FollowedDocument {
    /// Absent where none could be begun.
    recovery: Option<RecoveryLog>,
    document: Document,
    /// Where the file holds the very same.
    held: Option<(String, Option<PathBuf>, Option<FileStamp>)>,
}

impl FollowedDocument {
    /// The first word is all of the document; `saved` follows by itself.
    fn begin(fs: &Arc<dyn Fs>, folder: &Path, tab: &OpenDocument) -> (Self, Option<String>) {
        let document = tab.document().clone();
        let begun = RecoveryLog::start(fs.clone(), folder, &document, &tab.title(), tab.file.as_deref());
        let (recovery, trouble) = match begun {
            Ok(recovery) => (Some(recovery), None),
            Err(error) => (None, Some(error.to_string())),
        };
        (Self { recovery, document, held: None }, trouble)
    }
    /// Tells the log what became of the document; whether there was anything to tell.
    fn follow(&mut self, tab: &OpenDocument) -> bool {
        let Some(recovery) = &self.recovery else { return false };
        let is_edited = !is_same(&self.document, tab.document());
        if is_edited {
            self.document = tab.document().clone();
            recovery.record(&self.document);
        }
        let held = (!tab.is_dirty()).then(|| (tab.title(), tab.file.clone(), tab.stamp));
        if let Some((title, file, stamp)) = held.as_ref().filter(|_| is_edited || held != self.held) {
            recovery.saved(title, file.as_deref(), *stamp);
        }
        self.held = held;
        is_edited
    }
}

impl Autosave {
    /// * `folder`: as [`recovery::folder`] names it; made when it is needed.
    pub fn new(folder: PathBuf) -> Self {
        Self { fs: Arc::new(Disk), folder, followed: BTreeMap::new(), told: None }
    }
    /// Brings the logs up to the open documents; called after whatever may have changed them. A new trouble as a
    /// sentence.
    ///
    /// An edit waits a few milliseconds for being written, so that what is seen as done is safe from `kill -9`.
    pub fn follow(&mut self, open_documents: &[OpenDocument]) -> Option<String> {
        let mut trouble = None;
        for tab in open_documents {
            let is_edited = match self.followed.get_mut(&tab.key) {
                Some(followed) if followed.recovery.is_some() || is_same(&followed.document, tab.document()) => {
                    followed.follow(tab)
                }
                // Not known yet, or edited since its log could not be begun: perhaps now it can.
                _ => {
                    let (mut followed, why) = FollowedDocument::begin(&self.fs, &self.folder, tab);
                    trouble = trouble.or(why);
                    followed.follow(tab);
                    self.followed.insert(tab.key, followed);
                    false
                }
            };
            let recovery = self.followed.get(&tab.key).and_then(|followed| followed.recovery.as_ref());
            if let Some(recovery) = recovery {
                if is_edited {
                    recovery.settle(PATIENCE);
                }
                trouble = trouble.or_else(|| recovery.trouble());
            }
        }
        let is_open = |key: &usize| open_documents.iter().any(|tab| tab.key == *key);
        let closed: Vec<usize> = self.followed.keys().copied().filter(|key| !is_open(key)).collect();
        for key in closed {
            trouble = self.end(key).err().map(|error| error.to_string()).or(trouble);
        }
        let is_new = trouble != self.told;
        self.told.clone_from(&trouble);
        let sentence = |why| format!("Not safe from a crash until it is saved: {why}");
        trouble.filter(|_| is_new).map(sentence)
    }
    /// A document that has a log already, such as a recovered one.
    pub fn adopt(&mut self, tab: &OpenDocument, recovery: RecoveryLog) {
        let document = tab.document().clone();
        self.followed.insert(tab.key, FollowedDocument { recovery: Some(recovery), document, held: None });
    }
    /// Waits until all edits are written.
    pub fn settle(&self) {
        for recovery in self.followed.values().filter_map(|followed| followed.recovery.as_ref()) {
            while !recovery.settle(Duration::from_secs(1)) {}
        }
    }
    /// The program ends as it should: what is saved, or never was touched, needs no log. Others stay, to be offered.
    pub fn close(&mut self, open_documents: &[OpenDocument]) {
        self.follow(open_documents);
        for tab in open_documents.iter().filter(|tab| !tab.is_dirty()) {
            // What cannot be deleted is found to be safe the next time.
            let _ = self.end(tab.key);
        }
    }
    fn end(&mut self, key: usize) -> Result<()> {
        let recovery = self.followed.remove(&key).and_then(|followed| followed.recovery);
        recovery.map_or(Ok(()), RecoveryLog::close)
    }
    /// For a thread that looks after what was left, or brings it back.
    pub fn lost(&self) -> LostSessions {
        LostSessions { fs: self.fs.clone(), folder: self.folder.clone() }
    }
}

/// What accidents left.
pub struct LostSessions {
    fs: Arc<dyn Fs>,
    folder: PathBuf,
}

/// A document that was brought back, and the log it has now.
pub struct RecoveredTab {
    pub tab: OpenDocument,
    pub recovery: Option<RecoveryLog>,
}

impl LostSessions {
    /// The drawings to offer, oldest first. Logs of which a file holds the very last version are deleted.
    ///
    /// Where there are none it looks again for some seconds as long as other processes hold logs: one may be just
    /// dying.
    pub fn list(&self) -> Vec<recovery::LostSession> {
        for _ in 0..DYING.as_millis() / LOOK_AGAIN.as_millis() {
            let lost = self.list_now();
            if !lost.is_empty() || recovery::held_by_others(&self.fs, &self.folder) == 0 {
                return lost;
            }
            self.fs.pause(LOOK_AGAIN);
        }
        self.list_now()
    }
    fn list_now(&self) -> Vec<recovery::LostSession> {
        let mut lost = Vec::new();
        for mut session in recovery::sessions(&self.fs, &self.folder) {
            // One that failed is not so much as read unasked.
            if !session.has_failed && session.is_safe() {
                // If it cannot be deleted, it is as safe the next time.
                let _ = session.discard();
            } else {
                lost.push(session);
            }
        }
        lost
    }
    /// Brings a drawing back: untitled, with something to save. What was left of it is deleted once another log holds
    /// it.
    pub fn bring_back(&self, mut session: recovery::LostSession) -> Result<RecoveredTab> {
        let recovered = session.recover(&Budget::default())?;
        let name = Path::new(&recovered.title).file_stem().unwrap_or_default().to_string_lossy();
        let mut tab = OpenDocument::new(format!("{name} (recovered)"), recovered.document, None);
        tab.mark_unsaved();
        let begun = RecoveryLog::start(self.fs.clone(), &self.folder, tab.document(), &tab.title(), None);
        let recovery = begun.ok().filter(|recovery| {
            recovery.flush();
            recovery.trouble().is_none()
        });
        if recovery.is_some() {
            // What stays is offered once more; nothing is lost by that.
            let _ = session.discard();
        }
        Ok(RecoveredTab { tab, recovery })
    }
}

#[cfg(test)]
mod tests;
