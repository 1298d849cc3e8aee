//! One drawing's recovery log on a disk: appended to after every edit, and rewritten when it has
//! grown to twice the needed size. Floor 5. It is used from one thread, which `recovery` owns.

use super::DrawingVersion;
use super::log::{self, RecordKind};
use super::state::{self, LoggedParts};
use crate::fs::{FileHandle, Fs};
use crate::replace::FileStamp;
use crate::{Error, Result};
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A log smaller than this is not worth rewriting.
const LEAST_COMPACTED: u64 = 16 << 20;

/// The log of a session.
pub struct Journal {
    fs: Arc<dyn Fs>,
    /// `…/ID.log`
    path: PathBuf,
    head: Value,
    known: LoggedParts,
    /// Absent after a failure: a half-written record makes everything after it unreadable.
    handle: Option<Box<dyn FileHandle>>,
    bytes: u64,
    /// Its length when it was last rewritten.
    fresh_bytes: u64,
    unsynced: bool,
    pub least_compacted: u64,
    /// The log is no longer needed: the current write need not be finished.
    pub given_up: Arc<AtomicBool>,
}

impl Journal {
    /// Nothing is written before the first document.
    pub fn new(fs: Arc<dyn Fs>, path: PathBuf, title: &str, file: Option<&Path>) -> Self {
        let head =
            json!({ "format": "rilievo-recovery", "version": 1, "title": title, "file": file });
        Self {
            fs,
            path,
            head,
            known: LoggedParts::default(),
            handle: None,
            bytes: 0,
            fresh_bytes: 0,
            unsynced: false,
            least_compacted: LEAST_COMPACTED,
            given_up: Arc::default(),
        }
    }

    /// The version recorded last is what a file holds, or with no file what the drawing was made
    /// as.
    ///
    /// If this cannot be written, the drawing is offered for recovery once more than necessary.
    pub fn mark_saved(
        &mut self,
        title: &str,
        file: Option<&Path>,
        stamp: Option<FileStamp>,
    ) -> Result<()> {
        (self.head["title"], self.head["file"]) = (json!(title), json!(file));
        let stamp = stamp.map(|stamp| json!([stamp.bytes, stamp.crc]));
        let said = json!({ "title": title, "file": file, "stamp": stamp }).to_string();
        let mut out = Vec::new();
        let is_short = log::push(&mut out, RecordKind::Saved, &[said.as_bytes()]);
        debug_assert!(is_short, "it has a few hundred bytes");
        self.append(&out)
    }

    /// Appends a version of the drawing.
    pub fn record(&mut self, version: impl Into<DrawingVersion>) -> Result<()> {
        let version = &version.into();
        let has_grown = self.bytes > self.least_compacted.max(2 * self.fresh_bytes);
        if has_grown || self.handle.is_none() {
            return self.write_anew(version);
        }
        let mut out = Vec::new();
        if let Err(error) =
            state::write(&self.path, version, &mut self.known, &mut out, &self.given_up)
        {
            // The state it remembers no longer matches the log.
            self.handle = None;
            return Err(error);
        }
        self.append(&out)
    }

    fn append(&mut self, out: &[u8]) -> Result<()> {
        let Some(handle) = &mut self.handle else { return Ok(()) };
        if let Err(e) = handle.write_all(out) {
            self.handle = None;
            return Err(Error::io(&self.path, e));
        }
        self.bytes += out.len() as u64;
        self.unsynced = true;
        Ok(())
    }

    /// Makes sure that what was appended outlives a power cut.
    pub fn sync(&mut self) -> Result<()> {
        if !std::mem::take(&mut self.unsynced) {
            return Ok(());
        }
        let Some(handle) = &mut self.handle else { return Ok(()) };
        handle.sync().map_err(|e| {
            // Data that the system dropped cannot be written again.
            self.handle = None;
            Error::io(&self.path, e)
        })
    }

    /// Writes a log of only this version next to the old one, and replaces that.
    fn write_anew(&mut self, version: &DrawingVersion) -> Result<()> {
        let failed = |e| Error::io(&self.path, e);
        let mut known = LoggedParts::default();
        let mut out = log::MAGIC.to_vec();
        let is_short = log::push(&mut out, RecordKind::Head, &[self.head.to_string().as_bytes()]);
        debug_assert!(is_short, "a head has a few hundred bytes");
        state::write(&self.path, version, &mut known, &mut out, &self.given_up)?;
        let part = self.path.with_extension("new");
        // Left by a session of this name that was interrupted here.
        let _ = self.fs.remove(&part);
        let mut handle = self.fs.create_new(&part).map_err(failed)?;
        let written = handle.write_all(&out).and_then(|()| handle.sync());
        let placed = written.and_then(|()| self.fs.rename(&part, &self.path));
        if let Err(e) = placed {
            let _ = self.fs.remove(&part);
            return Err(failed(e));
        }
        let folder = self.path.parent().unwrap_or(Path::new("."));
        self.fs.sync_dir(folder).map_err(failed)?;
        (self.handle, self.known) = (Some(handle), known);
        (self.bytes, self.fresh_bytes, self.unsynced) = (out.len() as u64, out.len() as u64, false);
        Ok(())
    }
}
