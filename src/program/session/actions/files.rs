//! Opening and saving documents, and placing pictures in documents. Floor 6. Not here: the formats
//! (`io`).

mod maps;

pub use maps::{add_maps, replace_maps};

use crate::document::view::UnwrapOptions;
use crate::document::{Content, Document, Highlights, Layer, Progress};
use crate::io::export::shape::{ShapeFiles, ShapeMap, ShapeOptions};
use crate::io::export::{ExportOptions, Output, OutputFile};
use crate::io::{Budget, Overwrite, Terms, save};
use crate::math::{Size, Vec2, srgb::Color};
use crate::session::actions::placing::{place, read_picture};
use crate::session::actions::{pictures, unwrapped};
use crate::session::replay::{actions, names};
use crate::session::{OpenDocument, PicturePart, Session, brushes, storage};
use crate::{Error, Result};
use std::path::{Path, PathBuf};
use std::sync::Arc;

names!(ShapeMap);

actions! {
    /// Paths are those of the user's own files.
    FileAction {
        /// An empty document, its bottom layer filled with a color where there is one.
        "new" New { width: u32, height: u32, background: Option<Color> }
        /// A document, or a picture as one.
        "open" Open { file: PathBuf }
        /// A document on the surface of these maps, conventions found.
        "open maps" OpenMaps { normal: Option<PathBuf>, depth: Option<PathBuf> }
        /// A picture as an image layer, pinned to the surface at a canvas point.
        "place" Place { file: PathBuf, at: Vec2 }
        /// The brushes of a file are added to the list.
        "import brush" ImportBrush { file: PathBuf }
        /// The current brush is added under a name.
        "keep brush" KeepBrush { name: String }
        /// One of the user's own, by its key, is removed.
        "remove brush" RemoveBrush { name: String }
        "save" Save { file: PathBuf }
        /// `bits`: per channel; if absent, the format's default.
        "export" Export { file: PathBuf, background: Option<Color>, quality: u8, bits: Option<u8> }
        /// The maps of the shape as files whose names begin with this one's, as PNG, or as EXR if
        /// it ends in that.
        "export maps" ExportMaps { file: PathBuf, maps: Vec<ShapeMap>, directx: bool, bits: u8 }
        /// The painting, or the layer that is seen alone, as it lies in the planes of the unwrapped
        /// surface, `scale` pixels per pixel of the plane, with so many bits per channel.
        "export unwrapped" ExportUnwrapped { file: PathBuf, scale: u32, bits: u8 }
        /// A picture of those planes becomes an image layer that lies on the surface.
        "import unwrapped" ImportUnwrapped { file: PathBuf }
        /// A picture that the selected layer is made of.
        "use" Use { part: PicturePart, file: PathBuf }
        /// A new surface from these maps: live layers bend over it.
        "replace maps" ReplaceMaps { normal: Option<PathBuf>, depth: Option<PathBuf> }
        /// A part of these maps, in front of all others.
        "add maps" AddMaps { normal: Option<PathBuf>, depth: Option<PathBuf> }
        "tab" Show { index: usize }
        /// Whether saved or not.
        "close" Close { index: usize }
    }
}

impl FileAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) -> Result<()> {
        session.drop_gesture();
        match self {
            FileAction::New { width, height, background } => {
                let size = Budget::of_this_machine().size(
                    Path::new("new"),
                    (*width).into(),
                    (*height).into(),
                )?;
                let name = session.new_title();
                session.add_document(OpenDocument::new(name, empty(size, *background), None));
            }
            FileAction::Open { file } => {
                let opened = storage::open(file)?;
                session.adopt(opened);
            }
            FileAction::OpenMaps { normal, depth } => {
                let opened =
                    storage::open_maps(&storage::maps_of(normal.as_deref(), depth.as_deref()))?;
                session.adopt(opened);
            }
            FileAction::Place { file, at } => {
                let (name, picture) = read_picture(file)?;
                place(session, &name, picture, *at);
                session.note_read(file);
            }
            FileAction::ImportBrush { file } => brushes::import(session, file)?,
            FileAction::KeepBrush { name } => brushes::keep(session, name)?,
            FileAction::RemoveBrush { name } => brushes::remove(session, name)?,
            FileAction::Save { file } => save_in_front(session, file)?,
            FileAction::Export { .. }
            | FileAction::ExportMaps { .. }
            | FileAction::ExportUnwrapped { .. } => self.export(session)?,
            FileAction::ImportUnwrapped { file } => {
                let (name, picture) = read_picture(file)?;
                unwrapped::place(session, &name, picture);
                session.note_read(file);
            }
            FileAction::Use { part, file } => {
                let read = pictures::read(*part, file)?;
                if let Some(open) = session.active_mut()
                    && let Some(layer) = open.active_layer
                {
                    pictures::put(open, layer, read);
                    open.reads.push(file.clone());
                }
            }
            FileAction::ReplaceMaps { normal, depth } => {
                let source = storage::maps_of(normal.as_deref(), depth.as_deref());
                let import = storage::import(&source)?;
                replace_maps(session, &source, import)?;
            }
            FileAction::AddMaps { normal, depth } => {
                let source = storage::maps_of(normal.as_deref(), depth.as_deref());
                let import = storage::import(&source)?;
                add_maps(session, &source, import)?;
            }
            FileAction::Show { index } => {
                session.tools.crop.area = None;
                session.current = (*index).min(session.open_documents.len().saturating_sub(1));
            }
            FileAction::Close { index } => session.close_document(*index),
        }
        Ok(())
    }

    /// Writes what an export is of.
    fn export(&self, session: &mut Session) -> Result<()> {
        let Some(open) = session.active() else { return Ok(()) };
        let terms = Terms::export(unless_forced(session), session.reads());
        match self {
            FileAction::Export { file, background, quality, bits } => {
                let (background, quality, bits) = (*background, *quality, *bits);
                let options =
                    ExportOptions { background, quality, bits, ..ExportOptions::default() };
                let notes = export(open.document(), file, &options, terms, &Progress::default())?;
                session.notes.extend(notes);
            }
            FileAction::ExportMaps { file, maps, directx, bits } => {
                let is_exr =
                    file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("exr"));
                let options = ShapeOptions { is_directx: *directx, is_16_bit: *bits > 8, is_exr };
                export_maps(open.document(), file, maps, options, &terms)?;
            }
            FileAction::ExportUnwrapped { file, scale, bits } => {
                let settings = session.unwrap_settings();
                let floats = (*bits > 8).then_some(Highlights::Clipped);
                let options = UnwrapOptions { scale: *scale, settings, floats };
                let document = open.drawn_document();
                unwrapped::export(&document, file, options, terms, &Progress::default())?;
            }
            _ => {}
        }
        Ok(())
    }
}

/// Saves the document in front.
fn save_in_front(session: &mut Session, file: &Path) -> Result<()> {
    let Some(open) = session.active() else { return Ok(()) };
    let document = open.document().clone();
    let terms = session.saving(file, unless_forced(session));
    // Nothing here cancels, so it is saved.
    let stamp = storage::save(file, &document, terms, &Progress::default())?;
    if let (Some(stamp), Some(open)) = (stamp, session.active_mut()) {
        open.mark_saved(document, file.to_path_buf(), stamp);
    }
    Ok(())
}

/// An empty document.
pub fn empty(size: Size, background: Option<Color>) -> Document {
    let fill = background.map(|color| Arc::new(Layer::new("Background", Content::Fill(color))));
    Document { layers: fill.into_iter().collect(), ..Document::empty(size) }
}

/// What saving and exporting may replace besides the document's own file: nothing, since nobody can
/// be asked, or all if the user said so beforehand.
pub(super) fn unless_forced(session: &Session) -> Overwrite {
    if session.replaces_unasked { Overwrite::Forced } else { Overwrite::Nothing }
}

/// The flattened picture as a file, or the document as a Photoshop file; none is written if
/// canceled. Returns what the format cannot hold.
pub fn export(
    document: &Document,
    file: &Path,
    options: &ExportOptions,
    terms: Terms,
    progress: &Progress,
) -> Result<Vec<String>> {
    let target = OutputFile::new(file, terms)?;
    if let Output::Picture(_) = Output::of(file)? {
        target.write_document(document, options, &Budget::of_this_machine(), progress)?;
        return Ok(Vec::new());
    }
    let Some(encoded) = save::encode(document, file, progress)? else { return Ok(Vec::new()) };
    target.replace(&encoded.bytes)?;
    Ok(encoded.notes.into_iter().map(|note| format!("{}: {note}", file.display())).collect())
}

/// The maps of a document's shape as files; returns their paths.
pub fn export_maps(
    document: &Document,
    file: &Path,
    maps: &[ShapeMap],
    options: ShapeOptions,
    terms: &Terms,
) -> Result<Vec<PathBuf>> {
    let no_shape =
        || Error::unsupported_file(file, "the document has no shape, so it has no maps to export");
    let surface = document.surface.as_ref().ok_or_else(no_shape)?;
    ShapeFiles::new(file, maps, options, terms)?.write(surface)
}
