//! Builds a document from a Photoshop file's records: ours as it was written, others as far as both
//! programs agree. Floor 5. Parsing is in `parse`.

use super::blocks::ArtboardBackground;
use super::colors::{Mode, StraightPixels};
use super::compare::check_against_merged;
use super::effects::RecordEffects;
use super::gray::GrayTones;
use super::inks::InkTones;
use super::parse::{ParsedPsd, parse};
use super::pattern::PatternResource;
use super::{LayerRecord, PASS_THROUGH, RecordMask, RecordSection, filled, marks, signature};
use crate::Budget;
use crate::document::{Content, Document, Group, Guides, Layer, LayerLock};
use crate::math::Size;
use crate::paint::effect::EffectPattern;
use crate::paint::{ColorAdjustment, LayerEffect};
use crate::pixels;
use crate::project::archive::Archive;
use crate::project::manifest::Manifest;
use crate::project::packer::ZipPacker;
use crate::project::{self, ProjectContents};
use crate::raster::BlendMode;
use crate::{Error, Remedy, Result};
use std::path::Path;
use std::sync::Arc;

/// Reads a Photoshop file; what was not imported is in the notes.
pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<ProjectContents> {
    let mut parsed = parse(file, bytes, budget)?;
    let damage = std::mem::take(&mut parsed.damage);
    let mut notes = damage.clone();
    if let Some(ours) = parsed.ours {
        match restore(file, ours, &parsed.records, budget) {
            Ok(Some(contents)) => {
                notes.extend(contents.notes);
                let document = with_guides_of(contents.document, parsed.guides.0);
                let is_whole = contents.is_whole && damage.is_empty();
                return Ok(ProjectContents { document, is_whole, notes, ..contents });
            }
            Ok(None) => notes.push(
                "the layers were changed by another program: live layers became pixels".into(),
            ),
            // Read again with paint of 8 bits, it may fit.
            Err(error)
                if budget.sixteen_bit_paint && error.remedy() == Some(Remedy::MoreMemory) =>
            {
                return Err(error);
            }
            Err(error) => notes.push(format!("live layers became pixels: {error}")),
        }
    }
    notes.extend(color_notes(&parsed));
    let (document, is_less) = build_document(&mut parsed, budget, &mut notes);
    if parsed.merged.is_some() {
        let compared = parsed.held_bytes.saturating_add(document.flattening_bytes());
        budget.room(file, "comparing its layers with its own picture", compared)?;
    }
    let document = check_against_merged(
        document,
        parsed.merged.take(),
        is_less || !damage.is_empty(),
        &mut notes,
    );
    Ok(ProjectContents { document, notes, is_whole: damage.is_empty(), picture: None })
}

/// The document that a file's records say, and whether something was left out.
pub(super) fn build_document(
    parsed: &mut ParsedPsd,
    budget: &Budget,
    notes: &mut Vec<String>,
) -> (Document, bool) {
    let size = parsed.header.size;
    let kept =
        parsed.merged.as_mut().map(|merged| (std::mem::take(&mut merged.selections), merged.inks));
    let kept = kept.unwrap_or_default();
    if parsed.records.is_empty() {
        use_merged(parsed);
    }
    // One level is kept for the group that the layers may be hidden in.
    let deepest = budget.group_depth.saturating_sub(1);
    let mut builder = TreeBuilder {
        size,
        deepest,
        patterns: &parsed.patterns,
        is_light: parsed.header.bits == 32,
        has_profile: parsed.has_profile,
        gray: parsed.gray.as_ref(),
        inks: parsed.inks.as_ref(),
        tables: 0,
        open: vec![Vec::new()],
        is_less: false,
        notes: std::mem::take(notes),
    };
    std::mem::take(&mut parsed.records).into_iter().for_each(|record| builder.add(record));
    let (layers, is_less, found_notes) = builder.finish();
    *notes = found_notes;
    let (selections, inks) = kept;
    if inks > 0 {
        notes.push("inks in addition to its colors are left out".into());
    }
    let (guides, lost) = parsed.guides.clone();
    if lost > 0 {
        notes.push(format!(
            "{lost} of its guides are left out: there are too many, or they are too far away"
        ));
    }
    let effect_light = parsed.effect_light;
    let guides = guides.into();
    let document = Document { layers, selections, guides, effect_light, ..Document::empty(size) };
    (document, is_less)
}

/// Ours keep their places to the last digit, unless another program moved them.
fn with_guides_of(document: Document, found: Guides) -> Document {
    if marks::guides_to_write(&document) == found {
        document
    } else {
        Document { guides: found.into(), ..document }
    }
}

/// What the file's colors were converted to.
fn color_notes(parsed: &ParsedPsd) -> Option<String> {
    let header = &parsed.header;
    let what = match header.mode {
        Mode::Cmyk => "its CMYK colors became sRGB; layers blend in those",
        Mode::Lab => "its Lab colors became sRGB; layers blend in those",
        Mode::Multichannel => {
            "its inks were read as cyan, magenta, yellow and black; others are left out"
        }
        Mode::Duotone => "its inks are left out: it became gray",
        _ if header.is_16_bit && header.bits == 32 => {
            "its 32 bits a channel became 16, and values brighter than white are lost; a Photoshop file that is saved \
             here has 8 for other programs"
        }
        _ if header.is_16_bit => {
            "its 16 bits a channel are kept here; a Photoshop file that is saved here has 8 for other programs"
        }
        _ if header.bits == 32 => {
            "its 32 bits per channel became 8, and values brighter than white are lost"
        }
        _ if header.bits == 16 => "its 16 bits a channel became 8",
        _ => return None,
    };
    Some(what.into())
}

/// The picture of a file without layers becomes one.
fn use_merged(parsed: &mut ParsedPsd) {
    let rect = parsed.header.size.rect();
    let StraightPixels { rgba, rgba16 } =
        parsed.merged.take().map(|merged| merged.pixels).unwrap_or_default();
    parsed.records.push(LayerRecord {
        name: "Background".into(),
        rect,
        rgba,
        rgba16,
        ..LayerRecord::default()
    });
}

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

/// Adjustments of one file that become tables, a quarter of a megabyte each.
const MOST_TABLES: usize = 200;

/// Layers gathered bottom first, each open group a list of its own.
struct TreeBuilder<'a> {
    size: Size,
    /// The greatest depth of groups.
    deepest: usize,
    patterns: &'a [PatternResource],
    /// Its values are light, which blends as light.
    is_light: bool,
    /// Its values have a profile of their own.
    has_profile: bool,
    gray: Option<&'a GrayTones>,
    inks: Option<&'a InkTones>,
    /// Adjustments that became tables.
    tables: usize,
    open: Vec<Vec<Arc<Layer>>>,
    /// Something was left out.
    is_less: bool,
    notes: Vec<String>,
}

impl TreeBuilder<'_> {
    fn add(&mut self, mut record: LayerRecord) {
        let layer = match record.section {
            RecordSection::End => return self.open.push(Vec::new()),
            RecordSection::Group => {
                // Without a beginning, a group holds nothing.
                let mut layers = if self.open.len() > 1 {
                    self.open.pop().unwrap_or_default()
                } else {
                    Vec::new()
                };
                if self.open.len() > self.deepest {
                    self.notes.push(format!(
                        "“{}” is nested too deep: its layers are in the group around it",
                        record.name
                    ));
                    return self.open.last_mut().map_or((), |list| list.extend(layers));
                }
                if let Some(ground) = record.ground {
                    self.lay_ground(&mut record, ground, &mut layers);
                }
                // With a fill that is not whole, a group no longer passes through.
                let passes = record.blend == PASS_THROUGH && record.fill_opacity == 255;
                let group = Group { layers, pass_through: passes };
                self.layer(record, Content::Group(group))
            }
            RecordSection::Layer => {
                // A line and what it is around are a group.
                record.line = record.line.take().filter(|_| self.open.len() <= self.deepest);
                let content = match record.adjustment.take() {
                    Some(adjustment) => self.adjust(&mut record, adjustment),
                    None => filled::content(&mut record, self.size, self.patterns),
                };
                self.layer(record, content)
            }
        };
        if let Some(list) = self.open.last_mut() {
            list.push(Arc::new(layer));
        }
    }

    /// An adjustment of the values that the file has.
    fn adjust(&mut self, record: &mut LayerRecord, adjustment: ColorAdjustment) -> Content {
        let of_black = record.adjustment_of_black.take();
        let has_room = self.tables < MOST_TABLES;
        let (lookup, note) = if let Some(gray) = self.gray {
            let note =
                "it adjusts the values of the file's gray profile, and became a table of tones";
            (has_room.then(|| gray.lookup(&adjustment)).flatten(), note)
        } else if let Some(inks) = self.inks {
            let note = "it adjusts the file's inks, and became a table of colors";
            (has_room.then(|| inks.lookup(&adjustment, of_black.as_ref())).flatten(), note)
        } else {
            (None, "")
        };
        let Some(lookup) = lookup else {
            if self.has_profile || self.inks.is_some() {
                record.note_conversion(
                    "it adjusts sRGB values, and in other programs those of the file's color profile",
                );
            }
            return adjustment.into();
        };
        self.tables += 1;
        record.note_conversion(note);
        ColorAdjustment::ColorLookup(lookup).into()
    }

    /// An artboard's ground is beneath its layers, and what is beyond it is cut off.
    fn lay_ground(
        &self,
        record: &mut LayerRecord,
        ground: ArtboardBackground,
        layers: &mut Vec<Arc<Layer>>,
    ) {
        let rect = ground.rect.intersect(self.size.rect());
        let values = vec![255; rect.width() * rect.height()];
        let board = RecordMask { rect, outside: 0, values, disabled: false };
        if let Some(color) = ground.color {
            let fill = Layer {
                mask: Some(board.to_layer_mask(self.size)),
                clip_to_surface: false,
                ..Layer::new("Artboard", Content::Fill(color))
            };
            layers.insert(0, Arc::new(fill));
        }
        record.mask = Some(match record.mask.take().filter(|mask| !mask.disabled) {
            Some(mask) => mask.times(self.size, &board),
            None => board,
        });
    }

    /// Whether what is clipped next lies on a group that passes through.
    fn is_clipped_to_passing(&self) -> bool {
        let below = self.open.last().and_then(|list| list.iter().rev().find(|l| !l.clip_below));
        below.and_then(|base| base.content.group()).is_some_and(|group| group.pass_through)
    }

    fn layer(&mut self, mut record: LayerRecord, content: Content) -> Layer {
        if record.clipped && record.visible && self.is_clipped_to_passing() {
            record.note_conversion(
                "in other programs it is blended with all that its group lets through, too",
            );
        }
        let known = BlendMode::from_photoshop(record.blend);
        if known.is_none() && record.blend != PASS_THROUGH {
            let key = String::from_utf8_lossy(&record.blend).into_owned();
            let key: String = key.chars().filter(|c| !c.is_control()).collect();
            let reason = format!(
                "“{}” is blended by “{}” elsewhere; here it is blended normally",
                record.name,
                key.trim()
            );
            self.notes.push(reason);
            self.is_less = true;
        }
        if known == Some(BlendMode::Dissolve) && record.visible {
            record.note_conversion("it dissolves in a different pattern than in other programs");
        }
        let found = record.effects.take().map(|effects| self.with_patterns(effects));
        let (effects, lost) = found.unwrap_or_default();
        lost.into_iter().for_each(|what| record.leave_out(what));
        let [mut opacity, mut fill_opacity] =
            [record.opacity, record.fill_opacity].map(|v| f32::from(v) / 255.0);
        // Adjustments have no fill of their own.
        if effects.is_empty() && matches!(content, Content::Adjustment(_)) {
            opacity *= std::mem::replace(&mut fill_opacity, 1.0);
        }
        self.is_less |= !record.lost.is_empty();
        for what in record.lost.iter().chain(&record.converted) {
            self.notes.push(format!("“{}”: {what}", record.name));
        }
        Layer {
            visible: record.visible,
            opacity,
            blend_linear: self.is_light,
            blend: known.unwrap_or(BlendMode::Normal),
            clip_below: record.clipped,
            lock: match (record.lock_all, record.lock_alpha) {
                (true, _) => LayerLock::All,
                (false, true) => LayerLock::Alpha,
                (false, false) => LayerLock::None,
            },
            label: record.label,
            effects: Arc::new(effects),
            fill_opacity,
            mask: record.mask.as_ref().map(|mask| mask.to_layer_mask(self.size)),
            clip_to_surface: false,
            ..Layer::new(record.name, content)
        }
    }

    /// Effects with the pictures of their patterns, and what is left out of them.
    fn with_patterns(&self, effects: RecordEffects) -> (Vec<LayerEffect>, Vec<&'static str>) {
        let RecordEffects { mut list, patterns, mut lost, .. } = effects;
        for (number, id) in patterns {
            let found = self.patterns.iter().find(|pattern| pattern.id() == id);
            let made = found.and_then(|pattern| {
                let (size, rgba) = pattern.picture();
                EffectPattern::new(pattern.name(), size, rgba.to_vec())
            });
            let Some(effect) = list.get_mut(number) else { continue };
            if made.is_none() && effect.on {
                lost.push(
                    "the pattern of an effect is not in the file, is damaged or is too large",
                );
            }
            effect.pattern = made.map(Arc::new);
        }
        (list, lost)
    }

    /// Groups that were never closed end with the file.
    fn finish(mut self) -> (Vec<Arc<Layer>>, bool, Vec<String>) {
        while self.open.len() > 1 {
            let layers = self.open.pop().unwrap_or_default();
            if let Some(list) = self.open.last_mut() {
                list.extend(layers);
            }
        }
        (self.open.pop().unwrap_or_default(), self.is_less, self.notes)
    }
}
