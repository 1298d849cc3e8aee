//! A brush as a file of this program: a preset's JSON, with its pictures next to it. Floor 5.

use crate::document::Progress;
use crate::fs::Disk;
use crate::paint::PictureSource;
use crate::picture;
use crate::raster::Asset;
use crate::recipe::{BrushPreset, write_preset};
use crate::replace::{Terms, check, replace};
use crate::{Error, Result};
use std::path::{Path, PathBuf};

/// A preset as files, not written yet.
pub struct Encoded {
    /// With the names of its pictures.
    pub preset: BrushPreset,
    /// The pictures first, so that a preset that exists is complete.
    files: Vec<(PathBuf, Asset)>,
}

/// A preset as it is written to `file`; its pictures become `STEM.png`, `STEM.2.png` … in the same
/// folder.
pub fn encode(file: &Path, preset: &BrushPreset) -> Result<Encoded> {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut files: Vec<(PathBuf, Asset)> = Vec::new();
    let brush = preset.brush.with_pictures(|source| {
        let (bytes, extension) = picture::encode(file, &source.picture)?;
        let number = files.len() + 1;
        let name = if number == 1 {
            format!("{stem}.{extension}")
        } else {
            format!("{stem}.{number}.{extension}")
        };
        files.push((file.with_file_name(&name), bytes));
        Ok::<_, Error>(PictureSource::new(name, source.picture.clone(), source.adjust))
    })?;
    let preset = BrushPreset { brush, ..preset.clone() };
    let text = serde_json::to_string_pretty(&write_preset(&preset))
        .map_err(|e| Error::unsupported_file(file, e))?
        + "\n";
    files.push((file.into(), text.into_bytes().into()));
    Ok(Encoded { preset, files })
}

impl Encoded {
    /// Whether each of its files may be written.
    pub fn check(&self, terms: &Terms) -> Result<()> {
        self.files.iter().try_for_each(|(file, _)| check(&Disk, file, terms))
    }

    /// Writes them; none where `terms` do not allow all of them.
    pub fn write(&self, terms: &Terms) -> Result<()> {
        self.check(terms)?;
        // Never canceled.
        let put = |(file, bytes): &(PathBuf, Asset)| {
            replace(&Disk, file, bytes.bytes(), terms, &Progress::default())
        };
        self.files.iter().try_for_each(|file| put(file).map(drop))
    }
}

/// The pictures that a preset's file names, which are next to it.
pub fn pictures_beside(file: &Path, preset: &BrushPreset) -> impl Iterator<Item = PathBuf> {
    let names = preset.brush.pictures().map(|source| Path::new(&source.file));
    names
        .filter(|name| name.file_name() == Some(name.as_os_str()))
        .map(|name| file.with_file_name(name))
}

/// Removes a preset's file and the pictures that it names. A missing file is no failure.
pub fn remove(file: &Path, preset: &BrushPreset) -> Result<()> {
    // The preset first: what is left then is named by nobody.
    for file in std::iter::once(file.to_owned()).chain(pictures_beside(file, preset)) {
        match crate::platform::files::remove_file(&file) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                return Err(Error::io(file, error));
            }
            _ => {}
        }
    }
    Ok(())
}
