//! The progress of long work, and whether it was canceled. Floor 4. Higher floors display it;
//! nothing here draws or waits.

#![warn(missing_docs)]

use crate::math::parallel;
use crate::raster::TileAt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Counters shared between those that work and those that watch. Steps have no unit; mostly they
/// are tiles.
#[derive(Default)]
pub struct Progress {
    done: AtomicU64,
    total: AtomicU64,
    canceled: AtomicBool,
    stage: Mutex<&'static str>,
}

impl Progress {
    /// Announces more steps.
    pub fn add_total(&self, steps: u64) {
        self.total.fetch_add(steps, Ordering::Relaxed);
    }

    /// One step is done.
    pub fn step(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    /// Steps done and steps announced so far.
    pub fn read(&self) -> (u64, u64) {
        (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed))
    }

    /// Names what is done now, in a few words; empty: what the work itself is called.
    pub fn enter(&self, stage: &'static str) {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = stage;
    }

    /// What is done now; empty if that has no name of its own.
    pub fn stage(&self) -> &'static str {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Cancels the work: it ends soon, without a result.
    pub fn cancel(&self) {
        self.canceled.store(true, Ordering::Relaxed);
    }

    /// Whether the work was canceled.
    pub fn is_canceled(&self) -> bool {
        self.canceled.load(Ordering::Relaxed)
    }
}

/// One result per tile, in the order of the tiles; `None` if canceled.
pub(super) fn in_parallel<T: Send>(
    tiles: &[TileAt],
    progress: &Progress,
    work: impl Fn(TileAt) -> T + Sync,
) -> Option<Vec<T>> {
    progress.add_total(tiles.len() as u64);
    let each = |&at: &TileAt| {
        let result = (!progress.is_canceled()).then(|| work(at))?;
        progress.step();
        Some(result)
    };
    parallel::map(tiles, each).into_iter().collect()
}
