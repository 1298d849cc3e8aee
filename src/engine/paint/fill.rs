//! The fill: the pixels joined to one by colors like its own, with small gaps in their border
//! closed and its edge smoothed. Floor 3. `flood` finds the joined pixels; `raster::gaps`
//! excludes those that are only reached through a gap. Here: the settings and the edge. Not here: the picture that
//! is read, and what is done with the pixels (`tools::fill`).

mod flood;

#[cfg(test)]
mod tests;

use crate::math::{Rect, Size, Vec2};
use crate::raster::coverage::{CoverageGrid, edges};
pub use crate::raster::gaps::WIDEST_GAP_PX;
use crate::raster::gaps::{self, PixelSet};
use crate::raster::{Plane, TILE, Tile, TileAt};
use crate::surface::objects::{CanvasPart, PaintLimit};
use std::sync::Arc;

/// The settings of a fill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fill {
    /// The largest difference to the first pixel's color, of any channel of the premultiplied
    /// encoded color, `[0, 1]`.
    pub tolerance: f32,
    /// Gaps up to this wide are closed, px, `[0, 64]`; 0 closes none.
    pub gap_px: f32,
    /// How far the edge moves outward, px, `[-32, 32]`: under the softened edge of a line, so that
    /// no pale seam is left.
    pub grow_px: f32,
    /// Whether pixels at the edge are partly covered.
    pub antialias: bool,
    /// Compare colors of the layer only, not of the picture.
    pub layer_alone: bool,
    /// How far it may go.
    pub bounded: PaintLimit,
}

impl Default for Fill {
    fn default() -> Self {
        let bounded = PaintLimit::Free;
        Self {
            tolerance: 0.1,
            gap_px: 0.0,
            grow_px: 1.0,
            antialias: true,
            layer_alone: false,
            bounded,
        }
    }
}

/// The farthest that an edge can move, px.
pub const FARTHEST_GROWTH_PX: f32 = 32.0;

/// What a fill covers.
pub struct FilledArea {
    /// The canvas pixels that `coverage` holds, column 0 and row 0 at its corner.
    pub rect: Rect,
    /// 255 wholly covered.
    coverage: Plane<u8>,
}

impl FilledArea {
    /// The share of a canvas pixel that is covered, `[0, 1]`.
    pub fn coverage(&self, x: i32, y: i32) -> f32 {
        let at = |v: i32, from: i32| v.saturating_sub(from);
        f32::from(self.coverage.get(at(x, self.rect.x0), at(y, self.rect.y0)).unwrap_or(0)) / 255.0
    }
}

impl Fill {
    /// Fills from a canvas point. `None` if it is off the canvas or outside `part`.
    ///
    /// * `part`: the part of the canvas that may be touched (`PaintLimit::from`); its border bounds
    ///   the fill.
    /// * `tile`: gives a tile of the picture that is read, premultiplied; called once for each tile
    ///   that the fill reaches.
    pub fn from(
        &self,
        start: Vec2,
        canvas: Size,
        part: &CanvasPart,
        tile: impl Fn(TileAt) -> Option<Arc<Tile>> + Sync,
    ) -> Option<FilledArea> {
        let (x, y) = (start.x.floor() as i32, start.y.floor() as i32);
        if !start.is_finite() || !canvas.rect().contains(x, y) {
            return None;
        }
        // Comparisons that turn NaN into the minimum.
        let tolerance = (self.tolerance.max(0.0).min(1.0) * 255.0).round() as u8;
        let flooded = flood::connected_area((x, y), canvas, part, tolerance, tile)?;
        let gap_px = self.gap_px.max(0.0).min(WIDEST_GAP_PX);
        let inside = flood::pixels(&flooded);
        let inside =
            if gap_px > 0.0 { gaps::close_gaps(inside, (x, y), canvas, gap_px) } else { inside };
        Some(self.cover_edges(inside, canvas, part))
    }

    /// The same area as coverage on the canvas; `everywhere`: all pixels of a color like the first
    /// one's, joined or not, so that gaps do not matter.
    ///
    /// `None` as for [`Fill::from`], which has the same arguments.
    pub fn find_coverage(
        &self,
        start: Vec2,
        canvas: Size,
        part: &CanvasPart,
        everywhere: bool,
        tile: impl Fn(TileAt) -> Option<Arc<Tile>> + Sync,
    ) -> Option<CoverageGrid> {
        let (x, y) = (start.x.floor() as i32, start.y.floor() as i32);
        if !start.is_finite() || !canvas.rect().contains(x, y) {
            return None;
        }
        let tolerance = (self.tolerance.max(0.0).min(1.0) * 255.0).round() as u8;
        let moves = self.grow_px.max(-FARTHEST_GROWTH_PX).min(FARTHEST_GROWTH_PX);
        if !everywhere && self.gap_px > 0.0 {
            let area = self.from(start, canvas, part, tile)?;
            return Some(CoverageGrid::from_plane(&area.coverage, area.rect.x0, area.rect.y0));
        }
        let found = match everywhere {
            true => flood::alike((x, y), canvas, part, tolerance, tile)?,
            false => flood::connected_area((x, y), canvas, part, tolerance, tile)?.coverage(),
        };
        let found = if moves == 0.0 { found } else { edges::grown(&found, moves, canvas.rect()) };
        Some(if part.is_whole() { found } else { limited(&found, part) })
    }

    /// The pixels found as coverage, the edge moved and smoothed.
    fn cover_edges(&self, inside: PixelSet, canvas: Size, part: &CanvasPart) -> FilledArea {
        let grow_px = self.grow_px.max(-FARTHEST_GROWTH_PX).min(FARTHEST_GROWTH_PX);
        let limit = grow_px.abs().ceil() as i32 + 1;
        let rect = inside.rect.grown(limit).intersect(canvas.rect());
        let PixelSet { rect, pixels } = inside.within(rect);
        let coverage = edges::moved(&pixels, grow_px, self.antialias);
        if part.is_whole() {
            return FilledArea { rect, coverage };
        }
        let allowed = |x: usize, y: usize, share: u8| match share {
            0 => 0,
            _ => (f32::from(share) * part.coverage(x as i32 + rect.x0, y as i32 + rect.y0)).round()
                as u8,
        };
        FilledArea { rect, coverage: coverage.updated(allowed) }
    }
}

/// Coverage within a part of the canvas.
fn limited(found: &CoverageGrid, part: &CanvasPart) -> CoverageGrid {
    CoverageGrid::from_tiles(found.bounds(), |at, bytes| {
        let Some(tile) = found.tile(at) else { return };
        let corner = at.rect();
        for (i, (to, share)) in
            bytes.iter_mut().zip(tile.bytes()).enumerate().filter(|(_, (_, share))| **share > 0)
        {
            let (x, y) = ((i % TILE) as i32, (i / TILE) as i32);
            *to = (f32::from(*share) * part.coverage(corner.x0 + x, corner.y0 + y)).round() as u8;
        }
    })
}
