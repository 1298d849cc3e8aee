//! The computer's own disk.
//! Floor 5.

#[cfg(windows)]
mod windows;

use super::{EntryKind, FileHandle, FileLock, Fs, Identity};
use std::fs::{File, OpenOptions};
use std::hash::{BuildHasher, RandomState};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// The real one.
pub struct Disk;

impl FileHandle for File {
    fn sync(&mut self) -> io::Result<()> {
        self.sync_all()
    }

    #[cfg(not(windows))]
    fn hold(&mut self) -> io::Result<bool> {
        use std::fs::TryLockError;
        match self.try_lock() {
            Ok(()) => Ok(true),
            Err(TryLockError::WouldBlock) => Ok(false),
            Err(TryLockError::Error(e)) => Err(e),
        }
    }

    #[cfg(windows)]
    fn hold(&mut self) -> io::Result<bool> {
        windows::hold(self)
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

    #[cfg(not(windows))]
    fn link(&self, from: &Path, to: &Path) -> io::Result<()> {
        std::fs::hard_link(from, to)
    }

    /// A second name of a file that another program keeps from being removed would stay.
    #[cfg(windows)]
    fn link(&self, from: &Path, to: &Path) -> io::Result<()> {
        windows::check_removable(from)?;
        std::fs::hard_link(from, to)
    }

    #[cfg(not(windows))]
    fn remove(&self, path: &Path) -> io::Result<()> {
        std::fs::remove_file(path)
    }

    #[cfg(windows)]
    fn remove(&self, path: &Path) -> io::Result<()> {
        windows::remove(path)
    }

    fn sync_dir(&self, folder: &Path) -> io::Result<()> {
        // Elsewhere a folder cannot be opened, and its entries are written through.
        if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
    }

    #[cfg(not(windows))]
    fn resolve(&self, path: &Path) -> io::Result<PathBuf> {
        std::fs::canonicalize(path)
    }

    /// Some drives, such as those in memory, cannot say where a path leads; without a link at its end
    /// it is taken as it is.
    #[cfg(windows)]
    fn resolve(&self, path: &Path) -> io::Result<PathBuf> {
        std::fs::canonicalize(path).or_else(|refused| match refused.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::PermissionDenied => Err(refused),
            _ if std::fs::symlink_metadata(path)?.is_symlink() => Err(refused),
            _ => std::path::absolute(path),
        })
    }

    fn find(&self, path: &Path) -> io::Result<Option<EntryKind>> {
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

    fn copy_ownership(&self, from: &Path, to: &Path) -> io::Result<()> {
        ownership::copy(from, to)
    }

    fn is_same_owner(&self, one: &Path, other: &Path) -> io::Result<bool> {
        ownership::is_same(one, other)
    }

    fn identity(&self, path: &Path) -> io::Result<Option<Identity>> {
        ownership::identity(path)
    }

    fn is_read_only(&self, path: &Path) -> io::Result<bool> {
        if std::fs::metadata(path)?.permissions().readonly() {
            return Ok(true);
        }
        // For somebody else's file, or one that the system guards, only trying shows it.
        let tried = OpenOptions::new().write(true).open(path);
        Ok(tried.is_err_and(|e| e.kind() == io::ErrorKind::PermissionDenied))
    }

    fn token(&self) -> u64 {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        // A hasher's keys come from the system's own randomness.
        RandomState::new()
            .hash_one((COUNT.fetch_add(1, Ordering::Relaxed), std::time::SystemTime::now()))
    }

    fn lock(&self, path: &Path) -> io::Result<Option<Box<dyn FileLock>>> {
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
        Ok(if file.hold()? { Some(Box::new(file)) } else { None })
    }

    fn pause(&self, time: Duration) {
        std::thread::sleep(time);
    }
}

#[cfg(unix)]
mod ownership {
    use super::Identity;
    use std::fs::{Permissions, metadata, set_permissions};
    use std::io;
    use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};
    use std::path::Path;

    /// Permission bits, without those that let a program run as another user.
    const RIGHTS: u32 = 0o777;
    const GROUP: u32 = 0o070;

    pub fn copy(from: &Path, to: &Path) -> io::Result<()> {
        let (old, new) = (metadata(from)?, metadata(to)?);
        // Only root gives a file away; whoever may not keeps it.
        let has_owner = old.uid() == new.uid() || chown(to, Some(old.uid()), None).is_ok();
        let has_group = old.gid() == new.gid() || chown(to, None, Some(old.gid())).is_ok();
        let rights = old.mode() & RIGHTS;
        // A different group gets no more than everybody; a different owner keeps what is needed to
        // read back the file.
        let rights = if has_group { rights } else { rights & !GROUP | (rights & 0o007) << 3 };
        set_permissions(to, Permissions::from_mode(if has_owner { rights } else { rights | 0o400 }))
    }

    pub fn is_same(one: &Path, other: &Path) -> io::Result<bool> {
        Ok(metadata(one)?.uid() == metadata(other)?.uid())
    }

    pub fn identity(path: &Path) -> io::Result<Option<Identity>> {
        let found = metadata(path)?;
        Ok(Some(Identity { device: found.dev(), number: found.ino() }))
    }
}

#[cfg(not(unix))]
mod ownership {
    use super::Identity;
    use std::fs::{metadata, set_permissions};
    use std::io;
    use std::path::Path;

    pub fn copy(from: &Path, to: &Path) -> io::Result<()> {
        set_permissions(to, metadata(from)?.permissions())
    }

    /// Folders there do not keep everybody to their own files.
    pub fn is_same(_: &Path, _: &Path) -> io::Result<bool> {
        Ok(true)
    }

    #[cfg(windows)]
    pub fn identity(path: &Path) -> io::Result<Option<Identity>> {
        super::windows::identity(path).map(Some)
    }

    /// Only the resolved paths can be compared.
    #[cfg(not(windows))]
    pub fn identity(_: &Path) -> io::Result<Option<Identity>> {
        Ok(None)
    }
}
