//! Places over a whole map: tile by tile, the large chunks in lanes. Floor 2. The reference is
//! `ChunkMaps::place_at`, in the module above.

use super::sown::SownParts;
use super::{
    BallPlace, BallPlaces, ChunkMaps, LANES, LOOKED_UP, Seed, SeedGrid, neighboring_cells, seams,
};
use crate::math::{Mat2, Rect, Vec2, fast, parallel, vec2};
use crate::raster::{Plane, TILE};

/// Cells from this side on are worked on in lanes; in smaller ones few pixels are left.
const IN_LANES_PX: f32 = 8.0;

/// Of every pixel of a surface.
pub(super) fn places(maps: &ChunkMaps) -> BallPlaces {
    let size = maps.surface.size();
    let (mut places, mut chunks) = (Plane::full(size, [0u16; 2]), Plane::full(size, 0u8));
    let (width, steps) = (places.width().max(1), maps.settings.steps());
    let chunk_bands = chunks.values_mut().chunks_mut(width * TILE);
    let bands = places.values_mut().chunks_mut(width * TILE).zip(chunk_bands).enumerate();
    parallel::for_each_with(bands, 1, PlaceTile::default, |tile, (band, (places, chunks))| {
        for x0 in (0..width).step_by(TILE) {
            tile.fill(maps, (x0, band * TILE));
            let end = (x0 + TILE).min(width);
            let rows = places.chunks_mut(width).zip(chunks.chunks_mut(width));
            for (y, (places, chunks)) in rows.enumerate() {
                tile.write(steps, y, &mut places[x0..end], &mut chunks[x0..end]);
            }
        }
    });
    seams::find_seams(maps, BallPlaces::without_seams(places, &maps.settings), &chunks)
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
                self.small_chunks(maps, level);
            }
        }
        self.look_up_rest(maps);
    }

    /// The places of a row, as they are stored, and the chunks that show them.
    fn write(&self, steps: f32, y: usize, places: &mut [[u16; 2]], chunks: &mut [u8]) {
        let (first, count) = (y * ROW, places.len());
        chunks.copy_from_slice(&self.chunk[first..first + count]);
        let [across, down] = [0, 1].map(|axis| &self.at[axis][first..first + count]);
        for (i, place) in places.iter_mut().enumerate() {
            let found = BallPlace::of(vec2(across[i], down[i]), chunks[i], steps).at;
            *place = if chunks[i] > 0 { found } else { [0; 2] };
        }
    }

    /// What is left shows what a lit sphere does.
    fn look_up_rest(&mut self, maps: &ChunkMaps) {
        for y in 0..self.rect.height() {
            for x in (0..self.rect.width()).map(|x| y * ROW + x) {
                if self.open[x] > 0 {
                    let nbar = vec2(self.normal[0][x], self.normal[1][x]);
                    self.take(x, maps.settings.look_up(nbar), LOOKED_UP);
                }
            }
        }
    }

    /// One level, some pixels of a row at once.
    fn small_chunks(&mut self, maps: &ChunkMaps, level: (u32, f32)) {
        let tile = self.rect;
        let mut sown = SownParts::of(maps, level, tile);
        for y in 0..tile.height() {
            for left in (0..tile.width()).step_by(LANES) {
                self.fill_small(&mut sown, (left, y));
            }
        }
    }

    /// The same from one of its pixels on.
    fn fill_small(&mut self, sown: &mut SownParts, (left, y): (usize, usize)) {
        let (first, count) = (y * ROW + left, LANES.min(self.rect.width() - left));
        let (x0, y) = (self.rect.x0 as usize + left, self.rect.y0 as usize + y);
        // Of the last pixel's part.
        let mut nearest = None;
        for lane in 0..count {
            if self.open[first + lane] == 0 {
                continue;
            }
            let part = sown.maps.part(x0 + lane, y);
            let maps = sown.maps;
            let cells = sown.cells_of(part);
            let found = match nearest {
                Some((of, found)) if of == part => found,
                _ => cells.find_nearest((x0, y)),
            };
            nearest = Some((part, found));
            let pixel = (x0 + lane, y);
            if let Some((at, chunk)) = maps.chunk_place(&cells.grid, cells.cell(found[lane]), pixel)
            {
                self.take(first + lane, at, chunk);
            }
        }
    }

    /// Gives a pixel its place.
    fn take(&mut self, i: usize, at: Vec2, chunk: u8) {
        (self.at[0][i], self.at[1][i]) = (at.x, at.y);
        (self.chunk[i], self.open[i]) = (chunk, 0);
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
            // Near the end of the cell.
            let mut end = (((own + 1) as f32 * grid.side) as i32).max(start + 1).min(to);
            while end > start + 1 && cell(end - 1) != own {
                end -= 1;
            }
            while end < to && cell(end) == own {
                end += 1;
            }
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
    /// How many there are of the nine.
    count: usize,
    /// Where they are sown, px.
    sown: [Vec2; 9],
    /// Those that are off their part lie nowhere.
    seeds: [Seed; 9],
    chunks: [u8; 9],
    /// Whether every pixel is joined to every seed, and of the same part.
    is_whole: bool,
    is_bent: bool,
}

/// Off every ball.
const NOWHERE: Seed = Seed { at: Vec2::ZERO, offset: Vec2::splat(-1e6), bend: Mat2::ZERO };

/// The bounds of the middles of the pixels of a rectangle, px.
#[derive(Clone, Copy)]
struct Middles {
    low: Vec2,
    high: Vec2,
}

impl Middles {
    #[inline(always)]
    fn of(rect: Rect) -> Self {
        Self {
            low: vec2(rect.x0 as f32 + 0.5, rect.y0 as f32 + 0.5),
            high: vec2(rect.x1 as f32 - 0.5, rect.y1 as f32 - 0.5),
        }
    }

    /// The square of the distance from a seed to the nearest of them, at least.
    #[inline(always)]
    fn nearest(&self, seed: Vec2) -> f32 {
        super::square(seed - seed.max(self.low).min(self.high))
    }

    /// And to the farthest, with room for rounding, so that no seed is left out that could be
    /// chosen.
    #[inline(always)]
    fn farthest(&self, seed: Vec2) -> f32 {
        let away = (seed - self.low).abs().max((seed - self.high).abs());
        super::square(away) * 1.001 + 0.01
    }
}

impl CellBlock {
    fn of(maps: &ChunkMaps, grid: &SeedGrid, at: (i32, i32), part: u32, cell: Rect) -> Self {
        let mut block = Self {
            cell,
            part,
            count: 0,
            sown: [Vec2::ZERO; 9],
            seeds: [NOWHERE; 9],
            chunks: [0; 9],
            is_whole: false,
            is_bent: maps.settings.follow > 0.0,
        };
        let (around, middles) = (neighboring_cells(at), Middles::of(cell));
        let (mut sown, mut least) = ([Vec2::ZERO; 9], f32::MAX);
        for (seed, cell) in sown.iter_mut().zip(around) {
            *seed = grid.seed_of(cell);
            least = fast::min(least, middles.farthest(*seed));
        }
        let mut reach = cell;
        for (seed, cell) in sown.into_iter().zip(around) {
            if middles.nearest(seed) > least {
                continue;
            }
            let found = maps.seed(grid, cell, part);
            if let Some(found) = &found {
                let (x, y) = (found.at.x as i32, found.at.y as i32);
                reach = reach.union(Rect::new(x, y, x + 1, y + 1));
            }
            let k = block.count;
            block.sown[k] = seed;
            block.seeds[k] = found.unwrap_or(NOWHERE);
            block.chunks[k] = grid.chunk(cell);
            block.count += 1;
        }
        block.is_whole = maps.surface.parts_plane().is_none() && maps.ways.is_whole(reach);
        block
    }

    /// Those of its seeds, in order, that may be nearest to a pixel of a rectangle.
    #[inline(always)]
    fn nearest_seeds(&self, rect: Rect, out: &mut [u32; 9]) -> usize {
        let (middles, sown) = (Middles::of(rect), &self.sown[..self.count]);
        let mut least = f32::MAX;
        for seed in sown {
            least = fast::min(least, middles.farthest(*seed));
        }
        let mut count = 0;
        for (k, seed) in sown.iter().enumerate() {
            out[count.min(8)] = k as u32;
            count += usize::from(middles.nearest(*seed) <= least);
        }
        count
    }

    /// The pixels of lanes that are of its part, and reach the seeds that they found.
    #[inline(always)]
    fn reaching_lanes(
        &self,
        maps: &ChunkMaps,
        (x, y): (usize, usize),
        found: &[u32; LANES],
        taken: &mut [u32; LANES],
    ) {
        for lane in 0..LANES {
            let at = (x + lane, y);
            let is_taken = taken[lane] > 0
                && maps.part(at.0, at.1) == self.part
                && maps.ways.is_reached(self.seeds[found[lane] as usize].pixel(), at);
            taken[lane] = u32::from(is_taken);
        }
    }
}

/// Pixels of a row that are worked on at once.
struct PlaceLanes {
    /// Their first pixel.
    at: (i32, i32),
    /// How many of them lie in the cell.
    count: usize,
    /// In the tile.
    first: usize,
}

crate::widest! {
    /// Finds the nearest seed of each open pixel of a cell, and takes its place if it suits.
    fn fill_cell(block: &CellBlock, maps: &ChunkMaps, tile: &mut PlaceTile) {
        let cell = block.cell;
        let mut near = [0u32; 9];
        for top in (cell.y0..cell.y1).step_by(LANES) {
            for left in (cell.x0..cell.x1).step_by(LANES) {
                let (right, bottom) = (left + LANES as i32, top + LANES as i32);
                let square = Rect::new(left, top, right.min(cell.x1), bottom.min(cell.y1));
                let count = block.nearest_seeds(square, &mut near);
                for y in square.y0..square.y1 {
                    let first = (y - tile.rect.y0) as usize * ROW + (left - tile.rect.x0) as usize;
                    let lanes = PlaceLanes { at: (left, y), count: square.width(), first };
                    fill_lanes(block, &near[..count], maps, &lanes, tile);
                }
            }
        }
    }
}

/// The same of some pixels of a row.
///
/// * `near`: the seeds that may be the nearest.
#[inline(always)]
fn fill_lanes(
    block: &CellBlock,
    near: &[u32],
    maps: &ChunkMaps,
    lanes: &PlaceLanes,
    tile: &mut PlaceTile,
) {
    let per_px = 2.0 / maps.settings.ball_px;
    let PlaceLanes { at: (left, row), count, first } = *lanes;
    let PlaceTile { at: [at_x, at_y], chunk, open, normal: [nx, ny, nz], .. } = tile;
    let Some(open) = open[first..].first_chunk_mut::<LANES>() else { return };
    if u64::from_ne_bytes(*open) == 0 {
        return;
    }
    let (Some(nx), Some(ny), Some(nz), Some(at_x), Some(at_y)) = (
        nx[first..].first_chunk::<LANES>(),
        ny[first..].first_chunk::<LANES>(),
        nz[first..].first_chunk::<LANES>(),
        at_x[first..].first_chunk_mut::<LANES>(),
        at_y[first..].first_chunk_mut::<LANES>(),
    ) else {
        return;
    };
    let y = row as f32 + 0.5;
    let mut x = [0.0f32; LANES];
    for (lane, x) in x.iter_mut().enumerate() {
        *x = left as f32 + 0.5 + lane as f32;
    }
    let (mut least, mut best) = ([f32::MAX; LANES], [0u32; LANES]);
    let [mut ox, mut oy] = [[0.0f32; LANES]; 2];
    for &k in near {
        let (sown, seed) = (block.sown[k as usize], &block.seeds[k as usize]);
        let dy = sown.y - y;
        for lane in 0..LANES {
            let dx = sown.x - x[lane];
            let away = dx * dx + dy * dy;
            let is_less = away < least[lane];
            least[lane] = if is_less { away } else { least[lane] };
            best[lane] = if is_less { k } else { best[lane] };
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
    let mut taken = [0u32; LANES];
    for lane in 0..LANES {
        let (bx, by) = (ox[lane] * per_px - 1.0, oy[lane] * per_px - 1.0);
        let below = 1.0 - (bx * bx + by * by);
        let bz = fast::max(below, 0.0).sqrt();
        let apart = (bx - nx[lane]).abs() + (by - ny[lane]).abs() + (bz - nz[lane]).abs();
        let is_near = (below > 0.0) & (apart < super::NEAR);
        taken[lane] = u32::from(is_near & (open[lane] > 0) & (lane < count));
    }
    if !block.is_whole {
        block.reaching_lanes(maps, (left as usize, row as usize), &best, &mut taken);
    }
    for lane in 0..LANES {
        at_x[lane] = if taken[lane] > 0 { ox[lane] } else { at_x[lane] };
        at_y[lane] = if taken[lane] > 0 { oy[lane] } else { at_y[lane] };
        open[lane] = if taken[lane] > 0 { 0 } else { open[lane] };
    }
    for lane in 0..LANES {
        if taken[lane] > 0 {
            chunk[first + lane] = block.chunks[best[lane] as usize];
        }
    }
}
