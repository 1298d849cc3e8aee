//! A brush as a file of this program: a preset's JSON, its pictures beside it.
//! Floor 5.

use crate::document::Progress;
use crate::fs::Disk;
use crate::paint::PictureSource;
use crate::project::pixels;
use crate::raster::Asset;
use crate::raster::picture::Texels;
use crate::recipe::{Preset, write_preset};
use crate::{Error, Result};
use crate::{Overwrite, exr, save};
use std::path::Path;

/// Writes a preset to `file`; its pictures become `STEM.png`, `STEM.2.png` … in the same folder. The preset with these
/// names.
///
/// The pictures are written first, so that an existing preset is complete.
pub fn write(file: &Path, preset: &Preset) -> Result<Preset> {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut number = 0;
    let brush = preset.brush.with_pictures(|source| {
        number += 1;
        let (bytes, extension) = encoded(file, source)?;
        let name = if number == 1 { format!("{stem}.{extension}") } else { format!("{stem}.{number}.{extension}") };
        replace(&file.with_file_name(&name), bytes.bytes())?;
        Ok::<_, Error>(PictureSource::new(name, source.picture.clone(), source.adjust))
    })?;
    let written = Preset { brush, ..preset.clone() };
    let text = serde_json::to_string_pretty(&write_preset(&written)).map_err(|e| Error::unsupported(file, e))? + "\n";
    replace(file, text.as_bytes())?;
    Ok(written)
}

/// Removes a preset's file and the pictures that it names. A missing file is no failure.
pub fn remove(file: &Path, preset: &Preset) -> Result<()> {
    let beside = preset.brush.pictures().map(|source| Path::new(&source.file));
    let beside = beside.filter(|name| name.file_name() == Some(name.as_os_str())).map(|name| file.with_file_name(name));
    // The preset is removed first, so that nothing refers to the remaining pictures.
    for file in std::iter::once(file.to_owned()).chain(beside) {
        match std::fs::remove_file(&file) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => return Err(Error::io(file, error)),
            _ => {}
        }
    }
    Ok(())
}

/// Without loss: bytes as PNG, light as EXR.
fn encoded(file: &Path, source: &PictureSource) -> Result<(Asset, &'static str)> {
    let picture = &source.picture;
    match &picture.texels {
        Texels::Srgb8(texels) => pixels::encode_texels(file, texels, picture.size).map(|png| (png, "png")),
        Texels::Linear(texels) => exr::encode_light(file, picture.size, texels).map(|exr| (exr.into(), "exr")),
    }
}

fn replace(file: &Path, bytes: &[u8]) -> Result<()> {
    // Nothing cancels this.
    save::replace(&Disk, file, bytes, Overwrite::Anything, &Progress::default()).map(|_| ())
}
