//! Reads the layers of a Photoshop file as records: their fields, the blocks after them, their
//! channels and masks. Floor 5. `parse` finds their position in the file.

use super::blocks::{self, block};
use super::channel;
use super::colors::{ColorValue, Colors, StraightPixels};
use super::cursor::ByteCursor;
use super::effects::RecordEffects;
use super::fill::LayerFill;
use super::header::PsdHeader;
use super::masks::{MaskData, Softness};
use super::outline::VectorPaths;
use super::shape::{self, ShapePaths};
use super::{LayerRecord, RecordMask, filled};
use crate::Budget;
use crate::math::{Rect, Size};
use crate::{Error, Result};
use std::path::Path;

/// Coordinates beyond this are invalid.
const FARTHEST: i32 = 1_000_000;
/// Pixels that vector masks may draw together: some seconds.
const DRAWN_PX: u64 = 1 << 33;
/// A record whose channels are still to be read.
struct PendingRecord {
    record: LayerRecord,
    /// Each channel's number, and how many bytes it has.
    channels: Vec<(i16, usize)>,
    masks: Option<MaskData>,
}

/// The reader of layers' records.
pub struct RecordReader<'a> {
    file: &'a Path,
    budget: &'a Budget,
    header: &'a PsdHeader,
    colors: &'a Colors<'a>,
    used_px: u64,
    /// What 16 bits take in addition to bytes.
    bytes16: u64,
    drawn_px: u64,
    /// Records keep the values of their colors.
    pub keeps_inks: bool,
    /// Shapes stay pixels.
    pub keeps_pixels: bool,
    /// What could not be read.
    pub damage: Vec<String>,
}

impl<'a> RecordReader<'a> {
    pub fn new(
        file: &'a Path,
        budget: &'a Budget,
        header: &'a PsdHeader,
        colors: &'a Colors<'a>,
    ) -> Self {
        Self {
            file,
            budget,
            header,
            colors,
            used_px: 0,
            bytes16: 0,
            drawn_px: 0,
            keeps_inks: false,
            keeps_pixels: false,
            damage: Vec::new(),
        }
    }

    /// All of them, bottom first; unreadable ones are reported.
    pub fn records(&mut self, mut rest: ByteCursor) -> Result<Vec<LayerRecord>> {
        let count = usize::from(rest.i16().map_or(0, i16::unsigned_abs));
        if count > self.budget.layers * 2 {
            let reason = format!("it has {count} layers; {} are allowed", self.budget.layers);
            return Err(Error::too_large(self.file, reason));
        }
        let mut pending = Vec::new();
        for i in 0..count {
            let Some(record) = self.record(&mut rest) else {
                self.damage.push(format!(
                    "{} of {count} layers are lost: the file is cut short or damaged",
                    count - i
                ));
                break;
            };
            pending.push(record);
        }
        for i in 0..pending.len() {
            let has_clipped = pending.get(i + 1).is_some_and(|next| next.record.clipped);
            let record = &mut pending[i].record;
            record.line_is_over = record.stroked && record.is_parted_by(has_clipped);
        }
        let is_16_bit = self.header.is_16_bit;
        let filled = |pending| match is_16_bit {
            true => self.read_channels::<u16>(pending, &mut rest),
            false => self.read_channels::<u8>(pending, &mut rest),
        };
        pending.into_iter().map(filled).collect()
    }

    fn record(&self, rest: &mut ByteCursor) -> Option<PendingRecord> {
        let rect = rest.rect()?;
        let count = rest.u16().filter(|count| *count <= 64)?;
        let large = self.header.large;
        let channels =
            (0..count).map(|_| Some((rest.i16()?, rest.length(large)?))).collect::<Option<_>>()?;
        rest.key().filter(|signature| *signature == *b"8BIM")?;
        let (blend, opacity, clipping, flags) = (rest.key()?, rest.u8()?, rest.u8()?, rest.u8()?);
        rest.u8()?;
        let mut extra = rest.section(false)?;
        let masks = MaskData::read(extra.section(false)?);
        let ranges = extra.section(false)?;
        let name = extra.pascal(4)?;
        let mut record = LayerRecord {
            name: String::from_utf8_lossy(name).into_owned(),
            rect,
            blend,
            opacity,
            clipped: clipping == 1,
            visible: flags & 2 == 0,
            lock_alpha: flags & 1 == 1,
            ..LayerRecord::default()
        };
        // Blending ranges from black to white of this layer and those beneath, for all channels and
        // each: everything passes.
        if ranges.rest().chunks(4).any(|range| range != [0, 0, 255, 255]) {
            record.leave_out("its “blend if” is left out");
        }
        while let Some((key, data)) = block(&mut extra, large) {
            blocks::take(&mut record, key, data, self.colors);
        }
        if let (Some(effects), Some(reference)) = (&mut record.effects, record.reference) {
            effects.begin_patterns_at(reference);
        }
        for what in record.effects.as_ref().map_or(Vec::new(), |effects| effects.lost.clone()) {
            record.leave_out(what);
        }
        let has_effects = record.effects.as_ref().is_some_and(|effects| !effects.list.is_empty());
        if has_effects && record.masks_effects && masks.is_some() {
            record.leave_out("in other programs its mask hides its effects, too");
        }
        Some(PendingRecord { record, channels, masks })
    }

    /// Reads a record's channels.
    fn read_channels<T: ColorValue>(
        &mut self,
        pending: PendingRecord,
        rest: &mut ByteCursor,
    ) -> Result<LayerRecord> {
        let PendingRecord { mut record, channels, masks } = pending;
        record.rect = self.affordable(&record.name, record.rect)?.unwrap_or(Rect::EMPTY);
        let size = Size::new(record.rect.width() as u32, record.rect.height() as u32);
        if self.header.is_16_bit {
            self.bytes16 += size.area() as u64 * size_of::<[u16; 4]>() as u64;
            self.budget.room(self.file, "reading its layers", self.held_bytes())?;
        }
        let mut planes: [Option<Vec<T>>; 4] = [None, None, None, None];
        let mut own_values: [Option<Vec<u16>>; 4] = [None, None, None, None];
        let mut alpha = None;
        let mut drawn = [None, None];
        let mut is_damaged = false;
        for (id, length) in channels {
            let Some(data) = rest.take(length) else {
                is_damaged = true;
                break;
            };
            let mut data = ByteCursor::new(data);
            if let (-3..=-2, Some(masks)) = (id, &masks) {
                let placed = if id == -2 { Some(masks.shown) } else { masks.painted };
                if let Some(placed) = placed {
                    let read = self.mask(&record.name, &mut data, placed.rect)?;
                    drawn[(-2 - id) as usize] =
                        read.map(|(rect, values)| placed.with(rect, values));
                }
                continue;
            }
            let is_color = (0..self.header.colors() as i16).contains(&id);
            if size.area() == 0 || !(is_color || id == -1) {
                continue;
            }
            if self.keeps_inks && is_color {
                // As they are stored, and beside each other.
                self.spend(size.area() as u64)?;
                let shape = self.header.shape(size, is_color);
                let mut again = data;
                own_values[id as usize] = channel::decode::<u16>(&mut again, shape);
            }
            let plane = channel::decode(&mut data, self.header.shape(size, is_color));
            is_damaged |= plane.is_none();
            *(if is_color { &mut planes[id as usize] } else { &mut alpha }) = plane;
        }
        if is_damaged {
            self.damage.push(format!("“{}” is damaged or cut short", record.name));
        }
        let StraightPixels { rgba, rgba16 } =
            T::pixels(*self.colors, size, &planes, alpha.as_deref());
        (record.rgba, record.rgba16) = (rgba, rgba16);
        if !own_values.iter().all(Option::is_none) {
            let value = |c: usize, i: usize| own_values[c].as_ref().and_then(|plane| plane.get(i));
            // A channel that is missing shows black.
            let pixel = |i: usize| [0, 1, 2, 3].map(|c| value(c, i).copied().unwrap_or(0));
            record.inks = (0..size.area()).map(pixel).collect();
        }
        self.read_mask(&mut record, masks, drawn)?;
        self.spend_for_canvas(&record)?;
        Ok(record)
    }

    /// The mask that a layer's masks are together. `drawn`: channels −2 and −3.
    fn read_mask(
        &mut self,
        record: &mut LayerRecord,
        masks: Option<MaskData>,
        drawn: [Option<RecordMask>; 2],
    ) -> Result<()> {
        let size = self.header.size;
        let [shown, painted] = drawn;
        let softness = masks.map_or([Softness::HARD; 2], |masks| masks.softness);
        let [of_painted, of_outline] = softness;
        if of_outline != Softness::HARD {
            record.show_beyond_shape();
        }
        // A shape's pixels show its outline already.
        let is_shape =
            (record.fill.is_some() || record.stroked || record.is_shape) && !record.rgba.is_empty();
        let is_drawn = masks.is_some_and(|masks| masks.shown.is_drawn);
        let has_both = painted.is_some();
        // What the file holds of both together is as sharp and as dense as they were drawn.
        let is_drawn_anew = has_both && softness != [Softness::HARD; 2] && record.outline.is_some();
        record.mask = match (shown, painted) {
            (_, Some(painted)) if is_shape || is_drawn_anew => {
                Some(self.soften_mask(painted, of_painted)?)
            }
            (Some(_), None) if is_shape && is_drawn => None,
            (shown, Some(_)) => shown,
            (Some(shown), None) => {
                Some(self.soften_mask(shown, if is_drawn { of_outline } else { of_painted })?)
            }
            (None, None) => None,
        };
        if is_shape {
            self.find_path(record, of_outline);
        }
        if record.path.is_some() {
            return Ok(());
        }
        if is_shape {
            self.draw_effect_shape(record)?;
            self.draw_line_over(record)?;
        }
        let is_needed = !is_shape && (is_drawn_anew || !has_both && !is_drawn);
        let Some(outline) = record.outline.take().filter(|_| is_needed) else { return Ok(()) };
        if outline.disabled {
            record.note_conversion("its vector mask, which is switched off, is left out");
            return Ok(());
        }
        self.spend(size.area() as u64 / 4)?;
        self.drawn_px += size.area() as u64 * outline.shapes() as u64;
        if self.drawn_px > DRAWN_PX {
            record.leave_out("its vector mask is left out: it would take too long to draw");
            return Ok(());
        }
        let filled = outline.coverage(size);
        if of_outline == Softness::HARD && self.try_find_covering(record, &outline, &filled) {
            return Ok(());
        }
        self.draw_line(record, &outline, &filled)?;
        let drawn = RecordMask::of_canvas(size, filled);
        let drawn = self.soften_mask(drawn, of_outline)?;
        record.mask = Some(match record.mask.take().filter(|mask| !mask.disabled) {
            Some(mask) => mask.times(size, &drawn),
            None => drawn,
        });
        Ok(())
    }

    /// The path that a shape is whose pixels are in the file, if it shows them.
    fn find_path(&mut self, record: &mut LayerRecord, of_outline: Softness) {
        let size = self.header.size;
        // What lies between a shape and its line makes them two layers.
        let is_parted = record.stroked && record.line_is_over;
        let is_cut = filled::has_cut_effects(record, size);
        let keeps_pixels = self.keeps_inks || self.keeps_pixels;
        if keeps_pixels || is_parted || is_cut || of_outline != Softness::HARD {
            return;
        }
        let found = match record.outline.as_ref() {
            Some(outline) => ShapePaths::of(record, outline, size),
            None => None,
        };
        match found {
            None => {}
            Some(Err(why)) => record.note_conversion(why),
            Some(Ok(found)) if self.try_spend_for(&found, record) => {
                match found.find_shown(size, record.rect, &record.rgba) {
                    Ok(path) => (record.path, record.line) = (Some(path), None),
                    Err(why) => record.note_conversion(why),
                }
            }
            Some(Ok(_)) => record.note_conversion(shape::TOO_LARGE),
        }
    }

    /// Finds the path that a shape is whose pixels are not in the file; whether there is one.
    fn try_find_covering(
        &mut self,
        record: &mut LayerRecord,
        outline: &VectorPaths,
        filled: &[u8],
    ) -> bool {
        let size = self.header.size;
        if !record.rgba.is_empty() || self.keeps_inks || self.keeps_pixels {
            return false;
        }
        match ShapePaths::of(record, outline, size) {
            None => {}
            Some(Err(why)) => record.note_conversion(why),
            Some(Ok(found)) if self.try_spend_for(&found, record) => {
                match found.find_covering(size, filled) {
                    Ok(path) => (record.path, record.line) = (Some(path), None),
                    Err(why) => record.note_conversion(why),
                }
            }
            Some(Ok(_)) => record.note_conversion(shape::TOO_LARGE),
        }
        record.path.is_some()
    }

    /// Reserves memory for the picture of a path that is shown instead of a record's own pixels;
    /// whether there is enough.
    fn try_spend_for(&mut self, found: &ShapePaths, record: &LayerRecord) -> bool {
        let own = record.rect.width() as u64 * record.rect.height() as u64;
        let drawn: u64 = found.paths.iter().map(shape::bounds_px).sum();
        let pictures = found.paths.iter().map(|path| path.picture_size().area() as u64);
        let used_px = self.used_px + pictures.max().unwrap_or(0).saturating_sub(own);
        // To be compared, they are drawn at their own size.
        let held = self.held_bytes().saturating_add(4 * drawn);
        let has_room = self.budget.room(self.file, "what its layers hold", held).is_ok();
        if !has_room || used_px > self.budget.document_px || self.drawn_px + drawn > DRAWN_PX {
            return false;
        }
        (self.used_px, self.drawn_px) = (used_px, self.drawn_px + drawn);
        true
    }

    /// What the effects of a shape follow if a gradient leaves it translucent: all of the shape.
    fn draw_effect_shape(&mut self, record: &mut LayerRecord) -> Result<()> {
        let is_translucent = match &record.fill {
            Some(LayerFill::Gradient(fill)) => fill.stops.iter().any(|stop| stop.color.a < 255),
            _ => false,
        };
        let has_effects = record.effects.as_ref().is_some_and(RecordEffects::is_shown);
        let outline = record.outline.as_ref().filter(|outline| !outline.disabled);
        let is_followed = is_translucent && has_effects && !record.stroked;
        let Some(outline) = outline.filter(|_| is_followed) else { return Ok(()) };
        let size = self.header.size;
        let drawn_px = self.drawn_px + size.area() as u64 * outline.shapes() as u64;
        if drawn_px > DRAWN_PX {
            return Ok(());
        }
        self.drawn_px = drawn_px;
        let covered = outline.coverage(size);
        self.spend(size.area() as u64 / 4)?;
        record.effect_shape = Some(RecordMask::of_canvas(size, covered));
        Ok(())
    }

    /// The line of a shape whose pixels are in the file, if something lies between both.
    fn draw_line_over(&mut self, record: &mut LayerRecord) -> Result<()> {
        let line = record.line.take().filter(|_| record.line_is_over && record.fill_opacity == 255);
        let outline = record.outline.as_ref().filter(|outline| !outline.disabled);
        let (Some(mut line), Some(outline)) = (line, outline) else { return Ok(()) };
        let size = self.header.size;
        let drawn_px = self.drawn_px + size.area() as u64 * (outline.shapes() as u64 + 1);
        if drawn_px > DRAWN_PX {
            return Ok(());
        }
        self.drawn_px = drawn_px;
        self.spend(size.area() as u64 / 2)?;
        let filled = outline.coverage(size);
        record.line = line.try_draw(outline, size, &filled).then_some(line);
        Ok(())
    }

    /// The line around a shape whose pixels are not in the file.
    fn draw_line(
        &mut self,
        record: &mut LayerRecord,
        outline: &VectorPaths,
        filled: &[u8],
    ) -> Result<()> {
        let is_shown = record.rgba.is_empty() && record.mask.is_none();
        let Some(mut line) = record.line.take().filter(|_| is_shown) else { return Ok(()) };
        let size = self.header.size;
        self.spend(size.area() as u64 / 2)?;
        self.drawn_px += size.area() as u64;
        record.line = line.try_draw(outline, size, filled).then_some(line);
        Ok(())
    }

    fn soften_mask(&mut self, mask: RecordMask, softness: Softness) -> Result<RecordMask> {
        if softness.feather_px > 0.0 {
            // The blur works in floats, on two planes of the canvas.
            self.spend(self.header.size.area() as u64 * 2)?;
        }
        Ok(mask.softened(self.header.size, softness))
    }

    /// Reserves memory for what will cover the whole canvas, however small it is in the file.
    fn spend_for_canvas(&mut self, record: &LayerRecord) -> Result<()> {
        let area = self.header.size.area() as u64;
        if record.rgba.is_empty()
            && matches!(record.fill, Some(LayerFill::Gradient(_) | LayerFill::Pattern(_)))
        {
            self.spend(area)?;
        }
        if record.knocks_out || record.clips_apart {
            self.spend(area / 2)?;
        }
        if record.ground.is_some() || (record.fill.is_some() && !record.rgba.is_empty()) {
            self.spend(area / 4)?;
        }
        Ok(())
    }

    /// The rectangle if it is valid and within the budget; `None` if it is empty.
    fn affordable(&mut self, name: &str, rect: Rect) -> Result<Option<Rect>> {
        if rect.is_empty() {
            return Ok(None);
        }
        let [x0, y0, x1, y1] = [rect.x0, rect.y0, rect.x1, rect.y1].map(i64::from);
        if [x0, y0, x1, y1].iter().any(|v| v.abs() > FARTHEST.into()) {
            return Err(Error::decode(
                self.file,
                format!("“{name}” is {x0}, {y0} pixels away from the canvas"),
            ));
        }
        let size = self.budget.size(self.file, (x1 - x0) as u64, (y1 - y0) as u64)?;
        self.spend(size.area() as u64)?;
        Ok(Some(rect))
    }

    /// Counts pixels of four bytes that will be in memory.
    pub fn spend(&mut self, px: u64) -> Result<()> {
        self.used_px += px;
        if self.used_px > self.budget.document_px {
            let reason =
                format!("its layers hold more than {} pixels together", self.budget.document_px);
            return Err(Error::too_large(self.file, reason));
        }
        self.budget.room(self.file, "reading its layers", self.held_bytes())
    }

    /// Memory of the layers that were read.
    pub fn held_bytes(&self) -> u64 {
        self.used_px.saturating_mul(4).saturating_add(self.bytes16)
    }

    /// A mask's rectangle and its values; `None` where they are damaged.
    fn mask(
        &mut self,
        name: &str,
        data: &mut ByteCursor,
        rect: Rect,
    ) -> Result<Option<(Rect, Vec<u8>)>> {
        // Here it will cover the canvas, a byte a pixel, however small it is in the file.
        self.spend(self.header.size.area() as u64 / 4)?;
        let Some(rect) = self.affordable(name, rect)? else {
            return Ok(Some((Rect::EMPTY, Vec::new())));
        };
        let size = Size::new(rect.width() as u32, rect.height() as u32);
        let values = channel::decode(data, self.header.shape(size, false));
        if values.is_none() {
            self.damage.push(format!("the mask of “{name}” is damaged"));
        }
        Ok(values.map(|values| (rect, values)))
    }
}
