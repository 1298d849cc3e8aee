//! The previous version of a file, kept next to it as `name~`. Floor 5.

use super::part::{OLDER, PartFile, SPARE};
use super::rename_patiently;
use crate::fs::{EntryKind, Fs};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// The longest name that every disk takes, bytes.
const LONGEST_NAME: usize = 255;

/// The previous version next to the file, and the version before that, until the new file is in
/// place.
pub struct Previous {
    name: PathBuf,
    /// The version before, under a passing name.
    older: Option<PathBuf>,
}

impl Previous {
    /// Keeps the file at `target` as `name~`, or under a shorter name if that is too long for the
    /// disk. A file of that name exists at every moment, and is never half written.
    pub fn keep(fs: &dyn Fs, part: &PartFile, target: &Path) -> io::Result<Self> {
        let mut name = target.as_os_str().to_owned();
        name.push("~");
        let name = PathBuf::from(name);
        // Not every disk gives the reason.
        let is_long = name.file_name().is_some_and(|name| name.len() > LONGEST_NAME);
        match Self::keep_as(fs, part, target, name) {
            Err(e) if is_long || e.kind() == ErrorKind::InvalidFilename => {
                Self::keep_as(fs, part, target, shorten(target))
            }
            kept => kept,
        }
    }

    fn keep_as(fs: &dyn Fs, part: &PartFile, target: &Path, name: PathBuf) -> io::Result<Self> {
        let spare = part.path.with_extension(SPARE);
        let previous = Self { older: set_aside(fs, part, &name)?, name };
        let kept = take(fs, part, target, &spare)
            .and_then(|()| rename_patiently(fs, &spare, &previous.name));
        // The spare name is still there after a failure, and if both names belonged to one file:
        // then nothing is renamed.
        let _ = fs.remove(&spare);
        match kept {
            Ok(()) => Ok(previous),
            Err(e) => {
                previous.forget(fs);
                Err(e)
            }
        }
    }

    /// The new file did not get its place: restores the previous version that was next to the old
    /// one.
    pub fn undo(self, fs: &dyn Fs) {
        let put_back = match &self.older {
            Some(older) => fs.rename(older, &self.name),
            None => fs.remove(&self.name),
        };
        // A version that cannot be restored keeps its temporary name; none of this touches the old
        // file itself.
        if put_back.is_ok() {
            self.forget(fs);
        }
    }

    /// The new file is in place, and the version before the previous one no longer needed.
    pub fn forget(self, fs: &dyn Fs) {
        self.older.iter().for_each(|older| drop(fs.remove(older)));
    }
}

/// Gives an existing previous version a temporary name; `None` if there is none.
fn set_aside(fs: &dyn Fs, part: &PartFile, name: &Path) -> io::Result<Option<PathBuf>> {
    let older = part.path.with_extension(OLDER);
    match fs.find(name)? {
        // Only a file can be a previous version.
        Some(EntryKind::File) => take(fs, part, name, &older).map(|()| Some(older)),
        _ => Ok(None),
    }
}

/// A file under a passing name: a second name where the disk knows such, else a copy.
fn take(fs: &dyn Fs, part: &PartFile, file: &Path, spare: &Path) -> io::Result<()> {
    // In a folder where users may remove only their own files, a second name of another user's file
    // could not be removed.
    let is_ours = fs.is_same_owner(file, &part.path).unwrap_or(false);
    if is_ours && fs.link(file, spare).is_ok() {
        return Ok(());
    }
    let copied = (|| {
        let (mut source, mut copy) = (fs.open(file)?, fs.create_new(spare)?);
        let _ = fs.copy_ownership(file, spare);
        io::copy(&mut source, &mut copy)?;
        copy.sync()
    })();
    if copied.is_err() {
        let _ = fs.remove(spare);
    }
    copied
}

/// A name for the previous version that is no longer than the file's own, used if `name~` does not
/// fit. Its checksum distinguishes files whose names begin alike.
fn shorten(target: &Path) -> PathBuf {
    let name = target.file_name().unwrap_or_default();
    let extension = format!("-{:08x}~", crc32fast::hash(name.as_encoded_bytes()));
    let text = name.to_string_lossy();
    let room = name.len().saturating_sub(extension.len());
    target.with_file_name(format!("{}{extension}", &text[..text.floor_char_boundary(room)]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shortened_name_fits_and_tells_files_apart() {
        let of = |name: &str| shorten(&Path::new("/d").join(name)).file_name().unwrap().to_owned();
        let (a, b) = (format!("{}a.ora", "ü".repeat(125)), format!("{}b.ora", "ü".repeat(125)));
        assert_eq!(a.len(), 255);
        assert!(of(&a).len() <= 255 && of(&a).to_string_lossy().ends_with('~'));
        assert_ne!(of(&a), of(&b));
        assert_eq!(of(&a), of(&a));
    }
}
