//! Saving a document: as a project, or as a Photoshop file if its name ends so. Floor 5. Not here:
//! the bytes (`project`, `psd`), how they are written to the disk (`replace`).

#![warn(missing_docs)]

use super::export::Output;
use super::fs::Disk;
use super::replace::{FileStamp, Terms, folder_of, replace, sweep};
use super::{Budget, project, psd};
use crate::document::{Document, Progress};
use crate::{Error, Result};
use std::io;
use std::path::Path;

/// A document on the disk.
#[derive(Clone, Copy, Debug)]
pub struct SavedDocument {
    /// For the next save.
    pub stamp: FileStamp,
}

/// A document as the bytes of a file, not written yet.
pub struct EncodedDocument {
    /// As they were written.
    pub bytes: Vec<u8>,
    /// What the format cannot express; nothing for a project.
    pub notes: Vec<String>,
}

/// The bytes that a document is saved as under this name; `None` if canceled. A shape that is
/// still to be made is made first. A project is read back as a file is opened, and compared with
/// the document: it fails where the two differ.
pub fn encode(
    document: &Document,
    file: &Path,
    progress: &Progress,
) -> Result<Option<EncodedDocument>> {
    in_own_threads(file, || {
        let Some(document) = &document.reshaped_with_progress(progress) else { return Ok(None) };
        match Output::of(file) {
            Ok(Output::Psd) => {
                let written = psd::write(file, document, progress)?;
                Ok(written
                    .map(|written| EncodedDocument { bytes: written.bytes, notes: written.notes }))
            }
            _ => {
                let Some(bytes) = project::write(file, document, progress)? else {
                    return Ok(None);
                };
                project::read_back(file, &bytes, document, &Budget::holding(document))?;
                Ok(Some(EncodedDocument { bytes, notes: Vec::new() }))
            }
        }
    })?
}

impl EncodedDocument {
    /// Writes it; `None` if canceled. Fails as [`save`] does.
    pub fn save(
        &self,
        file: &Path,
        terms: &Terms,
        progress: &Progress,
    ) -> Result<Option<SavedDocument>> {
        let done = replace(&Disk, file, &self.bytes, terms, progress)?;
        Ok(done.then(|| SavedDocument { stamp: FileStamp::of(&self.bytes) }))
    }
}

/// Saves a document; `None` if canceled, and then nothing has changed.
///
/// Works on a clone, from any thread; it works in threads of its own, so that a brush never waits
/// for it. Returns once the file and its folder are on the disk. The previous version is kept next
/// to it as `name~`. Fails with [`Error::Changed`] if `terms` do not allow the replacement;
/// whatever fails, the old file is unchanged.
pub fn save(
    document: &Document,
    file: &Path,
    terms: impl Into<Terms>,
    progress: &Progress,
) -> Result<Option<SavedDocument>> {
    match encode(document, file, progress)? {
        Some(encoded) => encoded.save(file, &terms.into(), progress),
        None => Ok(None),
    }
}

/// Removes what killed saves left next to a file; failures are left to the next save.
pub fn tidy(file: &Path) {
    sweep(&Disk, folder_of(file));
}

/// Uses half the processors: the other half is for painting meanwhile.
fn in_own_threads<T: Send>(file: &Path, work: impl FnOnce() -> T + Send) -> Result<T> {
    let threads = (rayon::current_num_threads() / 2).max(1);
    let pool = crate::platform::thread_pool(threads);
    Ok(pool.map_err(|e| Error::io(file, io::Error::other(e)))?.install(work))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::replace::Overwrite;
    use crate::{open, project::sample};

    #[test]
    fn a_document_is_saved_opened_and_saved_over_itself() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.ora");
        let document = sample::everything(32);
        let first =
            save(&document, &file, Overwrite::Nothing, &Progress::default()).unwrap().unwrap();
        let opened = open(&file, &Budget::default()).unwrap();
        assert_eq!(opened.stamp, first.stamp);
        sample::assert_same(&document, &opened.document);
        save(&opened.document, &file, Overwrite::This(opened.stamp), &Progress::default())
            .unwrap()
            .unwrap();
        std::fs::write(&file, "another program's").unwrap();
        let said = save(&document, &file, Overwrite::This(opened.stamp), &Progress::default())
            .unwrap_err();
        assert!(matches!(said, Error::Changed { .. }), "{said}");
        assert_eq!(std::fs::read(&file).unwrap(), b"another program's");
    }
}
