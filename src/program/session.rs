//! Floor 6: the program without its window. It holds the open documents and the current tool
//! settings, and performs everything as [`Action`]s, so that a replay file, a test and the window
//! behave the same.

pub mod actions;
pub mod autosave;
mod balls;
pub mod brushes;
pub mod drawing;
pub mod exporting;
mod last_actions;
pub mod memory;
mod open_document;
mod palettes;
mod path;
mod picture_part;
pub mod property;
pub mod replay;
pub mod script;
pub mod storage;
pub mod stored_preview;
pub mod swatch;
pub mod view;

pub use actions::Action;
pub use actions::clipboard::Copied;
pub use autosave::Autosave;
pub use exporting::{ExportSettings, ExportSize, ExportedFile};
pub use last_actions::last_actions;
pub use open_document::{CloneSource, Edit, OpenDocument, is_same, is_same_look};
pub use open_document::{labels, selected_layers};
pub use palettes::PaletteShelf;
pub use path::{LayerPath, LayerPaths};
pub use picture_part::PicturePart;
pub use property::Property;
pub use view::CanvasView;

use crate::Result;
use crate::document::{Document, Layer, LayerId, SymmetrySettings};
use crate::io::fs::Disk;
use crate::io::recipe::{BrushPreset, presets};
use crate::io::replace::is_same_file;
use crate::io::{Overwrite, Terms};
use crate::math::{Vec2, named::current_name, srgb::Color};
use crate::surface::Operator;
use crate::surface::operator::UnwrapSettings;
use crate::tools::snap::{SnapLines, ViewAids};
use crate::tools::{Gesture, ToolKind, ToolSettings};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use storage::OpenedFile;

/// The number of recent colors.
const RECENT: usize = 16;

/// Everything except the window.
pub struct Session {
    /// The open documents, in the order of their tabs.
    pub open_documents: Vec<OpenDocument>,
    /// The index of the one in front.
    pub current: usize,
    /// The current tool.
    pub tool: ToolKind,
    /// The available brushes: the program's own, then imported ones; each key is unique.
    pub presets: Vec<BrushPreset>,
    /// The key of the current brush among them.
    pub preset: String,
    /// The settings of the tools, the current brush among them.
    pub tools: ToolSettings,
    /// The last colors painted with, newest first.
    pub recent_colors: Vec<Color>,
    /// The user's own palettes.
    pub palettes: PaletteShelf,
    /// The outline of the selection is not drawn.
    pub hides_selection: bool,
    /// The picture is shown in grays of its luminance.
    pub shows_values: bool,
    /// Whether the picture is shown as it will be printed, where a profile for that is known.
    pub shows_proof: bool,
    /// Whether colors that cannot be printed are marked there.
    pub marks_gamut: bool,
    /// Whether the picture is shown as the document's file holds it.
    pub shows_saved: bool,
    /// Balls that are painted in documents of their own.
    balls: Vec<balls::BallLink>,
    /// The text that the text tool was last pressed on.
    pub writing: Option<Writing>,
    /// What was copied last.
    pub copied: Option<Copied>,
    /// A view of the surface shown over the picture, by its name.
    pub overlay: Option<String>,
    /// How opaque that view is.
    pub overlay_opacity: f32,
    gesture: Option<Box<dyn Gesture>>,
    /// Whether that draws a stroke, and where its end is.
    draws_stroke: bool,
    last_pen: Option<Vec2>,
    /// The recovery logs of the open documents, where they are kept.
    pub autosave: Option<Autosave>,
    /// The folder of the user's own brushes, if there is one.
    pub brush_folder: Option<PathBuf>,
    /// The files of the current brush and of those in the list.
    brush_files: Vec<PathBuf>,
    /// Whether saving and exporting replace existing files, as the user said beforehand.
    pub replaces_unasked: bool,
    /// Sentences for the user, not yet shown.
    pub notes: Vec<String>,
    /// The same, of little importance, which disappear by themselves.
    pub said: Vec<String>,
    untitled: usize,
    /// The most steps of a document that are kept.
    steps: usize,
}

/// A place in a text where the hand wants to type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Writing {
    /// The layer of the text.
    pub layer: LayerId,
    /// The bytes of the text before that place; `None`: all of it is to be replaced.
    pub byte: Option<usize>,
    /// Counts the presses.
    pub turn: u32,
}

impl Default for Session {
    fn default() -> Self {
        let preset = "soft-round";
        let presets: Vec<BrushPreset> = presets().collect();
        let brush =
            presets.iter().find(|known| known.key == preset).map(|known| known.brush.clone());
        Self {
            open_documents: Vec::new(),
            current: 0,
            tool: ToolKind::default(),
            presets,
            preset: preset.into(),
            tools: ToolSettings::with_brush(brush.unwrap_or_default()),
            recent_colors: Vec::new(),
            palettes: PaletteShelf::default(),
            hides_selection: false,
            shows_values: false,
            shows_proof: false,
            marks_gamut: false,
            shows_saved: false,
            balls: Vec::new(),
            writing: None,
            copied: None,
            overlay: None,
            overlay_opacity: 0.85,
            gesture: None,
            draws_stroke: false,
            last_pen: None,
            autosave: None,
            brush_folder: None,
            brush_files: Vec::new(),
            replaces_unasked: false,
            notes: Vec::new(),
            said: Vec::new(),
            untitled: 0,
            steps: open_document::STEPS,
        }
    }
}

impl Session {
    /// The same with other settings of what is shown and snapped to.
    pub fn with_aids(self, aids: ViewAids) -> Self {
        Self { tools: ToolSettings { aids, ..self.tools }, ..self }
    }

    /// The document in front.
    pub fn active(&self) -> Option<&OpenDocument> {
        self.open_documents.get(self.current)
    }

    /// The document in front, to be changed.
    pub fn active_mut(&mut self) -> Option<&mut OpenDocument> {
        self.open_documents.get_mut(self.current)
    }

    /// The document in front as shown, with the preview.
    pub fn shown_document(&self) -> Option<&Document> {
        self.active().map(OpenDocument::shown_document)
    }

    /// How strokes in the document in front repeat.
    pub fn symmetry(&self) -> SymmetrySettings {
        self.shown_document().map_or_else(Default::default, |document| document.symmetry)
    }

    /// The selected layer as shown.
    pub fn layer(&self) -> Option<&Arc<Layer>> {
        let open = self.active()?;
        open.shown_document().layer(open.active_layer?)
    }

    /// The path of the selected layer.
    pub fn layer_path(&self) -> Option<LayerPath> {
        let open = self.active()?;
        LayerPath::of(open.document(), open.active_layer?)
    }

    /// The paths of the selected layers, without those in a group that is selected.
    pub fn layer_paths(&self) -> LayerPaths {
        let selected =
            self.active().map(|open| LayerPaths::of(open.document(), &open.outermost_selected()));
        selected.unwrap_or_default()
    }

    /// How surfaces are unwrapped: as the current operator says, else by default.
    pub fn unwrap_settings(&self) -> UnwrapSettings {
        self.tools.operator.unwrapping().unwrap_or(UnwrapSettings { amount: 1.0, smooth_px: 0.0 })
    }

    /// Whether a tool is between press and release.
    pub fn is_drawing(&self) -> bool {
        self.gesture.is_some()
    }

    /// The lines that what is dragged snapped to.
    pub fn snap_lines(&self) -> SnapLines {
        self.gesture.as_ref().map_or_else(SnapLines::default, |gesture| gesture.snap_lines())
    }

    /// The color that is taken when the pen lifts.
    pub fn picked_color(&self) -> Option<Color> {
        self.gesture.as_ref().and_then(|gesture| gesture.picked_color())
    }

    /// Keeps at most so many steps of each document, those that are opened later included.
    pub fn keep_steps(&mut self, steps: usize) {
        if std::mem::replace(&mut self.steps, steps) != steps {
            self.open_documents.iter_mut().for_each(|open| open.history.keep(steps));
        }
    }

    /// Whether a guide is being dragged.
    pub fn is_dragging_guide(&self) -> bool {
        self.gesture.as_ref().is_some_and(|gesture| gesture.is_guide())
    }

    /// Adds an open document, in front of the others.
    pub fn add_document(&mut self, mut open: OpenDocument) {
        self.drop_gesture();
        open.history.keep(self.steps);
        self.open_documents.push(open);
        self.current = self.open_documents.len() - 1;
    }

    /// A document that was opened elsewhere, perhaps on another thread.
    pub fn adopt(&mut self, opened: OpenedFile) {
        let OpenedFile { mut open, notes, .. } = opened;
        if open.file.is_none() && open.name.is_empty() {
            open.name = self.new_title();
        }
        self.add_document(open);
        self.notes.extend(notes);
    }

    /// A file was put into the document in front.
    pub fn note_read(&mut self, file: &Path) {
        if let Some(open) = self.active_mut() {
            open.reads.push(file.into());
        }
    }

    /// Every file that an open document or a brush was made from: none of them may be written over.
    pub fn reads(&self) -> Vec<PathBuf> {
        self.open_documents
            .iter()
            .flat_map(|open| &open.reads)
            .chain(&self.brush_files)
            .cloned()
            .collect()
    }

    /// What saving the document in front to a file may replace. `elsewhere`: for a file that is not
    /// its own.
    pub fn saving(&self, file: &Path, elsewhere: Overwrite) -> Terms {
        let own = self.active().and_then(|open| Some((open, open.file.as_deref()?)));
        let own = own.filter(|(_, own)| is_same_file(&Disk, own, file));
        let mut reads = self.reads();
        let over = match own {
            Some((open, own)) => {
                reads.retain(|read| !is_same_file(&Disk, read, own));
                // A document that was incomplete when opened must not replace its file without
                // asking.
                if elsewhere == Overwrite::Forced {
                    elsewhere
                } else {
                    open.stamp.map_or(Overwrite::Nothing, Overwrite::This)
                }
            }
            None => elsewhere,
        };
        Terms { reads, ..over.into() }
    }

    /// Closes the document at an index.
    pub fn close_document(&mut self, index: usize) {
        if index < self.open_documents.len() {
            self.open_documents.remove(index);
            if self.current > index || self.current >= self.open_documents.len() {
                self.current = self.current.saturating_sub(1);
            }
        }
    }

    /// A name for a document that has none.
    pub fn new_title(&mut self) -> String {
        self.untitled += 1;
        format!("Untitled {}", self.untitled)
    }

    /// Selects a brush by its key. A brush made for an operator selects it too; others leave the
    /// operator as it is.
    pub fn take_preset(&mut self, key: &str) {
        let key = current_name(key);
        let Some(preset) = self.presets.iter().find(|preset| preset.key == key) else { return };
        if preset.operator != Operator::None {
            self.tools.operator = preset.operator;
        }
        self.tools.brush = preset.brush.clone();
        self.preset = preset.key.clone();
        self.tool = ToolKind::Brush;
    }

    /// Tells the user something of little importance.
    pub fn say(&mut self, sentence: &str) {
        self.said.push(sentence.into());
    }

    /// Drops the current gesture and its preview.
    pub fn drop_gesture(&mut self) {
        if self.gesture.take().is_some()
            && let Some(open) = self.active_mut()
        {
            open.forget_preview();
        }
    }

    /// Moves the current color to the front of the recent ones.
    fn remember_color(&mut self) {
        let color = self.tools.color;
        self.recent_colors.retain(|known| *known != color);
        self.recent_colors.insert(0, color);
        self.recent_colors.truncate(RECENT);
    }

    /// The last steps are over: what is selected now is what redo goes back to. Called before
    /// whatever may choose.
    fn record_targets(&mut self) {
        self.open_documents.iter_mut().for_each(OpenDocument::record_target);
    }

    /// Notes why edits were not kept, and what they did to parts.
    fn tell_refusals(&mut self) {
        let take_notes = |open: &mut OpenDocument| [open.refused.take(), open.noted.take()];
        self.notes.extend(self.open_documents.iter_mut().flat_map(take_notes).flatten());
    }

    /// Updates the recovery logs to the documents; called after whatever may have changed them.
    pub fn keep(&mut self) {
        self.tell_refusals();
        let trouble = self
            .autosave
            .as_mut()
            .and_then(|autosave| autosave.follow(&self.open_documents, self.tool));
        self.notes.extend(trouble);
    }

    /// Called when the program ends: see [`Autosave::close`].
    pub fn close(&mut self) {
        if let Some(autosave) = &mut self.autosave {
            autosave.close(&self.open_documents, self.tool);
        }
    }

    /// Performs the actions of a replay file line by line; stops with an error at the first that
    /// fails.
    pub fn replay(&mut self, file: &Path, text: &str) -> Result<()> {
        self.replay_with_progress(file, text, |_| Ok(()))
    }

    /// The same, and calls back after each line.
    pub fn replay_with_progress(
        &mut self,
        file: &Path,
        text: &str,
        mut tell: impl FnMut(&mut Self) -> Result<()>,
    ) -> Result<()> {
        replay::lines::<Action>(file, text)?.iter().try_for_each(|action| {
            action.apply(self)?;
            tell(self)
        })
    }
}

#[cfg(test)]
mod tests;
