//! Builds a document from the records of a Photoshop file, as far as both programs agree. Floor 5.
//! Parsing is in `parse`, and what of it is shown in `read`.

use super::blocks::ArtboardBackground;
use super::colors::StraightPixels;
use super::effects::RecordEffects;
use super::gray::GrayTones;
use super::inks::InkTones;
use super::layer_base::{CLIPPED_TO_PASSING, CLIPPED_TOGETHER, IGNORES_ALPHA, LayerBase, is_empty};
use super::nesting::{with_effects_of_shape, with_effects_within, with_line_over};
use super::parse::ParsedPsd;
use super::pattern::PatternResource;
use super::{LayerRecord, PASS_THROUGH, RecordMask, RecordSection, filled, knockout};
use crate::Budget;
use crate::document::{Content, Document, Group, Layer, LayerLock, LayerMask};
use crate::math::Size;
use crate::paint::effect::EffectPattern;
use crate::paint::{ColorAdjustment, LayerEffect};
use crate::raster::BlendMode;
use std::sync::Arc;

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
        is_deep: parsed.header.is_16_bit,
        open: vec![OpenList::default()],
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
    let profile = parsed.profile;
    let document =
        Document { layers, profile, selections, guides, effect_light, ..Document::empty(size) };
    (document, is_less)
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

/// Adjustments of one file that become tables, a quarter of a megabyte each.
const MOST_TABLES: usize = 200;

/// The layers of an open group so far, bottom first.
#[derive(Default)]
struct OpenList {
    layers: Vec<Arc<Layer>>,
    /// What the next ones may be clipped to.
    base: LayerBase,
}

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
    /// It has more than bytes.
    is_deep: bool,
    open: Vec<OpenList>,
    /// Something was left out.
    is_less: bool,
    notes: Vec<String>,
}

impl TreeBuilder<'_> {
    fn add(&mut self, mut record: LayerRecord) {
        let knockout = self.knockout(&mut record);
        let mut base = LayerBase {
            clips_apart: record.clips_apart,
            shape: self.clip_shape(&record),
            ignores_alpha: record.ignores_alpha.then(|| record.name.clone()),
            ..LayerBase::default()
        };
        let layer = match record.section {
            RecordSection::End => return self.open.push(OpenList::default()),
            RecordSection::Group => {
                // Without a beginning, a group holds nothing.
                let mut layers = if self.open.len() > 1 {
                    self.open.pop().unwrap_or_default().layers
                } else {
                    Vec::new()
                };
                if self.open.len() > self.deepest {
                    self.notes.push(format!(
                        "“{}” is nested too deep: its layers are in the group around it",
                        record.name
                    ));
                    return self.open.last_mut().map_or((), |list| list.layers.extend(layers));
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
                let line = self.line_over(&mut record);
                base.has_line_over = line.is_some();
                let content = match record.adjustment.take() {
                    Some(adjustment) => self.adjust(&mut record, adjustment),
                    None => filled::content(&mut record, self.size, self.patterns),
                };
                let layer = self.layer(record, content);
                match line {
                    Some(line) => with_line_over(layer, line),
                    None => layer,
                }
            }
        };
        let deepest = self.deepest.saturating_sub(self.open.len());
        let Some(list) = self.open.last_mut() else { return };
        if let Some(mask) = knockout {
            knockout::hide_beneath(&mut list.layers, mask, &layer.name);
        }
        if layer.clip_below && list.base.has_line_over {
            return list.base.clip_beneath_line(&mut list.layers, layer);
        }
        if !layer.clip_below {
            list.base = LayerBase { index: list.layers.len(), ..base };
        } else if layer.visible {
            if list.base.is_passing(&list.layers) {
                let adjusts = list.base.has_adjustments(&list.layers);
                if is_empty(&layer) && !adjusts {
                    return list.layers.push(Arc::new(Layer { clip_below: false, ..layer }));
                }
                if deepest > 0 && !adjusts && !list.base.can_clip_apart() {
                    list.base.clip_to_passing(&list.layers, self.size);
                }
                if !list.base.can_clip_apart() {
                    self.notes.push(format!("“{}”: {CLIPPED_TO_PASSING}", layer.name));
                }
            }
            if let Some(name) = list.base.ignores_alpha.take() {
                self.notes.push(format!("“{name}”: {IGNORES_ALPHA}"));
                self.is_less = true;
            }
            if list.base.can_clip_apart() && deepest > 0 {
                return list.base.clip_apart(&mut list.layers, layer);
            }
            if std::mem::take(&mut list.base.clips_apart) {
                self.notes.push(format!("“{}”: {CLIPPED_TOGETHER}", layer.name));
                self.is_less = true;
            }
        }
        list.layers.push(Arc::new(layer));
    }

    /// The line of a shape whose pixels are in the file, if something lies between both.
    fn line_over(&self, record: &mut LayerRecord) -> Option<Layer> {
        let is_shown = record.line_is_over && !record.rgba.is_empty() && !record.clips_apart;
        let mut line = record.line.take_if(|line| is_shown && line.coverage.is_some())?;
        if let Some(mask) = record.mask.as_ref().filter(|mask| !mask.disabled) {
            line.coverage = line.coverage.map(|coverage| coverage.times(self.size, mask));
        }
        Some(filled::line_layer(record, line, self.size, self.patterns))
    }

    /// What layers that are clipped apart from a layer are clipped to.
    fn clip_shape(&self, record: &LayerRecord) -> Option<LayerMask> {
        let shape = knockout::shape(record, self.size).filter(|_| record.clips_apart)?;
        let values = shape.values.iter().map(|v| 255 - v).collect();
        let shape = RecordMask { outside: 0, values, ..shape };
        Some(LayerMask { disabled: false, ..shape.to_layer_mask(self.size) })
    }

    /// The mask of what a layer knocks out.
    fn knockout(&self, record: &mut LayerRecord) -> Option<LayerMask> {
        let has_beneath = self.open.last().is_some_and(|list| !list.layers.is_empty());
        if !record.knocks_out || !record.visible || !has_beneath {
            return None;
        }
        let depth = self.open.last().map_or(0, |list| knockout::depth(&list.layers));
        let has_room = self.open.len() + depth <= self.deepest;
        let shape = knockout::shape(record, self.size).filter(|_| has_room && !record.clipped);
        if shape.is_none() {
            record.leave_out("its knockout is left out");
        }
        shape.map(|shape| shape.to_layer_mask(self.size))
    }

    /// An adjustment of the values that the file has.
    fn adjust(&mut self, record: &mut LayerRecord, mut adjustment: ColorAdjustment) -> Content {
        if let ColorAdjustment::Posterize(own) = &mut adjustment {
            own.of_16_bits = self.is_deep;
        }
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

    fn layer(&mut self, mut record: LayerRecord, content: Content) -> Layer {
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
        if record.ignores_alpha && effects.iter().any(|effect| effect.on) {
            record.leave_out(IGNORES_ALPHA);
        }
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
        let layer = Layer {
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
        };
        let has_room = self.open.len() <= self.deepest;
        if let Some(shape) = record.effect_shape.filter(|_| has_room) {
            let shape = match record.mask.filter(|mask| !mask.disabled) {
                Some(mask) => mask.times(self.size, &shape),
                None => shape,
            };
            return with_effects_of_shape(layer, shape.to_layer_mask(self.size));
        }
        if record.fills_with_effects && has_room { with_effects_within(layer) } else { layer }
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
            let layers = self.open.pop().unwrap_or_default().layers;
            if let Some(list) = self.open.last_mut() {
                list.layers.extend(layers);
            }
        }
        (self.open.pop().unwrap_or_default().layers, self.is_less, self.notes)
    }
}
