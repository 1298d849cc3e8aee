//! Reads the layers of a Photoshop file as records: their fields, the blocks after them, their channels and masks.
//! Floor 5. `parse` finds their position in the file.

use super::channel::{self, ChannelLayout};
use super::cursor::ByteCursor;
use super::parse::{PsdHeader, interleaved};
use super::{LayerRecord, RecordMask, RecordSection};
use crate::Budget;
use crate::math::Rect;
use crate::{Error, Result};
use std::path::Path;

/// Coordinates beyond this are invalid.
const FARTHEST: i32 = 1_000_000;
/// Blocks that mean something is not imported.
const LOSSES: [(&[[u8; 4]], &str); 5] = [
    (&[*b"TySh", *b"tySh"], "its text became pixels"),
    (&[*b"lfx2", *b"lrFX", *b"lmfx"], "its effects are left out"),
    (&[*b"vmsk", *b"vsms"], "its vector mask is left out"),
    (&[*b"SoLd", *b"SoLE", *b"PlLd"], "its smart object became pixels"),
    (&[*b"SoCo", *b"GdFl", *b"PtFl"], "its fill is left out but for the pixels stored with it"),
];
const ADJUSTMENTS: [[u8; 4]; 17] = [
    *b"levl", *b"curv", *b"brit", *b"hue2", *b"hue ", *b"blnc", *b"blwh", *b"phfl", *b"mixr", *b"clrL", *b"nvrt",
    *b"post", *b"thrs", *b"selc", *b"grdm", *b"expA", *b"vibA",
];

/// A block of additional information. Some programs pad them to four bytes, some to two, some not at all.
pub fn block<'a>(rest: &mut ByteCursor<'a>, large: bool) -> Option<([u8; 4], ByteCursor<'a>)> {
    const LONG: [[u8; 4]; 13] = [
        *b"LMsk", *b"Lr16", *b"Lr32", *b"Layr", *b"Mt16", *b"Mt32", *b"Mtrn", *b"Alph", *b"FMsk", *b"lnk2", *b"FEid",
        *b"FXid", *b"PxSD",
    ];
    let is_signature = |key: [u8; 4]| key == *b"8BIM" || key == *b"8B64";
    for _ in 0..4 {
        let mut ahead = *rest;
        if ahead.key().is_some_and(is_signature) {
            break;
        }
        rest.take(1)?;
    }
    rest.key().filter(|key| is_signature(*key))?;
    let key = rest.key()?;
    let data = rest.section(large && LONG.contains(&key))?;
    Some((key, data))
}

/// A record whose channels are still to be read.
struct PendingRecord {
    record: LayerRecord,
    /// Each channel's number, and how many bytes it has.
    channels: Vec<(i16, usize)>,
    /// Its rectangle, what is outside, whether it is in use.
    mask: Option<(Rect, u8, bool)>,
}

/// The reader of layers' records.
pub struct RecordReader<'a> {
    file: &'a Path,
    budget: &'a Budget,
    header: &'a PsdHeader,
    used_px: u64,
    /// What could not be read.
    pub damage: Vec<String>,
}

impl<'a> RecordReader<'a> {
    pub fn new(file: &'a Path, budget: &'a Budget, header: &'a PsdHeader) -> Self {
        Self { file, budget, header, used_px: 0, damage: Vec::new() }
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
                self.damage.push(format!("{} of {count} layers are lost: the file is cut short or damaged", count - i));
                break;
            };
            pending.push(record);
        }
        pending.into_iter().map(|pending| self.filled(pending, &mut rest)).collect()
    }
    fn record(&self, rest: &mut ByteCursor) -> Option<PendingRecord> {
        let rect = rest.rect()?;
        let count = rest.u16().filter(|count| *count <= 64)?;
        let large = self.header.large;
        let channels = (0..count).map(|_| Some((rest.i16()?, rest.length(large)?))).collect::<Option<_>>()?;
        rest.key().filter(|signature| *signature == *b"8BIM")?;
        let (blend, opacity, clipping, flags) = (rest.key()?, rest.u8()?, rest.u8()?, rest.u8()?);
        rest.u8()?;
        let mut extra = rest.section(false)?;
        let mask = mask_data(extra.section(false)?);
        extra.section(false)?;
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
        while let Some((key, data)) = block(&mut extra, large) {
            note_block(&mut record, key, data);
        }
        Some(PendingRecord { record, channels, mask })
    }
    /// Reads a record's channels.
    fn filled(&mut self, pending: PendingRecord, rest: &mut ByteCursor) -> Result<LayerRecord> {
        let PendingRecord { mut record, channels, mask } = pending;
        if let Some(rect) = self.affordable(&record.name, record.rect)? {
            record.rect = rect;
        } else {
            record.rect = Rect::EMPTY;
        }
        let area = record.rect.width() * record.rect.height();
        let mut planes: [Option<Vec<u8>>; 4] = [None, None, None, None];
        let mut is_damaged = false;
        for (id, length) in channels {
            let mut data = ByteCursor::new(match rest.take(length) {
                Some(data) => data,
                None => {
                    is_damaged = true;
                    break;
                }
            });
            let slot = match id {
                -1 => 3,
                -2 => {
                    if let Some((rect, outside, true)) = mask {
                        record.mask = self.mask(&record.name, &mut data, rect, outside)?;
                    }
                    continue;
                }
                0..=2 => id as usize,
                _ => continue,
            };
            if area == 0 {
                continue;
            }
            planes[slot] = channel::decode(&mut data, self.shape(record.rect));
            is_damaged |= planes[slot].is_none();
        }
        if mask.is_some_and(|(_, _, enabled)| !enabled) {
            record.lost.push("its mask, which is switched off, is left out");
        }
        if is_damaged {
            self.damage.push(format!("“{}” is damaged or cut short", record.name));
        }
        record.rgba = interleaved(&planes, area, self.header.is_grey);
        Ok(record)
    }
    fn shape(&self, rect: Rect) -> ChannelLayout {
        ChannelLayout { width: rect.width(), height: rect.height(), bits: self.header.bits, large: self.header.large }
    }
    /// The rectangle if it is valid and within the budget; `None` if it is empty.
    fn affordable(&mut self, name: &str, rect: Rect) -> Result<Option<Rect>> {
        if rect.is_empty() {
            return Ok(None);
        }
        let [x0, y0, x1, y1] = [rect.x0, rect.y0, rect.x1, rect.y1].map(i64::from);
        if [x0, y0, x1, y1].iter().any(|v| v.abs() > FARTHEST.into()) {
            return Err(Error::decode(self.file, format!("“{name}” lies {x0}, {y0} pixels away from the canvas")));
        }
        let size = self.budget.size(self.file, (x1 - x0) as u64, (y1 - y0) as u64)?;
        self.spend(size.area() as u64)?;
        Ok(Some(rect))
    }
    fn spend(&mut self, px: u64) -> Result<()> {
        self.used_px += px;
        if self.used_px > self.budget.document_px {
            let reason = format!("its layers hold more than {} pixels together", self.budget.document_px);
            return Err(Error::too_large(self.file, reason));
        }
        Ok(())
    }
    fn mask(&mut self, name: &str, data: &mut ByteCursor, rect: Rect, outside: u8) -> Result<Option<RecordMask>> {
        // In memory it covers the canvas, a byte per pixel, however small it is in the file.
        self.spend(self.header.size.area() as u64 / 4)?;
        let Some(rect) = self.affordable(name, rect)? else {
            return Ok(Some(RecordMask { rect: Rect::EMPTY, outside, values: Vec::new() }));
        };
        let values = channel::decode(data, self.shape(rect));
        if values.is_none() {
            self.damage.push(format!("the mask of “{name}” is damaged"));
        }
        Ok(values.map(|values| RecordMask { rect, outside, values }))
    }
}

/// Rectangle, what is outside, whether it is in use.
fn mask_data(mut data: ByteCursor) -> Option<(Rect, u8, bool)> {
    let (rect, outside, flags) = (data.rect()?, data.u8()?, data.u8()?);
    Some((rect, outside, flags & 2 == 0))
}

fn note_block(record: &mut LayerRecord, key: [u8; 4], mut data: ByteCursor) {
    match &key {
        b"luni" => {
            let count = data.u32().unwrap_or(0) as usize;
            let units: Vec<u16> = std::iter::from_fn(|| data.u16()).take(count).collect();
            let name = String::from_utf16_lossy(&units);
            name.trim_end_matches('\0').clone_into(&mut record.name);
        }
        b"lsct" | b"lsdk" => {
            record.section = match data.u32() {
                Some(1 | 2) => RecordSection::Group,
                Some(3) => RecordSection::End,
                _ => RecordSection::Layer,
            };
            if data.key() == Some(*b"8BIM")
                && let Some(blend) = data.key()
            {
                record.blend = blend;
            }
        }
        b"lspf" => {
            let locks = data.u32().unwrap_or(0);
            record.lock_all = locks & 0x8000_0002 != 0;
            record.lock_alpha |= locks & 1 != 0;
        }
        b"iOpa" => {
            let fill = u32::from(data.u8().unwrap_or(255));
            record.opacity = ((u32::from(record.opacity) * fill + 127) / 255) as u8;
        }
        key if ADJUSTMENTS.contains(key) => record.lost.push("its adjustment is left out"),
        key => {
            let losses = LOSSES.iter().filter(|(keys, _)| keys.contains(key)).map(|(_, what)| *what);
            for what in losses {
                if !record.lost.contains(&what) {
                    record.lost.push(what);
                }
            }
        }
    }
}
