//! A detail normal map from whatever a file stores: tangent space, as it lies in the picture.
//! Floor 5. Nothing else is known of the surface it will lie on, so that only its own numbers tell how to read it.

use super::encoding;
use super::findings::Findings;
use super::normals::order_of;
use super::orientation::{self, Fixed};
use super::stored::{self, Role};
use crate::Budget;
use crate::document::source::{NormalConvention, NormalSpace};
use crate::math::Vec3;
use crate::raster::Plane;
use crate::{Error, Result};
use std::path::Path;

/// Reads a file as tangent-space normals: x right, y up, z out of the map. What the convention leaves open is found from
/// the numbers themselves.
pub fn read(file: &Path, bytes: &[u8], told: &NormalConvention, budget: &Budget) -> Result<Plane<Vec3>> {
    if told.space == Some(NormalSpace::World) {
        return Err(Error::unsupported(
            file,
            "a detail map lies on the surface, not in the world: its space is its own",
        ));
    }
    let stored = stored::load(file, bytes, None, Role::Normals, budget)?;
    let area = stored.size.area();
    // A spread sample tells the encoding of a large map.
    let samples: Vec<usize> = (0..area).step_by((area / 50_000).max(1)).collect();
    let reading = encoding::choose(&stored, &samples, told, &mut Findings::default())?;
    let width = stored.size.width as usize;
    let vectors = Plane::from_fn(stored.size, |x, y| {
        let n = reading.vector(stored.texel(y * width + x));
        if n.is_finite() { n.normalize_or(Vec3::Z) } else { Vec3::Z }
    });
    let order = told.channels.map_or([0, 1, 2], |c| order_of(c, reading.encoding));
    // Of the axes only green's is in doubt: whether the map belongs to a relief tells it.
    let flip = [told.flip_x.or(Some(false)), told.flip_y, told.flip_z.or(Some(false))];
    let fixed = Fixed { order: Some(order), flip, ..Fixed::default() };
    let everywhere = Plane::filled(stored.size, true);
    let axes = orientation::find(&vectors, &everywhere, None, &fixed).axes;
    Ok(vectors.map(|n| axes.apply(n)))
}
