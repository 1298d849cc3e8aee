//! Replaces a file: all or nothing, read back and compared before it counts. Projects, exports,
//! brushes and settings are all written this way. Floor 5. Every step prevents a loss that somebody
//! had (docs/PROJECTS.md). Not here: the bytes themselves.

mod part;
mod previous;
mod target;

use crate::document::Progress;
use crate::fs::{FileHandle, Fs};
use crate::{Error, Result};
use part::PartFile;
pub use part::sweep;
use previous::Previous;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;
pub use target::{check, is_same_file};

/// Bytes written or compared between two looks at whether the file is still wanted.
const CHUNK: usize = 1 << 20;
/// Programs that synchronize folders hold a file for some milliseconds; waited for, twice as long
/// each time.
const RENAME_TRIES: u32 = 6;
const FIRST_PAUSE: Duration = Duration::from_millis(10);

/// What a file held when it was last read or written here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileStamp {
    pub(crate) bytes: u64,
    pub(crate) crc: u32,
}

impl FileStamp {
    /// The stamp of these bytes.
    pub fn of(bytes: &[u8]) -> Self {
        Self { bytes: bytes.len() as u64, crc: crc32fast::hash(bytes) }
    }

    /// The stamp of a file, read piece by piece.
    pub(crate) fn read(handle: &mut dyn FileHandle) -> io::Result<Self> {
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

/// What may be replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overwrite {
    /// Nothing: no file of that name may exist, up to the moment when it is created.
    Nothing,
    /// The file as it was when it was opened or last saved; another program's change is not
    /// overwritten.
    This(FileStamp),
    /// Whatever is there, unless it is set read-only: the user agreed to lose what has this name.
    Anything,
    /// Whatever is there: the user was warned and insists.
    Forced,
}

/// On what terms a file is written.
#[derive(Clone, Debug)]
pub struct Terms {
    /// What it may replace.
    pub over: Overwrite,
    /// The old file is kept next to it as `name~`.
    pub keeps_previous: bool,
    /// Never overwritten, whatever else is allowed: the files that the document was made from.
    pub reads: Vec<PathBuf>,
}

impl Terms {
    /// For what can be made again, such as an exported picture: no previous version is kept.
    pub fn export(over: Overwrite, reads: Vec<PathBuf>) -> Self {
        Self { over, keeps_previous: false, reads }
    }
}

/// For a document itself: the previous version is kept.
impl From<Overwrite> for Terms {
    fn from(over: Overwrite) -> Self {
        Self { over, keeps_previous: true, reads: Vec::new() }
    }
}

/// Replaces a file by bytes with the mechanism of docs/PROJECTS.md; true if it was done, false if
/// canceled.
///
/// Fails with [`Error::Changed`] if `terms` do not allow the replacement. Whatever fails, the old
/// file is unchanged.
pub fn replace(
    fs: &dyn Fs,
    file: &Path,
    bytes: &[u8],
    terms: &Terms,
    progress: &Progress,
) -> Result<bool> {
    ReplaceJob { fs, named: file, bytes, terms, progress }.run()
}

struct ReplaceJob<'a> {
    fs: &'a dyn Fs,
    /// As the user named it, for messages.
    named: &'a Path,
    bytes: &'a [u8],
    terms: &'a Terms,
    progress: &'a Progress,
}

impl ReplaceJob<'_> {
    /// Whether it was done, and not canceled.
    fn run(&self) -> Result<bool> {
        let target = self.target()?;
        self.check_allowed(&target)?;
        sweep(self.fs, folder_of(&target));
        let failed =
            |e| self.describe_failure("it could not be written there; choose another folder", e);
        let mut part = PartFile::create(self.fs, folder_of(&target)).map_err(failed)?;
        let placed = self.write_part(&mut part, &target).and_then(|is_written| {
            if is_written {
                self.place(&part, &target)?;
            }
            Ok(is_written)
        });
        if !matches!(placed, Ok(true)) {
            // The unfinished file is removed; if even that fails, the first failure is reported.
            let _ = self.fs.remove(&part.path);
            return placed;
        }
        self.flush_folder(&target)?;
        Ok(true)
    }

    /// Writes the new file under another name and verifies it; false if canceled meanwhile.
    fn write_part(&self, part: &mut PartFile, target: &Path) -> Result<bool> {
        let chunks = self.bytes.len().div_ceil(CHUNK) as u64;
        self.progress.add_total(2 * chunks);
        let failed =
            |e| self.describe_failure("it could not be written there; choose another folder", e);
        if self.fs.find(target).map_err(failed)?.is_some() {
            // Before there is anything to read in it. A disk without owners and permissions must
            // not keep anybody from saving.
            let _ = self.fs.copy_ownership(target, &part.path);
        }
        for chunk in self.bytes.chunks(CHUNK) {
            if self.progress.is_canceled() {
                return Ok(false);
            }
            part.handle.write_all(chunk).map_err(failed)?;
            self.progress.step();
        }
        part.handle.sync().map_err(failed)?;
        self.compare(&part.path)
    }

    /// The written file is read back.
    fn compare(&self, part: &Path) -> Result<bool> {
        let failed = |e| {
            self.describe_failure(
                "what was written could not be read back; choose another folder",
                e,
            )
        };
        let differs =
            || failed(io::Error::new(ErrorKind::InvalidData, "the disk returned different bytes"));
        let mut handle = self.fs.open(part).map_err(failed)?;
        let mut buffer = vec![0; CHUNK];
        let mut rest = self.bytes;
        loop {
            if self.progress.is_canceled() {
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

    /// Keeps the old file, where that is wanted, and puts the new one in its place.
    fn place(&self, part: &PartFile, target: &Path) -> Result<()> {
        self.check_allowed(target)?;
        if self.terms.over == Overwrite::Nothing && self.link_new(part, target)? {
            return Ok(());
        }
        let is_kept = self.terms.keeps_previous
            && self.fs.find(target).map_err(|e| self.describe_failure("", e))?.is_some();
        let previous = is_kept.then(|| Previous::keep(self.fs, part, target)).transpose();
        let previous = previous.map_err(|e| {
            self.describe_failure("the previous version could not be kept next to it", e)
        })?;
        let renamed = self.rename(part, target);
        if let Some(previous) = previous {
            if renamed.is_ok() { previous.forget(self.fs) } else { previous.undo(self.fs) }
        }
        renamed
    }

    /// Puts the new file in the old one's place.
    fn rename(&self, part: &PartFile, target: &Path) -> Result<()> {
        rename_patiently(self.fs, &part.path, target)
            .map_err(|e| self.describe_failure("the old file could not be replaced", e))
    }

    /// Gives the new file its name if no file has it: of two programs that do so at once, one
    /// fails. False if the disk has no hard links.
    fn link_new(&self, part: &PartFile, target: &Path) -> Result<bool> {
        match self.fs.link(&part.path, target) {
            Ok(()) => {
                // The other name is in nobody's way: the next sweep takes it.
                let _ = self.fs.remove(&part.path);
                Ok(true)
            }
            Err(e) if e.kind() == ErrorKind::AlreadyExists => Err(self.name_taken_error()),
            Err(_) => Ok(false),
        }
    }

    /// Without this a power cut brings the old file back.
    fn flush_folder(&self, target: &Path) -> Result<()> {
        match self.fs.sync_dir(folder_of(target)) {
            // Some disks cannot; they have no later moment either.
            Err(e) if !matches!(e.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => {
                Err(self
                    .describe_failure("the file was written, but may be lost in a power cut", e))
            }
            _ => Ok(()),
        }
    }

    fn describe_failure(&self, what: &str, error: io::Error) -> Error {
        if what.is_empty() {
            return Error::io(self.named, error);
        }
        Error::io(self.named, io::Error::new(error.kind(), format!("{what} ({error})")))
    }
}

/// Renames a file, and tries again for a third of a second where another program holds one of the
/// two.
fn rename_patiently(fs: &dyn Fs, from: &Path, to: &Path) -> io::Result<()> {
    let mut pause = FIRST_PAUSE;
    for _ in 1..RENAME_TRIES {
        match fs.rename(from, to) {
            Err(e) if matches!(e.kind(), ErrorKind::PermissionDenied | ErrorKind::ResourceBusy) => {
                fs.pause(pause);
                pause *= 2;
            }
            done => return done,
        }
    }
    fs.rename(from, to)
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

pub(crate) fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

#[cfg(test)]
mod tests;
