//! The document that a file of ours holds besides its layers. Floor 5.

use super::{LayerRecord, signature};
use crate::math::Size;
use crate::pixels;
use crate::project::archive::Archive;
use crate::project::manifest::Manifest;
use crate::project::packer::ZipPacker;
use crate::project::{self, ProjectContents};
use crate::{Budget, Error, Result};
use std::path::Path;

/// The document that our own resource holds, the layers' pixels taken from the file; `None` where
/// the layers are others.
pub fn restore(
    file: &Path,
    ours: &[u8],
    records: &[LayerRecord],
    budget: &Budget,
) -> Result<Option<ProjectContents>> {
    let archive = Archive::open(file, ours, budget)?;
    let damaged = |e: zip::result::ZipError| {
        Error::decode(file, format!("our part of the file is damaged ({e})"))
    };
    let text = archive.bytes(project::MANIFEST, budget.json_bytes)?;
    let manifest = serde_json::from_slice(&text).ok().as_ref().and_then(Manifest::read);
    let manifest =
        manifest.ok_or_else(|| Error::decode(file, "our part of the file is damaged"))?;
    if manifest.stack != signature(records) {
        return Ok(None);
    }
    let mut packer = ZipPacker::default();
    for name in archive.names() {
        packer.store(name, &archive.bytes(name, budget.file_bytes)?).map_err(damaged)?;
    }
    for shown in &manifest.pictures {
        let number = shown.name.strip_prefix("data/").and_then(|name| name.strip_suffix(".png"));
        let record = number.and_then(|n| n.parse::<usize>().ok()).and_then(|n| records.get(n));
        let Some(record) = record else { continue };
        packer.store(&shown.name, png(file, record)?.bytes()).map_err(damaged)?;
    }
    project::read(file, &packer.finish().map_err(damaged)?, budget).map(Some)
}

/// A record's pixels as a project would store them.
fn png(file: &Path, record: &LayerRecord) -> Result<crate::raster::Asset> {
    if record.rect.is_empty() {
        return pixels::encode_texels(file, &[[0; 4]], Size::new(1, 1));
    }
    let size = Size::new(record.rect.width() as u32, record.rect.height() as u32);
    pixels::encode_texels(file, record.rgba.as_chunks().0, size)
}
