//! Converts a document to records: what Photoshop can express is kept, the rest becomes pixels; the document itself is
//! stored beside them. Floor 5. `emit` writes the records as bytes.

use super::{LayerRecord, PASS_THROUGH, RecordMask, RecordSection, emit, signature};
use crate::document::cache::EncodedPixels;
use crate::document::{Content, Document, LayerId, LayerLock, LayerMask, MaskKind, Progress, flatten};
use crate::math::{Rect, Size};
use crate::project::look::{self, Cancellable};
use crate::project::plan::{FormatSupport, ItemContent, PlanItem, plan};
use crate::project::{self, pixels};
use crate::raster::BlendMode;
use crate::{Error, Result};
use std::collections::BTreeMap;
use std::path::Path;

/// A side of a file of this kind.
const LONGEST_PX: u32 = 30_000;

/// A Photoshop file, and notes on what other programs show differently.
pub struct WrittenPsd {
    pub bytes: Vec<u8>,
    pub notes: Vec<String>,
}

/// The bytes of a Photoshop file, 8 bits a channel; `None` if cancelled. `file` is for messages.
pub fn write(file: &Path, document: &Document, progress: &Progress) -> Cancellable<WrittenPsd> {
    if document.size.width.max(document.size.height) > LONGEST_PX {
        let reason = format!("a Photoshop file has at most {LONGEST_PX} pixels a side, not {}", document.size);
        return Err(Error::unsupported(file, reason));
    }
    let items = plan(document, FormatSupport::PHOTOSHOP);
    let paint = look::paint(file, document)?;
    let Some(looks) = look::render(file, document, &items, progress)? else { return Ok(None) };
    let Some(merged) = flatten(document, progress) else { return Ok(None) };
    let mut lowering = RecordBuilder { size: document.size, looks: looks.into_iter(), ..RecordBuilder::default() };
    lowering.items(file, &items)?;
    let RecordBuilder { records, shown, notes, .. } = lowering;
    let shown: BTreeMap<LayerId, &(String, EncodedPixels)> = shown.iter().map(|(id, picture)| (*id, picture)).collect();
    let ours = project::documents(file, document, &paint, &shown, signature(&records))?;
    let ours = project::packed(file, &ours)?;
    let merged = merged.to_straight_rgba(document.size.rect());
    Ok(Some(WrittenPsd { bytes: emit::emit(document.size, &records, &merged, &ours), notes }))
}

/// Records in the making.
struct RecordBuilder {
    size: Size,
    /// Of the plan's pictures, in their order.
    looks: std::vec::IntoIter<EncodedPixels>,
    records: Vec<LayerRecord>,
    /// The records that show a single layer, for the manifest.
    shown: Vec<(LayerId, (String, EncodedPixels))>,
    notes: Vec<String>,
}

impl Default for RecordBuilder {
    fn default() -> Self {
        let looks = Vec::new().into_iter();
        Self { size: Size::new(1, 1), looks, records: Vec::new(), shown: Vec::new(), notes: Vec::new() }
    }
}

impl RecordBuilder {
    fn items(&mut self, file: &Path, items: &[PlanItem]) -> Result<()> {
        items.iter().try_for_each(|item| self.item(file, item))
    }
    fn item(&mut self, file: &Path, item: &PlanItem) -> Result<()> {
        if let ItemContent::Stack { isolated, items } = &item.shows {
            self.records.push(LayerRecord {
                name: "</Layer group>".into(),
                section: RecordSection::End,
                ..LayerRecord::default()
            });
            self.items(file, items)?;
            let blend = if *isolated { key(item.blend) } else { PASS_THROUGH };
            let mask = item.mask.as_ref().and_then(|mask| self.mask(mask));
            self.records.push(LayerRecord { blend, mask, section: RecordSection::Group, ..record(item) });
            return Ok(());
        }
        let damaged = || Error::unsupported(file, "a layer could not be encoded; nothing was saved");
        let look = self.looks.next().ok_or_else(damaged)?;
        let rgba = pixels::decoded(look.file.bytes()).ok_or_else(damaged)?;
        let is_empty = rgba.chunks_exact(4).all(|pixel| pixel[3] == 0);
        let (x1, y1) = (look.x + look.size.width as i32, look.y + look.size.height as i32);
        let (rect, rgba) = if is_empty { (Rect::EMPTY, Vec::new()) } else { (Rect::new(look.x, look.y, x1, y1), rgba) };
        let mask = item.mask.as_ref().and_then(|mask| self.mask(mask));
        match &item.shows {
            ItemContent::Layer(layer) | ItemContent::Nothing(layer) => {
                if !matches!(layer.content, Content::Pixels(_)) {
                    self.notes.push(format!("“{}” is live here and pixels for other programs", item.name));
                }
                let name = format!("data/{:03}.png", self.records.len());
                self.shown.push((layer.id, (name, look)));
            }
            _ => self.notes.push(format!("“{}” is composed of several layers for other programs", item.name)),
        }
        self.records.push(LayerRecord { rect, rgba, mask, ..record(item) });
        Ok(())
    }
    /// A mask of a picture; derived ones are in the layer's pixels.
    fn mask(&self, mask: &LayerMask) -> Option<RecordMask> {
        let MaskKind::File { coverage, .. } = &mask.kind else { return None };
        if mask.disabled {
            return None;
        }
        let way = |v: &u8| if mask.invert { 255 - v } else { *v };
        Some(RecordMask {
            rect: self.size.rect(),
            outside: 0,
            values: coverage.values().iter().map(way).collect(),
            disabled: false,
        })
    }
}

/// The key of a mode; hidden parts may have one that the format has not.
fn key(blend: BlendMode) -> [u8; 4] {
    if blend == BlendMode::Plus { BlendMode::LinearDodge.photoshop() } else { blend.photoshop() }
}

/// What an item says of itself.
fn record(item: &PlanItem) -> LayerRecord {
    LayerRecord {
        name: item.name.clone(),
        blend: key(item.blend),
        opacity: (item.opacity * 255.0).round() as u8,
        clipped: item.clipped,
        visible: item.visible,
        // A fully locked layer also has its transparency locked.
        lock_alpha: item.lock != LayerLock::None,
        lock_all: item.lock == LayerLock::All,
        ..LayerRecord::default()
    }
}
