//! The maps that contours are found in.
//! Floor 2.

use crate::math::Size;
use crate::raster::Plane;

/// The maps that contours are found in.
pub struct ContourMaps<'m> {
    pub size: Size,
    /// n̄_x, n̄_y.
    pub nbar: [&'m Plane<f32>; 2],
    pub depth: &'m Plane<f32>,
    pub coverage: &'m Plane<u8>,
    /// Those across creases left out.
    pub links: &'m Plane<u8>,
    /// Those across creases, too.
    pub all_links: &'m Plane<u8>,
    /// Where the maps held values, if it is known: elsewhere the nearest values were repeated.
    pub valid: Option<&'m Plane<bool>>,
}
