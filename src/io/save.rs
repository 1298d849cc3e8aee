//! Saving a document: all or nothing, read back and compared before it counts, the previous version kept.
//! Floor 5. `project` makes the bytes. Every step prevents a loss that has happened to somebody (docs/PROJECTS.md).

mod part;

use super::fs::{Disk, EntryKind, FileHandle, Fs};
use super::project;
use crate::document::{Document, Progress};
use crate::{Error, Result};
use part::{PartFile, SPARE, sweep};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Bytes written or compared between two checks for cancellation.
const CHUNK: usize = 1 << 20;
/// Synchronisation programs lock files for some milliseconds: the pause before a retry, doubled each time.
const RENAME_TRIES: u32 = 6;
const FIRST_PAUSE: Duration = Duration::from_millis(10);

/// The state of a file when it was last read or written here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileStamp {
    pub(super) bytes: u64,
    pub(super) crc: u32,
}

impl FileStamp {
    pub fn of(bytes: &[u8]) -> Self {
        Self { bytes: bytes.len() as u64, crc: crc32fast::hash(bytes) }
    }
    /// Of a file, piece by piece.
    pub(super) fn read(handle: &mut dyn FileHandle) -> io::Result<Self> {
        let (mut buffer, mut hasher, mut bytes) = (vec![0; CHUNK], crc32fast::Hasher::new(), 0);
        loop {
            let n = read_some(handle, &mut buffer)?;
            if n == 0 {
                return Ok(Self { bytes, crc: hasher.finalize() });
            }
            hasher.update(&buffer[..n]);
            bytes += n as u64;
        }
    }
}

/// What a save may replace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overwrite {
    /// Nothing: there must be no file of that name yet.
    Nothing,
    /// Only the file as it was when opened or last saved; another program's change is not overwritten.
    This(FileStamp),
    /// Whatever is there: the user agreed.
    Anything,
}

/// A document on the disk.
#[derive(Clone, Copy, Debug)]
pub struct SavedDocument {
    /// For the next save.
    pub stamp: FileStamp,
}

/// Saves a document as a project; `None` if cancelled, and then nothing has changed.
///
/// Works on a clone, from any thread; it works in threads of its own, so that a brush never waits for it. Returns once
/// the file and its folder are on the disk. The previous version is kept beside it as `name~`. Fails with
/// [`Error::Changed`] where `over` does not allow what would be replaced; whatever fails, the old file is as it was.
pub fn save(document: &Document, file: &Path, over: Overwrite, progress: &Progress) -> Result<Option<SavedDocument>> {
    let encoded = in_own_threads(file, || project::write(file, document, progress))??;
    let Some(bytes) = encoded else { return Ok(None) };
    replace(&Disk, file, &bytes, over, progress)
}

/// Removes what killed saves left beside a file; failures are left to the next save.
pub fn tidy(file: &Path) {
    sweep(&Disk, folder_of(file));
}

/// Uses half the processors: the other half is for painting meanwhile.
fn in_own_threads<T: Send>(file: &Path, work: impl FnOnce() -> T + Send) -> Result<T> {
    let threads = (rayon::current_num_threads() / 2).max(1);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|e| Error::io(file, io::Error::other(e)))?.install(work))
}

/// Puts bytes in a file's place by the mechanism of docs/PROJECTS.md; `None` if cancelled.
pub fn replace(
    fs: &dyn Fs,
    file: &Path,
    bytes: &[u8],
    over: Overwrite,
    progress: &Progress,
) -> Result<Option<SavedDocument>> {
    let saving = SaveJob { fs, named: file, bytes, over, progress };
    saving.run().map(|done| done.then(|| SavedDocument { stamp: FileStamp::of(bytes) }))
}

struct SaveJob<'a> {
    fs: &'a dyn Fs,
    /// As the user named it, for messages.
    named: &'a Path,
    bytes: &'a [u8],
    over: Overwrite,
    progress: &'a Progress,
}

impl SaveJob<'_> {
    /// Whether it was done, and not cancelled.
    fn run(&self) -> Result<bool> {
        let target = self.target()?;
        self.check(&target)?;
        sweep(self.fs, folder_of(&target));
        let failed = |e| self.failed("the drawing could not be written there; choose another place", e);
        let mut part = PartFile::create(self.fs, folder_of(&target)).map_err(failed)?;
        let placed = self.write_part(&mut part, &target).and_then(|is_written| {
            if is_written {
                self.place(&part, &target)?;
            }
            Ok(is_written)
        });
        if !matches!(placed, Ok(true)) {
            // The partial file is removed; if that fails too, the first failure is reported.
            let _ = self.fs.remove(&part.path);
            return placed;
        }
        self.flush_folder(&target)?;
        Ok(true)
    }
    /// The file itself: where a link leads to, not the link.
    fn target(&self) -> Result<PathBuf> {
        let io = |e| self.failed("", e);
        match self.fs.found(self.named).map_err(io)? {
            Some(EntryKind::File) | Some(EntryKind::Link) => {
                let target = self.fs.resolve(self.named);
                let target = target.map_err(|e| self.failed("it is a link that leads nowhere", e))?;
                match self.fs.found(&target).map_err(io)? {
                    Some(EntryKind::File) => Ok(target),
                    _ => Err(Error::unsupported(self.named, "it is not a regular file, so it cannot be replaced")),
                }
            }
            Some(EntryKind::Folder) => Err(Error::unsupported(self.named, "it is a folder")),
            Some(EntryKind::Other) => {
                Err(Error::unsupported(self.named, "it is not a regular file, so it cannot be replaced"))
            }
            None => {
                let name = self.named.file_name().ok_or_else(|| Error::unsupported(self.named, "it has no name"))?;
                let folder = self.fs.resolve(folder_of(self.named));
                Ok(folder.map_err(|e| self.failed("its folder cannot be reached", e))?.join(name))
            }
        }
    }
    /// Checks that the existing file may be replaced.
    fn check(&self, target: &Path) -> Result<()> {
        let changed = |reason: &str| Err(Error::Changed { file: self.named.into(), reason: reason.into() });
        let is_there = self.fs.found(target).map_err(|e| self.failed("", e))?.is_some();
        match self.over {
            Overwrite::Nothing if is_there => changed("there is a file of this name already"),
            // A deleted file has no changes to lose.
            Overwrite::This(stamp) if is_there && self.stamp_of(target)? != stamp => {
                changed("another program changed it since it was opened")
            }
            _ => Ok(()),
        }
    }
    fn stamp_of(&self, target: &Path) -> Result<FileStamp> {
        let failed = |e| self.failed("it cannot be compared with what was opened", e);
        FileStamp::read(&mut *self.fs.open(target).map_err(failed)?).map_err(failed)
    }
    /// Writes the new file under another name and makes sure of it; whether it was not cancelled meanwhile.
    fn write_part(&self, part: &mut PartFile, target: &Path) -> Result<bool> {
        let chunks = self.bytes.len().div_ceil(CHUNK) as u64;
        self.progress.add_total(2 * chunks);
        let failed = |e| self.failed("the drawing could not be written there; choose another place", e);
        for chunk in self.bytes.chunks(CHUNK) {
            if self.progress.is_cancelled() {
                return Ok(false);
            }
            part.handle.write_all(chunk).map_err(failed)?;
            self.progress.step();
        }
        if self.fs.found(target).map_err(failed)?.is_some() {
            // A disk without permissions must not prevent saving.
            let _ = self.fs.copy_permissions(target, &part.path);
        }
        part.handle.sync().map_err(failed)?;
        self.compare(&part.path)
    }
    /// What was written is read back.
    fn compare(&self, part: &Path) -> Result<bool> {
        let failed = |e| self.failed("what was written could not be read back; choose another place", e);
        let differs = || failed(io::Error::new(ErrorKind::InvalidData, "the disk gave back other bytes"));
        let mut handle = self.fs.open(part).map_err(failed)?;
        let mut buffer = vec![0; CHUNK];
        let mut rest = self.bytes;
        loop {
            if self.progress.is_cancelled() {
                return Ok(false);
            }
            let n = read_some(&mut *handle, &mut buffer).map_err(failed)?;
            let Some((same, after)) = rest.split_at_checked(n) else { return Err(differs()) };
            if same != &buffer[..n] {
                return Err(differs());
            }
            if n == 0 {
                return if rest.is_empty() { Ok(true) } else { Err(differs()) };
            }
            rest = after;
            self.progress.step();
        }
    }
    /// Keeps the old file as `name~` and puts the new one in its place.
    fn place(&self, part: &PartFile, target: &Path) -> Result<()> {
        self.check(target)?;
        if self.fs.found(target).map_err(|e| self.failed("", e))?.is_some() {
            self.keep(part, target).map_err(|e| self.failed("the previous version could not be kept beside it", e))?;
        }
        let mut pause = FIRST_PAUSE;
        for last in (0..RENAME_TRIES).rev() {
            match self.fs.rename(&part.path, target) {
                Ok(()) => return Ok(()),
                Err(e) if last > 0 && matches!(e.kind(), ErrorKind::PermissionDenied | ErrorKind::ResourceBusy) => {
                    self.fs.pause(pause);
                    pause *= 2;
                }
                Err(e) => return Err(self.failed("the old file could not be replaced", e)),
            }
        }
        Ok(())
    }
    /// The old file as `name~`: a hard link if the disk supports it, else a copy. There is never a moment without it.
    fn keep(&self, part: &PartFile, target: &Path) -> io::Result<()> {
        let spare = part.path.with_extension(SPARE);
        if self.fs.link(target, &spare).is_err() {
            let copied = self.copy(target, &spare);
            if copied.is_err() {
                let _ = self.fs.remove(&spare);
            }
            copied?;
        }
        let mut name = target.as_os_str().to_owned();
        name.push("~");
        let renamed = self.fs.rename(&spare, Path::new(&name));
        if renamed.is_err() {
            let _ = self.fs.remove(&spare);
        }
        renamed
    }
    fn copy(&self, from: &Path, to: &Path) -> io::Result<()> {
        let (mut source, mut copy) = (self.fs.open(from)?, self.fs.create_new(to)?);
        io::copy(&mut source, &mut copy)?;
        copy.sync()
    }
    /// Without this a power cut brings the old file back.
    fn flush_folder(&self, target: &Path) -> Result<()> {
        match self.fs.sync_dir(folder_of(target)) {
            // Some disks cannot flush folders; nothing more can be done there.
            Err(e) if !matches!(e.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => {
                Err(self.failed("the file was written, but whether it stays after a power cut is unknown", e))
            }
            _ => Ok(()),
        }
    }
    fn failed(&self, what: &str, error: io::Error) -> Error {
        if what.is_empty() {
            return Error::io(self.named, error);
        }
        Error::io(self.named, io::Error::new(error.kind(), format!("{what} ({error})")))
    }
}

/// Reads until the buffer is full or the file ends.
fn read_some(handle: &mut dyn FileHandle, buffer: &mut [u8]) -> io::Result<usize> {
    let mut filled = 0;
    while filled < buffer.len() {
        match handle.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(n) => filled += n,
            Err(e) if e.kind() == ErrorKind::Interrupted => {}
            Err(e) => return Err(e),
        }
    }
    Ok(filled)
}

fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

#[cfg(test)]
mod tests;
