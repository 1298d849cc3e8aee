//! The memory that a surface uses: its maps, and what was computed from them and is kept for speed. Floor 2.

use super::Surface;
use super::cache::RecentCache;
use super::pyramid::MapPyramids;
use crate::raster::coverage::CoverageTile;
use crate::raster::{CoverageGrid, Plane};

/// Bytes that a value holds.
pub(super) trait KeptBytes {
    fn kept_bytes(&self) -> u64;
}

impl<T: Copy> KeptBytes for Plane<T> {
    fn kept_bytes(&self) -> u64 {
        (self.size().area() * size_of::<T>()) as u64
    }
}

impl KeptBytes for CoverageGrid {
    fn kept_bytes(&self) -> u64 {
        self.iter().map(|(_, tile)| CoverageTile::held_bytes(tile)).sum()
    }
}

impl KeptBytes for Surface {
    fn kept_bytes(&self) -> u64 {
        self.map_bytes() + self.computed_bytes()
    }
}

impl<K: PartialEq, V: KeptBytes> KeptBytes for RecentCache<K, V> {
    fn kept_bytes(&self) -> u64 {
        self.sum(V::kept_bytes)
    }
}

impl Surface {
    /// Bytes of the maps alone and of the links between their pixels.
    pub const BYTES_PER_PX: usize = 4 * size_of::<f32>() + 2 * size_of::<u8>();

    /// Bytes of the maps and of what is computed when a surface is made.
    pub fn map_bytes(&self) -> u64 {
        let smooth_links = self.smooth_links.as_ref().map_or(0, |plane| plane.kept_bytes());
        let parts = self.parts.as_ref().map_or(0, |plane| plane.kept_bytes());
        (self.size().area() * Self::BYTES_PER_PX) as u64 + smooth_links + parts + self.contours().bytes()
    }
    /// Bytes of what was computed from the maps and can be computed again.
    pub fn computed_bytes(&self) -> u64 {
        let maps = self.curvatures().kept_bytes() + self.kappas().kept_bytes() + self.occlusions().kept_bytes();
        let found = self.regions().kept_bytes() + self.rims_cell().kept_bytes() + self.bounds().kept_bytes();
        let planes = self.unwrappings().kept_bytes() + self.plane_yields.kept_bytes() + self.plane_springs.kept_bytes();
        maps + found + planes + self.sheets().kept_bytes() + self.ray_maps().kept_bytes()
    }
    /// Drops what can be computed again. What others hold stays in memory until they drop it, too.
    pub fn let_go(&self) {
        self.curvatures().clear();
        self.rims_cell().clear();
        self.kappas().clear();
        self.occlusions().clear();
        self.ray_maps().clear();
        self.regions().clear();
        self.plane_layouts().clear();
        self.unwrappings().clear();
        self.plane_yields.clear();
        self.plane_springs.clear();
        self.sheets().clear();
    }
}

impl KeptBytes for MapPyramids {
    fn kept_bytes(&self) -> u64 {
        self.bytes()
    }
}
