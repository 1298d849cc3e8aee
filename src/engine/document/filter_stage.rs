//! What filters read and make: composed tiles by their places, kept while what lies beneath stays.
//! Floor 4. Not here: in which order they are composed and filtered (`filters`).

use super::far_side::FarTile;
use super::memory_use::MemoryCount;
use crate::math::Rect;
use crate::paint::filter::{FilterSource, FilterWindow};
use crate::paint::{LiveFilter, Scene};
use crate::raster::tile::sixteen_bit::{Row16, quantize_row};
use crate::raster::{PlanarTile, TILE, TileAt};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A filter of a prepared document.
pub struct FilterStage {
    /// Its number among the adjustments.
    pub index: usize,
    pub filter: LiveFilter,
    pub scene: Scene,
    /// What is composed beneath it: with live layers as bytes, and in floats.
    pub beneath: [Arc<StoredTiles>; 2],
    /// What it makes of that.
    pub made: [StoredTiles; 2],
}

impl FilterStage {
    /// The tiles that it reads for some of its blocks.
    pub fn tiles_read(&self, blocks: &[Rect], canvas: Rect) -> BTreeSet<TileAt> {
        let reads = blocks.iter().flat_map(|block| self.filter.reads(*block, canvas));
        reads.flat_map(TileAt::covering).collect()
    }
}

/// Composed tiles by their places; what is not there was not composed yet.
#[derive(Default)]
pub struct StoredTiles(Mutex<HashMap<TileAt, StoredTile>>);

/// A composed tile; what it holds is shared.
#[derive(Clone)]
pub enum StoredTile {
    /// It is transparent.
    Nothing,
    /// Rounded to 16 bits.
    Rounded(Arc<[Row16]>),
    /// With light that may be brighter than white.
    Bright(Arc<PlanarTile>),
}

impl StoredTiles {
    pub fn get(&self, at: TileAt) -> Option<StoredTile> {
        self.lock().get(&at).cloned()
    }

    pub fn set(&self, at: TileAt, tile: StoredTile) {
        self.lock().insert(at, tile);
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<TileAt, StoredTile>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Counts what it holds, or drops it.
    pub fn count(self: &Arc<Self>, count: &mut MemoryCount, keeps: bool) {
        if count.is_new(self) {
            let mut tiles = self.lock();
            if !keeps {
                tiles.clear();
            }
            count.add_kept(tiles.values().map(StoredTile::held_bytes).sum());
        }
    }
}

impl StoredTile {
    pub fn of(pixels: PlanarTile, in_floats: bool) -> Self {
        if pixels.rows().iter().all(|row| row.a.iter().all(|a| *a == 0.0)) {
            return StoredTile::Nothing;
        }
        if in_floats {
            return StoredTile::Bright(Arc::new(pixels));
        }
        let mut rows = vec![[[0; TILE]; 4]; TILE];
        for (row, rows16) in pixels.rows().iter().zip(&mut rows) {
            let [r, g, b] = &row.rgb;
            quantize_row([r, g, b, &row.a], rows16);
        }
        StoredTile::Rounded(rows.into())
    }

    fn held_bytes(&self) -> u64 {
        match self {
            StoredTile::Nothing => 0,
            StoredTile::Rounded(rows) => size_of_val::<[Row16]>(rows) as u64,
            StoredTile::Bright(pixels) => size_of_val(pixels.rows()) as u64,
        }
    }

    /// A pixel by its place in the tile.
    #[inline(always)]
    fn pixel(&self, x: usize, y: usize) -> [f32; 4] {
        match self {
            StoredTile::Nothing => [0.0; 4],
            StoredTile::Rounded(rows) => {
                [0, 1, 2, 3].map(|k| f32::from(rows[y][k][x]) * (1.0 / 65535.0))
            }
            StoredTile::Bright(pixels) => pixels.rows()[y].pixel(x),
        }
    }

    fn copy_row(&self, from: usize, y: usize, row: &mut [[f32; 4]]) {
        match self {
            StoredTile::Nothing => row.fill([0.0; 4]),
            StoredTile::Rounded(rows) => interleave_row(&rows[y], from, row),
            _ => row.iter_mut().zip(from..).for_each(|(to, x)| *to = self.pixel(x, y)),
        }
    }

    /// Replaces the pixels of a tile.
    ///
    /// * `keeps_alpha`: alpha stays, and what is transparent here has no color to show there.
    pub fn put_on(&self, pixels: &mut PlanarTile, keeps_alpha: bool) {
        if let (StoredTile::Rounded(rows), false) = (self, keeps_alpha) {
            for (row, rows16) in pixels.rows_mut().iter_mut().zip(rows.iter()) {
                let [r, g, b] = &mut row.rgb;
                read_row(rows16, [r, g, b, &mut row.a]);
            }
            return;
        }
        for (y, row) in pixels.rows_mut().iter_mut().enumerate() {
            for x in 0..TILE {
                row.set(x, compose_over(self.pixel(x, y), row.pixel(x), keeps_alpha));
            }
        }
    }

    /// The same for what the other sides of contour pixels see: both see what is filtered.
    pub fn put_on_far_side(&self, far: &FarTile, pixels: &mut PlanarTile, keeps_alpha: bool) {
        let corner = far.at.rect();
        for (place, pixel) in far.places() {
            let (x, y) = ((pixel.x - corner.x0) as usize, (pixel.y - corner.y0) as usize);
            let row = &mut pixels.rows_mut()[place / TILE];
            let old = row.pixel(place % TILE);
            row.set(place % TILE, compose_over(self.pixel(x, y), old, keeps_alpha));
        }
    }
}

crate::widest! {
    /// Pixels of a row of 16 bits, from one on, in floats.
    fn interleave_row(rows16: &Row16, from: usize, row: &mut [[f32; 4]]) {
        let to = from + row.len();
        let [r, g, b, a] = rows16;
        let channels = r[from..to].iter().zip(&g[from..to]).zip(&b[from..to]).zip(&a[from..to]);
        for (pixel, (((r, g), b), a)) in row.iter_mut().zip(channels) {
            *pixel = [
                f32::from(*r) * (1.0 / 65535.0),
                f32::from(*g) * (1.0 / 65535.0),
                f32::from(*b) * (1.0 / 65535.0),
                f32::from(*a) * (1.0 / 65535.0),
            ];
        }
    }

    /// Pixels in the channels of a row, from one on.
    pub(super) fn part_row(pixels: &[[f32; 4]], from: usize, rgb: &mut [[f32; TILE]; 3], a: &mut [f32; TILE]) {
        let to = from + pixels.len();
        let [r, g, b] = rgb;
        let channels = r[from..to]
            .iter_mut()
            .zip(&mut g[from..to])
            .zip(&mut b[from..to])
            .zip(&mut a[from..to]);
        for (pixel, (((r, g), b), a)) in pixels.iter().zip(channels) {
            (*r, *g, *b, *a) = (pixel[0], pixel[1], pixel[2], pixel[3]);
        }
    }

    /// A row of 16 bits in floats.
    fn read_row(rows16: &Row16, row: [&mut [f32; TILE]; 4]) {
        for (channel, values) in row.into_iter().zip(rows16) {
            for x in 0..TILE {
                channel[x] = f32::from(values[x]) * (1.0 / 65535.0);
            }
        }
    }
}

/// A filtered pixel in the place of an old one.
#[inline(always)]
fn compose_over(filtered: [f32; 4], old: [f32; 4], keeps_alpha: bool) -> [f32; 4] {
    if !keeps_alpha {
        return filtered;
    }
    if filtered[3] <= 0.0 {
        return old;
    }
    let share = old[3] / filtered[3];
    [filtered[0] * share, filtered[1] * share, filtered[2] * share, old[3]]
}

/// The tiles that are read for a block.
pub struct ReadTiles {
    pub tiles: BTreeMap<TileAt, StoredTile>,
    pub canvas: Rect,
}

impl FilterSource for ReadTiles {
    fn bounds(&self) -> Rect {
        self.canvas
    }

    fn window(&self, rect: Rect) -> FilterWindow {
        FilterWindow::gather(rect, self.canvas, |x, y, row| {
            let line = Rect::new(x, y, x + row.len() as i32, y + 1);
            for at in TileAt::covering(line) {
                let (tile, area) = (at.rect(), at.rect().intersect(line));
                let to = &mut row[(area.x0 - x) as usize..][..area.width()];
                let known = self.tiles.get(&at).unwrap_or(&StoredTile::Nothing);
                known.copy_row((area.x0 - tile.x0) as usize, (y - tile.y0) as usize, to);
            }
        })
    }
}

/// The tiles of a canvas that a filter changes where others changed beneath it.
pub fn tiles_touched(filter: &LiveFilter, changed: &BTreeSet<TileAt>, canvas: Rect) -> Vec<TileAt> {
    let around = changed.iter().fold(Rect::EMPTY, |all, at| all.union(at.rect()));
    let reads_changed = |block: &Rect| {
        filter.reads(*block, canvas).into_iter().any(|read| {
            !read.intersect(around).is_empty()
                && TileAt::covering(read).any(|at| changed.contains(&at))
        })
    };
    let blocks = filter.blocks(canvas, canvas).into_iter().filter(reads_changed);
    blocks.flat_map(TileAt::covering).collect()
}
