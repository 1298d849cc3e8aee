//! A project while it is read, and the notes about it. Floor 5. `open` reads what was saved,
//! `foreign` what another program made of it, `repair` leaves out what is damaged.

use super::png_header::{PNG_HEADER, is_16_bit_png};
use super::{Archive, DOCUMENT};
use crate::document::Document;
use crate::document::EncodedPixels;
use crate::math::ColorProfile;
use crate::raster::TileGrid;
use crate::recipe::{self, RecipeSource};
use crate::{Budget, Error, Remedy, Result};
use serde_json::Value;
use std::path::Path;

/// A project being read, and the notes about it.
pub struct ProjectReader<'a> {
    pub file: &'a Path,
    pub archive: &'a Archive<'a>,
    pub budget: &'a Budget,
    /// The color profile of the document.
    pub profile: ColorProfile,
    pub notes: Vec<String>,
    pub is_whole: bool,
    /// Pixels that are known to be those of these files.
    pub known: Vec<(EncodedPixels, TileGrid)>,
}

impl ProjectReader<'_> {
    /// The budget of pictures of the document.
    pub fn picture_budget(&self) -> Budget {
        Budget { profile: self.profile, ..*self.budget }
    }

    /// Notes a difference that loses nothing.
    pub fn note(&mut self, sentence: impl Into<String>) {
        self.notes.push(sentence.into());
    }

    /// Notes a loss.
    pub fn note_loss(&mut self, sentence: impl Into<String>) {
        self.is_whole = false;
        self.notes.push(sentence.into());
    }

    /// Whether something was refused that may fit once paint has 8 bits: then nothing is left out,
    /// and the file is read again (`sixteen_bit_paint`).
    pub fn can_fit_if_rounded(&self, error: &Error) -> bool {
        let is_16_bit = |name: &str| {
            self.archive.beginning(name, PNG_HEADER).is_some_and(|bytes| is_16_bit_png(&bytes))
        };
        self.budget.sixteen_bit_paint
            && error.remedy() == Some(Remedy::MoreMemory)
            && self.archive.names().into_iter().filter(|name| name.ends_with(".png")).any(is_16_bit)
    }

    pub fn archive_path(&self, name: &str) -> std::path::PathBuf {
        use crate::Files;
        self.archive.path(name)
    }

    pub fn read_value(&self, value: &Value) -> Result<Document> {
        let path = self.archive_path(DOCUMENT);
        recipe::read_value(
            value,
            RecipeSource { file: &path, files: self.archive, budget: self.budget, onto: None },
        )
    }
}
