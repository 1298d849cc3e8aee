//! The previous version of a file, kept beside it as `name~`.
//! Floor 5.

use super::part::{PartFile, SPARE};
use crate::fs::Fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Keeps what stands at `target`. Never for a moment without a file of that name, and nothing half written as `name~`.
pub fn keep(fs: &dyn Fs, part: &PartFile, target: &Path) -> io::Result<()> {
    let spare = part.path.with_extension(SPARE);
    let kept = take(fs, part, target, &spare).and_then(|()| rename(fs, &spare, target));
    // After a failure it is still there; and where both names were one file's already, for then nothing is renamed.
    let _ = fs.remove(&spare);
    kept
}

/// The old file under a passing name: a second name where the disk knows such, else a copy.
fn take(fs: &dyn Fs, part: &PartFile, target: &Path, spare: &Path) -> io::Result<()> {
    // In a folder where everybody keeps their own, a second name of another's file could not be taken away again.
    let is_ours = fs.is_same_owner(target, &part.path).unwrap_or(false);
    if is_ours && fs.link(target, spare).is_ok() {
        return Ok(());
    }
    let (mut source, mut copy) = (fs.open(target)?, fs.create_new(spare)?);
    let _ = fs.copy_ownership(target, spare);
    io::copy(&mut source, &mut copy)?;
    copy.sync()
}

fn rename(fs: &dyn Fs, spare: &Path, target: &Path) -> io::Result<()> {
    let mut name = target.as_os_str().to_owned();
    name.push("~");
    match fs.rename(spare, Path::new(&name)) {
        Err(e) if e.kind() == ErrorKind::InvalidFilename => fs.rename(spare, &shortened(target)),
        renamed => renamed,
    }
}

/// A name for the previous version that is no longer than the file's own, for where `name~` does not fit. Its checksum
/// tells it from that of another file whose name begins alike.
fn shortened(target: &Path) -> PathBuf {
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
        let of = |name: &str| shortened(&Path::new("/d").join(name)).file_name().unwrap().to_owned();
        let (a, b) = (format!("{}a.ora", "ü".repeat(125)), format!("{}b.ora", "ü".repeat(125)));
        assert_eq!(a.len(), 255);
        assert!(of(&a).len() <= 255 && of(&a).to_string_lossy().ends_with('~'));
        assert_ne!(of(&a), of(&b));
        assert_eq!(of(&a), of(&a));
    }
}
