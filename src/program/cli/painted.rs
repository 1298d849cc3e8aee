//! What every command that paints a document does: the document must be complete, and may get
//! another size. Floor 7.

use super::LimitArgs;
use crate::document::Document;
use crate::session::exporting;
use crate::{Error, Result};
use std::path::Path;

/// Refuses layers that would paint black because their picture is missing.
pub fn refuse_incomplete(file: &Path, document: &Document) -> Result<()> {
    for (path, layer) in document.walk() {
        if let Some((field, reason)) = layer.content.lacks().filter(|_| layer.visible) {
            return Err(Error::invalid(file, format!("{path}.{field}"), reason));
        }
    }
    Ok(())
}

/// The document at another size, within the limits.
pub fn scale_document(
    file: &Path,
    factor: f32,
    limits: &LimitArgs,
    document: Document,
) -> Result<Document> {
    exporting::scale_document(file, &document, factor, &limits.budget())
}
