//! What is left to paint of one picture as its document changes.
//! Floor 7.

use super::RenderedTileBatch;
use crate::document::{Document, PreparedDocument, Progress, diff};
use crate::io::platform::Instant;
use crate::math::{Rect, Size};
use crate::raster::{Tile, TileAt};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;

/// A picture that is being painted.
#[derive(Default)]
pub struct RenderPass {
    document: Option<Document>,
    prepared: Option<PreparedDocument>,
    /// Tiles that are not yet those of the document.
    dirty: BTreeSet<TileAt>,
    begun: Option<Instant>,
    /// The number of documents taken up, and how long the last settled one took.
    passes: u32,
    took: Duration,
    /// The longest that one took.
    slowest: Duration,
    /// Tiles painted of this document.
    painted: usize,
}

/// What one call painted.
pub struct PassBatch {
    tiles: Vec<(TileAt, Option<Arc<Tile>>)>,
    pub is_settled: bool,
    /// Since the document was taken up.
    pub took: Duration,
    /// Tiles painted since then, and visible ones that are left.
    painted: usize,
    left: usize,
}

impl PassBatch {
    /// Tiles left per tile done.
    pub fn share_left(&self) -> f32 {
        self.left as f32 / self.painted.max(1) as f32
    }

    pub fn into_batch(self, picture: u64, size: Size) -> RenderedTileBatch {
        let Self { tiles, is_settled, took, .. } = self;
        RenderedTileBatch { picture, is_draft: false, size, tiles, is_settled, took, refused: None }
    }
}

impl RenderPass {
    pub fn begin(&mut self, next: Document) {
        match self.document.as_ref().filter(|old| old.size == next.size) {
            Some(old) => self.dirty.extend(diff(old, &next)),
            None => self.dirty = TileAt::covering(next.size.rect()).collect(),
        }
        (self.prepared, self.begun, self.painted) = (None, Some(Instant::now()), 0);
        self.document = Some(next);
        self.passes = self.passes.saturating_add(1);
    }

    pub fn has_more(&self) -> bool {
        !self.dirty.is_empty()
    }

    pub fn size(&self) -> Option<Size> {
        self.document.as_ref().map(|document| document.size)
    }

    pub fn passes(&self) -> u32 {
        self.passes
    }

    pub fn duration(&self) -> Duration {
        self.took
    }

    /// The longest that a document took.
    pub fn slowest(&self) -> Duration {
        self.slowest
    }

    /// Paints at most so many tiles, visible ones first; `None` if nothing is left.
    pub fn paint(&mut self, visible: Rect, most: usize) -> Option<PassBatch> {
        let document = self.document.as_ref()?;
        if self.dirty.is_empty() {
            return None;
        }
        if self.prepared.is_none() {
            self.prepared = PreparedDocument::new(document, &Progress::default());
        }
        let prepared = self.prepared.as_ref()?;
        let in_sight = |at: &TileAt| !at.rect().intersect(visible).is_empty();
        let mut batch: Vec<TileAt> =
            self.dirty.iter().copied().filter(in_sight).take(most).collect();
        if batch.is_empty() {
            batch = self.dirty.iter().copied().take(most).collect();
        }
        // What is not canceled always answers.
        let _ = prepared.filter_tiles(&batch, &Progress::default());
        let tiles: Vec<_> = batch.par_iter().map(|&at| (at, prepared.flatten_tile(at))).collect();
        for at in &batch {
            self.dirty.remove(at);
        }
        self.painted += batch.len();
        let left = self.dirty.iter().filter(|at| in_sight(at)).count();
        let took = self.begun.map_or(Duration::ZERO, |begun| begun.elapsed());
        if left == 0 {
            (self.took, self.slowest) = (took, self.slowest.max(took));
        }
        Some(PassBatch { tiles, is_settled: left == 0, took, painted: self.painted, left })
    }
}
