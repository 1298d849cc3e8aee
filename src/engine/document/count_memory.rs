//! Counts what documents take of memory, and lets go of what they keep for speed alone. Floor 4. How much that may be
//! is told by higher floors, which know the machine.

use super::{Document, MaskKind, MemoryCount};

impl MemoryCount {
    /// Counts what a document holds beside what was counted before; `keeps`: otherwise it lets go of what it keeps for
    /// speed and nobody before it did. It is computed again when it is needed.
    pub fn add(&mut self, document: &Document, keeps: bool) {
        if let Some(surface) = &document.surface {
            self.add_surface(surface, keeps);
        }
        let kept_by_name = document.selections.iter().map(|named| &named.selection);
        kept_by_name.chain(&document.active_selection).for_each(|selection| self.add_selection(selection));
        for (_, layer) in document.walk() {
            if !self.is_new(layer) {
                continue;
            }
            if let Some(MaskKind::File { coverage, .. }) = layer.mask.as_ref().map(|mask| &mask.kind)
                && self.is_new(coverage)
            {
                self.add_painted(coverage.size().area() as u64);
            }
            layer.content.count(self, keeps);
        }
    }
}
