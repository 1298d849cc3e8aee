//! The files of a page: a tree in memory, with the functions that the program uses of `std::fs`.
//! Floor 5. What is below [`HOME`](super::HOME) is stored by the page.

use super::{HOME, host};
use std::collections::BTreeMap;
use std::io::{self, Error, ErrorKind, Read, Result, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The bytes of a file; all of its names lead to them.
#[derive(Default)]
struct FileBody {
    /// Its last name: a handle stays valid when the file is renamed.
    path: PathBuf,
    bytes: Vec<u8>,
    /// How many of them the page stored.
    stored: usize,
    /// A handle holds it.
    is_held: bool,
}

type SharedBody = Arc<Mutex<FileBody>>;

#[derive(Clone)]
enum Node {
    Folder,
    File(SharedBody),
}

type Tree = BTreeMap<PathBuf, Node>;

static TREE: Mutex<Tree> = Mutex::new(BTreeMap::new());

fn tree() -> MutexGuard<'static, Tree> {
    TREE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn lock(body: &SharedBody) -> MutexGuard<'_, FileBody> {
    body.lock().unwrap_or_else(PoisonError::into_inner)
}

fn missing() -> Error {
    Error::new(ErrorKind::NotFound, "there is no such file or folder")
}

/// The path from the root, without `.` and `..`.
pub fn canonicalize(path: &Path) -> Result<PathBuf> {
    let path = plain(path);
    if is_root(&path) || tree().contains_key(&path) { Ok(path) } else { Err(missing()) }
}

fn plain(path: &Path) -> PathBuf {
    use std::path::Component;
    let mut plain = PathBuf::from("/");
    for part in path.components() {
        match part {
            Component::Normal(name) => plain.push(name),
            Component::ParentDir => {
                plain.pop();
            }
            _ => {}
        }
    }
    plain
}

fn is_root(path: &Path) -> bool {
    path.parent().is_none()
}

fn is_stored(path: &Path) -> bool {
    path.starts_with(HOME)
}

fn find(path: &Path) -> Option<Node> {
    let path = plain(path);
    if is_root(&path) { Some(Node::Folder) } else { tree().get(&path).cloned() }
}

fn file_at(path: &Path) -> Result<SharedBody> {
    match find(path) {
        Some(Node::File(body)) => Ok(body),
        Some(Node::Folder) => Err(Error::new(ErrorKind::IsADirectory, "it is a folder")),
        None => Err(missing()),
    }
}

/// What is known of a file or a folder.
#[derive(Clone, Copy, Debug)]
pub struct Metadata {
    bytes: u64,
    is_file: bool,
}

impl Metadata {
    /// Bytes of a file.
    #[allow(clippy::len_without_is_empty)] // As the standard library has it.
    pub fn len(&self) -> u64 {
        self.bytes
    }

    /// Whether it is a file.
    pub fn is_file(&self) -> bool {
        self.is_file
    }

    /// Whether it is a folder.
    pub fn is_dir(&self) -> bool {
        !self.is_file
    }

    /// There are no links here.
    pub fn is_symlink(&self) -> bool {
        false
    }
}

/// What is at a path.
pub fn metadata(path: impl AsRef<Path>) -> Result<Metadata> {
    Ok(match find(path.as_ref()).ok_or_else(missing)? {
        Node::Folder => Metadata { bytes: 0, is_file: false },
        Node::File(body) => Metadata { bytes: lock(&body).bytes.len() as u64, is_file: true },
    })
}

/// The same: there are no links here.
pub fn symlink_metadata(path: impl AsRef<Path>) -> Result<Metadata> {
    metadata(path)
}

/// All bytes of a file.
pub fn read(path: impl AsRef<Path>) -> Result<Vec<u8>> {
    Ok(lock(&file_at(path.as_ref())?).bytes.clone())
}

/// Makes a folder, and those around it.
pub fn create_dir_all(path: impl AsRef<Path>) -> Result<()> {
    let path = plain(path.as_ref());
    let mut tree = tree();
    for folder in path.ancestors().filter(|folder| !is_root(folder)) {
        tree.entry(folder.into()).or_insert(Node::Folder);
    }
    Ok(())
}

/// An entry of a folder.
#[derive(Clone, Debug)]
pub struct DirEntry(PathBuf);

impl DirEntry {
    /// Its path.
    pub fn path(&self) -> PathBuf {
        self.0.clone()
    }

    /// Its name.
    pub fn file_name(&self) -> std::ffi::OsString {
        self.0.file_name().unwrap_or_default().into()
    }
}

/// What is in a folder, in the order of the names.
pub fn read_dir(folder: impl AsRef<Path>) -> Result<impl Iterator<Item = Result<DirEntry>>> {
    let folder = plain(folder.as_ref());
    if !metadata(&folder)?.is_dir() {
        return Err(Error::new(ErrorKind::NotADirectory, "it is not a folder"));
    }
    let tree = tree();
    let within = tree.keys().filter(|path| path.parent() == Some(&folder));
    Ok(within.cloned().map(|path| Ok(DirEntry(path))).collect::<Vec<_>>().into_iter())
}

/// Removes a file.
pub fn remove_file(path: impl AsRef<Path>) -> Result<()> {
    file_at(path.as_ref())?;
    let path = plain(path.as_ref());
    tree().remove(&path);
    if is_stored(&path) {
        host::remove(&path.to_string_lossy());
    }
    Ok(())
}

/// Gives a file another name, in place of what had it.
pub fn rename(from: &Path, to: &Path) -> Result<()> {
    let body = file_at(from)?;
    let (from, to) = (plain(from), plain(to));
    let mut tree = tree();
    tree.remove(&from);
    tree.insert(to.clone(), Node::File(body.clone()));
    drop(tree);
    let mut body = lock(&body);
    if is_stored(&from) && is_stored(&to) {
        body.store();
        host::rename(&from.to_string_lossy(), &to.to_string_lossy());
    }
    body.path = to;
    Ok(())
}

/// Puts a file there, as the page stored it or the user chose it.
pub fn put(path: &Path, bytes: Vec<u8>) {
    let path = plain(path);
    let _ = path.parent().map_or(Ok(()), create_dir_all);
    let body = FileBody { path: path.clone(), stored: bytes.len(), bytes, is_held: false };
    tree().insert(path, Node::File(Arc::new(Mutex::new(body))));
}

impl FileBody {
    /// Lets the page store what it has not.
    fn store(&mut self) {
        if is_stored(&self.path) && (self.stored < self.bytes.len() || self.bytes.is_empty()) {
            let path = self.path.to_string_lossy();
            host::store(&path, self.stored as f64, &self.bytes[self.stored..]);
            self.stored = self.bytes.len();
        }
    }
}

/// An open file.
pub struct File {
    body: SharedBody,
    /// The byte that is read next.
    at: usize,
    can_write: bool,
    holds: bool,
}

impl File {
    fn new(body: SharedBody, can_write: bool) -> Self {
        Self { body, at: 0, can_write, holds: false }
    }

    /// A file for reading.
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        Ok(Self::new(file_at(path.as_ref())?, false))
    }

    /// A new file for writing; fails if there is one.
    pub fn create_new(path: impl AsRef<Path>) -> Result<Self> {
        let path = plain(path.as_ref());
        let is_within = path.parent().is_some_and(|folder| metadata(folder).is_ok());
        if !is_within {
            return Err(missing());
        }
        let new = FileBody { path: path.clone(), ..FileBody::default() };
        let body = Arc::new(Mutex::new(new));
        let mut tree = tree();
        if tree.contains_key(&path) {
            return Err(Error::new(ErrorKind::AlreadyExists, "there is a file of that name"));
        }
        tree.insert(path, Node::File(body.clone()));
        Ok(Self::new(body, true))
    }

    /// Returns once the page was told all bytes.
    pub fn sync_all(&self) -> Result<()> {
        if self.can_write {
            lock(&self.body).store();
        }
        Ok(())
    }

    /// Holds the file as long as this value lives; false where another holds it.
    pub fn try_hold(&mut self) -> bool {
        let mut body = lock(&self.body);
        let is_free = self.holds || !body.is_held;
        (body.is_held, self.holds) = (true, self.holds || is_free);
        is_free
    }
}

impl Read for File {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let body = lock(&self.body);
        let rest = body.bytes.get(self.at..).unwrap_or_default();
        let count = rest.len().min(to.len());
        to[..count].copy_from_slice(&rest[..count]);
        self.at += count;
        Ok(count)
    }
}

impl Write for File {
    fn write(&mut self, from: &[u8]) -> io::Result<usize> {
        if !self.can_write {
            return Err(Error::new(ErrorKind::PermissionDenied, "it was opened for reading"));
        }
        let mut body = lock(&self.body);
        body.bytes.try_reserve(from.len()).map_err(|_| ErrorKind::OutOfMemory)?;
        body.bytes.extend_from_slice(from);
        // The page has it, whatever becomes of the program.
        body.store();
        Ok(from.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Drop for File {
    fn drop(&mut self) {
        let _ = self.sync_all();
        if self.holds {
            lock(&self.body).is_held = false;
        }
    }
}
