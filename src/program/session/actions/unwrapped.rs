//! Pictures of the unwrapped surface: written to a file, and put back on the surface. Floor 6. Not
//! here: drawing them (`document::view`), the sheet (`surface::unwrap`).

use crate::document::view::{UnwrapOptions, place_over, render_unwrapped};
use crate::document::{Document, Highlights, Progress};
use crate::io::Terms;
use crate::io::export::high_depth::encode_in as encode_floats;
use crate::io::export::{ExportFormat, ExportOptions, OutputFile, encode_in};
use crate::math::ColorProfile;
use crate::math::srgb::Color;
use crate::raster::{Outside, Picture, TileGrid, picture::Texels};
use crate::session::Session;
use crate::session::actions::placing::{Lies, add_image, in_profile};
use crate::{Error, Result};
use std::path::Path;

/// Writes a painting as it lies in the planes of its surface; nothing if canceled.
///
/// Fails if there is no surface, and for formats that cannot hold what is requested.
pub fn export(
    document: &Document,
    file: &Path,
    options: UnwrapOptions,
    terms: Terms,
    progress: &Progress,
) -> Result<()> {
    let target = OutputFile::new(file, terms)?;
    let format = ExportFormat::of(file)?;
    // A file of light keeps highlights.
    let floats = (format == ExportFormat::Exr).then_some(Highlights::Kept).or(options.floats);
    let options = UnwrapOptions { floats, ..options };
    let seen = match render_unwrapped(document, None, options, progress) {
        _ if progress.is_canceled() => return Ok(()),
        seen => seen.map_err(|why| Error::unsupported_file(file, why))?,
    };
    // A JPEG has no transparency for what lies between the pieces.
    let background = (format == ExportFormat::Jpeg).then_some(Color::WHITE);
    let written = ExportOptions { background, ..ExportOptions::default() };
    let profile = document.profile;
    if floats.is_some() {
        let bytes = encode_floats(file, format, &seen.pixels, seen.size, &written, profile)?;
        return target.replace(&bytes);
    }
    let Some(Texels::Srgb8(texels)) = seen.picture().map(|picture| picture.texels) else {
        return Ok(());
    };
    let (width, height) = (seen.size.width as usize, seen.size.height as usize);
    let grid = TileGrid::from_straight_rgba(texels.as_flattened(), width, height, 0, 0);
    target.replace(&encode_in(file, format, &grid, seen.size, &written, profile)?)
}

/// How far the sides of a picture may differ from the sheet's, as a ratio, without a note.
const SAME_ASPECT: f32 = 0.005;

/// A picture of the sheet becomes an image layer above the selected one, pixel for pixel where the
/// sheet shows it.
pub fn place(session: &mut Session, name: &str, picture: Picture) {
    let settings = session.unwrap_settings();
    let Some(open) = session.active_mut() else { return };
    let document = open.document();
    let Some(layout) = document.surface.as_ref().and_then(|surface| surface.plane_layout(settings))
    else {
        return session.notes.push("There is no surface to unwrap.".into());
    };
    let picture = in_profile(&picture, ColorProfile::Srgb, document);
    let (sheet, size) = (layout.size(), picture.size);
    let lies = Lies {
        placement: place_over(sheet.rect(), size, document.size),
        outside: Outside::None,
        bend: layout.bend(),
    };
    if add_image(open, name, picture, lies, "Import unwrapped") {
        let aspect = |size: crate::math::Size| size.width as f32 / size.height.max(1) as f32;
        if (aspect(size) / aspect(sheet) - 1.0).abs() > SAME_ASPECT {
            session.notes.push(format!(
                "The picture has {size} pixels, the unwrapped surface {sheet}: the width matches, \
                 the height does not."
            ));
        }
    }
}
