//! Selections on a canvas of another size. Floor 4.

use super::CanvasScale;
use crate::document::layer::scale::source_weights;
use crate::document::{Document, NamedSelection};
use crate::math::{Rect, srgb::quantize};
use crate::paint::Selection;
use crate::raster::{CoverageGrid, TILE};
use crate::surface::region::SurfaceRegion;
use std::sync::{Arc, PoisonError};

impl CanvasScale {
    /// The document with its active and its kept selections scaled, and all else as it is.
    pub(super) fn scale_selections(&self, document: &Document) -> Document {
        let kept = |kept: &NamedSelection| NamedSelection {
            selection: self.selection(&kept.selection),
            ..kept.clone()
        };
        let scaled = |selection: &Arc<Selection>| self.selection(selection);
        Document {
            selections: document.selections.iter().map(kept).collect(),
            active_selection: document
                .active_selection
                .as_ref()
                .map(scaled)
                .filter(|found| !found.is_empty()),
            ..document.clone()
        }
    }

    /// A selection scaled, resampled once however many strokes share it.
    pub(in crate::document) fn selection(&self, selection: &Arc<Selection>) -> Arc<Selection> {
        let key = Arc::as_ptr(selection) as usize;
        let lock = || self.selections.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, scaled)) = lock().get(&key) {
            return scaled.clone();
        }
        // Without the lock: other threads take part in resampling.
        let made =
            selection.made.map(|region| SurfaceRegion { at: region.at * self.per_axis, ..region });
        let scaled = Arc::new(Selection::provisional(self.coverage(&selection.coverage), made));
        // The old one is kept too, so that no other gets its address.
        lock().entry(key).or_insert((selection.clone(), scaled)).1.clone()
    }

    /// Coverage resampled; the uncovered part continues beyond the canvas.
    fn coverage(&self, grid: &CoverageGrid) -> CoverageGrid {
        let Rect { x0, y0, x1, y1 } = grid.covered_rect();
        let low = |v: i32, s: f32| (f64::from(v) * f64::from(s)).floor() as i32;
        let high = |v: i32, s: f32| (f64::from(v) * f64::from(s)).ceil() as i32;
        let bounds = Rect::new(
            low(x0, self.per_axis.x),
            low(y0, self.per_axis.y),
            high(x1, self.per_axis.x),
            high(y1, self.per_axis.y),
        );
        // The border is continued beyond the old canvas, as for masks.
        let clamp = |v: i32, n: u32| {
            if (-1..=n as i32).contains(&v) { v.max(0).min(n as i32 - 1) } else { v }
        };
        CoverageGrid::from_tiles(
            bounds.intersect(self.to.rect().grown(self.to.width as i32)),
            |at, bytes| {
                let rect = at.rect();
                let columns: Vec<_> =
                    (rect.x0..rect.x1).map(|x| source_weights(x, self.per_axis.x)).collect();
                for (y, row) in (rect.y0..).zip(bytes.as_chunks_mut::<TILE>().0) {
                    let rows = source_weights(y, self.per_axis.y);
                    for (to, columns) in row.iter_mut().zip(&columns) {
                        let of_row = |&(y, wy): &(i32, f32)| {
                            let at = |x: i32| {
                                f32::from(
                                    grid.at(clamp(x, self.from.width), clamp(y, self.from.height)),
                                )
                            };
                            columns.iter().map(|&(x, wx)| wx * wy * at(x)).sum::<f32>()
                        };
                        *to = quantize(rows.iter().map(of_row).sum::<f32>() / 255.0);
                    }
                }
            },
        )
    }
}
