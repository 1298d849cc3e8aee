//! Builds a document from a Photoshop file's records: ours as it was written, others as far as both programs agree.
//! Floor 5. Parsing is in `parse`.

use super::parse::{ParsedPsd, parse};
use super::{LayerRecord, PASS_THROUGH, RecordMask, RecordSection, signature};
use crate::document::{Content, Document, Group, Layer, LayerLock, LayerMask, MaskKind, PixelLayer};
use crate::math::Size;
use crate::project::archive::Archive;
use crate::project::manifest::Manifest;
use crate::project::packer::ZipPacker;
use crate::project::{self, ProjectContents, pixels};
use crate::raster::{BlendMode, Plane, TileGrid};
use crate::{Budget, picture};
use crate::{Error, Result};
use std::path::Path;
use std::sync::Arc;

/// Reads a Photoshop file; what was not imported is in the notes.
pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<ProjectContents> {
    let mut parsed = parse(file, bytes, budget)?;
    let damage = std::mem::take(&mut parsed.damage);
    let mut notes = damage.clone();
    if let Some(ours) = parsed.ours {
        match restored(file, ours, &parsed.records, budget) {
            Ok(Some(contents)) => {
                notes.extend(contents.notes);
                return Ok(ProjectContents { is_whole: contents.is_whole && damage.is_empty(), notes, ..contents });
            }
            Ok(None) => notes.push("the layers were changed by another program: live layers became pixels".into()),
            Err(error) => notes.push(format!("live layers became pixels: {error}")),
        }
    }
    if parsed.is_deep {
        notes.push("its 16 bits a channel became 8".into());
    }
    let records = layers_of(&mut parsed);
    let mut builder = TreeBuilder { size: parsed.size, deepest: budget.group_depth, open: vec![Vec::new()], notes };
    records.into_iter().for_each(|record| builder.add(record));
    let (layers, notes) = builder.done();
    let document = Document { layers, ..Document::empty(parsed.size) };
    Ok(ProjectContents { document, notes, is_whole: damage.is_empty() })
}

/// The document that our own resource holds, the layers' pixels taken from the file; `None` if the layers were changed.
fn restored(file: &Path, ours: &[u8], records: &[LayerRecord], budget: &Budget) -> Result<Option<ProjectContents>> {
    let archive = Archive::open(file, ours, budget)?;
    let damaged = |e: zip::result::ZipError| Error::decode(file, format!("our part of the file is damaged ({e})"));
    let text = archive.bytes(project::MANIFEST, budget.json_bytes)?;
    let manifest = serde_json::from_slice(&text).ok().as_ref().and_then(Manifest::read);
    let manifest = manifest.ok_or_else(|| Error::decode(file, "our part of the file is damaged"))?;
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

/// The records, in the colours of this program; of a file without layers its picture.
fn layers_of(parsed: &mut ParsedPsd) -> Vec<LayerRecord> {
    let mut records = std::mem::take(&mut parsed.records);
    if let (true, Some(rgba)) = (records.is_empty(), parsed.merged.take()) {
        let background =
            LayerRecord { name: "Background".into(), rect: parsed.size.rect(), rgba, ..LayerRecord::default() };
        records.push(background);
    }
    if let Some(icc) = parsed.icc.filter(|icc| !picture::is_own_srgb(icc)) {
        for record in records.iter_mut().filter(|record| !record.rgba.is_empty()) {
            let size = Size::new(record.rect.width() as u32, record.rect.height() as u32);
            record.rgba = picture::to_srgb(size, std::mem::take(&mut record.rgba), parsed.is_grey, icc);
        }
    }
    records
}

/// Collects layers bottom first, with a list for each open group.
struct TreeBuilder {
    size: Size,
    /// The greatest depth of groups.
    deepest: usize,
    open: Vec<Vec<Arc<Layer>>>,
    notes: Vec<String>,
}

impl TreeBuilder {
    fn add(&mut self, record: LayerRecord) {
        for what in &record.lost {
            self.notes.push(format!("“{}”: {what}", record.name));
        }
        let layer = match record.section {
            RecordSection::End => return self.open.push(Vec::new()),
            RecordSection::Group => {
                // A group without a beginning is empty.
                let layers = if self.open.len() > 1 { self.open.pop().unwrap_or_default() } else { Vec::new() };
                if self.open.len() > self.deepest {
                    self.notes
                        .push(format!("“{}” is nested too deep: its layers stand in the group around it", record.name));
                    return self.open.last_mut().map_or((), |list| list.extend(layers));
                }
                let group = Group { layers, pass_through: record.blend == PASS_THROUGH };
                self.layer(record, Content::Group(group))
            }
            RecordSection::Layer => {
                let (w, h) = (record.rect.width(), record.rect.height());
                let (x, y) = (record.rect.x0, record.rect.y0);
                let tiles = match record.rect.is_empty() {
                    true => TileGrid::default(),
                    false => TileGrid::from_straight_rgba(&record.rgba, w, h, x, y),
                };
                self.layer(record, Content::Pixels(PixelLayer { file: String::new(), x, y, tiles }))
            }
        };
        if let Some(list) = self.open.last_mut() {
            list.push(Arc::new(layer));
        }
    }
    fn layer(&mut self, record: LayerRecord, content: Content) -> Layer {
        let known = BlendMode::from_photoshop(record.blend);
        if known.is_none() && record.blend != PASS_THROUGH {
            let key = String::from_utf8_lossy(&record.blend).into_owned();
            let reason =
                format!("“{}” is blended by “{}” elsewhere; here it is blended normally", record.name, key.trim());
            self.notes.push(reason);
        }
        Layer {
            visible: record.visible,
            opacity: f32::from(record.opacity) / 255.0,
            blend: known.unwrap_or(BlendMode::Normal),
            clip_below: record.clipped,
            lock: match (record.lock_all, record.lock_alpha) {
                (true, _) => LayerLock::All,
                (false, true) => LayerLock::Alpha,
                (false, false) => LayerLock::None,
            },
            mask: record.mask.as_ref().map(|mask| self.mask(mask)),
            clip_to_surface: false,
            ..Layer::new(record.name, content)
        }
    }
    fn mask(&self, mask: &RecordMask) -> LayerMask {
        let rect = mask.rect;
        let value = |x: i32, y: i32| {
            let at = (y - rect.y0) as usize * rect.width() + (x - rect.x0) as usize;
            mask.values.get(at).copied().unwrap_or(mask.outside)
        };
        let coverage = Plane::from_fn(self.size, |x, y| {
            let (x, y) = (x as i32, y as i32);
            if rect.contains(x, y) { value(x, y) } else { mask.outside }
        });
        LayerMask::new(MaskKind::File { file: String::new(), coverage: Arc::new(coverage) })
    }
    /// Groups that were never closed end with the file.
    fn done(mut self) -> (Vec<Arc<Layer>>, Vec<String>) {
        while self.open.len() > 1 {
            let layers = self.open.pop().unwrap_or_default();
            if let Some(list) = self.open.last_mut() {
                list.extend(layers);
            }
        }
        (self.open.pop().unwrap_or_default(), self.notes)
    }
}
