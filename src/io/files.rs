//! Where a document's files are found: in the recipe's folder, or in a project's zip. Floor 5.
//! Every file that a document names is read through [`Files`]; nothing else opens a path from a
//! file.

#![warn(missing_docs)]

use super::Budget;
use crate::platform::files as fs;
use crate::raster::Asset;
use crate::{Error, Result};
use std::{
    cell::RefCell,
    collections::{BTreeMap, HashMap},
    io::Read,
    path::{Path, PathBuf},
};

/// The files a document may name.
pub trait Files {
    /// The whole file called `name`, or a sentence: no such file, larger than the budget, or a name
    /// that leaves the folder.
    fn read(&self, name: &str, budget: &Budget) -> Result<Vec<u8>>;
    /// The path of `name`, for messages.
    fn path(&self, name: &str) -> PathBuf;
}

/// Why a document may not use this file name; `None` if it may.
///
/// Names are relative, below the document's own folder, with `/` between parts, the same on every
/// system.
pub fn refusal(name: &str) -> Option<&'static str> {
    if name.is_empty() {
        return Some("the name is empty");
    }
    if name.contains('\0') {
        return Some("the name holds a NUL character");
    }
    if name.contains('\\') {
        return Some("the name holds a backslash; parts of a name are separated by “/”");
    }
    if name.contains(':') {
        return Some("the name holds a colon; it must not name a drive or an address");
    }
    if name.starts_with('/') {
        return Some("the name is absolute; it must be relative to the document");
    }
    if name.split('/').any(|part| part == "..") {
        return Some("the name contains “..”; it must stay in the document's folder");
    }
    None
}

/// The folder that holds a recipe. Links are not followed: a recipe cannot reach beyond its folder
/// through one.
pub struct RecipeFolder {
    root: PathBuf,
}

impl RecipeFolder {
    /// The folder that names are read in.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into() }
    }

    /// The folder of a recipe.
    pub fn folder_of(recipe: &Path) -> Self {
        Self::new(recipe.parent().unwrap_or(Path::new("")))
    }
}

impl Files for RecipeFolder {
    fn read(&self, name: &str, budget: &Budget) -> Result<Vec<u8>> {
        if let Some(reason) = refusal(name) {
            return Err(Error::unsupported_file(name, reason));
        }
        let mut path = self.root.clone();
        for part in name.split('/').filter(|part| !part.is_empty() && *part != ".") {
            path.push(part);
            let found = fs::symlink_metadata(&path).map_err(|e| Error::io(&path, e))?;
            if found.is_symlink() {
                return Err(Error::unsupported_file(
                    &path,
                    "it is a link, which could point outside the document's folder",
                ));
            }
        }
        read_file(&path, budget.file_bytes)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }
}

/// Files that the user named himself, on the command line or in a dialog: they may be anywhere.
#[derive(Default)]
pub struct UserFiles {
    paths: HashMap<String, PathBuf>,
}

impl UserFiles {
    /// The name that a document uses for a path given by the user.
    pub fn add(&mut self, path: &Path) -> String {
        let mut name = path.to_string_lossy().into_owned();
        // Two paths that are not UTF-8 may look alike.
        while self.paths.get(&name).is_some_and(|known| known != path) {
            name.push('′');
        }
        self.paths.insert(name.clone(), path.into());
        name
    }
}

impl Files for UserFiles {
    fn read(&self, name: &str, budget: &Budget) -> Result<Vec<u8>> {
        read_file(&self.path(name), budget.file_bytes)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.paths.get(name).cloned().unwrap_or_else(|| name.into())
    }
}

/// Files that record which of them were read, so that none of them is overwritten.
pub struct TrackedFiles<F> {
    files: F,
    read: RefCell<Vec<PathBuf>>,
}

impl<F: Files> TrackedFiles<F> {
    /// Over other files.
    pub fn new(files: F) -> Self {
        Self { files, read: RefCell::default() }
    }

    /// The requested paths, in that order.
    pub fn read_paths(&self) -> Vec<PathBuf> {
        self.read.borrow().clone()
    }
}

impl<F: Files> Files for TrackedFiles<F> {
    fn read(&self, name: &str, budget: &Budget) -> Result<Vec<u8>> {
        self.read.borrow_mut().push(self.path(name));
        self.files.read(name, budget)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.files.path(name)
    }
}

/// Files that are read once and cached.
pub struct CachedFiles<'a> {
    files: &'a dyn Files,
    read: RefCell<BTreeMap<String, Asset>>,
}

impl<'a> CachedFiles<'a> {
    /// Over other files.
    pub fn new(files: &'a dyn Files) -> Self {
        Self { files, read: RefCell::default() }
    }

    /// What was read, by name.
    pub fn assets(&self) -> BTreeMap<String, Asset> {
        self.read.borrow().clone()
    }
}

impl Files for CachedFiles<'_> {
    fn read(&self, name: &str, budget: &Budget) -> Result<Vec<u8>> {
        if let Some(known) = self.read.borrow().get(name) {
            return Ok(known.bytes().to_vec());
        }
        let bytes = self.files.read(name, budget)?;
        self.read.borrow_mut().insert(name.to_owned(), bytes.clone().into());
        Ok(bytes)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.files.path(name)
    }
}

/// Reads a regular file of at most `max_bytes`; a folder, a pipe or a device is refused before it
/// is opened.
pub fn read_file(path: &Path, max_bytes: u64) -> Result<Vec<u8>> {
    let io = |e| Error::io(path, e);
    let found = fs::metadata(path).map_err(io)?;
    if found.is_dir() {
        return Err(Error::unsupported_file(path, "it is a folder, not a file"));
    }
    if !found.is_file() {
        return Err(Error::unsupported_file(path, "it is not a regular file"));
    }
    let file = fs::File::open(path).map_err(io)?;
    let mut bytes = Vec::new();
    // Reading one byte more than allowed reveals a file that is too large, whatever its metadata
    // said.
    file.take(max_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(io)?;
    if bytes.len() as u64 > max_bytes {
        return Err(Error::too_large(path, format!("the file has more than {max_bytes} bytes")));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn folder_with_a_file() -> (tempfile::TempDir, RecipeFolder) {
        let outer = tempfile::tempdir().unwrap();
        fs::create_dir_all(outer.path().join("doc/sub")).unwrap();
        fs::write(outer.path().join("secret.png"), "secret").unwrap();
        fs::write(outer.path().join("doc/sub/a.png"), "inside").unwrap();
        let folder = RecipeFolder::folder_of(&outer.path().join("doc/recipe.json"));
        (outer, folder)
    }

    #[test]
    fn files_below_the_folder_are_read() {
        let (_outer, folder) = folder_with_a_file();
        for name in ["sub/a.png", "./sub/a.png", "sub//a.png"] {
            assert_eq!(folder.read(name, &Budget::default()).unwrap(), b"inside", "{name}");
        }
    }

    #[test]
    fn names_that_leave_the_folder_are_refused() {
        let (outer, folder) = folder_with_a_file();
        let absolute = outer.path().join("secret.png").display().to_string();
        for name in [
            "../secret.png",
            "sub/../../secret.png",
            "C:/a.png",
            "sub\\a.png",
            "a\0b",
            "",
            &absolute,
        ] {
            let said = folder.read(name, &Budget::default()).unwrap_err().to_string();
            assert!(said.contains("the name"), "{name}: {said}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_are_refused_wherever_they_lead() {
        let (outer, folder) = folder_with_a_file();
        let doc = outer.path().join("doc");
        std::os::unix::fs::symlink("../secret.png", doc.join("out.png")).unwrap();
        std::os::unix::fs::symlink("sub", doc.join("within")).unwrap();
        for name in ["out.png", "within/a.png"] {
            let said = folder.read(name, &Budget::default()).unwrap_err().to_string();
            assert!(said.contains("is a link"), "{said}");
        }
    }

    #[test]
    fn a_folder_a_device_and_a_file_beyond_the_budget_are_refused() {
        let (_outer, folder) = folder_with_a_file();
        assert!(
            folder.read("sub", &Budget::default()).unwrap_err().to_string().contains("is a folder")
        );
        let small = Budget { file_bytes: 5, ..Budget::default() };
        assert!(
            folder.read("sub/a.png", &small).unwrap_err().to_string().contains("more than 5 bytes")
        );
        let exact = Budget { file_bytes: 6, ..Budget::default() };
        assert!(folder.read("sub/a.png", &exact).is_ok());
    }

    #[test]
    fn what_the_user_names_may_be_anywhere() {
        let (outer, _) = folder_with_a_file();
        let mut given = UserFiles::default();
        let name = given.add(&outer.path().join("secret.png"));
        assert_eq!(given.read(&name, &Budget::default()).unwrap(), b"secret");
    }
}
