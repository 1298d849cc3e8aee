//! The layers of colors of an EXR, as paint.
//! Floor 5.

use super::light::{WHOLE, rank};
use super::painted::of_light;
use crate::Budget;
use crate::exr::{ExrFile, ExrPass};
use crate::pixels::Painted;
use crate::{Error, Result};
use std::path::Path;

/// A layer of colors.
pub struct LightLayer {
    /// Empty for the channels without a layer.
    pub name: String,
    /// The pixels.
    pub painted: Painted,
    /// Whether it is the picture to show; usually it combines all the others.
    pub is_whole: bool,
}

/// Every layer of colors of an EXR, in the file's order; none where there are not several.
///
/// Fails as [`decode`](super::decode) does, and where all of them together are beyond the budget.
pub fn layers(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Vec<LightLayer>> {
    if !ExrFile::is_exr(bytes) {
        return Ok(Vec::new());
    }
    let exr = ExrFile::open(file, bytes, budget)?;
    // Cryptomatte stores object ids in color channels.
    let is_light =
        |pass: &&ExrPass| pass.letters("rgb").is_some() && !pass.key().starts_with("crypto");
    let passes: Vec<&ExrPass> = exr.passes().iter().filter(is_light).collect();
    if passes.len() < 2 {
        return Ok(Vec::new());
    }
    if passes.len() as u64 * exr.size().area() as u64 > budget.document_px
        || passes.len() > budget.layers
    {
        let reason = format!(
            "its {} layers hold more than {} pixels together",
            passes.len(),
            budget.document_px
        );
        return Err(Error::too_large(file, reason));
    }
    let whole = passes
        .iter()
        .enumerate()
        .filter(|(_, p)| rank(p) < WHOLE.len())
        .min_by_key(|(_, p)| rank(p));
    // The first of several parts, such as the views of two eyes, is shown.
    let whole = whole.map(|(i, _)| i).or((exr.parts() > 1).then_some(0));
    let mut used_bytes = 0;
    let one = |(i, pass): (usize, &&ExrPass)| {
        let left =
            Budget { memory_bytes: budget.memory_bytes.saturating_sub(used_bytes), ..*budget };
        let painted = of_light(file, &exr, pass, 0, 0, &left)?;
        used_bytes += painted.tiles.bytes() as u64;
        Ok(LightLayer { name: pass.name.clone(), painted, is_whole: whole == Some(i) })
    };
    passes.iter().enumerate().map(one).collect()
}
