//! Reads a project: as it was saved, as far as it is intact, or as another program changed it.
//! Floor 5.

use super::look::remember;
use super::manifest::{Manifest, ManifestPicture};
use super::{Archive, DOCUMENT, MANIFEST, STACK, foreign, pixels, repair, stack};
use crate::document::cache::EncodedPixels;
use crate::document::{Document, LayerId};
use crate::math::Size;
use crate::raster::Asset;
use crate::recipe::{self, RecipeSource, TileGrids};
use crate::{Budget, json, picture};
use crate::{Error, Result};
use rayon::prelude::*;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// The result of reading a project.
pub struct ProjectContents {
    pub document: Document,
    /// What differs from the saved state, a sentence each, for the user.
    pub notes: Vec<String>,
    /// Whether nothing was lost. A document that is not whole must not overwrite its file without asking.
    pub is_whole: bool,
}

/// Reads a project of ours, or any OpenRaster file. Fails only if nothing can be recovered.
pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<ProjectContents> {
    let archive = Archive::open(file, bytes, budget)?;
    let mut reading = ProjectReader { file, archive: &archive, budget, notes: Vec::new(), is_whole: true };
    if archive.is_damaged() {
        reading.lost("the file's table of contents is damaged; its entries were found without it");
    }
    let document = reading.document()?;
    Ok(ProjectContents { document, notes: reading.notes, is_whole: reading.is_whole })
}

/// A project being read, and the notes on it.
pub struct ProjectReader<'a> {
    pub file: &'a Path,
    pub archive: &'a Archive<'a>,
    pub budget: &'a Budget,
    pub notes: Vec<String>,
    pub is_whole: bool,
}

impl ProjectReader<'_> {
    /// Notes a difference that loses nothing.
    pub fn note(&mut self, sentence: impl Into<String>) {
        self.notes.push(sentence.into());
    }
    /// Notes a loss.
    pub fn lost(&mut self, sentence: impl Into<String>) {
        self.is_whole = false;
        self.notes.push(sentence.into());
    }
    fn document(&mut self) -> Result<Document> {
        let manifest = self.manifest();
        let stack = self.archive.has(STACK).then(|| self.archive.bytes(STACK, self.budget.json_bytes));
        let parsed = match self.archive.has(DOCUMENT) {
            false => None,
            true => match self.value(DOCUMENT) {
                Ok(value) => Some(value),
                Err(error) => {
                    self.lost(format!("{error}; what is left are the layers' pictures"));
                    None
                }
            },
        };
        let Some(value) = parsed else { return self.pictures_only(stack) };
        let stack_crc = stack.as_ref().and_then(|text| text.as_ref().ok()).map(|text| crc32fast::hash(text));
        match (&manifest, stack) {
            (Some(manifest), Some(Ok(text))) if stack_crc != Some(manifest.stack) => {
                let restored = foreign::restored(self, &text, &value, manifest);
                restored.or_else(|error| {
                    self.lost(format!("{error}; the layers are as Rilievo saved them"));
                    self.own(value, Some(manifest))
                })
            }
            _ => self.own(value, manifest.as_ref()),
        }
    }
    fn value(&self, name: &str) -> Result<Value> {
        let text = self.archive.bytes(name, self.budget.json_bytes)?;
        json::parse(&self.archive_path(name), &text, self.budget)
    }
    pub fn archive_path(&self, name: &str) -> std::path::PathBuf {
        use crate::Files;
        self.archive.path(name)
    }
    fn manifest(&mut self) -> Option<Manifest> {
        if !self.archive.has(MANIFEST) {
            if self.archive.has(DOCUMENT) {
                self.note("the list of the layers' pictures is missing; changes by other programs cannot be told");
            }
            return None;
        }
        let read = self.value(MANIFEST).ok().as_ref().and_then(Manifest::read);
        if read.is_none() {
            self.note("the list of the layers' pictures is damaged; changes by other programs cannot be told");
        }
        read
    }
    /// The document as it was saved, with what another program changed and without what is damaged.
    fn own(&mut self, mut value: Value, manifest: Option<&Manifest>) -> Result<Document> {
        let intact = manifest.map(|manifest| repair::check_pictures(self, &mut value, manifest)).unwrap_or_default();
        let path = self.archive_path(DOCUMENT);
        let source = RecipeSource { file: &path, files: self.archive, budget: self.budget, onto: None };
        let document = match recipe::read_with_tiles(&value, source, self.decoded_ahead(&value)) {
            Ok(document) => document,
            Err(error) => {
                // A newer version or a field out of range is no damage: leaving something out would not help.
                if !repair::leave_out_damaged(self, &mut value, manifest) {
                    return Err(error);
                }
                self.read_value(&value)?
            }
        };
        let of_this_program = manifest.is_some_and(Manifest::is_of_this_program);
        if of_this_program {
            remember(&document, &looks(&document, intact));
        }
        Ok(document)
    }
    /// The pixels of the paint layers, decoded in parallel; failures are reported later, in order.
    fn decoded_ahead(&self, value: &Value) -> TileGrids {
        let mut wanted = BTreeSet::new();
        list_paint(&value["layers"], &mut wanted);
        let left_px = AtomicU64::new(self.budget.document_px);
        let one = |key: (String, i32, i32)| {
            let bytes = self.archive.bytes(&key.0, self.budget.file_bytes).ok()?;
            let area = repair::png_size(&bytes)?.area() as u64;
            let less = |left: u64| left.checked_sub(area);
            left_px.fetch_update(Ordering::Relaxed, Ordering::Relaxed, less).ok()?;
            let quick = pixels::decode_tiles(&bytes, key.1, key.2, self.budget);
            let slow = || {
                let picture = picture::decode(Path::new(&key.0), &bytes, self.budget).ok()?;
                Some(picture::to_tiles(&picture, key.1, key.2))
            };
            Some((key.clone(), quick.or_else(slow)?))
        };
        wanted.into_par_iter().filter_map(one).collect()
    }
    pub fn read_value(&self, value: &Value) -> Result<Document> {
        let path = self.archive_path(DOCUMENT);
        recipe::read_value(value, RecipeSource { file: &path, files: self.archive, budget: self.budget, onto: None })
    }
    /// Without a document: what any program sees.
    fn pictures_only(&mut self, stack: Option<Result<Vec<u8>>>) -> Result<Document> {
        let layers = match stack {
            Some(Ok(text)) => stack::read(self.file, &text, self.budget),
            Some(Err(error)) => Err(error),
            None => Err(Error::decode(self.file, "it is no OpenRaster file: there is no stack.xml in it")),
        };
        match layers {
            Ok(layers) => foreign::document(self, layers),
            Err(error) => foreign::leftovers(self, error),
        }
    }
}

/// The file and the corner of every paint layer.
fn list_paint(layers: &Value, out: &mut BTreeSet<(String, i32, i32)>) {
    for layer in layers.as_array().into_iter().flatten() {
        let corner = |name: &str| match layer.get(name) {
            None => Some(0),
            Some(value) => value.as_i64().and_then(|v| i32::try_from(v).ok()).filter(|v| v.abs() <= 1_000_000),
        };
        if let (Some("pixels"), Some(file)) = (layer["kind"].as_str(), layer["file"].as_str())
            && let (Some(x), Some(y)) = (corner("x"), corner("y"))
        {
            out.insert((file.to_owned(), x, y));
        }
        list_paint(&layer["layers"], out);
    }
}

/// The pictures by the layers they show.
fn looks(document: &Document, intact: Vec<(ManifestPicture, Asset, Size)>) -> BTreeMap<LayerId, EncodedPixels> {
    let mut by_path: BTreeMap<String, EncodedPixels> = intact
        .into_iter()
        .map(|(shown, file, size)| (shown.layer, EncodedPixels { file, size, x: shown.x, y: shown.y }))
        .collect();
    let walk = document.walk().into_iter();
    walk.filter_map(|(path, layer)| Some((layer.id, by_path.remove(&path)?))).collect()
}
