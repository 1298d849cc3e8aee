//! Where the pictures of presets come from and go to: files that a preset holds or names become tips
//! and patterns, counted against the budget. Floor 5.

use super::super::beside::{BrushFiles, ResourceKind, base_name};
use super::super::{TipNames, pat, spend, text_of};
use super::settings::KppPreset;
use super::tip_file::{self, TipFile};
use crate::paint::PictureSource;
use crate::raster::Picture;
use crate::raster::picture::Texels;
use crate::{Budget, Error, Result, picture};
use std::path::{Path, PathBuf};

/// The pictures of one preset, or of all presets of a bundle.
pub struct KppPictures<'a> {
    /// For messages.
    file: &'a Path,
    files: &'a dyn BrushFiles,
    budget: &'a Budget,
    names: TipNames,
    used_px: u64,
}

/// Why a file is not used, as the end of a sentence.
type Missing = String;

impl<'a> KppPictures<'a> {
    pub fn new(file: &'a Path, files: &'a dyn BrushFiles, budget: &'a Budget) -> Self {
        Self { file, files, budget, names: TipNames::default(), used_px: 0 }
    }

    pub fn budget(&self) -> &'a Budget {
        self.budget
    }

    /// The tip that a preset names.
    pub fn find_tip(&mut self, preset: &KppPreset, named: &str) -> Result<TipFile, Missing> {
        let called = quote(named);
        let Some(name) = base_name(named) else {
            return Err(format!("{called} is no name of a file"));
        };
        let damaged = |e: Error| format!("{called} cannot be used ({e})");
        if let Some(bytes) = self.bytes(preset, ResourceKind::Tip, name).map_err(damaged)? {
            let tip = tip_file::decode(&self.path(name), &bytes, self.budget).map_err(damaged)?;
            return self.count(tip).map_err(damaged);
        }
        if let Some(tip) = self.find_sampled_tip(preset, name).map_err(damaged)? {
            return self.count(tip).map_err(damaged);
        }
        Err(format!("{called} is not in the file or beside it"))
    }

    /// A tip of one of Photoshop's collections is named by the collection and its number: `Set_3`.
    fn find_sampled_tip(&self, preset: &KppPreset, name: &str) -> Result<Option<TipFile>> {
        let Some((stem, number)) = name.rsplit_once('_') else { return Ok(None) };
        let Ok(number) = number.parse() else { return Ok(None) };
        let file = format!("{stem}.abr");
        let bytes = self.bytes(preset, ResourceKind::Tip, &file)?;
        bytes
            .map(|bytes| tip_file::decode_sampled(&self.path(&file), &bytes, number, self.budget))
            .transpose()
    }

    /// The pattern of a preset's texture: from within its settings, or the file that they name.
    pub fn find_pattern(&mut self, preset: &KppPreset) -> Result<Picture, Missing> {
        let of = |name: &str| preset.text(name).to_owned();
        let names = [of("Texture/Pattern/PatternFileName"), of("Texture/Pattern/Name")];
        let named = names.iter().find(|name| !name.is_empty()).cloned().unwrap_or_default();
        let called = quote(base_name(&named).unwrap_or(&named));
        let damaged = |e: Error| format!("{called} cannot be used ({e})");
        let mut found = preset.held_png("Texture/Pattern/Pattern");
        for name in names.iter().filter_map(|name| base_name(name)) {
            if found.is_none() {
                found = self.bytes(preset, ResourceKind::Pattern, name).map_err(damaged)?;
            }
        }
        let Some(bytes) = found else {
            return Err(format!("{called} is not in the file or beside it"));
        };
        let path = self.path(base_name(&named).unwrap_or("pattern"));
        let picture = if pat::is_pat(&bytes) {
            pat::read(&path, &bytes, self.budget)
        } else {
            picture::decode(&path, &bytes, self.budget)
        };
        let picture = picture.map_err(damaged)?;
        if matches!(picture.texels, Texels::Linear(_)) {
            return Err(format!("{called} holds light beyond white"));
        }
        spend(self.file, self.budget, &mut self.used_px, picture.size.area() as u64)
            .map_err(damaged)?;
        Ok(picture)
    }

    /// A picture under a name of its own.
    pub fn add(&mut self, picture: Picture, name: &str) -> PictureSource {
        self.names.add(self.file, picture, name)
    }

    fn bytes(&self, preset: &KppPreset, kind: ResourceKind, name: &str) -> Result<Option<Vec<u8>>> {
        match preset.held_file(kind, name) {
            Some(bytes) => Ok(Some(bytes)),
            None => self.files.find(kind, name, self.budget),
        }
    }

    fn count(&mut self, tip: TipFile) -> Result<TipFile> {
        spend(self.file, self.budget, &mut self.used_px, tip.area_px())?;
        Ok(tip)
    }

    /// A file's path, for messages.
    fn path(&self, name: &str) -> PathBuf {
        self.file.join(name)
    }
}

fn quote(name: &str) -> String {
    format!("“{}”", text_of(name.as_bytes()))
}
