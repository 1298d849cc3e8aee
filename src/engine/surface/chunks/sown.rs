//! Seeds of small chunks: those of a tile are sown at once, and the nearest are found for some pixels
//! of a row at a time. Floor 2. The reference is `SeedGrid::nearest`, in the module above.

use super::{ChunkMaps, LANES, SeedGrid};
use crate::math::{Rect, Vec2};

/// The cells of a level in a tile, for every part that it shows.
pub(super) struct SownParts<'m, 's> {
    pub maps: &'m ChunkMaps<'s>,
    level: (u32, f32),
    tile: Rect,
    cells: Vec<(u32, SownCells)>,
}

impl<'m, 's> SownParts<'m, 's> {
    pub fn of(maps: &'m ChunkMaps<'s>, level: (u32, f32), tile: Rect) -> Self {
        Self { maps, level, tile, cells: Vec::new() }
    }

    pub fn cells_of(&mut self, part: u32) -> &SownCells {
        let known = self.cells.iter().position(|(of, _)| *of == part);
        let known = known.unwrap_or_else(|| {
            let grid = self.maps.grid(self.level, part);
            self.cells.push((part, SownCells::of(grid, self.tile)));
            self.cells.len() - 1
        });
        &self.cells[known].1
    }
}

/// Where the seeds of all cells of a tile, and of those beside it, lie.
pub(super) struct SownCells {
    pub grid: SeedGrid,
    /// The first cell.
    first: (i32, i32),
    columns: usize,
    seeds: Vec<Vec2>,
}

impl SownCells {
    fn of(grid: SeedGrid, tile: Rect) -> Self {
        let cell = |v: i32| grid.cell(v as usize);
        let [x0, y0] = [tile.x0, tile.y0].map(|v| cell(v) - 1);
        // Lanes may reach beyond the tile.
        let (x1, y1) = (cell(tile.x1 + LANES as i32) + 1, cell(tile.y1 - 1) + 1);
        let cells = (y0..=y1).flat_map(|j| (x0..=x1).map(move |i| (i, j)));
        let seeds = cells.map(|cell| grid.seed_of(cell)).collect();
        Self { grid, first: (x0, y0), columns: (x1 - x0 + 1) as usize, seeds }
    }

    /// The cells whose seeds are the nearest to pixels of a row, of the nine around each.
    pub fn find_nearest(&self, (x, y): (usize, usize)) -> [u32; LANES] {
        let mut lanes = NearestLanes::new();
        for lane in 0..LANES {
            lanes.x[lane] = (x + lane) as f32 + 0.5;
            lanes.column[lane] = self.grid.cell(x + lane) - self.first.0;
        }
        let row = self.grid.cell(y) - self.first.1;
        let (from, to) = (lanes.column[0] - 1, lanes.column[LANES - 1] + 1);
        for row in (row - 1..=row + 1).map(|row| row as usize * self.columns) {
            let seeds = row + from as usize..row + to as usize + 1;
            find_nearest(
                &self.seeds[seeds.clone()],
                (seeds.start, from),
                y as f32 + 0.5,
                &mut lanes,
            );
        }
        lanes.best
    }

    pub fn cell(&self, i: u32) -> (i32, i32) {
        let (row, column) = (i as usize / self.columns, i as usize % self.columns);
        (self.first.0 + column as i32, self.first.1 + row as i32)
    }
}

/// The seeds that are nearest to pixels of a row.
struct NearestLanes {
    /// Their middles, px.
    x: [f32; LANES],
    /// Their cells.
    column: [i32; LANES],
    least: [f32; LANES],
    best: [u32; LANES],
}

impl NearestLanes {
    fn new() -> Self {
        Self { x: [0.0; LANES], column: [0; LANES], least: [f32::MAX; LANES], best: [0; LANES] }
    }
}

crate::widest! {
    /// Looks for the nearest among a row of seeds, each for the pixels in its cell and beside it.
    ///
    /// * `first`: the number of the first seed, and its column.
    fn find_nearest(seeds: &[Vec2], first: (usize, i32), y: f32, lanes: &mut NearestLanes) {
        let NearestLanes { x, column, least, best } = lanes;
        for (k, seed) in seeds.iter().enumerate() {
            let (own, number) = (first.1 + k as i32, (first.0 + k) as u32);
            let dy = seed.y - y;
            for lane in 0..LANES {
                let dx = seed.x - x[lane];
                let away = dx * dx + dy * dy;
                let is_beside = (column[lane] - own + 1) as u32 <= 2;
                let is_less = (away < least[lane]) & is_beside;
                least[lane] = if is_less { away } else { least[lane] };
                best[lane] = if is_less { number } else { best[lane] };
            }
        }
    }
}
