//! The new file while it is being written: next to its target, under a temporary name, locked so
//! that others know it is in use. Floor 5.

use crate::fs::{EntryKind, FileHandle, Fs};
use std::io;
use std::path::{Path, PathBuf};

const PREFIX: &str = ".rilievo-";
const PART: &str = "part";
/// Extension of the old file for a moment, before it becomes `name~`.
pub const SPARE: &str = "old";
/// Extension of the old `name~`, until the new file is in place.
pub const OLDER: &str = "older";
/// Digits of a token.
const DIGITS: usize = 16;
/// Names tried before a disk is given up where every one of them is taken.
const TRIES: u32 = 100;

/// `.rilievo-TOKEN.part`, and the handle that holds it. Its name is as short for every target.
pub struct PartFile {
    pub path: PathBuf,
    pub handle: Box<dyn FileHandle>,
}

impl PartFile {
    /// A new one, empty.
    pub fn create(fs: &dyn Fs, folder: &Path) -> io::Result<Self> {
        for _ in 0..TRIES {
            let path = folder.join(format!("{PREFIX}{:0DIGITS$x}.{PART}", fs.token()));
            let mut handle = match fs.create_new(&path) {
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => continue,
                made => made?,
            };
            // A disk that cannot hold files is not swept either. One that is swept may have been so
            // before it was held.
            let is_ours = handle.hold().unwrap_or(true);
            match fs.find(&path) {
                Ok(Some(_)) if is_ours => return Ok(Self { path, handle }),
                Err(e) => {
                    let _ = fs.remove(&path);
                    return Err(e);
                }
                Ok(_) => {}
            }
        }
        Err(io::Error::new(
            io::ErrorKind::AlreadyExists,
            "every name for a temporary file is taken",
        ))
    }
}

/// Removes what killed saves and exports left in a folder: files with our names that no process has
/// locked. Process numbers are not used, since they are reused. Whatever fails is left for the next
/// time.
pub fn sweep(fs: &dyn Fs, folder: &Path) {
    for path in fs.list(folder).unwrap_or_default().into_iter().filter(|path| is_ours(path)) {
        // Only a regular file: opening a pipe would wait for ever.
        if !matches!(fs.find(&path), Ok(Some(EntryKind::File))) {
            continue;
        }
        let part = path.with_extension(PART);
        match fs.open(&part) {
            Ok(mut handle) => {
                // Removed while it is held, so that nobody takes it for theirs.
                if handle.hold().unwrap_or(false) {
                    let _ = fs.remove(&path);
                }
            }
            // An old file under its passing name, and the save that gave it no longer there.
            Err(e) if e.kind() == io::ErrorKind::NotFound => drop(fs.remove(&path)),
            Err(_) => {}
        }
    }
}

/// `.rilievo-TOKEN.part`, `.old` or `.older`, and nothing else. A token was a process's number and
/// a count before 1.0.
fn is_ours(path: &Path) -> bool {
    let name =
        path.file_name().and_then(|name| name.to_str()).and_then(|name| name.strip_prefix(PREFIX));
    let Some((token, extension)) = name.and_then(|name| name.split_once('.')) else { return false };
    let is_token = token.len() == DIGITS
        && token.bytes().all(|b| b.is_ascii_digit() || (b'a'..=b'f').contains(&b));
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let is_pair = token
        .split_once('-')
        .is_some_and(|(process, number)| is_number(process) && is_number(number));
    (is_token || is_pair) && [PART, SPARE, OLDER].contains(&extension)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fs::memory::MemoryFs;

    #[test]
    fn what_no_process_holds_is_swept_and_nothing_else() {
        let fs = MemoryFs::with(&[
            ("/d/.rilievo-0123456789abcdef.part", b"killed"),
            ("/d/.rilievo-0123456789abcdef.old", b"the same"),
            ("/d/.rilievo-0123456789abcdef.older", b"the same"),
            ("/d/.rilievo-1-8.part", b"killed long ago"),
            ("/d/.rilievo-1-9.old", b"killed long ago"),
            ("/d/.rilievo-notes.part", b"somebody's"),
            ("/d/.rilievo-0123456789abcdeF.part", b"somebody's"),
            ("/d/a.part", b"somebody's"),
        ]);
        let ours = PartFile::create(&fs, Path::new("/d")).unwrap();
        sweep(&fs, Path::new("/d"));
        sweep(&fs, Path::new("/d"));
        let name = ours.path.display().to_string();
        let others = ["/d/.rilievo-0123456789abcdeF.part", "/d/.rilievo-notes.part", "/d/a.part"];
        let mut left = fs.names();
        assert!(left.contains(&name));
        left.retain(|other| *other != name);
        assert_eq!(left, others);
        drop(ours);
        sweep(&fs, Path::new("/d"));
        assert_eq!(fs.names(), others);
    }

    #[test]
    fn two_processes_that_would_take_the_same_name_take_two() {
        let fs = MemoryFs::with(&[("/d/other", b"")]);
        let first = PartFile::create(&fs, Path::new("/d")).unwrap();
        fs.repeat_tokens();
        let second = PartFile::create(&fs, Path::new("/d")).unwrap();
        assert_ne!(first.path, second.path);
        assert_eq!(fs.names().len(), 3);
    }
}
