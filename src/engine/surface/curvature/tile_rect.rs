//! The tiles in which curvature is computed: wide and flat, so that their rows stay in the cache.
//! Floor 2.

use crate::math::Size;
use crate::surface::Surface;

/// Columns of a tile's scratch: the tile and one pixel around it for the differences.
pub(super) const STRIDE: usize = 256;
const TILE_COLS: usize = STRIDE - 2;
/// Rows of a band: enough that few rows are blurred twice, once for each of two bands.
pub(super) const BAND_ROWS: usize = 64;
/// Pixels summed side by side in registers.
pub(super) const LANES: usize = 32;

/// The pixels of one tile.
#[derive(Clone, Copy)]
pub(super) struct TileRect {
    pub x0: usize,
    pub y0: usize,
    pub cols: usize,
    pub rows: usize,
}

impl TileRect {
    /// The tiles of the band of rows that starts at `y0`.
    pub fn of_band(size: Size, y0: usize) -> impl Iterator<Item = TileRect> {
        let (width, rows) = (size.width as usize, BAND_ROWS.min(size.height as usize - y0));
        (0..width).step_by(TILE_COLS).map(move |x0| TileRect {
            x0,
            y0,
            cols: TILE_COLS.min(width - x0),
            rows,
        })
    }

    /// No pixel of the tile is linked to another: there is nothing to difference.
    pub fn is_empty(&self, surface: &Surface) -> bool {
        (0..self.rows)
            .all(|y| surface.links_plane().row(self.y0 + y)[self.columns()].iter().all(|&l| l == 0))
    }

    pub fn clear<T: Copy>(&self, band: &mut [T], size: Size, nothing: T) {
        (0..self.rows).for_each(|y| band[y * size.width as usize..][self.columns()].fill(nothing));
    }

    /// How many chunks hold the tile and a pixel at both sides.
    pub fn chunks(&self) -> usize {
        (self.cols + 2).div_ceil(LANES)
    }

    pub fn columns(&self) -> std::ops::Range<usize> {
        self.x0..self.x0 + self.cols
    }
}
