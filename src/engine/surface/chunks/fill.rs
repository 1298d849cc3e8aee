//! Places over a whole map: tile by tile, the large chunks in lanes. Floor 2. The reference is
//! `ChunkMaps::place_at`, in the module above.

use super::{
    BallPlace, BallPlaces, ChunkMaps, ChunkSettings, LOOKED_UP, Seed, SeedGrid, neighboring_cells,
    seams,
};
use crate::math::{Mat2, Rect, Vec2, fast, vec2};
use crate::raster::{Plane, TILE};
use rayon::prelude::*;

/// Pixels that are worked on at once.
const LANES: usize = 8;
/// Cells from this side on are worked on in lanes; in smaller ones few pixels are left.
const IN_LANES_PX: f32 = 8.0;

/// Of every pixel of a surface.
pub(super) fn places(maps: &ChunkMaps) -> BallPlaces {
    let size = maps.surface.size();
    let mut places = Plane::full(size, BallPlace::default());
    let width = places.width().max(1);
    places.values_mut().par_chunks_mut(width * TILE).enumerate().for_each(|(band, rows)| {
        let mut tile = PlaceTile::default();
        for x0 in (0..width).step_by(TILE) {
            tile.fill(maps, (x0, band * TILE));
            let end = (x0 + TILE).min(width);
            for (y, out) in rows.chunks_mut(width).enumerate() {
                tile.write(&maps.settings, y, &mut out[x0..end]);
            }
        }
    });
    seams::find_seams(maps, places)
}

/// A tile's row with room for the last lanes.
const ROW: usize = TILE + LANES;

/// The places of a tile while they are found.
struct PlaceTile {
    /// Its pixels on the canvas.
    rect: Rect,
    /// On the ball's square, px.
    at: [Vec<f32>; 2],
    chunk: Vec<u8>,
    /// 1 for pixels that have none yet.
    open: Vec<u8>,
    normal: [Vec<f32>; 3],
}

impl Default for PlaceTile {
    fn default() -> Self {
        let values = || vec![0.0; ROW * TILE];
        Self {
            rect: Rect::EMPTY,
            at: [values(), values()],
            chunk: vec![0; ROW * TILE],
            open: vec![0; ROW * TILE],
            normal: [values(), values(), values()],
        }
    }
}

impl PlaceTile {
    fn fill(&mut self, maps: &ChunkMaps, (x0, y0): (usize, usize)) {
        let size = maps.surface.size();
        let (width, height) =
            ((size.width as usize - x0).min(TILE), (size.height as usize - y0).min(TILE));
        self.rect = Rect::new(x0 as i32, y0 as i32, (x0 + width) as i32, (y0 + height) as i32);
        self.chunk.fill(0);
        self.open.fill(0);
        for y in 0..height {
            for (normal, plane) in self.normal.iter_mut().zip(&maps.seen) {
                normal[y * ROW..][..width].copy_from_slice(&plane.row(y0 + y)[x0..x0 + width]);
            }
            let covered = &maps.surface.coverage_plane().row(y0 + y)[x0..x0 + width];
            let open = self.open[y * ROW..].iter_mut();
            open.zip(covered).for_each(|(open, covered)| *open = u8::from(*covered > 0));
        }
        for level in maps.settings.sides() {
            if !self.open.contains(&1) {
                return;
            }
            if level.1 >= IN_LANES_PX {
                self.large_chunks(maps, level);
            } else {
                self.each_open(|x, y| maps.chunk_place(level, x, y));
            }
        }
        self.each_open(|x, y| Some((maps.look_up(x, y), LOOKED_UP)));
    }

    /// The places of a row, as they are stored.
    fn write(&self, settings: &ChunkSettings, y: usize, out: &mut [BallPlace]) {
        let first = y * ROW;
        for (x, out) in out.iter_mut().enumerate() {
            let i = first + x;
            *out = match self.chunk[i] {
                0 => BallPlace::default(),
                chunk => settings.store_place(vec2(self.at[0][i], self.at[1][i]), chunk),
            };
        }
    }

    /// Asks for the place of each pixel that has none yet.
    fn each_open(&mut self, place: impl Fn(usize, usize) -> Option<(Vec2, u8)>) {
        for y in 0..self.rect.height() {
            for x in 0..self.rect.width() {
                let i = y * ROW + x;
                if self.open[i] > 0
                    && let Some((at, chunk)) =
                        place(self.rect.x0 as usize + x, self.rect.y0 as usize + y)
                {
                    (self.at[0][i], self.at[1][i]) = (at.x, at.y);
                    (self.chunk[i], self.open[i]) = (chunk, 0);
                }
            }
        }
    }

    /// One level, cell by cell.
    fn large_chunks(&mut self, maps: &ChunkMaps, level: (u32, f32)) {
        let grid = maps.grid(level, 0);
        let tile = self.rect;
        for (j, top, bottom) in runs(&grid, tile.y0, tile.y1) {
            for (i, left, right) in runs(&grid, tile.x0, tile.x1) {
                let cell = Rect::new(left, top, right, bottom);
                for part in self.open_parts(maps, cell) {
                    let grid = maps.grid(level, part);
                    let block = CellBlock::of(maps, &grid, (i, j), part, cell);
                    fill_cell(&block, maps, self);
                }
            }
        }
    }

    /// The parts of the open pixels of a cell.
    fn open_parts(&self, maps: &ChunkMaps, cell: Rect) -> Vec<u32> {
        let mut parts = Vec::new();
        for y in cell.y0..cell.y1 {
            let first = (y - self.rect.y0) as usize * ROW + (cell.x0 - self.rect.x0) as usize;
            let open = &self.open[first..first + cell.width()];
            let Some(own) = maps.surface.parts_plane() else {
                if open.contains(&1) {
                    return vec![0];
                }
                continue;
            };
            let own = &own.row(y as usize)[cell.x0 as usize..];
            for (part, _) in own.iter().zip(open).filter(|(_, open)| **open > 0) {
                if !parts.contains(part) {
                    parts.push(*part);
                }
            }
        }
        parts
    }
}

/// The runs of pixels from one to another that lie in the same cells: cell, first and end.
fn runs(grid: &SeedGrid, from: i32, to: i32) -> impl Iterator<Item = (i32, i32, i32)> {
    let cell = |v: i32| grid.cell(v as usize);
    let mut start = from;
    std::iter::from_fn(move || {
        (start < to).then(|| {
            let own = cell(start);
            let end = (start + 1..to).find(|v| cell(*v) != own).unwrap_or(to);
            let run = (own, start, end);
            start = end;
            run
        })
    })
}

/// A cell of a tile and the seeds that may be nearest to its pixels.
struct CellBlock {
    cell: Rect,
    part: u32,
    /// Where they are sown, px.
    sown: Vec<Vec2>,
    /// Those that are off their part lie nowhere.
    seeds: Vec<Seed>,
    chunks: Vec<u8>,
    /// Whether every pixel is joined to every seed, and of the same part.
    is_whole: bool,
    is_bent: bool,
}

/// Off every ball.
const NOWHERE: Seed = Seed { at: Vec2::ZERO, offset: Vec2::splat(-1e6), bend: Mat2::ZERO };

impl CellBlock {
    fn of(maps: &ChunkMaps, grid: &SeedGrid, at: (i32, i32), part: u32, cell: Rect) -> Self {
        let around = neighboring_cells(at).map(|cell| (cell, grid.seed_of(cell)));
        let (low, high) = (
            vec2(cell.x0 as f32 + 0.5, cell.y0 as f32 + 0.5),
            vec2(cell.x1 as f32 - 0.5, cell.y1 as f32 - 0.5),
        );
        let farthest = |seed: Vec2| super::square((seed - low).abs().max((seed - high).abs()));
        let nearest = |seed: Vec2| super::square(seed - seed.max(low).min(high));
        // Room for rounding, so that no seed is left out that could be chosen.
        let least =
            around.iter().map(|(_, s)| farthest(*s)).fold(f32::MAX, f32::min) * 1.001 + 0.01;
        let (mut sown, mut seeds, mut chunks, mut reach) =
            (Vec::new(), Vec::new(), Vec::new(), cell);
        for (cell, seed) in around.into_iter().filter(|(_, seed)| nearest(*seed) <= least) {
            let found = maps.seed(grid, cell, part);
            if let Some(found) = &found {
                let (x, y) = (found.at.x as i32, found.at.y as i32);
                reach = reach.union(Rect::new(x, y, x + 1, y + 1));
            }
            sown.push(seed);
            seeds.push(found.unwrap_or(NOWHERE));
            chunks.push(grid.chunk(cell));
        }
        let is_whole = maps.surface.parts_plane().is_none() && maps.ways.is_whole(reach);
        Self { cell, part, sown, seeds, chunks, is_whole, is_bent: maps.settings.follow > 0.0 }
    }

    /// The pixels of lanes that are of its part, and reach the seeds that they found.
    #[inline(always)]
    fn reaching_lanes(
        &self,
        maps: &ChunkMaps,
        (x, y): (usize, usize),
        found: &[u32; LANES],
        taken: &mut [bool; LANES],
    ) {
        for lane in 0..LANES {
            let at = (x + lane, y);
            taken[lane] = taken[lane]
                && maps.part(at.0, at.1) == self.part
                && maps.ways.is_reached(self.seeds[found[lane] as usize].pixel(), at);
        }
    }
}

crate::widest! {
    /// Finds the nearest seed of each open pixel of a cell, and takes its place if it suits.
    fn fill_cell(block: &CellBlock, maps: &ChunkMaps, tile: &mut PlaceTile) {
        let per_px = 2.0 / maps.settings.ball_px;
        let rows = (block.cell.y0..block.cell.y1).flat_map(|y| {
            (block.cell.x0..block.cell.x1).step_by(LANES).map(move |x| (x, y))
        });
        for (left, row) in rows {
            let first = (row - tile.rect.y0) as usize * ROW + (left - tile.rect.x0) as usize;
            let Some(open) = tile.open[first..].first_chunk_mut::<LANES>() else { continue };
            if u64::from_ne_bytes(*open) == 0 {
                continue;
            }
            let count = (block.cell.x1 - left).min(LANES as i32) as usize;
            let y = row as f32 + 0.5;
            let mut x = [0.0f32; LANES];
            for (lane, x) in x.iter_mut().enumerate() {
                *x = left as f32 + 0.5 + lane as f32;
            }
            let (mut least, mut best) = ([f32::MAX; LANES], [0u32; LANES]);
            let [mut ox, mut oy] = [[0.0f32; LANES]; 2];
            for (k, (sown, seed)) in block.sown.iter().zip(&block.seeds).enumerate() {
                let dy = sown.y - y;
                for lane in 0..LANES {
                    let dx = sown.x - x[lane];
                    let away = dx * dx + dy * dy;
                    let is_less = away < least[lane];
                    least[lane] = if is_less { away } else { least[lane] };
                    best[lane] = if is_less { k as u32 } else { best[lane] };
                    ox[lane] = if is_less { seed.offset.x } else { ox[lane] };
                    oy[lane] = if is_less { seed.offset.y } else { oy[lane] };
                }
            }
            for lane in 0..LANES {
                ox[lane] += x[lane];
                oy[lane] += y;
            }
            if block.is_bent {
                for lane in 0..LANES {
                    let place = block.seeds[best[lane] as usize].place(vec2(x[lane], y));
                    (ox[lane], oy[lane]) = (place.x, place.y);
                }
            }
            let normal = [0, 1, 2].map(|c| tile.normal[c][first..].first_chunk::<LANES>());
            let [Some(nx), Some(ny), Some(nz)] = normal else { continue };
            let mut taken = [false; LANES];
            for lane in 0..LANES {
                let (bx, by) = (ox[lane] * per_px - 1.0, oy[lane] * per_px - 1.0);
                let below = 1.0 - (bx * bx + by * by);
                let bz = fast::max(below, 0.0).sqrt();
                let apart = (bx - nx[lane]).abs() + (by - ny[lane]).abs() + (bz - nz[lane]).abs();
                taken[lane] = (below > 0.0) & (apart < super::NEAR) & (open[lane] > 0) & (lane < count);
            }
            if !block.is_whole {
                block.reaching_lanes(maps, (left as usize, row as usize), &best, &mut taken);
            }
            let (at_x, rest) = tile.at.split_at_mut(1);
            let at = [&mut at_x[0], &mut rest[0]].map(|at| at[first..].first_chunk_mut::<LANES>());
            let [Some(at_x), Some(at_y)] = at else { continue };
            for lane in 0..LANES {
                at_x[lane] = if taken[lane] { ox[lane] } else { at_x[lane] };
                at_y[lane] = if taken[lane] { oy[lane] } else { at_y[lane] };
                open[lane] = if taken[lane] { 0 } else { open[lane] };
            }
            for lane in 0..LANES {
                if taken[lane] {
                    tile.chunk[first + lane] = block.chunks[best[lane] as usize];
                }
            }
        }
    }
}
