//! The budget of every reader: no allocation is sized by a file's own numbers without a check
//! against it. Floor 5.

#![warn(missing_docs)]

use crate::document::{Content, Document, Part, PartKind};
use crate::math::{ColorProfile, Size};
use crate::memory;
use crate::paint::{Sample, Stroke};
use crate::raster::{Picture, Tile};
use crate::surface::Bend;
use crate::{Error, Remedy, Result};
use std::path::Path;
use std::sync::Arc;

/// Limits for what one file may request. The command line raises them with `--max-pixels`,
/// `--max-side` and `--max-memory`.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Longest side of a picture, px.
    pub side_px: u32,
    /// Pixels of a picture.
    pub area_px: u64,
    /// Pixels of all pictures of one document together.
    pub document_px: u64,
    /// Pixels in which regions of the surface are looked for, all together.
    pub region_px: u64,
    /// Bytes that reading a file may take at its peak, what was read included.
    pub memory_bytes: u64,
    /// Whether paint has 16 bits a channel where its file has more than 8. It takes three times the
    /// memory.
    pub sixteen_bit_paint: bool,
    /// The profile of the document that is read for. Colors in Display P3 stay as they are for a
    /// document in Display P3; all others become sRGB.
    pub profile: ColorProfile,
    /// Bytes of any one file.
    pub file_bytes: u64,
    /// Bytes read from all entries of a zip together.
    pub unpacked_bytes: u64,
    /// Entries of a zip.
    pub entries: usize,
    /// Bytes of a JSON text.
    pub json_bytes: u64,
    /// Values of a JSON text, an object counting as eight; each takes some eighty bytes once
    /// parsed.
    pub json_values: usize,
    /// Nesting of a JSON text.
    pub json_depth: usize,
    /// Layers of a document, groups opened.
    pub layers: usize,
    /// Groups around a layer.
    pub group_depth: usize,
    /// Anchors a layer.
    pub anchors: usize,
    /// Readings of the pen a stroke.
    pub samples: usize,
    /// Readings of the pen of all strokes together.
    pub document_samples: usize,
}

impl Default for Budget {
    /// The contents of a document are limited by the constants that also limit edits, so whatever
    /// was saved can be read.
    fn default() -> Self {
        Self {
            side_px: Picture::LONGEST_SIDE_PX,
            area_px: Picture::MOST_PX as u64,
            document_px: 1 << 31,
            region_px: Document::MOST_REGION_PX,
            memory_bytes: super::machine::UNKNOWN_BYTES,
            sixteen_bit_paint: true,
            profile: ColorProfile::default(),
            file_bytes: 2 << 30,
            unpacked_bytes: 8 << 30,
            // Each layer may have a look, pixels and a mask, each brush its pictures; a name takes
            // some hundred bytes.
            entries: 1 << 18,
            // The limit on values also bounds the text, except for readings of the pen, which are
            // packed before parsing: whatever edits may hold of them is read.
            json_bytes: (256 << 20) + Document::MOST_SAMPLES as u64 * Sample::MOST_CHARS,
            json_values: Document::MOST_VALUES,
            // A group takes two levels; the contents of the innermost take the rest. The parser
            // goes no deeper than 127.
            json_depth: 2 * Document::DEEPEST + 20,
            layers: Document::MOST_LAYERS,
            group_depth: Document::DEEPEST,
            anchors: Bend::MOST_ANCHORS,
            samples: Stroke::MOST_SAMPLES,
            document_samples: Document::MOST_SAMPLES,
        }
    }
}

impl Budget {
    /// The usual budget, raised for a document with a larger canvas, or with maps that were put on
    /// one; whoever reads it must raise theirs again. What its paint takes is in memory already,
    /// and as much is free as this machine has.
    pub fn holding(document: &Document) -> Self {
        let usual = Self::default();
        let painted = document.walk().into_iter().map(|(_, layer)| match &layer.content {
            Content::Pixels(pixels) => pixels.tiles.bytes() as u64,
            _ => 0,
        });
        let memory_bytes =
            usual.memory_bytes.max(super::machine::free_bytes()).saturating_add(painted.sum());
        let frame = |part: &Arc<Part>| match &part.kind {
            PartKind::Maps(maps) => Some(maps.surface.size()),
            _ => None,
        };
        let sizes = || document.parts.list.iter().filter_map(frame).chain([document.size]);
        let area_px = sizes().map(|size| size.area() as u64).fold(usual.area_px, u64::max);
        Self {
            side_px: sizes().map(|size| size.width.max(size.height)).fold(usual.side_px, u32::max),
            area_px,
            document_px: usual.document_px.max(area_px.saturating_mul(4)),
            memory_bytes,
            ..usual
        }
    }

    /// The usual limits on this machine as it is now: `memory_bytes` is what is free, minus a
    /// reserve.
    pub fn of_this_machine() -> Self {
        Self::default().within(super::machine::free_bytes())
    }

    /// Bytes that a pixel of paint takes at most.
    pub fn paint_bytes(&self) -> u64 {
        Tile::most_bytes_a_pixel(self.sixteen_bit_paint)
    }

    /// With so much memory.
    pub fn within(self, memory_bytes: u64) -> Self {
        // A file and its unpacked data are in memory together with what is made from them.
        let share = memory_bytes / 2;
        Self {
            memory_bytes,
            file_bytes: self.file_bytes.min(share),
            unpacked_bytes: self.unpacked_bytes.min(share.saturating_mul(4)),
            // Beside a text there are its packed form and what is parsed from it.
            json_bytes: self.json_bytes.min(share / 4),
            ..self
        }
    }

    /// Checks memory before it is allocated. `what`: for the sentence, in front of “takes”.
    pub fn room(&self, file: &Path, what: &str, bytes: u64) -> Result<()> {
        let too_large = |reason| Error::too_large(file, reason).with_remedy(Remedy::MoreMemory);
        self.room_for(what, bytes).map_err(too_large)
    }

    /// The same for work that belongs to no file; fails with a sentence without its full stop.
    pub fn room_for(&self, what: &str, bytes: u64) -> Result<(), String> {
        memory::room_for(what, bytes, self.memory_bytes)
    }

    /// Checks memory before the surface of some parts is made. `held_bytes`: of the layers that
    /// were read.
    pub fn room_for_shape(
        &self,
        file: &Path,
        document: &Document,
        list: &[Arc<Part>],
        held_bytes: u64,
    ) -> Result<()> {
        let held_bytes = held_bytes + document.maps_surface().map_or(0, |maps| maps.map_bytes());
        let bytes = document.shape_bytes(list).saturating_add(held_bytes);
        self.room(file, &document.shape_work(list), bytes)
    }

    /// The size, or a sentence saying which limit it breaks. A side of 0 is not a picture.
    pub fn size(&self, file: &Path, width: u64, height: u64) -> Result<Size> {
        if width == 0 || height == 0 {
            return Err(Error::decode(
                file,
                format!("a picture of {width} × {height} pixels has no pixels"),
            ));
        }
        if width.max(height) > u64::from(self.side_px) {
            let reason = format!("{width} × {height} pixels; a side may have {}", self.side_px);
            return Err(Error::too_large(file, reason).with_remedy(Remedy::LongerSides));
        }
        if width * height > self.area_px {
            let reason = format!("{width} × {height} pixels; a picture may have {}", self.area_px);
            return Err(Error::too_large(file, reason).with_remedy(Remedy::MorePixels));
        }
        Ok(Size::new(width as u32, height as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_names_what_is_asked_and_what_there_is() {
        let budget = Budget::default().within(3_000_000_000);
        assert!(budget.room(Path::new("n.png"), "its surface", 3_000_000_000).is_ok());
        let said = budget.room(Path::new("n.png"), "its surface", 7_250_000_000).unwrap_err();
        assert_eq!(
            said.to_string(),
            "n.png: too large: its surface takes 7.2 GB of memory, and 3.0 GB are free for it"
        );
        assert_eq!(said.remedy(), Some(Remedy::MoreMemory));
    }
}
