//! The operations that saving and recovery need from a disk, as a trait, so that failing disks and
//! power cuts can be tested. Floor 5. [`Disk`] is the real one; in a browser it is the page's files.
//! Tests have one in memory that fails, or forgets what was not synced.

#[cfg(not(target_family = "wasm"))]
mod disk;
#[cfg(test)]
pub mod memory;
#[cfg(target_family = "wasm")]
mod page;

#[cfg(not(target_family = "wasm"))]
pub use disk::Disk;
#[cfg(target_family = "wasm")]
pub use page::PageDisk as Disk;

use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A disk. Paths are absolute or relative to the working folder; every error is the system's own.
pub trait Fs: Send + Sync {
    /// A new file for writing; fails if the file exists.
    fn create_new(&self, path: &Path) -> io::Result<Box<dyn FileHandle>>;
    /// A file for reading.
    fn open(&self, path: &Path) -> io::Result<Box<dyn FileHandle>>;
    /// Replaces what is at `to`, all at once.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;
    /// A second name for the same file; fails where `to` exists.
    fn link(&self, from: &Path, to: &Path) -> io::Result<()>;
    /// Removes a file or a link.
    fn remove(&self, path: &Path) -> io::Result<()>;
    /// Returns once the folder's entries are on the disk.
    fn sync_dir(&self, folder: &Path) -> io::Result<()>;
    /// The path with every link resolved; fails where there is nothing.
    fn resolve(&self, path: &Path) -> io::Result<PathBuf>;
    /// What is at a path, without following a link; `None` if there is nothing.
    fn find(&self, path: &Path) -> io::Result<Option<EntryKind>>;
    /// The files of a folder, in the order of their names.
    fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>>;
    /// Makes a folder, and those around it.
    fn create_folder(&self, folder: &Path) -> io::Result<()>;
    /// Gives a file the owner, the group and the permissions of another, as far as the system
    /// allows.
    fn copy_ownership(&self, from: &Path, to: &Path) -> io::Result<()>;
    /// Both files belong to the same user.
    fn is_same_owner(&self, one: &Path, other: &Path) -> io::Result<bool>;
    /// Identity of the file at a path, links followed: the same for each of its names. `None` if
    /// the system cannot say.
    fn identity(&self, path: &Path) -> io::Result<Option<Identity>>;
    /// Nobody, or not this user, may write to the file.
    fn is_read_only(&self, path: &Path) -> io::Result<bool>;
    /// A number that no other process makes or guesses, for a name.
    fn token(&self) -> u64;
    /// Holds a file for as long as the lock and the process live; `None` where another holds it.
    fn lock(&self, path: &Path) -> io::Result<Option<Box<dyn FileLock>>>;
    /// Waits, before something is tried again.
    fn pause(&self, time: Duration);
}

/// An open file.
pub trait FileHandle: Read + Write + Send {
    /// Returns once the file's bytes are on the disk. It is never retried after a failure: the
    /// system may have dropped the bytes.
    fn sync(&mut self) -> io::Result<()>;
    /// Holds the file as long as the handle and the process live; false where another handle holds
    /// it.
    fn hold(&mut self) -> io::Result<bool>;
}

/// Released when it is dropped, and by the system when the process dies for any reason.
pub trait FileLock: Send {}

/// What is at a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EntryKind {
    /// A file.
    File,
    /// A folder.
    Folder,
    /// A symbolic link.
    Link,
    /// A pipe, a device.
    Other,
}

/// Identity of a file, whatever its names are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identity {
    /// The device that it is on.
    pub device: u64,
    /// Its number there.
    pub number: u64,
}
