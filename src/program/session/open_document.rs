//! An open document: its history, selection, file and view.
//! Floor 6.

mod drawn;
pub mod labels;
pub mod selected_layers;
mod target;

use super::exporting::ExportedFile;
use super::stored_preview::StoredPreview;
use super::view::CanvasView;
use crate::document::{Document, History, LayerId, MaskKind, Part};
use crate::io::replace::FileStamp;
use crate::math::{Size, Vec2};
use crate::paint::Selection;
use crate::surface::operator::UnwrapSettings;
use crate::surface::unwrap::PlaneLayout;
use selected_layers::SelectedLayers;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use target::EditTarget;

/// Steps that can be undone.
pub(super) const STEPS: usize = 200;

/// A step: its name, the resulting document, and the new selection.
pub struct Edit {
    /// What the history calls it.
    pub label: &'static str,
    /// The document after it.
    pub document: Document,
    /// Chosen from now on, the active one last; none: unchanged.
    pub select: Vec<LayerId>,
    /// What the user should know of it.
    pub note: Option<&'static str>,
}

/// An open document.
pub struct OpenDocument {
    /// Identifies it as long as the program runs.
    pub key: usize,
    /// The steps, and what was being edited before and after each.
    pub history: History<EditTarget>,
    /// The preview during a gesture: not a step yet.
    preview: Option<Preview>,
    /// The active one of the selected layers: what the brush paints on.
    pub active_layer: Option<LayerId>,
    pub(super) selected_layers: SelectedLayers,
    /// The part of the shape that is selected, by its id.
    pub part: Option<String>,
    /// Where it was opened from or saved to.
    pub file: Option<PathBuf>,
    /// Its name while it has no file.
    pub name: String,
    /// The stamp of that file when it was last read or written here.
    pub stamp: Option<FileStamp>,
    /// The files that it was made from: none of them may be written over.
    pub reads: Vec<PathBuf>,
    /// Whether the user was told what the format of that file cannot hold.
    pub knows_losses: bool,
    /// What it was exported to last.
    pub exported: Option<ExportedFile>,
    /// The document as the file holds it.
    saved: Document,
    /// `None` until the window has shown it.
    pub view: Option<CanvasView>,
    /// The surface is shown unwrapped, with these settings: the view is of the sheet of its planes.
    unwrapped: Option<UnwrapSettings>,
    /// The view of the picture while the sheet is shown, and of the sheet while the picture is.
    other_view: Option<CanvasView>,
    /// The brush and the eraser change the selected layer's mask, not the layer.
    pub on_mask: bool,
    /// The one layer that is shown, while it is alone.
    pub solo: Option<LayerId>,
    /// The brush and the eraser change the selection.
    pub quick_mask: bool,
    /// The selection that was dropped last.
    pub last_selection: Option<Arc<Selection>>,
    /// Where the last stroke ended, canvas px.
    pub last_end: Option<Vec2>,
    /// Where clone brushes copy from.
    pub clone_source: Option<CloneSource>,
    /// Why the last edit was not kept, until the user is told.
    pub refused: Option<String>,
    /// What became of parts in the last edit that the user would not expect, until it is told.
    pub noted: Option<String>,
    /// The picture that its file held of it, until the window shows it.
    pub stored_preview: StoredPreview,
    /// The selected strokes, by their positions in the layer.
    selected_strokes: Option<(LayerId, Vec<usize>)>,
}

/// Where clone brushes copy from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CloneSource {
    /// The point that was set, canvas px.
    pub at: Vec2,
    /// From a pixel to the one that the last stroke copied onto it, px.
    pub offset: Option<Vec2>,
}

struct Preview {
    label: String,
    document: Document,
    /// It is kept when something else is done.
    is_typed: bool,
}

impl OpenDocument {
    /// A document that was just opened, from a file if it has one.
    pub fn new(name: impl Into<String>, document: Document, file: Option<PathBuf>) -> Self {
        static NEXT: AtomicUsize = AtomicUsize::new(0);
        // What follows from it is there before anything is done with it, wherever it comes from.
        let document = document.reshaped();
        let part = nearest_part(&document);
        let active_layer = document.layers.last().map(|layer| layer.id);
        Self {
            key: NEXT.fetch_add(1, Ordering::Relaxed),
            saved: document.clone(),
            history: History::new(document, STEPS),
            preview: None,
            active_layer,
            selected_layers: SelectedLayers::default(),
            part,
            file,
            stamp: None,
            reads: Vec::new(),
            knows_losses: false,
            exported: None,
            name: name.into(),
            view: None,
            unwrapped: None,
            other_view: None,
            on_mask: false,
            quick_mask: false,
            last_selection: None,
            solo: None,
            last_end: None,
            clone_source: None,
            refused: None,
            noted: None,
            stored_preview: StoredPreview::default(),
            selected_strokes: None,
        }
    }

    /// The document after the last step.
    pub fn document(&self) -> &Document {
        self.history.present()
    }

    /// The document as shown: with the preview.
    pub fn shown_document(&self) -> &Document {
        self.preview.as_ref().map_or(self.history.present(), |preview| &preview.document)
    }

    /// How the surface is unwrapped, while it is shown so.
    pub fn unwrap_settings(&self) -> Option<UnwrapSettings> {
        self.unwrapped
    }

    /// Shows the surface unwrapped, or the picture again; each has a view of its own.
    pub fn show_unwrapped(&mut self, settings: Option<UnwrapSettings>) {
        if self.unwrapped.is_some() != settings.is_some() {
            std::mem::swap(&mut self.view, &mut self.other_view);
        }
        self.unwrapped = settings;
    }

    /// The sheet that is shown, if it is laid out already: see [`OpenDocument::layout`].
    pub fn cached_layout(&self) -> Option<Arc<PlaneLayout>> {
        self.document().surface.as_ref()?.cached_plane_layout(self.unwrapped?)
    }

    /// The sheet that is shown, laid out now if necessary.
    pub fn layout(&self) -> Option<Arc<PlaneLayout>> {
        self.document().surface.as_ref()?.plane_layout(self.unwrapped?)
    }

    /// The size of what the view shows: the picture, or the sheet.
    pub fn shown_size(&self) -> Size {
        self.cached_layout().map_or(self.document().size, |layout| layout.size())
    }

    /// The file's name, or the one given.
    pub fn title(&self) -> String {
        let name = self.file.as_ref().and_then(|file| file.file_name());
        name.map_or_else(|| self.name.clone(), |name| name.to_string_lossy().into_owned())
    }

    /// Whether there are unsaved changes.
    pub fn is_dirty(&self) -> bool {
        !is_same(&self.saved, self.document())
    }

    /// The document as its file holds it.
    pub fn saved_document(&self) -> &Document {
        &self.saved
    }

    /// It is now the same as in a file.
    pub fn mark_saved(&mut self, document: Document, file: PathBuf, stamp: FileStamp) {
        self.saved = document;
        // The file that it was saved to before is now like any other.
        self.reads.retain(|read| Some(read) != self.file.as_ref() && *read != file);
        self.reads.push(file.clone());
        (self.file, self.stamp) = (Some(file), Some(stamp));
    }

    /// Marks a document that did not come from its own file, such as a recovered one, as unsaved.
    pub fn mark_unsaved(&mut self) {
        self.saved = Document::empty(self.document().size);
    }

    /// What it holds is kept elsewhere: nothing of it is unsaved.
    pub(super) fn mark_kept(&mut self) {
        self.saved = self.document().clone();
    }

    /// Whether something is shown that is not a step yet.
    pub fn is_previewing(&self) -> bool {
        self.preview.is_some()
    }

    /// Shows a document as preview.
    pub fn show(&mut self, label: impl Into<String>, document: Document) {
        self.forget_preview();
        self.preview = Some(Preview { label: label.into(), document, is_typed: false });
    }

    /// Shows what is being typed. It becomes a step as soon as something else is done.
    pub fn show_typed(&mut self, label: impl Into<String>, document: Document) {
        self.preview = Some(Preview { label: label.into(), document, is_typed: true });
    }

    /// Keeps a document as a step; returns whether it did. What files cannot hold is refused:
    /// `refused` says why.
    pub fn commit(&mut self, label: impl Into<String>, document: Document) -> bool {
        self.preview = None;
        self.record_target();
        let mut is_kept = true;
        // The layers that parts are made from may have been painted on or bent.
        let document = document.reshaped();
        if !is_same(self.document(), &document) {
            match document.fits(Some(self.document())) {
                Ok(()) => {
                    self.noted = document.note_of_lost(Some(self.document()));
                    if document.active_selection.is_none() {
                        let let_go = self.document().active_selection.clone();
                        self.last_selection = let_go.or(self.last_selection.take());
                    }
                    let label = labels::label(label.into(), self.document(), &document);
                    self.history.commit(label, document, self.target());
                }
                Err(why) => {
                    is_kept = false;
                    self.refused = Some(format!("{why} Nothing was changed."));
                }
            }
        }
        self.repair();
        is_kept
    }

    /// Adds an edit as a step.
    pub fn take(&mut self, edit: Edit) {
        let Edit { label, document, select, note: _ } = edit;
        if self.commit(label, document) {
            self.select_layers(select);
        }
    }

    /// Adds the preview as a step.
    pub fn keep_preview(&mut self) {
        if let Some(Preview { label, document, .. }) = self.preview.take() {
            self.commit(label, document);
        }
    }

    /// Drops the preview; what was typed is kept.
    pub fn forget_preview(&mut self) {
        match &self.preview {
            Some(preview) if preview.is_typed => self.keep_preview(),
            _ => self.preview = None,
        }
    }

    /// The selected part as shown.
    pub fn selected_part(&self) -> Option<&Arc<Part>> {
        self.shown_document().parts.part(self.part.as_deref()?)
    }

    /// The selected strokes of the active layer that exist, in rising order.
    pub fn selected_strokes(&self) -> Vec<usize> {
        let Some((layer, selected_strokes)) =
            self.selected_strokes.as_ref().filter(|(layer, _)| Some(*layer) == self.active_layer)
        else {
            return Vec::new();
        };
        let count = self.shown_document().strokes(*layer).len();
        selected_strokes.iter().copied().filter(|&index| index < count).collect()
    }

    /// From a pixel to the one that a clone stroke that begins at `start` copies onto it; `None`
    /// before a source was set.
    pub fn begin_clone(&mut self, start: Vec2, aligned: bool) -> Option<Vec2> {
        let source = self.clone_source.as_mut()?;
        let kept = source.offset.filter(|_| aligned);
        source.offset = Some(kept.unwrap_or(source.at - start));
        source.offset
    }

    /// Chooses strokes of a layer.
    pub fn select_strokes(&mut self, layer: LayerId, mut strokes: Vec<usize>) {
        strokes.sort_unstable();
        strokes.dedup();
        self.selected_strokes = Some((layer, strokes));
    }

    /// Goes back (negative) or forward by steps, to what was selected before the last one undone,
    /// or after the last one redone.
    pub fn walk(&mut self, steps: i32) {
        self.preview = None;
        self.record_target();
        let mut target = None;
        for _ in 0..steps.unsigned_abs() {
            let gone = if steps < 0 { self.history.undo() } else { self.history.redo() };
            let Some(gone) = gone else { break };
            target = Some(gone.clone());
        }
        match target {
            Some(target) => self.aim(target),
            None => self.repair(),
        }
    }

    /// Selects the topmost layer if the selected one is gone.
    pub(super) fn repair(&mut self) {
        let has_mask = |layer: &Arc<crate::document::Layer>| {
            layer.mask.as_ref().is_some_and(|mask| matches!(mask.kind, MaskKind::File { .. }))
        };
        self.on_mask &=
            self.active_layer.and_then(|id| self.document().layer(id)).is_some_and(has_mask);
        let document = self.history.present();
        let is_there = |id: LayerId| document.layer(id).is_some();
        if !self.active_layer.is_some_and(is_there) {
            self.active_layer = document.layers.last().map(|layer| layer.id);
        }
        if !self.solo.is_some_and(is_there) {
            self.solo = None;
        }
        let is_part = |id: &String| document.parts.part(id).is_some();
        if !self.part.as_ref().is_some_and(is_part) {
            self.part = nearest_part(document);
        }
        if document.surface.is_none() {
            self.show_unwrapped(None);
        }
    }
}

/// The nearest part that has a form of its own, by its id.
fn nearest_part(document: &Document) -> Option<String> {
    document.parts.list.iter().rev().find(|part| part.on().is_none()).map(|part| part.id.clone())
}

/// Whether both are the same value: nothing was edited between them.
pub fn is_same(a: &Document, b: &Document) -> bool {
    let same_active = match (&a.active_selection, &b.active_selection) {
        (None, None) => true,
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        _ => false,
    };
    let same_kept = a.selections.len() == b.selections.len()
        && a.selections
            .iter()
            .zip(&b.selections)
            .all(|(a, b)| a.name == b.name && Arc::ptr_eq(&a.selection, &b.selection));
    let same_aids =
        a.guides == b.guides && a.assistants == b.assistants && a.symmetry == b.symmetry;
    let same_palette = Arc::ptr_eq(&a.palette, &b.palette) || a.palette == b.palette;
    same_active && same_kept && same_aids && same_palette && is_same_look(a, b)
}

/// Whether both show the same picture, whatever is selected.
pub fn is_same_look(a: &Document, b: &Document) -> bool {
    let same_layers = a.layers.len() == b.layers.len()
        && a.layers.iter().zip(&b.layers).all(|(a, b)| Arc::ptr_eq(a, b));
    let (old, new) = (&a.parts.list, &b.parts.list);
    let same_parts = old.len() == new.len() && old.iter().zip(new).all(|(a, b)| Arc::ptr_eq(a, b));
    same_layers && same_parts && a.profile == b.profile && a.scene().is_same(&b.scene())
}
