//! The operations that saving and recovery need from a disk, as a trait, so that failing disks and power cuts can be
//! tested. Floor 5. [`Disk`] is the real one. Tests have one in memory that fails, or forgets what was not synced.

#[cfg(test)]
pub mod memory;

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A disk. Paths are absolute or relative to the working folder; every error is the system's own.
pub trait Fs: Send + Sync {
    /// A new file for writing; fails where there is one already.
    fn create_new(&self, path: &Path) -> io::Result<Box<dyn FileHandle>>;
    /// A file for reading.
    fn open(&self, path: &Path) -> io::Result<Box<dyn FileHandle>>;
    /// Replaces what stands at `to`, all at once.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;
    /// A second name for the same file; fails where `to` exists.
    fn link(&self, from: &Path, to: &Path) -> io::Result<()>;
    fn remove(&self, path: &Path) -> io::Result<()>;
    /// Returns once the folder's entries are on the disk.
    fn sync_dir(&self, folder: &Path) -> io::Result<()>;
    /// The path with every link resolved; fails where there is nothing.
    fn resolve(&self, path: &Path) -> io::Result<PathBuf>;
    /// What is at a path, without following a link; `None` if there is nothing.
    fn found(&self, path: &Path) -> io::Result<Option<EntryKind>>;
    /// The files of a folder, in the order of their names.
    fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>>;
    /// Makes a folder, and those around it.
    fn create_folder(&self, folder: &Path) -> io::Result<()>;
    /// Gives a file the permissions of another.
    fn copy_permissions(&self, from: &Path, to: &Path) -> io::Result<()>;
    /// Holds a file for as long as the lock and the process live; `None` where another holds it.
    fn lock(&self, path: &Path) -> io::Result<Option<Box<dyn FileLock>>>;
    fn pause(&self, time: Duration);
}

/// An open file.
pub trait FileHandle: Read + Write + Send {
    /// Returns once the file's bytes are on the disk. It is never retried after a failure: the system may have dropped
    /// the bytes.
    fn sync(&mut self) -> io::Result<()>;
    /// Holds the file as long as the handle and the process live; false where another handle holds it.
    fn hold(&mut self) -> io::Result<bool>;
}

/// Released when it is dropped, and by the system when the process dies for any reason.
pub trait FileLock: Send {}

/// What stands at a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EntryKind {
    File,
    Folder,
    Link,
    /// A pipe, a device.
    Other,
}

/// The computer's own disk.
pub struct Disk;

impl FileHandle for File {
    fn sync(&mut self) -> io::Result<()> {
        self.sync_all()
    }
    fn hold(&mut self) -> io::Result<bool> {
        match self.try_lock() {
            Ok(()) => Ok(true),
            Err(TryLockError::WouldBlock) => Ok(false),
            Err(TryLockError::Error(e)) => Err(e),
        }
    }
}

impl FileLock for File {}

impl Fs for Disk {
    fn create_new(&self, path: &Path) -> io::Result<Box<dyn FileHandle>> {
        Ok(Box::new(OpenOptions::new().write(true).create_new(true).open(path)?))
    }
    fn open(&self, path: &Path) -> io::Result<Box<dyn FileHandle>> {
        Ok(Box::new(File::open(path)?))
    }
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        std::fs::rename(from, to)
    }
    fn link(&self, from: &Path, to: &Path) -> io::Result<()> {
        std::fs::hard_link(from, to)
    }
    fn remove(&self, path: &Path) -> io::Result<()> {
        std::fs::remove_file(path)
    }
    fn sync_dir(&self, folder: &Path) -> io::Result<()> {
        // Elsewhere a folder cannot be opened, and its entries are written through.
        if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
    }
    fn resolve(&self, path: &Path) -> io::Result<PathBuf> {
        std::fs::canonicalize(path)
    }
    fn found(&self, path: &Path) -> io::Result<Option<EntryKind>> {
        let kind = match std::fs::symlink_metadata(path) {
            Ok(data) => data.file_type(),
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(e) => return Err(e),
        };
        Ok(Some(match kind {
            kind if kind.is_file() => EntryKind::File,
            kind if kind.is_dir() => EntryKind::Folder,
            kind if kind.is_symlink() => EntryKind::Link,
            _ => EntryKind::Other,
        }))
    }
    fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        let entries: io::Result<Vec<_>> = std::fs::read_dir(folder)?.collect();
        let mut paths: Vec<PathBuf> = entries?.into_iter().map(|entry| entry.path()).collect();
        paths.sort();
        Ok(paths)
    }
    fn create_folder(&self, folder: &Path) -> io::Result<()> {
        std::fs::create_dir_all(folder)
    }
    fn copy_permissions(&self, from: &Path, to: &Path) -> io::Result<()> {
        std::fs::set_permissions(to, std::fs::metadata(from)?.permissions())
    }
    fn lock(&self, path: &Path) -> io::Result<Option<Box<dyn FileLock>>> {
        let mut file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
        Ok(if file.hold()? { Some(Box::new(file)) } else { None })
    }
    fn pause(&self, time: Duration) {
        std::thread::sleep(time);
    }
}
