//! Names of files within a document. Floor 6.

use crate::document::Document;
use std::path::Path;

/// A file name that no other picture of the document has.
pub(in crate::session) fn free_file(document: &Document, name: &str) -> String {
    let taken =
        |name: &str| document.walk().iter().any(|(_, layer)| layer.content.files().contains(&name));
    let path = Path::new(name);
    let (stem, extension) =
        (path.file_stem().unwrap_or_default(), path.extension().unwrap_or_default());
    let mut free = name.to_owned();
    for i in 2.. {
        if !taken(&free) {
            break;
        }
        free = format!("{}-{i}.{}", stem.to_string_lossy(), extension.to_string_lossy());
    }
    free
}
