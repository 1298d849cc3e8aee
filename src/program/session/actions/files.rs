//! Opening and saving documents, and placing pictures in documents. Floor 6. Not here: the formats
//! (`io`).

mod maps;

pub use maps::{add_maps, replace_maps};

use crate::document::view::UnwrapOptions;
use crate::document::{Content, Document, Highlights, Layer, Progress};
use crate::io::export::shape::{ShapeFiles, ShapeMap, ShapeOptions};
use crate::io::export::{Output, OutputFile};
use crate::io::fs::Disk;
use crate::io::replace::replace;
use crate::io::{Budget, Overwrite, Terms, line_svg, save};
use crate::math::{ColorProfile, Size, Vec2, srgb::Color};
use crate::session::actions::placing::{place, read_picture};
use crate::session::actions::{pictures, unwrapped};
use crate::session::exporting::{ExportSettings, ExportSize, ExportedFile};
use crate::session::replay::{ReplayValue, actions, names, record};
use crate::session::{OpenDocument, PicturePart, Session, brushes, storage};
use crate::{Error, Result};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;

names!(ShapeMap);
record!(ExportSettings { background, quality, bits, size, selection, profile });

/// `{ "scale": factor }` or `{ "width": pixels }`.
impl ReplayValue for ExportSize {
    fn to_value(&self) -> Value {
        match self {
            ExportSize::Scale(factor) => json!({ "scale": factor.to_value() }),
            ExportSize::Width(width) => json!({ "width": width }),
        }
    }

    fn read(value: &Value) -> Result<Self, String> {
        let read = match (value.get("scale"), value.get("width")) {
            (Some(factor), None) => f32::read(factor).map(ExportSize::Scale)?,
            (None, Some(width)) => u32::read(width).map(ExportSize::Width)?,
            _ => return Err("must be an object of “scale” or of “width”".into()),
        };
        let is_known = match read {
            ExportSize::Scale(factor) => ExportSize::SCALE.contains(&factor),
            ExportSize::Width(width) => width > 0,
        };
        is_known.then_some(read).ok_or_else(|| "must be a scale from 0.01 to 16, or a width".into())
    }
}

actions! {
    /// Paths are those of the user's own files.
    FileAction {
        /// An empty document, its bottom layer filled with a color where there is one.
        /// `profile`: if absent, sRGB.
        "new" New {
            width: u32, height: u32, background: Option<Color>, profile: Option<ColorProfile>,
        }
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
        /// `bits`: per channel; if absent, the format's default. `size`: if absent, that of the
        /// canvas. `selection`: only the box around it. `profile`: what colors are converted to; if
        /// absent, the document's.
        "export" Export {
            file: PathBuf, background: Option<Color>, quality: u8, bits: Option<u8>, size: Option<ExportSize>,
            selection: Option<bool>, profile: Option<ColorProfile>,
        }
        /// The document in front once more, to the same file, which is replaced.
        "export again" ExportAgain {}
        /// The maps of the shape as files whose names begin with this one's, as PNG, or as EXR if
        /// it ends in that.
        "export maps" ExportMaps { file: PathBuf, maps: Vec<ShapeMap>, directx: bool, bits: u8 }
        /// The painting, or the layer that is seen alone, as it lies in the planes of the unwrapped
        /// surface, `scale` pixels per pixel of the plane, with so many bits per channel.
        "export unwrapped" ExportUnwrapped { file: PathBuf, scale: u32, bits: u8 }
        /// The lines of the selected layer, or of the lowest layer of form lines, as paths of an SVG.
        "export lines" ExportLines { file: PathBuf }
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
    /// Whether it writes a file.
    pub(super) fn has_output(&self) -> bool {
        matches!(
            self,
            FileAction::Save { .. }
                | FileAction::Export { .. }
                | FileAction::ExportAgain {}
                | FileAction::ExportLines { .. }
                | FileAction::ExportMaps { .. }
                | FileAction::ExportUnwrapped { .. }
        )
    }

    /// The files that it names.
    pub(super) fn files_mut(&mut self) -> Vec<&mut PathBuf> {
        match self {
            FileAction::Open { file }
            | FileAction::Place { file, .. }
            | FileAction::ImportBrush { file }
            | FileAction::Save { file }
            | FileAction::Export { file, .. }
            | FileAction::ExportLines { file }
            | FileAction::ExportMaps { file, .. }
            | FileAction::ExportUnwrapped { file, .. }
            | FileAction::ImportUnwrapped { file }
            | FileAction::Use { file, .. } => vec![file],
            FileAction::OpenMaps { normal, depth }
            | FileAction::ReplaceMaps { normal, depth }
            | FileAction::AddMaps { normal, depth } => normal.iter_mut().chain(depth).collect(),
            FileAction::New { .. }
            | FileAction::KeepBrush { .. }
            | FileAction::RemoveBrush { .. }
            | FileAction::ExportAgain {}
            | FileAction::Show { .. }
            | FileAction::Close { .. } => Vec::new(),
        }
    }

    /// Performs it.
    pub fn apply(&self, session: &mut Session) -> Result<()> {
        session.drop_gesture();
        match self {
            FileAction::New { width, height, background, profile } => {
                let size = Budget::of_this_machine().size(
                    Path::new("new"),
                    (*width).into(),
                    (*height).into(),
                )?;
                let name = session.new_title();
                let profile = profile.unwrap_or_default();
                let document = Document { profile, ..empty(size, *background) };
                session.add_document(OpenDocument::new(name, document, None));
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
                place(session, &name, picture, ColorProfile::Srgb, *at);
                session.note_read(file);
            }
            FileAction::ImportBrush { file } => brushes::import(session, file)?,
            FileAction::KeepBrush { name } => brushes::keep(session, name)?,
            FileAction::RemoveBrush { name } => brushes::remove(session, name)?,
            FileAction::Save { file } => save_in_front(session, file)?,
            FileAction::ExportAgain {} => export_again(session)?,
            FileAction::ExportLines { file } => {
                export_lines(session, file, unless_forced(session))?
            }
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
            FileAction::Export { file, background, quality, bits, size, selection, profile } => {
                let settings = ExportSettings {
                    background: *background,
                    quality: *quality,
                    bits: *bits,
                    size: size.unwrap_or(ExportSettings::default().size),
                    selection: selection.unwrap_or(false),
                    profile: *profile,
                };
                export_in_front(session, ExportedFile { file: file.clone(), settings }, terms)?;
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

/// Exports the document in front, which remembers how.
fn export_in_front(session: &mut Session, to: ExportedFile, terms: Terms) -> Result<()> {
    let Some(open) = session.active_mut() else { return Ok(()) };
    let (document, progress) = (open.document().clone(), Progress::default());
    let notes = export(&document, &to.file, &to.settings, terms, &progress)?;
    open.exported = Some(to);
    session.notes.extend(notes);
    Ok(())
}

fn export_again(session: &mut Session) -> Result<()> {
    let Some(to) = session.active().and_then(|open| open.exported.clone()) else {
        session.say("The document was not exported yet.");
        return Ok(());
    };
    // It was written here before.
    let terms = Terms::export(Overwrite::Anything, session.reads());
    export_in_front(session, to, terms)
}

/// Writes the lines of the form of the document in front as an SVG; it takes no time.
pub fn export_lines(session: &Session, file: &Path, over: Overwrite) -> Result<()> {
    let Some(open) = session.active() else { return Ok(()) };
    let document = open.document();
    if document.surface.is_none() {
        let reason = "the document has no shape whose lines there could be";
        return Err(Error::unsupported_file(file, reason));
    }
    let selected = open.active_layer.and_then(|id| document.layer(id));
    let drawing = match selected.map(|layer| &layer.content) {
        Some(Content::FormDrawing(live)) if live.params().hatching().is_none() => {
            live.params().clone()
        }
        _ => line_svg::drawing_of(document),
    };
    let terms = Terms::export(over, session.reads());
    let svg = line_svg::write(document, &drawing);
    replace(&Disk, file, svg.as_bytes(), &terms, &Progress::default()).map(drop)
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
    settings: &ExportSettings,
    terms: Terms,
    progress: &Progress,
) -> Result<Vec<String>> {
    let (target, budget) = (OutputFile::new(file, terms)?, Budget::of_this_machine());
    let (document, options) = settings.prepare(document, file, &budget)?;
    if let Output::Picture(_) = Output::of(file)? {
        target.write_document(&document, &options, &budget, progress)?;
        return Ok(Vec::new());
    }
    let Some(encoded) = save::encode(&document, file, progress)? else { return Ok(Vec::new()) };
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
