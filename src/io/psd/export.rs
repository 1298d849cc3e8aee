//! Converts a document to records: what Photoshop can express is kept, the rest becomes pixels; the
//! document itself is stored with them. Floor 5. `write` makes bytes of the records, `verify` reads
//! them again.

use super::isolation::can_be_isolated;
use super::write::{FileMarks, encode_file, on_white};
use super::{
    LayerRecord, MOST_RECORDS, PASS_THROUGH, RecordMask, RecordSection, adjustments,
    alpha_channels, cursor, effects, marks, shape, signature, verify,
};
use crate::document::EncodedPixels;
use crate::document::{
    Content, Document, LayerId, LayerLock, LayerMask, MaskKind, Progress, flatten,
};
use crate::math::{ColorProfile, Rect};
use crate::memory;
use crate::project::layer_preview::{self, Cancelable};
use crate::project::plan::{FormatSupport, ItemContent, PlanItem, plan};
use crate::raster::{BlendMode, TileGrid};
use crate::{Error, Result};
use crate::{pixels, project};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A side of a file of this kind.
const LONGEST_PX: u32 = 30_000;
/// A file of this kind; PSB, which may be longer, is not written.
const LONGEST_BYTES: usize = (2 << 30) - 1;

/// A Photoshop file, and notes on what other programs show differently.
pub struct WrittenPsd {
    pub bytes: Vec<u8>,
    pub notes: Vec<String>,
}

/// The bytes of a Photoshop file, 8 bits a channel; `None` if canceled. `file` is for messages.
///
/// They are read again as any file is, and compared: every record and pixel, the merged picture,
/// and the document that comes back live. Fails with a sentence that says what would not come back,
/// or which limit of the format is passed.
pub fn write(file: &Path, document: &Document, progress: &Progress) -> Cancelable<WrittenPsd> {
    if document.size.width.max(document.size.height) > LONGEST_PX {
        let reason = format!(
            "a Photoshop file has at most {LONGEST_PX} pixels a side, not {}",
            document.size
        );
        return Err(Error::unsupported_file(file, reason));
    }
    let items = plan(document, FormatSupport::PHOTOSHOP);
    let paint = layer_preview::encode_paint(file, document)?;
    let Some(previews) = layer_preview::render(file, document, &items, progress)? else {
        return Ok(None);
    };
    let Some(merged) = flatten(document, progress) else { return Ok(None) };
    let mut builder = RecordBuilder {
        document,
        profile: document.profile,
        previews: previews.into_iter(),
        records: Vec::new(),
        shown: Vec::new(),
        whole_rims: BTreeSet::new(),
        notes: Vec::new(),
        is_hidden: false,
    };
    builder.items(file, &items)?;
    let RecordBuilder { mut records, shown, whole_rims, mut notes, .. } = builder;
    shape::drop_parted(&mut records);
    if records.len() > MOST_RECORDS {
        let reason = format!(
            "its layers would be {} for Photoshop, which may be {MOST_RECORDS}",
            records.len()
        );
        return Err(Error::unsupported_file(file, reason));
    }
    let shown: BTreeMap<LayerId, &(String, EncodedPixels)> =
        shown.iter().map(|(id, picture)| (*id, picture)).collect();
    let ours =
        project::documents(file, document, &paint, &shown, signature(&records), &whole_rims)?;
    let ours = project::pack_zip(file, &ours)?;
    let merged = merged.to_straight_rgba(document.size.rect());
    let merged = on_white(&merged);
    let selections = alpha_channels::of_document(document);
    if selections.len() < document.selections.len() {
        notes.push(
            "selections beyond the first 52, and empty ones, are stored for this program only"
                .into(),
        );
    }
    let guides = marks::guides_to_write(document);
    let bytes = encode_file(
        document.size,
        &records,
        &merged,
        FileMarks {
            selections: &selections,
            guides: &guides,
            light: document.effect_light,
            profile: document.profile,
        },
        &ours,
    );
    if bytes.len() > LONGEST_BYTES {
        let reason = format!(
            "a Photoshop file has at most 2 GB, not {}",
            memory::bytes_text(bytes.len() as u64)
        );
        return Err(Error::unsupported_file(file, reason));
    }
    verify::read_back(
        file,
        &bytes,
        verify::Meant { document, records: &records, merged, selections, guides },
    )?;
    Ok(Some(WrittenPsd { bytes, notes }))
}

/// Records in the making.
struct RecordBuilder<'a> {
    document: &'a Document,
    /// The previews of the plan's pictures, in their order.
    profile: ColorProfile,
    previews: std::vec::IntoIter<EncodedPixels>,
    records: Vec<LayerRecord>,
    /// The records that show a single layer, for the manifest.
    shown: Vec<(LayerId, (String, EncodedPixels))>,
    /// The layers whose records cover the surface's rim wholly.
    whole_rims: BTreeSet<LayerId>,
    notes: Vec<String>,
    /// The items are in a group that is not visible.
    is_hidden: bool,
}

impl RecordBuilder<'_> {
    fn items(&mut self, file: &Path, items: &[PlanItem]) -> Result<()> {
        items.iter().try_for_each(|item| self.item(file, item))
    }

    fn item(&mut self, file: &Path, item: &PlanItem) -> Result<()> {
        self.tell_of_blending(item);
        if let ItemContent::Stack { isolated, items } = &item.shows {
            self.records.push(LayerRecord {
                name: "</Layer group>".into(),
                section: RecordSection::End,
                ..LayerRecord::default()
            });
            let first = self.records.len();
            let around = self.is_hidden;
            self.is_hidden |= !item.visible;
            self.items(file, items)?;
            self.is_hidden = around;
            let mask = item.mask.as_ref().and_then(|mask| self.mask(mask));
            let is_isolated = *isolated
                || (mask.is_some() && can_be_isolated(self.document.size, &self.records[first..]));
            if mask.is_some() && !is_isolated && item.visible && !self.is_hidden {
                self.notes
                    .push(format!("“{}” passes through, and Krita ignores its mask", item.name));
            }
            let blend = if is_isolated { key(item.blend) } else { PASS_THROUGH };
            self.records.push(LayerRecord {
                blend,
                mask,
                section: RecordSection::Group,
                ..record(item)
            });
            return Ok(());
        }
        let damaged =
            || Error::unsupported_file(file, "a layer could not be encoded; nothing was saved");
        let mut preview = self.previews.next().ok_or_else(damaged)?;
        let rgba = pixels::decode_png(preview.file.bytes()).ok_or_else(damaged)?;
        let is_16_bit = pixels::is_16_bit(preview.file.bytes());
        if is_16_bit || self.profile != ColorProfile::Srgb {
            // Our part of the file says what the record holds; it has all of the paint, too.
            preview = in_bytes(file, preview, &rgba)?;
        }
        if is_16_bit {
            self.notes.push(format!(
                "“{}” has 16 bits per channel here and 8 for other programs",
                item.name
            ));
        }
        let is_empty = rgba.chunks_exact(4).all(|pixel| pixel[3] == 0);
        let (x1, y1) =
            (preview.x + preview.size.width as i32, preview.y + preview.size.height as i32);
        let (rect, rgba) = if is_empty {
            (Rect::EMPTY, Vec::new())
        } else {
            (Rect::new(preview.x, preview.y, x1, y1), rgba)
        };
        let mask = item.mask.as_ref().and_then(|mask| self.mask(mask));
        let adjustment = match &item.shows {
            ItemContent::Nothing(layer) => adjustments::as_read(&layer.content),
            _ => None,
        };
        let mut made = LayerRecord { rect, rgba, mask, adjustment, ..record(item) };
        if let ItemContent::Layer(layer) = &item.shows
            && let Some(map) = self.document.map_of(layer.id)
        {
            shape::put(&mut made, self.document, &map.layer_on_canvas(layer));
        }
        match &item.shows {
            ItemContent::Layer(layer) | ItemContent::Nothing(layer) => {
                let is_said = made.adjustment.is_some() || made.path.is_some();
                if !matches!(layer.content, Content::Pixels(_)) && !is_said {
                    self.notes.push(format!(
                        "“{}” is live here and pixels for other programs",
                        item.name
                    ));
                }
                let name = format!("data/{:03}.png", self.records.len());
                self.shown.push((layer.id, (name, preview)));
                if item.whole_rim {
                    self.whole_rims.insert(layer.id);
                }
            }
            _ => self
                .notes
                .push(format!("“{}” is composed of several layers for other programs", item.name)),
        }
        self.records.push(made);
        Ok(())
    }

    /// What other programs read but compute differently.
    fn tell_of_blending(&mut self, item: &PlanItem) {
        if let Some(programs) = differs_in(item.blend).filter(|_| item.visible && !self.is_hidden) {
            let blend = item.blend.label().to_lowercase();
            self.notes.push(format!(
                "“{}” is blended by “{blend}”, shown otherwise by {programs}",
                item.name
            ));
        }
    }

    /// A mask of a picture; derived ones are in the layer's pixels.
    fn mask(&self, mask: &LayerMask) -> Option<RecordMask> {
        let MaskKind::File { coverage, .. } = &mask.kind else { return None };
        if mask.disabled {
            return None;
        }
        let way = |v: &u8| if mask.invert { 255 - v } else { *v };
        Some(RecordMask {
            rect: self.document.size.rect(),
            outside: 0,
            values: coverage.values().iter().map(way).collect(),
            disabled: false,
        })
    }
}

/// A preview as it is restored: of 8 bits, and without a profile, which the file has.
fn in_bytes(file: &Path, preview: EncodedPixels, rgba: &[u8]) -> Result<EncodedPixels> {
    if rgba.chunks_exact(4).all(|pixel| pixel[3] == 0) {
        return pixels::encode(file, &TileGrid::default(), None, ColorProfile::Srgb);
    }
    Ok(EncodedPixels {
        file: pixels::encode_texels(file, rgba.as_chunks().0, preview.size)?,
        ..preview
    })
}

/// Programs that read the format's word for a mode and compute it otherwise, as was measured
/// (docs/PROJECTS.md).
fn differs_in(blend: BlendMode) -> Option<&'static str> {
    match blend {
        BlendMode::SoftLight => Some("Krita and GIMP"),
        BlendMode::Hue | BlendMode::Saturation | BlendMode::Color | BlendMode::Luminosity => {
            Some("GIMP 2.10")
        }
        BlendMode::DarkerColor | BlendMode::LighterColor => Some("GIMP 2.10"),
        _ => None,
    }
}

/// The key of a mode; hidden parts may have one that the format has not.
fn key(blend: BlendMode) -> [u8; 4] {
    if blend == BlendMode::Plus { BlendMode::LinearDodge.photoshop() } else { blend.photoshop() }
}

/// The properties of an item.
fn record(item: &PlanItem) -> LayerRecord {
    LayerRecord {
        // As it will be read; our own name is stored as well, with its blanks.
        name: cursor::shown_text(&item.name),
        blend: key(item.blend),
        opacity: (item.opacity * 255.0).round() as u8,
        clipped: item.clipped,
        visible: item.visible,
        // A fully locked layer also has its transparency locked.
        lock_alpha: item.lock != LayerLock::None,
        lock_all: item.lock == LayerLock::All,
        label: marks::nearest_label(item.label),
        effects: effects::as_read(&item.effects),
        fill_opacity: (item.fill_opacity * 255.0).round() as u8,
        ..LayerRecord::default()
    }
}
