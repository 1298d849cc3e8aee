//! The file that is to be replaced: where its name leads, and whether it may be lost.
//! Floor 5.

use super::{FileStamp, Overwrite, ReplaceJob, Terms, folder_of};
use crate::document::Progress;
use crate::fs::{EntryKind, Fs, Identity};
use crate::{Error, Result};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Whether [`super::replace`] would begin: for a look before the work that makes the bytes.
pub fn check(fs: &dyn Fs, file: &Path, terms: &Terms) -> Result<()> {
    let replacing =
        ReplaceJob { fs, named: file, bytes: &[], terms, progress: &Progress::default() };
    replacing.check_allowed(&replacing.target()?)
}

/// Both paths lead to one file, whatever its names.
pub fn is_same_file(fs: &dyn Fs, one: &Path, other: &Path) -> bool {
    let resolved = |path: &Path| fs.resolve(path).unwrap_or_else(|_| path.into());
    one == other || is_named(fs, one, &resolved(other), fs.identity(other).ok().flatten())
}

/// A path leads to the file at `target`, which is resolved and has this identity.
fn is_named(fs: &dyn Fs, path: &Path, target: &Path, identity: Option<Identity>) -> bool {
    let is_path = fs.resolve(path).is_ok_and(|path| path == target);
    // Another name of the same file, which no path shows.
    is_path || (identity.is_some() && fs.identity(path).is_ok_and(|other| other == identity))
}

impl ReplaceJob<'_> {
    /// The file itself: where a link leads to, not the link.
    pub(super) fn target(&self) -> Result<PathBuf> {
        let io = |e| self.describe_failure("", e);
        let irregular = || {
            Error::unsupported_file(
                self.named,
                "it is not a regular file, so it cannot be replaced",
            )
        };
        match self.fs.find(self.named).map_err(io)? {
            Some(EntryKind::File) | Some(EntryKind::Link) => {
                let target = self.fs.resolve(self.named);
                let target = target.map_err(|e| self.describe_failure("it is a broken link", e))?;
                match self.fs.find(&target).map_err(io)? {
                    Some(EntryKind::File) => Ok(target),
                    _ => Err(irregular()),
                }
            }
            Some(EntryKind::Folder) => Err(Error::unsupported_file(self.named, "it is a folder")),
            Some(EntryKind::Other) => Err(irregular()),
            None => {
                let name = self
                    .named
                    .file_name()
                    .ok_or_else(|| Error::unsupported_file(self.named, "it has no name"))?;
                let folder = self.fs.resolve(folder_of(self.named));
                let unreached = |e: io::Error| {
                    let is_absent = e.kind() == ErrorKind::NotFound;
                    let what = "its folder cannot be reached";
                    let absent =
                        format!("{what}: there is no folder {}", folder_of(self.named).display());
                    self.describe_failure(if is_absent { &absent } else { what }, e)
                };
                Ok(folder.map_err(unreached)?.join(name))
            }
        }
    }

    /// Checks that the existing file may be replaced.
    pub(super) fn check_allowed(&self, target: &Path) -> Result<()> {
        let io = |e| self.describe_failure("", e);
        if self.fs.find(target).map_err(io)?.is_none() {
            // A file that is gone cannot be lost.
            return Ok(());
        }
        if self.is_read(target)? {
            return Err(Error::unsupported_file(
                self.named,
                "an open document was made from it; write to another file",
            ));
        }
        let changed =
            |reason: &str| Err(Error::Changed { file: self.named.into(), reason: reason.into() });
        match self.terms.over {
            Overwrite::Forced => return Ok(()),
            Overwrite::Nothing => return Err(self.name_taken_error()),
            Overwrite::This(stamp) if self.stamp_of(target)? != stamp => {
                return changed("another program changed it since it was opened");
            }
            Overwrite::This(_) | Overwrite::Anything => {}
        }
        if self.fs.is_read_only(target).map_err(io)? { changed("it is read-only") } else { Ok(()) }
    }

    pub(super) fn name_taken_error(&self) -> Error {
        Error::Changed {
            file: self.named.into(),
            reason: "a file of this name already exists".into(),
        }
    }

    /// The document is made from this very file, whatever its names.
    fn is_read(&self, target: &Path) -> Result<bool> {
        if self.terms.reads.is_empty() {
            return Ok(false);
        }
        let identity = self.fs.identity(target).map_err(|e| self.describe_failure("", e))?;
        let is_it = |file: &PathBuf| is_named(self.fs, file, target, identity);
        Ok(self.terms.reads.iter().any(is_it))
    }

    fn stamp_of(&self, target: &Path) -> Result<FileStamp> {
        let failed = |e| self.describe_failure("it cannot be compared with what was opened", e);
        FileStamp::read(&mut *self.fs.open(target).map_err(failed)?).map_err(failed)
    }
}
