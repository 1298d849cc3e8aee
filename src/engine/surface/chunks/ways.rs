//! Ways from pixel to pixel within a surface. Floor 2.

use crate::math::{Rect, Size, parallel};
use crate::raster::Plane;
use crate::surface::{Surface, links};
use std::ops::Range;

/// For every pixel how many links are missing before it, in its row and in its column: two pixels
/// of a row with the same number are joined. Counts wrap; no row is long enough for that to tell.
pub(super) struct WayCounts {
    across: Plane<u16>,
    down: Plane<u16>,
}

impl WayCounts {
    pub fn of(surface: &Surface) -> Self {
        let linked = surface.links_plane();
        let size = surface.size();
        let width = linked.width().max(1);
        let (mut across, mut down) = (Plane::full(size, 0u16), Plane::full(size, 0u16));
        let missing = |bits: u8, link: u8| u16::from(bits & link == 0);
        parallel::for_each_row(across.values_mut(), width, 1, |y, row| {
            let mut count = 0u16;
            for (out, &bits) in row.iter_mut().zip(linked.row(y)) {
                count = count.wrapping_add(missing(bits, links::LEFT));
                *out = count;
            }
        });
        for y in 1..linked.height() {
            let (above, below) = down.values_mut().split_at_mut(y * width);
            let above = &above[(y - 1) * width..];
            for ((out, before), &bits) in below.iter_mut().zip(above).zip(linked.row(y)) {
                *out = before.wrapping_add(missing(bits, links::UP));
            }
        }
        Self { across, down }
    }

    /// Whether one of the two ways with one corner joins two pixels.
    #[inline(always)]
    pub fn is_reached(&self, from: (usize, usize), to: (usize, usize)) -> bool {
        let ((x0, y0), (x1, y1)) = (from, to);
        let along = |y: usize| self.across.at(x0, y) == self.across.at(x1, y);
        let upright = |x: usize| self.down.at(x, y0) == self.down.at(x, y1);
        along(y0) && upright(x1) || upright(x0) && along(y1)
    }

    /// The counts of pixels and of those that they are paired with.
    ///
    /// * `rows`, `columns`: of the one and of the other.
    pub fn pairs(&self, rows: [usize; 2], columns: [Range<usize>; 2]) -> WayPairs<'_> {
        let corner = |row: usize, column: usize| {
            let (row, columns) = (rows[row], columns[column].clone());
            (&self.across.row(row)[columns.clone()], &self.down.row(row)[columns])
        };
        WayPairs {
            here: corner(0, 0),
            beside: corner(0, 1),
            below: corner(1, 0),
            there: corner(1, 1),
        }
    }

    /// Whether every pixel of a rectangle, as far as it lies on the canvas, is joined to its
    /// neighbors in it.
    pub fn is_whole(&self, rect: Rect) -> bool {
        let Size { width, height } = self.across.size();
        let rect = rect.intersect(Rect::new(0, 0, width as i32, height as i32));
        if rect.is_empty() {
            return true;
        }
        let [x0, x1] = [rect.x0, rect.x1 - 1].map(|x| x as usize);
        let [y0, y1] = [rect.y0, rect.y1 - 1].map(|y| y as usize);
        (y0..=y1).all(|y| self.across.at(x0, y) == self.across.at(x1, y))
            && self.down.row(y0)[x0..=x1] == self.down.row(y1)[x0..=x1]
    }
}

/// The counts across and down at the corners of the ways between pairs of pixels.
pub(super) struct WayPairs<'w> {
    here: (&'w [u16], &'w [u16]),
    beside: (&'w [u16], &'w [u16]),
    below: (&'w [u16], &'w [u16]),
    there: (&'w [u16], &'w [u16]),
}

impl<'w> WayPairs<'w> {
    /// Those of `N` pairs from one on, if there are so many.
    #[inline(always)]
    pub fn lanes<const N: usize>(&self, first: usize) -> Option<WayLanes<'w, N>> {
        let Self { here, beside, below, there } = self;
        Some(WayLanes {
            here: (here.0[first..].first_chunk()?, here.1[first..].first_chunk()?),
            beside: (beside.0[first..].first_chunk()?, beside.1[first..].first_chunk()?),
            below: (below.0[first..].first_chunk()?, below.1[first..].first_chunk()?),
            there: (there.0[first..].first_chunk()?, there.1[first..].first_chunk()?),
        })
    }
}

/// Some of them.
pub(super) struct WayLanes<'w, const N: usize> {
    here: (&'w [u16; N], &'w [u16; N]),
    beside: (&'w [u16; N], &'w [u16; N]),
    below: (&'w [u16; N], &'w [u16; N]),
    there: (&'w [u16; N], &'w [u16; N]),
}

impl<const N: usize> WayLanes<'_, N> {
    /// As [`WayCounts::is_reached`], of one pair.
    #[inline(always)]
    pub fn are_joined(&self, i: usize) -> bool {
        let Self { here, beside, below, there } = self;
        let along_first = (here.0[i] == beside.0[i]) & (beside.1[i] == there.1[i]);
        let down_first = (here.1[i] == below.1[i]) & (below.0[i] == there.0[i]);
        along_first | down_first
    }
}
