//! Photoshop's brushes: sampled tips of versions 1 and 2, and of 6 and later, and computed round
//! ones. Floor 5. What the descriptions of later versions say of a brush is carried over by
//! `presets` and `dynamics`.

mod dynamics;
mod presets;

use super::{ImportedBrush, TipNames, spend};
use crate::Budget;
use crate::math::Size;
use crate::paint::{Brush, Tip};
use crate::psd::channel::{ChannelLayout, decode_as};
use crate::psd::cursor::ByteCursor;
use crate::psd::descriptor::{self, DescriptorObject};
use crate::psd::pattern::{self, PatternResource};
use crate::raster::Picture;
use crate::{Error, Result};
use std::path::Path;

/// More tips than any known collection has.
const MOST: usize = 4096;
/// Photoshop's default, if the file does not say.
const SPACING: f32 = 0.25;

/// Reads every brush of a collection. Damaged ones are left out; the notes of the first intact one
/// mention them.
pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Vec<ImportedBrush>> {
    let AbrReader { mut brushes, damaged, .. } = read_all(file, bytes, budget, true)?;
    let Some(first) = brushes.first_mut() else {
        let reason =
            if damaged > 0 { "its brushes are damaged" } else { "it holds no sampled tips" };
        return Err(Error::decode(file, reason));
    };
    if damaged > 0 {
        first.notes.push(format!("{damaged} damaged brushes of the collection were left out"));
    }
    Ok(brushes)
}

/// The sampled tips of a collection in the order of the file, whatever its descriptions say.
pub fn read_tips(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Vec<Picture>> {
    let AbrReader { brushes, .. } = read_all(file, bytes, budget, false)?;
    let picture = |imported: &ImportedBrush| match &imported.brush.tip {
        Tip::Picture(source) => Some(source.picture.clone()),
        _ => None,
    };
    Ok(brushes.iter().filter_map(picture).collect())
}

/// `is_described`: the brushes are those that later versions describe, not the bare tips.
fn read_all<'a>(
    file: &'a Path,
    bytes: &[u8],
    budget: &'a Budget,
    is_described: bool,
) -> Result<AbrReader<'a>> {
    let mut cursor = ByteCursor::new(bytes);
    let cut = || Error::decode(file, "the collection is cut short");
    let (version, second) = (cursor.u16().ok_or_else(cut)?, cursor.u16().ok_or_else(cut)?);
    let mut reading = AbrReader {
        file,
        budget,
        used_px: 0,
        tips: TipNames::default(),
        brushes: Vec::new(),
        keys: Vec::new(),
        patterns: Vec::new(),
        damaged: 0,
    };
    match version {
        1 | 2 => reading.old(&mut cursor, version, usize::from(second))?,
        6 | 7 | 9 | 10 => reading.later(&mut cursor, second, is_described)?,
        _ => {
            return Err(Error::unsupported_file(
                file,
                format!("version {version} of Photoshop's brushes"),
            ));
        }
    }
    Ok(reading)
}

/// A collection being read.
struct AbrReader<'a> {
    file: &'a Path,
    budget: &'a Budget,
    used_px: u64,
    tips: TipNames,
    brushes: Vec<ImportedBrush>,
    /// The keys of the sampled tips, if the version has them.
    keys: Vec<(String, usize)>,
    /// The pictures of the brushes' textures.
    patterns: Vec<PatternResource>,
    damaged: usize,
}

impl AbrReader<'_> {
    /// Versions 1 and 2: a count, then records that say their kind and length.
    fn old(&mut self, cursor: &mut ByteCursor, version: u16, count: usize) -> Result<()> {
        for _ in 0..count.min(MOST) {
            let Some((kind, record)) = cursor.u16().zip(cursor.section(false)) else {
                self.damaged += 1;
                break;
            };
            match kind {
                1 => self.read_computed_tip(record),
                2 => self.old_sample(record, version)?,
                _ => self.damaged += 1,
            }
        }
        Ok(())
    }

    /// A computed round or elliptic tip.
    fn read_computed_tip(&mut self, mut record: ByteCursor) {
        let mut number = || {
            let value = record.i16()?;
            Some(f32::from(value))
        };
        let Some(_) = number().zip(number()) else { return self.damaged += 1 };
        let Some(values) = (0..5).map(|_| number()).collect::<Option<Vec<f32>>>() else {
            return self.damaged += 1;
        };
        let [spacing, diameter, roundness, angle, hardness] = values[..] else {
            return self.damaged += 1;
        };
        let ratio = (roundness / 100.0).clamp(0.05, 1.0);
        let tip = if ratio < 1.0 { Tip::Ellipse { ratio } } else { Tip::Round };
        let brush = Brush {
            size: diameter.clamp(1.0, 5000.0),
            hardness: (hardness / 100.0).clamp(0.0, 1.0),
            spacing: (spacing / 100.0).clamp(0.01, 10.0),
            rotation: angle.clamp(-180.0, 180.0),
            tip,
            ..Brush::default()
        };
        let name = format!("Round {diameter}");
        self.brushes.push(ImportedBrush { name, brush, notes: Vec::new() });
    }

    fn old_sample(&mut self, mut record: ByteCursor, version: u16) -> Result<()> {
        let Some((spacing, name)) = old_header(&mut record, version) else {
            self.damaged += 1;
            return Ok(());
        };
        self.sample(&mut record, name, spacing)
    }

    /// Versions 6 and later: blocks; one holds all sampled tips, another their names.
    fn later(
        &mut self,
        cursor: &mut ByteCursor,
        subversion: u16,
        is_described: bool,
    ) -> Result<()> {
        // A key of 37 letters, followed by undocumented data.
        let before = match subversion {
            1 => 47,
            2 => 301,
            _ => {
                let reason = format!("subversion {subversion} of Photoshop's brushes");
                return Err(Error::unsupported_file(self.file, reason));
            }
        };
        let mut said = None;
        while let Some((key, mut block)) = next_block(cursor) {
            match &key {
                b"samp" => self.samples(block, before)?,
                b"desc" => said = descriptor::read(&mut block),
                b"patt" => {
                    let (file, budget, used_px) = (self.file, self.budget, &mut self.used_px);
                    self.patterns =
                        pattern::of_block(block, |px| spend(file, budget, used_px, px))?;
                }
                _ => {}
            }
        }
        if is_described {
            self.call(&said.unwrap_or_default());
        }
        Ok(())
    }

    fn samples(&mut self, mut block: ByteCursor, before: usize) -> Result<()> {
        while !block.rest().is_empty() && self.brushes.len() < MOST {
            let Some(mut record) = read_padded_section(&mut block) else {
                self.damaged += 1;
                break;
            };
            let Some(head) = record.take(before) else {
                self.damaged += 1;
                continue;
            };
            let (index, key) =
                (self.brushes.len(), ByteCursor::new(head).pascal(1).map(super::text_of));
            self.sample(&mut record, None, SPACING)?;
            if let Some(key) = key.filter(|key| !key.is_empty() && self.brushes.len() > index) {
                self.keys.push((key, index));
            }
        }
        Ok(())
    }

    /// The brushes by their names in the collection, in its order; tips that no brush uses come last.
    fn call(&mut self, said: &DescriptorObject) {
        let tips = std::mem::take(&mut self.brushes);
        let mut is_called = vec![false; tips.len()];
        let mut pictures = presets::AbrPictures {
            file: self.file,
            patterns: &self.patterns,
            tips: &mut self.tips,
            sampled: &tips,
            keys: &self.keys,
        };
        for said in presets::read(said) {
            for i in said.samples().filter_map(|key| pictures.place(key)) {
                is_called[i] = true;
            }
            match said.sample.as_ref().map(|key| pictures.place(key)) {
                // Its tip is damaged or missing.
                Some(None) => {}
                Some(Some(i)) => self.brushes.push(said.brush(tips.get(i), &mut pictures)),
                None => self.brushes.push(said.brush(None, &mut pictures)),
            }
        }
        let rest = tips.into_iter().zip(is_called).filter(|(_, is_called)| !is_called);
        self.brushes.extend(rest.map(|(tip, _)| tip));
    }

    /// Bounds, depth, compression, values: 0 is bare, the largest covers wholly.
    fn sample(
        &mut self,
        record: &mut ByteCursor,
        name: Option<String>,
        spacing: f32,
    ) -> Result<()> {
        let header = record.rect().zip(record.u16()).zip(record.u8());
        let Some(((bounds, bits), compression)) =
            header.filter(|((_, bits), _)| [8, 16].contains(bits))
        else {
            self.damaged += 1;
            return Ok(());
        };
        let side = |from: i32, to: i32| u64::try_from(i64::from(to) - i64::from(from)).unwrap_or(0);
        let (width, height) = (side(bounds.x0, bounds.x1), side(bounds.y0, bounds.y1));
        if width == 0 || height == 0 {
            self.damaged += 1;
            return Ok(());
        }
        let size = self.budget.size(self.file, width, height)?;
        spend(self.file, self.budget, &mut self.used_px, size.area() as u64)?;
        match read_sampled_tip(record, size, bits, compression) {
            Some(picture) => {
                let name = name.filter(|n| !n.is_empty()).unwrap_or_else(|| self.next_name());
                let tip = self.tips.add(self.file, picture, &name);
                self.brushes.push(ImportedBrush::stamp(name, tip, spacing));
            }
            None => self.damaged += 1,
        }
        Ok(())
    }

    /// The name of a tip that the file does not name.
    fn next_name(&self) -> String {
        let stem = self.file.file_stem().unwrap_or_default().to_string_lossy();
        format!("{stem} {}", self.brushes.len() + 1)
    }
}

/// What precedes the pixels of a tip in versions 1 and 2: its spacing and its name.
fn old_header(record: &mut ByteCursor, version: u16) -> Option<(f32, Option<String>)> {
    record.u32()?;
    let spacing = f32::from(record.u16()?.clamp(1, 1000)) / 100.0;
    let name = if version == 2 { Some(record.unicode()?) } else { None };
    // Antialiasing, and the bounds in 16 bits: they follow again in 32.
    record.take(1 + 8)?;
    Some((spacing, name))
}

/// The next block and its key.
fn next_block<'a>(cursor: &mut ByteCursor<'a>) -> Option<([u8; 4], ByteCursor<'a>)> {
    // Some programs fill blocks up to four bytes, some do not.
    let padding = (0..4).find(|n| cursor.rest().get(*n..n + 4) == Some(b"8BIM"))?;
    cursor.take(padding + 4)?;
    cursor.key().zip(cursor.section(false))
}

/// A section filled up to four bytes; the filling of the last may be missing.
fn read_padded_section<'a>(block: &mut ByteCursor<'a>) -> Option<ByteCursor<'a>> {
    let section = block.section(false)?;
    let filling = section.rest().len().next_multiple_of(4) - section.rest().len();
    block.take(filling.min(block.rest().len()))?;
    Some(section)
}

fn read_sampled_tip(
    record: &mut ByteCursor,
    size: Size,
    bits: u16,
    compression: u8,
) -> Option<Picture> {
    let shape = ChannelLayout {
        width: size.width as usize,
        height: size.height as usize,
        bits,
        is_color: true,
        large: false,
    };
    // Of Photoshop's compressions, tips use only plain rows and run lengths.
    let values = (compression < 2).then(|| decode_as(record, shape, u16::from(compression)))??;
    Picture::srgb8(size, values.into_iter().map(|v| [v, v, v, 255]).collect())
}
