//! Curvature at the ends of a surface: continued from nearby pixels that have all their neighbors.
//! Floor 2.

use crate::math::parallel;
use crate::raster::Plane;
use crate::surface::Surface;
use crate::surface::cache::HeapSize;
use crate::surface::contours::{BESIDE, PixelWindow, bits, mean_of};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// The pixels at which a neighbor is missing, and which pixels of the window around them their
/// curvature is continued from. Differences there are one-sided: noisy, and of a normal that is
/// seen edge-on.
pub struct CurvatureRims {
    pixels: Vec<RimPixel>,
}

impl HeapSize for CurvatureRims {
    fn heap_bytes(&self) -> u64 {
        size_of_val(&self.pixels[..]) as u64
    }
}

#[derive(Clone, Copy)]
struct RimPixel {
    x: i32,
    y: i32,
    members: u64,
}

impl Surface {
    /// Cached.
    pub(super) fn rims(&self) -> Arc<CurvatureRims> {
        self.derived.rims.get_or_compute((), 1, |_| CurvatureRims::of(self))
    }
}

impl CurvatureRims {
    fn of(surface: &Surface) -> Self {
        let rows: Vec<Vec<RimPixel>> = parallel::collect(surface.links_plane().height(), 1, |y| {
            let links = surface.links_plane().row(y);
            let ends = (0..links.len()).filter(|&x| links[x] != 15);
            ends.filter_map(|x| rim(surface, x as i32, y as i32)).collect()
        });
        Self { pixels: rows.concat() }
    }

    /// There is none.
    pub fn is_empty(&self) -> bool {
        self.pixels.is_empty()
    }

    /// Those of some rows.
    fn rows(&self, rows: Range<usize>) -> &[RimPixel] {
        let at = |y: usize| self.pixels.partition_point(|rim| (rim.y as usize) < y);
        &self.pixels[at(rows.start)..at(rows.end)]
    }

    /// Whether there are any in a rectangle.
    pub fn are_in(&self, columns: Range<usize>, rows: Range<usize>) -> bool {
        self.rows(rows).iter().any(|rim| columns.contains(&(rim.x as usize)))
    }

    /// The distance of each pixel of a rectangle (from column and row to column and row) to the
    /// nearest in it, in thirds of a pixel, steps counting 3 and diagonal ones 4.
    pub fn distances(&self, [x0, y0, x1, y1]: [usize; 4], distance: &mut Vec<u16>) {
        let (width, height) = (x1 - x0, y1 - y0);
        distance.clear();
        distance.resize(width * height, u16::MAX / 2);
        for rim in self.rows(y0..y1).iter().filter(|rim| (x0..x1).contains(&(rim.x as usize))) {
            distance[(rim.y as usize - y0) * width + rim.x as usize - x0] = 0;
        }
        for y in 0..height {
            let (above, row) = distance[..(y + 1) * width].split_at_mut(y * width);
            step_from_row(&above[y.saturating_sub(1) * width..], row);
            step_along(row.iter_mut());
        }
        for y in (0..height).rev() {
            let (row, below) = distance[y * width..].split_at_mut(width);
            step_from_row(&below[..width.min(below.len())], row);
            step_along(row.iter_mut().rev());
        }
    }

    /// Puts the means of their members into a map.
    pub fn continue_in(&self, plane: &mut Plane<f32>) {
        let mean = |rim: &RimPixel| mean_of(rim.members, (rim.x, rim.y), |x, y| plane.at(x, y));
        // Members are no rims themselves, so the order does not matter.
        let means: Vec<f32> = self.pixels.par_iter().with_min_len(1024).map(mean).collect();
        // Where a piece is too thin to have members, such as a wire, its own differences stay.
        for (rim, mean) in self.pixels.iter().zip(means).filter(|(rim, _)| rim.members != 0) {
            plane.set(rim.x as usize, rim.y as usize, mean);
        }
    }
}

/// Steps of 3 along a row.
fn step_along<'d>(row: impl Iterator<Item = &'d mut u16>) {
    row.fold(u16::MAX / 2, |before, distance| {
        *distance = (*distance).min(before + 3);
        *distance
    });
}

crate::widest! {
    /// Steps from the row above or below, straight ones of 3 and diagonal ones of 4; no row is
    /// empty.
    fn step_from_row(beside: &[u16], row: &mut [u16]) {
        if beside.is_empty() {
            return;
        }
        let n = row.len();
        let beside = &beside[..n];
        for i in 0..n {
            row[i] = row[i].min(beside[i] + 3);
        }
        for i in 1..n {
            row[i] = row[i].min(beside[i - 1] + 4);
        }
        for i in 0..n - 1 {
            row[i] = row[i].min(beside[i + 1] + 4);
        }
    }
}

/// A covered pixel that lacks a neighbor on the canvas.
fn rim(surface: &Surface, x: i32, y: i32) -> Option<RimPixel> {
    members(surface, x, y).map(|members| RimPixel { x, y, members })
}

/// The pixels around a rim's that belong to its piece and have all their neighbors; `None` for a
/// pixel that is no rim.
pub(super) fn members(surface: &Surface, x: i32, y: i32) -> Option<u64> {
    let whole = |x: i32, y: i32| {
        let links = surface.links_plane().at(x as usize, y as usize);
        let on_canvas = |dx: i32, dy: i32| surface.size().rect().contains(x + dx, y + dy);
        BESIDE
            .iter()
            .all(|beside| links & beside.link != 0 || !on_canvas(beside.step.0, beside.step.1))
    };
    if surface.coverage(x as usize, y as usize) == 0 || whole(x, y) {
        return None;
    }
    surface.with_contour_maps(None, |maps| {
        let window = PixelWindow::around(maps, x, y);
        let piece = window.piece_of_center();
        let wholes = bits(piece).filter(|&i| {
            let (x, y) = window.pixel(i);
            whole(x as i32, y as i32)
        });
        Some(wholes.fold(0, |set, i| set | 1 << i))
    })
}
