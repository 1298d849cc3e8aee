//! Where a surface shows some of a painted ball, so that a dab on the ball costs what it changes.
//! Floor 2. Not here: what of the ball changed (`shading::ball_strokes`).

use super::{BallPlaces, ChunkSettings};
use crate::raster::{Plane, TileAt};
use crate::surface::Surface;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Cells of a ball's square, some of them marked.
#[derive(Clone, Debug)]
pub struct BallCells {
    /// Row by row.
    marked: Vec<bool>,
}

impl BallCells {
    /// Cells along a side.
    pub const SIDE: usize = 64;
    /// No cell.
    pub fn none() -> Self {
        Self { marked: vec![false; Self::SIDE * Self::SIDE] }
    }

    /// Marks the cell of a place, from 0 to 1 along each side of the square.
    pub fn mark(&mut self, place: [f32; 2]) {
        let cell = Self::cell(place.map(|v| v * Self::SIDE as f32));
        self.marked[cell] = true;
    }

    /// With the cells beside those that are marked, so many each way.
    pub fn grown(&self, by: usize) -> Self {
        let mut next = Self::none();
        let marked = (0..self.marked.len()).filter(|i| self.marked[*i]);
        for (x, y) in marked.map(|i| (i % Self::SIDE, i / Self::SIDE)) {
            for y in y.saturating_sub(by)..(y + by + 1).min(Self::SIDE) {
                let row = y * Self::SIDE;
                let columns = x.saturating_sub(by)..(x + by + 1).min(Self::SIDE);
                next.marked[row + columns.start..row + columns.end].fill(true);
            }
        }
        next
    }

    /// Marks what others mark, too.
    pub fn add(&mut self, others: &Self) {
        self.marked.iter_mut().zip(&others.marked).for_each(|(own, other)| *own |= other);
    }

    /// The number of the cell of a place, in cells.
    #[inline(always)]
    fn cell(place: [f32; 2]) -> usize {
        let [x, y] = [place[0] as usize, place[1] as usize].map(|v| v.min(Self::SIDE - 1));
        y * Self::SIDE + x
    }
}

impl BallPlaces {
    /// Whether a pixel shows a marked cell, also as what it is averaged with.
    fn has_shown(&self, cells: &BallCells, (x, y): (usize, usize)) -> bool {
        let per_step = BallCells::SIDE as f32 / (self.steps * self.ball_px);
        let is_marked =
            |[x, y]: [f32; 2]| cells.marked[BallCells::cell([x * per_step, y * per_step])];
        let mut bits = self.seams.as_ref().map_or(0, |seams| seams.at(x, y));
        let mut is_shown = is_marked(self.places.at(x, y).map(f32::from));
        while !is_shown && bits != 0 {
            is_shown = is_marked(self.place_beside(x, y, bits.trailing_zeros() as usize));
            bits &= bits - 1;
        }
        is_shown
    }
}

impl Surface {
    /// The tiles with a pixel that shows a marked cell of a ball, on either side of a contour.
    pub fn tiles_showing_ball(
        self: &Arc<Self>,
        settings: &ChunkSettings,
        cells: &BallCells,
    ) -> Vec<TileAt> {
        let (places, size) = (self.ball_places(settings), self.size());
        let shows = |at: &TileAt| {
            let tile = at.rect().intersect(size.rect());
            let mut pixels =
                (tile.y0..tile.y1).flat_map(|y| (tile.x0..tile.x1).map(move |x| (x, y)));
            pixels.any(|(x, y)| {
                let pixel = (x as usize, y as usize);
                self.coverage(pixel.0, pixel.1) > 0 && places.has_shown(cells, pixel)
            })
        };
        let all: Vec<TileAt> = TileAt::covering(size.rect()).collect();
        let mut tiles: BTreeSet<TileAt> = all.into_par_iter().filter(shows).collect();
        if let Some(far) = self.far_side()
            && let Some(members) = far.as_far_side()
        {
            let places = far.ball_places(settings);
            let pixels: Plane<Option<[i32; 2]>> =
                members.map(far.size(), |pixel| Some([pixel.x, pixel.y]));
            for y in 0..pixels.height() {
                let shown = pixels.row(y).iter().enumerate();
                let shown =
                    shown.filter(|(x, at)| at.is_some() && places.has_shown(cells, (*x, y)));
                tiles.extend(shown.filter_map(|(_, at)| at.map(|[x, y]| TileAt::of_pixel(x, y))));
            }
        }
        tiles.into_iter().collect()
    }
}
