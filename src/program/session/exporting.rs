//! How a document is exported, which is remembered with it while it is open. Floor 6. Not here: the
//! formats (`io::export`).

use crate::document::Document;
use crate::io::Budget;
use crate::io::export::{ExportOptions, Output};
use crate::io::profile_change;
use crate::math::srgb::Color;
use crate::math::{ColorProfile, Rect, Size};
use crate::{Error, Result};
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// The size of an exported picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExportSize {
    /// So many times the canvas.
    Scale(f32),
    /// So many pixels wide; the height follows.
    Width(u32),
}

/// How a document is exported.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExportSettings {
    /// Behind transparent parts.
    pub background: Option<Color>,
    /// Of a JPEG, 1 … 100.
    pub quality: u8,
    /// Per channel; if absent, the format's default.
    pub bits: Option<u8>,
    /// How large it is.
    pub size: ExportSize,
    /// Only the box around the selection, where there is one.
    pub selection: bool,
    /// What colors are converted to; if absent, they stay in the document's profile.
    pub profile: Option<ColorProfile>,
}

/// A file that a document was exported to, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportedFile {
    /// The file.
    pub file: PathBuf,
    /// How it was written.
    pub settings: ExportSettings,
}

impl ExportSize {
    /// Factors that can be chosen.
    pub const SCALE: RangeInclusive<f32> = 0.01..=16.0;

    /// The factor for a canvas.
    pub fn factor(self, canvas: Size) -> f32 {
        match self {
            ExportSize::Scale(factor) => factor.max(*Self::SCALE.start()).min(*Self::SCALE.end()),
            ExportSize::Width(width) => width.max(1) as f32 / canvas.width.max(1) as f32,
        }
    }
}

impl Default for ExportSettings {
    fn default() -> Self {
        let ExportOptions { background, quality, bits, .. } = ExportOptions::default();
        let (size, selection, profile) = (ExportSize::Scale(1.0), false, None);
        Self { background, quality, bits, size, selection, profile }
    }
}

impl ExportSettings {
    /// The part of the canvas that is exported.
    pub fn part(&self, document: &Document) -> Rect {
        let canvas = document.size.rect();
        let selected = document.active_coverage().filter(|_| self.selection);
        selected.map_or(canvas, |selected| selected.covered_rect().intersect(canvas))
    }

    /// The size of the exported picture.
    pub fn pixels(&self, document: &Document) -> Size {
        let part = self.part(document);
        let part = Size::new(part.width() as u32, part.height() as u32);
        part.scaled(self.size.factor(part))
    }

    /// The document at the size that is exported, and how it is written. Fails where it has too
    /// many pixels, or the format cannot hold a part alone.
    pub fn prepare(
        &self,
        document: &Document,
        file: &Path,
        budget: &Budget,
    ) -> Result<(Document, ExportOptions)> {
        let part = self.part(document);
        if part.is_empty() {
            return Err(Error::unsupported_file(file, "the selection lies outside of the canvas"));
        }
        let is_whole = part == document.size.rect();
        if !is_whole && Output::of(file)? == Output::Psd {
            let reason = "a Photoshop file holds the whole canvas, not the selection alone";
            return Err(Error::unsupported_file(file, reason));
        }
        let factor = self.size.factor(Size::new(part.width() as u32, part.height() as u32));
        let scaled = scale_document(file, document, factor, budget)?;
        let scaled = match self.profile.filter(|_| matches!(Output::of(file), Ok(Output::Psd))) {
            Some(profile) => profile_change::convert(&scaled, profile, budget).document,
            None => scaled,
        };
        let crop = (!is_whole).then(|| {
            // Of whole pixels, wherever the factor leads.
            let along = |at: i32, to: u32, from: u32| {
                (f64::from(at) * f64::from(to) / f64::from(from.max(1))).round() as i32
            };
            let (to, from, size) = (scaled.size, document.size, self.pixels(document));
            let x0 = along(part.x0, to.width, from.width);
            let y0 = along(part.y0, to.height, from.height);
            Rect::new(x0, y0, x0 + size.width as i32, y0 + size.height as i32)
        });
        let Self { background, quality, bits, profile, .. } = *self;
        let options = ExportOptions::default();
        Ok((scaled, ExportOptions { background, quality, bits, crop, profile, ..options }))
    }
}

/// The document at another size, within a budget.
pub fn scale_document(
    file: &Path,
    document: &Document,
    factor: f32,
    budget: &Budget,
) -> Result<Document> {
    if factor == 1.0 {
        return Ok(document.clone());
    }
    let size = document.size.scaled(factor);
    budget.size(file, size.width.into(), size.height.into())?;
    // A surface is made again from normals, depth and coverage; layers are copied.
    let a_pixel = if document.surface.is_some() { 40 } else { 8 };
    let shape = document.shape_bytes(&document.parts.list) as f64 * f64::from(factor * factor);
    let bytes = (size.area() as u64 * a_pixel).max(shape as u64);
    budget.room(file, &format!("a canvas of {size} pixels"), bytes)?;
    document.scaled(factor).map_err(|error| Error::unsupported_file(file, error))
}
