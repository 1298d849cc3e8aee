//! Undo: past documents, each with the name of the edit that made it. Floor 4. A document is a
//! value that shares what it did not change, so a step takes only the memory of what the edit
//! touched.
//!
//! What follows from a document is made before it becomes a step: whoever reads one, or goes back
//! to it, finds the surface that its parts and layers make.

use super::Document;

/// The present document, the past ones and the undone ones. With each edit goes a small value of
/// the caller's from before it and one from after it, such as what was selected: undo gives the
/// first back, redo the second.
pub struct History<T> {
    /// Oldest first; the edit of each led away from its document.
    past: Vec<HistoryStep<T>>,
    present: Document,
    /// Nearest last; the edit of each leads to its document.
    future: Vec<HistoryStep<T>>,
    /// The most steps that are kept.
    limit: usize,
}

/// What an edit did.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EditLabel {
    /// Its name, the same for all edits of its kind.
    pub name: String,
    /// The one layer that it was done to, if there is one.
    pub layer: Option<LabeledLayer>,
}

/// The layer that an edit was done to, by the name that it had then.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LabeledLayer {
    /// A layer by its name.
    Changed(String),
    /// Added to the layers, or deleted from them.
    Listed(String),
}

impl<S: Into<String>> From<S> for EditLabel {
    fn from(name: S) -> Self {
        Self { name: name.into(), layer: None }
    }
}

struct HistoryStep<T> {
    label: EditLabel,
    document: Document,
    before: T,
    /// `None` until [`History::set_target_after`].
    after: Option<T>,
}

impl<T> History<T> {
    /// Keeps at most `limit` steps; the oldest are forgotten.
    pub fn new(document: Document, limit: usize) -> Self {
        Self { past: Vec::new(), present: document.reshaped(), future: Vec::new(), limit }
    }

    /// The document as it is now.
    pub fn present(&self) -> &Document {
        &self.present
    }

    /// Makes an edited document the present one; undone documents are dropped.
    ///
    /// * `before`: what undo gives back.
    pub fn commit(&mut self, label: impl Into<EditLabel>, document: Document, before: T) {
        self.future.clear();
        let old = std::mem::replace(&mut self.present, document.reshaped());
        self.past.push(HistoryStep { label: label.into(), document: old, before, after: None });
        self.keep(self.limit);
    }

    /// Keeps at most `limit` past steps from now on; the oldest are forgotten.
    pub fn keep(&mut self, limit: usize) {
        self.limit = limit;
        let excess = self.past.len().saturating_sub(limit);
        self.past.drain(..excess);
    }

    /// Whether it was said what redo gives back for the last edit.
    pub fn has_target_after(&self) -> bool {
        self.past.last().is_none_or(|step| step.after.is_some())
    }

    /// Says what redo gives back for the last edit, unless that was said before.
    pub fn set_target_after(&mut self, after: T) {
        if let Some(step) = self.past.last_mut() {
            step.after.get_or_insert(after);
        }
    }

    /// The other documents that it holds, the nearest steps first.
    pub fn others(&self) -> impl Iterator<Item = &Document> {
        let back = |steps: &'_ [HistoryStep<T>], i: usize| steps.len().checked_sub(i + 1);
        (0..self.past.len().max(self.future.len())).flat_map(move |i| {
            let past = back(&self.past, i).map(|at| &self.past[at].document);
            past.into_iter().chain(back(&self.future, i).map(|at| &self.future[at].document))
        })
    }

    /// Goes back by one edit and returns what was given from before it; `None` at the beginning.
    pub fn undo(&mut self) -> Option<&T> {
        let mut step = self.past.pop()?;
        std::mem::swap(&mut self.present, &mut step.document);
        self.future.push(step);
        self.future.last().map(|step| &step.before)
    }

    /// Goes forward again by one edit and returns what was given from after it, or from before if
    /// that was never set; `None` at the end.
    pub fn redo(&mut self) -> Option<&T> {
        let mut step = self.future.pop()?;
        std::mem::swap(&mut self.present, &mut step.document);
        self.past.push(step);
        self.past.last().map(|step| step.after.as_ref().unwrap_or(&step.before))
    }

    /// The names of the edits that were made, oldest first.
    pub fn past_names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.past_labels().map(|label| label.name.as_str())
    }

    /// Every edit that was made, oldest first.
    pub fn past_labels(&self) -> impl ExactSizeIterator<Item = &EditLabel> {
        self.past.iter().map(|step| &step.label)
    }

    /// Every edit that was undone, the next to redo first.
    pub fn future_labels(&self) -> impl ExactSizeIterator<Item = &EditLabel> {
        self.future.iter().rev().map(|step| &step.label)
    }

    /// The edit that undo would revert.
    pub fn undo_label(&self) -> Option<&str> {
        self.past.last().map(|step| step.label.name.as_str())
    }

    /// The edit that redo would repeat.
    pub fn redo_name(&self) -> Option<&str> {
        self.future.last().map(|step| step.label.name.as_str())
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
        let layer = Layer::new(
            "paint",
            Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles }),
        );
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
        history.commit("Erase", erased.unwrap(), ());
        assert_eq!(tiles(history.present()).changed_tiles(tiles(&first)), [TileAt::new(0, 0)]);
        assert!(history.undo().is_some());
        assert_eq!(history.redo_name(), Some("Erase"));
        assert!(tiles(history.present()).ptr_eq(tiles(&first)));
        assert!(Arc::ptr_eq(&history.present().layers[0], &first.layers[0]));
    }

    #[test]
    fn undo_and_redo_walk_the_edits_by_name() {
        let mut history = History::new(painted(), 10);
        for label in ["One", "Two", "Three"] {
            let mut next = history.present().clone();
            next.layers.push(Arc::new(Layer::new(label, Content::Fill(Color::BLACK))));
            history.commit(label, next, format!("before {label}"));
        }
        assert!(!history.has_target_after());
        history.set_target_after("after Three".into());
        assert!(history.has_target_after());
        let two = [history.undo().cloned(), history.undo().cloned()];
        assert_eq!(two, [Some("before Three".into()), Some("before Two".into())]);
        assert_eq!((history.undo_label(), history.redo_name()), (Some("One"), Some("Two")));
        assert_eq!(history.redo(), Some(&"before Two".into()), "nothing was said about after it");
        assert_eq!(history.redo(), Some(&"after Three".into()));
        history.set_target_after("much later".into());
        assert_eq!((history.undo().is_some(), history.redo()), (true, Some(&"after Three".into())));
        assert_eq!(history.present().layers.len(), 4);
        history.undo();
        history.commit("Other", painted(), "before Other".into());
        assert_eq!(history.redo(), None, "a new edit forgets what was undone");
    }

    #[test]
    fn only_so_many_steps_are_kept() {
        let mut history = History::new(painted(), 2);
        (0..5).for_each(|i| history.commit(i.to_string(), painted(), i));
        assert_eq!(
            [history.undo().copied(), history.undo().copied(), history.undo().copied()],
            [Some(4), Some(3), None]
        );
    }
}
