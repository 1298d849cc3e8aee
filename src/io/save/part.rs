//! The temporary file of a save: beside its target, under its own name, locked while it is in use. Floor 5.

use crate::fs::{FileHandle, Fs};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

const PREFIX: &str = ".rilievo-";
const PART: &str = "part";
/// The suffix of the old file for the moment before it becomes `name~`.
pub const SPARE: &str = "old";

/// `.rilievo-PROCESS-NUMBER.part`, and the handle that holds it.
pub struct PartFile {
    pub path: PathBuf,
    pub handle: Box<dyn FileHandle>,
}

impl PartFile {
    /// A new one, empty.
    pub fn create(fs: &dyn Fs, folder: &Path) -> io::Result<Self> {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        loop {
            let number = NEXT.fetch_add(1, Ordering::Relaxed);
            let path = folder.join(format!("{PREFIX}{}-{number}.{PART}", std::process::id()));
            let mut handle = match fs.create_new(&path) {
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => continue,
                made => made?,
            };
            // On a disk without locks nothing is swept either. The file may have been swept before it was locked.
            let is_ours = handle.hold().unwrap_or(true);
            if is_ours && fs.found(&path)?.is_some() {
                return Ok(Self { path, handle });
            }
        }
    }
}

/// Removes what killed saves left in a folder: files with our names that no process holds. Process ids are not checked,
/// because they are reused. Failures are left for the next time.
pub fn sweep(fs: &dyn Fs, folder: &Path) {
    for path in fs.list(folder).unwrap_or_default().into_iter().filter(|path| is_ours(path)) {
        let part = path.with_extension(PART);
        match fs.open(&part) {
            Ok(mut handle) => {
                // Removed while it is locked, so that no other process takes it.
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

/// `.rilievo-12-3.part` or `.old`, and nothing else.
fn is_ours(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).and_then(|name| name.strip_prefix(PREFIX));
    let Some((numbers, extension)) = name.and_then(|name| name.split_once('.')) else { return false };
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let is_pair = numbers.split_once('-').is_some_and(|(process, number)| is_number(process) && is_number(number));
    is_pair && (extension == PART || extension == SPARE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fs::memory::MemoryFs;

    #[test]
    fn what_no_process_holds_is_swept_and_nothing_else() {
        let fs = MemoryFs::with(&[
            ("/d/.rilievo-1-7.part", b"killed"),
            ("/d/.rilievo-1-8.part", b"killed later"),
            ("/d/.rilievo-1-8.old", b"the same"),
            ("/d/.rilievo-notes.part", b"somebody's"),
            ("/d/a.part", b"somebody's"),
        ]);
        let ours = PartFile::create(&fs, Path::new("/d")).unwrap();
        sweep(&fs, Path::new("/d"));
        sweep(&fs, Path::new("/d"));
        let name = ours.path.display().to_string();
        assert_eq!(fs.names(), [&name, "/d/.rilievo-notes.part", "/d/a.part"]);
        drop(ours);
        sweep(&fs, Path::new("/d"));
        assert_eq!(fs.names(), ["/d/.rilievo-notes.part", "/d/a.part"]);
    }
}
