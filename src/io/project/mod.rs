//! Projects: a zip that is a valid OpenRaster file and holds beside it what only Rilievo understands (docs/PROJECTS.md).
//! Floor 5. Bytes in memory both ways; files on the disk are `io::save`'s.
//!
//! | file | |
//! |---|---|
//! | `archive`, `packer` | the zip: read within a budget, written the same every time |
//! | `plan` | what other programs see of a document |
//! | `look`, `pixels` | those pictures, rendered, encoded and checked |
//! | `stack` | `stack.xml`, written and read |
//! | `assets` | maps, sources and tips under their names in the zip |
//! | `manifest` | which picture is whose, so that another program's change is seen |
//! | `open`, `repair`, `foreign` | reading: our own, damaged, other programs' |

mod archive;
pub(super) mod assets;
mod foreign;
mod look;
mod manifest;
mod open;
mod packer;
pub(super) mod pixels;
mod plan;
mod repair;
#[cfg(test)]
pub(super) mod sample;
mod stack;
#[cfg(test)]
mod tests;

pub use archive::Archive;
pub use look::Cancellable;
pub use open::{Contents, read};

use super::recipe;
use crate::Error;
use crate::document::kept::Encoded;
use crate::document::{Document, LayerId, Progress, flatten};
use crate::math::Size;
use assets::{Assets, Painted};
use manifest::Manifest;
use packer::Packer;
use plan::{Item, Shows};
use std::collections::BTreeMap;
use std::path::Path;

const MIMETYPE: &str = "mimetype";
const MIME: &str = "image/openraster";
const DOCUMENT: &str = "rilievo/document.json";
const MANIFEST: &str = "rilievo/manifest.json";
const STACK: &str = "stack.xml";
const MERGED: &str = "mergedimage.png";
const THUMBNAIL: &str = "Thumbnails/thumbnail.png";
/// Longest side of the thumbnail, px, as OpenRaster wants it.
const THUMBNAIL_PX: u32 = 256;

/// The bytes of a project; `None` if cancelled. `file` is for messages.
///
/// The same document gives the same bytes, and so does the document read back from them.
pub fn write(file: &Path, document: &Document, progress: &Progress) -> Cancellable<Vec<u8>> {
    let items = plan::plan(document);
    let paint = look::paint(file, document)?;
    let Some(looks) = look::render(file, document, &items, progress)? else { return Ok(None) };
    let Some(merged) = flatten(document, progress) else { return Ok(None) };
    let pictures: Vec<(String, Encoded)> =
        looks.into_iter().enumerate().map(|(i, look)| (format!("data/{i:03}.png"), look)).collect();
    let shown = shown_alone(&items, &pictures);

    let shared = shown.iter().filter(|(id, (_, look))| paint.get(id) == Some(look));
    let shared = shared.map(|(id, (name, _))| (*id, name.clone())).collect();
    let mut assets = Assets::default();
    let renamed = assets.rename(file, document, &Painted { pixels: &paint, shared: &shared })?;
    let xml = stack::write(document.size, &items, &pictures);
    let manifest = Manifest::new(document, &xml, &shown);

    let json = |value: &serde_json::Value| format!("{value:#}\n").into_bytes();
    let packed = || {
        let mut packer = Packer::default();
        packer.store(MIMETYPE, MIME.as_bytes())?;
        packer.deflate(DOCUMENT, &json(&recipe::write(&renamed)))?;
        packer.deflate(MANIFEST, &json(&manifest.write()))?;
        packer.deflate(STACK, xml.as_bytes())?;
        for (name, picture) in &pictures {
            packer.store(name, picture.file.bytes())?;
        }
        for (name, asset) in assets.files() {
            packer.store(name, asset.bytes())?;
        }
        Ok(packer)
    };
    let failed = |e: zip::result::ZipError| Error::unsupported(file, format!("the project cannot be packed ({e})"));
    let mut packer = packed().map_err(failed)?;
    let whole = merged.to_straight_rgba(document.size.rect());
    let (small, size) = thumbnail(&whole, document.size);
    for (name, rgba, size) in [(MERGED, &whole, document.size), (THUMBNAIL, &small, size)] {
        packer.store(name, pixels::encode_texels(file, rgba.as_chunks().0, size)?.bytes()).map_err(failed)?;
    }
    Ok(Some(packer.finish().map_err(failed)?))
}

/// A small version of straight pixels; of a small picture, the picture itself.
fn thumbnail(rgba: &[u8], size: Size) -> (Vec<u8>, Size) {
    let longer = size.width.max(size.height);
    let Some(picture) = image::RgbaImage::from_raw(size.width, size.height, rgba.to_vec()) else {
        return (vec![0; 4], Size::new(1, 1));
    };
    if longer <= THUMBNAIL_PX {
        return (picture.into_raw(), size);
    }
    let side = |n: u32| ((u64::from(n) * u64::from(THUMBNAIL_PX) / u64::from(longer)) as u32).max(1);
    let size = Size::new(side(size.width), side(size.height));
    (image::imageops::thumbnail(&picture, size.width, size.height).into_raw(), size)
}

/// The pictures that show one layer alone, with their names.
fn shown_alone<'a>(items: &[Item], pictures: &'a [(String, Encoded)]) -> BTreeMap<LayerId, &'a (String, Encoded)> {
    let shown = look::pictures_of(items).into_iter().zip(pictures);
    let alone = shown.filter_map(|(item, picture)| match &item.shows {
        Shows::Layer(layer) | Shows::Nothing(layer) => Some((layer.id, picture)),
        _ => None,
    });
    alone.collect()
}
