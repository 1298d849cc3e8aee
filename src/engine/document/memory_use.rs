//! The memory that documents use, counted value by value.
//! Floor 4. Not here: which values there are (their owners, `count_memory`).

use super::Document;
use crate::paint::{LiveAdjustment, PictureSource, Selection, Stroke};
use crate::raster::{CoverageGrid, TileGrid};
use crate::surface::Surface;
use std::collections::HashSet;
use std::sync::Arc;

/// Bytes, by what they are for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryUse {
    /// Painted pixels, pen samples, masks and selections.
    pub painted: u64,
    /// Placed pictures.
    pub pictures: u64,
    /// Maps of the shape.
    pub maps: u64,
    /// Kept for speed: rendered layers, and what was computed from the maps and the pictures.
    pub kept: u64,
}

impl MemoryUse {
    /// Of one document alone, with all that it keeps.
    pub fn of(document: &Document) -> Self {
        let mut count = MemoryCount::default();
        count.add(document, true);
        count.sum_up()
    }

    /// All bytes.
    pub fn total(self) -> u64 {
        self.painted + self.pictures + self.maps + self.kept
    }

    /// What was added after another count, which this one continues.
    pub fn minus(self, before: Self) -> Self {
        Self {
            painted: self.painted - before.painted,
            pictures: self.pictures - before.pictures,
            maps: self.maps - before.maps,
            kept: self.kept - before.kept,
        }
    }

    /// The sum of both.
    pub fn plus(self, other: Self) -> Self {
        Self {
            painted: self.painted + other.painted,
            pictures: self.pictures + other.pictures,
            maps: self.maps + other.maps,
            kept: self.kept + other.kept,
        }
    }
}

/// A count over documents that share what they hold: each value is counted once, with the first
/// that holds it.
#[derive(Default)]
pub struct MemoryCount {
    /// Addresses of what was counted. None of it may be dropped while the count goes on.
    seen: HashSet<usize>,
    used: MemoryUse,
}

impl MemoryCount {
    /// All that was counted.
    pub fn sum_up(&self) -> MemoryUse {
        self.used
    }

    /// Whether a shared value was not counted yet; from now on it is.
    pub(in crate::document) fn is_new<T: ?Sized>(&mut self, shared: &Arc<T>) -> bool {
        self.seen.insert(Arc::as_ptr(shared).cast::<()>() as usize)
    }

    pub(in crate::document) fn add_tiles(&mut self, tiles: &TileGrid) {
        for (_, tile) in tiles.iter() {
            if self.is_new(tile) {
                self.used.painted += tile.held_bytes();
            }
        }
    }

    pub(in crate::document) fn add_painted(&mut self, bytes: u64) {
        self.used.painted += bytes;
    }

    /// Counts a copy that can be made again: whatever it holds is kept for speed.
    pub(in crate::document) fn add_copy(&mut self, add: impl FnOnce(&mut Self)) {
        let before = self.used;
        add(self);
        let more = self.used.minus(before).total();
        self.used = MemoryUse { kept: before.kept + more, ..before };
    }

    /// Tiles that a layer was rendered to.
    pub(in crate::document) fn add_kept(&mut self, bytes: u64) {
        self.used.kept += bytes;
    }

    pub(in crate::document) fn add_adjustment(&mut self, adjustment: &LiveAdjustment, keeps: bool) {
        if self.seen.insert(adjustment.place()) {
            if !keeps {
                adjustment.clear_kept();
            }
            self.used.kept += adjustment.kept_bytes();
        }
    }

    pub(in crate::document) fn add_stroke(&mut self, stroke: &Arc<Stroke>) {
        if self.is_new(stroke) {
            self.used.painted += size_of_val(stroke.samples()) as u64;
            stroke
                .selection()
                .into_iter()
                .for_each(|selection| self.add_selection(&selection.selection));
        }
    }

    pub(in crate::document) fn add_picture(&mut self, source: &PictureSource, keeps: bool) {
        if self.seen.insert(source.picture.place()) {
            self.used.pictures += source.picture.bytes() as u64;
        }
        if self.seen.insert(source.place()) {
            if !keeps {
                source.clear_textures();
            }
            self.used.kept += source.texture_bytes();
        }
    }

    pub(in crate::document) fn add_selection(&mut self, selection: &Arc<Selection>) {
        if self.is_new(selection) {
            self.add_coverage(&selection.coverage);
        }
    }

    pub(in crate::document) fn add_coverage(&mut self, coverage: &CoverageGrid) {
        for (_, tile) in coverage.iter() {
            if self.is_new(tile) {
                self.used.painted += tile.held_bytes();
            }
        }
    }

    pub(in crate::document) fn add_surface(&mut self, surface: &Arc<Surface>, keeps: bool) {
        if self.is_new(surface) {
            if !keeps {
                surface.clear_caches();
            }
            self.used.maps += surface.map_bytes();
            self.used.kept += surface.cached_bytes();
        }
    }
}
