//! Reads a detail normal map in tangent space. Floor 5. The surface that it will lie on is unknown,
//! so its convention is detected from its own numbers alone.

use super::encoding;
use super::findings::Findings;
use super::layers::MapRole;
use super::normals::order_of;
use super::orientation::{self, FixedAxes};
use super::stored;
use crate::Budget;
use crate::document::source::{NormalConvention, NormalSpace};
use crate::math::Vec3;
use crate::raster::Plane;
use crate::{Error, Result};
use std::path::Path;

/// Reads a file as tangent-space normals: x right, y up, z out of the map. What the convention
/// leaves open is detected from the numbers.
pub fn read(
    file: &Path,
    bytes: &[u8],
    overrides: &NormalConvention,
    budget: &Budget,
) -> Result<Plane<Vec3>> {
    if overrides.space == Some(NormalSpace::World) {
        return Err(Error::unsupported_file(
            file,
            "a detail map is in the space of the surface, not of the world",
        ));
    }
    let stored = stored::load(file, bytes, None, MapRole::Normals, budget)?;
    let area = stored.size.area();
    // A regular sample is enough to detect the encoding of a large map.
    let samples: Vec<usize> = (0..area).step_by((area / 50_000).max(1)).collect();
    let reading = encoding::choose(&stored, &samples, overrides, &mut Findings::default())?;
    let width = stored.size.width as usize;
    let vectors = Plane::from_fn(stored.size, |x, y| {
        let n = reading.vector(stored.texel(y * width + x));
        if n.is_finite() { n.normalize_or(Vec3::Z) } else { Vec3::Z }
    });
    let order = overrides.channels.map_or([0, 1, 2], |c| order_of(c, reading.encoding));
    // Only the green axis is in doubt: the better fit to a relief decides.
    let flip =
        [overrides.flip_x.or(Some(false)), overrides.flip_y, overrides.flip_z.or(Some(false))];
    let fixed = FixedAxes { order: Some(order), flip, ..FixedAxes::default() };
    let everywhere = Plane::full(stored.size, true);
    let axes = orientation::find(&vectors, &everywhere, None, &fixed).axes;
    Ok(vectors.map(|n| axes.apply(n)))
}
