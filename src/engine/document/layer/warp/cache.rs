//! What was composed of a warped layer: the tiles that it is sampled from, and those that it shows.
//! Floor 4.

use super::LayerWarp;
use crate::document::layer::content::Content;
use crate::document::layer::map::LayerMap;
use crate::document::memory_use::MemoryCount;
use crate::math::Rect;
use crate::memory::once;
use crate::paint::Scene;
use crate::raster::warp::{PixelMap, warp_tile_within};
use crate::raster::{Tile, TileAt, TileGrid};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

type Cell = OnceLock<Option<Arc<Tile>>>;

/// One cell for each tile of the canvas.
struct Cells {
    cols: i32,
    cells: Vec<Cell>,
}

impl Cells {
    fn new(canvas: Rect) -> Self {
        let count = TileAt::covering(canvas).count();
        let cols = TileAt::covering(canvas).take_while(|at| at.row == 0).count() as i32;
        Self { cols, cells: (0..count).map(|_| OnceLock::new()).collect() }
    }

    fn cell(&self, at: TileAt) -> Option<&Cell> {
        let inside = at.col >= 0 && at.row >= 0 && at.col < self.cols;
        inside.then(|| self.cells.get((at.row * self.cols + at.col) as usize)).flatten()
    }

    fn count(&self, count: &mut MemoryCount) {
        for tile in self.cells.iter().filter_map(|cell| cell.get()?.as_ref()) {
            if count.is_new(tile) {
                count.add_kept(tile.held_bytes());
            }
        }
    }
}

/// The tiles of a warped layer, computed when needed.
pub struct WarpTiles {
    pub warp: LayerWarp,
    /// The surface cuts what is shown, or will: all of a rim's pixel is the surface's.
    pub is_cut: bool,
    canvas: Rect,
    /// As it is composed, undisplaced.
    source: Arc<Cells>,
    /// As it shows.
    shown: Cells,
}

impl WarpTiles {
    /// What the layer shows on a tile. `None`: it shows itself there.
    pub fn displaced_tile(
        &self,
        at: TileAt,
        compose: &dyn Fn(TileAt) -> Option<Arc<Tile>>,
    ) -> Option<Option<Arc<Tile>>> {
        let cell = self.shown.cell(at)?;
        if let Some(known) = cell.get() {
            return Some(known.clone());
        }
        let map = self.warp.tile_map(at, &crate::math::PlaneMap::IDENTITY)?;
        Some(once(cell, || self.sample_tile(at, &map, compose)).clone())
    }

    fn sample_tile(
        &self,
        at: TileAt,
        map: &dyn PixelMap,
        compose: &dyn Fn(TileAt) -> Option<Arc<Tile>>,
    ) -> Option<Arc<Tile>> {
        let wanted = self
            .warp
            .rect_within_border(map.source_rect(at.rect().intersect(self.canvas)))
            .intersect(self.canvas);
        let mut grid = TileGrid::default();
        for from in TileAt::covering(wanted) {
            let tile = self.source.cell(from).map(|cell| once(cell, || compose(from)).clone());
            grid.set(from, tile.flatten());
        }
        let border = self.warp.has_continued_border().then_some(self.canvas);
        warp_tile_within(&grid, border, map, self.warp.filter, at)
    }
}

/// The last composed tiles of a layer, shared by its versions.
#[derive(Clone, Default)]
pub struct WarpCache {
    last: Arc<Mutex<Option<Entry>>>,
}

#[derive(Clone)]
struct Entry {
    scene: Scene,
    content: Content,
    map: LayerMap,
    tiles: Arc<WarpTiles>,
}

impl WarpCache {
    /// Counts what it holds, or drops it.
    pub fn count(&self, count: &mut MemoryCount, keeps: bool) {
        if !count.is_new(&self.last) {
            return;
        }
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if !keeps {
            *last = None;
        }
        if let Some(entry) = &*last {
            entry.tiles.source.count(count);
            entry.tiles.shown.count(count);
        }
    }

    /// The tiles of a layer that shows `content` on a scene. What was composed of the same content
    /// is kept; what it shows is kept too, where its displacement did not change.
    ///
    /// * `is_cut`: as [`WarpTiles::is_cut`].
    pub fn tiles(
        &self,
        scene: &Scene,
        (content, map): (&Content, &LayerMap),
        warp: LayerWarp,
        is_cut: bool,
    ) -> Arc<WarpTiles> {
        let canvas = scene.size.rect();
        // The lock is not held while tiles are compared.
        let known = {
            let last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
            let same = last.as_ref().filter(|entry| {
                let is_alike = entry.map == *map && entry.tiles.is_cut == is_cut;
                is_alike && entry.scene.is_same(scene) && is_same(&entry.content, content)
            });
            same.map(|entry| entry.tiles.clone())
        };
        let tiles = match known {
            Some(known) if known.warp == warp => return known,
            Some(known) => {
                let shown = Cells::new(canvas);
                if let Some(changed) = LayerWarp::changed_tiles(Some(&known.warp), Some(&warp))
                    && known.warp.filter == warp.filter
                {
                    for at in TileAt::covering(canvas).filter(|at| !changed.contains(at)) {
                        if let (Some(to), Some(from)) = (shown.cell(at), known.shown.cell(at))
                            && let Some(tile) = from.get()
                        {
                            let _ = to.set(tile.clone());
                        }
                    }
                }
                WarpTiles { warp, is_cut, canvas, source: known.source.clone(), shown }
            }
            None => WarpTiles {
                warp,
                is_cut,
                canvas,
                source: Arc::new(Cells::new(canvas)),
                shown: Cells::new(canvas),
            },
        };
        let tiles = Arc::new(tiles);
        let (scene, content, map) = (scene.clone(), content.clone(), *map);
        let entry = Entry { scene, content, map, tiles: tiles.clone() };
        // What was known before is freed after the lock.
        let before = self.last.lock().unwrap_or_else(PoisonError::into_inner).replace(entry);
        drop(before);
        tiles
    }
}

/// The very same content: for a group, the very same layers.
fn is_same(a: &Content, b: &Content) -> bool {
    match (a, b) {
        (Content::Group(a), Content::Group(b)) => {
            a.layers.len() == b.layers.len()
                && a.layers.iter().zip(&b.layers).all(|(a, b)| Arc::ptr_eq(a, b))
        }
        _ => a.is_identical(b),
    }
}
