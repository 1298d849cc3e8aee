//! Reports of crashes: texts that a user may send; nothing sends them. Floor 5.

use crate::platform::{self, SystemTime, UNIX_EPOCH, files};
use crate::{Error, Result};
use std::io::Write;
use std::path::{Path, PathBuf};

/// So many reports are kept.
const KEPT: usize = 10;
/// The file that names the report which nobody has heard of yet.
const UNREAD: &str = "unread";

/// The folder of reports: `rilievo/crashes` in the user's folder for state; `None` if the system has
/// none.
pub fn folder() -> Option<PathBuf> {
    Some(platform::state_folder()?.join("rilievo").join("crashes"))
}

/// Writes a report; returns its path. The oldest of many are removed.
pub fn write(folder: &Path, text: &str) -> Result<PathBuf> {
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |e| Error::io(path, e)
    };
    files::create_dir_all(folder).map_err(failed(folder))?;
    let secs = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs();
    let name = format!("crash-{secs:010}-{}.txt", platform::process_id());
    let file = folder.join(&name);
    put(&file, text).map_err(failed(&file))?;
    put(&folder.join(UNREAD), &name).map_err(failed(folder))?;
    let mut all = reports(folder);
    all.sort();
    for old in all.iter().rev().skip(KEPT) {
        // A report that stays is no harm.
        let _ = files::remove_file(old);
    }
    Ok(file)
}

/// The last report, if nobody has heard of it yet: it is returned once.
pub fn take_unread(folder: &Path) -> Option<PathBuf> {
    let mark = folder.join(UNREAD);
    let name = String::from_utf8(files::read(&mark).ok()?).ok()?;
    files::remove_file(&mark).ok()?;
    let found = reports(folder);
    found.into_iter().find(|file| file.file_name().is_some_and(|own| own == name.as_str()))
}

fn put(file: &Path, text: &str) -> std::io::Result<()> {
    match files::remove_file(file) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    files::File::create_new(file)?.write_all(text.as_bytes())
}

fn reports(folder: &Path) -> Vec<PathBuf> {
    let is_report = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("crash-") && name.ends_with(".txt")
    };
    let entries = files::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).filter(is_report).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_is_told_of_once_and_old_ones_go() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("rilievo").join("crashes");
        assert_eq!(take_unread(&folder), None);
        let file = write(&folder, "internal error: a tile went missing").unwrap();
        assert_eq!(take_unread(&folder), Some(file.clone()));
        assert_eq!(take_unread(&folder), None);
        assert!(std::fs::read_to_string(&file).unwrap().contains("a tile went missing"));
        for i in 0..20 {
            std::fs::write(folder.join(format!("crash-{i:010}-1.txt")), "old").unwrap();
        }
        let last = write(&folder, "again").unwrap();
        let left = reports(&folder);
        assert_eq!((left.len(), left.contains(&last)), (KEPT, true));
        // A mark that names no report is nothing.
        std::fs::write(folder.join(UNREAD), "../../settings.json").unwrap();
        assert_eq!(take_unread(&folder), None);
    }
}
