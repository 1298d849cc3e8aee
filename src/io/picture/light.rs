//! Pictures in EXR files: which of a file's layers is the picture, and all of them as layers.
//! Floor 5.

use crate::Budget;
use crate::exr::{ExrFile, ExrPass};
use crate::raster::Picture;
use crate::{Error, Result};
use std::path::Path;

/// Usual names of the layer that shows all the others, the likeliest first.
const WHOLE: [&str; 7] = ["", "combined", "beauty", "rgba", "rgb", "color", "colour"];

/// The picture of an EXR, straight alpha.
pub fn decode(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Picture> {
    let exr = ExrFile::open(file, bytes, budget)?;
    picture(file, &exr, texels(file, &exr)?)
}

/// A layer of colours.
pub struct LightLayer {
    /// Empty for the channels without a layer.
    pub name: String,
    pub picture: Picture,
    /// Whether it is the picture to show; usually it combines all the others.
    pub is_whole: bool,
}

/// Every layer of colours of an EXR, in the file's order; none where there are not several.
///
/// Fails as [`decode`](super::decode) does, and where all of them together are beyond the budget.
pub fn layers(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Vec<LightLayer>> {
    if !ExrFile::is_exr(bytes) {
        return Ok(Vec::new());
    }
    let exr = ExrFile::open(file, bytes, budget)?;
    // Cryptomatte stores object ids in colour channels.
    let is_light = |pass: &&ExrPass| pass.letters("rgb").is_some() && !pass.key().starts_with("crypto");
    let passes: Vec<&ExrPass> = exr.passes().iter().filter(is_light).collect();
    if passes.len() < 2 {
        return Ok(Vec::new());
    }
    if passes.len() as u64 * exr.size().area() as u64 > budget.document_px || passes.len() > budget.layers {
        let reason = format!("its {} layers hold more than {} pixels together", passes.len(), budget.document_px);
        return Err(Error::too_large(file, reason));
    }
    let whole = passes.iter().enumerate().filter(|(_, p)| rank(p) < WHOLE.len()).min_by_key(|(_, p)| rank(p));
    // Of several parts, such as the views of two eyes, the first is the one to show.
    let whole = whole.map(|(i, _)| i).or((exr.parts() > 1).then_some(0));
    let one = |(i, pass): (usize, &&ExrPass)| {
        let picture = picture(file, &exr, texels_of(&exr, pass)?)?;
        Ok(LightLayer { name: pass.name.clone(), picture, is_whole: whole == Some(i) })
    };
    passes.iter().enumerate().map(one).collect()
}

/// The finished picture that a renderer stored beside its maps, `None` where there is none.
///
/// * `maps`: the layer that was read as normals, which is no picture.
pub fn finished(file: &Path, bytes: &[u8], maps: &str, budget: &Budget) -> Result<Option<LightLayer>> {
    if !ExrFile::is_exr(bytes) {
        return Ok(None);
    }
    let exr = ExrFile::open(file, bytes, budget)?;
    let is_finished = |pass: &&ExrPass| pass.letters("rgb").is_some() && rank(pass) < WHOLE.len() && pass.name != maps;
    let Some(pass) = exr.passes().iter().filter(is_finished).min_by_key(|pass| rank(pass)) else { return Ok(None) };
    let picture = picture(file, &exr, texels_of(&exr, pass)?)?;
    Ok(Some(LightLayer { name: pass.name.clone(), picture, is_whole: true }))
}

/// EXR's alpha is associated: colours are stored multiplied by it.
fn picture(file: &Path, exr: &ExrFile, mut texels: Vec<[f32; 4]>) -> Result<Picture> {
    for [r, g, b, a] in &mut texels {
        if *a > 0.0 && *a < 1.0 {
            [r, g, b].into_iter().for_each(|c| *c /= *a);
        }
    }
    Picture::linear(exr.size(), texels).ok_or_else(|| Error::decode(file, "the picture has no pixels"))
}

/// The place of a layer's name among those of the whole picture; beyond them for others.
fn rank(pass: &ExrPass) -> usize {
    let last = pass.name.rsplit('.').next().unwrap_or("").to_lowercase();
    WHOLE.iter().position(|known| *known == last).unwrap_or(WHOLE.len())
}

/// The colour layer of an EXR as stored, alpha 1 where it has none: the unnamed one, else one called colour or beauty,
/// else the first with R, G and B, else a lone grey channel.
pub fn texels(file: &Path, exr: &ExrFile) -> Result<Vec<[f32; 4]>> {
    let colour = |pass: &&ExrPass| pass.letters("rgb").is_some();
    let grey = |pass: &&ExrPass| pass.letters("y").or(pass.letters("a")).is_some() || pass.channels.len() == 1;
    let passes = exr.passes();
    let chosen = passes.iter().filter(colour).min_by_key(|p| rank(p));
    let Some(pass) = chosen.or_else(|| passes.iter().filter(grey).min_by_key(|p| rank(p))) else {
        let names: Vec<&str> = passes.iter().map(|p| p.name.as_str()).collect();
        let reason = format!("no layer of this EXR has R, G and B; it has {}", names.join(", "));
        return Err(Error::unsupported(file, reason));
    };
    texels_of(exr, pass)
}

/// The colours of a layer as stored, of a grey one thrice the same.
fn texels_of(exr: &ExrFile, pass: &ExrPass) -> Result<Vec<[f32; 4]>> {
    let rgb = pass.letters("rgb").or(pass.letters("y").map(|y| vec![y[0]; 3]));
    let rgb = rgb.unwrap_or_else(|| vec![pass.channels[0]; 3]);
    let alpha = pass.letters("a").filter(|a| a[0] != rgb[0]);
    let wanted: Vec<usize> = rgb.iter().chain(alpha.iter().flatten()).copied().collect();
    let planes = exr.read(&wanted)?;
    let finite = |v: f32| if v.is_finite() { v } else { v.max(0.0).min(65504.0) };
    let texel = |i: usize| std::array::from_fn(|c| planes.get(c).map_or(1.0, |plane| finite(plane.values()[i])));
    Ok((0..exr.size().area()).map(texel).collect())
}
