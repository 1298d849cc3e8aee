//! The words of the document for what is chosen from a few.
//! Floor 5. One table each, for reading and writing. Blend modes keep theirs in `raster::blend`.

use crate::document::LayerLock;
use crate::paint::ImageFilter;
use crate::raster::Outside;

pub const LOCKS: [(LayerLock, &str); 3] =
    [(LayerLock::None, "none"), (LayerLock::Alpha, "alpha"), (LayerLock::All, "all")];

pub const OUTSIDES: [(Outside, &str); 4] =
    [(Outside::None, "none"), (Outside::Clamp, "clamp"), (Outside::Repeat, "repeat"), (Outside::Mirror, "mirror")];

pub const FILTERS: [(ImageFilter, &str); 2] =
    [(ImageFilter::Antialias, "antialias"), (ImageFilter::Bilinear, "bilinear")];

/// Whether a layer blends linear light.
pub const BLEND_SPACES: [(bool, &str); 2] = [(false, "srgb"), (true, "linear")];

/// The word for a value; every value of a table's type stands in it.
pub fn name_of<T: PartialEq>(table: &[(T, &'static str)], value: T) -> &'static str {
    table.iter().find(|(v, _)| *v == value).map_or("", |(_, name)| name)
}
