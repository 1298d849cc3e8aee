//! Reads a project: as it was saved, as far as it is intact, or as another program changed it.
//! Floor 5.

use super::layer_preview::{cache_previews, encode_paint};
use super::manifest::{Manifest, ManifestPicture};
use super::png_header::png_size;
use super::reader::ProjectReader;
use super::{Archive, DOCUMENT, MANIFEST, MERGED, STACK, foreign, krita, repair, stack};
use crate::document::EncodedPixels;
use crate::document::{Content, Document, Layer, LayerId};
use crate::math::{ColorProfile, Size};
use crate::raster::Asset;
use crate::raster::tile::TILE_AREA;
use crate::recipe::{self, RecipeSource, TileGrids};
use crate::{Budget, picture};
use crate::{Error, Result};
use rayon::prelude::*;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// The picture that a drawing of Procreate holds of itself.
const PROCREATE_PREVIEW: &str = "QuickLook/Thumbnail.png";
const PROCREATE_NOTE: &str = "it is a Procreate drawing, shown by its small preview; for its \
     layers, share it as PSD in Procreate";

/// The result of reading a project.
pub struct ProjectContents {
    /// What the project holds.
    pub document: Document,
    /// What differs from the saved state, a sentence each, for the user.
    pub notes: Vec<String>,
    /// Whether nothing was lost. A document that is not whole must not overwrite its file without
    /// asking.
    pub is_whole: bool,
    /// The merged picture that the file holds besides the layers, as a PNG.
    pub picture: Option<Asset>,
}

/// Reads a project of ours, or any OpenRaster file. Fails only if nothing can be recovered.
pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<ProjectContents> {
    let archive = Archive::open(file, bytes, budget)?;
    let (notes, known) = (Vec::new(), Vec::new());
    let profile = ColorProfile::default();
    let mut reading =
        ProjectReader { file, archive: &archive, budget, profile, notes, is_whole: true, known };
    if archive.is_damaged() {
        reading.note_loss(
            "the file's table of contents is damaged; its entries were found without it",
        );
    }
    let document = reading.document()?;
    let ProjectReader { mut notes, is_whole, .. } = reading;
    notes.extend(document.notes_of_parts());
    // Without it the layers are painted before anything is seen.
    let picture =
        archive.has_entry(MERGED).then(|| archive.bytes(MERGED, budget.file_bytes).ok()).flatten();
    Ok(ProjectContents { document, notes, is_whole, picture: picture.map(Asset::from) })
}

/// Reads a project that was just made from a document, and compares the two; everything saved must
/// come back unchanged.
///
/// Pixels whose bytes were already decoded and compared after encoding are not decoded again. Fails
/// with a sentence that says what would not come back.
pub fn read_back(file: &Path, bytes: &[u8], document: &Document, budget: &Budget) -> Result<()> {
    let lost = |what: String| {
        Err(Error::unsupported_file(file, format!("the drawing would not open as it is: {what}")))
    };
    let archive = Archive::open(file, bytes, budget)?;
    let paint = encode_paint(file, document)?;
    let known = document.walk().into_iter().filter_map(|(_, layer)| match &layer.content {
        Content::Pixels(pixels) => Some((paint.get(&layer.id)?.clone(), pixels.tiles.clone())),
        _ => None,
    });
    let known = known.collect();
    let mut reading = ProjectReader {
        file,
        archive: &archive,
        budget,
        profile: document.profile,
        notes: Vec::new(),
        is_whole: true,
        known,
    };
    match reading.document() {
        Err(error) => lost(error.to_string()),
        Ok(_) if !reading.notes.is_empty() => lost(reading.notes.join("; ")),
        Ok(read) => document.difference(&read).map_or(Ok(()), lost),
    }
}

impl ProjectReader<'_> {
    fn document(&mut self) -> Result<Document> {
        let manifest = self.manifest();
        let stack = self
            .archive
            .has_entry(STACK)
            .then(|| self.archive.bytes(STACK, self.budget.json_bytes));
        let parsed = match self.archive.has_entry(DOCUMENT) {
            false => None,
            true => match self.value(DOCUMENT) {
                Ok(value) => Some(value),
                Err(error) => {
                    self.note_loss(format!("{error}; only the layers' pictures are left"));
                    None
                }
            },
        };
        let Some(value) = parsed else { return self.pictures_only(stack) };
        self.profile = recipe::profile_of(&value);
        let stack_crc =
            stack.as_ref().and_then(|text| text.as_ref().ok()).map(|text| crc32fast::hash(text));
        match (&manifest, stack) {
            (Some(manifest), Some(Ok(text))) if stack_crc != Some(manifest.stack) => {
                let restored = foreign::restore(self, &text, &value, manifest);
                restored.or_else(|error| {
                    if self.can_fit_if_rounded(&error) {
                        return Err(error);
                    }
                    self.note_loss(format!("{error}; the layers are as Rilievo saved them"));
                    self.read_document(value, Some(manifest))
                })
            }
            _ => self.read_document(value, manifest.as_ref()),
        }
    }

    fn value(&self, name: &str) -> Result<Value> {
        let text = self.archive.bytes(name, self.budget.json_bytes)?;
        recipe::parse(&self.archive_path(name), &text, self.budget)
    }

    fn manifest(&mut self) -> Option<Manifest> {
        if !self.archive.has_entry(MANIFEST) {
            if self.archive.has_entry(DOCUMENT) {
                self.note("the list of the layers' pictures is missing; changes by other programs cannot be detected");
            }
            return None;
        }
        let read = self.value(MANIFEST).ok().as_ref().and_then(Manifest::read);
        if read.is_none() {
            self.note("the list of the layers' pictures is damaged; changes by other programs cannot be detected");
        }
        read
    }

    /// The document as it was saved, with what another program changed and without what is damaged.
    fn read_document(&mut self, mut value: Value, manifest: Option<&Manifest>) -> Result<Document> {
        let intact = manifest
            .map(|manifest| repair::check_pictures(self, &mut value, manifest))
            .unwrap_or_default();
        let path = self.archive_path(DOCUMENT);
        let source =
            RecipeSource { file: &path, files: self.archive, budget: self.budget, onto: None };
        let document = match recipe::read_with_tiles(&value, source, self.decode_ahead(&value)) {
            Ok(document) => document,
            Err(error) => {
                // A newer version or a field out of range is no damage: leaving something out would
                // not help.
                if self.can_fit_if_rounded(&error)
                    || !repair::leave_out_damaged(self, &mut value, manifest)
                {
                    return Err(error);
                }
                self.read_value(&value)?
            }
        };
        let of_this_program = manifest.is_some_and(Manifest::is_of_this_program);
        if of_this_program {
            // A Photoshop file, which has no stack.xml, keeps masks beside the pixels of layers.
            let has_masks_in_pixels = self.archive.has_entry(STACK);
            cache_previews(&document, &previews(&document, intact, has_masks_in_pixels));
        }
        Ok(document)
    }

    /// The pixels of the paint layers, decoded in parallel; failures are reported later, in order.
    fn decode_ahead(&self, value: &Value) -> TileGrids {
        let mut wanted = BTreeSet::new();
        list_paint(&value["layers"], &mut wanted);
        let left_px = AtomicU64::new(self.budget.document_px);
        let left_bytes = AtomicU64::new(self.budget.memory_bytes);
        let budget = self.picture_budget();
        let one = |key: (String, i32, i32)| {
            let bytes = self.archive.bytes(&key.0, self.budget.file_bytes).ok()?;
            let size = png_size(&bytes)?;
            self.budget.size(self.file, size.width.into(), size.height.into()).ok()?;
            let known = self.known.iter().find(|(known, _)| {
                (known.x, known.y, known.size) == (key.1, key.2, size)
                    && known.file.bytes() == bytes
            });
            let known = known.map(|(_, tiles)| tiles.clone());
            let read =
                || picture::decode_paint(Path::new(&key.0), &bytes, key.1, key.2, &budget).ok();
            let tiles = known.or_else(|| Some(read()?.tiles))?;
            // Pixels in memory count, not the rectangle around them.
            let px = (tiles.iter().count() * TILE_AREA) as u64;
            left_px
                .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left: u64| {
                    left.checked_sub(px)
                })
                .ok()?;
            let bytes = tiles.bytes() as u64;
            left_bytes
                .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left: u64| {
                    left.checked_sub(bytes)
                })
                .ok()?;
            Some((key.clone(), tiles))
        };
        wanted.into_par_iter().filter_map(one).collect()
    }

    /// Without a document: what any program sees.
    fn pictures_only(&mut self, stack: Option<Result<Vec<u8>>>) -> Result<Document> {
        let layers = match stack {
            Some(Ok(text)) => stack::read(self.file, &text, self.budget),
            Some(Err(error)) => Err(error),
            None if self.archive.has_entry(krita::MAINDOC) => {
                let read = krita::document(self);
                return read.or_else(|error| match self.can_fit_if_rounded(&error) {
                    true => Err(error),
                    false => foreign::leftovers(self, error),
                });
            }
            None if self.archive.has_entry(PROCREATE_PREVIEW) => {
                return foreign::read_stored_picture(self, PROCREATE_PREVIEW, PROCREATE_NOTE);
            }
            None => {
                Err(Error::decode(self.file, "it is not an OpenRaster file: it has no stack.xml"))
            }
        };
        match layers {
            Ok(layers) => {
                // Its layers are in the profile of the picture of them all.
                let merged = self.archive.bytes(MERGED, self.budget.file_bytes);
                self.profile = merged.map_or(self.profile, |png| {
                    picture::profile_of(Path::new(MERGED), &png, self.budget)
                });
                foreign::document(self, layers)
            }
            Err(error) => foreign::leftovers(self, error),
        }
    }
}

/// The file and the corner of every paint layer.
fn list_paint(layers: &Value, out: &mut BTreeSet<(String, i32, i32)>) {
    for layer in layers.as_array().into_iter().flatten() {
        let corner = |name: &str| match layer.get(name) {
            None => Some(0),
            Some(value) => {
                value.as_i64().and_then(|v| i32::try_from(v).ok()).filter(|v| v.abs() <= 1_000_000)
            }
        };
        if let (Some("pixels"), Some(file)) = (layer["kind"].as_str(), layer["file"].as_str())
            && let (Some(x), Some(y)) = (corner("x"), corner("y"))
        {
            out.insert((file.to_owned(), x, y));
        }
        list_paint(&layer["layers"], out);
    }
}

/// The pictures by the layers they show, if they show them as they look here.
fn previews(
    document: &Document,
    intact: Vec<(ManifestPicture, Asset, Size)>,
    has_masks_in_pixels: bool,
) -> BTreeMap<LayerId, EncodedPixels> {
    let mut by_path: BTreeMap<String, EncodedPixels> = intact
        .into_iter()
        .filter(|(shown, ..)| !shown.whole_rim)
        .map(|(shown, file, size)| {
            (shown.layer, EncodedPixels { file, size, x: shown.x, y: shown.y })
        })
        .collect();
    let is_whole = |layer: &Layer| has_masks_in_pixels || layer.mask.is_none();
    let walk = document.walk().into_iter().filter(|(_, layer)| is_whole(layer));
    walk.filter_map(|(path, layer)| Some((layer.id, by_path.remove(&path)?))).collect()
}
