//! Pictures in EXR files: which of a file's layers is the picture, and all of them as layers.
//! Floor 5.

use crate::Budget;
use crate::exr::{ExrFile, ExrPass};
use crate::math::{ColorProfile, ProfileConversion};
use crate::raster::Picture;
use crate::{Error, Result};
use std::path::Path;

/// Usual names of the layer that shows all the others, the likeliest first.
pub(super) const WHOLE: [&str; 7] = ["", "combined", "beauty", "rgba", "rgb", "color", "colour"];

/// The picture of an EXR, straight alpha.
pub fn decode(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Picture> {
    let exr = ExrFile::open(file, bytes, budget)?;
    picture(file, &exr, choose_pass(file, &exr)?, budget)
}

/// The finished picture that a renderer stored with its maps, and its layer's name; `None` if there
/// is none.
///
/// * `maps`: the layer that was read as normals, which is no picture.
pub fn read_finished_picture(
    file: &Path,
    bytes: &[u8],
    maps: &str,
    budget: &Budget,
) -> Result<Option<(String, Picture)>> {
    if !ExrFile::is_exr(bytes) {
        return Ok(None);
    }
    let exr = ExrFile::open(file, bytes, budget)?;
    let is_finished = |pass: &&ExrPass| {
        pass.letters("rgb").is_some() && rank(pass) < WHOLE.len() && pass.name != maps
    };
    let Some(pass) = exr.passes().iter().filter(is_finished).min_by_key(|pass| rank(pass)) else {
        return Ok(None);
    };
    Ok(Some((pass.name.clone(), picture(file, &exr, pass, budget)?)))
}

/// A layer as a picture.
fn picture(file: &Path, exr: &ExrFile, pass: &ExrPass, budget: &Budget) -> Result<Picture> {
    // Once while it is collected, once as the shared copy.
    let bytes = exr.size().area() as u64 * 2 * size_of::<[f32; 4]>() as u64;
    budget.room(file, &format!("a picture of {} pixels of light", exr.size()), bytes)?;
    let mut texels = Vec::with_capacity(exr.size().area());
    let conversion = conversion(exr, budget);
    in_bands(file, exr, pass, |band| {
        texels.extend(band.iter().map(|&texel| convert(straight(texel), conversion)));
        Ok(())
    })?;
    Picture::linear(exr.size(), texels)
        .ok_or_else(|| Error::decode(file, "the picture has no pixels"))
}

/// EXR's alpha is associated: colors are stored multiplied by it.
pub fn straight([r, g, b, a]: [f32; 4]) -> [f32; 4] {
    if a > 0.0 && a < 1.0 { [r / a, g / a, b / a, a] } else { [r, g, b, a] }
}

/// How light in Display P3 becomes that of a document in sRGB.
pub fn conversion(exr: &ExrFile, budget: &Budget) -> Option<&'static ProfileConversion> {
    let is_p3 = exr.profile() == ColorProfile::DisplayP3;
    is_p3.then(|| exr.profile().conversion_to(budget.profile)).flatten()
}

/// Straight light, converted if that is to be done.
pub fn convert([r, g, b, a]: [f32; 4], by: Option<&ProfileConversion>) -> [f32; 4] {
    let [r, g, b] = by.map_or([r, g, b], |by| by.light([r, g, b]));
    [r, g, b, a]
}

/// The place of a layer's name among those of the whole picture; beyond them for others.
pub(super) fn rank(pass: &ExrPass) -> usize {
    let last = pass.name.rsplit('.').next().unwrap_or("").to_lowercase();
    WHOLE.iter().position(|known| *known == last).unwrap_or(WHOLE.len())
}

/// The color layer of an EXR: the unnamed one, else one called color or beauty, else the first
/// with R, G and B, else a lone gray channel.
pub fn choose_pass<'e>(file: &Path, exr: &'e ExrFile) -> Result<&'e ExrPass> {
    let color = |pass: &&ExrPass| pass.letters("rgb").is_some();
    let gray = |pass: &&ExrPass| {
        pass.letters("y").or(pass.letters("a")).is_some() || pass.channels.len() == 1
    };
    let passes = exr.passes();
    let found = passes.iter().filter(color).min_by_key(|p| rank(p));
    found.or_else(|| passes.iter().filter(gray).min_by_key(|p| rank(p))).ok_or_else(|| {
        let names: Vec<&str> = passes.iter().map(|p| p.name.as_str()).collect();
        Error::unsupported_file(
            file,
            format!("no layer of this EXR has R, G and B; it has {}", names.join(", ")),
        )
    })
}

/// Passes on the colors of a layer as stored (gray repeated in all three, alpha 1 if absent):
/// whole rows from the top, a multiple of the height of tiles at a time, so that only these are in
/// memory.
pub fn in_bands(
    file: &Path,
    exr: &ExrFile,
    pass: &ExrPass,
    mut take: impl FnMut(&[[f32; 4]]) -> Result<()>,
) -> Result<()> {
    let rgb = pass.letters("rgb").or(pass.letters("y").map(|y| vec![y[0]; 3]));
    let only = pass
        .channels
        .first()
        .ok_or_else(|| Error::decode(file, "a layer of the EXR has no channels"))?;
    let rgb = rgb.unwrap_or_else(|| vec![*only; 3]);
    let alpha = pass.letters("a").filter(|a| a[0] != rgb[0]);
    let wanted: Vec<usize> = rgb.iter().chain(alpha.iter().flatten()).copied().collect();
    let finite = |v: f32| if v.is_finite() { v } else { v.max(0.0).min(65504.0) };
    let mut texels = Vec::new();
    for rows in exr.bands() {
        let planes = exr.read_rows(&wanted, rows.clone())?;
        let texel = |i: usize| {
            std::array::from_fn(|c| planes.get(c).map_or(1.0, |plane| finite(plane.values()[i])))
        };
        texels.clear();
        texels.extend((0..rows.len() * exr.size().width as usize).map(texel));
        take(&texels)?;
    }
    Ok(())
}
