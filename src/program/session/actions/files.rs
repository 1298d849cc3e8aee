//! Opening and saving documents, and placing pictures in documents. Floor 6. The formats are in `io`.

use crate::document::parts::PartMaps;
use crate::document::view::UnwrapOptions;
use crate::document::{Content, Document, Highlights, Layer, Live, Progress, SurfaceSource};
use crate::io::export::shape::{ShapeFiles, ShapeMap, ShapeOptions};
use crate::io::export::{ExportOptions, Output, OutputFile};
use crate::io::{Budget, Overwrite, Terms, files::read_file, maps, picture, save};
use crate::math::{Size, Vec2, srgb::Color};
use crate::paint::{Adjust, ImageFilter, PictureSource, PlacedImage, Placement};
use crate::raster::{Outside, Picture};
use crate::session::actions::layers::above;
use crate::session::actions::parts;
use crate::session::actions::pictures::{self, PicturePart};
use crate::session::actions::unwrapped;
use crate::session::replay::{ReplayValue, actions};
use crate::session::{OpenDocument, Session, brushes, storage};
use crate::surface::operator::reflection;
use crate::surface::{Anchor, Bend, Operator};
use crate::{Error, Result};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// By what is added to a file's name.
impl ReplayValue for ShapeMap {
    fn written(&self) -> Value {
        self.suffix().into()
    }
    fn read(value: &Value) -> std::result::Result<Self, String> {
        let map = value.as_str().and_then(ShapeMap::from_suffix);
        map.ok_or_else(|| format!("is {value}; it must be _n, _d, _h, _mask or _id"))
    }
}

actions! {
    /// Paths are those of the user's own files.
    FileAction {
        /// An empty document, its bottom layer filled with a colour where there is one.
        "new" New { width: u32, height: u32, background: Option<Color> }
        /// A document, or a picture as one.
        "open" Open { file: PathBuf }
        /// A document on the surface of these maps, conventions found.
        "open maps" OpenMaps { normal: Option<PathBuf>, depth: Option<PathBuf> }
        /// A picture as an image layer, pinned to the surface at a canvas point.
        "place" Place { file: PathBuf, at: Vec2 }
        /// The brushes of a file join those to choose from.
        "import brush" ImportBrush { file: PathBuf }
        /// The brush in hand joins them under a name.
        "keep brush" KeepBrush { name: String }
        /// One of the user's own, by its key, is gone.
        "remove brush" RemoveBrush { name: String }
        "save" Save { file: PathBuf }
        /// `bits`: a channel; the format's usual ones where absent.
        "export" Export { file: PathBuf, background: Option<Color>, quality: u8, bits: Option<u8> }
        /// The maps of the shape as files whose names begin with this one's, as PNG, or as EXR where it ends in that.
        "export maps" ExportMaps { file: PathBuf, maps: Vec<ShapeMap>, directx: bool, bits: u8 }
        /// The painting, or the layer that is seen alone, as it lies in the planes of the unwrapped surface, `scale`
        /// pixels to one of the plane.
        "export unwrapped" ExportUnwrapped { file: PathBuf, scale: u32, deep: bool }
        /// A picture of those planes becomes an image layer that lies on the surface.
        "import unwrapped" ImportUnwrapped { file: PathBuf }
        /// A picture that the selected layer is made of.
        "use" Use { part: PicturePart, file: PathBuf }
        /// The document's surface anew, of these maps: what is live bends over it.
        "replace maps" ReplaceMaps { normal: Option<PathBuf>, depth: Option<PathBuf> }
        /// A part of these maps, in front of all others.
        "add maps" AddMaps { normal: Option<PathBuf>, depth: Option<PathBuf> }
        "tab" Tab { index: usize }
        /// Whether saved or not.
        "close" Close { index: usize }
    }
}

impl FileAction {
    pub fn apply(&self, session: &mut Session) -> Result<()> {
        session.drop_gesture();
        match self {
            FileAction::New { width, height, background } => {
                let size = Budget::of_this_machine().size(Path::new("new"), (*width).into(), (*height).into())?;
                let name = session.untitled();
                session.add_document(OpenDocument::new(name, empty(size, *background), None));
            }
            FileAction::Open { file } => {
                let opened = storage::open(file)?;
                session.adopt(opened);
            }
            FileAction::OpenMaps { normal, depth } => {
                let opened = storage::open_maps(&storage::maps_of(normal.as_deref(), depth.as_deref()))?;
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
            FileAction::Save { file } => {
                let Some(tab) = session.active() else { return Ok(()) };
                let document = tab.document().clone();
                let terms = session.saving(file, unless_forced(session));
                // Nothing here gives up, so it is saved.
                if let (Some(stamp), Some(tab)) =
                    (storage::save(file, &document, terms, &Progress::default())?, session.active_mut())
                {
                    tab.mark_saved(document, file.clone(), stamp);
                }
            }
            FileAction::Export { file, background, quality, bits } => {
                let Some(tab) = session.active() else { return Ok(()) };
                let (background, quality, bits) = (*background, *quality, *bits);
                let options = ExportOptions { background, quality, bits, ..ExportOptions::default() };
                let terms = Terms::export(unless_forced(session), session.reads());
                let notes = export(tab.document(), file, &options, terms, &Progress::default())?;
                session.notes.extend(notes);
            }
            FileAction::ExportMaps { file, maps, directx, bits } => {
                let Some(tab) = session.active() else { return Ok(()) };
                let is_exr = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("exr"));
                let options = ShapeOptions { is_directx: *directx, is_deep: *bits > 8, is_exr };
                let terms = Terms::export(unless_forced(session), session.reads());
                export_maps(tab.document(), file, maps, options, &terms)?;
            }
            FileAction::ExportUnwrapped { file, scale, deep } => {
                let Some(tab) = session.active() else { return Ok(()) };
                let settings = session.unwrap_settings();
                let deep = deep.then_some(Highlights::Clipped);
                let options = UnwrapOptions { scale: *scale, settings, deep };
                let terms = Terms::export(unless_forced(session), session.reads());
                unwrapped::export(&tab.drawn(), file, options, terms, &Progress::default())?;
            }
            FileAction::ImportUnwrapped { file } => {
                let (name, picture) = read_picture(file)?;
                unwrapped::place(session, &name, picture);
                session.note_read(file);
            }
            FileAction::Use { part, file } => {
                let read = pictures::read(*part, file)?;
                if let Some(tab) = session.active_mut()
                    && let Some(layer) = tab.selected
                {
                    pictures::put(tab, layer, read);
                    tab.reads.push(file.clone());
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
            FileAction::Tab { index } => {
                session.crop = None;
                session.current = (*index).min(session.open_documents.len().saturating_sub(1));
            }
            FileAction::Close { index } => session.close_document(*index),
        }
        Ok(())
    }
}

/// An empty document.
pub fn empty(size: Size, background: Option<Color>) -> Document {
    let fill = background.map(|color| Arc::new(Layer::new("Background", Content::Fill(color))));
    Document { layers: fill.into_iter().collect(), ..Document::empty(size) }
}

/// What saving and exporting may replace beside the document's own file: nothing, since nobody can be asked, or all
/// where the user said so beforehand.
fn unless_forced(session: &Session) -> Overwrite {
    if session.replaces_unasked { Overwrite::Forced } else { Overwrite::Nothing }
}

/// The flattened picture as a file, or the document as a Photoshop file; none is written if that is given up. What the
/// format cannot hold.
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

/// The maps of a document's shape as files; their paths.
pub fn export_maps(
    document: &Document,
    file: &Path,
    maps: &[ShapeMap],
    options: ShapeOptions,
    terms: &Terms,
) -> Result<Vec<PathBuf>> {
    let no_shape = || Error::unsupported(file, "the document has no shape whose maps could be exported");
    let surface = document.surface.as_ref().ok_or_else(no_shape)?;
    ShapeFiles::new(file, maps, options, terms)?.write(surface)
}

/// A picture of the user's own, with the name it goes by.
pub fn read_picture(file: &Path) -> Result<(String, Picture)> {
    let bytes = read_file(file, Budget::of_this_machine().file_bytes)?;
    let picture = picture::decode(file, &bytes, &Budget::of_this_machine())?;
    Ok((file.file_name().unwrap_or_default().to_string_lossy().into_owned(), picture))
}

/// A picture becomes an image layer, bent by the current operator (by normals, if that is flat), pinned at `at`.
/// Without an open document it becomes a document of its own.
pub fn place(session: &mut Session, name: &str, picture: Picture, at: Vec2) {
    let operator = match session.operator {
        Operator::None => DROPPED,
        operator => operator,
    };
    let Some(tab) = session.active_mut() else {
        let tab = OpenDocument::new(name, of_picture(name, picture), None);
        return session.add_document(tab);
    };
    let document = tab.document();
    let operator = if document.surface.is_some() { operator } else { Operator::None };
    let at = at.clamp(Vec2::ZERO, Vec2::new(document.size.width as f32, document.size.height as f32));
    let lies = Lies {
        placement: placement(document, operator, at),
        outside: Outside::Mirror,
        bend: Bend { operator, anchors: vec![Anchor::fixed(at)], ..Bend::default() },
    };
    add_image(tab, name, picture, lies, "Place image");
}

/// How a picture lies on the canvas.
pub(super) struct Lies {
    pub placement: Placement,
    pub outside: Outside,
    pub bend: Bend,
}

/// A picture becomes an image layer above the selected one, which is selected; whether it could.
pub(super) fn add_image(tab: &mut OpenDocument, name: &str, picture: Picture, lies: Lies, label: &str) -> bool {
    let document = tab.document();
    let Lies { placement, outside, bend } = lies;
    let source = PictureSource::new(free_file(document, name), picture, Adjust::default());
    let filter = ImageFilter::Antialias;
    let image = PlacedImage { source, placement, outside, bend, filter, frame: Default::default() };
    let stem = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    let layer = Layer::new(document.free_layer_name(&stem), Content::Image(Live::new(image)));
    let id = layer.id;
    let next = document.with_inserted(layer, above(tab));
    let is_added = next.is_some_and(|next| tab.commit(label, next));
    if is_added {
        tab.selected = Some(id);
    }
    is_added
}

/// Where a picture lies that is pinned at a point: over the canvas, or over all that a mirror looks up.
fn placement(document: &Document, operator: Operator, at: Vec2) -> Placement {
    match (operator, &document.surface) {
        (Operator::Reflection { alpha, .. }, Some(surface)) => {
            let (x, y) = surface.pixel_of(at);
            let turn = reflection::mirrored(surface.nbar(x, y), surface.normal(x, y).z);
            Placement::covering_mirror(document.size, alpha, turn)
        }
        _ => Placement::covering(document.size),
    }
}

/// Replaces the surface beneath the layers, as a step; it is stretched to the canvas, with a note. Fails if no surface
/// of the canvas's size can be made of it.
pub fn replace_maps(session: &mut Session, source: &SurfaceSource, import: maps::ImportedSurface) -> Result<()> {
    let maps::ImportedSurface { surface, findings, files } = import;
    let Some(tab) = session.active_mut() else { return Ok(()) };
    let (canvas, found) = (tab.document().size, surface.size());
    let mut notes = findings.notes;
    let placed = source.map();
    let surface = if found == canvas && placed.is_none() {
        Arc::new(surface)
    } else if let Some(map) = &placed {
        Arc::new(surface).onto(canvas, Some(map)).map_err(|error| Error::unsupported("maps", error))?
    } else {
        notes.push(format!("The maps have {found} pixels and were stretched to the canvas, {canvas}."));
        Arc::new(surface.stretched(canvas).map_err(|error| Error::unsupported("maps", error))?)
    };
    let is_whole = found == canvas || placed.is_some();
    let next = Document {
        surface: Some(surface),
        surface_source: is_whole.then(|| Arc::new(source.clone())),
        surface_files: Arc::new(if is_whole { files } else { Default::default() }),
        ..tab.document().clone()
    };
    let maps = next.surface.clone();
    if tab.commit("Replace maps", next.with_maps(maps).with_selections_found()) {
        tab.reads.extend(storage::map_files(source));
        session.notes.extend(notes);
    }
    Ok(())
}

/// A part of maps in front of all others, stretched to the canvas, as a step. Fails if no surface of the canvas's size
/// can be made of them.
pub fn add_maps(session: &mut Session, source: &SurfaceSource, import: maps::ImportedSurface) -> Result<()> {
    let maps::ImportedSurface { surface, findings, files } = import;
    let Some(tab) = session.active_mut() else { return Ok(()) };
    let (canvas, found) = (tab.document().size, surface.size());
    let mut notes = findings.notes;
    if found != canvas {
        notes.push(format!("The maps have {found} pixels and were stretched to the canvas, {canvas}."));
    }
    let surface = Arc::new(surface).onto(canvas, None).map_err(|error| Error::unsupported("maps", error))?;
    parts::new::add_maps(tab, PartMaps { source: Arc::new(source.clone()), files: Arc::new(files), surface });
    tab.reads.extend(storage::map_files(source));
    session.notes.extend(notes);
    Ok(())
}

/// The operator of a dropped picture if the current one is flat: like a reflection that is still recognisable.
const DROPPED: Operator = Operator::Normal { alpha: 0.5, beta: 1.5, detail: 0.0 };

/// A picture as a document of its own size.
pub fn of_picture(name: &str, picture: Picture) -> Document {
    let size = picture.size;
    let stem = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    Document { layers: vec![Arc::new(storage::flat_image(&stem, name, picture, size))], ..Document::empty(size) }
}

/// A file name that no other picture of the document has.
pub(super) fn free_file(document: &Document, name: &str) -> String {
    let taken = |name: &str| document.walk().iter().any(|(_, layer)| layer.content.files().contains(&name));
    let path = Path::new(name);
    let (stem, extension) = (path.file_stem().unwrap_or_default(), path.extension().unwrap_or_default());
    let mut free = name.to_owned();
    for i in 2.. {
        if !taken(&free) {
            break;
        }
        free = format!("{}-{i}.{}", stem.to_string_lossy(), extension.to_string_lossy());
    }
    free
}
