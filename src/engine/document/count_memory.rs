//! Counts the memory that documents take, and frees what they keep only for speed. Floor 4. Higher
//! floors, which know the machine, say how much that may be.

use super::{Document, MaskKind, MemoryCount};

impl MemoryCount {
    /// Counts what a document holds besides what was counted before. Unless `keeps`, it frees what
    /// it keeps for speed and was not counted before; that is computed again when needed.
    pub fn add(&mut self, document: &Document, keeps: bool) {
        if let Some(surface) = &document.surface {
            self.add_surface(surface, keeps);
        }
        let kept_by_name = document.selections.iter().map(|named| &named.selection);
        kept_by_name
            .chain(&document.active_selection)
            .for_each(|selection| self.add_selection(selection));
        for (_, layer) in document.walk() {
            if !self.is_new(layer) {
                continue;
            }
            if let Some(MaskKind::File { coverage, .. }) =
                layer.mask.as_ref().map(|mask| &mask.kind)
                && self.is_new(coverage)
            {
                self.add_painted(coverage.size().area() as u64);
            }
            layer.content.count(self, keeps);
            layer.cache.count(self, keeps);
        }
    }
}
