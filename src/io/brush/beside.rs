//! The files that a preset names and does not hold: its tip and its pattern. Floor 5. They lie where
//! Krita puts them: in the preset's folder, in `brushes` and `patterns` beside that folder, or in a
//! bundle in the preset's folder, in `bundles` beside it or in the folder of both. Nothing else is
//! read.

use crate::files::{RecipeFolder, refusal};
use crate::platform::{files as disk, is_file};
use crate::project::Archive;
use crate::{Budget, Error, Files, Result};
use std::path::{Path, PathBuf};

/// What a file is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResourceKind {
    /// The tip of a brush.
    Tip,
    /// The pattern of a texture.
    Pattern,
}

impl ResourceKind {
    /// Both, each with the folder that Krita keeps them in and the word that its files use.
    const ALL: [(Self, &'static str); 2] =
        [(ResourceKind::Tip, "brushes"), (ResourceKind::Pattern, "patterns")];

    /// The folder of such files.
    pub fn folder(self) -> &'static str {
        Self::ALL.iter().find(|(kind, _)| *kind == self).map_or("", |(_, folder)| folder)
    }

    /// The kind by the name of its folder.
    pub fn of_folder(folder: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, known)| *known == folder).map(|(kind, _)| *kind)
    }
}

/// Where the files that a preset names are found.
pub trait BrushFiles {
    /// The file of this name, which has no folders; `None` where there is none. Fails with a
    /// sentence where it cannot be read.
    fn find(&self, kind: ResourceKind, name: &str, budget: &Budget) -> Result<Option<Vec<u8>>>;
}

/// No files: a preset has what it holds itself.
pub struct NoBrushFiles;

impl BrushFiles for NoBrushFiles {
    fn find(&self, _: ResourceKind, _: &str, _: &Budget) -> Result<Option<Vec<u8>>> {
        Ok(None)
    }
}

/// The last part of a name, since older presets hold whole paths; `None` for one that is no name of
/// a file.
pub fn base_name(name: &str) -> Option<&str> {
    let name = name.rsplit(['/', '\\', ':']).next().unwrap_or_default().trim();
    (refusal(name).is_none() && name != ".").then_some(name)
}

/// The entries of a bundle.
pub struct BundleFiles<'a>(pub &'a Archive<'a>);

impl BrushFiles for BundleFiles<'_> {
    fn find(&self, kind: ResourceKind, name: &str, budget: &Budget) -> Result<Option<Vec<u8>>> {
        let entry = format!("{}/{name}", kind.folder());
        let is_there = base_name(name) == Some(name) && self.0.has_entry(&entry);
        is_there.then(|| self.0.bytes(&entry, budget.file_bytes)).transpose()
    }
}

/// The files around a preset on the disk.
pub struct NeighborFiles {
    folder: PathBuf,
}

impl NeighborFiles {
    /// More bundles than a folder has.
    const MOST_BUNDLES: usize = 16;

    /// The files around this preset.
    pub fn of(preset: &Path) -> Self {
        Self { folder: preset.parent().unwrap_or(Path::new("")).into() }
    }

    /// The folder that holds the preset's own.
    fn outer_folder(&self) -> PathBuf {
        match (self.folder.file_name(), self.folder.parent()) {
            (Some(_), Some(outer)) => outer.into(),
            _ => self.folder.join(".."),
        }
    }

    /// The bundles around the preset, those of each folder by name.
    fn bundles(&self) -> Vec<PathBuf> {
        let here = if self.folder.as_os_str().is_empty() { Path::new(".") } else { &self.folder };
        let outer = self.outer_folder();
        let folders = [here, &outer.join("bundles"), &outer];
        let mut bundles: Vec<PathBuf> = folders.into_iter().flat_map(bundles_in).collect();
        bundles.truncate(Self::MOST_BUNDLES);
        bundles
    }

    fn find_in_bundles(
        &self,
        kind: ResourceKind,
        name: &str,
        budget: &Budget,
    ) -> Result<Option<Vec<u8>>> {
        let mut failed = None;
        for file in self.bundles() {
            let found = crate::files::read_file(&file, budget.file_bytes).and_then(|bytes| {
                let archive = Archive::open(&file, &bytes, budget)?;
                BundleFiles(&archive).find(kind, name, budget)
            });
            match found {
                Ok(None) => {}
                Ok(found) => return Ok(found),
                Err(error) => failed = failed.or(Some(error)),
            }
        }
        failed.map_or(Ok(None), Err)
    }
}

/// The bundles of a folder, by name.
fn bundles_in(folder: &Path) -> Vec<PathBuf> {
    let entries = disk::read_dir(folder).into_iter().flatten().flatten();
    let is_bundle = |file: &PathBuf| {
        let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        extension == "bundle" && is_file(file)
    };
    let mut bundles: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(is_bundle).collect();
    bundles.sort();
    bundles
}

impl BrushFiles for NeighborFiles {
    fn find(&self, kind: ResourceKind, name: &str, budget: &Budget) -> Result<Option<Vec<u8>>> {
        if base_name(name) != Some(name) {
            return Err(Error::unsupported_file(name, "it is no plain name of a file"));
        }
        let beside = format!("{}/{name}", kind.folder());
        for (folder, name) in [(self.folder.clone(), name), (self.outer_folder(), &beside)] {
            if is_file(&folder.join(name)) {
                return RecipeFolder::new(folder).read(name, budget).map(Some);
            }
        }
        self.find_in_bundles(kind, name, budget)
    }
}

#[cfg(test)]
mod tests;
