//! The names of choices in documents. Floor 5. There is one table each, for reading and writing. The names of blend
//! modes are in `raster::blend`.

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
