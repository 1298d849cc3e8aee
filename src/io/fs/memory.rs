//! A disk in memory for tests: it can fail at any operation, and lose power at any moment.
//!
//! Power cut, harsher than any real disk: bytes written since a file's last sync may be lost from
//! any point on; of a folder's changes since its last sync any may be missing, each by itself.

mod handles;
mod power;

use super::{EntryKind, FileHandle, FileLock, Fs, Identity};
use handles::{MemoryLock, OpenInode};
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;

#[derive(Clone, Default)]
struct Inode {
    bytes: Vec<u8>,
    /// How many bytes are on the disk for certain.
    synced: Vec<u8>,
}

/// A change of the folder: names and what they lead to afterwards.
type NameChange = Vec<(PathBuf, Option<usize>)>;

#[derive(Clone, Default)]
pub struct DiskState {
    inodes: Vec<Inode>,
    names: BTreeMap<PathBuf, usize>,
    /// Names on the disk for certain, and the changes since.
    synced_names: BTreeMap<PathBuf, usize>,
    pending: Vec<NameChange>,
    locked: BTreeSet<PathBuf>,
    /// Files held by a handle.
    held: BTreeSet<usize>,
    operations: usize,
    has_no_links: bool,
    /// Another user's files, which in a folder where everybody keeps their own nobody else may
    /// rename or remove.
    others: BTreeSet<usize>,
    read_only: BTreeSet<PathBuf>,
    tokens: u64,
    /// Fails the operations of these numbers.
    failing: Option<InjectedFailure>,
    /// The state before every operation, if they are recorded.
    history: Option<Vec<DiskState>>,
}

#[derive(Clone, Copy, Debug)]
pub struct InjectedFailure {
    pub at: usize,
    pub error: InjectedError,
    /// Every later operation fails too.
    pub sticky: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InjectedError {
    Code(i32),
    /// Writes less than requested.
    Short,
}

/// A disk that is shared by its clones.
#[derive(Clone, Default)]
pub struct MemoryFs(Arc<Mutex<DiskState>>);

impl MemoryFs {
    fn state(&self) -> MutexGuard<'_, DiskState> {
        self.0.lock().unwrap()
    }

    /// A disk that has these files for certain.
    pub fn with(files: &[(&str, &[u8])]) -> Self {
        let memory = MemoryFs::default();
        let mut state = memory.state();
        for (name, bytes) in files {
            state.inodes.push(Inode { bytes: bytes.to_vec(), synced: bytes.to_vec() });
            let inode = state.inodes.len() - 1;
            state.names.insert(name.into(), inode);
            state.synced_names.insert(name.into(), inode);
        }
        drop(state);
        memory
    }

    pub fn fail(&self, failure: InjectedFailure) {
        self.state().failing = Some(failure);
    }

    /// From now on a file has one name.
    pub fn refuse_links(&self) {
        self.state().has_no_links = true;
    }

    /// Gives a file to another user.
    pub fn give_away(&self, name: &str) {
        let mut state = self.state();
        let inode = state.names[Path::new(name)];
        state.others.insert(inode);
    }

    pub fn set_read_only(&self, name: &str) {
        self.state().read_only.insert(name.into());
    }

    /// As another process would count that began as this one did.
    pub fn repeat_tokens(&self) {
        self.state().tokens = 0;
    }

    pub fn heal(&self) {
        self.state().failing = None;
    }

    pub fn operations(&self) -> usize {
        self.state().operations
    }

    pub fn record(&self) {
        self.state().history = Some(Vec::new());
    }

    /// The disk as it was before each operation since [`MemoryFs::record`], and as it is.
    pub fn moments(&self) -> Vec<DiskState> {
        let mut state = self.state();
        let mut moments = state.history.take().unwrap_or_default();
        moments.push(state.clone());
        moments
    }

    pub fn file(&self, name: &str) -> Option<Vec<u8>> {
        let state = self.state();
        state.names.get(Path::new(name)).map(|inode| state.inodes[*inode].bytes.clone())
    }

    pub fn names(&self) -> Vec<String> {
        self.state().names.keys().map(|name| name.display().to_string()).collect()
    }

    /// Counts one more operation, which fails if it is its turn.
    fn turn(&self) -> io::Result<Option<InjectedError>> {
        let mut state = self.state();
        let number = state.operations;
        state.operations += 1;
        let before = DiskState { history: None, ..state.clone() };
        if let Some(history) = &mut state.history {
            history.push(before);
        }
        match state.failing {
            Some(f) if f.at == number || (f.sticky && number > f.at) => match f.error {
                InjectedError::Code(code) => Err(io::Error::from_raw_os_error(code)),
                InjectedError::Short => Ok(Some(InjectedError::Short)),
            },
            _ => Ok(None),
        }
    }

    fn handle(&self, inode: usize) -> Box<dyn FileHandle> {
        Box::new(OpenInode { memory: self.clone(), inode, at: 0, holds: false })
    }

    fn inode(&self, path: &Path) -> io::Result<usize> {
        self.state().names.get(path).copied().ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    /// Fails where nobody but a file's owner may take its name away.
    fn may_move(&self, inode: usize) -> io::Result<()> {
        let is_others = self.state().others.contains(&inode);
        if is_others { Err(io::ErrorKind::PermissionDenied.into()) } else { Ok(()) }
    }

    /// Fails where a name is too long for a disk.
    fn may_name(path: &Path) -> io::Result<()> {
        let length = path.file_name().map_or(0, |name| name.len());
        if length > 255 { Err(io::ErrorKind::InvalidFilename.into()) } else { Ok(()) }
    }

    fn change(&self, change: NameChange) {
        let mut state = self.state();
        apply(&mut state.names, &change);
        state.pending.push(change);
    }
}

fn apply(names: &mut BTreeMap<PathBuf, usize>, change: &NameChange) {
    for (name, inode) in change {
        match inode {
            Some(inode) => drop(names.insert(name.clone(), *inode)),
            None => drop(names.remove(name)),
        }
    }
}

impl Fs for MemoryFs {
    fn create_new(&self, path: &Path) -> io::Result<Box<dyn FileHandle>> {
        self.turn()?;
        Self::may_name(path)?;
        if self.inode(path).is_ok() {
            return Err(io::ErrorKind::AlreadyExists.into());
        }
        let inode = {
            let mut state = self.state();
            state.inodes.push(Inode::default());
            state.inodes.len() - 1
        };
        self.change(vec![(path.into(), Some(inode))]);
        Ok(self.handle(inode))
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn FileHandle>> {
        self.turn()?;
        Ok(self.handle(self.inode(path)?))
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.turn()?;
        Self::may_name(to)?;
        let inode = self.inode(from)?;
        self.may_move(inode)?;
        self.inode(to).map_or(Ok(()), |inode| self.may_move(inode))?;
        if self.inode(to).is_ok_and(|there| there == inode) {
            // Two names of one file are left unchanged.
            return Ok(());
        }
        self.change(vec![(from.into(), None), (to.into(), Some(inode))]);
        Ok(())
    }

    fn link(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.turn()?;
        if self.state().has_no_links {
            return Err(io::ErrorKind::PermissionDenied.into());
        }
        Self::may_name(to)?;
        if self.inode(to).is_ok() {
            return Err(io::ErrorKind::AlreadyExists.into());
        }
        let inode = self.inode(from)?;
        self.change(vec![(to.into(), Some(inode))]);
        Ok(())
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.turn()?;
        let inode = self.inode(path)?;
        self.may_move(inode)?;
        self.change(vec![(path.into(), None)]);
        Ok(())
    }

    fn sync_dir(&self, folder: &Path) -> io::Result<()> {
        self.turn()?;
        let mut state = self.state();
        let (synced, kept): (Vec<NameChange>, Vec<NameChange>) = std::mem::take(&mut state.pending)
            .into_iter()
            .partition(|c| c.iter().all(|(p, _)| p.parent() == Some(folder)));
        synced.iter().for_each(|change| apply(&mut state.synced_names, change));
        state.pending = kept;
        Ok(())
    }

    fn resolve(&self, path: &Path) -> io::Result<PathBuf> {
        self.turn()?;
        let is_folder = self.state().names.keys().any(|name| name.parent() == Some(path));
        if is_folder || path == Path::new("/") {
            return Ok(path.into());
        }
        self.inode(path).map(|_| path.into())
    }

    fn find(&self, path: &Path) -> io::Result<Option<EntryKind>> {
        self.turn()?;
        let is_folder =
            self.state().names.keys().any(|name| name != path && name.starts_with(path));
        Ok(if is_folder {
            Some(EntryKind::Folder)
        } else {
            self.inode(path).ok().map(|_| EntryKind::File)
        })
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        self.turn()?;
        Ok(self
            .state()
            .names
            .keys()
            .filter(|name| name.parent() == Some(folder))
            .cloned()
            .collect())
    }

    fn create_folder(&self, _: &Path) -> io::Result<()> {
        self.turn().map(drop)
    }

    fn copy_ownership(&self, _: &Path, _: &Path) -> io::Result<()> {
        self.turn().map(drop)
    }

    fn is_same_owner(&self, one: &Path, other: &Path) -> io::Result<bool> {
        self.turn()?;
        let [one, other] = [self.inode(one)?, self.inode(other)?];
        let state = self.state();
        Ok(state.others.contains(&one) == state.others.contains(&other))
    }

    fn identity(&self, path: &Path) -> io::Result<Option<Identity>> {
        self.turn()?;
        self.inode(path).map(|inode| Some(Identity { device: 0, number: inode as u64 }))
    }

    fn is_read_only(&self, path: &Path) -> io::Result<bool> {
        self.turn()?;
        self.inode(path)?;
        Ok(self.state().read_only.contains(path))
    }

    fn token(&self) -> u64 {
        let mut state = self.state();
        state.tokens += 1;
        state.tokens
    }

    fn lock(&self, path: &Path) -> io::Result<Option<Box<dyn FileLock>>> {
        self.turn()?;
        let is_free = self.state().locked.insert(path.into());
        Ok(if is_free { Some(Box::new(MemoryLock(self.clone(), path.into()))) } else { None })
    }

    fn pause(&self, _: Duration) {}
}
