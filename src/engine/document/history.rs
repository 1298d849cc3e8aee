//! Undo: past documents, each with the name of the edit that made it. Floor 4. A document is a value that shares what
//! it did not change, so a step takes only the memory of what the edit touched.

use super::Document;

/// The present document, the past ones and the undone ones.
pub struct History {
    /// Oldest first; the label is of the edit that led away from it.
    past: Vec<HistoryStep>,
    present: Document,
    /// Nearest last; the label is of the edit that leads to it.
    future: Vec<HistoryStep>,
    /// The most steps that are kept.
    limit: usize,
}

struct HistoryStep {
    label: String,
    document: Document,
}

impl History {
    /// Keeps at most `limit` steps; the oldest are forgotten.
    pub fn new(document: Document, limit: usize) -> Self {
        Self { past: Vec::new(), present: document, future: Vec::new(), limit }
    }
    /// The document as it is now.
    pub fn present(&self) -> &Document {
        &self.present
    }
    /// Makes an edited document the present one; undone documents are dropped.
    pub fn commit(&mut self, label: impl Into<String>, document: Document) {
        self.future.clear();
        let before = std::mem::replace(&mut self.present, document);
        self.past.push(HistoryStep { label: label.into(), document: before });
        let excess = self.past.len().saturating_sub(self.limit);
        self.past.drain(..excess);
    }
    /// The other documents that it holds, the nearest steps first.
    pub fn others(&self) -> impl Iterator<Item = &Document> {
        let back = |steps: &'_ [HistoryStep], i: usize| steps.len().checked_sub(i + 1);
        (0..self.past.len().max(self.future.len())).flat_map(move |i| {
            let past = back(&self.past, i).map(|at| &self.past[at].document);
            past.into_iter().chain(back(&self.future, i).map(|at| &self.future[at].document))
        })
    }
    /// Goes back by one edit and returns its label; `None` at the beginning.
    pub fn undo(&mut self) -> Option<&str> {
        let HistoryStep { label, document } = self.past.pop()?;
        let document = std::mem::replace(&mut self.present, document);
        self.future.push(HistoryStep { label, document });
        self.undone()
    }
    /// Goes forward again by one edit and returns its label; `None` at the end.
    pub fn redo(&mut self) -> Option<&str> {
        let HistoryStep { label, document } = self.future.pop()?;
        let document = std::mem::replace(&mut self.present, document);
        self.past.push(HistoryStep { label, document });
        self.done()
    }
    /// Every edit that was made, oldest first.
    pub fn past(&self) -> impl ExactSizeIterator<Item = &str> {
        self.past.iter().map(|step| step.label.as_str())
    }
    /// Every edit that was undone, the next to redo first.
    pub fn future(&self) -> impl ExactSizeIterator<Item = &str> {
        self.future.iter().rev().map(|step| step.label.as_str())
    }
    /// The edit that undo would revert.
    pub fn done(&self) -> Option<&str> {
        self.past.last().map(|step| step.label.as_str())
    }
    /// The edit that redo would repeat.
    pub fn undone(&self) -> Option<&str> {
        self.future.last().map(|step| step.label.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Content, Layer, PixelLayer};
    use crate::math::{Size, srgb::Color};
    use crate::raster::{TileAt, TileGrid};
    use std::sync::Arc;

    fn painted() -> Document {
        let tiles = TileGrid::from_straight_rgba(&[255; 4 * 128 * 64], 128, 64, 0, 0);
        let layer = Layer::new("paint", Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles }));
        Document { layers: vec![Arc::new(layer)], ..Document::empty(Size::new(128, 64)) }
    }
    fn tiles(document: &Document) -> &TileGrid {
        match &document.layers[0].content {
            Content::Pixels(pixels) => &pixels.tiles,
            _ => panic!("a paint layer"),
        }
    }

    #[test]
    fn undo_returns_the_very_same_tiles() {
        let first = painted();
        let mut history = History::new(first.clone(), 10);
        let erased = first.with_layer(first.layers[0].id, |layer| {
            if let Content::Pixels(pixels) = &mut layer.content {
                pixels.tiles.set(TileAt::new(0, 0), None);
            }
        });
        history.commit("Erase", erased.unwrap());
        assert_eq!(tiles(history.present()).changed_tiles(tiles(&first)), [TileAt::new(0, 0)]);
        assert_eq!(history.undo(), Some("Erase"));
        assert!(tiles(history.present()).ptr_eq(tiles(&first)));
        assert!(Arc::ptr_eq(&history.present().layers[0], &first.layers[0]));
    }
    #[test]
    fn undo_and_redo_walk_the_edits_by_name() {
        let mut history = History::new(painted(), 10);
        for label in ["One", "Two", "Three"] {
            let mut next = history.present().clone();
            next.layers.push(Arc::new(Layer::new(label, Content::Fill(Color::BLACK))));
            history.commit(label, next);
        }
        assert_eq!((history.undo().map(String::from), history.undo()), (Some("Three".into()), Some("Two")));
        assert_eq!((history.done(), history.undone()), (Some("One"), Some("Two")));
        assert_eq!(history.redo(), Some("Two"));
        assert_eq!(history.present().layers.len(), 3);
        history.commit("Other", painted());
        assert_eq!(history.redo(), None, "a new edit forgets what was undone");
    }
    #[test]
    fn only_so_many_steps_are_kept() {
        let mut history = History::new(painted(), 2);
        (0..5).for_each(|i| history.commit(i.to_string(), painted()));
        assert_eq!(
            (history.undo().map(String::from), history.undo().map(String::from)),
            (Some("4".into()), Some("3".into()))
        );
        assert_eq!(history.undo(), None);
    }
}
