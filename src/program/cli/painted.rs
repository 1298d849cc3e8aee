//! What every command that paints a document does: the document must be complete, and may get
//! another size. Floor 7.

use super::LimitArgs;
use crate::document::Document;
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
    if factor == 1.0 {
        return Ok(document);
    }
    let size = document.size.scaled(factor);
    limits.budget().size(file, size.width.into(), size.height.into())?;
    // A surface is made again from normals, depth and coverage; layers are copied.
    let a_pixel = if document.surface.is_some() { 40 } else { 8 };
    let shape = document.shape_bytes(&document.parts.list) as f64 * f64::from(factor * factor);
    let bytes = (size.area() as u64 * a_pixel).max(shape as u64);
    limits.budget().room(file, &format!("a canvas of {size} pixels"), bytes)?;
    document.scaled(factor).map_err(|error| Error::invalid(file, "--scale", error))
}
