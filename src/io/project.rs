//! Projects: a zip that is a valid OpenRaster file and also holds Rilievo's own document
//! (docs/PROJECTS.md). Floor 5. It reads and writes bytes in memory; `io::save` handles files on
//! the disk.
//!
//! | file | |
//! |---|---|
//! | `archive`, `packer` | the zip: read within a budget, written the same every time |
//! | `plan` | what other programs see of a document |
//! | `layer_preview` | those pictures, rendered, encoded and checked (by `pixels`) |
//! | `stack` | `stack.xml`, written and read |
//! | `thumbnail` | the small picture that file managers show |
//! | `assets` | maps, sources and tips under their names in the zip |
//! | `manifest` | which picture belongs to which layer, so that another program's change is detected |
//! | `open`, `repair`, `foreign` | reading: our own, damaged, other programs' |
//! | `krita` | Krita's own files, which are zips of another kind |

pub(super) mod archive;
pub(super) mod assets;
mod foreign;
mod krita;
pub(super) mod layer_preview;
pub(super) mod manifest;
mod open;
pub(super) mod packer;
pub(super) mod plan;
mod png_header;
mod reader;
mod repair;
#[cfg(test)]
pub(super) mod sample;
mod stack;
#[cfg(test)]
mod tests;
mod thumbnail;

pub use archive::Archive;
pub use krita::blend_of as krita_blend;
pub use layer_preview::Cancelable;
pub use open::{ProjectContents, read, read_back};
pub use thumbnail::{SmallPicture, stored_thumbnail};

use super::recipe;
use crate::document::EncodedPixels;
use crate::document::{Document, LayerId, Progress, flatten};
use crate::math::ColorProfile;
use crate::pixels;
use crate::profile_change::show_in_srgb;
use crate::raster::Asset;
use crate::{Error, Result};
use assets::{AssetList, StoredPixels};
use manifest::Manifest;
use packer::ZipPacker;
use plan::{FormatSupport, ItemContent, PlanItem};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

const MIMETYPE: &str = "mimetype";
const MIME: &str = "image/openraster";
const DOCUMENT: &str = "rilievo/document.json";
/// The entry that lists which picture shows which layer.
pub const MANIFEST: &str = "rilievo/manifest.json";
const STACK: &str = "stack.xml";
const MERGED: &str = "mergedimage.png";

/// The bytes of a project; `None` if canceled. `file` is for messages.
///
/// The same document gives the same bytes, and so does the document read back from them.
pub fn write(file: &Path, document: &Document, progress: &Progress) -> Cancelable<Vec<u8>> {
    let items = plan::plan(document, FormatSupport::OPENRASTER);
    let paint = layer_preview::encode_paint(file, document)?;
    let Some(previews) = layer_preview::render(file, document, &items, progress)? else {
        return Ok(None);
    };
    let Some(merged) = flatten(document, progress) else { return Ok(None) };
    let pictures: Vec<(String, EncodedPixels)> = previews
        .into_iter()
        .enumerate()
        .map(|(i, preview)| (format!("data/{i:03}.png"), preview))
        .collect();
    let shown = pictures_alone(&items, &pictures);
    let xml = stack::write(document.size, &items, &pictures);
    let mut entries = vec![ZipEntry::text(MIMETYPE, MIME.as_bytes().to_vec())];
    let stack = crc32fast::hash(xml.as_bytes());
    entries.extend(documents(file, document, &paint, &shown, stack, &BTreeSet::new())?);
    // After the document and the manifest, before all pictures.
    entries.insert(3, ZipEntry::text(STACK, xml.into_bytes()));
    let layers = pictures.iter().map(|(name, picture)| ZipEntry::bytes(name, picture.file.clone()));
    entries.splice(4..4, layers);
    let mut whole = merged.to_straight_rgba(document.size.rect());
    let mut picture = |name, rgba: &[u8], size, profile| -> Result<()> {
        let png = pixels::encode_texels_in(file, rgba.as_chunks().0, size, profile)?;
        entries.push(ZipEntry::bytes(name, png));
        Ok(())
    };
    picture(MERGED, &whole, document.size, document.profile)?;
    // File managers know sRGB alone.
    show_in_srgb(&mut whole, document.profile);
    if let Some(small) = SmallPicture::of(whole, document.size, thumbnail::STORED_PX) {
        picture(thumbnail::ENTRY, &small.rgba, small.size, ColorProfile::Srgb)?;
    }
    pack_zip(file, &entries).map(Some)
}

/// An entry of the zip.
pub struct ZipEntry {
    name: String,
    bytes: Asset,
    is_text: bool,
}

impl ZipEntry {
    fn text(name: &str, bytes: Vec<u8>) -> Self {
        Self { name: name.into(), bytes: bytes.into(), is_text: name != MIMETYPE }
    }

    fn bytes(name: &str, bytes: Asset) -> Self {
        Self { name: name.into(), bytes, is_text: false }
    }
}

/// Rilievo's own entries: the document, the manifest, and every file they name except the pictures
/// in `shown`.
///
/// * `paint`: all pixels of the paint layers.
/// * `shown`: the pictures that show one layer alone, with their names.
/// * `stack`: a checksum of the layer structure that other programs see.
/// * `whole_rims`: the layers whose pictures cover the surface's rim wholly.
pub fn documents(
    file: &Path,
    document: &Document,
    paint: &BTreeMap<LayerId, EncodedPixels>,
    shown: &BTreeMap<LayerId, &(String, EncodedPixels)>,
    stack: u32,
    whole_rims: &BTreeSet<LayerId>,
) -> Result<Vec<ZipEntry>> {
    let shared = shown.iter().filter(|(id, (_, preview))| paint.get(id) == Some(preview));
    let shared = shared.map(|(id, (name, _))| (*id, name.clone())).collect();
    let mut assets = AssetList::default();
    let renamed =
        assets.rename(file, document, &StoredPixels { pixels: paint, shared: &shared })?;
    let manifest = format!("{:#}\n", Manifest::new(document, stack, shown, whole_rims).write());
    let mut entries = vec![
        ZipEntry::text(DOCUMENT, recipe::print(&renamed).into_bytes()),
        ZipEntry::text(MANIFEST, manifest.into_bytes()),
    ];
    entries.extend(assets.files().iter().map(|(name, asset)| ZipEntry::bytes(name, asset.clone())));
    Ok(entries)
}

/// Entries as a zip.
pub fn pack_zip(file: &Path, entries: &[ZipEntry]) -> Result<Vec<u8>> {
    let pack = || {
        let mut packer = ZipPacker::default();
        for ZipEntry { name, bytes, is_text } in entries {
            if *is_text {
                packer.deflate(name, bytes.bytes())?
            } else {
                packer.store(name, bytes.bytes())?
            }
        }
        packer.finish()
    };
    pack().map_err(|e| Error::unsupported_file(file, format!("the project cannot be packed ({e})")))
}

/// The pictures that show one layer alone, with their names.
fn pictures_alone<'a>(
    items: &[PlanItem],
    pictures: &'a [(String, EncodedPixels)],
) -> BTreeMap<LayerId, &'a (String, EncodedPixels)> {
    let shown = layer_preview::pictures_of(items).into_iter().zip(pictures);
    let alone = shown.filter_map(|(item, picture)| match &item.shows {
        ItemContent::Layer(layer) | ItemContent::Nothing(layer) => Some((layer.id, picture)),
        _ => None,
    });
    alone.collect()
}
