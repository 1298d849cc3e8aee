//! The files of a browser's page as a disk. Floor 5.

use super::{EntryKind, FileHandle, FileLock, Fs, Identity};
use crate::platform::{self, DOCUMENTS, files, files::File};
use std::hash::{BuildHasher, RandomState};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// The one that every part of the program sees.
pub struct PageDisk;

impl FileHandle for File {
    fn sync(&mut self) -> io::Result<()> {
        self.sync_all()
    }

    fn hold(&mut self) -> io::Result<bool> {
        Ok(self.try_hold())
    }
}

impl FileLock for File {}

impl Fs for PageDisk {
    fn create_new(&self, path: &Path) -> io::Result<Box<dyn FileHandle>> {
        Ok(Box::new(File::create_new(path)?))
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn FileHandle>> {
        Ok(Box::new(File::open(path)?))
    }

    /// A file that is complete now (`io::replace`) is handed to the user, if it is one of his.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        files::rename(from, to)?;
        let is_complete = from.extension().is_some_and(|extension| extension == "part");
        if is_complete && to.starts_with(DOCUMENTS) {
            platform::hand_out(to, &files::read(to)?);
        }
        Ok(())
    }

    fn link(&self, _: &Path, _: &Path) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        files::remove_file(path)
    }

    fn sync_dir(&self, _: &Path) -> io::Result<()> {
        Ok(())
    }

    fn resolve(&self, path: &Path) -> io::Result<PathBuf> {
        files::canonicalize(path)
    }

    fn find(&self, path: &Path) -> io::Result<Option<EntryKind>> {
        let found = files::metadata(path).ok();
        Ok(found.map(|found| if found.is_dir() { EntryKind::Folder } else { EntryKind::File }))
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        files::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path())).collect()
    }

    fn create_folder(&self, folder: &Path) -> io::Result<()> {
        files::create_dir_all(folder)
    }

    fn copy_ownership(&self, _: &Path, _: &Path) -> io::Result<()> {
        Ok(())
    }

    fn is_same_owner(&self, _: &Path, _: &Path) -> io::Result<bool> {
        Ok(true)
    }

    fn identity(&self, _: &Path) -> io::Result<Option<Identity>> {
        Ok(None)
    }

    fn is_read_only(&self, path: &Path) -> io::Result<bool> {
        files::metadata(path).map(|_| false)
    }

    fn token(&self) -> u64 {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        RandomState::new().hash_one((count, platform::process_id(), platform::SystemTime::now()))
    }

    fn lock(&self, path: &Path) -> io::Result<Option<Box<dyn FileLock>>> {
        let mut file = match File::create_new(path) {
            Err(e) if e.kind() == io::ErrorKind::AlreadyExists => File::open(path)?,
            made => made?,
        };
        Ok(if file.try_hold() { Some(Box::new(file)) } else { None })
    }

    fn pause(&self, time: Duration) {
        platform::sleep(time);
    }
}
