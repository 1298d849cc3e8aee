//! Filters what is composed beneath filters: which tiles they read, in which order. Floor 4. Blocks
//! are filtered in parallel, each once, before the tiles are composed that show them. Not here: what
//! a filter does to pixels (`paint::filter`), where the tiles are kept (`filter_stage`).

use super::Progress;
use super::compose::{ComposeFlow, Composer};
use super::far_side::FarTile;
use super::filter_stage::{FilterStage, ReadTiles, StoredTile, part_row};
use super::floats::FloatTiles;
use super::prepare::PreparedDocument;
use super::progress::in_parallel;
use crate::math::{Rect, parallel};
use crate::paint::filter::FilterPlace;
use crate::raster::{PlanarTile, TileAt};
use std::collections::{BTreeMap, BTreeSet};

/// Which of a stage's tiles: composed in floats, or not.
fn pass_of(floats: Option<&FloatTiles>) -> usize {
    usize::from(floats.is_some())
}

impl PreparedDocument {
    /// Filters what some tiles show, in parallel, so that composing them finds it; `None` if
    /// canceled. Composing a tile that was not prepared filters its block alone.
    pub fn filter_tiles(&self, tiles: &[TileAt], progress: &Progress) -> Option<()> {
        self.filter_beneath(tiles, usize::MAX, None, progress)
    }

    /// The same for the filters beneath an adjustment, by its number.
    pub(super) fn filter_beneath(
        &self,
        tiles: &[TileAt],
        below: usize,
        floats: Option<&FloatTiles>,
        progress: &Progress,
    ) -> Option<()> {
        let (canvas, pass) = (self.size.rect(), pass_of(floats));
        let mut needed: BTreeSet<TileAt> = tiles.iter().copied().collect();
        let mut steps = Vec::new();
        for stage in self.filters.iter().rev().filter(|stage| stage.index < below) {
            let blocks = needed.iter().flat_map(|at| stage.filter.blocks(at.rect(), canvas));
            let blocks: BTreeMap<(i32, i32), Rect> =
                blocks.map(|block| ((block.y0, block.x0), block)).collect();
            let made = &stage.made[pass];
            let is_new = |block: &Rect| made.get(TileAt::of_pixel(block.x0, block.y0)).is_none();
            let blocks: Vec<Rect> = blocks.into_values().filter(is_new).collect();
            let reads = stage.tiles_read(&blocks, canvas);
            needed.extend(&reads);
            steps.push((stage, blocks, reads));
        }
        for (stage, blocks, reads) in steps.into_iter().rev() {
            let beneath = &stage.beneath[pass];
            let missing: Vec<TileAt> =
                reads.into_iter().filter(|at| beneath.get(*at).is_none()).collect();
            let composed =
                in_parallel(&missing, progress, |at| self.compose_beneath(stage, at, floats))?;
            missing.iter().zip(composed).for_each(|(at, tile)| beneath.set(*at, tile));
            parallel::for_each(&blocks, 1, |block| {
                if !progress.is_canceled() {
                    self.filter_block(stage, *block, floats);
                }
            });
            if progress.is_canceled() {
                return None;
            }
        }
        Some(())
    }

    /// What a filter shows on a tile; `None` for what is no filter.
    pub(super) fn filtered_tile(
        &self,
        index: usize,
        at: TileAt,
        floats: Option<&FloatTiles>,
    ) -> Option<StoredTile> {
        let stage = self.filters.iter().find(|stage| stage.index == index)?;
        let made = &stage.made[pass_of(floats)];
        if let Some(known) = made.get(at) {
            return Some(known);
        }
        for block in stage.filter.blocks(at.rect(), self.size.rect()) {
            self.filter_block(stage, block, floats);
        }
        Some(made.get(at).unwrap_or(StoredTile::Nothing))
    }

    /// Filters a block, and composes what it reads if that is not there. On the calling thread
    /// alone: a tile that waits for it may hold a lock.
    fn filter_block(&self, stage: &FilterStage, block: Rect, floats: Option<&FloatTiles>) {
        let (canvas, pass) = (self.size.rect(), pass_of(floats));
        let mut tiles = BTreeMap::new();
        for at in stage.tiles_read(&[block], canvas) {
            let known = stage.beneath[pass].get(at).unwrap_or_else(|| {
                let tile = self.compose_beneath(stage, at, floats);
                stage.beneath[pass].set(at, tile.clone());
                tile
            });
            tiles.insert(at, known);
        }
        let brightest = floats.map_or(1.0, FloatTiles::brightest);
        let place = FilterPlace::new(&stage.scene, block, brightest);
        let filtered = stage.filter.apply(&place, &ReadTiles { tiles, canvas });
        for at in TileAt::covering(block) {
            let (tile, inside) = (at.rect(), at.rect().intersect(block));
            let mut pixels = PlanarTile::transparent();
            for y in inside.y0..inside.y1 {
                let to = &mut pixels.rows_mut()[(y - tile.y0) as usize];
                let start = (inside.x0 - block.x0) as usize;
                let from = &filtered.row(y)[start..start + inside.width()];
                let first = (inside.x0 - tile.x0) as usize;
                part_row(from, first, &mut to.rgb, &mut to.a);
            }
            stage.made[pass].set(at, StoredTile::of(pixels, floats.is_some()));
        }
    }

    /// A tile of what lies beneath a filter, as it would be seen: both sides of contour pixels
    /// mixed.
    fn compose_beneath(
        &self,
        stage: &FilterStage,
        at: TileAt,
        floats: Option<&FloatTiles>,
    ) -> StoredTile {
        let composed = |far: Option<FarTile>| {
            let sought = Some(stage.index);
            let composer = Composer { prepared: self, at, far, sought, floats };
            match composer.stack(&self.stack, &mut composer.blank()) {
                ComposeFlow::Break(beneath) => beneath,
                ComposeFlow::Continue(()) => composer.blank(),
            }
        };
        StoredTile::of(self.with_far_side(at, floats, composed), floats.is_some())
    }
}
